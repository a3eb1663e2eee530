#!/usr/bin/env bash
# Runs what takes too long for every change: all combinations of settings, clang-tidy, fuzzing up to a number of
# executions, and the comparison with a viewer that others wrote.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/nightly.sh [PART…]

Sets up, builds, and runs all parts, or those that are named:

  sweep   test_combinations with every strategy, tracer, merge policy, placement of
          shadows, ordering and binning, where scripts/test.sh takes every pair of values
  lint    scripts/lint.sh
  fuzz    scripts/fuzz.sh --executions 10000000
  viewer  scripts/viewer_compare.sh, which is left out without Chromium, npm or network
TEXT
}

parts=("$@")
if [[ ${#parts[@]} -eq 0 ]]; then
    parts=(sweep lint fuzz viewer)
fi
for part in "${parts[@]}"; do
    case $part in
        sweep | lint | fuzz | viewer) ;;
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
        lint) scripts/lint.sh ;;
        fuzz) scripts/fuzz.sh --executions 10000000 ;;
        viewer)
            scripts/setup.sh --viewer || true
            cmake --preset release >/dev/null
            cmake --build --preset release --target glint
            scripts/viewer_compare.sh
            ;;
    esac
done
