#!/usr/bin/env bash
# Of the C library's mathematics the library calls nothing but what is exact, or rounded to nearest, on every platform:
# see src/simd/elementary.h. The environment of floating point is no function of numbers.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/libm
mkdir -p "$scratch"
allowed='^(sqrt|fma|floor|ceil|trunc|rint|nearbyint|round|fabs|fmin|fmax|copysign)f?$|^fe[gs]etenv$'

# A static C library, as musl, has its mathematics in libc: there is nothing to compare with.
libm=$("$CC" -print-file-name=libm.so.6)
if [ ! -e "$libm" ]; then
  echo "libm.sh: skipped: this C library has no libm.so.6"
  exit 0
fi
nm -D --defined-only "$libm" | awk '$2 ~ /[TWi]/ { sub(/@.*/, "", $3); print $3 }' | sort -u > "$scratch/mathematics"
grep -qx expm1 "$scratch/mathematics"

# The functions of libm that files need and must not: one in a line.
forbidden() {
  nm -u "$@" 2> /dev/null | awk '$1 == "U" || $1 == "w" { sub(/@.*/, "", $2); print $2 }' | sort -u |
    comm -12 - "$scratch/mathematics" | awk -v allowed="$allowed" '$0 !~ allowed'
}

echo 'extern double expm1(double), floor(double); double planted(double x) { return expm1(x) + floor(x); }' |
  "$CC" -std=c11 -fno-builtin -c -x c - -o "$scratch/planted.o"
if [ "$(forbidden "$scratch/planted.o")" != expm1 ]; then
  echo "libm.sh: a planted call is not noticed" >&2
  exit 1
fi

found=$(forbidden -D "$BUILD/libmpm.so"; forbidden "$BUILD"/obj/src/*/*.o)
if [ -n "$found" ]; then
  echo "libm.sh: bits of these differ between C libraries, use simd/elementary.h: $found" >&2
  exit 1
fi
echo "libm.sh: $(find "$BUILD"/obj/src -name '*.o' | wc -l) objects"
