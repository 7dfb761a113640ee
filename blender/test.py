# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension in Blender: blender -b --factory-startup --python blender/test.py -- MESHES.json, with the add-on installed.

Writes the farthest that Blender's limit surface at qualities 10 and 3, and its levels, are from snug's, of each mesh, into
MESHES.json, as parts of its size.
"""

import json
import math
import os
import sys
import tempfile
import traceback

import bpy
import numpy as np

bpy.ops.preferences.addon_enable(module="snug_blender")
import snug  # noqa: E402  (which the add-on has found)
from snug_blender import cages, live, operators, panel, words  # noqa: E402

SMOOTH, SEMI_SHARP = 2e-7, 1e-6  # of the size: single precision, and what it adds up to at semi-sharp creases


def new(name, points, faces, boundary="ALL", simple=False, edges={}, corners={}, quality=10, level=4):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, p)) for p in points], [], faces)
    mesh.update()
    if edges:
        by_ends = {tuple(sorted(edge.vertices)): edge for edge in mesh.edges}
        values = np.zeros(len(mesh.edges), np.float32)
        for ends, value in edges.items():
            values[by_ends[tuple(sorted(ends))].index] = value
        if hasattr(mesh.edges[0], "crease"):
            mesh.edges.foreach_set("crease", values)
        else:
            mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", values)
    if corners:
        values = np.zeros(len(mesh.vertices), np.float32)
        for vertex, value in corners.items():
            values[vertex] = value
        if bpy.app.version < (4, 0):
            if not mesh.vertex_creases:
                obj = bpy.data.objects.new("holder", mesh)
                bpy.context.scene.collection.objects.link(obj)
                with bpy.context.temp_override(object=obj, active_object=obj, mesh=mesh):
                    bpy.ops.mesh.customdata_crease_vertex_add()
                bpy.data.objects.remove(obj)
            mesh.vertex_creases[0].data.foreach_set("value", values)
        else:
            mesh.attributes.new("crease_vert", "FLOAT", "POINT").data.foreach_set("value", values)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.subdivision_type = "SIMPLE" if simple else "CATMULL_CLARK"
    modifier.boundary_smooth = boundary
    modifier.levels = level
    modifier.quality = quality
    modifier.use_limit_surface = True
    return obj


CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def grid(n, height=lambda x, y: 0.3 * math.sin(3 * x) * math.cos(2 * y)):
    points = [(i / n, j / n, height(i / n, j / n)) for i in range(n + 1) for j in range(n + 1)]
    at = lambda i, j: i * (n + 1) + j
    return points, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(n) for j in range(n)]


def torus(n, m, big=1.0, small=0.4):
    turn = lambda k, count: 2 * math.pi * k / count
    points = [((big + small * math.cos(turn(j, m))) * math.cos(turn(i, n)), (big + small * math.cos(turn(j, m))) * math.sin(turn(i, n)), small * math.sin(turn(j, m))) for i in range(n) for j in range(m)]
    return points, [(i * m + j, (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m) for i in range(n) for j in range(m)]


def prism(n):
    ring = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
    points = [(x, y, -0.7) for x, y in ring] + [(x, y, 0.7) for x, y in ring]
    return points, [tuple(range(n))[::-1], tuple(range(n, 2 * n))] + [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]


def octahedron(stretch=1.0):
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, stretch), (0, 0, -stretch)]
    return points, [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]


def fan(n):
    return [(0, 0, 0.8)] + [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), 0) for i in range(n)], [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)]


TOP = [(1, 3), (3, 7), (7, 5), (5, 1)]
SHEET, SHEET_FACES = grid(3)
# name: how it is made, and how near it is
MESHES = {
    "cube": (lambda: new("cube", CUBE, CUBE_FACES), SMOOTH),
    "crease of 1": (lambda: new("crease", CUBE, CUBE_FACES, edges={e: 1.0 for e in TOP}), SMOOTH),
    "crease of 0.5": (lambda: new("half", CUBE, CUBE_FACES, edges={e: 0.5 for e in TOP}), SEMI_SHARP),
    "creases of 0.3 and 0.8": (lambda: new("mixed", CUBE, CUBE_FACES, edges={TOP[0]: 0.3, TOP[1]: 0.8, TOP[2]: 0.8}), SEMI_SHARP),
    "vertex crease of 1": (lambda: new("corner", CUBE, CUBE_FACES, corners={7: 1.0}), SMOOTH),
    "vertex crease of 0.6": (lambda: new("halfcorner", CUBE, CUBE_FACES, corners={7: 0.6, 0: 0.4}), SEMI_SHARP),
    "sheet, All": (lambda: new("all", SHEET, SHEET_FACES), SMOOTH),
    "sheet, Keep corners": (lambda: new("keep", SHEET, SHEET_FACES, boundary="PRESERVE_CORNERS"), SMOOTH),
    "sheet, corner of two creases": (lambda: new("two", SHEET, SHEET_FACES, edges={(0, 1): 0.5, (0, 4): 0.7}), SEMI_SHARP),
    "triangles": (lambda: new("octahedron", *octahedron(1.4)), SMOOTH),
    "faces of seven": (lambda: new("prism", *prism(7)), SMOOTH),
    "torus": (lambda: new("torus", *torus(9, 6)), SMOOTH),
    "valence of eleven": (lambda: new("fan", *fan(11)), SMOOTH),
    "simple": (lambda: new("simple", CUBE, CUBE_FACES, simple=True, edges={e: 0.5 for e in TOP}), SMOOTH),
}


def surface_of(obj):
    return cages.surface_of(obj, bpy.context.evaluated_depsgraph_get())


def seen_points(obj):
    """Blender's own points, which it puts into the world itself."""
    seen = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([seen.matrix_world @ vertex.co for vertex in seen.data.vertices], float)


def farthest(obj):
    """Of Blender's points from snug's surface, by its size."""
    surface = surface_of(obj)
    far = surface.closest_point(seen_points(obj), absolute=1e-9 * surface.size)
    return float(np.max(far.lower)) / surface.size


def alone(*objects):
    for obj in bpy.context.scene.objects:
        obj.select_set(obj in objects)
    bpy.context.view_layer.objects.active = objects[-1] if objects else None


def start():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="snug_blender")


def answer():
    return bpy.context.scene.snug_answer


def marks():
    return sorted(obj.name for obj in bpy.context.scene.objects if "snug_mark" in obj)


def two_tori(apart):
    start()
    a, b = new("A", *torus(12, 8)), new("B", *torus(12, 8))
    b.location.z = apart
    bpy.context.view_layer.update()
    alone(a, b)
    return a, b


def test_meshes(report):
    start()
    for name, (make, limit) in MESHES.items():
        obj = make()
        obj.matrix_world = [[0.8, -0.6, 0, 1], [0.6, 0.8, 0, -2], [0, 0, 1, 0.5], [0, 0, 0, 1]]
        bpy.context.view_layer.update()
        modifier = obj.modifiers[0]
        report[name] = {"quality 10": farthest(obj)}
        assert report[name]["quality 10"] <= limit, f"{name}: {report[name]} of the size"
        modifier.quality = 3
        report[name]["quality 3"] = farthest(obj)
        modifier.use_limit_surface = False
        for modifier.levels in (1, 2, 3, 4):
            report[name][f"level {modifier.levels}"] = farthest(obj)


def test_transforms_are_exact():
    start()
    plain = new("plain", *torus(9, 6))
    other = new("other", *torus(9, 6))
    other.scale = (2, 0.5, -1)
    other.rotation_euler = (0.3, 0.2, 0.9)
    other.location = (3, 4, 5)
    bpy.context.view_layer.update()
    assert farthest(other) < 3 * SMOOTH
    there, here = (np.sort(np.abs(surface_of(obj).measure().volume)) for obj in (other, plain))  # both scaled by 1
    assert there[0] <= here[1] * 1.000001 and there[1] >= here[0] * 0.999999, (here, there)


def order(obj, old, new):
    alone(obj)
    bpy.ops.object.modifier_move_to_index(modifier=obj.modifiers[old].name, index=new)
    bpy.context.view_layer.update()


def test_modifiers_before():
    start()
    half = new("half", *fan(8))
    modifier = half.modifiers.new("Mirror", "MIRROR")
    modifier.use_axis = (False, False, True)
    order(half, 1, 0)
    bpy.context.view_layer.update()
    assert surface_of(half).is_closed and farthest(half) <= SMOOTH
    assert half.modifiers["Subdivision"].show_viewport
    order(half, 0, 1)
    try:
        surface_of(half)
        raise AssertionError("a modifier after it was let through")
    except cages.NoSurface as error:
        assert "Mirror comes after" in str(error)


def test_touch():
    two_tori(0.5)
    bpy.ops.snug.touch()
    assert answer() == "A and B intersect: proved" and marks() == ["snug contact A B"], (answer(), marks())
    two_tori(1.0)
    bpy.ops.snug.touch()
    assert answer() == "A and B do not touch: proved" and marks() == []


def test_intersecting_surfaces_are_no_distance_apart():
    for offset in (0.5, 0.7209, 0.7218):  # from 0.7219 on they are apart
        two_tori(offset)
        bpy.ops.snug.touch()
        touch = answer(), marks()
        bpy.ops.snug.distance()
        assert touch == (answer(), marks()), (offset, touch, answer(), marks())


def test_distance_and_undo():
    assert all("UNDO" in each.bl_options for each in operators.CLASSES)  # which pushes by itself where there is a window
    a, b = two_tori(1.0)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.snug.distance()
    gap = snug.distance(surface_of(a), surface_of(b))
    assert answer() == f"A and B: {words.interval(gap.lower, gap.upper)} apart"
    assert marks() == ["snug gap", "snug nearest on A", "snug nearest on B"]
    bpy.ops.ed.undo_push(message="asked")
    bpy.ops.ed.undo()
    assert answer() == "" and marks() == [], (answer(), marks())
    bpy.ops.ed.redo()
    assert marks() == ["snug gap", "snug nearest on A", "snug nearest on B"]
    bpy.ops.snug.distance()
    assert len(marks()) == 3  # not six


def test_self_contact():
    start()
    points, faces = grid(12, lambda x, y: 0)
    def loop(x, y):  # a strip that comes back through itself
        turn = 3 * math.pi * x
        return (math.cos(turn) + 0.6 * x, y, math.sin(2 * turn))
    alone(new("loop", [loop(x, y) for x, y, _ in points], faces))
    bpy.ops.snug.self_contact()
    crossed = answer()
    alone(new("torus", *torus(12, 8)))
    bpy.ops.snug.self_contact()
    assert answer() == "torus does not meet itself: proved", answer()
    assert crossed == "loop meets itself: proved", crossed


def test_deviation():
    start()
    surface, mesh = new("surface", *torus(12, 8)), new("mesh", *torus(24, 16))
    mesh.modifiers.clear()
    bpy.context.view_layer.update()
    alone(surface, mesh)
    bpy.ops.snug.deviation()
    assert answer().startswith("Largest distance of mesh from surface: between 0.1") and "Yellow" in answer(), answer()
    layer = mesh.data.color_attributes["snug deviation"]
    colours = np.empty(4 * len(mesh.data.vertices), np.float32)
    layer.data.foreach_get("color", colours)
    assert layer.domain == "POINT" and np.ptp(colours.reshape(-1, 4)[:, 0]) > 0.1
    bpy.ops.snug.deviation(top=0.001)
    mesh.data.color_attributes["snug deviation"].data.foreach_get("color", colours)
    assert np.allclose(colours.reshape(-1, 4)[:, :3].max(0), [0.85, 0.05, 0.08], atol=0.4)


def test_new_objects():
    start()
    torus_object = new("torus", *torus(12, 8))
    alone(torus_object)
    surface = surface_of(torus_object)
    bpy.ops.snug.triangles(error=0.2)
    made = bpy.data.objects["torus triangles"].data
    assert f"torus: {len(made.polygons)} triangles, proved within" in answer()
    far = surface.closest_point([v.co for v in made.vertices]).lower.max()
    assert far < 1e-6
    alone(torus_object)
    bpy.ops.snug.envelope(clearance=0.05, error=2)
    shell = bpy.data.objects["torus envelope"].data
    assert surface.closest_point([v.co for v in shell.vertices]).lower.min() >= 0.05 - 1e-6
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "part.step")
        alone(torus_object)
        bpy.ops.snug.step(filepath=path)
        text = open(path).read()
        assert text.startswith("ISO-10303-21;") and "'torus'" in text


def test_control_meshes_keep_their_tags():
    start()
    for name in ("triangles", "creases of 0.3 and 0.8", "vertex crease of 0.6", "sheet, corner of two creases"):
        obj = MESHES[name][0]()
        alone(obj)
        surface = surface_of(obj)
        for ending in (".obj", ".usda"):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "part" + ending)
                bpy.ops.snug.control_mesh(filepath=path)
                again = snug.read(path)
            assert (again.scheme, again.boundary) == (surface.scheme, surface.boundary), name
            assert np.array_equal(again.vertices, surface.vertices), name
            assert sorted(map(tuple, again.creases)) == sorted(map(tuple, surface.creases)), name
            assert sorted(map(tuple, again.corners)) == sorted(map(tuple, surface.corners)), name


def test_save_and_load():
    two_tori(1.0)
    bpy.context.scene.snug_live = True
    bpy.context.scene.snug_question = "touch"
    bpy.ops.snug.distance()
    said = answer()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_enable(module="snug_blender")
        bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    assert answer() == said and scene.snug_live and scene.snug_question == "touch" and len(marks()) == 3
    alone(bpy.data.objects["A"], bpy.data.objects["B"])
    bpy.ops.snug.distance()
    assert answer() == said and len(marks()) == 3


def test_live():
    a, b = two_tori(1.0)
    bpy.context.scene.snug_live = True
    bpy.context.view_layer.update()
    b.location.z = 0.9
    bpy.context.view_layer.update()
    assert bpy.app.timers.is_registered(live.ask)  # and will ask once nothing has moved for a while
    bpy.app.timers.unregister(live.ask)
    live.ask()
    first = answer()
    b.location.z = 0.5
    bpy.context.view_layer.update()
    live.ask()
    assert first != answer() and marks() == ["snug contact A B"]
    bpy.context.scene.snug_live = False
    b.location.z = 0.6
    if bpy.app.timers.is_registered(live.ask):
        bpy.app.timers.unregister(live.ask)
    bpy.context.view_layer.update()
    assert not bpy.app.timers.is_registered(live.ask)


def test_refusals():
    start()
    plain = new("plain", CUBE, CUBE_FACES)
    alone(plain)
    for ask in (bpy.ops.snug.touch, bpy.ops.snug.distance, bpy.ops.snug.deviation):
        try:
            ask()
            raise AssertionError("one object was enough")
        except RuntimeError as error:
            assert "select" in str(error), error
            assert "select" in answer()  # no older answer stays
    plain.modifiers.clear()
    assert not bpy.ops.snug.touch.poll()
    empty = new("empty", [(0, 0, 0)], [])
    alone(empty)
    try:
        bpy.ops.snug.self_contact()
        raise AssertionError("a mesh without faces was taken")
    except RuntimeError as error:
        assert "no faces" in str(error), error


def test_answers_are_shown_whole():
    answer = "Cube and Cube.001 do not touch: proved\nnearest at the mark"
    for width in (100, 205, 400):
        lines = panel.lines_of(answer, width)
        assert " ".join(lines) == answer.replace("\n", " ") and all(len(line) <= max(16, (width - 60) / 6.5) for line in lines)


def test_words_round_outwards():
    assert words.interval(0.1234564, 0.1234566) == "between 0.123456 and 0.123457"
    assert words.interval(0.12345678, 1234567.1) == "between 0.123456 and 1234570"


def main():
    report, failed = {}, []
    for name, test in sorted(globals().items()):
        if not name.startswith("test_"):
            continue
        try:
            test(report) if name == "test_meshes" else test()
        except Exception:
            traceback.print_exc()
            failed.append(name)
    rest = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    if rest:
        with open(rest[0], "w", encoding="utf-8") as file:
            json.dump(report, file, indent=1)
    print(f"blender {bpy.app.version_string}: {len(failed)} failed: {', '.join(failed)}" if failed else f"blender {bpy.app.version_string}: all passed, {len(report)} meshes")
    sys.stdout.flush()
    os._exit(1 if failed else 0)


main()
