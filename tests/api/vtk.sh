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
for program in write_vtp write_vti; do
  "$CC" -std=c11 -Wall -Wextra -Werror -Iinclude tests/io/$program.c "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/$program"
  "$scratch/$program" "$scratch/files" > "$scratch/$program.out"
done
"$python" tests/io/vtk_read.py "$scratch/files" < "$scratch/write_vtp.out"
