# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes of objects, with what Blender's Subdivision modifier makes of their tags; see docs/blender.md."""

import contextlib
from types import SimpleNamespace

import numpy as np
import snug


class NoSurface(Exception):
    """Why an object has no limit surface that can be asked about; a sentence for the user."""


def modifier_of(obj):
    """The Subdivision modifier that gives the limit surface, which no enabled one follows. Raises NoSurface."""
    if obj.type != "MESH":
        raise NoSurface(f"{obj.name} is not a mesh")
    enabled = [modifier for modifier in obj.modifiers if modifier.show_viewport]
    if not enabled or not any(modifier.type == "SUBSURF" for modifier in enabled):
        raise NoSurface(f"{obj.name} has no Subdivision modifier")
    if enabled[-1].type != "SUBSURF":
        raise NoSurface(f"{obj.name}: {enabled[-1].name} comes after the Subdivision modifier; turn it off or move it up")
    if sum(modifier.type == "SUBSURF" for modifier in enabled) > 1:
        raise NoSurface(f"{obj.name} has two Subdivision modifiers; turn one off")
    return enabled[-1]


def has_surface(obj):
    try:
        return bool(modifier_of(obj))
    except NoSurface:
        return False


def surface_of(obj, depsgraph):
    """The limit surface of an object, in the world's coordinates. Raises NoSurface, snug.MeshError."""
    modifier = modifier_of(obj)
    with _control_mesh(obj, modifier, depsgraph) as mesh:
        vertices = _points(mesh, obj)
        faces = _faces(mesh)
        if not faces:
            raise NoSurface(f"{obj.name} has no faces")
        if modifier.subdivision_type == "SIMPLE":  # faces stay where they are
            return snug.Surface(vertices, faces, scheme="bilinear")
        creases, corners = _tags(mesh, faces) if modifier.use_creases else ([], [])
        boundary = "edge-only" if modifier.boundary_smooth == "ALL" else "edge-and-corner"
        return snug.Surface(vertices, faces, scheme="catmark", creases=creases or None, corners=corners or None, boundary=boundary)


def triangles_of(obj):
    """The triangles of a mesh as it is, in the world's coordinates: .vertices and .faces."""
    if obj.type != "MESH" or any(modifier.show_viewport for modifier in obj.modifiers):
        raise NoSurface(f"{obj.name}: select a mesh without modifiers to compare; apply those it has")
    obj.update_from_editmode()
    obj.data.calc_loop_triangles()
    corners = np.empty(3 * len(obj.data.loop_triangles), np.int32)
    obj.data.loop_triangles.foreach_get("vertices", corners)
    if len(corners) == 0:
        raise NoSurface(f"{obj.name} has no faces")
    return SimpleNamespace(vertices=_points(obj.data, obj), faces=corners.reshape(-1, 3).astype(np.uint32))


@contextlib.contextmanager
def _control_mesh(obj, modifier, depsgraph):
    """What the Subdivision modifier is given: the object's mesh, or what modifiers before it make of that."""
    obj.update_from_editmode()
    if not any(other.show_viewport for other in obj.modifiers if other != modifier):
        yield obj.data
        return
    modifier.show_viewport = False
    try:
        depsgraph.update()
        yield obj.evaluated_get(depsgraph).data
    finally:
        modifier.show_viewport = True


def _points(mesh, obj):
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    matrix = np.array(obj.matrix_world, float)
    return points.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


def _faces(mesh):
    corners = np.empty(len(mesh.loops), np.int32)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.polygons.foreach_get("loop_start", starts)
    return [part.tolist() for part in np.split(corners, starts[1:])] if len(starts) else []


def sharpness(crease):
    """OpenSubdiv's sharpness of a crease from 0 to 1: 10 is infinite."""
    return 10 * crease * crease


def _tags(mesh, faces):
    """(vertex, vertex, sharpness) of edges and (vertex, sharpness) of vertices that are not smooth."""
    crease = _crease_of_edges(mesh)
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    ends = ends.reshape(-1, 2)
    used = {(min(a, b), max(a, b)) for face in faces for a, b in zip(face, face[1:] + face[:1])}
    at = [[] for _ in mesh.vertices]
    creases = []
    for (a, b), value in zip(ends.tolist(), sharpness(crease).tolist()):
        if (min(a, b), max(a, b)) not in used:
            continue
        at[a].append(value)
        at[b].append(value)
        if value > 0:
            creases.append((a, b, value))
    corners = []
    for vertex, own in enumerate(sharpness(_crease_of_vertices(mesh)).tolist()):
        # A vertex of two edges is as sharp as the smoother one of them, besides its own crease.
        value = min(10.0, own + (min(at[vertex]) if len(at[vertex]) == 2 else 0.0))
        if value > 0 and at[vertex]:
            corners.append((vertex, value))
    return creases, corners


def _crease_of_edges(mesh):
    values = np.zeros(len(mesh.edges), np.float32)
    if "crease_edge" in mesh.attributes:  # Blender 4
        mesh.attributes["crease_edge"].data.foreach_get("value", values)
    elif hasattr(mesh.edges[0] if len(mesh.edges) else None, "crease"):
        mesh.edges.foreach_get("crease", values)
    return values.astype(float)


def _crease_of_vertices(mesh):
    values = np.zeros(len(mesh.vertices), np.float32)
    if "crease_vert" in mesh.attributes:  # Blender 4
        mesh.attributes["crease_vert"].data.foreach_get("value", values)
    elif getattr(mesh, "vertex_creases", None):
        mesh.vertex_creases[0].data.foreach_get("value", values)
    return values.astype(float)
