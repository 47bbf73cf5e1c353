#!/usr/bin/env python3
"""Plants an upward include, an upward call, a circle of files, an unlisted folder and a system's header in a small source
tree of its own and expects check.py to name each of them, and nothing before they are planted.

    planted.py SCRATCH      CC and NM from the environment
"""
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
CLEAN = {
    'platform/system.c': '#define _POSIX_C_SOURCE 200809L\n#include <unistd.h>\nlong mpmi_id(void) { return getpid(); }\n',
    'low/base.h': 'int mpmi_base(int x);\n',
    'low/base.c': '#include "low/base.h"\nint mpmi_base(int x) { return x + 1; }\n',
    'low/twice.h': '#include "low/base.h"\nint mpmi_twice(int x);\n',
    'low/twice.c': '#include "low/twice.h"\nint mpmi_twice(int x) { return mpmi_base(mpmi_base(x)); }\n',
    'high/user.h': 'int mpmi_user(int x);\n',
    'high/user.c': '#include "high/user.h"\n#include "low/twice.h"\nint mpmi_user(int x) { return mpmi_twice(x); }\n',
}
INLINE = 'int mpmi_twice(int x);\nstatic inline int mpmi_thrice(int x) { return mpmi_twice(x) + 1; }\n'
# What is planted, and what the check must say about it.
PLANTED = [
    ('an upward include', {'low/base.c': '#include "high/user.h"\n'}, 'low/base.c -> high/user: #include'),
    ('an upward call', {'low/base.c': 'int mpmi_user(int x);\nint mpmi_up(int x) { return mpmi_user(x); }\n'},
     'low/base.c -> high/user: mpmi_user'),
    ('a circle of files', {'low/base.c': 'int mpmi_twice(int x);\nint mpmi_back(int x) { return mpmi_twice(x); }\n'},
     'low/base.c -> low/twice: mpmi_twice'),
    ('a circle through a header', {'low/base.h': INLINE}, 'low/base.h -> low/twice: mpmi_twice'),
    ('a header of the system', {'low/base.c': '#include <unistd.h>\n'}, 'low/base.c includes <unistd.h>'),
    ('a feature of the system', {'low/base.h': '#define _POSIX_C_SOURCE 200809L\n'}, 'low/base.h defines _POSIX_C_SOURCE'),
    ('a folder that is not listed', {'odd/one.h': '\n'}, 'odd is not in the list'),
]


def run_check(top, change):
    source, objects = os.path.join(top, 'src'), os.path.join(top, 'obj')
    shutil.rmtree(top, ignore_errors=True)
    for name in CLEAN.keys() | change.keys():
        for folder in (source, objects):
            os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        with open(os.path.join(source, name), 'w') as file:
            file.write(CLEAN.get(name, '') + change.get(name, ''))
    for name in CLEAN:
        if name.endswith('.c'):
            subprocess.run([*os.environ.get('CC', 'cc').split(), '-I' + source, '-c', os.path.join(source, name), '-o',
                            os.path.join(objects, name[:-2] + '.o')], check=True)
    layers = os.path.join(top, 'layers.txt')
    with open(layers, 'w') as file:
        file.write('platform\nlow\nhigh\n')
    return subprocess.run([sys.executable, os.path.join(HERE, 'check.py'), '--source', source, '--objects', objects,
                           '--layers', layers], text=True, stdout=subprocess.PIPE)


def main():
    top = os.path.join(sys.argv[1], 'structure')
    failures = 0
    clean = run_check(top, {})
    if clean.returncode:
        print('structure: a tree without faults is refused:\n' + clean.stdout)
        failures += 1
    for what, change, sentence in PLANTED:
        said = run_check(top, change)
        if said.returncode != 1 or sentence not in said.stdout:
            print(f'structure: {what} is not noticed:\n' + said.stdout)
            failures += 1
    shutil.rmtree(top)
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
