"""Points near a limit surface, by the names and argument orders of trimesh.proximity.

A script that asks trimesh.proximity asks this module instead by changing its import. `mesh` is a snug.Surface, or
anything that snug.Surface() takes. A mesh of another library whose faces are all triangles is what these triangles are,
as in trimesh; scheme= and sharp=, those of snug.Surface(), make a smooth surface of it. What is a Surface already stays so.

- closest points lie on the limit surface, and `triangle_id` is the face of the control mesh they belong to;
- distances are upper ends of proved intervals, at most 0.01 % of the mesh's size above the exact distance;
- signs come from winding numbers and are positive inside, as in trimesh (Surface.signed_distance() has the
  opposite sign, and intervals). A surface that is not closed is refused with MeshError: it has no inside.
"""

from __future__ import annotations

from typing import Any, Callable, List, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._convert import doubles
from ._snug import Surface

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

__all__ = [
    "ProximityQuery",
    "closest_point",
    "closest_point_naive",
    "longest_ray",
    "max_tangent_sphere",
    "nearby_faces",
    "reach",
    "signed_distance",
    "thickness",
]


Sharp = Union[float, str, None]


def as_surface(mesh: Any, scheme: Optional[str] = "auto", sharp: Sharp = None) -> Surface:
    """A Surface as it is, anything else that Surface() takes made into one."""
    return mesh if isinstance(mesh, Surface) else Surface(mesh, scheme=scheme, sharp=sharp)


def _rows(given: Any, name: str) -> Floats:
    array = doubles(given, name)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}; give (n, 3)")
    return array


def closest_point(
    mesh: Any, points: npt.ArrayLike, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> Tuple[Floats, Floats, Integers]:
    """The limit point closest to each of `points`, (m, 3).

    Returns closest (m, 3), distance (m,) in mesh units, and triangle_id (m,), faces of the control mesh.
    """
    found = as_surface(mesh, scheme, sharp).closest_point(_rows(points, "points"))
    return np.array(found.point), np.array(found.upper), np.array(found.face)


def closest_point_naive(
    mesh: Any, points: npt.ArrayLike, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> Tuple[Floats, Floats, Integers]:
    """closest_point(): nothing here is quicker and less exact."""
    return closest_point(mesh, points, scheme=scheme, sharp=sharp)


def nearby_faces(
    mesh: Any, points: npt.ArrayLike, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> List[List[int]]:
    """For each of `points`, (n, 3), the faces that its closest limit point may lie on, and perhaps some more: a list of
    lists. In a dual scheme they are vertices."""
    surface = as_surface(mesh, scheme, sharp)
    at = _rows(points, "points")
    reach = np.array(surface.closest_point(at).upper) * (1 + 1e-12)
    boxes = surface.boxes()
    found: List[List[int]] = []
    for point, far in zip(at, reach):
        apart = np.maximum(np.maximum(boxes[:, 0] - point, point - boxes[:, 1]), 0.0)  # NaN for faces without a surface
        found.append(np.flatnonzero(np.linalg.norm(apart, axis=1) * (1 - 1e-12) <= far).tolist())
    return found


def signed_distance(
    mesh: Any, points: npt.ArrayLike, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> Floats:
    """Distance of each of `points`, (m, 3), from the surface of a solid: positive inside, negative outside, (m,).

    The number is the end of the proved interval that is nearer to 0; where the interval contains 0 it is 0.
    """
    found = as_surface(mesh, scheme, sharp).signed_distance(_rows(points, "points"))
    lower, upper = np.array(found.lower), np.array(found.upper)
    inside, outside = upper < 0, lower > 0
    return np.where(inside, -upper, np.where(outside, -lower, 0.0))


def longest_ray(
    mesh: Any, points: npt.ArrayLike, directions: npt.ArrayLike, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> Floats:
    """How far one comes from each of `points`, (n, 3), along `directions`, (n, 3), before meeting the surface, (n,).

    Lengths in mesh units, infinite where nothing is met. Hits within 1e-8 of the size are the point's own and do not
    count. A length is the lower end of the interval of
    the first hit, or of what may be one.
    """
    surface = as_surface(mesh, scheme, sharp)
    origins, towards = _rows(points, "points"), _rows(directions, "directions")
    if len(origins) != len(towards):
        raise ValueError(f"there are {len(origins)} points and {len(towards)} directions; give as many")
    lengths = np.linalg.norm(towards, axis=1)
    if not np.all(lengths > 0):
        raise ValueError(f"directions[{int(np.argmin(lengths > 0))}] has length 0")
    unit = towards / lengths[:, None]
    own = 1e-8 * surface.size
    hits = surface.ray(origins + own * unit, unit)
    first = np.full(len(origins), np.inf)
    np.minimum.at(first, hits.ray, np.maximum(hits.lower, 0.0) + own)
    return first


def max_tangent_sphere(
    mesh: Any,
    points: npt.ArrayLike,
    inwards: bool = True,
    normals: Optional[npt.ArrayLike] = None,
    threshold: float = 1e-6,
    max_iter: int = 100,
    *,
    scheme: Optional[str] = "auto",
    sharp: Sharp = None,
) -> Tuple[Floats, Floats]:
    """The largest sphere that touches the surface at each of `points`, (n, 3), and does not cross it.

    points: on the surface. normals: (n, 3); by default the limit normals there. threshold: iteration ends once a
    radius changes by at most this, mesh units. Returns centers (n, 3), NaN where the radius is infinite, and radii
    (n,). Found by shrinking spheres to their closest limit points; no bound is proved.
    """
    surface = as_surface(mesh, scheme, sharp)
    at = _rows(points, "points")
    outward = _normals_at(surface, at) if normals is None else _rows(normals, "normals")
    if len(outward) != len(at):
        raise ValueError(f"there are {len(at)} points and {len(outward)} normals; give as many")
    direction = -outward if inwards else outward
    direction = direction / np.linalg.norm(direction, axis=1)[:, None]
    # A sphere as large as the surface holds it all, unless all of it lies beyond the tangent plane.
    radii = np.minimum(longest_ray(surface, at, direction) / 2, 4 * surface.size)
    centers = at + radii[:, None] * direction
    active = np.arange(len(at))
    for _ in range(max_iter):
        if not len(active):
            break
        near = surface.closest_point(centers[active], absolute=threshold / 2)
        across = np.array(near.point) - at[active]
        along = np.einsum("ij,ij->i", across, direction[active])
        smaller = (np.array(near.upper) < radii[active] - threshold) & (along > 0)
        squared = np.einsum("ij,ij->i", across, across)
        shrunk = np.where(smaller, squared / np.where(smaller, 2 * along, 1.0), radii[active])
        settled = ~smaller | (radii[active] - shrunk <= threshold)
        radii[active] = np.minimum(shrunk, radii[active])
        centers[active] = at[active] + radii[active, None] * direction[active]
        active = active[~settled]
    infinite = radii >= 4 * surface.size
    radii[infinite] = np.inf
    centers[infinite] = np.nan
    return centers, radii


def thickness(
    mesh: Any,
    points: npt.ArrayLike,
    exterior: bool = False,
    normals: Optional[npt.ArrayLike] = None,
    method: str = "max_sphere",
    *,
    scheme: Optional[str] = "auto",
    sharp: Sharp = None,
) -> Floats:
    """How thick the solid is at each of `points`, (n, 3), of its surface, (n,), mesh units.

    method: 'max_sphere', the diameter of max_tangent_sphere(), or 'ray', the length of longest_ray() along the normal.
    exterior: of the space outside instead, as reach() has it.
    """
    surface = as_surface(mesh, scheme, sharp)
    at = _rows(points, "points")
    if method == "max_sphere":
        return 2 * max_tangent_sphere(surface, at, inwards=not exterior, normals=normals)[1]
    if method == "ray":
        outward = _normals_at(surface, at) if normals is None else _rows(normals, "normals")
        return longest_ray(surface, at, outward if exterior else -outward)
    raise ValueError(f"method is {method!r}; give 'max_sphere' or 'ray'")


def reach(
    mesh: Any,
    points: npt.ArrayLike,
    method: str = "max_sphere",
    *,
    scheme: Optional[str] = "auto",
    sharp: Sharp = None,
) -> Floats:
    """How far the space outside reaches at each of `points`, (n, 3): thickness() of the exterior."""
    return thickness(mesh, points, exterior=True, method=method, scheme=scheme, sharp=sharp)


def _normals_at(surface: Surface, points: Floats) -> Floats:
    found = surface.closest_point(points)
    normals = np.array(surface.evaluate(found.face, found.u, found.v, corner=found.corner).normal)
    if not np.all(np.isfinite(normals)):
        raise ValueError("the surface has no normal at some points; give normals")
    return normals


class ProximityQuery:
    """Queries about one mesh, which is made into a surface by the first one. A later change of `mesh` is not seen."""

    def __init__(self, mesh: Any, *, scheme: Optional[str] = "auto", sharp: Sharp = None) -> None:
        # Not now: a mesh that makes its queries may be half made itself.
        self._make: Callable[[], Surface] = lambda: as_surface(mesh, scheme, sharp)
        self._made: Optional[Surface] = None

    @property
    def _surface(self) -> Surface:
        if self._made is None:
            self._made = self._make()
        return self._made

    def on_surface(self, points: npt.ArrayLike) -> Tuple[Floats, Floats, Integers]:
        """closest_point()."""
        return closest_point(self._surface, points)

    def vertex(self, points: npt.ArrayLike) -> Tuple[Floats, Integers]:
        """The control vertex closest to each of `points`, (n, 3): distance (n,) and vertex_id (n,)."""
        at, vertices = _rows(points, "points"), self._surface.vertices
        distance = np.empty(len(at))
        index = np.empty(len(at), dtype=np.int64)
        block = max(1, 4_000_000 // max(1, len(vertices)))
        for begin in range(0, len(at), block):
            apart = np.linalg.norm(at[begin : begin + block, None, :] - vertices[None, :, :], axis=2)
            index[begin : begin + block] = apart.argmin(axis=1)
            distance[begin : begin + block] = apart.min(axis=1)
        return distance, index

    def signed_distance(self, points: npt.ArrayLike) -> Floats:
        """signed_distance()."""
        return signed_distance(self._surface, points)
