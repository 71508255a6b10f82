"""Meshes of other libraries: trimesh, PyVista, meshio and Open3D, which are imported when they are needed.

Texture coordinates, colours, and data of points and cells come along as channels and go back under their names. Nothing is merged
or mended on the way in (``process=False``): `refine` does that, and tells.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ._limitmesh import MeshError
from ._mesh import Channel, Mesh, as_mesh
from ._refined import Refined, Split

_UV = "uv"
_COLOUR = "colour"


def _library(name: str) -> Any:
    from importlib import import_module

    try:
        return import_module(name)
    except ImportError as why:
        raise ImportError(f"{name} is not installed, and is what this function is for: pip install {name}") from why


def _is_numbers(array: npt.NDArray[Any]) -> bool:
    return array.dtype.kind in "fiub" and array.ndim in (1, 2) and (array.ndim == 1 or array.shape[1] > 0)


def _finite(array: npt.NDArray[Any]) -> bool:
    return bool(array.dtype.kind != "f" or np.isfinite(array).all())


def _data(name: str, values: Any, domain: Any) -> Channel | None:
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


def from_trimesh(mesh: Any) -> Mesh:
    """A ``trimesh.Trimesh``, with texture coordinates ("uv"), colours and its attributes of vertices and faces.

    >>> import limitmesh
    >>> trimesh = __import__("pytest").importorskip("trimesh")
    >>> smooth = limitmesh.refine(limitmesh.from_trimesh(trimesh.creation.box()), crease_angle=30)
    >>> smooth.diagnosis.clean
    True
    """
    if hasattr(mesh, "geometry"):
        raise MeshError(
            f"a trimesh scene of {len(mesh.geometry)} meshes, expected one mesh: its to_mesh() makes one of them, and refine_file() "
            "keeps a file as it is"
        )
    if not hasattr(mesh, "faces"):
        raise MeshError(f"a trimesh {type(mesh).__name__} has no faces, expected a trimesh.Trimesh")
    channels: dict[str, Channel] = {}
    for domain, attributes in (("vertex", mesh.vertex_attributes), ("face", mesh.face_attributes)):
        for name, values in attributes.items():
            found = _data(name, values, domain)
            if found is not None:
                channels[name] = found
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    uv = getattr(visual, "uv", None)
    if uv is not None and len(uv) == len(mesh.vertices):
        channels[_UV] = Channel(np.asarray(uv, dtype=np.float64), semantic="texture")
    elif kind == "vertex":
        channels[_COLOUR] = _colour(np.asarray(visual.vertex_colors), "vertex")  # type: ignore[union-attr]
    elif kind == "face":
        channels[_COLOUR] = _colour(np.asarray(visual.face_colors), "face")  # type: ignore[union-attr]
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces), channels)


def to_trimesh(mesh: Refined | Any, *, visual: Any = None) -> Any:
    """A ``trimesh.Trimesh`` of a result, with its limit normals, texture coordinates, colours and attributes.

    Where texture coordinates have seams, or edges are sharp, vertices stand once for each side, as trimesh has one value a vertex.

    Parameters
    ----------
    mesh
        A result, or any mesh.
    visual
        That of the mesh which was refined, whose material is taken over.

    Examples
    --------
    >>> import limitmesh
    >>> trimesh = __import__("pytest").importorskip("trimesh")
    >>> limitmesh.to_trimesh(limitmesh.refine("builtin:cup")).is_watertight
    True
    """
    trimesh = _library("trimesh")
    split, by_face = _split(mesh)
    values = dict(split.values)
    uv = values.pop(_UV, None)
    colours = values.pop(_COLOUR, None)
    face_colours = by_face.pop(_COLOUR, None)
    made = trimesh.Trimesh(
        vertices=split.vertices,
        faces=split.faces,
        vertex_normals=split.normals if len(split.normals) else None,
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


def from_pyvista(mesh: Any) -> Mesh:
    """A ``pyvista.PolyData`` (or any dataset, by its surface), with its data of points and cells.

    >>> import limitmesh
    >>> pyvista = __import__("pytest").importorskip("pyvista")
    >>> sphere = limitmesh.from_pyvista(pyvista.Sphere())
    >>> limitmesh.info(sphere)["watertight"]
    True
    """
    surface = mesh if isinstance(mesh, _library("pyvista").PolyData) else _outside(mesh)
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
    channels: dict[str, Channel] = {}
    textures = surface.active_texture_coordinates
    for name in surface.point_data:
        if name in ("Normals", "vtkOriginalPointIds"):
            continue
        found = _data(name, surface.point_data[name], "vertex")
        if textures is not None and found is not None and surface.point_data.active_texture_coordinates_name == name:
            found = Channel(found.values, semantic="texture")
        if found is not None:
            channels[name] = found
    for name in surface.cell_data:
        found = None if name in ("Normals", "vtkOriginalCellIds") else _data(name, surface.cell_data[name][before:], "face")
        if found is not None:
            channels[name] = found
    return Mesh(np.asarray(surface.points), faces, channels)


def _outside(dataset: Any) -> Any:
    """The surface of a dataset, by whichever way this version of PyVista has."""
    try:
        return dataset.extract_surface(algorithm=None)
    except TypeError:
        return dataset.extract_geometry()


def to_pyvista(mesh: Refined | Any) -> Any:
    """A ``pyvista.PolyData`` of a result, with its limit normals and channels as data of points and cells.

    Where channels have seams, or edges are sharp, points stand once for each side.

    >>> import limitmesh
    >>> pyvista = __import__("pytest").importorskip("pyvista")
    >>> limitmesh.to_pyvista(limitmesh.refine("builtin:cup")).n_open_edges
    0
    """
    pyvista = _library("pyvista")
    split, by_face = _split(mesh)
    made = pyvista.PolyData.from_regular_faces(split.vertices, split.faces.astype(np.int64, copy=False))
    textures = {name for name, channel in _channels(mesh).items() if channel.semantic == "texture"}
    for name, value in split.values.items():
        made.point_data[name] = _column(value)
        if name in textures and value.shape[1] >= 2:
            made.point_data[name] = value[:, :2]
            made.point_data.active_texture_coordinates_name = name
    for name, value in by_face.items():
        made.cell_data[name] = _column(value)
    if isinstance(mesh, Refined):
        made.point_data["Normals"] = split.normals
        made.point_data.active_normals_name = "Normals"
        if mesh.parent_face is not None:
            made.cell_data["parent_face"] = np.asarray(mesh.parent_face, dtype=np.int64)
    return made


def from_meshio(mesh: Any) -> Mesh:
    """A ``meshio.Mesh``: its triangles, quadrilaterals and polygons, with its data of points and cells.

    Raises
    ------
    MeshError
        It has no such cells.

    Examples
    --------
    >>> import limitmesh
    >>> meshio = __import__("pytest").importorskip("meshio")
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
    channels: dict[str, Channel] = {}
    for name, values in mesh.point_data.items():
        found = _data(name, values, "vertex")
        if found is not None:
            channels[name] = found
    for name, blocks in mesh.cell_data.items():
        found = _data(name, np.concatenate([np.asarray(blocks[at]) for at in flat]), "face")
        if found is not None:
            channels[name] = found
    return Mesh(points, together, channels)


def to_meshio(mesh: Refined | Any) -> Any:
    """A ``meshio.Mesh`` of a result, with its channels as data of points and cells; points stand once for each side of seams.

    >>> import limitmesh
    >>> meshio = __import__("pytest").importorskip("meshio")
    >>> fine = limitmesh.refine("builtin:cup")
    >>> len(limitmesh.to_meshio(fine).cells[0].data) == len(fine.faces)
    True
    """
    meshio = _library("meshio")
    split, by_face = _split(mesh)
    point_data = {name: _column(value) for name, value in split.values.items()}
    if isinstance(mesh, Refined):
        point_data["Normals"] = split.normals
        if mesh.parent_face is not None:
            by_face["parent_face"] = np.asarray(mesh.parent_face, dtype=np.int64)
    cell_data = {name: [_column(value)] for name, value in by_face.items()}
    return meshio.Mesh(split.vertices, [("triangle", split.faces.astype(np.int64, copy=False))], point_data, cell_data)


def from_open3d(mesh: Any) -> Mesh:
    """An ``open3d.geometry.TriangleMesh``, with texture coordinates ("uv", by corner), colours and materials.

    >>> import limitmesh
    >>> open3d = __import__("pytest").importorskip("open3d")
    >>> torus = limitmesh.from_open3d(open3d.geometry.TriangleMesh.create_torus())
    >>> limitmesh.info(torus)["genus"]
    1
    """
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    channels: dict[str, Channel] = {}
    if len(mesh.triangle_uvs) == 3 * len(faces):
        channels[_UV] = Channel(np.asarray(mesh.triangle_uvs), domain="corner", semantic="texture")
    if len(mesh.vertex_colors) == len(vertices):
        channels[_COLOUR] = Channel(np.asarray(mesh.vertex_colors), semantic="colour")
    if len(mesh.triangle_material_ids) == len(faces) and len(faces):
        channels["material"] = Channel(np.asarray(mesh.triangle_material_ids), domain="face", semantic="label")
    return Mesh(vertices, faces, channels)


def _channels(mesh: Any) -> dict[str, Channel]:
    return dict(mesh.channels) if isinstance(mesh, Refined) else {}


def _restored(values: npt.NDArray[Any], channel: Channel) -> npt.NDArray[Any]:
    """Values as the other library had them."""
    if channel.semantic == "colour" and channel.storage == "byte":
        return _bytes(values)
    if channel.semantic == "label":
        return np.round(values).astype(np.int64)
    return values


def _split(mesh: Any) -> tuple[Split, dict[str, npt.NDArray[Any]]]:
    """What goes out: vertices with one value each, and values by face."""
    if isinstance(mesh, Refined):
        split = mesh.split()
        values = {name: _restored(value, mesh.channels[name]) for name, value in split.values.items()}
        faces = {name: channel for name, channel in mesh.channels.items() if channel.domain == "face"}
        by_face = {name: _restored(channel[slice(None)], channel) for name, channel in faces.items()}
        return replace(split, values=values), by_face
    from ._simplify import repair

    mended = repair(as_mesh(mesh))
    none = np.zeros((0, 3))
    sources = np.arange(len(mended.vertices))
    return Split(mended.vertices, mended.faces, none, {}, sources), {}


def _column(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of one number each as a flat array."""
    return values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values


def _bytes(colours: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Colours from 0 to 1 as bytes."""
    if colours.dtype == np.uint8:
        return colours
    return np.clip(np.round(colours * 255.0), 0, 255).astype(np.uint8)
