"""Surfaces that move, surfaces that meet themselves, and how far they are from their faces."""

import pickle

import numpy as np
import pytest

import snug
from conftest import CUBE, CUBE_FACES, moved, turned

ABOVE = moved(0, 0, 2)


def test_the_first_contact_is_not_before_the_lower_end(bracket, pin):
    path = snug.Trajectory.steady(ABOVE, velocity=[0, 0, -2], radians=0.2, about=[0, 0, 2])
    first = snug.time_of_contact(bracket, None, pin, path)
    assert first and first.verdict == "intersecting" and 0 < first.lower < first.upper < 1 and first.steps > 1
    for time in np.linspace(0, first.lower, 20):
        assert snug.distance(bracket, pin, pose_b=path.at(time)).lower > 0
    at_end = snug.collide(bracket, pin, pose_b=path.at(first.upper))
    assert at_end.colliding and first.points.shape == (2, 3) and np.abs(first.points[0] - first.points[1]).max() < 0.01
    assert first.stats["splits"] > 0 and repr(first).startswith("<snug.TimeOfContact intersecting, time 0.5")
    assert pickle.loads(pickle.dumps(first)).lower == first.lower


def test_clearance_is_an_envelope(bracket, pin):
    path = [moved(0, 0, 3), turned(90, 2.5, 0, 2), moved(6, 0, 1)]
    room = snug.clearance(bracket, None, pin, path, absolute=0.02)
    assert room.outcome == "complete" and room.lower <= room.upper <= room.lower + 0.02
    spans, through = room.spans, snug.Trajectory.through(path)
    assert spans.time.shape == (len(spans), 2) and (spans.time[1:, 0] == spans.time[:-1, 1]).all()
    assert spans.time[0, 0] == 0 and spans.time[-1, 1] == 2 and room.lower == spans.lower.min()
    times = np.linspace(0, 2, 200)
    found = snug.distance(bracket, pin, pose_b=[through.at(time) for time in times])
    at = np.clip(np.searchsorted(spans.time[:, 1], times), 0, len(spans) - 1)
    assert (spans.lower[at] <= found.upper).all()
    here = snug.distance(bracket, pin, pose_b=through.at(room.time))
    assert here.lower <= room.upper and room.points.shape == (2, 3) and room.steps > 3
    first = snug.time_of_contact(bracket, None, pin, path, margin=room.upper + 0.3)
    assert first.verdict == "within" and (found.upper[times < first.lower] > room.upper + 0.3).all()
    assert snug.time_of_contact(bracket, None, pin, path, margin=0.9 * room.lower).verdict == "separated"
    assert repr(room).startswith("<snug.Clearance 0.") and repr(spans[0]).startswith("<snug.ClearanceSpans time 0 to ")
    again = pickle.loads(pickle.dumps(room))
    np.testing.assert_array_equal(again.spans.distance, spans.distance)
    for wrong in ({"absolute": -1}, {"relative": np.nan}, {"max_splits": -1}):
        with pytest.raises(ValueError):
            snug.clearance(bracket, None, pin, path, **wrong)
    with pytest.raises(ValueError, match="margin"):
        snug.time_of_contact(bracket, None, pin, path, margin=-1)


def test_what_misses_and_what_is_not_decided(bracket, pin):
    aside = snug.time_of_contact(bracket, None, pin, [moved(9), moved(9, 0, -3)])
    assert aside.verdict == "separated" and not aside and aside.lower == 1 and aside.upper == np.inf
    undecided = snug.time_of_contact(bracket, moved(), pin, [ABOVE, moved()], max_splits=2000, tolerance=0)
    with pytest.raises(snug.UndecidedError):
        bool(undecided)
    assert undecided.outcome == "budget-spent"


def test_forms_of_motion(bracket, pin):
    poses = [ABOVE, turned(90, 0, 0, 1), moved(0, 0, 0.5)]
    through = snug.Trajectory.through(poses)
    assert through.duration == 2 and repr(through) == "<snug.Trajectory of duration 2>"
    for time, pose in enumerate(poses):
        np.testing.assert_allclose(through.at(time), pose, atol=1e-15)
    expected = snug.time_of_contact(bracket, None, pin, through)
    for form in (poses, np.array(poses), [(pose[:3, :3], pose[:3, 3]) for pose in poses]):
        same = snug.time_of_contact(bracket, np.eye(4), pin, form)
        assert [same.lower, same.upper] == [expected.lower, expected.upper]
    back = snug.time_of_contact(pin, through, bracket, None)
    assert back.verdict == expected.verdict
    # A spin about a moving point: half a turn and half a step.
    spin = snug.Trajectory.steady(velocity=[1, 0, 0], radians=np.pi, about=[0, 1, 0])
    np.testing.assert_allclose(spin.at(1) @ [0, 0, 0, 1], [1, 2, 0, 1], atol=1e-15)
    with pytest.raises(ValueError, match="different times"):
        snug.time_of_contact(bracket, poses, pin, poses[:2])
    with pytest.raises(ValueError, match="motion_b"):
        snug.time_of_contact(bracket, None, pin, np.empty((0, 4, 4)))
    with pytest.raises(snug.PoseError, match="motion_b"):
        snug.time_of_contact(bracket, None, pin, [moved(), turned(180)])
    with pytest.raises(ValueError, match="velocity"):
        snug.Trajectory.steady(velocity=[[1, 2, 3]])
    with pytest.raises(ValueError, match="time"):
        through.at(3)


def test_a_surface_and_itself(cube):
    clear = cube.self_contact()
    assert clear.verdict == "clear" and not clear and clear.outcome == "complete" and len(clear.pairs) == 0
    assert clear.pairs.points.shape == (0, 2, 3) and clear.stats["stars"] > 0 and clear.radius == 0
    near = cube.self_contact(within="60%", radius="130%")
    assert near.radius == pytest.approx(1.3 * cube.size) and near.verdict in ("clear", "near", "undecided")
    two = np.vstack([CUBE, np.add(CUBE, 0.4)])
    faces = [list(face) for face in CUBE_FACES]
    met = snug.Surface(two, faces + [[v + 8 for v in face] for face in faces], scheme="bilinear").self_contact()
    assert met and met.verdict == "intersecting" and len(met.pairs) == len(met.pairs.verdict) > 0
    assert (np.diff(met.pairs.faces, axis=1) != 0).all() and not met.pairs.touching.all()
    assert (met.pairs.lower == 0).all() and met.pairs[0].verdict == "intersecting" and met.pairs[0].points.shape == (2, 3)
    again = pickle.loads(pickle.dumps(met))
    np.testing.assert_array_equal(again.pairs.points, met.pairs.points)
    undecided = snug.Surface(two, faces + [[v + 8 for v in face] for face in faces]).self_contact(max_splits=0)
    with pytest.raises(snug.UndecidedError, match="max_splits"):
        bool(undecided)
    with pytest.raises(ValueError, match="within"):
        cube.self_contact(radius=1)


def test_all_contacts(bracket, pin):
    found = snug.contacts(bracket, pin, pose_b=moved(0, 0, 0.5))
    assert found.exhaustive and found.outcome == "complete" and len(found.regions) > 0 and len(found.curves) > 0
    assert len(found.regions.verdict) == len(found.regions) and found.regions.box.shape == (len(found.regions), 2, 3)
    for curve in found.curves:
        n = len(curve.points)
        assert curve.boxes.shape == (n if curve.closed else n - 1, 2, 3) and curve.region < len(found.regions)
        for point in curve.points[:: max(1, n // 5)]:
            assert bracket.closest_point(point).lower <= curve.error and pin.closest_point(point - [0, 0, 0.5]).lower <= curve.error
        lower, upper = curve.boxes[0]
        assert (lower <= curve.points[0]).all() and (curve.points[0] <= upper).all()
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.curves[0].points, found.curves[0].points)
    assert again.regions.owners[0][0].tolist() == found.regions.owners[0][0].tolist()
    assert bool(found) and not snug.contacts(bracket, pin, pose_b=moved(9))
    with pytest.raises(snug.UndecidedError):
        bool(snug.contacts(bracket, pin, pose_b=moved(0, 0, 0.5), max_splits=0))
    # Boxes on each other share a face, in halves where it is cut in two.
    box = snug.Surface(CUBE, CUBE_FACES, scheme="bilinear")
    on = snug.contacts(box, box, pose_b=moved(0.5, 0.25, 2))
    assert on.outcome == "complete" and len(on.areas) == 1 and len(on.open) == 0
    corners = on.areas[0].points
    assert on.areas[0].error == 0 and {tuple(p) for p in corners.tolist()} == {(-0.5, -0.75, 1), (1, -0.75, 1), (1, 1, 1), (-0.5, 1, 1)}
    with pytest.raises(ValueError, match="one pose"):
        snug.contacts(bracket, pin, pose_b=[moved(), moved()])


def test_how_far_the_surface_is_from_its_faces(cube):
    apart = cube.limit_to_faces()
    points = cube.evaluate(np.repeat(np.arange(6), 25), np.tile(np.linspace(0, 1, 5), 30), np.tile(np.repeat(np.linspace(0, 1, 5), 5), 6)).point
    assert (1 - np.abs(points).max(axis=1)).max() <= apart < 1
    assert snug.Surface(CUBE, CUBE_FACES, scheme="bilinear").limit_to_faces() == 0
    assert snug.Surface(CUBE, CUBE_FACES, scheme="doo-sabin").limit_to_faces() is None
