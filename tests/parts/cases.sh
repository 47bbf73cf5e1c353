#!/usr/bin/env bash
# cases.sh OUT JOBS "PARTS..." PROGRAM...: runs cases of the verification in small on one part and on so many, which must
# come to the same hashes, results and files. What the library refuses must be one of the sentences of refused.txt.
# In some cases GMRES has more than 2000 unknowns, where one part has a preconditioner that several have not; in billet, cook,
# drawn_bar, heat and soil_footing it goes on where conjugate gradients fail, as one part does by other means. There the first
# number of parts is compared with the others, so that there must be two.
set -euo pipefail
export LC_ALL=C
out=$1 jobs=$2 parts=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$out"
mkdir -p "$out"
beyond="billet cook drawn_bar heat ring_sphere soil_footing surface_cylinder surface_held"
# Here the iterations that several parts have do not converge, and say so.
hard="cook"
export out parts here beyond hard

run() { # program parts
  local folder=$out/${1##*/}.$2 status=0
  mkdir -p "$folder"
  nice "$1" --parts "$2" --quick --out "$folder" 2> "$folder/errors" || status=$?
  echo "$status" > "$folder/status"
}

one() {
  local name=${1##*/} n k line like=1
  case " $beyond " in *" $name "*) like=${parts%% *} ;; *) run "$1" 1 ;; esac
  if [ "$like" = "$parts" ]; then
    echo "$name on $parts parts: is compared with nothing"
    return
  fi
  for n in $parts; do # the first of them is run before it is compared with
    run "$1" "$n"
    line=$(sed -n 's/.*: MPM_E_UNSUPPORTED: \(part [0-9]*: \)*//p' "$out/$name.$n/errors" | head -1)
    if [ -n "$line" ] && grep -Fxq -- "$line" "$here/refused.txt"; then
      echo "$name on $n parts: refused: $line"
      continue
    fi
    if ! cmp -s "$out/$name.$like/status" "$out/$name.$n/status" || ! grep -q '^HASH' "$out/$name.$like/part_0/log"; then
      echo "$name on $n parts: ended otherwise: $(tail -1 "$out/$name.$n/errors")"
      continue
    fi
    line=equal
    for k in $(seq 0 $((n - 1))); do
      diff -rq "$out/$name.$like/part_0" "$out/$name.$n/part_$k" > /dev/null || line="other results, in part $k"
    done
    if [ "$(cat "$out/$name.$n/status")" != 0 ] && [ "$line" = equal ]; then
      line="equal, and fails: $(tail -1 "$out/$name.$n/errors")"
      case " $hard $line" in *" $name "*MPM_NOT_CONVERGED*"MPM_SOLVER_HOST may have"*) line="refused: MPM_NOT_CONVERGED" ;; esac
    fi
    echo "$name on $n parts: $line"
  done
}
export -f run one

start=$SECONDS
printf '%s\n' "$@" | xargs -P "$jobs" -I{} bash -c 'one {}' | tee "$out/lines"
equal=$(grep -c ': equal$' "$out/lines" || :) refused=$(grep -c ': refused: ' "$out/lines" || :) total=$(wc -l < "$out/lines")
echo "check-parts: $equal of $total runs of cases equal, $refused refused, $((SECONDS - start)) s"
[ "$equal" -gt 0 ] && [ "$((equal + refused))" = "$total" ]
