"""Writes what the JavaScript package takes from the headers: names, numbers and memory layouts, and declarations.

bindings/javascript/libmpm.d.ts.in has the declarations of the classes, which are written by hand. There a line

    //! mpm_step            becomes the comment of that function, as it stands in the header
    //= constants           becomes what this module writes of that kind: constants, options, reports, batches, raw
"""
import os
import re

from common import NOTE, constants, is_descriptor, words, wrapped

HERE = os.path.dirname(os.path.abspath(__file__))
TEMPLATE = f"{HERE}/../javascript/libmpm.d.ts.in"
WIDTH = 110
NUMBERS = {"uint8_t": "u8", "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64", "double": "f64", "float": "f32",
           "float": "f32", "mpm_status": "i32", "size_t": "u32"}
ARRAYS = {"uint8_t": "Uint8Array", "int32_t": "Int32Array", "int64_t": "BigInt64Array", "double": "Float64Array", "float": "Float32Array"}
# What holds the id of a particle, which is a BigInt as in arrays of ids; other 64-bit integers are counts.
IDS = {("mpm_step_info", "particle")}
REPORTS = ["mpm_step_info", "mpm_contact_info", "mpm_profile", "mpm_operator_info", "mpm_adaption_info", "mpm_heat_info"]


def is_number(kind):
    return not kind["pointer"] and kind["kind"] == "value"


def shape_of(field):
    """What the comment of an array says about its extent: ["dim", "ld"] of "[dim][ld] ..."."""
    found = re.match(r"((\[\w+\])+)", field["doc"])
    return re.findall(r"\w+", found[1]) if found and field["type"]["base"] in ARRAYS else None


def entry(struct, field):
    """A field in the layout: [offset, kind], with the number of entries, or with the extents of what it points to, which
    is "f64*", or "f64* out" where it is to be filled."""
    kind, offset = field["type"], field["offset32"]
    if is_number(kind):
        name = "id" if (struct["name"], field["name"]) in IDS else NUMBERS[kind["base"]]
        return [offset, name, kind["count"]] if "count" in kind else [offset, name]
    shape = shape_of(field)
    mark = "*" if kind["const"] else "* out"
    return [offset, NUMBERS[kind["base"]] + mark, *shape] if shape else [offset, "pointer"]


def literal(value):
    if isinstance(value, str):
        return f"'{value}'"
    return f"[{', '.join(literal(one) for one in value)}]" if isinstance(value, list) else str(value)


def wasm_type(kind):
    if kind["pointer"] or kind["kind"] == "callback":
        return "i32"
    return {"i64": "i64", "u64": "i64", "f64": "f64"}.get(NUMBERS[kind["base"]], "i32")


def layout(api):
    out = [f"// {NOTE}", f"export const VERSION = {api['version']:#08x};", "", "export const constants = Object.freeze({"]
    out += [f"  {value['name']}: {value['value']}," for _, value in constants(api)]
    out += ["});", "", "// A field is [offset, kind], with the length of an array in the struct, or with the extents of one that it points to.",
            "export const structs = {"]
    for struct in api["structs"]:
        out += [f"  {struct['name']}: {{", f"    size: {struct['size32']},", "    fields: {"]
        out += [f"      {field['name']}: {literal(entry(struct, field))}," for field in struct["fields"]]
        out += ["    },", "  },"]
    out += ["};", "", "// The parameters of callbacks as WebAssembly has them, and how many results there are.", "export const callbacks = {"]
    for one in api["callbacks"]:
        if one["arguments"] and one["arguments"][0]["name"] == "user":
            results = 0 if one["result"]["base"] == "void" and not one["result"]["pointer"] else 1
            out.append(f"  {one['name']}: [{literal([wasm_type(a['type']) for a in one['arguments']])}, {results}],")
    out += ["};", "", "// The parameters of functions that are numbers: [place, name, kind].", "export const functions = {"]
    for one in api["functions"]:
        numbers = [[k, a["name"], NUMBERS[a["type"]["base"]]] for k, a in enumerate(one["arguments"])
                   if not a["type"]["pointer"] and NUMBERS.get(a["type"]["base"]) in ("i32", "u32", "i64", "f64")]
        if numbers:
            out.append(f"  {one['name']}: {literal(numbers)},")
    return "\n".join(out + ["};", ""])


def comment(text, indent):
    """A comment of JSDoc; tables and lists keep their lines."""
    text = text.replace("*/", "* /")
    text = re.sub(r"@par (\w+)", r"\1:", text)
    lines = wrapped(text, WIDTH - len(indent) - 3).split("\n")
    if len(lines) == 1 and len(lines[0]) < WIDTH - len(indent) - 7:
        return f"{indent}/** {lines[0]} */"
    return "\n".join([f"{indent}/**"] + [f"{indent} * {line}".rstrip() for line in lines] + [f"{indent} */"])


def of_constants(api, indent):
    out = [f"{indent}export interface Constants {{"]
    for group in api["constants"]:
        for value in group["values"]:
            out += [comment(value["doc"], indent + "  "), f"{indent}  readonly {value['name']}: {value['value']};"]
    return out + [f"{indent}}}"]


def of_fields(struct, indent, optional):
    out = []
    for field in struct["fields"]:
        if field["name"] in ("struct_size", "reserved") or not is_number(field["type"]):
            continue
        kind = "bigint" if field["type"]["base"] == "uint64_t" or (struct["name"], field["name"]) in IDS else "number"
        if "count" in field["type"]:
            kind = "ArrayLike<number>" if optional else f"{kind}[]"
        mark = "?" if optional else ""
        if optional and field["type"]["base"] == "int32_t" and "count" not in field["type"]:
            kind = "number | boolean"
        out += [comment(field["doc"], indent + "  "), f"{indent}  {field['name']}{mark}: {kind};"]
    return out


def of_options(api, indent):
    out = []
    for struct in api["structs"]:
        if is_descriptor(struct):
            out += [comment(re.sub(r" Fill (the struct|it) with \w+\(\)(, then change what is wanted)?\.", "", struct["doc"]), indent),
                    f"{indent}export interface {words(struct['name'])} {{", *of_fields(struct, indent, True), f"{indent}}}"]
    return out


def of_reports(api, indent):
    out = []
    for struct in api["structs"]:
        if struct["name"] in REPORTS:
            out += [comment(re.sub(r" ?The caller sets struct_size\.", "", struct["doc"]), indent),
                    f"{indent}export interface {words(struct['name'])} {{", *of_fields(struct, indent, False), f"{indent}}}"]
    return out


def of_batches(api, indent):
    out = []
    for struct in api["structs"]:
        if not struct["name"].endswith("_batch"):
            continue
        out += [comment(struct["doc"], indent), f"{indent}export interface {words(struct['name'])} {{"]
        known = {field["name"] for field in struct["fields"]}
        for field in struct["fields"]:
            shape = shape_of(field)
            if field["name"] in ("struct_size", "reserved") or (not shape and not is_number(field["type"])):
                continue
            kind, name = "number", field["name"]
            if shape:
                kind = ARRAYS[field["type"]["base"]] + ("[]" if len(shape) > 1 else "")
                if not shape[0].isdigit() and shape[0] != "ld" and shape[0] not in known:
                    name, kind = f"{name}({shape[0]}: number)", kind
                elif "NULL" in field["doc"]:
                    kind += " | undefined"
            out += [comment(field["doc"], indent + "  "), f"{indent}  readonly {name}: {kind};" if "(" not in name else f"{indent}  {name}: {kind};"]
        out += [f"{indent}}}"]
    return out


def of_raw(api, indent):
    out = [f"{indent}export interface Raw {{"]
    for function in api["functions"]:
        kinds = {"i64": "bigint"}
        arguments = ", ".join(f"{a['name']}: {kinds.get(wasm_type(a['type']), 'number')}" for a in function["arguments"])
        out.append(f"{indent}  {function['name']}({arguments}): {kinds.get(wasm_type(function['result']), 'number')};")
    return out + [f"{indent}}}"]


def declarations(api):
    docs = {one["name"]: one["doc"] for kind in ("functions", "callbacks", "structs", "handles") for one in api[kind]}
    docs.update({f"{struct['name']}.{field['name']}": field["doc"] for struct in api["structs"] for field in struct["fields"]})
    makers = {"constants": of_constants, "options": of_options, "reports": of_reports, "batches": of_batches, "raw": of_raw}
    out = [f"// {NOTE} Classes: libmpm.d.ts.in."]
    with open(TEMPLATE, encoding="utf-8") as file:
        lines = file.read().split("\n")
    for line in lines:
        found = re.match(r"( *)//([!=]) ([\w.]+)(?:: (.*))?$", line)
        if not found:
            out.append(line)
        elif found[2] == "=":
            out += makers[found[3]](api, found[1])
        elif found[3] in docs:
            out.append(comment((found[4] + "\n\n" if found[4] else "") + docs[found[3]], found[1]))
        elif found[3] in LATER:
            out.append(comment(found[4], found[1]))
        else:
            raise SystemExit(f"javascript.py: libmpm.d.ts.in asks for the comment of {found[3]}, which the headers do not have")
    return "\n".join(out)


def exports(api):
    """What the linker exports, as its options: names that the library lacks end the link."""
    names = [function["name"] for function in api["functions"]] + ["malloc", "free"]
    return "".join(f"-Wl,--export={name}\n" for name in names)


# Functions of the classes that fall back on others where the headers lack these.
LATER = ("mpm_particles_get_f32", "mpm_write_particles_to", "mpm_write_grid_to")


def files(api):
    return {"javascript/layout.mjs": layout(api), "javascript/libmpm.d.ts": declarations(api), "javascript/exports.txt": exports(api)}
