"""The inner and outer hull of [Wu05, sec. 5.2] as printed, and how often it fails: PYTHONPATH=build/release/python python3 experiments/printed_hull.py [MODEL...]

Of each triangle's interval triangle two of eight planes are taken, by the signs of their normals; each node's hull vertex is the
point nearest to its limit that lies outside the planes of the triangles around it; connectivity is the mesh's. Counted is where no
plane or several fit, where limit points lie beyond a plane, where no point lies outside all planes of a node, and whether the
hull, asked in exact arithmetic, meets the surface or itself.
"""

import itertools
import json
import pathlib
import sys

import numpy as np
import snug

MODELS = pathlib.Path(__file__).resolve().parent.parent / "examples/models"
SIGNS = list(itertools.product((0, 1), repeat=3))


def planes_of(lower, upper, side):
    """All (normal, offset) of the eight that fit: the normal's signs are the choice's, or for side = -1 its opposite's."""
    found = []
    for choice in SIGNS:
        corners = np.where(np.array(choice) == 1, upper, lower)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        wanted = np.where(np.array(choice) == 1, 1, -1) * side
        if np.all(normal * wanted >= 0) and np.any(normal):
            normal = normal / np.linalg.norm(normal)
            found.append((normal, float(normal @ corners[0])))
    return found


def nearest_outside(point, planes, side):
    """The point nearest to `point` with side * (n . x - d) >= 0 for all planes; None if there is none. By enumeration."""
    normals = side * np.array([n for n, _ in planes])
    offsets = side * np.array([d for _, d in planes])
    best = None
    for count in range(4):
        for active in itertools.combinations(range(len(planes)), count):
            a = normals[list(active)]
            if count:
                gram = a @ a.T
                if np.linalg.matrix_rank(gram, tol=1e-9) < count:
                    continue
                x = point + a.T @ np.linalg.solve(gram, offsets[list(active)] - a @ point)
            else:
                x = point
            if np.all(normals @ x >= offsets - 1e-9) and (best is None or np.linalg.norm(x - point) < np.linalg.norm(best - point)):
                best = x
    return best


def verdict(surface, hull):
    """Does the hull stay clear of the surface and of itself?"""
    triangles = snug.Surface(*hull, scheme="flat")
    try:
        meets = snug.collide(surface, triangles, prove_contact=True).verdict == "intersecting"
        itself = triangles.self_contact().verdict == "intersecting"
    except snug.MeshError:
        return None, None
    return bool(meets), bool(itself)


def rough(seed, amplitude):
    """A sphere of 80 triangles whose vertices are moved by up to `amplitude` of its radius in each coordinate."""
    t = (1 + 5**0.5) / 2
    points = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)])
    hull = [f for f in itertools.combinations(range(12), 3) if all(np.linalg.norm(points[a] - points[b]) < 2.1 for a, b in itertools.combinations(f, 2))]
    faces = [f if np.linalg.det(points[list(f)]) > 0 else f[::-1] for f in hull]
    fine = snug.Surface(points, faces, scheme="loop").subdivided(1)
    vertices = fine.vertices / np.linalg.norm(fine.vertices, axis=1, keepdims=True)
    moved = vertices + np.random.default_rng(seed).uniform(-amplitude, amplitude, vertices.shape)
    return snug.Surface(moved, fine.faces, scheme="loop")


def measure(name, mesh, level):
    mesh = mesh.subdivided(level) if level else mesh
    surface = snug.Surface(mesh.vertices, mesh.faces, scheme="loop", bounds="table")
    enclosures = surface.bound()
    faces = np.asarray(surface.faces)
    limit = np.asarray(surface.subdivided(0, limit=True).vertices)
    grid = np.array([(i / 6, j / 6) for i in range(7) for j in range(7 - i)])
    row = {"model": name, "level": level, "triangles": len(faces), "no_plane": 0, "several": 0, "beyond": 0, "no_vertex": 0}
    assert len(enclosures) == len(faces), "a piece for each triangle"
    order = np.argsort(enclosures.face)
    lower, upper = np.asarray(enclosures.lower)[order], np.asarray(enclosures.upper)[order]
    ids = np.repeat(np.arange(len(faces)), len(grid))
    seen = surface.evaluate(ids, np.tile(grid[:, 0], len(faces)), np.tile(grid[:, 1], len(faces))).point.reshape(len(faces), len(grid), 3)
    hulls = {}
    for side, name in ((1, "outer"), (-1, "inner")):
        around = [[] for _ in limit]
        for f, face in enumerate(faces):
            fits = planes_of(lower[f], upper[f], side)
            row["no_plane"] += not fits
            row["several"] += len(fits) > 1
            if not fits:
                continue
            normal, offset = max(fits, key=lambda plane: side * plane[1])
            row["beyond"] += bool(np.max(side * (seen[f] @ normal - offset)) > 1e-12)
            for v in face:
                around[v].append((normal, offset))
        points = [nearest_outside(p, planes, side) if planes else p for p, planes in zip(limit, around)]
        row["no_vertex"] += sum(p is None for p in points)
        hulls[name] = [limit[v] if p is None else p for v, p in enumerate(points)]
    for name, points in hulls.items():
        row[f"{name}_meets"], row[f"{name}_itself"] = verdict(surface, (np.array(points), faces))
    return row


def main():
    names = sys.argv[1:] or ["bust", "head", "pawn", "star", "demon", "figure"]
    for name in names:
        for level in (0, 1):
            print(json.dumps(measure(name, snug.read(MODELS / f"{name}.obj", scheme="loop"), level)), flush=True)
    for amplitude in (0.1, 0.2, 0.4):
        for level in (0, 1):
            rows = [measure(f"30 rough spheres, {amplitude}", rough(seed, amplitude), level) for seed in range(30)]
            print(json.dumps({key: value if isinstance(value, str) or key == "level" else sum(int(row[key] or 0) for row in rows) for key, value in rows[0].items()}), flush=True)


main()
