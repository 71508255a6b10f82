"""Triangles that follow a demand: a front that is refined and coarsened, of which only what differs is touched."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _inputs, _limitmesh, _options
from ._arrays import Floats, Integers
from ._inputs import MeshLike
from ._limitmesh import OptionError
from ._options import Boundary, Camera, Count, Length, ProgressCallback, Scheme
from ._shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Changes(Shown):
    """What an update changed in a front's ``vertices`` and ``faces``: rows that are not named are as they were.

    Attributes
    ----------
    vertices, faces
        (a,) and (b,): the rows that are new or other than before, ascending. There may be fewer rows than before: those beyond the
        end are gone.
    divided, merged
        How many nodes were divided in four, and how many were put together again.
    """

    vertices: Integers
    faces: Integers
    divided: int
    merged: int


class Front:
    """Triangles that stand for a mesh's limit surface, brought from one demand to the next: for viewers and sliders.

    What it is depends on the demand alone, but for the order of its rows. It begins with the control mesh's own triangles, their
    corners on the limit surface. An update that ends before its time, by Ctrl-C or by its ``progress``, leaves all as it was here, or,
    where it was done already, as it is then; the next one goes on from where that was, to the same mesh as a fresh front's. It may name all rows
    as changed, as it does after a fork. One that was pickled is as it was, and its next update names all rows as changed.

    Parameters
    ----------
    vertices, faces
        The control mesh, as for `refine`.
    interpolate, crease_angle, creases, corners, boundary, concave_corners, scheme, smooth_triangles, weld, repair
        What the limit surface is, as for `refine`; distances are proven for ``"loop"`` and ``"loop-warren"``.
    threads, progress
        As for `refine`; the threads are those of all updates, ``progress`` is about the beginning.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> front = limitmesh.Front("builtin:torus")
    >>> changes = front.update(tolerance="0.2%")
    >>> fine = len(front.faces)
    >>> changes = front.update(tolerance="1%")
    >>> len(front.faces) < fine, changes.merged > 0, front.certified
    (True, True, True)
    """

    def __init__(
        self,
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
    ) -> None:
        native, control = _inputs.surface_of(
            vertices, faces, creases, corners,
            interpolate=interpolate, crease_angle=crease_angle, boundary=boundary, concave_corners=concave_corners,
            scheme=scheme, smooth_triangles=smooth_triangles, weld=weld, repair=repair,
        )
        native["channels"] = []
        workers, callback = _options.work_of(threads, progress)
        self._source = (native, control, workers)
        self._native: _limitmesh.Front | None = _limitmesh.Front(*self._source, callback)
        self._busy = threading.Lock()
        self._vertices: Floats = np.zeros((0, 3))
        self._faces: Integers = np.zeros((0, 3), dtype=np.int64)
        # Whether the arrays here are what the last update left.
        self._is_told = False
        self._update(None, callback)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_native": None, "_busy": None, "_is_told": False}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, _busy=threading.Lock())

    def update(
        self,
        *,
        tolerance: Length | None = None,
        pixels: float | None = None,
        cameras: Camera | Iterable[Camera] | None = None,
        triangles: Count | None = None,
        max_levels: int | None = None,
        progress: ProgressCallback | None = None,
    ) -> Changes:
        """Brings the front to another demand.

        Parameters
        ----------
        tolerance
            Greatest distance between mesh and limit surface, either way: a length from 0 on, or a part of the diagonal.
        pixels, cameras
            Or the greatest distance as the cameras see it; 1 where there are cameras and no number. What none of them sees is left
            coarse.
        triangles
            At most so many, as near as they allow, and never fewer than the control mesh has; ten million where nothing is said, at
            some 500 bytes each.
        max_levels
            No triangles of more levels below a control face; 30 at most.
        progress
            As for `refine`.

        Raises
        ------
        OptionError
            Nothing is asked for, or what makes no sense.
        RuntimeError
            Another thread is updating it, or this is called by its own ``progress``.

        Examples
        --------
        >>> import limitmesh
        >>> front = limitmesh.Front("builtin:head")
        >>> seen = front.update(cameras=limitmesh.Camera(eye=(0, 0, 5)), pixels=2)
        >>> front.pixels <= 2
        True
        """
        pixels, looking = _options.seen_by(pixels, cameras)
        if pixels is not None and not looking:
            raise OptionError("pixels is what cameras see; it needs cameras")
        if pixels is not None and tolerance is not None:
            raise OptionError("tolerance and pixels: a front keeps one of them")
        if tolerance is None and pixels is None and triangles is None:
            raise OptionError("nothing is asked for: tolerance, pixels with cameras, or triangles")
        demand = {
            "tolerance": None if tolerance is None else _options.extent(tolerance, "tolerance", zero=True),
            "pixels": None if pixels is None else _options.positive(pixels, "pixels"),
            "cameras": looking,
            "triangles": None if triangles is None else _options.whole(triangles, "triangles", 1),
            "max_levels": None if max_levels is None else _options.whole(max_levels, "max_levels", 0),
        }
        return self._update(demand, _options.callback_of(progress))

    def _update(self, demand: dict[str, Any] | None, callback: Any) -> Changes:
        if not self._busy.acquire(blocking=False):
            raise RuntimeError("another thread, or this update's own progress function, updates the front; each thread needs one of its own")
        try:
            return self._updated(demand, callback)
        finally:
            self._busy.release()

    def _updated(self, demand: dict[str, Any] | None, callback: Any) -> Changes:
        is_told, self._is_told = self._is_told, False
        if self._native is None:
            self._native = _limitmesh.Front(*self._source, callback)
        try:
            told = self._native.update(demand, callback, is_told)
        except OptionError:
            # Nothing was done.
            self._is_told = is_told
            raise
        try:
            changes = self._take(told)
        except KeyboardInterrupt:
            # What is done is done: rows of one update among those of another are no mesh.
            self._take(told)
            self._is_told = True
            raise
        self._is_told = True
        return changes

    def _take(self, told: tuple[Any, ...]) -> Changes:
        count, at, positions, triangles, slots, corners, numbers = told
        self._vertices, self._faces = _resized(self._vertices, count), _resized(self._faces, triangles)
        self._vertices[at], self._faces[slots] = positions, corners
        self._shown_vertices: Floats | None = None
        self._shown_faces: Integers | None = None
        divided, merged, *rest = numbers
        self._numbers: tuple[float, bool, float | None, int] = tuple(rest)
        return Changes(at.astype(np.int64), slots.astype(np.int64), divided, merged)

    # Copies, made when they are asked for: what somebody holds does not change with the next update.

    @property
    def vertices(self) -> Floats:
        """(n, 3) positions, on the limit surface: the control mesh's come first, some may be of no triangle."""
        if self._shown_vertices is None:
            self._shown_vertices = self._vertices.copy()
        return self._shown_vertices

    @property
    def faces(self) -> Integers:
        """(m, 3) vertex numbers, counter-clockwise seen from outside, in no order."""
        if self._shown_faces is None:
            self._shown_faces = self._faces.copy()
        return self._shown_faces

    @property
    def bound(self) -> float:
        """How far mesh and limit surface are from each other at most, both ways, in the mesh's unit."""
        return self._numbers[0]

    @property
    def certified(self) -> bool:
        """Whether ``bound`` is proven, as it is for Loop's schemes."""
        return self._numbers[1]

    @property
    def pixels(self) -> float | None:
        """That distance as the cameras see it, at most; None where there are none."""
        return self._numbers[2]

    @property
    def levels(self) -> int:
        """Levels of the finest triangle below its control face."""
        return self._numbers[3]

    def __repr__(self) -> str:
        certain = "certified" if self.certified else "estimated"
        return f"Front({len(self._faces)} triangles, within {self.bound:.4g} {certain})"


def _resized(rows: Any, count: int) -> Any:
    """The first so many rows, with room for more where there are fewer."""
    if count <= len(rows):
        return rows[:count]
    found = np.empty((count, 3), dtype=rows.dtype)
    found[: len(rows)] = rows
    return found


__all__ = ["Changes", "Front"]
