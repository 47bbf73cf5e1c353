#!/usr/bin/env bash
# run.sh [PATH] [I/N]: plants the faults of faults.txt one at a time in copies of the sources and runs the suite that is
# named beside each; a fault that it does not notice is a gap in the tests. PATH selects the faults whose file contains
# it, I/N every N-th of them from the I-th on. JOBS faults are tried side by side. Each has its line as soon as it is
# known: number, suite, verdict, seconds, and the first failure or else the fault. The lines stay in
# $BUILD/mutate/results, and what compilers and suites say in $BUILD/mutate/logs. On a busy machine a greater
# CK_TIMEOUT_MULTIPLIER keeps the tests from running out of time, which would pass for a fault that was noticed.
set -euo pipefail
export MAKE=${MAKE:-make} CC=${CC:-cc} CXX=${CXX:-g++}
BUILD=${BUILD:-build} JOBS=${JOBS:-$(nproc)}
path='' share=1/1
for argument in "$@"; do
  case $argument in [1-9]*/[1-9]*) share=$argument ;; *) path=$argument ;; esac
done
rm -rf "$BUILD/mutate"
mkdir -p "$BUILD"/mutate/{whole/scratch,logs,trees}
cp -a --parents Makefile platform.mk {bindings/bindings,bindings/javascript/rules,packaging/packaging}.mk include src umat mpi petsc tests \
  "$BUILD/mutate/whole"
rm -rf "$BUILD/mutate/whole/tests/examples"

# A fault that the compiler's warnings would catch is no fault: they are off. It must still compile.
compile() { # jobs, suite
  local target=out/tests/unit
  case $2 in wrapper | mpi | petsc) target=out/libmpm.a ;; scenes) target=out/tests/parts/parts ;; umat) target='out/libmpm-umat.a out/libmpm-umat-utilities.a out/libmpm.a' ;; verify/*) target=out/verification/${2#*/} ;; esac
  # shellcheck disable=SC2086
  "$MAKE" -s -j"$1" BUILD=out CC="$CC" WERROR=-w $target > "$log" 2>&1
}

# The unit tests of a suite until the first failure, which is enough: Check tells of each test as it ends, and stops the
# one that runs when it is stopped itself.
units() { # suite, what is said of the tags "long" and "wide"
  exec 3< <(export "$2=long wide" CK_RUN_SUITE="$1" CK_VERBOSITY=silent CK_LOG_FILE_NAME=- MPM_SCRATCH="$PWD/scratch"
    exec timeout $limit out/tests/unit 2>&1)
  local program=$!
  sed -E "/$failed/q" <&3 > "$log"
  kill "$program" 2> /dev/null || : # it may have come to its end
  wait "$program"
}

suite() {
  case $1 in
  wrapper)
    BUILD=out MPM_SCRATCH=$PWD/scratch COMPILERS=$CXX CXXFLAGS='-w -g0' \
      timeout $limit bash tests/api/wrapper.sh > "$log" 2>&1
    ;;
  umat) BUILD=out MPM_SCRATCH=$PWD/scratch WERROR=-w timeout $limit bash tests/umat/run.sh tests > "$log" 2>&1 ;;
  mpi) BUILD=out MPM_SCRATCH=$PWD/scratch WERROR=-w MPI_LIMIT=60 timeout $limit bash mpi/tests/run.sh tests > "$log" 2>&1 ;;
  petsc) BUILD=out MPM_SCRATCH=$PWD/scratch WERROR=-w PETSC_LIMIT=120 PETSC_CELLS=10 timeout $limit bash petsc/tests/run.sh tests > "$log" 2>&1 ;;
  scenes) timeout $limit bash tests/parts/run.sh out/tests/parts/parts out/found 1 1 3 > "$log" 2>&1 ;;
  verify/*) timeout $limit "$MAKE" -s -j1 BUILD=out CC="$CC" WERROR=-w CASES="${1#*/}" verify-quick > "$log" 2>&1 ;;
  exact) units exact CK_EXCLUDE_TAGS ;; # minutes in all, and the short tests see the faults
  *) units "$1" CK_EXCLUDE_TAGS && units "$1" CK_INCLUDE_TAGS ;; # long ones and whole tables come last: most faults are seen before
  esac
}

# The copy is that of the tree that was compiled without a fault, with its times: only what needs the changed file is
# compiled, and nothing of a fault is there for the next one.
try() { # a fault's number or "none", suite
  local what='' verdict first begin=$SECONDS tree=$PWD/trees/$1.${2#*/} log=$PWD/logs/$1.${2#*/}
  cp -a whole "$tree"
  cd "$tree"
  if [ "$1" != none ] && ! what=$(python3 tests/mutate/plant.py plant "$1"); then
    verdict="no longer applies"
  elif ! compile 1 "$2"; then
    verdict="does not compile"
  elif suite "$2"; then
    verdict="not noticed"
  elif ! first=$(grep -Em 1 "$failed" "$log"); then
    verdict="did not run to its end"
  else
    verdict="noticed" what=$first
  fi
  case $1:$verdict in
  none:not\ noticed) verdict="passes without a fault" ;;
  none:*) verdict="fails without a fault" ;;
  esac
  rm -rf "$tree"
  printf '%s %s: %s, %s s%s\n' "$1" "$2" "$verdict" $((SECONDS - begin)) "${what:+: ${what//$'\n'/ }}"
}
export limit=$((1500 * ${CK_TIMEOUT_MULTIPLIER:-1})) failed=':[0-9]+:[FE]:|\] +(FAILED|MET|BROKEN)$|^(mpi|petsc): .* processes: status [0-9]+$|^mpi: .*, wanted [0-9a-f]+, |^petsc: .*: from [0-9]+ to [0-9]+ iterations$|^[1-3]-D .*: (other bits|failed)'
export -f compile units suite try

cd "$BUILD/mutate/whole"
log=../logs/whole
compile "$(nproc)" all || { cat "$log"; echo "mutate: the tests do not compile without a fault" >&2; exit 1; }
python3 tests/mutate/plant.py list "$path" |
  awk -v share="$share" 'BEGIN { split(share, s, "/") } NR % s[2] == s[1] % s[2] { print $1, $2 }' > ../faults
cd ..
{ cut -d ' ' -f 2 faults | sort -u | sed 's/^/none /'; cat faults; } > list
xargs -P "$JOBS" -L 1 bash -c 'try "$@"' try < list | tee results
echo "mutate: $(wc -l < faults) faults, $(grep -c ': noticed, ' results || :) noticed," \
  "$(grep -c ': noticed, .*Test timeout expired' results || :) of them by tests that ran out of time"
if grep -Ev ': (noticed|passes without a fault), ' results; then exit 1; fi
[ "$(wc -l < results)" = "$(wc -l < list)" ] || { echo "mutate: not all were tried" >&2; exit 1; }
