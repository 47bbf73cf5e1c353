#!/usr/bin/env bash
# Runs the scenes on every instruction set that the processor has and compares their hashes with expected-*.txt: a
# difference is a changed result, and needs a line in CHANGELOG.md. `run.sh update` writes the files instead.
#
# Kernels for avx2 and avx512 are contracted to fused multiply-add as the compiler sees fit: their hashes hold for the
# compiler that they are noted with. The locking remedy takes logarithms and exponentials from the C library, and GMRES
# rotations: they hold for its version.
set -euo pipefail
cd "$(dirname "$0")"
export LC_ALL=C
BUILD=${BUILD:-../../build} CC=${CC:-cc} JOBS=${JOBS:-$(nproc)}
program=$BUILD/tests/hashes/hashes
folder=$BUILD/tests/hashes/found
parts=6
mode=${1:-check}

if [ "$("$CC" -dumpmachine | cut -d- -f1)" != x86_64 ]; then
  echo "check-hashes: skipped: the hashes are of x86_64"
  exit 0
fi
case $("$CC" --version | head -n 1) in
*clang*) compiler="clang $("$CC" -dumpversion | cut -d. -f1)" ;;
*) compiler="gcc $("$CC" -dumpversion | cut -d. -f1)" ;;
esac
library=$(getconf GNU_LIBC_VERSION 2> /dev/null || echo unknown)

# The C library's functions must not depend on the processor.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4

rm -rf "$folder"
mkdir -p "$folder"
for set in baseline avx2 avx512; do
  for part in $(seq 0 $((parts - 1))); do echo "$set $part"; done
done | xargs -P "$JOBS" -L 1 sh -c '
  "$0" "$2" "$3" '$parts' > "$1/$2.$3"
  status=$?
  if [ $status = 3 ]; then echo "$2" > "$1/$2.missing"; elif [ $status != 0 ]; then exit 1; fi' "$program" "$folder"

failed=0
for set in baseline avx2 avx512; do
  expected=expected-$set.txt
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
    { echo "# compiler: $compiler, C library: $library; written by: make update-hashes"; cat "$folder/$set.lines"; } \
      > "$expected"
    echo "$expected: $(wc -l < "$folder/$set.lines") scenes"
    continue
  fi
  noted=$(sed -n '1s/^# compiler: \([^,]*\), C library: \([^;]*\);.*/\1/p' "$expected")
  noted_library=$(sed -n '1s/^# compiler: \([^,]*\), C library: \([^;]*\);.*/\2/p' "$expected")
  if [ $set != baseline ] && [ "$noted" != "$compiler" ]; then
    echo "check-hashes: $set is not compared: its hashes are of $noted, this is $compiler"
    continue
  fi
  leave='^#'
  if [ "$noted_library" != "$library" ]; then
    echo "check-hashes: $set: the locking remedy and GMRES are not compared: they are of $noted_library, this is $library"
    leave='^#|: locking remedy |: GMRES '
  fi
  if ! diff <(grep -Ev "$leave" "$expected") <(grep -Ev "$leave" "$folder/$set.lines") > "$folder/$set.diff"; then
    failed=1
    sed -n "s/^</$set: expected/p; s/^>/$set: found   /p" "$folder/$set.diff" | sort -b -k 3
    echo "$set: $(grep -c '^>' "$folder/$set.diff") of $(wc -l < "$folder/$set.lines") scenes differ"
  else
    echo "check-hashes: $set: $(grep -Evc "$leave" "$folder/$set.lines") scenes as expected"
  fi
done
if [ $failed = 1 ]; then
  echo "check-hashes: results have changed. If that is meant: a line in CHANGELOG.md, and make update-hashes" >&2
  exit 1
fi
