"""Fortran: the module mpm, and a program that compares the layout of its types with that of C.

Pointers to values become arrays of assumed size, or scalars where C writes one value; void pointers take arrays of any type.
Arguments that may be NULL are optional: an absent one is NULL (Fortran 2018).
"""
import textwrap

from common import NOTE, OUTPUTS, constants, first_sentence, is_descriptor, wrapped

WIDTH = 120
KINDS = {"int32_t": "integer(c_int32_t)", "uint32_t": "integer(c_int32_t)", "mpm_status": "integer(c_int32_t)",
         "int64_t": "integer(c_int64_t)", "uint64_t": "integer(c_int64_t)", "uint8_t": "integer(c_int8_t)", "float": "real(c_float)",
         "size_t": "integer(c_size_t)", "double": "real(c_double)", "char": "character(kind=c_char)"}

# Where C writes several values through a pointer that is not to constants; elsewhere it writes one.
ARRAYS = {
    "mpm_material_update": {"tangent"}, "mpm_operator_apply": {"y"}, "mpm_stepper_residuals": {"residual"},
    "mpm_stepper_wall_reaction": {"force"}, "mpm_stepper_particles_reaction": {"force"},
    "mpm_stepper_wall_impulse": {"impulse"}, "mpm_stepper_particles_impulse": {"impulse"},
    "mpm_stepper_surface_reaction": {"force"}, "mpm_stepper_surface_impulse": {"impulse"},
    "mpm_obstacle_get_pose": {"position", "orientation", "velocity", "angular_velocity"},
    "mpm_tangent_fn": {"tangent"}, "mpm_inside_fn": {"inside"}, "mpm_solve_fn": {"solution"}, "mpm_particle_fn": {"add"},
    "mpm_velocity_fn": {"prescribed", "velocity"}, "mpm_node_fn": {"velocity", "force"}, "mpm_friction_fn": {"friction"},
    "mpm_motion_fn": {"velocity", "angular_velocity"}, "mpm_traction_fn": {"add"},
    "mpm_marker_velocity_fn": {"add"}, "mpm_particles_get_f32": {"out"}, "mpm_heat_fn": {"power"}, "mpm_adaption_fn": {"accept"},
    "mpm_reduce_fn": {"values"}, "mpm_gather_fn": {"all"},
}
# The names of those through which C writes one.
SINGLE = {"added", "body", "bytes", "component_stride", "components", "count", "dt", "first_id", "hash", "high", "iterations", "low",
          "n", "part", "parts", "peak_bytes", "symmetric", "type", "value_default", "writable"}
# Structs of which a pointer means several.
ARRAY_STRUCTS = {"mpm_param"}
NULLABLE = {
    "mpm_context_create": {"desc"}, "mpm_context_part": {"part", "parts"}, "mpm_context_memory": {"bytes", "peak_bytes"}, "mpm_material_create": {"params"},
    "mpm_material_model_param": {"name", "unit", "text", "value_default", "low", "high"},
    "mpm_material_state_name": {"name", "unit", "text"}, "mpm_material_update": {"tangent", "symmetric"},
    "mpm_particles_add": {"velocity", "size", "ids", "first_id"}, "mpm_particles_fill_box": {"first_id", "count"},
    "mpm_particles_fill_ball": {"first_id", "count"}, "mpm_particles_fill": {"first_id", "count"},
    "mpm_particles_fill_mesh": {"first_id", "count"},
    "mpm_particles_field_info": {"field", "type", "components", "writable"}, "mpm_particles_get": {"ids"},
    "mpm_particles_set": {"ids"}, "mpm_particles_pack": {"ids"}, "mpm_stepper_set_balance": {"desc"},
    "mpm_stepper_set_adaption": {"desc"}, "mpm_stepper_set_heat": {"desc"}, "mpm_write_particles_to": {"fields"},
    "mpm_write_grid_to": {"fields"}, "mpm_state_load_pieces": {"piece", "bytes"}, "mpm_stepper_create": {"desc"}, "mpm_step": {"info"}, "mpm_advance": {"info"},
    "mpm_step_end": {"info"}, "mpm_stepper_residuals": {"residual"}, "mpm_stepper_set_contact": {"desc"},
    "mpm_obstacle_set_pose": {"position", "orientation", "velocity", "angular_velocity"},
    "mpm_obstacle_get_pose": {"position", "orientation", "velocity", "angular_velocity"},
    "mpm_obstacle_set_load": {"force", "torque"}, "mpm_write_particles": {"fields"}, "mpm_write_grid": {"fields"},
    "mpm_write_body_grid": {"fields"}, "mpm_surface_create": {"desc"}, "mpm_surface_add": {"area", "first_id"},
    "mpm_surface_add_polyline": {"first_id", "count"}, "mpm_surface_add_triangles": {"first_id", "count"},
    "mpm_surface_refine": {"added"}, "mpm_surface_get": {"ids"}, "mpm_surface_set": {"ids"},
}


def check_tables(api):
    """Sees that the tables above name what there is, and that they tell of every value that C writes."""
    there = {f["name"]: {a["name"]: a["type"] for a in f["arguments"]} for f in api["functions"] + api["callbacks"]}
    for table in (ARRAYS, NULLABLE):
        for function, names in table.items():
            for name in names:
                if not there[function][name]["pointer"]:
                    raise SystemExit(f"fortran.py: {function}: '{name}' is no pointer")
    for function, arguments in there.items():
        for name, kind in arguments.items():
            values = kind["pointer"] == 1 and not kind["const"] and kind["base"] in KINDS
            if values and name not in SINGLE and name not in ARRAYS.get(function, ()):
                raise SystemExit(f"fortran.py: {function}: say in ARRAYS or in SINGLE how many values '{name}' has")


def check_names(names, where):
    """Fortran does not tell a from A, and its names have 63 characters."""
    seen = set()
    for name in names:
        if name.lower() in seen or len(name) > 63:
            raise SystemExit(f"fortran.py: {where}: '{name}' is taken, or too long")
        seen.add(name.lower())


def comment(text, indent):
    return wrapped(first_sentence(text), WIDTH, indent + "!> ", indent + "!! ") + "\n"


def statement(text, indent):
    """Breaks a statement into lines."""
    lines = textwrap.wrap(text, WIDTH - 2, initial_indent=indent, subsequent_indent=indent + "    ", break_long_words=False,
                          break_on_hyphens=False)
    return " &\n".join(lines) + "\n"


def field_type(kind):
    if kind["kind"] == "callback":
        return "type(c_funptr)"
    if kind["pointer"]:
        return "type(c_ptr)"
    return KINDS[kind["base"]]


def argument(function, name, kind):
    """The declaration of a dummy argument."""
    depth, base = kind["pointer"], kind["base"]
    optional = ", optional" if name in NULLABLE.get(function, ()) else ""
    if kind["kind"] == "callback":
        return f"type(c_funptr), value :: {name}"
    if not depth:
        return f"{KINDS[base]}, value :: {name}"
    if kind["kind"] == "handle" or base in ("void", "char") and depth == 2:
        if depth == 1:
            return f"type(c_ptr), value :: {name}"
        if kind["c"].count("const") == 2:
            return f"type(c_ptr), intent(in){optional} :: {name}(*)"
        return f"type(c_ptr), intent(out){optional} :: {name}"
    if depth == 2:
        return f"type(c_ptr), intent(out){optional} :: {name}"
    if base == "void":
        if name in ("user", "task_data", "memory", "lookup"):
            return f"type(c_ptr), value :: {name}"
        return f"type(*), intent({'in' if kind['const'] else 'inout'}){optional} :: {name}(*)"
    if kind["kind"] == "struct":
        shape = "(*)" if base in ARRAY_STRUCTS else ""
        return f"type({base}), intent({'in' if kind['const'] else 'inout'}){optional} :: {name}{shape}"
    intent = "in" if kind["const"] else "inout"
    shape = "(*)" if kind["const"] or name in ARRAYS.get(function, ()) else ""
    return f"{KINDS[base]}, intent({intent}){optional} :: {name}{shape}"


def procedure(function, bind):
    """An interface body."""
    result, indent = function["result"], " " * 4
    what = "subroutine" if result["base"] == "void" and not result["pointer"] else "function"
    names = [a["name"] for a in function["arguments"]]
    check_names(names + ["answer"], function["name"])
    out = statement(f"{what} {function['name']}({', '.join(names)}) {bind}" + (" result(answer)" if what == "function" else ""),
                    indent)
    out += f"{indent}  import\n"
    for one in function["arguments"]:
        out += statement(argument(function["name"], one["name"], one["type"]), indent + "  ")
    if what == "function":
        out += f"{indent}  {field_type(result)} :: answer\n"
    return out + f"{indent}end {what} {function['name']}\n\n"


def module(api):
    init = [s["name"] for s in api["structs"] if is_descriptor(s)]
    check_names([v["name"] for _, v in constants(api)] + [x["name"] for k in ("structs", "callbacks", "functions") for x in api[k]]
                + ["mpm_init", "MPM_VERSION_OF_MODULE", "mpm"], "the module")
    out = f"! {NOTE}\n"
    out += "!> libmpm from Fortran: the functions, types and constants of its headers, by their names there. The headers say what\n"
    out += "!! they mean; bindings/fortran/README.md says how C and Fortran differ.\n"
    out += "module mpm\n  use, intrinsic :: iso_c_binding\n  implicit none\n  public\n\n"
    out += "  !> Version of the headers that the module was made from, to be compared with mpm_version().\n"
    out += f"  integer(c_int32_t), parameter :: MPM_VERSION_OF_MODULE = {api['version']}_c_int32_t\n\n"
    for group in api["constants"]:
        out += comment(group["doc"], "  ")
        for value in group["values"]:
            out += wrapped(first_sentence(value["doc"]), WIDTH, "  !> ", "  !! ") + "\n"
            out += f"  integer(c_int32_t), parameter :: {value['name']} = {value.get('alias_of') or str(value['value']) + '_c_int32_t'}\n"
        out += "\n"
    for struct in api["structs"]:
        check_names([f["name"] for f in struct["fields"]], struct["name"])
        out += comment(struct["doc"], "  ") + f"  type, bind(c) :: {struct['name']}\n"
        for field in struct["fields"]:
            shape = f"({field['type']['count']})" if "count" in field["type"] else ""
            out += comment(field["doc"], "    ") + f"    {field_type(field['type'])} :: {field['name']}{shape}\n"
        out += f"  end type {struct['name']}\n\n"
    out += "  ! Callbacks of the host: c_funloc() of a procedure of such an interface is what arguments and fields take.\n"
    out += "  abstract interface\n"
    for callback in api["callbacks"]:
        out += comment(callback["doc"], "    ") + procedure(callback, "bind(c)")
    out += "  end interface\n\n  interface\n"
    for function in api["functions"]:
        out += comment(function["doc"], "    ") + procedure(function, f'bind(c, name="{function["name"]}")')
    out += "  end interface\n\n"
    out += "  !> Readies a struct: a descriptor gets the library's defaults, an output its struct_size and zeros.\n"
    out += "  interface mpm_init\n"
    ready = [s for s in api["structs"] if is_descriptor(s) or s["name"] in OUTPUTS]
    for struct in ready:
        out += f"    module procedure init_{struct['name']}\n"
    out += "  end interface mpm_init\n\n"
    out += statement("private :: " + ", ".join(f"init_{s['name']}" for s in ready), "  ")
    out += "\ncontains\n\n"
    for struct in ready:
        name = struct["name"]
        size = "int(c_sizeof(it), c_int32_t)"
        out += f"  subroutine init_{name}(it)\n    type({name}), intent(out) :: it\n"
        if name in init:
            out += f"    if (mpm_{name[4:]}_init(it, {size}) /= MPM_OK) error stop \"libmpm is older than the module mpm\"\n"
        else:
            for field in struct["fields"]:
                out += f"    it%{field['name']} = {size if field['name'] == 'struct_size' else zero(field['type'])}\n"
        out += f"  end subroutine init_{name}\n\n"
    return out + "end module mpm\n"


def zero(kind):
    if kind["pointer"]:
        return "c_null_ptr"
    return "0.0_c_double" if kind["base"] == "double" else "0"


def layout(api):
    """A program that compares sizes and offsets, and takes the address of every function."""
    out = f"! {NOTE}\n! Whether types lie in memory as those of C, and whether the library has every function.\n"
    out += "program layout\n  use mpm\n  implicit none\n  integer :: wrong\n  type(c_ptr) :: pointer\n  wrong = 0\n"
    for struct in api["structs"]:
        out += f"  call check_{struct['name']}()\n"
    out += "  call check_functions()\n"
    out += "  if (wrong /= 0) error stop 1\n  print '(a)', \"layouts agree\"\n\ncontains\n\n"
    out += "  !> The one that holds for pointers of the size that they have here.\n"
    out += "  pure integer function of(wide, narrow)\n    integer, intent(in) :: wide, narrow\n"
    out += "    of = merge(wide, narrow, c_sizeof(pointer) == 8)\n  end function of\n\n"
    out += "  subroutine compare(what, is, should)\n    character(*), intent(in) :: what\n"
    out += "    integer(c_size_t), intent(in) :: is\n    integer, intent(in) :: should\n    if (is == should) return\n"
    out += "    print '(a, i0, a, i0)', what // \": \", is, \", in C \", should\n    wrong = wrong + 1\n  end subroutine compare\n\n"
    out += "  !> The distance of two addresses.\n"
    out += "  integer(c_size_t) function distance(from, to)\n    type(c_ptr), intent(in) :: from, to\n"
    out += "    distance = int(transfer(to, 0_c_intptr_t) - transfer(from, 0_c_intptr_t), c_size_t)\n  end function distance\n\n"
    for struct in api["structs"]:
        name = struct["name"]
        out += f"  subroutine check_{name}()\n    type({name}), target :: it\n"
        out += f"    call compare(\"{name}\", c_sizeof(it), of({struct['size64']}, {struct['size32']}))\n"
        for field in struct["fields"]:
            at = f"it%{field['name']}"
            out += statement(f"call compare(\"{name}%{field['name']}\", distance(c_loc(it), c_loc({at})), "
                             f"of({field['offset64']}, {field['offset32']}))", "    ")
        out += f"  end subroutine check_{name}\n\n"
    out += "  subroutine check_functions()\n"
    out += f"    type(c_funptr) :: all({len(api['functions'])})\n    integer :: k\n"
    for k, function in enumerate(api["functions"]):
        out += f"    all({k + 1}) = c_funloc({function['name']})\n"
    out += "    do k = 1, size(all)\n      if (.not. c_associated(all(k))) error stop \"a function is missing\"\n    end do\n"
    return out + "  end subroutine check_functions\n\nend program layout\n"


def files(api):
    check_tables(api)
    texts = {"fortran/mpm.f90": module(api), "fortran/layout.f90": layout(api)}
    for path, text in texts.items():
        long = [line for line in text.split("\n") if len(line) > 132]
        if long:
            raise SystemExit(f"fortran.py: {path}: a line is too long: {long[0]}")
    return texts
