"""A mesh of Blender as limitmesh takes it: positions, faces, creases, and the rules of its Subdivision Surface modifier."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

_BOUNDARIES = {"ALL": "smooth", "PRESERVE_CORNERS": "corners"}


@dataclass(frozen=True)
class Control:
    """A control mesh.

    `vertices` are in the scene's unit: they have the object's scale, so that distances are those that a user sees. `corner_vertices` and
    `corner_edges` are rows of the mesh's vertices and edges by corner of the faces, which begin at `starts`. `loose_edges` and
    `loose_vertices` are rows of those in no face.
    """

    vertices: Floats
    corner_vertices: Integers
    corner_edges: Integers
    starts: Integers
    options: dict[str, Any]
    loose_edges: Integers
    loose_vertices: Integers

    @property
    def faces(self) -> list[Integers]:
        return np.split(self.corner_vertices, self.starts[1:]) if len(self.starts) else []

    @property
    def sides(self) -> Integers:
        """How many each face has."""
        return np.diff(self.starts, append=len(self.corner_vertices))

    @property
    def diagonal(self) -> float:
        """Of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))


def read(items: Any, name: str, width: int = 1, dtype: npt.DTypeLike = np.float32) -> npt.NDArray[Any]:
    """An attribute of all items of a collection: (n,), or (n, width) where it is wider than 1."""
    flat = np.empty(len(items) * width, dtype)
    items.foreach_get(name, flat)
    return flat if width == 1 else flat.reshape(-1, width)


def control_of(mesh: bpy.types.Mesh, scale: Floats, modifier: bpy.types.Modifier | None) -> Control:
    """The control mesh that Blender's modifier would subdivide; `scale` is the linear part of the object's transform."""
    corners = read(mesh.loops, "vertex_index", dtype=np.int32).astype(np.int64)
    edges = read(mesh.edges, "vertices", 2, np.int32).astype(np.int64)
    is_loose = read(mesh.edges, "is_loose", dtype=bool)
    creases, sharp = _tags(mesh, edges, is_loose, corners) if modifier is None or modifier.use_creases else ([], {})
    # As in Blender, faces keep hold of the edges that hang on them.
    for vertex in np.intersect1d(edges[is_loose], corners):
        sharp[int(vertex)] = np.inf
    options = {
        "creases": creases,
        "corners": sorted(sharp.items()),
        "boundary": "smooth" if modifier is None else _BOUNDARIES[modifier.boundary_smooth],
        "concave_corners": "as-tagged",
        # Vertices at one place are not connected unless they are one.
        "weld": None,
    }
    return Control(
        read(mesh.vertices, "co", 3).astype(np.float64) @ scale.T,
        corners,
        read(mesh.loops, "edge_index", dtype=np.int32).astype(np.int64),
        read(mesh.polygons, "loop_start", dtype=np.int32).astype(np.int64),
        options,
        np.flatnonzero(is_loose),
        np.setdiff1d(np.arange(len(mesh.vertices)), corners),
    )


def _tags(mesh: bpy.types.Mesh, edges: Integers, is_loose: npt.NDArray[np.bool_], corners: Integers) -> tuple[Any, dict[int, float]]:
    """Sharp edges of faces and sharp vertices of faces, with their sharpness in levels."""
    creases: list[tuple[int, int, float]] = []
    if (attribute := mesh.attributes.get("crease_edge")) is not None:
        crease = np.where(is_loose, 0.0, read(attribute.data, "value"))
        creases = [(*map(int, edges[row]), _sharpness(crease[row])) for row in np.flatnonzero(crease > 0.0)]
    sharp: dict[int, float] = {}
    if (attribute := mesh.attributes.get("crease_vert")) is not None:
        crease = read(attribute.data, "value")
        sharp = {int(row): _sharpness(crease[row]) for row in np.intersect1d(np.flatnonzero(crease > 0.0), corners)}
    return creases, sharp


def _sharpness(crease: float) -> float:
    """Blender gives OpenSubdiv 10 c², which takes 10 for ever."""
    return np.inf if crease >= 1.0 else 10.0 * float(crease) ** 2


def subdivision_of(an_object: bpy.types.Object) -> bpy.types.Modifier | None:
    """The last Subdivision Surface modifier that is switched on in the viewport."""
    found = [modifier for modifier in an_object.modifiers if modifier.type == "SUBSURF" and modifier.show_viewport]
    return found[-1] if found else None


def scale_of(an_object: bpy.types.Object) -> Floats:
    """The linear part of an object's transform."""
    return np.array(an_object.matrix_world, dtype=np.float64)[:3, :3]


def is_ready(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether the active object is a mesh in Object Mode; else the operator shows what it needs."""
    an_object = context.active_object
    if an_object is None or an_object.type != "MESH" or an_object.mode != "OBJECT":
        operator.poll_message_set("Needs an active mesh object in Object Mode")
        return False
    return True
