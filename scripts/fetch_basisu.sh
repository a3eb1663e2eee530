#!/usr/bin/env bash
# Fetches the sources of the Basis Universal transcoder, with which Glint reads KTX2 textures.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: scripts/fetch_basisu.sh [--where]

Fetches the source package basis-universal by apt, from the mirror and with the key that
this machine already uses, and keeps the files that Glint compiles (4 MB) in
$GLINT_BASISU_ROOT, else in $XDG_CACHE_HOME/glint-sources/basis-universal, else below
~/.cache. Does nothing if they are there. No release of Debian 12, Debian 13 and
Ubuntu 24.04 has the package, but later ones do. apt's own configuration stays as it is.

If the package can't be fetched, the script says so in one line and exits with 1. Glint is
then built without it and reads no KTX2 textures.

  --where   print the folder, and exit
TEXT
}

say() {
    printf 'setup: %s\n' "$*"
}

# apt_mirror.sh also expects this function.
fail() {
    say "KTX2 textures are left out of the build: $*"
    exit 1
}

# shellcheck source=scripts/apt_mirror.sh
source "$(dirname "${BASH_SOURCE[0]}")/apt_mirror.sh"

root=${GLINT_BASISU_ROOT:-${XDG_CACHE_HOME:-${HOME:-}/.cache}/glint-sources/basis-universal}

# Prints the suites that have the package. The one that changes least comes first.
suites_of() {
    case $1 in
        debian) printf '%s main\n' forky sid ;;
        ubuntu) printf '%s universe\n' resolute devel ;;
    esac
}

# fetch SUITE COMPONENT FOLDER: downloads the source package of that suite into FOLDER. apt checks its
# signatures.
fetch() {
    local suite=$1 component=$2 folder=$3
    rm -rf "$folder"
    private_apt "$folder"
    mirror_stanza deb-src "$suite" "$component" >"$folder/parts/source.sources" || return 1
    # The index of these suites expires after a week, unlike that of a release. An older mirror still has the
    # package, and its signature is still valid.
    private_apt_options+=(-o "Acquire::Check-Valid-Until=false")
    apt-get update "${private_apt_options[@]}" >"$folder/apt.log" 2>&1 || return 1
    (cd "$folder" && apt-get source "${private_apt_options[@]}" --download-only --only-source basis-universal) \
        >>"$folder/apt.log" 2>&1
}

# unpack FOLDER: copies the parts that Glint needs of the package in FOLDER to FOLDER/kept, and applies
# Debian's patches to them.
unpack() {
    local folder=$1 kept=$1/kept patch
    mkdir "$kept"
    # The archive also has 300 MB of pictures and builds for browsers.
    tar --extract --file "$(echo "$folder"/basis-universal_*.orig.tar.*)" --directory "$kept" --strip-components=1 \
        --no-same-owner --wildcards --no-wildcards-match-slash \
        '*/transcoder/*' '*/zstd/zstd.h' '*/zstd/zstd_errors.h' '*/LICENSE' || return 1
    tar --extract --file "$(echo "$folder"/basis-universal_*.debian.tar.*)" --directory "$folder" || return 1
    if [[ -s $folder/debian/patches/series ]]; then
        while read -r patch _; do
            [[ -z $patch || $patch == \#* ]] ||
                git -C "$kept" apply -p1 --include='transcoder/*' "$folder/debian/patches/$patch" || return 1
        done <"$folder/debian/patches/series"
    fi
    basename "$folder"/basis-universal_*.dsc .dsc >"$kept/package"
}

if [[ $# -gt 0 ]]; then
    case $1 in
        --where)
            printf '%s\n' "$root"
            exit 0
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
fi
if [[ -e $root/transcoder/basisu_transcoder.cpp ]]; then
    exit 0
fi
# shellcheck source=/dev/null
distribution=$(. /etc/os-release 2>/dev/null && printf '%s' "${ID:-}") || true
[[ -n $(suites_of "$distribution") ]] || fail "the package basis-universal is fetched on Debian and Ubuntu alone"
mirror_stanza deb-src any >/dev/null ||
    fail "found no source of this release's own packages to take the mirror from"

mkdir -p "$(dirname "$root")" || fail "$(dirname "$root") can't be made"
scratch=$(mktemp -d "$root.XXXXXX") || fail "$(dirname "$root") can't be written"
trap 'rm -rf "$scratch"' EXIT
say "fetching the sources of Basis Universal, for KTX2 textures (about 140 MB)"
while read -r suite component; do
    if fetch "$suite" "$component" "$scratch/apt"; then
        unpack "$scratch/apt" || fail "the package basis-universal has another layout than that of 2.0"
        [[ -e $scratch/apt/kept/transcoder/basisu_transcoder.cpp ]] ||
            fail "the package basis-universal has no transcoder"
        rm -rf "$root"
        mv -T "$scratch/apt/kept" "$root"
        say "$(cat "$root/package") of $suite is in $root"
        exit 0
    fi
done < <(suites_of "$distribution")
fail "apt can't fetch the source package basis-universal"
