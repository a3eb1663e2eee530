#!/usr/bin/env bash
# Builds and tests what is committed in a fresh root of Debian 12 or 13. That of Debian 13 has newer glslang and Mesa, so
# that --position-fetch works there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/debian_root.sh 12|13 ROOT [COMMAND…]

Makes a root of Debian 12 or 13 in the folder ROOT by debootstrap, if there is none,
from the mirror that apt uses here. Copies the commit that is checked out to ROOT/glint
and runs COMMAND there (default: scripts/test.sh). Models are those of $GLINT_MODELS,
else those of ../shared/models, if they exist. Files that were built there before are
kept, so that a second run builds only what changed.

Needs root, some 4 GB and the package debootstrap, which it installs.
TEXT
}

fail() {
    printf 'debian_root: error: %s\n' "$*" >&2
    exit 1
}

# Finds the URI of the mirror from which Debian's main component comes here, and the file of its keys.
find_mirror() {
    local release component origin uri
    # shellcheck disable=SC2016 # apt expands these, not the shell
    while IFS='|' read -r release component origin uri keys; do
        if [[ $component == main && $origin == Debian && $release != *-* ]]; then
            mirror=$uri
            return
        fi
    done < <(apt-get indextargets --format '$(RELEASE)|$(COMPONENT)|$(ORIGIN)|$(REPO_URI)|$(SIGNED_BY)' \
        'Created-By: Packages')
    fail "found no source of Debian's main component to take the mirror from: run this on Debian"
}

make_root() {
    find_mirror
    if ! command -v debootstrap >/dev/null; then
        DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends debootstrap
    fi
    local options=(--variant=minbase --include=ca-certificates)
    # Keys inside the source itself are not in a file. debootstrap then uses those of Debian's own package.
    if [[ $keys == /* ]]; then
        options+=("--keyring=$keys")
    fi
    debootstrap "${options[@]}" "$suite" "$root" "$mirror"
}

# Copies a pack of commits, so that files that did not change keep their time stamps.
copy_commit() {
    if [[ ! -d $root/glint/.git ]]; then
        git clone -q --no-hardlinks . "$root/glint"
    fi
    git -C "$root/glint" fetch -q "$PWD" HEAD
    git -C "$root/glint" reset -q --hard FETCH_HEAD
}

if [[ $# -lt 2 || $1 == -h || $1 == --help ]]; then
    usage
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
release=$1
case $release in
    12) suite=bookworm ;;
    13) suite=trixie ;;
    *) fail "$release is neither 12 nor 13" ;;
esac
[[ $(id -u) -eq 0 ]] || fail "this makes a root folder and mounts /proc in it: run it as root"
mkdir -p "$2"
root=$(realpath "$2")
shift 2
[[ $root != / ]] || fail "ROOT is to be a folder of its own, not this system"
[[ $# -gt 0 ]] || set -- scripts/test.sh

mirror=
keys=
if [[ ! -x $root/usr/bin/apt-get ]]; then
    make_root
fi
version=$(sed -n 's/^VERSION_ID="\?\([0-9]*\)"\?$/\1/p' "$root/etc/os-release")
[[ $version == "$release" ]] || fail "$root holds another system than Debian $release"
copy_commit

# The mounts belong to a namespace that ends with the command. The shell in the middle is that of the new
# root.
models=$(realpath -q "${GLINT_MODELS:-../shared/models}" || true)
# shellcheck disable=SC2016 # the inner shell expands these
exec unshare --mount bash -c '
    set -euo pipefail
    root=$1 models=$2
    shift 2
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    cp -L /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
    if [[ -d $models ]]; then
        mkdir -p "$root/shared/models"
        mount --bind "$models" "$root/shared/models"
    fi
    exec chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
        bash -c "cd /glint && exec \"\$@\"" bash "$@"
' bash "$root" "$models" "$@"
