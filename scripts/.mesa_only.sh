#!/usr/bin/env bash
# Compiles the shaders of three packages with Mesa's compilers for GPUs that are not here, and writes what the drivers
# say of them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/gpu_compilers.sh [--label NAME] [--gpu NAME]… [--glint PROGRAM] [--packages FOLDER] [--keep]
       scripts/gpu_compilers.sh --tables

Makes the pipelines of three packages (the gallery, SheenChair, 64 synthetic cases) as
Radeon RX 6800 (navi21), RX 7900 (navi31) and RX 9060 (gfx1200), Adreno 740 and 750
(a740, a750) and Arc A-series (dg2) would. Nothing runs, and no GPU is needed: RADV has a
null device, and Mesa's DRM shims stand in for the kernel's drivers of Adreno and Intel.
Writes benchmarks/data/gpu_compilers/NAME.csv, and from all files there the tables of
docs/gpu_compilers.md.

RADV and Intel's driver are those of the installed Mesa. Adreno's driver and the shims are
built from Mesa's source package, which comes by apt from the mirror that this machine
already uses (60 MB, some 12 minutes of processor time, below build/gpu_compilers). It
needs meson, ninja, flex, bison, python3-mako, python3-yaml, libdrm-dev, zlib1g-dev,
libzstd-dev and libexpat1-dev.

  --label NAME       the name of the measurement (default: after)
  --gpu NAME         measure this one alone; may be repeated (default: all six)
  --glint PROGRAM    the program that measures (default: build/release/bin/glint)
  --packages FOLDER  measure the packages in its folders gallery, sheenchair and cases64,
                     and compile none (default: build/gpu_compilers/packages)
  --keep             keep the reports of earlier runs, and make the others
  --tables           only write the tables
TEXT
}

say() {
    printf 'gpu_compilers: %s\n' "$*"
}

# apt_mirror.sh also expects this function.
fail() {
    printf 'gpu_compilers: error: %s\n' "$*" >&2
    exit 1
}

# shellcheck source=scripts/apt_mirror.sh
source scripts/apt_mirror.sh

work=$PWD/build/gpu_compilers
mesa_build=$work/mesa/build
all_gpus=(navi21 navi31 gfx1200 a740 a750 dg2)
all_packages=(gallery sheenchair cases64)

# --- Mesa ------------------------------------------------------------------------------------------

# Downloads the source package of the installed Mesa. apt checks the hash of each file that it keeps. Only the
# archive of the developers of Mesa is needed, and mirrors may have dropped the rest of an older version.
fetch_mesa() {
    local version codename suite folder=$work/mesa/apt
    version=$(dpkg-query -W -f '${source:Version}' mesa-vulkan-drivers) || fail "mesa-vulkan-drivers is not installed"
    # shellcheck source=/dev/null
    codename=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
    for suite in "$codename-backports" "$codename-updates" "$codename"; do
        rm -rf "$folder"
        private_apt "$folder"
        mirror_stanza deb-src "$suite" >"$folder/parts/source.sources" ||
            fail "found no source of this release's own packages to take the mirror from"
        apt-get update "${private_apt_options[@]}" >"$folder/apt.log" 2>&1 || continue
        (cd "$work/mesa" && apt-get source "${private_apt_options[@]}" --download-only --only-source "mesa=$version") \
            >>"$folder/apt.log" 2>&1 || true
        if compgen -G "$work/mesa/mesa_${version%-*}.orig.tar.*" >/dev/null; then
            return
        fi
    done
    fail "apt can't fetch the source package mesa $version; $folder/apt.log says why"
}

# The shim of Mesa 25.0 does not know a parameter that Adreno's driver asks for. Adreno 750 has no ray queries then.
patch_shim() {
    patch --silent --forward -p1 <<'PATCH'
--- a/src/freedreno/drm-shim/freedreno_noop.c
+++ b/src/freedreno/drm-shim/freedreno_noop.c
@@ -109,5 +109,8 @@
    case MSM_PARAM_MAX_FREQ:
       gp->value = 1000000;
       return 0;
+   case MSM_PARAM_RAYTRACING:
+      gp->value = 1;
+      return 0;
    case MSM_PARAM_TIMESTAMP:
       gp->value = 0;
PATCH
}

# Assertions stay on, so that Mesa checks its own intermediate code after each pass.
build_mesa() {
    local archive program targets=(src/freedreno/vulkan/libvulkan_freedreno.so
        src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so src/intel/tools/libintel_noop_drm_shim.so)
    if [[ -e $mesa_build/built ]]; then
        return
    fi
    for program in meson ninja flex bison patch; do
        command -v "$program" >/dev/null ||
            fail "$program is not installed; on Debian 12, meson and libdrm-dev come from bookworm-backports"
    done
    mkdir -p "$work/mesa"
    if ! compgen -G "$work/mesa/mesa_*.orig.tar.*[xg]z" >/dev/null; then
        say "fetching the source of Mesa"
        fetch_mesa
    fi
    if [[ ! -e $work/mesa/source/meson.build ]]; then
        archive=$(compgen -G "$work/mesa/mesa_*.orig.tar.*[xg]z")
        mkdir -p "$work/mesa/source"
        tar --extract --file "$archive" --directory "$work/mesa/source" --strip-components=1 --no-same-owner
        (cd "$work/mesa/source" && patch_shim)
    fi
    say "building Adreno's driver and the shims"
    # The python3 of the distribution has mako.
    if [[ ! -e $mesa_build/build.ninja ]]; then
        PATH=/usr/bin:/bin:$PATH meson setup "$mesa_build" "$work/mesa/source" --wrap-mode=nodownload \
            -Dbuildtype=release -Db_ndebug=false -Dplatforms= -Dvulkan-drivers=freedreno -Dfreedreno-kmds=msm \
            -Dgallium-drivers= -Dtools=drm-shim,intel -Dglx=disabled -Degl=disabled -Dgbm=disabled -Dopengl=false \
            -Dgles1=disabled -Dgles2=disabled -Dllvm=disabled -Dintel-elk=false -Dxmlconfig=disabled \
            -Dvalgrind=disabled -Dlibunwind=disabled -Dvideo-codecs= -Dbuild-tests=false >"$work/mesa/setup.log" ||
            fail "meson can't set up the build; $work/mesa/setup.log says why"
    fi
    PATH=/usr/bin:/bin:$PATH nice ninja -C "$mesa_build" "${targets[@]}"
    cat >"$mesa_build/adreno_icd.json" <<JSON
{"file_format_version": "1.0.0",
 "ICD": {"library_path": "$mesa_build/src/freedreno/vulkan/libvulkan_freedreno.so", "api_version": "1.3.0"}}
JSON
    touch "$mesa_build/built"
}

# --- Packages --------------------------------------------------------------------------------------

# Compiles the packages with every strategy and ray queries.
compile_packages() {
    local models=${GLINT_MODELS:-../shared/models} chair scenes=$work/scenes
    chair=$models/features/SheenChair/SheenChair.gltf
    [[ -e $chair ]] || fail "$chair is not there; set GLINT_MODELS to the folder that scripts/models.sh fills"
    mkdir -p "$scenes" "$packages"
    build/release/bin/gallery "$scenes/gallery" >/dev/null
    python3 -B benchmarks/make_synthetic_scene.py "$scenes/cases64" --materials 64 --keys 64 >/dev/null
    local options=(--strategy all --tracer ray-query)
    "$glint" compile "$scenes/gallery/gallery.gltf" -o "$packages/gallery" "${options[@]}" >/dev/null 2>&1
    "$glint" compile "$chair" -o "$packages/sheenchair" "${options[@]}" >/dev/null 2>&1
    "$glint" compile "$scenes/cases64/scene.gltf" -o "$packages/cases64" "${options[@]}" --merge none >/dev/null 2>&1
}

# --- Reports ---------------------------------------------------------------------------------------

# on_gpu GPU COMMAND…: runs a command so that its only Vulkan device is that GPU.
on_gpu() {
    local gpu=$1 icd=/usr/share/vulkan/icd.d shim=
    local settings=(MESA_SHADER_CACHE_DISABLE=true)
    shift
    case $gpu in
        a[67]*)
            settings+=("VK_DRIVER_FILES=$mesa_build/adreno_icd.json" "FD_GPU_ID=${gpu#a}")
            shim=$mesa_build/src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so
            ;;
        dg2 | bmg | lnl | mtl | tgl | arl)
            settings+=("VK_DRIVER_FILES=$(compgen -G "$icd/intel_icd*.json" | head -n 1)"
                "INTEL_STUB_GPU_PLATFORM=$gpu")
            shim=$mesa_build/src/intel/tools/libintel_noop_drm_shim.so
            ;;
        *)
            settings+=("VK_DRIVER_FILES=$(compgen -G "$icd/radeon_icd*.json" | head -n 1)" "RADV_FORCE_FAMILY=$gpu")
            ;;
    esac
    if [[ -n $shim ]]; then
        # The shim looks functions up in the libraries behind it. They have to come before glint's own allocator, or
        # each calls the other.
        settings+=("LD_PRELOAD=$shim:$(library libc.so.6):$(library libstdc++.so.6)")
    fi
    env "${settings[@]}" "$@"
}

# Prints the path of a library as the loader finds it.
library() {
    ldconfig -p | awk -v name="$1" '$1 == name { print $NF; exit }'
}

# report_of GPU PACKAGE REPORT novalidate=0|1: succeeds if there is a report, also one with pipelines that the driver
# refuses.
report_of() {
    local checks=()
    [[ $4 == novalidate=0 ]] || checks=(NIR_DEBUG=novalidate)
    # The shims print to standard output before the report.
    on_gpu "$1" env "${checks[@]}" "$glint" inspect "$packages/$2" --pipelines --json \
        2>"${3%.json}.log" | sed -n '/^{/,$p' >"$3.part" || true
    grep -q '"format": *"glint-pipelines"' "$3.part" || return 1
    mv "$3.part" "$3"
}

measure() {
    local gpu package report
    mkdir -p "$reports"
    for gpu in "${gpus[@]}"; do
        for package in "${all_packages[@]}"; do
            report=$reports/$gpu.$package.json
            [[ -s $report && $keep == 1 ]] && continue
            say "$gpu: $package"
            rm -f "$reports/$gpu.$package".*
            if ! report_of "$gpu" "$package" "$report" novalidate=0; then
                # Mesa stops where a pass leaves code that its own checks refuse. Its releases do not check.
                touch "${report%.json}.invalid"
                if ! report_of "$gpu" "$package" "$report" novalidate=1; then
                    say "$gpu: $package FAILED; ${report%.json}.log says why"
                    failed=1
                fi
            fi
        done
    done
}

build_mesa
