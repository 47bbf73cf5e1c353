#!/usr/bin/env bash
# Compiles the library for WebAssembly, without threads, by Emscripten and by clang with wasi-libc, and runs a host program
# in node: the same bits as here. What is not installed is skipped by name; SYSTEMS selects.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=$(mkdir -p "${BUILD:-build}" && cd "${BUILD:-build}" && pwd) MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)}
SYSTEMS=${SYSTEMS:-emscripten emscripten-simd wasi}
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs} # where Debian keeps what emcc needs
"$here/tests/platform/smoke" baseline "$here/tests/scratch" > "$here/tests/scratch/smoke-expected"

compare() { # system, command...
  local system=$1 out=$here-wasm/$1
  shift
  mkdir -p "$out/files"
  "$@" > "$out/found"
  if ! diff "$here/tests/scratch/smoke-expected" "$out/found"; then
    echo "wasm.sh: $system: '<' here, '>' in WebAssembly" >&2
    exit 1
  fi
  echo "wasm.sh: $system: $(wc -l < "$out/found") scenes"
}

emscripten() { # system, flags
  local system=$1 flags=$2 out=$here-wasm/$1
  "$MAKE" -j"$JOBS" BUILD="$out" CC=emcc AR=emar CFLAGS="$flags" all
  # shellcheck disable=SC2086
  emcc -std=c11 -O1 $flags -DMPM_NO_THREADS -Iinclude tests/platform/smoke.c "$out/libmpm.a" -lm -sALLOW_MEMORY_GROWTH=1 \
    -sEXIT_RUNTIME=1 -o "$out/smoke.js"
  compare "$system" node --no-experimental-fetch "$out/smoke.js" baseline /tmp
}

for system in $SYSTEMS; do
  case $system in
  emscripten*)
    if ! command -v emcc > /dev/null || ! command -v node > /dev/null; then
      echo "wasm.sh: $system is skipped: emcc or node is not installed"
      continue
    fi
    case $system in *-simd) emscripten "$system" -msimd128 ;; *) emscripten "$system" '' ;; esac
    ;;
  wasi)
    clang=$(command -v "${WASI_CC:-clang}" || :)
    if [ ! -e /usr/lib/wasm32-wasi/libc.a ] || [ -z "$clang" ] || ! command -v node > /dev/null ||
      ! command -v wasm-ld > /dev/null; then
      echo "wasm.sh: wasi is skipped: wasi-libc, clang, lld or node is not installed"
      continue
    fi
    out=$here-wasm/wasi
    "$MAKE" -j"$JOBS" BUILD="$out" CC="$clang --target=wasm32-wasi" AR="$(command -v llvm-ar || command -v llvm-ar-14)" CFLAGS= all
    "$clang" --target=wasm32-wasi -std=c11 -O1 -Iinclude tests/platform/smoke.c "$out/libmpm.a" -lm -o "$out/smoke.wasm"
    mkdir -p "$out/files"
    runner=$PWD/tests/platform/wasi.mjs
    (cd "$out" && compare wasi node --no-warnings "$runner" smoke.wasm baseline files)
    ;;
  esac
done
