#!/usr/bin/env bash
# Measures traversal by the order of triangles and instances, and with Embree, on every scene of a folder. It makes the
# table of docs/performance.md, "Traversal on a CPU driver". It takes some 3 minutes on 2 idle cores.
#   benchmarks/measure_traversal.sh [OUTPUT]      default: out/traversal
# GLINT_MODELS: the folder of scenes (default: ../shared/models). GLINT_BUILD: a configured build folder (default:
# build/release). GLINT_ROUNDS: rounds (default: 7).
set -euo pipefail
cd "$(dirname "$0")/.."

output=${1:-out/traversal}
build=${GLINT_BUILD:-build/release}
if [[ ! -d $build ]]; then
    cmake --preset release > /dev/null
fi
cmake --build "$build" --target bench_traversal glint_gallery_scene
mkdir -p "$output"
models=${GLINT_MODELS:-../shared/models}
mapfile -t scenes < <(find "$models/features" "$models/large" -name '*.gltf' -o -name '*.glb' | sort)
"$build/tests/bench_traversal" --rounds "${GLINT_ROUNDS:-7}" --json "$output/traversal.json" \
    --markdown "$output/traversal.md" "${scenes[@]}" "$build/tests/render/gallery/gallery.gltf"
echo "wrote $output/traversal.json and $output/traversal.md"
