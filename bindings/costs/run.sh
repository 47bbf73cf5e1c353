#!/usr/bin/env bash
# What calls and callbacks cost in the languages whose tools are there, one after the other: the table of docs/bindings.md.
#   bindings/costs/run.sh LANGUAGE...
set -euo pipefail
cd "$(dirname "$0")/../.."
CC=${CC:-cc} BUILD=${BUILD:-$PWD/build} scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/costs
export LD_LIBRARY_PATH=$BUILD${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
mkdir -p "$scratch"
costs() {
  case $1 in
  c)
    "$CC" -std=c11 -O2 -Wall -Wextra -Werror -Iinclude bindings/costs/costs.c -L"$BUILD" -lmpm -lm -o "$scratch/in_c"
    "$scratch/in_c"
    ;;
  fortran)
    "${FC:-gfortran}" -std=f2018 -O2 -Wall -Wextra -Werror -J "$scratch" bindings/fortran/mpm.f90 bindings/fortran/mpm_texts.f90 \
      bindings/costs/costs.f90 -L"$BUILD" -lmpm -o "$scratch/in_fortran"
    "$scratch/in_fortran"
    ;;
  rust)
    MPM_LIB_DIR=$BUILD CARGO_TARGET_DIR=$scratch/rust cargo run --offline --locked --quiet --release \
      --manifest-path bindings/rust/Cargo.toml --example costs
    ;;
  csharp)
    mcs -nologo -unsafe -optimize -langversion:7 bindings/csharp/{Native,Handles,Callbacks,Materials,Objects,Stepping}.cs \
      bindings/costs/Costs.cs -out:"$scratch/costs.exe"
    mono "$scratch/costs.exe"
    ;;
  javascript)
    make -s BUILD="$BUILD" javascript
    node bindings/costs/costs.mjs "$BUILD/javascript/libmpm"
    ;;
  python)
    PYTHONPATH=$scratch/python
    export PYTHONPATH
    PYTHONPATH=bindings/python/backend "${PYTHON:-/usr/bin/python3}" -c "import backend; backend.install('$scratch/python')"
    MPM_LIBRARY=$BUILD/libmpm.so.0 "${PYTHON:-/usr/bin/python3}" bindings/python/costs.py
    ;;
  *)
    echo "costs: no program for $1" >&2
    return 1
    ;;
  esac
}
for language in "$@"; do
  echo "$language"
  costs "$language"
done
