"""A program as users write it, which mypy --strict takes."""

from typing import List, Tuple

import numpy as np
import numpy.typing as npt

import snug


def gaps(a: snug.Surface, b: snug.Surface, poses: npt.NDArray[np.float64]) -> List[Tuple[float, float]]:
    found = snug.distance(a, b, pose_b=poses, relative=1e-3)
    return list(zip(np.asarray(found.lower), np.asarray(found.upper)))


def touches(a: snug.Surface, b: snug.Surface) -> bool:
    hit: snug.Collision = snug.collide(a, b, tolerance="0.1%", progress=lambda done: None)
    try:
        return bool(hit)
    except snug.UndecidedError:
        return True


def wrapped(a: snug.Surface) -> float:
    inner, outer = a.hull("0.5%")
    nearest = a.closest_point([1, 2, 3])
    mesh = a.tessellate(1e-3)
    triangles: npt.NDArray[np.uint32] = mesh.faces
    assert outer is not None
    return outer.gap + float(nearest.upper) + len(triangles)


def read(name: str) -> snug.Surface:
    try:
        return snug.read(name, sharp=30)
    except snug.MeshError as error:
        print(error.elements)
        raise
    except snug.FileError as error:
        print(error.filename, error.line)
        raise
