#!/usr/bin/env bash
# Builds Debian's packages from the committed sources, has lintian look at them, and runs the packages' tests against what
# they hold, unpacked in a folder. As root, INSTALL=1 installs them and runs the tests on the installation.
#   packaging/deb.sh FOLDER
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 tree=$1/libmpm
for tool in dpkg-buildpackage dh dh_python3 lintian doxygen; do
  command -v $tool > /dev/null || { echo "deb.sh: $tool is missing: apt install build-essential debhelper dh-python lintian doxygen python3-dev" >&2; exit 1; }
done
rm -rf "$folder"
mkdir -p "$tree"
git archive HEAD | tar -x -C "$tree"
cp -R "$tree/packaging/debian" "$tree/debian"
(cd "$tree" && dpkg-buildpackage -b -us -uc -d > "$folder/log" 2>&1) || { tail -40 "$folder/log" >&2; exit 1; }
ls "$folder"/*.deb
lintian --pedantic --fail-on error,warning,pedantic,info "$folder"/*.changes
root=$folder/root
for package in "$folder"/*.deb; do dpkg-deb -x "$package" "$root"; done
library=$(dirname "$(find "$root" -name libmpm.so.0)")
scratch=$folder/scratch
mkdir -p "$scratch"
export LD_LIBRARY_PATH=$library PKG_CONFIG_LIBDIR=$library/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root AUTOPKGTEST_TMP=$scratch
PYTHONPATH=$root/usr/lib/python3/dist-packages
export PYTHONPATH
for test in build bits; do
  sh "$tree/debian/tests/$test"
  echo "deb.sh: test $test: ok"
done
if [ "${INSTALL:-0}" = 1 ]; then
  unset LD_LIBRARY_PATH PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR PYTHONPATH
  DEBIAN_FRONTEND=noninteractive apt-get install -y -q "$folder"/*.deb > "$folder/install.log"
  for test in build bits; do
    PYTHON=/usr/bin/python3 sh "$tree/debian/tests/$test"
    echo "deb.sh: test $test on the installation: ok"
  done
fi
