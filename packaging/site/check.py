#!/usr/bin/python3
"""check.py PAGES SITE: holds the built site to what it promises.

Every link leads to a file of the site, and to a place in it; nothing is loaded from a network; every page says what GitHub's
Markdown makes of its source, word by word, with as many lists, tables, code, headings and emphases. `--self-test` plants each fault.
"""

import collections
import difflib
import html.parser
import pathlib
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

COUNTED = ("li", "tr", "td", "th", "pre", "code", "em", "strong", "h1", "h2", "h3", "h4", "img", "a", "blockquote")
VOID = ("br", "hr", "img", "input", "link", "meta", "wbr", "source")


class Page(html.parser.HTMLParser):
    """What a page links to, loads, and says in its article (or everywhere, if it has none)."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads, self.counts = {""}, [], [], collections.Counter()
        self.words, self.depth, self.hidden, self.open = [], 0, [], []
        self.whole = "<article" not in text
        self.feed(text)

    def handle_starttag(self, tag, pairs):
        given = dict(pairs)
        classes = (given.get("class") or "").split()
        self.ids.add(given.get("id") or given.get("name") or "")
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if tag in ("script", "img", "iframe", "source") and given.get("src"):
            self.loads.append(given["src"])
        if tag == "link" and given.get("rel") in ("stylesheet", "icon", "preload", "preconnect", "prefetch"):
            self.loads.append(given["href"])
        if tag in VOID:
            if tag == "img" and self.inside():
                self.counts[tag] += 1
            if tag == "br":
                self.words.append(" ")
            return
        self.open.append(tag)
        if tag == "article":
            self.depth = len(self.open)
        if "headerlink" in classes or "md-content__button" in classes or tag in ("script", "style"):
            self.hidden.append(len(self.open))
        elif self.inside() and tag in COUNTED and not (tag == "code" and "pre" in self.open):
            self.counts[tag] += 1
        if tag in ("td", "th", "li", "p", "pre", "h1", "h2", "h3", "h4"):
            self.words.append(" ")

    def handle_endtag(self, tag):
        if tag not in self.open:
            return
        while self.open:
            top = self.open.pop()
            if self.hidden and len(self.open) < self.hidden[-1]:
                self.hidden.pop()
            if top == "article":
                self.depth = 0
            if top == tag:
                break

    def handle_data(self, data):
        if self.inside():
            self.words.append(data)

    def inside(self):
        return (self.whole or self.depth) and not self.hidden

    def text(self):
        return "".join(self.words).split()


def broken_links(site, pages):
    faults = []
    for path, page in pages.items():
        for link in page.links + page.loads:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loads and parts.scheme != "data":
                    faults.append(f"{path}: loads {link} from elsewhere")
                continue
            target = (site / path).parent / urllib.parse.unquote(parts.path) if parts.path else site / path
            target = target.resolve()
            if not target.is_file():
                faults.append(f"{path}: {link} does not exist")
            elif parts.fragment and target.suffix == ".html":
                named = pages[target.relative_to(site.resolve())]
                if urllib.parse.unquote(parts.fragment) not in named.ids:
                    faults.append(f"{path}: {link}: that page has no such place")
    return faults


def differences(source, page):
    """How a page differs from what GitHub's Markdown makes of its source."""
    text = source.read_text(encoding="utf-8")
    made = subprocess.run(["cmark-gfm", "--extension", "table", "--extension", "strikethrough", "--unsafe"], input=text, check=True,
                          capture_output=True, text=True).stdout
    wanted = Page(made)
    faults = []
    for tag in COUNTED:
        if wanted.counts[tag] != page.counts[tag]:
            faults.append(f"{page.counts[tag]} <{tag}> instead of {wanted.counts[tag]}")
    ours, theirs = page.text(), wanted.text()
    if ours != theirs:
        matcher = difflib.SequenceMatcher(None, theirs, ours, autojunk=False)
        what, a, b, c, d = next(step for step in matcher.get_opcodes() if step[0] != "equal")
        faults.append(f"'{' '.join(ours[max(c - 3, 0):d + 3])}' instead of '{' '.join(theirs[max(a - 3, 0):b + 3])}'")
    return faults


def check(sources, site):
    pages = {path.relative_to(site): Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    faults = broken_links(site, {path: page for path, page in pages.items() if path.name != "404.html"})
    count = 0
    for source in sorted(sources.rglob("*.md")):
        name = source.relative_to(sources)
        made = name.with_name("index.html") if name.name == "README.md" else name.with_suffix(".html")
        if made not in pages:
            faults.append(f"{name}: there is no page {made}")
        elif name.parts[0] != "files" or source.name in ("README.md", "index.md"):
            count += 1
            faults += [f"{made}: {fault}" for fault in differences(source, pages[made])]
    return faults, len(pages), count


def self_test():
    page = "<html><body><article>{}</article></body></html>"
    good = {"a.html": "<h1 id='one'>One</h1><p>x <a href='b.html#two'>two</a></p>", "b.html": "<h1 id='two'>Two</h1>"}
    source = {"a.md": "# One\n\nx [two](b.html#two)\n", "b.md": "# Two\n"}
    planted = [
        ({"a.html": good["a.html"].replace("b.html", "c.html")}, "does not exist"),
        ({"a.html": good["a.html"].replace("#two", "#three")}, "no such place"),
        ({"a.html": good["a.html"] + "<script src='https://example.org/a.js'></script>"}, "from elsewhere"),
        ({"a.html": good["a.html"].replace("x ", "y ")}, "instead of"),
        ({"a.html": good["a.html"].replace("x ", "<em>x</em> ")}, "1 <em> instead of 0"),
        ({"c.md": "# Three\n"}, "there is no page"),
        ({}, None),
    ]
    for change, wanted in planted:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, text in {**good, **source, **change}.items():
                (folder / name).write_text(page.format(text) if name.endswith(".html") else text, encoding="utf-8")
            faults, _, _ = check(folder, folder)
        if (wanted is None) != (not faults) or (wanted and not any(wanted in fault for fault in faults)):
            print(f"check.py: self-test failed: {wanted} not found in {faults}", file=sys.stderr)
            return 1
    print("check.py: self-test passed")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if not shutil.which("cmark-gfm"):
        print("check.py: cmark-gfm is missing; scripts/install_packages docs", file=sys.stderr)
        return 1
    site = pathlib.Path(sys.argv[2])
    faults, pages, compared = check(pathlib.Path(sys.argv[1]), site)
    for fault in faults:
        print(fault, file=sys.stderr)
    size = sum(path.stat().st_size for path in site.rglob("*") if path.is_file())
    print(f"build_site: {len(faults)} faults" if faults else
          f"build_site: passed ({pages} pages, {compared} of them word by word, {size / 1e6:.1f} MB): {site}/index.html")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
