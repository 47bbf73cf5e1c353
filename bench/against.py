#!/usr/bin/env python3
"""Runs the cases of the benchmark by turns with two installed libraries, A B A B ..., and compares them.

    against.py [--quick] [--rounds N] BENCH PREFIX_A PREFIX_B

BENCH is one program for both: LD_LIBRARY_PATH says which library it loads, and it prints which it has. A ratio is that
of the speeds, B over A: above 1, B is faster. Each run counts with the best of its repeats, by time of the processor,
because what disturbs it only slows it. Explicit cases have 40 000 particles, implicit ones are one Newton iteration;
all have one thread. Left out are cases with a solver of the host, and the three that take longest.

Columns: medians of the rounds and their ratio; the least and the largest ratio of the two runs of a round; the ratio of
the best of all runs, which noise shakes least; whether results are equal in every bit. --quick: four explicit cases and
two implicit ones.
"""
import argparse
import glob
import os
import statistics
import subprocess
import sys

QUICK = ["3-D quadratic FLIP", "3-D quadratic APIC_MLS", "3-D linear FLIP", "2-D quadratic FLIP",
         "3-D linear 16^3, direct", "3-D linear 16^3, multigrid"]
TOO_LONG = ["3-D linear 64^3, multigrid", "3-D linear 32^3, CG", "3-D quadratic 16^3, CG"]
EXPLICIT = ["--particles", "40000", "--repeats", "3", "--threads", "1"]
IMPLICIT = ["--implicit", "--repeats", "2", "--threads", "1"]


class Lacks(Exception):
    """The library does not have what the case calls."""


def stop(text):
    sys.exit("bench: " + text)


def library_of(prefix):
    """The shared library of an installation: its real path."""
    places = ["lib", "lib64", "lib/*"]
    found = {os.path.realpath(path) for place in places
             for path in glob.glob(os.path.join(glob.escape(prefix), place, "libmpm.so.0"))}
    if len(found) != 1:
        stop(f"{prefix} has {len(found)} libraries libmpm.so.0: it must be the PREFIX of one installation")
    return found.pop()


def run(bench, library, options):
    """What the program prints, as lines of fields; None if it fails. An older library lacks functions of newer cases."""
    environment = dict(os.environ, LD_LIBRARY_PATH=os.path.dirname(library))
    done = subprocess.run([bench] + options, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False)
    if done.returncode == 127 and "undefined symbol" in done.stderr:
        raise Lacks
    sys.stderr.write(done.stderr)
    return None if done.returncode else [line.split("\t") for line in done.stdout.splitlines()]


def measure(bench, library, options, name):
    """The figure and the hash of the result; None if the run fails."""
    lines = run(bench, library, options + ["--bare", "--case", name])
    if lines is None:
        return None
    (_, loaded), (_, _, figure, result) = lines
    if os.path.realpath(loaded) != library:
        stop(f"the program has loaded {loaded}, not {library}")
    return float(figure), result


def compare(bench, libraries, options, name, rounds):
    """Prints the line of a case; the ratio of the medians, None if a run fails, 0 if a library lacks the case."""
    runs = []
    for i in range(2 * rounds):
        try:
            runs.append(measure(bench, libraries[i % 2], options, name))
        except Lacks:
            print(f"{name:32s} is not in {'AB'[i % 2]}", flush=True)
            return 0
        if runs[-1] is None:
            print(f"{name:32s} fails with {'AB'[i % 2]}", flush=True)
            return None
    of_a, of_b = runs[0::2], runs[1::2]
    is_time = "--implicit" in options
    speed_up = [a / b if is_time else b / a for (a, _), (b, _) in zip(of_a, of_b)]
    figures = [[figure for figure, _ in each] for each in (of_a, of_b)]
    a, b = map(statistics.median, figures)
    whole = a / b if is_time else b / a
    best = min(figures[0]) / min(figures[1]) if is_time else max(figures[1]) / max(figures[0])
    same = len({result for _, result in runs}) == 1
    print(f"{name:32s} {a:9.4g} {b:9.4g} {'s' if is_time else 'Mp/s':4s}  {whole:6.3f}"
          f"  {min(speed_up):6.3f} - {max(speed_up):.3f}  {best:6.3f}  {'same' if same else 'others'}", flush=True)
    return whole


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("bench")
    parser.add_argument("prefixes", nargs=2, metavar="PREFIX")
    given = parser.parse_args()
    if given.rounds < 1:
        stop("a comparison takes a round at least")
    libraries = [library_of(prefix) for prefix in given.prefixes]
    for label, library in zip("AB", libraries):
        print(f"{label}: {library}")
    print(f"\n{'medians of ' + str(given.rounds):32s} {'A':>9s} {'B':>9s} {'':4s}  {'B / A':>6s}  "
          f"{'of the rounds':>14s}  {'best':>6s}  results")
    failed = False
    for options in (EXPLICIT, IMPLICIT):
        names = [line[0] for line in run(given.bench, libraries[1], options + ["--list"]) or []]
        chosen = [name for name in names if (name in QUICK if given.quick else name not in TOO_LONG)]
        whole = [compare(given.bench, libraries, options, name, given.rounds) for name in chosen]
        if not any(whole) or None in whole:
            failed = True
        else:
            whole = [ratio for ratio in whole if ratio]
            mean = statistics.geometric_mean(whole)
            print(f"{'all ' + str(len(whole)) + ', geometric mean':57s}  {mean:6.3f}\n", flush=True)
    if failed:
        stop("not every case ran with both libraries")


main()
