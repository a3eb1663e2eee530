#!/usr/bin/env bash
# Measures cost and gain of the march in screen space: error against rays only, rays, pass times. Runs are
# interleaved, so that a busy machine slows all alike. Prints a table in Markdown for each scene: medians with quartiles.
#
#   benchmarks/measure_ssr.sh [RUNS [SCENE...]]     default: 5 runs of the gallery
#
# Environment: GLINT_BIN, the folder of the programs (build/release/bin); GLINT_RENDER_OPTIONS, more of `glint render`.
set -euo pipefail

cd "$(dirname "$0")/.."
runs=${1:-5}
shift || true
bin=${GLINT_BIN:-build/release/bin}
work=out/measure_ssr
if [[ ! -x $bin/glint || ! -x $bin/gallery ]]; then
    echo "measure_ssr.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
rm -rf "$work"
mkdir -p "$work"
if (($# == 0)); then
    "$bin/gallery" "$work/gallery" > /dev/null
    set -- "$work/gallery/gallery.gltf"
fi
read -ra options <<< "${GLINT_RENDER_OPTIONS:-}"
settings=(off 16 64 512)

# Prints median and quartiles of the numbers on stdin.
quartiles() {
    sort -n | awk '{ v[NR] = $1 }
        function at(q, i) { i = 1 + q * (NR - 1); return v[int(i)] + (i - int(i)) * (v[int(i) + (int(i) < NR)] - v[int(i)]) }
        END { printf "%.1f (%.1f to %.1f)", at(0.5), at(0.25), at(0.75) }'
}

# Prints a number from the report of `glint compare`. The beginning of its line identifies it.
field() {
    awk -v name="$1" 'index($0, name) == 1 { sub(name, ""); print $1 }' "$2"
}

for scene in "$@"; do
    name=$(basename "${scene%.*}")
    package=$work/$name.glint
    "$bin/glint" compile "$scene" -o "$package" --strategy uber --merge all --effects shadow,reflection > /dev/null 2>&1
    render() {
        "$bin/glint" render "$scene" --package "$package" --strategy uber --size 320x180 "${options[@]}" "$@" 2> /dev/null
    }
    render -o "$work/$name-other.exr" --spp 64 --seed 1 > /dev/null
    for ssr in "${settings[@]}"; do
        render -o "$work/$name-$ssr.exr" --spp 64 --ssr "$ssr" --coverage "$work/$name-$ssr-coverage.png" > "$work/$name-$ssr.txt"
    done
    for ((run = 0; run < runs; ++run)); do
        for ssr in "${settings[@]}"; do
            render -o "$work/time.exr" --spp 3 --ssr "$ssr" |
                awk -v prefix="$work/$name-$ssr" '/^reflection rays/ { print $NF >> (prefix "-march.ms") }
                    /^uber/ { print $NF >> (prefix "-uber.ms") }'
        done
        for ssr in "${settings[@]}"; do
            paste "$work/$name-$ssr-march.ms" "$work/$name-$ssr-uber.ms" | awk '{ print $1 + $2 }' > "$work/$name-$ssr-sum.ms"
        done
    done
    echo
    echo "$name, 320 × 180, 64 samples; times: the last of 3 samples, median (quartiles) of $runs runs"
    echo
    echo "| \`--ssr\` | rays | found in screen space | RMSE | mean error | largest | march and list, ms | uber, ms | both, ms |"
    echo "|---|---|---|---|---|---|---|---|---|"
    row() {
        "$bin/glint" compare "$2" "$work/$name-off.exr" > "$work/compare.txt"
        printf '| %s | %s | %s | %s | %s | %s |' "$1" "$3" "$4" "$(field RMSE "$work/compare.txt")" \
            "$(field mean "$work/compare.txt")" "$(field 'largest error' "$work/compare.txt")"
    }
    for ssr in "${settings[@]}"; do
        rays=$(awk '$1 == "reflection" && $3 == "rays:" { print $2 }' "$work/$name-$ssr.txt")
        found=$(awk '$1 == "reflection" { for (i = 2; i < NF; ++i) if ($(i + 1) == "found") print $i }' "$work/$name-$ssr.txt")
        row "$ssr" "$work/$name-$ssr.exr" "$rays" "$found"
        for pass in march uber sum; do
            printf ' %s |' "$(quartiles < "$work/$name-$ssr-$pass.ms")"
        done
        echo
    done
    row "off, another seed" "$work/$name-other.exr" "" ""
    echo " | | |"
done
