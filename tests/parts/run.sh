#!/usr/bin/env bash
# run.sh PROGRAM OUT JOBS SHARE PARTS...: tells scenes of tests/hashes on so many parts, every SHARE-th of them, and
# compares with one part. What the library refuses must be one of the sentences of refused.txt beside this file.
set -euo pipefail
export LC_ALL=C
program=$1 out=$2 jobs=$3 share=$4
shift 4
here=$(dirname "$0") slices=16 failed=0
rm -rf "$out"
mkdir -p "$out"
for parts in "$@"; do
  for slice in $(seq 0 $((slices - 1))); do echo "$slice $parts"; done
done | xargs -P "$jobs" -L 1 sh -c \
  '"$0" every $(($2 * '$slices')) $(($2 * $3)) "$4" > "$1/$4.$3" 2>&1; [ $? -lt 2 ]' "$program" "$out" "$share"
for parts in "$@"; do
  cat "$out/$parts".* | grep -v '^[0-9]* parts: ' > "$out/lines.$parts"
  grep -vE ': (equal|refused: .*)$' "$out/lines.$parts" && failed=1
  sed -n 's/.*: refused: //p' "$out/lines.$parts" | sort | uniq -c > "$out/refused.$parts"
  if sed 's/^ *[0-9]* //' "$out/refused.$parts" | grep -Fxvf "$here/refused.txt"; then
    echo "check-parts: refused as above, which refused.txt does not have" >&2
    failed=1
  fi
  equal=$(grep -c ': equal$' "$out/lines.$parts" || :)
  echo "check-parts: $parts parts: $equal of $(wc -l < "$out/lines.$parts") scenes equal, $(grep -c ': refused: ' "$out/lines.$parts" || :) refused"
  [ "$equal" -gt 0 ] || failed=1
done
exit $failed
