#!/usr/bin/env bash
# What Debian's packages say of the libraries, without Debian's tools: descriptions keep within 80 columns, as lintian wants
# them, and each symbols file lists what its library exports.
set -euo pipefail
BUILD=${BUILD:-build}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/packages
debian=packaging/debian
mkdir -p "$scratch"
fail() {
  echo "packages.sh: $1" >&2
  exit 1
}

# A description begins at its field, and its other lines begin with a space.
awk '/^[^ ]/ { inside = /^Description:/ } inside { print FNR ": " $0 }' $debian/control > "$scratch/descriptions"
[ "$(grep -c '^[0-9]*: Description: ' "$scratch/descriptions")" = "$(grep -c '^Package:' $debian/control)" ] ||
  fail 'control: a package without a description'
! grep -E '^[0-9]+: .{81}' "$scratch/descriptions" || fail 'control: these lines of descriptions have more than 80 characters'

symbols() { # library, package
  local file=$debian/$2.symbols
  [ "$(head -n 1 "$file")" = "$1.so.0 $2 #MINVER#" ] || fail "$file: the first line is not that of $1.so.0"
  ! grep -nvE '^[^ ]+\.so\.0 [^ ]+ #MINVER#$|^\* Build-Depends-Package: libmpm-dev$|^ [A-Za-z_0-9]+@[A-Z_0-9]+ [0-9.]+~?$' "$file" || fail "$file: another form of lines"
  sed -n 's/^ \([^ ]*\) .*/\1/p' "$file" | LC_ALL=C sort > "$scratch/listed"
  # the node of versions is a symbol as well
  nm -D --defined-only --with-symbol-versions "$BUILD/$1.so" |
    awk '{ sub(/@@/, "@", $3); print $2 == "A" && $3 !~ /@/ ? $3 "@" $3 : $3 }' | LC_ALL=C sort > "$scratch/exported"
  diff "$scratch/listed" "$scratch/exported" || fail "$file: '<' is listed but not exported, '>' exported but not listed"
  echo "packages.sh: $2: $(wc -l < "$scratch/listed") symbols"
}
symbols libmpm libmpm0
symbols libmpm-umat libmpm-umat0
