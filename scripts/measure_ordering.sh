#!/usr/bin/env bash
# Measures the orderings of hits: device time of counting and copying, by number of buckets and spread of the hits. Prints
# the table of docs/reflections.md.
#
#   scripts/measure_ordering.sh [ROUNDS [RAYS]]     default 31 and 57600
set -euo pipefail

cd "$(dirname "$0")/.."
bench=build/release/tests/bench_ordering
if [[ ! -x $bench ]]; then
    echo "measure_ordering.sh: build first: cmake --preset release && cmake --build --preset release --target bench_ordering" >&2
    exit 1
fi
exec "$bench" "${1:-31}" "${2:-57600}"
