#!/usr/bin/env python3
"""Writes the library as two files: mpm.h, all public headers, and mpm.c, all sources with the baseline's kernels.

A host compiles mpm.c with its own sources. Feature macros and includes of the C library come first; each internal
header stands where it is first needed; a name of file scope that another file has too gets the name of its file in
front; the macros of a file end with it.

    amalgamate.py [--source src] [--include include] OUTPUT_FOLDER
"""
import argparse
import collections
import os
import re
import sys

INCLUDE = re.compile(r'[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]')
DEFINE = re.compile(r'[ \t]*#[ \t]*define[ \t]+(\w+)', re.M)
CONDITION = re.compile(r'[ \t]*#[ \t]*(if|ifdef|ifndef|endif)\b')
FEATURE = re.compile(r'[ \t]*#[ \t]*define[ \t]+(_[A-Z]\w*)[ \t]+(\S+)[ \t]*$')
PIECE = re.compile(r'(?P<hidden>/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|\s+)|(?P<word>\w+)'
                   r'|(?P<mark>->|.)', re.S)
DIRECTIVE = re.compile(r'^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', re.M)
WORD = re.compile(r'[A-Za-z_]')
NOT_NAMES = set('__attribute__ _Alignas _Static_assert'.split())

HEAD = '''/* libmpm {version} in one file: compile it with the host's own sources.
 *
 *   cc host.c mpm.c -lm         with -pthread where the C library keeps threads apart
 *
 * It holds the kernels of MPM_ISA_BASELINE alone, and is built without contraction to fused multiply-add whatever the
 * options are, so that states have the bits of that set. It needs what GNU C and clang have in common. Written by
 * `make amalgamation` from the sources; changes belong there. */
'''
# The compilers' own ways to say: no contraction; no warning about vectors that pass between inlined functions, nor
# about functions of headers that one file does not need.
PRAGMAS = '''#ifndef MPM_BASELINE_ONLY
#define MPM_BASELINE_ONLY 1
#endif
#if defined(__FAST_MATH__)
#error "libmpm needs the rules of IEEE 754: compile mpm.c without -ffast-math"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#pragma clang diagnostic ignored "-Wunused-function"
#pragma clang diagnostic ignored "-Wpass-failed"
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#pragma GCC diagnostic ignored "-Wpsabi"
#else
#error "libmpm needs GNU C or clang"
#endif
'''


def read(path):
    with open(path, encoding='utf-8') as file:
        return file.read()


def is_guarded(text):
    """Whether the first directive opens a guard, so that once is enough."""
    first = DIRECTIVE.search(re.sub(r'/\*.*?\*/', '', text, flags=re.S))
    return bool(first and re.match(r'\s*#\s*ifndef\s+\w+_H\w*$', first.group().strip()))


def top_level(text):
    """The declarations of a file, as lists of (depth in braces, token), without comments, literals and directives."""
    text = DIRECTIVE.sub('', re.sub(r'/\*.*?\*/', ' ', text, flags=re.S))
    declaration, depth, parens = [], 0, 0
    for piece in PIECE.finditer(text):
        token = piece.group('word') or piece.group('mark')
        if not token:
            continue
        if token == '}':
            depth -= 1
        declaration.append((depth, parens, token))
        parens += (token == '(') - (token == ')')
        if token == '{':
            depth += 1
        tokens = [t for d, p, t in declaration if d == 0]
        function_ends = token == '}' and depth == 0 and ')' in tokens and '=' not in tokens and \
            not {'typedef', 'struct', 'union', 'enum'} & {tokens[0]}
        if depth == 0 and parens == 0 and (token == ';' or function_ends or is_body_end(declaration, token)):
            yield declaration
            declaration = []


def is_body_end(declaration, token):
    """Whether a closing brace ends a function that returns a struct, whose declaration begins as that of a struct."""
    tokens = [t for d, p, t in declaration if d == 0]
    at = tokens.index('{') if '{' in tokens else 0
    return token == '}' and at > 0 and tokens[at - 1] == ')' and '=' not in tokens[:at]


def names_of(declaration):
    """The names that a declaration of file scope makes: {(name, whether it is of this file alone)}."""
    outer = [(p, t) for d, p, t in declaration if d == 0]
    tokens = [t for p, t in outer]
    found = set()
    if 'enum' in tokens:
        expects = True
        for token in (t for d, p, t in declaration if d == 1):
            if expects and WORD.match(token):
                found.add((token, True))
            expects = token == ','
    for k in range(len(tokens) - 2):
        if tokens[k] in ('struct', 'union', 'enum') and tokens[k + 2] == '{':
            found.add((tokens[k + 1], not tokens[k + 1].startswith('mpm')))
    if tokens[0] == 'typedef':
        pointers = [tokens[k + 2] for k in range(len(tokens) - 2) if tokens[k] == '(' and tokens[k + 1] == '*']
        plain = [t for p, t in outer if p == 0 and WORD.match(t) and t not in NOT_NAMES]
        return found | {(name, True) for name in pointers[:1] or plain[-1:]}
    is_own = 'static' in tokens or 'MPMI_INLINE' in tokens
    for k, token in enumerate(tokens[1:-1], 1):
        if outer[k][0] or not WORD.match(token) or token in NOT_NAMES or tokens[k - 1] in ('struct', 'union', 'enum'):
            continue
        if tokens[k + 1] in ('(', '[', '=', ';', ','):
            found.add((token, is_own))
        if tokens[k + 1] in ('(', '='):
            break
    return found


def made_by_macros(header):
    """Names that a header's macros declare by their own text: {name}."""
    found = set()
    for directive in DIRECTIVE.findall(header):
        if re.match(r'[ \t]*#[ \t]*define', directive):
            found.update(re.findall(r'\bstatic\s+(?:const\s+)?\w+\s*\*?\s*(\w+)\s*\((?!#)', directive.replace('\\\n', ' ')))
    return found - NOT_NAMES


def rename(text, new):
    """Other names for words of the text; members of structs, literals and comments keep theirs."""
    pieces = [(piece.group(), piece.lastgroup) for piece in PIECE.finditer(text)]
    code = [k for k, (_, kind) in enumerate(pieces) if kind != 'hidden']
    structs = []  # of the braces that are open: whether each is that of a struct
    for at, k in enumerate(code):
        token = pieces[k][0]
        before, tag = (pieces[code[at - n]][0] if at >= n else '' for n in (1, 2))
        after = pieces[code[at + 1]][0] if at + 1 < len(code) else ''
        if token == '{':
            structs.append({before, tag} & {'struct', 'union'} != set())
        elif token == '}' and structs:
            structs.pop()
        is_member = before in ('.', '->') or structs and structs[-1] and after in (';', ',', '[', ')', ':')
        if token in new and not is_member:
            pieces[k] = (new[token], 'word')
    return ''.join(text for text, _ in pieces)


class Writer:
    def __init__(self, source):
        self.source, self.done, self.out = source, set(), []
        self.system, self.features = [], collections.OrderedDict()

    def path_of(self, name, folder):
        for path in (os.path.join(folder, name), name):
            if os.path.exists(os.path.join(self.source, path)):
                return os.path.normpath(path)
        sys.exit(f'amalgamate: there is no {name}')

    def put(self, path, text):
        """Appends a file, with the headers that it needs and that are not there yet."""
        folder = os.path.dirname(path)
        self.out.append(f'\n/* ---- {path} ' + '-' * (100 - len(path)) + ' */\n')
        depth = -1 if is_guarded(text) else 0
        for line in text.splitlines(keepends=True):
            condition = CONDITION.match(line)
            if condition:
                depth += -1 if condition.group(1) == 'endif' else 1
            feature, include = FEATURE.match(line), INCLUDE.match(line)
            if feature and path.endswith('.c') and depth == 0:
                self.features[feature.group(1)] = feature.group(2)
            elif not include:
                self.out.append(line)
            elif include.group(2).startswith('mpm/'):
                pass
            elif include.group(1) == '<' and depth == 0:
                if include.group(2) not in self.system:
                    self.system.append(include.group(2))
            elif include.group(1) == '<':
                self.out.append(line)
            else:
                self.header(self.path_of(include.group(2), folder), depth)

    def header(self, path, depth):
        text = read(os.path.join(self.source, path))
        if path in self.done:
            return
        if is_guarded(text) and depth == 0:
            self.done.add(path)
        self.put(path, text)


def sources_of(top):
    return sorted(os.path.relpath(os.path.join(folder, name), top)
                  for folder, _, names in os.walk(top) for name in names if name.endswith(('.c', '.h')))


def write_source(top, output, version):
    files = {path: read(os.path.join(top, path)) for path in sources_of(top)}
    macros = {name for text in files.values() for name in DEFINE.findall(text)}
    made = {name for path, text in files.items() if path.endswith('.h') for name in made_by_macros(text)}
    owners, names = collections.Counter(), {}
    for path, text in files.items():
        found = {entry for declaration in top_level(text) for entry in names_of(declaration) if entry[0] not in macros}
        owners.update({name for name, _ in found})
        names[path] = {name for name, is_own in found if is_own}
    stems = collections.Counter(os.path.basename(path)[:-2] for path in files if path.endswith('.c'))

    writer = Writer(top)
    for path, text in files.items():
        if not path.endswith('.c'):
            continue
        stem = os.path.basename(path)[:-2]
        prefix = stem if stems[stem] == 1 else path[:-2].replace('/', '_')
        text = rename(text, {name: f'{prefix}_c_{name}' for name in names[path]
                             if owners[name] > 1 and name not in made})
        shared = sorted(name for name in made if re.search(r'\b' + name + r'\b', text))
        own = ''.join(f'#define {name} {prefix}_c_{name}\n' for name in shared)
        ends = sorted(set(DEFINE.findall('\n'.join(DIRECTIVE.findall(text)))) - set(writer.features) | set(shared))
        writer.put(path, own + text)
        writer.out.extend(f'#undef {name}\n' for name in ends if not name.startswith('_'))

    features = ''.join(f'#ifndef {name}\n#define {name} {value}\n#endif\n' for name, value in writer.features.items())
    includes = '#include "mpm.h"\n\n' + ''.join(f'#include <{name}>\n' for name in sorted(writer.system))
    with open(os.path.join(output, 'mpm.c'), 'w', encoding='utf-8') as file:
        file.write(HEAD.format(version=version) + features + PRAGMAS + includes + ''.join(writer.out))


def write_header(top, output):
    """mpm.h with each header in the place where it is included for the first time."""
    done = set()

    def expand(name):
        done.add(name)
        out = []
        for line in read(os.path.join(top, name)).splitlines(keepends=True):
            include = INCLUDE.match(line)
            if not include or not include.group(2).startswith('mpm/'):
                out.append(line)
            elif include.group(2) not in done:
                out.append(expand(include.group(2)))
        return ''.join(out)

    with open(os.path.join(output, 'mpm.h'), 'w', encoding='utf-8') as file:
        file.write(expand('mpm/mpm.h'))
    missing = {f'mpm/{name}' for name in os.listdir(os.path.join(top, 'mpm')) if name.endswith('.h')} - done
    if missing:
        sys.exit(f'amalgamate: mpm/mpm.h does not include {", ".join(sorted(missing))}')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--source', default='src')
    parser.add_argument('--include', default='include')
    parser.add_argument('--version', default='')
    parser.add_argument('output')
    options = parser.parse_args()
    os.makedirs(options.output, exist_ok=True)
    write_header(options.include, options.output)
    write_source(options.source, options.output, options.version)


if __name__ == '__main__':
    main()
