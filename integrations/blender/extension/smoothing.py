"""The operator that smooths a mesh to a tolerance."""

from __future__ import annotations

import warnings
from typing import Any

import bpy
import limitmesh
import numpy as np

from .control import Control, Floats, control_of, is_ready, scale_of, subdivision_of
from .luggage import Luggage
from .waiting import progress
from .words import counted, length
from .written import PLACES, places_of, write

_SIZE = 0.001
"""The tolerance of who names none, as a part of the diagonal of the bounding box: limitmesh's own."""


class SmoothToTolerance(bpy.types.Operator):
    """Divide the faces where the smooth surface bends, until the mesh is within a distance of it"""

    bl_idname = "object.limitmesh_smooth"
    bl_label = "Smooth to Tolerance"
    bl_options = {"REGISTER", "UNDO"}

    tolerance: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Tolerance",
        description="Greatest distance from the smooth surface; 0 for a thousandth of the size",
        min=0.0, soft_min=1e-5, soft_max=1.0, precision=5, subtype="DISTANCE", unit="LENGTH", options={"SKIP_SAVE"},
    )
    scheme: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Surface",
        items=(
            ("AUTO", "By Faces", "Catmull–Clark where most faces are quads, else Loop"),
            ("CATMULL_CLARK", "Catmull–Clark", "The surface of the Subdivision Surface modifier"),
            ("LOOP", "Loop", "The surface for triangles"),
        ),
    )
    most: bpy.props.IntProperty(  # type: ignore[valid-type]
        name="Most Triangles",
        description="Stop at so many triangles, with the best mesh that has no more",
        default=1_000_000, min=100, soft_max=10_000_000,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not is_ready(cls, context):
            return False
        if not context.active_object.data.is_editable:
            cls.poll_message_set("The mesh is linked from another file")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        an_object = context.active_object
        try:
            self.report(*smooth(self, context, an_object))
        except limitmesh.Error as why:
            self.report({"ERROR"}, f"{an_object.name}: {why}")
            return {"CANCELLED"}
        return {"FINISHED"}


def smooth(options: SmoothToTolerance, context: bpy.types.Context, an_object: bpy.types.Object) -> tuple[set[str], str]:
    """Replaces an object's mesh; gives what to report."""
    scale = scale_of(an_object)
    check(an_object, scale)
    modifier = subdivision_of(an_object)
    control = control_of(an_object.data, scale, modifier)
    options.tolerance = options.tolerance or _SIZE * control.diagonal
    luggage = Luggage(an_object, modifier)
    with progress(context) as told:
        channels = {**luggage.channels(an_object.data), PLACES: places_of(control)}
        refined = refine(control, options.tolerance, options.most, options.scheme, channels=channels, progress=told)
    users = an_object.data.users
    moved = write(an_object, control, refined, luggage, scale)
    within = np.nextafter(refined.error.upper + moved, np.inf)
    warned = _warnings(control, refined, luggage)
    if users > 1:
        warned.append(f"{users} objects share the mesh, and all changed")
    proven = "proven" if refined.error.certified else "estimated"
    faces = counted(len(an_object.data.polygons), "face", "faces")
    text = f"Within {length(context, within)} of the limit surface, {proven}; {faces}"
    is_met = within <= options.tolerance
    if not is_met:
        why = {"triangle-cap": f"it takes more than {options.most:,} triangles", "memory-cap": "memory ends before"}
        text = f"{length(context, options.tolerance)} not reached, since {why.get(refined.stop, 'single precision ends before')}. {text}"
    return {"WARNING"} if warned or not is_met else {"INFO"}, "; ".join([text, *warned, *_switch_off(an_object)])


def check(an_object: bpy.types.Object, scale: Floats) -> None:
    """Refuses objects that have no smooth surface, or another holder of it."""
    if not an_object.data.polygons:
        raise limitmesh.MeshError("the mesh has no faces")
    sizes = np.linalg.svd(scale, compute_uv=False)
    if not sizes[-1] > 1e-9 * sizes[0]:
        raise limitmesh.MeshError("the object has a scale of 0")
    if any(modifier.type == "MULTIRES" for modifier in an_object.modifiers):
        raise limitmesh.MeshError("a Multiresolution modifier holds details of this mesh: apply it, or remove it")


def refine(control: Control, tolerance: float, most: int, scheme: str, **options: Any) -> limitmesh.Refined:
    """Refines to a tolerance that holds after rounding to 32 bits, with quads where the scheme has some."""
    rounding = np.sqrt(3.0) * np.abs(control.vertices).max() * 2.0**-23
    is_of_quads = 2 * (control.sides == 4).sum() > len(control.sides) if scheme == "AUTO" else scheme == "CATMULL_CLARK"
    with warnings.catch_warnings():
        # The caller reports what falls short.
        warnings.simplefilter("ignore", limitmesh.StoppedShort)
        return limitmesh.refine(
            control.vertices,
            control.faces,
            tolerance=tolerance - rounding if rounding < 0.5 * tolerance else tolerance,
            max_triangles=most,
            scheme="catmull-clark" if is_of_quads else "loop",
            quads=is_of_quads,
            origins=False,
            **control.options,
            **options,
        )


def _warnings(control: Control, refined: limitmesh.Refined, luggage: Luggage) -> list[str]:
    """What a user should know of the mesh."""
    # Loose vertices come back, and faces keep their sides.
    warned = [line for line in refined.diagnosis.repairs if not any(words in line for words in ("in no face", "turned round"))]
    loose = [
        counted(len(rows), *words)
        for rows, words in (
            (control.loose_vertices, ("vertex", "vertices")),
            (control.loose_edges, ("edge", "edges")),
        )
        if len(rows)
    ]
    if loose:
        warned.append(f"{' and '.join(loose)} in no face kept as they are")
    if luggage.keys:
        warned.append(f"shape keys carried, but the distance is that of {luggage.keys[0][0]}")
    if luggage.left:
        warned.append(f"not carried: {', '.join(luggage.left)}")
    return warned


def _switch_off(an_object: bpy.types.Object) -> list[str]:
    """The result is what the Subdivision Surface modifier would have made."""
    found = [modifier for modifier in an_object.modifiers if modifier.type == "SUBSURF"]
    for modifier in found:
        modifier.show_viewport = modifier.show_render = False
    return [f"modifier {modifier.name} switched off" for modifier in found]


def register() -> None:
    bpy.utils.register_class(SmoothToTolerance)


def unregister() -> None:
    bpy.utils.unregister_class(SmoothToTolerance)
