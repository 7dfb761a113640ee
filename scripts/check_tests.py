#!/usr/bin/env python3
"""Holds tests to the sources that they prove.

A source src/snug/ROOM/NAME.h or .cpp, or src/support/NAME, is proved by tests/ROOM/NAME_test.cpp, or by the tests that its row of the table in
tests/README.md names. Checked: each source has one or the other and not both; rows name sources and tests that are there; each
test of a room has the name of a source or stands in that file; each test is listed in the CMakeLists.txt of its folder.
`--self-test` plants each fault and expects it found.
"""

import argparse
import pathlib
import re
import sys
import tempfile

TABLE = "tests/README.md"
ROW = re.compile(r"^\| `([a-z0-9_/-]+)` \|([^|]*)\|", re.MULTILINE)
TEST = re.compile(r"`([a-z0-9_/-]+_test\.cpp)`")


def check(root):
    tests = root / "tests"
    text = (root / TABLE).read_text(encoding="utf-8") if (root / TABLE).exists() else ""
    rows = {m[1]: TEST.findall(m[2]) for m in ROW.finditer(text)}
    stems = {str(p.relative_to(root / source).with_suffix("")): f"{source}/"
             for source in ("src/snug", "src") for p in (root / source).rglob("*")
             if p.suffix in (".h", ".cpp") and (source == "src/snug" or "snug" not in p.relative_to(root).parts)}
    names = {str(p.relative_to(tests)) for p in tests.rglob("*_test.cpp")}
    rooms = {stem.split("/")[0] for stem in stems}
    faults = []
    for stem in sorted(stems):
        own = stem + "_test.cpp"
        if own not in names and stem not in rows:
            faults.append(f"{stems[stem]}{stem}: no tests/{own}, and no row in {TABLE} that says which test proves it")
        if own in names and stem in rows:
            faults.append(f"{TABLE}: {stem} has tests/{own}; take its row out")
    for stem, proofs in rows.items():
        if stem not in stems:
            faults.append(f"{TABLE}: there is no source {stem}")
        if not proofs:
            faults.append(f"{TABLE}: the row of {stem} names no test")
    for name in sorted(set(TEST.findall(text)) - names):
        faults.append(f"{TABLE}: there is no tests/{name}")
    for name in sorted(names):
        folder, file = name.rsplit("/", 1)
        if folder in rooms and name[: -len("_test.cpp")] not in stems and f"`{name}`" not in text:
            faults.append(f"tests/{name}: no source of its name, and {TABLE} does not say what it proves")
        cmake = tests / folder / "CMakeLists.txt"
        if not cmake.exists() or not re.search(rf"(?<!\w){file}", cmake.read_text(encoding="utf-8")):
            faults.append(f"tests/{name}: tests/{folder}/CMakeLists.txt does not list it, so that it never runs")
    return faults


def self_test():
    good = {
        "src/snug/mesh/a.h": "",
        "src/snug/mesh/b.h": "",
        "src/snug/mesh/b.cpp": "",
        "tests/mesh/a_test.cpp": "",
        "tests/mesh/all_test.cpp": "",
        "tests/mesh/CMakeLists.txt": "snug_test(mesh_test SOURCES a_test.cpp all_test.cpp)",
        TABLE: "| `mesh/b` | `mesh/all_test.cpp` |\n",
    }
    table = good[TABLE]
    planted = [
        ({"src/snug/mesh/c.cpp": ""}, "src/snug/mesh/c: no tests/mesh/c_test.cpp"),
        ({TABLE: table + "| `mesh/a` | `mesh/all_test.cpp` |\n"}, "take its row out"),
        ({TABLE: table + "| `mesh/gone` | `mesh/all_test.cpp` |\n"}, "there is no source mesh/gone"),
        ({TABLE: "| `mesh/b` | by hand |\n`mesh/all_test.cpp`"}, "the row of mesh/b names no test"),
        ({TABLE: table + "`mesh/gone_test.cpp`"}, "there is no tests/mesh/gone_test.cpp"),
        ({"tests/mesh/more_test.cpp": "", "tests/mesh/CMakeLists.txt": "a_test.cpp all_test.cpp more_test.cpp"},
         "tests/mesh/more_test.cpp: no source of its name"),
        ({"tests/mesh/CMakeLists.txt": "a_test.cpp small_test.cpp"}, "does not list it"),
    ]
    failed = 0
    for files, expected in [({}, None)] + planted:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in (good | files).items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            faults = check(root)
            if (expected is None and faults) or (expected and not any(expected in f for f in faults)):
                failed += 1
                print(f"check_tests: self-test: expected {expected}, found {faults}", file=sys.stderr)
    if not failed:
        print(f"check_tests: self-test passed, {len(planted)} faults found")
    return failed == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--self-test", action="store_true")
    if parser.parse_args().self_test:
        return 0 if self_test() else 1
    faults = check(pathlib.Path(__file__).resolve().parent.parent)
    for fault in faults:
        print(f"check_tests: {fault}", file=sys.stderr)
    print(f"check_tests: {'failed' if faults else 'passed'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
