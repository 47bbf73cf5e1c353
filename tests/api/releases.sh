#!/usr/bin/env bash
# Hosts and libraries of several releases work together: tests/abi/host.c prints the same to the last bit
# - against the headers of 0.1.0 and those of today, with today's library;
# - against headers in which every versioned struct has got one more field, with today's library, as long as the host
#   leaves the field at zero; a descriptor in which it is set is refused with a sentence;
# - against all of these with a library that knows the field.
# That library is built of today's kernels, which hold no such struct, and of all other files anew. And a state that 0.1.0
# saved (tests/abi/old_state.c save) is loaded as it was and goes on; state.txt is what 0.1.0 says of it, and of the step after,
# but for the work of that step: 0.1.0 left out of it a part of what moves mirror images beside the slip wall.
set -euo pipefail
BUILD=${BUILD:-build} CC=${CC:-cc}
scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/releases
rm -rf "$scratch"
mkdir -p "$scratch/grown/mpm" "$scratch/library"
fail() { echo "releases.sh: $*" >&2; exit 1; }

# One more field at the end of every struct that begins with struct_size.
structs=$(sed -nE 's/^  uint32_t struct_size;.*sizeof\((mpm_[a-z_]+)\).*/\1/p' include/mpm/*.h)
[ "$(grep -c '^  uint32_t struct_size;' include/mpm/*.h | awk -F: '{ n += $2 } END { print n }')" = "$(wc -w <<< "$structs")" ]
for header in include/mpm/*.h; do
  script=
  for name in $structs; do script+="s/^} $name;/  double appended;\n} $name;/;"; done
  sed "$script" "$header" > "$scratch/grown/mpm/${header##*/}"
done
[ "$(cat "$scratch"/grown/mpm/*.h | grep -c '^  double appended;')" = "$(wc -w <<< "$structs")" ]

flags="-std=c11 -Wall -Wextra -Wpedantic -Werror -g"
host() { # name, folder of headers, flags
  # shellcheck disable=SC2086
  "$CC" $flags "-I$2" ${3:-} tests/abi/host.c -o "$scratch/$1" -L"$BUILD" -lmpm -lm
  # shellcheck disable=SC2086
  "$CC" $flags "-I$2" tests/abi/old_state.c -o "$scratch/$1-state" -L"$BUILD" -lmpm -lm
}
host released tests/abi/0.1.0/include
host today include
host newer "$scratch/grown" -DAPPENDED

mkdir "$scratch/present"
cp "$BUILD/libmpm.so" "$scratch/present/libmpm.so.0"
run() { # library, host, argument
  LD_LIBRARY_PATH=$scratch/$1 "$scratch/$2" ${3:+"$3"}
}
run present released > "$scratch/wanted" || fail "the host of 0.1.0: $(tail -n 1 "$scratch/wanted")"
[ "$(wc -l < "$scratch/wanted")" -gt 10 ]
same() { # library, host
  run "$1" "$2" > "$scratch/out" || fail "$2 host, $1 library: $(tail -n 1 "$scratch/out")"
  diff "$scratch/wanted" "$scratch/out" || fail "$2 host, $1 library: '<' is what the host of 0.1.0 gets"
}
same present today
same present newer
old_state() { # library, host
  LD_LIBRARY_PATH=$scratch/$1 "$scratch/$2-state" load tests/abi/0.1.0/state.mpm > "$scratch/out" || fail "$2 host, $1 library: $(tail -n 1 "$scratch/out")"
  diff tests/abi/0.1.0/state.txt "$scratch/out" || fail "$2 host, $1 library: '<' is what 0.1.0 says of its state"
}
for host in released today newer; do old_state present $host; done

refused=0
for name in $structs; do
  case $name in *_desc) ;; *) continue ;; esac
  if run present newer "$name" > "$scratch/out"; then fail "$name with a field that the library does not know passed"; fi
  wanted="MPM_E_UNSUPPORTED: $name sets a field that this version of the library does not know"
  [ "$name" = mpm_context_desc ] && wanted=MPM_E_UNSUPPORTED # there is no context that could keep the sentence
  tail -n 1 "$scratch/out" | grep -F "$wanted" > /dev/null || fail "$name: $(tail -n 1 "$scratch/out")"
  refused=$((refused + 1))
done
[ $refused = 11 ]

# The library that knows the field: its table of releases has one more line for every struct.
awk -v structs="$(tr '\n' ' ' <<< "$structs")" '
  /^#define RELEASES\(X\)/ { inside = 1 }
  inside && !/\\$/ {
    print $0 " \\"
    n = split(structs, name, " ")
    for (i = 1; i <= n; ++i) print "  X(" name[i] ", appended, sizeof(" name[i] "))" (i < n ? " \\" : "")
    inside = 0
    next
  }
  { print }' src/context/structs.c > "$scratch/library/structs.c"
objects=()
{
  for source in src/*/*.c; do
    kernel=("$BUILD/obj/${source%.c}".{baseline,avx2,avx512,neon}.o)
    for object in "${kernel[@]}"; do [ -e "$object" ] && objects+=("$object"); done
    [ -e "${kernel[0]}" ] && continue
    object=$scratch/library/$(tr / _ <<< "${source%.c}").o
    objects+=("$object")
    [ "$source" = src/context/structs.c ] && source=$scratch/library/structs.c
    echo "$source $object"
  done
} > "$scratch/library/sources"
# shellcheck disable=SC2016
xargs -P "$(nproc)" -L 1 sh -c '"$0" -std=c11 -O0 -ffp-contract=off -fPIC -fvisibility=hidden -I"$1" -Isrc -c "$2" -o "$3"' \
  "$CC" "$scratch/grown" < "$scratch/library/sources"
"$CC" -shared -Wl,-soname,libmpm.so.0 -Wl,--version-script=src/libmpm.map "${objects[@]}" -lm -lpthread \
  -o "$scratch/library/libmpm.so.0"
same library released
same library newer
old_state library released
for name in $structs; do
  case $name in *_desc) ;; *) continue ;; esac
  run library newer "$name" > "$scratch/out" || fail "$name: the library refuses a field that it knows"
  diff "$scratch/wanted" "$scratch/out" || fail "$name: '<' is what the host of 0.1.0 gets"
done
echo "releases.sh: $(wc -w <<< "$structs") structs, $refused of them descriptors"
