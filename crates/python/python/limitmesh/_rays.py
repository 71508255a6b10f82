"""Rays against the limit surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _inputs, _limitmesh, _options
from ._arrays import Floats, Integers
from ._inputs import MeshLike
from ._limitmesh import OptionError
from ._options import Boundary, Length, ProgressCallback, Scheme
from ._shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Intersections(Shown):
    """Where rays meet a limit surface: a row for each hit, ray by ray, and along each ray in their order.

    Attributes
    ----------
    rays
        (k,): the rows of ``origins`` and ``directions`` that hit.
    t
        (k,): how far along, in lengths of the direction.
    points, normals
        (k, 3): the surface's points, in the mesh's unit, and its unit normals there; 0 where there is none.
    faces, barycentric
        (k,) and (k, 3): the control mesh's triangles that they are on, and the weights of their corners, as `limit_surface` takes them.
    crossing
        (k,) int8: 1 through the front, where a face's corners run counter-clockwise; -1 through the back; 0 where the ray touches
        the surface, or comes so near to it that it cannot be told.
    """

    rays: Integers
    t: Floats
    points: Floats
    normals: Floats
    faces: Integers
    barycentric: Floats
    crossing: npt.NDArray[np.int8]


def intersect(
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    first: bool = False,
    between: tuple[float, float] = (0.0, np.inf),
    tolerance: Length | None = None,
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
) -> Intersections:
    """All points where rays meet a mesh's limit surface itself, of which none is missed.

    Each call prepares the surface anew, which takes as long as about one ray for each control face: many rays at once are cheap.

    Parameters
    ----------
    origins, directions
        (n, 3), finite: a ray is all ``origin + t * direction``. One row, (3,), stands for all rays. Directions have any length
        but 0.
    vertices, faces
        The control mesh, as for `refine`.
    first
        Whether the first hit of each ray is enough, which is found faster.
    between
        The least and the greatest t that count; -inf and inf for whole lines.
    tolerance
        A ray that touches the surface without being told to cross it within so little of it grazes it: a length, or a part of the
        control mesh's diagonal. Default: 1e-10 of that.
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
        Rays that are none, or as `refine`.

    Examples
    --------
    The limit of a vertex of an octahedron is 24/55 of it.

    >>> import limitmesh
    >>> vertices = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
    >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    >>> hits = limitmesh.intersect([[5, 0, 0], [5, 1, 0]], [-1, 0, 0], vertices, faces)
    >>> hits.rays.tolist(), hits.t.round(6).tolist(), hits.crossing.tolist()
    ([0, 0], [4.563636, 5.436364], [1, -1])
    """
    starts, along = _rays_of(origins, directions)
    casting = {
        "first": bool(first),
        "between": _range_of(between),
        "tolerance": None if tolerance is None else _options.extent(tolerance, "tolerance"),
    }
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, weld=weld,
    )
    rays, t, triangles, barycentric, points, normals, crossing = _limitmesh.intersect(
        starts, along, native, control, casting, *_options.work_of(threads, progress)
    )
    return Intersections(rays, t, points, normals, triangles, barycentric, crossing)


def _rays_of(origins: npt.ArrayLike, directions: npt.ArrayLike) -> tuple[Floats, Floats]:
    starts, along = _rows_of(origins, "origins"), _rows_of(directions, "directions")
    if len(starts) != len(along) and 1 not in (len(starts), len(along)):
        raise OptionError(f"directions has {len(along)} rows, expected {len(starts)}: one for each of origins, or one for all")
    has_none = ~along.any(axis=1)
    if has_none.any():
        raise OptionError(f"directions[{int(np.argmax(has_none))}] is 0, expected a direction")
    shape = np.broadcast_shapes(starts.shape, along.shape)
    return np.ascontiguousarray(np.broadcast_to(starts, shape)), np.ascontiguousarray(np.broadcast_to(along, shape))


def _rows_of(value: npt.ArrayLike, name: str) -> Floats:
    """Rows of three numbers; one that stands alone is a row."""
    rows = value
    if isinstance(value, (np.ndarray, list, tuple)) and len(value) == 3 and all(np.ndim(x) == 0 for x in value):
        rows = np.asarray(value)[None]
    return _options.points_of(rows, name)


def _range_of(between: tuple[float, float]) -> tuple[float, float]:
    try:
        low, high = (float(value) for value in between)
    except (ValueError, TypeError):
        low = high = np.nan
    if not low <= high:
        raise OptionError(f"between is {between!r}, expected two numbers, the least t and the greatest")
    return low, high


__all__ = ["Intersections", "intersect"]
