#!/usr/bin/env bash
# Compiles the library for Windows by mingw-w64, with an import library for its DLL, and runs a host program by wine, with
# the DLL and linked statically: the same bits as here, threads, files under names in UTF-8. What a Debian machine lacks is
# installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=$(mkdir -p "${BUILD:-build}" && cd "${BUILD:-build}" && pwd) MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)}
out=$here-windows cross=x86_64-w64-mingw32
mkdir -p "$out"

if ! command -v $cross-gcc > /dev/null || ! command -v wine > /dev/null; then
  sudo=
  if [ "$(id -u)" != 0 ]; then sudo=sudo; fi
  $sudo apt-get update -q
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
    gcc-mingw-w64-x86-64 wine wine64
fi

"$MAKE" -j"$JOBS" BUILD="$out" CC=$cross-gcc AR=$cross-ar CFLAGS="${CFLAGS_WINDOWS-}" all
warnings=(-std=c11 -Wall -Wextra -Wpedantic -Werror -D__USE_MINGW_ANSI_STDIO=1)
$cross-gcc "${warnings[@]}" -DMPM_DLL -Iinclude tests/platform/smoke.c -L"$out" -lmpm -o "$out/smoke-dll.exe"
$cross-gcc "${warnings[@]}" -Iinclude tests/platform/smoke.c "$out/libmpm.a" -o "$out/smoke-static.exe"
if $cross-objdump -p "$out/libmpm-0.dll" | grep 'DLL Name' | grep -viE 'kernel32|msvcrt|ucrt|api-ms-win-crt'; then
  echo "windows.sh: the DLL needs more than the system" >&2
  exit 1
fi
# What the DLL exports is what the shared library exports here.
$cross-objdump -p "$out/libmpm-0.dll" | sed -n 's/^\t\[ *[0-9]*\].* \(mpm[a-z0-9_]*\)$/\1/p' | sort > "$out/exports"
if ! diff <(nm -D --defined-only "$here/libmpm.so" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort) "$out/exports"; then
  echo "windows.sh: '<' is exported here, '>' by the DLL" >&2
  exit 1
fi

export WINEPREFIX=$out/wine WINEDEBUG=-all WINEARCH=win64
mkdir -p "$out/files"
(cd "$out" && timeout 300 wineboot -i > /dev/null 2>&1) || :
for isa in baseline best; do
  "$here/tests/platform/smoke" $isa "$here/tests/scratch" > "$out/expected-$isa"
  for program in smoke-dll smoke-static; do
    (cd "$out" && timeout 300 wine ./$program.exe $isa files | tr -d '\r') > "$out/found-$isa"
    if [ $isa = baseline ] && ! diff "$out/expected-$isa" "$out/found-$isa"; then
      echo "windows.sh: $program: '<' here, '>' on Windows" >&2
      exit 1
    fi
    echo "windows.sh: $program, $isa: $(wc -l < "$out/found-$isa") scenes"
  done
done
if ! ls "$out"/files/zust*.state > /dev/null || ls "$out"/files/*.tmp* 2> /dev/null; then
  echo "windows.sh: files are missing, or temporary ones left: $(ls "$out/files")" >&2
  exit 1
fi
