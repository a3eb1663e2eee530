#!/usr/bin/env bash
# Measures pass times of every strategy with every tracer on the gallery and, if given, on another scene. Every surface
# sends its ray, whatever its roughness. Runs are interleaved, so that a busy machine slows all alike. Prints Markdown:
# medians with quartiles in milliseconds, and the ratio of each total to that of uber with ray queries in the same round.
#
#   benchmarks/measure_strategies.sh [RUNS [SCENE.gltf|.glb]]     default 5, the gallery alone
set -euo pipefail

cd "$(dirname "$0")/.."
runs=${1:-5}
other=${2:-}
bin=build/release/bin
work=out/measure-strategies
if [[ ! -x $bin/glint || ! -x $bin/gallery ]]; then
    echo "measure_strategies.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
rm -rf "$work"
mkdir -p "$work"
"$bin/gallery" "$work/gallery" > /dev/null

ways=("uber ray-query" "visibility ray-query" "sorted-uber ray-query" "uber ray-pipeline" "visibility ray-pipeline"
    "sorted-uber ray-pipeline" "hit-shaders ray-pipeline")

# Prints median and quartiles of the numbers on stdin.
quartiles() {
    sort -n | awk '{ v[NR] = $1 }
        function at(q, i) { i = 1 + q * (NR - 1); return v[int(i)] + (i - int(i)) * (v[int(i) + (int(i) < NR)] - v[int(i)]) }
        END { printf "%.2f (%.2f to %.2f)", at(0.5), at(0.25), at(0.75) }'
}

# Runs once, and adds a line to the file of each group of passes.
render() {
    local name=$1 scene=$2 strategy=$3 tracer=$4
    local stem=$work/$name-$strategy-$tracer
    if [[ ! -d $work/$name.glint ]]; then
        "$bin/glint" compile "$scene" -o "$work/$name.glint" --strategy all --tracer all --merge family \
            --effects shadow,reflection > /dev/null
    fi
    "$bin/glint" render "$scene" -o "$work/image.exr" --package "$work/$name.glint" --strategy "$strategy" \
        --tracer "$tracer" --size 320x180 --spp 3 --max-roughness 1 2> /dev/null |
        awk -v stem="$stem" '/^pass of the last sample/ { on = 1; next }
            on && NF > 1 { ms = $NF; $NF = ""; sub(/ +$/, ""); all += ms
                group = "shade"
                if (/^(gbuffer|first .*|compose)$/) group = "primary"
                else if (/^reflection rays/ || /^ray dispatch/) group = "list"
                else if (/^(count|offset|copy)$/) group = "order"
                else if (/^trace/) group = "trace"
                sum[group] += ms }
            END { for (g in sum) print sum[g] >> (stem "-" g ".txt"); print all >> (stem "-all.txt") }'
}

scenes=("gallery $work/gallery/gallery.gltf")
if [[ -n $other ]]; then
    scenes+=("$(basename "${other%.*}") $other")
fi
for ((run = 0; run < runs; ++run)); do
    for scene in "${scenes[@]}"; do
        for way in "${ways[@]}"; do
            # shellcheck disable=SC2086
            render ${scene} ${way}
        done
    done
done

for scene in "${scenes[@]}"; do
    name=${scene%% *}
    base=$work/$name-uber-ray-query-all.txt
    echo "$name, 320 x 180, --merge family, $runs runs"
    echo
    echo "| strategy | tracer | primary | list | trace | order | shade | all | over uber |"
    echo "|---|---|---|---|---|---|---|---|---|"
    for way in "${ways[@]}"; do
        stem=$work/$name-${way/ /-}
        row="| \`${way% *}\` | ${way#* } |"
        for group in primary list trace order shade all; do
            if [[ -f $stem-$group.txt ]]; then
                row+=" $(quartiles < "$stem-$group.txt") |"
            else
                row+=" |"
            fi
        done
        row+=" $(paste "$stem-all.txt" "$base" | awk '{ print $1 / $2 }' | quartiles) |"
        echo "$row"
    done
    echo
done
