#!/usr/bin/env python3
"""Writes what the bindings of all languages take from the headers, or tells what of it is stale.

    bindings/generate/generate.py [--check] [language ...]

Every module beside this one has `files(api)`: the text of each generated file by its path under bindings/. With clang,
bindings/api.json is made anew first, and umat.json, which is the same of libmpm-umat; without, they are taken as they are.
"""
import argparse
import importlib
import json
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
BINDINGS = os.path.dirname(HERE)
TOP = os.path.dirname(BINDINGS)
LANGUAGES = sorted(name[:-3] for name in os.listdir(HERE)
                   if name.endswith(".py") and name not in ("generate.py", "common.py"))


def description(name, *arguments):
    """The text of a description as the headers have it now."""
    tool = os.environ.get("API_CLANG", "clang")
    if not shutil.which(tool):
        print(f"generate.py: there is no clang; bindings/{name} is taken as it is", file=sys.stderr)
        with open(f"{BINDINGS}/{name}", encoding="utf-8") as file:
            return file.read()
    made = subprocess.run([sys.executable, f"{TOP}/tools/api.py", *arguments, f"{TOP}/include"], capture_output=True, text=True, check=False)
    if made.returncode:
        raise SystemExit(made.stderr.strip())
    return made.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true", help="write nothing; fail where a file is stale")
    parser.add_argument("languages", nargs="*", help=", ".join(LANGUAGES))
    arguments = parser.parse_args()
    sys.path.insert(0, HERE)
    text = description("api.json")
    files = {"api.json": text, "umat.json": description("umat.json", "--umat", f"{TOP}/umat/include"),
             "mpi.json": description("mpi.json", "--mpi", f"{TOP}/mpi/include"),
             "petsc.json": description("petsc.json", "--petsc", f"{TOP}/petsc/include")}
    for language in arguments.languages or LANGUAGES:
        files.update(importlib.import_module(language).files(json.loads(text)))
    stale = []
    for path, content in files.items():
        there = f"{BINDINGS}/{path}"
        old = None
        if os.path.exists(there):
            with open(there, encoding="utf-8") as file:
                old = file.read()
        if old == content:
            continue
        stale.append(path)
        if not arguments.check:
            os.makedirs(os.path.dirname(there), exist_ok=True)
            with open(there, "w", encoding="utf-8") as file:
                file.write(content)
    if arguments.check and stale:
        raise SystemExit(f"stale, to be made anew by `make api`: {', '.join(stale)}")
    print(f"generate.py: {len(files)} files, {len(stale)} {'written' if stale else 'changed'}")


if __name__ == "__main__":
    main()
