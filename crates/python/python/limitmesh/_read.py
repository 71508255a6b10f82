"""Files and built-in models, read."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _limitmesh
from ._mesh import Mesh, told_channels


def models() -> dict[str, str]:
    """The built-in models, each with a line about it; `load` takes them as ``"builtin:cup"``.

    >>> import limitmesh
    >>> "cup" in limitmesh.models()
    True
    """
    return dict(_limitmesh.models())


def load(path: str | os.PathLike[str]) -> Mesh:
    """Reads a file, whatever is in it: OBJ, PLY, STL, OFF, glTF (what its scene shows) or 3MF (what its build has), or a built-in model.

    Parameters
    ----------
    path
        The file, whose extension tells the format; or ``"builtin:NAME"``.

    Raises
    ------
    ReadError
        It cannot be read; the message names the line or the place.

    Examples
    --------
    >>> import limitmesh
    >>> limitmesh.load("builtin:cube").vertices.shape
    (8, 3)
    """
    told = _limitmesh.load(os.fspath(path))
    corners, starts = told["corners"], told["starts"]
    sizes = np.diff(starts)
    faces: Any
    if len(sizes) and (sizes == sizes[0]).all():
        faces = corners.reshape(-1, sizes[0])
    elif not len(sizes):
        faces = np.zeros((0, 3), dtype=np.int64)
    else:
        faces = np.split(corners, starts[1:-1])
    return Mesh(
        told["vertices"],
        faces,
        told_channels(told["channels"], triangles=False),
        told["creases"] or None,
        told["corner_tags"] or None,
        tuple(told["material_libraries"]),
        tuple(told["texture_files"]),
        tuple(told["left_out"]),
    )
