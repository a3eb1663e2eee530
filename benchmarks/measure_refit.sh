#!/usr/bin/env bash
# Measures device times of an animated scene's updates, with BLASes and TLAS always refitted, always rebuilt, or by
# rule, and of the frames traced afterwards. Runs are interleaved, so that a busy machine slows all alike. Prints
# Markdown: medians with quartiles over all frames but the first, in ms, and ratios of refits to rebuilds in each frame.
#
#   benchmarks/measure_refit.sh SCENE.gltf|.glb [RUNS [FRAMES [FPS]]]     default 5 runs of frames 0:24, 8 a second
set -euo pipefail

cd "$(dirname "$0")/.."
if [[ $# -lt 1 ]]; then
    sed -n '6p' "$0" >&2
    exit 2
fi
scene=$1
runs=${2:-5}
frames=${3:-0:24}
fps=${4:-8}
glint=build/release/bin/glint
work=out/measure-refit
if [[ ! -x $glint ]]; then
    echo "measure_refit.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
rm -rf "$work"
mkdir -p "$work"
"$glint" compile "$scene" -o "$work/package" > /dev/null 2>&1
for ((run = 0; run < runs; ++run)); do
    for refit in always never auto; do
        "$glint" render "$scene" -o "$work/image.exr" --package "$work/package" --size 320x180 --max-roughness 1 \
            --frames "$frames" --fps "$fps" --refit "$refit" --stats "$work/$refit-$run.json" > /dev/null 2>&1
    done
done

python3 - "$work" "$runs" "$(basename "$scene")" << 'EOF'
import json
import statistics
import sys

work, runs, name = sys.argv[1], int(sys.argv[2]), sys.argv[3]


def load(refit, run):
    with open(f"{work}/{refit}-{run}.json") as file:
        return json.load(file)["frames"][1:]


def spread(values, digits):
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return f"{middle:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


data = {refit: [load(refit, run) for run in range(runs)] for refit in ("always", "never", "auto")}
print(f"{name}, 320 x 180, {len(data['auto'][0])} frames, {runs} runs\n")
print("| `--refit` | BLASes built anew | TLAS built anew | deform | BLASes | TLAS | passes |")
print("|---|---|---|---|---|---|---|")
for refit, rounds in data.items():
    frames = [frame for frames in rounds for frame in frames]
    rebuilt = sum(frame["rebuilds"] for frame in rounds[0])
    touched = rebuilt + sum(frame["refits"] for frame in rounds[0])
    top = sum(frame["topLevel"] == "rebuilt" for frame in rounds[0])
    cells = [spread([frame[member] for frame in frames], 2 if member == "deviceMs" else 3)
             for member in ("deformMs", "blasMs", "tlasMs", "deviceMs")]
    print(f"| `{refit}` | {rebuilt} of {touched} | {top} of {len(rounds[0])} | " + " | ".join(cells) + " |")
ratios = []
for member in ("blasMs", "tlasMs", "deviceMs"):
    pairs = [(a[member], b[member]) for always, never in zip(data["always"], data["never"])
             for a, b in zip(always, never)]
    ratios.append(spread([a / b for a, b in pairs if b > 0] or [1.0, 1.0], 2))
print("| `always` over `never` | | | | " + " | ".join(ratios) + " |")
EOF
