# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel asks. Each operator leaves its sentences in the scene's property snug_answer, and can be undone."""

import itertools

import bpy
import numpy as np
import snug
from bpy.props import FloatProperty, StringProperty

from . import cages, marks, words


def selected_surfaces(context):
    """[(object, surface)] of the selected objects that have one, by name."""
    chosen = sorted((obj for obj in context.selected_objects if cages.has_surface(obj)), key=lambda obj: obj.name)
    depsgraph = context.evaluated_depsgraph_get()
    return [(obj, cages.surface_of(obj, depsgraph)) for obj in chosen]


def needs(parts, count, what):
    if len(parts) < count:
        raise cages.NoSurface(f"select {what} with a Subdivision modifier as the last one that is on")


def active_surface(context):
    """(object, surface) of the active object, or else of the first that is selected."""
    parts = selected_surfaces(context)
    needs(parts, 1, "an object")
    return next((part for part in parts if part[0] == context.object), parts[0])


class Asking:
    """Turns what is raised into a report, and puts the answer where the panel shows it."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return any(cages.has_surface(obj) for obj in context.selected_objects)

    def execute(self, context):
        try:
            lines = self.ask(context)
        except (cages.NoSurface, ArithmeticError, OSError, ValueError) as error:
            context.scene.snug_answer = str(error)  # instead of an answer about other objects
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene.snug_answer = "\n".join(lines)
        self.report({"INFO"}, "; ".join(lines))
        return {"FINISHED"}


class SNUG_OT_touch(Asking, bpy.types.Operator):
    """Do the limit surfaces of the selected objects touch? Proved either way, or undecided"""

    bl_idname = "snug.touch"
    bl_label = "Do they touch?"

    def ask(self, context):
        parts = selected_surfaces(context)
        needs(parts, 2, "two objects")
        marks.clear(context.scene)
        lines, seen = [], 0
        for (a, one), (b, other) in itertools.combinations(parts, 2):
            hit = snug.collide(one, other, prove_contact=True)
            lines.append(words.pair(a.name, b.name, hit))
            if hit.verdict == "intersecting":
                seen += 1
                size = 0.02 * min(one.size, other.size)
                marks.points(context.scene, {f"contact {a.name} {b.name}": hit.witness[0]}, size)
        if len(parts) > 2:
            lines.insert(0, f"{seen} of {len(lines)} pairs intersect")
        return lines


class SNUG_OT_distance(Asking, bpy.types.Operator):
    """How far apart are the limit surfaces of the selected objects? The nearest pair is marked"""

    bl_idname = "snug.distance"
    bl_label = "How far apart?"

    def ask(self, context):
        parts = selected_surfaces(context)
        needs(parts, 2, "two objects")
        marks.clear(context.scene)
        lines, nearest = [], None
        for (a, one), (b, other) in itertools.combinations(parts, 2):
            gap = snug.distance(one, other)
            lines.append(words.apart(a.name, b.name, gap))
            if nearest is None or gap.upper < nearest[0].upper:
                nearest = gap, a, b, 0.02 * min(one.size, other.size)
        gap, a, b, size = nearest
        on_a, on_b = gap.witness
        if gap.upper == 0:
            marks.points(context.scene, {f"contact {a.name} {b.name}": on_a}, size)
            return lines
        marks.points(context.scene, {f"nearest on {a.name}": on_a, f"nearest on {b.name}": on_b}, size)
        marks.line(context.scene, on_a, on_b)
        return lines


class SNUG_OT_self_contact(Asking, bpy.types.Operator):
    """Does the limit surface of the active object meet itself?"""

    bl_idname = "snug.self_contact"
    bl_label = "Does it meet itself?"

    def ask(self, context):
        obj, surface = active_surface(context)
        marks.clear(context.scene)
        found = surface.self_contact()
        meets = [pair for pair in found.pairs if pair.verdict == "intersecting"]
        for i, pair in enumerate(meets[:20]):
            marks.points(context.scene, {f"meets itself {i + 1}": pair.witness[0]}, 0.02 * surface.size)
        says = {"clear": "does not meet itself: proved", "intersecting": "meets itself: proved"}
        return [f"{obj.name} {says.get(found.verdict, 'may meet itself: undecided')}"]


class SNUG_OT_deviation(Asking, bpy.types.Operator):
    """Colours the active mesh by its vertices' distances from the limit surface of the other selected object"""

    bl_idname = "snug.deviation"
    bl_label = "Deviation of a mesh"
    top: FloatProperty(name="Yellow at", description="Vertices farther than this are red; 0: the largest distance", min=0, unit="LENGTH")

    def ask(self, context):
        candidate = context.object
        parts = [part for part in selected_surfaces(context) if part[0] != candidate]
        needs(parts, 1, "an object")
        if len(parts) > 1 or candidate is None:
            raise cages.NoSurface("select one surface, and then the mesh to compare, so that it is the active one")
        obj, surface = parts[0]
        mesh = cages.triangles_of(candidate)
        found = snug.deviation(surface, mesh)
        far = np.atleast_1d(surface.closest_point(mesh.vertices).upper)
        top = self.top if self.top > 0 else float(far.max())
        marks.colours(candidate.data, "snug deviation", far, top)
        there, back = found.from_surface, found.from_candidate
        return [
            f"Largest distance of {candidate.name} from {obj.name}: {words.interval(back.lower, back.upper)}",
            f"Largest distance of {obj.name} from {candidate.name}: {words.interval(there.lower, there.upper)}",
            f"Yellow is {words.at_most(top)}, red is more",
        ]


class SNUG_OT_triangles(Asking, bpy.types.Operator):
    """Triangles within an error of the limit surface, as a new object"""

    bl_idname = "snug.triangles"
    bl_label = "Adaptive triangles"
    error: FloatProperty(name="Error", description="Percent of the object's size", default=0.1, min=0.0001, soft_max=5, precision=4)

    def ask(self, context):
        parts = selected_surfaces(context)
        needs(parts, 1, "an object")
        lines = []
        for obj, surface in parts:
            made = surface.tessellate(f"{self.error!r}%", normals=False)
            marks.mesh_object(context.scene, f"{obj.name} triangles", made.positions, made.triangles)
            lines.append(f"{obj.name}: {len(made.triangles)} triangles, proved within {words.at_most(made.error_bound)}")
        return lines


class SNUG_OT_envelope(Asking, bpy.types.Operator):
    """A watertight mesh around the limit surface, at least a clearance away from it, as a new object"""

    bl_idname = "snug.envelope"
    bl_label = "Envelope"
    clearance: FloatProperty(name="Clearance", description="Least distance from the surface", default=0, min=0, unit="LENGTH")
    error: FloatProperty(
        name="Error", description="How much farther away than the clearance, in percent of the object's size", default=2, min=0.01, soft_max=10, precision=3
    )

    def ask(self, context):
        parts = selected_surfaces(context)
        needs(parts, 1, "an object")
        lines = []
        for obj, surface in parts:
            made = surface.envelope(self.clearance + self.error / 100 * surface.size, clearance=self.clearance or None)
            if made.outcome != "complete":
                raise cages.NoSurface(f"{obj.name}: no envelope within this error was proved; try a larger one")
            marks.mesh_object(context.scene, f"{obj.name} envelope", made.vertices, made.faces)
            lines.append(f"{obj.name}: {len(made.faces)} triangles, at least {words.at_least(self.clearance)} away: proved")
        return lines


class Exporting(Asking):
    """Asks for a file, named after the active object, before the answer is made."""

    filepath: StringProperty(subtype="FILE_PATH")

    def invoke(self, context, event):
        self.filepath = (context.object.name if context.object else "surface") + self.ending
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class SNUG_OT_step(Exporting, bpy.types.Operator):
    """Writes the limit surface of the active object as B-spline faces"""

    bl_idname = "snug.step"
    bl_label = "Export STEP"
    ending = ".step"
    filter_glob: StringProperty(default="*.step;*.stp", options={"HIDDEN"})
    error: FloatProperty(name="Error", description="Percent of the object's size", default=0.1, min=0.0001, soft_max=5, precision=4)

    def ask(self, context):
        obj, surface = active_surface(context)
        # Blender's unit is a metre unless the scene has another scale, a STEP file's is one of a few.
        scale = context.scene.unit_settings.scale_length
        units = {1.0: "m", 0.01: "cm", 0.001: "mm"}.get(round(scale, 6))
        if units is None:
            raise cages.NoSurface(f"the scene's unit scale is {scale:g}; set it to 1, 0.01 or 0.001 to export")
        path = bpy.path.abspath(self.filepath)
        surface.write_step(path, f"{self.error!r}%", units=units, name=obj.name)
        return [f"{obj.name}: {path}"]


class SNUG_OT_control_mesh(Exporting, bpy.types.Operator):
    """Writes the control mesh of the active object with its creases, corners and boundary rule, for snug elsewhere"""

    bl_idname = "snug.control_mesh"
    bl_label = "Export control mesh"
    ending = ".obj"
    filter_glob: StringProperty(default="*.obj;*.usda", options={"HIDDEN"})

    def ask(self, context):
        obj, surface = active_surface(context)
        path = bpy.path.abspath(self.filepath)
        surface.write(path)
        return [f"{obj.name}: {path}"]


CLASSES = (
    SNUG_OT_touch,
    SNUG_OT_distance,
    SNUG_OT_self_contact,
    SNUG_OT_deviation,
    SNUG_OT_triangles,
    SNUG_OT_envelope,
    SNUG_OT_step,
    SNUG_OT_control_mesh,
)
