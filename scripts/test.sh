#!/usr/bin/env bash
# Sets up, builds and runs every test. Ends with CTest's summary, how many tests lacked models, and CTest's exit code.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/test.sh [--werror] [--sanitize]

Installs missing packages, builds Glint and runs every test. Files that scripts/demo.sh has built are not built again.

  --werror    treat the compiler's warnings as errors, as continuous integration does; this builds everything again
              if it was built without the option before
  --sanitize  run scripts/sanitize.sh before the tests, which makes a separate build with AddressSanitizer and
              UndefinedBehaviorSanitizer and runs the commands with it; a finding ends the run
TEXT
}

setup=(--browser --window)
sanitize=false
werror=()
for argument in "$@"; do
    case $argument in
        --werror) werror=(-DGLINT_WARNINGS_AS_ERRORS=ON) ;;
        --sanitize)
            setup+=(--sanitize)
            sanitize=true
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
done

scripts/setup.sh "${setup[@]}"
if [[ $sanitize == true ]]; then
    scripts/sanitize.sh --build
    # Some of its commands are single processes, beside which the other build goes on.
    report=$(mktemp)
    scripts/sanitize.sh >"$report" 2>&1 &
    sanitizer=$!
    trap 'kill "$sanitizer" 2>/dev/null || true; rm -f "$report"' EXIT
fi
cmake --preset release "${werror[@]}"
cmake --build --preset release
status=0
if [[ $sanitize == true ]]; then
    wait "$sanitizer" || status=$?
    cat "$report"
    [[ $status -eq 0 ]] || exit "$status"
fi
# Processes wait for files and for the end of others, so one more than there are cores keeps them busy.
ctest --preset release -j "$(($(nproc) + 1))" --output-on-failure --no-tests=error || status=$?
# Skipped tests give their reason in these words (tests/support/models.cpp).
skipped=$(grep -c '^no models: ' build/release/Testing/Temporary/LastTest.log || true)
if [[ $skipped -gt 0 ]]; then
    printf '%s tests were skipped because their models are not there: scripts/models.sh --help\n' "$skipped"
fi
exit "$status"
