"""Pages about the Python module: python_reference.py MODULE-FOLDER FOLDER writes them. Texts are the module's own, types those of its stubs."""

import ast
import inspect
import pathlib
import re
import sys

WIDEST = 100
TOPICS = {
    "questions": ("Questions", "Functions about two surfaces, and about files.",
                  ["read", "read_assembly", "urdf", "inspect", "collide", "distance", "contacts", "penetration", "clearance", "time_of_contact",
                   "deviation", "view"]),
    "surface": ("Surfaces and meshes", "What is asked.", ["Surface", "Mesh", "Trajectory", "Robot"]),
    "collision": ("Drop-ins for trimesh", "Names and arguments of trimesh's modules, with proved answers.", ["CollisionManager", "collision", "proximity"]),
    "errors": ("Errors and warnings", "", ["MeshError", "FileError", "PoseError", "UndecidedError", "MeshWarning"]),
}
ANSWERS = ("answers", "Answers", "Their members; of a function that was asked about many poses or points these are arrays.")


class Stubs:
    """Functions and classes of stubs and sources, by name; classes with the members of their bases."""

    def __init__(self, folder):
        self.nodes = {}
        for name in ("_snug.pyi", "_errors.py", "_view.py", "collision.py", "proximity.py"):
            for node in ast.parse((folder / name).read_text(encoding="utf-8")).body:
                if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                    self.nodes.setdefault(node.name, node)

    def members(self, name):
        node, found = self.nodes.get(name), {}
        if isinstance(node, ast.ClassDef):
            for base in node.bases:
                found.update(self.members(ast.unparse(base)))
            found.update({child.name: child for child in node.body if isinstance(child, ast.FunctionDef)})
            found.update({child.target.id: child for child in node.body if isinstance(child, ast.AnnAssign)})
        return found


def signature(name, node):
    """As one calls it: without self, one argument a line where it is long."""
    given = node.args
    plain = given.posonlyargs + given.args
    defaults = [None] * (len(plain) - len(given.defaults)) + given.defaults
    words = []
    for argument, default in list(zip(plain, defaults)) + [("*", None)] * bool(given.kwonlyargs or given.vararg) + list(zip(given.kwonlyargs, given.kw_defaults)):
        if argument == "*":
            words.append("*" + (ast.unparse(given.vararg) if given.vararg else ""))
        elif argument.arg != "self":
            words.append(ast.unparse(argument) + (f" = {ast.unparse(default)}" if default is not None else ""))
    result = f" -> {ast.unparse(node.returns)}" if node.returns and node.name != "__init__" else ""
    line = f"{name}({', '.join(words)}){result}"
    return line if len(line) <= WIDEST else f"{name}(\n" + "".join(f"    {word},\n" for word in words) + f"){result}"


def markdown(text):
    """A docstring's paragraphs; its signs stand for themselves, but for code in backticks."""
    paragraphs = []
    for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(text or "")):
        if paragraph.startswith("    "):
            paragraphs.append(paragraph)
            continue
        parts = re.split(r"(`[^`]+`)", " ".join(paragraph.split()))
        parts[::2] = [re.sub(r"([*_\[\]\\])", r"\\\1", part).replace("<", "&lt;") for part in parts[::2]]
        paragraphs.append(re.sub(r"^(\d+|[-+#>])", r"\\\1", "".join(parts)) if re.match(r"[-+#>]", "".join(parts)) else "".join(parts))
    return "\n\n".join(paragraphs)


def is_property(node):
    """As stubs and sources declare them: `lower: Final[Floats]`, or a function with a decorator."""
    return isinstance(node, ast.AnnAssign) or any(ast.unparse(each).split(".")[-1] in ("property", "cached_property") for each in node.decorator_list)


def type_of(node):
    if node is None:
        return ""
    declared = node.annotation if isinstance(node, ast.AnnAssign) else node.returns
    text = ast.unparse(declared) if declared is not None else ""
    return ": " + re.sub(r"^Final\[(.*)\]$", r"\1", text) if text else ""


class Writer:
    def __init__(self, module, stubs):
        self.module, self.stubs = module, stubs

    def function(self, name, value, node, level):
        lines = ["#" * level + f" {name}", ""]
        if node is not None:
            lines += ["```python", signature(name.split(".")[-1], node), "```", ""]
        return lines + [markdown(inspect.getdoc(value)), ""]

    def of_class(self, name, value, level):
        members, lines = self.stubs.members(name), ["#" * level + f" {name}", ""]
        made = members.get("__init__")
        if made is not None and not name.endswith(("Error", "Warning")):
            lines += ["```python", signature(name, made), "```", ""]
        lines += [markdown(value.__doc__), ""]
        if made is not None and getattr(value.__init__, "__doc__", None) and value.__init__.__doc__ != object.__init__.__doc__:
            lines += [markdown(value.__init__.__doc__), ""]
        names = [each for each in dict.fromkeys([*members, *vars(value)]) if not each.startswith("_") and hasattr(value, each)]
        shown = [(each, inspect.getattr_static(value, each), members.get(each)) for each in names]
        properties = [(each, node, text) for each, found, node in shown if not callable(getattr(value, each)) or (node is not None and is_property(node))
                      for text in [markdown(inspect.getdoc(found)).replace("\n\n", " ")]]
        for each, node, text in properties:
            lines.append(f"- `{each}{type_of(node)}`" + (f"<br>{text}" if text else ""))
        lines.append("")
        for each, found, node in shown:
            if each not in [one for one, _, _ in properties]:
                lines += self.function(f"{name}.{each}", getattr(value, each), node, level + 1)
        return lines

    def of_module(self, name, value):
        lines = [f"## snug.{name}", "", markdown(value.__doc__), ""]
        for each in value.__all__:
            lines += self.entry(each, getattr(value, each), 3)
        return lines

    def entry(self, name, value, level=2):
        if inspect.ismodule(value):
            return self.of_module(name, value)
        if inspect.isclass(value):
            return self.of_class(name, value, level)
        return self.function(name, value, self.stubs.nodes.get(name), level)


def pages(folder):
    """The name and the text of each page, for the module below `folder`."""
    sys.path.insert(0, str(folder))
    import snug

    writer = Writer(snug, Stubs(pathlib.Path(folder) / "snug"))
    placed = [name for _, _, names in TOPICS.values() for name in names]
    rest = [name for name in snug.__all__ if name not in placed and not name.startswith("_")]
    index = ["# Python", "", markdown(snug.__doc__), "", "[In Python](../python.md) explains how they go together.", "", "| page | has |", "|---|---|"]
    for page, title, text, names in [*((page, *rest_of) for page, rest_of in TOPICS.items()), (*ANSWERS, rest)]:
        lines = [f"# {title}", "", text, ""]
        for name in names:
            lines += writer.entry(name, getattr(snug, name))
        yield f"{page}.md", re.sub(r"\n{3,}", "\n\n", "\n".join(lines)) + "\n"
        index.append(f"| [{title}]({page}.md) | " + ", ".join(f"`{name}`" for name in names) + " |")
    yield "index.md", "\n".join(index) + "\n"


if __name__ == "__main__":
    for page, text in pages(pathlib.Path(sys.argv[1])):
        (pathlib.Path(sys.argv[2]) / page).write_text(text, encoding="utf-8")
