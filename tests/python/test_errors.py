"""What is refused: with which exception, and what it names."""

import copy
import os
import pickle

import numpy as np
import pytest

import snug
from conftest import CUBE, CUBE_FACES
from snug._errors import elements_of


def test_a_mesh_error_names_elements():
    with pytest.raises(snug.MeshError) as caught:
        snug.Surface(CUBE, [[0, 1, 99, 2], [0, 0, 1]])
    assert isinstance(caught.value, ValueError)
    assert caught.value.elements[:2] == [("face", 0), ("vertex", 99)] and ("face", 1) in caught.value.elements
    with pytest.raises(snug.MeshError) as caught:
        snug.Surface(np.where(np.arange(24).reshape(8, 3) == 10, np.nan, CUBE), CUBE_FACES)
    assert caught.value.elements == [("vertex", 3)]
    for broken in (dict(creases=[(0, 99, 1)]), dict(corners=[(99, 1)]), dict(holes=[99])):
        with pytest.raises(snug.MeshError) as caught:
            snug.Surface(CUBE, CUBE_FACES, **broken)
        assert caught.value.elements
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.elements == caught.value.elements


def test_every_way_a_message_names_elements():
    text = "edge (3, 17) has 3 faces: 1, 2 and 5; face 4 names vertex 9 twice; crease tag 2 needs two vertices"
    assert elements_of(text) == [("edge", (3, 17)), ("face", 4), ("vertex", 9), ("crease tag", 2)]
    with pytest.raises(snug.MeshError) as caught:
        snug.Surface(CUBE, CUBE_FACES[1:]).contains([0, 0, 0])
    assert "edge" in [kind for kind, _ in caught.value.elements]


def test_a_file_error_names_file_and_line(tmp_path):
    with pytest.raises(snug.FileError) as caught:
        snug.read(tmp_path / "none.obj")
    assert isinstance(caught.value, OSError) and caught.value.filename == str(tmp_path / "none.obj") and caught.value.line is None
    broken = tmp_path / "line 7.obj"
    broken.write_text("v 0 0 0\nv 1 x 0\n")
    with pytest.raises(snug.FileError) as caught:
        snug.read(broken)
    assert caught.value.line == 2 and str(broken) in str(caught.value)
    for again in (pickle.loads(pickle.dumps(caught.value)), copy.copy(caught.value)):
        assert (str(again), again.filename, again.line) == (str(caught.value), str(broken), 2)
    with pytest.raises(snug.FileError):
        snug.Surface(CUBE, CUBE_FACES).write(tmp_path / "a.xyz")
    with pytest.raises(snug.MeshError):
        snug.Surface(CUBE, CUBE_FACES).write(tmp_path / "a.stl")
    for wrong in ("a\0b.obj", 3, None):
        with pytest.raises((ValueError, TypeError)):
            snug.read(wrong)


def test_a_mesh_error_of_a_file_names_no_element_of_its_name(tmp_path):
    broken = tmp_path / "face 7, edge (1, 2).off"
    broken.write_text("OFF 3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n")
    with pytest.raises((snug.MeshError, snug.FileError)):
        snug.read(broken)
    broken.write_text("OFF 4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 0 2\n")
    with pytest.raises(snug.MeshError) as caught:
        snug.read(broken)
    assert caught.value.filename == str(broken) and str(broken) in str(caught.value)
    assert caught.value.elements and ("face", 7) not in caught.value.elements and ("edge", (1, 2)) not in caught.value.elements
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.filename, again.elements) == (str(caught.value), str(broken), caught.value.elements)


def test_names_of_files_may_have_any_bytes(tmp_path):
    name = os.fsencode(tmp_path) + b"/\xff.off"
    with pytest.raises(snug.FileError) as caught:
        snug.read(name)
    assert os.fsencode(caught.value.filename) == name
    tagged = snug.Surface(CUBE, CUBE_FACES, creases=[(0, 1, 2.5)])
    with pytest.warns(snug.MeshWarning):
        tagged.write(name)
    np.testing.assert_array_equal(snug.read(name).vertices, CUBE)


def test_objects_that_were_never_made():
    """__new__ alone: pybind11 would show memory as it is."""
    with pytest.raises(TypeError, match="__init__"):
        snug.Surface.__new__(snug.Surface).closest_point([1, 2, 3])
    for name in snug.__all__:
        cls = getattr(snug, name)
        if not isinstance(cls, type) or cls.__module__ != "snug" or issubclass(cls, Exception):
            continue
        for member in dir(cls):
            thing = cls.__new__(cls)
            try:
                value = getattr(thing, member)
                repr(value)
                if callable(value) and not member.startswith("__"):
                    value(*[[[1, 2, 3]]] * (member in ("update", "closest_point", "signed_distance", "contains")))
            except (TypeError, ValueError, AttributeError, IndexError):
                pass


def test_a_pose_error_is_pickled():
    again = pickle.loads(pickle.dumps(snug.PoseError("pose_b: bad", 0.5)))
    assert str(again) == "pose_b: bad" and again.defect == 0.5


@pytest.mark.parametrize(
    "vertices, faces",
    [
        ([], []),
        (CUBE, []),
        (CUBE[:, :2], CUBE_FACES),
        (CUBE[0], CUBE_FACES),
        (CUBE[None], CUBE_FACES),
        (np.float64(3), CUBE_FACES),
        (CUBE.astype(complex), CUBE_FACES),
        (CUBE.astype(str), CUBE_FACES),
        (np.array([[None] * 3]), CUBE_FACES),
        (np.ma.masked_array(CUBE, CUBE > 0), CUBE_FACES),
        (CUBE, CUBE_FACES.astype(float)),
        (CUBE, CUBE_FACES - 1),
        (CUBE, np.uint64(2**63) + CUBE_FACES.astype(np.uint64)),
        (CUBE, CUBE_FACES + 2**32),
        (CUBE, CUBE_FACES[None]),
        (CUBE, 3),
        (CUBE, "faces"),
        (CUBE, [[0, 1, 2], 3]),
        (CUBE, [[0, 1, [2]]]),
        (CUBE, [[10**30, 1, 2]]),
        ("vertices", None),
        (None, None),
    ],
)
def test_what_is_no_mesh(vertices, faces):
    with pytest.raises((ValueError, TypeError, OverflowError)):
        snug.Surface(vertices, faces)


@pytest.mark.parametrize(
    "options",
    [
        dict(scheme="nurbs"),
        dict(scheme=3),
        dict(boundary="edge"),
        dict(bounds="spheres"),
        dict(crease_method="x"),
        dict(smooth_triangles=1),
        dict(sharp=-1),
        dict(sharp="30"),
        dict(sharp=30, scheme="doo-sabin"),
        dict(weld=-1),
        dict(weld=np.nan),
        dict(creases=[(0, 1)]),
        dict(creases=[(0.5, 1, 1)]),
        dict(creases=[(-1, 1, 1)]),
        dict(creases=[(0, 1, np.nan)]),
        dict(corners=[1]),
        dict(holes=[[1]]),
        dict(threads=-1),
        dict(threads=10**6),
        dict(progress=3),
    ],
)
def test_what_is_no_option(options):
    with pytest.raises((ValueError, TypeError)):
        snug.Surface(CUBE, CUBE_FACES, **options)


def test_values_that_do_not_fit(cube):
    huge = snug.Surface(CUBE * 1e308, CUBE_FACES)
    with pytest.raises(OverflowError):
        huge.measure()
    with pytest.raises(ValueError):
        cube.closest_point([1e300, 0, 0])
    with pytest.raises(ValueError):
        cube.tessellate()
    with pytest.raises(ValueError):
        cube.bound(level=61)
    with pytest.raises((ValueError, MemoryError)):
        cube.subdivided(64)
    with pytest.raises(TypeError):
        snug.collide(cube, CUBE)
    with pytest.raises(TypeError):
        snug.Collision()


@pytest.mark.parametrize("call, message", [
    (lambda a: snug.collide(a), "collide() needs 'b': collide(a, b, *, pose_a=None"),
    (lambda a: snug.collide(a, a, pose=1), "collide() has no argument 'pose': collide(a, b"),
    (lambda a: snug.collide(a, 3), "collide() cannot take these types: a is of Surface, b is of int: collide(a, b"),
    (lambda a: snug.collide(a, a, a=a), "collide() was given 'a' twice: collide(a, b"),
    (lambda a: a.tessellate(1, 2), "tessellate() takes at most 1 by position, not 2: tessellate(error=None"),
    (lambda a: a.closest_point(), "closest_point() needs 'points': closest_point(points, *"),
    (lambda a: snug.Surface(), "Surface() needs 'vertices': Surface(vertices, faces=None"),
    (lambda a: snug.Trajectory.through(), "through() needs 'poses': through(poses, *"),
    (lambda a: snug.collide(a, a).any(1), "any() takes none by position, not 1: any()"),
    (lambda a: snug.Distance(a, a), "Distance() makes none: functions of snug return it"),
    (lambda a: snug.Mesh(), "Mesh() makes none: functions of snug return it"),
    (lambda a: snug.CollisionManager().in_collision_other(a), "other_manager: give a snug.CollisionManager, not Surface"),
    (lambda a: snug.collision.scene_to_collision(a), "scene_to_collision: give an object with .graph and .geometry"),
])
def test_a_wrong_call_is_told_in_a_line(call, message, cube):
    with pytest.raises(TypeError) as error:
        call(cube)
    assert str(error.value).startswith(message) and "\n" not in str(error.value)


def test_errors_of_callbacks_stay_as_they_are(cube):
    def fail(done):
        raise TypeError("mine")

    with pytest.raises(TypeError, match="^mine$"):
        cube.tessellate("0.01%", progress=fail)


def test_dir_shows_what_users_need():
    assert dir(snug) == sorted(snug.__all__)


def test_numbers_in_a_repr_are_on_the_side_that_it_says(cube):
    for share in range(1, 12):
        triangles, wrap, boxes = cube.tessellate(0.013 * share), cube.envelope(0.11 + 0.013 * share), cube.bound(error=0.013 * share)
        assert float(repr(triangles).split()[-1].rstrip(">")) >= triangles.error_bound
        assert float(repr(boxes).split()[-1].rstrip(">")) >= boxes.max_radius
        lower, upper = repr(wrap).rstrip(">").split(" from ")[1].split(" to ")
        assert float(lower) <= wrap.clearance and float(upper) >= wrap.error
        outer = cube.hull(0.013 * share).outer
        assert float(repr(outer).split()[-1].rstrip(">")) >= outer.gap


def test_intervals_are_not_rounded_shut(cube, bracket, pin):
    for relative in (1e-3, 1e-6, 1e-9):
        found = snug.distance(bracket, pin, relative=relative)
        lower, upper = repr(found).split()[1].rstrip(",>"), repr(found).split()[3].rstrip(",>")
        assert found.lower == found.upper or float(lower) < float(upper)
