#!/usr/bin/env bash
# pack.sh build target: merges what a fuzzing run has found with the committed corpus, keeps what adds coverage, and packs
# it into tests/fuzz/corpus. The archive depends on nothing but the inputs: numbered by size, without owners and times.
set -euo pipefail
build=$1 target=$2
work=$build/fuzz/merged/$target
rm -rf "$work"
mkdir -p "$work/seeds" "$work/kept" "$work/packed" "$build/fuzz/corpus/$target"
tar -xzf "tests/fuzz/corpus/$target.tar.gz" -C "$work/seeds"
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
"$build/fuzz/$target" -merge=1 -rss_limit_mb=2048 -malloc_limit_mb=1024 -timeout=25 -max_len=384 \
  "$work/kept" "$work/seeds" "$build/fuzz/corpus/$target" > "$work/log" 2>&1 || { tail -60 "$work/log"; exit 1; }
number=0
while read -r _ name; do
  number=$((number + 1))
  cp "$work/kept/$name" "$work/packed/$(printf %04d $number)"
done < <(cd "$work/kept" && sha1sum -- * | while read -r sum name; do echo "$(stat -c %s "$name") $sum $name"; done |
  LC_ALL=C sort -n -k 1,1 -k 2,2 | cut -d ' ' -f 1,3)
[ "$number" -gt 0 ] || { echo "fuzz-corpus: $target: nothing is left" >&2; exit 1; }
chmod 644 "$work/packed"/*
(cd "$work/packed" && LC_ALL=C tar --format=ustar --owner=0 --group=0 --numeric-owner --mtime=@0 -cf - [0-9]*) |
  gzip -9n > "tests/fuzz/corpus/$target.tar.gz"
echo "fuzz-corpus: $target: $number inputs"
