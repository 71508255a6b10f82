"""Triangles and what they carry, written to files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _limitmesh
from ._arrays import Floats
from ._mesh import Channel


def write(
    path: str | os.PathLike[str],
    vertices: Floats,
    faces: npt.NDArray[np.integer[Any]],
    normals: Floats | None,
    channels: Mapping[str, Channel],
    linked: tuple[Sequence[str], Sequence[str]] = ((), ()),
    *,
    normals_of_corners: npt.NDArray[np.uint32] | None = None,
    quads: npt.NDArray[np.integer[Any]] | None = None,
    ascii: bool,
) -> None:
    """Writes a file, whole or not at all; ``linked`` are libraries of materials and pictures that it is to name.

    Corners have the normals of their vertices, or by ``normals_of_corners`` any of the rows, which OBJ holds alone.
    Pairs of triangles are written as ``quads``, by the corners where the edges between them begin.
    """
    counts = {"vertex": len(vertices), "corner": 3 * len(faces), "face": len(faces)}
    _limitmesh.save(
        os.fspath(path),
        np.ascontiguousarray(vertices, dtype=np.float64),
        np.ascontiguousarray(faces, dtype=np.uint32),
        [] if quads is None else quads.tolist(),
        None if normals is None else np.ascontiguousarray(normals),
        normals_of_corners,
        [channel._native(name, counts) for name, channel in channels.items()],
        [list(names) for names in linked],
        bool(ascii),
    )
