#!/usr/bin/env bash
# Measures the cost of precision for the table of docs/accuracy.md: instructions, time and errors of the shaders'
# functions as in textbooks, as in Glint, in 16 bits and in double precision. Build first. It takes a few minutes on a
# machine that does nothing else.
#
#   benchmarks/ladder.sh                          into docs/accuracy.md, region "ladder", and out/ladder.json
#   benchmarks/ladder.sh --marker NAME [OPTIONS]  into the region NAME and out/NAME.json; OPTIONS of glint_numerics:
#                                              --device PART-OF-NAME, or --from FILE for the JSON of another machine
set -euo pipefail

cd "$(dirname "$0")/.."
program=build/release/bin/glint_numerics
if [[ ! -x $program ]]; then
    echo "ladder.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
marker=ladder
if [[ ${1:-} == --marker && -n ${2:-} ]]; then
    marker=$2
    shift 2
elif [[ $# -gt 0 ]]; then
    echo "usage: benchmarks/ladder.sh [--marker NAME [OPTIONS]]" >&2
    exit 2
fi
mkdir -p out
exec "$program" --ladder --inputs 200000 --rounds 31 --marker "$marker" --report docs/accuracy.md \
    --json "out/$marker.json" "$@"
