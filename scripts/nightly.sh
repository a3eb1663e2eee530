#!/usr/bin/env bash
# Runs what takes too long for every change: all combinations of settings, every command with sanitizers over every
# scene, all materials against the specification, the comparison with a viewer that others wrote, clang-tidy, the
# tests on Debian 13, and fuzzing up to a number of executions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/nightly.sh [PART…]

Sets up, builds, and runs all parts, or those that are named:

  sweep     the tests that look at GLINT_NIGHTLY, with all that scripts/test.sh leaves out:
            test_combinations with every strategy, tracer, merge policy, placement of
            shadows, ordering and binning, where scripts/test.sh takes every pair of values;
            other tests of pictures with each strategy and each tracer, where scripts/test.sh
            gives each strategy one tracer, and with rooms of all lobes; test_strategies_agree
            with every merge policy for every scene; test_half and test_library with the gallery;
            convergence with every kind of light; a scene at every decade of place and scale; the
            orderings with more numbers of buckets and other subgroup sizes; 10,000 random scenes,
            others each day, with every strategy; twice to three times as many materials in
            test_furnace and test_sampling; a fault at every call that writes; four times as many
            damaged files; the runtime as a subdirectory of another project, built and run. All
            with lavapipe's LLVM passes, which scripts/test.sh leaves out
  timing    the tests that follow files, clocks and a window: ten times by themselves, and ten times
            beside programs that take every core
  sanitize  scripts/sanitize.sh --all, and --threads
  spec      every material of tests/oracle/spec against the glTF specification, from six
            views, where scripts/test.sh compares a short list from three; writes
            out/specification.json and out/specification.md
  proofs    scripts/proofs.sh --nightly: claims about the shaders' functions on intervals, with a
            hundred times as many boxes as the table of docs/numerics.md
  viewer    scripts/viewer_compare.sh, which is left out without Chromium, npm or network
  lint      scripts/lint.sh
  debian    scripts/debian_root.sh: the README's first command in a fresh root of Debian 12,
            below build/debian12, and every test with the newer compiler and libraries of
            Debian 13, below build/debian13; needs root
  fuzz      scripts/fuzz.sh --executions 10000000
TEXT
}

parts=("$@")
if [[ ${#parts[@]} -eq 0 ]]; then
    parts=(sweep timing sanitize spec proofs viewer lint debian fuzz)
fi
for part in "${parts[@]}"; do
    case $part in
        sweep | timing | sanitize | spec | proofs | viewer | lint | debian | fuzz) ;;
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

# build TARGET…: in the preset release.
build() {
    cmake --preset release >/dev/null
    cmake --build --preset release --target "$@"
}

# Repeats the tests whose faults would depend on how fast the machine is.
repeat_timed() {
    local suites='Watching|InputWatching|Incremental|Lock|LockRender|Store|PipelineCacheFolder|BackgroundPipelines'
    suites+='|Background|WindowTest|Install\.RebuildsWhatChanged\..*'
    ctest --preset release -R "^($suites)\$" --repeat until-fail:10 --output-on-failure --no-tests=error
}

scripts/setup.sh --sanitize
for part in "${parts[@]}"; do
    case $part in
        sweep)
            whole=(test_combinations test_strategies_agree test_half test_library test_live_edit test_emissive_lights
                test_opacity test_ordering test_furnace test_sampling test_cli_robustness test_cli_build test_paths
                test_convergence test_effects test_shadow_through test_packs test_sky_light test_sized_lights
                test_random_scenes test_narrow_frame test_layers test_views test_oracle_effects test_oracle_scenes
                gltf_fuzz_test)
            build "${whole[@]}" glint
            for program in "${whole[@]}"; do
                GLINT_NIGHTLY=1 GLINT_RANDOM_FIRST="$(date +%Y%m%d)0000" "build/release/tests/$program"
            done
            GLINT_NIGHTLY=1 ctest --preset release -R '^Install\.' --output-on-failure
            for bits in 128 512; do
                LP_NATIVE_VECTOR_WIDTH=$bits GLINT_NIGHTLY=1 build/release/tests/test_ordering --gtest_filter='Buckets/*'
            done
            ;;
        timing)
            cmake --preset release >/dev/null
            cmake --build --preset release
            repeat_timed
            load=()
            for ((core = 0; core < $(nproc); ++core)); do
                (while :; do :; done) &
                load+=("$!")
            done
            trap 'kill "${load[@]}"' EXIT
            repeat_timed
            kill "${load[@]}"
            trap - EXIT
            ;;
        sanitize)
            scripts/sanitize.sh --all
            scripts/sanitize.sh --threads
            ;;
        spec)
            build glint_spec_oracle
            mkdir -p out
            build/release/bin/glint_spec_oracle --many-views --samples 64 --map-width 512 --points 96 \
                --json out/specification.json --markdown out/specification.md
            ;;
        proofs)
            build glint_proofs
            scripts/proofs.sh --nightly
            ;;
        viewer)
            scripts/setup.sh --viewer || true
            build glint
            scripts/viewer_compare.sh
            ;;
        lint) scripts/lint.sh ;;
        debian)
            if [[ $(id -u) -eq 0 ]]; then
                rm -rf build/debian12
                scripts/debian_root.sh 12 build/debian12 scripts/demo.sh
                scripts/debian_root.sh 13 build/debian13
            else
                printf 'nightly: debian is left out: it needs root\n'
            fi
            ;;
        fuzz) scripts/fuzz.sh --executions 10000000 ;;
    esac
done
