#!/usr/bin/python3
"""Draws docs/verification/*.svg and fills the tables of docs/verification.md. Needs Debian's python3-matplotlib.

    plot.py [--from FOLDER] [NAME]

FOLDER is where `make verify` has left its CSV files (build/verification/full). Of these, the ones that also lie beside
this file, because it takes minutes to make them, are taken over, with the gates into results.csv; the others are only
read. What cannot be drawn because a file is missing stays as it is, and the end says how to make it. NAME selects the
plots whose name contains it.

A plot is a function in plot_*.py, marked @plot, that draws into what axes() returns; its name is the file's."""
import argparse
import csv
import importlib
import math
import pathlib
import re
import shutil
import sys

sys.dont_write_bytecode = True
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
CASES = sorted((path.stem for path in (TOP / "tests/verification").glob("*.c")), key=len, reverse=True)
OTHER_NAMES = {"bar_smoothing": "bar_stability", "bar_cfl_4": "bar_stability", "bar_cfl_8": "bar_stability"}
PLOTS = {}
made = TOP / "build/verification/full"
plt.rcParams.update({
    "svg.hashsalt": "mpm", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.markersize": 4})


def plot(function):
    PLOTS[function.__name__] = function
    return function


def axes(columns=1, width=4.8, height=3.4):
    figure, ax = plt.subplots(1, columns, figsize=(width * columns, height), layout="constrained")
    return figure, ax


class Missing(Exception):
    """No <name>.csv. A case's files have its name, or begin with it."""

    def __init__(self, name):
        super().__init__(name)
        self.case = OTHER_NAMES.get(name) or next(case for case in CASES if name.startswith(case))


def read(name):
    """Columns of <name>.csv by heading; numbers where all entries are."""
    path = next((p for p in (made / (name + ".csv"), HERE / (name + ".csv")) if p.exists()), None)
    if not path:
        raise Missing(name)
    with open(path, newline="") as file:
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


def take_over():
    """The files of the last run that lie here as well, and its gates case by case."""
    for path in HERE.glob("*.csv"):
        if path.name != "results.csv" and (made / path.name).exists():
            shutil.copy(made / path.name, path)
    if not (made / "results.csv").exists():
        return

    def rows(path):
        heading, *lines = path.read_text().splitlines()
        cases = {}
        for line in lines:
            cases.setdefault(next(csv.reader([line]))[0], []).append(line)
        return heading, cases

    heading, cases = rows(HERE / "results.csv")
    cases.update(rows(made / "results.csv")[1])
    (HERE / "results.csv").write_text("\n".join([heading] + [line for case in cases.values() for line in case]) + "\n")


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
    global made
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--from", dest="made", type=pathlib.Path, default=made, metavar="FOLDER")
    parser.add_argument("wanted", nargs="?", default="", metavar="NAME")
    arguments = parser.parse_args()
    made, wanted, left = arguments.made, arguments.wanted, {}
    take_over()
    for module in sorted(HERE.glob("plot_*.py")):
        importlib.import_module(module.stem)
    for name, function in PLOTS.items():
        if wanted in name:
            try:
                figure = function()
                figure.savefig(HERE / (name + ".svg"), metadata={"Date": None})
            except Missing as missing:
                left.setdefault(missing.case, []).append(name)
            plt.close("all")
    if not wanted:
        fill_tables()
    for case, names in left.items():
        print(f"plot.py: left as they are, for want of numbers: {', '.join(names)}", file=sys.stderr)
    if left:
        sys.exit(f'plot.py: make verify CASES="{" ".join(left)}" makes them, make verify-plots then draws')


if __name__ == "__main__":
    sys.modules["plot"] = sys.modules[__name__]
    main()
