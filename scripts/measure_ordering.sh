#!/usr/bin/env bash
# Measures the orderings of hits: device time of all their passes, by number of hits, of buckets and spread of the hits,
# beside a plain copy. Prints a table in Markdown; options are those of bench_ordering (--help).
#
#   scripts/measure_ordering.sh [OPTIONS]
set -euo pipefail

cd "$(dirname "$0")/.."
bench=build/release/tests/bench_ordering
if [[ ! -x $bench ]]; then
    echo "measure_ordering.sh: build first: cmake --preset release && cmake --build --preset release --target bench_ordering" >&2
    exit 1
fi
exec "$bench" "$@"
