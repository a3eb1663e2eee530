#!/usr/bin/env bash
# Renders scenes beside the Khronos glTF viewer, which others wrote, and reports how far the two are apart. Build first.
#
# To make the table and the pictures of docs/materials.md ("Beside the Khronos viewer") again:
#
#   scripts/viewer_compare.sh --document
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/viewer_compare.sh --document
       scripts/viewer_compare.sh [--scenes NAME,NAME…] [--size WxH]

Renders models (scripts/models.sh) and spheres with Glint and with the Khronos glTF viewer
in headless Chromium, under the same map and camera, in linear radiance, and compares the
pictures by region: all objects, facing, grazing, nine cells, each material.

Writes to out/viewer: viewer.md (tables), viewer.json (every region and channel), and a
picture for each scene: Glint prefiltered, Glint traced, the viewer, the ratio. In the
ratio, red means that Glint is brighter, blue that it is darker, by up to a factor of 1.5.

  --document   also replaces the table in docs/materials.md and docs/images/viewer_*.jpg
  --scenes     only these scenes
  --size       pixels of the models' pictures (default 320x240)

Needs Chromium, its driver and npm (scripts/setup.sh --viewer). npm fetches the viewer's
package once, into $XDG_CACHE_HOME/glint-sources or ~/.cache/glint-sources, and its
checksum is compared. Where one of them is missing, the script says so in one line and
exits 0, or 1 with --document. It also exits 1 where a scene can't be rendered, where the
backgrounds of the two differ, or where a sphere is outside of its bound; --document writes
all the same in the last case.

Environment: GLINT_BIN, the folder of glint (build/release/bin).
TEXT
}

readonly kPackage=@khronosgroup/gltf-viewer
readonly kVersion=1.1.0
readonly kSha512=WC5F99OUcqOG1rz+xMM1lNU6C9IPWrnFurLUc/belq4ZEWRrUwwWI+6EdzK5LOjUH9p9EnajZKeAlIE1h+AaaA==
# Debian's package of Selenium is for the system's Python, even if another one is first on the path.
readonly kPython=/usr/bin/python3

document=false
options=()
while [[ $# -gt 0 ]]; do
    case $1 in
        --document)
            document=true
            options+=(--document)
            ;;
        --scenes | --size)
            [[ $# -ge 2 ]] || { usage >&2; exit 2; }
            options+=("$1" "$2")
            shift
            ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            usage >&2
            exit 2
            ;;
    esac
    shift
done
if [[ $document == true && ${#options[@]} -gt 1 ]]; then
    usage >&2
    exit 2
fi

# skip REASON…: leaves the comparison out. That is an error only where the document depends on it.
skip() {
    printf 'viewer_compare.sh: left out: %s\n' "$*" >&2
    [[ $document == false ]] || exit 1
    exit 0
}

bin=${GLINT_BIN:-build/release/bin}
if [[ ! -x $bin/glint ]]; then
    echo "viewer_compare.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
for program in chromium chromedriver "$kPython"; do
    command -v "$program" >/dev/null || skip "$program is not there (scripts/setup.sh --viewer)"
done
"$kPython" -c 'import numpy, selenium' 2>/dev/null || skip "Selenium or NumPy is not there (scripts/setup.sh --viewer)"

# Fetches the package and unpacks it, if its checksum is the expected one.
package=${XDG_CACHE_HOME:-${HOME:-}/.cache}/glint-sources/gltf-viewer-$kVersion
if [[ ! -e $package/dist/gltf-viewer.module.js ]]; then
    command -v npm >/dev/null || skip "npm is not there (scripts/setup.sh --viewer)"
    mkdir -p "$(dirname "$package")"
    scratch=$(mktemp -d "$package.XXXXXX")
    trap 'rm -rf "$scratch"' EXIT
    npm pack "$kPackage@$kVersion" --pack-destination "$scratch" --ignore-scripts >"$scratch/npm.log" 2>&1 ||
        skip "npm can't fetch $kPackage@$kVersion"
    archive=$(echo "$scratch"/*.tgz)
    sha512=$("$kPython" -c 'import base64, hashlib, sys
print(base64.b64encode(hashlib.sha512(open(sys.argv[1], "rb").read()).digest()).decode())' "$archive")
    if [[ $sha512 != "$kSha512" ]]; then
        echo "viewer_compare.sh: error: $kPackage@$kVersion has the checksum $sha512 instead of $kSha512" >&2
        exit 1
    fi
    tar --extract --gzip --file "$archive" --directory "$scratch" --no-same-owner
    mv -T "$scratch/package" "$package"
    rm -rf "$scratch"
    trap - EXIT
fi

eval "$(scripts/models.sh)"
"$kPython" -B scripts/viewer/compare.py --package "$package" --package-name "$kPackage $kVersion" \
    --glint "$bin/glint" --models "$GLINT_MODELS" --out out/viewer "${options[@]}"
