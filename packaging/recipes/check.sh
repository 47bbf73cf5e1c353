#!/usr/bin/env bash
# Whether the recipes parse, say the version of the Makefile, and name options, files and targets that there are.
set -euo pipefail
cd "$(dirname "$0")/../.."
recipes=packaging/recipes
version=$(sed -n 's/^VERSION := //p' Makefile)
python3 - "$version" <<'PYTHON'
import ast, json, pathlib, re, sys
recipes = pathlib.Path("packaging/recipes")
for path in recipes.rglob("*.py"):
    ast.parse(path.read_text(), str(path))
port = json.loads((recipes / "vcpkg/libmpm/vcpkg.json").read_text())
assert port["version"] == sys.argv[1], port["version"]
assert f"libmpm/{sys.argv[1]}" in (recipes / "README.md").read_text(), "README.md has another version"
conan = (recipes / "conan/conanfile.py").read_text()
for pattern in re.search(r"for pattern in \((.*?)\):\n\s+copy\(self, pattern, ROOT", conan, re.S).group(1).split(","):
    name = ast.literal_eval(pattern.strip())
    assert list(pathlib.Path().glob(name)), f"conanfile.py copies {name}, which is not there"
cmake = pathlib.Path("CMakeLists.txt").read_text()
for path in recipes.rglob("*"):
    if path.is_file():
        for name in re.findall(r"\bMPM_[A-Z_]+\b", path.read_text()):
            assert f"option({name} " in cmake, f"{path}: CMakeLists.txt has no option {name}"
PYTHON
if command -v ruby > /dev/null; then ruby -c $recipes/homebrew/libmpm.rb > /dev/null; fi
echo "recipes of Conan, vcpkg, Spack and Homebrew: they parse and fit version $version"
