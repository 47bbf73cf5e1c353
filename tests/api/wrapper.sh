#!/usr/bin/env bash
# The C++ wrapper, with every C++ compiler that is there.
set -euo pipefail
BUILD=${BUILD:-build}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/wrapper
rm -rf "$scratch"
mkdir -p "$scratch"
for compiler in ${COMPILERS:-g++ clang++}; do
  command -v $compiler > /dev/null || continue
  for source in tests/api/wrapper*.cpp; do
    $compiler -std=c++17 -Wall -Wextra -Wpedantic -Werror -g -Iinclude ${CXXFLAGS:-} -c "$source" \
      -o "$scratch/$compiler-$(basename "$source").o" &
  done
  for job in $(jobs -p); do wait "$job"; done
  $compiler ${CXXFLAGS:-} "$scratch/$compiler"-*.o "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/$compiler"
  printf 'wrapper.sh: %s: ' $compiler
  "$scratch/$compiler" "$scratch" || { echo "wrapper.sh:0:E: exit status $?"; exit 1; }
done
