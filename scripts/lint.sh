#!/usr/bin/env bash
# Checks the formatting of every C++ file, runs clang-tidy over every source, and ShellCheck over the scripts.
# usage: scripts/lint.sh [FILE.cpp…]   with files: clang-tidy over those only
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh --lint
clang_format=$(command -v clang-format-14 || command -v clang-format)

printf 'lint: clang-format\n'
git ls-files -z '*.cpp' '*.h' | xargs -0 "$clang_format" --dry-run -Werror

printf 'lint: shellcheck\n'
git ls-files -z '*.sh' .ci/run | xargs -0 -r shellcheck

printf 'lint: clang-tidy\n'
cmake --preset release >/dev/null
# Generated sources must be there before anything that includes them can be read.
cmake --build --preset release
if [[ $# -gt 0 ]]; then
    sources=("$@")
else
    mapfile -t sources < <(git ls-files '*.cpp')
fi
printf '%s\0' "${sources[@]}" |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/release --quiet
printf 'lint: clean\n'
