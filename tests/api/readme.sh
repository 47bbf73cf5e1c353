#!/usr/bin/env bash
# The host programs of the README and of docs/cpp.md compile as printed, run, and report a falling then resting block.
set -euo pipefail
build=${BUILD:-build}
scratch=${MPM_SCRATCH:-$build/tests/scratch}/readme
rm -rf "$scratch"
mkdir -p "$scratch"
awk '/^```c$/ {inside = 1; next} /^```/ {inside = 0} inside' README.md > "$scratch/block.c"
[ -s "$scratch/block.c" ] || { echo "README.md has no C program"; exit 1; }
${CC:-cc} -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude "$scratch/block.c" -o "$scratch/block" \
  -L"$build" -lmpm -Wl,-rpath,"$build"
(cd "$scratch" && ./block > out)
cat "$scratch/out"
grep -Eq '^t = 0\.50[0-9] s: kinetic [0-9.]+ J, strain [0-9.]+ J$' "$scratch/out"
grep -q '<VTKFile type="PolyData"' "$scratch/block.vtp"

awk '/^```cpp$/ {inside = 1; next} /^```/ {if (inside) exit} inside' docs/cpp.md > "$scratch/block.cpp"
${CXX:-g++} -std=c++17 -Wall -Wextra -Wpedantic -Werror -Iinclude "$scratch/block.cpp" -o "$scratch/block_cpp" \
  -L"$build" -lmpm -Wl,-rpath,"$build"
"$scratch/block_cpp" > "$scratch/out"
cat "$scratch/out"
[ "$(grep -Ec '^t = 0\.[1-5] s: kinetic [0-9.]+ J$' "$scratch/out")" = 5 ]

# The two commands that open the live page stand under the moving picture, before the first heading.
first=$(sed '/^## /,$d' README.md)
grep -q '^!\[.*\](docs/gallery/snowball\.apng)$' <<< "$first"
[ "$(sed -n '/snowball\.apng/,$p' <<< "$first" | sed -n '/^```sh$/,/^```$/p' | grep -c 'make live$\|^python3 -m http\.server -d build/live ')" = 2 ]
