#!/usr/bin/env bash
# The package is built without a network, gives the bits of the C program, and passes its tests.
set -euo pipefail
cd "$(dirname "$0")/../.."
CC=${CC:-cc} BUILD=${BUILD:-$PWD/build} scratch=${MPM_SCRATCH:-$BUILD/tests/scratch}/python
python='' missing=''
find_python() { # modules beside those that are needed
  local candidate
  for candidate in "${PYTHON:-python3}" /usr/bin/python3; do
    if "$candidate" -c "import sys, numpy, venv, ensurepip$1; sys.exit(sys.version_info < (3, 11))" 2> /dev/null; then
      python=$candidate
      return
    fi
  done
  false
}
if ! find_python ', numba, matplotlib'; then
  missing='numba or matplotlib'
  find_python '' || {
    echo 'python: not checked: there is no Python from 3.11 on with numpy and venv'
    exit 77
  }
fi
rm -rf "$scratch"
mkdir -p "$scratch"
"$CC" -std=c11 -Wall -Wextra -Werror -Iinclude bindings/example.c "$BUILD/libmpm.a" -lm -lpthread -o "$scratch/example"
"$python" -m venv --system-site-packages "$scratch/env"
CC=$CC CFLAGS="-O2 -Wall -Wextra -Werror" MPM_LIBRARY=$BUILD/libmpm.so.0 \
  "$scratch/env/bin/pip" install -q --no-index --no-deps --disable-pip-version-check ./bindings/python
unset MPM_LIBRARY
cmp <("$scratch/example") <("$scratch/env/bin/python" bindings/python/example.py)
cd bindings/python/tests
PYTHONDONTWRITEBYTECODE=1 MPLCONFIGDIR=$scratch "$scratch/env/bin/python" -W error::ResourceWarning -m unittest -q
cd ..
if "$scratch/env/bin/python" -c 'import matplotlib' 2> /dev/null; then
  export MPLCONFIGDIR=$scratch MPLBACKEND=agg
  "$scratch/env/bin/python" tests/run_notebook.py introduction.ipynb > "$scratch/notebook.txt"
  awk '/^```python$/ {inside = 1; next} /^```/ {inside = 0} inside' README.md > "$scratch/ball.py"
  (cd "$scratch" && env/bin/python ball.py > ball.txt && [ -s ball.png ])
fi
echo "python: the C program's bits; tests passed"
if [ -n "$missing" ]; then
  echo "python: pictures, the notebook or compiled callbacks are not checked: there is no $missing"
  exit 77
fi
