"""Questions of every kind, at the command and in Python: members of one name have the same digits.

SNUG_QUESTIONS (12) of each, asked by tests/doors/ask.py, or those that it has left in the file SNUG_ANSWERS.
"""

import functools
import json
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import PROGRAMS, ROOT
from test_command import COMMAND

import snug

pytestmark = pytest.mark.skipif(not os.path.exists(COMMAND), reason="the command is not built")


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


def same(document, answer):
    """Compares the members that both have; how many?"""
    compared = 0
    for i, at in enumerate(document.get("witness_at") or [] if hasattr(answer, "faces") else []):
        here = (answer.faces[i], answer.corners[i], *answer.parameters[i])
        assert here[0] == -1 if at is None else here == (at.get("face", at.get("vertex")), at.get("corner", 0), at["u"], at["v"])
    for name, ought in document.items():
        members = answer if isinstance(answer, dict) else dir(type(answer))
        if name.endswith("_at") or name not in members:
            continue
        here = answer[name] if isinstance(answer, dict) else getattr(answer, name)
        if name == "contained":
            ought = -1 if ought is None else "ab".index(ought)
        if isinstance(ought, dict) and not isinstance(here, dict):
            compared += same(ought, here)
        elif isinstance(ought, list) and (type(here).__module__ == "snug" or (ought and isinstance(ought[0], dict))):
            assert len(ought) == len(here)
            if isinstance(here, list):
                compared += sum(same(one, answer) for one, answer in zip(ought, here))
                continue
            for column in ought[0] if ought and not isinstance(here, np.ndarray) else ():
                if hasattr(type(here), column) and not column.endswith("_at") and column != "contacts":
                    assert plain([each[column] for each in ought]) == plain(getattr(here, column)), (name, column)
        elif name in ("positions", "triangles"):
            assert ought == np.ravel(here).tolist(), name
        elif ought is None and (name.startswith("witness") or name in ("normal", "centroid", "inertia", "volume")):
            assert here is None or np.isnan(here).all()
        else:
            assert plain(here) == ought, name
        compared += 1
    return compared


@functools.lru_cache(16)
def surface_of(file, scheme):
    return snug.read(file, **({} if scheme == "auto" else {"scheme": scheme}))


def of_pair(line, a, b):
    ask, options = getattr(snug, line["ask"]), dict(line["options"])
    if "path" in line:
        return ask(a, None, b, snug.Trajectory.through([np.reshape(pose, (3, 4)) for pose in line["path"]]), **options)
    if line["ask"] == "collide":
        options.update(measure=True, prove_contact=True)
    return ask(a, b, pose_b=np.reshape(line["pose"], (3, 4)), **options)


def of_one(line, surface, folder):
    ask, options, document = line["ask"], line["options"], line["document"]
    if ask == "contains":
        found = surface.contains(*line["args"])
        assert document["inside"] == (True if found.inside else False if found.outside else None)
    elif ask == "ray":
        hits = surface.ray(*line["args"], query="all")
        for member in ("t", "certified", "side", "point", "error", "u", "v"):
            assert [hit[member] for hit in document["hits"]] == plain(getattr(hits, member)), member
        return hits
    elif ask == "evaluate":
        face, u, v, corner = line["args"]
        return surface.evaluate(face, u, v, corner=corner)
    elif ask == "limit_to_faces":
        assert document["limit_to_faces"] == surface.limit_to_faces()
    elif ask == "bound":
        bounds = surface.bound(**options)
        for member in ("level", "base", "radius", "lower", "upper", "corners"):
            assert [each[member] for each in document["enclosures"]] == plain(getattr(bounds, member)), member
        return bounds
    elif ask == "deviation":
        triangles = line["candidate"]
        mesh = SimpleNamespace(vertices=np.reshape(triangles["positions"], (-1, 3)), faces=np.reshape(triangles["triangles"], (-1, 3)))
        return snug.deviation(surface, mesh, **options)
    elif ask == "subdivided":
        assert document["positions"] == surface.subdivided(options["level"]).vertices.ravel().tolist()
    elif ask == "step":
        path = folder / f"{os.path.basename(line['files'][0])[:-4]}.step"  # the part's name is the file's
        made = surface.write_step(path, **options)
        text = path.read_text()
        assert document["text"] == text[text.index("DATA;") :]
        return made
    elif ask in ("closest_point", "signed_distance"):
        return getattr(surface, ask)(*line["args"])
    else:
        return getattr(surface, ask)(**options)
    return None


def test_questions_of_every_kind(tmp_path):
    answers = os.environ.get("SNUG_ANSWERS", tmp_path / "answers.jsonl")
    if "SNUG_ANSWERS" not in os.environ:
        subprocess.run([sys.executable, ROOT / "tests/doors/ask.py", COMMAND, os.environ.get("SNUG_QUESTIONS", "12"), tmp_path], check=True, env=PROGRAMS)
    counts = {}
    with open(answers) as file:
        for number, line in enumerate(map(json.loads, file), 1):
            try:
                surfaces = [surface_of(path, line["scheme"]) for path in line["files"]]
                answer = of_pair(line, *surfaces) if len(surfaces) == 2 else of_one(line, *surfaces, tmp_path)
                if answer is not None:
                    assert same(line["document"], answer) >= 2
            except BaseException as error:
                raise AssertionError(f"line {number}, {line['ask']} {line['files']} {line['scheme']}: {error}") from error
            counts[line["ask"]] = counts.get(line["ask"], 0) + 1
    print(counts)
    assert len(counts) == 21 and min(counts.values()) >= 10
