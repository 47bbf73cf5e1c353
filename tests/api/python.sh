#!/usr/bin/env bash
# The Python of docs/guide.md runs as printed, where there is a Python with numpy.
set -euo pipefail
build=${BUILD:-build}
python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import numpy' 2> /dev/null; then python=$candidate; fi
done
if [ -z "$python" ]; then
  echo "python.sh: skipped: no Python has numpy"
  exit 0
fi
awk '/^```python$/ {inside = 1; next} /^```/ {inside = 0} inside' docs/guide.md \
  | "$python" tests/api/python.py "$build/libmpm.so"
