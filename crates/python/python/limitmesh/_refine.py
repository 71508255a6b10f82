"""Refinement of arrays."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _inputs, _limitmesh, _options, _short
from ._inputs import MeshLike
from ._limitmesh import OptionError
from ._mesh import Channel
from ._options import Boundary, Camera, Count, Length, Method, ProgressCallback, RefiningScheme, Scheme
from ._refined import Refined


def refine(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerance: Length | None = None,
    within: Length | None = None,
    triangles: Count | None = None,
    angle: float | None = None,
    pixels: float | None = None,
    cameras: Camera | Iterable[Camera] | None = None,
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: RefiningScheme | None = None,
    smooth_triangles: bool = False,
    method: Method = "exact",
    levels: int | None = None,
    view: npt.ArrayLike | None = None,
    eye: npt.ArrayLike | None = None,
    dilatation: float = 1.0,
    optimize: bool = False,
    balance: bool = False,
    flat_regions: bool = True,
    quads: bool = False,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    origins: bool = True,
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    max_triangles: Count | None = None,
    max_levels: int | None = None,
    max_memory: float | str | None = "50%",
    strict: bool = False,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Refined:
    """Refines a mesh to a goal: within a proven distance of its smooth limit surface.

    Without a goal the tolerance is "0.1%". Each of tolerance, angle and pixels that is given is met everywhere; a number of
    triangles ends the refinement early, with the worst places refined first. There are never cracks.

    Parameters
    ----------
    vertices
        (n, 3) positions in the mesh's unit, or a mesh: a `Mesh`, a result, a pair, a file's name, or a mesh of trimesh, PyVista,
        meshio or Open3D.
    faces
        (m, 3) vertex numbers, counter-clockwise seen from outside; or polygons, as (m, k) or a list of lists.
    tolerance
        Greatest distance between mesh and limit surface, either way: a length, or a part of the diagonal such as "0.1%".
    within
        Greatest distance between the result and the mesh that is given, either way, written as ``tolerance``: the smoothest surface
        that is certainly so near, for scans and voxels. Closed parts keep their volume. Takes the place of ``tolerance`` and
        ``interpolate``; ``input_distance`` of the result is what is proven.
    triangles
        The best mesh with at most so many, such as 20000, "20k" or "20,000".
    angle
        Greatest angle between triangles and limit normals, in degrees.
    pixels, cameras
        Greatest distance as the cameras see it; 1 where there are cameras and no number.
    interpolate
        True lets the limit surface pass through every vertex; a length, or a part of the diagonal, that near to them, and as fair
        as it can be. Default: False, but for parts that ``creases="auto"`` finds.
    crease_angle
        Edges stay sharp where faces meet at more than this angle between their normals, in degrees.
    creases, corners
        Edges that stay sharp: pairs of vertices, or triples with a sharpness in levels; vertices that stay, likewise. "auto" in place
        of edges does what the program does by default: where nothing is tagged and the mesh looks like a part, its sharp edges stay
        sharp, and the surface is led through the vertices where that does not fold it, unless ``interpolate`` says otherwise. A
        mesh of quadrilaterals is a cage and becomes round. ``result.crease_angle`` says what was found. Default: what the mesh has
        tagged, in files, too; ``refine_file`` has the program's default.
    boundary
        "smooth"; "corners" keeps vertices in one face only; "fixed" keeps open boundaries as they are.
    concave_corners
        Corners of 180° and more between sharp edges: "divided", so that flat faces stay flat, or "as-tagged". Default: divided
        with ``crease_angle``, with ``creases="auto"`` and with boundaries that are not smooth.
    scheme
        "loop", "loop-warren", "butterfly", "catmull-clark" or "sqrt3"; default: "catmull-clark" for a mesh most of whose faces are quads
        (unless another option is for triangles), else "loop". Distances are estimated for "butterfly" and "sqrt3", and proven for
        the others. "catmull-clark" is for quads: other polygons are divided into quads first. "sqrt3" divides triangles by their
        centres, to tolerance, angle and triangles, or uniformly; it carries no channels.
    smooth_triangles
        Makes the surface rounder where a cage for "catmull-clark" has triangles: OpenSubdiv's rule of that name.
    method
        "exact"; or, with ``levels`` steps (default 3), "limit-normal" (the paper's) or "amresh" with ``angle`` (default 10), or
        "uniform", whose vertices are on the limit surface but for "sqrt3". To be compared with, over restricted quadtrees: "planarity", to ``angle`` (default 10) between triangles and limit
        normals, or to ``tolerance`` in height, at samples; "vertex-error", to ``tolerance`` between control points and their limits
        (default "0.1%"); both with at most ``triangles``. Nothing but "exact" says how far the result is from the limit surface.
    view, eye, dilatation
        Let ``angle`` depend on where the viewer looks along, or stands.
    optimize
        Collapses edges of a finer mesh as long as the goals allow: slower, with fewer triangles.
    balance
        Lets vertices leave the limit surface by up to half the local error: fewer triangles.
    flat_regions
        Whether regions in a plane are triangulated from their rims alone, and what is straight in one direction by long triangles.
    quads
        With "catmull-clark", whether triangles are paired to quads where the tolerance holds for both diagonals: ``quads`` of the
        result, which `save` writes. It takes about half more triangles.
    channels
        What is carried along, by name: `Channel`, or arrays with a row for each vertex, corner or face.
    origins
        Whether the result tells where its vertices came from, which is a quarter of its memory.
    weld
        Distance within which vertices become one: 0 for equal positions, None for none.
    repair
        Whether defects are mended (and told in ``diagnosis``) or refused.
    index_dtype
        Type of the result's vertex numbers.
    max_triangles, max_levels, max_memory
        Caps; what was reached by then is the result, and a `StoppedShort` warning says so. ``max_memory`` is in bytes, such as
        "2GB", or a part of the machine's; None for no cap.
    strict
        Raises `ToleranceNotMet` where a cap came first, and with ``within`` where triangles are turned over.
    threads
        Default: ``LIMITMESH_NUM_THREADS``, or all processors. The result is the same to the bit for any number.
    progress
        Called with a `Progress` some twenty times a second; what it raises ends the refinement and is raised again.

    Raises
    ------
    MeshError
        The arrays are no mesh; the message names the row.
    OptionError
        An option is out of range, or does not go with another.

    Examples
    --------
    >>> import limitmesh, numpy as np
    >>> vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    >>> faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    >>> smooth = limitmesh.refine(vertices, faces, tolerance=0.01)
    >>> smooth.error.certified and smooth.error.upper <= 0.01
    True
    >>> smooth.vertices.shape[1], smooth.faces.dtype
    (3, dtype('int64'))
    """
    mesh = _inputs.mesh_of(vertices, faces, creases, corners, channels)
    needs_triangles = within is not None or optimize or method not in ("exact", "uniform")
    scheme = _inputs.scheme_of(mesh, scheme, needs_quads=quads or smooth_triangles, needs_triangles=needs_triangles)  # type: ignore[assignment]
    if scheme == "sqrt3" and mesh.channels:
        names = ", ".join(map(repr, mesh.channels))
        raise OptionError(f"channels do not go with scheme='sqrt3', which carries none: {names}")
    control, goals = _options.remembered(
        _options.of_refinement,
        interpolate=interpolate,
        auto_creases=_inputs.are_found(mesh, creases),
        crease_angle=crease_angle,
        boundary=boundary,
        concave_corners=concave_corners,
        scheme=scheme,
        smooth_triangles=smooth_triangles,
        weld=weld,
        repair=repair,
        method=method,
        levels=levels,
        tolerance=tolerance,
        within=within,
        triangles=triangles,
        angle=angle,
        pixels=pixels,
        cameras=cameras,
        view=view,
        eye=eye,
        dilatation=dilatation,
        optimize=optimize,
        balance=balance,
        flat_regions=flat_regions,
        quads=quads,
        origins=origins,
        max_triangles=max_triangles,
        max_levels=max_levels,
        max_memory=max_memory,
    )
    dtype = _options.index_dtype_of(index_dtype)
    work = _options.work_of(threads, progress)
    result = Refined._of_native(_limitmesh.refine(mesh._native(), control, goals, dtype == np.int64, *work), dtype)
    _short.tell(_short.why(result, goals, strict), result, strict)
    return result


@dataclass(frozen=True)
class Estimate:
    """What a refinement would give.

    Attributes
    ----------
    triangles
        Counted where there are few, extrapolated where there are many.
    memory
        Bytes that the refinement and its result would take at most, about.
    counted
        Whether the triangles were counted.
    """

    triangles: int
    memory: int
    counted: bool


def estimate(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerance: Length | None = None,
    triangles: Count | None = None,
    angle: float | None = None,
    pixels: float | None = None,
    cameras: Camera | Iterable[Camera] | None = None,
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    smooth_triangles: bool = False,
    view: npt.ArrayLike | None = None,
    eye: npt.ArrayLike | None = None,
    dilatation: float = 1.0,
    optimize: bool = False,
    balance: bool = False,
    flat_regions: bool = True,
    weld: float | None = 0.0,
    repair: bool = True,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Estimate:
    """Predicts the triangles and the memory of `refine` with the same options, from how a coarser result grows.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> found = limitmesh.estimate("builtin:cup", tolerance="0.1%")
    >>> found.counted and found.triangles > 1000
    True
    """
    goals = _options.goals_of(
        tolerance=tolerance, triangles=triangles, angle=angle, pixels=pixels, cameras=cameras, view=view, eye=eye,
        dilatation=dilatation, optimize=optimize, balance=balance, flat_regions=flat_regions, origins=False,
    )
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, smooth_triangles=smooth_triangles, weld=weld, repair=repair,
    )
    return Estimate(*_limitmesh.estimate(native, control, goals, *_options.work_of(threads, progress)))
