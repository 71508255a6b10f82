"""Animations: one refinement for many positions of its control vertices."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _arrays, _inputs, _limitmesh, _options, _short
from ._arrays import Floats, MeshIn
from ._inputs import MeshLike
from ._limitmesh import MeshError
from ._mesh import Channel
from ._options import Boundary, Camera, Count, Length, ProgressCallback, Scheme
from ._refined import AnyIntegers, ErrorBounds, Refined
from ._shown import Shown


_Again: TypeAlias = Callable[[int], _limitmesh.Replay]
"""Prepares a replay again, on so many threads."""


class Replay:
    """Gives the vertices of a refined mesh for other positions of its control vertices: call it with these.

    Every vertex is on the true limit surface of what it is given, and the triangles stay; how far those are from that surface is
    not known, but for frames of `refine_frames`. A call takes a small part of a refinement. A pickle holds what it was made from, so that
    the first call of one that was unpickled takes a refinement more.

    Attributes
    ----------
    refined
        The refined mesh that it was prepared with.
    faces
        (m, 3): its triangles.
    """

    refined: Refined

    def __init__(self, native: _limitmesh.Replay, refined: Refined, count: int, again: _Again) -> None:
        self._native: _limitmesh.Replay | None = native
        self.refined, self._count, self._again = refined, count, again

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_native": None}

    @property
    def faces(self) -> AnyIntegers:
        return self.refined.faces

    def __call__(self, positions: npt.ArrayLike, *, threads: int | None = None) -> tuple[Floats, Floats]:
        """(n, 3) vertices and (n, 3) unit limit normals, given a row of (v, 3) ``positions`` for each control vertex.

        Raises
        ------
        MeshError
            Other than that many finite rows, or rows apart that are one vertex in the control mesh.
        """
        rows = _arrays.vertices_of(positions, "positions")
        _check(rows, self._count, "positions")
        workers = _options.threads_of(threads)
        if self._native is None:
            self._native = self._again(workers)
        return self._native.at(rows, workers)

    def __repr__(self) -> str:
        return f"Replay({self._count} control vertices, {len(self.refined.vertices)} vertices, {len(self.faces)} triangles)"


def replay(
    vertices: npt.ArrayLike | MeshLike,
    faces: Any = None,
    *,
    tolerance: Length | None = None,
    triangles: Count | None = None,
    angle: float | None = None,
    pixels: float | None = None,
    cameras: Camera | Iterable[Camera] | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    scheme: Scheme | None = None,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    max_triangles: Count | None = None,
    max_levels: int | None = None,
    max_memory: float | str | None = "50%",
    strict: bool = False,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Replay:
    """Refines a mesh once, so that the refined vertices for any other positions of its own are there in a moment.

    Parameters
    ----------
    vertices, faces
        As for `refine`: the mesh at rest, which the goals are for.
    tolerance, triangles, angle, pixels, cameras
        Goals, as for `refine`. Flat regions are divided like others, since they may bend.
    crease_angle, creases, corners, boundary, scheme, channels, weld, repair, index_dtype
        As for `refine`; the scheme is not ``"butterfly"``. Corners of 180° and more are taken as tagged.
    max_triangles, max_levels, max_memory, strict, threads, progress
        As for `refine`.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> vertices = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    >>> moving = limitmesh.replay(vertices, faces, tolerance=0.01)
    >>> moved, normals = moving([[1, 1, 2], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    >>> moved.shape == moving.refined.vertices.shape == normals.shape
    True
    """
    goals = _options.goals_of(
        tolerance=tolerance, triangles=triangles, angle=angle, pixels=pixels, cameras=cameras, flat_regions=False,
        max_triangles=max_triangles, max_levels=max_levels, max_memory=max_memory,
    )
    # Where corners are concave depends on positions, which change.
    native, control = _inputs.surface_of(
        vertices, faces, creases, corners, channels, interpolate=False, crease_angle=crease_angle, boundary=boundary,
        concave_corners="as-tagged", scheme=scheme, weld=weld, repair=repair,
    )
    dtype = _options.index_dtype_of(index_dtype)
    told, own = _limitmesh.replay(native, control, goals, dtype == np.int64, *_options.work_of(threads, progress))
    refined = Refined._of_native(told, dtype)
    _short.tell(_short.why(refined, goals), refined, strict)
    again = functools.partial(_replay_again, native, control, goals)
    return Replay(own, refined, len(native["vertices"]), again)


def _replay_again(native: MeshIn, control: dict[str, Any], goals: dict[str, Any], threads: int) -> _limitmesh.Replay:
    return _limitmesh.replay(native, control, goals, False, threads, None)[1]


@dataclass(frozen=True, eq=False, repr=False)
class RefinedFrames(Shown):
    """An animation refined with the same triangles.

    Attributes
    ----------
    refined
        The refined mesh with the vertices of the first frame, and all that is told of it; ``stop`` is about all frames.
    errors
        By frame, how near the triangles are to its limit surface.
    replay
        Gives the vertices for any further positions, of which nothing is proven.
    frames
        (k, v, 3) the control positions that it was made for.
    """

    refined: Refined
    errors: tuple[ErrorBounds, ...]
    replay: Replay
    frames: Floats

    @property
    def faces(self) -> AnyIntegers:
        """(m, 3) vertex numbers, the same for all frames."""
        return self.refined.faces

    # Made when they are asked for: of a long animation they may be too much to be there at once.

    @functools.cached_property
    def vertices(self) -> Floats:
        """(k, n, 3) positions by frame, on its limit surface."""
        return self._all[0]

    @functools.cached_property
    def normals(self) -> Floats:
        """(k, n, 3) unit limit normals by frame."""
        return self._all[1]

    @functools.cached_property
    def _all(self) -> tuple[Floats, Floats]:
        shape = (len(self.frames), len(self.refined.vertices), 3)
        vertices, normals = np.empty(shape), np.empty(shape)
        for frame, positions in enumerate(self.frames):
            vertices[frame], normals[frame] = self.replay(positions)
        return vertices, normals


def refine_frames(
    frames: npt.ArrayLike | Sequence[npt.ArrayLike],
    faces: Any,
    *,
    tolerance: Length | None = None,
    angle: float | None = None,
    pixels: float | None = None,
    cameras: Camera | Iterable[Camera] | None = None,
    crease_angle: float | None = None,
    creases: Any = None,
    corners: Any = None,
    boundary: Boundary = "smooth",
    scheme: Scheme | None = None,
    channels: Mapping[str, Channel | npt.ArrayLike] | None = None,
    weld: float | None = 0.0,
    repair: bool = True,
    index_dtype: npt.DTypeLike = np.int64,
    max_triangles: Count | None = None,
    max_levels: int | None = None,
    max_memory: float | str | None = "50%",
    strict: bool = False,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> RefinedFrames:
    """Refines the frames of an animation with the same triangles, each frame within the goals, with its own proven distance.

    Parameters
    ----------
    frames
        (k, v, 3), or a list of (v, 3): positions of the control vertices by frame, in the mesh's unit.
    faces
        As for `refine`: the same for all frames.
    tolerance, angle, pixels, cameras
        Goals, as for `refine`; parts of the diagonal are of the first frame's. Flat regions are divided like others.
    crease_angle, creases, corners, boundary, scheme, channels, weld, repair, index_dtype
        As for `refine`, all by the first frame; the scheme is not ``"butterfly"``. What is welded there must stay
        together. Corners of 180° and more are taken as tagged.
    max_triangles, max_memory
        Caps; a frame that takes more is an `OptionError`.
    max_levels, strict, threads, progress
        As for `refine`.

    Raises
    ------
    MeshError
        Frames that are none, or that do not share vertices; the message names frame and row. Else as `refine`.
    OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh, numpy as np
    >>> rest = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    >>> faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    >>> found = limitmesh.refine_frames([rest, rest * [1, 1, 2], rest * [1, 1, 3]], faces, tolerance=0.02)
    >>> found.vertices.shape[0], [error.upper <= 0.02 for error in found.errors]
    (3, [True, True, True])
    """
    goals = _options.goals_of(
        tolerance=tolerance, angle=angle, pixels=pixels, cameras=cameras, flat_regions=False,
        max_triangles=max_triangles, max_levels=max_levels, max_memory=max_memory,
    )
    rows = _frames_of(frames)
    # Where corners are concave depends on positions, which change.
    native, control = _inputs.surface_of(
        rows[0], faces, creases, corners, channels, interpolate=False, crease_angle=crease_angle, boundary=boundary,
        concave_corners="as-tagged", scheme=scheme, weld=weld, repair=repair,
    )
    dtype = _options.index_dtype_of(index_dtype)
    told, errors, own = _limitmesh.refine_frames(
        native, rows.reshape(-1, 3), control, goals, dtype == np.int64, *_options.work_of(threads, progress)
    )
    refined = Refined._of_native(told, dtype)
    _short.tell(_short.why(refined, goals), refined, strict)
    bounds = tuple(ErrorBounds(*error) for error in errors)
    again = functools.partial(_refine_again, native, rows, control, goals)
    return RefinedFrames(refined, bounds, Replay(own, refined, rows.shape[1], again), rows)


def _refine_again(
    native: MeshIn, rows: Floats, control: dict[str, Any], goals: dict[str, Any], threads: int
) -> _limitmesh.Replay:
    return _limitmesh.refine_frames(native, rows.reshape(-1, 3), control, goals, False, threads, None)[2]


def _frames_of(frames: Any) -> Floats:
    """(k, v, 3) finite positions, one frame at least."""
    try:
        each = [_arrays.vertices_of(frame, f"frames[{row}]") for row, frame in enumerate(frames)]
    except TypeError:
        raise MeshError(f"frames is {type(frames).__name__}, expected (k, v, 3), or a list of (v, 3)") from None
    if not each:
        raise MeshError("there are no frames, expected at least one")
    for frame, rows in enumerate(each):
        _check(rows, len(each[0]), f"frames[{frame}]")
    return np.stack(each)


def _check(rows: Floats, count: int, name: str) -> None:
    if len(rows) != count:
        raise MeshError(f"{name} has {len(rows)} rows, expected {count}: one for each control vertex")
    _arrays.check_finite(rows, name, MeshError)


__all__ = ["RefinedFrames", "Replay", "refine_frames", "replay"]
