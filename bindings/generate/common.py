"""What the writers of several languages share."""
import re
import textwrap

NOTE = "Generated from the headers of libmpm by `make api`; not to be edited."


#: Structs that the library fills, once the caller has set struct_size; a batch of the material driver is one that both fill.
OUTPUTS = ("mpm_view", "mpm_operator_info", "mpm_step_info", "mpm_profile", "mpm_contact_info", "mpm_adaption_info", "mpm_heat_info",
           "mpm_parallel_info", "mpm_material_batch")


def is_descriptor(struct):
    """Whether a struct has the _init function that fills in defaults."""
    return struct["name"].endswith("_desc")


def constants(api):
    """All constants in order, as (group, constant)."""
    for group in api["constants"]:
        for value in group["values"]:
            yield group, value


def wrapped(text, width, first="", rest=None):
    """Fills paragraphs to a width; lines of tables and lists stay lines."""
    rest = first if rest is None else rest
    out = []
    for line in text.split("\n"):
        if line.startswith("|") or not line:
            out.append((first if not out else rest) + line)
            continue
        hanging = rest + ("  " if line.startswith("- ") else "")
        out += textwrap.wrap(line, width, initial_indent=first if not out else rest, subsequent_indent=hanging,
                             break_long_words=False, break_on_hyphens=False)
    return "\n".join(line.rstrip() for line in out)


def short(name):
    """A name without the library's prefix."""
    return re.sub(r"^(mpm|MPM)_", "", name)


def words(name):
    """mpm_particle_batch -> ParticleBatch."""
    return "".join(part.capitalize() for part in short(name).split("_"))


def first_sentence(text):
    """The first sentence of a comment, without the lines that only doxygen reads."""
    lines = [line for line in text.split("\n") if not line.startswith("@")]
    text = " ".join(line for line in lines if line).strip()
    found = re.match(r"(.*?\.)(?= [A-Z]| \d+ \(default| - |$)", text)
    sentence = found[1] if found else text
    return sentence if sentence.endswith(".") else sentence.rstrip(":") + "."
