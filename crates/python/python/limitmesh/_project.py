"""Points against the limit surface: closest points and signed distances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from . import _inputs, _limitmesh, _options
from ._arrays import Floats, Integers
from ._inputs import MeshLike
from ._options import Boundary, Length, ProgressCallback, Scheme
from ._shown import Shown


@dataclass(frozen=True, repr=False)
class Projected(Shown):
    """The closest points of a limit surface, one for each of those that were given.

    Attributes
    ----------
    points, normals
        (n, 3): the closest points, in the mesh's unit, and the unit normals there; 0 where there is none.
    distances, lower
        (n,): how far they are, and what no point of the surface is nearer than.
    signed
        (n,): the distances, below 0 inside of a closed surface; where it is open, behind it, by its normals.
    faces, barycentric
        (n,) and (n, 3): the control mesh's triangles that they are on, and the weights of their corners, as `limit_surface` takes them.
    """

    points: Floats
    normals: Floats
    distances: Floats
    lower: Floats
    signed: Floats
    faces: Integers
    barycentric: Floats


def project(
    points: npt.ArrayLike,
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerance: Length = "0.0001%",
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    weld: float | None = 0.0,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Projected:
    """The closest points of a mesh's limit surface itself to points, such as those of a scan, certified.

    Parameters
    ----------
    points
        (n, 3), finite.
    vertices, faces
        The control mesh, as for `refine`.
    tolerance
        How much nearer the surface may be than what was found: a length, or a part of the control mesh's diagonal.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, weld
        What the limit surface is, as for `refine`; the scheme is ``"loop"``, ``"loop-warren"`` or ``"catmull-clark"``, whose
        control faces are halves of quads, those of the first quad 0 and 1.
    threads, progress
        As for `refine`.

    Raises
    ------
    MeshError
        As `refine`.
    OptionError
        Points that are none, or as `refine`.

    Examples
    --------
    The limit of a vertex of an octahedron is 24/55 of it.

    >>> import limitmesh
    >>> vertices = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
    >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    >>> found = limitmesh.project([[2, 0, 0], [0.4, 0, 0]], vertices, faces)
    >>> round(float(found.signed[0]), 6), bool(found.signed[1] < 0)
    (1.563636, True)
    """
    rows = _options.points_of(points, "points")
    within = _options.extent(tolerance, "tolerance")
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, weld=weld,
    )
    found = _limitmesh.project(rows, native, control, within, *_options.work_of(threads, progress))
    closest, normals, barycentric, triangles, distances, lower, signed = found
    return Projected(closest, normals, distances, lower, signed, triangles, barycentric)


__all__ = ["Projected", "project"]
