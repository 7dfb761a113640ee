#!/usr/bin/env python3
"""What pages and comments point at exists: links of Markdown pages, cited keys, derivations and decisions, and the names
of docs/doors.md, which has all those of the doors.

A citation is [Key05] or [Key05, place], and its key stands in docs/references.bib.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\]\(([^)\s]+)\)")
CITATION = re.compile(r"\[([A-Z][A-Za-z]+[0-9]{2}[a-z]?)(?:,[^\]]*)?\](?!\()")
PAGE = re.compile(r"\b((?:derivations|decisions)/[\w-]+\.md)\b")


def files(*suffixes):
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\0")
    return [ROOT / name for name in sorted(set(names)) if name.endswith(suffixes) and (ROOT / name).exists()]


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


def names_of_doors():
    """The public names of each door, by the column of docs/doors.md."""
    headers = "\n".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "include/snug").glob("*.h")))
    # A declaration may begin in one line and have its name in the next one.
    functions = re.findall(r"^(?:\[\[nodiscard\]\] )?SNUG_API (?!friend)[^;({]*?(\w+)\(", headers, re.MULTILINE)
    classes = re.findall(r"^class SNUG_API (\w+)", headers, re.MULTILINE)
    commands = [path.stem for path in (ROOT / "docs/command").glob("*.md")]
    exported = re.search(r"__all__ = \[(.*?)\]", text_of("python/snug/__init__.py"), re.DOTALL).group(1)
    surface = re.search(r"^class _Tagged:.*?^class _Truth", text_of("python/snug/_snug.pyi"), re.MULTILINE | re.DOTALL).group(0)
    methods = re.findall(r"(?<!@property\n)    def ([a-z]\w*)\(", surface)
    python = re.findall(r'"([A-Za-z]\w*)"', exported) + [f"Surface.{name}" for name in methods]
    types = text_of("web/package/snug.d.ts")
    javascript = []
    for interface, before in (("Surface", "Surface."), ("Robot", "Robot."), ("SnugModule", "")):
        body = re.search(rf"^export interface {interface} {{(.*?)^}}", types, re.MULTILINE | re.DOTALL).group(1)
        javascript += [before + name for name in re.findall(r"^  ([a-z]\w*)\(", body, re.MULTILINE)]
    return {"C++": functions + classes, "command": commands, "Python": python, "JavaScript": javascript}


def faults_of_doors(page, doors):
    """Each name of a door stands in its column, or in its paragraph; what stands in a column is there."""
    table, _, rest = page.partition("Beside questions:")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines() if line.startswith("|")]
    faults = []
    for column, (door, names) in enumerate(doors.items(), 1):
        told = set()
        for row in rows[2:]:
            cell = row[column]
            words = re.findall(r"`([^`]+)`", cell)
            if not cell or not (words or cell.startswith("no: ") or door == "command"):
                faults.append(f"docs/doors.md: {row[0]}: {door} has neither a name nor a reason")
            if not cell.startswith("no: "):
                told.update(words)
        beside = re.search(rf"^- {re.escape(door)}: (.*?)(?=^- |\Z)", rest, re.MULTILINE | re.DOTALL)
        told_beside = set(re.findall(r"`([^`]+)`", beside.group(1))) if beside else set()
        faults += [f"docs/doors.md: {door} has {name}, which stands nowhere" for name in sorted(set(names) - told - told_beside)]
        # Options stand for themselves.
        faults += [f"docs/doors.md: {door} has no {name}" for name in sorted(told - set(names))
                   if re.fullmatch(r"[\w.]+", name) and not name.startswith("CollideOptions.")]
    return faults


def self_test():
    """Spoils the page of the doors."""
    page, doors = text_of("docs/doors.md"), names_of_doors()
    spoiled = (("`Surface.self_contact`", "`Surface.selfcontact`"), ("| `hull` | `hull` |", "| `hull` | |"), ("`textAtMost` and ", ""),
               ("| no: of Python alone |", "| |"), ("`Workspace` keeps", "This keeps"))
    missed = [old for old, new in spoiled if old not in page or not faults_of_doors(page.replace(old, new), doors)]
    for old in missed:
        print(f"docs/doors.md without {old} is taken", file=sys.stderr)
    print(f"check_docs: {'self-test failed' if missed else f'self-test passed, {len(spoiled)} faults found'}")
    return 1 if missed else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    keys = re.findall(r"^@\w+\{([^,\s]+),", (ROOT / "docs/references.bib").read_text(encoding="utf-8"), re.MULTILINE)
    faults = [f"docs/references.bib: two entries {key}" for key in sorted(set(keys)) if keys.count(key) > 1]
    for path in files(".md", ".h", ".cpp", ".py", ".cmake", "CMakeLists.txt"):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{path.relative_to(ROOT)}:{number}"
            faults += [f"{where}: [{key}] is not in docs/references.bib"
                       for key in CITATION.findall(line) if key not in keys and path.name != "check_docs.py"]
            faults += [f"{where}: docs/{page} does not exist"
                       for page in PAGE.findall(line) if not (ROOT / "docs" / page).exists()]
            if path.suffix == ".md":
                faults += [f"{where}: {link} does not exist" for link in LINK.findall(line)
                           if not re.match(r"https?:|mailto:|#", link)
                           and not (path.parent / link.split("#")[0]).exists()]
    faults += faults_of_doors(text_of("docs/doors.md"), names_of_doors())
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"check_docs: {f'{len(faults)} faults' if faults else 'passed'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
