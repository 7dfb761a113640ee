"""What is not an array of doubles already: called by the extension for meshes and for odd arrays."""

from __future__ import annotations

import importlib
import itertools
import os
import warnings
from typing import Any, Callable, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._errors import MeshWarning

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.uint32]

_MOST = 2**32 - 2  # indices are 32 bits wide, and the largest one stands for none


def bar() -> Callable[[float], object]:
    """Shows the fraction done, until nobody holds it any longer."""
    try:
        tqdm = importlib.import_module("tqdm.auto").tqdm
    except ImportError:
        raise ValueError("progress=True needs tqdm, which is not installed; give a callable of the fraction done") from None
    shown = tqdm(total=100, unit="%", leave=False)
    return lambda done: shown.update(100 * done - shown.n)


def doubles(numbers: Any, what: str) -> Doubles:
    """A C-contiguous array of doubles."""
    array = _array(numbers, what)
    if array.dtype.kind == "O":
        try:
            array = array.astype(np.float64)
        except (TypeError, ValueError) as error:
            raise TypeError(f"{what}: give real numbers ({error})") from None
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{what}: give real numbers, not {array.dtype}")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype="=f8").reshape(array.shape)


def _array(numbers: Any, what: str) -> npt.NDArray[Any]:
    if isinstance(numbers, np.ma.MaskedArray) and np.any(numbers.mask):
        raise ValueError(f"{what} has masked numbers; fill or drop them")
    try:
        return np.asarray(numbers)
    except ValueError as error:  # ragged, or deeper than numpy goes
        raise ValueError(f"{what}: give an array of numbers ({error})") from None


def _indices(numbers: Any, what: str) -> Indices:
    array = _array(numbers, what)
    if array.size == 0 and array.dtype.kind in "fO":
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{what}: give whole numbers, not {array.dtype}; .astype(int) makes them")
    wrong = (array < 0) | (array > _MOST)
    if wrong.any():
        raise ValueError(f"{what} has the index {array[wrong].flat[0]}; indices are from 0 to {_MOST}")
    return np.ascontiguousarray(array, dtype=np.uint32).reshape(array.shape)


def mesh(vertices: Any, faces: Any) -> Tuple[Doubles, Indices, Indices, bool]:
    """Points (n, 3), offsets of the faces, their vertices, and whether all faces are triangles."""
    if faces is None:
        vertices, faces = _parts(vertices)
    points = doubles(vertices, "vertices")
    if points.size == 0:
        points = points.reshape(0, 3)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"vertices has the shape {points.shape}; give (n, 3)")
    if len(points) > _MOST:
        raise ValueError(f"vertices: at most {_MOST} are taken")
    offsets, corners = _faces(faces)
    return points, offsets, corners, bool((np.diff(offsets.astype(np.int64)) == 3).all())


def _faces(faces: Any) -> Tuple[Indices, Indices]:
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        array = _indices(faces, "faces")
        if array.ndim == 1 and array.size == 0:
            array = array.reshape(0, 3)
        if array.ndim != 2:
            raise ValueError(f"faces has the shape {array.shape}; give (m, k), or a sequence of sequences")
        return _offsets(np.full(len(array), array.shape[1], np.uint64)), array.reshape(-1)
    if isinstance(faces, (str, bytes)) or not hasattr(faces, "__iter__"):
        raise TypeError("faces: give an array (m, k), or a sequence of sequences of vertices")
    faces = list(faces)
    quick = _plain_faces(faces)
    if quick is not None:
        return quick
    rows = [_indices(face, f"face {i}") for i, face in enumerate(faces)]
    for i, row in enumerate(rows):
        if row.ndim != 1:
            raise ValueError(f"face {i} has the shape {row.shape}; give a sequence of vertices")
    corners = np.concatenate(rows) if rows else np.empty(0, np.uint32)
    return _offsets(np.array([len(row) for row in rows], np.uint64)), corners


def _plain_faces(faces: List[Any]) -> Optional[Tuple[Indices, Indices]]:
    """What most lists are, ints of Python in lists or tuples, or arrays of indices, in one go; None for others."""
    if not faces:
        return None
    if all(type(face) is np.ndarray and face.ndim == 1 and face.dtype.kind in "iu" for face in faces):
        if len({face.dtype for face in faces}) > 1:
            return None
        flat = np.concatenate(faces)
    elif all(type(face) in (list, tuple) for face in faces):
        items = list(itertools.chain.from_iterable(faces))
        if not all(type(item) is int for item in items):
            return None
        try:
            flat = np.array(items, dtype=np.int64)
        except OverflowError:
            return None
    else:
        return None
    if ((flat < 0) | (flat > _MOST)).any():
        return None  # to be told which face has it
    return _offsets(np.fromiter(map(len, faces), np.uint64, len(faces))), flat.astype(np.uint32)


def _offsets(counts: npt.NDArray[np.uint64]) -> Indices:
    offsets = np.zeros(len(counts) + 1, np.uint64)
    np.cumsum(counts, out=offsets[1:])
    if offsets[-1] > _MOST:
        raise ValueError(f"faces: at most {_MOST} corners are taken")
    return offsets.astype(np.uint32)


def _parts(given: Any) -> Tuple[Any, Any]:
    """Vertices and faces of an object of trimesh, Open3D, meshio or snug."""
    if hasattr(given, "points") and hasattr(given, "cells"):  # meshio
        return given.points, [face for block in given.cells for face in _flat_cells(block)]
    for name in ("faces", "triangles"):
        if hasattr(given, "vertices") and hasattr(given, name):
            faces = getattr(given, name)
            return given.vertices, faces if isinstance(faces, (np.ndarray, list)) else np.asarray(faces)
    raise TypeError(
        "Surface: give vertices and faces, or an object with .vertices and .faces or .triangles, or .points and .cells; "
        f"{type(given).__name__} has neither"
    )


def _flat_cells(block: Any) -> Any:
    kind = block.type
    if kind in ("triangle", "quad") or kind.startswith("polygon"):
        return block.data
    if kind not in ("vertex", "line"):
        warnings.warn(f"cells of the kind {kind} are left out: {len(block.data)}", MeshWarning, stacklevel=5)
    return ()


def triangles(candidate: Any) -> Doubles:
    """Corners (n, 3, 3) of triangles given as such, or as a mesh of triangles."""
    if isinstance(candidate, (np.ndarray, list, tuple)):
        corners = doubles(candidate, "candidate")
        if corners.ndim != 3 or corners.shape[1:] != (3, 3):
            raise ValueError(f"candidate has the shape {corners.shape}; give corners (n, 3, 3), a mesh, or a Surface")
        return corners
    points, _, flat, triangular = mesh(candidate, None)
    if not triangular:
        raise ValueError("candidate has faces that are not triangles; split them first")
    if flat.size and flat.max() >= len(points):
        raise ValueError(f"candidate uses vertex {flat.max()} of {len(points)}")
    return np.ascontiguousarray(points[flat].reshape(-1, 3, 3))


def pairs(poses: List[Any], what: str) -> Tuple[Doubles, Doubles]:
    """Rotations or quaternions, and translations, of a list of pairs."""
    if not all(isinstance(pose, tuple) and len(pose) == 2 for pose in poses):
        raise ValueError(f"{what}: give matrices, or tuples (rotation, translation), not both in one list")
    rotations, translations = zip(*poses)
    return doubles(list(rotations), what), doubles(list(translations), what)


def parameters(face: Any, u: Any, v: Any, corner: Any) -> Tuple[Indices, Doubles, Doubles, Indices, bool]:
    """Four arrays of one length, and whether all were single numbers."""
    given = (_indices(face, "face"), doubles(u, "u"), doubles(v, "v"), _indices(corner, "corner"))
    whole = np.broadcast_arrays(*given)
    if whole[0].ndim > 1:
        raise ValueError(f"evaluate: face, u, v and corner have the shape {whole[0].shape} together; give numbers or (n,)")
    at = [np.ascontiguousarray(each).reshape(-1) for each in whole]
    return at[0], at[1], at[2], at[3], whole[0].ndim == 0


class WholeFile:
    """A text file that is written completely or not at all."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._temporary = f"{path}.{os.getpid()}.{id(self)}.tmp"
        self._handle = os.open(self._temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)

    def write(self, text: str) -> None:
        with open(self._handle, "w", encoding="ascii", closefd=False) as file:
            file.write(text)
        os.replace(self._temporary, self._path)

    def leave(self) -> None:
        """There is no such file, not that of an earlier call either."""
        if os.path.exists(self._path):
            os.unlink(self._path)

    def __del__(self) -> None:
        if hasattr(self, "_handle"):
            os.close(self._handle)
            if os.path.exists(self._temporary):
                os.unlink(self._temporary)
