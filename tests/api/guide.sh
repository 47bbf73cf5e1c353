#!/usr/bin/env bash
# The C of docs/guide.md compiles as printed, piece by piece, and its first program runs and prints what stands there.
set -euo pipefail
build=${BUILD:-build}
scratch=${MPM_SCRATCH:-$build/tests/scratch}/guide
rm -rf "$scratch"
mkdir -p "$scratch"

# A piece with main() is a program of its own; one that begins with a definition stands at file scope; any other is the
# body of a function, with the objects that the guide takes for granted around it.
awk -v out="$scratch" '
  /^```c$/ {inside = 1; piece = ""; line = NR; next}
  /^```/ && inside {
    inside = 0
    place = "#line " line + 1 " \"docs/guide.md\"\n"
    if (piece ~ /int main\(/) print place piece > (out "/program.c")
    else if (piece ~ /^(static [a-z_]+ \**[a-z_]+\(|typedef|\/\*)/) print place piece > (out "/pieces.c")
    else printf "static int piece_%d(void) {\n%s%sreturn 0;\n}\n", ++n, place, piece > (out "/pieces.c")
    next
  }
  inside {piece = piece $0 "\n"}
  END {
    print "int main(void) {\n  return 0" > (out "/pieces.c")
    for (i = 1; i <= n; ++i) print "         + (ctx ? piece_" i "() : 0)" > (out "/pieces.c")
    print "      ;\n}" > (out "/pieces.c")
  }' docs/guide.md
[ -s "$scratch/program.c" ] || { echo "docs/guide.md has no program"; exit 1; }
{
  printf '#include <math.h>\n#include <mpm/mpm.h>\n#include <stdio.h>\n#include <stdlib.h>\n'
  printf 'static mpm_context *ctx;\nstatic mpm_grid *grid;\nstatic mpm_material *steel;\nstatic mpm_particles *block, *platen;\nstatic mpm_stepper *stepper;\n'
  printf 'static mpm_step_info now;\nstatic double dt, speed;\n'
  cat "$scratch/pieces.c"
} > "$scratch/all.c"
flags="-std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude"
${CC:-cc} $flags -Wno-unused-function "$scratch/all.c" -o "$scratch/all" -L"$build" -lmpm -lm -Wl,-rpath,"$build"
"$scratch/all"
${CC:-cc} $flags "$scratch/program.c" -o "$scratch/program" -L"$build" -lmpm -Wl,-rpath,"$build"
"$scratch/program" > "$scratch/out"
awk '/^It prints$/ {soon = 1} soon && /^```/ {if (inside) exit; inside = 1; next} inside' docs/guide.md > "$scratch/wanted"
# the last digits may differ between instruction sets
if ! paste "$scratch/out" "$scratch/wanted" | awk 'NF != 20 {exit 1}
  {for (i = 1; i <= 10; ++i) if ($i ~ /[0-9]/ ? ($i - $(i + 10)) ^ 2 > (2e-3 * $i) ^ 2 : $i != $(i + 10)) exit 1}'; then
  echo "docs/guide.md says that its program prints"; cat "$scratch/wanted"; echo "it prints"; cat "$scratch/out"; exit 1
fi
echo "guide.sh: $(grep -c '^static int piece_' "$scratch/all.c") pieces, and the first program"
