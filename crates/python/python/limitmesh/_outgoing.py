"""Meshes on their way to other libraries: trimesh, PyVista and meshio, which are imported when they are needed.

Channels go back as texture coordinates, colours, and data of points and cells, under their names.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Floats
from ._library import COLOUR, UV, library
from ._mesh import Channel
from ._shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Outgoing(Shown):
    """What goes out: vertices with one value each, and values by face.

    Attributes
    ----------
    vertices, faces, normals
        (n, 3) each but the faces, (m, 3); no normals where nothing is known of a limit surface.
    by_vertex, by_face
        Values by channel, as the other library had them.
    textures
        The channels that are texture coordinates.
    parents
        (m,) the row of the input that each triangle came from, where that is known.
    sources
        (n,) the vertex of the result that each vertex was, where there is a result.
    """

    vertices: Floats
    faces: npt.NDArray[np.integer[Any]]
    normals: Floats | None
    by_vertex: dict[str, npt.NDArray[Any]]
    by_face: dict[str, npt.NDArray[Any]]
    textures: frozenset[str]
    parents: npt.NDArray[np.integer[Any]] | None
    sources: npt.NDArray[np.integer[Any]] | None = None


def restored(values: npt.NDArray[Any], channel: Channel) -> npt.NDArray[Any]:
    """Values as the other library had them."""
    if channel.semantic == "colour" and channel.storage == "byte":
        return _bytes(values)
    if channel.semantic == "label":
        return np.round(values).astype(np.int64)
    return values


def to_trimesh(mesh: Outgoing, visual: Any) -> Any:
    """A ``trimesh.Trimesh`` of it, with the material of a ``visual``."""
    trimesh = library("trimesh")
    values, by_face = dict(mesh.by_vertex), dict(mesh.by_face)
    uv = values.pop(UV, None)
    colours = values.pop(COLOUR, None)
    face_colours = by_face.pop(COLOUR, None)
    made = trimesh.Trimesh(
        vertices=mesh.vertices,
        faces=mesh.faces,
        vertex_normals=mesh.normals,
        vertex_attributes={name: _column(value) for name, value in values.items()} or None,
        face_attributes={name: _column(value) for name, value in by_face.items()} or None,
        process=False,
    )
    if uv is not None:
        material = getattr(visual, "material", None)
        made.visual = trimesh.visual.TextureVisuals(uv=uv[:, :2], material=material)
    elif colours is not None:
        made.visual = trimesh.visual.ColorVisuals(made, vertex_colors=_bytes(colours))
    elif face_colours is not None:
        made.visual = trimesh.visual.ColorVisuals(made, face_colors=_bytes(face_colours))
    return made


def to_pyvista(mesh: Outgoing) -> Any:
    """A ``pyvista.PolyData`` of it."""
    pyvista = library("pyvista")
    made = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces.astype(np.int64, copy=False))
    for name, value in mesh.by_vertex.items():
        made.point_data[name] = _column(value)
        if name in mesh.textures and value.shape[1] >= 2:
            made.point_data[name] = value[:, :2]
            made.point_data.active_texture_coordinates_name = name
    for name, value in mesh.by_face.items():
        made.cell_data[name] = _column(value)
    if mesh.normals is not None:
        made.point_data["Normals"] = mesh.normals
        made.point_data.active_normals_name = "Normals"
    if mesh.parents is not None:
        made.cell_data["parent_face"] = np.asarray(mesh.parents, dtype=np.int64)
    return made


def to_meshio(mesh: Outgoing) -> Any:
    """A ``meshio.Mesh`` of it."""
    meshio = library("meshio")
    point_data = {name: _column(value) for name, value in mesh.by_vertex.items()}
    cell_data = {name: [_column(value)] for name, value in mesh.by_face.items()}
    if mesh.normals is not None:
        point_data["Normals"] = mesh.normals
    if mesh.parents is not None:
        cell_data["parent_face"] = [np.asarray(mesh.parents, dtype=np.int64)]
    return meshio.Mesh(mesh.vertices, [("triangle", mesh.faces.astype(np.int64, copy=False))], point_data, cell_data)


def _column(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of one number each as a flat array."""
    return values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values


def _bytes(colours: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Colours from 0 to 1 as bytes."""
    if colours.dtype == np.uint8:
        return colours
    return np.clip(np.round(colours * 255.0), 0, 255).astype(np.uint8)
