#!/usr/bin/env bash
# The CMake package: hosts in C and in C++, shared and static, find an installation in a prefix, one that was moved, and
# one staged under DESTDIR with another layout. CMakeLists.txt compiles what the Makefile compiles.
#
#   cmake.sh full    builds by CMakeLists.txt as well: an installation, and hosts that have the library as a folder of
#                    theirs and by FetchContent
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

configure() { # build folder, source folder, options
  CC=$CC CXX=$CXX cmake -S "$2" -B "$1" "${@:3}" > "$1.log" || { cat "$1.log"; exit 1; }
}
version=$(sed -n 's/^VERSION := //p' Makefile)

# One object for each pair of a source and an instruction set, by both.
configure "$scratch/own" . -DCMAKE_BUILD_TYPE=Debug -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_INSTALL_LIBDIR=lib \
  -DCMAKE_INSTALL_PREFIX="$scratch/by-cmake"
sed -n 's/.*"command": "\(.*\)".*/\1/p' "$scratch/own/compile_commands.json" \
  | sed -E "s|.* -c $PWD/(umat/.*)\.c$|\1.o|; s|.*-DMPMI_ISA=([a-z0-9_]+) .* -c [^ ]*/src/(.*)\.c$|\2.\1.o|; s|.* -c [^ ]*/src/(.*)\.c$|\1.o|" | sort > "$scratch/cmake-objects"
"$MAKE" -s BUILD="$BUILD" CC="$CC" --eval 'show-objects:; @printf "%s\n" $(OBJECTS:$(BUILD)/obj/src/%=%) $(patsubst $(BUILD)/obj/%,%,$(UMAT_OBJECTS) $(UTILITY_OBJECTS))' show-objects \
  | sort > "$scratch/make-objects"
if ! diff "$scratch/make-objects" "$scratch/cmake-objects"; then
  echo "cmake.sh: '<' is compiled by the Makefile alone, '>' by CMakeLists.txt alone" >&2
  exit 1
fi
echo "cmake.sh: $(wc -l < "$scratch/cmake-objects") objects by CMakeLists.txt as by the Makefile"

if [ "${1:-}" = full ]; then
  cmake --build "$scratch/own" --parallel "${JOBS:-2}" > "$scratch/own.log" || { cat "$scratch/own.log"; exit 1; }
  cmake --install "$scratch/own" > "$scratch/own.log"
  mv "$scratch/by-cmake" "$scratch/by-cmake-moved"
  (cd "$scratch/by-cmake-moved" && find . -type f -o -type l) | sort > "$scratch/by-cmake.list"
  "$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX="$scratch/by-make" DESTDIR= > /dev/null
  (cd "$scratch/by-make" && find . -type f -o -type l) | sort | diff - "$scratch/by-cmake.list" \
    || { echo "cmake.sh: the two installations have other files" >&2; exit 1; }
  for folder in pkgconfig cmake; do # other files say the same, too
    diff -r "$scratch/by-make/lib/$folder" "$scratch/by-cmake-moved/lib/$folder" || { echo "cmake.sh: '<' by make, '>' by cmake" >&2; exit 1; }
  done
  hosts by-cmake "$scratch/by-cmake-moved" "$scratch/by-cmake-moved/lib"
  [ "$(PKG_CONFIG_PATH=$scratch/by-cmake-moved/lib/pkgconfig "${PKG_CONFIG:-pkg-config}" --modversion mpm)" = "$version" ]
  for way in subdirectory fetch; do
    configure "$scratch/$way" tests/api/cmake/ways -DWAY=$way -DMPM_SOURCE="$PWD" -DMPM_BASELINE_ONLY=ON -DCMAKE_BUILD_TYPE=Debug
    cmake --build "$scratch/$way" --parallel "${JOBS:-2}" > "$scratch/$way.log" || { cat "$scratch/$way.log"; exit 1; }
    for program in shared static; do
      printf 'cmake.sh: %s, %s: ' $way $program
      "$scratch/$way/$program" "$version"
    done
  done
  # for Windows, where the tools for it are there: the DLL, found in the installation
  if command -v x86_64-w64-mingw32-gcc > /dev/null; then
    cross=(-DCMAKE_SYSTEM_NAME=Windows -DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc -DCMAKE_RC_COMPILER=x86_64-w64-mingw32-windres)
    configure "$scratch/windows" . "${cross[@]}" -DMPM_BASELINE_ONLY=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_INSTALL_PREFIX="$scratch/for-windows"
    cmake --build "$scratch/windows" --parallel "${JOBS:-2}" --target install > "$scratch/windows.log" || { cat "$scratch/windows.log"; exit 1; }
    ls "$scratch/for-windows/bin/libmpm-${version%%.*}.dll" "$scratch/for-windows/lib/libmpm.dll.a" "$scratch/for-windows/lib/libmpm.a" > /dev/null
    configure "$scratch/windows-host" tests/api/cmake "${cross[@]}" -DLANGUAGE=C -DCMAKE_PREFIX_PATH="$scratch/for-windows" \
      -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=BOTH
    cmake --build "$scratch/windows-host" > "$scratch/windows-host.log" || { cat "$scratch/windows-host.log"; exit 1; }
    x86_64-w64-mingw32-objdump -p "$scratch/windows-host/shared.exe" | grep -q "DLL Name: libmpm-${version%%.*}.dll"
    if x86_64-w64-mingw32-objdump -p "$scratch/windows-host/static.exe" | grep 'DLL Name: libmpm'; then exit 1; fi
    echo "cmake.sh: the DLL and hosts of it, for Windows"
  fi
fi

"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX="$scratch/prefix" DESTDIR= > /dev/null
mv "$scratch/prefix" "$scratch/moved"
hosts moved "$scratch/moved" "$scratch/moved/lib"
"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX=/opt/mpm LIBDIR=/opt/mpm/lib/x86_64-linux-gnu DESTDIR="$scratch/stage" \
  > /dev/null
hosts staged "$scratch/stage/opt/mpm" "$scratch/stage/opt/mpm/lib/x86_64-linux-gnu"
