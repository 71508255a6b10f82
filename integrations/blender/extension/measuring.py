"""The operator that measures how far a Subdivision Surface modifier is from its limit surface."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import limitmesh
import numpy as np

from .control import Control, Floats, Integers, control_of, is_ready, read, scale_of, subdivision_of
from .smoothing import check, refine
from .waiting import progress
from .words import counted, length

_MOST = 1_000_000
"""Triangles beyond which a proof would take minutes."""


class MeasureSubdivision(bpy.types.Operator):
    """Measure how far the Subdivision Surface modifier's viewport level is from the smooth surface"""

    bl_idname = "object.limitmesh_measure"
    bl_label = "Measure Subdivision Level"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not is_ready(cls, context):
            return False
        if subdivision_of(context.active_object) is None:
            cls.poll_message_set("Needs a Subdivision Surface modifier, switched on in the viewport")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        an_object = context.active_object
        try:
            self.report({"INFO"}, measured(context, an_object))
        except limitmesh.Error as why:
            self.report({"ERROR"}, f"{an_object.name}: {why}")
            return {"CANCELLED"}
        return {"FINISHED"}


def measured(context: bpy.types.Context, an_object: bpy.types.Object) -> str:
    """The distance between the mesh that the modifier makes and the limit surface of what it is given, in words."""
    modifier = subdivision_of(an_object)
    if modifier.subdivision_type != "CATMULL_CLARK":
        raise limitmesh.MeshError(f"modifier {modifier.name} is set to Simple, which has no smooth surface")
    scale = scale_of(an_object)
    check(an_object, scale)
    with _without_what_follows(an_object, modifier):
        vertices, triangles, faces = _subdivided(context, an_object)
        modifier.show_viewport = False
        control = _control(context, an_object, scale, modifier)
    with progress(context) as told:
        distance = limitmesh.measure(
            (vertices @ scale.T, triangles),
            limit_of=(control.vertices, control.faces),
            certified=True, scheme="catmull-clark", progress=told, **control.options,
        )
        needed = refine(control, distance.upper, _MOST, "CATMULL_CLARK", progress=told)
    how = ", on the limit surface" if modifier.use_limit_surface else ""
    return (
        f"Level {modifier.levels} ({counted(faces, 'face', 'faces')}{how}) is within {length(context, distance.upper)} of the limit surface, "
        f"proven, or {100.0 * distance.upper / control.diagonal:.2g} % of the size; "
        f"for this tolerance limitmesh needs {counted(len(needed.faces) - len(needed.quads), 'face', 'faces')}"
    )


@contextmanager
def _without_what_follows(an_object: bpy.types.Object, modifier: bpy.types.Modifier) -> Iterator[None]:
    """The object with its modifiers up to one; as it was afterwards."""
    modifiers = list(an_object.modifiers)
    last = modifiers[modifiers.index(modifier):]
    shown = [one.show_viewport for one in last]
    try:
        for one in last[1:]:
            one.show_viewport = False
        yield
    finally:
        for one, was in zip(last, shown):
            one.show_viewport = was


def _subdivided(context: bpy.types.Context, an_object: bpy.types.Object) -> tuple[Floats, Integers, int]:
    """Vertices and triangles of what the modifiers make, as Blender draws them, and its number of faces."""
    evaluated = an_object.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        if len(mesh.loops) > 2 * _MOST:
            raise limitmesh.MeshError(f"the modifier makes {len(mesh.polygons):,} faces: lower its viewport level")
        mesh.calc_loop_triangles()
        triangles = read(mesh.loop_triangles, "vertices", 3, np.int32).astype(np.int64)
        return read(mesh.vertices, "co", 3).astype(np.float64), triangles, len(mesh.polygons)
    finally:
        evaluated.to_mesh_clear()


def _control(context: bpy.types.Context, an_object: bpy.types.Object, scale: Floats, modifier: Any) -> Control:
    """What the modifier is given."""
    evaluated = an_object.evaluated_get(context.evaluated_depsgraph_get())
    try:
        return control_of(evaluated.to_mesh(), scale, modifier)
    finally:
        evaluated.to_mesh_clear()


def register() -> None:
    bpy.utils.register_class(MeasureSubdivision)


def unregister() -> None:
    bpy.utils.unregister_class(MeasureSubdivision)
