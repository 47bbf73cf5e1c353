#!/usr/bin/env bash
# The shared library exports exactly the functions that the headers declare with MPM_API, under the version node,
# and needs nothing but the C library.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/symbols
mkdir -p "$scratch"
library=$BUILD/libmpm.so

# One declaration per line, then the first name before a parenthesis.
for header in include/mpm/*.h; do
  [ "$header" = include/mpm/experimental.h ] && continue # promises nothing, static library only
  "$CC" -E -P -Iinclude -DMPM_API=DECLARED "$header"
done | tr '\n' ' ' | tr ';' '\n' | sed -n 's/.*DECLARED [^(]*\(mpm_[A-Za-z0-9_]*\) *(.*/\1@@LIBMPM_0/p' |
  sort -u > "$scratch/declared"
[ -s "$scratch/declared" ]

nm -D --defined-only --with-symbol-versions "$library" | awk '$2 != "A" { print $3 }' | sort -u > "$scratch/exported"
if ! diff "$scratch/declared" "$scratch/exported"; then
  echo "symbols.sh: '<' is declared but not exported, '>' exported but not declared" >&2
  exit 1
fi

if readelf -d "$library" | grep NEEDED | grep -vE '\[(libc|libm|libpthread|ld-linux[^]]*)\.so[.0-9]*\]'; then
  echo "symbols.sh: the library needs more than the C library" >&2
  exit 1
fi
if ! readelf -d "$library" | grep -q 'SONAME.*\[libmpm\.so\.0\]'; then
  echo "symbols.sh: wrong soname" >&2
  exit 1
fi
if readelf -lW "$library" | grep -E 'GNU_STACK.*RWE'; then
  echo "symbols.sh: executable stack" >&2
  exit 1
fi
echo "symbols.sh: $(wc -l < "$scratch/exported") functions"
