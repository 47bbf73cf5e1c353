#!/usr/bin/env bash
# The crates against the library: layouts, what the safe layer promises, and the example with C's output. Without network.
set -euo pipefail
if ! command -v cargo > /dev/null; then
  echo "rust: not checked: there is no cargo"
  exit 77
fi
scratch=$MPM_SCRATCH/rust
mkdir -p "$scratch"
export MPM_LIB_DIR=$BUILD LD_LIBRARY_PATH=$BUILD${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} CARGO_TARGET_DIR=$scratch/target
export CARGO_PROFILE_DEV_DEBUG=0 CARGO_PROFILE_TEST_DEBUG=0 CARGO_INCREMENTAL=0 RUST_BACKTRACE=0
export RUSTFLAGS=${WERROR:+-Dwarnings} # as for C: warnings end the build where the gate asks for it
run() {
  cargo "$1" --offline --locked --quiet --manifest-path bindings/rust/Cargo.toml "${@:2}"
}
run test > "$scratch/log" 2>&1 || {
  cat "$scratch/log" >&2
  echo "rust: tests fail" >&2
  exit 1
}
if cargo clippy --version > /dev/null 2>&1; then
  run clippy --all-targets
fi
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude bindings/example.c -L"$BUILD" -lmpm -Wl,-rpath,"$BUILD" -o "$scratch/in_c"
"$scratch/in_c" > "$scratch/expected"
run run --example disks > "$scratch/found"
diff "$scratch/expected" "$scratch/found" || {
  echo "rust: the example differs from that in C" >&2
  exit 1
}
echo "rust: $(grep -c '^running' "$scratch/log") groups of tests, $(paste -sd ' ' "$scratch/found")"
