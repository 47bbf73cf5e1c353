"""The lowest layer of the Python package: ctypes for every struct, callback, function and constant."""
from common import NOTE, short, words, wrapped

KINDS = {"int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64", "uint64_t": "c_uint64", "double": "c_double",
         "float": "c_float", "uint8_t": "c_uint8", "mpm_status": "c_int32", "size_t": "c_size_t", "char": "c_char"}


def ctype(kind, made):
    """The ctypes expression of a type. Arrays and structs are passed by address, and addresses are void pointers, so
    that an array of numpy costs no conversion."""
    if kind["kind"] == "callback":
        return short(kind["base"])
    if kind["kind"] == "handle" or (kind["base"] == "void" and kind["pointer"]):
        return "c_void_p"
    if kind["pointer"] == 1 and kind["base"] == "char" and kind["const"]:
        return "c_char_p"
    if kind["pointer"]:
        return f"POINTER({made[kind['base']]})" if kind["base"] in made and kind["pointer"] == 1 else "c_void_p"
    if kind["base"] == "void":
        return "None"
    one = made.get(kind["base"]) or KINDS[kind["base"]]
    return f"{one} * {kind['count']}" if "count" in kind else one


def constants(api):
    out, flat = [], []
    for group in api["constants"]:
        name = words(group["name"][:-len("_value")])
        name = {"Type": "FieldType", "Tangent": "TangentForm"}.get(name, name)
        base = "IntFlag" if name == "Access" else "IntEnum"
        out.append(f"class {name}({base}):\n" + wrapped(f'"""{group["doc"]}"""', 118, "    ") + "\n")
        for value in group["values"]:
            out.append(wrapped(value["doc"], 116, "    #: "))
            out.append(f"    {short(value['name'])} = {value['value']}")
            flat.append((short(value["name"]), f"{name}.{short(value['name'])}"))
        out.append("\n")
    out += [f"{name} = {value}" for name, value in flat]
    return "\n".join(out), [name for name, _ in flat]


def struct(one, made):
    out = [f"class {short(one['name'])}(Structure):", wrapped(f'"""{one["doc"]}"""', 118, "    "), ""]
    out.append("    _fields_ = [")
    out += [f'        ("{field["name"]}", {ctype(field["type"], made)}),' for field in one["fields"]]
    out.append("    ]\n\n")
    made[one["name"]] = short(one["name"])
    return "\n".join(out)


def callbacks_and_structs(api):
    """Each after those that it names: a callback takes structs by address, a struct may hold callbacks."""
    made, out, waiting = {}, [], api["callbacks"] + api["structs"]
    structs = {one["name"] for one in api["structs"]}
    done = set()
    while waiting:
        rest = []
        for one in waiting:
            parts = [p["type"] for p in one.get("fields", one.get("arguments"))]
            needs = {p["base"] for p in parts if p["kind"] == "callback" or p["base"] in structs}
            if not needs <= done | {one["name"]}:
                rest.append(one)
                continue
            if one["name"] in structs:
                out.append(struct(one, made))
            else:
                kinds = ", ".join([ctype(one["result"], made)] + [ctype(p, made) for p in parts])
                out.append(f"{short(one['name'])} = CFUNCTYPE({kinds})\n")
            done.add(one["name"])
        if len(rest) == len(waiting):
            raise SystemExit(f"python.py: types in a circle: {[one['name'] for one in rest]}")
        waiting = rest
    return "\n".join(out), made


def sizes(api):
    lines = [f"    {short(one['name'])}: ({one['size64']}, {one['size32']})," for one in api["structs"]]
    return "#: Sizes of the structs for pointers of 8 and of 4 bytes.\nSIZES = {\n" + "\n".join(lines) + "\n}"


def functions(api, made):
    out = ["#: Result and arguments of every function.", "FUNCTIONS = {"]
    for one in api["functions"]:
        arguments = ", ".join(ctype(a["type"], made) for a in one["arguments"])
        out.append(f'    "{one["name"]}": ({ctype(one["result"], made)}, [{arguments}]),')
    out += ["}", "", "#: What the headers say about every function.", "DOCS = {"]
    for one in api["functions"]:
        signature = f"{one['result']['c']} {one['name']}(" + ", ".join(f"{a['type']['c']} {a['name']}"
                                                                         for a in one["arguments"]) + ")"
        signature = signature.replace("* ", "*")
        text = (signature + "\n\n" + one["doc"]).replace("\\", "\\\\")
        out.append(f'    "{one["name"]}": """' + wrapped(text, 118) + '""",')
    out.append("}")
    return "\n".join(out)


def files(api):
    enums, names = constants(api)
    types, made = callbacks_and_structs(api)
    text = f'''"""{NOTE}

Structs, types of callbacks and prototypes for ctypes, and the constants without their prefix."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint8, c_uint32,
                    c_uint64, c_void_p)
from enum import IntEnum, IntFlag

#: Version of the headers that this was made from.
VERSION = {api["version"]:#08x}


{enums}

#: Names of all constants.
CONSTANTS = """
{wrapped(" ".join(names), 118, "    ")}
""".split()


{types}
{sizes(api)}

{functions(api, made)}
'''
    return {"python/src/mpm/_api.py": text}
