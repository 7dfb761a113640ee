"""snug.CollisionManager and snug.proximity: names and orders of trimesh's, answers of snug."""

import itertools

import numpy as np
import pytest
from conftest import CUBE, CUBE_FACES, MODELS

import snug
from snug import proximity


class Mesh:
    """What other libraries' meshes look like."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces


def moved(x=0.0, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def cube(side=2.0, sharp=30):
    corners = np.array(list(itertools.product((-side / 2, side / 2), repeat=3)))
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return snug.Surface(corners, quads, sharp=sharp)


@pytest.fixture(scope="module")
def pawn():
    return snug.read(MODELS / "pawn.obj")


@pytest.fixture
def manager():
    result = snug.CollisionManager()
    for name, x in (("left", 0.0), ("middle", 1.5), ("right", 5.0)):
        result.add_object(name, cube(), moved(x))
    return result


def test_pairs_inside(manager):
    assert manager.in_collision_internal() is True
    touch, names, data = manager.in_collision_internal(return_names=True, return_data=True)
    assert touch and names == {("left", "middle")}
    assert [contact.names for contact in data] == [frozenset(("left", "middle"))]
    # Between the faces x = 1 of the left one and x = 0.5 of the right one: their edges cross.
    assert 0.4 <= data[0].point[0] <= 1.1 and np.all(np.abs(data[0].point[1:]) <= 1 + 1e-9)
    assert data[0].depth == pytest.approx(0.5, rel=0.1)
    np.testing.assert_allclose(data[0].normal, [1, 0, 0], atol=1e-6)  # the middle one parts from the left one that way
    assert max(data[0].index("left"), data[0].index("middle")) >= 0
    with pytest.raises(ValueError, match="nobody"):
        data[0].index("nobody")


def test_one_against_all(manager):
    other = cube(0.5)
    assert manager.in_collision_single(other, moved(3.0)) is False
    assert manager.in_collision_single(other, moved(1.0, 0.9), return_names=True) == (True, {"left", "middle"})
    distance, name, data = manager.min_distance_single(other, moved(3.0), return_name=True, return_data=True)
    assert name == "middle" and distance <= 0.25 <= data.interval[1]
    assert distance == data.distance == pytest.approx(0.25, rel=1e-3)
    assert data.point("middle")[0] == pytest.approx(2.5, abs=1e-6)
    assert data.names == frozenset(("middle", "__external"))


def test_two_managers(manager):
    other = snug.CollisionManager()
    other.add_object("far", cube(), moved(20.0))
    other.add_object("near", cube(), moved(7.5))
    assert manager.in_collision_other(other) is False
    distance, names = manager.min_distance_other(other, return_names=True)
    assert names == ("right", "near") and distance == pytest.approx(0.5, rel=1e-3)
    other.set_transform("far", moved(6.0))
    assert manager.in_collision_other(other, return_names=True) == (True, {("right", "far")})


def test_objects_come_and_go(manager):
    manager.set_transform("middle", moved(0.0, 10.0))
    assert manager.in_collision_internal(return_names=True) == (False, set())
    distance, names = manager.min_distance_internal(return_names=True)
    assert names == ("left", "right") and distance == pytest.approx(3.0, rel=1e-3)
    distance, names = manager.min_distance_internal("middle", return_names=True)
    assert names == ("left", "middle") and distance == pytest.approx(8.0, rel=1e-3)
    manager.remove_object("right")
    manager.remove_object("middle")
    with pytest.raises(ValueError, match="no two objects"):
        manager.min_distance_internal()
    with pytest.raises(ValueError, match="'right'"):
        manager.remove_object("right")
    assert manager.in_collision_internal() is False


def test_a_surface_that_was_updated_is_asked_where_it_is_now(manager):
    surface = manager.add_object("moving", cube(), moved(100.0))
    assert manager.in_collision_internal(return_names=True)[1] == {("left", "middle")}
    surface.update(surface.vertices - np.array([95.0, 0.0, 0.0]))
    assert manager.in_collision_internal(return_names=True)[1] == {("left", "middle"), ("moving", "right")}
    assert manager.min_distance_single(cube(), moved(5.0)) == pytest.approx(-2)
    shallow = snug.CollisionManager(depth=False)
    shallow.add_object("cube", cube())
    assert shallow.min_distance_single(cube(), moved(0.5)) == 0


def test_undecided_raises_unless_something_touches():
    # Two faces of sharp cubes in one plane: with tolerance 0 neither contact nor distance can be shown.
    manager = snug.CollisionManager(tolerance=0)
    manager.add_object("a", cube())
    manager.add_object("b", cube(), moved(2.0))
    try:
        answer = manager.in_collision_internal()
    except snug.UndecidedError as error:
        assert "'a'" in str(error) and "'b'" in str(error)
    else:
        assert answer is True  # proved after all, but never False
    manager.add_object("c", cube(), moved(0.5, 0.3, 0.4))
    assert manager.in_collision_internal() is True


def test_depths_are_negative_distances(manager):
    """A translation of that length parts them; of what is not closed there is none."""
    manager.add_object("open", snug.Surface([[0, -3, 0], [9, -3, 0], [9, 3, 0], [0, 3, 0]], [[0, 1, 2, 3]]), moved(20.0))
    distance, names, data = manager.min_distance_internal(return_names=True, return_data=True)
    assert names == ("left", "middle") and distance == data.interval[0] == pytest.approx(-0.5, rel=0.05)
    assert data.interval[0] <= -0.5 <= data.interval[1]
    assert snug.collide(cube(), cube(), pose_b=moved(1.5 - distance * 1.001)).separated
    assert manager.min_distance_internal("open") > 0
    manager.set_transform("open", moved(0.5))
    assert manager.min_distance_internal("open") == 0


def test_queries_of_a_mesh_that_is_made_later():
    class Late:
        def __init__(self):
            self.nearest = proximity.ProximityQuery(self)
            self.vertices, self.faces = CUBE, CUBE_FACES

    assert Late().nearest.signed_distance([[0, 0, 0]])[0] > 0


def test_solids():
    surfaces, solids = snug.CollisionManager(), snug.CollisionManager(solid=True)
    for manager in (surfaces, solids):
        manager.add_object("shell", cube())
        manager.add_object("core", cube(0.5))
    assert surfaces.in_collision_internal() is False and solids.in_collision_internal() is True
    assert solids.min_distance_internal() == pytest.approx(-1.25, rel=1e-5)


def test_boxes_lose_no_pair(pawn):
    """The boxes that rule pairs out against snug.collide() of each pair."""
    rng = np.random.default_rng(3)
    manager = snug.CollisionManager()
    poses = []
    for i in range(40):
        q = rng.normal(size=4)
        q /= np.linalg.norm(q)
        w, x, y, z = q
        pose = moved(*rng.uniform(-4, 4, size=3))
        pose[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        poses.append(pose)
        manager.add_object(f"{i:02}", pawn, pose)
    expected = {
        (f"{i:02}", f"{j:02}")
        for i, j in itertools.combinations(range(40), 2)
        if snug.collide(pawn, pawn, pose_a=poses[i], pose_b=poses[j])
    }
    assert len(expected) > 5
    assert manager.in_collision_internal(return_names=True) == (True, expected)


def test_closest_points(pawn):
    points = np.random.default_rng(0).normal(scale=2, size=(500, 3))
    closest, distance, face = proximity.closest_point(pawn, points)
    assert closest.shape == (500, 3) and distance.shape == face.shape == (500,)
    found = pawn.closest_point(points)
    assert np.array_equal(distance, found.upper) and np.array_equal(face, found.face)
    np.testing.assert_allclose(np.linalg.norm(points - closest, axis=1), distance, atol=1e-9)
    # A mesh of another library is asked about its limit surface where the scheme says so.
    again = proximity.closest_point(Mesh(pawn.vertices, pawn.faces), points, scheme="loop")
    assert all(np.array_equal(x, y) for x, y in zip(again, (closest, distance, face)))


def test_signs_are_positive_inside():
    signed = proximity.signed_distance(cube(), [[0, 0, 0], [2, 0, 0], [0.9, 0, 0], [1, 0, 0]])
    np.testing.assert_allclose(signed, [1, -1, 0.1, 0], atol=2e-4)


def test_rays_and_thickness():
    slab = cube()
    rays = proximity.longest_ray(slab, [[0, 0, 0], [0, 0, 1], [0, 0, 1], [3, 0, 0]], [[0, 0, 2], [0, 0, -1], [0, 0, 1], [0, 1, 0]])
    np.testing.assert_allclose(rays, [1, 2, np.inf, np.inf], atol=1e-5)
    at = [[0.1, 0.2, 1.0], [0.1, 0.8, 1.0]]
    np.testing.assert_allclose(proximity.thickness(slab, at, method="ray"), [2, 2], atol=1e-5)
    # The sphere that touches z = 1 at (0.1, 0.8) meets y = 1 before z = -1: its radius is 0.2.
    np.testing.assert_allclose(proximity.thickness(slab, at)[1], 0.4, atol=1e-3)
    assert np.all(np.isinf(proximity.reach(slab, at)))
    with pytest.raises(ValueError, match="method"):
        proximity.thickness(slab, at, method="guess")


def test_tangent_spheres_are_empty(pawn):
    on, _, _ = proximity.closest_point(pawn, np.random.default_rng(1).normal(scale=2, size=(300, 3)))
    centers, radii = proximity.max_tangent_sphere(pawn, on)
    near = pawn.closest_point(centers, absolute=1e-7)
    assert np.all(near.upper >= radii - 2e-6)
    np.testing.assert_allclose(np.linalg.norm(centers - on, axis=1), radii, atol=1e-12)


def test_queries_of_one_mesh(pawn):
    points = np.random.default_rng(2).normal(scale=2, size=(50, 3))
    query = proximity.ProximityQuery(pawn)
    distance, vertex = query.vertex(points)
    np.testing.assert_array_equal(distance, np.linalg.norm(points - pawn.vertices[vertex], axis=1))
    assert np.all(distance <= np.linalg.norm(points[:, None] - pawn.vertices[None], axis=2).min(axis=1))
    assert np.array_equal(query.on_surface(points)[1], proximity.closest_point(pawn, points)[1])
    assert np.array_equal(query.signed_distance(points), proximity.signed_distance(pawn, points))


@pytest.mark.parametrize("points", [[1, 2, 3], [[1, 2]], np.zeros((2, 2, 3))])
def test_shapes_are_refused(pawn, points):
    with pytest.raises(ValueError, match="shape"):
        proximity.closest_point(pawn, points)
    with pytest.raises(TypeError, match="real numbers"):
        proximity.closest_point(pawn, [[1j, 0, 0]])


def test_odd_transforms_are_refused(manager):
    """At once: boxes that they place would rule pairs out, and nobody would be asked."""
    with pytest.raises(ValueError, match="shape"):
        manager.add_object("odd", cube(), np.eye(3))
    far = moved(1000.0)
    for wrong in (np.eye(4) + np.eye(4, k=1) * 0.1, np.full((4, 4), np.nan), 2 * far, far @ np.diag([1.0, 1, -1, 1])):
        for attempt in (
            lambda: manager.add_object("odd", cube(), wrong),
            lambda: manager.set_transform("left", wrong),
            lambda: manager.in_collision_single(cube(), wrong),
            lambda: manager.min_distance_single(cube(), wrong),
        ):
            with pytest.raises(snug.PoseError):
                attempt()
    assert manager.in_collision_internal(return_names=True) == (True, {("left", "middle")})


def test_transforms_in_single_precision():
    turned = moved(1.5)
    turned[:2, :2] = [[np.cos(1), -np.sin(1)], [np.sin(1), np.cos(1)]]
    turned = turned.astype(np.float32)
    with pytest.raises(snug.PoseError, match="'a'"):
        snug.CollisionManager().add_object("a", cube(), turned)
    manager = snug.CollisionManager(rigid="nearest")
    manager.add_object("a", cube(), turned)
    assert manager.in_collision_single(cube()) is True


def test_other_names_of_trimesh(pawn):
    points = np.random.default_rng(5).normal(scale=2, size=(40, 3))
    for x, y in zip(proximity.closest_point_naive(pawn, points), proximity.closest_point(pawn, points)):
        np.testing.assert_array_equal(x, y)
    near, face = proximity.nearby_faces(pawn, points), proximity.closest_point(pawn, points)[2]
    assert all(f in faces for f, faces in zip(face, near)) and sum(map(len, near)) < 40 * len(pawn.faces) / 2


def test_a_scene():
    class Graph(dict):
        nodes_geometry = ["one", "two", "far"]

    class Scene:
        geometry = {"box": cube()}
        graph = Graph(one=(moved(), "box"), two=(moved(1.5), "box"), far=(moved(9), "box"))

    manager, objects = snug.collision.scene_to_collision(Scene())
    assert set(objects) == {"one", "two", "far"} and objects["one"] is objects["far"]
    assert manager.in_collision_internal(return_names=True) == (True, {("one", "two")})


def test_groups_and_pairs_that_may_touch(manager):
    manager.add_object("hand", cube(), moved(2.5), group="arm")
    manager.add_object("wrist", cube(), moved(3.8), group="arm")
    def touching():
        return manager.in_collision_internal(return_names=True)[1]
    assert touching() == {("left", "middle"), ("hand", "middle"), ("hand", "wrist"), ("right", "wrist")}
    manager.allow("arm", "arm")
    assert manager.is_allowed("hand", "wrist") and not manager.is_allowed("hand", "right")
    manager.allow("middle", "left")
    assert touching() == {("hand", "middle"), ("right", "wrist")}
    manager.allow("arm", "right")
    assert manager.in_collision_internal() is True
    manager.allow("arm", "middle")
    assert touching() == set()
    # Nor is their distance asked for: left and hand are the nearest of the others, 1/2 apart.
    least, names = manager.min_distance_internal(return_names=True)
    assert least == pytest.approx(0.5, rel=0.01) and names == ("hand", "left")
    manager.allow("middle", "left", False)
    assert touching() == {("left", "middle")}
    # Of something from outside nothing is allowed.
    assert manager.in_collision_single(cube(), moved(2.5)) is True


def test_what_is_made_and_asked_is_logged(caplog, manager):
    with caplog.at_level("DEBUG", logger="snug"):
        cube()
        snug.read(MODELS / "pin.obj")
        manager.in_collision_internal()
    texts = [record.getMessage() for record in caplog.records if record.name == "snug"]
    assert texts[0] == "arrays: 6 faces, catmark" and texts[1].endswith("faces, catmark") and "pin.obj: " in texts[1]
    assert "of the pairs of 3 objects" in texts[2]
