"""Surfaces: how they are made, seen, changed, written, copied."""

import base64
import copy
import gc
import json
import pathlib
import pickle
import sys
import types
import warnings

import numpy as np
import pytest

import snug
from conftest import CUBE, CUBE_FACES, MODELS, moved


def test_properties(cube):
    assert (cube.scheme, cube.boundary, cube.size, cube.is_closed) == ("catmark", "edge-and-corner", 2.0, True)
    assert repr(cube) == "<snug.Surface catmark, 6 faces, size 2>"
    np.testing.assert_array_equal(cube.vertices, CUBE)
    np.testing.assert_array_equal(cube.faces, CUBE_FACES)
    assert cube.vertices.dtype == np.float64 and cube.faces.dtype == np.uint32
    assert not cube.vertices.flags.writeable and not cube.faces.flags.writeable
    with pytest.raises(ValueError):
        cube.vertices[0] = 1


@pytest.mark.parametrize("dtype", ["f4", ">f8", "i2", "u1", "f2", "g", "O"])
def test_any_real_dtype(dtype):
    whole = (CUBE + 2).astype(dtype)
    np.testing.assert_array_equal(snug.Surface(whole, CUBE_FACES).vertices, CUBE + 2)


@pytest.mark.parametrize("dtype", ["i1", "u2", "i8", ">i4", "u8"])
def test_any_whole_dtype(dtype):
    np.testing.assert_array_equal(snug.Surface(CUBE, CUBE_FACES.astype(dtype)).faces, CUBE_FACES)


def test_any_stride():
    wide = np.zeros((8, 6))
    wide[:, ::2] = CUBE
    for vertices in (wide[:, ::2], np.asfortranarray(CUBE), CUBE.tolist(), CUBE[::-1][::-1]):
        np.testing.assert_array_equal(snug.Surface(vertices, CUBE_FACES.tolist()).vertices, CUBE)


def test_faces_of_several_sizes():
    vertices = np.vstack([CUBE, [[0, 0, 2]]])
    faces = [list(face) for face in CUBE_FACES if list(face) != [1, 5, 7, 3]] + [[1, 5, 8], [5, 7, 8], [7, 3, 8], [3, 1, 8]]
    made = snug.Surface(vertices, faces)
    assert [list(face) for face in made.faces] == faces and made.is_closed
    for same in (tuple(map(tuple, faces)), [np.array(face) for face in faces], [np.array(face, np.uint8) for face in faces], iter(faces),
                 [np.array(faces[0], "u1"), *faces[1:]], [[np.int8(i) for i in face] for face in faces], np.array([*map(list, faces)], object)):
        assert [list(face) for face in snug.Surface(vertices, same).faces] == faces
    for wrong, error, said in (([[0, 1, 2], [0, -1, 2]], ValueError, "face 1 has the index -1"), ([[0, 1, 2], [0, 1, 10**30]], ValueError, "face 1"),
                               ([[0, 1, 2], [0, 1.5, 2]], TypeError, "face 1"), ([[0, 1, 2], [True, False, True]], TypeError, "face 1")):
        with pytest.raises((error, TypeError), match=said):
            snug.Surface(vertices, wrong)


def test_objects_with_meshes(cube):
    trimesh = types.SimpleNamespace(vertices=CUBE, faces=CUBE_FACES)
    open3d = types.SimpleNamespace(vertices=CUBE, triangles=CUBE_FACES[:, :3])
    meshio = types.SimpleNamespace(
        points=CUBE, cells=[types.SimpleNamespace(type="vertex", data=[[0]]), types.SimpleNamespace(type="quad", data=CUBE_FACES)]
    )
    assert snug.Surface(trimesh).scheme == "catmark"
    assert snug.Surface(open3d).scheme == "flat"
    np.testing.assert_array_equal(snug.Surface(meshio).faces, CUBE_FACES)
    tagged = snug.Surface(CUBE, CUBE_FACES, creases=[(0, 1, 2.5)], scheme="bilinear")
    assert snug.Surface(tagged).creases == [(0, 1, 2.5)] and snug.Surface(tagged).scheme == "bilinear"
    assert snug.Surface(cube.tessellate("5%")).scheme == "flat"
    assert snug.Surface(cube.subdivided(1)).is_closed
    with pytest.raises(TypeError, match="neither"):
        snug.Surface(object())
    meshio.cells.append(types.SimpleNamespace(type="quad8", data=np.zeros((3, 8), int)))
    with pytest.warns(snug.MeshWarning, match="quad8 are left out: 3"):
        snug.Surface(meshio)


def test_tags():
    tags = dict(creases=[(0, 1, 2), (1, 3, np.inf)], corners=np.array([[5, 10.0]]), holes=[3])
    made = snug.Surface(CUBE, CUBE_FACES, crease_method="chaikin", boundary="edge-only", **tags)
    assert made.creases == [(0, 1, 2.0), (1, 3, 10.0)] and made.corners == [(5, 10.0)] and made.holes == [3]
    assert made.boundary == "edge-only" and not made.is_closed
    sharp = snug.Surface(CUBE, CUBE_FACES, sharp="auto")
    assert len(sharp.creases) >= 12
    welded = snug.Surface(CUBE[CUBE_FACES].reshape(-1, 3), np.arange(24).reshape(6, 4), weld=True)
    assert len(welded.vertices) == 8 and welded.is_closed


def test_points_near_the_surface(cube):
    points = np.array([[9, 0, 0], [0.1, 0.2, 5]])
    exact, near = (cube.closest_point(points, absolute=0.02, witness=witness) for witness in ("exact", "approximate"))
    assert (exact.error < 1e-12).all() and (near.error > 1e-12).all()
    assert (np.abs(cube.evaluate(near.face, near.u, near.v, near.corner).point - near.point) <= near.error[:, None] + 1e-12).all()
    with pytest.raises(ValueError, match="witness: 'roughly' is none of"):
        cube.closest_point(points, witness="roughly")
    with pytest.raises(ValueError):
        cube.closest_point(points, witness="\ud800")


def test_update(cube):
    before, far = cube.vertices, cube.closest_point([9, 0, 0])
    copied = copy.copy(cube)
    cube.update(CUBE * 2)
    np.testing.assert_array_equal(before, CUBE)
    np.testing.assert_array_equal(cube.vertices, CUBE * 2)
    assert cube.closest_point([9, 0, 0]).upper < far.lower
    assert copied.closest_point([9, 0, 0]).lower == far.lower
    for other, points in ((copied, CUBE * 4), (cube, CUBE * 3), (copied, CUBE), (cube, CUBE * 2)):  # each by itself
        other.update(points)
        np.testing.assert_array_equal(other.vertices, points)
    assert copied.closest_point([9, 0, 0]).lower == far.lower
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(cube)).vertices, CUBE * 2)
    quick = cube.ray([0, 0, 9], [0, 0, -1], certified=False, error=1e-3).t
    cube.update(CUBE)
    assert cube.ray([0, 0, 9], [0, 0, -1], certified=False, error=1e-3).t > quick + 0.5
    for wrong in (CUBE[:-1], CUBE * np.nan):
        with pytest.raises(ValueError):
            cube.update(wrong)
    np.testing.assert_array_equal(cube.vertices, CUBE)


def test_views_keep_memory(cube):
    vertices, faces = cube.vertices, snug.Surface(CUBE, CUBE_FACES).faces
    lower = snug.collide(cube, cube, pose_b=[moved(9)] * 1000).lower
    inner = cube.hull("5%").inner.vertices
    kept = inner.copy()
    cube.update(CUBE * 3)
    del cube
    gc.collect()
    ballast = [np.full((8, 3), 7.0) for _ in range(1000)]
    np.testing.assert_array_equal(vertices, CUBE)
    np.testing.assert_array_equal(faces, CUBE_FACES)
    np.testing.assert_array_equal(inner, kept)
    assert (lower == lower[0]).all() and len(ballast) == 1000


def test_pickle_and_copies(bracket, pin):
    tagged = snug.Surface(CUBE, CUBE_FACES, creases=[(0, 1, 2.5)], holes=[2], boundary="none", scheme="catmark", bounds="table")
    for made in (bracket, tagged, snug.read(MODELS / "pawn.obj")):
        for again in (pickle.loads(pickle.dumps(made)), copy.copy(made), copy.deepcopy(made)):
            np.testing.assert_array_equal(again.vertices, made.vertices)
            assert (again.scheme, again.boundary, again.creases, again.holes) == (made.scheme, made.boundary, made.creases, made.holes)
            assert again.measure().area == made.measure().area
    mesh = pickle.loads(pickle.dumps(tagged.subdivided(1)))
    assert mesh.creases == tagged.subdivided(1).creases and len(mesh.creases) == 2
    for hit in (snug.collide(bracket, pin), snug.collide(bracket, pin, pose_b=[moved(3), moved(0)])):
        again = pickle.loads(pickle.dumps(hit))
        np.testing.assert_array_equal(again.points, hit.points)
        assert again.verdict == hit.verdict
    with pytest.raises(ValueError):
        snug.Collision.__new__(snug.Collision).__setstate__(("0", 1, True, b""))


def properties(answer):
    return {
        name: getattr(answer, name)
        for name in dir(type(answer))
        if not name.startswith("_") and isinstance(getattr(type(answer), name), property)
    }


def every_answer(cube):
    """One of each class, of one question and of many, and some that have nothing to say."""
    one, many = [0.25, 0.5, 3.0], [[0.25, 0.5, 3.0], [0, 0, 0.1]]
    hulls = cube.hull("5%")
    answers = [
        cube.bound(level=1), cube.bound(error="5%"), cube.tessellate("5%", corners=True), hulls, hulls.inner, cube.hull("5%", inner=False), cube.envelope("5%"),
        cube.measure(), snug.Surface(CUBE, CUBE_FACES[1:]).measure(), snug.deviation(cube, cube.tessellate("5%"), solid=True),
        snug.deviation(cube, cube).from_surface, cube.evaluate(0, 0.5, 0.5), cube.evaluate([0, 1], 0.25, 0.5),
    ]
    for points in (one, many, np.empty((0, 3))):
        answers += [cube.closest_point(points), cube.signed_distance(points), cube.contains(points)]
        answers += [cube.ray(points, [0, 0, -1], query="all"), cube.ray(points, [0, 0, -1], certified=False)]
    return answers


# Where there may be none of what an array has in each row.
MAY_BE_MISSING = {"witness", "points", "parameters", "normal", "axis", "angle"}


def test_arrays_are_read_only_and_made_once(cube):
    cone = snug.Surface([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]], scheme="flat")
    answers = every_answer(cube) + [cube, cone, cube.subdivided(1), cone.evaluate(0, 0, 0), cone.ray([0.1, 0.1, 9], [0, 0, -1])]
    for how in ({"pose_b": moved(9)}, {"pose_b": [moved(9), moved(0.5)]}, {"pose_b": np.empty((0, 4, 4))}):
        answers += [snug.collide(cube, cube, witness=witness, **how) for witness in ("none", "exact")]
        answers += [snug.distance(cube, cube, **how), snug.penetration(cube, cube, **how), snug.collide(cube, cube, solid=True, **how)]
    seen = set()
    for answer in answers:
        for name, array in properties(answer).items():
            where = f"{type(answer).__name__}.{name}"
            if isinstance(array, float):
                assert not np.isnan(array), where
            if not isinstance(array, np.ndarray):
                continue
            seen.add(where)
            assert not array.flags.writeable, where
            again = getattr(answer, name)
            assert again is array or array.size == 0 or (np.shares_memory(again, array) and again.strides == array.strides), where
            if array.dtype.kind == "f" and name not in MAY_BE_MISSING:
                assert not np.isnan(array).any(), where
    assert len(seen) > 60
    hits = snug.collide(cube, cube, pose_b=[moved(9)] * 3)
    kept = hits.points
    assert hits.points is kept and hits[1].points is not kept
    del hits, answer, answers
    gc.collect()
    assert kept.shape == (3, 2, 3)


def test_arrays_do_not_keep_answers(cube):
    """A cycle of an answer and its arrays would last as long as the process."""
    answer = snug.collide(cube, cube, pose_b=[moved(9)] * 1000)
    lower, points = answer.lower, answer.points
    holders = sys.getrefcount(answer)
    del lower
    assert sys.getrefcount(answer) == holders - 1
    del points
    assert sys.getrefcount(answer) == holders - 1


def test_every_answer_is_pickled_and_copied(cube):
    for answer in every_answer(cube):
        for again in (pickle.loads(pickle.dumps(answer)), pickle.loads(pickle.dumps(answer, protocol=5)), copy.copy(answer), copy.deepcopy(answer)):
            assert type(again) is type(answer) and repr(again) == repr(answer)
            for (name, x), (_, y) in zip(properties(answer).items(), properties(again).items()):
                if type(x).__module__ == "snug":  # hulls within hulls
                    np.testing.assert_equal(properties(x), properties(y), name)
                else:
                    np.testing.assert_equal(x, y, name)
    for cls in (type(cube.bound()), snug.Tessellation, snug.Hulls, snug.RayHits, snug.Measures):
        for state in ((), ("0", 1, b""), (snug.__version__, 1, ())):
            with pytest.raises((ValueError, TypeError)):
                cls.__new__(cls).__setstate__(state)


def test_files(tmp_path, cube):
    for name in ("a.obj", "b.off", "c.ply", "d.usda", "ä.obj"):
        cube.write(tmp_path / name)
        np.testing.assert_array_equal(snug.read(tmp_path / name).vertices, CUBE)
    tagged = snug.Surface(CUBE, CUBE_FACES, creases=[(0, 1, 2.5)], boundary="edge-only")
    tagged.write(str(tmp_path / "tagged.obj"))
    again = snug.read(str(tmp_path / "tagged.obj").encode())
    assert again.creases == tagged.creases and again.boundary == "edge-only"
    with pytest.warns(snug.MeshWarning):
        tagged.write(tmp_path / "tagged.off")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(snug.MeshWarning):
            tagged.write(tmp_path / "again.off")


def test_cones_of_normals(cube):
    bound = cube.bound(level=3, normals=True)
    assert bound.axis.shape == (len(bound), 3) and bound.angle.shape == (len(bound),)
    assert np.isfinite(bound.angle).all() and np.isnan(cube.bound(level=3).axis).all()
    points = cube.evaluate(np.repeat(np.arange(6), 20), *np.random.default_rng(1).random((2, 120)))
    for face, normal in zip(np.repeat(np.arange(6), 20), points.normal):
        own = bound.face == face
        assert (bound.axis[own] @ normal >= np.cos(bound.angle[own]) - 1e-9).any()


def test_boxes_of_a_motion(cube):
    end = cube.vertices * [1, 2, 1] + [0.3, 0, 0]
    boxes = cube.boxes(end=end)
    faces, at = np.repeat(np.arange(6), 20), np.random.default_rng(1).random((2, 120))
    for time in (0, 0.3, 1):
        points = snug.Surface((1 - time) * cube.vertices + time * end, cube.faces).evaluate(faces, *at).point
        assert (boxes[faces, 0] <= points).all() and (points <= boxes[faces, 1]).all()
    with pytest.raises(ValueError, match="level is 0"):
        cube.boxes(1, end=end)
    with pytest.raises(ValueError):
        cube.boxes(end=end[1:])


def test_shapes(cube):
    bound = cube.bound(error="1%")
    assert bound.outcome == "complete" and bound.max_radius <= 0.005 * cube.size * 1.0001 and len(bound) == len(bound.pieces) == len(bound.radius)
    assert bound.base.shape == bound.lower.shape == bound.corners.shape == (len(bound), 3, 3)
    assert (bound.lower <= bound.upper).all()
    boxes = cube.boxes()
    assert boxes.shape == (6, 2, 3)
    points = cube.evaluate(np.repeat(np.arange(6), 50), *np.random.default_rng(1).random((2, 300)))
    for own in (boxes[np.repeat(np.arange(6), 50)], cube.boxes(level=3)[np.repeat(np.arange(6), 50)]):
        assert (own[:, 0] <= points.point).all() and (points.point <= own[:, 1]).all()
    mesh = cube.tessellate("1%", corners=True)
    assert mesh.outcome == "complete" and mesh.error_bound <= 0.01 * cube.size and mesh.faces.max() < len(mesh.vertices)
    assert mesh.corner_parameters.shape == (len(mesh.faces), 3, 2) and mesh.normals.shape == mesh.vertices.shape
    assert len(mesh.owners) == len(mesh.corner_corners) == len(mesh.faces)
    deviation = snug.deviation(cube, mesh)
    assert deviation.from_surface.lower <= mesh.error_bound and deviation.inside is None
    assert snug.deviation(cube, cube).from_candidate.lower == 0
    assert deviation.verdict is None and snug.deviation(cube, mesh, threshold="50%").verdict == "within"
    assert snug.deviation(cube, mesh, threshold=0).verdict == "exceeds"
    around = cube.envelope("2%", clearance="1%")
    assert around.outcome == "complete" and around.problems == [] and around.clearance * 2 == around.error
    assert np.all(cube.closest_point(around.vertices).upper >= around.clearance)
    low, high = around.volume
    assert cube.measure().volume[1] < low <= high
    assert around.bridges.shape == (0,) and around.bridge_distance == 0
    tube = snug.Surface([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (0.2, 0), (0.2, 0.2), (0, 0.2))],
                        [[k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)], scheme="bilinear")
    filled = tube.envelope("2%", gap="24%")
    assert filled.outcome == "complete" and filled.volume[0] > 0.04 and tube.envelope("2%").volume[1] < 0.03
    assert len(filled.bridges) > 0 and filled.bridge_distance > filled.error and filled.bridges.max() < len(filled.faces)
    inner, outer = hulls = cube.hull("2%")
    assert hulls.outcome == "complete" and hulls.closed and hulls.problems == []
    assert cube.signed_distance(inner.vertices).upper.max() < 0 < cube.signed_distance(outer.vertices).lower.min()
    assert cube.hull("2%", inner=False).inner is None
    measures = cube.measure()
    assert measures.outcome == "complete" and measures.volume[0] <= measures.volume[1] and measures.centroid.shape == (3, 2)
    assert cube.subdivided(2).faces.shape == (96, 4)
    assert snug.Surface(CUBE, CUBE_FACES[1:]).measure().volume is None
    assert np.isnan(snug.Surface(CUBE, CUBE_FACES, holes=[2]).boxes()[2]).all()


def test_view(cube, tmp_path):
    template = tmp_path / "template.html"
    template.write_text('<p><script type="application/json" id="snug-data">{}</script></p>')
    hit = snug.collide(cube, cube, pose_b=moved(9))
    page = snug.view(cube, cube, hit, poses=[None, moved(9)], template=template, path=tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.html and "v 1 1 1" not in page.html
    assert page.html.startswith("<p><script") and page.html.endswith("</script></p>") and "separated" in page.html
    assert page._repr_html_().startswith("<iframe srcdoc=") and repr(page).startswith("<snug.Page")
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    for pose in ((turn, [9, 0, 0]), ([np.sqrt(0.5), 0, 0, np.sqrt(0.5)], [9, 0, 0]), np.hstack([turn, [[9], [0], [0]]])):
        assert '"place": [' in snug.view(cube, poses=[pose], template=template).html
    assert snug.view(cube, cube, poses=np.stack([moved(1), moved(9)]), template=template).html.count('"place": [') == 2
    for wrong in (np.eye(3), "abc", np.eye(4)[None]):
        with pytest.raises((ValueError, TypeError), match=r"poses\[0\]"):
            snug.view(cube, poses=[wrong], template=template)
    with pytest.raises(snug.PoseError, match=r"poses\[1\]"):
        snug.view(cube, cube, poses=[None, 2 * np.eye(4)], template=template)
    with pytest.raises(snug.FileError) as caught:
        snug.view(cube, template=template, path=tmp_path / "no" / "page.html")
    assert caught.value.filename == str(tmp_path / "no" / "page.html")
    with pytest.raises(TypeError):
        snug.view(hit, cube, template=template)
    with pytest.raises(snug.FileError, match="make page"):
        snug.view(cube, template=tmp_path / "none.html")
    data = json.loads(page.html.split(">", 2)[2].split("</script>")[0])
    assert [part["file"] for part in data["parts"]] == [0, 1] and len(data["files"]) == 2
    assert all("still" not in file for file in data["files"])


def test_view_without_the_page_with_answers(cube, monkeypatch):
    from snug import _view

    still = pathlib.Path(_view.__file__).parent / "still.html"
    monkeypatch.setattr(_view, "_page", lambda template: still)
    page = snug.view(cube).html
    data = json.loads(page.split('id="snug-data">')[1].split("</script>")[0])
    positions = np.frombuffer(base64.b64decode(data["files"][0]["still"]["positions"]), "<f4").reshape(-1, 3)
    triangles = np.frombuffer(base64.b64decode(data["files"][0]["still"]["triangles"]), "<u4").reshape(-1, 3)
    assert len(triangles) > 100 and triangles.max() + 1 == len(positions) and np.abs(positions).max() <= 1


def test_write_step(tmp_path):
    cube = snug.read(MODELS / "bracket.obj")
    found = cube.write_step(tmp_path / "part.step", "0.1%", units="inch", name="a part")
    assert found["outcome"] == "complete" and found["solids"] == 1 and found["sheets"] == 0
    assert found["error_bound"] <= 0.001 * cube.size and found["gap_bound"] < 1e-12
    text = (tmp_path / "part.step").read_text()
    assert len(text) == found["bytes"]
    assert "MANIFOLD_SOLID_BREP('a part'" in text and "'INCH'" in text
    flatter = cube.write_step(tmp_path / "part.step", "0.1%", max_angle=0.05)
    assert flatter["break_angle"] <= 0.05 < found["break_angle"] and flatter["spans"] > found["spans"]
    for wrong in ({"units": "yard"}, {"protocol": "ap203"}, {"max_angle": 100}):
        with pytest.raises(ValueError):
            cube.write_step(tmp_path / "other.step", **wrong)
    assert not (tmp_path / "other.step").exists()
