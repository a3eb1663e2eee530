#!/usr/bin/env bash
# Measures which lines of the readers the corpora of the fuzz targets reach.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/fuzz_coverage.sh [--html DIR]

Builds the replays of tests/fuzz with Clang's source coverage (in build/coverage), runs them over tests/fuzz/corpus
and over the inputs of scripts/fuzz.sh in build/fuzz/corpus, and prints a Markdown table: the lines of each reader, and
how many of them ran.

  --html DIR  also write pages that show these lines

Needs Clang: scripts/setup.sh --sanitize.
TEXT
}

html=
if [[ ${1:-} == --html && $# -eq 2 ]]; then
    html=$2
elif [[ $# -gt 0 ]]; then
    usage
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

build=build/coverage
# Clang's coverage tools have the version of the compiler in their names, or are in its folder.
tools=$(dirname "$(readlink -f "$(command -v clang++)")")

cmake --preset fuzz -B "$build" -DCMAKE_BUILD_TYPE=Debug -DGLINT_FUZZ=OFF -DGLINT_SANITIZE=OFF \
    -DCMAKE_CXX_FLAGS="-O0 -fprofile-instr-generate -fcoverage-mapping" >/dev/null
cmake --build "$build" --target glint_fuzzers >&2
mkdir -p "$build/profiles"
rm -f "$build"/profiles/*

programs=()
for folder in tests/fuzz/corpus/*; do
    name=${folder##*/}
    folders=("$folder")
    [[ -d build/fuzz/corpus/$name ]] && folders+=("build/fuzz/corpus/$name")
    LLVM_PROFILE_FILE=$build/profiles/$name.profraw "$build/tests/fuzz_$name" "${folders[@]}" >"$build/$name.log" 2>&1
    programs+=("$build/tests/fuzz_$name")
done
"$tools/llvm-profdata" merge -o "$build/all.profdata" "$build"/profiles/*.profraw

objects=("${programs[0]}")
for program in "${programs[@]:1}"; do
    objects+=(-object "$program")
done

# row NAME FILE…: prints the sum over the files. Lines are counted as llvm-cov counts them.
row() {
    local name=$1
    shift
    "$tools/llvm-cov" export -summary-only -instr-profile "$build/all.profdata" "${objects[@]}" "$@" 2>/dev/null |
        python3 -c '
import json, sys
lines = json.load(sys.stdin)["data"][0]["totals"]["lines"]
print("| {} | {:,} | {:,} | {:.0f} % |".format(sys.argv[1], lines["count"], lines["covered"], lines["percent"]))
' "$name"
}

printf '| reader | lines | reached | |\n|---|---|---|---|\n'
row "\`tool/gltf\`" tool/gltf/*.cpp
row "\`tool/plan/lock*\`" tool/plan/lock*.cpp
row "\`tool/spirv\`: reader, statistics, lint" tool/spirv/{reader,statistics}.cpp tool/spirv/lint*.cpp
row "\`tool/image\`" tool/image/{png,exr,hdr,image_file}.cpp
row "\`tool/cache\`" tool/cache/*.cpp
row "\`tool/inspect\`, \`tool/resolve\`: manifest, profile" tool/inspect/package.cpp tool/resolve/profile.cpp
row "\`tool/base\`: JSON and PNG bounds" tool/base/{json,image_limits}.cpp
row "\`runtime/src/package/\`" runtime/src/package/package*.cpp
if [[ -n $html ]]; then
    "$tools/llvm-cov" show -format=html -output-dir "$html" -instr-profile "$build/all.profdata" "${objects[@]}" \
        tool runtime/src
fi
