#!/usr/bin/env bash
# Compiles the library and its unit tests for aarch64 and runs them under qemu: another processor, another compiler
# backend, no x86 kernels. What a Debian machine lacks is installed (the compiler, qemu) or unpacked into the build
# folder (Check for arm64, which so needs no foreign packages on the machine).
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$(mkdir -p "${BUILD:-build}-aarch64" && cd "${BUILD:-build}-aarch64" && pwd)
export MPM_EMULATED=1
triplet=aarch64-linux-gnu MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)}
# Left out unless SUITES asks: runs against analytical solutions and through every failing allocation, minutes each, that
# show no more of the processor than those that stay.
SUITES=${SUITES:-$(sed -n 's/^SUITE(\(.*\))$/\1/p' tests/unit/suites.h | grep -vxE 'waves|impact|walls|allocation')}

install_tools() {
  local sudo=
  if command -v $triplet-gcc > /dev/null && command -v qemu-aarch64 > /dev/null && [ -e /usr/$triplet/lib/libc.so ]; then
    return
  fi
  if [ "$(id -u)" != 0 ]; then sudo=sudo; fi
  $sudo apt-get update -q
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
    gcc-$triplet libc6-dev-arm64-cross qemu-user
}

# apt with lists and packages of its own, for arm64 only: the machine's state is left alone.
unpack_check() {
  local state=$out/apt sysroot=$1
  [ -e "$sysroot/usr/lib/$triplet/libcheck.a" ] && return
  rm -rf "$state" "$sysroot"
  mkdir -p "$state/state/lists/partial" "$state/cache/archives/partial"
  : > "$state/status"
  local options=(-q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$state/state"
    -o Dir::State::status="$state/status" -o Dir::Cache="$state/cache" -o APT::Sandbox::User=root)
  apt-get "${options[@]}" update
  (cd "$state" && apt-get "${options[@]}" download check libsubunit-dev)
  for package in "$state"/*.deb; do dpkg-deb -x "$package" "$sysroot"; done
  rm -rf "$state"
}

install_tools
sysroot=$out/sysroot
unpack_check "$sysroot"
"$MAKE" -j"$JOBS" BUILD="$out" CC=$triplet-gcc CHECK_CFLAGS="-I$sysroot/usr/include" \
  CHECK_LIBS="-L$sysroot/usr/lib/$triplet -lcheck -lsubunit -lrt" all "$out/tests/unit"

# An item is a suite, or a suite and one of its cases: of determinism, which is all long runs, one dimension.
export CK_TIMEOUT_MULTIPLIER=20
# shellcheck disable=SC2016,SC2086
printf '%s\n' $SUITES | sed 's/^determinism$/determinism:2-D/' | xargs -P "$JOBS" -I{} sh -c '
  suite=${0%%:*}
  mkdir -p "$1/tests/scratch/$0"
  case $0 in *:*) export CK_RUN_CASE="${0#*:}" ;; *) export CK_EXCLUDE_TAGS=long ;; esac
  from=$(date +%s)
  out=$(CK_RUN_SUITE=$suite MPM_SCRATCH="$1/tests/scratch/$0" qemu-aarch64 -L "$2" "$1/tests/unit" 2>&1)
  status=$?
  case $out in *"Checks: 0,"*) status=1 ;; esac
  printf "%s\n%s: %d s\n" "$out" "$0" $(($(date +%s) - from))
  exit $status' {} "$out" /usr/$triplet
