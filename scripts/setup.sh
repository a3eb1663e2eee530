#!/usr/bin/env bash
# Installs what Glint needs to build, test and run. Does nothing if everything is there.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: scripts/setup.sh [--check] [--browser] [--lint] [--portable] [--sanitize] [--viewer] [--window]

Installs the packages that Glint needs on Debian 12, Debian 13 and Ubuntu 24.04.
On Debian 12, whose Mesa has no ray queries, mesa-vulkan-drivers comes from backports.
Then scripts/fetch_basisu.sh fetches the sources with which Glint reads KTX2 textures. If
they can't be fetched, the script says so, and Glint is built without them.

  --check     install nothing; print the missing packages and exit 1 if there are any
  --browser   also Chromium and its driver, with which scripts/test.sh checks the page of glint bench
  --lint      also the packages for scripts/lint.sh
  --portable  also the packages for scripts/portable.sh, which is for Debian 12
  --sanitize  also the packages for scripts/sanitize.sh and scripts/fuzz.sh
  --viewer    also the packages for scripts/viewer_compare.sh: those of --browser, and npm
  --window    also Xvfb, an X server without a screen, in which the tests use the window of glint view, and
              Pillow, with which benchmarks/view/tour.py writes its pictures
TEXT
}

# Each need, and the packages that provide it. The first package that the distribution has is used.
#   command NAME   a program on the PATH
#   file PATTERN   a file
kNeeds=(
    "command g++|g++"
    "command cmake|cmake"
    "command ninja|ninja-build"
    "command pkg-config|pkg-config pkgconf"
    "command git|git"
    "command ccache|ccache"
    "command mold|mold"
    "command xz|xz-utils"
    "file /etc/ssl/certs/ca-certificates.crt|ca-certificates"
    "file /usr/include/glslang/Public/ShaderLang.h|glslang-dev"
    "command glslangValidator|glslang-tools"
    "file /usr/include/spirv-tools/optimizer.hpp|spirv-tools-dev libspirv-tools-dev spirv-tools"
    "command spirv-val|spirv-tools"
    "file /usr/include/spirv/unified1/spirv.hpp|spirv-headers"
    "file /usr/include/tiny_gltf.h|libtinygltf-dev"
    "file /usr/include/draco/compression/decode.h|libdraco-dev"
    "file /usr/include/meshoptimizer.h|libmeshoptimizer-dev"
    "file /usr/include/pugixml.hpp|libpugixml-dev"
    "file /usr/include/webp/decode.h|libwebp-dev"
    "file /usr/include/zstd.h|libzstd-dev"
    "file /usr/include/vulkan/vulkan.h|libvulkan-dev"
    "file /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json|vulkan-validationlayers"
    "file /usr/share/vulkan/icd.d/lvp_icd*.json|mesa-vulkan-drivers"
    "file /usr/include/mimalloc.h|libmimalloc-dev"
    "file /usr/include/fmt/format.h|libfmt-dev"
    "file /usr/include/CLI/CLI.hpp|libcli11-dev"
    "file /usr/include/nlohmann/json.hpp|nlohmann-json3-dev"
    "file /usr/include/kainjow/mustache.hpp|libkainjow-mustache-dev"
    "file /usr/include/glm/glm.hpp|libglm-dev"
    "file /usr/include/xxhash.h|libxxhash-dev"
    "file /usr/include/stb/stb_image.h|libstb-dev"
    "file /usr/include/OpenEXR/ImfHeader.h|libopenexr-dev"
    "file /usr/include/embree*/rtcore.h|libembree-dev"
    "file /usr/include/gtest/gtest.h|libgtest-dev"
    "file /usr/include/valijson/schema.hpp|libvalijson-dev"
    "file /usr/include/GLFW/glfw3.h|libglfw3-dev"
    "file /usr/include/imgui/imgui.h|libimgui-dev"
    "file /usr/include/X11/extensions/XTest.h|libxtst-dev"
    "file /usr/lib/python3/dist-packages/numpy/__init__.py|python3-numpy"
    "file /usr/lib/python3/dist-packages/xxhash/__init__.py|python3-xxhash"
)
# clang-format 14 is what the sources are formatted with.
kLintNeeds=(
    "command clang-format-14|clang-format-14 clang-format"
    "command clang-tidy|clang-tidy"
    "command shellcheck|shellcheck"
)
kPortableNeeds=(
    "command dpkg-source|dpkg-dev"
    "command debootstrap|debootstrap"
)
# Mesa's software driver has ray queries from this series on.
kOldestMesa=24
kBackportsFile=/etc/apt/sources.list.d/glint-backports.sources

say() {
    printf 'setup: %s\n' "$*"
}

fail() {
    printf 'setup: error: %s\n' "$*" >&2
    exit 1
}

# shellcheck source=scripts/apt_mirror.sh
source "$(dirname "${BASH_SOURCE[0]}")/apt_mirror.sh"

# --- What is there ---------------------------------------------------------------------------------

present() {
    local kind=$1 what=$2
    case $kind in
        command) command -v "$what" >/dev/null ;;
        file) compgen -G "$what" >/dev/null ;;
    esac
}

# Prints the needs that are not met.
missing_needs() {
    local need probe
    for need in "$@"; do
        probe=${need%%|*}
        if ! present "${probe%% *}" "${probe#* }"; then
            printf '%s\n' "$need"
        fi
    done
}

mesa_version() {
    dpkg-query -W -f '${Version}' mesa-vulkan-drivers 2>/dev/null || true
}

# Returns whether this is Debian 12 with its original Mesa.
mesa_too_old() {
    [[ $distribution == "debian 12" ]] || return 1
    local version
    version=$(mesa_version)
    [[ -z $version ]] || dpkg --compare-versions "$version" lt "$kOldestMesa"
}

# Adds a browser and its driver. Ubuntu has browsers only as snaps, which containers can't install, so the
# test of the page in a browser is skipped there.
add_browser_needs() {
    [[ $distribution == debian\ * ]] || return 0
    needs+=(
        "command chromium|chromium"
        "command chromedriver|chromium-driver"
        "file /usr/lib/python3/dist-packages/selenium/__init__.py|python3-selenium"
    )
}

# Adds Clang, its run-time libraries, and the tool that adds names and lines to their reports.
add_sanitizer_needs() {
    local version
    # Debian's packages of the run-time libraries are for one version, that of the package clang.
    case $distribution in
        "debian 12") version=14 ;;
        "ubuntu 24.04") version=18 ;;
        *) version=19 ;;
    esac
    needs+=(
        "command clang++|clang"
        "command llvm-symbolizer|llvm"
        "file /usr/lib/llvm-$version/lib/clang/*/lib/linux/libclang_rt.asan-*.a|libclang-rt-$version-dev"
    )
}

# --- What to install -------------------------------------------------------------------------------

as_root() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    else
        sudo "$@"
    fi
}

apt_get() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get "$@"
}

candidate() {
    LC_ALL=C apt-cache policy "$1" 2>/dev/null | sed -n 's/^  Candidate: //p' | grep -v '^(none)$' || true
}

# Prints the first of the named packages that the configured sources have.
choose_package() {
    local name
    for name in "$@"; do
        if [[ -n $(candidate "$name") ]]; then
            printf '%s\n' "$name"
            return
        fi
    done
    local hint="check the sources of apt"
    if [[ $distribution == ubuntu* ]]; then
        hint="is the component universe enabled?"
    fi
    fail "no package for this system among: $* ($hint)"
}

# Adds backports to the sources. They use the mirror and the key that this machine uses for Debian itself.
configure_backports() {
    local stanza
    if [[ $'\n'$(apt_indices) == *$'\n'"bookworm-backports|main|"* ]]; then
        say "bookworm-backports is configured already"
        return
    fi
    if ! stanza=$(mirror_stanza deb bookworm-backports); then
        fail "found no source of Debian's main component to take the mirror of backports from;" \
            "configure bookworm-backports by hand and run this again"
    fi
    say "adding bookworm-backports in $kBackportsFile"
    printf '%s\n' "$stanza" | as_root tee "$kBackportsFile" >/dev/null
    as_root chmod 644 "$kBackportsFile"
    apt_get update -q
}

install_mesa_from_backports() {
    configure_backports
    say "installing mesa-vulkan-drivers from bookworm-backports"
    apt_get install -q -y --no-install-recommends -t bookworm-backports mesa-vulkan-drivers
    if mesa_too_old; then
        fail "mesa-vulkan-drivers is still $(mesa_version): bookworm-backports offers no newer one"
    fi
}

install_packages() {
    local packages=() alternatives need chosen
    for need in "$@"; do
        read -ra alternatives <<<"${need#*|}"
        chosen=$(choose_package "${alternatives[@]}")
        packages+=("$chosen")
    done
    say "installing ${packages[*]}"
    apt_get install -q -y --no-install-recommends "${packages[@]}"
}

# Fetches the sources for KTX2 textures. Glint builds without them, so nothing here fails.
fetch_basisu() {
    local script root
    script=$(dirname "${BASH_SOURCE[0]}")/fetch_basisu.sh
    root=$("$script" --where)
    if [[ -e $root/transcoder/basisu_transcoder.cpp ]]; then
        say "nothing to do"
        return
    fi
    if [[ $check_only == true ]]; then
        say "not there: the sources for KTX2 textures, in $root (optional)"
        return
    fi
    # A new machine may not have read its package lists yet. The mirror is found through them.
    if ! apt_indices 2>/dev/null | grep -qi '|main|\(debian\|ubuntu\)|'; then
        apt_get update -q || true
    fi
    "$script" || true
}

# --- Main ------------------------------------------------------------------------------------------

check_only=false
browser=false
sanitize=false
viewer=false
needs=("${kNeeds[@]}")
for argument in "$@"; do
    case $argument in
        --check) check_only=true ;;
        --browser) browser=true ;;
        --lint) needs+=("${kLintNeeds[@]}") ;;
        --portable) needs+=("${kPortableNeeds[@]}") ;;
        --sanitize) sanitize=true ;;
        --viewer) viewer=true ;;
        --window) needs+=("command Xvfb|xvfb" "file /usr/lib/python3/dist-packages/PIL/__init__.py|python3-pil") ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            usage >&2
            exit 2
            ;;
    esac
done

distribution=unknown
if [[ -r /etc/os-release ]]; then
    # shellcheck source=/dev/null
    distribution=$(. /etc/os-release && printf '%s %s' "${ID:-unknown}" "${VERSION_ID:-}")
fi
if [[ $browser == true || $viewer == true ]]; then
    add_browser_needs
fi
if [[ $viewer == true ]]; then
    needs+=("command npm|npm")
fi
if [[ $sanitize == true ]]; then
    add_sanitizer_needs
fi

mapfile -t missing < <(missing_needs "${needs[@]}")
old_mesa=false
if mesa_too_old; then
    old_mesa=true
fi

if [[ ${#missing[@]} -eq 0 && $old_mesa == false ]]; then
    fetch_basisu
    exit 0
fi

if [[ $check_only == true ]]; then
    for need in "${missing[@]}"; do
        probe=${need%%|*}
        names=${need#*|}
        say "missing: ${probe#* } (package ${names// / or })"
    done
    fetch_basisu
    if [[ $old_mesa == true && -n $(mesa_version) ]]; then
        say "too old: mesa-vulkan-drivers $(mesa_version) (from $kOldestMesa on, in bookworm-backports)"
    fi
    exit 1
fi

case $distribution in
    "debian 12" | "debian 13" | "ubuntu 24.04") ;;
    *)
        printf 'setup: missing here:\n' >&2
        printf '  %s\n' "${missing[@]##*|}" >&2
        fail "this script knows Debian 12, Debian 13 and Ubuntu 24.04, not '$distribution';" \
            "install the packages above by the names they have here," \
            "and a Vulkan driver with ray queries, for instance Mesa $kOldestMesa or newer"
        ;;
esac
if [[ $(id -u) -ne 0 ]] && ! command -v sudo >/dev/null; then
    fail "packages are missing (--check lists them): run this as root, or install sudo"
fi

say "reading the package lists"
apt_get update -q
if [[ $old_mesa == true ]]; then
    install_mesa_from_backports
    mapfile -t missing < <(missing_needs "${needs[@]}")
fi
if [[ ${#missing[@]} -gt 0 ]]; then
    install_packages "${missing[@]}"
fi

mapfile -t missing < <(missing_needs "${needs[@]}")
if [[ ${#missing[@]} -gt 0 ]]; then
    printf 'setup: still missing: %s\n' "${missing[@]%%|*}" >&2
    fail "the packages installed did not bring all that is needed"
fi
fetch_basisu
say "done"
