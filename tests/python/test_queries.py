"""Queries: their forms of input, their answers, their guarantees."""

import pickle

import numpy as np
import pytest

import snug
from conftest import CUBE, CUBE_FACES, moved, turned


def test_a_verdict_is_a_truth(bracket, pin):
    plain = snug.collide(bracket, pin)
    assert plain.verdict == "separated" and 0 < plain.lower
    hit = snug.collide(bracket, pin, measure=True)
    assert plain.lower <= hit.lower and hit.lower >= hit.upper / 2
    assert hit.verdict == "separated" and not hit and hit.separated and not hit.colliding
    assert 0 < hit.lower <= hit.upper and hit.points.shape == (2, 3) and hit.stats["box_tests"] > 0
    assert repr(hit).startswith("<snug.Collision separated, distance 0.01")
    assert snug.collide(bracket, pin, pose_b=moved(0, 0, 0.5)).colliding
    touch = snug.collide(bracket, pin, pose_b=moved(0, 0, 0.5), prove_contact=True)
    assert touch and touch.verdict == "intersecting" and touch.upper == 0
    undecided = snug.collide(bracket, pin, tolerance=0, max_splits=0)
    assert undecided.undecided and undecided.lower <= hit.upper
    with pytest.raises(snug.UndecidedError):
        bool(undecided)
    with pytest.raises(TypeError):
        len(hit)


def test_many_verdicts(bracket, pin):
    poses = np.array([moved(x) for x in np.linspace(-3, 3, 60)])
    hits = snug.collide(bracket, pin, pose_b=poses)
    assert len(hits) == 60 and hits.lower.shape == (60,) and hits.points.shape == (60, 2, 3) and hits.faces.shape == (60, 2)
    assert hits.any() and not hits.all() and 0 < hits.colliding.sum() < 60
    np.testing.assert_array_equal(hits.separated, ~hits.colliding)
    with pytest.raises(ValueError, match="ambiguous"):
        bool(hits)
    for i in (0, 30, -1):
        one = snug.collide(bracket, pin, pose_b=poses[i])
        for name in ("lower", "upper", "points", "faces", "parameters", "error", "stats", "verdict"):
            np.testing.assert_equal(getattr(hits[i], name), getattr(one, name))
            np.testing.assert_equal(getattr(hits, name)[i], getattr(one, name))
    for rows in (slice(10, 20), slice(None, None, -7), slice(100, 200)):
        np.testing.assert_array_equal(hits[rows].lower, hits.lower[rows])
    with pytest.raises(IndexError):
        hits[60]
    some = snug.collide(bracket, pin, pose_b=poses, tolerance=0, max_splits=0)
    assert some.undecided.any()
    with pytest.raises(snug.UndecidedError):
        some.all() if not some.separated.any() else some.any()
    none = snug.collide(bracket, pin, pose_b=np.empty((0, 4, 4)))
    assert len(none) == 0 and none.lower.shape == (0,) and none.points.shape == (0, 2, 3) and not none.any() and none.all()


def test_every_form_of_pose(bracket, pin):
    pose = turned(135, 0.05, 0.05, 0.5)
    half = np.radians(135) / 2
    quaternion, move = [np.cos(half), 0, 0, np.sin(half)], pose[:3, 3]
    expected = snug.distance(bracket, pin, pose_b=pose).lower
    for form in (pose[:3], pose.tolist(), np.asfortranarray(pose), (pose[:3, :3], move), (pose[:3, :3].tolist(), tuple(move))):
        assert snug.distance(bracket, pin, pose_b=form).lower == expected
    assert snug.distance(bracket, pin, pose_b=(quaternion, move)).lower == pytest.approx(expected, rel=1e-9)
    for many in ([pose] * 3, np.array([pose] * 3)[:, :3], ([pose[:3, :3]] * 3, [move] * 3)):
        assert (snug.distance(bracket, pin, pose_b=many).lower == expected).all()
    assert snug.distance(bracket, pin, pose_b=([quaternion] * 2, [move] * 2)).lower.shape == (2,)
    assert len(snug.distance(bracket, pin, pose_a=moved(), pose_b=[pose] * 3)) == 3
    assert len(snug.distance(bracket, pin, pose_a=[moved()] * 3, pose_b=pose)) == 3
    assert (snug.distance(bracket, pin, pose_a=[moved()] * 3, pose_b=[pose] * 3).lower == expected).all()
    pairs = [(quaternion, move), (np.array([1.0, 0, 0, 0]), [9, 0, 0])]
    of_pairs = snug.distance(bracket, pin, pose_b=pairs)
    assert list(of_pairs.lower) == [snug.distance(bracket, pin, pose_b=pair).lower for pair in pairs]
    assert (snug.distance(bracket, pin, pose_b=[(pose[:3, :3], move)] * 2).lower == expected).all()
    with pytest.raises(ValueError, match="not both"):
        snug.distance(bracket, pin, pose_b=[(quaternion, move), pose])
    for wrong in ([(quaternion, move), (pose[:3, :3], move)], [(quaternion, move, 1)], [((1, 2), move)], [(quaternion, "x")]):
        with pytest.raises((ValueError, TypeError)):
            snug.distance(bracket, pin, pose_b=wrong)
    for wrong in (np.eye(3), np.zeros((2, 2, 4, 4)), (quaternion, [move]), (pose, move), (pose[:3, :3],), 3, "abc", [[1], [1, 2]]):
        with pytest.raises((ValueError, TypeError)):
            snug.collide(bracket, pin, pose_b=wrong)
    with pytest.raises(ValueError, match="as many"):
        snug.collide(bracket, pin, pose_a=[pose] * 2, pose_b=[pose] * 3)


def test_poses_that_are_not_rigid(bracket, pin):
    bent = turned(30, 3)
    bent[0, 0] += 1e-6
    with pytest.raises(snug.PoseError, match=r"pose_b\[1\].*nearest") as caught:
        snug.collide(bracket, pin, pose_b=[turned(30), bent])
    assert caught.value.defect == pytest.approx(2 * np.cos(np.pi / 6) * 1e-6, rel=1e-3) and "--" not in str(caught.value)
    mended = snug.collide(bracket, pin, pose_b=bent, rigid="nearest")
    assert mended.upper == pytest.approx(snug.collide(bracket, pin, pose_b=turned(30, 3)).upper, abs=1e-5)
    mirrored = np.diag([1.0, 1, -1, 1])
    for wrong in (mirrored, np.eye(4) * np.nan, np.zeros((4, 4)), 2 * np.eye(4)):
        with pytest.raises(snug.PoseError) as caught:
            snug.collide(bracket, pin, pose_b=wrong, rigid="nearest")
        assert isinstance(caught.value.defect, float)
    with pytest.raises(ValueError, match="rigid"):
        snug.collide(bracket, pin, rigid="closest")


def test_lengths(bracket, pin):
    assert snug.collide(bracket, pin, margin="2%").verdict in ("within", "intersecting")
    assert snug.collide(bracket, pin, margin=0.04).verdict == snug.collide(bracket, pin, margin="2%").verdict
    same = snug.collide(bracket, pin, tolerance=0.1 / 100 * 2)
    assert same.lower == snug.collide(bracket, pin).lower == snug.collide(bracket, pin, tolerance=" 0.1 % ").lower
    for wrong in ("", "%", "x", "1e999%", "nan", -1, np.nan, [1], object()):
        with pytest.raises((ValueError, TypeError)):
            snug.collide(bracket, pin, margin=wrong)
    for wrong in (-1, 1.5, 2**64, "many"):
        with pytest.raises(ValueError):
            snug.collide(bracket, pin, max_splits=wrong)
        with pytest.raises(ValueError):
            snug.collide(bracket, pin, threads=wrong)


def test_distance_contains_sampled_distances(bracket, pin):
    found = snug.distance(bracket, pin, relative=1e-4)
    assert found.outcome == "complete" and found.upper - found.lower <= 1e-4 * found.upper
    points = pin.tessellate("0.2%").vertices
    assert bracket.closest_point(points).upper.min() >= found.lower


def test_penetration_separates(bracket, pin):
    depth = snug.penetration(bracket, pin, pose_b=moved(0, 0, 0.5))
    assert 0 < depth.lower <= depth.upper
    apart = moved(*(np.array([0, 0, 0.5]) + depth.translation))
    assert snug.collide(bracket, pin, pose_b=apart, solid=True, tolerance=0).separated
    many = snug.penetration(bracket, pin, pose_b=[moved(0, 0, 0.5), moved(9)])
    assert many.lower[0] == depth.lower and (many.translation[1] == 0).all()


def test_points(cube):
    rng = np.random.default_rng(7)
    points = rng.uniform(-2, 2, (500, 3))
    near = cube.closest_point(points, relative=1e-6)
    assert near.point.shape == (500, 3) and near.face.shape == (500,) and set(near.outcome) == {"complete"}
    gap = np.linalg.norm(near.point - points, axis=1)
    assert (near.lower <= gap + 1e-12).all() and (gap <= near.upper + 1e-12).all()
    one = cube.closest_point(points[3], relative=1e-6)
    assert one.lower == near.lower[3] and one.face == near.face[3] and isinstance(one.lower, float) and isinstance(one.face, int)
    signed, inside = cube.signed_distance(points), cube.contains(points)
    np.testing.assert_array_equal(cube.contains(points, threads=1).inside, inside.inside)
    assert [bool(cube.contains(p)) for p in points[:50]] == inside.inside[:50].tolist()
    decided = ~inside.undecided
    assert decided.all() and ((signed.upper < 0) <= inside.inside).all() and ((signed.lower > 0) <= inside.outside).all()
    assert cube.contains([0, 0, 0]) and not cube.contains([3, 0, 0])
    with pytest.raises(ValueError, match="ambiguous"):
        bool(inside)
    on = cube.evaluate(0, 0.0, 0.0).point
    if cube.contains(on).undecided:
        with pytest.raises(snug.UndecidedError):
            bool(cube.contains(on))
    with pytest.raises(snug.MeshError):
        snug.Surface(CUBE, CUBE_FACES[1:]).contains([0, 0, 0])


def test_points_are_not_copied(cube):
    points = np.random.default_rng(1).uniform(-2, 2, (100, 3))
    expected = cube.closest_point(points).lower
    for one in (points[3].tolist(), tuple(points[3]), points[3], list(points[3])):
        assert cube.closest_point(one).lower == expected[3]
    assert cube.closest_point([1, -2, 3.5]).lower == cube.closest_point(np.array([1.0, -2, 3.5])).lower
    for same in (points.astype(">f8"), np.asfortranarray(points), points.tolist(), np.hstack([points, points])[:, :3]):
        np.testing.assert_array_equal(cube.closest_point(same).lower, expected)


def test_rays(cube):
    down = cube.ray([0, 0, 9], [0, 0, -1], query="all")
    assert down.certain_hit and down.outcome == "complete" and len(down) == 2 and list(down.side) == [-1, 1]
    assert (down.lower <= down.upper).all() and down.certified.all()
    grid = np.array([[x, y, 9.0] for x in np.linspace(-2, 2, 9) for y in np.linspace(-2, 2, 9)])
    hits = cube.ray(grid, [0, 0, -1])
    quick = cube.ray(grid, np.tile([0.0, 0, -1], (81, 1)), certified=False)
    assert len(hits.outcome) == 81 and (hits.certain_hit | hits.certain_miss).all()
    np.testing.assert_array_equal(np.unique(hits.ray[hits.certified]), np.flatnonzero(hits.certain_hit))
    np.testing.assert_array_equal(quick.hit, hits.certain_hit)
    first = hits.lower[hits.certified]
    np.testing.assert_allclose(quick.t[quick.hit], first, atol=1e-3)
    assert len(cube.ray(np.empty((0, 3)), [0, 0, 1])) == 0
    for wrong in (dict(query="some"), dict(query="all", certified=False)):
        with pytest.raises(ValueError):
            cube.ray([0, 0, 9], [0, 0, -1], **wrong)
    with pytest.raises(ValueError):
        cube.ray([0, 0, 9], [0, 0, 0])
    with pytest.raises(ValueError, match="as many"):
        cube.ray(np.zeros((2, 3)), np.ones((3, 3)))


def test_evaluate(cube):
    one = cube.evaluate(0, 0.5, 0.5)
    np.testing.assert_allclose(one.point, [-0.6875, 0, 0], atol=1)
    np.testing.assert_allclose(np.abs(one.normal), [1, 0, 0], atol=1e-9)
    assert one.tangents.shape == (2, 3) and one.differentiable and one.error < 1e-12
    for same in ((np.int8(0), np.float32(0.5), 0.5), (np.array(0), 0.5, np.float64(0.5)), (0, 0.5, 0.5, np.uint8(0))):
        np.testing.assert_array_equal(cube.evaluate(*same).point, one.point)
    np.testing.assert_array_equal(cube.evaluate(0, 0, 1).point, cube.evaluate(0, 0.0, 1.0).point)
    many = cube.evaluate([0, 1], 0.5, [0.5, 0.5])
    np.testing.assert_array_equal(many.point[0], one.point)
    for wrong in ((6, 0.5, 0.5), (2**32 - 1, 0, 0), (2**70, 0, 0), (0, 0, 10**400), (0, 0, 0, 9), (0, 0, 0, -1), (0, 2, 0), (0, np.nan, 0), (-1, 0, 0), (0.5, 0, 0), ([[0]], 0, 0), ([0, 1], [0, 0, 0], 0)):
        with pytest.raises((ValueError, TypeError, OverflowError)):
            cube.evaluate(*wrong)


def test_names_of_other_doors(bracket, pin):
    for hits in (snug.collide(bracket, pin, pose_b=moved(0, 0, 0.5)), snug.distance(bracket, pin, pose_b=[moved(3), moved(9)])):
        np.testing.assert_array_equal(hits.distance, np.stack([hits.lower, hits.upper], axis=-1))
        np.testing.assert_array_equal(hits.witness, hits.points)
    regions = snug.contacts(bracket, pin, pose_b=moved(0, 0, 0.5)).regions
    again = pickle.loads(pickle.dumps(regions))
    assert len(again) == len(regions) > 0 and again.verdict == regions.verdict and again.contacts == regions.contacts
    np.testing.assert_array_equal(again.distance, regions.distance)
    assert again[0].owners[0].tolist() == regions[0].owners[0].tolist()


def test_inspection():
    whole = snug.inspect(CUBE, CUBE_FACES)
    assert [whole[name] for name in ("scheme", "edges", "components", "boundary_edges", "closed", "defects")] == ["catmark", 12, 1, 0, True, []]
    assert whole["coincidences"]["vertices"] == 0
    broken = snug.inspect(CUBE, [*CUBE_FACES, CUBE_FACES[0]], scheme="loop")
    assert {each["kind"] for each in broken["defects"]} >= {"duplicate-face"} and not all(each["legal"] for each in broken["defects"])
    assert not snug.inspect(CUBE, CUBE_FACES[1:])["closed"]
    assert [each["kind"] for each in snug.inspect(CUBE, np.zeros((2, 0)))["defects"][:2]] == ["too-few-vertices"] * 2
    surface = snug.Surface(CUBE, CUBE_FACES)
    assert surface.topology_of(0) == surface.topology_of(0, 0)
    with pytest.raises(ValueError):
        surface.topology_of(99)


def test_trajectories_say_how_they_are_made():
    for wrong in ((), (1,)):
        with pytest.raises(TypeError, match=r"through\(poses.*steady\(pose"):
            snug.Trajectory(*wrong)
