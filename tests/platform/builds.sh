#!/usr/bin/env bash
# Builds the library with other compilers, optimisations and C libraries than the usual ones, with warnings as errors, and
# runs a host program with each: one line for each, with the same bits. What is not installed is skipped by name; what is
# there must pass. BUILDS="gcc-11 musl" selects.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=$(mkdir -p "${BUILD:-build}" && cd "${BUILD:-build}" && pwd) MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)}
PKG_CONFIG=${PKG_CONFIG:-pkg-config}
out=$here-builds
mkdir -p "$out"
BUILDS=${BUILDS:-O0 Og Os lto no-threads no-files no-system gcc-11 clang-13 clang-14 clang-16 clang-19 musl i686 x87 s390x spaces}
smoke=tests/platform/smoke.c
"$here/tests/platform/smoke" baseline "$here/tests/scratch" > "$out/expected" 2> /dev/null
unset MAKEFLAGS MFLAGS MAKELEVEL

# name, what it needs, runner, arguments of make...; LINK has what programs are linked with besides.
build() {
  local name=$1 needs=$2 run=$3 from=$SECONDS compiler=cc argument said
  shift 3
  if ! eval "$needs" > /dev/null 2>&1; then
    echo "$name: skipped: not installed ($needs)"
    return
  fi
  for argument; do case $argument in CC=*) compiler=${argument#CC=} ;; esac; done
  mkdir -p "$out/$name/files"
  # shellcheck disable=SC2086
  if ! { "$MAKE" -j"$JOBS" BUILD="$out/$name" WERROR=-Werror KERNEL_OPT=-O1 OPT=-O1 CFLAGS= "$@" "$out/$name/libmpm.a" &&
    $compiler -std=c11 -Iinclude $smoke ${FLAGS-} "$out/$name/libmpm.a" -lm ${LINK--lpthread} -o "$out/$name/smoke" &&
    $run "$out/$name/smoke" baseline "$out/$name/files" > "$out/$name/found" 2> "$out/$name/said" &&
    diff "$out/expected" "$out/$name/found" && $run "$out/$name/smoke" best "$out/$name/files"; } > "$out/$name/log" 2>&1; then
    tail -n 20 "$out/$name/log" "$out/$name"/found "$out/$name"/said >&2 || :
    echo "$name: failed: see $out/$name/log"
    failed=1
    return
  fi
  said=$(cat "$out/$name/said")
  echo "$name: the same bits, $said, $((SECONDS - from)) s"
}

refused() { # name, what it needs, words, command...
  local name=$1 needs=$2 words=$3
  shift 3
  if ! eval "$needs" > /dev/null 2>&1; then
    echo "$name: skipped: not installed ($needs)"
  elif grep -q "$words" <<< "$("$@" 2>&1)"; then
    echo "$name: refused, as it must be"
  else
    echo "$name: failed: it is not refused with the words: $words"
    failed=1
  fi
}

host() { # packages, program, run with...
  local packages=$1 program=$2
  shift 2
  eval "cc -std=c11 $smoke $("$PKG_CONFIG" --cflags --libs $packages) -o '$program'"
  "$@" "$program" baseline "$out/spaces/files" | diff "$out/expected" -
}

# Sources and installation in folders with spaces; the installation is moved, and found again by pkg-config.
spaces() {
  local tree="$out/spaces/the sources" prefix="$out/spaces/my prefix" moved="$out/spaces/moved away"
  rm -rf "$out/spaces"
  mkdir -p "$tree" "$out/spaces/files"
  cp -r Makefile platform.mk src umat include pkgconfig cmake tests examples bench "$tree"
  (cd "$tree" && "$MAKE" -j"$JOBS" ISAS=baseline CPPFLAGS=-DMPM_BASELINE_ONLY KERNEL_OPT=-O0 OPT=-O0 CFLAGS= \
    PREFIX="$prefix" install)
  mv "$prefix" "$moved"
  export PKG_CONFIG_PATH="$moved/lib/pkgconfig"
  host mpm "$out/spaces/shared" env LD_LIBRARY_PATH="$moved/lib"
  host mpm-static "$out/spaces/static"
  if readelf -d "$out/spaces/static" | grep libmpm; then return 1; fi
  host '--static mpm-static' "$out/spaces/static"
  (cd "$tree" && "$MAKE" -s PREFIX="$moved" uninstall)
  if find "$moved" -type f -o -type l | grep .; then return 1; fi
}

failed=0
for name in $BUILDS; do
  case $name in
  O0 | Og | Os) build "$name" 'command -v cc' '' OPT=-"$name" KERNEL_OPT=-"$name" ;;
  lto) FLAGS=-flto build lto 'command -v cc' '' CFLAGS=-flto OPT=-O2 ;;
  no-threads) build $name 'command -v cc' '' CPPFLAGS=-DMPM_NO_THREADS ;;
  no-files) build $name 'command -v cc' '' CPPFLAGS=-DMPM_NO_FILES ;;
  no-system) build $name 'command -v cc' '' CPPFLAGS=-DMPM_NO_SYSTEM ;;
  gcc-* | clang-*) build "$name" "command -v $name" '' CC="$name" ;;
  musl) LINK=-static build musl 'command -v musl-gcc' '' CC=musl-gcc ;;
  i686)
    FLAGS='-msse2 -mfpmath=sse -static' build i686 'command -v i686-linux-gnu-gcc' '' CC=i686-linux-gnu-gcc \
      AR=i686-linux-gnu-ar CFLAGS='-msse2 -mfpmath=sse'
    ;;
  x87) refused x87 'cc -m32 -E -x c /dev/null' 'doubles are not evaluated as doubles' \
    cc -m32 -mno-sse -ffreestanding -std=c11 -Iinclude -Isrc -fsyntax-only src/transfer/update.c ;;
  s390x)
    FLAGS='-static' build s390x 'command -v s390x-linux-gnu-gcc && command -v qemu-s390x' qemu-s390x CC=s390x-linux-gnu-gcc \
      AR=s390x-linux-gnu-ar
    ;;
  spaces)
    if (set -e && spaces) > "$out/spaces.log" 2>&1; then
      echo 'spaces: sources and an installation that was moved, by pkg-config, shared and static'
    else
      tail -n 20 "$out/spaces.log" >&2
      echo "spaces: failed: see $out/spaces.log"
      failed=1
    fi
    ;;
  *)
    echo "there is no build $name"
    failed=1
    ;;
  esac
done
exit $failed
