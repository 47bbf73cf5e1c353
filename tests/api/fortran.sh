#!/usr/bin/env bash
# A Fortran host that traps invalid operations, divisions by zero and overflows in its own code lives through steps of
# every scheme.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} FC=${FC:-gfortran}
if ! command -v "$FC" > /dev/null; then
  echo "fortran.sh: skipped: there is no Fortran compiler ($FC)"
  exit 0
fi
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/fortran
rm -rf "$scratch"
mkdir -p "$scratch"
"$CC" -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude -c tests/api/fortran/scene.c -o "$scratch/scene.o"
"$FC" -g -Wall -Wno-unused-dummy-argument -Werror -ffpe-trap=invalid,zero,overflow -J "$scratch" tests/api/fortran/host.f90 \
  "$scratch/scene.o" "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/host"
out=$("$scratch/host")
[ "${out//[[:space:]]/}" = noexceptionwasraised ] || { echo "fortran.sh: $out" >&2; exit 1; }
echo "fortran.sh: $out"
