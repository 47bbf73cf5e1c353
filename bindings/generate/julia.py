"""Julia: the module MPM, with all functions by ccall, and a test of layouts.

A struct that the host fills is mutable, so that it has an address: an argument that is a pointer to it takes the struct
itself, or C_NULL. Those that the host only reads are immutable, and so is mpm_param, of which C takes an array.
"""
from common import NOTE, constants, is_descriptor, wrapped

WIDTH = 118
TYPES = {"int32_t": "Int32", "uint32_t": "UInt32", "mpm_status": "Int32", "int64_t": "Int64", "uint64_t": "UInt64",
         "uint8_t": "UInt8", "size_t": "Csize_t", "double": "Float64", "float": "Cfloat", "char": "UInt8", "void": "Cvoid"}
RESERVED = {"end", "function", "struct", "module", "global", "local", "const", "let", "type", "in"}

HEAD = '''"""
libmpm, the Material Point Method, from Julia: the functions, structs and constants of its headers, by their names there.
bindings/julia/README.md says how C and Julia differ.
"""
module MPM

"The library: the variable MPM_LIBRARY names another file."
const libmpm = get(ENV, "MPM_LIBRARY", "libmpm")

"A call was not done: the status of C, and the library's sentence."
struct MpmError <: Exception
    status::Int32
    text::String
end
Base.showerror(io::IO, error::MpmError) = print(io, error.text, " (", unsafe_string(mpm_status_name(error.status)), ")")

"Throws MpmError where a call on a context was not done."
function check(context, status)
    if status != MPM_OK
        throw(MpmError(status, unsafe_string(mpm_last_error(context))))
    end
    return nothing
end

"An array that C lends in a batch: [components][ld], of which the first n items count, as a matrix of ld rows."
function columns(data, ld, components)
    return unsafe_wrap(Array, Ptr{eltype(data)}(data), (Int(ld), Int(components)))
end

"A struct whose bytes are all 0."
function zeroed(::Type{T}) where {T}
    it = T()
    GC.@preserve it begin
        ccall(:memset, Ptr{Cvoid}, (Ptr{Cvoid}, Cint, Csize_t), pointer_from_objref(it), 0, sizeof(T))
    end
    return it
end

'''


def is_immutable(struct):
    return struct["name"] == "mpm_param" or struct["name"].endswith("_batch") and struct["name"] != "mpm_material_batch"


def quoted(text):
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\$")


def comment(text):
    text = "\n".join(line for line in text.split("\n") if not line.startswith("@file"))
    return '"""\n' + wrapped(quoted(text), WIDTH) + '\n"""\n'


def name_of(name):
    return f"{name}_" if name in RESERVED else name


def type_of(kind, of_argument):
    if kind["kind"] == "callback":
        return "Ptr{Cvoid}"
    base = TYPES.get(kind["base"], kind["base"])
    if of_argument and kind["base"] == "char" and kind["const"]:
        if kind["pointer"] == 1:
            return "Cstring"
        return "Ptr{Cstring}" if kind["c"].count("const") == 2 else "Ptr{Ptr{UInt8}}"
    for _ in range(kind["pointer"]):
        base = f"Ptr{{{base}}}"
    return f"NTuple{{{kind['count']}, {base}}}" if "count" in kind else base


def result_of(kind):
    return "Ptr{UInt8}" if kind["base"] == "char" else type_of(kind, False)


def listed(types):
    return f"({', '.join(types)}{',' if len(types) == 1 else ''})"


def function_text(function):
    names = [name_of(a["name"]) for a in function["arguments"]]
    types = [type_of(a["type"], True) for a in function["arguments"]]
    head = f"function {function['name']}({', '.join(names)})"
    call = f"    return ccall((:{function['name']}, libmpm), {result_of(function['result'])}, {listed(types)}"
    line = call + "".join(f", {name}" for name in names) + ")"
    if len(line) > WIDTH:
        line = call + ",\n        " + ", ".join(names) + ")"
    return comment(function["doc"]) + head + "\n" + line + "\nend\n\n"


def module(api):
    out = f"# {NOTE}\n{HEAD}"
    out += '"Version of the headers that the module was made from, to be compared with mpm_version()."\n'
    out += f"const MPM_VERSION = {api['version']:#08x}\n\n"
    for group in api["constants"]:
        out += wrapped(group["doc"], WIDTH, "# ") + "\n"
        for value in group["values"]:
            value_text = value.get("alias_of") or f"Int32({value['value']})"
            out += f"const {value['name']} = {value_text} # {value['doc'].split(': ')[0].split('. ')[0]}\n"
        out += "\n"
    for handle in api["handles"]:
        out += comment(handle["doc"]) + f"mutable struct {handle['name']} end\n\n"
    for struct in api["structs"]:
        name = struct["name"]
        out += comment(struct["doc"]) + ("" if is_immutable(struct) else "mutable ") + f"struct {name}\n"
        for field in struct["fields"]:
            out += f"    {name_of(field['name'])}::{type_of(field['type'], False)}\n"
        if is_immutable(struct):
            out += "end\n\n"
            continue
        out += f"    {name}() = new()\nend\n"
        out += f"Base.cconvert(::Type{{Ptr{{{name}}}}}, it::{name}) = it\n"
        out += (f"Base.unsafe_convert(::Type{{Ptr{{{name}}}}}, it::{name}) = "
                f"Ptr{{{name}}}(pointer_from_objref(it))\n\n")
    out += "# Callbacks: what @cfunction(f, result, (arguments,)) takes for each type of C.\n\n"
    for callback in api["callbacks"]:
        types = [type_of(a["type"], False) for a in callback["arguments"]]
        form = f"@cfunction(f, {result_of(callback['result'])}, {listed(types)})"
        out += comment(callback["doc"] + f"\n\nf({', '.join(a['name'] for a in callback['arguments'])}): {form}")
        out += f"const {callback['name']} = Ptr{{Cvoid}}\n\n"
    for function in api["functions"]:
        out += function_text(function)
    out += '"A struct that is ready: a descriptor has the library\'s defaults, others their struct_size and zeros."\n'
    out += "function ready(::Type{T}) where {T}\n    it = zeroed(T)\n    if hasfield(T, :struct_size)\n"
    out += "        it.struct_size = UInt32(sizeof(T))\n    end\n    return it\nend\n"
    for struct in api["structs"]:
        if is_descriptor(struct):
            name = struct["name"]
            out += f"function ready(::Type{{{name}}})\n    it = zeroed({name})\n"
            out += f"    status = {name}_init(it, UInt32(sizeof({name})))\n"
            out += f"    status == MPM_OK || error(\"{name}_init: libmpm is older than the module\")\n    return it\nend\n"
    names = ["check", "columns", "ready", "MpmError"] + [v["name"] for _, v in constants(api)]
    names += [x["name"] for kind in ("handles", "structs", "functions") for x in api[kind]]
    out += "\n" + wrapped("export " + ", ".join(names), WIDTH, "", "    ") + "\n\nend\n"
    return out


def layout(api):
    out = f"# {NOTE}\n# Whether structs lie in memory as those of C, and whether the library has every function.\n"
    out += "include(\"MPM.jl\")\nusing Libdl\nusing .MPM\n\nwide(a, b) = sizeof(Ptr{Cvoid}) == 8 ? a : b\n\n"
    out += "function compare(what, found, should)\n    found == should || error(\"$what: $found, in C $should\")\nend\n\n"
    for struct in api["structs"]:
        out += f"compare(\"{struct['name']}\", sizeof({struct['name']}), wide({struct['size64']}, {struct['size32']}))\n"
        for k, field in enumerate(struct["fields"]):
            out += (f"compare(\"{struct['name']}.{field['name']}\", fieldoffset({struct['name']}, {k + 1}), "
                    f"wide({field['offset64']}, {field['offset32']}))\n")
    out += "\nlibrary = Libdl.dlopen(MPM.libmpm)\n"
    for function in api["functions"]:
        out += f"Libdl.dlsym(library, :{function['name']})\n"
    return out


def files(api):
    return {"julia/MPM.jl": module(api), "julia/layout.jl": layout(api)}
