"""Distances of triangle meshes in rationals: slow, exact, and without anything of snug."""

from fractions import Fraction
from itertools import product

import numpy as np


def exact(points):
    """Rows of Fractions of an array of doubles."""
    return [tuple(map(Fraction, row)) for row in np.asarray(points, dtype=float).tolist()]


def placed(points, pose):
    """Each point at the twelve doubles of the pose, exactly."""
    rows = exact(pose)[:3]
    return [tuple(sum(r[k] * p[k] for k in range(3)) + r[3] for r in rows) for p in points]


def sub(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def along(a, b, t):
    return tuple(x + t * (y - x) for x, y in zip(a, b))


def squared(a, b):
    d = sub(a, b)
    return dot(d, d)


def point_segment(p, a, b):
    """The squared distance."""
    d = sub(b, a)
    t = dot(sub(p, a), d) / dot(d, d)
    return squared(p, along(a, b, min(max(t, Fraction(0)), Fraction(1))))


def segment_segment(a, b, c, d):
    u, v, w = sub(b, a), sub(d, c), sub(a, c)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    det = uu * vv - uv * uv
    best = min(point_segment(a, c, d), point_segment(b, c, d), point_segment(c, a, b), point_segment(d, a, b))
    if det != 0:
        s, t = (uv * vw - vv * uw) / det, (uu * vw - uv * uw) / det
        if 0 <= s <= 1 and 0 <= t <= 1:
            best = min(best, squared(along(a, b, s), along(c, d, t)))
    return best


def inside(p, triangle):
    """Is a point of the triangle's plane one of the triangle's?"""
    n = cross(sub(triangle[1], triangle[0]), sub(triangle[2], triangle[0]))
    return all(dot(n, cross(sub(triangle[(k + 1) % 3], triangle[k]), sub(p, triangle[k]))) >= 0 for k in range(3))


def height(p, triangle):
    n = cross(sub(triangle[1], triangle[0]), sub(triangle[2], triangle[0]))
    return dot(n, sub(p, triangle[0])), n


def point_triangle(p, triangle):
    h, n = height(p, triangle)
    foot = tuple(x - h / dot(n, n) * y for x, y in zip(p, n))
    if inside(foot, triangle):
        return h * h / dot(n, n)
    return min(point_segment(p, triangle[k], triangle[(k + 1) % 3]) for k in range(3))


def pierces(a, b, triangle):
    """Does a segment that is not parallel to the triangle meet it?"""
    from_a, from_b = height(a, triangle)[0], height(b, triangle)[0]
    if from_a == from_b or (from_a > 0 and from_b > 0) or (from_a < 0 and from_b < 0):
        return False
    return inside(along(a, b, from_a / (from_a - from_b)), triangle)


def triangle_triangle(s, t):
    edges = [[(x[k], x[(k + 1) % 3]) for k in range(3)] for x in (s, t)]
    if any(pierces(*e, t) for e in edges[0]) or any(pierces(*e, s) for e in edges[1]):
        return Fraction(0)
    return min(
        min(segment_segment(*e, *f) for e, f in product(*edges)),
        min(point_triangle(p, t) for p in s),
        min(point_triangle(p, s) for p in t),
    )


def _spheres(triangles):
    corners = np.array([[[float(x) for x in p] for p in t] for t in triangles])
    middle = corners.mean(axis=1)
    return middle, np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)


def least(triangles, others, between):
    """The least of between(x, y): pairs whose balls are farther apart than one that was seen are left out."""
    (middle, radius), (other, reach) = _spheres(triangles), _spheres(others)
    gaps = np.linalg.norm(middle[:, None] - other, axis=2) - radius[:, None] - reach
    order = np.argsort(gaps, axis=None)
    best = None
    for at in order:
        i, j = np.unravel_index(at, gaps.shape)
        if best is not None and gaps[i, j] > 1e-9 and gaps[i, j] * (1 - 1e-9) > float(best) ** 0.5 + 1e-9:
            break
        found = between(triangles[i], others[j])
        best = found if best is None else min(best, found)
        if best == 0:
            break
    return best


def mesh_mesh(a, b):
    """The squared distance of two lists of triangles."""
    return least(a, b, triangle_triangle)


def point_mesh(p, triangles):
    return least([(p, p, p)], triangles, lambda x, t: point_triangle(x[0], t))
