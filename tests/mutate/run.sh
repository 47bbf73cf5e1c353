#!/usr/bin/env bash
# Plants the faults of faults.txt one by one in a copy of the sources and runs the suite that is named beside each; a
# fault that it does not notice is a gap in the tests. An argument selects the files whose path contains it.
set -euo pipefail
BUILD=${BUILD:-build} MAKE=${MAKE:-make} CC=${CC:-cc} CXX=${CXX:-g++}
copy=$BUILD/mutate
rm -rf "$copy"
mkdir -p "$copy/scratch" "$copy/original"
cp -a Makefile platform.mk include src tests "$copy"
cp -a include src "$copy/original"
rm -rf "$copy"/tests/examples
cd "$copy"

# A fault that the compiler's warnings would catch is no fault: they are off. It must still compile.
program() { "$MAKE" -s -j"$(nproc)" BUILD=out CC="$CC" WERROR=-w out/tests/unit > log 2>&1; }
suite() {
  if [ "$1" = wrapper ]; then
    BUILD=out MPM_SCRATCH=$PWD/scratch COMPILERS=$CXX CXXFLAGS=-w timeout 300 bash tests/api/wrapper.sh > log 2>&1
    return
  fi
  if [ "${1%/*}" = verify ]; then
    timeout 300 "$MAKE" -s -j"$(nproc)" BUILD=out CC="$CC" WERROR=-w CASES="${1#*/}" verify-quick > log 2>&1
    return
  fi
  local leave_out=
  if [ "$1" = exact ]; then leave_out=long; fi # minutes in all, and the short tests see the faults
  CK_EXCLUDE_TAGS=$leave_out CK_RUN_SUITE=$1 MPM_SCRATCH=$PWD/scratch timeout 300 out/tests/unit > log 2>&1
}
program || { cat log; echo "mutate: the tests do not compile without a fault" >&2; exit 1; }

planted=0 missed=0
miss() { echo "mutate: $1: $2"; missed=$((missed + 1)); }
python3 tests/mutate/plant.py list "${1:-}" > list
while read -r number name file function <&3; do
  planted=$((planted + 1))
  if ! what=$(python3 tests/mutate/plant.py plant "$number"); then
    miss "no longer applies" "$what"
    continue
  elif ! program; then
    miss "does not compile" "$what"
  elif suite "$name"; then
    miss "not noticed by $name" "$what"
  elif ! grep -Eq ':[FE]:|\] +(FAILED|MET)$' log; then
    miss "$name did not run to its end" "$what"
  fi
  cp "original/$file" "$file" # with a new time, so that it is compiled again
done 3< list
program
for name in $(cut -d ' ' -f 2 list | sort -u); do
  suite "$name" || miss "fails without a fault" "$name"
done
echo "mutate: $planted faults, $((planted - missed)) noticed"
[ "$missed" = 0 ]
