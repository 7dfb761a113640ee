# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks again once a selected object was moved and let go: when nothing has moved for a quarter of a second."""

import bpy
from bpy.app.handlers import persistent

from . import cages

CLASSES = ()
WAIT = 0.25  # seconds
_asking = False


@persistent
def _moved(scene, depsgraph):
    if _asking or not getattr(scene, "snug_live", False):
        return
    moved = {update.id.original for update in depsgraph.updates if update.is_updated_transform or update.is_updated_geometry}
    if any(obj in moved and cages.has_surface(obj) for obj in scene.objects if obj.select_get()):
        if bpy.app.timers.is_registered(ask):
            bpy.app.timers.unregister(ask)
        bpy.app.timers.register(ask, first_interval=WAIT)


def ask():
    """Asks the scene's question about what is selected."""
    global _asking
    operator = getattr(bpy.ops.snug, bpy.context.scene.snug_question)
    _asking = True  # the marks it makes are updates, too
    try:
        if operator.poll():
            operator()
    except RuntimeError as error:  # what an operator reports as an error
        bpy.context.scene.snug_answer = str(error).removeprefix("Error: ").strip()
    finally:
        _asking = False


def listen():
    bpy.app.handlers.depsgraph_update_post.append(_moved)


def stop():
    if bpy.app.timers.is_registered(ask):
        bpy.app.timers.unregister(ask)
    bpy.app.handlers.depsgraph_update_post.remove(_moved)
