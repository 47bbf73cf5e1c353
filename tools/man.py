#!/usr/bin/env python3
"""Writes manual pages from bindings/api.json, umat.json, mpi.json and petsc.json: mpm(7), one page a header in section 3, and a link to it for
each function.

    tools/man.py VERSION FOLDER
"""
import json
import os
import re
import sys

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.split("\n"))


def paragraphs(text):
    """A comment of the headers: lists and tables stay, "@par Title" begins a section."""
    out = []
    table = False
    for line in text.split("\n"):
        if line.startswith("|") != table:
            table = not table
            out.append(".RS 0\n.nf" if table else ".fi\n.RE")
        if line.startswith("@par"):
            title = line[4:].strip()
            out.append(f".SS {escaped(title)}" if title else ".PP")
        elif line.startswith("@"):
            continue
        elif line.startswith("- "):
            out.append(".IP \\(bu 2\n" + escaped(line[2:]))
        elif not line:
            out.append(".PP")
        else:
            out.append(escaped(line))
    if table:
        out.append(".fi\n.RE")
    return re.sub(r"(\.PP\n)+(\.SS|$)", r"\2", "\n".join(out))


def declared(one, kind=""):
    if "pointer_to" in one:
        return f"{kind}{one['pointer_to']} *{one['name']};"
    arguments = ", ".join(f"{a['type']['c']} {a['name']}".replace("* ", "*") for a in one["arguments"]) or "void"
    name = f"(*{one['name']})" if kind and not one.get("function") else one["name"]
    return f"{kind}{one['result']['c']} {name}({arguments});".replace("* ", "*")


def head(name, section, version, what):
    return f'.TH {name.upper()} {section} "" "libmpm {version}" "libmpm"\n.SH NAME\n{name} \\- {escaped(what)}\n'


def fields(struct):
    out = [".TP 4\n.B struct " + struct["name"] + "\n" + paragraphs(struct["doc"]) + "\n.RS"]
    for field in struct["fields"]:
        kind = field["type"]["c"]
        text = re.sub(r"(\w+)(\[.*\])$", rf"\1 {field['name']}\2", kind) if "[" in kind else f"{kind} {field['name']}"
        out.append(f".TP 4\n.I {escaped(text)}\n{paragraphs(field['doc'])}")
    return "\n".join(out) + "\n.RE"


def page_name(header):
    stem = header["name"][:-2]
    return stem if stem.startswith("mpm_") else f"mpm_{stem}"


def page(api, header, version):
    mine = lambda kind: [one for one in api[kind] if one["header"] == header["name"]]
    text = re.sub(r"^@file \S+\n", "", header["doc"])
    first = text.split(":")[0].split(".")[0].split("\n")[0]
    out = [head(page_name(header), 3, version, first[0].lower() + first[1:]),
           f".SH SYNOPSIS\n.nf\n.B #include <mpm/{header['name']}>\n.PP"]
    out += [".B " + escaped(declared(one)) for one in mine("functions")]
    out += [".fi\n.SH DESCRIPTION", paragraphs(text)]
    if mine("handles"):
        out.append(".SH OBJECTS")
        out += [f".TP 4\n.B {one['name']}\n{paragraphs(one['doc'])}" for one in mine("handles")]
    if mine("functions"):
        out.append(".SH FUNCTIONS")
        out += [f".TP 4\n.B {escaped(declared(one))}\n{paragraphs(one['doc'])}" for one in mine("functions")]
    named = [one for one in mine("callbacks") if "_desc_" not in one["name"]]
    if named:
        out.append(".SH CALLBACKS")
        out += [f".TP 4\n.B {escaped(declared(one, 'typedef '))}\n{paragraphs(one['doc'])}" for one in named]
    if mine("structs"):
        out.append(".SH STRUCTS")
        out += [fields(one) for one in mine("structs")]
    if mine("constants"):
        out.append(".SH CONSTANTS")
        for group in mine("constants"):
            out.append(f".TP 4\n.B enum {group['name']}\n{paragraphs(group['doc'])}\n.RS")
            out += [f".TP 4\n{one['name']} = {escaped(str(one['value']))}\n{paragraphs(one['doc'])}" for one in group["values"]]
            out.append(".RE")
    out.append(".SH SEE ALSO\n.BR mpm (7)\n")
    return "\n".join(out)


def overview(api, companions, version):
    mpm = next(one for one in api["files"] if one["name"] == "mpm.h")
    text = re.sub(r"^@file \S+\n", "", mpm["doc"])
    others = ",\n".join(f".BR {page_name(one)} (3)" for api in (api, *companions) for one in api["files"] if one is not mpm)
    compile_line = "cc host.c $(pkg-config --cflags --libs mpm)"
    return (head("mpm", 7, version, "the Material Point Method as a library")
            + f".SH SYNOPSIS\n.nf\n.B #include <mpm/mpm.h>\n.PP\n.B {escaped(compile_line)}\n.fi\n.SH DESCRIPTION\n"
            + paragraphs(text) + f"\n.SH SEE ALSO\n{others}\n".replace(",\n.BR", ",\n.BR"))


def main():
    version, folder = sys.argv[1:]
    descriptions = []
    for name in ("api", "umat", "mpi", "petsc"):
        with open(f"{TOP}/bindings/{name}.json", encoding="utf-8") as file:
            descriptions.append(json.load(file))
    os.makedirs(folder, exist_ok=True)
    pages = {"mpm.7": overview(descriptions[0], descriptions[1:], version)}
    for api in descriptions:
        for header in api["files"]:
            if header["name"] != "mpm.h":
                pages[f"{page_name(header)}.3"] = page(api, header, version)
        for one in api["functions"]:
            pages.setdefault(f"{one['name']}.3", f".so man3/{page_name({'name': one['header']})}.3\n")
    for name, text in pages.items():
        with open(f"{folder}/{name}", "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
