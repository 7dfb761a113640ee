"""The page of `snug view`: surfaces that are moved in a browser, with live answers."""

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
    the installed one.

    Raises FileError if the page to fill is missing or `path` cannot be written, PoseError, TypeError, ValueError.
    """
    surfaces = [part for part in parts if isinstance(part, Surface)]
    answers = [part for part in parts if not isinstance(part, Surface)]
    if not surfaces or len(answers) > 1 or (answers and parts[-1] is not answers[0]):
        raise TypeError("view: give surfaces and then, at most, one answer of collide or distance")
    if not all(isinstance(answer, (Collision, Distance)) for answer in answers):
        raise TypeError("view: an answer of collide or distance can be shown")
    places = [_place(pose, i) for i, pose in enumerate(poses or [])]
    if len(places) > len(surfaces):
        raise ValueError(f"view: {len(places)} poses, but {len(surfaces)} surfaces")
    data: Dict[str, Any] = {"parts": [_part(surface, i) for i, surface in enumerate(surfaces)]}
    for part, place in zip(data["parts"], places):
        if place is not None:
            part["place"] = place
    if answers:
        data["answer"] = json.dumps(_answer(answers[0], places + [None, None]))
    page = _filled(template, json.dumps(data).replace("<", "\\u003c"))
    if path is not None:
        try:
            Path(path).write_text(page, encoding="utf-8")
        except OSError as error:
            raise FileError(f"{path}: {error.strerror}", str(path)) from error
    return Page(page)


def _place(pose: Any, i: int) -> Optional[List[float]]:
    if pose is None:
        return None
    return [float(number) for number in _pose(pose, f"poses[{i}]")[:3].reshape(-1)]


def _part(surface: Surface, i: int) -> Dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "part.obj"
        surface.write(file)
        content = file.read_bytes()
    name = chr(ord("a") + i) if i < 26 else str(i)
    return {"name": f"{name}.obj", "scheme": surface.scheme, "base64": base64.b64encode(content).decode("ascii")}


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


def _filled(template: Union[str, "os.PathLike[str]", None], data: str) -> str:
    folder = Path(__file__).parent
    # In the package; in a clone, where `make page` puts it; beside the command of the Debian package snug.
    places = ("view.html", "../../../web/snug.html", "../../../../share/snug/view.html")
    candidates = [Path(template)] if template is not None else [folder / place for place in places]
    for candidate in candidates:
        if candidate.exists():
            break
    else:
        raise FileError(
            "view: the page to fill is not there; build it with make page before the package, or give template=", str(candidates[0])
        )
    page = candidate.read_text(encoding="utf-8")
    begin = page.find(_BEGIN)
    end = page.find(_END, begin)
    if begin < 0 or end < 0:
        raise FileError(f"{candidate}: is not snug's page; build it with make page", str(candidate))
    return page[: begin + len(_BEGIN)] + data + page[end:]
