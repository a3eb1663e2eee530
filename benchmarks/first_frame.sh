#!/usr/bin/env bash
# Measures how long a scene takes to its first sample, by strategy. It does so without anything from earlier runs, with
# the pipeline cache in its file, and with only the driver's own cache; and with pipelines made by one thread, and by one
# thread for each core. Runs are interleaved, so that a busy machine slows all alike. Prints Markdown: medians with the
# least and the most, in milliseconds of wall clock.
#
#   benchmarks/first_frame.sh [ROUNDS [SCENE.gltf|.glb [STRATEGIES]]]     default 5, the gallery, "uber visibility sorted-uber
#                                                                      hit-shaders"
#
# GLINT: the binary, default build/release/bin/glint. SIZE: size of the picture, default 320x180. PACKAGE: a package of the
# scene with all strategies; by default one is compiled. DEVICE: as for --device.
set -euo pipefail

cd "$(dirname "$0")/.."
rounds=${1:-5}
scene=${2:-}
read -ra strategies <<<"${3:-uber visibility sorted-uber hit-shaders}"
glint=${GLINT:-build/release/bin/glint}
size=${SIZE:-320x180}
work=out/first-frame
if [[ ! $rounds =~ ^[1-9][0-9]*$ ]]; then
    echo "first_frame.sh: \"$rounds\" is no number of rounds" >&2
    exit 2
fi
if [[ ! -x $glint ]]; then
    echo "first_frame.sh: no $glint; build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
rm -rf "$work"
mkdir -p "$work"
if [[ -z $scene ]]; then
    "${glint%/*}/gallery" "$work/gallery" > /dev/null
    scene=$work/gallery/gallery.gltf
fi
package=${PACKAGE:-}
if [[ -z $package ]]; then
    package=$work/package
    "$glint" compile "$scene" -o "$package" --strategy all --tracer all --quiet
fi
options=(--package "$package" --size "$size")
if [[ -n ${DEVICE:-} ]]; then
    options+=(--device "$DEVICE")
fi

# These variables turn off the driver's own shader cache, by NVIDIA's and Mesa's names.
nothing=(__GL_SHADER_DISK_CACHE=0 MESA_SHADER_CACHE_DISABLE=true)
own=(__GL_SHADER_DISK_CACHE=1 "__GL_SHADER_DISK_CACHE_PATH=$PWD/$work/driver" __GL_SHADER_DISK_CACHE_SKIP_CLEANUP=1
    MESA_SHADER_CACHE_DISABLE=false "MESA_SHADER_CACHE_DIR=$PWD/$work/driver")
mkdir -p "$work/driver"

# Runs once and writes the report to FILE.
render() {
    local file=$1 strategy=$2 state=$3 threads=$4
    local variables=("${nothing[@]}") cache=none
    case $state in
        file) cache=$work/file-$strategy ;;
        driver) variables=("${own[@]}") ;;
    esac
    env "${variables[@]}" "$glint" render "$scene" -o "$work/image.exr" "${options[@]}" --strategy "$strategy" \
        --pipeline-cache "$cache" --pipeline-threads "$threads" --json > "$file" 2> "$work/errors.txt" ||
        { cat "$work/errors.txt" "$file" >&2; exit 1; }
}

# Prints the value of a member that occurs once in the report, be it a text or not.
member() {
    sed -n -e "s/^ *\"$1\": \"\(.*\)\",\{0,1\}\$/\1/p" -e "s/^ *\"$1\": \([^\"]*[^\",]\),\{0,1\}\$/\1/p" "$2" | head -n 1
}

for strategy in "${strategies[@]}"; do
    render "$work/fill.json" "$strategy" file 0
    render "$work/fill.json" "$strategy" driver 0
done
kMembers=(pipelineCreationMs rendererMs firstSampleMs totalMs)
for ((round = 0; round < rounds; ++round)); do
    for strategy in "${strategies[@]}"; do
        for state in cold file driver; do
            for threads in 1 0; do
                report=$work/run.json
                render "$report" "$strategy" "$state" "$threads"
                for name in "${kMembers[@]}"; do
                    member "$name" "$report" >> "$work/$strategy-$state-$threads-$name.txt"
                done
                cp "$report" "$work/$strategy-$state-$threads.json"
            done
        done
    done
done

# Prints median, least and most of the numbers in a file.
spread() {
    sort -n "$1" | awk '{ v[NR] = $1 }
        END { m = NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2; printf "%.0f (%.0f to %.0f)", m, v[1], v[NR] }'
}

last=$work/${strategies[0]}-cold-0.json
echo "$(basename "$scene"), $size, $rounds rounds; $(member device "$last"), $(member driver "$last"); $(nproc) cores"
echo
echo "| strategy | kept | threads | pipelines | found in the file | making pipelines, ms | renderer, ms | first sample, ms | from nothing, ms |"
echo "|---|---|---|---|---|---|---|---|---|"
for strategy in "${strategies[@]}"; do
    for state in cold file driver; do
        for threads in 1 0; do
            stem=$work/$strategy-$state-$threads
            case $state in
                cold) kept=nothing ;;
                file) kept="pipeline cache" ;;
                driver) kept="the driver's own" ;;
            esac
            hits="-"
            if [[ $state == file ]]; then
                hits=$(member hits "$stem.json")
                if [[ $hits == null ]]; then
                    hits="not said"
                fi
            fi
            row="| $strategy | $kept | $(member pipelineThreads "$stem.json") | $(member pipelines "$stem.json") | $hits |"
            for name in "${kMembers[@]}"; do
                row+=" $(spread "$stem-$name.txt") |"
            done
            echo "$row"
        done
    done
done
