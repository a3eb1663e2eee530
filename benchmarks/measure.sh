#!/usr/bin/env bash
# Measures what the README states about the gallery: compile time by number of jobs, package size, pass times by strategy.
# Runs are interleaved, so that a busy machine slows both sides alike. Prints medians with quartiles.
#
#   benchmarks/measure.sh [RUNS]     default 11
set -euo pipefail

cd "$(dirname "$0")/.."
runs=${1:-11}
bin=build/release/bin
work=out/measure
if [[ ! -x $bin/glint || ! -x $bin/gallery ]]; then
    echo "measure.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
mkdir -p "$work"
rm -f "$work"/*.txt
"$bin/gallery" "$work/gallery" > /dev/null
scene=$work/gallery/gallery.gltf

# Prints median and quartiles of the numbers on stdin.
quartiles() {
    sort -n | awk '{ v[NR] = $1 }
        function at(q, i) { i = 1 + q * (NR - 1); return v[int(i)] + (i - int(i)) * (v[int(i) + (int(i) < NR)] - v[int(i)]) }
        END { printf "%10.2f  (%.2f to %.2f)", at(0.5), at(0.25), at(0.75) }'
}

for ((run = 0; run < runs; ++run)); do
    for merge in none family all; do
        for jobs in 1 2; do
            "$bin/glint" compile "$scene" -o "$work/package-$merge" --merge "$merge" --jobs "$jobs" --cache none \
                --effects shadow,reflection |
                awk '$1 == "time" { print $2 }' >> "$work/compile-$merge-$jobs.txt"
        done
        paste "$work/compile-$merge-1.txt" "$work/compile-$merge-2.txt" | awk '{ print $1 / $2 }' > "$work/ratio-$merge.txt"
    done
    for strategy in uber visibility; do
        "$bin/glint" render "$scene" -o "$work/$strategy.png" --strategy "$strategy" --merge none --size 640x360 --spp 2 \
            --effects shadow,reflection |
            awk -v prefix="$work/pass-$strategy" '/^pass of the last sample/ { on = 1; next }
                on && NF > 1 { ms = $NF; $NF = ""; sub(/ +$/, ""); total += ms
                    name = /^shade/ && $0 != "shade miss" ? "shade cases" : $0; sum[name] += ms
                    if (!(name in order)) { order[name] = ++n; names[n] = name } }
                END { for (i = 1; i <= n; ++i) { file = prefix "-" sprintf("%02d", i) "-" names[i] ".txt"; print sum[names[i]] >> file }
                    print total >> (prefix "-99-all.txt") }'
    done
done

echo "compile, ms, median (quartiles) of $runs runs"
for merge in none family all; do
    for jobs in 1 2; do
        printf '%-8s jobs %d  %s\n' "$merge" "$jobs" "$(quartiles < "$work/compile-$merge-$jobs.txt")"
    done
    printf '%-8s 1 over 2%s\n' "$merge" "$(quartiles < "$work/ratio-$merge.txt")"
    printf '%-8s bytes   %10d in %d files\n' "$merge" "$(cat "$work/package-$merge"/* | wc -c)" "$(find "$work/package-$merge" -type f | wc -l)"
done
for strategy in uber visibility; do
    echo
    echo "$strategy, merge none, 640 x 360: ms a pass, median (quartiles) of $runs runs"
    for file in "$work/pass-$strategy"-*.txt; do
        name=${file##*/pass-"$strategy"-??-}
        printf '%-16s%s\n' "${name%.txt}" "$(quartiles < "$file")"
    done
done
