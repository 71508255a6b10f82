"""Results of refinement."""

from __future__ import annotations

import base64
import functools
import html
import os
import pathlib
import tempfile
import webbrowser
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _limitmesh
from ._arrays import Floats
from ._limitmesh import OptionError
from ._mesh import Channel, told_channels
from ._options import threads_of
from ._outgoing import Outgoing, restored
from ._plot import plot
from ._shown import Shown
from ._write import write

_MOST_SHOWN = 100_000
"""Triangles that a notebook holds: some megabytes."""

AnyIntegers = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True)
class ErrorBounds:
    """An interval for the symmetric Hausdorff distance between a mesh and its limit surface, in the mesh's unit.

    Attributes
    ----------
    lower
        Some point of the one is so far from the other.
    upper
        A distance that is not exceeded where ``certified`` holds; infinite where none was asked for and none near ``lower``
        could be proven. Otherwise an estimate.
    certified
        Whether ``upper`` is proven, as it is for Loop's schemes.
    at
        That point: one of the mesh, or of the limit surface, give or take an eighth of ``lower``.
    """

    lower: float
    upper: float
    certified: bool
    at: tuple[float, float, float]


@dataclass(frozen=True)
class Finding:
    """How often something was found in the input, and the rows of the first few."""

    count: int
    first: tuple[int, ...]


@dataclass(frozen=True)
class Diagnosis:
    """What was found in a mesh and mended before it was used.

    Attributes
    ----------
    clean
        Whether nothing had to be mended; polygons and equal positions are no defects.
    repairs, preparations
        A line for each defect, and for each other finding, with what was done about it.
    findings
        All of them by name, such as "repeated_faces".
    """

    clean: bool
    repairs: tuple[str, ...]
    preparations: tuple[str, ...]
    findings: Mapping[str, Finding]

    @staticmethod
    def _of_native(told: Mapping[str, Any] | None) -> Diagnosis:
        if told is None:
            return Diagnosis(True, (), (), dict(_NOTHING))
        findings = {name: Finding(count, first) for name, (count, first) in told["findings"].items()}
        return Diagnosis(told["clean"], told["repairs"], told["preparations"], {**_NOTHING, **findings})


_NOTHING = dict.fromkeys(_limitmesh.FINDINGS, Finding(0, ()))


def _of_vertices(channel: Channel, sources: AnyIntegers) -> Channel:
    """A channel where vertices stand for others, which they are made of."""
    if channel.domain != "vertex":
        return channel
    rows = sources if channel.indices is None else channel.indices[sources]
    return replace(channel, indices=rows.astype(np.int64))


@dataclass(frozen=True, eq=False, repr=False)
class Refined:
    """A refined mesh, how near it is to its limit surface, and where it came from.

    Attributes
    ----------
    vertices
        (n, 3) positions, all on the limit surface unless ``balance`` or a method other than "exact" and "uniform" was asked for. Those
        of the control mesh come first.
    faces
        (m, 3) vertex numbers, counter-clockwise seen from outside, of the type ``index_dtype``.
    quads
        (k, 4) vertex numbers of the pairs of triangles that make quads, if ``quads`` was asked for.
    quad_corners
        (k, 4) which corners of the triangles these are, numbered over all rows of ``faces``: to look up what corners carry.
    triangles
        (r, 3) vertex numbers of the triangles that are in no quad: with ``quads`` the faces of a file.
    normals
        (n, 3) unit limit normals of the vertices; at sharp edges an average of the sides, zero where there is none.
    parent_face
        (m,) the row of ``faces`` of the input that each triangle came from, with ``optimize`` one of those that it reaches over; None
        for stepwise methods with ``origins=False``.
    vertex_face
        (n,) a row of ``faces`` of the input on which each vertex was; None with ``origins=False``, as the next two are.
    barycentric
        (n, 3) where on it: weights of the vertices ``barycentric_vertices``. None also where a step of Catmull–Clark first divided polygons
        into quads: three vertices do not span the places on a pentagon.
    barycentric_vertices
        (n, 3) rows of ``vertices`` of the input: those of the triangle that ``barycentric`` is about.
    channels
        What was carried along, by name; with corners as domain, so that seams stay seams.
    error
        How near the mesh is to the limit surface, of √3-subdivision an estimate; None for methods that do not say.
    input_distance
        The distance between the mesh and the one that was given, either way, with ``within``: some point is at least so far off, and
        none farther than that, proven; else None.
    stop
        Why it ended: "met"; "input-distance" where the mesh is farther from the one that was given than ``within``; "triangles" where their number was a goal; "triangle-cap", "level-cap", "memory-cap" or "rounding"
        where that was before the goals; "cones" where triangles stay outside the angle that no division brings nearer;
        "levels" or "satisfied" for the stepwise methods.
    diagnosis
        What was found in the input and mended.
    levels
        Levels of the most divided part, or steps.
    pixels
        The distance as the cameras see it, at most, in pixels.
    open_cones
        Triangles outside the angle that was asked for.
    unfolded
        Flat regions that the scheme folds over, in whose place stands what their rim encloses.
    inverted
        Triangles that are turned over against the limit surface: it folds there.
    crease_angle
        The angle beyond which edges are sharp, in degrees: as asked for, or as ``creases="auto"`` found it; None where there is none.
    interpolation
        How control points were found for a surface through the vertices, if that was asked for, or found to suit a part.
    seconds
        Time that the library took, without the binding.

    Examples
    --------
    >>> import limitmesh
    >>> cup = limitmesh.refine("builtin:cup", tolerance="0.1%")
    >>> cup
    Refined(... vertices, ... triangles, within ... certified, met)
    >>> cup.corner_normals.shape == (*cup.faces.shape, 3)
    True
    """

    vertices: Floats
    faces: AnyIntegers
    normals: Floats
    channels: Mapping[str, Channel]
    error: ErrorBounds | None
    input_distance: tuple[float, float] | None
    stop: str
    diagnosis: Diagnosis
    levels: int
    pixels: float | None
    open_cones: int
    unfolded: int
    inverted: int | None
    crease_angle: float | None
    interpolation: Mapping[str, Any] | None
    seconds: float
    _quads: AnyIntegers
    _sides: tuple[AnyIntegers, Floats]
    _parents: AnyIntegers | None
    _origins: _limitmesh.Origins | None

    @staticmethod
    def _of_native(told: dict[str, Any], dtype: np.dtype[Any]) -> Refined:
        told["faces"] = told["faces"].astype(dtype, copy=False)
        if told["error"] is not None:
            told["error"] = ErrorBounds(*told["error"])
        told["channels"] = told_channels(told["channels"], triangles=True)
        told["diagnosis"] = Diagnosis._of_native(told["diagnosis"])
        return Refined(**told)

    # These are made when they are asked for: for most who refine they would be the greater part of what is handed over.

    @property
    def quads(self) -> AnyIntegers:
        return self.faces.reshape(-1)[self.quad_corners]

    @property
    def quad_corners(self) -> AnyIntegers:
        corners = self._quads.astype(np.int64)
        around = [_after(corners[:, 1], 1), _after(corners[:, 1], 2), _after(corners[:, 0], 1), _after(corners[:, 0], 2)]
        return np.stack(around, axis=1)

    @property
    def triangles(self) -> AnyIntegers:
        return np.delete(self.faces, self._quads.reshape(-1) // 3, axis=0)

    @functools.cached_property
    def parent_face(self) -> AnyIntegers | None:
        if self._parents is None:
            return None
        # Of uniform refinement the triangles of a face stand together.
        each = len(self.faces) // max(len(self._parents), 1)
        parents = self._parents if each == 1 else self._parents.repeat(each)
        return parents.astype(self.faces.dtype, copy=False)

    @property
    def vertex_face(self) -> AnyIntegers | None:
        return self._places[0]

    @property
    def barycentric(self) -> Floats | None:
        return self._places[2] if self._places[3] else None

    @property
    def barycentric_vertices(self) -> AnyIntegers | None:
        return self._places[1] if self._places[3] else None

    @functools.cached_property
    def _places(self) -> tuple[AnyIntegers | None, AnyIntegers | None, Floats | None, bool]:
        if self._origins is None:
            return None, None, None, False
        faces, vertices, weights, is_exact = self._origins.rows()
        dtype = self.faces.dtype
        return faces.astype(dtype, copy=False), vertices.astype(dtype, copy=False), weights, is_exact

    @property
    def _nearest(self) -> AnyIntegers | None:
        """By vertex, the row of ``vertices`` of the input with most weight."""
        _, vertices, weights, _ = self._places
        if vertices is None or weights is None:
            return None
        return np.take_along_axis(vertices, weights.argmax(axis=1)[:, None], axis=1)[:, 0]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_places": self._places, "_origins": None}

    @property
    def corner_normals(self) -> Floats:
        """(m, 3, 3) unit limit normals of the triangles' corners, each of its own side of sharp edges."""
        return by_corner(self.normals, self.faces, self._sides)

    @property
    def met(self) -> bool:
        """Whether what was asked for was reached, rather than a cap before it."""
        return self.stop not in _SHORT

    def at_vertices(self, name: str) -> Floats:
        """(n, width) values of a channel by vertex.

        Raises
        ------
        OptionError
            There is no such channel, or it has a seam: vertices with several values. `split` takes these apart.

        Examples
        --------
        >>> import limitmesh
        >>> cup = limitmesh.load("builtin:cup")
        >>> fine = limitmesh.refine(cup, channels={"height": cup.vertices[:, 1]})
        >>> fine.at_vertices("height").shape == (len(fine.vertices), 1)
        True
        """
        channel = self._channel(name)
        rows = self._rows(channel)
        found = np.zeros(len(self.vertices), dtype=np.int64)
        flat = self.faces.reshape(-1)
        found[flat] = rows
        torn = found[flat] != rows
        if torn.any() and not np.array_equal(channel.values[found[flat]], channel.values[rows]):
            raise OptionError(f"channel {name!r} has several values at vertex {int(flat[torn][0])}; split() takes these apart")
        return channel.values[found]

    def at_corners(self, name: str) -> Floats:
        """(m, 3, width) values of a channel by corner of the triangles.

        >>> import limitmesh
        >>> cup = limitmesh.load("builtin:cup")
        >>> fine = limitmesh.refine(cup, channels={"height": cup.vertices[:, 1]})
        >>> fine.at_corners("height").shape == (*fine.faces.shape, 1)
        True
        """
        channel = self._channel(name)
        return channel.values[self._rows(channel)].reshape(*self.faces.shape, -1)

    def _channel(self, name: str) -> Channel:
        try:
            return self.channels[name]
        except KeyError:
            raise OptionError(f"there is no channel {name!r}; there are: {', '.join(self.channels) or 'none'}") from None

    def _rows(self, channel: Channel) -> AnyIntegers:
        assert channel.indices is not None
        return np.repeat(channel.indices, 3) if channel.domain == "face" else channel.indices.reshape(-1)

    def split(self, *names: str, normals: bool = True) -> Split:
        """The mesh with a vertex for each value at it: as graphics cards and most libraries want it.

        Parameters
        ----------
        names
            The channels whose values are told by vertex; all channels of corners without names.
        normals
            Whether vertices on sharp edges stand once for each side, too.

        Examples
        --------
        >>> import limitmesh
        >>> box = limitmesh.refine("builtin:cube", crease_angle=30)
        >>> split = box.split()
        >>> len(split.vertices) > len(box.vertices)
        True
        """
        if not names:
            names = tuple(name for name, channel in self.channels.items() if channel.domain == "corner")
        flat = self.faces.reshape(-1).astype(np.int64)
        keys = flat
        for name in names:
            keys = _together(keys, _ranks(self._channel(name).values)[self._rows(self.channels[name])])
        if normals and len(self._sides[0]):
            side = np.zeros(len(flat), dtype=np.int64)
            side[self._sides[0]] = 1 + _ranks(np.round(self._sides[1], 6))
            keys = _together(keys, side)
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
        # By number of the vertex, so that undivided ones keep their order.
        values = {name: self._channel(name).values[self._rows(self.channels[name])][first] for name in names}
        return Split(
            vertices=self.vertices[flat[first]],
            faces=inverse.reshape(-1, 3).astype(self.faces.dtype),
            normals=(self.corner_normals if normals else self.normals[self.faces]).reshape(-1, 3)[first],
            values=values,
            sources=flat[first].astype(self.faces.dtype),
        )

    def save(self, path: str | os.PathLike[str], *, ascii: bool = False) -> None:
        """Writes a file, whole or not at all: OBJ, PLY, STL, OFF or glTF, by its extension.

        Limit normals and channels that the format has a place for are written, too: OBJ and glTF have one for each side of sharp edges; for glTF assets see `refine_file`.

        Raises
        ------
        ReadError
            The file cannot be written.

        Examples
        --------
        >>> import limitmesh, os, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "cup.ply")
        ...     limitmesh.refine("builtin:cup").save(path)
        ...     len(limitmesh.load(path).faces) > 1000
        True
        """
        corners, of_sides = self._sides
        if not len(corners):
            write(path, self.vertices, self.faces, self.normals, self.channels, quads=self._quads, ascii=ascii)
        elif os.fspath(path).lower().endswith((".glb", ".gltf")):
            # Their vertices have one normal each: those on sharp edges stand once for each side.
            split = self.split()
            channels = {name: _of_vertices(channel, split.sources) for name, channel in self.channels.items()}
            write(path, split.vertices, split.faces, split.normals, channels, ascii=ascii)
        else:
            rows = self.faces.astype(np.uint32).reshape(-1)
            rows[corners] = len(self.normals) + np.arange(len(corners), dtype=np.uint32)
            normals = np.concatenate([self.normals, of_sides])
            of_corners = rows.reshape(-1, 3)
            write(path, self.vertices, self.faces, normals, self.channels, normals_of_corners=of_corners, quads=self._quads, ascii=ascii)

    def __repr__(self) -> str:
        error = ""
        if self.error is not None and np.isfinite(self.error.upper):
            error = f", within {self.error.upper:.4g} {'certified' if self.error.certified else 'estimated'}"
        return f"Refined({len(self.vertices)} vertices, {len(self.faces)} triangles{error}, {self.stop})"

    def _picture(self, width: int, height: int) -> bytes:
        return _limitmesh.picture(
            np.ascontiguousarray(self.vertices),
            np.ascontiguousarray(self.faces, dtype=np.uint32),
            None,
            width,
            height,
            len(self.faces) <= 50_000,
            threads_of(None),
        )

    def page(self, name: str = "mesh") -> str:
        """A page that shows the mesh in a browser: HTML that needs nothing else, neither this library nor a network.

        Parameters
        ----------
        name
            What the page calls the mesh.

        Examples
        --------
        >>> import limitmesh
        >>> limitmesh.refine("builtin:cup").page("cup").startswith("<!doctype html>")
        True
        """
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mesh.glb")
            self.save(path)
            with open(path, "rb") as file:
                glb = file.read()
        bounds = (None, None, False) if self.error is None else (self.error.lower, self.error.upper, self.error.certified)
        lower, upper, certified = (None if own is not None and not np.isfinite(own) else own for own in bounds)
        diagonal = float(np.linalg.norm(np.ptp(self.vertices, axis=0))) if len(self.vertices) else 1.0
        report = (len(self.faces), len(self.vertices), lower, upper, bool(certified), self.seconds)
        return _limitmesh.page(name, glb, self._picture(800, 600), diagonal, report)

    def view(self, name: str = "mesh") -> None:
        """Opens `page` in the browser."""
        file, path = tempfile.mkstemp(prefix="limitmesh-", suffix=".html")
        with open(file, "w", encoding="utf-8") as page:
            page.write(self.page(name))
        webbrowser.open(pathlib.Path(path).as_uri())

    def _repr_html_(self) -> str:
        shown = ""
        if 0 < len(self.faces) <= _MOST_SHOWN:
            page = html.escape(self.page())
            shown = f'<iframe title="the mesh" width="100%" height="480" style="border:0" srcdoc="{page}"></iframe>'
        elif 0 < len(self.faces) <= 2_000_000:
            png = base64.b64encode(self._picture(320, 240)).decode("ascii")
            shown = f'<img alt="the mesh" width="320" height="240" src="data:image/png;base64,{png}"><p>view() opens it in the browser</p>'
        rows = [("triangles", f"{len(self.faces):,}"), ("vertices", f"{len(self.vertices):,}"), ("ended", self.stop)]
        if self.error is not None:
            certain = "certainly within" if self.error.certified else "within, estimated,"
            rows.append(("distance", f"{certain} {self.error.upper:.4g}, at least {self.error.lower:.4g}"))
        if self.channels:
            rows.append(("carries", ", ".join(map(html.escape, self.channels))))
        body = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
        return f"<div>{shown}<table>{body}</table></div>"

    def plot(self, *, backend: str | None = None, show: bool = True, **options: Any) -> Any:
        """Draws the mesh with PyVista, or with Matplotlib where that is not installed.

        Parameters
        ----------
        backend
            "pyvista" or "matplotlib".
        show
            Whether it is shown at once; else what the library draws into is returned, a plotter or axes.
        options
            For ``pyvista.Plotter.add_mesh``, or ``Axes.plot_trisurf``.
        """
        return plot((self.vertices, self.faces), self._outgoing, backend=backend, show=show, options=options)

    def _outgoing(self, *, sides: bool = True) -> Outgoing:
        """With a vertex for each side of sharp edges, or without; then there are no normals if any edge is sharp."""
        split = self.split(normals=sides)
        has_normals = sides or not len(self._sides[0])
        faces = {name: channel for name, channel in self.channels.items() if channel.domain == "face"}
        return Outgoing(
            split.vertices,
            split.faces,
            split.normals if has_normals else None,
            {name: restored(value, self.channels[name]) for name, value in split.values.items()},
            {name: restored(channel[slice(None)], channel) for name, channel in faces.items()},
            frozenset(name for name, channel in self.channels.items() if channel.semantic == "texture"),
            self.parent_face,
            split.sources,
        )


def _ranks(rows: Floats) -> npt.NDArray[np.int64]:
    """By row its place among the different rows, in their order."""
    order = np.lexsort(rows.T[::-1])
    ranks = np.zeros(len(rows), dtype=np.int64)
    ranks[order[1:]] = np.cumsum((rows[order[1:]] != rows[order[:-1]]).any(axis=1))
    return ranks


def _together(keys: npt.NDArray[np.int64], more: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """One key for both, in the order of pairs."""
    # No more than there are keys, so that their product can be held.
    places = np.unique(keys, return_inverse=True)[1]
    return np.asarray(places * (more.max(initial=0) + 1) + more, dtype=np.int64)


def _after(corners: AnyIntegers, steps: int) -> AnyIntegers:
    """Corners so many steps farther around their triangles."""
    return corners // 3 * 3 + (corners % 3 + steps) % 3


def by_corner(normals: Floats, faces: AnyIntegers, sides: tuple[AnyIntegers, Floats]) -> Floats:
    """(m, 3, 3) normals of corners: those of their vertices, but for the corners that have their own."""
    found = normals[faces]
    corners, own = sides
    found.reshape(-1, 3)[corners] = own
    return found


_SHORT = ("triangle-cap", "level-cap", "memory-cap", "rounding", "input-distance")


@dataclass(frozen=True, eq=False, repr=False)
class Split(Shown):
    """A mesh whose vertices have one value and one normal each.

    Attributes
    ----------
    vertices, faces, normals
        As of `Refined`; vertices stand as often as they have values.
    values
        (n, width) by channel.
    sources
        (n,) the vertex that each was.
    """

    vertices: Floats
    faces: AnyIntegers
    normals: Floats
    values: Mapping[str, Floats]
    sources: AnyIntegers
