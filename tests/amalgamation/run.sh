#!/usr/bin/env bash
# The amalgamation: mpm.c and mpm.h compile without a warning with gcc and clang, as C11 and as the compilers' own C; the
# README's program runs with them, and so do the unit tests; scenes have the hashes that the library's baseline has, also
# where the host's options allow fused multiply-add.
#
#   run.sh quick    syntax by both compilers, the README's program without optimisation
#   run.sh full     all of it; SCENES: every so many-th scene of tests/hashes is compared (29)
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)} SCENES=${SCENES:-29}
mode=${1:-full}
made=$BUILD/amalgamation
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/amalgamation
warnings="-Wall -Wextra -Werror"
rm -rf "$scratch"
mkdir -p "$scratch/include/mpm"
fail() {
  echo "check-amalgamation: $*" >&2
  exit 1
}

compilers=()
for compiler in gcc clang; do
  if command -v $compiler > /dev/null; then compilers+=($compiler); else echo "check-amalgamation: there is no $compiler"; fi
done
[ ${#compilers[@]} -gt 0 ] || compilers=("$CC")
# pthread_create is in the C library itself, or not.
threads=-pthread
echo 'int main(void) { return 0; }' > "$scratch/empty.c"
if [ "$(getconf GNU_LIBC_VERSION 2> /dev/null | cut -d. -f2)" -ge 34 ] 2> /dev/null; then threads=; fi

awk '/^```c$/ {inside = 1; next} /^```/ {inside = 0} inside' README.md | sed 's|<mpm/mpm.h>|"mpm.h"|' > "$scratch/block.c"
grep -q '"mpm.h"' "$scratch/block.c" || fail "README.md has no C program"
readme() { # program
  (cd "$scratch" && "$1" > "$1.out") || fail "$1 failed"
  cmp -s "$1.out" "${first:=$1.out}" || fail "$1 prints other numbers than $first"
  grep -Eq '^t = 0\.50[0-9] s: kinetic [0-9.]+ J, strain [0-9.]+ J$' "$1.out" || fail "$1 prints $(cat "$1.out")"
}

for compiler in "${compilers[@]}"; do
  for standard in -std=c11 -std=gnu17; do
    $compiler $standard $warnings -fsyntax-only "$made/mpm.c" & syntax+=($!)
  done
done
accepted() {
  local pid
  for pid in "${syntax[@]}"; do wait "$pid" || fail "a compiler does not take mpm.c"; done
}
if [ "$mode" = quick ]; then
  # shellcheck disable=SC2086
  $CC $warnings -I"$made" "$scratch/block.c" "$made/mpm.c" -lm $threads -o "$scratch/block"
  accepted
  readme "$scratch/block"
  echo "check-amalgamation: no warning from ${compilers[*]}; $(cat "$scratch/block.out")"
  exit 0
fi

accepted
# Hosts of a folder mpm/ find the one header there.
for header in include/mpm/*.h; do echo '#include "../../mpm.h"' > "$scratch/include/mpm/$(basename "$header")"; done
cp "$made/mpm.h" "$scratch/mpm.h"

fused=
if [ "$(uname -m)" = x86_64 ] && grep -qw fma /proc/cpuinfo; then fused=-mfma; fi
for compiler in "${compilers[@]}"; do
  options=-O2
  if [ "$compiler" = "${compilers[0]}" ]; then options="-O2 $fused"; fi
  at=$scratch/$(basename "$compiler")
  # shellcheck disable=SC2086
  $compiler $options $warnings -c "$made/mpm.c" -o "$at.o" & pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || fail "mpm.c does not compile"; done

for compiler in "${compilers[@]}"; do
  at=$scratch/$(basename "$compiler")
  # shellcheck disable=SC2086
  $compiler $warnings -I"$made" "$scratch/block.c" "$at.o" -lm $threads -o "$at.block"
  readme "$at.block"
  # shellcheck disable=SC2086
  $compiler -std=c11 -O1 -ffp-contract=off -I"$scratch/include" tests/hashes/*.c "$at.o" -lm $threads -o "$at.hashes"
  for part in 7 18; do
    "$at.hashes" baseline part $part "$SCENES"
  done > "$at.found"
  for part in 7 18; do
    "$BUILD/tests/hashes/hashes" baseline part $part "$SCENES"
  done > "$scratch/expected"
  grep -q . "$scratch/expected" || fail "no scene was compared"
  grep ' failed$' "$scratch/expected" && fail "scenes fail"
  diff "$scratch/expected" "$at.found" || fail "with $compiler states differ from those of the library's baseline"
  echo "check-amalgamation: $compiler: $(wc -l < "$at.found") scenes with the library's bits; $(cat "$at.block.out")"
done

# The unit tests see the internal headers beside the one public header, and link to mpm.o instead of the library.
compiler=${compilers[0]}
ar rcs "$scratch/libmpm.a" "$scratch/$(basename "$compiler").o"
"$MAKE" -s -j"$JOBS" check-unit ${SUITES:+SUITES="$SUITES"} CC="$compiler -I$scratch/include" CPPFLAGS=-DMPM_BASELINE_ONLY BUILD="$made/unit" OBJECTS= \
  STATIC_LIB="$scratch/libmpm.a" JOBS="$JOBS"
