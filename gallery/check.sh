#!/usr/bin/env bash
# Runs every program of the gallery on few particles: it must end well, write its picture, and draw something in it.
# PYTHON: one that has the package mpm, numpy and Pillow; without it, an environment is made for the time of the check.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
if [ -z "${PYTHON:-}" ]; then
  /usr/bin/python3 -m venv --system-site-packages "$work/env"
  "$work/env/bin/pip" install -q "$here/../bindings/python"
  PYTHON=$work/env/bin/python
fi
for program in "$here"/*.py; do
  name=$(basename "$program" .py)
  case $name in style | splats) continue ;; esac
  "$PYTHON" "$program" --quick --threads 1 "$work/pictures"
  "$PYTHON" - "$work/pictures/$name" "$here/../docs/gallery/$name" <<'END'
import pathlib, sys
from PIL import Image
made, kept = sys.argv[1:]
for kind in (".png", ".apng"):
    if not pathlib.Path(kept + kind).exists():
        if kind == ".png":
            sys.exit(f"{kept}{kind} is not there")
        continue
    with Image.open(made + kind) as image:
        if kind == ".apng" and image.n_frames < 2:
            sys.exit(f"{made}{kind} does not move")
        tints = image.convert("RGB").getcolors(image.width * image.height)
        if sum(count for count, tint in tints if min(tint) < 240) < 0.01 * image.width * image.height:
            sys.exit(f"{made}{kind} is empty")
END
done
