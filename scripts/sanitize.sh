#!/usr/bin/env bash
# Runs the tool and its readers with AddressSanitizer and UndefinedBehaviorSanitizer over every scene and input.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/sanitize.sh

Builds the command and the replays of tests/fuzz with both sanitizers (preset asan) and runs
  - every file of tests/fuzz/corpus through the reader that it was made for, and through the command;
  - compile --strategy all --tracer all, explain, inspect, lint and diff over the example scenes, and over those
    of ../shared/models where they are.
Exit 1 on a report of a sanitizer, and where a command ends in another way than done or with a diagnostic.
TEXT
}

if [[ $# -gt 0 ]]; then
    usage
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

build=build/asan
# Not an exit code of the command: a report shows whatever the command was about to return.
export ASAN_OPTIONS=exitcode=99 UBSAN_OPTIONS=exitcode=99:print_stacktrace=1 LSAN_OPTIONS=exitcode=99
export NO_COLOR=1
models=../shared/models

cmake --preset asan >/dev/null
cmake --build --preset asan --target glint glint_gallery glint_fuzzers
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/failed" "$work/packages"

# check ALLOWED COMMAND…: runs it; keeps what it says where its exit code is none of ALLOWED ("0", "01").
check() {
    local allowed=$1 code=0 log
    shift
    log=$(mktemp "$work/log-XXXXXX")
    "$@" >"$log" 2>&1 || code=$?
    if [[ ${#code} -eq 1 && $allowed == *"$code"* ]]; then
        rm "$log"
    else
        { printf 'sanitize: exit %s: %s\n' "$code" "$*"; tail -n 60 "$log"; } >"$work/failed/${log##*-}"
    fi
}

# check_scene SCENE: all that reads it or its package.
check_scene() {
    local scene=$1 package
    package=$(mktemp -d "$work/packages/XXXXXX")
    check 0 "$build/bin/glint" explain "$scene" --json
    check 0 "$build/bin/glint" compile "$scene" -o "$package/a" --strategy all --tracer all --cache "$work/cache" \
        --emit glsl,header --lock "$package/ids.lock" --depfile "$package/list.d" --embed "$package/embedded.cpp" \
        --jobs 1
    check 0 "$build/bin/glint" compile "$scene" -o "$package/b" --merge all --alpha opaque --jobs 1 \
        --cache "$work/cache"
    check 0 "$build/bin/glint" inspect "$package/a" --json
    check 01 "$build/bin/glint" lint "$package/a" --json
    check 0 "$build/bin/glint" diff "$package/a" "$package/b" --json
    rm -rf "$package"
}

# check_input FILE: a file of tests/fuzz/corpus, by its folder, or a scene that may be invalid.
check_input() {
    local file=$1 scene=examples/cmake-consumer/scene/cubes.gltf package
    package=$(mktemp -d "$work/packages/XXXXXX")
    case $file in
        */corpus/lint/*) check 01 "$build/bin/glint" lint "$file" ;;
        */corpus/lock/*)
            cp "$file" "$package/ids.lock"
            check 01 "$build/bin/glint" compile "$scene" --dry-run --lock "$package/ids.lock"
            ;;
        */corpus/profile/*) check 01 "$build/bin/glint" explain "$scene" --merge "profile:$file" ;;
        */corpus/manifest/*)
            cp "$file" "$package/manifest.json"
            check 1 "$build/bin/glint" inspect "$package"
            check 01 "$build/bin/glint" lint "$package"
            ;;
        */corpus/package/*)
            cp "$file" "$package/tables.bin"
            check 1 "$build/bin/glint" inspect "$package"
            ;;
        */corpus/image/*)
            for end in png exr; do
                cp "$file" "$package/picture.$end"
                check 01 "$build/bin/glint" compare "$package/picture.$end" "$package/picture.$end"
            done
            ;;
        */corpus/cache/*) ;; # its replay has the folder of a cache
        *) check 01 "$build/bin/glint" compile "$file" --dry-run ;;
    esac
    rm -rf "$package"
}

export build work
export -f check check_scene check_input
"$build/bin/gallery" "$work/gallery" >/dev/null

printf 'sanitize: replays of the corpus\n'
for folder in tests/fuzz/corpus/*; do
    check 0 "$build/tests/fuzz_${folder##*/}" "$folder"
done

mapfile -d '' inputs < <(find tests/fuzz/corpus "$models/invalid" -type f \
    \( -path '*/corpus/*' -o -name '*.gltf' -o -name '*.glb' \) -print0 2>/dev/null || true)
printf 'sanitize: %s inputs through the command\n' "${#inputs[@]}"
# shellcheck disable=SC2016 # the inner shell expands it
printf '%s\0' "${inputs[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'check_input "$1"' _

mapfile -d '' scenes < <(find examples "$work/gallery" "$models/features" "$models/large" \
    \( -name '*.gltf' -o -name '*.glb' \) -print0 2>/dev/null || true)
printf 'sanitize: %s scenes through every command\n' "${#scenes[@]}"
# shellcheck disable=SC2016
printf '%s\0' "${scenes[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'check_scene "$1"' _

if [[ -n $(ls "$work/failed") ]]; then
    cat "$work"/failed/*
    printf 'sanitize: error: %s findings, printed above\n' "$(find "$work/failed" -type f | wc -l)" >&2
    exit 1
fi
printf 'sanitize: clean\n'
