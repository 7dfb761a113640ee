#!/usr/bin/env python3
"""Asks the command questions of every kind, and keeps what it answers for the other doors: ask.py SNUG COUNT FOLDER

FOLDER/answers.jsonl has a question a line: what is asked, the files and their scheme, options under the names that all doors spell in their way, and
the command's document. Each kind is asked COUNT times. Doors answer in one process each: digits_test.cpp, answers.mjs (Node and
Chromium) and tests/python/test_same_digits.py. The same COUNT gives the same questions.
"""

import json
import math
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from os import cpu_count
from pathlib import Path

MODELS = Path(__file__).resolve().parents[2] / "examples/models"
PAIRS = [("bracket", "pin", "auto"), ("ring", "star", "auto"), ("pawn", "bust", "auto"), ("bracket", "pin", "doo-sabin"), ("star", "ring", "flat")]
ALONE = [("bracket", "auto"), ("star", "auto"), ("pawn", "auto"), ("pin", "bilinear"), ("bracket", "midedge"), ("ring", "flat")]
draw = random.Random(1)


def rows(lists):
    return "".join(" ".join(map(repr, row)) + "\n" for row in lists)


def numbers(line, begin=1, kind=float):
    return [kind(word) for word in line.split()[begin:]]


def vertices_of(path):
    return [numbers(line) for line in path.read_text().splitlines() if line.startswith("v ")]


def size_of(path):
    return max(max(x) - min(x) for x in zip(*vertices_of(path)))


def pose(size):
    """A turn about any axis, or none, and a translation: near contact, or far."""
    w, x, y, z = (draw.gauss(0, 1) for _ in range(4)) if draw.random() < 0.8 else (1.0, 0.0, 0.0, 0.0)
    s = 2 / (w * w + x * x + y * y + z * z)
    way = [draw.uniform(-1, 1) * size * draw.choice([0.3, 1, 2]) for _ in range(3)]
    return [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y), way[0],
            s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x), way[1],
            s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y), way[2]]  # fmt: skip


class Command:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def ask(self, *words, stdin=None):
        """The document, or None where the question is refused."""
        done = subprocess.run([self.program, *map(str, words), "--json", "--quiet", "--threads", "1"], capture_output=True, text=True, input=stdin)
        # -0 is not the integer 0.
        return json.loads(done.stdout, parse_int=lambda digits: -0.0 if digits == "-0" else int(digits)) if done.stdout else None


def with_options(options):
    return [word for name, value in options.items() for word in (f"--{name.replace('_', '-')}", repr(value) if isinstance(value, float) else str(value))]


def pair_questions(command, count):
    """Of two surfaces: yields functions that give a line, or None."""
    for k, (a, b, scheme) in enumerate(PAIRS):
        files = [str(MODELS / f"{name}.obj") for name in (a, b)]
        size = max(map(size_of, map(Path, files)))
        of_pair = {"files": files, "scheme": scheme}
        share = [pose(size) for _ in range(math.ceil(count / len(PAIRS)) + 2)]
        placed = share[:-2]
        poses = command.folder / f"poses{k}"
        poses.write_text(rows(placed))
        for ask, options in (("collide", {"tolerance": 0.001 * size}), ("distance", {"absolute": 0.001 * size})):
            results = command.ask(ask, *files, "--scheme", scheme, "--poses", poses, *with_options(options))["results"]
            yield lambda ask=ask, of_pair=of_pair, options=options, results=results, placed=placed: [
                {"ask": ask, **of_pair, "pose": each, "options": options, "document": result} for each, result in zip(placed, results)]
        solids = all(name in ("bracket", "pin", "ring", "star", "pawn", "bust") for name in (a, b))
        for i, each in enumerate(placed):
            path = command.folder / f"path{k}.{i}"
            path.write_text(rows(share[i : i + 3]))
            place, moves = ["--place-b", rows([each]).strip()], ["--path-b", path]
            for ask, words, options in (
                ("contacts", ["collide", "--all", *place], {}),
                ("time_of_contact", ["time-of-contact", *moves], {"tolerance": 0.001 * size, "margin": 0.01 * (i % 3) * size}),
                ("clearance", ["clearance", *moves], {"absolute": 0.02 * size, "relative": 0.2}),
                ("penetration", ["collide", "--solid", "--penetration", *place], {}),
            ):
                if ask == "penetration" and not solids:
                    continue

                def one(ask=ask, words=words, options=options, files=files, scheme=scheme, of_pair=of_pair, each=each, i=i, share=share):
                    document = command.ask(words[0], *files, "--scheme", scheme, *words[1:], *with_options(options))
                    if document is None:
                        return []  # a motion through half a turn, or a surface that is open
                    document = document["penetration"] if ask == "penetration" else document
                    where = {"path": share[i : i + 3]} if "--path-b" in words else {"pose": each}
                    return [{"ask": ask, **of_pair, **where, "options": options, "document": document}]

                yield one


def point_questions(command, count):
    for name, scheme in ALONE:
        file = MODELS / f"{name}.obj"
        size = size_of(file)
        points = [[draw.gauss(0, 1) * size for _ in range(3)] for _ in range(math.ceil(count / len(ALONE)))]

        def asked(*words, stdin, file=file, scheme=scheme):
            return command.ask(words[0], file, "--scheme", scheme, *words[1:], "-", stdin=rows(stdin))

        def lines(asked=asked, points=points, file=file, scheme=scheme):
            of_surface = {"files": [str(file)], "scheme": scheme, "options": {}}
            near = asked("closest", "--points", stdin=points)["results"]
            yield from ({"ask": "closest_point", **of_surface, "args": [p], "document": one} for p, one in zip(points, near))
            signed = asked("closest", "--signed", "--points", stdin=points)
            for p, one in zip(points, signed["results"] if signed else []):
                yield {"ask": "contains", **of_surface, "args": [p], "document": {"inside": one["inside"]}}
                one["distance"] = one.pop("signed_distance")
                yield {"ask": "signed_distance", **of_surface, "args": [p], "document": one}
            rays = [[*p, *(b - a for a, b in zip(p, one["point"]))] for p, one in zip(points, near)]
            for ray, one in zip(rays, asked("ray", "--all", "--rays", stdin=rays)["results"]):
                yield {"ask": "ray", **of_surface, "args": [ray[:3], ray[3:]], "document": one}
            sides = scheme != "flat" and command.ask("info", file, "--scheme", scheme)["scheme"] != "loop"
            at = [[one["face"] if "face" in one else one["vertex"], one["u"], one["v"], *([one["corner"]] if sides else [])] for one in near]
            for place, one in zip(at, asked("eval", "--at", stdin=at)["points"]):
                yield {"ask": "evaluate", **of_surface, "args": [*place, *([] if sides else [0])], "document": one}

        yield lambda lines=lines: list(lines())


def solid(k):
    """Corners and faces of a small solid: a tetrahedron, a box, an octahedron, a prism."""
    if k == 0:
        return [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    if k == 1:
        return list(product((-1, 1), repeat=3)), [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    if k == 2:
        return ([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)],
                [(i, (i + 1) % 4, 4) for i in range(4)] + [((i + 1) % 4, i, 5) for i in range(4)])  # fmt: skip
    ring = [(math.cos(2 * math.pi * i / 5), math.sin(2 * math.pi * i / 5)) for i in range(5)]
    return ([(x, y, z) for z in (-1, 1) for x, y in ring],
            [tuple(range(4, -1, -1)), tuple(range(5, 10))] + [(i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i) for i in range(5)])  # fmt: skip


def solid_questions(command, count):
    """Of small solids whose corners are moved about, each another one."""
    schemes = [("catmark", "doo-sabin", "loop", "flat"), ("catmark", "midedge", "bilinear", "doo-sabin"), ("loop", "flat", "catmark", "midedge"), ("catmark", "doo-sabin", "midedge", "catmark")]
    for i in range(count):
        corners, faces = solid(i % 4)
        corners = [[x + draw.gauss(0, 0.15) for x in corner] for corner in corners]
        scheme = schemes[i % 4][i // 4 % 4]
        file = command.folder / f"solid{i}.obj"
        file.write_text("".join(f"v {row}" for row in rows(corners).splitlines(True)) + "".join(f"f {row}" for row in rows([v + 1 for v in face] for face in faces).splitlines(True)))
        size = size_of(file)

        def lines(i=i, file=file, scheme=scheme, size=size):
            out = command.folder / f"out{i}.obj"
            step, inner, outer = file.with_suffix(".step"), out.with_suffix(".inner.obj"), out.with_suffix(".outer.obj")

            def mesh(path):
                points = [x for line in path.read_text().splitlines() if line.startswith("v ") for x in numbers(line)]
                corners = [int(word.split("/")[0]) - 1 for line in path.read_text().splitlines() if line.startswith("f ") for word in line.split()[1:]]
                return points, corners

            for ask, words, options in (
                ("measure", ["measure"], {"relative": 1e-3}),
                ("self_contact", ["self-contact"], {}),
                ("limit_to_faces", ["info"], {}),
                ("bound", ["bound"], {"level": i % 2}),
                ("tessellate", ["tessellate", "-o", out], {"error": 0.01 * size * (1 + i % 5)}),
                ("deviation", ["deviation", out], {"absolute": 1e-3 * size, **({"threshold": 0.03 * size} if i % 2 else {})}),
                ("subdivided", ["subdivide", "-o", out.with_suffix(".finer.obj")], {"level": 1}),
                ("envelope", ["envelope", "-o", out.with_suffix(".around.obj")], {"error": 0.3 * size}),
                ("hull", ["hull", "--inner", inner, "--outer", outer], {"error": 0.05 * size}),
                ("step", ["convert", "-o", step], {"error": 0.01 * size}),
            ):
                asked = "catmark" if ask == "step" and scheme == "midedge" else scheme
                document = command.ask(words[0], file, *words[1:], "--scheme", asked, *with_options(options))
                if document is None:
                    continue  # no hull
                if ask == "limit_to_faces":
                    document = {"limit_to_faces": document["limit_to_faces"]}
                for name in ("command", "version", "mesh", "scheme", "seconds", "vertices", *(["faces"] if ask == "subdivided" else [])):
                    document.pop(name, None)  # of the document, or counts where answers have the things
                if ask in ("tessellate", "envelope", "subdivided"):
                    document["positions"], document["triangles"] = mesh(next(Path(word) for word in words if isinstance(word, Path)))
                if ask == "hull":
                    for side, path in (("inner", inner), ("outer", outer)):
                        if path.exists():
                            del document[side]["vertices"]
                            document[side]["positions"], document[side]["triangles"] = mesh(path)
                if ask == "deviation":
                    for name, pair, error in zip(("from_surface", "from_candidate"), document["points"], document["points_error"]):
                        document[name] = {"distance": document[name], "point": pair[0], "nearest": pair[1], "error": error}
                if ask == "step":
                    text = step.read_text()
                    document["text"] = text[text.index("DATA;") :]
                line = {"ask": ask, "files": [str(file)], "scheme": asked, "options": options, "document": document}
                if ask == "deviation":
                    points, triangles = mesh(out)
                    line["candidate"] = {"positions": points, "triangles": triangles}
                yield line

        yield lambda lines=lines: list(lines())


def main():
    program, count, folder = sys.argv[1], int(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    command = Command(program, folder)
    counts = {}
    with ThreadPoolExecutor(cpu_count()) as pool, open(folder / "answers.jsonl", "w") as out:
        questions = [each for kind in (pair_questions, point_questions, solid_questions) for each in kind(command, count)]
        for lines in pool.map(lambda question: question(), questions):
            for line in lines:
                counts[line["ask"]] = counts.get(line["ask"], 0) + 1
                out.write(json.dumps(line) + "\n")
    print(", ".join(f"{name} {n}" for name, n in sorted(counts.items())))


if __name__ == "__main__":
    main()
