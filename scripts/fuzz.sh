#!/usr/bin/env bash
# Builds the fuzz targets with Clang and runs each, two at a time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/fuzz.sh [SECONDS] [TARGET…]

Runs the libFuzzer targets of tests/fuzz for SECONDS each (60), all of them or those named, and prints a Markdown
table: executions, coverage (edges, and libFuzzer's features), time, findings. Inputs that are new stay in
build/fuzz/corpus, findings in build/fuzz/findings; exit 1 if there is any. Needs Clang:
scripts/setup.sh --sanitize.
TEXT
}

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
    usage
    exit 0
fi
seconds=${1:-60}
if ! [[ $seconds =~ ^[1-9][0-9]*$ ]]; then
    usage >&2
    exit 2
fi
shift || true
targets=("$@")
if [[ ${#targets[@]} -eq 0 ]]; then
    targets=(gltf_json gltf_glb ktx2 package manifest lock lint profile cache image)
fi

# Bounds for inputs of a few KB: what asks for more is a finding.
kRssMb=1024
kMallocMb=300
kTimeout=20
kMaxLength=16384

build=${GLINT_FUZZ_BUILD:-build/fuzz}
if [[ -z ${GLINT_FUZZ_BUILD:-} ]]; then
    cmake --preset fuzz >/dev/null
    cmake --build --preset fuzz >&2
fi
mkdir -p "$build/findings" "$build/logs"

# Inputs are files, thousands a second: in memory where there is such a folder.
scratch=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")/glint-fuzz-XXXXXX")
trap 'rm -rf "$scratch"' EXIT

# run_target NAME: never fails; what it found lies in the log and in findings/.
run_target() {
    local name=$1 dictionary=()
    local words=tests/fuzz/dictionaries/$name.dict
    [[ $name == gltf_* ]] && words=tests/fuzz/dictionaries/gltf.dict
    [[ -f $words ]] && dictionary=("-dict=$words")
    mkdir -p "$build/corpus/$name" "$scratch/$name"
    # Crashes of libraries are findings, too: go on after none of them.
    TMPDIR=$scratch/$name ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1 \
        nice -n 19 "$build/tests/fuzz_$name" "${dictionary[@]}" "-max_total_time=$seconds" \
        "-rss_limit_mb=$kRssMb" "-malloc_limit_mb=$kMallocMb" "-timeout=$kTimeout" "-max_len=$kMaxLength" \
        -print_final_stats=1 "-artifact_prefix=$build/findings/$name-" \
        "$build/corpus/$name" "tests/fuzz/corpus/$name" >"$build/logs/$name.log" 2>&1 || true
}

# The last number after WORD in the lines of progress.
last() {
    grep -oE "$2: [0-9]+" "$1" | tail -n 1 | grep -oE '[0-9]+' || echo 0
}

# table_row NAME: prints its row.
table_row() {
    local log=$build/logs/$1.log executions elapsed findings
    executions=$(grep -oE 'stat::number_of_executed_units: [0-9]+' "$log" | grep -oE '[0-9]+$' || echo 0)
    elapsed=$(grep -oE 'in [0-9]+ second' "$log" | tail -n 1 | grep -oE '[0-9]+' || echo '?')
    findings=$(grep -oE 'SUMMARY: .*' "$log" | head -n 1 || true)
    printf '| %s | %s | %s | %s | %s | %s |\n' "$1" "$executions" "$(last "$log" cov)" "$(last "$log" ft)" \
        "$elapsed" "${findings:-none}"
}

for name in "${targets[@]}"; do
    while [[ $(jobs -rp | wc -l) -ge 2 ]]; do
        wait -n
    done
    printf 'fuzz: %s\n' "$name" >&2
    run_target "$name" &
done
wait

found=0
printf '| target | executions | edges | features | seconds | finding |\n|---|---|---|---|---|---|\n'
for name in "${targets[@]}"; do
    table_row "$name"
    if grep -q '^SUMMARY: ' "$build/logs/$name.log"; then
        found=1
    fi
done
exit "$found"
