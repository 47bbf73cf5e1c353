#!/usr/bin/env python3
"""Finds the places of the faults of faults.txt in the sources, and plants them.

    plant.py check [PATH]    every fault must have exactly one place; tells of those that have not
    plant.py list [PATH]     per fault: its number, its suite, its file, its function
    plant.py plant NUMBER    changes the file, and prints the fault

PATH selects the faults whose file contains it. All run at the top of the sources; faults.txt says how a fault is
written. An expression is compared token by token, so that white space, line breaks and comments do not matter."""
import bisect
import os
import pathlib
import re
import sys

FAULTS = pathlib.Path(os.environ.get("MUTATE_FAULTS", "tests/mutate/faults.txt"))
SOURCES = ("src/**/*.[ch]", "include/mpm/*.h", "include/mpm/*.hpp", "umat/src/*.[ch]", "umat/utilities/*.[ch]",
           "mpi/src/*.[ch]", "petsc/src/*.[ch]")

TOKEN = re.compile(r"""
    (?P<space>\s+ | \\\n | //[^\n]* | /\*.*?\*/)
  | (?P<text>"(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*')
  | (?P<number>\.?[0-9](?:[eEpP][+-]|[\w.])*)
  | (?P<name>[A-Za-z_]\w*)
  | (?P<sign>\.\.\.|<<=|>>=|->|\+\+|--|<<|>>|[-+*/%&|^<>=!]=|&&|\|\||\#\#|::|.)
""", re.X | re.S)
WORD = re.compile(r"[A-Za-z_]")
NO_PARAMETERS = {"__attribute__", "_Alignas", "alignas", "decltype", "noexcept"}
BEFORE_BODY = {"const", "noexcept", "override", "final", "try", ")"}


class Misfit(Exception):
    """A fault that has no place, or several."""


class Source:
    """The tokens of a file, and of each the function around it: "-" for none."""

    def __init__(self, path):
        self.path = path
        with open(path, encoding="utf-8", newline="") as file:
            self.text = file.read()
        found = [m for m in TOKEN.finditer(self.text) if m.lastgroup != "space"]
        self.token = [m[0] for m in found]
        self.span = [m.span() for m in found]
        self.function = ["-"] * len(found)
        self.mark_functions()
        self.names = set(self.function)

    def directives(self):
        """The tokens of lines that the preprocessor takes: braces there do not pair with the others."""
        lines = [m.span() for m in re.finditer(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", self.text, re.M)]
        begins = [begin for begin, _ in lines]
        for k, (at, _) in enumerate(self.span):
            line = bisect.bisect_right(begins, at) - 1
            if line >= 0 and at < lines[line][1]:
                yield k

    def mark_functions(self):
        skipped = set(self.directives())
        code = [k for k in range(len(self.token)) if k not in skipped]
        head, i = [], 0 # the tokens of the declaration that is being read
        while i < len(code):
            token = self.token[code[i]]
            if token in (";", "}"):
                head = []
            elif token != "{":
                head.append(code[i])
            elif self.opens_scope(head):
                head = []
            else:
                end = self.closing(code, i)
                if name := self.function_of(head):
                    for k in range(head[0], code[end] + 1):
                        self.function[k] = name
                    head = []
                i = end
            i += 1

    def closing(self, code, i):
        """The index in `code` of the brace that closes that at i."""
        depth = 0
        for j in range(i, len(code)):
            depth += {"{": 1, "}": -1}.get(self.token[code[j]], 0)
            if depth == 0:
                return j
        raise Misfit(f"{self.path}: a brace that is not closed")

    def opens_scope(self, head):
        """Of a namespace, a class or a linkage, whose functions are found one by one."""
        words = [self.token[k] for k in head]
        words = words[self.past_template(words):]
        return bool(words) and "(" not in words and (words[0] in ("namespace", "class", "struct", "extern") or
                                                     (words[0] == "friend" and "class" in words))

    @staticmethod
    def past_template(words):
        at = 0
        while at < len(words) and words[at] == "template":
            depth, at = 0, at + 1
            while at < len(words):
                depth += {"<": 1, ">": -1, ">>": -2}.get(words[at], 0)
                at += 1
                if depth <= 0:
                    break
        return at

    def function_of(self, head):
        """The name of the function that these tokens declare, or None where they declare anything else."""
        words = [self.token[k] for k in head]
        at, depth, begin, is_initialised = self.past_template(words), 0, None, False
        name = None
        while at < len(words):
            word = words[at]
            if word == "=" and depth == 0 and "operator" not in words[:at]:
                return None
            if word == "(":
                if depth == 0:
                    begin = at
                depth += 1
            elif word == ")":
                depth -= 1
                if depth == 0 and name is None:
                    name = self.name_before(words, begin, at)
            elif word == ":" and depth == 0 and name is not None:
                is_initialised = True
            elif depth == 0 and words[at - 1] == ")" and WORD.match(word) and word not in BEFORE_BODY | NO_PARAMETERS:
                name = None # what stood before was a macro of its own
            at += 1
        if is_initialised and words[-1] not in BEFORE_BODY:
            return None # the brace is that of a member
        return name

    @staticmethod
    def name_before(words, begin, end):
        """The name that the parentheses from begin to end belong to, if they are the parameters of a function."""
        if "operator" in words[:begin + 1]:
            name = "".join(words[words.index("operator") + 1:begin])
            return "operator" + (name or "()")
        before = words[begin - 1] if begin else ""
        if before in NO_PARAMETERS or not WORD.match(before):
            return None
        if begin > 1 and words[begin - 2] == "~":
            return "~" + before
        if end + 1 < len(words) and words[end + 1] == "(": # a macro that makes the name
            inside = [w for w in words[begin:end] if WORD.match(w)]
            return inside[-1] if inside else None
        return before

    def places(self, function, expression):
        """The ranges of tokens of this function that read like the expression."""
        n, first = len(expression), expression[0]
        return [k for k in range(len(self.token) - n + 1)
                if self.token[k] == first and self.token[k:k + n] == expression and
                all(f == function for f in self.function[k:k + n])]


def tokens(text):
    return [m[0] for m in TOKEN.finditer(text) if m.lastgroup != "space"]


class Sources:
    """All files, each read when it is asked for."""

    def __init__(self):
        self.paths = sorted(str(p) for pattern in SOURCES for p in pathlib.Path(".").glob(pattern))
        self.read = {}

    def __getitem__(self, path):
        if path not in self.read:
            self.read[path] = Source(path)
        return self.read[path]


class Fault:
    def __init__(self, line, header):
        words = header.split()
        if len(words) not in (2, 3):
            raise SystemExit(f"{FAULTS}:{line}: a fault starts with: suite [file] function")
        self.line, self.suite, self.function = line, words[0], words[-1]
        self.hint = words[1] if len(words) == 3 else None
        self.changes = [] # [expression, replacement]

    def places_in(self, source):
        if self.function not in source.names:
            return None
        return [source.places(self.function, tokens(old)) for old, _ in self.changes]

    def find(self, sources):
        """The only file and, for each change, the only place in it; the file that is named comes first."""
        if self.hint in sources.paths:
            here = self.places_in(sources[self.hint])
            if here and all(len(p) == 1 for p in here):
                return sources[self.hint], [p[0] for p in here]
        found, has_function = [], []
        for path in sources.paths:
            here = self.places_in(sources[path])
            if here is None:
                continue
            has_function.append(path)
            if all(here):
                found.append((path, here))
        if len(found) == 1 and all(len(p) == 1 for p in found[0][1]):
            return sources[found[0][0]], [p[0] for p in found[0][1]]
        if found:
            raise Misfit("has several places: " + ", ".join(f"{max(map(len, here))} in {path}" for path, here in found))
        if self.function == "-":
            raise Misfit("nothing outside functions reads like that")
        if has_function:
            raise Misfit("nothing in the function reads like that: " + ", ".join(has_function))
        raise Misfit("there is no such function")

    def plant(self, sources):
        source, places = self.find(sources)
        text = source.text
        for place, (old, new) in sorted(zip(places, self.changes), reverse=True):
            begin, end = source.span[place][0], source.span[place + len(tokens(old)) - 1][1]
            text = text[:begin] + new + text[end:]
        return source.path, text

    def __str__(self):
        where = self.hint + " " if self.hint else ""
        return f"{FAULTS}:{self.line}: {self.suite} {where}{self.function}: {self.changes[0][0]}"


def read_faults():
    faults, part = [], ""
    for number, line in enumerate(FAULTS.read_text(encoding="utf-8").splitlines(), 1):
        mark, rest = line[:1], line[2:]
        if mark in ("", "#"):
            continue
        if mark not in "-+":
            faults.append(Fault(number, line))
        elif mark == "-" and part == "-":
            faults[-1].changes[-1][0] += "\n" + rest
        elif mark == "-":
            faults[-1].changes.append([rest, ""])
        else:
            faults[-1].changes[-1][1] += ("\n" if part == "+" else "") + rest
        part = mark
    for fault in faults:
        if not fault.changes or not all(tokens(old) for old, _ in fault.changes):
            raise SystemExit(f"{FAULTS}:{fault.line}: a fault needs an expression")
    return faults


def plant(fault, sources):
    try:
        path, text = fault.plant(sources)
    except Misfit as misfit:
        print(f"{fault}: {misfit}")
        return 1
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(text)
    print(f"{fault}")
    return 0


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1] not in ("check", "list", "plant"):
        raise SystemExit(__doc__)
    command, argument = sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else ""
    faults, sources = read_faults(), Sources()
    if command == "plant":
        return plant(faults[int(argument)], sources)
    count = misfits = 0
    for number, fault in enumerate(faults):
        try:
            path, problem = fault.find(sources)[0].path, None
        except Misfit as misfit:
            path, problem = fault.hint or "?", misfit
        if argument not in path:
            continue
        count += 1
        if command == "list":
            print(number, fault.suite, path, fault.function)
        elif problem:
            misfits += 1
            print(f"{fault}\n  {problem}")
    if command == "check":
        print(f"mutate-check: {count} faults, {misfits} without a place")
    return 1 if misfits else 0


if __name__ == "__main__":
    sys.exit(main())
