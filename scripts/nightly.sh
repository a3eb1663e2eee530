#!/usr/bin/env bash
# Runs what takes too long for every change: all combinations of settings, all materials against the specification,
# clang-tidy, and fuzzing up to a number of executions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/nightly.sh [PART…]

Sets up, builds, and runs all parts, or those that are named:

  sweep   test_combinations with every strategy, tracer, merge policy, placement of
          shadows, ordering and binning, where scripts/test.sh takes every pair of values
  spec    every material of tests/oracle/spec against the glTF specification, from six
          views, where scripts/test.sh compares a short list from three; writes
          out/specification.json and out/specification.md
  lint    scripts/lint.sh
  fuzz    scripts/fuzz.sh --executions 10000000
TEXT
}

parts=("$@")
if [[ ${#parts[@]} -eq 0 ]]; then
    parts=(sweep spec lint fuzz)
fi
for part in "${parts[@]}"; do
    case $part in
        sweep | spec | lint | fuzz) ;;
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

scripts/setup.sh --sanitize
for part in "${parts[@]}"; do
    case $part in
        sweep)
            cmake --preset release >/dev/null
            cmake --build --preset release --target test_combinations
            GLINT_NIGHTLY=1 build/release/tests/test_combinations
            ;;
        spec)
            cmake --preset release >/dev/null
            cmake --build --preset release --target glint_spec_oracle
            mkdir -p out
            build/release/bin/glint_spec_oracle --many-views --samples 64 --map-width 512 --points 96 \
                --json out/specification.json --markdown out/specification.md
            ;;
        lint) scripts/lint.sh ;;
        fuzz) scripts/fuzz.sh --executions 10000000 ;;
    esac
done
