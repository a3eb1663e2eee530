#!/usr/bin/env bash
# Proves the claims about the shaders' functions on intervals and writes the table of docs/numerics.md. Fails if one is
# refuted. Build the target glint_proofs first.
#
#   scripts/proofs.sh             2,000 boxes a claim, into docs/numerics.md
#   scripts/proofs.sh --nightly   200,000 boxes a claim, into out/proofs.txt only
set -euo pipefail

cd "$(dirname "$0")/.."
program=build/release/bin/glint_proofs
if [[ ! -x $program ]]; then
    echo "proofs.sh: build first: cmake --preset release && cmake --build --preset release --target glint_proofs" >&2
    exit 1
fi
mkdir -p out
case ${1:-} in
    "") exec "$program" --boxes 2000 --report docs/numerics.md ;;
    --nightly) "$program" --boxes 200000 | tee out/proofs.txt ;;
    *)
        echo "usage: scripts/proofs.sh [--nightly]" >&2
        exit 2
        ;;
esac
