"""Distances, limits, and what kind of mesh it is."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy.typing as npt

from . import _inputs, _limitmesh, _options
from ._arrays import Floats
from ._inputs import MeshLike, as_mesh
from ._limitmesh import OptionError
from ._options import Boundary, Length, ProgressCallback, Scheme
from ._refined import Diagnosis


@dataclass(frozen=True)
class OneSided:
    """The greatest distance from one surface to another, in their unit.

    Attributes
    ----------
    lower, upper
        It is between these; sampled distances are lower bounds, with ``upper`` infinite.
    mean, rms, percentile_95
        Over the surface, of sampled distances; 95 % of the surface is no farther away than the last.
    samples
        How many were taken.
    at, to
        The farthest point that was found, and the other surface's closest point to it.
    """

    lower: float
    upper: float
    mean: float | None
    rms: float | None
    percentile_95: float | None
    samples: int | None
    at: tuple[float, float, float]
    to: tuple[float, float, float]


@dataclass(frozen=True)
class Distance:
    """The symmetric Hausdorff distance of two surfaces, in their unit.

    Attributes
    ----------
    lower, upper
        It is between these: both proven where ``certified`` holds; else ``upper`` is infinite.
    certified
        Whether it was bounded from both sides.
    converged
        Whether the interval is as narrow as was asked for.
    forward, backward
        From the first surface to the second, and back.
    diagonal
        Of the second surface's bounding box.
    """

    lower: float
    upper: float
    certified: bool
    converged: bool
    forward: OneSided
    backward: OneSided
    diagonal: float


def measure(
    a: MeshLike,
    b: MeshLike | None = None,
    *,
    limit_of: MeshLike | None = None,
    certified: bool = False,
    samples: int = 100_000,
    gap: Length | None = None,
    max_work: int | None = None,
    levels: int | None = None,
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    smooth_triangles: bool = False,
    weld: float | None = 0.0,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Distance:
    """The distance between two meshes, or between a mesh and a limit surface.

    Parameters
    ----------
    a, b
        Meshes as for `refine`: such as a pair of vertices and faces. Any triangles will do.
    limit_of
        Instead of ``b``: the control mesh whose limit surface it is.
    certified
        Bounds the distance from both sides, rather than sampling it.
    samples
        On each surface.
    gap
        How narrow a certified interval is to be, as a length or a part of the diagonal. Default: a hundredth of the distance, or a
        millionth of the diagonal; of limit surfaces a tenth of the distance.
    max_work
        Work after which a certified search ends with what it has.
    levels
        Of uniform refinement that stands for a limit surface when sampling, at least 1. Default: 5, or fewer for large meshes, but two
        more than ``a`` has.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, smooth_triangles, weld
        What the limit surface is, as for `refine`.
    threads, progress
        As for `refine`.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> fine = limitmesh.refine("builtin:cup", tolerance="0.5%")
    >>> found = limitmesh.measure(fine, limit_of="builtin:cup", certified=True)
    >>> found.lower <= fine.error.upper and found.upper >= fine.error.lower
    True
    """
    if (b is None) == (limit_of is None):
        raise OptionError("b and limit_of: one of them is measured against")
    how = {
        "certified": bool(certified),
        "samples": _options.whole(samples, "samples", 1),
        "gap": None if gap is None else _options.extent(gap, "gap", zero=True),
        "max_work": None if max_work is None else _options.whole(max_work, "max_work", 0),
    }
    if not certified and (gap is not None or max_work is not None):
        raise OptionError("gap and max_work belong to certified distances")
    work = _options.work_of(threads, progress)
    surface = as_mesh(a, name="a")._native()
    if limit_of is None:
        told = _limitmesh.measure(surface, as_mesh(b, name="b")._native(), how, *work)
    else:
        steps = None if levels is None else min(_options.whole(levels, "levels", 1), 12)
        reference, control = _inputs.surface_of(
            limit_of, None, creases, corners,
            interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
            scheme=scheme, smooth_triangles=smooth_triangles, weld=weld,
        )
        told = _limitmesh.measure_limit(surface, reference, control, how, steps, *work)
    return Distance(
        told["lower"],
        told["upper"],
        told["certified"],
        told["converged"],
        _one_sided(told["forward"]),
        _one_sided(told["backward"]),
        told["diagonal"],
    )


def _one_sided(told: Mapping[str, Any]) -> OneSided:
    return OneSided(**{**told, "at": tuple(told["at"]), "to": tuple(told["to"])})


class Limit(NamedTuple):
    """Limits of the vertices of a mesh: `positions` and unit `normals`, (n, 3) each."""

    positions: Floats
    normals: Floats


def limit(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    smooth_triangles: bool = False,
    weld: float | None = 0.0,
    repair: bool = True,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Limit:
    """Where the vertices of a mesh go on its limit surface, exactly, and the limit normals there.

    At sharp edges the normal is an average of the sides; vertices in no face have NaN.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh, numpy as np
    >>> vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    >>> positions, normals = limitmesh.limit(vertices, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    >>> np.allclose(normals, vertices / np.sqrt(3))
    True
    """
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, smooth_triangles=smooth_triangles, weld=weld, repair=repair,
    )
    return Limit(*_limitmesh.limit(native, control, *_options.work_of(threads, progress)))


def info(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    weld: float | None = 0.0,
    repair: bool = True,
    threads: int | None = None,
) -> dict[str, Any]:
    """What kind of mesh it is, after the repairs that `refine` would make.

    Returns
    -------
    dict
        ``vertices``, ``edges``, ``triangles``, ``components``, ``genus``, ``euler_characteristic``, ``boundary_loops``,
        ``boundary_edges``, ``watertight``, ``min_valence``, ``max_valence``, ``irregular_vertices``, ``bounding_box`` (``low``,
        ``high``, ``diagonal``), ``area``, ``volume`` (None where open), ``dihedrals`` (``histogram``
        of edges in steps of 10°, ``suggested_crease_angle_degrees``, ``sharp_edges``), ``min_angle_degrees``,
        ``mean_min_angle_degrees``, ``angle_histogram`` (steps of 5°), and ``diagnosis``, a `Diagnosis`.

    Raises
    ------
    MeshError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> found = limitmesh.info("builtin:cube")
    >>> found["watertight"], found["dihedrals"]["suggested_crease_angle_degrees"] is not None
    (True, True)
    """
    native, control = _inputs.surface_of(vertices, faces, weld=weld, repair=repair)
    text, diagnosis = _limitmesh.examine(native, control, _options.threads_of(threads))
    found: dict[str, Any] = json.loads(text)
    return {**found, "diagnosis": Diagnosis._of_native(diagnosis)}


__all__ = ["Distance", "Limit", "OneSided", "info", "limit", "measure"]
