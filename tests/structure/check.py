#!/usr/bin/env python3
"""Reads which files of src/ need which others, and refuses circles and arrows that point upward.

Headers of an operating system are for the folder `platform` alone: what other files include of no folder here is ISO C11,
or, in `simd`, names the processor's instructions.

A node is a header X.h together with the X.c beside it. An arrow goes from a node to one whose header it includes, and
to one whose functions or data it uses; the second is read from the object files, and from the text of the functions
that are defined in headers. Of kernels only the objects of the baseline are read: the others have the same arrows.

    check.py [--source src] [--objects build/obj/src] [--layers FILE] [--measure]
"""
import argparse
import collections
import os
import re
import subprocess
import sys

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.M)
SYSTEM_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*<([^">]+)>', re.M)
FEATURES = re.compile(r'^[ \t]*#[ \t]*define[ \t]+(_(?:POSIX_C|DEFAULT|GNU|BSD|XOPEN|DARWIN_C)_SOURCE)\b', re.M)
OF_THE_PROCESSOR = {('simd', 'immintrin.h')}
ISO_C11 = {name + '.h' for name in (
    'assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic '
    'stdbool stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype').split()}
SYSTEM_FOLDER = 'platform'
NOT_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
FUNCTION = re.compile(r'\)\s*\{')
NAME = re.compile(r'\bmpmi?_\w+')

Arrow = collections.namedtuple('Arrow', 'start end file symbol')


def folder_of(node):
    return node.rpartition('/')[0]


def read_layers(path):
    order = []
    with open(path) as lines:
        for line in lines:
            words = line.split('#')[0].split()
            if not words:
                continue
            if len(words) == 1:
                order.append(words[0])
            else:
                sys.exit(f'{path}: cannot read "{line.strip()}"')
    return order


def find_sources(top):
    found = {}
    for folder, _, names in os.walk(top):
        for name in names:
            if name.endswith(('.c', '.h')):
                path = os.path.join(folder, name)
                with open(path) as file:
                    found[os.path.relpath(path, top)] = file.read()
    return found


def object_of(objects, source):
    """The newest of the objects that a source file may have: a file that became a kernel leaves its old one behind."""
    stem = os.path.join(objects, source[:-2])
    there = [path for path in (stem + '.o', stem + '.baseline.o') if os.path.exists(path)]
    return max(there, key=os.path.getmtime) if there else None


def read_symbols(objects, sources):
    """Who defines a symbol, and which symbols each node needs: {symbol: node}, {(file, symbol)}."""
    of = {}
    for source in sources:
        if source.endswith('.c'):
            path = object_of(objects, source)
            if not path:
                sys.exit(f'{source} has no object in {objects}: build the library first')
            of[path] = source
    listing = subprocess.run([os.environ.get('NM', 'nm'), '-A', '-g', '-P', *of], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    defined, needed = {}, set()
    for line in listing.splitlines():
        path, _, rest = line.partition(': ')
        symbol, kind = rest.split()[:2]
        if not NAME.fullmatch(symbol):
            continue
        if kind in 'Uvw':
            needed.add((of[path], symbol))
        else:
            defined[symbol] = of[path][:-2]
    return defined, needed


def function_bodies(text):
    """What stands in the functions that a header defines."""
    text = NOT_CODE.sub(' ', text)
    for start in FUNCTION.finditer(text):
        at, depth = start.end(), 1
        while at < len(text) and depth:
            depth += {'{': 1, '}': -1}.get(text[at], 0)
            at += 1
        yield text[start.end():at]


def find_arrows(sources, objects):
    nodes = {source[:-2] for source in sources}
    defined, needed = read_symbols(objects, sources)
    for source, text in sources.items():
        if source.endswith('.h'):
            needed.update((source, name) for body in function_bodies(text) for name in NAME.findall(body))
    arrows = set()
    for source, text in sources.items():
        for name in INCLUDE.findall(text):
            beside = os.path.join(os.path.dirname(source), name)
            name = beside if beside in sources else name
            if name[:-2] in nodes:
                arrows.add(Arrow(source[:-2], name[:-2], source, f'#include "{name}"'))
    for source, symbol in needed:
        if symbol in defined:
            arrows.add(Arrow(source[:-2], defined[symbol], source, symbol))
    return sorted(arrow for arrow in arrows if arrow.start != arrow.end)


def circles_of(nodes, arrows):
    """Sets of nodes that reach each other: Tarjan's strongly connected components of more than one node."""
    ends = collections.defaultdict(list)
    for arrow in arrows:
        ends[arrow.start].append(arrow.end)
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for end in ends[node]:
            if end not in index:
                visit(end)
                low[node] = min(low[node], low[end])
            elif end in stack:
                low[node] = min(low[node], index[end])
        if low[node] == index[node]:
            at = stack.index(node)
            if len(stack) - at > 1:
                found.append(set(stack[at:]))
            del stack[at:]

    for node in sorted(nodes):
        if node not in index:
            visit(node)
    return found


def show(arrow):
    print(f'  {arrow.file} -> {arrow.end}: {arrow.symbol}')


def check(sources, arrows, order):
    failures = 0
    level = {folder: k for k, folder in enumerate(order)}
    for folder in sorted({folder_of(source) for source in sources} - set(order)):
        print(f'structure: the folder {folder} is not in the list of layers')
        failures += 1
    for arrow in arrows:
        start, end = folder_of(arrow.start), folder_of(arrow.end)
        if level.get(start, 0) < level.get(end, 0):
            print(f'structure: {start} lies below {end}:')
            show(arrow)
            failures += 1
    for source, text in sorted(sources.items()):
        if folder_of(source) != SYSTEM_FOLDER:
            foreign = [f'includes <{name}>' for name in SYSTEM_INCLUDE.findall(text)
                       if name not in ISO_C11 and not name.startswith('mpm/')
                       and (folder_of(source), name) not in OF_THE_PROCESSOR]
            for what in foreign + [f'defines {name}' for name in FEATURES.findall(text)]:
                print(f'structure: {source} {what}, which is not ISO C11: only {SYSTEM_FOLDER} may')
                failures += 1
    between = [Arrow(folder_of(a.start), folder_of(a.end), a.file, a.symbol) for a in arrows
               if folder_of(a.start) != folder_of(a.end)]
    for circle in circles_of({a.start for a in between}, between):
        print('structure: a circle of folders: ' + ', '.join(sorted(circle)))
        failures += 1
    inside = [a for a in arrows if folder_of(a.start) == folder_of(a.end)]
    for circle in circles_of({a.start for a in inside}, inside):
        print('structure: a circle of files:')
        for arrow in inside:
            if arrow.start in circle and arrow.end in circle:
                show(arrow)
        failures += 1
    return failures


def longest_chain(arrows):
    """The longest chain of includes, from a file down to one that includes nothing of src/."""
    ends = collections.defaultdict(set)
    for arrow in arrows:
        if arrow.symbol.startswith('#'):
            ends[arrow.file].add(arrow.end + '.h')
    known = {}

    def chain(file, above):
        if file not in known:
            known[file] = [file] + max((chain(end, above | {file}) for end in sorted(ends[file] - above)), key=len,
                                       default=[])
        return known[file]

    return max((chain(file, {file}) for file in sorted(ends)), key=len, default=[])


def measure(sources, arrows):
    chain = longest_chain(arrows)
    print(f'longest chain of includes: {len(chain)} files')
    print('  ' + ' > '.join(chain))
    between = collections.Counter()
    for arrow in arrows:
        if folder_of(arrow.start) != folder_of(arrow.end):
            between[folder_of(arrow.start), folder_of(arrow.end), arrow.symbol.startswith('#')] += 1
    print('arrows from folder to folder: includes, symbols')
    for start, end in sorted({key[:2] for key in between}):
        print(f'  {start:>12} -> {end:<12} {between[start, end, True]:4} {between[start, end, False]:4}')
    lines = collections.Counter()
    for source, text in sources.items():
        lines[folder_of(source)] += text.count('\n')
    print(f'lines of code: {sum(lines.values())} in {len(sources)} files')
    for folder in sorted(lines):
        print(f'  {folder:>12} {lines[folder]:6}')


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--source', default='src')
    parser.add_argument('--objects', default='build/obj/src')
    parser.add_argument('--layers', default=os.path.join(here, 'layers.txt'))
    parser.add_argument('--measure', action='store_true', help='prints sizes and numbers of arrows as well')
    options = parser.parse_args()
    sources = find_sources(options.source)
    order = read_layers(options.layers)
    arrows = find_arrows(sources, options.objects)
    failures = check(sources, arrows, order)
    if options.measure:
        measure(sources, arrows)
    print(f'structure: {len({s[:-2] for s in sources})} files and headers, {len(arrows)} arrows, {failures} failures')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
