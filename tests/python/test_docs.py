"""The programs in README.md, docs/python.md, docs/newcomers.md and docs/robots.md run, and say what the pages say."""

import re

import pytest

from conftest import MODELS, ROOT

PAGES = ["README.md", "docs/python.md", "docs/newcomers.md", "docs/robots.md"]


@pytest.mark.parametrize("page", PAGES)
def test_programs_of_a_page(page, monkeypatch, capsys):
    monkeypatch.chdir(ROOT / "examples/robot" if page == "docs/robots.md" else MODELS)
    names = {}
    programs = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)
    assert programs
    for program in programs:
        exec(compile(program, page, "exec"), names)
    said = capsys.readouterr().out
    begins = {"README.md": "separated 0.205", "docs/python.md": "separated ", "docs/newcomers.md": "first contact by step",
              "docs/robots.md": "table upper separated"}
    assert said.startswith(begins[page]), said
    if page == "docs/python.md":
        assert names["hits"].colliding.shape == (1000,) and names["hits"].any()
