"""Triangles that mean triangles: where they are taken as they are, and what is said where they are smoothed."""

import contextlib
import itertools
import os
import types
import warnings
from fractions import Fraction

import numpy as np
import pytest
from conftest import CUBE, CUBE_FACES, MODELS, moved

import exact_triangles as exact
import snug
from snug import proximity

POSES = max(20, int(os.environ.get("SNUG_FUZZ", "100")))
TRIANGLES = np.array([t for a, b, c, d in CUBE_FACES for t in ((a, b, c), (a, c, d))])


def of_trimesh(vertices, faces):
    return types.SimpleNamespace(vertices=vertices, faces=faces)


def of_open3d(vertices, faces):
    return types.SimpleNamespace(vertices=list(vertices), triangles=np.asarray(faces, dtype=np.int32))


def of_meshio(vertices, faces):
    cells = [types.SimpleNamespace(type="triangle", data=part) for part in np.array_split(np.asarray(faces), 2)]
    return types.SimpleNamespace(points=vertices, cells=[types.SimpleNamespace(type="line", data=[[0, 1]])] + cells)


LIBRARIES = [of_trimesh, of_open3d, of_meshio]


@contextlib.contextmanager
def warned(count):
    """The MeshWarnings of a block, and no others, each seen however often it comes."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        yield seen
    assert [each.category for each in seen] == [snug.MeshWarning] * count, [str(each.message) for each in seen]


@pytest.mark.parametrize("library", LIBRARIES)
def test_meshes_of_other_libraries_are_their_triangles(library):
    mesh = library(CUBE, TRIANGLES)
    with warned(0):
        assert snug.Surface(mesh).scheme == "flat"
        assert snug.Surface(mesh, scheme="auto").measure().volume[1] == pytest.approx(8)
        assert snug.Surface(mesh, scheme="loop").scheme == "loop"
        # Who gives rules of subdivision means a control mesh.
        for rules in ({"sharp": 30}, {"creases": [(0, 1, 2)]}, {"corners": [(0, 1)]}, {"holes": [0]}, {"boundary": "none"}):
            assert snug.Surface(mesh, **rules).scheme == "loop"
        assert snug.CollisionManager().add_object("a", mesh).scheme == "flat"
        assert snug.Surface(of_trimesh(CUBE, CUBE_FACES)).scheme == "catmark"
    with warned(1):
        assert snug.Surface(mesh, creases=[]).scheme == "loop"


def test_surfaces_and_meshes_of_snug_keep_their_scheme():
    with warned(0):
        flat = snug.Surface(CUBE, TRIANGLES, scheme="flat")
        loop = snug.Surface(CUBE, TRIANGLES, scheme="loop")
        assert snug.Surface(flat).scheme == "flat" and snug.Surface(flat, sharp=30).scheme == "loop"
        assert snug.Surface(loop).scheme == snug.Surface(loop.subdivided(1)).scheme == "loop"
        assert snug.Surface(snug.Surface(CUBE, CUBE_FACES, scheme="doo-sabin")).scheme == "doo-sabin"
        assert snug.Surface(loop.tessellate("1%")).scheme == snug.Surface(loop.hull("5%").outer).scheme == "flat"
    with warned(1):  # points on the surface are no control points of it
        snug.Surface(loop.subdivided(1, limit=True))


def test_files(tmp_path):
    flat, loop = (snug.Surface(CUBE, TRIANGLES, scheme=scheme) for scheme in ("flat", "loop"))
    with warned(0):
        for name in ("a.stl", "a.glb", "a.obj", "a.usda"):
            flat.write(tmp_path / name)
            assert snug.read(tmp_path / name).scheme == "flat"
            assert snug.read(tmp_path / name, scheme="loop").scheme == snug.read(tmp_path / name, sharp=30).scheme == "loop"
        for name in ("b.obj", "b.usda"):
            loop.write(tmp_path / name)
            assert snug.read(tmp_path / name).scheme == "loop"
    with warned(2):  # that the format does not say so
        flat.write(tmp_path / "a.off")
        flat.write(tmp_path / "a.ply")
    for name in ("a.off", "a.ply"):
        with warned(1) as seen:
            assert snug.read(tmp_path / name).scheme == "loop"
        assert str(seen[0].message).startswith(f"{tmp_path / name}: triangles taken as the control mesh")
        with warned(0):
            for how in ({"scheme": "loop"}, {"scheme": "flat"}, {"sharp": 30}):
                snug.read(tmp_path / name, **how)
    (tmp_path / "odd.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nt odd 0/0/0\n")
    with warned(1) as seen:
        snug.read(tmp_path / "odd.obj")
    assert "odd" in str(seen[0].message)


def test_the_warning():
    with pytest.warns(snug.MeshWarning) as seen:
        surface = snug.Surface(CUBE, TRIANGLES)
    text = str(seen[0].message)
    begin, end = "triangles taken as the control mesh of a Loop surface, up to ", " away from them; "
    assert text.startswith(begin) and end in text
    assert text.endswith('; scheme="flat" takes the facets, scheme="loop" says that this is meant')
    assert seen[0].filename == __file__
    apart = float(text[len(begin) :].split()[0])
    # A corner of the cube is as far from the surface, and no point of the surface is farther from the cube.
    assert snug.deviation(surface, CUBE[TRIANGLES]).from_surface.upper <= apart < 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "triangles taken", snug.MeshWarning)
        assert snug.Surface(CUBE, TRIANGLES).scheme == "loop"


def doors(tmp_path):
    """Whatever makes a surface or takes a mesh, by name: a function of the keywords scheme and sharp, and whether it is
    given triangles that nobody said to be meant as they are."""
    file = tmp_path / "plain.off"
    file.write_text("OFF\n8 12 0\n" + "".join("%r %r %r\n" % tuple(p) for p in CUBE.tolist())
                    + "".join("3 %d %d %d\n" % tuple(t) for t in TRIANGLES))
    foreign, point = of_trimesh(CUBE, TRIANGLES), [[3.0, 0.1, 0.2]]
    yield "Surface", lambda **how: snug.Surface(CUBE, TRIANGLES, **how), True
    yield "Surface of lists", lambda **how: snug.Surface(CUBE.tolist(), TRIANGLES.tolist(), **how), True
    yield "read", lambda **how: snug.read(file, **how), True
    yield "Surface of a mesh", lambda **how: snug.Surface(foreign, **how), False
    for name in ("closest_point", "closest_point_naive", "nearby_faces", "signed_distance", "max_tangent_sphere", "thickness", "reach"):
        yield name, lambda name=name, **how: getattr(proximity, name)(foreign, [[1.0, 0.1, 0.2]], **how), False
    yield "longest_ray", lambda **how: proximity.longest_ray(foreign, point, [[-1.0, 0, 0]], **how), False
    yield "ProximityQuery", lambda **how: proximity.ProximityQuery(foreign, **how), False

    def manager(**how):
        result = snug.CollisionManager(**how)
        result.add_object("a", foreign)
        result.in_collision_single(foreign, moved(5))
        result.min_distance_single(foreign, moved(5))

    yield "CollisionManager", manager, False
    graph = type("Graph", (dict,), {"nodes_geometry": ["a"]})(a=(moved(), "a"))
    scene = types.SimpleNamespace(geometry={"a": foreign}, graph=graph)
    yield "scene_to_collision", lambda **how: snug.collision.scene_to_collision(scene, **how), False
    flat = snug.Surface(CUBE, TRIANGLES, scheme="flat")
    yield "deviation", lambda scheme="flat", sharp=None: snug.deviation(flat, foreign), False


def test_no_door_smooths_without_a_word(tmp_path):
    names = []
    for name, door, smooths in doors(tmp_path):
        names.append(name)
        with warned(1 if smooths else 0):
            door()
        if smooths:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                with pytest.raises(snug.MeshWarning, match="scheme=\"flat\""):
                    door()
        for how in ({"scheme": "loop"}, {"scheme": "flat"}, {"sharp": 30}):
            with warned(0):
                door(**how)
    # A function of proximity that is not among them would not be tried.
    assert {name for name in proximity.__all__ if callable(getattr(proximity, name))} <= set(names)


def test_surfaces_that_are_made_are_used_without_a_warning(tmp_path):
    import copy
    import pickle

    with pytest.warns(snug.MeshWarning):
        surface = snug.Surface(CUBE, TRIANGLES)
    with warned(0):
        for same in (surface, copy.copy(surface), pickle.loads(pickle.dumps(surface)), snug.Surface(surface)):
            same.update(CUBE * 2)
            snug.collide(surface, same)
            snug.deviation(surface, same)
            snug.CollisionManager().add_object("a", same)
            assert pickle.loads(pickle.dumps(same.subdivided(1))).faces.shape == (48, 3)
        surface.write(tmp_path / "a.obj")


def test_the_manager_has_a_scheme_and_an_angle():
    mesh = of_trimesh(CUBE, TRIANGLES)
    facets, smooth, sharp = snug.CollisionManager(), snug.CollisionManager(scheme="loop"), snug.CollisionManager(sharp=30)
    for manager in (facets, smooth, sharp):
        manager.add_object("a", mesh)
    gaps = [manager.min_distance_single(mesh, moved(3)) for manager in (facets, smooth, sharp)]
    assert gaps[0] == pytest.approx(1) and gaps[2] == pytest.approx(1) and gaps[1] > 1.2
    made = snug.Surface(CUBE, CUBE_FACES, scheme="bilinear")
    assert smooth.add_object("made", made) is made
    near = [proximity.closest_point(mesh, [[3, 0, 0]], **how)[1][0] for how in ({}, {"scheme": "loop"}, {"sharp": 30})]
    assert near[0] == pytest.approx(2, abs=1e-3) and near[2] == pytest.approx(2, abs=1e-3) and near[1] > 2.1
    with pytest.raises(ValueError, match="scheme"):
        snug.CollisionManager(scheme="smooth").add_object("a", mesh)


# Random meshes of other libraries against rationals.


def tetrahedron(rng):
    return rng.integers(-8, 9, (4, 3)) / 8.0, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def box(rng):
    return CUBE * rng.integers(1, 5, 3) / 4.0, TRIANGLES


def soup(rng):
    """Triangles that may cross each other."""
    n = int(rng.integers(1, 6))
    return rng.uniform(-1, 1, (3 * n, 3)), np.arange(3 * n).reshape(n, 3)


def fan(rng):
    """A disc whose boundary is bent."""
    n = int(rng.integers(3, 9))
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.column_stack([np.cos(angle), np.sin(angle), rng.uniform(-1, 1, n)])
    return np.vstack([[[0, 0, 0]], rim]), np.array([[0, 1 + i, 1 + (i + 1) % n] for i in range(n)])


KINDS = [tetrahedron, box, soup, fan]


def drawn(rng, kind):
    """A mesh without triangles that have no area."""
    while True:
        vertices, faces = kind(rng)
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        if np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-3:
            return np.asarray(vertices, dtype=float), faces


def rotation(rng, kind):
    if kind == "none":
        return np.eye(3)
    if kind == "right":  # a permutation with signs, exact
        axes = np.eye(3)[rng.permutation(3)] * rng.choice([-1.0, 1.0], 3)[:, None]
        return axes if np.linalg.det(axes) > 0 else -axes
    w, x, y, z = (lambda q: q / np.linalg.norm(q))(rng.normal(size=4))
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def triangles_of(points, faces):
    return [tuple(points[v] for v in face) for face in faces.tolist()]


def cases(count):
    """Every kind of mesh beside every kind; every kind of rotation; far, near, touching in dyadic places, and through each other."""
    kinds = itertools.cycle(itertools.product(itertools.combinations_with_replacement(KINDS, 2), ("none", "right", "any"),
                                              ("far", "near", "dyadic", "through")))
    rng = np.random.default_rng(30)
    for (kind_a, kind_b), turn, place in itertools.islice(kinds, count):
        a, b = drawn(rng, kind_a), drawn(rng, kind_b)
        pose = np.eye(4)
        pose[:3, :3] = rotation(rng, turn)
        pose[:3, 3] = {
            "far": lambda: rng.uniform(3, 50) * rng.choice([-1, 1], 3),
            "near": lambda: rng.uniform(-2, 2, 3),
            "dyadic": lambda: rng.integers(-8, 9, 3) / 4.0,
            "through": lambda: rng.uniform(-0.2, 0.2, 3),
        }[place]()
        yield a, b, pose, rng


def contains_interval(lower, upper, square):
    return Fraction(lower) ** 2 <= square and (upper == np.inf or square <= Fraction(upper) ** 2)


def test_the_drop_in_against_rationals():
    seen = {True: 0, False: 0}
    libraries = itertools.cycle(LIBRARIES)
    for a, b, pose, rng in cases(POSES):
        mesh_a, mesh_b = next(libraries)(*a), next(libraries)(*b)
        size = max(np.ptp(mesh[0][np.unique(mesh[1])], axis=0).max() for mesh in (a, b))
        triangles_a = triangles_of(exact.exact(a[0]), a[1])
        triangles_b = triangles_of(exact.placed(exact.exact(b[0]), pose), b[1])
        square = exact.mesh_mesh(triangles_a, triangles_b)
        with warned(0):
            manager = snug.CollisionManager(depth=False)
            manager.add_object("a", mesh_a)
            touch = manager.in_collision_single(mesh_b, pose)  # decided: UndecidedError would be raised
            distance, data = manager.min_distance_single(mesh_b, pose, return_data=True)
        seen[touch] += 1
        assert square <= Fraction(0.001 * size) ** 2 if touch else square > 0
        lower, upper = data.interval
        assert distance == lower >= 0 and contains_interval(lower, upper, square), (lower, upper, float(square) ** 0.5)
        assert upper - lower <= 1.0001e-4 * max(upper, size), (lower, upper)
        points = np.vstack([rng.uniform(-3, 3, (2, 3)), rng.integers(-4, 5, (1, 3)) / 4.0])
        with warned(0):
            closest, apart, face = proximity.closest_point(mesh_a, points)
        own = np.ptp(a[0][np.unique(a[1])], axis=0).max()
        for point, near, upper, triangle in zip(exact.exact(points), exact.exact(closest), apart, face):
            truth = float(exact.point_mesh(point, triangles_a)) ** 0.5
            assert truth - 1e-12 * own <= upper <= truth + 1.01e-4 * own
            assert float(exact.point_triangle(near, triangles_a[triangle])) ** 0.5 <= 1e-12 * own
    assert min(seen.values()) > POSES / 10


def test_signs_against_rationals():
    rng = np.random.default_rng(31)
    inside = 0
    for _ in range(POSES):
        vertices, faces = drawn(rng, tetrahedron)
        if np.linalg.det(vertices[1:] - vertices[0]) < 0:
            faces = faces[:, ::-1]
        triangles = triangles_of(exact.exact(vertices), faces)
        points = np.vstack([rng.dirichlet(np.ones(4), 3) @ vertices, rng.uniform(-1.5, 1.5, (3, 3))])
        with warned(0):
            signed = proximity.signed_distance(of_trimesh(vertices, faces), points)
        size = np.ptp(vertices, axis=0).max()
        for point, found in zip(exact.exact(points), signed):
            heights = [exact.height(point, triangle)[0] for triangle in triangles]
            sign = 0 if max(heights) == 0 else -1 if max(heights) > 0 else 1
            truth = sign * float(exact.point_mesh(point, triangles)) ** 0.5
            assert found == 0 or np.sign(found) == sign
            assert abs(found - truth) <= 1.01e-4 * size
            inside += sign > 0
    assert inside >= POSES


def test_the_rationals():
    """The twin itself, in places where the answer is plain."""
    flat = exact.exact([[0, 0, 0], [4, 0, 0], [0, 4, 0]])
    for other, square in (
        ([[0, 0, 3], [4, 0, 3], [0, 4, 3]], 9),  # parallel
        ([[1, 1, -1], [1, 1, 1], [9, 9, 1]], 0),  # pierced
        ([[4, 0, 0], [8, 0, 0], [4, 8, 1]], 0),  # one corner in common
        ([[1, 1, 0], [2, 1, 0], [1, 2, 0]], 0),  # inside, in its plane
        ([[5, 5, 0], [9, 5, 0], [5, 9, 0]], 18),  # beside, in its plane
        ([[-3, 2, -5], [-3, 2, 5], [-9, 2, 0]], 9),  # edges across
        ([[1, 1, 2], [1, 1, 9], [2, 1, 9]], 4),  # a corner above
    ):
        assert exact.triangle_triangle(flat, exact.exact(other)) == exact.triangle_triangle(exact.exact(other), flat) == square
    assert exact.point_triangle((Fraction(1), Fraction(1), Fraction(-2)), flat) == 4


def test_what_a_model_says():
    """The project's own triangle meshes say that they are control meshes."""
    with warned(0):
        assert {snug.read(file).scheme for file in sorted(MODELS.glob("*.obj"))} == {"loop", "catmark"}
