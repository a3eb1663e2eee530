#!/usr/bin/env bash
# Renders every scene of a folder twice, with its triangles and instances in the order of the file and in the driver's.
# Reports the scenes whose pictures differ by a bit, and exits with 1 if there are any.
#   benchmarks/compare_traversal.sh [SCENE...]      default: all of GLINT_MODELS, else of ../shared/models
# All effects are on, so that rays of each kind are compared. GLINT: the program (default: build/release/bin/glint).
# GLINT_RENDER: more options of `glint render`.
set -euo pipefail
cd "$(dirname "$0")/.."

glint=${GLINT:-build/release/bin/glint}
read -ra more <<< "${GLINT_RENDER:---size 160x90 --spp 1}"
scenes=("$@")
if [[ ${#scenes[@]} -eq 0 ]]; then
    models=${GLINT_MODELS:-../shared/models}
    mapfile -t scenes < <(find "$models/features" "$models/large" -name '*.gltf' -o -name '*.glb' | sort)
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
different=0
for scene in "${scenes[@]}"; do
    name=$(basename "$(dirname "$scene")")/$(basename "$scene")
    if ! "$glint" compile "$scene" -o "$folder/package" --strategy visibility --effects all > "$folder/log" 2>&1; then
        echo "$name: left out: $(tail -n 1 "$folder/log")"
        continue
    fi
    for order in input halving; do
        "$glint" render "$scene" -o "$folder/$order.exr" --package "$folder/package" --traversal-order "$order" \
            "${more[@]}" > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
    done
    if "$glint" compare "$folder/halving.exr" "$folder/input.exr" --max-error 0 > "$folder/log" 2>&1; then
        echo "$name: equal"
    else
        echo "$name: different"
        cat "$folder/log"
        different=1
    fi
done
exit "$different"
