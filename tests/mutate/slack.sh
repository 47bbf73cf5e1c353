#!/usr/bin/env bash
# Plants the faults of slack.txt one by one in a copy of the sources and runs the suite beside each under the address
# sanitizer, which must see an access to closed memory. Kernels of the baseline are enough.
set -euo pipefail
BUILD=${BUILD:-build} MAKE=${MAKE:-make} CC=${CC:-cc}
export MUTATE_FAULTS=tests/mutate/slack.txt MPM_ISA=baseline
copy=$BUILD/slack
rm -rf "$copy/tests" "$copy/src"
mkdir -p "$copy/scratch"
cp -a --parents Makefile platform.mk {bindings/bindings,bindings/javascript/rules,packaging/packaging}.mk include src umat mpi petsc tests \
  "$copy"
cd "$copy"

program() {
  "$MAKE" -s -j"$(nproc)" BUILD=out CC="$CC" WERROR=-w ISAS=baseline CPPFLAGS=-DMPM_BASELINE_ONLY OPT=-O1 KERNEL_OPT=-O1 \
    NO_UNDEFINED= CFLAGS="-g1 -fno-omit-frame-pointer -fsanitize=address" out/tests/unit > log 2>&1
}
suite() {
  CK_EXCLUDE_TAGS=long CK_TIMEOUT_MULTIPLIER=5 CK_RUN_SUITE=$1 MPM_SCRATCH=$PWD/scratch out/tests/unit > log 2>&1
}
program || { cat log; echo "mutate-slack: the tests do not compile without a fault" >&2; exit 1; }
python3 tests/mutate/plant.py list > list
for name in $(cut -d ' ' -f 2 list | sort -u); do
  suite "$name" || { tail -n 20 log; echo "mutate-slack: $name fails without a fault" >&2; exit 1; }
done
missed=0
while read -r number name file function <&3; do
  cp "$file" original
  what=$(python3 tests/mutate/plant.py plant "$number")
  program || { cat log; exit 1; }
  if suite "$name" || ! grep -Eq 'ERROR: AddressSanitizer: (use-after-poison|heap-buffer-overflow)' log; then
    echo "mutate-slack: not seen by $name: $what"
    missed=1
  else
    echo "mutate-slack: $name sees $(grep -m 1 -o 'AddressSanitizer: [a-z-]*' log) in $function"
  fi
  cp original "$file"
done 3< list
[ "$missed" = 0 ]
