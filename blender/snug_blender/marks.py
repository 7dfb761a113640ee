# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that show answers: witnesses in a collection of their own, meshes as new objects."""

import bpy
import numpy as np

COLLECTION = "snug"
MARK = "snug_mark"  # a custom property of what a next answer replaces


def _collection(scene):
    collection = bpy.data.collections.get(COLLECTION) or bpy.data.collections.new(COLLECTION)
    if collection.name not in scene.collection.children:
        scene.collection.children.link(collection)
    return collection


def clear(scene):
    """Removes the witnesses of the answer before."""
    for obj in [obj for obj in scene.objects if MARK in obj]:
        mesh = obj.data
        bpy.data.objects.remove(obj)
        if mesh is not None and mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def points(scene, named, size):
    """An empty at each place: {name: (x, y, z)}."""
    for name, place in named.items():
        mark = bpy.data.objects.new(f"snug {name}", None)
        mark.empty_display_type = "SPHERE"
        mark.empty_display_size = size
        mark.show_in_front = mark.show_name = True
        mark.location = [float(x) for x in place]
        mark[MARK] = True
        _collection(scene).objects.link(mark)


def line(scene, a, b):
    mesh = bpy.data.meshes.new("snug gap")
    mesh.from_pydata([tuple(map(float, a)), tuple(map(float, b))], [(0, 1)], [])
    gap = bpy.data.objects.new("snug gap", mesh)
    gap.show_in_front = True
    gap[MARK] = True
    _collection(scene).objects.link(gap)


def mesh_object(scene, name, vertices, faces):
    """A new object of triangles or polygons, in the world's coordinates."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices, float).tolist(), [], [list(map(int, face)) for face in faces])
    mesh.update()
    made = bpy.data.objects.new(name, mesh)
    _collection(scene).objects.link(made)
    return made


def colours(mesh, name, values, top):
    """A colour of each vertex: dark blue at 0, yellow at `top`, red beyond it. Darkness alone tells the order."""
    stops = np.array([[0.03, 0.07, 0.30], [0.10, 0.35, 0.45], [0.35, 0.62, 0.38], [0.98, 0.88, 0.25]])
    at = np.clip(values / top if top > 0 else np.zeros_like(values), 0, 1) * 3
    low = np.minimum(at.astype(int), 2)
    part = (at - low)[:, None]
    rgb = (1 - part) * stops[low] + part * stops[low + 1]
    rgb[values > top] = [0.85, 0.05, 0.08]
    if name in mesh.color_attributes:
        mesh.color_attributes.remove(mesh.color_attributes[name])
    layer = mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", np.hstack([rgb, np.ones((len(rgb), 1))]).astype(np.float32).ravel())
    mesh.color_attributes.active_color = layer
