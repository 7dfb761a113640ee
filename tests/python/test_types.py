"""The types that the package declares: complete, true to the module, and enough for mypy --strict."""

import importlib.util
import inspect
import os
import pathlib
import pydoc
import subprocess
import sys

import pytest

import snug
from conftest import CUBE, CUBE_FACES

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = pathlib.Path(snug.__file__).parent.parent
ENVIRONMENT = {**os.environ, "MYPY_CACHE_DIR": os.devnull}
if PACKAGE.name != "site-packages":  # there mypy finds it by itself
    ENVIRONMENT.update(PYTHONPATH=str(PACKAGE), MYPYPATH=str(PACKAGE))

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("mypy") is None or "asan" in os.environ.get("LD_PRELOAD", ""),
    reason="mypy is not installed, or sanitizers run",
)

# pybind11's classes have a metaclass and an __init__ of their own; copies and sequences go without saying.
ALLOWED = r"""
snug\.(_snug\.|_view\.|collision\.|proximity\.)?_?[A-Z][A-Za-z]+
.*\.__(init|new|len|getitem|iter|copy|deepcopy|getstate|setstate|reduce)__
"""


def test_a_program():
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", str(HERE / "sample.py")],
                          env=ENVIRONMENT, capture_output=True, text=True, cwd=HERE)
    assert done.returncode == 0, done.stdout


def test_declarations_are_true(tmp_path):
    (tmp_path / "allowed").write_text(ALLOWED.strip())
    done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "snug", "--concise", "--allowlist", tmp_path / "allowed",
                           "--ignore-unused-allowlist"],
                          env=ENVIRONMENT, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_help_shows_names_and_defaults():
    assert str(inspect.signature(snug.Surface)).startswith("(vertices, faces=None, *, scheme='auto', creases=None")
    assert str(inspect.signature(snug.Surface.hull)).startswith("(self, error=None, *, inner=True")
    cube = snug.Surface(CUBE, CUBE_FACES)
    assert str(inspect.signature(cube.contains)) == "(points, *, threads=0, progress=None, certificate=None)"
    assert "tolerance='0.1%'" in pydoc.plain(pydoc.render_doc(snug.collide)) and snug.collide.__doc__.startswith("Do two")
    for name in snug.__all__:
        thing = getattr(snug, name)
        if inspect.isbuiltin(thing):
            inspect.signature(thing)
        for member in vars(thing) if isinstance(thing, type) else ():
            if not member.startswith("_") and callable(getattr(thing, member)):
                inspect.signature(getattr(thing, member))


def test_every_name_is_explained():
    for name in snug.__all__:
        if name.startswith("_"):
            continue
        thing = getattr(snug, name)
        assert thing.__doc__, name
        for member in vars(thing) if isinstance(thing, type) else ():
            if not member.startswith("_"):
                assert getattr(thing, member).__doc__, f"{name}.{member}"
