#!/usr/bin/env bash
# Every public header compiles alone and twice over, as C99, C11 and C++17; a dumb parser can take it.
set -euo pipefail
BUILD=${BUILD:-build}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/headers
mkdir -p "$scratch"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"

compile() { # compiler, standard, language, header
  command -v "$1" > /dev/null || return 0
  local source=$scratch/$1-$2.$3
  printf '#include <%s>\n#include <%s>\nint used(void);\nint used(void) { return 0; }\n' "$4" "$4" > "$source"
  # shellcheck disable=SC2086
  "$1" -std="$2" $warnings -Iinclude -Iumat/include -Impi/include -Ipetsc/include -Impi/parsers -fsyntax-only "$source"
}

count=0
for path in include/mpm/*.h include/mpm/*.hpp umat/include/mpm/*.h umat/include/mpm/*.hpp mpi/include/mpm/*.h mpi/include/mpm/*.hpp petsc/include/mpm/*.h petsc/include/mpm/*.hpp; do
  [ -e "$path" ] || continue
  header=${path#umat/}
  header=${header#mpi/}
  header=${header#petsc/}
  header=${header#include/}
  case $path in
  *.hpp) ;;
  *)
    for standard in c99 c11; do
      compile gcc $standard c "$header"
      compile clang $standard c "$header"
    done
    gcc -E -P -std=c99 -Iinclude -Iumat/include -Impi/include -Ipetsc/include -Impi/parsers "$path" > "$scratch/expanded"
    if grep -nwE 'inline|_Bool|bool|FILE|va_list' "$scratch/expanded"; then
      echo "headers.sh: $path is more than plain declarations" >&2
      exit 1
    fi
    ;;
  esac
  compile g++ c++17 cpp "$header"
  compile clang++ c++17 cpp "$header"
  count=$((count + 1))
done
# What parsers are given that know the integer types: declarations and nothing else.
gcc -E -P -std=c99 -DMPM_NO_INCLUDES -DMPM_API= -Iinclude include/mpm/mpm.h > "$scratch/declarations.h"
if grep -nE '__|^#' "$scratch/declarations.h"; then
  echo "headers.sh: mpm.h with MPM_NO_INCLUDES is more than plain declarations" >&2
  exit 1
fi
for python in python3 /usr/bin/python3; do
  "$python" -c 'import cffi' 2> /dev/null || continue
  "$python" -c 'import cffi, sys; cffi.FFI().cdef(open(sys.argv[1]).read())' "$scratch/declarations.h"
  break
done
echo "headers.sh: $count headers"
