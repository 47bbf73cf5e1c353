#!/usr/bin/env bash
# check.sh LANGUAGE...: the check of each language. One that lacks its tools ends with status 77: where there is apt, its
# tools are installed by `make bindings-setup` and it runs once more. SKIP_MISSING=1 does without.
set -euo pipefail
cd "$(dirname "$0")/.."
missing=

run() { # language...; leaves in $missing those that lack tools
  local language status
  missing=
  for language in "$@"; do
    echo "bindings/$language/check.sh"
    status=0
    bash "bindings/$language/check.sh" || status=$?
    case $status in
      0) ;;
      77) missing="$missing $language" ;;
      *) exit 1 ;;
    esac
  done
}

run "$@"
# shellcheck disable=SC2086
if [ -n "$missing" ] && [ "${SKIP_MISSING:-}" != 1 ] && command -v apt-get > /dev/null; then
  "${MAKE:-make}" bindings-setup
  run $missing
fi
[ -n "$missing" ] || exit 0
echo "check-bindings: for want of tools not, or not wholly, checked:$missing" >&2
[ "${SKIP_MISSING:-}" = 1 ] && exit 0
echo 'check-bindings: SKIP_MISSING=1 does without, LANGUAGES selects' >&2
exit 1
