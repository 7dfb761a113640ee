#!/usr/bin/env python3
"""Verifies certificates about the linear independence of nodal functions of subdivision surfaces.

Files are as `snug-research independence --json` prints them. Each case says: the nodal functions of a scheme, restricted to a domain at
a corner of some valence, span a space of dimension `rank`. Shown here without a line of snug, in integers alone:
  - rank >= r: the matrix of the domain has rank r modulo a prime, with 2 cos(2 pi / n) sent to root + 1 / root;
  - rank <= r: there are only r functions, or r rows, or enough independent vectors whose functions are exactly 0.
Meshes and masks are built here from the rules of the schemes. `--self-test` makes right certificates, spoils each in every
way that it knows, and expects the right ones accepted and all others rejected.

A piece may have a second extraordinary corner; then n above is the order, the least common multiple of both valences.
A piece may lie in a fan at a boundary; then all masks are rational and certificates have no root.

Exact numbers are polynomials in t = 2 cos(2 pi / n), lowest degree first, modulo the minimal polynomial of t. Vectors are
lists of planes, plane i having the coefficients of t^i of all entries, times a common denominator where only zero matters.
"""

import argparse
import functools
import itertools
import json
import math
import pathlib
import re
import sys
import tempfile
from fractions import Fraction

SCHEMES = ("loop", "catmark", "doo-sabin", "midedge")
DUAL = ("doo-sabin", "midedge")
REGULAR_POINTS = {"loop": 12, "catmark": 16, "doo-sabin": 9, "midedge": 9}
RATIONAL = re.compile(r"-?[0-9]+(/[1-9][0-9]*)?")
PLACES = ("edge", "opposite")
MOST_STEPS = 2
MOST_ORDER = 10000
RATIONAL_ORDER = 3  # t = -1: the numbers of fans


class Fault(Exception):
    """Why a case does not hold."""


class Unreadable(Exception):
    """Why a file cannot be read."""


def need(ok, why):
    if not ok:
        raise Fault(why)


# --- Numbers -----------------------------------------------------------------------------------------------------------


def poly_add(a, b):
    return [x + y for x, y in itertools.zip_longest(a, b, fillvalue=0)]


def poly_scale(a, factor):
    return [x * factor for x in a]


def poly_mul(a, b):
    product = [0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            product[i + j] += x * y
    return product


def poly_divmod(a, b):
    """Quotient and remainder; b is monic."""
    a, quotient = list(a), [0] * max(1, len(a) - len(b) + 1)
    while len(a) >= len(b):
        top = a[-1]
        quotient[len(a) - len(b)] = top
        for i, x in enumerate(b):
            a[len(a) - len(b) + i] -= top * x
        a.pop()
    return quotient, a or [0]


@functools.cache
def cyclotomic(n):
    phi = [-1] + [0] * (n - 1) + [1]
    for d in range(1, n):
        if n % d == 0:
            phi, rest = poly_divmod(phi, cyclotomic(d))
            assert not any(rest)
    return phi


def chebyshev(count):
    """C_0 .. C_count with C_i(x + 1/x) = x^i + x^-i."""
    found = [[2], [0, 1]]
    while len(found) <= count:
        found.append(poly_add([0] + found[-1], poly_scale(found[-2], -1)))
    return found


@functools.cache
def minimal(n):
    """Minimal polynomial of t = 2 cos(2 pi / n), n >= 3: the palindromic cyclotomic one, written in x + 1/x."""
    phi = cyclotomic(n)
    half = len(phi) // 2
    total = [phi[half]]
    for k, c in enumerate(chebyshev(half)):
        if 1 <= k <= half:
            total = poly_add(total, poly_scale(c, phi[half - k]))
    assert len(total) == half + 1 and total[-1] == 1
    return total


def reduced(a, n):
    """Canonical form, without zeros at the end: [] is 0."""
    rest = poly_divmod(a, minimal(n))[1]
    while rest and not rest[-1]:
        rest.pop()
    return rest


@functools.cache
def cosines(n, m):
    """2 cos(2 pi i / m) for i = 0..m-1 as polynomials in 2 cos(2 pi / n); m divides n, or has rational cosines."""
    if n % m == 0:
        found, last, this = [], [0, 1], [2]
        for i in range(n):
            if i % (n // m) == 0:
                found.append(this)
            last, this = this, reduced(poly_add([0] + this, poly_scale(last, -1)), n)
        return found
    assert len(minimal(m)) == 2
    t = -minimal(m)[0]
    return [[sum(x * t**k for k, x in enumerate(c))] for c in chebyshev(m)[:m]]


@functools.cache
def is_prime(p):
    return p > 1 and all(p % d for d in itertools.takewhile(lambda d: d * d <= p, itertools.chain([2], itertools.count(3, 2))))


def prime_factors(n):
    return [q for q in range(2, n + 1) if n % q == 0 and is_prime(q)]


def has_order(root, n, p):
    return pow(root, n, p) == 1 and all(pow(root, n // q, p) != 1 for q in prime_factors(n))


@functools.cache
def own_prime(n, number):
    """A prime p = 1 modulo n and a root of order n."""
    candidates = (p for p in itertools.count(2**30 - 2**30 % n + 1, n) if is_prime(p))
    p = next(itertools.islice(candidates, number, None))
    powers = (pow(g, (p - 1) // n, p) for g in itertools.count(2))
    return p, next(z for z in powers if has_order(z, n, p))


def t_modulo(root, p):
    return (root + pow(root, -1, p)) % p


def value_modulo(poly, t, p):
    value = 0
    for x in reversed(poly):
        value = value * t + (x if isinstance(x, int) else x.numerator * pow(x.denominator, -1, p))
    return value % p


# --- Meshes: lists of faces, a face the tuple of its vertices in cyclic order ------------------------------------------


def edges_of(face):
    return [frozenset(pair) for pair in zip(face, face[1:] + face[:1])]


def faces_by_edge(faces):
    found = {}
    for i, face in enumerate(faces):
        for edge in edges_of(face):
            found.setdefault(edge, []).append(i)
    return found


def faces_by_vertex(faces):
    found = {}
    for i, face in enumerate(faces):
        for v in face:
            found.setdefault(v, []).append(i)
    return found


def from_edge(face, a, b):
    """The face, read such that it begins with the edge (a, b)."""
    i = face.index(a)
    if face[(i + 1) % len(face)] != b:
        face = tuple(reversed(face))
        i = face.index(a)
    assert face[(i + 1) % len(face)] == b
    return face[i:] + face[:i]


def star(v, faces, by_vertex, by_edge):
    """The faces around v in cyclic order, None if v lies on the boundary."""
    start = by_vertex[v][0]
    order, face, out = [], start, next(w for e in edges_of(faces[start]) if v in e for w in e - {v})
    while True:
        order.append(face)
        ring = from_edge(faces[face], v, out)
        out = ring[-1]
        both = by_edge[frozenset((v, out))]
        if len(both) != 2:
            return None
        face = both[0] if both[1] == face else both[1]
        if face == start:
            assert sorted(order) == sorted(by_vertex[v])
            return order


def loop_mesh(n):
    fan = [(1, 2, n + 1)] + [(1, j, j + 1) for j in range(2, n + 1)]
    return fan + [(2, n + 2, n + 1), (2, n + 3, n + 2), (2, n + 4, n + 3), (2, 3, n + 4), (n + 1, n + 2, n + 5),
                  (n + 1, n + 5, n + 6), (n + 1, n + 6, n)]


def catmark_mesh(n):
    e, f = [2 + 2 * (j % n) for j in range(n + 1)], [3 + 2 * j for j in range(n)]
    grid = {(0, 0): 1, (1, 0): e[1], (1, 1): f[1], (0, 1): e[2], (1, -1): f[0], (-1, 1): f[2]}
    for i, place in enumerate([(2, -1), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (-1, 2)]):
        grid[place] = 2 * n + 2 + i
    beyond = [tuple(grid[x + a, y + b] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
              for x, y in ((1, -1), (1, 0), (1, 1), (0, 1), (-1, 1))]
    fan = [(1, e[j], f[j], e[j + 1]) for j in range(n)]
    return [fan[1]] + fan[:1] + fan[2:] + beyond


def dual_mesh(n):
    w = [n + i for i in range(6)]
    return [tuple(range(1, n + 1)), (1, 2, w[1], w[2]), (1, w[2], w[3], w[4]), (1, w[4], w[5], n)]


def loop_pair(n, m):
    """Corners of valences n and m at an edge of a triangle."""
    faces, beyond, count = {frozenset((1, 2, 3)): (1, 2, 3)}, [4], 4
    for i, valence in enumerate((n, m, 6)):
        ring = beyond[-1:]
        while len(ring) < valence - 2:
            count += 1
            ring.append(count)
        if i == 2:
            count -= 1
            ring[-1] = beyond[0]
        beyond += ring
        around = [1 + (i + 2) % 3, *ring, 1 + (i + 1) % 3]
        faces.update((frozenset((1 + i, *pair)), (1 + i, *pair)) for pair in zip(around, around[1:]))
    return list(faces.values())


def catmark_pair(valences):
    """Corners of these valences in a quad."""
    outer, count = [], 5
    for valence in valences:
        outer.append(list(range(count, count + 2 * valence - 5)))
        count += 2 * valence - 5
    faces = {frozenset((1, 2, 3, 4)): (1, 2, 3, 4)}
    for i, ring in enumerate(outer):
        before, after = (i + 3) % 4, (i + 1) % 4
        spokes, diagonals = [1 + before, *ring[::2], 1 + after], [outer[before][-1], *ring[1::2], outer[after][0]]
        for a, d, b in zip(spokes, diagonals, spokes[1:]):
            faces[frozenset((1 + i, a, d, b))] = (1 + i, a, d, b)
    return list(faces.values())


def dual_pair(valences):
    """A vertex whose faces have these numbers of corners."""
    faces, count = [], 6
    for i, corners in enumerate(valences):
        faces.append((1, 2 + i, *range(count, count + corners - 3), 2 + (i + 1) % 4))
        count += corners - 3
    return faces


def loop_fan(n, i):
    """Face i of a fan of n faces at a boundary, its one-ring, and the edges of the boundary in it."""
    p, s, count = [2 + j for j in range(n + 1)], {}, n + 3
    for k in range(max(2 * i - 3, 0), min(2 * i + 1, 2 * n) + 1):
        s[k], count = count, count + 1
    fan = [(1, p[j], p[j + 1]) for j in range(n)]
    outer = [face for j in range(n + 1) for face in
             [(p[j], s.get(2 * j - 1), s.get(2 * j)), (p[j], s.get(2 * j), s.get(2 * j + 1)),
              (p[j], s.get(2 * j + 1), p[j + 1] if j < n else None)]]
    rim = [(1, p[0]), (1, p[n]), (p[0], s.get(0)), (p[n], s.get(2 * n))]
    return [fan[i - 1]] + fan[:i - 1] + fan[i:] + known(outer), frozenset(map(frozenset, known(rim)))


def catmark_fan(n, i):
    """The same of quads."""
    e, f, o, count = [2 + 2 * j for j in range(n + 1)], [3 + 2 * j for j in range(n)], {}, 2 * n + 3
    for k in range(max(4 * i - 5, 0), min(4 * i + 1, 4 * n) + 1):
        o[k], count = count, count + 1
    fan = [(1, e[j], f[j], e[j + 1]) for j in range(n)]
    outer = [face for j in range(n) for face in
             [(f[j], e[j], o.get(4 * j), o.get(4 * j + 1)), (f[j], *(o.get(4 * j + k) for k in (1, 2, 3))),
              (f[j], o.get(4 * j + 3), o.get(4 * j + 4), e[j + 1])]]
    rim = [(1, e[0]), (1, e[n]), (e[0], o.get(0)), (e[n], o.get(4 * n))]
    return [fan[i - 1]] + fan[:i - 1] + fan[i:] + known(outer), frozenset(map(frozenset, known(rim)))


def known(tuples):
    """Those without a vertex that is absent."""
    return [vertices for vertices in tuples if None not in vertices]


def loop_annulus(n):
    u, a, b = ([first + step * (j % n) for j in range(-1, n + 1)] for first, step in ((2, 1), (n + 2, 2), (n + 3, 2)))
    return [face for j in range(1, n + 1) for face in
            ((1, u[j], u[j + 1]), (u[j], u[j + 1], a[j]), (u[j], a[j], b[j - 1]), (u[j], b[j - 1], a[j - 1]))]


def catmark_annulus(n):
    faces = []
    for j in range(n):
        e, f, g = 2 + 2 * j, 3 + 2 * j, 2 + 2 * ((j + 1) % n)
        o = [2 * n + 2 + (4 * j + i) % (4 * n) for i in range(5)]
        faces += [(1, e, f, g), (f, e, o[0], o[1]), (f, o[1], o[2], o[3]), (f, o[3], o[4], g)]
    return faces


def dual_annulus(n):
    faces = [tuple(range(1, n + 1))]
    for j in range(n):
        k = (j + 1) % n
        corner, edge = n + 1 + 3 * j, n + 1 + 3 * k
        faces += [(1 + j, corner + 2, corner + 1, corner), (1 + j, 1 + k, edge, corner + 2)]
    return faces


def closed_mesh(scheme, n):
    """Bipyramid, trapezohedron or prism."""
    if scheme == "loop":
        return [(pole, 3 + i, 3 + (i + 1) % n) for pole in (1, 2) for i in range(n)]
    if scheme == "catmark":
        r = [3 + i % (2 * n) for i in range(2 * n + 2)]
        return [face for i in range(0, 2 * n, 2)
                for face in ((1, r[i], r[i + 1], r[i + 2]), (2, r[i + 3], r[i + 2], r[i + 1]))]
    sides = [(1 + i, 1 + (i + 1) % n, n + 1 + (i + 1) % n, n + 1 + i) for i in range(n)]
    return [tuple(range(1, n + 1)), tuple(range(n + 1, 2 * n + 1))] + sides


# --- One step of a scheme: masks of the new points by name, {old vertex: polynomial in t}, and the new faces. Near a boundary
# --- some new points have no mask.


def combine(terms):
    mask = {}
    for v, weight in terms:
        mask[v] = poly_add(mask.get(v, []), weight)
    return mask


def loop_step(faces, n, _rule):
    by_edge, by_vertex = faces_by_edge(faces), faces_by_vertex(faces)
    masks = {}
    for edge, sides in by_edge.items():
        if len(sides) == 2:
            opposite = [v for f in sides for v in faces[f] if v not in edge]
            masks["edge", edge] = combine([(v, [Fraction(3, 8)]) for v in edge] + [(v, [Fraction(1, 8)]) for v in opposite])
    for v, around in by_vertex.items():
        if star(v, faces, by_vertex, by_edge):
            neighbours = {w for f in around for w in faces[f]} - {v}
            m = len(neighbours)
            sharp = poly_add([3], cosines(n, m)[1])
            b = reduced(poly_scale(poly_add([40], poly_scale(poly_mul(sharp, sharp), -1)), Fraction(1, 64 * m)), n)
            masks["vertex", v] = combine([(v, poly_add([1], poly_scale(b, -m)))] + [(w, b) for w in neighbours])
    new_faces = []
    for a, b, c in faces:
        ab, bc, ca = (("edge", e) for e in edges_of((a, b, c)))
        new_faces += [(("vertex", a), ab, ca), (("vertex", b), bc, ab), (("vertex", c), ca, bc), (ab, bc, ca)]
    return masks, new_faces


def catmark_step(faces, _n, rule):
    by_edge, by_vertex = faces_by_edge(faces), faces_by_vertex(faces)

    def mean(part, names):
        """Mean of points, times `part`; a name that is no mask of a face is a vertex."""
        return [(v, [x * part / len(names)]) for name in names for v, (x,) in masks.get(name, {name: [Fraction(1)]}).items()]

    masks = {("face", i): {v: [Fraction(1, 4)] for v in face} for i, face in enumerate(faces)}
    middles = dict(masks)
    for edge, sides in by_edge.items():
        if len(sides) == 2:
            middles["edge", edge] = combine(mean(1, list(edge) + [("face", f) for f in sides]))
    for v, around in by_vertex.items():
        if star(v, faces, by_vertex, by_edge):
            m, spokes = len(around), [e for e in by_edge if v in e]
            q, r = [("face", f) for f in around], [w for e in spokes for w in e if w != v]
            if rule == "older":
                terms = mean(Fraction(1, 4), q) + mean(Fraction(1, 4), r) + mean(Fraction(1, 2), [v])
            else:  # (Q + 2 R + (m - 3) S) / m, R the mean of the middles of edges, so 2 R = S + mean of the neighbours
                terms = mean(Fraction(1, m), q) + mean(Fraction(1, m), r) + mean(Fraction(m - 2, m), [v])
            middles["vertex", v] = combine(terms)
    new_faces = []
    for i, face in enumerate(faces):
        sides = [("edge", e) for e in edges_of(face)]
        new_faces += [(("vertex", v), sides[k], ("face", i), sides[k - 1]) for k, v in enumerate(face)]
    return middles, new_faces


def dual_weight(scheme, n, m, j):
    """Weight of the vertex j places on from the corner of a face of m corners."""
    if scheme == "midedge":
        return [Fraction(1, 2) if j == 0 else Fraction(1, 4) if j in (1, m - 1) else Fraction(0)]
    weight = poly_scale(poly_add([3], cosines(n, m)[j]), Fraction(1, 4 * m))
    return poly_add(weight, [Fraction(1, 4)]) if j == 0 else weight


def dual_step(scheme, faces, n):
    by_edge, by_vertex = faces_by_edge(faces), faces_by_vertex(faces)
    masks = {(f, v): {w: weight for j, w in enumerate(face)
                      if any(weight := dual_weight(scheme, n, len(face), (j - i) % len(face)))}
             for f, face in enumerate(faces) for i, v in enumerate(face)}
    new_faces = [tuple((f, v) for v in face) for f, face in enumerate(faces)]
    for edge, sides in by_edge.items():
        if len(sides) == 2:
            (a, b), (f, g) = edge, sides
            new_faces.append(((f, a), (f, b), (g, b), (g, a)))
    for v in by_vertex:
        if around := star(v, faces, by_vertex, by_edge):
            new_faces.append(tuple((f, v) for f in around))
    return masks, new_faces


def step_of(scheme, faces, n, rule):
    if scheme in DUAL:
        return dual_step(scheme, faces, n)
    return (loop_step if scheme == "loop" else catmark_step)(faces, n, rule)


def rim_masks(rim, sharp):
    """Masks at the boundary: of its edges, and of the vertices between two of them; a sharp one stays."""
    masks = {("edge", edge): {v: [Fraction(1, 2)] for v in edge} for edge in rim}
    for v in frozenset().union(*rim):
        ends = [w for edge in rim if v in edge for w in edge - {v}]
        if len(ends) == 2:
            smooth = {v: [Fraction(3, 4)], **{w: [Fraction(1, 8)] for w in ends}}
            masks["vertex", v] = {v: [Fraction(1)]} if v in sharp else smooth
    return masks


def embed(pattern, mesh, seed):
    """Where the vertices of a pattern lie in a mesh: `seed` has those of its first face, the others follow over edges."""
    by_edge, by_edge_there = faces_by_edge(pattern), faces_by_edge(mesh)
    ends = {frozenset(seed[v] for v in pattern[0])}
    place, found = dict(seed), {0: next(i for i, face in enumerate(mesh) if frozenset(face) in ends)}
    queue = [0]
    for face in queue:
        for edge in edges_of(pattern[face]):
            for other in by_edge[edge]:
                if other not in found:
                    a, b = edge
                    there = next(i for i in by_edge_there[frozenset((place[a], place[b]))] if i != found[face])
                    ring, image = from_edge(pattern[other], a, b), from_edge(mesh[there], place[a], place[b])
                    assert len(ring) == len(image)
                    assert all(place.setdefault(v, w) == w for v, w in zip(ring, image))
                    found[other] = there
                    queue.append(other)
    assert len(found) == len(pattern)
    return place


# --- Matrices of a step ------------------------------------------------------------------------------------------------


class Step:
    """Masks of new points, as polynomials in t over columns 0..size-1."""

    def __init__(self, masks, columns, n):
        self.n, self.size = n, len(columns)
        self.rows = [{columns[v]: r for v, x in mask.items() if (r := reduced(x, n))} for mask in masks]
        denominators = [Fraction(x).denominator for row in self.rows for poly in row.values() for x in poly]
        self.scale = math.lcm(*denominators)
        degree = max(len(poly) for row in self.rows for poly in row.values())
        # planes[i]: (row, [(column, integer)]) of the coefficients of t^i, times scale
        self.planes = [[(r, terms) for r, row in enumerate(self.rows)
                        if (terms := [(c, int(poly[i] * self.scale)) for c, poly in row.items() if i < len(poly) and poly[i]])]
                       for i in range(degree)]
        self.known = {}

    def apply(self, vector):
        """The new points, times scale."""
        result = [[0] * len(self.rows) for _ in range(len(self.planes) + len(vector) - 1)]
        for i, rows in enumerate(self.planes):
            for j, plane in enumerate(vector):
                out = result[i + j]
                for r, terms in rows:
                    out[r] += sum([w * plane[c] for c, w in terms])
        return fold(result, self.n)

    def modulo(self, t, p):
        """Sparse rows modulo p."""
        if (t, p) not in self.known:
            self.known[t, p] = [[(c, value_modulo(poly, t, p)) for c, poly in row.items()] for row in self.rows]
        return self.known[t, p]


def fold(planes, n):
    """Planes modulo the minimal polynomial of t, without planes of zeros at the end."""
    low = minimal(n)[:-1]
    while len(planes) > len(low):
        top = planes.pop()
        if any(top):
            for i, x in enumerate(low):
                if x:
                    k = len(planes) - len(low) + i
                    planes[k] = [a - x * b for a, b in zip(planes[k], top)]
    while len(planes) > 1 and not any(planes[-1]):
        planes.pop()
    return planes


def primitive(planes):
    """The vector divided by the greatest common divisor of its coefficients, as tuples."""
    divisor = math.gcd(*itertools.chain.from_iterable(planes)) or 1
    return tuple(tuple(x // divisor for x in plane) for plane in planes)


class Net:
    """The step of a net: the points of its regular pieces, and of the parts left.

    names pick the regular pieces; seeds are pairs of the net that a part left is like, and where the first face of it lies;
    n is the order of the exact numbers; fewer has, for each piece, the points that it lacks of a regular one; rim and sharp are
    the edges of a boundary and the vertices of it that stay. Functions are zero on a piece where all its tests are zero, a test
    being the sum of one or two points.
    """

    def __init__(self, scheme, mesh, n, rule, names, seeds, fewer, rim=frozenset(), sharp=frozenset()):
        masks, faces = step_of(scheme, mesh, n, rule)
        masks.update(rim_masks(rim, sharp))
        by_vertex = faces_by_vertex(faces)
        patches = []
        for name, lacks in zip(names, fewer, strict=True):
            seen = [name] if scheme in DUAL else next(f for f in faces if set(name) <= set(f))
            around = {f for v in seen for f in by_vertex[v]}
            points = {v for f in around for v in faces[f]}
            assert len(points) == REGULAR_POINTS[scheme] - lacks
            sums = {e for f in around for e in edges_of(faces[f])} if scheme == "midedge" else {frozenset([v]) for v in points}
            patches.append(sums)
        places = [embed(pattern, faces, seed) for pattern, seed in seeds]
        needed = {v for sums in patches for e in sums for v in e}.union(*(place.values() for place in places))
        assert needed <= masks.keys()
        self.names = [v for v in masks if v in needed]
        index = {v: i for i, v in enumerate(self.names)}
        self.faces, self.count = mesh, len(faces_by_vertex(mesh))
        self.step = Step([masks[v] for v in self.names], {v: v - 1 for v in range(1, self.count + 1)}, n)
        self.parts = [[index[place[v]] for v in sorted(place)] for place in places]
        self.pieces = [frozenset(tuple(sorted(index[v] for v in e)) for e in sums) for sums in patches]
        self.own = set()
        self.next = {}
        self.ranks = {}

    def tests(self, pieces):
        return frozenset().union(*(self.pieces[i] for i in pieces))

    def advance(self, vector):
        """The nonzero tests of ring 1 and the parts left, of a primitive vector."""
        if vector not in self.next:
            if len(self.next) > 1000:
                self.next.clear()
            points = self.step.apply(vector)
            wrong = {test for test in self.tests(range(len(self.pieces)))
                     if any(sum(plane[i] for i in test) for plane in points)}
            self.next[vector] = wrong, [primitive([[plane[i] for i in part] for plane in points]) for part in self.parts]
        return self.next[vector]


def lacking(scheme, names, threes):
    """Points that pieces lack: for each corner of valence 3, two of the 12 of Loop's middle piece are one."""
    return [threes if scheme == "loop" and name[0][0] == "edge" else 0 for name in names]


class Corner(Net):
    """The net of one extraordinary corner. own: tests of points made by the corner's own irrational mask."""

    def __init__(self, scheme, n, rule, annulus, order):
        mesh = self.mesh(scheme, n, annulus)
        seeds = [] if annulus else [(mesh, seed_at(scheme, mesh, mesh, 0))]
        names = self.piece_names(scheme, n, mesh, annulus)
        super().__init__(scheme, mesh, order, rule, names, seeds, lacking(scheme, names, int(n == 3)))
        if scheme == "loop":
            self.own = {(self.names.index(("vertex", 1)),)}
        elif scheme == "doo-sabin":
            self.own = {(i,) for i, v in enumerate(self.names) if v[0] == 0}

    @staticmethod
    def mesh(scheme, n, annulus):
        if scheme in DUAL:
            return (dual_annulus if annulus else dual_mesh)(n)
        if scheme == "loop":
            return (loop_annulus if annulus else loop_mesh)(n)
        return (catmark_annulus if annulus else catmark_mesh)(n)

    @staticmethod
    def piece_names(scheme, n, mesh, annulus):
        """New vertices that pick the face (primal) or are the vertex (dual) of each regular piece, in order."""
        names = []
        if scheme in DUAL:
            by_vertex = faces_by_vertex(mesh)
            for v in range(1, n + 1) if annulus else [1]:
                names += [(f, v) for f in by_vertex[v] if f != 0]
            return names
        for i, face in enumerate(mesh):
            if 1 in face and (annulus or i == 0):
                assert face[0] == 1
                sides = [("edge", e) for e in edges_of(face)]
                if scheme == "loop":
                    names += [(("vertex", face[1]), *sides[:2]), tuple(sides), (("vertex", face[2]), *sides[1:])]
                else:
                    names += [(("vertex", face[k]), ("face", i)) for k in (1, 2, 3)]
        return names


class Pair(Net):
    """The net of two extraordinary corners; each of the parts left has one of them."""

    def __init__(self, scheme, n, m, place, rule):
        order, where = math.lcm(n, m), 1 + PLACES.index(place)
        mesh, sides = self.mesh(scheme, n, m, where), 3 if scheme == "loop" else 4
        regular = [i for i in range(sides) if i not in (0, where)]
        if scheme in DUAL:
            names = [(i, 1) for i in regular]
        elif scheme == "loop":
            edges = [("edge", e) for e in edges_of(mesh[0])]
            names = [tuple(edges), (("vertex", 3), *edges[1:])]
        else:
            names = [(("vertex", 1 + i), ("face", 0)) for i in regular]
        seeds = []
        for i, valence in ((0, n), (where, m)):
            pattern = Corner.mesh(scheme, valence, False)
            seeds.append((pattern, seed_at(scheme, pattern, mesh, i)))
        super().__init__(scheme, mesh, order, rule, names, seeds, lacking(scheme, names, (n, m).count(3)))
        self.corners = [Corner(scheme, valence, rule, False, order) for valence in (n, m)]
        if scheme == "doo-sabin":  # irrational masks
            faces = [i for i, valence in ((0, n), (where, m)) if valence not in (3, 4, 6)]
            self.own = {(i,) for i, v in enumerate(self.names) if v[0] in faces}

    @staticmethod
    def mesh(scheme, n, m, where):
        if scheme == "loop":
            return loop_pair(n, m)
        valences = [n if i == 0 else m if i == where else 4 for i in range(4)]
        return (dual_pair if scheme in DUAL else catmark_pair)(valences)


class Fan(Net):
    """The net of face i of a fan of n faces around a vertex of a boundary, sharp or not.

    A piece with a vertex at a boundary has regular points beyond it (Loop: a + b - c beyond an edge a b of a triangle a b c,
    Catmull-Clark: 2 a - c), which are zero where its others are: the masks at the boundary are the regular ones with those.
    """

    def __init__(self, scheme, n, i, sharp):
        mesh, rim = (loop_fan if scheme == "loop" else catmark_fan)(n, i)
        beyond = [[3, 2, 0], [0, 2, 3]] if scheme == "loop" else [[4, 0, 0], [0, 0, 4]]  # of pieces 1 to 3
        fewer = [(i == 1) * a + (i == n) * b for a, b in zip(*beyond)]
        super().__init__(scheme, mesh, RATIONAL_ORDER, None, Corner.piece_names(scheme, n, mesh, False),
                         [(mesh, seed_at(scheme, mesh, mesh, 0))], fewer, rim, {1} if sharp else frozenset())


def seed_at(scheme, pattern, mesh, i):
    """Where the first face of a corner's net lies after a step of a mesh: at corner i of face 0, or (dual) in face i."""
    if scheme in DUAL:
        return dict(zip(pattern[0], ((i, v) for v in mesh[i])))
    sides = [("edge", e) for e in edges_of(mesh[0])]
    ends = [sides[i], sides[i - 1]] if scheme == "loop" else [sides[i], ("face", 0), sides[i - 1]]
    return dict(zip(pattern[0], [("vertex", mesh[0][i]), *ends]))


@functools.cache
def corner(scheme, n, rule, annulus=False):
    return Corner(scheme, n, rule, annulus, n)


@functools.cache
def fan(scheme, n, i, sharp):
    return Fan(scheme, n, i, sharp)


@functools.lru_cache(maxsize=400)
def pair(scheme, n, m, place, rule):
    return Pair(scheme, n, m, place, rule)


@functools.cache
def closed_steps(scheme, n, rule):
    """MOST_STEPS steps of the closed mesh; the number of pieces with more than one extraordinary corner, and the faces, after
    each number of steps."""
    mesh, steps, crowded, meshes = closed_mesh(scheme, n), [], [], []
    size = len(faces_by_vertex(mesh))
    columns = {v: v - 1 for v in range(1, size + 1)}
    for level in range(MOST_STEPS + 1):
        crowded.append(crowded_pieces(scheme, mesh))
        meshes.append([tuple(columns[v] for v in face) for face in mesh])
        if level < MOST_STEPS:
            masks, mesh = step_of(scheme, mesh, n, rule)
            assert {v for face in mesh for v in face} == set(masks)
            steps.append(Step(list(masks.values()), columns, n))
            columns = {v: i for i, v in enumerate(masks)}
    return steps, crowded, meshes


def crowded_pieces(scheme, mesh):
    by_vertex = faces_by_vertex(mesh)
    if scheme in DUAL:
        return sum(len(around) != 4 or sum(len(mesh[f]) != 4 for f in around) > 1 for around in by_vertex.values())
    regular = 6 if scheme == "loop" else 4
    return sum(sum(len(by_vertex[v]) != regular for v in face) > 1 for face in mesh)


def valences_of(scheme, mesh):
    """Extraordinary valences."""
    if scheme in DUAL:
        return {len(face) for face in mesh} - {4}
    return {len(around) for around in faces_by_vertex(mesh).values()} - {6 if scheme == "loop" else 4}


# --- Ranks modulo a prime ----------------------------------------------------------------------------------------------


def extend(basis, row, p):
    """Adds a row to an echelon basis {pivot: row}; the new basis row, or None if it lies in the span."""
    for pivot in range(len(row)):
        x = row[pivot]
        if x:
            known = basis.get(pivot)
            if known is None:
                inverse = pow(x, -1, p)
                basis[pivot] = [v * inverse % p for v in row]
                return basis[pivot]
            row = [(v - x * w) % p for v, w in zip(row, known)]
    return None


def rank_modulo(rows, p, size):
    basis = {}
    for row in rows:
        if len(basis) == size:
            break
        extend(basis, row, p)
    return len(basis)


def dense(terms, size, p):
    row = [0] * size
    for c, x in terms:
        row[c] = (row[c] + x) % p
    return row


def test_rows(tests, sparse, size, p):
    return [dense([term for i in test for term in sparse[i]], size, p) for test in sorted(tests)]


def times(row, sparse, size, p):
    """Row times the matrix of sparse rows."""
    return dense([(c, x * w) for x, terms in zip(row, sparse) if x for c, w in terms], size, p)


class Rings:
    """Ranks of ring k and of rings 1 to k modulo p, extended as far as asked.

    The rows of rings 1 to k + 1 span those of ring 1 and those of rings 1 to k times the step: of the latter only those need a
    look that ring k brought.
    """

    def __init__(self, where, t, p):
        sparse = where.step.modulo(t, p)
        self.size, self.p, self.part = where.count, p, [sparse[i] for i in where.parts[0]]
        first = test_rows(where.tests(range(3)), sparse, self.size, p)
        self.basis, self.alone = {}, {}
        self.levels = [[row for r in first if (row := extend(self.basis, r, p))]]
        self.alone = dict(self.basis)
        self.together_ranks, self.alone_ranks = [len(self.basis)], [len(self.basis)]

    def together(self, k):
        while len(self.together_ranks) < k and self.levels[-1]:
            moved = [times(row, self.part, self.size, self.p) for row in self.levels[-1]]
            self.levels.append([row for r in moved if (row := extend(self.basis, r, self.p))])
            self.together_ranks.append(len(self.basis))
        return self.together_ranks[min(k, len(self.together_ranks)) - 1]

    def brought(self, k):
        """The rows that ring k adds to those of rings 1 to k - 1."""
        self.together(k)
        return self.levels[k - 1] if k <= len(self.levels) else []

    def only(self, k):
        while len(self.alone_ranks) < k:
            basis = {}
            for row in self.alone.values():
                extend(basis, times(row, self.part, self.size, self.p), self.p)
            self.alone = basis
            self.alone_ranks.append(len(basis))
        return self.alone_ranks[k - 1]


class PairRings:
    """Ranks modulo p of rings 1 to k of a piece with two extraordinary corners.

    Their rows span those of ring 1, and those of rings 1 to k - 1 of both parts times the step.
    """

    def __init__(self, where, t, p):
        sparse = where.step.modulo(t, p)
        self.size, self.p = where.count, p
        self.parts = [(rings_modulo(c, t, p), [sparse[i] for i in part]) for c, part in zip(where.corners, where.parts)]
        self.basis = {}
        for row in test_rows(where.tests(range(len(where.pieces))), sparse, self.size, p):
            extend(self.basis, row, p)
        self.ranks = [len(self.basis)]

    def together(self, k):
        while len(self.ranks) < k:
            more = [(row, part) for rings, part in self.parts for row in rings.brought(len(self.ranks))]
            if not more:
                break
            for row, part in more:
                extend(self.basis, times(row, part, self.size, self.p), self.p)
            self.ranks.append(len(self.basis))
        return self.ranks[min(k, len(self.ranks)) - 1]


def rings_modulo(where, t, p):
    if (t, p) not in where.ranks:
        where.ranks[t, p] = (PairRings if isinstance(where, Pair) else Rings)(where, t, p)
    return where.ranks[t, p]


def global_rows(scheme, n, rule, level, t, p):
    steps = closed_steps(scheme, n, rule)[0][:level]
    size = steps[0].size
    rows = [dense(terms, size, p) for terms in steps[0].modulo(t, p)]
    for step in steps[1:]:
        rows = [[sum(w * rows[c][k] for c, w in terms) % p for k in range(size)] for terms in step.modulo(t, p)]
    return rows


# --- Domains -----------------------------------------------------------------------------------------------------------


def parse_domain(name):
    """(kind, pieces or number)."""
    if name in ("omega", "annulus", "global"):
        return name, None
    if m := re.fullmatch(r"piece:([123])", name):
        return "pieces", (int(m[1]) - 1,)
    if (m := re.fullmatch(r"pieces:([123]),([123])", name)) and m[1] < m[2]:
        return "pieces", (int(m[1]) - 1, int(m[2]) - 1)
    if m := re.fullmatch(r"(rings?):([1-9][0-9]{0,3})", name):
        return m[1], int(m[2])
    raise Fault("this domain is not known")


class Case:
    """A scheme, a valence, a rule and a domain; and where there is a second extraordinary corner, its valence and place.

    In a fan at a boundary, the valence is its number of faces, `border` the number of the face, and `sharp` tells of the vertex.
    """

    def __init__(self, scheme, n, rule, domain, second=None, place=None, border=None, sharp=None):
        self.scheme, self.n, self.rule, self.second, self.border = scheme, n, rule, second, border
        self.kind, self.number = parse_domain(domain)
        self.order = RATIONAL_ORDER if border else math.lcm(n, second or n)
        if border:
            need(self.kind not in ("annulus", "global"), "this domain is not known at a boundary")
            self.corner = fan(scheme, n, border, bool(sharp))
        elif second:
            need(self.kind in ("rings", "omega"), "this domain is not known of two extraordinary corners")
            self.corner = pair(scheme, n, second, place, rule)
        else:
            self.corner = None if self.kind == "global" else corner(scheme, n, rule, self.kind == "annulus")
        self.dimension = closed_steps(scheme, n, rule)[0][0].size if self.kind == "global" else self.corner.count

    def first_tests(self):
        """Tests after one step."""
        return self.corner.tests(self.number if self.kind == "pieces" else range(len(self.corner.pieces)))

    def own_tests(self):
        """Tests that a kernel may leave out."""
        once = self.kind in ("pieces", "annulus") or (self.kind in ("ring", "rings") and self.number == 1)
        return self.first_tests() & self.corner.own if once else frozenset()

    def rank_modulo(self, root, p, rings=None, steps=None):
        t = t_modulo(root, p)
        if self.kind == "global":
            return rank_modulo(global_rows(self.scheme, self.n, self.rule, steps, t, p), p, self.dimension)
        if self.kind == "ring":
            return rings_modulo(self.corner, t, p).only(self.number)
        if self.kind in ("rings", "omega"):
            return rings_modulo(self.corner, t, p).together(rings if self.kind == "omega" else self.number)
        rows = test_rows(self.first_tests(), self.corner.step.modulo(t, p), self.dimension, p)
        return rank_modulo(rows, p, self.dimension)

    def row_count(self):
        """Independent tests, as forms in the distinct points of the domain."""
        count = forms(self.first_tests())
        return count * self.number if self.kind == "rings" else count


def forms(tests):
    """Rank of tests as forms in the points: of sums of two, the points but one for each part that is 2-coloured."""
    parent = {}

    def find(v):
        colour = 0
        while parent.get(v, (v, 0))[0] != v:
            v, c = parent[v]
            colour ^= c
        return v, colour

    odd = set()
    for test in tests:
        (a, x), (b, y) = find(test[0]), find(test[-1])
        if a != b:
            parent[a] = (b, x ^ y ^ 1)
            if a in odd:
                odd.add(b)
        elif x == y:
            odd.add(a)
    points = {v for test in tests for v in test}
    return len(points) - sum(find(v)[0] == v and v not in odd for v in points)


# --- Certificates ------------------------------------------------------------------------------------------------------


def field(record, name, kind):
    """A field of just this type; None where `kind` is a type in a tuple and the field is absent or null."""
    if isinstance(kind, tuple):
        if record.get(name) is None:
            return None
        kind = kind[0]
    need(name in record, f"{name} is missing")
    need(type(record[name]) is kind, f"{name} is of a wrong type")
    return record[name]


def rational(text):
    need(isinstance(text, str) and RATIONAL.fullmatch(text) and len(text) < 4000, f"not a rational number: {text!r:.40}")
    return Fraction(text)


def parse_vector(entries, size, n):
    """Planes of Fractions."""
    need(type(entries) is dict, "a vector of the kernel is of a wrong type")
    columns = {}
    for key, entry in entries.items():
        known = re.fullmatch(r"[1-9][0-9]{0,8}", key) and int(key) <= size
        need(known, f"the kernel has an entry of control point {key!r:.20}")
        need(type(entry) is not list or entry, "the kernel has an empty entry")
        columns[int(key) - 1] = [rational(x) for x in (entry if type(entry) is list else [entry])]
    planes = [[column[i] if (column := columns.get(c)) and i < len(column) else 0 for c in range(size)]
              for i in range(max(map(len, columns.values()), default=1))]
    scale = math.lcm(*(Fraction(x).denominator for plane in planes for x in plane))
    return primitive(fold([[int(x * scale) for x in plane] for plane in planes], n))


def independent_vectors(vectors, n, root, p):
    """Shown modulo the prime given, or one of our own."""
    for z, q in [(root, p)] + [own_prime(n, i)[::-1] for i in range(2)]:
        t = t_modulo(z, q)
        rows = [[value_modulo(column, t, q) for column in zip(*vector)] for vector in vectors]
        if rank_modulo(rows, q, len(vectors)) == len(vectors):
            return True
    return False


def check_rational_prime(certificate):
    p = field(certificate, "prime", int)
    need(2 < p < 2**31 and is_prime(p), f"{p} is no odd prime below 2^31")
    need(certificate.get("root") is None, "a fan has no root")
    return p, 1  # no row has a t


def check_prime(n, certificate):
    p, root = field(certificate, "prime", int), field(certificate, "root", int)
    need(1 < p < 2**31 and is_prime(p), f"{p} is no prime below 2^31")
    need((2 * n) % p and (p - 1) % n == 0, f"the prime {p} is not 1 modulo {n}")
    need(0 < root < p and has_order(root, n, p), f"the root {root} is not of order {n} modulo {p}")
    return p, root


def check_closed(case, steps, rank, root, p):
    """That lower bounds of the control points after `steps` steps hold for the functions.

    Where no piece has two extraordinary corners, a function that is zero has control points zero: by the regular patches, and
    by the annulus around each corner; midedge: but for the chess board, which sums over edges do not see.
    """
    _, crowded, meshes = closed_steps(case.scheme, case.n, case.rule)
    level = next((i for i in range(steps, MOST_STEPS + 1) if not crowded[i]), None)
    need(level is not None, f"the corners are not apart after {MOST_STEPS} steps")
    rows = global_rows(case.scheme, case.n, case.rule, level, t_modulo(root, p), p)
    if case.scheme == "midedge":
        edges = sorted({tuple(sorted(e)) for face in meshes[level] for e in edges_of(face)})
        rows = [[(x + y) % p for x, y in zip(rows[a], rows[b])] for a, b in edges]
    apart = rank_modulo(rows, p, case.dimension)
    need(apart == rank, f"after {level} steps, where corners are apart, the rank modulo {p} is {apart}, not {rank}")
    for m in sorted(valences_of(case.scheme, meshes[level])):
        need(annulus_determines(case.scheme, m, case.rule), f"the functions around a corner of valence {m} are dependent")


@functools.cache
def annulus_determines(scheme, m, rule):
    around = Case(scheme, m, rule, "annulus")
    p, root = own_prime(m, 0)
    chess = 1 if scheme == "midedge" and m % 2 == 0 else 0
    return around.rank_modulo(root, p) + chess == around.dimension


def check_kernel(case, certificate, rank, root, p):
    entries, left_out = field(certificate, "kernel", list), field(certificate, "left_out", (int,)) or 0
    vectors = [parse_vector(entry, case.dimension, case.order) for entry in entries]
    need(not case.border or all(type(x) is str for entry in entries for x in entry.values()), "an entry of a fan is not rational")
    allowed = case.own_tests() if case.kind != "global" else frozenset()
    need(left_out in (0, len(allowed)), f"left_out is {left_out}; {len(allowed)} rows may be left out")
    bound = case.dimension - len(vectors) + left_out
    need(bound == rank, f"the kernel shows at most {bound}, not {rank}")
    need(independent_vectors(vectors, case.order, root, p), "the vectors of the kernel are not shown to be independent")
    factor = rational(field(certificate, "factor", str)) if case.kind == "omega" else None
    for number, vector in enumerate(vectors, 1):
        if why := nonzero(case, vector, allowed if left_out else frozenset(), certificate, factor):
            raise Fault(f"vector {number} of the kernel {why}")


def nonzero(case, vector, left_out, certificate, factor):
    """Why a vector does not give the zero function; None if it does."""
    if case.kind == "global":
        for step in closed_steps(case.scheme, case.n, case.rule)[0][: certificate["steps"]]:
            vector = primitive(step.apply(vector))
        return "is not 0 after the steps" if any(map(any, vector)) else None
    if case.kind in ("pieces", "annulus"):
        points = case.corner.step.apply(vector)
        tests = case.first_tests() - left_out
        return "is not 0 on the domain" if any(sum(plane[i] for i in e) for e in tests for plane in points) else None
    if not case.second:
        return nonzero_rings(case.corner, vector, left_out, case.number, case.kind == "ring", factor)
    wrong, parts = case.corner.advance(vector)
    if wrong - left_out:
        return "is not 0 on ring 1"
    for number, (where, part) in enumerate(zip(case.corner.corners, parts), 1):
        if case.number != 1 and (why := nonzero_rings(where, part, left_out, (case.number or 0) - 1, False, factor)):
            return f"leaves a part {number} that {why}"
    return None


def nonzero_rings(where, vector, left_out, count, alone, factor):
    """Why a vector does not give zero on rings 1 to count of a corner, on ring count alone, or, with a factor, on all rings."""
    if factor is not None:
        if where.advance(vector)[0]:
            return "is not 0 on ring 1"
        return None if multiplied(where, vector, factor) else "is not multiplied by factor"
    for k in range(1, count + 1):
        wrong, (part,) = where.advance(vector)
        if wrong - left_out and (not alone or k == count):
            return f"is not 0 on ring {k}"
        if part == vector and not wrong:
            return None  # and so on all further rings
        vector = part
    return None


def multiplied(where, vector, factor):
    """Does a step map the vector to factor times itself?"""
    points, factor = where.step.apply(vector), factor * where.step.scale
    length = max(len(points), len(vector))
    left = [[plane[i] for i in where.parts[0]] for plane in points] + [[0] * where.count] * (length - len(points))
    right = list(vector) + [[0] * where.count] * (length - len(vector))
    return all(x == factor * y for a, b in zip(left, right) for x, y in zip(a, b))


def check_case(scheme, record):
    """Raises Fault if the case does not hold."""
    n, domain = field(record, "valence", int), field(record, "domain", str)
    rule, certificate = field(record, "rule", (str,)), field(record, "certificate", dict)
    dimension, rank = field(record, "dimension", int), field(record, "rank", int)
    for name in ("statement", "text"):
        field(record, name, (str,))
    second, place = field(record, "second", (int,)), field(record, "place", (str,))
    border, sharp = field(record, "border", (int,)), field(record, "corner", (bool,))
    need((3 if border is None else 1) <= n <= 1000, f"the valence is not in {3 if border is None else 1}..1000")
    if second is not None or place is not None:
        check_second(scheme, n, second, place)
    need(rule is None or (rule == "older" and scheme == "catmark"), f"{scheme} has no rule {rule}")
    if border is not None or sharp is not None:
        check_border(scheme, n, border)
        need(second is None and rule is None, "a fan has no second corner and no other rule")
    case = Case(scheme, n, rule, domain, second, place, border, sharp)
    need(dimension == case.dimension, f"the dimension is {case.dimension}, not {dimension}")
    need(field(record, "independent", bool) == (rank == dimension), "`independent` contradicts rank and dimension")

    p, root = check_rational_prime(certificate) if border else check_prime(case.order, certificate)
    rings = field(certificate, "rings", int) if case.kind == "omega" else None
    steps = field(certificate, "steps", int) if case.kind == "global" else None
    need(rings is None or 1 <= rings <= 9999, "rings is not in 1..9999")
    need(steps is None or 1 <= steps <= MOST_STEPS, f"steps is not in 1..{MOST_STEPS}")
    found = case.rank_modulo(root, p, rings, steps)
    need(found == rank, f"the rank modulo {p} is {found}, not {rank}")
    if steps:
        check_closed(case, steps, rank, root, p)

    check_upper(case, certificate, rank, root, p)


def check_second(scheme, n, second, place):
    need(second is not None and place is not None, "second and place go together")
    need(3 <= second <= 1000, "the second valence is not in 3..1000")
    need(place in PLACES, f"the place {place:.20} is not known")
    need(scheme != "loop" or place == "edge", "a triangle has no opposite corners")
    need(scheme != "loop" or (n, second) != (3, 3), "two corners of valence 3 at an edge of a triangle make no net")
    need(math.lcm(n, second) <= MOST_ORDER, f"the least common multiple of the valences is above {MOST_ORDER}")


def check_border(scheme, n, border):
    need(border is not None, "corner goes with border")
    need(scheme not in DUAL, f"fans of {scheme} are not known")
    need(1 <= border <= n, f"the border is not in 1..{n}")


def check_upper(case, certificate, rank, root, p):
    bound = field(certificate, "bound", str)
    need(bound in ("full", "count", "kernel"), f"bound {bound:.20} is not known")
    if bound == "kernel":
        check_kernel(case, certificate, rank, root, p)
    else:
        need(not certificate.get("kernel") and not certificate.get("left_out"), f"a bound by {bound} has no kernel")
        need(bound == "count" or rank == case.dimension, f"{rank} of {case.dimension} functions are not full")
        need(bound == "full" or not (case.second or case.kind in ("omega", "global")), "this domain has no count of rows")
        need(bound == "full" or rank == case.row_count(), f"the domain has not {rank} rows")


def fault_of(scheme, record):
    """Why a case does not hold, None if it does."""
    try:
        need(type(record) is dict, "the case is no object")
        check_case(scheme, record)
    except Fault as fault:
        return str(fault)
    return None


# --- Files -------------------------------------------------------------------------------------------------------------


def unique(pairs):
    """An object, read strictly: two fields of one name are an error."""
    found = dict(pairs)
    if len(found) != len(pairs):
        raise Unreadable("two fields of one name in an object")
    return found


def read(name):
    """(scheme, cases)."""
    try:
        if name == "-":
            text = sys.stdin.read()
        else:
            with open(name, encoding="utf-8") as file:
                text = file.read()
        document = json.loads(text, object_pairs_hook=unique)
    except (OSError, ValueError, RecursionError) as error:
        raise Unreadable(str(error)) from error
    if type(document) is not dict or document.get("scheme") not in SCHEMES:
        raise Unreadable("no object with a scheme of " + ", ".join(SCHEMES))
    if type(document.get("cases")) is not list or not document["cases"]:
        raise Unreadable("no cases")
    return document["scheme"], document["cases"]


def surroundings(record):
    """What to add to the valence, to name a case."""
    if record.get("border") is not None:
        return f" at a {'corner of a ' if record.get('corner') else ''}boundary, face {record['border']}"
    return f" with {record['second']} ({record.get('place')})" if record.get("second") is not None else ""


def check_file(name):
    """Lines to print, and whether all cases hold."""
    scheme, cases = read(name)
    shown = "standard input" if name == "-" else name
    lines = []
    for i, record in enumerate(cases, 1):
        if why := fault_of(scheme, record):
            known = type(record) is dict and {"valence", "domain"} <= record.keys()
            where = f"valence {record['valence']}{surroundings(record)}, {record['domain']}" if known else f"case {i}"
            lines.append(f"{shown}: {where}: {why}")
    if lines:
        return lines, False
    valences = [record["valence"] for record in cases]
    spread = f"valences {min(valences)} to {max(valences)}" if len(set(valences)) > 1 else f"valence {valences[0]}"
    what, verb = ("cases", "hold") if len(cases) > 1 else ("case", "holds")
    return [f"{shown}: {len(cases)} {what} of {spread} {verb}"], True


# --- Self test: certificates made here, and spoiled --------------------------------------------------------------------


def null_space(rows, size):
    """Basis of the rational vectors that all rows send to 0, as lists of Fractions."""
    basis = {}
    for row in rows:
        row = [Fraction(x) for x in row]
        for pivot, known in basis.items():
            if row[pivot]:
                row = [x - row[pivot] * y for x, y in zip(row, known)]
        pivot = next((i for i, x in enumerate(row) if x), None)
        if pivot is not None:
            row = [x / row[pivot] for x in row]
            for other, known in basis.items():
                basis[other] = [x - known[pivot] * y for x, y in zip(known, row)] if known[pivot] else known
            basis[pivot] = row
    return [[Fraction(i == free) if i not in basis else -basis[i][free] for i in range(size)]
            for free in range(size) if free not in basis]


def rational_rows(case, steps, without):
    """Rows over the rationals whose common zeros are the rational vectors with zero functions."""
    columns = []
    for i in range(case.dimension):
        vector, column = [[int(i == j) for j in range(case.dimension)]], []
        if case.kind == "global":
            for step in closed_steps(case.scheme, case.n, case.rule)[0][:steps]:
                vector = step.apply(vector)
            column.append({(r, d): x for d, plane in enumerate(vector) for r, x in enumerate(plane)})
        for ring in range(steps if case.kind != "global" else 0):
            points = case.corner.step.apply(vector)
            if case.kind != "ring" or ring == case.number - 1:
                column.append({(test, d): sum(plane[j] for j in test) for test in case.first_tests() - without
                               for d, plane in enumerate(points)})
            vector = [[plane[j] for j in case.corner.parts[0]] for plane in points] if case.corner.parts else []
        columns.append({(i, *key): x for i, values in enumerate(column) for key, x in values.items()})
    keys = sorted(set().union(*columns))
    return [[column.get(key, 0) for column in columns] for key in keys]


def entry_of(x):
    return str(x) if not isinstance(x, list) else [str(c) for c in x]


def sparse_vector(vector):
    return {str(i + 1): entry_of(x) for i, x in enumerate(vector) if x}


def shifts(case):
    """Doo-Sabin: zero on rings, and a quarter of themselves after a step."""
    return [{str(start + i): entry for i, entry in enumerate(("-1", ["1", "1"], ["-1", "-1"], "1"))}
            for start in range(3, case.n - 3)]


def pair_shifts(case):
    """The same at two corners: in each face the points beyond the neighbours of vertex 1."""
    vectors = []
    for face in case.corner.faces:
        t = cosines(case.order, len(face))[1]
        entries = ("-1", entry_of(poly_add([Fraction(1)], t)), entry_of(poly_add([Fraction(-1)], poly_scale(t, -1))), "1")
        inner = face[2:-1]
        vectors += [{str(v): x for v, x in zip(inner[i:], entries)} for i in range(len(inner) - 3)]
    return vectors


@functools.cache
def large_prime(n):
    """A number of 400 bits that is 1 modulo n and most likely a prime, and a root of order n."""
    p = next(p for p in itertools.count(2**400 - 2**400 % n + 1, n) if all(pow(g, p - 1, p) == 1 for g in (2, 3, 5)))
    return p, next(z for g in itertools.count(2) if has_order(z := pow(g, (p - 1) // n, p), n, p))


def null_modulo(basis, size, p):
    """Vectors that an echelon basis modulo p sends to 0, each 1 at one of the columns without a pivot and 0 at the others."""
    vectors = []
    for free in [c for c in range(size) if c not in basis]:
        vector = [int(c == free) for c in range(size)]
        for pivot in sorted(basis, reverse=True):
            vector[pivot] = -sum(x * y for x, y in zip(basis[pivot][pivot + 1:], vector[pivot + 1:])) % p
        vectors.append(vector)
    return vectors


def interpolated(points, values, p):
    """Coefficients modulo p of the polynomial that has these values."""
    total = [0] * len(points)
    for i, (x, value) in enumerate(zip(points, values)):
        others = points[:i] + points[i + 1:]
        factor = value * pow(math.prod(x - y for y in others), -1, p)
        term = functools.reduce(lambda a, y: poly_mul(a, [-y, 1]), others, [factor])
        total = [(a + b) % p for a, b in zip(total, term)]
    return total


def fraction_modulo(x, p):
    """The simplest fraction that is x modulo p."""
    (a, u), (b, v) = (p, 0), (x, 1)
    while b * b * 2 > p:
        q = a // b
        (a, u), (b, v) = (b, v), (a - q * b, u - q * v)
    return Fraction(b, v)


def pair_kernel(case, rings, parts=(0, 1)):
    """Basis of the kernel of ring 1 of a pair, and of its rings 2 to `rings` in some parts.

    It is made from those modulo a large prime for all values of t there.
    """
    p, root = large_prime(case.order)
    values = [t_modulo(pow(root, k, p), p) for k in range(1, case.order // 2 + 1) if math.gcd(k, case.order) == 1]
    kernels = []
    for t in values:
        found = PairRings(case.corner, t, p)
        found.parts = [found.parts[i] for i in parts]
        found.together(rings)
        kernels.append(null_modulo(found.basis, case.dimension, p))
    vectors = []
    for images in zip(*kernels):
        columns = [[fraction_modulo(x, p) for x in interpolated(values, column, p)] for column in zip(*images)]
        vectors.append({str(i + 1): entry_of(x[0] if not any(x[1:]) else x) for i, x in enumerate(columns) if any(x)})
    return vectors


def fan_kernel(case):
    """Basis of the kernel of a piece at a boundary, made from that modulo a large prime."""
    p, root = large_prime(case.order)
    t = t_modulo(root, p)
    found = Rings(case.corner, t, p)
    if case.kind == "pieces":
        found.basis = {}
        for row in test_rows(case.first_tests(), case.corner.step.modulo(t, p), case.dimension, p):
            extend(found.basis, row, p)
    elif case.kind == "ring":
        found.only(case.number)
        found.basis = found.alone
    else:
        found.together(case.number)
    return [sparse_vector([fraction_modulo(x, p) for x in vector]) for vector in null_modulo(found.basis, case.dimension, p)]


def certify(scheme, n, domain, rule, second=None, place=None, border=None, sharp=None):
    """A right case, or None where only a kernel with t would do that is not known here."""
    case = Case(scheme, n, rule, domain, second, place, border, sharp)
    p, root = own_prime(case.order, 0)
    certificate = {"prime": p, **({} if border else {"root": root}), "bound": "full"}
    steps = case.number if case.kind in ("ring", "rings") else 1
    if case.kind == "global":
        certificate["steps"] = steps = 1 if case.n % 2 else MOST_STEPS
    if case.kind == "omega":
        last = case.rank_modulo(root, p, 2 * case.dimension)
        certificate["rings"] = next(k for k in itertools.count(1) if case.rank_modulo(root, p, k) == last)
    rank = case.rank_modulo(root, p, certificate.get("rings"), steps)
    if rank < case.dimension and second:
        factor = {"factor": "1/4" if scheme == "doo-sabin" else "0"} if case.kind == "omega" else {}
        kernel = pair_kernel(case, certificate.get("rings", case.number))
        certificate.update({"bound": "kernel", "left_out": 0, "kernel": kernel, **factor})
    elif rank < case.dimension and border:
        certificate.update({"bound": "kernel", "left_out": 0, "kernel": fan_kernel(case)})
    elif rank < case.dimension and case.kind not in ("omega", "global") and rank == case.row_count():
        certificate["bound"] = "count"
    elif rank < case.dimension:
        certificate.update(kernel_of(case, rank, certificate))
        if "kernel" not in certificate:
            return None
    record = {"valence": n, "domain": domain, "dimension": case.dimension, "rank": rank, "independent": rank == case.dimension,
              "statement": None, "text": None, "certificate": certificate}
    more = {"rule": rule, "second": second, "place": place, "border": border, "corner": sharp}
    return {**record, **{name: x for name, x in more.items() if x}}


def order_of(record):
    return RATIONAL_ORDER if "border" in record else math.lcm(record["valence"], record.get("second") or 1)


def case_of(scheme, record):
    return Case(scheme, record["valence"], record.get("rule"), record["domain"], record.get("second"), record.get("place"),
                record.get("border"), record.get("corner"))


def kernel_of(case, rank, certificate):
    """The fields of a kernel of the right number of vectors."""
    steps = certificate["rings"] if case.kind == "omega" else certificate.get("steps") or case.number
    if case.kind not in ("ring", "rings", "omega", "global"):
        steps = 1
    if case.scheme == "doo-sabin" and case.kind in ("ring", "rings", "omega"):
        factor = {"factor": "1/4"} if case.kind == "omega" else {}
        return {"bound": "kernel", "left_out": 0, "kernel": shifts(case), **factor}
    for without in (frozenset(), case.own_tests()) if case.kind != "global" else [frozenset()]:
        vectors = null_space(rational_rows(case, steps, without), case.dimension)
        if case.dimension - len(vectors) + len(without) == rank:
            factor = {"factor": "0"} if case.kind == "omega" else {}  # midedge: the chess board
            return {"bound": "kernel", "left_out": len(without), "kernel": list(map(sparse_vector, vectors)), **factor}
    return {}


def changed(record, **fields):
    """A copy with fields of the case changed."""
    return {**record, **fields}


def recertified(record, **fields):
    """A copy with fields of the certificate changed; None takes a field out."""
    certificate = {**record["certificate"], **fields}
    return changed(record, certificate={k: x for k, x in certificate.items() if x is not None})


def with_rank(record, rank):
    return changed(record, rank=rank, independent=rank == record["dimension"])


def composite_modulus(n):
    """A product of two primes that are 1 modulo n, and a root of order n modulo both."""
    (p, y), (q, z) = ((p, next(z for z in range(2, p) if has_order(z, n, p)))
                      for p in itertools.islice((p for p in itertools.count(2 * n + 1) if p % n == 1 and is_prime(p)), 2))
    return p * q, next(x for x in range(y, p * q, p) if x % q == z)


def span_misses(vectors, size, n):
    """A column whose unit vector is not in the span of a kernel."""
    p, root = own_prime(n, 1)
    t = t_modulo(root, p)
    rows = [[value_modulo(column, t, p) for column in zip(*parse_vector(v, size, n))] for v in vectors]
    return next(i for i in range(size)
                if rank_modulo(rows + [[int(i == j) for j in range(size)]], p, len(rows) + 1) == len(rows) + 1)


def spoiled_kernels(record):
    """Pairs (what, record)."""
    n, size, certificate = order_of(record), record["dimension"], record["certificate"]
    vectors = certificate["kernel"]
    first, rest = vectors[0], vectors[1:]

    def put(*new):
        return recertified(record, kernel=list(new))

    column = str(span_misses(vectors, size, n) + 1)
    entry = first.get(column, "0")
    added = [str(Fraction(entry[0]) + 1), *entry[1:]] if type(entry) is list else str(Fraction(entry) + Fraction(1, 3))
    wrong = {**first, column: added}
    yield "an entry changed", put(wrong, *rest)
    if type(entry) is str and n != 4:  # t = 0 at n = 4
        yield "an entry changed by t", put({**first, column: [entry, "1"]}, *rest)
    yield "an entry changed of the last vector", put(*vectors[:-1], {**vectors[-1], column: "12345678901234567890123/7"})
    yield "a vector dropped", put(*rest)
    yield "a vector doubled", put(*vectors, first)
    yield "a zero vector", put({}, *rest)
    yield "a zero vector written out", put({key: "0" for key in first}, *rest)
    yield "a zero vector written with polynomials", put({"1": [str(x) for x in minimal(n)]}, *rest)
    yield "one more vector", with_rank(put(*vectors, {column: "1"}), record["rank"] - 1)
    yield "one vector less", with_rank(put(*rest), record["rank"] + 1)
    if rest:
        yield "a vector in place of another", put(first, first, *rest[1:])
        multiple = {k: [str(-3 * Fraction(c)) for c in (x if type(x) is list else [x])] for k, x in first.items()}
        yield "a multiple in place of another", put(first, multiple, *rest[1:])
    if len(rest) > 1 and all(type(x) is str for v in vectors for x in v.values()):
        total = {k: str(Fraction(first.get(k, 0)) + Fraction(rest[0].get(k, 0))) for k in first | rest[0]}
        yield "a sum in place of another", put(first, rest[0], total, *rest[2:])
    for key in [key for key in map(str, range(1, size + 1)) if key not in first][:1]:
        yield "an entry without coefficients", put({**first, key: []}, *rest)
    for key in ("0", "-1", "01", "1.0", "x", "", str(size + 1)):
        yield f"an entry of {key!r}", put({**first, key: "1"}, *rest)
    for bad in (1, 0.5, None, True, "", "1/0", "0.5", "1e3", " 1", "1/-2", "--1", "٣", [], ["x"], [1], [["1"]], {}):
        yield f"an entry {bad!r}", put({**first, next(iter(first), "1"): bad}, *rest)
    for bad in (None, [], "1", 1, list(first.values())):
        yield f"a vector {bad!r:.20}", put(bad, *rest)
    left_out = certificate["left_out"]
    for bad in {left_out + 1, left_out - 1, 0, 1, 2, size} - {left_out}:
        yield f"left_out {bad}", recertified(record, left_out=bad)
    yield "a row left out for a wrong vector", recertified(record, left_out=left_out + 1, kernel=vectors + [{column: "1"}])
    for bad in ("0", 0.0, False, []):
        yield f"left_out {bad!r}", recertified(record, left_out=bad)
    if "factor" in certificate:
        for bad in ("", "0.25", 0, 0.25, None, ["1/4"]):
            yield f"factor {bad!r}", recertified(record, factor=bad)
        # Of a pair, midedge's chess board is 0 after the step, and any factor holds.
        for bad in ("1/2", "-1/4", "1", "1/5") if certificate["factor"] != "0" or "second" not in record else ():
            yield f"factor {bad}", recertified(record, factor=bad)


def spoiled_primes(record):
    n, certificate = order_of(record), record["certificate"]
    p, root = certificate["prime"], certificate["root"]
    modulus, z = composite_modulus(n)
    yield "a composite modulus", recertified(record, prime=modulus, root=z)
    yield "a negative prime", recertified(record, prime=-p)
    for small in (0, 1, 2, 4):
        yield f"prime {small}", recertified(record, prime=small, root=1)
    q = next(q for q in itertools.count(2**30) if is_prime(q) and q % n != 1)
    yield "a prime that is not 1", recertified(record, prime=q)
    yield "a prime that is not 1, and root 1", recertified(record, prime=q, root=1)
    q = next(q for q in itertools.count(2**31 - 2**31 % n + 1 + n, n) if is_prime(q))
    z = next(z for g in itertools.count(2) if has_order(z := pow(g, (q - 1) // n, q), n, q))
    yield "too large a prime", recertified(record, prime=q, root=z)
    for z in {0, 1, p - 1, -root, p, root + p, root - p, 5, p - root} | {pow(root, k, p) for k in range(n)}:
        if not (0 < z < p and has_order(z, n, p)):
            yield f"root {z}", recertified(record, root=z)


def spoiled_cases(record):
    """Pairs (what, record) with a field of the case spoiled."""
    rank, dimension, n = record["rank"], record["dimension"], record["valence"]
    for other in {rank - 1, rank + 1, 0, dimension + 1, -rank} - {rank}:
        yield f"rank {other}", with_rank(record, other)
        yield f"rank {other}, independent as before", changed(record, rank=other)
        yield f"rank and dimension {other}", changed(record, rank=other, dimension=other, independent=True)
    for other in (dimension - 1, dimension + 1, 0):
        yield f"dimension {other}", changed(record, dimension=other, independent=rank == other)
    yield "independent flipped", changed(record, independent=not record["independent"])
    yield "independent 1", changed(record, independent=int(record["independent"]))
    for name in set(record) - {"statement", "text", "rule", "corner"}:
        yield f"without {name}", {k: x for k, x in record.items() if k != name}
        for bad in (None, "", str(record[name]), [record[name]], {}, 1.5, float(rank)):
            if type(bad) is not type(record[name]):
                yield f"{name} {bad!r:.20}", changed(record, **{name: bad})
    for bad in (1, True, [], {}):
        yield f"statement {bad!r}", changed(record, statement=bad)
        yield f"text {bad!r}", changed(record, text=bad)
        yield f"rule {bad!r}", changed(record, rule=bad)
    yield "rule newer", changed(record, rule="newer")
    for bad in ("piece:0", "piece:4", "piece:1,2", "pieces:2,1", "pieces:1,1", "pieces:1", "rings:0", "ring:01", "rings:",
                "Omega", "omega ", "rings:-1", "ring:1\n", "rings:99999"):
        yield f"domain {bad!r}", changed(record, domain=bad)
    for m in {n - 1, n + 1, 2 * n, -n, 0, 2, 1001} - {n}:
        yield f"valence {m}", changed(record, valence=m)
    if "second" in record:
        yield "another sum of valences", changed(record, valence=n + 1, second=record["second"] + 1)
        for m in (record["second"] - 1, record["second"] + 1, 2 * record["second"], -record["second"], 0, 2, 1001):
            yield f"second {m}", changed(record, second=m)
        for bad in ("Edge", "corner", 0, True, ["edge"]):
            yield f"place {bad!r}", changed(record, place=bad)
        for bad in ("piece:1", "piece:2", "pieces:1,2", "ring:1", "ring:2", "annulus", "global"):
            yield f"domain {bad}", changed(record, domain=bad)
    else:
        yield "a second corner without a place", changed(record, second=5)
        yield "a place without a second corner", changed(record, place="edge")
        yield "a second corner", changed(record, second=5, place="edge")
    if "border" not in record:
        for sharp in (False, True):
            yield f"corner {sharp} without border", changed(record, corner=sharp)
        yield "a border", changed(record, border=1)


def spoiled_certificates(record, count):
    """Pairs (what, record) with a field of the certificate spoiled; `count` rows are in the domain."""
    certificate = record["certificate"]
    for name in set(certificate) - {"left_out"}:
        yield f"certificate without {name}", recertified(record, **{name: None})
        for bad in ("", str(certificate[name]), [certificate[name]], {}, 1.5, True):
            if type(bad) is not type(certificate[name]):
                yield f"{name} {bad!r:.20}", recertified(record, **{name: bad})
    for bound in {"full", "count", "kernel", "Full", "rank"} - {certificate["bound"]}:
        if bound != "count" or record["rank"] != count:
            yield f"bound {bound}", recertified(record, bound=bound)
            yield f"bound {bound}, no kernel", recertified(record, bound=bound, kernel=None, left_out=None)
    if certificate["bound"] != "kernel":
        yield "a vector with no kernel", recertified(record, kernel=[{"1": "1"}])
        yield "left_out with no kernel", recertified(record, left_out=1)
    for k in {0, -1, certificate.get("rings", 0) - 1}:
        if "rings" in certificate:
            yield f"rings {k}", recertified(record, rings=k)
    for k in {0, -1, MOST_STEPS + 1}:
        if "steps" in certificate:
            yield f"steps {k}", recertified(record, steps=k)


def spoiled(record, scheme, truth):
    """Triples (what, scheme, record); `truth` has (rank, dimension) by (scheme, valence, domain, rule, second, place)."""
    certificate, n, domain, rule = record["certificate"], record["valence"], record["domain"], record.get("rule")
    fields = {"rings": certificate.get("rings", 9), "steps": certificate.get("steps", 1)}
    for (s, m, d, r, second, place), found in truth.items():
        if m == n and (s == scheme or d == domain) and found != (record["rank"], record["dimension"]):
            other = changed(recertified(record, **fields), domain=d, rule=r, second=second, place=place)
            yield f"{s}, {d}, rule {r}, {second} {place}", s, other
    if scheme != "catmark":
        yield "rule older", scheme, changed(record, rule="older")
    if record.get("second") not in (None, 6 if scheme == "loop" else 4):
        yield "no second corner", scheme, changed(record, second=None, place=None)
    if scheme == "loop" and "second" in record:
        yield "opposite corners of a triangle", scheme, changed(record, place="opposite")
        yield "valences 3 and 3", scheme, changed(record, valence=3, second=3)
    counted = domain not in ("global", "omega") and "second" not in record
    count = Case(scheme, n, rule, domain).row_count() if counted else None
    for what, bad in itertools.chain(spoiled_cases(record), spoiled_certificates(record, count), spoiled_primes(record),
                                     spoiled_kernels(record) if certificate["bound"] == "kernel" else ()):
        yield what, scheme, bad


def other_fans(record, scheme, fans):
    """Triples (what, scheme, record) of certificates of a piece at a boundary as those of another piece, vertex or domain;
    `fans` has the right records by (scheme, n, i, sharp, domain)."""
    n, i, sharp, domain = record["valence"], record["border"], "corner" in record, record["domain"]
    others = [(scheme, n, j, s, domain) for j in range(1, n + 1) for s in (False, True)]
    others += [(s, n, i, sharp, d) for s in FAN_SCHEMES for d in FAN_DOMAINS if s == scheme or d == domain]
    for s, _, j, flag, d in others:
        if not covers(record, fans[s, n, j, flag, d]):
            other = recertified(record, rings=record["certificate"].get("rings", 9))
            yield f"{s}, {d}, face {j}, corner {flag}", s, changed(other, domain=d, border=j, corner=flag)


def spoiled_fan(record, scheme):
    """Triples of a piece at a boundary with a field spoiled."""
    n, i, domain, certificate = record["valence"], record["border"], record["domain"], record["certificate"]
    for bad in (0, n + 1, -i, -1, "", str(i), float(i), True, [i], {}):
        yield f"border {bad!r}", scheme, changed(record, border=bad)
    for bad in (0, 1, "", "true", [], [True], {}):
        yield f"corner {bad!r}", scheme, changed(record, corner=bad)
    yield "a corner without border", scheme, changed(record, border=None, corner=True)
    for bad in ("annulus", "global"):
        yield f"domain {bad}", scheme, changed(recertified(record, steps=1), domain=bad)
    for s in DUAL:
        yield f"scheme {s}", s, record
    yield "a second corner", scheme, changed(record, second=4, place="edge")
    yield "another rule", scheme, changed(record, rule="older")
    p = certificate["prime"]
    for bad in (2, 4, 9, 1, 0, -p, p + 1, p * 3, 2**31 + 11, 2**61 - 1):  # the last two are primes
        yield f"prime {bad}", scheme, recertified(record, prime=bad)
    yield "a composite modulus", scheme, recertified(record, prime=32749 * 32719)
    for bad in (1, p - 1, own_prime(RATIONAL_ORDER, 0)[1], 0, "", [], False):
        yield f"root {bad!r}", scheme, recertified(record, root=bad)
    if certificate["bound"] == "kernel":
        first, *rest = certificate["kernel"]
        for more in ([], ["0"]):
            listed = {k: [x, *more] for k, x in first.items()}
            yield f"entries as lists of {1 + len(more)}", scheme, recertified(record, kernel=[listed, *rest])
    count = case_of(scheme, record).row_count() if domain != "omega" else None
    for what, bad in itertools.chain(spoiled_cases(record), spoiled_certificates(record, count),
                                     spoiled_kernels(record) if certificate["bound"] == "kernel" else ()):
        yield what, scheme, bad


def covers(record, other):
    """Does a certificate of a fan hold of the case of another record too? Kernels are in their one reduced form."""
    a, b = record["certificate"], other["certificate"]
    return ((record["rank"], record["dimension"]) == (other["rank"], other["dimension"])
            and a.get("kernel") == b.get("kernel") and a.get("rings", 9) >= b.get("rings", 1))


def too_low_fan(case, record, fans):
    """As too_low, of a piece at a boundary: with the kernels of other domains, and of the vertex sharp or not."""
    found = [fans[case.scheme, case.n, case.border, sharp, domain]["certificate"].get("kernel", [])
             for sharp in (False, True) for domain in FAN_DOMAINS]
    constant = {str(i + 1): "1" for i in range(case.dimension)}
    kernels = [[constant]] + [kernel for i, kernel in enumerate(found) if kernel and kernel not in found[:i]]
    for kernel, factor, left_out in [(k, f, 0) for k in kernels for f in ("0", "1")] + [(k, "0", 1) for k in kernels]:
        rank = case.dimension - len(kernel) + left_out
        if rank < record["rank"] or left_out:
            certificate = {**record["certificate"], "bound": "kernel", "kernel": kernel, "left_out": left_out}
            yield rank, {**certificate, "factor": factor}
    for bound in ("full", "count"):
        yield record["rank"] - 1, {**record["certificate"], "bound": bound, "kernel": []}


def also_right_fan(scheme, record):
    """Other certificates of the same piece at a boundary, or of its mirror image, that hold."""
    n, certificate = record["valence"], record["certificate"]
    kernel = certificate.get("kernel", [])
    yield "another prime", recertified(record, prime=next(p for p in itertools.count(2**30) if p % 3 == 2 and is_prime(p)))
    yield "root null", changed(record, certificate={**certificate, "root": None})
    if "corner" not in record:
        yield "corner false", changed(record, corner=False)
    if "rings" in certificate:
        yield "more rings", recertified(record, rings=certificate["rings"] + 3)
    inner, last = (n + 4, n + 2) if scheme == "loop" else (2 * n + 4, 2 * n + 2)
    turned = [{k if k == "1" else str(inner - int(k) if int(k) <= last else record["dimension"] + last + 1 - int(k)): x
               for k, x in vector.items()} for vector in kernel]
    swapped = {"piece:1": "piece:3", "piece:3": "piece:1", "pieces:1,2": "pieces:2,3", "pieces:2,3": "pieces:1,2"}
    yield "the mirror image", changed(recertified(record, kernel=turned or None), border=n + 1 - record["border"],
                                      domain=swapped.get(record["domain"], record["domain"]))
    if not kernel:
        yield "an empty kernel", recertified(record, kernel=[], left_out=0)
        return
    if record["domain"] != "omega" and case_of(scheme, record).row_count() == record["rank"]:
        yield "a count", recertified(record, bound="count", kernel=None, left_out=None)
    yield "vectors in another order", recertified(record, kernel=kernel[::-1])
    yield "no left_out", recertified(record, left_out=None)
    total = {k: str(Fraction(-7, 3) * sum(Fraction(v.get(k, 0)) for v in kernel)) for k in set().union(*kernel)}
    yield "their sum in place of the first", recertified(record, kernel=[total] + kernel[1:])
    yield "entries that are 0", recertified(record, kernel=[{**{"1": "0", "2": "-0/3"}, **v} for v in kernel])


def too_low(case, record, kernels):
    """Pairs (rank, certificate) whose upper bound must not hold.

    They claim less than the right rank, as an unlucky prime would allow, or leave out a row where none may be.
    """
    constant = {str(i + 1): "1" for i in range(case.dimension)}
    steps = case.number if case.kind in ("ring", "rings") else 1
    tried = [([constant], "1"), ([constant] + record["certificate"].get("kernel", []), "1/4")]
    tried += [(kernel, factor) for kernel in kernels for factor in ("0", "1/4")]
    if case.second and case.number != 1:
        for parts in ((0,), (1,)):  # not zero on the other one
            vectors = pair_kernel(case, record["certificate"].get("rings", case.number), parts)
            tried += [(vectors, "0"), (vectors, "1/4")]
        if case.number:
            vectors = pair_kernel(case, case.number - 1)  # not zero on the last ring
            tried.append((vectors, "0"))
    if case.kind not in ("global", "omega") and not case.second and case.corner.own:
        vectors = null_space(rational_rows(case, steps, case.corner.own), case.dimension)
        tried.append((list(map(sparse_vector, vectors)), "0"))
    for kernel, factor in tried:
        for left_out in range(4):
            rank = case.dimension - len(kernel) + left_out
            never = (case.second and case.number != 1) or re.fullmatch("rings?:[23]|omega|global", record["domain"])
            if rank < record["rank"] or (left_out and never):
                certificate = {**record["certificate"], "bound": "kernel", "kernel": kernel, "left_out": left_out}
                yield rank, {**certificate, "factor": factor}
    for bound in ("full", "count"):
        yield record["rank"] - 1, {**record["certificate"], "bound": bound, "kernel": []}


def also_right(scheme, record):
    """Other certificates of the same case that hold."""
    n, certificate = order_of(record), record["certificate"]
    p, root = own_prime(n, 1)
    yield "another prime", recertified(record, prime=p, root=root)
    yield "another root", recertified(record, root=pow(certificate["root"], n - 1, certificate["prime"]))
    if "rings" in certificate:
        yield "more rings", recertified(record, rings=certificate["rings"] + 3)
    if certificate["bound"] != "kernel":
        yield "an empty kernel", recertified(record, kernel=[], left_out=0)
        if "second" in record:
            yield "the corners swapped", changed(record, valence=record["second"], second=record["valence"])
        return
    vectors = certificate["kernel"]
    if scheme == "doo-sabin" and "second" in record and len(shifts := pair_shifts(case_of(scheme, record))) == len(vectors):
        yield "shifts", recertified(record, kernel=shifts)
    yield "vectors in another order", recertified(record, kernel=vectors[::-1])
    if not certificate["left_out"]:
        yield "no left_out", recertified(record, left_out=None)
    first = {k: entry_of(poly_mul([Fraction(c) for c in (x if type(x) is list else [x])], [Fraction(2), Fraction(-1, 3)]))
             for k, x in vectors[0].items()}
    yield "a vector times 2 - t / 3", recertified(record, kernel=[first] + vectors[1:])
    yield "entries that are 0", recertified(record, kernel=[{**{"1": "0", "2": ["0", "-0/3"]}, **v} for v in vectors])


# Derived on paper: a name, the case, and its rank.
def known_results():
    rings = [(n, k) for n in range(3, 13) for k in range(1, 9)]
    yield "loop, rings:k: min(n + 6, 11 + 2 k)", [("loop", n, f"rings:{k}", min(n + 6, 11 + 2 * k)) for n, k in rings]
    yield ("catmark, n >= 5, rings:k: min(2 n + 8, 18 if k = 1 else 17 + 2 k)",
           [("catmark", n, f"rings:{k}", min(2 * n + 8, 18 if k == 1 else 17 + 2 * k)) for n, k in rings if n >= 5])
    yield "doo-sabin, rings:k: min(n + 5, 11)", [("doo-sabin", n, f"rings:{k}", min(n + 5, 11)) for n, k in rings]
    yield ("midedge, n >= 5, rings:k: min(7 + 2 k, n + 4 + (n odd))",
           [("midedge", n, f"rings:{k}", min(7 + 2 * k, n + 4 + n % 2)) for n, k in rings if n >= 5])
    yield "midedge, regular (n = 4), rings:k: 8 of 9", [("midedge", 4, f"rings:{k}", 8) for k in range(1, 9)]
    yield "midedge, regular (n = 4), piece:i: 7", [("midedge", 4, f"piece:{i}", 7) for i in (1, 2, 3)]
    yield ("loop, piece:i: n + 6 up to n = 6, then 12",
           [("loop", n, f"piece:{i}", min(n + 6, 12)) for n in range(3, 13) for i in (1, 2, 3)])
    yield ("loop, pieces:i,j: n + 6 up to n = 7, then 13",
           [("loop", n, f"pieces:{i}", min(n + 6, 13)) for n in range(3, 13) for i in ("1,2", "1,3", "2,3")])
    for scheme, size in (("loop", lambda n: 3 * n + 1), ("catmark", lambda n: 6 * n + 1), ("doo-sabin", lambda n: 4 * n),
                         ("midedge", lambda n: 4 * n - (n % 2 == 0))):
        but = ", but for the chess board of even n" if scheme == "midedge" else ""
        yield (f"{scheme}, annulus: all{but}",
               [(scheme, n, "annulus", size(n)) for n in range(3, 13)])
    for scheme, size in (("loop", lambda n: n + 2), ("catmark", lambda n: 7 if n == 3 else 2 * n + 2),
                         ("doo-sabin", lambda n: 2 * n), ("midedge", lambda n: 2 * n - (n % 2 == 0))):
        but = {"catmark": ", but 7 of 8 on the cube", "midedge": ", but one for even n"}.get(scheme, "")
        yield (f"{scheme}, global: all{but}",
               [(scheme, n, "global", size(n)) for n in range(3, 13)])


def known_fans():
    """Ranks of pieces at a boundary, in the same form.

    Beyond the control points that ring 1 has, a ring shows one more on each side. The smooth mask of the vertex shows the sum
    of its neighbours on the boundary.
    """
    tried = [(n, i) for n in range(1, 13) for i in range(1, n + 1)]
    for scheme, each in (("loop", 1), ("catmark", 2)):
        for sharp in (True, False):
            cases = []
            for (n, i), k in itertools.product(tried, range(1, 9)):
                size = (n + 7 if scheme == "loop" else 2 * n + 9) - (i == 1) - (i == n)
                rank = size - sum(max(0, each * (there - 1) - k) for there in (i - 1, n - i)) + (not sharp)
                cases.append((scheme, n, f"rings:{k}", min(size, rank), None, None, i, sharp))
            yield f"{scheme}, {'corner' if sharp else 'boundary'}, rings:k: one more on each side", cases
    for scheme, along, away in (("loop", 9, 10), ("catmark", 12, 14)):
        cases = [(scheme, n, f"piece:{piece}", along if first == (piece == 1) else away, None, None, 1 if first else n, False)
                 for n in range(4, 13) for piece in (1, 3) for first in (True, False)]
        yield f"{scheme}, boundary, first and last face: {along} on the piece along the boundary, {away} on that away", cases
    for scheme, regular in FANS_REGULAR:
        cases = [(scheme, n, domain, fan(scheme, n, i, sharp).count, None, None, i, sharp)
                 for n, sharp in regular for i in range(1, n + 1) for domain in FAN_DOMAINS]
        yield f"{scheme}, a regular boundary, any domain: all", cases


def known_pairs():
    """Ranks of pieces with two corners, in the same form, where the second is regular or a symmetry knows them."""
    for scheme, place in PAIRS:
        regular = 6 if scheme == "loop" else 4
        # A function that is zero on a part of a regular piece is zero on it, but for midedge, where the piece is no polynomial.
        rings = [] if scheme == "midedge" else ["rings:2", "rings:3", "rings:4"]
        cases = [(scheme, n, domain, rank_of(scheme, n, domain), regular, place)
                 for n in range(3, 13) for domain in (*rings, "omega")]
        yield f"{scheme}, {place}, a regular second corner: as one corner", cases
        cases = [(scheme, m, f"rings:{k}", rank_of(scheme, n, f"rings:{k}", m, place), n, place)
                 for n in range(3, 9) for m in range(n + 1, 9) for k in range(1, 5)]
        yield f"{scheme}, {place}, rings:k: corners may be swapped", cases


def rank_of(scheme, n, domain, *others):
    case = Case(scheme, n, None, domain, *others)
    p, root = own_prime(case.order, 0)
    return case.rank_modulo(root, p, 2 * case.dimension, MOST_STEPS)


SELF_TEST_DOMAINS = ["piece:1", "piece:2", "piece:3", "pieces:1,2", "pieces:1,3", "pieces:2,3", "rings:1", "rings:2",
                     "rings:3", "ring:1", "ring:2", "ring:3", "omega", "annulus", "global"]
PAIRS = [(scheme, place) for scheme in SCHEMES for place in PLACES if (scheme, place) != ("loop", "opposite")]
FAN_SCHEMES = ("loop", "catmark")
FAN_DOMAINS = SELF_TEST_DOMAINS[:-2]
FANS_REGULAR = [("loop", [(3, False), (1, True)]), ("catmark", [(2, False), (1, True)])]  # (n, sharp)
SELF_TEST_FANS = [(n, i, sharp) for n in range(1, 9) for i in range(1, n + 1) for sharp in (False, True)]
SELF_TEST_PAIRS = [(3, 3), (3, 4), (4, 4), (5, 6), (8, 6), (7, 3), (8, 8)]


def self_test_files(record):
    """Faults of reading and reporting, around one right case of loop."""
    bad = with_rank(record, record["rank"] - 1)
    good = json.dumps({"scheme": "loop", "cases": [record, record]})
    holds = "2 cases of valence 7 hold"
    texts = [(good, 0, holds), (json.dumps({"scheme": "loop", "cases": [record, bad, bad]}), 1, "valence 7, piece:1: "),
             (json.dumps({"scheme": "loop", "cases": [record, 5]}), 1, "case 2: "),
             (good[:-1], 2, ""), ("", 2, ""), ("[]", 2, ""),
             ('{"scheme": "loop", "cases": []}', 2, "no cases"), ('{"scheme": "loop"}', 2, "no cases"),
             (good.replace('"loop"', '"sqrt3"'), 2, "scheme"), (good.replace('"rank"', '"rank": 1, "rank"'), 2, "two fields"),
             (good.replace('"scheme"', '"schema"'), 2, "scheme"), ("[" * 100000, 2, "")]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        for text, code, part in texts:
            path = pathlib.Path(folder) / "cases.json"
            path.write_text(text, encoding="utf-8")
            lines, found = check_files([str(path)])
            if found != code or not any(part in line for line in lines):
                wrong.append(f"a file {text:.60} gives {found}: {lines[:1]}")
        path.write_text(good, encoding="utf-8")
        for names, code in (([str(path), str(path)], 0), ([str(path), folder + "/none"], 2), ([folder], 2)):
            if check_files(names)[1] != code:
                wrong.append(f"files {names} do not give {code}")
    return wrong


def flat_corner(scheme):
    """Regular corners drawn in the plane: places of the control points, and of those of the three pieces, doubled."""
    square = list(itertools.product((-1, 0, 1), repeat=2))
    if scheme in DUAL:
        places = [(1, 1), (-1, 1), (-1, -1), (1, -1), (-1, 3), (1, 3), (3, 3), (3, 1), (3, -1)]
        return places, [{(x + 2 * a, y + 2 * b) for a, b in square} for x, y in ((1, 3), (3, 3), (3, 1))]
    if scheme == "catmark":
        places = [(0, 0), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1),
                  (2, -1), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (-1, 2)]
        return places, [set(itertools.product(range(x, x + 4), range(y, y + 4))) for x, y in ((0, -1), (0, 0), (-1, 0))]
    places = [(0, 0), (1, 0), (1, -1), (0, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (2, 0), (2, -1), (0, 2), (-1, 2)]
    around = [(a, b) for a, b in square if a != b or a == 0]
    children = (((2, 0), (1, 0), (1, 1)), ((1, 0), (1, 1), (0, 1)), ((0, 2), (0, 1), (1, 1)))
    return places, [{(x + a, y + b) for x, y in child for a, b in around} for child in children]


def self_test_geometry(scheme):
    """Faults of the meshes: a regular corner halves a drawing in the plane, and its pieces lie where they should."""
    n = 6 if scheme == "loop" else 4
    places, expected = flat_corner(scheme)
    where = corner(scheme, n, None)
    points = list(zip(*(where.step.apply([list(axis)])[0] for axis in zip(*places))))
    doubled = [tuple(Fraction(2 * x, where.step.scale) for x in point) for point in points]
    wrong = [] if [doubled[i] for i in where.parts[0]] == places else [f"{scheme}: the part left is not at the corner"]
    for i, (tests, drawn) in enumerate(zip(where.pieces, expected), 1):
        if {doubled[v] for test in tests for v in test} != drawn:
            wrong.append(f"{scheme}: piece {i} is elsewhere")
    return wrong


def self_test_pair_geometry(scheme, place):
    """The same of a regular piece, seen as one with two corners."""
    net, where = pair(scheme, *([6, 6] if scheme == "loop" else [4, 4]), place, None), 1 + PLACES.index(place)
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    if scheme in DUAL:
        corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
        places = [(0, 0), (2, 0), (0, 2), (-2, 0), (0, -2)] + [(2 * x, 2 * y) for x, y in corners]
        drawn = [{(x + 2 * a, y + 2 * b) for a, b in itertools.product((-1, 0, 1), repeat=2)} for x, y in corners]
    elif scheme == "catmark":
        outside = [(-1, 0), (-1, -1), (0, -1), (1, -1), (2, -1), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (-1, 2), (-1, 1)]
        places, drawn = corners + outside, [set(itertools.product(range(-1, 3), repeat=2)), *flat_corner(scheme)[1]]
    else:
        places = [(0, 0), (1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1), (2, -1), (2, 0), (1, 1), (0, 2), (-1, 2)]
        at_corner, middle, at_third = flat_corner(scheme)[1]
        drawn = [set(flat_corner(scheme)[0]), at_corner, middle, at_third]
    step = net.step
    points = list(zip(*(step.apply([list(axis)])[0] for axis in zip(*places))))
    doubled = [tuple(Fraction(2 * x, step.scale) for x in point) for point in points]
    wrong = []
    for i, part in zip((0, where), net.parts):
        first = corners[i] if scheme in DUAL else tuple(2 * x for x in corners[i])
        if {doubled[v] for v in part} != drawn[i] or doubled[part[0]] != first:
            wrong.append(f"{scheme}, {place}: part {i} is not at its corner")
    rest = [points for i, points in enumerate(drawn) if i not in (0, where)]
    if [{doubled[v] for test in tests for v in test} for tests in net.pieces] != rest:
        wrong.append(f"{scheme}, {place}: the regular pieces are elsewhere")
    return wrong


def lattice(scheme):
    """Edge neighbours of the origin in cyclic order."""
    return [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)] if scheme == "loop" else [(1, 0), (0, 1), (-1, 0), (0, -1)]


def at(*terms):
    """Sum of factors times places."""
    return tuple(sum(factor * place[axis] for factor, place in terms) for axis in (0, 1))


def flat_fan(scheme, n, i):
    """Face i of a fan drawn in the plane: places of the control points, and the vertices of the three pieces, doubled."""
    spokes = [lattice(scheme)[j % len(lattice(scheme))] for j in range(n + 1)]
    a, b = spokes[i - 1], spokes[i]
    pairs = list(zip(spokes, spokes[1:]))
    if scheme == "loop":
        ring = [at((2, spokes[0]))] + [place for c, d in pairs for place in (at((1, c), (1, d)), at((2, d)))]
        places = [(0, 0), *spokes, *ring[max(0, 2 * i - 3):2 * i + 2]]
        middle = at((1, a), (1, b))
        return places, [(at((2, a)), a, middle), (a, middle, b), (at((2, b)), b, middle)]
    ring = [at((2, spokes[0]))] + [at((x, c), (y, d)) for c, d in pairs for x, y in ((2, 1), (2, 2), (1, 2), (0, 2))]
    places = [(0, 0), spokes[0], *(place for c, d in pairs for place in (at((1, c), (1, d)), d)),
              *ring[max(0, 4 * i - 5):4 * i + 2]]
    squares = [[at((x + u, a), (y + v, b)) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))] for x, y in ((1, 0), (1, 1), (0, 1))]
    return places, squares


def around(scheme, vertices):
    """Places of a regular piece's points."""
    square = list(itertools.product((-1, 0, 1), repeat=2))
    steps = square if scheme == "catmark" else lattice(scheme) + [(0, 0)]
    return {at((1, v), (1, step)) for v in vertices for step in steps}


def self_test_fan(scheme, n, i):
    """Faults of a fan: of its masks; and whether, around a sharp vertex, it halves a drawing in the plane."""
    where, smooth = fan(scheme, n, i, True), fan(scheme, n, i, False)
    places, pieces = flat_fan(scheme, n, i)
    wrong, name = [], f"{scheme}, face {i} of {n}"
    if where.count != (n + 7 if scheme == "loop" else 2 * n + 9) - (i == 1) - (i == n) or where.count != len(places):
        wrong.append(f"{name}: {where.count} control points")
        return wrong
    drawn = list(zip(*(where.step.apply([list(axis)])[0] for axis in zip(*places))))
    doubled = [tuple(Fraction(2 * x, where.step.scale) for x in point) for point in drawn]
    if [doubled[v] for v in where.parts[0]] != places:
        wrong.append(f"{name}: the part left is not at the corner")
    for piece, vertices in zip(where.pieces, pieces, strict=True):
        found, whole = {doubled[v] for v, in piece}, around(scheme, vertices)
        if not (found == whole if len(piece) == REGULAR_POINTS[scheme] else set(vertices) <= found < whole):
            wrong.append(f"{name}: a piece is elsewhere")
    eighth, own = Fraction(1, 8), where.names.index(("vertex", 1))
    last = n + 1 if scheme == "loop" else 2 * n + 1
    if where.step.rows[own] != {0: [1]} or smooth.step.rows[own] != {0: [6 * eighth], 1: [eighth], last: [eighth]}:
        wrong.append(f"{name}: the mask of the vertex is wrong")
    if any(a != b for k, (a, b) in enumerate(zip(where.step.rows, smooth.step.rows)) if k != own):
        wrong.append(f"{name}: other masks know whether the vertex is sharp")
    masks = {"loop": {(4, 4), (6, 1, 1), (3, 3, 1, 1), (5, *[Fraction(1, 2)] * 6)},
             "catmark": {(4, 4), (6, 1, 1), (2, 2, 2, 2), (3, 3, *[Fraction(1, 2)] * 4),
                         (Fraction(9, 2), *[Fraction(3, 4)] * 4, *[eighth] * 4)}}[scheme]
    for row in where.step.rows[:own] + where.step.rows[own + 1:]:
        if tuple(sorted((8 * x for x, in row.values()), reverse=True)) not in masks:
            wrong.append(f"{name}: a mask is unknown")
    return wrong


class Lattice:
    """Values at places of the plane, times scale, refined by regular masks where all points of a mask are there."""

    def __init__(self, scheme, values, scale=1):
        self.scheme, self.values, self.scale = scheme, values, scale

    def total(self, terms):
        """Of pairs (weight, place); None where a place has no value."""
        known = all(place in self.values for _, place in terms)
        return sum(weight * self.values[place] for weight, place in terms) if known else None

    def mask(self, place):
        """The mask, times 64, of a place of the finer lattice: a product of curves' masks, or Loop's."""
        x, y = place
        if self.scheme == "catmark":
            curves = [((1, c // 2 - 1), (6, c // 2), (1, c // 2 + 1)) if c % 2 == 0 else ((4, c // 2), (4, c // 2 + 1))
                      for c in place]
            return [(u * v, (c, d)) for u, c in curves[0] for v, d in curves[1]]
        if x % 2 == y % 2 == 0:
            return [(40, (x // 2, y // 2))] + [(4, (x // 2 + c, y // 2 + d)) for c, d in lattice("loop")]
        k = next(k for k, (c, d) in enumerate(lattice("loop")) if (x - c) % 2 == (y - d) % 2 == 0)
        before, along, after = (lattice("loop")[(k + j) % 6] for j in (-1, 0, 1))
        start = (x - along[0]) // 2, (y - along[1]) // 2
        return [(w, at((1, start), (1, d))) for w, d in ((24, (0, 0)), (24, along), (8, before), (8, after))]

    def finer(self):
        near = list(itertools.product((-1, 0, 1), repeat=2))
        found = {place: self.total(self.mask(place))
                 for place in {(2 * x + c, 2 * y + d) for x, y in self.values for c, d in near}}
        return Lattice(self.scheme, {place: x for place, x in found.items() if x is not None}, 64 * self.scale)

    def limit(self, place):
        """The limit at a place; None if its neighbours are not all there."""
        own, side, diagonal = (6, 1, 0) if self.scheme == "loop" else (16, 4, 1)
        weights = {(c, d): diagonal for c in (-1, 1) for d in (-1, 1)} if diagonal else {}
        weights |= {(0, 0): own, **{d: side for d in lattice(self.scheme)}}
        total = self.total([(w, at((1, place), (1, d))) for d, w in weights.items()])
        return None if total is None else Fraction(total, sum(weights.values()) * self.scale)

    def extended(self, wanted, sharp):
        """With the wanted points beyond the line y = 0, and beyond x = 0 of a sharp vertex of one face."""
        grid = dict(self.values)

        def value(place):
            if place not in grid:
                inward, across = ((0, 1), (1, 0)) if place[1] < 0 else ((1, 0), (0, 1))
                assert place[1] < 0 or (sharp and place[0] < 0)
                if self.scheme == "catmark" or (sharp and place in ((-1, 0), (0, -1))):
                    grid[place] = 2 * value(at((1, place), (1, inward))) - value(at((1, place), (2, inward)))
                else:  # the triangle on the other side of the boundary's edge
                    a, b = at((1, place), (1, inward)), at((1, place), (1, inward), (-1, across))
                    grid[place] = value(a) + value(b) - value(at((1, a), (1, b), (-1, place)))
            return grid[place]

        return Lattice(self.scheme, {place: value(place) for place in wanted}, self.scale)


def self_test_regular_fan(scheme, n, i, sharp):
    """Faults of a fan at a regular boundary: each function is the same polynomial on the piece and on the three of ring 1.

    A polynomial on a piece is known from its values at the corners of 16 parts.
    """
    where = fan(scheme, n, i, sharp)
    places, pieces = flat_fan(scheme, n, i)
    doubled = [tuple(Fraction(2 * x, where.step.scale) for x in point)
               for point in zip(*(fan(scheme, n, i, True).step.apply([list(axis)])[0] for axis in zip(*places)))]
    whole = [(0, 0), *flat_spokes(scheme, i)]
    wrong = []
    for b in range(where.count):
        points = where.step.apply([[int(b == j) for j in range(where.count)]])[0]
        parent = Lattice(scheme, {place: int(b == j) for j, place in enumerate(places)})
        parent = parent.extended(around(scheme, whole), sharp).finer().finer().finer()
        for k, (piece, vertices) in enumerate(zip(where.pieces, pieces), 1):
            part = Lattice(scheme, {doubled[v]: points[v] for v, in piece}, where.step.scale)
            part = part.extended(around(scheme, vertices), sharp).finer().finer()
            nodes = [at((4 - x - y, vertices[0]), (x, vertices[1]), (y, vertices[-1])) for x in range(5) for y in range(5)
                     if scheme == "catmark" or x + y <= 4]
            if any(part.limit(node) is None or part.limit(node) != parent.limit(node) for node in nodes):
                wrong.append(f"{scheme}, face {i} of {n}, piece {k}: function {b + 1} is another polynomial")
    return wrong


def flat_spokes(scheme, i):
    """The other vertices of face i of a fan drawn in the plane."""
    a, b = lattice(scheme)[i - 1], lattice(scheme)[i]
    return [a, b] if scheme == "loop" else [a, at((1, a), (1, b)), b]


def self_test_forms():
    """Faults of the counts of midedge's rows, against the rank of sums of two points."""
    wrong = []
    for n, domain in itertools.product(range(3, 9), SELF_TEST_DOMAINS[:7] + ["annulus"]):
        case = Case("midedge", n, None, domain)
        size, p = len(case.corner.step.rows), own_prime(n, 0)[0]
        rows = [[int(i in test) for i in range(size)] for test in case.first_tests()]
        if rank_modulo(rows, p, size) != case.row_count():
            wrong.append(f"midedge {n}, {domain}: the count of rows is wrong")
    return wrong


def self_test_masks(n):
    """Faults of masks against closed forms, and of eigenvalues against those known."""
    wrong, p, root = [], *own_prime(n, 0)
    t, c = t_modulo(root, p), [pow(root, i, p) + pow(root, -i, p) for i in range(n)]
    loop = (5 * pow(8, -1, p) - (11 + 6 * c[1] + c[2 % n]) * pow(64, -1, p)) * pow(n, -1, p)
    spectra = {"loop": [3 + c[1], -8], "catmark": [1, -10 - c[1], 16], "doo-sabin": [1, -2], "midedge": [2 + c[1], -4]}
    vertex = {None: (1 - Fraction(7, 4 * n), Fraction(3, 2 * n * n), Fraction(1, 4 * n * n)),
              "older": (Fraction(9, 16), Fraction(3, 8 * n), Fraction(1, 16 * n))}
    for scheme, rule in [(s, None) for s in SCHEMES] + [("catmark", "older")]:
        where = corner(scheme, n, rule)
        size, sparse = where.count, where.step.modulo(t, p)
        if any(sum(w for _, w in row) % p != 1 for row in sparse):
            wrong.append(f"{scheme} {n}: weights do not sum to 1")
        own = [dict(sparse[i]).get(k, 0) for i in where.parts[0][:1] for k in range(size)]
        if scheme == "loop" and own != [(1 - n * loop) % p] + [loop % p] * n + [0] * (size - n - 1):
            wrong.append(f"{scheme} {n}: the vertex mask is wrong")
        if scheme == "catmark" and own != [value_modulo([x], t, p) for x in vertex[rule][:1] + vertex[rule][1:] * n] + [0] * 7:
            wrong.append(f"{scheme} {n} {rule}: the vertex mask is wrong")
        power = [[int(i == j) for j in range(size)] for i in range(size)]
        total = [[0] * size for _ in range(size)]
        for x in spectra[scheme] if not rule else ():
            total = [[(a + x * b) % p for a, b in zip(r, q)] for r, q in zip(total, power)]
            power = [times(row, [sparse[i] for i in where.parts[0]], size, p) for row in power]
        if not rule and rank_modulo(total, p, size) > size - 2 * (len(spectra[scheme]) - 1):
            wrong.append(f"{scheme} {n}: the second eigenvalues are wrong")
    return wrong


def misjudged(where, right, bad):
    """Faults of judging triples (what, scheme, record) that are right or bad; and the number of bad ones."""
    wrong, count = [], 0
    for what, scheme, record in right:
        if why := fault_of(scheme, json.loads(json.dumps(record))):
            wrong.append(f"{where}, {what}: rejected: {why}")
    for what, scheme, record in bad:
        count += 1
        if not fault_of(scheme, json.loads(json.dumps(record))):
            wrong.append(f"{where}, {what}: accepted")
    return wrong, count


def misjudged_bounds(where, case, record, bounds):
    """Faults of judging pairs (rank, certificate) whose upper bound must not hold; and their number."""
    wrong, count, (p, root) = [], 0, own_prime(order_of(record), 0)
    for rank, certificate in bounds:
        count += 1
        try:
            check_upper(case, certificate, rank, root, p)
            wrong.append(f"{where}: accepted as a proof that the rank is {rank}: {certificate}")
        except Fault:
            pass
    return wrong, count


def self_test_fans():
    """Faults of pieces at a boundary; the numbers of certificates accepted and rejected. Each spoils a part of the cases."""
    wrong, count = [], 0
    for scheme, n in itertools.product(FAN_SCHEMES, range(1, 13)):
        wrong += itertools.chain(*(self_test_fan(scheme, n, i) for i in range(1, n + 1)))
    for scheme, regular in FANS_REGULAR:
        wrong += itertools.chain(*(self_test_regular_fan(scheme, n, i, sharp) for n, sharp in regular for i in range(1, n + 1)))
    fans = {(scheme, n, i, sharp, domain): certify(scheme, n, domain, None, border=i, sharp=sharp) for scheme in FAN_SCHEMES
            for n, i, sharp in SELF_TEST_FANS for domain in FAN_DOMAINS}
    for number, ((scheme, *_), record) in enumerate(fans.items()):
        where = f"{scheme} {record['valence']}{surroundings(record)} {record['domain']}"
        right, bad = [("as made", scheme, record)], other_fans(record, scheme, fans) if number % 2 == 0 else []
        if number % 4 == 0:
            right += [(what, scheme, other) for what, other in also_right_fan(scheme, record)]
        if number % 12 == 0:
            bad = itertools.chain(bad, spoiled_fan(record, scheme))
        found = [misjudged(where, right, bad)]
        if number % 7 == 0:
            case = case_of(scheme, record)
            found.append(misjudged_bounds(where, case, record, too_low_fan(case, record, fans)))
        for faults, tried in found:
            wrong += faults
            count += tried
    return wrong, len(fans), count


def self_test():
    """Faults of this check, and what was tried."""
    wrong, accepted, count = self_test_fans()
    right, truth = [], {}
    wrong += itertools.chain(self_test_forms(), *map(self_test_geometry, SCHEMES), *map(self_test_masks, range(3, 13)),
                             *itertools.starmap(self_test_pair_geometry, PAIRS))
    for name, cases in itertools.chain(known_results(), known_pairs(), known_fans()):
        off = [f"{n} {domain} {second}: {found}, not {rank}"
               for s, n, domain, rank, *second in cases if (found := rank_of(s, n, domain, *second)) != rank]
        print(f"  {name}: {f'WRONG at {off}' if off else f'{len(cases)} ranks agree'}")
        wrong += off
    tried = [(*case, None, None) for case in itertools.product(SCHEMES, range(3, 9), SELF_TEST_DOMAINS)]
    tried += [(scheme, n, domain, m, place) for (scheme, place), (n, m), domain in
              itertools.product(PAIRS, SELF_TEST_PAIRS, ["rings:1", "rings:3", "omega"])
              if (scheme, n, m) != ("loop", 3, 3)]
    for scheme, n, domain, *second in tried:
        for rule in (None, "older") if scheme == "catmark" else (None,):
            record = certify(scheme, n, domain, rule, *second)
            if record is None:
                wrong.append(f"no certificate of {scheme} {n} {domain} {rule}")
                continue
            right.append((scheme, record))
            truth[scheme, n, domain, rule, *second] = record["rank"], record["dimension"]
    for scheme, record in right:
        where = f"{scheme} {record['valence']}{surroundings(record)} {record['domain']} {record.get('rule', '')}"
        kernels = [r["certificate"]["kernel"] for s, r in right if r["certificate"]["bound"] == "kernel" and s == scheme
                   and (r["dimension"], r.get("rule")) == (record["dimension"], record.get("rule"))]
        good = [(what, scheme, other) for what, other in [("as made", record), *also_right(scheme, record)]]
        case = case_of(scheme, record)
        for faults, tried in (misjudged(where, good, spoiled(record, scheme, truth)),
                              misjudged_bounds(where, case, record, too_low(case, record, kernels))):
            wrong += faults
            count += tried
    wrong += self_test_files(next(r for s, r in right if s == "loop" and r["valence"] == 7 and r["domain"] == "piece:1"))
    return wrong, f"{len(right) + accepted} certificates accepted, {count} spoiled ones rejected"


def check_files(names):
    """Lines to print, and the exit code."""
    shown, code = [], 0
    for name in names:
        try:
            lines, holds = check_file(name)
            code = max(code, 0 if holds else 1)
        except Unreadable as error:
            lines, code = [f"{name}: cannot be read: {error}"], 2
        shown += lines
    return shown, code


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("files", nargs="*", metavar="FILE.json", help="of `snug-research independence --json`; - for standard input")
    parser.add_argument("--self-test", action="store_true", help="check that this check can fail")
    arguments = parser.parse_args()
    if arguments.self_test:
        wrong, passed = self_test()
        for fault in wrong:
            print(fault, file=sys.stderr)
        print(f"check_independence: {f'{len(wrong)} faults' if wrong else f'self test passed ({passed})'}")
        return 1 if wrong else 0
    if not arguments.files:
        parser.error("no files; or --self-test")
    lines, code = check_files(arguments.files)
    print("\n".join(lines))
    return code


if __name__ == "__main__":
    sys.exit(main())
