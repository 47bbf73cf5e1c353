"""C#: structs, constants, delegates and the functions of C, by their names there.

Pointers stay pointers: the classes over this layer pin arrays and make texts. An array in a struct is a fixed buffer with a
declaration of its own, as compilers lay several in one out wrongly.
"""
import html

from common import NOTE, OUTPUTS, first_sentence, is_descriptor, words, wrapped

WIDTH = 118
TYPES = {"int32_t": "int", "uint32_t": "uint", "mpm_status": "int", "int64_t": "long", "uint64_t": "ulong", "uint8_t": "byte", "float": "float",
         "size_t": "UIntPtr", "double": "double", "char": "byte", "void": "void"}
KEYWORDS = {"params", "out", "in", "ref", "object", "string", "lock", "event", "fixed", "is", "as", "base", "operator"}

HEAD = """using System;
using System.Runtime.InteropServices;

namespace Mpm {
"""


def comment(text, indent):
    text = html.escape(first_sentence(text), quote=False)
    return wrapped(f"<summary>{text}</summary>", WIDTH, indent + "/// ") + "\n"


def name_of(name):
    return f"@{name}" if name in KEYWORDS else name


def type_of(kind, of_argument):
    """A pointer to what is not laid out here, or to a function, is an IntPtr."""
    if kind["kind"] == "callback":
        return words(kind["base"]) if of_argument else "IntPtr"
    if kind["kind"] == "handle":
        return "IntPtr" + "*" * (kind["pointer"] - 1)
    base = TYPES.get(kind["base"]) or words(kind["base"])
    if base == "void" and kind["pointer"]:
        return "IntPtr" + "*" * (kind["pointer"] - 1)
    if base == "byte" and kind["base"] == "char" and kind["pointer"] and not of_argument:
        return "IntPtr"
    return base + "*" * kind["pointer"]


def arguments(function):
    return [f"{type_of(a['type'], True)} {name_of(a['name'])}" for a in function["arguments"]]


def fitted(start, parts, end, indent):
    line = f"{indent}{start}{', '.join(parts)}{end}"
    if len(line) <= WIDTH:
        return line + "\n"
    return wrapped(f"{start}{', '.join(parts)}{end}", WIDTH, indent, indent + "    ") + "\n"


def native(api):
    out = f"// {NOTE}\n{HEAD}"
    out += "  /// <summary>All constants of the headers: `using static Mpm.Constants;` makes them known by their names.</summary>\n"
    out += "  public static class Constants {\n"
    for k, group in enumerate(api["constants"]):
        out += ("\n" if k else "") + wrapped("// " + first_sentence(group["doc"]), WIDTH, "    ", "    // ") + "\n"
        for value in group["values"]:
            out += comment(value["doc"], "    ")
            out += f"    public const int {value['name']} = {value.get('alias_of') or value['value']};\n"
    out += "  }\n\n"
    for callback in api["callbacks"]:
        out += comment(callback["doc"], "  ")
        out += "  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]\n"
        out += fitted(f"public unsafe delegate {type_of(callback['result'], True)} {words(callback['name'])}(", arguments(callback),
                      ");", "  ") + "\n"
    for struct in api["structs"]:
        name = words(struct["name"])
        out += comment(struct["doc"], "  ") + "  [StructLayout(LayoutKind.Sequential)]\n"
        out += f"  public unsafe partial struct {name} {{\n"
        for field in struct["fields"]:
            kind = field["type"]
            out += comment(field["doc"], "    ")
            if "count" in kind:
                out += f"    public fixed {type_of(kind, False)} {name_of(field['name'])}[{kind['count']}];\n"
            else:
                out += f"    public {type_of(kind, False)} {name_of(field['name'])};\n"
        if is_descriptor(struct):
            out += f"\n    /// <summary>The library's defaults.</summary>\n    public static {name} Default() {{\n"
            out += f"      var it = new {name}();\n"
            out += f"      MpmException.Check(Native.{struct['name']}_init(&it, (uint)sizeof({name})), IntPtr.Zero);\n"
            out += "      return it;\n    }\n"
        elif struct["name"] in OUTPUTS:
            out += f"\n    /// <summary>Ready to be filled: zeros, and struct_size.</summary>\n    public static {name} Empty() {{\n"
            out += f"      var it = new {name}();\n      it.struct_size = (uint)sizeof({name});\n      return it;\n    }}\n"
        out += "  }\n\n"
    out += "  /// <summary>The functions of C.</summary>\n  public static unsafe class Native {\n"
    out += "#if MPM_STATIC // the library is part of the program, as Unity has it on iOS and WebGL\n"
    out += "    public const string Library = \"__Internal\";\n#else\n    public const string Library = \"mpm\";\n#endif\n"
    out += "    /// <summary>Version of the headers that this was made from, to be compared with mpm_version().</summary>\n"
    out += f"    public const uint Version = {api['version']:#08x};\n"
    for function in api["functions"]:
        out += "\n" + comment(function["doc"], "    ")
        out += "    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]\n"
        out += fitted(f"public static extern {type_of(function['result'], False)} {function['name']}(", arguments(function), ");",
                      "    ")
    return out + "  }\n}\n"


def layout(api):
    out = f"// {NOTE}\n// Whether structs lie in memory as those of C, and whether the library has every function.\n{HEAD}"
    out += "  static unsafe class Layout {\n    static int wrong;\n\n"
    out += "    static void Compare(string what, long found, int wide, int narrow) {\n"
    out += "      int should = IntPtr.Size == 8 ? wide : narrow;\n      if (found == should) return;\n"
    out += "      Console.Error.WriteLine(\"{0}: {1}, in C {2}\", what, found, should);\n      wrong++;\n    }\n\n"
    for struct in api["structs"]:
        name = words(struct["name"])
        out += f"    static void Check{name}() {{\n      var it = new {name}();\n      byte* at = (byte*)&it;\n"
        out += f"      Compare(\"{name}\", sizeof({name}), {struct['size64']}, {struct['size32']});\n"
        for field in struct["fields"]:
            address = f"it.{name_of(field['name'])}" if "count" in field["type"] else f"&it.{name_of(field['name'])}"
            out += (f"      Compare(\"{name}.{field['name']}\", (byte*){address} - at, {field['offset64']}, "
                    f"{field['offset32']});\n")
        out += "    }\n\n"
    out += "    public static int Check() {\n      wrong = 0;\n"
    for struct in api["structs"]:
        out += f"      Check{words(struct['name'])}();\n"
    out += "      foreach (var method in typeof(Native).GetMethods())\n"
    out += "        if (method.IsStatic) Marshal.Prelink(method);\n"
    return out + "      return wrong;\n    }\n  }\n}\n"


def files(api):
    return {"csharp/Native.cs": native(api), "csharp/tests/Layout.cs": layout(api)}
