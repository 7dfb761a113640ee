"""Questions of every kind, random ones, at the command and in Python: members of one name have the same digits.

A thousand questions of each kind that the command takes by files; of others SNUG_QUESTIONS (2) of each surface.
"""

import os

import numpy as np
import pytest

import snug
from conftest import MODELS
from test_command import COMMAND, output_of, text

pytestmark = pytest.mark.skipif(not os.path.exists(COMMAND), reason="the command is not built")

MANY = 1000
FEW = int(os.environ.get("SNUG_QUESTIONS", 2))
PAIRS = [("bracket", "pin", "auto"), ("ring", "star", "auto"), ("pawn", "bust", "auto"), ("bracket", "pin", "doo-sabin"), ("star", "ring", "flat")]
ALONE = [("bracket", "auto"), ("star", "auto"), ("pawn", "auto"), ("pin", "bilinear"), ("bracket", "midedge"), ("ring", "flat")]


def plain(value):
    """Lists, numbers and words; what is not there or infinite is None."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value.item() if isinstance(value, np.generic) else value


def told(document, name):
    value = document[name]
    if name == "contained":
        return -1 if value is None else "ab".index(value)
    return value


def same(document, answer, least=3):
    """Members that both have; at least so many."""
    compared = 0
    for name in document:
        member = "face" if name == "vertex" else name
        if name.endswith("_at") or not hasattr(type(answer), member):
            continue
        here, ought = getattr(answer, member), told(document, name)
        if isinstance(ought, list) and (type(here).__module__ == "snug" or (ought and isinstance(ought[0], dict))):
            assert len(ought) == len(here)
            for column in ought[0] if ought and not isinstance(here, (list, np.ndarray)) else ():
                if hasattr(type(here), column) and not column.endswith("_at") and column != "contacts":
                    assert plain([each[column] for each in ought]) == plain(getattr(here, column)), (name, column)
        elif ought is None and name.startswith("witness"):
            assert np.isnan(here).all()
        else:
            assert plain(here) == ought, name
        compared += 1
    assert compared >= least, (compared, list(document))


def poses(size, count, seed):
    random = np.random.default_rng(seed)
    all_of_them = np.tile(np.eye(4), (count, 1, 1))
    for pose in all_of_them:
        q, r = np.linalg.qr(random.normal(size=(3, 3)))
        q = q * np.sign(np.diag(r))
        q[:, 0] *= np.sign(np.linalg.det(q))
        pose[:3, :3] = q if random.random() < 0.8 else np.eye(3)
        pose[:3, 3] = random.uniform(-1, 1, 3) * size * random.choice([0.3, 1, 2])
    return all_of_them


def surfaces(*names, scheme):
    return [snug.read(MODELS / f"{name}.obj", **({} if scheme == "auto" else {"scheme": scheme})) for name in names]


@pytest.mark.parametrize("names", PAIRS)
def test_pairs(names, tmp_path):
    a, b = surfaces(*names[:2], scheme=names[2])
    files = [MODELS / f"{name}.obj" for name in names[:2]]
    how = ["--scheme", names[2]]
    placed = poses(max(a.size, b.size), max(MANY // len(PAIRS), FEW + 2), 1)
    (tmp_path / "poses").write_text("".join(text(pose) + "\n" for pose in placed))
    for question, answers in (
        ("collide", snug.collide(a, b, pose_b=placed, measure=True, prove_contact=True)),
        ("distance", snug.distance(a, b, pose_b=placed)),
    ):
        document = output_of(question, *files, *how, "--poses", tmp_path / "poses")
        assert len(document["results"]) == len(placed)
        for one, answer in zip(document["results"], answers):
            same(one, answer, 5)
    for i in range(FEW):
        pose = text(placed[i])
        same(output_of("collide", *files, *how, "--place-b", pose, "--all"), snug.contacts(a, b, pose_b=placed[i]))
        (tmp_path / "path").write_text("".join(text(pose) + "\n" for pose in placed[i : i + 3]))
        moving = [*files, *how, "--path-b", tmp_path / "path"]
        try:
            path = snug.Trajectory.through(placed[i : i + 3])
        except snug.PoseError:
            continue
        margin = 0.01 * i
        same(output_of("time-of-contact", *moving, "--margin", margin), snug.time_of_contact(a, None, b, path, margin=margin), 7)
        same(output_of("clearance", *moving, "--absolute", "2%", "--relative", 0.2), snug.clearance(a, None, b, path, absolute="2%", relative=0.2), 8)
        if a.is_closed and b.is_closed:
            same(output_of("collide", *files, *how, "--place-b", pose, "--solid", "--penetration")["penetration"], snug.penetration(a, b, pose_b=placed[i]))


@pytest.mark.parametrize("name, scheme", ALONE)
def test_surfaces(name, scheme, tmp_path):
    (surface,) = surfaces(name, scheme=scheme)
    file, how = MODELS / f"{name}.obj", ["--scheme", scheme]
    random = np.random.default_rng(2)
    points = random.normal(size=(MANY // len(ALONE), 3)) * surface.size
    rows = "".join(" ".join(map(repr, p)) + "\n" for p in points.tolist())
    near = surface.closest_point(points)
    for one, answer in zip(output_of("closest", file, *how, "--points", "-", stdin=rows)["results"], near):
        same(one, answer, 6)
    if surface.is_closed:
        signed, inside = surface.signed_distance(points), surface.contains(points)
        for i, one in enumerate(output_of("closest", file, *how, "--points", "-", "--signed", stdin=rows)["results"]):
            assert one["signed_distance"] == plain(signed[i].distance)
            assert one["inside"] == (True if inside.inside[i] else False if inside.outside[i] else None)
    towards = near.point - points
    rays = "".join(" ".join(map(repr, o + d)) + "\n" for o, d in zip(points.tolist(), towards.tolist()))
    hits = surface.ray(points, towards, query="all")
    flat = [(i, hit) for i, one in enumerate(output_of("ray", file, *how, "--rays", "-", "--all", stdin=rays)["results"]) for hit in one["hits"]]
    assert [i for i, _ in flat] == hits.ray.tolist()
    for member in ("t", "certified", "side", "point", "error", "u", "v", "normal"):
        assert [hit[member] for _, hit in flat] == plain(getattr(hits, member)), member
    at = near[: 50 * FEW]
    places = "".join(f"{f} {u!r} {v!r} {c}\n" for f, u, v, c in zip(at.face.tolist(), at.u.tolist(), at.v.tolist(), at.corner.tolist()))
    if surface.scheme in ("loop", "flat"):
        places = "".join(" ".join(line.split()[:3]) + "\n" for line in places.splitlines())
    for one, answer in zip(output_of("eval", file, *how, "--at", "-", stdin=places)["points"], surface.evaluate(at.face, at.u, at.v, at.corner)):
        same(one, answer, 4)
    same(output_of("measure", file, *how), surface.measure(), 6)
    same(output_of("self-contact", file, *how), surface.self_contact(), 4)
    bounds = surface.bound(error="3%")
    document = output_of("bound", file, *how, "--error", "3%")
    assert [document["outcome"], document["max_radius"]] == [bounds.outcome, bounds.max_radius]
    for member in ("level", "base", "radius", "lower", "upper", "corners"):
        assert [each[member] for each in document["enclosures"]] == plain(getattr(bounds, member)), member
    if FEW < 3 and (name, scheme) != ("pin", "bilinear"):
        return  # what takes longest
    apart = snug.deviation(surface, surface.tessellate("1%"), absolute="0.1%")
    triangles = tmp_path / "triangles.obj"
    output_of("tessellate", file, *how, "--error", "1%", "-o", triangles)
    written = snug.read(triangles, scheme="flat")
    assert plain(written.vertices) == plain(surface.tessellate("1%").vertices)
    document = output_of("deviation", file, triangles, *how, "--absolute", "0.1%")
    assert [document["from_surface"], document["from_candidate"]] == [plain(apart.from_surface.distance), plain(apart.from_candidate.distance)]
    finer = tmp_path / "finer.obj"
    output_of("subdivide", file, *how, "--level", 1, "-o", finer)
    assert plain(snug.read(finer, scheme="bilinear").vertices) == plain(surface.subdivided(1).vertices)
    around = tmp_path / "around.obj"
    document = output_of("envelope", file, *how, "--error", "10%", "-o", around)
    assert plain(snug.read(around, scheme="flat").vertices) == plain(surface.envelope("10%").vertices) and document["outcome"] == "complete"
