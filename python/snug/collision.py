"""Which of many placed surfaces touch, by the names and argument orders of trimesh.collision.CollisionManager.

A script that uses trimesh's manager uses this one by changing its import. A mesh of another library whose faces are all
triangles is what these triangles are, as in trimesh; scheme= and sharp= make a smooth surface of it. The answers are proved:

- two objects collide if their verdict is 'within' or 'intersecting': at most `tolerance` apart, 0.1 % of the larger
  one's size by default. With solid=True one inside the other collides, too. Where nothing could be shown,
  UndecidedError is raised;
- a minimum distance is the lower end of a proved interval: the objects are at least so far apart. DistanceData has
  the interval. Of closed surfaces that touch it is negative: a translation of that length parts them, proved
  (penetration(), some 50 ms for each such pair); depth=False, or a surface that is not closed, makes it 0;
- one contact is given for each pair: the witnesses' middle, not all contact points.

Objects may stand in groups, and pairs of objects or groups may be allowed to touch: allow(). Those are never asked about.
"""

from __future__ import annotations

import logging
from typing import Any, Callable, Dict, FrozenSet, Iterator, List, NamedTuple, Optional, Set, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._errors import UndecidedError
from ._snug import Collision, Distance, Penetration, Surface, _near_pairs, _pose, collide, distance, penetration
from .proximity import Sharp, as_surface

Floats = npt.NDArray[np.float64]

__all__ = ["CollisionManager", "ContactData", "DistanceData", "scene_to_collision"]

_EXTERNAL = "__external"
_log = logging.getLogger("snug")


class _Placed(NamedTuple):
    name: str
    surface: Surface
    pose: Floats


def _placed(name: str, surface: Surface, transform: Optional[npt.ArrayLike], rigid: Optional[str] = None) -> _Placed:
    pose = np.eye(4)
    if transform is not None:
        given = np.asarray(transform)
        if given.shape != (4, 4):
            raise ValueError(f"transform has the shape {given.shape}; give (4, 4)")
        pose = _pose(given, f"the transform of {name!r}", rigid)  # here, not at the first query
    return _Placed(name, surface, pose)


class _Pair(NamedTuple):
    a: _Placed
    b: _Placed
    gap: float  # a lower bound of their distance, from boxes

    def size(self) -> float:
        """The larger one's."""
        return max(self.a.surface.size, self.b.surface.size)


class _Pairs(NamedTuple):
    """Each two of some objects or, with `others`, each of these with each of the others."""

    objects: List[_Placed]
    others: Optional[List[_Placed]] = None
    allowed: Callable[[str, str], bool] = lambda a, b: False

    def nearer_than(self, reach: float) -> Iterator[_Pair]:
        """The pairs that boxes around them do not keep farther apart, and that are not allowed to touch."""
        parts = self.objects + (self.others or [])
        if not parts:
            return
        first = None if self.others is None else len(self.objects)
        poses = np.array([each.pose for each in parts])
        near = _near_pairs([each.surface for each in parts], poses, first, reach)
        _log.debug("%d of the pairs of %d objects are within %g of each other's boxes", len(near[0]), len(parts), reach)
        for i, j, gap in zip(*near):
            if not self.allowed(parts[i].name, parts[j].name):
                yield _Pair(parts[i], parts[j], float(gap))

    def largest_size(self) -> float:
        return max((each.surface.size for each in self.objects + (self.others or [])), default=0.0)


class ContactData:
    """One contact of two objects."""

    def __init__(self, a: _Placed, b: _Placed, found: Collision) -> None:
        self.names: FrozenSet[str] = frozenset((a.name, b.name))
        self.collision = found  #: the proved answer
        self._objects = (a, b)
        self._penetration: Optional[Penetration] = None

    @property
    def point(self) -> Floats:
        """Between the witnesses, (3,), world coordinates."""
        middle: Floats = np.asarray(self.collision.points).mean(axis=0)
        return middle

    @property
    def normal(self) -> Floats:
        """Along the translation of the second object that takes `depth` away, (3,), world coordinates. Of surfaces that are not
        closed, and of contacts without depth, the normal of the first one at the contact; NaN where it has none."""
        a, b = self._objects
        if a.surface.is_closed and b.surface.is_closed:
            way = np.asarray(self._depth().translation)
            if way.any():
                return way / np.linalg.norm(way)
        face = int(self.collision.faces[0])
        if face < 0:
            return np.full(3, np.nan)
        u, v = self.collision.parameters[0]
        there = a.surface.evaluate(face, u, v, corner=int(self.collision.corners[0]))
        return a.pose[:3, :3] @ np.asarray(there.normal)

    @property
    def depth(self) -> float:
        """How deeply two solids penetrate: the upper end of penetration(), found when asked for. Closed surfaces only."""
        return float(self._depth().upper)

    def _depth(self) -> Penetration:
        if self._penetration is None:
            a, b = self._objects
            self._penetration = penetration(a.surface, b.surface, pose_a=a.pose, pose_b=b.pose)
        return self._penetration

    def index(self, name: str) -> int:
        """The face of the object `name` at the contact; -1 if it was located on the other one only."""
        return int(self.collision.faces[_side(self._objects, name)])


class DistanceData:
    """How far two objects are apart."""

    def __init__(self, a: _Placed, b: _Placed, found: Distance, interval: Tuple[float, float]) -> None:
        self.names: FrozenSet[str] = frozenset((a.name, b.name))
        self.interval = interval  #: contains the distance, or minus the depth of solids that touch
        self._found = found
        self._objects = (a, b)

    @property
    def distance(self) -> float:
        """The interval's lower end, mesh units."""
        return self.interval[0]

    def point(self, name: str) -> Floats:
        """The closest point of the object `name`, (3,), world coordinates."""
        return np.array(self._found.points[_side(self._objects, name)])

    def index(self, name: str) -> int:
        """The face that it lies on; -1 if it was located on the other object only."""
        return int(self._found.faces[_side(self._objects, name)])


def _side(objects: Tuple[_Placed, _Placed], name: str) -> int:
    for side, each in enumerate(objects):
        if each.name == name:
            return side
    raise ValueError(f"{name!r} is not one of the names {objects[0].name!r} and {objects[1].name!r}")


def _objects_of(manager: Any) -> List[_Placed]:
    if not isinstance(manager, CollisionManager):
        raise TypeError(f"other_manager: give a snug.CollisionManager, not {type(manager).__name__}")
    return manager._all()


Names = Union[Set[str], Set[Tuple[str, str]]]


class CollisionManager:
    """Objects by name, each a surface and a transform (4, 4).

    tolerance, solid: as in snug.collide(). relative: as in snug.distance(). depth: are distances of solids that touch
    negative? rigid="nearest": transforms that are not rigid
    within 1e-9, such as those of single precision, are replaced by the nearest ones; without it they raise PoseError.
    scheme, sharp: as in snug.Surface(), for meshes that are not surfaces yet.
    """

    def __init__(
        self,
        tolerance: Union[float, str] = "0.1%",
        solid: bool = False,
        relative: float = 1e-4,
        rigid: Optional[str] = None,
        scheme: Optional[str] = "auto",
        sharp: Sharp = None,
        depth: bool = True,
    ) -> None:
        self._depth = depth
        self._tolerance = tolerance
        self._solid = solid
        self._relative = relative
        self._rigid = rigid
        self._scheme = scheme
        self._sharp = sharp
        self._objects: Dict[str, _Placed] = {}
        self._groups: Dict[str, str] = {}
        self._allowed: Set[FrozenSet[str]] = set()

    def add_object(
        self, name: str, mesh: Any, transform: Optional[npt.ArrayLike] = None, group: Optional[str] = None
    ) -> Surface:
        """Adds a surface, or a mesh that snug.Surface() takes, in place of an object of that name. Returns the surface.

        group: one that the object stands in; objects of one group are asked about like others, until allow(group, group).
        """
        surface = self._surface(mesh)
        self._objects[name] = self._place(name, surface, transform)
        self._groups[name] = name if group is None else group
        return surface

    def allow(self, a: str, b: str, allowed: bool = True) -> None:
        """May two objects, an object and a group, or two groups touch? By default none may. A name that is not there yet counts
        once it is."""
        (self._allowed.add if allowed else self._allowed.discard)(frozenset((a, b)))

    def is_allowed(self, a: str, b: str) -> bool:
        """May two objects touch, by their names or groups?"""
        both = [(name, self._groups.get(name, name)) for name in (a, b)]
        return any(frozenset((x, y)) in self._allowed for x in both[0] for y in both[1])

    def remove_object(self, name: str) -> None:
        """Removes an object. Raises ValueError if there is none of that name."""
        self._require(name)
        del self._objects[name], self._groups[name]

    def set_transform(self, name: str, transform: npt.ArrayLike) -> None:
        """Places an object anew. Raises ValueError if there is none of that name."""
        self._objects[name] = self._place(name, self._require(name).surface, transform)

    def in_collision_single(
        self,
        mesh: Any,
        transform: Optional[npt.ArrayLike] = None,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any:
        """Does a surface touch any object?

        Returns bool; with return_names also the set of names of those that it touches, with return_data also a list of
        ContactData.
        """
        other = self._place(_EXTERNAL, self._surface(mesh), transform)
        found = list(self._contacts(_Pairs(self._all(), [other]), return_names or return_data))
        return self._answer(found, {a.name for a, _, _ in found}, return_names, return_data)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Do any two objects touch? As in_collision_single(), with pairs of names in alphabetical order."""
        found = list(self._contacts(_Pairs(self._all(), None, self.is_allowed), return_names or return_data))
        names = {(min(a.name, b.name), max(a.name, b.name)) for a, b, _ in found}
        return self._answer(found, names, return_names, return_data)

    def in_collision_other(
        self, other_manager: "CollisionManager", return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Does any object touch one of another manager? As above; pairs begin with the name in this one."""
        found = list(self._contacts(_Pairs(self._all(), _objects_of(other_manager)), return_names or return_data))
        return self._answer(found, {(a.name, b.name) for a, b, _ in found}, return_names, return_data)

    def min_distance_single(
        self, mesh: Any, transform: Optional[npt.ArrayLike] = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """How far a surface is from the objects, at least; with return_name also the nearest one's name, with
        return_data also DistanceData."""
        other = self._place(_EXTERNAL, self._surface(mesh), transform)
        return self._nearest(_Pairs(self._all(), [other]), return_name, return_data, lambda a, b: a)

    def min_distance_internal(
        self, name: Optional[str] = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """How far any two objects are apart, or the object `name` from any other, at least; with names as in
        in_collision_internal()."""
        pairs = _Pairs(self._all(), None, self.is_allowed)
        if name is not None:
            one = self._require(name)
            pairs = _Pairs([one], [each for each in self._all() if each is not one], self.is_allowed)
        return self._nearest(pairs, return_names, return_data, lambda a, b: (min(a, b), max(a, b)))

    def min_distance_other(
        self, other_manager: "CollisionManager", return_names: bool = False, return_data: bool = False
    ) -> Any:
        """How far the objects are from another manager's, at least; with names as in in_collision_other()."""
        return self._nearest(
            _Pairs(self._all(), _objects_of(other_manager)), return_names, return_data, lambda a, b: (a, b)
        )

    def _surface(self, mesh: Any) -> Surface:
        return as_surface(mesh, self._scheme, self._sharp)

    def _place(self, name: str, surface: Surface, transform: Optional[npt.ArrayLike]) -> _Placed:
        return _placed(name, surface, transform, self._rigid)

    def _require(self, name: str) -> _Placed:
        try:
            return self._objects[name]
        except KeyError:
            raise ValueError(f"there is no object named {name!r}") from None

    def _all(self) -> List[_Placed]:
        return list(self._objects.values())

    def _contacts(self, pairs: _Pairs, all_of_them: bool) -> Iterator[Tuple[_Placed, _Placed, Collision]]:
        undecided: Optional[UndecidedError] = None
        for pair in pairs.nearer_than(self._reach(pairs.largest_size())):
            a, b = pair.a, pair.b
            if pair.gap > self._reach(pair.size()):
                continue
            hit = collide(
                a.surface, b.surface, pose_a=a.pose, pose_b=b.pose, tolerance=self._tolerance, solid=self._solid
            )
            try:
                touch = bool(hit)
            except UndecidedError as error:
                undecided = UndecidedError(f"{a.name!r} and {b.name!r}: {error}")
                continue
            if touch:
                yield a, b, hit
                if not all_of_them:
                    return
        if undecided is not None:
            raise undecided

    def _reach(self, size: float) -> float:
        """At least the tolerance for a pair whose larger object has this size, mesh units."""
        text = str(self._tolerance).strip()
        if text.endswith("%"):
            return 1.01 * float(text[:-1]) / 100 * size
        return float(text)

    def _answer(
        self, found: List[Tuple[_Placed, _Placed, Collision]], names: Names, return_names: bool, return_data: bool
    ) -> Any:
        result: List[Any] = [bool(found)]
        if return_names:
            result.append(names)
        if return_data:
            result.append([ContactData(a, b, hit) for a, b, hit in found])
        return result[0] if len(result) == 1 else tuple(result)

    def _nearest(
        self,
        pairs: _Pairs,
        return_names: bool,
        return_data: bool,
        named: Callable[[str, str], Any],
    ) -> Any:
        best: Optional[Tuple[_Placed, _Placed, Distance, Tuple[float, float]]] = None
        lower = np.inf
        for a, b, gap in sorted(pairs.nearer_than(np.inf), key=lambda each: each.gap):
            if gap > 0 and gap >= lower:
                break
            found = distance(
                a.surface, b.surface, pose_a=a.pose, pose_b=b.pose, relative=self._relative, solid=self._solid
            )
            interval = self._interval(a, b, found)
            if best is None or interval[0] < lower:
                best, lower = (a, b, found, interval), interval[0]
        if best is None:
            raise ValueError("there are no two objects to compare")
        result: List[Any] = [lower]
        if return_names:
            result.append(named(best[0].name, best[1].name))
        if return_data:
            result.append(DistanceData(*best))
        return result[0] if len(result) == 1 else tuple(result)


    def _interval(self, a: _Placed, b: _Placed, found: Distance) -> Tuple[float, float]:
        """What contains the distance, or minus the depth."""
        if self._depth and found.lower == 0 and a.surface.is_closed and b.surface.is_closed:
            deep = penetration(a.surface, b.surface, pose_a=a.pose, pose_b=b.pose)
            if deep.upper > 0:
                return -float(deep.upper), -float(deep.lower)
        return float(found.lower), float(found.upper)


def scene_to_collision(
    scene: Any, *, scheme: Optional[str] = "auto", sharp: Sharp = None
) -> Tuple[CollisionManager, Dict[str, Surface]]:
    """A manager with the objects of a trimesh.Scene, and their surfaces, by the names of its nodes.

    scheme, sharp: those of the manager.
    """
    if not hasattr(scene, "graph") or not hasattr(scene, "geometry"):
        raise TypeError(f"scene_to_collision: give an object with .graph and .geometry, such as a trimesh.Scene, not {type(scene).__name__}")
    manager = CollisionManager(scheme=scheme, sharp=sharp)
    surfaces: Dict[str, Surface] = {}
    made: Dict[Any, Surface] = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        if geometry not in made:
            made[geometry] = manager._surface(scene.geometry[geometry])
        surfaces[node] = manager.add_object(node, made[geometry], transform)
    return manager, surfaces
