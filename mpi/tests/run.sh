#!/usr/bin/env bash
# libmpm-mpi on 1 to 4 processes of Open MPI and of MPICH, those that are there: the transport by itself, files, processes that
# fail; states that other numbers of processes go on from, with the bits of a run without MPI, where steps fail on one process; once more with small pieces in the place of two gigabytes, and under the sanitizers of addresses and undefined
# behaviour; hosts in C and C++ by pkg-config, from an installation; the example, whose bits do not depend on the processes.
#
#   run.sh tests     the tests alone, by the first MPI: what planted faults must fail
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc} CXX=${CXX:-g++} MAKE=${MAKE:-make} PKG_CONFIG=${PKG_CONFIG:-pkg-config}
BUILD=$(cd "$BUILD" && pwd)
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/mpi
rm -rf "$scratch"
mkdir -p "$scratch"
scratch=$(cd "$scratch" && pwd)
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion ${WERROR:-}"
limit=${MPI_LIMIT:-300}

# What starts processes, more of them than there are processors, also for root.
launcher() { # package
  local name
  case $1 in
  ompi-c) for name in mpirun.openmpi orterun; do command -v $name && return; done ;;
  mpich) for name in mpirun.mpich mpiexec.hydra; do command -v $name && return; done ;;
  esac
}
run() { # processes, program, arguments...
  local n=$1 options=()
  shift
  if [ "$package" = ompi-c ]; then
    options=(--oversubscribe)
    [ "$(id -u)" != 0 ] || options+=(--allow-run-as-root)
  fi
  timeout "$limit" "$start" "${options[@]}" -n "$n" "$@"
}
must() { # what, processes, program, arguments...
  local status=0
  run "${@:2}" > "$scratch/log" 2>&1 || status=$?
  [ $status = 0 ] && return
  head -n 40 "$scratch/log" >&2
  echo "mpi: $package: $1 on $2 processes: status $status" >&2
  exit 1
}

flags() { # package: what compilers take; its headers are the system's
  "$PKG_CONFIG" --cflags "$1" | sed 's/-I/-isystem /g'
}
build() { # folder, flags...: the tests with the sources of the library
  local folder=$scratch/$package-$1 flags=("${@:2}") source
  mkdir -p "$folder"
  for source in mpi/src/*.c mpi/tests/{meet,read_vtk,test_transport,test_files,test_states}.c tests/unit/transport_rounds.c; do
    # shellcheck disable=SC2046,SC2086
    "$CC" -std=c11 $warnings -g "${flags[@]}" -Iinclude -Impi/include -Impi/src -Itests/unit $(flags $package) -c "$source" -o "$folder/${source//\//_}.o" || exit 1
  done
  rm -f "$folder/libmpm-mpi.a"
  ar rcs "$folder/libmpm-mpi.a" "$folder"/mpi_src_*.o
  # meet.o stands between the libraries and some functions, of theirs and of MPI
  link "$folder" transport '' mpi_tests_test_transport.c tests_unit_transport_rounds.c
  link "$folder" files ,--wrap=mpm_state_load_pieces mpi_tests_test_files.c mpi_tests_read_vtk.c
  link "$folder" states '' mpi_tests_test_states.c
}
link() { # folder, program, more for the linker, objects...; flags are those of build()
  # shellcheck disable=SC2046
  "$CC" "${flags[@]}" $(printf "$1/%s.o " "${@:4}" mpi_tests_meet.c) "$1/libmpm-mpi.a" "$BUILD/libmpm.a" \
    "-Wl,--wrap=mpm_version$3" $("$PKG_CONFIG" --libs $package) -lm -lpthread -o "$1/$2"
}
files() { # folder, processes
  mkdir -p "$scratch/$package-$1/out-$2"
  must "$1: files" "$2" "$scratch/$package-$1/files" "$scratch/$package-$1/out-$2"
}

result_of() { # what: the hash that the last run has printed
  sed -n 's/^result: //p' "$scratch/log" | grep . || { echo "mpi: $package: $1: no result" >&2; exit 1; }
}
# A run that goes on with other processes, whose steps first fail on one of them, and one of which a process dies, have the
# bits of one that does not stop, on one thread and without a transport: for implicit steps, too, whose solver has a name there.
restart() { # folder
  scheme=explicit restart_of "$1" 30 17 # more than one sort
  scheme=implicit restart_of "$1" 12 8
}
restart_of() { # folder, steps, the step in which a process is killed
  local states="$scratch/$package-$1/states $scheme" at=$scratch/$package-$1/states-out wanted result status=0 from=- n last
  rm -rf "$at"
  mkdir -p "$at"
  # shellcheck disable=SC2086
  {
    must "$1: without a transport, $scheme" 1 $states - - "$2"
    wanted=$(result_of "$1: without a transport, $scheme")
    for n in 4 3 1; do
      case $n in 4) last=5 ;; 3) last=10 ;; 1) last=$2 ;; esac
      must "$1: restart, $scheme" $n $states "$at/run.state" "$from" $last fails
      result=$(result_of "$1: restart, $scheme")
      from=$at/run.state
    done
    [ "$result" = "$wanted" ] || { echo "mpi: $package: $1: restart 4, 3, 1, $scheme: $result, wanted $wanted" >&2; exit 1; }
    run 3 $states "$at/killed.state" - "$2" dies "$3" > "$scratch/log" 2>&1 || status=$?
    case $status in 0 | 124) echo "mpi: $package: $1: a process was killed, and the others went on or waited ($status)" >&2; exit 1 ;; esac
    must "$1: after a process was killed" 2 $states "$at/killed.state" "$at/killed.state" "$2"
    grep -q "^from step $((($3 - 1) / 5 * 5))\$" "$scratch/log" || { echo "mpi: $package: $1: it does not go on from the last state" >&2; exit 1; }
    result=$(result_of "$1: after a process was killed")
  }
  [ "$result" = "$wanted" ] || { echo "mpi: $package: $1: after a process was killed, $scheme: $result, wanted $wanted" >&2; exit 1; }
}

# MPI_TESTS=quick: one MPI, up to three processes, without small pieces and sanitizers
many="1 2 3 4" kinds="pieces sanitized" known="ompi-c mpich"
if [ "${MPI_TESTS:-}" = quick ]; then many="1 2 3" kinds= known="ompi-c"; fi
find_packages() { # and what Debian calls those that are missing; the tests alone take any MPI, and no VTK
  local package candidate
  packages= missing= python=
  for package in $known; do
    if "$PKG_CONFIG" --exists $package && [ -n "$(launcher $package)" ]; then
      packages="$packages $package"
    else
      case $package in ompi-c) missing="$missing libopenmpi-dev openmpi-bin" ;; mpich) missing="$missing libmpich-dev mpich" ;; esac
    fi
  done
  if [ "$mode" = tests ]; then
    [ -z "$packages" ] || missing=
    return 0
  fi
  for candidate in python3 /usr/bin/python3; do
    "$candidate" -c 'import vtkmodules.vtkIOXML' 2> /dev/null && python=$candidate && return
  done
  missing="$missing python3-vtk9"
}
mode=${1:-}
find_packages
if [ -n "$missing" ] && [ "${SKIP_MISSING:-}" != 1 ] && command -v apt-get > /dev/null; then
  sudo=
  if [ "$(id -u)" != 0 ]; then sudo=sudo; fi
  $sudo apt-get update -q
  # shellcheck disable=SC2086
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
  find_packages
fi
if [ -n "$missing" ]; then
  echo "mpi: not there:$missing" >&2
  if [ "${SKIP_MISSING:-}" != 1 ]; then
    echo 'mpi: SKIP_MISSING=1 does without' >&2
    exit 1
  fi
  [ -n "$python" ] || [ "$mode" = tests ] || echo 'mpi: files are not read back' >&2
  [ -n "$packages" ] || exit 0
fi
if [ "$mode" = tests ]; then
  read -r package rest <<< "$packages"
  start=$(launcher "$package")
  build plain -O1
  build pieces -O1 -DMPMX_PIECE=1000
  for folder in plain pieces; do
    for test in rounds wrong faults most; do must "$test" 3 "$scratch/$package-$folder/transport" $test; done
    files $folder 3
  done
  must open 3 "$scratch/$package-plain/transport" open
  restart plain
  exit 0
fi

for package in $packages; do
  start=$(launcher $package)
  build plain -O1
  for n in $many; do
    for test in rounds wrong open faults most; do must "$test" $n "$scratch/$package-plain/transport" $test; done
    files plain $n
    if [ -n "$python" ]; then "$python" mpi/tests/read_vtk.py "$scratch/$package-plain/out-$n" $n; fi
  done
  restart plain
  # a process that ends without a word: the others end, too, and do not wait
  status=0
  run 3 "$scratch/$package-plain/transport" dies > "$scratch/log" 2>&1 || status=$?
  case $status in 0 | 124) echo "mpi: $package: a process ended, and the others went on or waited ($status)" >&2; exit 1 ;; esac
  if [ -n "$kinds" ]; then
    build pieces -O1 -DMPMX_PIECE=1000
    for n in 2 3; do
      for test in rounds faults; do must "$test in pieces" $n "$scratch/$package-pieces/transport" $test; done
      files pieces $n
    done
    restart pieces
    # MPI keeps memory until the end, and some of it beyond
    build sanitized -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    export ASAN_OPTIONS=detect_leaks=0:strict_string_checks=1
    for test in rounds wrong open faults; do must "$test, sanitized" 2 "$scratch/$package-sanitized/transport" $test; done
    files sanitized 2
    restart sanitized
    unset ASAN_OPTIONS
  fi
  echo "mpi: $package: transport and files: ok"
done

# ---- installed, for one MPI after the other
for package in $packages; do
  start=$(launcher $package)
  prefix=$scratch/$package-prefix out=$scratch/$package-build
  mkdir -p "$out"
  # the library itself is the same for all: only what stands on MPI is made anew
  cp -p "$BUILD"/libmpm.a "$BUILD"/libmpm*.so* "$BUILD"/libmpm-umat*.a "$out"
  "$MAKE" -s -o "$out/libmpm.a" -o "$out/libmpm.so.$("$MAKE" -s --eval 'show:; @echo $(VERSION)' show)" BUILD="$out" CC="$CC" \
    MPI_PACKAGE=$package PREFIX="$prefix" DESTDIR= install install-mpi mpi-examples > /dev/null
  export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
  read -ra cflags <<< "$("$PKG_CONFIG" --cflags mpm-mpi)"
  read -ra shared <<< "$("$PKG_CONFIG" --libs mpm-mpi)"
  read -ra static <<< "$("$PKG_CONFIG" --libs mpm-mpi-static)"
  "$CC" -std=c11 -Wall -Wextra -Werror "${cflags[@]}" -c mpi/tests/host.c -o "$scratch/host_c.o"
  "$CXX" -std=c++17 -Wall -Wextra -Werror -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX "${cflags[@]}" -c mpi/tests/host.cpp -o "$scratch/host_cpp.o"
  for language in c cpp; do
    for way in shared static; do
      libraries=("${shared[@]}")
      [ $way = shared ] || libraries=("${static[@]}")
      "$CXX" "$scratch/host_$language.o" "${libraries[@]}" -o "$scratch/program"
      LD_LIBRARY_PATH=$prefix/lib must "host in $language, $way" 2 "$scratch/program" "$scratch"
      grep -q '^2 parts$' "$scratch/log" || { echo "mpi: $package: the host in $language does not see two parts" >&2; exit 1; }
    done
  done
  readelf -d "$out/libmpm-mpi.so" | grep -q 'SONAME.*\[libmpm-mpi\.so\.0\]'
  nm -D --defined-only "$out/libmpm-mpi.so" | awk '$2 != "A" { sub("@.*", "", $3); print $3 }' | sort > "$scratch/exported"
  sed -nE 's/^MPM_MPI_API .*[ *](mpm_mpi_[a-z_]+)\(.*/\1/p' mpi/include/mpm/mpm_mpi.h | sort | diff - "$scratch/exported"
  "$MAKE" -s PREFIX="$prefix" DESTDIR= uninstall uninstall-mpi > /dev/null
  if find "$prefix" -type f -o -type l | grep .; then
    echo "mpi: uninstall left these behind" >&2
    exit 1
  fi

  # the same bits on any number of processes, and when as many others go on
  cells=8 frames=12 wanted=
  for n in $many; do
    mkdir -p "$scratch/$package-dam-$n"
    (cd "$scratch/$package-dam-$n" && must "example" $n "$out/examples/dam_break_mpi" $cells $frames)
    result=$(grep '^result:' "$scratch/log")
    [ -n "$wanted" ] || wanted=$result
    [ "$result" = "$wanted" ] || { echo "mpi: $package: on $n processes: $result, on one: $wanted" >&2; exit 1; }
    points=$(sed -n 's/.*NumberOfPoints="\([0-9]*\)".*/\1/p' -- "$scratch/$package-dam-$n"/water_0005/*.vtp 2> /dev/null | paste -sd +)
    points=$((points))
    [ "$points" = $((8 * cells * cells * cells)) ] || { echo "mpi: $package: on $n processes: $points points" >&2; exit 1; }
  done
  for n in 2 ${many##* }; do
    (cd "$scratch/$package-dam-3" && must "example, going on" $n "$out/examples/dam_break_mpi" $cells $frames water.state)
    result=$(grep '^result:' "$scratch/log")
    [ "$result" = "$wanted" ] || { echo "mpi: $package: from 3 to $n processes: $result, on one: $wanted" >&2; exit 1; }
  done
  echo "mpi: $package: installed, and the example: ok, $wanted"
done
