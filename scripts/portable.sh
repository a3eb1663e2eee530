#!/usr/bin/env bash
# Builds and packs a glint that runs on every machine with a C library of 2022 or later and a Vulkan driver.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/portable.sh [--test ROOT]

On Debian 12, builds a release glint, with gallery, glint_numerics, bench_ordering,
test_ray_steps and the example engine. They are statically linked except for the C library
and the Vulkan loader. The script packs them as out/glint-VERSION-linux-ARCHITECTURE.tar.gz
with the README, the licences, and the scenes of both examples with their packages for
every strategy and tracer.

Libraries without a static archive in Debian are built from Debian's own source packages,
once, in build/portable/deps. Needs the packages of scripts/setup.sh --portable.

  --test ROOT  also unpacks the archive in a root of Debian 12 with nothing but a
               Vulkan loader and driver, made by debootstrap in the folder ROOT where
               there is none, and renders there; needs root
TEXT
}

say() {
    printf 'portable: %s\n' "$*"
}

fail() {
    printf 'portable: error: %s\n' "$*" >&2
    exit 1
}

# shellcheck source=scripts/apt_mirror.sh
source scripts/apt_mirror.sh

# The newest version of the C library whose symbols may be needed is that of Debian 12. Ubuntu 24.04 has 2.39.
kNewestGlibc=2.36
kPrograms=(glint gallery glint_numerics bench_ordering test_ray_steps engine)
build=$PWD/build/portable
deps=$build/deps
jobs=$(nproc)

# --- Static libraries ------------------------------------------------------------------------------

# These source packages are built in this order, each with its CMake options. Tests, tools and documents are
# left out.
kSources=(
    "fmtlib|-DFMT_TEST=OFF -DFMT_DOC=OFF"
    "mimalloc|-DMI_BUILD_SHARED=OFF -DMI_BUILD_OBJECT=OFF -DMI_BUILD_TESTS=OFF -DMI_INSTALL_TOPLEVEL=ON"
    "meshoptimizer|"
    "pugixml|"
    "imath|-DPYTHON=OFF"
    "openexr|-DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DDOCS=OFF -DINSTALL_DOCS=OFF"
)
# Debian's own static archives are used here, because a shared library of the same name would otherwise be
# found first.
kArchives=(libstb.a libwebp.a libxxhash.a libz.a libzstd.a)

# Fetches and unpacks the source packages in the folder, with separate apt sources and lists, so that this
# machine's own do not change. apt checks the sources as it checks packages.
fetch_sources() {
    local folder=$1 names=()
    private_apt "$folder"
    mirror_stanza deb-src bookworm > "$folder/parts/debian.sources" ||
        fail "found no source of Debian 12's main component to take source packages from"
    apt-get update "${private_apt_options[@]}" > "$folder/apt.log"
    local source
    for source in "${kSources[@]}"; do
        names+=("${source%%|*}")
    done
    (cd "$folder" && apt-get source "${private_apt_options[@]}" --download-only "${names[@]}") >> "$folder/apt.log"
    for source in "${names[@]}"; do
        # apt has verified the checksums of the files, so the uploaders' own keys are not needed here.
        dpkg-source -q --no-check -x "$folder/$source"_*.dsc "$folder/$source" >> "$folder/apt.log" 2>&1
    done
}

copy_archives() {
    local triplet archive
    triplet=$(gcc -dumpmachine)
    for archive in "${kArchives[@]}"; do
        cp "/usr/lib/$triplet/$archive" "$deps/lib/"
    done
}

build_deps() {
    if [[ -e $deps/done ]]; then
        copy_archives
        return
    fi
    say "fetching source packages"
    rm -rf "$deps"
    mkdir -p "$deps/lib" "$deps/source"
    fetch_sources "$deps/source"
    copy_archives
    local source name
    for source in "${kSources[@]}"; do
        name=${source%%|*}
        say "building $name"
        # shellcheck disable=SC2086 # several words
        cmake -S "$deps/source/$name" -B "$deps/source/build-$name" -G Ninja -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_INSTALL_PREFIX="$deps" -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_PREFIX_PATH="$deps" \
            -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF \
            ${source#*|} > "$deps/source/$name.log" 2>&1 || fail "$name: see $deps/source/$name.log"
        cmake --build "$deps/source/build-$name" --parallel "$jobs" --target install >> "$deps/source/$name.log" 2>&1 ||
            fail "$name: see $deps/source/$name.log"
    done
    touch "$deps/done"
}

# --- Checks ----------------------------------------------------------------------------------------

# Returns whether a library belongs to the C library.
is_of_libc() {
    case $1 in
        libc.so.6 | libm.so.6 | libdl.so.2 | libpthread.so.0 | librt.so.1 | ld-linux-*.so.*) return 0 ;;
        *) return 1 ;;
    esac
}

check_program() {
    local program=$1 needed newest
    while read -r needed; do
        # The engine links the Vulkan loader, which the others open themselves.
        is_of_libc "$needed" || [[ $(basename "$program") == engine && $needed == libvulkan.so.1 ]] ||
            fail "$program needs $needed"
    done < <(objdump -p "$program" | sed -n 's/^ *NEEDED *//p')
    newest=$(objdump -T "$program" | sed -n 's/.*(\{0,1\}GLIBC_\([0-9.]*\))\{0,1\}.*/\1/p' | sort -V | tail -n 1)
    [[ -n $newest ]] || fail "$program: found no version of the C library"
    [[ $(printf '%s\n' "$newest" "$kNewestGlibc" | sort -V | tail -n 1) == "$kNewestGlibc" ]] ||
        fail "$program needs version $newest of the C library; $kNewestGlibc is the newest that may be"
    if objdump -T "$program" | grep -q 'GLIBCXX_\|CXXABI_\|GCC_'; then
        fail "$program takes symbols of libstdc++ or libgcc from outside"
    fi
    say "$(basename "$program"): C library $newest, $(objdump -p "$program" | sed -n 's/^ *NEEDED *//p' | paste -sd ' ')"
}

# --- Archive ---------------------------------------------------------------------------------------

# These are Debian's packages of the linked libraries. Their copyright files are included.
kLicensed=(glslang-dev spirv-tools libfmt-dev libmimalloc-dev libmeshoptimizer-dev libpugixml-dev libimath-dev libopenexr-dev
    libtinygltf-dev libstb-dev libdraco-dev libwebp-dev libzstd-dev libxxhash-dev zlib1g-dev libstdc++-12-dev nlohmann-json3-dev
    libcli11-dev libkainjow-mustache-dev libglm-dev libvulkan-dev)

pack() {
    local version name folder program built package
    version=$("$build/bin/glint" --version | sed -n '1s/[^0-9]*\([0-9.]*\).*/\1/p')
    [[ -n $version ]] || fail "glint --version says no version"
    name=glint-$version-linux-$(uname -m)
    folder=$build/pack/$name
    rm -rf "$build/pack"
    mkdir -p "$folder/bin" "$folder/licences" "$folder/example" out
    for program in "${kPrograms[@]}"; do
        built=$build/bin/$program
        if [[ ! -x $built ]]; then
            built=$build/tests/$program
        fi
        strip -o "$folder/bin/$program" "$built"
        check_program "$folder/bin/$program"
    done
    cp README.md LICENSE "$folder/"
    for package in "${kLicensed[@]}"; do
        [[ -r /usr/share/doc/$package/copyright ]] || fail "no licence of $package in /usr/share/doc"
        cp -L "/usr/share/doc/$package/copyright" "$folder/licences/$package.txt"
    done
    cp "$(scripts/fetch_basisu.sh --where)/LICENSE" "$folder/licences/basis-universal.txt"
    "$folder/bin/gallery" "$folder/example" > /dev/null
    "$folder/bin/glint" compile "$folder/example/gallery.gltf" -o "$folder/example/gallery.glint" --strategy all \
        --tracer all --cache none --quiet
    mkdir "$folder/engine"
    cp examples/engine/scene/engine.gltf "$folder/engine/"
    cp -r "$build/examples/engine/glint/engine" "$folder/engine/engine.glint"
    cp -r "$build/examples/engine/shaders" "$folder/engine/shaders"
    archive=out/$name.tar.gz
    tar --create --gzip --file "$archive" --directory "$build/pack" --owner=0 --group=0 --numeric-owner --sort=name "$name"
    say "$archive, $(du -h "$archive" | cut -f 1)"
}

# --- Test ------------------------------------------------------------------------------------------

# Tests the archive in a root that has never had a compiler.
test_in() {
    local root=$1 name
    name=$(basename "$archive" .tar.gz)
    if [[ ! -e $root/usr/bin/apt-get ]]; then
        mirror_stanza deb bookworm > /dev/null || fail "found no source of Debian 12's main component"
        say "making $root"
        debootstrap --variant=minbase bookworm "$root" "$(mirror_stanza deb bookworm | sed -n 's/^URIs: //p')" > /dev/null
        mirror_stanza deb bookworm-backports > "$root/etc/apt/sources.list.d/backports.sources"
        chroot "$root" apt-get update -q > /dev/null
        chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends libvulkan1 > /dev/null
        chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
            -t bookworm-backports mesa-vulkan-drivers > /dev/null
    fi
    rm -rf "${root:?}/$name"
    tar --extract --gzip --file "$archive" --directory "$root"
    say "rendering in $root"
    local strategy
    for strategy in uber hit-shaders; do
        chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp "/$name/bin/glint" render "/$name/example/gallery.gltf" \
            --package "/$name/example/gallery.glint" --strategy "$strategy" --size 96x54 -o "/tmp/$strategy.exr" --quiet
    done
    chroot "$root" env -i PATH=/usr/bin:/bin "/$name/bin/glint" compare /tmp/uber.exr /tmp/hit-shaders.exr --max-error 0.01
    chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp "/$name/bin/glint" render "/$name/example/gallery.gltf" --size 96x54 \
        -o /tmp/compiled.exr --quiet
    local tracer
    for tracer in ray-query ray-pipeline; do
        chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp "/$name/bin/engine" "/$name/engine/engine.gltf" \
            "/$name/engine/engine.glint" "/$name/engine/shaders" /tmp/engine.exr --size 96x54 --tracer "$tracer"
        chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp "/$name/bin/glint" render "/$name/engine/engine.gltf" --size 96x54 \
            --tracer "$tracer" --sky 1 --max-roughness 1 --mirror-roughness 1 -o /tmp/glint.exr --quiet
        chroot "$root" env -i PATH=/usr/bin:/bin "/$name/bin/glint" compare /tmp/engine.exr /tmp/glint.exr --max-error 1e-4
    done
    chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp GLINT_TESTS_UNVALIDATED=1 "/$name/bin/test_ray_steps"
    chroot "$root" sh -c "! command -v cc && ! ls /usr/lib/*/libstdc++.so" > /dev/null || fail "$root has a compiler"
}

# --- Main ------------------------------------------------------------------------------------------

root=
while [[ $# -gt 0 ]]; do
    case $1 in
        --test)
            [[ $# -gt 1 ]] || fail "--test needs a folder"
            root=$2
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

# shellcheck source=/dev/null
[[ $(. /etc/os-release && printf '%s %s' "$ID" "${VERSION_ID:-}") == "debian 12" ]] ||
    fail "this is for Debian 12, whose C library is old enough"
scripts/setup.sh --check --portable || fail "run scripts/setup.sh --portable"
scripts/fetch_basisu.sh || fail "the archive is to read KTX2 textures"
build_deps
say "building glint"
cmake --preset portable > "$build/configure.log"
cmake --build --preset portable --target "${kPrograms[@]}"
pack
if [[ -n $root ]]; then
    test_in "$root"
fi
