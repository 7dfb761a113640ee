"""The module and the command, digit by digit."""

import json
import os
import subprocess

import numpy as np
import pytest

import snug
from conftest import MODELS, PROGRAMS, ROOT, moved, turned

COMMAND = os.environ.get("SNUG_COMMAND", str(ROOT / "build/release/bin/snug"))
pytestmark = pytest.mark.skipif(not os.path.exists(COMMAND), reason="the command is not built")

PAIRS = [("bracket", "pin"), ("pawn", "bust"), ("ring", "star")]
POSES = [moved(), moved(0, 0, 0.5), turned(135, 0.05, 0.05, 0.5), turned(17, 1.1, -0.3, 0.2), turned(80, 9, 1, 2)]


def output_of(*words, stdin=None):
    done = subprocess.run([COMMAND, *map(str, words), "--json", "--quiet"], capture_output=True, text=True, input=stdin,
                          env=PROGRAMS)
    assert done.stdout, done.stderr
    return json.loads(done.stdout)


def text(pose):
    return " ".join(map(repr, pose[:3].reshape(-1).tolist()))


def same_pair(document, answer):
    upper = document["distance"][1]
    assert [document["distance"][0], np.inf if upper is None else upper] == [answer.lower, answer.upper]
    if document["witness"] is None:
        assert np.isnan(answer.points).all()
    else:
        assert document["witness"] == answer.points.tolist() and document["witness_error"] == answer.error
        for i, at in enumerate(document["witness_at"]):
            if at is None:
                assert answer.faces[i] == -1
            else:
                assert [at.get("face", at.get("vertex")), at["u"], at["v"]] == [answer.faces[i], *answer.parameters[i]]
    assert (-1 if document["contained"] is None else "ab".index(document["contained"]) if isinstance(document["contained"], str) else document["contained"]) == answer.contained
    assert document["stats"] == answer.stats


@pytest.mark.parametrize("names", PAIRS)
def test_pairs(names):
    files = [MODELS / f"{name}.obj" for name in names]
    a, b = map(snug.read, files)
    for pose in POSES:
        document = output_of("collide", *files, "--place-b", text(pose))
        answer = snug.collide(a, b, pose_b=pose, measure=True, prove_contact=True)
        assert document["verdict"] == answer.verdict
        same_pair(document, answer)
        document, answer = output_of("distance", *files, "--place-b", text(pose)), snug.distance(a, b, pose_b=pose)
        assert document["outcome"] == answer.outcome
        same_pair(document, answer)
    many = snug.collide(a, b, pose_b=POSES, measure=True, prove_contact=True)
    for i, pose in enumerate(POSES):
        assert output_of("collide", *files, "--place-b", text(pose))["distance"][0] == many.lower[i]


def test_solids_and_options():
    files = MODELS / "bracket.obj", MODELS / "pin.obj"
    a, b = map(snug.read, files)
    document = output_of("collide", *files, "--place-b", text(moved(0, 0, 0.5)), "--solid", "--margin", "1%", "--tolerance", "0.01")
    same_pair(document, snug.collide(a, b, pose_b=moved(0, 0, 0.5), solid=True, margin="1%", tolerance=0.01, measure=True, prove_contact=True))
    document = output_of("distance", *files, "--absolute", "0", "--relative", "1e-6")
    same_pair(document, snug.distance(a, b, relative=1e-6))


def test_motions(tmp_path):
    files = MODELS / "bracket.obj", MODELS / "pin.obj"
    a, b = map(snug.read, files)
    poses = [moved(0, 0, 2), turned(30, 0.1, 0, 1), moved(0, 0, 0.5)]
    (tmp_path / "path.txt").write_text("".join(text(pose) + "\n" for pose in poses))
    for document, answer in (
        (output_of("time-of-contact", *files, "--path-b", tmp_path / "path.txt"), snug.time_of_contact(a, None, b, poses)),
        (
            output_of("time-of-contact", *files, "--place-b", text(poses[0]), "--velocity-b", "0 0 -2", "--solid"),
            snug.time_of_contact(a, None, b, snug.Trajectory.steady(poses[0], velocity=[0, 0, -2]), solid=True),
        ),
    ):
        assert [document["verdict"], document["outcome"], document["steps"]] == [answer.verdict, answer.outcome, answer.steps]
        same_pair({**document, "distance": document["time"]}, answer)


def test_all_contacts():
    files = MODELS / "bracket.obj", MODELS / "pin.obj"
    a, b = map(snug.read, files)
    document = output_of("collide", *files, "--place-b", text(moved(0, 0, 0.5)), "--all")
    found = snug.contacts(a, b, pose_b=moved(0, 0, 0.5))
    assert document["exhaustive"] == found.exhaustive and len(document["open"]) == len(found.open)
    for one, curve in zip(document["curves"], found.curves):
        assert [one["points"], one["closed"], one["proved"], one["error"]] == [curve.points.tolist(), curve.closed, curve.proved, curve.error]
        assert [each["box"] for each in one["boxes"]] == curve.boxes.tolist()
        assert [each["one_arc"] for each in one["boxes"]] == curve.one_arc.tolist()
    for i, one in enumerate(document["regions"]):
        region = found.regions[i]
        assert [one["verdict"], one["distance"], one["box"]] == [region.verdict, [region.lower, region.upper], region.box.tolist()]
        assert [one["witness"], one["owners"]] == [region.points.tolist(), [owners.tolist() for owners in region.owners]]


@pytest.mark.parametrize("scheme", ["catmark", "bilinear", "midedge"])
def test_self_contact(scheme, tmp_path):
    file = tmp_path / "two.obj"
    box = [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]]
    corners = box + (np.array(box) + 0.4).tolist()
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(
        f"f {a} {b} {c} {d}\n" for a, b, c, d in faces + (np.array(faces) + 8).tolist()))
    document, answer = output_of("self-contact", file, "--scheme", scheme), snug.read(file, scheme=scheme).self_contact()
    assert [document["verdict"], document["outcome"], document["stats"]] == [answer.verdict, answer.outcome, answer.stats]
    pairs = document["pairs"]
    assert [p["witness"] for p in pairs] == answer.pairs.points.tolist() and len(pairs) > 0
    assert [p["distance"] for p in pairs] == np.column_stack([answer.pairs.lower, answer.pairs.upper]).tolist()
    assert [[at.get("face", at.get("vertex")) for at in p["witness_at"]] for p in pairs] == answer.pairs.faces.tolist()
    assert [p["touching"] for p in pairs] == answer.pairs.touching.tolist()


@pytest.mark.parametrize("name", ["bracket", "pawn"])
@pytest.mark.parametrize("scheme", ["auto", "doo-sabin"])
def test_one_surface(name, scheme, tmp_path):
    file = MODELS / f"{name}.obj"
    surface = snug.read(file, scheme=scheme)
    points = np.random.default_rng(3).uniform(-1, 1, (20, 3)) * surface.size
    (tmp_path / "points.txt").write_text("".join(" ".join(map(repr, p)) + "\n" for p in points.tolist()))
    results = output_of("closest", file, "--points", tmp_path / "points.txt", "--signed", "--scheme", scheme)["results"]
    near, signed, inside = surface.closest_point(points), surface.signed_distance(points), surface.contains(points)
    assert [r["distance"] for r in results] == np.column_stack([near.lower, near.upper]).tolist()
    assert [r["point"] for r in results] == near.point.tolist()
    assert [r["signed_distance"] for r in results] == np.column_stack([signed.lower, signed.upper]).tolist()
    assert [r["inside"] for r in results] == inside.inside.tolist()
    measures = surface.measure()
    document = output_of("measure", file, "--scheme", scheme)
    assert [document["area"], document["volume"]] == [list(measures.area), list(measures.volume)]
    assert [document["centroid"], document["inertia"]] == [measures.centroid.tolist(), measures.inertia.tolist()]
    pieces = output_of("bound", file, "--error", "5%", "--scheme", scheme)["enclosures"]
    bound = surface.bound(error="5%")
    for key in ("piece", "level", "lower", "upper", "base", "radius", "corners"):
        assert [p[key] for p in pieces] == np.asarray(getattr(bound, "pieces" if key == "piece" else key)).tolist()
    rays = "".join(" ".join(map(repr, p)) + " 0.1 0.2 -1\n" for p in points.tolist())
    hits = surface.ray(points, [0.1, 0.2, -1], query="all")
    flat = [hit for r in output_of("ray", file, "--rays", "-", "--all", "--scheme", scheme, stdin=rays)["results"] for hit in r["hits"]]
    assert [h["t"] for h in flat] == np.column_stack([hits.lower, hits.upper]).tolist()
    assert [h["side"] for h in flat] == hits.side.tolist()
