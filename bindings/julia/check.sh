#!/usr/bin/env bash
# With Julia: layouts, functions, and the example with C's output. Without: whether the files close and nothing lacks.
set -euo pipefail
here=bindings/julia
scratch=$MPM_SCRATCH/julia
python3 $here/structure.py
if ! command -v julia > /dev/null; then
  echo "julia: not run: Debian has no julia"
  exit 0
fi
rm -rf "$scratch"
mkdir -p "$scratch"
export MPM_LIBRARY=$BUILD/libmpm.so
julia --startup-file=no $here/layout.jl
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude bindings/example.c -L"$BUILD" -lmpm -Wl,-rpath,"$BUILD" -o "$scratch/in_c"
"$scratch/in_c" > "$scratch/expected"
julia --startup-file=no $here/example.jl > "$scratch/found"
diff "$scratch/expected" "$scratch/found" || {
  echo "julia: the example differs from that in C" >&2
  exit 1
}
echo "julia: $(paste -sd ' ' "$scratch/found")"
