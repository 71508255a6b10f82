"""A level of detail, and its geomorph."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import _limitmesh, _options
from ._arrays import Floats
from ._limitmesh import OptionError
from ._options import Camera
from ._refined import AnyIntegers, ErrorBounds, Refined, by_corner
from ._shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Level(Shown):
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
        return by_corner(self.coarser_normals, self.faces, self._coarser_sides)

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
        most = _options.positive(pixels, "pixels")
        has_proof = np.isfinite(self.error.upper) and not self._morphs
        return _limitmesh.switching_distance(self.error.upper if has_proof else self.deviation, most, height, fov)
