#!/usr/bin/env bash
# libmpm-petsc on 1 to 4 processes: what is refused, solvers that fail; the history of Newton's method is that of one process;
# the same answer as the library's conjugate gradients; a host in C++ by pkg-config, from an installation; the example. Prints
# how many iterations GAMG takes on each number of processes: at most 1.15 times as many on one as on another with 10 or 12 cells.
#
#   run.sh tests     the tests alone: what planted faults must fail
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} CXX=${CXX:-g++} MAKE=${MAKE:-make} PKG_CONFIG=${PKG_CONFIG:-pkg-config}
BUILD=$(cd "$BUILD" && pwd)
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/petsc
cells=${PETSC_CELLS:-12}
rm -rf "$scratch"
mkdir -p "$scratch"
scratch=$(cd "$scratch" && pwd)
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion ${WERROR:-}"

if ! "$PKG_CONFIG" --exists 'PETSc >= 3.17' mpi-c || ! command -v mpirun > /dev/null; then
  echo 'petsc: skipped: there is no PETSc 3.17 with MPI (petsc-dev, mpi-default-bin)'
  exit 0
fi
options=()
if mpirun --version 2>&1 | grep -q 'Open MPI'; then
  options=(--oversubscribe)
  [ "$(id -u)" != 0 ] || options+=(--allow-run-as-root)
fi
must() { # what, processes, program, arguments...
  local status=0
  timeout "${PETSC_LIMIT:-600}" mpirun "${options[@]}" -n "${@:2}" > "$scratch/log" 2>&1 || status=$?
  [ $status = 0 ] && return
  head -n 40 "$scratch/log" >&2
  echo "petsc: $1 on $2 processes: status $status" >&2
  exit 1
}
silent() { # what: the last run has printed nothing
  [ ! -s "$scratch/log" ] || { cat "$scratch/log" >&2; echo "petsc: $1 has printed something" >&2; exit 1; }
}

read -ra flags <<< "$("$PKG_CONFIG" --cflags-only-I PETSc mpi-c | sed 's/-I/-isystem /g')"
read -ra libraries <<< "$("$PKG_CONFIG" --libs PETSc mpi-c)"
objects=()
for source in petsc/src/*.c petsc/tests/test_petsc.c mpi/src/*.c; do
  object=$scratch/${source//\//_}.o
  # shellcheck disable=SC2086
  "$CC" -std=c11 $warnings -g -O1 -Iinclude -Ipetsc/include -Impi/include "${flags[@]}" -c "$source" -o "$object"
  objects+=("$object")
done
"$CC" "${objects[@]}" "$BUILD/libmpm.a" "${libraries[@]}" -lm -lpthread -o "$scratch/test_petsc"

for n in 1 2 3; do
  must 'what is refused' $n "$scratch/test_petsc" faults
  silent 'what is refused'
done
must 'as conjugate gradients' 1 "$scratch/test_petsc" gradients 6
cat "$scratch/log"
for law in neo_hookean j2; do
  least= most=
  for n in 1 2 3 4; do
    must "$law" $n "$scratch/test_petsc" history $law "$cells" "$scratch/$law.history"
    cat "$scratch/log"
    iterations=$(sed -n 's/.* \([0-9]*\) iterations,.*/\1/p' "$scratch/log")
    [ -n "$least" ] || least=$iterations most=$iterations
    [ "$iterations" -ge "$least" ] || least=$iterations
    [ "$iterations" -le "$most" ] || most=$iterations
  done
  [ $((100 * most)) -le $((115 * least)) ] || { echo "petsc: $law: from $least to $most iterations" >&2; exit 1; }
done
echo 'petsc: solver: ok'
[ "${1:-}" != tests ] || exit 0

# ---- installed
prefix=$scratch/prefix
"$MAKE" -s BUILD="$BUILD" CC="$CC" PREFIX="$prefix" DESTDIR= install install-petsc > /dev/null
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
for way in '' -static; do
  # shellcheck disable=SC2046
  "$CXX" -std=c++17 -Wall -Wextra -Werror -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX petsc/tests/host.cpp \
    $("$PKG_CONFIG" --cflags --libs mpm-petsc$way | sed 's|-I/usr|-isystem /usr|g') -o "$scratch/host$way"
  LD_LIBRARY_PATH=$prefix/lib must "host in C++$way" 1 "$scratch/host$way"
  grep -qE '^[1-9][0-9]* solves, [1-9] patterns$' "$scratch/log"
done
readelf -d "$BUILD/libmpm-petsc.so" | grep -q 'SONAME.*\[libmpm-petsc\.so\.0\]'
nm -D --defined-only "$BUILD/libmpm-petsc.so" | awk '$2 != "A" { sub("@.*", "", $3); print $3 }' | sort > "$scratch/exported"
tr '\n' ' ' < petsc/include/mpm/mpm_petsc.h | grep -oE 'MPM_PETSC_API [a-z_ *]*mpm_petsc_[a-z_]+\(' | sed -E 's/.*[ *](mpm_petsc_[a-z_]+)\($/\1/' | sort | diff - "$scratch/exported"
"$MAKE" -s BUILD="$BUILD" PREFIX="$prefix" DESTDIR= uninstall uninstall-petsc > /dev/null
if find "$prefix" -type f -o -type l | grep .; then
  echo 'petsc: uninstall left these behind' >&2
  exit 1
fi
"$MAKE" -s BUILD="$BUILD" CC="$CC" "$BUILD/examples/petsc_solver"
BUILD=$BUILD EXAMPLES_RUN=petsc_solver sh tests/examples/run.sh
echo 'petsc: installed, and the example: ok'
