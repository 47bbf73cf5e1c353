#!/usr/bin/env bash
# Counts the instructions of a particle-step with callgrind and compares with expected.txt, within 1 %: a slower hot path
# shows on any machine, however loaded, and so does slower contact. Obstacles that nothing comes near may add 0.5 %.
# `run.sh update` writes expected.txt instead.
set -euo pipefail
cd "$(dirname "$0")"
BUILD=${BUILD:-../../build} CC=${CC:-cc}
program=$BUILD/tests/instructions/steps
expected=expected.txt
mode=${1:-check}

compiler=$("$CC" --version | head -n 1)
case $compiler in
*clang*) major="clang $("$CC" -dumpversion | cut -d. -f1)" ;;
*) major="gcc $("$CC" -dumpversion | cut -d. -f1)" ;;
esac
major="$major $("$CC" -dumpmachine | cut -d- -f1)"

if [ "$mode" = check ]; then
  noted=$(sed -n 's/^compiler: //p' $expected)
  if [ "$noted" != "$major" ]; then
    echo "check-instructions: skipped: the figures are of $noted, this is $major"
    exit 0
  fi
fi
if ! command -v valgrind > /dev/null; then
  echo "check-instructions: there is no valgrind" >&2
  exit 1
fi

# The C library's copies for the smallest x86-64: which it takes, and how callgrind counts them, must not depend on the
# processor.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512VL,-ERMS,-FSRM,-FMA

# Of the steps alone, without setting up; callgrind says "Collected : N" at the end.
per_particle_step() { # case
  local log=$BUILD/tests/instructions/callgrind.log steps
  steps=$(valgrind --tool=callgrind --toggle-collect=mpm_step --callgrind-out-file=/dev/null "$program" "$1" 2> "$log") ||
    { cat "$log" >&2; return 1; }
  sed -n 's/.*Collected : \([0-9]*\).*/\1/p' "$log" | awk -v steps="$steps" '{ printf "%.1f", $1 / steps }'
}

if [ "$mode" = update ]; then
  {
    echo "# Instructions per particle-step of the baseline kernels; written by: make update-instructions"
    echo "# Measured with: $compiler"
    echo "compiler: $major"
    "$program" | while read -r name; do printf '%s: %s\n' "$name" "$(per_particle_step "$name")"; done
  } > $expected.new
  mv $expected.new $expected
  cat $expected
  exit 0
fi

failed=0
declare -A count
printf '%-34s %10s %10s %8s\n' "instructions" expected counted change
while read -r name; do
  wanted=$(sed -n "s/^$name: //p" $expected)
  counted=$(per_particle_step "$name")
  if ! awk -v name="$name" -v wanted="${wanted:-0}" -v counted="${counted:-0}" 'BEGIN {
    change = wanted > 0 ? 100 * (counted / wanted - 1) : 100
    bad = change > 1 || change < -1
    printf "%-34s %10.1f %10.1f %+7.2f%%%s\n", name, wanted, counted, change, bad ? "  more than 1 % off" : ""
    exit bad
  }'; then failed=1; fi
  count[$name]=$counted
  without=${count[${name%, far obstacles}]}
  if ! awk -v a="$counted" -v b="$without" 'BEGIN { exit !(a <= 1.005 * b) }'; then
    echo "$name: more than 0.5 % above the case without" >&2
    failed=1
  fi
done < <("$program")
if [ $failed = 1 ]; then
  echo "check-instructions: if the change is meant: make update-instructions" >&2
  exit 1
fi
