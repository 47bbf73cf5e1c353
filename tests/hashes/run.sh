#!/usr/bin/env bash
# Runs the scenes on every instruction set that the processor has and compares their hashes with expected-*.txt: a
# difference is a changed result, and needs a line in CHANGELOG.md. `run.sh update` writes the files instead.
#
# Those of the baseline hold on every platform: tests/portable compares with the same list. Kernels for avx2 and avx512
# are contracted to fused multiply-add as the compiler sees fit: their hashes hold for the compiler that they are noted
# with. An update on a processor without a set writes "unknown" there for the scenes that changed elsewhere: they are not
# compared until an update on a processor that has the set.
set -euo pipefail
cd "$(dirname "$0")"
export LC_ALL=C
BUILD=${BUILD:-../../build} CC=${CC:-cc} JOBS=${JOBS:-$(nproc)}
program=$BUILD/tests/hashes/hashes
folder=$BUILD/tests/hashes/found
parts=16
mode=${1:-check}

if [ "$("$CC" -dumpmachine | cut -d- -f1)" != x86_64 ]; then
  echo "check-hashes: skipped: the hashes are of x86_64"
  exit 0
fi
case $("$CC" --version | head -n 1) in
*clang*) compiler="clang $("$CC" -dumpversion | cut -d. -f1)" ;;
*) compiler="gcc $("$CC" -dumpversion | cut -d. -f1)" ;;
esac
if echo | "$CC" ${CFLAGS-} -dM -E - | grep __FMA__ > /dev/null; then compiler="$compiler for another processor"; fi

rm -rf "$folder"
mkdir -p "$folder"
# The long ones, in 3-D, come first.
for part in $(seq $((parts - 1)) -1 0); do
  for set in baseline avx2 avx512; do echo "$set $part"; done
done | xargs -P "$JOBS" -L 1 sh -c '
  "$0" "$2" part "$3" '$parts' > "$1/$2.$3"
  status=$?
  if [ $status = 3 ]; then echo "$2" > "$1/$2.missing"; elif [ $status != 0 ]; then exit 1; fi' "$program" "$folder"

# forget SET: its lines, for a processor that lacks it; what has changed on another set is unknown.
forget() {
  awk '{ hash = $NF; scene = $0; sub(/ [^ ]*$/, "", scene) }
       FILENAME == ARGV[1] { changed[$0]; next }
       FILENAME == ARGV[2] { noted[scene] = hash; next }
       { print scene, scene in changed || !(scene in noted) ? "unknown" : noted[scene] }' \
    "$folder/changed" "expected-$1.txt" "$folder/baseline.lines"
}

failed=0
: > "$folder/changed"
for set in baseline avx2 avx512; do
  expected=expected-$set.txt
  if [ -e "$folder/$set.missing" ] && [ "$mode" = update ]; then
    forget "$set" > "$folder/$set.lines"
    { head -n 1 "$expected"; cat "$folder/$set.lines"; } > "$folder/$set.new"
    mv "$folder/$set.new" "$expected"
    echo "$expected: $(awk '$NF == "unknown" { ++n } END { print n + 0 }' "$expected") scenes unknown: this processor does not have the set"
    continue
  fi
  if [ -e "$folder/$set.missing" ]; then
    echo "check-hashes: $set is skipped: this processor does not have it"
    continue
  fi
  for part in $(seq 0 $((parts - 1))); do cat "$folder/$set.$part"; done > "$folder/$set.lines"
  if [ "$mode" = update ]; then
    if grep -q ' failed$' "$folder/$set.lines"; then
      echo "update-hashes: $set: scenes fail" >&2
      exit 1
    fi
    awk 'FILENAME == ARGV[1] { noted[$0]; next } !($0 in noted) { sub(/ [^ ]*$/, ""); print }' \
      "$expected" "$folder/$set.lines" >> "$folder/changed"
    { echo "# compiler: $compiler; written by: make update-hashes"; cat "$folder/$set.lines"; } \
      > "$expected"
    echo "$expected: $(wc -l < "$folder/$set.lines") scenes"
    continue
  fi
  noted=$(sed -n '1s/^# compiler: \([^;]*\);.*/\1/p' "$expected")
  if [ $set != baseline ] && [ "$noted" != "$compiler" ]; then
    echo "check-hashes: $set is not compared: its hashes are of $noted, this is $compiler"
    continue
  fi
  sed -n 's/ unknown$//p' "$expected" > "$folder/$set.unknown"
  awk -v list="$folder/$set.unknown" 'BEGIN { while ((getline scene < list) > 0) unknown[scene] }
       { scene = $0; sub(/ [^ ]*$/, "", scene) } !(scene in unknown)' "$folder/$set.lines" > "$folder/$set.known"
  if [ -s "$folder/$set.unknown" ]; then
    echo "check-hashes: $set: $(wc -l < "$folder/$set.unknown") scenes are not compared: make update-hashes notes them"
  fi
  if ! diff <(grep -v -e '^#' -e ' unknown$' "$expected") "$folder/$set.known" > "$folder/$set.diff"; then
    failed=1
    sed -n "s/^</$set: expected/p; s/^>/$set: found   /p" "$folder/$set.diff" | sort -b -k 3
    echo "$set: $(grep -c '^>' "$folder/$set.diff") of $(wc -l < "$folder/$set.lines") scenes differ"
  else
    echo "check-hashes: $set: $(wc -l < "$folder/$set.known") scenes as expected"
  fi
done
if [ $failed = 1 ]; then
  echo "check-hashes: results have changed. If that is meant: a line in CHANGELOG.md, and make update-hashes" >&2
  exit 1
fi
