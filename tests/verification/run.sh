#!/usr/bin/env bash
# run.sh DIR JOBS [--quick] PROGRAM...: runs the cases side by side, shows what goes on, gathers their RESULT lines in
# DIR/results.csv and ends with a table. Status 1: a gate failed, an expected failure did not, or a case broke off.
set -euo pipefail
dir=$1 jobs=$2
shift 2
quick=
if [ "${1:-}" = --quick ]; then quick=--quick; shift; fi
mkdir -p "$dir"
rm -f "$dir"/*.log "$dir"/results.csv
export dir quick

one() {
  local name=${1##*/} start=$SECONDS status=0
  echo "$name starts"
  nice "$1" $quick --out "$dir" > "$dir/$name.log" || status=$?
  local failed
  failed=$(grep -cE '\| (FAILED|MET) \|' "$dir/$name.log" || :)
  if [ "$status" -gt 1 ] || ! grep -q '^RESULT' "$dir/$name.log" || [ "$status" != "$((failed > 0))" ]; then
    echo "RESULT $name | runs to its end | $status | 0 | 0 | BROKEN | exit status" >> "$dir/$name.log"
    failed=$((failed + 1))
  fi
  echo "$name ends after $((SECONDS - start)) s: $(grep -c '^RESULT' "$dir/$name.log") gates, $failed not as expected"
}
export -f one

start=$SECONDS
printf '%s\n' "$@" | xargs -P "$jobs" -I{} bash -c 'one {}'
for program in "$@"; do cat "$dir/${program##*/}.log"; done | sed -n 's/^RESULT //p' > "$dir/all.log"
{
  echo 'case,what,value,low,high,verdict,source'
  awk -F ' [|] ' '{ for (i = 1; i <= 7; i++) { gsub(/"/, "\"\"", $i); printf "\"%s\"%s", $i, i < 7 ? "," : "\n" } }' "$dir/all.log"
} > "$dir/results.csv"

line='%-22s %-62s %12s  %-24s %s\n'
table() { # verdicts as a regular expression, heading
  if ! awk -F ' [|] ' -v verdict="$1" '$6 ~ verdict { found = 1 } END { exit !found }' "$dir/all.log"; then return; fi
  printf '\n%s\n' "$2"
  printf "$line" case what value gate verdict
  awk -F ' [|] ' -v verdict="$1" -v line="${line%\\n}" \
    '$6 ~ verdict { printf line "\n", $1, $2, $3, "[" $4 ", " $5 "]", $6 }' "$dir/all.log"
}
table '^(ok|FAILED|BROKEN)$' 'Gates'
table '^(expected|MET)$' 'Expected failures: gates that a correct method does not meet; the reasons are in docs/verification.md'
total=$(wc -l < "$dir/all.log") bad=$(grep -cE '\| (FAILED|MET|BROKEN) \|' "$dir/all.log" || :)
printf '\n%s gates in %s cases, %s not as expected, %s s\n' "$total" "$#" "$bad" "$((SECONDS - start))"
[ "$bad" = 0 ]
