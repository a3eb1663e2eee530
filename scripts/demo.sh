#!/usr/bin/env bash
# Builds Glint, compiles the example scene for both strategies, renders it with each, and compares the two.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out=out/demo
bin=build/release/bin
scene=$out/gallery/gallery.gltf
strategies=(uber visibility)

step() {
    printf '\n== %s\n' "$*"
}

step "set-up and build"
scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target glint glint_gallery

step "example scene"
mkdir -p "$out"
"$bin/gallery" "$out/gallery"

for strategy in "${strategies[@]}"; do
    step "compile and render: $strategy"
    "$bin/glint" compile "$scene" -o "$out/package-$strategy" --strategy "$strategy" --json \
        >"$out/compile-$strategy.json"
    "$bin/glint" render "$scene" --strategy "$strategy" -o "$out/gallery-$strategy.png" \
        --size 960x540 --spp 4 --exposure 0 --stats "$out/stats-$strategy.json"
done

step "table"
cmake -DFOLDER="$out" -P scripts/demo_table.cmake | tee "$out/table.txt"

step "difference of the two pictures"
"$bin/glint" compare "$out/gallery-uber.png" "$out/gallery-visibility.png" | tee "$out/compare.txt"

step "where things are"
printf '  scene     %s\n' "$PWD/$scene"
for strategy in "${strategies[@]}"; do
    printf '  picture   %s\n' "$PWD/$out/gallery-$strategy.png"
    printf '  package   %s\n' "$PWD/$out/package-$strategy"
    printf '  numbers   %s\n' "$PWD/$out/compile-$strategy.json" "$PWD/$out/stats-$strategy.json"
done
printf '  table     %s\n' "$PWD/$out/table.txt"
printf '  compare   %s\n' "$PWD/$out/compare.txt"
