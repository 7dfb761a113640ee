"""The page of `snug view`: surfaces that are moved in a browser, with live answers; where that page was not built, a still one."""

from __future__ import annotations

import base64
import html
import json
import os
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

from ._errors import FileError
from ._snug import Collision, Distance, Surface, _pose

_BEGIN = '<script type="application/json" id="snug-data">'
_END = "</script>"
_STILL = "still.html"


class Page:
    """A self-contained page. Notebooks show it; .html is its text."""

    def __init__(self, text: str) -> None:
        self.html = text

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="600" style="border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<snug.Page of {len(self.html) / 1e6:.1f} MB>"


def view(
    *parts: Union[Surface, Collision, Distance],
    path: Union[str, "os.PathLike[str]", None] = None,
    poses: Optional[Sequence[Any]] = None,
    template: Union[str, "os.PathLike[str]", None] = None,
) -> Page:
    """A page with surfaces and, at the end, an answer about the first two: snug.view(a, b, hit, poses=[None, T]).

    path: where it is written, too. poses: for each surface None or a pose as collide() takes it, (4, 4), (3, 4), (R, t) or
    (quaternion w x y z, t); an answer does not know the poses that it was asked about. template: the page to fill, if not
    the installed one. Where none is installed, the page shows the parts from all sides, but they stay where they are.

    Raises FileError if `template` is missing or `path` cannot be written, PoseError, TypeError, ValueError.
    """
    surfaces = [part for part in parts if isinstance(part, Surface)]
    answers = [part for part in parts if not isinstance(part, Surface)]
    if not surfaces or len(answers) > 1 or (answers and parts[-1] is not answers[0]):
        raise TypeError("view: give surfaces and then, at most, one answer of collide or distance")
    if not all(isinstance(answer, (Collision, Distance)) for answer in answers):
        raise TypeError("view: an answer of collide or distance can be shown")
    places = [_place(pose, i) for i, pose in enumerate([] if poses is None else poses)]
    if len(places) > len(surfaces):
        raise ValueError(f"view: {len(places)} poses, but {len(surfaces)} surfaces")
    page = _page(template)
    still = page.name == _STILL
    data: Dict[str, Any] = {
        "files": [_file(surface, i, still) for i, surface in enumerate(surfaces)],
        "parts": [{"name": _name(i), "file": i, "scheme": surface.scheme} for i, surface in enumerate(surfaces)],
    }
    for part, place in zip(data["parts"], places):
        if place is not None:
            part["place"] = place
    if answers:
        data["answer"] = json.dumps(_answer(answers[0], places + [None, None]))
    text = _filled(page, json.dumps(data).replace("<", "\\u003c"))
    if path is not None:
        try:
            Path(path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise FileError(f"{path}: {error.strerror}", str(path)) from error
    return Page(text)


def _place(pose: Any, i: int) -> Optional[List[float]]:
    if pose is None:
        return None
    return [float(number) for number in _pose(pose, f"poses[{i}]")[:3].reshape(-1)]


def _name(i: int) -> str:
    return f"{chr(ord('a') + i) if i < 26 else i}.obj"


def _file(surface: Surface, i: int, still: bool) -> Dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "part.obj"
        surface.write(file)
        made: Dict[str, Any] = {"name": _name(i), "base64": _base64(file.read_bytes())}
    if still:  # that page makes no triangles itself
        mesh = surface.tessellate("0.2%", max_triangles=60000, normals=False)
        made["still"] = {
            "positions": _base64(np.asarray(mesh.positions, "<f4").tobytes()),
            "triangles": _base64(np.asarray(mesh.triangles, "<u4").tobytes()),
        }
    return made


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")


def _answer(answer: Union[Collision, Distance], places: Sequence[Optional[List[float]]]) -> Dict[str, Any]:
    if np.ndim(answer.lower) != 0:
        raise TypeError("view: one answer can be shown, as in answers[0]")
    upper = float(answer.upper)
    document: Dict[str, Any] = {
        "command": "collide" if isinstance(answer, Collision) else "distance",
        "distance": [float(answer.lower), upper if np.isfinite(upper) else None],
    }
    if isinstance(answer, Collision):
        document["verdict"] = answer.verdict
    for name, place in zip(("place_a", "place_b"), places):
        if place is not None:
            document[name] = place
    return document


def _page(template: Union[str, "os.PathLike[str]", None]) -> Path:
    if template is not None:
        return Path(template)
    folder = Path(__file__).parent
    # In the package; in a clone, where `make page` puts it; beside the command of the Debian package snug.
    for place in ("view.html", "../../../web/snug.html", "../../../../share/snug/view.html"):
        if (folder / place).exists():
            return folder / place
    return folder / _STILL


def _filled(path: Path, data: str) -> str:
    try:
        page = path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(f"view: {path}: {error.strerror}; make page builds the page to fill", str(path)) from error
    begin = page.find(_BEGIN)
    end = page.find(_END, begin)
    if begin < 0 or end < 0:
        raise FileError(f"{path}: is not snug's page; build it with make page", str(path))
    return page[: begin + len(_BEGIN)] + data + page[end:]
