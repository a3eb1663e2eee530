#!/usr/bin/env bash
# Compares merge policies on every scene, and the naive switch with Glint's result: SPIR-V, compile time, pipeline
# creation, render time. The scenes are the gallery, a synthetic one of 48 keys, and all below the FOLDERs. Policies of a
# scene are interleaved, so that a busy machine slows all alike. Prints Markdown. Needs python3-xxhash.
#
#   benchmarks/measure_merge.sh [RUNS [FOLDER…]]     default 2, and those of scripts/models.sh that exist
set -euo pipefail

cd "$(dirname "$0")/.."
bin=build/release/bin
work=out/measure-merge
if [[ ! -x $bin/glint || ! -x $bin/gallery ]]; then
    echo "measure_merge.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
runs=${1:-2}
shift || true
folders=("$@")
if [[ ${#folders[@]} -eq 0 ]]; then
    models=${GLINT_MODELS:-../shared/models}
    for folder in "$models/features" "$models/large"; do
        if [[ -d $folder ]]; then
            folders+=("$folder")
        fi
    done
fi
rm -rf "$work"
mkdir -p "$work"
"$bin/gallery" "$work/gallery" > /dev/null
scenes=("$work/gallery/gallery.gltf" "$work/synthetic.gltf")
if [[ ${#folders[@]} -gt 0 ]]; then
    while IFS= read -r scene; do
        scenes+=("$scene")
    done < <(find "${folders[@]}" -name '*.gltf' -o -name '*.glb' | sort)
fi
# A distribution's own Python has the modules that the distribution installs.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
exec "$python" -B benchmarks/measure_merge.py --glint "$bin/glint" --work "$work" --runs "$runs" "${scenes[@]}"
