#!/usr/bin/env bash
# ABI.md names every exported function, every constant with its value, and every public struct with its size on LP64;
# nothing in it is not there. A struct that has grown is listed again: the last size counts.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/ledger
rm -rf "$scratch"
mkdir -p "$scratch"
headers="include/mpm/*.h umat/include/mpm/*.h mpi/include/mpm/*.h petsc/include/mpm/*.h"
# shellcheck disable=SC2086
ledger=$scratch/ledger
sed -n '/^# Ledger/,$p' ABI.md > "$ledger"

same() { # what, in the ledger, in the library
  if ! diff "$2" "$3"; then
    echo "ledger.sh: $1: '<' is in ABI.md only, '>' in the library only" >&2
    exit 1
  fi
}

sed -n '/^### Functions/,/^### /p' "$ledger" | grep -o '`mpm_[a-z0-9_]*`' | tr -d '`' | sort > "$scratch/functions"
# libmpm-mpi and libmpm-petsc need not be there: their tests compare what they export with their headers
{
  for library in libmpm libmpm-umat; do nm -D --defined-only "$BUILD/$library.so"; done | awk '$3 ~ /^mpm_/ { sub("@.*", "", $3); print $3 }'
  sed -nE 's/^MPM_MPI_API .*[ *](mpm_mpi_[a-z_]+)\(.*/\1/p' mpi/include/mpm/mpm_mpi.h
  sed -nE 's/^MPM_PETSC_API .*[ *](mpm_petsc_[a-z_]+)\(.*/\1/p' petsc/include/mpm/mpm_petsc.h
} | sort > "$scratch/exported"
same functions "$scratch/functions" "$scratch/exported"

grep -oE '`MPM_[A-Z0-9_]*` -?[0-9]+' "$ledger" | tr -d '`' | sort > "$scratch/constants"
# an alias has the value of what it names
sed -nE 's/^ *(enum mpm_[a-z_]+ \{ )?(MPM_[A-Z0-9_]+) = (-?[A-Z0-9_]+).*/\2 \3/p' $headers |
  awk '{ value[$1] = $2 in value ? value[$2] : $2; print $1, value[$1] }' | sort > "$scratch/declared"
same constants "$scratch/constants" "$scratch/declared"

sed -nE 's/^\| `(mpm_[a-z_]+)` \| ([0-9]+) \|.*/\1 \2/p' "$ledger" | awk '{ size[$1] = $2 } END { for (s in size) print s, size[s] }' |
  sort > "$scratch/sizes"
{
  printf '#include <mpm/%s.h>\n' mpm_umat mpm_mpi mpm_petsc
  echo '#include <stdio.h>'
  echo 'int main(void) {'
  sed -nE 's/^\} (mpm_[a-z_]+);.*/  printf("%s %zu\\n", "\1", sizeof(\1));/p' $headers
  echo '  return 0;'
  echo '}'
} > "$scratch/sizes.c"
"$CC" -std=c11 -Iinclude -Iumat/include -Impi/include -Ipetsc/include -Impi/parsers "$scratch/sizes.c" -o "$scratch/sizes_of"
if [ "$(getconf LONG_BIT)" = 64 ]; then
  "$scratch/sizes_of" | sort > "$scratch/actual"
  same sizes "$scratch/sizes" "$scratch/actual"
fi
echo "ledger.sh: $(wc -l < "$scratch/functions") functions, $(wc -l < "$scratch/constants") constants, $(wc -l < "$scratch/sizes") structs"
