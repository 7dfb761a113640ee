# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's tab, and what scenes remember: the last answer, and whether drags ask."""

import textwrap

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty


def lines_of(answer, width):
    """The answer in lines that a panel of so many pixels shows whole: Blender leaves out the middle of longer ones, which may be a `not`."""
    return [part for line in answer.split("\n")[:12] for part in textwrap.wrap(line, max(16, int((width - 60) / 6.5)))]


class SNUG_PT_panel(bpy.types.Panel):
    bl_label = "snug"
    bl_idname = "SNUG_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "snug"

    def draw(self, context):
        layout, scene = self.layout, context.scene
        ask = layout.column(align=True)
        ask.operator("snug.touch", icon="MOD_PHYSICS")
        ask.operator("snug.distance", icon="DRIVER_DISTANCE")
        ask.operator("snug.self_contact", icon="MOD_BOOLEAN")
        layout.prop(scene, "snug_live")
        if scene.snug_live:
            layout.prop(scene, "snug_question", text="")
        make = layout.column(align=True)
        make.operator("snug.triangles", icon="MOD_TRIANGULATE")
        make.operator("snug.envelope", icon="MESH_ICOSPHERE")
        make.operator("snug.deviation", icon="COLOR")
        make.operator("snug.step", icon="EXPORT")
        make.operator("snug.control_mesh", icon="MESH_GRID")
        if scene.snug_answer:
            box = layout.box().column(align=True)
            for line in lines_of(scene.snug_answer, context.region.width / context.preferences.system.ui_scale):
                box.label(text=line)


CLASSES = (SNUG_PT_panel,)


def add_properties():
    bpy.types.Scene.snug_answer = StringProperty(name="Answer")
    bpy.types.Scene.snug_live = BoolProperty(name="Ask after each move", description="Asks again when a selected object was moved and let go")
    bpy.types.Scene.snug_question = EnumProperty(
        name="Question",
        items=[("touch", "Do they touch?", ""), ("distance", "How far apart?", ""), ("self_contact", "Does it meet itself?", "")],
        default="distance",
    )


def remove_properties():
    del bpy.types.Scene.snug_answer, bpy.types.Scene.snug_live, bpy.types.Scene.snug_question
