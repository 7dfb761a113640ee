"""Small meshes of the kinds that real files hold and few tests do: what a question finds hard, one kind a file."""

import math
from pathlib import Path


class Mesh:
    def __init__(self):
        self.points, self.faces, self.tags = [], [], []

    def point(self, x, y, z):
        self.points.append((x, y, z))
        return len(self.points) - 1

    def add(self, other, move=(0.0, 0.0, 0.0)):
        first = len(self.points)
        self.points += [tuple(p + m for p, m in zip(point, move)) for point in other.points]
        self.faces += [[first + v for v in face] for face in other.faces]
        return self

    def crease(self, a, b, sharpness):
        self.tags.append(f"t crease 2/1/0 {a} {b} {sharpness}")

    def write(self, path):
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.points]
        lines += ["f " + " ".join(str(v + 1) for v in face) for face in self.faces]
        Path(path).write_text("\n".join(lines + self.tags) + "\n")


def box(x=1.0, y=1.0, z=1.0, triangles=False):
    mesh = Mesh()
    for k in (0, 1):
        for j in (0, 1):
            for i in (0, 1):
                mesh.point(i * x, j * y, k * z)
    mesh.faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    if triangles:
        mesh.faces = [t for a, b, c, d in mesh.faces for t in ([a, b, c], [a, c, d])]
    return mesh


def grid(columns, rows, height=lambda x, y: 0.0, triangles=False):
    mesh = Mesh()
    for j in range(rows + 1):
        for i in range(columns + 1):
            mesh.point(i / columns, j / rows, height(i / columns, j / rows))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            mesh.faces += [[a, b, c], [a, c, d]] if triangles else [[a, b, c, d]]
    return mesh


def cylinder(sides, sharp_caps):
    """Caps are polygons, whose edges may be creases."""
    mesh = Mesh()
    for z in (0.0, 1.0):
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            mesh.point(math.cos(angle), math.sin(angle), z)
    ring = range(sides)
    mesh.faces = [[k, (k + 1) % sides, sides + (k + 1) % sides, sides + k] for k in ring]
    mesh.faces += [list(reversed(ring)), [sides + k for k in ring]]
    for k in ring if sharp_caps else ():
        mesh.crease(k, (k + 1) % sides, sharp_caps)
        mesh.crease(sides + k, sides + (k + 1) % sides, sharp_caps)
    return mesh


def poles(valence, triangles, height=0.7):
    """Two poles with a belt between them."""
    mesh = Mesh()
    for z, radius in ((-0.3, 1.0), (0.3, 1.0)):
        for k in range(valence):
            angle = 2 * math.pi * k / valence
            mesh.point(radius * math.cos(angle), radius * math.sin(angle), z)
    low, high = mesh.point(0, 0, -height), mesh.point(0, 0, height)
    for k in range(valence):
        a, b = k, (k + 1) % valence
        c, d = valence + b, valence + a
        mesh.faces += [[low, b, a], [high, d, c]]
        mesh.faces += [[a, b, c], [a, c, d]] if triangles else [[a, b, c, d]]
    return mesh


def dart(sharpness):
    mesh = grid(4, 4, lambda x, y: 0.3 * math.sin(2 * x + y))
    for a in (10, 11, 12):
        mesh.crease(a, a + 1, sharpness)
    return mesh


def l_shaped_face():
    mesh = Mesh()
    for x, y in ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)):
        mesh.point(float(x), float(y), 0.0)
    mesh.faces = [[0, 1, 2, 3, 4, 5]]
    return mesh


def saddle_corners():
    """Six cubes of eight, as squares: corners whose squares lie on both sides of every plane through them."""
    mesh, names = Mesh(), {}
    cubes = {(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)} - {(1, 1, 1), (0, 0, 0)}
    sides = [((-1, 0, 0), [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)]), ((1, 0, 0), [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)]),
             ((0, -1, 0), [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)]), ((0, 1, 0), [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)]),
             ((0, 0, -1), [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]), ((0, 0, 1), [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])]
    for cube in sorted(cubes):
        for way, corners in sides:
            if tuple(c + w for c, w in zip(cube, way)) in cubes:
                continue
            face = []
            for corner in corners:
                at = tuple(c + x for c, x in zip(cube, corner))
                if at not in names:
                    names[at] = mesh.point(*map(float, at))
                face.append(names[at])
            mesh.faces.append(face)
    return mesh


def thread(turns, steps):
    """A square bar along a helix, capped: long, thin, and near itself."""
    mesh = Mesh()
    for k in range(steps * turns + 1):
        angle = 2 * math.pi * k / steps
        for r, z in ((0.8, 0.0), (1.0, 0.0), (1.0, 0.12), (0.8, 0.12)):
            mesh.point(r * math.cos(angle), r * math.sin(angle), z + 0.2 * k / steps)
    last = 4 * steps * turns
    for k in range(steps * turns):
        for c in range(4):
            a, b = 4 * k + c, 4 * k + (c + 1) % 4
            mesh.faces.append([a, a + 4, b + 4, b])
    mesh.faces += [[0, 1, 2, 3], [last + 3, last + 2, last + 1, last]]
    return mesh


def sheets_at_a_vertex():
    mesh = grid(2, 2)
    middle = 4
    first = len(mesh.points)
    mesh.add(grid(2, 2), (0.0, 0.0, 0.0))
    mesh.points[first:] = [(x, y, 2 * abs(x - 0.5) + 2 * abs(y - 0.5))
                           for x, y, _ in mesh.points[first:]]
    mesh.faces = [[middle if v == first + middle else v for v in face] for face in mesh.faces]
    return mesh


def vertices_twice():
    """Every face has corners of its own, as exporters write that split normals."""
    whole = thread(1, 8)
    mesh = Mesh()
    for face in whole.faces:
        mesh.faces.append([mesh.point(*whole.points[v]) for v in face])
    return mesh


def soup(bodies):
    """Bodies that pass through each other, as kit-bashed models have them."""
    mesh = Mesh()
    for k in range(bodies):
        mesh.add(box(1.0, 0.4, 0.3) if k % 2 else poles(6, False, 0.4), (0.37 * k, 0.11 * (k % 5), 0.07 * (k % 3)))
    return mesh


def needles():
    return grid(40, 2, lambda x, y: 1e-3 * math.sin(9 * x), triangles=True)


def flat_part(cells):
    """A plate with a step, of triangles in its planes: what CAD exports."""
    return grid(cells, cells, lambda x, y: 0.0 if x < 0.5 else 0.25, triangles=True)


def disc(sides):
    """A flat cylinder whose caps are fans around one vertex, as CAD triangulates them."""
    mesh = Mesh()
    for z in (0.0, 0.1):
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            mesh.point(math.cos(angle), math.sin(angle), z)
    for k in range(1, sides - 1):
        mesh.faces += [[0, k + 1, k], [sides, sides + k, sides + k + 1]]
    for k in range(sides):
        after = (k + 1) % sides
        mesh.faces += [[k, after, sides + after], [k, sides + after, sides + k]]
    return mesh


def large(columns):
    mesh = grid(columns, columns, lambda x, y: 0.1 * math.sin(8 * x) * math.cos(7 * y))
    return mesh


STAND_INS = {
    "box": lambda: box(), "box_triangles": lambda: box(triangles=True), "quad": lambda: grid(1, 1),
    "grid_3": lambda: grid(3, 3, lambda x, y: x * x - y), "triangle_grid": lambda: grid(3, 3, lambda x, y: x * y, triangles=True),
    "l_face": l_shaped_face, "cylinder_sharp": lambda: cylinder(8, 10), "cylinder_semi": lambda: cylinder(12, 2.3),
    "dart": lambda: dart(10), "dart_semi": lambda: dart(1.5),
    "pole_9": lambda: poles(9, False), "pole_16": lambda: poles(16, False), "pole_32": lambda: poles(32, False),
    "pole_64": lambda: poles(64, False), "loop_pole_32": lambda: poles(32, True), "saddle_corners": saddle_corners,
    "thread": lambda: thread(4, 16), "sheets_at_a_vertex": sheets_at_a_vertex, "vertices_twice": vertices_twice,
    "soup": lambda: soup(12), "needles": needles, "flat_part": lambda: flat_part(60), "disc": lambda: disc(60), "large": lambda: large(158),
}


def write_all(folder):
    paths = []
    for name, make in STAND_INS.items():
        path = Path(folder) / f"{name}.obj"
        make().write(path)
        paths.append(path)
    return paths
