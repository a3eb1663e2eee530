#!/usr/bin/env bash
# Compares the effects on the device with the oracle in double precision and writes the table of docs/effects_accuracy.md.
# Fails if one of them disagrees. Build first.
#
#   benchmarks/effects_accuracy.sh [FACTOR]   FACTOR times the samples of the tests, 1 if it is not given
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=build/release/tests/test_oracle_effects
table=build/release/tests/effects_accuracy.md
document=docs/effects_accuracy.md
if [[ ! -x $program ]]; then
    echo "effects_accuracy.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
if [[ $# -gt 1 || ! ${1:-1} =~ ^[1-9][0-9]*$ ]]; then
    echo "usage: benchmarks/effects_accuracy.sh [FACTOR]" >&2
    exit 2
fi
GLINT_ORACLE_SAMPLES=${1:-1} "$program"

updated=$(mktemp)
trap 'rm -f "$updated"' EXIT
awk -v table="$table" '
    /^<!-- end effects -->$/ { inside = 0; ends++ }
    !inside { print }
    /^<!-- begin effects -->$/ {
        inside = 1
        begins++
        while ((getline line < table) > 0) { print line }
    }
    END { exit !(begins == 1 && ends == 1) }
' "$document" >"$updated" || {
    echo "effects_accuracy.sh: $document lacks the lines that the table goes between" >&2
    exit 1
}
cat "$updated" >"$document"
