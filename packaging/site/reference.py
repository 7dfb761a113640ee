"""Pages about the public headers: what Doxygen reads in them, as Markdown, a page for each header in the header's own order."""

import collections
import pathlib
import re
import xml.etree.ElementTree as ElementTree

CONTRACT = re.compile(r" *\b(Guarantee|Guarantees|Requires|Errors|Cost|Source|Tolerance|Memory): +")
WIDEST = 100
Entry = collections.namedtuple("Entry", "line name element members")


def plain(element):
    return " ".join("".join(element.itertext()).split()) if element is not None else ""


def tidy(code):
    """C++ as the headers space it."""
    code = re.sub(r" ([&*]+)(?=[ ,)>]|$)", r"\1", code)
    code = re.sub(r" ([&*]+)(?=\w)", r"\1 ", code)
    return re.sub(r"< (.*?) >", r"<\1>", re.sub(r"< (.*?) >", r"<\1>", code)).replace(" >", ">")


class Reference:
    def __init__(self, xml):
        self.pages = collections.defaultdict(list)
        self.places = {}  # what Doxygen calls it: page and anchor
        self.compounds = {}
        for path in sorted(xml.glob("*.xml")):
            if path.name.startswith(("struct", "class", "namespace")):
                self.take(ElementTree.parse(path).getroot().find("compounddef"))
        for entries in self.pages.values():
            entries.sort(key=lambda entry: entry.line)

    def take(self, compound):
        members = [member for member in compound.iter("memberdef") if member.get("prot") == "public"]
        if compound.get("kind") == "namespace":
            for member in members:
                if "<" not in plain(member.find("name")):  # specializations, whose text is that of the template
                    self.add(member, plain(member.find("name")), [], "member")
        else:
            name = plain(compound.find("compoundname")).removeprefix("snug::")
            self.add(compound, name, members, "compound")

    def add(self, element, name, members, kind):
        location = element.find("location")
        header = pathlib.Path(location.get("file")).name
        self.pages[header].append(Entry(int(location.get("line")), name, element, members))
        anchor = re.sub(r"[^a-z0-9_-]", "", name.lower().replace(" ", "-"))
        for owned in [element] + members:
            self.places[owned.get("id")] = f"{pathlib.Path(header).stem}.md#{anchor}"

    def text(self, element):
        """A description as Markdown."""
        if element is None:
            return ""
        parts = [element.text or ""]
        for child in element:
            inner = self.text(child)
            if child.tag == "ref" and child.get("refid") in self.places:
                inner = f"[{inner}]({self.places[child.get('refid')]})"
            elif child.tag == "computeroutput":
                inner = f"`{plain(child)}`"
            elif child.tag == "verbatim":
                inner = "\n\n" + "".join("    " + line + "\n" for line in (child.text or "").splitlines()) + "\n"
            elif child.tag in ("para", "itemizedlist"):
                inner = inner.strip("\n ") + "\n\n"
            elif child.tag == "listitem":
                inner = "- " + inner.strip() + "\n"
            parts += [inner, child.tail or ""]
        return "".join(parts)

    def description(self, element):
        parts = [self.text(element.find(tag)).strip() for tag in ("briefdescription", "detaileddescription")]
        return "\n\n".join(part for part in parts if part)

    def contract(self, element):
        """The description, its clauses (Guarantee, Requires ...) as a list."""
        lines = []
        for paragraph in self.description(element).split("\n\n"):
            pieces = [paragraph] if paragraph.startswith("    ") else CONTRACT.split(paragraph)
            if pieces[0].strip():
                lines += [pieces[0].rstrip(), ""]
            clauses = [f"- **{key}**: {value.strip()}" for key, value in zip(pieces[1::2], pieces[2::2])]
            if clauses and lines and lines[-1] == "" and len(lines) > 1 and lines[-2].startswith("- **"):
                lines.pop()
            lines += clauses + [""] if clauses else []
        return "\n".join(lines).strip()

    def one_line(self, element):
        return " ".join(self.contract(element).replace("\n- **", " **").split())


def signature(member):
    kind, name = member.get("kind"), plain(member.find("name"))
    type_of = tidy(plain(member.find("type")))
    if kind == "typedef":
        return f"using {name} = {type_of}"
    if kind != "function":
        value = plain(member.find("initializer"))
        lead = "static " if member.get("static") == "yes" and kind == "variable" and "constexpr" in type_of else ""
        return tidy(f"{lead}{type_of} {name}{plain(member.find('argsstring'))} {value}".strip().replace(" {", "{"))
    arguments = tidy(plain(member.find("argsstring")))
    prefix = "explicit " if member.get("explicit") == "yes" else ""
    prefix += "static " if member.get("static") == "yes" else ""
    template = member.find("templateparamlist")
    if template is not None:
        names = [" ".join(filter(None, (plain(p.find("type")), plain(p.find("declname"))))) for p in template]
        prefix = f"template <{', '.join(names)}> " + prefix
    head = f"{prefix}{type_of} {name}".strip()
    if len(head + arguments) <= WIDEST:
        return head + arguments
    parameters = [tidy(" ".join(filter(None, (plain(p.find("type")), plain(p.find("declname")))))
                       + (f" = {plain(p.find('defval'))}" if p.find("defval") is not None else ""))
                  for p in member.findall("param")]
    return head + "(\n    " + ",\n    ".join(parameters) + ")" + arguments[arguments.rfind(")") + 1:]


def listed(reference, members):
    lines = []
    for member in members:
        if member.get("kind") in ("friend",) or plain(member.find("name")).startswith("~"):
            continue
        code = " ".join(signature(member).split())
        text = reference.one_line(member)
        if text.startswith("For internal use"):
            continue
        lines.append(f"- `{code}`" + (f"<br>{text}" if text else ""))
        if member.get("kind") == "enum":
            lines += [f"    - `{plain(v.find('name'))}`: {reference.one_line(v)}" for v in member.findall("enumvalue")]
    return lines


def shown(reference, entry):
    """An entry of a page below its heading."""
    element = entry.element
    if element.tag == "compounddef":
        lines = ["```cpp", f"{element.get('kind')} {entry.name}", "```", "", reference.contract(element), ""]
        return lines + listed(reference, entry.members)
    if element.get("kind") == "enum":
        lines = ["```cpp", f"enum class {entry.name} : {plain(element.find('type')) or 'int'}", "```", "",
                 reference.contract(element), ""]
        values = [(plain(v.find("name")), reference.one_line(v)) for v in element.findall("enumvalue")]
        return lines + [f"- `{name}`" + (f": {text}" if text else "") for name, text in values]
    return ["```cpp", signature(element), "```", "", reference.contract(element)]


def pages(xml, headers):
    """The name and the text of a page for each of the headers, and of index.md."""
    reference = Reference(xml)
    index = ["# Headers", "", "`#include <snug/snug.h>` has them all, but for the adapter. Everything is in the namespace "
             "`snug`.", "", "| header | declares |", "|---|---|"]
    for header in headers:
        page = header.stem + ".md"
        path = "snug/adapters/" + header.name if header.parent.name == "adapters" else "snug/" + header.name
        lines, last = [f"# {header.name}", "", f"`#include <{path}>`", ""], None
        names = []
        for entry in reference.pages[header.name]:
            if entry.name != last:
                lines += [f"## {entry.name}", ""]
                names.append(f"[`{entry.name}`]({reference.places[entry.element.get('id')]})")
            lines += shown(reference, entry) + [""]
            last = entry.name
        if names:
            yield page, "\n".join(lines)
            index.append(f"| [{path}]({page}) | {', '.join(names)} |")
    yield "index.md", "\n".join(index) + "\n"
