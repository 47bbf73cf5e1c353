#!/usr/bin/env bash
# libmpm-umat with subroutines in Fortran: the tests of this folder, once more under the sanitizers of addresses and
# undefined behaviour; what a step costs; hosts in C++ and Fortran by pkg-config, from an installation; the example.
#
#   run.sh tests     the tests alone, without the sanitizers: what planted faults must fail
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} CXX=${CXX:-g++} FC=${FC:-gfortran} MAKE=${MAKE:-make} PKG_CONFIG=${PKG_CONFIG:-pkg-config}
BUILD=$(cd "$BUILD" && pwd)
if ! command -v "$FC" > /dev/null; then
  echo "umat: skipped: there is no Fortran compiler ($FC)"
  exit 0
fi
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/umat
rm -rf "$scratch"
mkdir -p "$scratch"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion ${WERROR:-}"
read -ra check_flags <<< "$("$PKG_CONFIG" --cflags check)"
read -ra check_libs <<< "$("$PKG_CONFIG" --libs check)"

wait_for_all() { local job; for job in $(jobs -p); do wait "$job"; done; }
for source in laws vumats; do
  "$FC" -O2 -g -Wall -Wno-unused-dummy-argument -Wno-unused-variable -Werror -c tests/umat/$source.f90 -o "$scratch/$source.o" &
done
wait_for_all

compile() { # name, flags, sources...: objects in a folder of that name
  local name=$1 flags=$2 source
  mkdir -p "$scratch/$name"
  for source in "${@:3}"; do
    # shellcheck disable=SC2086
    "$CC" -std=c11 $warnings -g $flags -Iinclude -Iumat/include "${check_flags[@]}" -c "$source" -o "$scratch/$name/${source//\//_}.o" &
  done
  wait_for_all
}
tests=(tests/umat/{main,element,runs,failures,vumat}.c)
link() { # name, flags, libraries...
  # shellcheck disable=SC2086
  "$CC" $2 "$scratch/$1"/*.o "$scratch"/{laws,vumats}.o "${@:3}" "$BUILD/libmpm.a" "${check_libs[@]}" -lgfortran -lm -lpthread -o "$scratch/$1/umat"
}
compile plain -O1 "${tests[@]}"
link plain '' "$BUILD"/libmpm-umat{-utilities,}.a
"$scratch/plain/umat"
[ "${1:-}" = tests ] && exit 0

# the program of the documents
awk '/^```c$/ {inside = 1; next} /^```/ {inside = 0} inside' docs/umat.md > "$scratch/document.c"
grep -q mpm_umat_material "$scratch/document.c"
"$CC" -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude -Iumat/include -fsyntax-only "$scratch/document.c"

sanitized="-O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
compile sanitized "$sanitized" "${tests[@]}" umat/src/*.c umat/utilities/*.c
link sanitized "$sanitized"
ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 CK_TIMEOUT_MULTIPLIER=5 "$scratch/sanitized/umat" | tail -n 1

# processor time, the least of three rounds: a busy machine makes it worse for both
compile speed -O2 tests/umat/speed.c
"$CC" "$scratch"/speed/*.o "$scratch"/{laws,vumats}.o "$BUILD"/libmpm-umat{-utilities,}.a "$BUILD/libmpm.a" -lgfortran -lm -lpthread -o "$scratch/speed/speed"
"$scratch/speed/speed" 8

# ---- installed
prefix=$scratch/prefix
"$MAKE" -s install BUILD="$BUILD" CC="$CC" PREFIX="$prefix" DESTDIR= > /dev/null
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags() { "$PKG_CONFIG" "$@"; }
read -ra include <<< "$(flags --cflags mpm-umat)"
read -ra shared <<< "$(flags --libs mpm-umat)"
read -ra static <<< "$(flags --libs mpm-umat-static)"
"$CXX" -std=c++17 -Wall -Wextra -Werror "${include[@]}" -c tests/umat/host.cpp -o "$scratch/host_cpp.o" &
"$FC" -Wall -Wno-unused-dummy-argument -J "$scratch" -c tests/umat/host.f90 -o "$scratch/host_f90.o" &
wait_for_all
for way in shared static; do
  libraries=("${shared[@]}")
  [ $way = shared ] || libraries=("${static[@]}")
  "$CXX" "$scratch/host_cpp.o" "$scratch"/{laws,vumats}.o "${libraries[@]}" -lgfortran -o "$scratch/cpp_$way"
  "$FC" "$scratch/host_f90.o" "$scratch/laws.o" "${libraries[@]}" -o "$scratch/f90_$way"
  for host in cpp f90; do
    printf 'umat: %s, %s: ' $host $way
    LD_LIBRARY_PATH=$prefix/lib "$scratch/${host}_$way"
  done
done
if readelf -d "$scratch"/{cpp,f90}_static | grep 'NEEDED.*libmpm'; then
  echo "umat: a static program still needs a shared library" >&2
  exit 1
fi
readelf -d "$scratch/cpp_shared" | grep -q 'NEEDED.*libmpm-umat\.so\.0'

# ---- the example
"$MAKE" -s BUILD="$BUILD" CC="$CC" FC="$FC" "$BUILD/umat/footing"
"$BUILD/umat/footing" "$scratch" > "$scratch/footing.out" || { cat "$scratch/footing.out"; exit 1; }
result=$(tail -n 1 "$scratch/footing.out")
echo "umat: footing: $result"
awk '/^result:/ { found = $3 >= 4.9 && $3 <= 5.9 } END { exit !found }' <<< "$result" || { echo "umat: footing: the load is not as measured" >&2; exit 1; }
[ -s "$scratch/footing.svg" ]
