#!/usr/bin/env bash
# Builds Debian's packages from the committed sources, has lintian look at them, and, as root, installs them in a clean root
# by debootstrap and runs their tests there.
#   packaging/deb.sh FOLDER
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 tree=$1/libmpm
for tool in dpkg-buildpackage dh dh_python3 lintian doxygen; do
  command -v $tool > /dev/null || { echo "deb.sh: $tool is missing: apt install build-essential debhelper dh-python lintian doxygen python3-dev mpi-default-dev petsc-dev" >&2; exit 1; }
done
rm -rf "$folder"
mkdir -p "$tree"
git archive HEAD | tar -x -C "$tree"
cp -R "$tree/packaging/debian" "$tree/debian"
(cd "$tree" && dpkg-buildpackage -b -us -uc -d > "$folder/log" 2>&1) || { tail -40 "$folder/log" >&2; exit 1; }
ls "$folder"/*.deb
# bytes of code that happen to read as a word are not misspelt
lintian -I --pedantic --suppress-tags spelling-error-in-binary --fail-on error,warning,pedantic,info "$folder"/*.changes
# The packages' tests want them installed: in a root that has nothing else.
if [ "$(id -u)" != 0 ] || ! command -v debootstrap > /dev/null; then
  echo 'deb.sh: the tests are not run: they take root and debootstrap' >&2
  exit 0
fi
root=$folder/root
debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" > "$folder/debootstrap.log"
cp /etc/resolv.conf /etc/hosts "$root/etc/"
cp -R /etc/apt/. "$root/etc/apt/"
mkdir "$root/packages" "$root/scratch"
cp "$folder"/*.deb "$root/packages"
mkdir -p "$root/tree/bindings/python"
cp -R "$tree/debian" "$root/tree"
cp "$tree/bindings/example.c" "$root/tree/bindings"
cp "$tree/bindings/python/example.py" "$root/tree/bindings/python"
in_root() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive AUTOPKGTEST_TMP=/scratch "$@"
}
in_root apt-get update -q > "$folder/install.log"
in_root sh -c 'apt-get install -y -q --no-install-recommends /packages/*.deb gcc g++ libc6-dev pkgconf mpi-default-bin' >> "$folder/install.log"
for test in build bits mpi petsc; do
  in_root sh "/tree/debian/tests/$test"
  echo "deb.sh: test $test on the installation: ok"
done
rm -rf "$root"
