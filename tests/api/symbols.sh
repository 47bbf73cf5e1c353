#!/usr/bin/env bash
# Each shared library exports exactly the functions that its headers declare, under its version node, and needs nothing
# but the C library; libmpm-umat needs libmpm, too, and of it what is public.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/symbols
mkdir -p "$scratch"

check() { # library, version node, macro of declarations, folder of headers, what it may need
  local library=$BUILD/$1.so header
  # One declaration per line, then the first name before a parenthesis.
  for header in "$4"/*.h; do
    # Of a header that includes others, only what it declares itself.
    "$CC" -E -Iinclude -Iumat/include "-D$3=DECLARED" "$header" |
      awk -v of="$header" '/^# [0-9]+ "/ { inside = index($3, "\"" of "\"") == 1; next } inside'
  done | tr '\n' ' ' | tr ';' '\n' | sed -n "s/.*DECLARED [^(]*\(mpm_[A-Za-z0-9_]*\) *(.*/\1@@$2/p" |
    sort -u > "$scratch/declared"
  [ -s "$scratch/declared" ]

  nm -D --defined-only --with-symbol-versions "$library" | awk '$2 != "A" { print $3 }' | sort -u > "$scratch/exported"
  if ! diff "$scratch/declared" "$scratch/exported"; then
    echo "symbols.sh: $1: '<' is declared but not exported, '>' exported but not declared" >&2
    exit 1
  fi

  if readelf -d "$library" | grep NEEDED | grep -vE "\[($5)\.so[.0-9]*\]"; then
    echo "symbols.sh: $1 needs more than it may" >&2
    exit 1
  fi
  if ! readelf -d "$library" | grep -q "SONAME.*\[$1\.so\.0\]"; then
    echo "symbols.sh: $1: wrong soname" >&2
    exit 1
  fi
  if readelf -lW "$library" | grep -E 'GNU_STACK.*RWE'; then
    echo "symbols.sh: $1: executable stack" >&2
    exit 1
  fi
  echo "symbols.sh: $1: $(wc -l < "$scratch/exported") functions"
}
system='libc|libm|libpthread|ld-linux[^]]*'
check libmpm LIBMPM_0 MPM_API include/mpm "$system"
check libmpm-umat LIBMPM_UMAT_0 MPM_UMAT_API umat/include/mpm "$system|libmpm"
