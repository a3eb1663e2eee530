#!/usr/bin/env bash
# How much of Glint's own code the inputs of the fuzz targets reach.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/fuzz_coverage.sh [TARGET…]

Builds the replays of tests/fuzz for gcov in build/coverage, runs each over its inputs (those of tests/fuzz/corpus, and
those that scripts/fuzz.sh found in build/fuzz/corpus), and prints a Markdown table: lines that were run, out of those
of the source files of which any was; then the files, in build/coverage/TARGET.txt.
TEXT
}

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
    usage
    exit 0
fi
targets=("$@")
if [[ ${#targets[@]} -eq 0 ]]; then
    targets=(gltf_json gltf_glb package manifest lock lint profile cache image)
fi

build=build/coverage
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DGLINT_BUILD_EXAMPLES=OFF \
    "-DCMAKE_CXX_FLAGS=--coverage -O0 -g0" >/dev/null
cmake --build "$build" --target "${targets[@]/#/fuzz_}" >&2

# lines_of TARGET: "FILE RUN ALL" for each source file of the tool and the runtime that was reached.
lines_of() {
    find "$build" -name '*.gcda' -delete
    local folders=("tests/fuzz/corpus/$1")
    [[ -d build/fuzz/corpus/$1 ]] && folders+=("build/fuzz/corpus/$1")
    "$build/tests/fuzz_$1" "${folders[@]}" >/dev/null
    find "$build/tool" "$build/runtime" -name '*.gcda' -print0 | xargs -0 gcov -n 2>/dev/null |
        awk -F "'" -v root="$PWD/" '
            /^File / { file = index($2, root) == 1 ? substr($2, length(root) + 1) : "" }
            /^Lines executed:/ && file ~ /^(tool|runtime\/src)\/.*\.cpp$/ {
                split($0, parts, /[:% ]+/)
                run = parts[3] * parts[5] / 100
                if (run >= 0.5) printf "%s %.0f %d\n", file, run, parts[5]
            }
            /^Lines executed:/ { file = "" }' | sort
}

printf '| target | inputs | files | lines run | of |\n|---|---|---|---|---|\n'
for name in "${targets[@]}"; do
    lines_of "$name" >"$build/$name.txt"
    inputs=$(find "tests/fuzz/corpus/$name" "build/fuzz/corpus/$name" -type f 2>/dev/null | wc -l)
    awk -v name="$name" -v inputs="$inputs" '
        { run += $2; all += $3 }
        END { printf "| %s | %d | %d | %d (%.0f %%) | %d |\n", name, inputs, NR, run, all ? 100 * run / all : 0, all }
    ' "$build/$name.txt"
done
