#!/usr/bin/env bash
# The package for JavaScript: builds it, installs its tarball into a scratch project, and there runs the example and the
# tests with both binaries; checks the declarations by tsc, and the live page in chromium by playwright-core. These two are
# packages of the npm registry: without the registry they are left out. BROWSER=no leaves the page out.
set -euo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C CC=${CC:-cc} BUILD=${BUILD:-$PWD/build} MAKE=${MAKE:-make} JOBS=${JOBS:-$(nproc)}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/javascript
PLAYWRIGHT=playwright-core@1.65.1 TYPESCRIPT=typescript@5.9.3

skip() {
  echo "javascript: not checked: there is no $1"
  exit 77
}
for tool in node npm wasm-ld python3 "${WASM_CLANG:-clang}"; do command -v "$tool" > /dev/null || skip "$tool"; done
command -v llvm-ar > /dev/null || command -v llvm-ar-14 > /dev/null || skip llvm-ar
[ "${BROWSER:-yes}" = no ] || command -v "${CHROMIUM:-chromium}" > /dev/null || skip "chromium (BROWSER=no does without)"
[ -e /usr/lib/wasm32-wasi/libc.a ] || skip wasi-libc
printf 'int main(void) { return 0; }' | "${WASM_CLANG:-clang}" --target=wasm32-wasi -x c - -o /dev/null 2> /dev/null ||
  skip 'runtime of clang for WebAssembly (libclang-rt-dev-wasm32)'

"$MAKE" -s -j"$JOBS" BUILD="$BUILD" live
package=$BUILD/javascript/libmpm live=$BUILD/live

# ---- as a host has it: the tarball in a project of its own, without a network ----
rm -rf "$scratch/project"
mkdir -p "$scratch/project"
export npm_config_cache=$scratch/npm npm_config_update_notifier=false npm_config_audit=false npm_config_fund=false
(cd "$scratch/project" && npm pack --silent "$package" > packed && npm init --yes > /dev/null &&
  npm install --silent --offline "./$(cat packed)")
cp bindings/javascript/example.mjs bindings/javascript/tests/* "$scratch/project"

"$CC" -std=c11 -O1 -Iinclude bindings/example.c "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/example"
"$scratch/example" > "$scratch/expected"
cd "$scratch/project"
installed=$PWD/node_modules/libmpm
for binary in libmpm.simd.wasm libmpm.wasm ''; do
  node example.mjs ${binary:+"$installed/$binary"} | diff "$scratch/expected" - ||
    { echo "javascript: the example has other results with ${binary:-no name of a binary}" >&2; exit 1; }
done
grep -q "$(sed -n 's/^hash //p' "$scratch/expected")" node_modules/libmpm/README.md ||
  { echo 'javascript: README.md has another hash than the example' >&2; exit 1; }
echo "javascript: the example: $(tail -n 1 "$scratch/expected"), with both binaries"

# ---- the scenes of the page as a program in C ----
export STEPS=200 WANTED=1000 LIVE=$live EXPECTED=$scratch/scenes.hashes
node native.mjs "$live" $STEPS $WANTED jelly water sand snow stacking stirrer > "$scratch/scenes.c"
"$CC" -std=c11 -O1 -Wall -Wextra -I"$OLDPWD/include" "$scratch/scenes.c" "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/scenes"
"$scratch/scenes" > "$EXPECTED"

# ---- the tests ----
for binary in libmpm.simd.wasm libmpm.wasm; do
  LIBMPM_WASM=$installed/$binary node --expose-gc --test objects.test.mjs callbacks.test.mjs scenes.test.mjs > "$scratch/log" ||
    { cat "$scratch/log" >&2; exit 1; }
  echo "javascript: $binary: $(sed -n 's/^# pass //p' "$scratch/log") tests"
done

# ---- what takes tools of the registry ----
tools=$scratch/tools
have_registry() { npm ping --silent --fetch-retries=0 --fetch-timeout=20000 > /dev/null 2>&1; }
fetched() {
  [ -e "$tools/node_modules/typescript" ] && [ -e "$tools/node_modules/playwright-core" ] && return
  have_registry || return
  timeout 120 npm install --silent --prefix "$tools" --no-save "$TYPESCRIPT" "$PLAYWRIGHT" > "$scratch/log" 2>&1 ||
    { cat "$scratch/log" >&2; echo "javascript: the registry has no $TYPESCRIPT or $PLAYWRIGHT" >&2; exit 1; }
}
mkdir -p "$tools"
if ! fetched; then
  echo 'javascript: declarations and the live page are NOT CHECKED: the npm registry cannot be reached'
  exit 0
fi
node "$tools/node_modules/typescript/bin/tsc" --noEmit --strict --target es2022 --lib es2022,dom \
  --module nodenext --moduleResolution nodenext types.ts
echo 'javascript: the declarations'
if [ "${BROWSER:-yes}" = no ]; then
  echo 'javascript: the live page is not checked: BROWSER=no'
else
  CHROMIUM=$(command -v "${CHROMIUM:-chromium}")
  export CHROMIUM
  ln -sfn "$tools/node_modules/playwright-core" node_modules/playwright-core
  node browser.mjs "$live" "$EXPECTED" "$scratch/pictures" | sed 's/^/javascript: /'
fi
