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
            yield from csv.DictReader(line for line in file if not line.startswith("#"))


def main(out, *names):
    table = list(rows(names))
    figure, axes = plt.subplots(figsize=(6.4, 3.2))
    for case in dict.fromkeys(row["case"] for row in table):
        for spread, line in (("3", "-"), ("3000", ":")):
            chosen = [r for r in table if r["case"] == case and r["spread"] == spread and r["threads"] == "1"]
            chosen.sort(key=lambda r: int(r["particles"]))
            if len(chosen) < 2:  # nothing to connect
                continue
            label = case if spread == "3" else f"{case}, bounds 1000 times wider"
            axes.plot([int(r["particles"]) for r in chosen], [1e3 / float(r["median_Mps"]) for r in chosen],
                      line, marker="o", label=label)
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
