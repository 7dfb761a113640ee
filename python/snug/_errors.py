"""Exceptions and warnings of snug."""

from __future__ import annotations

import re
from typing import Any, List, Optional, Tuple, Union

Element = Tuple[str, Union[int, Tuple[int, int]]]

_ELEMENT = re.compile(r"\b(edge|face|vertex|crease tag|corner tag|hole tag|polyline) (?:\((\d+), (\d+)\)|(\d+))")


def elements_of(message: str) -> List[Element]:
    """The elements that a message of the library names, in its order: ("face", 3), ("edge", (1, 2))."""
    found: List[Element] = []
    for kind, a, b, single in _ELEMENT.findall(message):
        index: Union[int, Tuple[int, int]] = int(single) if single else (int(a), int(b))
        element = (str(kind), index)
        if element not in found:
            found.append(element)
    return found


class MeshError(ValueError):
    """A mesh that has no limit surface, or is not supported."""

    def __init__(self, message: str = "", filename: Optional[str] = None) -> None:
        super().__init__(message)
        #: The file that the mesh was read from or written to; None where there is none.
        self.filename = filename

    @property
    def elements(self) -> List[Element]:
        """What is wrong, at most the first ten: (kind, index), or ("edge", (vertex, vertex))."""
        # The name of the file may have any text.
        message, name = str(self), self.filename
        return elements_of(message[len(name) :] if name and message.startswith(name) else message)

    def __reduce__(self) -> Any:
        return type(self), (str(self), self.filename)


class FileError(OSError):
    """A file that cannot be read, parsed or written."""

    def __init__(self, message: str, filename: Optional[str] = None) -> None:
        super().__init__(message)
        self.filename = filename

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def line(self) -> Optional[int]:
        """The line that cannot be parsed, from 1; None if none is to blame."""
        # "FILE:2: what is wrong", where the name of the file may have any text.
        found = re.match(re.escape(str(self.filename)) + r":(\d+):", str(self))
        return int(found.group(1)) if found else None

    def __reduce__(self) -> Any:
        return type(self), (self.args[0], self.filename)


class PoseError(ValueError):
    """A pose that is not a rigid transform."""

    def __init__(self, message: str, defect: float = float("nan")) -> None:
        super().__init__(message)
        #: Largest entry of |R'R - I|, roughly.
        self.defect = defect

    def __reduce__(self) -> Any:
        return type(self), (self.args[0], self.defect)


class UndecidedError(ArithmeticError):
    """The truth of an answer was asked for that is undecided."""


class MeshWarning(UserWarning):
    """A reader or writer dropped something, although it changes the surface; or triangles are smoothed though nobody said so."""


for _class in (MeshError, FileError, PoseError, UndecidedError, MeshWarning):
    _class.__module__ = "snug"
