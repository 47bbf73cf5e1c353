#!/usr/bin/env bash
# Plants the faults of faults.txt one by one in a copy of the sources; a fault that no unit test notices is a gap
# in the tests. An argument selects the files whose path contains it.
set -euo pipefail
BUILD=${BUILD:-build} MAKE=${MAKE:-make} CC=${CC:-cc}
copy=$BUILD/mutate
rm -rf "$copy"
mkdir -p "$copy"
cp -a Makefile include src tests "$copy"
rm -rf "$copy"/tests/api "$copy"/tests/examples
cd "$copy"

# A fault that the compiler's warnings would catch is no fault: they are off. It must still compile.
program() { "$MAKE" -s -j"$(nproc)" BUILD=out CC="$CC" WERROR=-w out/tests/unit > log 2>&1; }
tests() { MPM_SCRATCH=$PWD timeout 600 out/tests/unit > log 2>&1; }
if ! { program && tests; }; then
  cat log
  echo "mutate: the tests fail without a fault" >&2
  exit 1
fi

planted=0 missed=0
while read -r file fault; do
  case $file in '' | '#'*) continue ;; *"${1:-}"*) ;; *) continue ;; esac
  cp -p "$file" original
  sed "$fault" original > "$file"
  planted=$((planted + 1))
  if cmp -s "$file" original; then
    echo "mutate: no longer applies: $file $fault"
    missed=$((missed + 1))
  elif ! program; then
    echo "mutate: does not compile: $file $fault"
    missed=$((missed + 1))
  elif tests; then
    echo "mutate: not noticed: $file $fault"
    missed=$((missed + 1))
  fi
  cp original "$file" # with a new time, so that it is compiled again
done < tests/mutate/faults.txt
echo "mutate: $planted faults, $((planted - missed)) noticed"
[ "$missed" = 0 ]
