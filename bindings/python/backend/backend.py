"""Builds the wheel with a C compiler and nothing from the network: the extensions in C, and the shared library beside them.

The library is the one of the sources around this folder, made by `make` where it is not there yet; MPM_LIBRARY names
another to be taken along, and MPM_BUNDLE=0 takes none: the package then loads the one that is installed.
"""
import base64
import hashlib
import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TOP = os.path.dirname(os.path.dirname(HERE))


def _project():
    with open(f"{HERE}/pyproject.toml", "rb") as file:
        return tomllib.load(file)["project"]


def _tag():
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"cp311-abi3-{platform}"  # from 3.11 on buffers are part of the stable interface


def compile_extensions(folder):
    """Compiles what of the package is C into a folder; returns the paths."""
    made = []
    compiler = shlex.split(os.environ.get("CC") or "cc")
    flags = [one for name, default in (("CFLAGS", "-O2"), ("CPPFLAGS", ""), ("LDFLAGS", ""))
             for one in shlex.split(os.environ.get(name, default))]
    link = ["-undefined", "dynamic_lookup"] if sys.platform == "darwin" else []
    for source in sorted(one for one in os.listdir(f"{HERE}/src/mpm") if one.endswith(".c")):
        made.append(f"{folder}/{source[:-2]}.abi3.so")
        subprocess.run(compiler + flags + ["-fPIC", "-shared"] + link
                       + ["-I" + sysconfig.get_path("include"), f"{HERE}/src/mpm/{source}", "-o", made[-1]], check=True)
    return made


def _library():
    if os.environ.get("MPM_BUNDLE") == "0":
        return None
    path = os.environ.get("MPM_LIBRARY") or f"{TOP}/build/libmpm.so.0"
    if not os.path.exists(path):
        subprocess.run(["make", "-C", TOP, "all"], check=True, stdout=sys.stderr)
    return os.path.realpath(path)


def _metadata():
    project = _project()
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}",
             "Description-Content-Type: text/markdown"]
    lines += [f"Requires-Dist: {one}" for one in project["dependencies"]]
    for extra, needs in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}"] + [f"Requires-Dist: {one}; extra == '{extra}'" for one in needs]
    with open(f"{HERE}/{project['readme']}", encoding="utf-8") as file:
        return "\n".join(lines) + "\n\n" + file.read()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project, tag = _project(), _tag()
    info = f"{project['name']}-{project['version']}.dist-info"
    name = f"{project['name']}-{project['version']}-{tag}.whl"
    records = []
    with tempfile.TemporaryDirectory() as scratch, zipfile.ZipFile(f"{wheel_directory}/{name}", "w",
                                                                   zipfile.ZIP_DEFLATED) as wheel:

        def add(path, content):
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            records.append(f"{path},sha256={digest},{len(content)}")
            wheel.writestr(path, content)

        def add_file(path, source):
            with open(source, "rb") as file:
                add(path, file.read())

        for one in sorted(os.listdir(f"{HERE}/src/mpm")):
            if one.endswith(".py"):
                add_file(f"mpm/{one}", f"{HERE}/src/mpm/{one}")
        for extension in compile_extensions(scratch):
            add_file(f"mpm/{os.path.basename(extension)}", extension)
        library = _library()
        if library:
            add_file("mpm/libmpm.so.0", library)
        add(f"{info}/METADATA", _metadata().encode())
        add(f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: libmpm\nRoot-Is-Purelib: false\nTag: {tag}\n".encode())
        if os.path.exists(f"{TOP}/LICENSE"):
            add_file(f"{info}/LICENSE", f"{TOP}/LICENSE")
        records.append(f"{info}/RECORD,,")
        wheel.writestr(f"{info}/RECORD", "\n".join(records) + "\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("the package is built from the sources of libmpm, of which this folder is a part: git archive has all")


def install(folder):
    """Copies the package into a folder, with the extensions and without the library: for packages of a distribution."""
    os.makedirs(f"{folder}/mpm", exist_ok=True)
    for one in sorted(os.listdir(f"{HERE}/src/mpm")):
        if one.endswith(".py"):
            shutil.copy(f"{HERE}/src/mpm/{one}", f"{folder}/mpm/{one}")
    compile_extensions(f"{folder}/mpm")
