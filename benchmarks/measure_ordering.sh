#!/usr/bin/env bash
# Measures the orderings of hits: the device time of all their passes, by number of hits, number of buckets and spread of
# the hits. A plain copy is measured for comparison. Prints a table in Markdown. The options are those of bench_ordering
# (--help).
#
#   benchmarks/measure_ordering.sh [OPTIONS]
set -euo pipefail

cd "$(dirname "$0")/.."
bench=build/release/tests/bench_ordering
if [[ ! -x $bench ]]; then
    echo "measure_ordering.sh: build first: cmake --preset release && cmake --build --preset release --target bench_ordering" >&2
    exit 1
fi
exec "$bench" "$@"
