"""Do the files and symbols that the documents name exist?  theory.py [ROOT]

In docs/theory.md everything in backticks is looked at. A file must be there, and be the only one that its name can
mean. An identifier must be a function, macro, constant, type or member of src/ or include/, here or in umat/, mpi/ or petsc/, or a name of the interface
(a string in src/). A symbol in front of a file, "`symbol`, ..., `file`" or "`symbol` in `file`", must be declared there,
and each internal function must stand so in one place at least. In the other documents files and names that begin with
mpm_ or mpmi_ are looked at.
"""
import collections
import os
import re
import sys

ROOT = sys.argv[1] if len(sys.argv) > 1 else '.'
STRICT = 'docs/theory.md'

# What is no name of the sources though it looks like one.
NO_CODE = {
    'README.md': {'block.c', 'energy.csv', 'mpm::mpm_static'},
}
COMMAND = re.compile(r'(make|bash|bench|cmake|pkg-config|cc|c\+\+) ')

# Faults that the check must find: what is replaced in STRICT, once, and what is said of it.
PLANTED = [
    ('`mpmi_layout_prepare`', '`mpmi_layout_prepares`', '`mpmi_layout_prepares` is nowhere'),
    ('`src/stages/p2g.c`', '`src/stages/p2q.c`', '`src/stages/p2q.c` is no file'),
    ('`src/boundary/hooks.c`', '`src/boundary/ties.c`', '`show_node` is not in src/boundary/ties.c'),
    ('`gmres.c`', '`layout.c`, `gmre.c`', '`gmre.c` is no file'),
    ('`MPM_WALL_SLIP`', '`MPM_WALL_SLIPS`', '`MPM_WALL_SLIPS` is nowhere'),
    ('`gravity`', '`gravitation`', '`gravitation` is nowhere'),
    ('`..._axis`', '`..._axes_of`', 'nothing ends as `..._axes_of`'),
    ('`find_mass_cut`, `src/layout/sorted_layout.c`', '`find_mass_cut`', '`find_mass_cut` is nowhere with its file'),
]

# ---- the sources -----------------------------------------------------------------------------------------
STRIP = re.compile(r'/\*.*?\*/|//[^\n]*|"((?:\\.|[^"\\\n])*)"|\'(?:\\.|[^\'\\\n])+\'', re.S)
DIRECTIVE = re.compile(r'^[ \t]*#(?:[^\n\\]|\\.|\\\n)*', re.M)
DEFINE = re.compile(r'\s*#\s*define\s+(\w+)')
ASKED = re.compile(r'defined\((MPM_\w+)\)')  # macros that a host or a build defines
TOKEN = re.compile(r'[A-Za-z_]\w*|[^\s\w]')
SKIPPED = re.compile(r'__attribute__\s*\(\([^()]*(?:\([^()]*\))?[^()]*\)\)|_Alignas\(\w+\)')
WORDS = {'if', 'for', 'while', 'switch', 'return', 'sizeof', 'void', 'int', 'char', 'double', 'float', 'const',
         'static', 'inline', 'struct', 'union', 'enum', 'typedef', 'extern', 'restrict', 'unsigned', 'long'}
NAME = re.compile(r'[A-Za-z_]\w*$')


def declared(head, names):
    """Names that one declaration at the top of a file, or in a struct, brings: those in front of ( [ = , ; and :"""
    depth = 0
    for i, token in enumerate(head):
        after = head[i + 1] if i + 1 < len(head) else ';'
        if token in '([{':
            depth += 1
        elif token in ')]}':
            depth -= 1
        elif NAME.match(token) and token not in WORDS:
            # KERNEL(name)(...), (*name)(...) and MACRO(name, ...)
            kernel = i >= 2 and head[i - 2:i] == ['KERNEL', '(']
            pointer = i >= 2 and head[i - 1] == '*' and head[i - 2] == '('
            of_macro = depth == 1 and token.islower() and i >= 2 and head[0].isupper() and head[1] == '('
            if kernel:
                names.update((token, 'mpmi_' + token))
            elif (depth == 0 and after in '([=,;:') or pointer or of_macro:
                names.add(token)


def symbols_of(text):
    """Names that a file declares at its top, with constants, macros and members; and its string literals."""
    literals = set()

    def blank(match):
        if match.group(1) is not None:
            literals.add(match.group(1))
            return '0'
        return ' '

    text = STRIP.sub(blank, text)
    names, macros = set(), []

    def directive(match):
        define = DEFINE.match(match.group(0))
        if define:
            names.add(define.group(1))
            macros.append(match.group(0)[define.end():])
        names.update(ASKED.findall(match.group(0)))
        return ''

    text = SKIPPED.sub('', DIRECTIVE.sub(directive, text))
    for body in macros:
        for made in re.findall(r'KERNEL\((\w+?)_?(?:##|\))', body):
            names.update((made, 'mpmi_' + made))
    stack, head = [], []
    for token in TOKEN.findall(text):
        inside = stack[-1] if stack else 'file'
        if token == '{':
            if inside in ('file', 'struct') and '=' not in head:
                if 'enum' in head and '(' not in head:
                    kind = 'enum'
                elif ('struct' in head or 'union' in head) and '(' not in head:
                    kind = 'struct'
                else:
                    kind = 'body'
                if kind == 'body':
                    if head[:1] == ['extern'] and len(head) == 2:
                        kind = 'file'
                    else:
                        declared(head, names)
                else:
                    names.update(t for t in head if NAME.match(t) and t not in WORDS)
                head = []
            else:
                kind = 'values' if inside in ('file', 'struct', 'values') else 'body'
            stack.append(kind)
        elif token == '}':
            if stack and stack.pop() == 'body':
                head = []
            elif inside == 'enum':
                names.update(last for last in head[:1] if NAME.match(last))
                head = []
        elif inside == 'enum':
            if token == ',':
                names.update(head[:1])
                head = []
            else:
                head.append(token)
        elif inside in ('file', 'struct'):
            head.append(token)
            if token == ';':
                declared(head, names)
                head = []
    return names, literals


def read(path):
    with open(os.path.join(ROOT, path), encoding='utf-8') as file:
        return file.read()


files = []
for folder, folders, here in os.walk(ROOT):
    folders[:] = [f for f in folders if not f.startswith('.') and not re.match(r'build($|-)', f)]
    files += [os.path.relpath(os.path.join(folder, name), ROOT) for name in here]
files = set(files)
places = files | {f[:i] for f in files for i in range(len(f)) if f[i] == '/'}
symbols_in, every, interface, public = {}, set(), set(), set()
for path in files:
    if re.match(r'((umat|mpi|petsc)/)?(src|include)/.*\.(c|h|hpp)$', path):
        text = read(path)
        symbols_in[path], literals = symbols_of(text)
        every |= symbols_in[path]
        interface |= literals
        if path.startswith(('include/', 'umat/include/', 'mpi/include/', 'petsc/include/')):
            public |= set(re.findall(r'\w+', STRIP.sub(' ', text)))
functions = {name for name in every - public - interface if name.islower()}  # with types and members
every |= public
by_suffix = collections.defaultdict(set)
for path in places:
    parts = path.split('/')
    for i in range(len(parts)):
        by_suffix['/'.join(parts[i:])].add(path)

# ---- the documents ---------------------------------------------------------------------------------------
FILE = re.compile(r'[\w.-]+(/[\w.-]+)*(/|\[ch\])?$')
ENDING = re.compile(r'\.(c|h|\[ch\]|hpp|md|sh|py|svg|csv|txt|mk|xml|map)$')
IDENTIFIER = re.compile(r'(?<![\w.\\])[A-Za-z_]\w+')
PUBLIC = re.compile(r'(mpmi?|MPMI?)_\w')
ISA = re.compile(r'_(baseline|avx2|avx512|neon)$')
# Between a symbol and the file that it belongs to.
TOGETHER = re.compile(r'(,|\s|and|in|of|\([^()`]*\)|[()|])*')


def find_file(token):
    """The one file that is meant, and what is wrong with the name: one of them. NAME stands for any name."""
    name = token.rstrip('/')
    if name.endswith('[ch]'):
        both = [find_file(name[:-4] + c) for c in 'ch']
        return both[0] if both[0][1] else both[1]
    if 'NAME' in name:
        pattern = re.compile(re.escape(name).replace('NAME', r'\w+') + '$')
        return None, None if any(pattern.match(p) for p in by_suffix) else f'no file is like `{token}`'
    found = by_suffix.get(name, set())
    for path in (name, os.path.normpath(os.path.join('docs', name))):
        if path in found:
            return path, None
    for first in ('src/', 'include/', ''):
        those = sorted(p for p in found if p.startswith(first))
        if len(those) == 1:
            return those[0], None
        if those:
            return None, f'`{token}` is one of ' + ', '.join(those)
    return None, f'`{token}` is no file'


def is_known(name, before):
    if name in every or name in interface or ISA.sub('', name) in every:
        return True
    # "_END" is the end of another name that begins as the one before it, "MPM_WALL_..." the beginning of several
    return name.startswith('_') and any(before[:k] + name in every for k in range(1, len(before)))


def is_beginning(name):
    return any(symbol.startswith(name) and symbol != name for symbol in every)


def check(document, text):
    """How many names a document has in backticks, and what is wrong with them: (line, sentence)."""
    strict = document == STRICT
    text = re.sub(r'^```.*?^```', lambda m: re.sub(r'[^\n]', ' ', m.group(0)), text, flags=re.S | re.M)
    count, bad, before, group, end = 0, [], '', [], 0
    internal, placed = {}, set()  # functions of src/ and the line that names them first; symbols with their file
    for match in re.finditer(r'`([^`\n]+(?:\n[^`\n]+)?)`', text):
        token = ' '.join(match.group(1).split())
        line = text.count('\n', 0, match.start()) + 1
        between, end = text[end:match.start()], match.end()
        if not TOGETHER.fullmatch(between) or '\n\n' in between or '|\n' in between:
            group = []
        if token in NO_CODE.get(document, ()) or COMMAND.match(token) or token.startswith('build'):
            group = []
            continue
        count += 1
        if FILE.match(token) and ('/' in token or ENDING.search(token)):
            path, wrong = find_file(token)
            if wrong:
                bad.append((line, wrong))
            bad += [(line, f'`{name}` is not in {path}') for name in group
                    if path in symbols_in and name not in symbols_in[path]]
            placed.update(group)
            group = []
        elif token.startswith('...'):
            if not any(s.endswith(token[3:]) for s in every):
                bad.append((line, f'nothing ends as `{token}`'))
        else:
            for name in IDENTIFIER.findall(token):
                if not strict and not PUBLIC.match(name) or name + '...' in token and is_beginning(name):
                    continue
                if not is_known(name, before):
                    bad.append((line, f'`{name}` is nowhere in src/ and include/'))
                elif name == token and name in every:
                    group.append(name)
                    if strict and name in functions:
                        internal.setdefault(name, line)
                before = before if name.startswith('_') else name
    bad += [(line, f'`{name}` is nowhere with its file') for name, line in internal.items() if name not in placed]
    return count, bad


documents = [STRICT] + sorted(f for f in files if re.match(r'(docs/\w+|README|ABI)\.md$', f) and f != STRICT)
count, wrong = {}, 0
for document in documents:
    count[document], bad = check(document, read(document))
    wrong += len(bad)
    for line, what in bad:
        print(f'{document}:{line}: {what}')
if wrong:
    sys.exit(f'theory.py: {wrong} names in documents that are not those of the sources')
for there, fault, complaint in PLANTED:
    text = read(STRICT)
    found = [what for _, what in check(STRICT, text.replace(there, fault, 1))[1]] if there in text else []
    if not any(what.startswith(complaint) for what in found):
        sys.exit(f'theory.py: a planted fault, {fault} for {there}, was not found')
print(f'theory.py: {count[STRICT]} names in {STRICT}, {sum(count.values()) - count[STRICT]} in other documents, '
      f'{len(PLANTED)} planted faults found')
