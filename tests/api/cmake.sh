#!/usr/bin/env bash
# The CMake package: hosts in C and in C++, shared and static, find an installation in a prefix, one that was moved, and
# one staged under DESTDIR with another layout.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} CXX=${CXX:-g++} MAKE=${MAKE:-make}
BUILD=$(cd "$BUILD" && pwd)
if ! command -v cmake > /dev/null; then
  echo "cmake.sh: skipped: there is no cmake"
  exit 0
fi
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/cmake
rm -rf "$scratch"
mkdir -p "$scratch"

hosts() { # name, prefix, library folder
  local name=$1 prefix=$2 libraries=$3 language
  for language in C CXX; do
    local where=$scratch/$name-$language
    CC=$CC CXX=$CXX cmake -S tests/api/cmake -B "$where" -DLANGUAGE=$language -DCMAKE_PREFIX_PATH="$prefix" \
      -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF > "$where.log" || { cat "$where.log"; exit 1; }
    cmake --build "$where" >> "$where.log" || { cat "$where.log"; exit 1; }
    local library
    library=$(LD_LIBRARY_PATH='' ldd "$where/shared" | awk '/libmpm/ { print $3 }')
    if [ "$library" != "$libraries/libmpm.so.0" ]; then
      echo "cmake.sh: $name-$language uses $library, not that of $libraries" >&2
      exit 1
    fi
    if ldd "$where/static" | grep libmpm; then
      echo "cmake.sh: $name-$language/static still needs the shared library" >&2
      exit 1
    fi
    for program in shared static; do
      printf 'cmake.sh: %s, %s, %s: ' "$name" $language $program
      "$where/$program" "$(cat "$where/version")"
    done
  done
  "$scratch/$name-CXX/wrapper" | grep '^result: '
}

"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX="$scratch/prefix" DESTDIR= > /dev/null
mv "$scratch/prefix" "$scratch/moved"
hosts moved "$scratch/moved" "$scratch/moved/lib"
"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX=/opt/mpm LIBDIR=/opt/mpm/lib/x86_64-linux-gnu DESTDIR="$scratch/stage" \
  > /dev/null
hosts staged "$scratch/stage/opt/mpm" "$scratch/stage/opt/mpm/lib/x86_64-linux-gnu"
