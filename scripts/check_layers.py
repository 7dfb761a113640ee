#!/usr/bin/env python3
"""Holds the rooms of src/snug, and src/support before them, to their one-way order, and says where they break it.

Checked: each #include <snug/...> against the order below, that it exists, that snug's headers are included in that form
only, #pragma once, that public headers include public ones and the C++ standard library alone, that src/snug/CMakeLists.txt
lists every source, that no room includes a library it should not know, that no two types of a namespace have one name, and that the browser's library has what is used of std::ranges.
`--self-test` plants each fault and expects it found.
"""

import argparse
import pathlib
import re
import sys
import tempfile

# A folder includes itself and folders before it, but for the exceptions. `support` is src/support, included as <support/...>:
# what the library and its programs share.
ORDER = ["support", "geometry", "mesh", "scheme", "patch", "bounds", "shape", "spline", "bvh", "surface", "search", "certificate", "query", "independence",
         "io", "caster"]
SHARED = ORDER[0]
EXCEPTIONS = {
    "bvh": {"support", "geometry"},  # knows sets and ids, no surfaces
    "certificate": {"support", "geometry", "mesh", "scheme"},  # of public data and the schemes: nothing that a search found
    "io": {"support", "geometry", "mesh", "scheme"},  # files name schemes; knows no surfaces
}
# Rooms with a library of their own, which is not installed: outside src only files below these folders include them, and their own
# CMakeLists.txt lists their sources.
SEPARATE = {"independence": ("apps/research/", "tests/")}
# What a layer may include besides the C++ standard library and snug; all others: nothing.
LIBRARIES = {
    "geometry": ("hwy/",),
    "patch": ("hwy/",),
    "bounds": ("hwy/",),
    "bvh": ("hwy/",),
    "shape": ("hwy/",),
    "independence": ("flint/", "gmpxx.h"),
    "io": ("nlohmann/", "zlib.h", "assimp/"),
}
POSIX = ("fcntl.h", "unistd.h", "sys/", "io.h", "malloc.h", "windows.h")
# Folders outside src/snug, and the layers they may include: those that must not lean on what they are there to check,
# adapters, which is installed and so includes what is installed, and the renderer, a user like others.
INDEPENDENT = {"tests/oracle": set(), "checker": {"support", "geometry"}, "adapters": set(ORDER) - set(SEPARATE),
               "apps/snug/picture": {SHARED}}
# Folders whose files use the library like any other program: they include public headers and src/support alone.
USERS = ("apps/snug", "python", "web", "examples")
# Tests of questions, and what they share, ask as users do: no private headers of `query` but in the files that look inside.
QUESTIONS = ("tests/query", "tests/sound", "tests/testing")
WHITE_BOX = {"tests/query/hull_problems_test.cpp", "tests/query/local_tessellation_test.cpp", "tests/query/local_tolerances_test.cpp", "tests/query/moving_body_test.cpp",
             "tests/query/pair_queries_test.cpp",
             "tests/query/piece_quadratic_test.cpp", "tests/query/plane_cover_test.cpp", "tests/query/swept_motion_test.cpp", "tests/query/trajectory_test.cpp",
             "tests/query/triangle_complex_test.cpp", "tests/sound/lazy_trees_test.cpp", "tests/sound/schemes_collide_test.cpp",
             "tests/sound/self_near_test.cpp"}
# Headers of this folder are included as <snug/adapters/...>; nothing of src/snug includes them.
ADAPTERS = "adapters"
# Folders whose headers are checked for #pragma once and whose includes of snug must exist.
FOLDERS = ["include", "src", "apps", "experiments", "adapters", "tests", "examples", "bench", "tablegen", "checker"]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def allowed(layer):
    return EXCEPTIONS.get(layer, set(ORDER[: ORDER.index(layer)]) - set(SEPARATE)) | {layer}


def cpp_files(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp"))


def includes(path):
    """Triples (line, quoted?, name)."""
    text = path.read_text(encoding="utf-8")
    return [(text.count("\n", 0, m.start()) + 1, m[1] == '"', m[2]) for m in INCLUDE.finditer(text)]


def layer_of(name):
    """The layer of an include <snug/layer/...> or <support/...>; None for other includes."""
    parts = name.split("/")
    return SHARED if parts[0] == SHARED else parts[1] if parts[0] == "snug" and len(parts) > 2 else None


def public(name):
    """Is an include <snug/name.h> of a public header?"""
    return name.startswith("snug/") and name.count("/") == 1


def listed(cmake, function):
    """Words in the call of a function in a CMakeLists.txt."""
    text = re.sub(r"#.*", "", cmake.read_text(encoding="utf-8")) if cmake.exists() else ""
    call = re.search(rf"\b{function}\s*\(([^)]*)\)", text)
    return set(call[1].split()) if call else set()


def check_layer(root, layer):
    """Faults of src/snug/<layer>."""
    folder, faults = root / "src" / (SHARED if layer == SHARED else f"snug/{layer}"), []
    for path in cpp_files(folder):
        where = path.relative_to(root)
        for line, quoted, name in includes(path):
            target = layer_of(name)
            if quoted:
                faults.append(f'{where}:{line}: "{name}": snug\'s headers are included as <snug/...>')
            elif target:
                if target not in allowed(layer):
                    faults.append(f"{where}:{line}: {layer} may not include {target} (<{name}>)")
            elif not public(name) and ("." in name or "/" in name) and not name.startswith(POSIX + LIBRARIES.get(layer, ())):
                faults.append(f"{where}:{line}: {layer} may not include <{name}>")

    present = {str(p.relative_to(folder)) for p in cpp_files(folder) if p.suffix == ".cpp"}
    if layer in SEPARATE:
        cmake, names = folder / "CMakeLists.txt", listed(folder / "CMakeLists.txt", "add_library")
    else:
        cmake, present = root / "src/snug/CMakeLists.txt", {f"../{layer}/{name}" if layer == SHARED else f"{layer}/{name}" for name in present}
        names = listed(cmake, "snug_library")
    return faults + [f"{cmake.relative_to(root)}: lacks {name}" for name in sorted(present - names)]


def check_public(root):
    """Faults of include/snug."""
    return [f"{path.relative_to(root)}:{line}: public headers may not include {name}"
            for path in cpp_files(root / "include/snug")
            for line, quoted, name in includes(path)
            if quoted or not (public(name) or re.fullmatch(r"[a-z_]+", name))]


def check_browser(root):
    """Algorithms of std::ranges that the browser's old library lacks: it has those of its shim alone."""
    shim = root / "web/shims/standard_library.h"
    known = set(re.findall(r"^(?:auto|bool|void) (\w+)\(", shim.read_text(encoding="utf-8"), re.MULTILINE)) if shim.exists() else set()
    faults = []
    for folder in ("include", "src", "web"):
        for path in cpp_files(root / folder):
            if path == shim or any(path.is_relative_to(root / "src/snug" / room) for room in SEPARATE):
                continue
            text = path.read_text(encoding="utf-8")
            faults += [f"{path.relative_to(root)}:{text.count(chr(10), 0, m.start()) + 1}: std::ranges::{m[1]} is not in {shim.relative_to(root)}"
                       for m in re.finditer(r"std::ranges::(\w+)\(", text) if m[1] not in known]
    return faults


def check_types(root):
    """Types of one name in one namespace: where the linker keeps one of two vectors, it handles both."""
    seen, faults = {}, []
    for path in [path for folder in ("include", "src") for path in cpp_files(root / folder)]:
        namespaces = []
        for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
            if opened := re.match(r"namespace\s*([\w:]*) \{$", line):
                namespaces.append(opened[1] or f"{path}")
            elif line.startswith("}  // namespace"):
                namespaces.pop()
            elif (found := re.match(r"(?:struct|class|enum class) (?:SNUG_API )?(\w+)(?: final)?(?: :[^:].*)? \{", line)) and namespaces:
                where = f"{path.relative_to(root)}:{number}"
                first = seen.setdefault(("::".join(namespaces), found[1]), where)
                if first != where:
                    faults.append(f"{where}: {found[1]} is a type of {first}, too")
    return faults


def check_tree(root):
    """Faults of a whole checkout, as lines "file:line: what"."""
    faults = check_public(root) + check_browser(root) + check_types(root)
    for folder in [root / "src" / SHARED, *sorted((root / "src/snug").iterdir())]:
        if folder.is_dir() and cpp_files(folder):
            if folder.name in ORDER:
                faults += check_layer(root, folder.name)
            else:
                faults.append(f"src/snug/{folder.name}: not a room of scripts/check_layers.py")
    for name in FOLDERS:
        for path in cpp_files(root / name):
            where = path.relative_to(root)
            once = re.search(r"^#pragma once$", path.read_text(encoding="utf-8"), re.MULTILINE)
            # Headers named -inl.h are read again for each instruction set.
            if path.suffix == ".h" and not once and not path.stem.endswith("-inl"):
                faults.append(f"{where}:1: no #pragma once")
            for line, _, include in includes(path):
                source = (f"include/{include}" if public(include) else
                          include.removeprefix("snug/") if layer_of(include) == ADAPTERS else f"src/{include}")
                if include.startswith(("snug/", f"{SHARED}/")) and not (root / source).exists():
                    faults.append(f"{where}:{line}: <{include}> does not exist")
                if name != "src" and not str(where).startswith(SEPARATE.get(layer_of(include), "")):
                    faults.append(f"{where}:{line}: {where.parent} may not include {layer_of(include)}")
    for name, layers in INDEPENDENT.items():
        for path in cpp_files(root / name):
            if not path.stem.endswith("_test"):
                faults += [f"{path.relative_to(root)}:{line}: {name} may not include <{include}>"
                           for line, _, include in includes(path)
                           if (layer_of(include) and layer_of(include) not in layers | {name})
                           or (public(include) and not layers)]
    for name in USERS:
        for path in cpp_files(root / name):
            faults += [f"{path.relative_to(root)}:{line}: {name} includes public headers alone, not <{include}>"
                       for line, _, include in includes(path)
                       if layer_of(include) and layer_of(include) not in (SHARED, ADAPTERS)]
    for name in QUESTIONS:
        for path in cpp_files(root / name):
            where = path.relative_to(root)
            faults += [f"{where}:{line}: tests of questions ask through public headers, not <{include}>"
                       for line, _, include in includes(path)
                       if layer_of(include) == "query" and str(where) not in WHITE_BOX]
    return faults


GOOD_TREE = {
    "include/snug/p.h": "#pragma once\n#include <vector>\n",
    "include/snug/snug.h": "#pragma once\n#include <snug/p.h>\n",
    "src/snug/CMakeLists.txt": "snug_library(../support/a.cpp mesh/m.cpp  # and so on\n  query/q.cpp io/r.cpp)",
    "src/support/a.h": "#pragma once\n#include <vector>\n#include <snug/p.h>\n",
    "src/support/a.cpp": "#include <support/a.h>\n#include <thread>\n",
    "src/snug/mesh/m.h": "#pragma once\n#include <support/a.h>\n",
    "src/snug/mesh/m.cpp": "#include <snug/mesh/m.h>\nauto i = std::ranges::find(list, 1);\n",
    "web/shims/standard_library.h": "auto find(Range&& range, const T& value) {\n",
    "src/snug/query/q.cpp": "#include <snug/mesh/m.h>\n",
    "src/snug/query/q.h": "#pragma once\n",
    "tests/query/trajectory_test.cpp": "#include <snug/query/q.h>\n",
    "tests/sound/q_test.cpp": "#include <snug/p.h>\n#include <snug/mesh/m.h>\n",
    "src/snug/independence/CMakeLists.txt": "add_library(snug_independence STATIC k.cpp)",
    "src/snug/independence/k.h": "#pragma once\n",
    "src/snug/independence/k.cpp": "#include <snug/independence/k.h>\n#include <snug/mesh/m.h>\n",
    "apps/research/a.cpp": "#include <snug/independence/k.h>\n",
    "tests/independence/k_test.cpp": "#include <snug/independence/k.h>\n",
    "src/snug/io/r.h": "#pragma once\nnamespace snug {\nstruct R {\n};\n}  // namespace snug\n",
    "src/snug/io/r.cpp": "#include <support/a.h>\n#include <unistd.h>\n",
    "tests/oracle/o.h": "#pragma once\n#include <gmp.h>\n",
    "adapters/d.h": "#pragma once\n#include <dear.h>\n#include <snug/p.h>\n",
    "examples/e.cpp": "#include <snug/adapters/d.h>\n",
    "tests/oracle/o_test.cpp": "#include <support/a.h>\n",
}
# Each: a file put in the place of one above, and a part of the fault that must be reported.
BAD_FILES = [
    ("src/support/a.h", "#pragma once\n#include <snug/mesh/m.h>\n", "a.h:2: support may not include mesh"),
    ("src/snug/query/q.cpp", "#include <snug/mesh/m.h>\n#include <snug/io/r.h>\n", "query may not include io"),
    ("src/snug/io/r.cpp", "#include <support/a.h>\n#include <snug/query/q.h>\n", "io may not include query"),
    ("src/snug/bvh/t.cpp", "#include <snug/mesh/m.h>\n", "bvh may not include mesh"),
    ("src/snug/mesh/m.h", "#include <support/a.h>\n", "m.h:1: no #pragma once"),
    ("src/snug/mesh/m.cpp", '#include "m.h"\n', "included as <snug/...>"),
    ("src/snug/mesh/m.cpp", "#  include <CLI/CLI.hpp>\n", "mesh may not include <CLI/CLI.hpp>"),
    ("src/snug/mesh/m.cpp", "#include <gmp.h>\n", "mesh may not include <gmp.h>"),
    ("src/snug/mesh/m.cpp", "#include <hwy/highway.h>\n", "mesh may not include <hwy"),
    ("src/snug/query/q.cpp", "#include <nlohmann/json.hpp>\n", "query may not include <nlohmann"),
    ("src/snug/mesh/m.cpp", "#include <snug/mesh/gone.h>\n", "does not exist"),
    ("src/snug/mesh/m.cpp", "#include <snug/gone.h>\n", "does not exist"),
    ("src/snug/mesh/m.cpp", "\nstd::ranges::reverse(list);\n", "m.cpp:2: std::ranges::reverse is not in web/shims"),
    ("src/snug/mesh/n.cpp", "\n", "lacks mesh/n.cpp"),
    ("src/snug/independence/k.cpp", "#include <snug/io/r.h>\n", "independence may not include io"),
    ("src/snug/independence/l.cpp", "\n", "src/snug/independence/CMakeLists.txt: lacks l.cpp"),
    ("src/snug/caster/f.cpp", "#include <snug/independence/k.h>\n", "caster may not include independence"),
    ("examples/e.cpp", "#include <snug/independence/k.h>\n", "e.cpp:1: examples may not include independence"),
    ("apps/snug/a.cpp", "#include <snug/independence/k.h>\n", "a.cpp:1: apps/snug may not include independence"),
    ("adapters/d.h", "#pragma once\n#include <snug/independence/k.h>\n", "adapters may not include independence"),
    ("src/snug/extra/e.cpp", "\n", "src/snug/extra: not a room"),
    ("include/snug/p.h", "#pragma once\n#include <support/a.h>\n", "p.h:2: public headers may not include"),
    ("include/snug/p.h", "#pragma once\n#include <hwy/highway.h>\n", "p.h:2: public headers may not include"),
    ("include/snug/p.h", '#pragma once\n#include "snug/snug.h"\n', "p.h:2: public headers may not include"),
    ("include/snug/p.h", "#include <vector>\n", "p.h:1: no #pragma once"),
    ("tests/oracle/o.h", "#pragma once\n#include <support/a.h>\n", "tests/oracle may not include"),
    ("tests/oracle/o.h", "#pragma once\n#include <snug/p.h>\n", "tests/oracle may not include"),
    ("adapters/d.h", "#include <snug/p.h>\n", "d.h:1: no #pragma once"),
    ("adapters/d.h", "#pragma once\n#include <snug/picture/p.h>\n", "adapters may not include <snug/picture/p.h>"),
    ("apps/snug/picture/p.h", "#pragma once\n#include <snug/mesh/m.h>\n", "apps/snug/picture may not include <snug/mesh/m.h>"),
    ("examples/e.cpp", "#include <snug/adapters/gone.h>\n", "<snug/adapters/gone.h> does not exist"),
    ("apps/snug/b.cpp", "#include <snug/mesh/m.h>\n", "b.cpp:1: apps/snug includes public headers alone"),
    ("python/src/b.cpp", "#include <snug/mesh/m.h>\n", "b.cpp:1: python includes public headers alone"),
    ("tests/sound/q_test.cpp", "#include <snug/query/q.h>\n", "q_test.cpp:1: tests of questions ask through public"),
    ("tests/query/q_test.cpp", "#include <snug/query/q.h>\n", "q_test.cpp:1: tests of questions ask through public"),
    ("tests/testing/q.h", "#pragma once\n#include <snug/query/q.h>\n", "q.h:2: tests of questions ask through public"),
    ("src/snug/mesh/m.cpp", "#include <snug/adapters/d.h>\n", "mesh may not include adapters"),
    ("src/snug/mesh/m.cpp", "namespace snug {\nclass R {\n};\n}  // namespace snug\n", "R is a type of src/snug/"),
]


def self_test():
    def faults_of(tree):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in tree.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return check_tree(pathlib.Path(folder))

    wrong = [f"a tree without faults gives: {fault}" for fault in faults_of(GOOD_TREE)]
    for name, text, expected in BAD_FILES:
        if not any(expected in fault for fault in faults_of({**GOOD_TREE, name: text})):
            wrong.append(f"passed over in {name}: {expected}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--self-test", action="store_true", help="check that this check can fail")
    if parser.parse_args().self_test:
        faults, passed = self_test(), f"self test passed ({len(BAD_FILES)} faults planted and found)"
    else:
        faults, passed = check_tree(pathlib.Path(__file__).resolve().parent.parent), "passed"
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"check_layers: {f'{len(faults)} faults' if faults else passed}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
