#!/usr/bin/env bash
# Files for visualisation are read with VTK, and every number in them is compared with what the library gives by id.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/vtk
python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import vtkmodules.vtkIOXML' 2> /dev/null; then
    python=$candidate
    break
  fi
done
if [ -z "$python" ]; then
  echo "vtk.sh: skipped: there is no Python with VTK (python3-vtk9)"
  exit 0
fi
rm -rf "$scratch"
mkdir -p "$scratch/files"
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude tests/io/write_vtp.c "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/write_vtp"
"$scratch/write_vtp" "$scratch/files" > "$scratch/times"
"$python" tests/io/vtk_read.py "$scratch/files" < "$scratch/times"
