#!/usr/bin/env python3
"""What can be said of the Julia files where there is no Julia: blocks and brackets close, and nothing of the interface lacks.

    bindings/julia/structure.py
"""
import json
import os
import re

HERE = os.path.dirname(os.path.abspath(__file__))
OPENERS = {"module", "function", "struct", "begin", "if", "for", "while", "let", "quote", "do", "macro", "try"}
PAIRS = {")": "(", "]": "[", "}": "{"}
TOKEN = re.compile(r'"""(?:\\.|[^\\])*?"""|"(?:\\.|[^"\\])*"|#[^\n]*|:?[A-Za-z_]\w*|[()\[\]{}]|\n|"', re.S)


def check(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    open_ones, line = [], 1
    for found in TOKEN.finditer(text):
        token, at = found[0], line
        line += token.count("\n")
        if token == '"':
            raise SystemExit(f"{path}:{at}: a text does not end")
        in_bracket = open_ones and open_ones[-1][0] in PAIRS.values()
        if token in PAIRS.values() or token in OPENERS and not in_bracket:
            open_ones.append((token, at))
        elif token in PAIRS or token == "end" and not in_bracket:
            opener, begun = open_ones.pop() if open_ones else ("nothing", at)
            if opener != PAIRS.get(token) if token in PAIRS else opener not in OPENERS:
                raise SystemExit(f"{path}:{at}: '{token}' closes '{opener}' of line {begun}")
    if open_ones:
        raise SystemExit(f"{path}:{open_ones[-1][1]}: '{open_ones[-1][0]}' is not closed")
    return text


def main():
    texts = {name: check(f"{HERE}/{name}") for name in sorted(os.listdir(HERE)) if name.endswith(".jl")}
    with open(f"{HERE}/../api.json", encoding="utf-8") as file:
        api = json.load(file)
    wanted = [rf"^function {f['name']}\(" for f in api["functions"]]
    wanted += [rf"^(mutable )?struct {s['name']}$" for s in api["structs"]]
    wanted += [rf"^const {v['name']} = " for group in api["constants"] for v in group["values"]]
    for pattern in wanted:
        if len(re.findall(pattern, texts["MPM.jl"], re.M)) != 1:
            raise SystemExit(f"MPM.jl does not have once: {pattern}")
    used = set(re.findall(r"\b(?:mpm|MPM)_\w+", texts["example.jl"]))
    known = set(re.findall(r"\b(?:mpm|MPM)_\w+", texts["MPM.jl"]))
    if used - known:
        raise SystemExit(f"example.jl uses what there is not: {', '.join(sorted(used - known))}")
    print(f"julia: {len(texts)} files close, {len(wanted)} entities are there")


if __name__ == "__main__":
    main()
