#!/usr/bin/env python3
"""Draws the scaling of a rate with the number of particles, and with the size of the bounds around the same body.

    plot.py OUT.svg FILE.csv...     files written by bench --csv
"""
import csv
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "libmpm"
import matplotlib.pyplot as plt


def rows(names):
    for name in names:
        with open(name, newline="") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                yield {**row, "run": name}


def main(out, *names):
    table = list(rows(names))
    figure, axes = plt.subplots(figsize=(6.4, 3.2))
    colours = {}
    for case in dict.fromkeys(row["case"] for row in table):
        for spread, line in (("3", "-"), ("3000", ":")):
            label = case if spread == "3" else f"{case}, bounds 1000 times wider"
            for run in names:  # each has a line of its own: other runs are of other hours
                chosen = [r for r in table if (r["case"], r["spread"], r["threads"], r["run"]) == (case, spread, "1", run)]
                chosen.sort(key=lambda r: int(r["particles"]))
                if len(chosen) < 2:  # nothing to connect
                    continue
                axes.plot([int(r["particles"]) for r in chosen], [1e3 / float(r["median_Mps"]) for r in chosen],
                          line, marker="o", color=f"C{colours.setdefault(label, len(colours))}",
                          label=label if label not in axes.get_legend_handles_labels()[1] else None)
    axes.set_xscale("log")
    axes.margins(x=0.08)
    axes.set_ylim(0, 1.12 * max(1e3 / float(r["median_Mps"]) for r in table if r["threads"] == "1"))
    axes.set_xlabel("particles")
    axes.set_ylabel("ns per particle and step, one thread")
    axes.legend(loc="lower right")
    figure.tight_layout()
    figure.savefig(out, metadata={"Date": None})


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
