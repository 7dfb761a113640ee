"""Lays out what MkDocs reads: stage.py OUTPUT SOURCES DOXYGEN-XML.

README.md, CONTRIBUTING.md and CHANGELOG.md become pages beside those of docs/, and so do notebooks, with their outputs where `make notebooks` made
them; files of the repository that pages link to become pages of their text, below files/, and folders lists of these. Links are changed
accordingly; those that lead nowhere are left for check.py to find. A picture with a twin for dark pages (x.dark.png) stands beside it.
"""

import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import python_reference
import reference

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"(?<=\]\()([^)\s#]+)(?=[)#])")
LANGUAGE = {".h": "cpp", ".cpp": "cpp", ".ts": "ts", ".mjs": "js", ".py": "python", ".json": "json", ".cmake": "cmake"}
LONGEST = 100_000
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s#]+\.png)\)")
PICTURES = re.compile(r"(!\[[^\]]*\]\([^)\s#]+\.png\))")

MARKER = re.compile(r"( {0,3})((?:[-*+]|[0-9]{1,9}[.)]) +)(?=\S)")
FENCE = re.compile(r" *(```|~~~)")
CODE = re.compile(r"`[^`]*`")


def python_markdown(text):
    """GitHub's Markdown as Python's: what is inside of a list item is indented by four, lists come after a blank line, and bars
    in the code of tables stand for themselves."""
    lines, inside, fenced, previous, spread = [], [], False, "", False
    for line in text.split("\n"):
        indent = len(line) - len(line.lstrip())
        if not line.strip():
            lines.append(line)
            previous, spread = line, True
            continue
        rest = line[inside[-1]:] if inside and indent >= inside[-1] else line
        if not fenced:
            depth = len(inside)
            while inside and indent < inside[-1] and (not previous.strip() or MARKER.match(line, inside[-2] if len(inside) > 1 else 0)):
                inside.pop()
            own = inside[-1] if inside else 0
            rest = line[own:] if indent >= own else line.lstrip()
            marker, nested = MARKER.match(rest), len(inside) >= depth
            if marker and not (nested and previous.strip() and marker[2][0].isdigit() and marker[2][:-1].rstrip(".) ") != "1"):  # which ends no paragraph
                if previous.strip() and (nested or spread):
                    lines.append("")
                spread = nested and depth > 0
                prefix = "    " * len(inside)
                inside.append(own + marker.end())
                lines.append(prefix + rest.lstrip())
                previous = line
                continue
            if rest.startswith("|"):
                rest = CODE.sub(lambda code: code[0].replace("\\|", "|"), rest)
        if FENCE.match(rest):
            fenced = not fenced
        lines.append("    " * len(inside) + rest)
        previous = line
    return "\n".join(lines)


class Site:
    def __init__(self, output, sources):
        self.output, self.sources = output, sources
        names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                               capture_output=True, text=True).stdout.split("\0")
        self.files = sorted(pathlib.Path(name) for name in names if name and (ROOT / name).is_file())
        self.pages = {pathlib.Path("README.md"): pathlib.Path("index.md"), pathlib.Path("CHANGELOG.md"): pathlib.Path("changelog.md"),
                      pathlib.Path("CONTRIBUTING.md"): pathlib.Path("contributing.md"),
                      pathlib.Path("include/snug"): pathlib.Path("reference/index.md")}
        for path in self.files:
            if path.parts[0] == "docs":
                self.pages[path] = path.relative_to("docs")
            elif path.parts[0] in ("include", "adapters") and path.suffix == ".h" and path.name != "snug.h":
                self.pages[path] = pathlib.Path("reference", path.stem + ".md")
            elif path.parts[0] == "notebooks" and path.suffix == ".ipynb":
                self.pages[path] = path.with_suffix(".md")
        for folder in ("decisions", "derivations"):
            self.pages[pathlib.Path("docs", folder)] = pathlib.Path(folder, "README.md")

    def write(self, page, text):
        """A page for MkDocs, and what it is made of for check.py."""
        for folder, written in ((self.output, python_markdown(text)), (self.sources, text)):
            path = folder / page
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(written, encoding="utf-8")

    def page_of(self, path):
        """The page about a file or folder of the repository; made if there is none yet."""
        if path in self.pages:
            return self.pages[path]
        if path.name == "README.md":
            return self.page_of(path.parent)
        inside = [file for file in self.files if path in file.parents]
        if inside:
            self.pages[path] = page = pathlib.Path("files", path, "index.md")
            self.write(page, self.folder(path, page, inside))
        elif path in self.files:
            if path.suffix == ".md":
                self.pages[path] = page = pathlib.Path("files", path)
                self.write(page, self.moved((ROOT / path).read_text(encoding="utf-8"), path, page))
            else:
                self.pages[path] = page = pathlib.Path("files", str(path) + ".md")
                self.write(page, self.source(path))
        return self.pages.get(path)

    def folder(self, path, page, inside):
        readme = path / "README.md"
        if readme in self.files:
            text = self.moved((ROOT / readme).read_text(encoding="utf-8"), readme, page)
        else:
            text = f"# {path}\n"
        shown = [file for file in inside if file != readme and file.suffix not in (".png", ".svg")
                 and not any(part.startswith(".") for part in file.parts)]
        lines = [f"- [{file.relative_to(path)}]({os.path.relpath(self.page_of(file), page.parent)})"
                 for file in shown]
        return text + "\n## Files\n\n" + "\n".join(lines) + "\n"

    def source(self, path):
        text = (ROOT / path).read_text(encoding="utf-8", errors="replace")
        if len(text) > LONGEST:
            text = text[:LONGEST].rsplit("\n", 1)[0] + "\n...\n"
        fence = "~~~~~~"
        return f"# {path.name}\n\n`{path}`\n\n{fence}{LANGUAGE.get(path.suffix, 'text')}\n{text}\n{fence}\n"

    def moved(self, text, path, page):
        """The text of a file of the repository with links that hold on its page."""
        def link(match):
            target = match[1]
            if re.match(r"https?:|mailto:", target):
                return target
            wanted = pathlib.Path(os.path.normpath(path.parent / target))
            made = self.page_of(wanted)
            return target if made is None else os.path.relpath(made, page.parent)

        def both(match):
            bright, dark = LINK.sub(link, match[0]), pathlib.Path(os.path.normpath(path.parent / match[1]))
            if dark.with_suffix(".dark.png") not in self.files:
                return bright
            return bright[:-1] + "#only-light)" + bright[:-5] + ".dark.png#only-dark)"
        return "".join(both(part) if (part := PICTURE.fullmatch(piece)) else LINK.sub(link, piece) for piece in PICTURES.split(text))

    def notebook(self, path, page):
        """Its cells one after the other, with what they print and show."""
        made = ROOT / "build" / path
        lines = []
        for number, cell in enumerate(json.loads((made if made.exists() else ROOT / path).read_text(encoding="utf-8"))["cells"]):
            source = "".join(cell["source"])
            if cell["cell_type"] == "markdown":
                lines += [self.moved(source, path, page), ""]
                continue
            lines += ["```python", source, "```", ""]
            for k, output in enumerate(cell.get("outputs", [])):
                data = output.get("data", {})
                if "image/png" in data:
                    name = f"{page.stem}_{number}_{k}.png"
                    (self.output / page).parent.mkdir(parents=True, exist_ok=True)
                    (self.output / page).with_name(name).write_bytes(base64.b64decode(data["image/png"]))
                    lines += [f"![What this cell shows]({name})", ""]
                elif text := "".join(output.get("text", data.get("text/plain", []))).rstrip():
                    lines += ["```text", text, "```", ""]
        return "\n".join(lines)

    def run(self, xml):
        headers = [path for path in self.files if self.pages.get(path, pathlib.Path()).parts[:1] == ("reference",)]
        for name, text in reference.pages(xml, headers):
            self.write(pathlib.Path("reference", name), text)
        for module in (ROOT / "build/release/python", ROOT / "build/python/python"):
            if any((module / "snug").glob("_snug*.so")):
                for name, text in python_reference.pages(module):
                    self.write(pathlib.Path("python", name), text)
                break
        else:
            print("build_site: no reference for Python: make python first", file=sys.stderr)
        for path, page in list(self.pages.items()):
            if path.suffix == ".ipynb":
                self.write(page, self.notebook(path, page))
            elif path.suffix == ".md":
                self.write(page, self.moved((ROOT / path).read_text(encoding="utf-8"), path, page))
            elif path.parts[0] == "docs" and path.is_file():
                (self.output / page).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(ROOT / path, self.output / page)
        live = ROOT / "build/web/snug.html"  # which make page builds
        if live.exists():
            shutil.copyfile(live, self.output / "live.html")
        shutil.copytree(ROOT / "packaging/site/assets", self.output / "assets", dirs_exist_ok=True)


if __name__ == "__main__":
    Site(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])).run(pathlib.Path(sys.argv[3]))
