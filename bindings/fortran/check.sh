#!/usr/bin/env bash
# The Fortran module against the library: layouts, a host with a law of its own, and the example with C's output.
set -euo pipefail
FC=${FC:-gfortran}
if ! command -v "$FC" > /dev/null; then
  echo "fortran: not checked: there is no $FC"
  exit 77
fi
here=bindings/fortran
scratch=$MPM_SCRATCH/fortran
rm -rf "$scratch"
mkdir -p "$scratch"
compile() {
  "$FC" -g -std=f2018 -Wall -Wextra -Werror -fcheck=all -ffpe-trap=invalid,zero,overflow -J "$scratch" "$@"
}
for module in mpm mpm_texts; do
  compile -c $here/$module.f90 -o "$scratch/$module.o"
done
for program in layout host example; do
  compile $here/$program.f90 "$scratch/mpm.o" "$scratch/mpm_texts.o" -L"$BUILD" -lmpm -Wl,-rpath,"$BUILD" -o "$scratch/$program"
done
compile -c bindings/costs/costs.f90 -o "$scratch/costs.o"
"$scratch/layout"
"$scratch/host" "$scratch/set.vtp"
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude bindings/example.c -L"$BUILD" -lmpm -Wl,-rpath,"$BUILD" -o "$scratch/in_c"
"$scratch/in_c" > "$scratch/expected"
"$scratch/example" > "$scratch/found"
diff "$scratch/expected" "$scratch/found" || {
  echo "fortran: the example differs from that in C" >&2
  exit 1
}
echo "fortran: $(paste -sd ' ' "$scratch/found")"
