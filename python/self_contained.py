"""Makes an extension module for Linux independent of libraries that other systems may lack, as auditwheel does.

Libraries beyond those that every Linux has are put beside it under names of their own, so that no other package's copy is taken
for them, and are found there by $ORIGIN. What all of them ask of the C and C++ libraries gives the tag of the wheel (PEP 600).
"""

import pathlib
import re
import shutil
import subprocess

# The C++ library of GCC 12 came with systems of glibc 2.35.
EVERYWHERE = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1"}
LOWEST_GLIBC = (2, 35)
HIGHEST_GLIBCXX = (3, 4, 30)


def self_contained(extension, folder):
    """Copies of the extension and of the libraries that it needs, in `folder`, and the tag manylinux_2_N, or None.

    None: the tools are missing, or the module needs a newer C++ library; then the wheel is for systems like this one.
    """
    if not all(shutil.which(tool) for tool in ("patchelf", "readelf", "ldd", "strip")):
        return [extension], None
    folder = pathlib.Path(folder)
    places = dict(re.findall(r"^\s*(\S+) => (/\S+)", _run("ldd", extension), re.MULTILINE))
    made, waiting = [], [(extension, extension.name)]
    while waiting:
        source, name = waiting.pop()
        copy = folder / name
        shutil.copyfile(source, copy)
        _run("strip", "--strip-unneeded", copy)
        _run("patchelf", "--set-rpath", "$ORIGIN", copy)
        if name != extension.name:
            _run("patchelf", "--set-soname", name, copy)
        for library in sorted(needed(copy) - EVERYWHERE):
            if library.startswith("ld-linux"):
                continue
            beside = _own_name(library)
            _run("patchelf", "--replace-needed", library, beside, copy)
            if not (folder / beside).exists() and (places[library], beside) not in waiting:
                waiting.append((places[library], beside))
        made.append(copy)
    return sorted(made), _tag(made)


def needed(file):
    return set(re.findall(r"\(NEEDED\)[^[]*\[([^]]+)\]", _run("readelf", "--wide", "--dynamic", file)))


def versions(file, name):
    """Those of the versions NAME_1.2.3 that a file asks for, as tuples."""
    asked = _run("readelf", "--wide", "--version-info", file)
    return {tuple(map(int, found.split("."))) for found in re.findall(rf"Name: {name}_([0-9.]+)", asked)}


def _own_name(library):
    stem, _, rest = library.partition(".so")
    return f"{stem}-snug.so{rest}"


def _tag(files):
    if any(version > HIGHEST_GLIBCXX for file in files for version in versions(file, "GLIBCXX")):
        return None
    major, minor = max([LOWEST_GLIBC, *(version[:2] for file in files for version in versions(file, "GLIBC"))])
    return f"manylinux_{major}_{minor}"


def _run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout
