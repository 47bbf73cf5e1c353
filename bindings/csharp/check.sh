#!/usr/bin/env bash
# The classes against the library, by mono: layouts, what they promise, and the example with C's output.
set -euo pipefail
for tool in mcs mono; do
  if ! command -v $tool > /dev/null; then
    echo "csharp: not checked: there is no $tool"
    exit 77
  fi
done
here=bindings/csharp
scratch=$MPM_SCRATCH/csharp
rm -rf "$scratch"
mkdir -p "$scratch"
export LD_LIBRARY_PATH=$BUILD${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} MONO_PATH=$scratch
compile() {
  mcs -nologo -unsafe -langversion:7 -warn:4 -warnaserror+ "$@"
}
compile -target:library $here/{Native,Handles,Callbacks,Materials,Objects,Stepping}.cs -out:"$scratch/Mpm.dll"
compile -reference:"$scratch/Mpm.dll" bindings/costs/Costs.cs -out:"$scratch/costs.exe"
compile -reference:"$scratch/Mpm.dll" $here/Example.cs -out:"$scratch/example.exe"
# the tests see what is internal
compile $here/{Native,Handles,Callbacks,Materials,Objects,Stepping}.cs $here/tests/*.cs -out:"$scratch/tests.exe"
export MONO_CRASH_NOFILE=1
(cd "$scratch" && mono tests.exe .)
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude bindings/example.c -L"$BUILD" -lmpm -Wl,-rpath,"$BUILD" -o "$scratch/in_c"
"$scratch/in_c" > "$scratch/expected"
mono "$scratch/example.exe" > "$scratch/found"
diff "$scratch/expected" "$scratch/found" || {
  echo "csharp: the example differs from that in C" >&2
  exit 1
}
echo "csharp: $(paste -sd ' ' "$scratch/found")"
