#!/usr/bin/env bash
# Builds the fuzz targets with Clang and runs them for a time or for a number of executions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: scripts/fuzz.sh [SECONDS] [TARGET…]
       scripts/fuzz.sh --executions N [--seconds SECONDS] [TARGET…]
       scripts/fuzz.sh --report [TARGET…]

Runs the libFuzzer targets of tests/fuzz, all of them or those named, and prints a Markdown table: executions,
coverage (edges, and libFuzzer's features), time, findings. New inputs are kept in build/fuzz/corpus, and findings in
build/fuzz/findings. Exits with 1 if there is a finding. Needs Clang: scripts/setup.sh --sanitize.

  SECONDS         run each target for this time (default 60), two at a time
  --executions N  run one target after the other until each has had N executions since its last finding
  --seconds S     with --executions: run each target for at most this time
  --report        run nothing; print the counts of all runs so far

Every run adds its executions to tests/fuzz/executions.txt, or sets a target with a finding back to 0. Commit the file,
so that the runs of all machines add up. Its head says what it counts.
TEXT
}

all=(lock declaration glsl material_list package image ktx2 lint profile manifest cache gltf_json gltf_glb)
executions=0
seconds=
report=false
targets=()
while [[ $# -gt 0 ]]; do
    case $1 in
        -h | --help)
            usage
            exit 0
            ;;
        --executions | --seconds)
            if ! [[ ${2:-} =~ ^[1-9][0-9]*$ ]]; then
                usage >&2
                exit 2
            fi
            [[ $1 == --executions ]] && executions=$2 || seconds=$2
            shift
            ;;
        --report) report=true ;;
        *)
            if [[ $1 =~ ^[1-9][0-9]*$ && -z $seconds && ${#targets[@]} -eq 0 ]]; then
                seconds=$1
            elif [[ " ${all[*]} " == *" $1 "* ]]; then
                targets+=("$1")
            else
                printf 'fuzz: %s is no number of seconds and no target; targets: %s\n' "$1" "${all[*]}" >&2
                exit 2
            fi
            ;;
    esac
    shift
done
[[ ${#targets[@]} -gt 0 ]] || targets=("${all[@]}")

# These bounds are for inputs of a few KB. A target that asks for more is a finding.
kRssMb=1024
kMallocMb=300
kTimeout=20
# A run of --executions ends after this many seconds, so that it can be counted. The next run continues it.
kSlice=300

build=${GLINT_FUZZ_BUILD:-build/fuzz}
if [[ -z ${GLINT_FUZZ_BUILD:-} && $report == false ]]; then
    cmake --preset fuzz >/dev/null
    cmake --build --preset fuzz >&2
fi
counts=${GLINT_FUZZ_COUNTS:-tests/fuzz/executions.txt}
mkdir -p "$build/findings" "$build/logs"

# Inputs are files, thousands each second. They are kept in memory if there is such a folder.
scratch=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")/glint-fuzz-XXXXXX")
trap 'rm -rf "$scratch"' EXIT

# Prints the length of the longest input that a target makes. Longer ones would only test bounds of the
# readers, which the corpora and the tests reach. Shorter ones run several times as fast.
longest() {
    case $1 in
        lock | glsl) echo 1024 ;;
        declaration | material_list | image | profile | cache) echo 4096 ;;
        manifest | gltf_*) echo 8192 ;;
        *) echo 16384 ;;
    esac
}

# run_target NAME FLAG…: never fails. Its findings are in the log and in findings/.
run_target() {
    local name=$1 flags=("${@:2}")
    local words=tests/fuzz/dictionaries/$name.dict
    [[ $name == gltf_* ]] && words=tests/fuzz/dictionaries/gltf.dict
    [[ -f $words ]] && flags+=("-dict=$words")
    mkdir -p "$build/corpus/$name" "$scratch/$name"
    # Weighing inputs by their rare features takes longer than importing them.
    [[ $name == gltf_* ]] && flags+=(-entropic=0)
    # Allocations don't record their callers; run a finding again without these options to see them. The
    # quarantine of freed memory holds the memory of many inputs. Crashes of libraries are findings, too.
    TMPDIR=$scratch/$name UBSAN_OPTIONS=print_stacktrace=1 \
        ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0:malloc_context_size=0:quarantine_size_mb=16 \
        nice -n "${GLINT_FUZZ_NICE:-19}" "$build/tests/fuzz_$name" "${flags[@]}" \
        "-rss_limit_mb=$kRssMb" "-malloc_limit_mb=$kMallocMb" "-timeout=$kTimeout" "-max_len=$(longest "$name")" \
        -print_final_stats=1 -entropic_scale_per_exec_time=1 "-artifact_prefix=$build/findings/$name-" \
        "$build/corpus/$name" "tests/fuzz/corpus/$name" >"$build/logs/$name.log" 2>&1 || true
}

# Prints the last number after WORD in the lines of progress.
last() {
    grep -oE "$2: [0-9]+" "$1" | tail -n 1 | grep -oE '[0-9]+' || echo 0
}

executions_of() {
    local count
    count=$(grep -oE 'stat::number_of_executed_units: [0-9]+' "$1" | grep -oE '[0-9]+$' || true)
    # A run that was killed has no statistics, but its last line of progress begins with the number.
    echo "${count:-$(grep -oE '^#[0-9]+' "$1" | tail -n 1 | tr -d '#' || true)}"
}

found() {
    grep -qE '^SUMMARY: ' "$1"
}

# counted NAME: prints how many executions the target has had since its last finding.
counted() {
    awk -v name="$1" '$1 == name { count = $2 } END { print count + 0 }' "$counts"
}

# count_run NAME: adds the run in the log to the file of counts. A finding sets the target back to 0. Targets that run
# at the same time take turns.
count_run() {
    local name=$1 log=$build/logs/$1.log ran count
    ran=$(executions_of "$log")
    # shellcheck disable=SC2094 # descriptor 9 is a lock and is never read
    (
        flock 9
        count=$(($(counted "$name") + ${ran:-0}))
        found "$log" && count=0
        awk -v name="$name" -v count="$count" -v day="$(date -u +%F)" '
            $1 == name { $0 = name " " count " " day; there = 1 }
            { print }
            END { if (!there) print name " " count " " day }' "$counts" >"$scratch/counts"
        cat "$scratch/counts" >"$counts"
    ) 9<"$counts"
}

# run_until NAME: runs until the target has its executions, has a finding, or has used its time.
run_until() {
    local name=$1 spent=0 left slice began
    while left=$((executions - $(counted "$name"))) && [[ $left -gt 0 ]]; do
        slice=$kSlice
        if [[ -n $seconds ]]; then
            slice=$((seconds - spent < kSlice ? seconds - spent : kSlice))
            [[ $slice -gt 0 ]] || return 0
        fi
        began=$SECONDS
        run_target "$name" "-runs=$left" "-max_total_time=$slice"
        count_run "$name"
        spent=$((spent + SECONDS - began))
        printf 'fuzz: %s: %s executions since the last finding\n' "$name" "$(counted "$name")" >&2
        found "$build/logs/$name.log" && return 0
        # A target that does not start must not be started for ever.
        [[ $(executions_of "$build/logs/$name.log") -gt 0 ]] || return 0
    done
}

print_counts() {
    local name
    printf '| target | executions since the last finding | last run |\n|---|---:|---|\n'
    for name in "${targets[@]}"; do
        printf "| \`%s\` | %s | %s |\n" "$name" "$(counted "$name" | sed -E ':a; s/([0-9])([0-9]{3})($|,)/\1,\2\3/; ta')" \
            "$(awk -v name="$name" '$1 == name { day = $3 } END { print day == "" ? "-" : day }' "$counts")"
    done
}

# table_row NAME: prints the row of the target.
table_row() {
    local log=$build/logs/$1.log elapsed findings
    elapsed=$(grep -oE 'in [0-9]+ second' "$log" | tail -n 1 | grep -oE '[0-9]+' || echo '?')
    findings=$(grep -oE 'SUMMARY: .*' "$log" | head -n 1 || true)
    printf '| %s | %s | %s | %s | %s | %s |\n' "$1" "$(executions_of "$log")" "$(last "$log" cov)" "$(last "$log" ft)" \
        "$elapsed" "${findings:-none}"
}

# The shell reads the whole file before anything runs, so that the file may change during a run of hours.
main() {
    local name
    if [[ $report == true ]]; then
        print_counts
        exit 0
    fi
    if [[ $executions -gt 0 ]]; then
        for name in "${targets[@]}"; do
            run_until "$name"
        done
        print_counts
    else
        for name in "${targets[@]}"; do
            while [[ $(jobs -rp | wc -l) -ge 2 ]]; do
                wait -n
            done
            printf 'fuzz: %s\n' "$name" >&2
            {
                run_target "$name" "-max_total_time=${seconds:-60}"
                count_run "$name"
            } &
        done
        wait
        printf '| target | executions | edges | features | seconds | finding |\n|---|---|---|---|---|---|\n'
        for name in "${targets[@]}"; do
            table_row "$name"
        done
    fi
    for name in "${targets[@]}"; do
        if [[ -f $build/logs/$name.log ]] && found "$build/logs/$name.log"; then
            exit 1
        fi
    done
}

main
exit
