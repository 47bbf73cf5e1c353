#!/usr/bin/env bash
# cases.sh OUT JOBS "PARTS..." PROGRAM...: runs cases of the verification in small on one part and on so many, which must
# come to the same hashes, results and files.
set -euo pipefail
export LC_ALL=C
out=$1 jobs=$2 parts=$3
shift 3
rm -rf "$out"
mkdir -p "$out"
# Here the iterations that problems with a transport have do not do what the gates ask for, on one part as on several:
# they do not converge, or do not tell what is singular.
hard="advice cook"
export out parts hard

run() { # program parts
  local folder=$out/${1##*/}.$2 status=0
  mkdir -p "$folder"
  nice "$1" --parts "$2" --quick --out "$folder" 2> "$folder/errors" || status=$?
  echo "$status" > "$folder/status"
}

one() {
  local name=${1##*/} n k line
  run "$1" 1
  for n in $parts; do
    run "$1" "$n"
    if ! cmp -s "$out/$name.1/status" "$out/$name.$n/status" || ! grep -q '^HASH' "$out/$name.1/part_0/log"; then
      echo "$name on $n parts: ended otherwise: $(tail -1 "$out/$name.$n/errors")"
      continue
    fi
    line=equal
    for k in $(seq 0 $((n - 1))); do
      diff -rq "$out/$name.1/part_0" "$out/$name.$n/part_$k" > /dev/null || line="other results, in part $k"
    done
    if [ "$(cat "$out/$name.$n/status")" != 0 ] && [ "$line" = equal ]; then
      line="equal, and fails: $(tail -1 "$out/$name.$n/errors")"
      case " $hard $line" in *" $name "*" iterations the residual is "*) line=equal ;; esac
    fi
    echo "$name on $n parts: $line"
  done
}
export -f run one

start=$SECONDS
printf '%s\n' "$@" | xargs -P "$jobs" -I{} bash -c 'one {}' | tee "$out/lines"
equal=$(grep -c ': equal$' "$out/lines" || :) total=$(wc -l < "$out/lines")
echo "check-parts: $equal of $total runs of cases equal, $((SECONDS - start)) s"
[ "$equal" -gt 0 ] && [ "$equal" = "$total" ]
