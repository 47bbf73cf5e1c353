"""Rust: the crate mpm-sys, which is the interface of C as it is, and its test of layouts."""
from common import NOTE, OUTPUTS, first_sentence, is_descriptor, wrapped

WIDTH = 118
TYPES = {"int32_t": "i32", "uint32_t": "u32", "mpm_status": "mpm_status", "int64_t": "i64", "uint64_t": "u64", "uint8_t": "u8", "float": "f32",
         "size_t": "usize", "double": "f64", "char": "c_char", "void": "c_void"}

HEAD = """//! The interface of libmpm as C has it: functions, structs, constants and types of callbacks, by their names there. The
//! crate `mpm` is the safe layer over it.
//!
//! What holds for all of it stands in `mpm/mpm.h`; the comments here are those of the headers.
#![allow(non_camel_case_types, non_snake_case)]
#![allow(unknown_lints, rustdoc::all, clippy::doc_lazy_continuation, clippy::doc_overindented_list_items)]
#![allow(clippy::too_long_first_doc_paragraph, clippy::type_complexity)]

use std::marker::{PhantomData, PhantomPinned};
use std::mem::size_of;
use std::os::raw::{c_char, c_void};

pub use constants::*;

"""


def comment(text, indent=""):
    text = "\n".join(line for line in text.split("\n") if not line.startswith("@file"))
    lines = wrapped(text, WIDTH - len(indent)).split("\n")
    return "".join(f"{indent}/// {line}".rstrip() + "\n" for line in lines)


def name_of(name):
    return f"r#{name}" if name in ("type", "fn", "in", "match", "ref") else name


def type_of(kind):
    if kind["kind"] == "callback":
        return kind["base"]
    out = TYPES.get(kind["base"], kind["base"])
    if kind["pointer"] == 1:
        out = f"*{'const' if kind['const'] else 'mut'} {out}"
    elif kind["pointer"] == 2:
        inner = f"*{'const' if kind['const'] else 'mut'} {out}"
        out = f"*{'const' if kind['c'].count('const') == 2 else 'mut'} {inner}"
    return f"[{out}; {kind['count']}]" if "count" in kind else out


def result_of(function):
    kind = function["result"]
    return "" if kind["base"] == "void" and not kind["pointer"] else f" -> {type_of(kind)}"


def parameters(function):
    return [f"{name_of(a['name'])}: {type_of(a['type'])}" for a in function["arguments"]]


def fitted(start, parts, end, indent):
    """A list of parts on one line, or one on each, as rustfmt has it."""
    line = f"{indent}{start}{', '.join(parts)}{end}"
    if len(line) <= 100:
        return line + "\n"
    return f"{indent}{start}\n" + "".join(f"{indent}    {part},\n" for part in parts) + f"{indent}{end}\n"


def sys(api):
    out = f"// {NOTE}\n" + HEAD
    out += comment("The result of a call: 0 if it was done; see `constants::MPM_OK` and the others.") + "pub type mpm_status = i32;\n\n"
    out += "/// All constants of the headers.\npub mod constants {\n"
    out += "    /// Version of the headers that the crate was made from, to be compared with `mpm_version()`.\n"
    out += f"    pub const MPM_VERSION: u32 = {api['version']:#08x};\n"
    for group in api["constants"]:
        out += f"\n    // {first_sentence(group['doc'])}\n\n"
        for value in group["values"]:
            out += comment(value["doc"], "    ") + f"    pub const {value['name']}: i32 = {value.get('alias_of') or value['value']};\n"
    out += "}\n\n"
    for handle in api["handles"]:
        out += comment(handle["doc"]) + f"#[repr(C)]\npub struct {handle['name']} {{\n    _opaque: [u8; 0],\n"
        out += "    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,\n}\n\n"
    for callback in api["callbacks"]:
        out += comment(callback["doc"])
        out += fitted(f"pub type {callback['name']} = Option<unsafe extern \"C\" fn(", parameters(callback),
                      f"){result_of(callback)}>;", "") + "\n"
    for struct in api["structs"]:
        out += comment(struct["doc"]) + f"#[repr(C)]\n#[derive(Clone, Copy, Debug)]\npub struct {struct['name']} {{\n"
        for field in struct["fields"]:
            out += comment(field["doc"], "    ") + f"    pub {name_of(field['name'])}: {type_of(field['type'])},\n"
        out += "}\n\n"
        name = struct["name"]
        if is_descriptor(struct):
            out += f"impl Default for {name} {{\n    /// The library's defaults: `{name}_init()`.\n    fn default() -> Self {{\n"
            out += "        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.\n"
            out += "        unsafe {\n            let mut out: Self = std::mem::zeroed();\n"
            out += f"            let status = {name}_init(&mut out, size_of::<Self>() as u32);\n"
            out += f"            assert_eq!(status, MPM_OK, \"{name}_init\");\n            out\n        }}\n    }}\n}}\n\n"
        elif name in OUTPUTS:
            out += f"impl Default for {name} {{\n    /// Ready to be filled: zeros, and `struct_size`.\n    fn default() -> Self {{\n"
            out += "        // SAFETY: zeros are a value of every field.\n        let mut out: Self = unsafe { std::mem::zeroed() };\n"
            out += "        out.struct_size = size_of::<Self>() as u32;\n        out\n    }\n}\n\n"
    out += "extern \"C\" {\n"
    for k, function in enumerate(api["functions"]):
        out += ("\n" if k else "") + comment(function["doc"], "    ")
        out += fitted(f"pub fn {function['name']}(", parameters(function), f"){result_of(function)};", "    ")
    return out + "}\n"


def layout(api):
    out = f"// {NOTE}\n//! Whether structs lie in memory as those of C, and whether the library has every function.\n"
    out += "use mpm_sys::*;\nuse std::mem::{size_of, MaybeUninit};\nuse std::ptr::addr_of;\n\n"
    out += "fn of(wide: usize, narrow: usize) -> usize {\n    if size_of::<usize>() == 8 {\n        wide\n    } else {\n"
    out += "        narrow\n    }\n}\n\n"
    out += "macro_rules! offset {\n    ($type:ty, $field:ident) => {{\n        let it = MaybeUninit::<$type>::uninit();\n"
    out += "        let base = it.as_ptr();\n        // SAFETY: an address is taken, nothing is read.\n"
    out += "        unsafe { addr_of!((*base).$field) as usize - base as usize }\n    }};\n}\n\n"
    for struct in api["structs"]:
        name = struct["name"]
        out += f"#[test]\nfn layout_of_{name}() {{\n    assert_eq!(size_of::<{name}>(), of({struct['size64']}, {struct['size32']}));\n"
        for field in struct["fields"]:
            out += (f"    assert_eq!(offset!({name}, {name_of(field['name'])}), "
                    f"of({field['offset64']}, {field['offset32']}));\n")
        out += "}\n\n"
    out += "#[test]\nfn functions_are_there() {\n    let all = [\n"
    for function in api["functions"]:
        out += f"        {function['name']} as *const (),\n"
    out += "    ];\n    assert!(all.iter().all(|function| !function.is_null()));\n}\n"
    return out


def files(api):
    return {"rust/mpm-sys/src/lib.rs": sys(api), "rust/mpm-sys/tests/layout.rs": layout(api)}
