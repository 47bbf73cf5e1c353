#!/usr/bin/python3
"""Draws docs/verification/*.svg from the CSV files beside it, and fills the tables of docs/verification.md from
results.csv. Needs Debian's python3-matplotlib. An argument selects the plots whose name contains it.

A plot is a function in plot_*.py, marked @plot, that draws into what axes() returns; its name is the file's."""
import csv
import importlib
import math
import pathlib
import re
import sys

sys.dont_write_bytecode = True
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
PLOTS = {}
plt.rcParams.update({
    "svg.hashsalt": "mpm", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.markersize": 4})


def plot(function):
    PLOTS[function.__name__] = function
    return function


def axes(columns=1, width=4.8, height=3.4):
    figure, ax = plt.subplots(1, columns, figsize=(width * columns, height), layout="constrained")
    return figure, ax


def read(name):
    """Columns of <name>.csv by heading; numbers where all entries are."""
    with open(HERE / (name + ".csv"), newline="") as file:
        heading, *rows = list(csv.reader(file))
    columns = {}
    for key, values in zip(heading, zip(*rows)):
        try:
            columns[key] = [float(v) for v in values]
        except ValueError:
            columns[key] = list(values)
    return columns


def slope(ax, x, y, order, text=None):
    """A line of the given order from (x[0], y) to x[1], in logarithmic axes."""
    ax.plot(x, [y, y * (x[1] / x[0]) ** order], "k:", linewidth=1)
    ax.annotate(text or f"order {abs(order):g}", (x[1], y * (x[1] / x[0]) ** order), fontsize=8)


def loglog(ax, x_label, y_label, base=2):
    ax.set_xscale("log", base=base)
    ax.set_yscale("log")
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)


def ticks(ax, values):
    """These values along x, in figures."""
    ax.set_xticks(values, [f"{v:g}" for v in values])
    ax.minorticks_off()


def number(text):
    value = float(text)
    return {math.inf: "∞", -math.inf: "-∞"}.get(value, f"{value:.4g}")


def fill_tables():
    """Between `<!-- results CASE -->` and `<!-- end -->`: what was measured."""
    page = HERE.parent / "verification.md"
    with open(HERE / "results.csv", newline="") as file:
        rows = list(csv.DictReader(file))

    def table(match):
        lines = ["| measured | value | gate | verdict | gate from |", "|---|---|---|---|---|"]
        for r in rows:
            if r["case"] == match[1]:
                verdict = {"expected": "*expected failure*"}.get(r["verdict"], r["verdict"])
                lines.append(f"| {r['what']} | {number(r['value'])} | {number(r['low'])} … {number(r['high'])} "
                             f"| {verdict} | {r['source']} |")
        if len(lines) == 2:
            sys.exit(f"plot.py: results.csv has no case {match[1]}")
        return f"<!-- results {match[1]} -->\n" + "\n".join(lines) + "\n<!-- end -->"

    text = page.read_text()
    page.write_text(re.sub(r"<!-- results (\w+) -->\n.*?<!-- end -->", table, text, flags=re.S))


def main():
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    for module in sorted(HERE.glob("plot_*.py")):
        importlib.import_module(module.stem)
    for name, function in PLOTS.items():
        if wanted in name:
            figure = function()
            figure.savefig(HERE / (name + ".svg"), metadata={"Date": None})
            plt.close(figure)
    if not wanted:
        fill_tables()


if __name__ == "__main__":
    sys.modules["plot"] = sys.modules[__name__]
    main()
