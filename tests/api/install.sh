#!/usr/bin/env bash
# Installs into a scratch prefix and builds host programs against it through pkg-config, as a user would: C and C++,
# shared and static. Then uninstalls and expects nothing to be left.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} CXX=${CXX:-g++} MAKE=${MAKE:-make} PKG_CONFIG=${PKG_CONFIG:-pkg-config}
BUILD=$(cd "$BUILD" && pwd)
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/install
rm -rf "$scratch"
mkdir -p "$scratch"
prefix=$scratch/prefix

"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX="$prefix" DESTDIR= > /dev/null
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
version=$("$PKG_CONFIG" --modversion mpm)

# `make` alone makes everything.
"$MAKE" -pn 2> /dev/null | grep -x '.DEFAULT_GOAL := all' > /dev/null
# One version everywhere.
grep -qx "version: $version" CITATION.cff
[ "$(sed -n '/(unreleased)$/d; s/^## //p' CHANGELOG.md | head -n 1)" = "$version" ]
grep -qx "set(PACKAGE_VERSION \"$version\")" "$prefix/lib/cmake/mpm/mpmConfigVersion.cmake"
bash packaging/recipes/check.sh

flags() { "$PKG_CONFIG" "$@"; }
build() { # compiler, standard, source, program, libraries...
  local compiler=$1 standard=$2 source=$3 program=$scratch/$4
  shift 4
  # shellcheck disable=SC2046
  "$compiler" -std="$standard" -Wall -Wextra -Werror $(flags --cflags mpm) "$source" -o "$program" "$@"
}
# shellcheck disable=SC2207
shared=($(flags --libs mpm)) static=($(flags --libs mpm-static))

build "$CC" c99 tests/api/host.c c_shared "${shared[@]}"
build "$CC" c99 tests/api/host.c c_static "${static[@]}"
build "$CXX" c++17 tests/api/host.cpp cpp_shared "${shared[@]}"
build "$CXX" c++17 tests/api/host.cpp cpp_static "${static[@]}"
for program in c_shared c_static cpp_shared cpp_static; do
  printf 'install.sh: %s: ' $program
  case $program in
  *_shared) LD_LIBRARY_PATH=$prefix/lib "$scratch/$program" "$version" ;;
  *) "$scratch/$program" "$version" ;;
  esac
done
if readelf -d "$scratch/c_static" | grep libmpm; then
  echo "install.sh: the static program still needs the shared library" >&2
  exit 1
fi

# A package is staged under DESTDIR. Under a prefix of its own its files find each other wherever they are moved; under
# /usr they speak of the prefix, so that pkg-config knows the folders of the system.
"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX=/opt/mpm DESTDIR="$scratch/stage" > /dev/null
[ "$(PKG_CONFIG_PATH=$scratch/stage/opt/mpm/lib/pkgconfig flags --variable=includedir mpm | xargs realpath)" = \
  "$(realpath "$scratch/stage/opt/mpm/include")" ]
"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX=/usr LIBDIR=/usr/lib/x DESTDIR="$scratch/stage" > /dev/null
[ "$(PKG_CONFIG_PATH=$scratch/stage/usr/lib/x/pkgconfig flags --cflags mpm)" = "" ]

"$MAKE" -s uninstall PREFIX="$prefix" DESTDIR= > /dev/null
if find "$prefix" -type f -o -type l | grep .; then
  echo "install.sh: uninstall left these behind" >&2
  exit 1
fi
