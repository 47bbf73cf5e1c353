#!/usr/bin/env bash
# The same bits on every platform: compiles the library and the scenes of tests/hashes for each platform whose compiler
# and emulator are there, runs them on MPM_ISA_PORTABLE, and compares with tests/hashes/expected-baseline.txt. Then states
# that one platform saved half-way go to their end on another.
#
# SCENES: selected (the default: scenes.txt), gate (the first nine of it) or all. PLATFORMS="gcc s390x" selects
# platforms, which then must be there. FOLDERS="gcc=build" takes a library that is compiled already.
set -euo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C
BUILD=${BUILD:-build} MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)} SCENES=${SCENES:-selected}
expected=tests/hashes/expected-baseline.txt
out=$BUILD-portable
mkdir -p "$out"

# Quick to compile, and other than what expected-baseline.txt is made with, which must not matter. Without the second
# flag gcc contracts nothing, and could not show that it must not.
level='-O1 -fexpensive-optimizations'

# name | compiler | its flags | for linking | what runs the program | the platform
platforms() {
  cat << 'LIST'
gcc|gcc||-static||x86-64, gcc
clang|clang||-static||x86-64, clang
musl|musl-gcc||-static||x86-64, musl
i686|i686-linux-gnu-gcc|-msse2 -mfpmath=sse|-static||i686 with SSE2
aarch64|aarch64-linux-gnu-gcc||-static|qemu-aarch64|aarch64
armhf|arm-linux-gnueabihf-gcc||-static|qemu-arm|armhf
riscv64|riscv64-linux-gnu-gcc||-static|qemu-riscv64|riscv64
ppc64le|powerpc64le-linux-gnu-gcc||-static|qemu-ppc64le|ppc64le
s390x|s390x-linux-gnu-gcc||-static|qemu-s390x|s390x, big endian
windows|x86_64-w64-mingw32-gcc|-D__USE_MINGW_ANSI_STDIO=1|-static|wine|Windows, by wine
wasi|clang --target=wasm32-wasi|||node --no-warnings tests/platform/wasi.mjs|WebAssembly, WASI
emscripten|emcc||-sALLOW_MEMORY_GROWTH=1 -sNODERAWFS=1 -sEXIT_RUNTIME=1|node --no-experimental-fetch|WebAssembly, emcc
LIST
}
export WINEDEBUG=-all WINEARCH=win64 WINEPREFIX=$(cd "$out" && pwd)/wine NODE_PATH=${NODE_PATH:-/usr/share/nodejs}

missing() { # compiler, runner: what of a platform is not there
  local tool
  for tool in ${1%% *} ${2%% *}; do command -v "$tool" > /dev/null || { echo "$tool" && return; }; done
  case $1 in *wasm32-wasi) [ -e /usr/lib/wasm32-wasi/libc.a ] && command -v wasm-ld > /dev/null || echo wasi-libc ;; esac
}

# Every basis, scheme, transfer, law and option that a scene's name may have.
parts_of() {
  awk '{ n = split($0, part, /: /); if (n > 1) print "option " part[2]
         split(part[1], of, /, /); print "scheme " of[2]; print "transfer " of[3]
         print "dimension " substr(of[1], 1, 3); print "basis " substr(of[1], 5) }' | sort -u
}

grep -v '^#' "$expected" > "$out/all"
sed 's/ [0-9a-f]\{16\}$//' "$out/all" > "$out/all.names"
grep -v '^#' tests/portable/scenes.txt > "$out/selected"
if ! diff <(parts_of < "$out/all.names") <(parts_of < "$out/selected"); then
  echo "check-portable: no scene of tests/portable/scenes.txt has what '<' shows" >&2
  exit 1
fi
case $SCENES in
all) cp "$out/all.names" "$out/names" ;;
gate) head -n 9 "$out/selected" > "$out/names" ;;
*) cp "$out/selected" "$out/names" ;;
esac
awk 'NR == FNR { wanted[$0] = 1; next } substr($0, 1, length($0) - 17) in wanted' \
  "$out/names" "$out/all" > "$out/expected"
mapfile -t names < "$out/names"
if [ "$(wc -l < "$out/expected")" != ${#names[@]} ]; then
  echo "check-portable: a scene of tests/portable/scenes.txt is not in $expected" >&2
  exit 1
fi
# whose state goes from one platform to another
mapfile -t moved < <(grep -E ': (locking remedy|J2|LDLT)$' "$out/selected" | head -n 3)
for name in "${moved[@]}"; do grep -F "$name " "$out/all"; done | sort > "$out/moved"

digest() { sha256sum | cut -c1-16; }
folder_of() {
  local pair
  for pair in ${FOLDERS-}; do [ "${pair%%=*}" = "$1" ] && echo "${pair#*=}" && return; done
  echo "$out/$1"
}

failed=0 first=
printf '%-18s %7s  %-16s  %s\n' platform scenes hash 'states continued'
while IFS='|' read -r name compiler flags link runner platform; do
  case " ${PLATFORMS-$name} " in *" $name "*) ;; *) continue ;; esac
  if [ -n "$(missing "$compiler" "$runner")" ]; then
    printf '%-18s skipped: no %s\n' "$platform" "$(missing "$compiler" "$runner")"
    [ -z "${PLATFORMS-}" ] || failed=1
    continue
  fi
  folder=$(folder_of "$name")
  options=(BUILD="$folder" CC="$compiler" LDFLAGS="$link")
  if [ "$folder" = "$out/$name" ]; then options+=(CFLAGS="$flags" OPT="$level" KERNEL_OPT="$level" WERROR=); fi
  case $name in wasi) options+=(AR="$(command -v llvm-ar || command -v llvm-ar-14)") ;; emscripten) options+=(AR=emar) ;; esac
  "$MAKE" -j"$JOBS" "${options[@]}" "$folder/tests/hashes/hashes" > "$out/$name.log" 2>&1 || {
    tail -n 20 "$out/$name.log"
    printf '%-18s does not compile\n' "$platform"
    failed=1
    continue
  }
  if [ "$name" = windows ]; then (timeout 300 wineboot -i > /dev/null 2>&1) || :; fi
  # shellcheck disable=SC2206
  binary=$folder/tests/hashes/hashes
  if [ -e "$binary.exe" ]; then binary=$binary.exe; fi
  program=($runner "$binary" portable)
  rm -f "$out/$name".part.*
  # shellcheck disable=SC2016
  printf '%s\0' "${names[@]}" | xargs -0 -P "$JOBS" -n $(((${#names[@]} + 2 * JOBS - 1) / (2 * JOBS))) \
    sh -c 'part=$0.$$; exec "$@" > "$part"' "$out/$name.part" "${program[@]}" && same=yes || same=no
  cat "$out/$name".part.* | tr -d '\r' > "$out/$name.lines"
  diff <(sort "$out/expected") <(sort "$out/$name.lines") > "$out/$name.diff" || same=no

  # to this platform from the first one, and back
  continued=-
  if [ -z "$first" ]; then
    first=("${program[@]}")
  else
    continued=yes
    for way in there back; do
      mkdir -p "$out/states-$name"
      rm -f "$out/states-$name"/*
      if [ $way = there ]; then from=("${first[@]}") to=("${program[@]}"); else from=("${program[@]}") to=("${first[@]}"); fi
      "${from[@]}" save "$out/states-$name" "${moved[@]}" > /dev/null &&
        "${to[@]}" load "$out/states-$name" "${moved[@]}" | tr -d '\r' | sort | diff "$out/moved" - > "$out/$name.$way" || continued=no
    done
  fi
  printf '%-18s %7d  %s  %s\n' "$platform" "$(wc -l < "$out/$name.lines")" "$(sort "$out/$name.lines" | digest)" $continued
  if [ $same = no ] || [ $continued = no ]; then
    failed=1
    sed -n 's/^</  expected/p; s/^>/  found   /p' "$out/$name.diff" | sort -b -k 2
  fi
done < <(platforms)
printf '%-18s %7d  %s\n' expected ${#names[@]} "$(sort "$out/expected" | digest)"
if [ $failed = 1 ]; then
  echo "check-portable: a platform is missing or has other bits" >&2
  exit 1
fi
