"""The limit surface itself: at places of its control faces, and which way it looks over each."""

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


@dataclass(frozen=True, repr=False)
class SurfacePoints(Shown):
    """Points of a limit surface, one a place; NaN for what is not there.

    Attributes
    ----------
    positions, normals
        (n, 3), in the mesh's unit; normals are unit vectors, on the face's own side of sharp edges.
    tangents
        (n, 2, 3): unit vectors that span the tangent plane: the directions of the first derivatives, and at corners of faces where there
        are none the limit tangents of the scheme.
    first
        (n, 2, 3): the derivatives by the weights of the face's second and third corner, where that of the first is what they leave of 1.
    second
        (n, 3, 3): by the second corner's weight twice, by both, by the third's twice.
    gaussian, mean
        (n,): curvatures, in 1 / unit² and 1 / unit; the mean is below 0 on convex places whose normals point outwards.
    principal, directions
        (n, 2) and (n, 2, 3): the greatest and the least curvature, and the unit directions in which the surface bends so.
    """

    positions: Floats
    normals: Floats
    tangents: Floats
    first: Floats
    second: Floats
    gaussian: Floats
    mean: Floats
    principal: Floats
    directions: Floats


def limit_surface(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    at: npt.ArrayLike,
    barycentric: npt.ArrayLike,
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
) -> SurfacePoints:
    """Where the limit surface is over places of its control faces, and how it bends there, exactly.

    Parameters
    ----------
    vertices, faces
        A mesh of triangles, as for `refine`; one that needs no repair, such as `repair` gives.
    at
        (n,): the faces, counted from 0.
    barycentric
        (n, 3): weights of the three corners, none below 0, which add up to 1; where they do so within 0.0002, as 0.3333 three times, they
        are divided by their sum.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, weld
        What the limit surface is, as for `refine`.
    threads, progress
        As for `refine`.

    Raises
    ------
    MeshError
        As `refine`, and where the control mesh's triangles would not be ``faces``.
    OptionError
        A face that there is not, weights that are no place on it, or as `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> vertices = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    >>> middle = limitmesh.limit_surface(vertices, faces, at=[0], barycentric=[[0.5, 0.5, 0]])
    >>> round(float(middle.gaussian[0]), 9), round(float(middle.mean[0]), 9)
    (15.75, -4.625)
    """
    rows, weights = _places_of(at, barycentric)
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, weld=weld,
    )
    found = _limitmesh.limit_surface(native, control, rows, weights, *_options.work_of(threads, progress))
    positions, normals, tangents, first, second, directions, curvatures = found
    gaussian, mean, most, least = np.ascontiguousarray(curvatures.reshape(-1, 4).T)
    return SurfacePoints(
        positions,
        normals,
        tangents.reshape(-1, 2, 3),
        first.reshape(-1, 2, 3),
        second.reshape(-1, 3, 3),
        gaussian,
        mean,
        np.column_stack([most, least]),
        directions.reshape(-1, 2, 3),
    )


def facing(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    view: npt.ArrayLike | None = None,
    eye: npt.ArrayLike | None = None,
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
) -> npt.NDArray[np.int8]:
    """Which side of the limit surface over each control face is seen, for certain: (m,) int8.

    1 where every point over the face shows its front, -1 where every one shows its back; 0 where both are seen, where it is a close
    thing, at vertices without a tangent plane, and for schemes other than ``"loop"`` and ``"loop-warren"``.

    Parameters
    ----------
    vertices, faces
        A mesh of triangles, as for `refine`; one that needs no repair, such as `repair` gives.
    view
        The direction of sight of a parallel projection, from the viewer into the scene, of any length but 0.
    eye
        Or where the viewer stands, in the mesh's unit. One of both is needed.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, weld
        What the limit surface is, as for `refine`.
    threads, progress
        As for `refine`.

    Raises
    ------
    MeshError
        As `refine`, and where the control mesh's triangles would not be ``faces``.
    OptionError
        A viewpoint that is none, or as `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> vertices = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    >>> limitmesh.facing(vertices, faces, eye=[9, 9, -9]).tolist()
    [1, 0, 0, 0]
    """
    if (view is None) == (eye is None):
        raise OptionError("view and eye: one of them says where the viewer is")
    stands = None if eye is None else _options.point(eye, "eye")
    sight = [0.0, 0.0, 0.0] if view is None else _options.point(view, "view")
    if view is not None and not any(sight):
        raise OptionError(f"view is {view!r}, expected a direction: it is 0")
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, weld=weld,
    )
    return _limitmesh.facing(native, control, stands, sight, *_options.work_of(threads, progress))


def _places_of(
    at: npt.ArrayLike, barycentric: npt.ArrayLike
) -> tuple[Integers, Floats]:
    faces = np.asarray(at)
    if faces.ndim != 1 or (faces.dtype.kind not in "iu" and faces.size):
        raise OptionError(f"at has the shape {faces.shape} and numbers of type {faces.dtype}, expected (n,) whole numbers")
    weights = _options.rows_of(barycentric, "barycentric")
    if weights.shape != (len(faces), 3):
        raise OptionError(f"barycentric has the shape {weights.shape}, expected {(len(faces), 3)}: a row for each of at")
    return np.ascontiguousarray(faces, dtype=np.int64), weights


__all__ = ["SurfacePoints", "facing", "limit_surface"]
