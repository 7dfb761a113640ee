#!/usr/bin/env python3
"""What pages and comments point at exists: links of Markdown pages, cited keys, derivations and decisions.

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


def main():
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
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"check_docs: {f'{len(faults)} faults' if faults else 'passed'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
