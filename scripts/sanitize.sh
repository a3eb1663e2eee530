#!/usr/bin/env bash
# Runs the tool and its readers with AddressSanitizer and UndefinedBehaviorSanitizer over every scene and input.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/sanitize.sh [--all | --build | --threads]

Builds the command and the replays of tests/fuzz with both sanitizers (preset sanitize, which needs Clang:
scripts/setup.sh --sanitize) and runs
  - every file of tests/fuzz/corpus through the reader that it was made for, and invalid scenes through both readers
    of scenes;
  - every eighth of these files through the command;
  - every command over the scene of the example program, with each strategy;
  - explain over the gallery and the scenes of scripts/models.sh where they are. The other example scenes, those of
    packs with their packs, the gallery and every fourth of these scenes are also compiled and rendered, each with one
    of the strategies in turn.
With --build it only builds.
With --threads it runs the tests of the runtime that use several threads with ThreadSanitizer instead (preset threads).
With --all, as in scripts/nightly.sh, every file goes through the command, and every scene through every command and
strategy.
Exits with 1 after a report of a sanitizer, and if a command takes 15 minutes or ends neither successfully nor with a
diagnostic.
TEXT
}

all=false
build_only=false
threads=false
for argument in "$@"; do
    case $argument in
        --all) all=true ;;
        --build) build_only=true ;;
        --threads) threads=true ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            usage >&2
            exit 2
            ;;
    esac
done

build=build/sanitize
# The command has no such exit code, so that a report is noticed whatever the command would have returned.
export ASAN_OPTIONS=exitcode=99 UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS=exitcode=99
export NO_COLOR=1
# Neither lavapipe's machine code nor its threads are tested here, and pictures are small.
export GALLIVM_PERF=nopt LP_NUM_THREADS=0
models=${GLINT_MODELS:-../shared/models}
# Bounds what a hang costs; the longest command takes two minutes.
export kTimeout=900

say() {
    printf 'sanitize: %s\n' "$*"
}

fail() {
    printf 'sanitize: error: %s\n' "$*" >&2
    exit 1
}

if [[ $threads == true ]]; then
    say "building with ThreadSanitizer"
    cmake --preset threads >/dev/null
    cmake --build --preset threads
    # Only calls from Glint's own code count: the driver and the validation layer are not compiled for it. Nor do they
    # take their locks in one order.
    export TSAN_OPTIONS="ignore_noninstrumented_modules=1 detect_deadlocks=0 report_mutex_bugs=0 exitcode=99"
    for program in test_runtime_engine test_background test_replace_package test_live_edit test_textures; do
        say "$program"
        "build/threads/tests/$program" --gtest_brief=1 || fail "$program has a finding, printed above"
    done
    say "clean"
    exit 0
fi
say "building"
cmake --preset sanitize >/dev/null
cmake --build --preset sanitize
[[ $build_only == false ]] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/failed" "$work/packages"
export GLINT_CACHE=$work/cache

# check ALLOWED COMMAND…: runs the command, and keeps its output if its exit code is none of ALLOWED ("0",
# "01").
check() {
    local allowed=$1 code=0 log
    shift
    log=$(mktemp "$work/log-XXXXXX")
    timeout -k 10 "$kTimeout" "$@" >"$log" 2>&1 || code=$?
    if [[ ${#code} -eq 1 && $allowed == *"$code"* ]]; then
        rm "$log"
    else
        { printf 'sanitize: exit %s: %s\n' "$code" "$*"; tail -n 60 "$log"; } >"$work/failed/${log##*-}"
    fi
}

# packs_of SCENE: prints the option that names the packs of material features beside an example scene, if it has some.
packs_of() {
    [[ $1 != examples/materials/* ]] || printf -- '--materials=%s' "${1%/*}"
}

# check_scene SCENE: runs everything that reads the scene or its package.
check_scene() {
    local scene=$1 glint=$build/bin/glint package packs
    package=$(mktemp -d "$work/packages/XXXXXX")
    packs=$(packs_of "$scene")
    check 0 "$glint" explain "$scene" ${packs:+"$packs"} --json
    check 0 "$glint" explain "$scene" ${packs:+"$packs"} --plan --merge auto
    check 0 "$glint" compile "$scene" ${packs:+"$packs"} -o "$package/a" --strategy all --tracer all \
        --emit glsl,header --lock "$package/ids.lock" --depfile "$package/list.d" --embed "$package/embedded.cpp"
    check 0 "$glint" compile "$scene" ${packs:+"$packs"} -o "$package/b" --merge all --alpha tested --shadows deferred \
        --hit-record packed --jobs 1
    check 0 "$glint" inspect "$package/a" --json
    check 01 "$glint" lint "$package/a" --json
    check 0 "$glint" diff "$package/a" "$package/b" --json
    for strategy in uber visibility sorted-uber hit-shaders; do
        check 0 "$glint" render "$scene" ${packs:+"$packs"} -o "$package/$strategy.exr" --package "$package/a" \
            --size 32x18 --strategy "$strategy" --stats "$package/$strategy.json"
    done
    check 0 "$glint" render "$scene" ${packs:+"$packs"} -o "$package/b.png" --package "$package/b" --size 32x18 --ssr 8
    check 0 "$glint" compare "$package/uber.exr" "$package/hit-shaders.exr" --diff "$package/diff.png" --json
    rm -rf "$package"
}

# explain_scene SCENE: reads the scene and plans. Images are decoded where scenes are rendered.
explain_scene() {
    check 0 "$build/bin/glint" explain "$1" --plan --merge auto --no-trust-textures
}

# render_scene STRATEGY:SCENE: compiles and renders for one strategy.
render_scene() {
    local strategy=${1%%:*} scene=${1#*:} glint=$build/bin/glint package packs
    package=$(mktemp -d "$work/packages/XXXXXX")
    packs=$(packs_of "$scene")
    check 0 "$glint" compile "$scene" ${packs:+"$packs"} -o "$package/a" --strategy "$strategy" \
        --lock "$package/ids.lock"
    check 0 "$glint" render "$scene" ${packs:+"$packs"} -o "$package/a.exr" --package "$package/a" --size 32x18 \
        --strategy "$strategy"
    rm -rf "$package"
}

# check_farm SCENE…: runs the commands that build several scenes, and modules one by one.
check_farm() {
    local glint=$build/bin/glint folder=$work/farm
    check 0 "$glint" compile "$@" --plan-only "$folder/plan" -o "$folder/package" --merge all
    check 0 ninja -f "$folder/plan/build.ninja"
    check 0 "$glint" inspect "$folder/package" --disassemble 0
    check 0 "$glint" render "$1" -o "$folder/picture.png" --size 32x18 --profile "$folder/hits.json"
    check 0 "$glint" compile "$1" -o "$folder/b" --merge "profile:$folder/hits.json"
    for shell in bash zsh fish; do
        check 0 "$glint" completion "$shell"
    done
}

# replay FOLDER: runs the files of a folder of tests/fuzz/corpus through their reader, in one process.
replay() {
    check 0 "$build/tests/fuzz_${1##*/}" "$1"
}

# replay_scenes READER: runs invalid scenes through a reader of scenes.
replay_scenes() {
    mapfile -d '' folders < <(find "$models/invalid" -type f -printf '%h\0' | sort -zu)
    check 0 "$build/tests/fuzz_$1" "${folders[@]}"
}

# check_input FILE: runs the reader of a file of tests/fuzz/corpus, which its folder determines, or of a scene
# that may be invalid.
check_input() {
    local file=$1 glint=$build/bin/glint scene=examples/cmake-consumer/scene/cubes.gltf package
    package=$(mktemp -d "$work/packages/XXXXXX")
    case $file in
        */corpus/lint/*) check 01 "$glint" lint "$file" ;;
        */corpus/lock/*)
            cp "$file" "$package/ids.lock"
            check 01 "$glint" compile "$scene" --dry-run --lock "$package/ids.lock"
            ;;
        */corpus/profile/*) check 01 "$glint" explain "$scene" --merge "profile:$file" ;;
        */corpus/manifest/*)
            cp "$file" "$package/manifest.json"
            check 1 "$glint" inspect "$package"
            check 01 "$glint" lint "$package"
            ;;
        */corpus/package/*)
            cp "$file" "$package/tables.bin"
            check 1 "$glint" inspect "$package"
            ;;
        */corpus/image/*)
            for end in png exr; do
                cp "$file" "$package/picture.$end"
                check 01 "$glint" compare "$package/picture.$end" "$package/picture.$end"
            done
            ;;
        */corpus/cache/*) ;; # the replay of its target has the folder of a cache
        */corpus/declaration/*) ;; # the replay of its target reads it beside Glint's own declarations
        */corpus/ktx2/*) ;;  # the replay of its target decodes it; a scene around it would add nothing
        *) check 01 "$glint" compile "$file" --dry-run ;;
    esac
    rm -rf "$package"
}

# each BATCH FUNCTION FILE…: calls the function for every file, with as many processes as there are cores and
# BATCH files for each process.
each() {
    local batch=$1 function=$2
    shift 2
    [[ $# -gt 0 ]] || fail "nothing to run $function over"
    # shellcheck disable=SC2016 # the inner shell expands it
    printf '%s\0' "$@" |
        xargs -0 -n "$batch" -P "$(nproc)" bash -c 'for file in "${@:2}"; do "$1" "$file"; done' _ "$function"
}

# every COUNT WORD…: prints the first of each COUNT words, with a 0 byte behind each.
every() {
    local count=$1 i
    shift
    for ((i = 1; i <= $#; i += count)); do
        printf '%s\0' "${!i}"
    done
}

export build work models
export -f packs_of check check_scene explain_scene render_scene replay replay_scenes check_input

say "replays of the corpus"
each 1 replay tests/fuzz/corpus/*
if [[ -d $models/invalid ]]; then
    each 1 replay_scenes gltf_json gltf_glb
fi

mapfile -d '' inputs < <(find tests/fuzz/corpus "$models/invalid" -type f \
    \( -path '*/corpus/*' -o -name '*.gltf' -o -name '*.glb' \) -print0 2>/dev/null | sort -z || true)
if [[ $all == false ]]; then
    mapfile -d '' inputs < <(every 8 "${inputs[@]}")
fi
say "${#inputs[@]} inputs through the command"
# The gallery is one process of half a minute.
check 0 "$build/bin/gallery" "$work/gallery" &
each 16 check_input "${inputs[@]}"
wait

# scenes_in FOLDER…: prints the scenes, with a 0 byte behind each. A scene with only KTX2 textures is an error in a build
# without the transcoder.
scenes_in() {
    local without=()
    if "$build/bin/glint" --version | grep -q 'KTX2.*not built in'; then
        without=(! -path '*-ktx2/*')
    fi
    find "$@" \( -name '*.gltf' -o -name '*.glb' \) "${without[@]}" -print0 2>/dev/null | sort -z || true
}

gallery=$work/gallery/gallery.gltf
farm=(examples/cmake-consumer/scene/cubes.gltf examples/engine/scene/engine.gltf)
scenes=(examples/cmake-consumer/scene/cubes.gltf)
mapfile -d '' examples < <(scenes_in examples/engine examples/materials)
mapfile -d '' others < <(scenes_in "$models/large" "$models/features")
if [[ $all == true ]]; then
    farm[1]=$gallery
    # The gallery comes first, because it takes longest.
    scenes=("$gallery" "${scenes[@]}" "${examples[@]}" "${others[@]}")
fi
say "a plan of two scenes, by Ninja"
check_farm "${farm[@]}"
say "${#scenes[@]} scenes through every command"
each 1 check_scene "${scenes[@]}"
if [[ $all == false ]]; then
    say "$((${#others[@]} + 1)) scenes through explain"
    each 2 explain_scene "$gallery" "${others[@]}"
    mapfile -d '' rendered < <(every 4 "$gallery" "${others[@]}")
    rendered+=("${examples[@]}")
    strategies=(hit-shaders uber visibility sorted-uber)
    for i in "${!rendered[@]}"; do
        rendered[i]=${strategies[i % 4]}:${rendered[i]}
    done
    say "${#rendered[@]} scenes through compile and render"
    each 1 render_scene "${rendered[@]}"
fi

if [[ -n $(ls "$work/failed") ]]; then
    cat "$work"/failed/*
    fail "$(find "$work/failed" -type f | wc -l) findings, printed above"
fi
say "clean"
