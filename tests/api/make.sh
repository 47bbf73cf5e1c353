#!/usr/bin/env bash
# `make help` has a line for every target that is no file, and for nothing else; recipes use all processors unless -j says
# otherwise.
set -euo pipefail
MAKE=${MAKE:-make}
scratch=${MPM_SCRATCH:-${BUILD:-build}/tests/scratch}/make
rm -rf "$scratch"
mkdir -p "$scratch"
files="Makefile tests/tests.mk bindings/bindings.mk bindings/javascript/rules.mk packaging/packaging.mk mpi/mpi.mk petsc/petsc.mk"

# shellcheck disable=SC2086
sed -n 's/^\.PHONY://p' $files | tr ' ' '\n' | sed '/^$/d' | sort > "$scratch/phony"
$MAKE -s help | sed -nE 's/^  ([a-z0-9-]+) +[^ ].*/\1/p' | sort > "$scratch/listed"
# shellcheck disable=SC2086
grep -hE '^[a-z0-9 -]+:([^=]|$)' $files | sed 's/:.*//' | tr ' ' '\n' | sort -u > "$scratch/ruled"
if ! diff "$scratch/phony" "$scratch/listed"; then
  echo "make.sh: '<' is phony but has no line in make help, '>' has a line but is not phony (or has two)" >&2
  exit 1
fi
if [ -n "$(comm -23 "$scratch/listed" "$scratch/ruled")" ]; then
  echo "make.sh: listed, but no rule makes it: $(comm -23 "$scratch/listed" "$scratch/ruled" | paste -sd ' ')" >&2
  exit 1
fi

flags() { # what recipes are given, with these arguments of make
  env -u MAKELEVEL -u MFLAGS MAKEFLAGS="$1" "$MAKE" -s --eval 'show-flags:; @echo "$$MAKEFLAGS"' show-flags "${@:2}"
}
expect() { # what, pattern, flags
  grep -qE -- "$2" <<< "$3" || { echo "make.sh: $1: MAKEFLAGS are $3" >&2; exit 1; }
}
expect 'without -j' "(^| )-j$(nproc)( |\$)" "$(flags '')"
expect 'with -j1' '(^| )-j1( |$)' "$(flags '' -j1)"
expect 'with --jobs=3' '(^| )-j3( |$)' "$(flags '' --jobs=3)"
expect 'with MAKEFLAGS=-j1' '(^| )-j1( |$)' "$(flags -j1)"
echo "$(wc -l < "$scratch/listed") targets, all of them in make help"
