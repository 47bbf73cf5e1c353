#!/usr/bin/env bash
# Compares the binary interface of the shared library with the committed baseline (check), or writes the baseline anew
# (update). New functions pass. New fields at the end of a struct do not, though they are allowed: abidiff cannot tell
# them from other changes of the struct, so a person looks and updates the baseline.
set -euo pipefail
BUILD=${BUILD:-build}
baseline=abi/libmpm-x86_64.abi.xml library=$BUILD/libmpm.so now=$BUILD/tests/libmpm.abi.xml

case $(readelf -h "$library" | sed -n 's/ *Machine: *//p') in
*X86-64*) ;;
*)
  echo "check-abi: skipped: the baseline is that of x86-64"
  exit 0
  ;;
esac
# Types are described by debugging information, and compilers describe some of them differently.
if ! readelf --debug-dump=info --dwarf-depth=1 "$library" 2> /dev/null | grep 'DW_AT_producer.*GNU C' > /dev/null; then
  echo "check-abi: $library must be built by gcc with -g" >&2
  exit 1
fi

mkdir -p "$BUILD/tests"
abidw --suppressions abi/private-types.ini --no-corpus-path --no-comp-dir-path --no-show-locs --no-parameter-names \
  --no-elf-needed --type-id-style hash --exported-interfaces-only "$library" > "$now"

if [ "${1:-check}" = update ]; then
  if grep -n "'/[^>]" "$now"; then
    echo "check-abi: the baseline would name folders of this machine" >&2
    exit 1
  fi
  cp "$now" "$baseline"
  echo "check-abi: $baseline written: enter what is new into ABI.md"
  exit 0
fi

# Bits of abidiff's status: 1 and 2 an error, 4 a change, 8 a change that it knows to be incompatible.
compare() {
  local status=0
  abidiff "$@" "$baseline" "$now" || status=$?
  if [ $((status & ~12)) != 0 ]; then
    echo "check-abi: abidiff failed with $status" >&2
    exit 1
  fi
  [ $status = 0 ]
}
if ! compare --no-added-syms; then
  echo "check-abi: hosts that were compiled against the baseline would break, unless all that is listed are fields" >&2
  echo "appended to structs that begin with struct_size: see ABI.md; then run make update-abi" >&2
  exit 1
fi
if compare; then
  echo "check-abi: as in the baseline"
else
  echo "check-abi: compatible, with new functions: run make update-abi and enter them into ABI.md"
fi
