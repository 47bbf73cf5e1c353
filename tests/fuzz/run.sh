#!/usr/bin/env bash
# run.sh build target seconds: the committed corpus, all of it, then new inputs until so many seconds have gone. A finding
# ends it and is left in build/fuzz; give it to the program as its only argument to see it again.
set -euo pipefail
build=$1 target=$2 seconds=$3
seeds=$build/fuzz/seeds/$target found=$build/fuzz/corpus/$target
rm -rf "$seeds"
mkdir -p "$found" "$seeds"
tar -xzf "tests/fuzz/corpus/$target.tar.gz" -C "$seeds"
limits="-rss_limit_mb=2048 -malloc_limit_mb=1024 -timeout=60 -max_len=384 -len_control=0 -artifact_prefix=$build/fuzz/$target-"
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
quietly() { "$@" > "$build/fuzz/$target.log" 2>&1 || { tail -60 "$build/fuzz/$target.log"; echo "fuzz: $target: a finding"; exit 1; }; }
# shellcheck disable=SC2086
quietly "$build/fuzz/$target" $limits -max_total_time="$seconds" -print_final_stats=1 "$found" "$seeds"
runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/fuzz/$target.log")
committed=$(find "$seeds" -type f | wc -l)
echo "fuzz: $target: $runs inputs, $committed of them committed, no finding"
[ "${runs:-0}" -ge "$committed" ]
