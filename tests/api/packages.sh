#!/usr/bin/env bash
# What packages say of the libraries, without the tools that make them: all have one version; descriptions of Debian's keep
# within 80 columns, as lintian wants them, and each symbols file lists what its library exports.
set -euo pipefail
BUILD=${BUILD:-build} MAKE=${MAKE:-make}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/packages
debian=packaging/debian
mkdir -p "$scratch"
fail() {
  echo "packages.sh: $1" >&2
  exit 1
}

# Between releases the coming version, marked as each tool marks it; docs/developing.md, 5.
version=$(sed -n '/^## /{s/^## \([0-9.]*\).*/\1/p;q}' CHANGELOG.md)
if grep -qx "## $version (unreleased)" CHANGELOG.md; then tilde='~dev' point=.dev0 dash=-dev; else tilde='' point='' dash=''; fi
has() { # file, line that it must have
  grep -qxF "$2" "$1" || fail "$1 has not the version of CHANGELOG.md: $2"
}
[ "$(sed "s/).*/)/;q" $debian/changelog)" = "libmpm ($version$tilde)" ] || fail "$debian/changelog has not the version of CHANGELOG.md"
has bindings/python/pyproject.toml "version = \"$version$point\""
has bindings/python/src/mpm/__init__.py "__version__ = \"$version$point\""
has bindings/rust/mpm/Cargo.toml "version = \"$version$dash\""
has bindings/rust/mpm-sys/Cargo.toml "version = \"$version$dash\""
package=$scratch/npm/javascript/libmpm/package.json
"$MAKE" -s BUILD="$scratch/npm" "$package"
has "$package" "  \"version\": \"$version$dash\","

# A description begins at its field, and its other lines begin with a space.
awk '/^[^ ]/ { inside = /^Description:/ } inside { print FNR ": " $0 }' $debian/control > "$scratch/descriptions"
[ "$(grep -c '^[0-9]*: Description: ' "$scratch/descriptions")" = "$(grep -c '^Package:' $debian/control)" ] ||
  fail 'control: a package without a description'
! grep -E '^[0-9]+: .{81}' "$scratch/descriptions" || fail 'control: these lines of descriptions have more than 80 characters'

symbols() { # library, package
  local file=$debian/$2.symbols
  [ "$(head -n 1 "$file")" = "$1.so.0 $2 #MINVER#" ] || fail "$file: the first line is not that of $1.so.0"
  ! grep -nvE '^[^ ]+\.so\.0 [^ ]+ #MINVER#$|^\* Build-Depends-Package: libmpm(-mpi|-petsc)?-dev$|^ [A-Za-z_0-9]+@[A-Z_0-9]+ [0-9.]+~?$' "$file" || fail "$file: another form of lines"
  sed -n 's/^ \([^ ]*\) .*/\1/p' "$file" | LC_ALL=C sort > "$scratch/listed"
  # the node of versions is a symbol as well
  nm -D --defined-only --with-symbol-versions "$BUILD/$1.so" |
    awk '{ sub(/@@/, "@", $3); print $2 == "A" && $3 !~ /@/ ? $3 "@" $3 : $3 }' | LC_ALL=C sort > "$scratch/exported"
  diff "$scratch/listed" "$scratch/exported" || fail "$file: '<' is listed but not exported, '>' exported but not listed"
  echo "packages.sh: $2: $(wc -l < "$scratch/listed") symbols"
}
symbols libmpm libmpm0
symbols libmpm-umat libmpm-umat0
# where it was made
[ ! -e "$BUILD/libmpm-mpi.so" ] || symbols libmpm-mpi libmpm-mpi0
[ ! -e "$BUILD/libmpm-petsc.so" ] || symbols libmpm-petsc libmpm-petsc0

# Each of these functions has a manual page, which may be a link to that of its header.
"$MAKE" -s BUILD="$scratch/man" man
for function in $(sed -n 's/^ \(mpm_[a-z_0-9]*\)@.*/\1/p' $debian/*.symbols); do
  page=$scratch/man/man/$function.3
  [ -e "$page" ] || fail "no manual page of $function"
  target=$(sed -n 's/^\.so man3\///p' "$page")
  [ -z "$target" ] || page=$scratch/man/man/$target
  grep -q "^\.B .*[ *]$function(" "$page" || fail "$page does not have $function"
done
echo "packages.sh: $(find "$scratch/man/man" -name '*.3' -type f | wc -l) manual pages"
