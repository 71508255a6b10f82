"""Meshes as arguments: whatever stands for one, and with its options what the native half takes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias, Unpack

import numpy as np
import numpy.typing as npt

from . import _arrays, _incoming, _options
from ._arrays import MeshIn
from ._limitmesh import MeshError, OptionError
from ._mesh import Channel, Mesh
from ._read import load
from ._refined import Refined

MeshLike: TypeAlias = Mesh | Refined | tuple[npt.ArrayLike, Any] | str | os.PathLike[str] | Any
"""A `Mesh`, a result, a pair of vertices and faces, a file's name, or a mesh of trimesh, PyVista, meshio or Open3D."""


def as_mesh(mesh: Any, faces: Any = None, name: str = "vertices") -> Mesh:
    """A mesh from whatever stands for one."""
    if faces is not None:
        if isinstance(faces, (str, float, int)):
            raise MeshError(f"faces is {faces!r}, expected rows of vertex numbers; options have names, such as tolerance={faces!r}")
        return Mesh(mesh, faces)
    if isinstance(mesh, Mesh):
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return load(mesh)
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return Mesh(*mesh)
    library = _incoming.BY_LIBRARY.get(type(mesh).__module__.partition(".")[0])
    if library is not None:
        return library(mesh)
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return Mesh(mesh.vertices, mesh.faces, getattr(mesh, "channels", {}))
    raise MeshError(f"{name} is {type(mesh).__name__} and faces are missing, expected vertices and faces, or a mesh")


def mesh_of(
    vertices: Any,
    faces: Any,
    creases: Any = None,
    corners: Any = None,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
) -> Mesh:
    """A mesh with the tags and channels that are given beside it, which replace its own."""
    mesh = as_mesh(vertices, faces).with_channels(channels)
    if isinstance(creases, str):
        if creases != "auto":
            raise OptionError(f"creases is {creases!r}, expected pairs of vertices, or 'auto'")
    elif creases is not None:
        mesh = replace(mesh, creases=creases)
    if corners is not None:
        mesh = replace(mesh, corners=corners)
    return mesh


def surface_of(
    vertices: Any,
    faces: Any,
    creases: Any = None,
    corners: Any = None,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    **options: Unpack[_options.ControlOptions],
) -> tuple[MeshIn, dict[str, Any]]:
    """A mesh, and how a control mesh comes about from it, whose limit surface is meant."""
    mesh = mesh_of(vertices, faces, creases, corners, channels)
    if "scheme" in options:
        options["scheme"] = scheme_of(mesh, options["scheme"], needs_quads=options.get("smooth_triangles", False))
    control = _options.control_of(auto_creases=are_found(mesh, creases), **options)
    return mesh._native(), control


def scheme_of(mesh: Mesh, scheme: str | None, *, needs_quads: bool = False, needs_triangles: bool = False) -> str:
    """The scheme that was asked for, or else that of the mesh's faces: a mesh most of whose faces are quads is a cage for Catmull–Clark."""
    if scheme is not None:
        return scheme
    if needs_quads or needs_triangles:
        return "catmull-clark" if needs_quads else "loop"
    _, starts = _arrays.faces_of(mesh.faces)
    return "loop" if starts is None or 2 * np.count_nonzero(np.diff(starts) == 4) <= len(starts) - 1 else "catmull-clark"


def are_found(mesh: Mesh, creases: Any) -> bool:
    """Whether sharp edges are those that look so: that is asked for, and no edges or vertices are tagged."""
    is_tagged = any(tags is not None and len(tags) > 0 for tags in (mesh.creases, mesh.corners))
    return isinstance(creases, str) and not is_tagged
