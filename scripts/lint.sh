#!/usr/bin/env bash
# Checks the formatting of every C++ file, runs clang-tidy over every source, and runs ShellCheck over the scripts.
# usage: scripts/lint.sh [FILE.cpp…]   with files: clang-tidy over those only
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh --lint
clang_format=$(command -v clang-format-14 || command -v clang-format)

printf 'lint: clang-format\n'
git ls-files -z '*.cpp' '*.h' | xargs -0 "$clang_format" --dry-run -Werror

printf 'lint: shellcheck\n'
git ls-files -z '*.sh' .ci/run | xargs -0 -r shellcheck

# tidy BUILD FILE…: runs clang-tidy over sources that have compile commands in BUILD. The counts that
# clang-tidy prints are of warnings in other projects' headers, which it leaves out.
tidy() {
    local build=$1
    shift
    printf '%s\0' "$@" |
        xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$build" --quiet 2>&1 |
        { grep -vE '^[0-9]+ warnings? generated\.$' || true; }
}

# tidy_project FOLDER FILE…: checks a separate project, which is built with the Glint of this build. The
# commands name the standard, because clang-tidy's own default is older than the compiler's.
tidy_project() {
    local folder=$1 build=build/lint/${1//\//-}
    shift
    mkdir -p build/lint/scenes
    cp examples/cmake-consumer/scene/* build/lint/scenes/
    cp build/lint/scenes/cubes.gltf build/lint/scenes/copy.gltf
    cmake -S "$folder" -B "$build" -G Ninja -DGlint_DIR="$PWD/build/tidy" -DSCENES="$PWD/build/lint/scenes" \
        -DCMAKE_CXX_STANDARD=20 -DCMAKE_EXPORT_COMPILE_COMMANDS=ON --no-warn-unused-cli >/dev/null &&
        cmake --build "$build" &&
        tidy "$build" "$@"
}

printf 'lint: clang-tidy\n'
# Each file is compiled by itself, as clang-tidy reads it. This also shows that every file includes what it
# uses. Generated sources must exist before anything that includes them can be read.
cmake --preset release -B build/tidy -DGLINT_UNITY=OFF >/dev/null
cmake --build build/tidy
if [[ $# -gt 0 ]]; then
    sources=("$@")
else
    mapfile -t sources < <(git ls-files '*.cpp')
fi
own=()
programs=()
consumers=()
for source in "${sources[@]}"; do
    if [[ $source == tests/install/consumer/* ]]; then
        consumers+=("$source")
    elif [[ $source == examples/cmake-consumer/* ]]; then
        programs+=("$source")
    elif ! grep -qF "/$source\"" build/tidy/compile_commands.json; then
        printf 'lint: %s: not part of this build, left out\n' "$source"
    else
        own+=("$source")
    fi
done

failed=0
if [[ ${#own[@]} -gt 0 ]]; then
    tidy build/tidy "${own[@]}" || failed=1
fi
if [[ ${#consumers[@]} -gt 0 ]]; then
    tidy_project tests/install/consumer "${consumers[@]}" || failed=1
fi
if [[ ${#programs[@]} -gt 0 ]]; then
    tidy_project examples/cmake-consumer "${programs[@]}" || failed=1
fi
if [[ $failed -ne 0 ]]; then
    printf 'lint: error: clang-tidy has findings, printed above\n' >&2
    exit 1
fi
printf 'lint: clean\n'
