# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks snug about the limit surfaces of objects with Subdivision modifiers."""

bl_info = {  # before Blender 4.2, which reads blender_manifest.toml
    "name": "snug: proved contact of subdivision surfaces",
    "description": "Do subdivision surfaces touch, and how far apart are they",
    "author": "snug developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > snug",
    "category": "Mesh",
}

import bpy

from . import engine


def _modules():
    engine.find()
    from . import live, operators, panel

    return operators, panel, live


def register():
    modules = _modules()
    for module in modules:
        for each in module.CLASSES:
            bpy.utils.register_class(each)
    modules[1].add_properties()
    modules[2].listen()


def unregister():
    modules = _modules()
    modules[2].stop()
    modules[1].remove_properties()
    for module in reversed(modules):
        for each in reversed(module.CLASSES):
            bpy.utils.unregister_class(each)
