#!/usr/bin/env bash
# What each language's README tells newcomers to type, typed in a root that has nothing but Debian's base and the committed
# sources. Each must print the hash of the two disks.
#   bindings/newcomer.sh FOLDER LANGUAGE...
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1
shift
if [ "$(id -u)" != 0 ] || ! command -v debootstrap > /dev/null; then
  echo 'newcomer.sh: it takes root and debootstrap' >&2
  exit 1
fi
mkdir -p "$folder"
base=$folder/base
if [ ! -e "$base/etc/debian_version" ]; then
  debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$base" > "$folder/debootstrap.log"
  cp /etc/resolv.conf /etc/hosts "$base/etc/"
  cp -R /etc/apt/. "$base/etc/apt/"
  printf '#!/bin/sh\nexec "$@"\n' > "$base/usr/bin/sudo" # minbase has none, and its user is root
  chmod +x "$base/usr/bin/sudo"
  chroot "$base" apt-get update -q > "$folder/update.log" 2>&1
fi

block() { # README, kind: the first block of that kind
  sed -n "/^\`\`\`$2\$/,/^\`\`\`\$/p" "$1" | sed '/^```/d;/^$/q'
}

for language in "$@"; do
  start=$SECONDS root=$folder/$language readme=bindings/$language/README.md
  rm -rf "$root"
  cp -a "$base" "$root"
  mkdir "$root/libmpm"
  git archive HEAD | tar -x -C "$root/libmpm"
  {
    echo 'set -e; cd /libmpm; export DEBIAN_FRONTEND=noninteractive'
    block "$readme" sh | sed 's/apt install -y\|apt-get install -y\|apt install/apt-get install -y -q/'
    if [ "$language" = python ]; then
      block "$readme" python > "$root/libmpm/ball.py"
      echo 'mpm-env/bin/python ball.py; mpm-env/bin/python bindings/python/example.py'
    fi
  } > "$root/libmpm/typed.sh"
  # rustc and mono want /proc, which is mounted for these processes alone.
  unshare --mount bash -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root bash /libmpm/typed.sh > "$folder/$language.log" 2>&1 || {
    tail -20 "$folder/$language.log" >&2
    echo "newcomer.sh: $language: failed" >&2
    exit 1
  }
  grep -q 87de2815a6d3f4bc "$folder/$language.log" || { tail -5 "$folder/$language.log" >&2; echo "newcomer.sh: $language: another hash" >&2; exit 1; }
  echo "$language: as its README says, in $((SECONDS - start)) s"
  rm -rf "$root"
done
