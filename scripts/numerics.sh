#!/usr/bin/env bash
# Measures the error of the shaders' functions and writes the table of docs/numerics.md. Fails if one is out of its
# bounds. Build first.
#
#   scripts/numerics.sh             200,000 inputs a function, into docs/numerics.md and out/numerics.json
#   scripts/numerics.sh --nightly   10,000,000 inputs a function, into out/ only
set -euo pipefail

cd "$(dirname "$0")/.."
program=build/release/bin/glint_numerics
if [[ ! -x $program ]]; then
    echo "numerics.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
mkdir -p out
case ${1:-} in
    "") exec "$program" --inputs 200000 --report docs/numerics.md --json out/numerics.json ;;
    --nightly) exec "$program" --inputs 10000000 --json out/numerics.json ;;
    *)
        echo "usage: scripts/numerics.sh [--nightly]" >&2
        exit 2
        ;;
esac
