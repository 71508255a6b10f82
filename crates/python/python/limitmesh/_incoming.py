"""Meshes of other libraries: trimesh, PyVista, meshio and Open3D, which are imported when they are needed.

Texture coordinates, colours, and data of points and cells come along as channels. Nothing is merged or mended on the way
(``process=False``): `refine` does that, and tells.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._library import COLOUR, UV, library
from ._limitmesh import MeshError
from ._mesh import Channel, Mesh


def _is_numbers(array: npt.NDArray[Any]) -> bool:
    return array.dtype.kind in "fiub" and array.ndim in (1, 2) and (array.ndim == 1 or array.shape[1] > 0)


def _finite(array: npt.NDArray[Any]) -> bool:
    return bool(array.dtype.kind != "f" or np.isfinite(array).all())


def carried(name: str, values: Any, domain: Any) -> Channel | None:
    """A channel of data by point or cell; what is no number, or no finite one, cannot be carried."""
    array = np.asarray(values)
    if array.ndim > 2:
        array = array.reshape(len(array), -1)
    if not _is_numbers(array) or not _finite(array):
        return None
    low = name.lower()
    if any(word in low for word in ("texture", "texcoord", "uv")) and array.ndim == 2 and array.shape[1] >= 2:
        return Channel(array, domain=domain, semantic="texture")
    if any(word in low for word in ("rgb", "colour", "color")) and array.ndim == 2:
        return _colour(array, domain)
    is_label = array.dtype.kind in "iub" and domain == "face"
    return Channel(array, domain=domain, semantic="label" if is_label else "other")


def _colour(array: npt.NDArray[Any], domain: Any) -> Channel:
    """Colours from 0 to 1; bytes are remembered as such."""
    if array.dtype == np.uint8:
        return Channel(array / 255.0, domain=domain, semantic="colour", storage="byte")
    return Channel(array, domain=domain, semantic="colour")


def _carried(data: Mapping[str, Any], domain: Any) -> dict[str, Channel]:
    """Channels of all data that can be carried, by name."""
    found = {name: carried(name, values, domain) for name, values in data.items()}
    return {name: channel for name, channel in found.items() if channel is not None}


def from_trimesh(mesh: Any) -> Mesh:
    """A ``trimesh.Trimesh``, with texture coordinates ("uv"), colours and its attributes of vertices and faces.

    >>> import limitmesh
    >>> import trimesh
    >>> smooth = limitmesh.refine(limitmesh.from_trimesh(trimesh.creation.box()), crease_angle=30)
    >>> smooth.diagnosis.clean
    True
    """
    if hasattr(mesh, "geometry"):
        raise MeshError(
            "a trimesh scene, expected one mesh: its to_mesh() makes one of all that it has, and refine_file() keeps a file as it is"
        )
    if not hasattr(mesh, "faces"):
        raise MeshError(f"{type(mesh).__module__}.{type(mesh).__name__} has no faces, expected a trimesh.Trimesh")
    channels = _carried(mesh.vertex_attributes, "vertex") | _carried(mesh.face_attributes, "face")
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    uv = getattr(visual, "uv", None)
    if uv is not None and len(uv) == len(mesh.vertices):
        channels[UV] = Channel(np.asarray(uv, dtype=np.float64), semantic="texture")
    elif kind == "vertex":
        channels[COLOUR] = _colour(np.asarray(visual.vertex_colors), "vertex")  # type: ignore[union-attr]
    elif kind == "face":
        channels[COLOUR] = _colour(np.asarray(visual.face_colors), "face")  # type: ignore[union-attr]
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces), channels)


def from_pyvista(mesh: Any) -> Mesh:
    """A ``pyvista.PolyData`` (or any dataset, by its surface), with its data of points and cells.

    >>> import limitmesh
    >>> import pyvista
    >>> sphere = limitmesh.from_pyvista(pyvista.Sphere())
    >>> limitmesh.info(sphere)["watertight"]
    True
    """
    surface = mesh if isinstance(mesh, library("pyvista").PolyData) else _outside(mesh)
    if surface.n_strips:
        surface = surface.triangulate()
    # Lines and points are cells, too, and stand before the polygons.
    before = surface.n_verts + surface.n_lines
    polygons = np.asarray(surface.faces)
    faces: Any
    if surface.is_all_triangles:
        faces = surface.regular_faces
    else:
        faces, at = [], 0
        while at < len(polygons):
            size = int(polygons[at])
            faces.append(polygons[at + 1 : at + 1 + size])
            at += 1 + size
    own = ("Normals", "vtkOriginalPointIds", "vtkOriginalCellIds")
    points = {name: surface.point_data[name] for name in surface.point_data if name not in own}
    cells = {name: surface.cell_data[name][before:] for name in surface.cell_data if name not in own}
    channels = _carried(points, "vertex")
    if surface.active_texture_coordinates is not None:
        name = surface.point_data.active_texture_coordinates_name
        if name in channels:
            channels[name] = Channel(channels[name].values, semantic="texture")
    return Mesh(np.asarray(surface.points), faces, channels | _carried(cells, "face"))


def _outside(dataset: Any) -> Any:
    """The surface of a dataset, by whichever way this version of PyVista has."""
    try:
        return dataset.extract_surface(algorithm=None)
    except TypeError:
        return dataset.extract_geometry()


def from_meshio(mesh: Any) -> Mesh:
    """A ``meshio.Mesh``: its triangles, quadrilaterals and polygons, with its data of points and cells.

    Raises
    ------
    MeshError
        It has no such cells.

    Examples
    --------
    >>> import limitmesh
    >>> import meshio
    >>> square = meshio.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [("quad", [[0, 1, 2, 3]])])
    >>> len(limitmesh.refine(limitmesh.from_meshio(square), boundary="fixed").faces) >= 2
    True
    """
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    flat = [at for at, block in enumerate(mesh.cells) if block.type.startswith(("triangle", "quad", "polygon"))]
    # Of cells of higher order the corners.
    width = {"triangle": 3, "quad": 4}
    faces: list[Any] = []
    for at in flat:
        block = mesh.cells[at]
        size = next((size for kind, size in width.items() if block.type.startswith(kind)), None)
        faces.append(block.data if size is None else np.asarray(block.data)[:, :size])
    if not faces:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "none"
        raise MeshError(f"the meshio mesh has no triangles, quadrilaterals or polygons; its cells are: {kinds}")
    together: Any = np.concatenate(faces) if len({np.asarray(f).shape[1:] for f in faces}) == 1 and all(
        isinstance(f, np.ndarray) for f in faces
    ) else [row for block in faces for row in block]
    cells = {name: np.concatenate([np.asarray(blocks[at]) for at in flat]) for name, blocks in mesh.cell_data.items()}
    return Mesh(points, together, _carried(mesh.point_data, "vertex") | _carried(cells, "face"))


def from_open3d(mesh: Any) -> Mesh:
    """An ``open3d.geometry.TriangleMesh``, with texture coordinates ("uv", by corner), colours and materials.

    >>> import limitmesh
    >>> import open3d
    >>> torus = limitmesh.from_open3d(open3d.geometry.TriangleMesh.create_torus())
    >>> limitmesh.info(torus)["genus"]
    1
    """
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    channels: dict[str, Channel] = {}
    if len(mesh.triangle_uvs) == 3 * len(faces):
        channels[UV] = Channel(np.asarray(mesh.triangle_uvs), domain="corner", semantic="texture")
    if len(mesh.vertex_colors) == len(vertices):
        channels[COLOUR] = Channel(np.asarray(mesh.vertex_colors), semantic="colour")
    if len(mesh.triangle_material_ids) == len(faces) and len(faces):
        channels["material"] = Channel(np.asarray(mesh.triangle_material_ids), domain="face", semantic="label")
    return Mesh(vertices, faces, channels)


BY_LIBRARY: dict[str, Callable[[Any], Mesh]] = {
    "trimesh": from_trimesh,
    "pyvista": from_pyvista,
    "meshio": from_meshio,
    "open3d": from_open3d,
}
