#!/usr/bin/env python3
"""Describes the public interface in JSON, from the headers as clang parses them.

    tools/api.py [--clang clang] [--umat umat/include | --mpi mpi/include | --petsc petsc/include] [include] > api.json

With --umat it describes mpm_umat.h, the header of libmpm-umat, in the place of libmpm's; with --mpi mpm_mpi.h, that of
libmpm-mpi, and with --petsc mpm_petsc.h, that of libmpm-petsc, for which MPI and PETSc need not be there.

The description holds what bindings need: functions, structs with the offsets of their fields, constants by group, types
of callbacks, handles, and every comment. Offsets are those for pointers of 8 and of 4 bytes, where an 8-byte number lies
at a multiple of 8; clang confirms them for x86-64 and WebAssembly. docs/bindings.md says what the entries mean.
"""
import argparse
import json
import os
import re
import subprocess
import sys

HEADERS = ["types", "parallel", "context", "grid", "material", "particles", "stepper", "operator", "contact", "obstacle", "surface",
           "adaption", "heat", "io"]
SIZES = {"int8_t": 1, "uint8_t": 1, "char": 1, "int": 4, "int32_t": 4, "uint32_t": 4, "int64_t": 8, "uint64_t": 8, "double": 8,
         "float": 4, "mpm_status": 4}
TARGETS = {8: "x86_64-linux-gnu", 4: "wasm32-unknown-unknown"}


def companion(arguments):
    """Header of the companion that is asked for, and the folders of headers; nothing for libmpm itself."""
    if arguments.umat:
        return ["mpm_umat", arguments.umat]
    if arguments.mpi:
        return ["mpm_mpi", arguments.mpi, f"{os.path.dirname(arguments.mpi)}/parsers"]
    if arguments.petsc:
        return ["mpm_petsc", arguments.petsc, f"{os.path.dirname(os.path.dirname(arguments.petsc))}/mpi/parsers"]
    return []


def source(arguments):
    return "".join(f"#include <mpm/{name}.h>\n" for name in companion(arguments)[:1] or HEADERS)


def clang(arguments, text):
    folders = [one for folder in [arguments.include, *companion(arguments)[1:]] for one in ("-I", folder)]
    command = [arguments.clang, "-std=c11", "-ffreestanding", *folders, "-x", "c", "-"]
    return lambda *more: subprocess.run(command + list(more), input=text, capture_output=True, text=True, check=False)


class Texts:
    """The headers' texts, from which comments and the names of arguments are cut."""

    def __init__(self):
        self.files = {}

    def of(self, path):
        if path not in self.files:
            with open(path, encoding="utf-8") as file:
                self.files[path] = file.read()
        return self.files[path]

    def comment(self, path, begin, end):
        """The comment that clang found between two offsets, without its stars."""
        text = self.of(path)
        first = text.rindex("/**", 0, begin + 1)
        return plain(text[first:text.index("*/", end - 1) + 2])


def plain(comment):
    """Takes the marks off a comment. Lines of tables and lists keep their ends, others are joined to paragraphs."""
    body = re.sub(r"^/\*\*<?|\*/$", "", comment.strip())
    lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in body.split("\n")]
    out = []
    for line in lines:
        line = line.strip()
        starts = not line or line.startswith(("|", "- ", "@"))
        if out and out[-1] and not starts and not out[-1].startswith(("|", "@")):
            out[-1] += " " + line
        else:
            out.append(line)
    return re.sub(r"\n{3,}", "\n\n", "\n".join(out)).strip()


def walk(node, state, visit):
    """Calls visit(node, file) in the order of clang's output, which names a file only where it changes."""
    for place in (node.get("loc", {}), node.get("range", {}).get("begin", {}), node.get("range", {}).get("end", {})):
        for where in (place, place.get("spellingLoc", {}), place.get("expansionLoc", {})):
            if "file" in where:
                state["file"] = where["file"]
    visit(node, state["file"])
    for inner in node.get("inner", []):
        walk(inner, state, visit)


def type_of(text, known):
    """Takes a type of C apart."""
    text = re.sub(r"\s+", " ", text).strip()
    array = re.match(r"(.*)\[(\d+)\]$", text)
    plain_text = array[1] if array else text
    base = re.sub(r"\bconst\b|\bstruct\b|\*", " ", plain_text).strip()
    out = {"c": text, "base": base, "pointer": plain_text.count("*"), "const": plain_text.startswith("const ")}
    if array:
        out["count"] = int(array[2])
    for kind in ("handle", "struct", "callback"):
        if base in known[kind]:
            out["kind"] = kind
            return out
    out["kind"] = "value"
    if base not in SIZES and base not in ("void", "size_t", "MPI_Comm", "MPI_Fint"):
        raise SystemExit(f"api.py: the type '{text}' is not known")
    return out


def arguments_of(text, known):
    """The arguments of a declaration's text, by name: "(void *user, int32_t dim)"."""
    out = []
    for one in re.sub(r"\s+", " ", text).strip().split(","):
        one = one.strip()
        if one in ("", "void"):
            continue
        found = re.match(r"(.*?)(\w+)$", one)
        out.append({"name": found[2], "type": type_of(found[1], known)})
    return out


def size_and_alignment(kind, pointer):
    if kind["pointer"] or kind["kind"] == "callback" or kind["base"] == "size_t":
        return pointer, pointer
    return SIZES[kind["base"]], SIZES[kind["base"]]


def lay_out(struct, pointer):
    at, widest = 0, 1
    for field in struct["fields"]:
        size, alignment = size_and_alignment(field["type"], pointer)
        at = (at + alignment - 1) // alignment * alignment
        field[f"offset{8 * pointer}"] = at
        at += size * field["type"].get("count", 1)
        widest = max(widest, alignment)
    struct[f"size{8 * pointer}"] = (at + widest - 1) // widest * widest


class Reader:
    def __init__(self, tree, texts):
        self.texts = texts
        self.tree = tree
        self.comments, self.file_of = {}, {}
        state = {"file": ""}
        for top in tree["inner"]:
            walk(top, state, self.note)
        self.tops = [top for top in tree["inner"] if "/mpm/" in self.file_of.get(top["id"], "")]
        self.known = {"handle": set(), "struct": set(), "callback": set()}
        complete = {t["name"] for t in self.tops if t["kind"] == "RecordDecl" and t.get("completeDefinition")}
        for top in self.tops:
            name = top.get("name", "")
            if top["kind"] != "TypedefDecl":
                continue
            if self.is_function(top["type"]["qualType"]):
                self.known["callback"].add(name)
            elif name in complete:
                self.known["struct"].add(name)
            elif top["type"]["qualType"].startswith("struct "):
                self.known["handle"].add(name)

    def is_function(self, kind):
        """A type of function, a pointer to one, or a pointer to a type that has a name of its own."""
        return "(" in kind or kind.rstrip("* ") in self.known["callback"]

    def note(self, node, file):
        if "id" in node:
            self.file_of[node["id"]] = file
        for inner in node.get("inner", []):
            if inner["kind"] == "FullComment":
                span = inner["range"]
                self.comments[node["id"]] = self.texts.comment(file, span["begin"]["offset"], span["end"]["offset"])

    def doc(self, node):
        return self.comments.get(node["id"], "")

    def header(self, node):
        return os.path.basename(self.file_of[node["id"]])

    def text(self, node):
        span = node["range"]
        begin, end = span["begin"], span["end"]
        begin, end = begin.get("expansionLoc", begin), end.get("expansionLoc", end)
        return self.texts.of(self.file_of[node["id"]])[begin["offset"]:end["offset"] + end["tokLen"]]

    def constants(self):
        out = []
        for top in self.tops:
            if top["kind"] != "EnumDecl":
                continue
            group = {"name": top.get("name", ""), "header": self.header(top), "doc": self.doc(top), "values": []}
            for one in top["inner"]:
                if one["kind"] != "EnumConstantDecl":
                    continue
                written = re.search(r"=\s*(-?\w+)", self.text(one))[1]
                alias = written if written.startswith("MPM_") else None
                value = next(v["value"] for v in group["values"] if v["name"] == alias) if alias else int(written, 0)
                entry = {"name": one["name"], "value": value, "doc": self.doc(one)}
                group["values"].append({**entry, "alias_of": alias} if alias else entry)
            out.append(group)
        return out

    def callback(self, name, doc, header, text):
        """A type of function, or a pointer to one, from the text of its typedef or field."""
        text = re.sub(r"\s+", " ", text)
        other = re.match(r"typedef (\w+) \*\w+$", text)
        if other:
            return {"name": name, "header": header, "doc": doc, "pointer_to": other[1], "result": type_of("void", self.known),
                    "arguments": []}
        found = re.match(r"(?:typedef\s+)?(.*?)(?:\(\*\s*\w+\)|\b\w+)\s*\((?!\*)(.*)\)\s*$", text)
        out = {"name": name, "header": header, "doc": doc, "result": type_of(found[1], self.known),
               "arguments": arguments_of(found[2], self.known)}
        return out if "(*" in text else {**out, "function": True}

    def callbacks_and_structs(self):
        callbacks, structs = [], []
        for top in self.tops:
            name = top.get("name", "")
            if top["kind"] == "TypedefDecl" and name in self.known["callback"]:
                callbacks.append(self.callback(name, self.doc(top), self.header(top), self.text(top)))
            if top["kind"] != "RecordDecl" or name not in self.known["struct"] or not top.get("completeDefinition"):
                continue
            struct = {"name": name, "header": self.header(top), "doc": self.doc(top), "fields": []}
            for field in top["inner"]:
                if field["kind"] != "FieldDecl":
                    continue
                if "(*)" in field["type"]["qualType"]:
                    made = f"{name}_{field['name']}_fn"
                    self.known["callback"].add(made)
                    callbacks.append(self.callback(made, self.doc(field), self.header(top), self.text(field)))
                    kind = type_of(made, self.known)
                else:
                    kind = type_of(field["type"]["qualType"], self.known)
                struct["fields"].append({"name": field["name"], "type": kind, "doc": self.doc(field)})
            for pointer in (8, 4):
                lay_out(struct, pointer)
            structs.append(struct)
        return callbacks, structs

    def handles(self):
        return [{"name": t["name"], "header": self.header(t), "doc": self.doc(t)} for t in self.tops
                if t["kind"] == "TypedefDecl" and t["name"] in self.known["handle"]]

    def functions(self):
        out = []
        for top in self.tops:
            if top["kind"] != "FunctionDecl":
                continue
            arguments = [{"name": a["name"], "type": type_of(a["type"]["qualType"], self.known)}
                         for a in top.get("inner", []) if a["kind"] == "ParmVarDecl"]
            out.append({"name": top["name"], "header": self.header(top), "doc": self.doc(top),
                        "result": type_of(top["type"]["qualType"].split("(")[0], self.known), "arguments": arguments})
        return out


def describe(arguments):
    texts = Texts()
    run = clang(arguments, source(arguments))
    parsed = run("--target=" + TARGETS[8], "-fsyntax-only", "-Xclang", "-ast-dump=json", "-fparse-all-comments")
    if parsed.returncode:
        raise SystemExit(parsed.stderr)
    reader = Reader(json.loads(parsed.stdout), texts)
    version = int(re.search(r"#define MPM_VERSION (\w+)", texts.of(f"{arguments.include}/mpm/types.h"))[1], 16)
    files = []
    header, *folders = companion(arguments) or ("", arguments.include)
    for name in [header] if header else HEADERS + ["mpm"]:
        text = texts.of(f"{folders[0]}/mpm/{name}.h")
        files.append({"name": f"{name}.h", "doc": plain(re.match(r"/\*\*.*?\*/", text, re.S)[0])})
    callbacks, structs = reader.callbacks_and_structs()
    api = {"library": "lib" + (header or "mpm").replace("_", "-"), "version": version, "files": files,
           "handles": reader.handles(), "constants": reader.constants(), "callbacks": callbacks, "structs": structs,
           "functions": reader.functions()}
    names = {one["name"] for one in files}
    for kind in ("handles", "constants", "callbacks", "structs", "functions"):
        api[kind] = [one for one in api[kind] if one["header"] in names]
    confirm(arguments, api)
    return api


def confirm(arguments, api):
    """Sees that nothing lacks a comment or a name, and that the compiler lays structs out as is said here."""
    for kind in ("handles", "constants", "callbacks", "structs", "functions"):
        for one in api[kind]:
            parts = [one] + one.get("values", []) + one.get("fields", [])
            bad = [p for p in parts if not p["doc"] or not p["name"]]
            if bad:
                raise SystemExit(f"api.py: no comment or name: {one['name']} {bad[0]['name']}")
    for pointer, target in TARGETS.items():
        text = source(arguments) + "#include <stddef.h>\n"
        for struct in api["structs"]:
            name, bits = struct["name"], 8 * pointer
            text += f'_Static_assert(sizeof({name}) == {struct[f"size{bits}"]}, "{name}");\n'
            for field in struct["fields"]:
                offset = field[f"offset{bits}"]
                text += f'_Static_assert(offsetof({name}, {field["name"]}) == {offset}, "{name}.{field["name"]}");\n'
        checked = clang(arguments, text)("--target=" + target, "-fsyntax-only")
        if checked.returncode:
            raise SystemExit(f"api.py: {target} lays structs out otherwise:\n{checked.stderr}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--clang", default=os.environ.get("API_CLANG", "clang"))
    parser.add_argument("--umat", metavar="FOLDER")
    parser.add_argument("--mpi", metavar="FOLDER")
    parser.add_argument("--petsc", metavar="FOLDER")
    parser.add_argument("include", nargs="?", default="include")
    json.dump(describe(parser.parse_args()), sys.stdout, indent=1, ensure_ascii=False)
    print()


if __name__ == "__main__":
    main()
