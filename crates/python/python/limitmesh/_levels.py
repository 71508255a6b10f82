"""Levels of detail, and geomorphs between them."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _limitmesh, _options
from ._arrays import Floats
from ._errors import StoppedShort, ToleranceNotMet
from ._limitmesh import OptionError
from ._mesh import Channel, MeshLike
from ._options import Boundary, Camera, Length, ProgressCallback, Scheme
from ._refine import _index_dtype, _mesh_of, _refined, _short
from ._refined import AnyIntegers, ErrorBounds, Refined


@dataclass(frozen=True, eq=False)
class Level:
    """One of several meshes of a limit surface, each nested in the next: control vertices keep their numbers on all.

    Attributes
    ----------
    refined
        The mesh with all that is told of it; ``seconds`` are those of all levels. ``vertices``, ``faces``, ``normals`` and ``error``
        are its own.
    tolerance
        What it was refined to, in the mesh's unit.
    deviation
        How far a point of the limit surface is from the point of the mesh with the same place on the control mesh, at most: more than
        the distance of ``error``, and what a texture slides by as well.
    coarser, coarser_normals
        (n, 3): where its vertices are on the coarser level, and that level's normals there as they are shaded, not of unit length;
        None without ``morph``, and for the coarsest.
    coarser_deviation
        ``deviation`` while the vertices are there.
    """

    refined: Refined
    tolerance: float
    deviation: float
    coarser: Floats | None
    coarser_normals: Floats | None
    coarser_deviation: float | None
    _coarser_sides: tuple[AnyIntegers, Floats] | None
    _morphs: bool

    @property
    def vertices(self) -> Floats:
        return self.refined.vertices

    @property
    def faces(self) -> AnyIntegers:
        return self.refined.faces

    @property
    def normals(self) -> Floats:
        return self.refined.normals

    @property
    def error(self) -> ErrorBounds:
        assert self.refined.error is not None
        return self.refined.error

    @property
    def coarser_corner_normals(self) -> Floats | None:
        """(m, 3, 3) normals on the coarser level at the triangles' corners, each of its own side of sharp edges."""
        if self.coarser_normals is None or self._coarser_sides is None:
            return None
        found = self.coarser_normals[self.faces]
        corners, normals = self._coarser_sides
        found.reshape(-1, 3)[corners] = normals
        return found

    def at(self, t: float) -> Floats:
        """(n, 3) positions of the vertices at a moment of the geomorph, from 0, the coarser level's surface, to 1, this level.

        Raises
        ------
        OptionError
            The moment is not from 0 to 1, or there is no geomorph.

        Examples
        --------
        >>> import limitmesh
        >>> coarse, fine = limitmesh.levels_of_detail("builtin:torus", tolerances=["1%", "0.2%"], morph=True)
        >>> halfway = fine.at(0.5)
        >>> halfway.shape == fine.vertices.shape and fine.deviation_at(0.5) <= coarse.tolerance
        True
        """
        t = self._moment(t)
        assert self.coarser is not None
        return (1.0 - t) * self.coarser + t * self.vertices

    def deviation_at(self, t: float) -> float:
        """How far mesh and limit surface are from each other at most at a moment of the geomorph, both ways and place by place.

        >>> import limitmesh
        >>> coarse, fine = limitmesh.levels_of_detail("builtin:torus", tolerances=["1%", "0.2%"], morph=True)
        >>> fine.deviation_at(1) == fine.deviation, fine.deviation_at(0) == fine.coarser_deviation
        (True, True)
        """
        t = self._moment(t)
        assert self.coarser_deviation is not None
        return (1.0 - t) * self.coarser_deviation + t * self.deviation

    def _moment(self, t: float) -> float:
        if self.coarser is None:
            raise OptionError("this level has no geomorph: it is the coarsest, or morph=True was not asked for")
        return _options.number(t, "t", "a number from 0 to 1", lambda x: 0.0 <= x <= 1.0)

    def switching_distance(self, camera: Camera | None = None, *, pixels: float = 1.0) -> float:
        """From which distance on the level is off by no more than so many pixels, in the middle of the picture.

        Between morphing levels each place counts, ``deviation``; without geomorphs it is the distance of ``error``. Of the camera
        ``fov`` and ``height`` count; default: 45 degrees and 1080 pixels.

        >>> import limitmesh
        >>> levels = limitmesh.levels_of_detail("builtin:torus", tolerances=["1%", "0.2%"])
        >>> levels[0].switching_distance() > levels[1].switching_distance()
        True
        """
        ((*_, fov, _, height),) = _options.cameras_of([Camera((0.0, 0.0, 1.0)) if camera is None else camera])
        most = _options.number(pixels, "pixels", "a number above 0", lambda x: 0.0 < x < np.inf)
        has_proof = np.isfinite(self.error.upper) and not self._morphs
        return _limitmesh.switching_distance(self.error.upper if has_proof else self.deviation, most, height, fov)


def levels_of_detail(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerances: Iterable[Length] | None = None,
    levels: int | None = None,
    tolerance: Length | None = None,
    ratio: float | None = None,
    morph: bool = False,
    interpolate: bool | Length = False,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme = "loop",
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    max_triangles: int | None = None,
    max_memory: float | str | None = "50%",
    strict: bool = False,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> list[Level]:
    """Levels of detail of a limit surface from the coarsest to the finest, each nested in the next and within its proven tolerance.

    With ``morph`` each knows its vertices' places on the coarser level, and grows out of it within the coarser one's tolerance at
    every moment; tolerances hold place by place then.

    Parameters
    ----------
    vertices, faces
        As for `refine`.
    tolerances
        By level the greatest distance between mesh and limit surface, each below the one before: lengths, or parts of the diagonal.
    levels, tolerance, ratio
        Without ``tolerances``: so many levels (default 4), the finest within ``tolerance`` (default "0.1%"), each with ``ratio`` times
        the tolerance of the coarser one (default 0.25).
    morph
        Whether geomorphs are wanted.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, channels, weld, repair, index_dtype
        As for `refine`.
    max_triangles, max_memory
        Caps of a level. The first level that a cap ends is the last one; a `StoppedShort` warning says so.
    strict
        Raises `ToleranceNotMet` where a cap came first.
    threads, progress
        As for `refine`.

    Raises
    ------
    MeshError
        As `refine`.
    OptionError
        Tolerances that do not fall, or as `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> levels = limitmesh.levels_of_detail("builtin:cup", tolerances=["1%", "0.3%", "0.1%"])
    >>> [level.error.upper <= level.tolerance for level in levels]
    [True, True, True]
    >>> len(levels[0].faces) < len(levels[1].faces) < len(levels[2].faces)
    True
    """
    control = _options.control_of(
        interpolate=interpolate,
        crease_angle=crease_angle,
        boundary=boundary,
        concave_corners=concave_corners,
        scheme=scheme,
        weld=weld,
        repair=repair,
    )
    asked = _tolerances_of(tolerances, levels, tolerance, ratio)
    detail = {
        "tolerances": asked,
        "morph": bool(morph),
        "max_triangles": None if max_triangles is None else _options.whole(max_triangles, "max_triangles", 1),
        "max_memory": _options.memory(max_memory),
    }
    dtype = _index_dtype(index_dtype)
    native = _mesh_of(vertices, faces, channels, creases, corners)._native()
    workers, callback = _options.threads_of(threads), _options.callback_of(progress)
    told = _limitmesh.levels_of_detail(native, control, detail, dtype == np.int64, workers, callback)
    found = [Level(_refined(one.pop("refined"), dtype), _morphs=bool(morph), **one) for one in told]
    short = _short(found[-1].refined, {"triangles": None})
    if short is not None:
        short = f"level {len(found)} of {len(asked)}, counted from the coarsest: {short}"
        if strict:
            raise ToleranceNotMet(short, found)
        warnings.warn(short, StoppedShort, stacklevel=2)
    return found


def _tolerances_of(
    tolerances: Iterable[Length] | None, levels: int | None, tolerance: Length | None, ratio: float | None
) -> list[tuple[float, bool]]:
    if tolerances is not None:
        for name, value in (("levels", levels), ("tolerance", tolerance), ("ratio", ratio)):
            if value is not None:
                raise OptionError(f"{name} does not go with tolerances, which say how many levels there are, and how fine")
        if isinstance(tolerances, (str, float, int)):
            raise OptionError(f"tolerances is {tolerances!r}, expected a list from coarse to fine")
        found = [_options.extent(value, f"tolerances[{row}]") for row, value in enumerate(tolerances)]
        if not found:
            raise OptionError("tolerances is empty, expected at least one")
        return found
    count = 4 if levels is None else _options.whole(levels, "levels", 1)
    if count > 64:
        raise OptionError(f"levels is {levels!r}, expected at most 64")
    finest, is_part = _options.extent("0.1%" if tolerance is None else tolerance, "tolerance")
    own = 0.25 if ratio is None else _options.number(ratio, "ratio", "a number above 0, below 1", lambda x: 0.0 < x < 1.0)
    return [(finest / own**level, is_part) for level in reversed(range(count))]


__all__ = ["Level", "levels_of_detail"]
