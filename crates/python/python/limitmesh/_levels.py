"""Levels of detail of one limit surface, nested in each other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _inputs, _limitmesh, _options, _short
from ._inputs import MeshLike
from ._level import Level
from ._limitmesh import OptionError
from ._mesh import Channel
from ._options import Boundary, Count, Length, ProgressCallback, Scheme
from ._refined import Refined


def levels_of_detail(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerances: Iterable[Length] | None = None,
    levels: int | None = None,
    tolerance: Length | None = None,
    ratio: float | None = None,
    morph: bool = False,
    interpolate: bool | Length | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    smooth_triangles: bool = False,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    max_triangles: Count | None = None,
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
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, smooth_triangles, channels, weld, repair, index_dtype
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
    asked = _tolerances_of(tolerances, levels, tolerance, ratio)
    detail = {
        "tolerances": asked,
        "morph": bool(morph),
        "max_triangles": None if max_triangles is None else _options.whole(max_triangles, "max_triangles", 1),
        "max_memory": _options.memory(max_memory),
    }
    dtype = _options.index_dtype_of(index_dtype)
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners, channels,
        interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
        scheme=scheme, smooth_triangles=smooth_triangles, weld=weld, repair=repair,
    )
    told = _limitmesh.levels_of_detail(
        native, control, detail, dtype == np.int64, *_options.work_of(threads, progress)
    )
    found = [Level(Refined._of_native(one.pop("refined"), dtype), _morphs=bool(morph), **one) for one in told]
    short = _short.why(found[-1].refined, {"triangles": None})
    if short is not None:
        short = f"level {len(found)} of {len(asked)}, counted from the coarsest: {short}"
    _short.tell(short, found, strict)
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


__all__ = ["levels_of_detail"]
