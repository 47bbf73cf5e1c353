"""Runs the code of a notebook from top to bottom, without Jupyter."""
import json
import sys

import matplotlib

matplotlib.use("Agg")
names = {}
with open(sys.argv[1], encoding="utf-8") as notebook:
    for cell in json.load(notebook)["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
