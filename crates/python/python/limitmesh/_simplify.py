"""Fewer triangles within a distance, and mended meshes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _inputs, _limitmesh, _options
from ._arrays import Floats
from ._inputs import MeshLike
from ._mesh import Channel, told_channels
from ._options import Boundary, Count, Length, ProgressCallback
from ._refined import AnyIntegers, Diagnosis
from ._shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Simplified(Shown):
    """A mesh with fewer triangles.

    Attributes
    ----------
    vertices, faces
        (n, 3) positions, each one of the input's, and (m, 3) vertex numbers.
    parent_vertex
        (n,) the row of ``vertices`` of the input that each vertex was.
    bound
        The distance between both meshes is certainly no more than this, either way; None where no proof was asked for.
    estimate
        The greatest distance that samples showed.
    diagnosis
        What was found in the input and mended.
    """

    vertices: Floats
    faces: AnyIntegers
    parent_vertex: AnyIntegers
    bound: float | None
    estimate: float
    diagnosis: Diagnosis


def simplify(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerance: Length | None = None,
    triangles: Count | None = None,
    certify: bool = True,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Simplified:
    """Collapses edges of a mesh within a proven distance, or until there are no more than so many triangles.

    The mesh's own triangles are the surface: no smoothing. Boundaries and creases stay along their lines.

    Parameters
    ----------
    vertices, faces
        As for `refine`.
    tolerance
        Greatest distance from the input, either way; "0.1%" without another goal.
    triangles
        Stop at so many.
    certify
        Whether the distance is proven.
    crease_angle, creases, corners, boundary, weld, repair, index_dtype, threads, progress
        As for `refine`.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> fine = limitmesh.refine("builtin:torus", tolerance="0.05%")
    >>> coarse = limitmesh.simplify(fine, tolerance="0.5%")
    >>> len(coarse.faces) < len(fine.faces) and bool((coarse.vertices == fine.vertices[coarse.parent_vertex]).all())
    True
    """
    dtype = _options.index_dtype_of(index_dtype)
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=False, crease_angle=crease_angle, boundary=boundary, concave_corners="as-tagged", weld=weld, repair=repair,
    )
    native["channels"] = []
    told = _limitmesh.simplify(
        native,
        control,
        None if tolerance is None else _options.extent(tolerance, "tolerance"),
        None if triangles is None else _options.whole(triangles, "triangles", 1),
        bool(certify),
        *_options.work_of(threads, progress),
    )
    return Simplified(
        told["vertices"],
        told["faces"].astype(dtype, copy=False),
        told["parent_vertex"].astype(dtype, copy=False),
        told["bound"],
        told["estimate"],
        Diagnosis._of_native(told["diagnosis"]),
    )


@dataclass(frozen=True, eq=False, repr=False)
class Repaired(Shown):
    """A mended mesh: triangles, oriented alike, manifold.

    Attributes
    ----------
    vertices, faces
        (n, 3) positions and (m, 3) vertex numbers.
    parent_face
        (m,) the row of ``faces`` of the input that each triangle came from.
    parent_vertices
        (m, 3) the rows of ``vertices`` of the input that its corners were.
    channels
        What was carried along, by name.
    creases, corners
        Sharp edges and vertices, with their sharpness.
    diagnosis
        What was found and mended.
    """

    vertices: Floats
    faces: AnyIntegers
    parent_face: AnyIntegers
    parent_vertices: AnyIntegers
    channels: Mapping[str, Channel]
    creases: list[tuple[int, int, float]]
    corners: list[tuple[int, float]]
    diagnosis: Diagnosis


def repair(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    creases: Any = None,
    corners: Any = None,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    weld: float | None = 0.0,
    index_dtype: npt.DTypeLike = np.int64,
    threads: int | None = None,
) -> Repaired:
    """The mesh that `refine` would begin with: polygons cut into triangles, equal positions welded, defects mended.

    Parameters
    ----------
    vertices, faces, creases, corners, channels, weld, index_dtype, threads
        As for `refine`.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> square = limitmesh.repair([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [9, 9, 9]], [[0, 1, 2, 3]])
    >>> square.faces.shape, square.parent_face.tolist(), square.diagnosis.repairs
    ((2, 3), [0, 0], ('1 vertex in no face: left out (vertex 4)',))
    """
    dtype = _options.index_dtype_of(index_dtype)
    native, control = _inputs.surface_of(vertices, faces, creases, corners, channels, interpolate=False, concave_corners="as-tagged", weld=weld)
    told = _limitmesh.repair(native, control, _options.threads_of(threads))
    return Repaired(
        told["vertices"],
        told["faces"].astype(dtype, copy=False),
        told["parent_face"].astype(dtype, copy=False),
        told["parent_vertices"].astype(dtype, copy=False),
        told_channels(told["channels"], triangles=True),
        told["creases"],
        told["corners"],
        Diagnosis._of_native(told["diagnosis"]),
    )


__all__ = ["Repaired", "Simplified", "repair", "simplify"]
