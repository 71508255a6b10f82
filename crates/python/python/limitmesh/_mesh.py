"""Meshes and what they carry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._arrays import Floats, MeshIn
from ._limitmesh import OptionError
from ._shown import Shown, shown

Domain: TypeAlias = Literal["vertex", "corner", "face"]
Semantic: TypeAlias = Literal["texture", "colour", "skin-weight", "displacement", "label", "other"]
Interpolation: TypeAlias = Literal[
    "linear",
    "nearest",
    "smooth-none",
    "smooth-corners-only",
    "smooth-corners-plus1",
    "smooth-corners-plus2",
    "smooth-boundaries",
]
Storage: TypeAlias = Literal["double", "single", "byte", "int8", "uint8", "int16", "uint16", "int32", "uint32"]

_USUAL: dict[str, Interpolation] = {
    "texture": "smooth-boundaries",
    "skin-weight": "smooth-none",
    "displacement": "smooth-none",
    "colour": "linear",
    "other": "linear",
    "label": "nearest",
}


@dataclass(frozen=True, eq=False, repr=False)
class Channel(Shown):
    """What a mesh carries: a table of values, and for each vertex, corner or face which of them it has.

    Two corners at one vertex that name different rows have a *seam* between them.

    Parameters
    ----------
    values
        (k, width) numbers, or (k,) for one each.
    indices
        By vertex (n,), corner (m, 3) or face (m,) the row of its value; without them each has the row of its own number.
    domain
        "vertex", "corner" or "face".
    semantic
        What the values mean: "texture" coordinates, "colour", "skin-weight", "displacement", "label" (names, never blended) or
        "other".
    interpolation
        How values between those of the mesh come about: "linear" on each face, "nearest", or "smooth-…" as positions do, where
        the rest says what is kept along seams, by OpenSubdiv's names ("smooth-boundaries" keeps them all). Default: as usual
        for the semantic, texture coordinates "smooth-boundaries", skins and displacements "smooth-none", labels "nearest",
        all else "linear".
    labels
        What the numbers of labels stand for.
    storage
        How files hold the numbers: "double", "single", "byte" (255 for 1), or whole numbers such as "int32".

    Examples
    --------
    >>> import limitmesh
    >>> uv = limitmesh.Channel([[0, 0], [1, 0], [1, 1], [0, 1]], semantic="texture")
    >>> uv.values.shape, uv.interpolation
    ((4, 2), 'smooth-boundaries')
    """

    values: Floats
    indices: npt.NDArray[np.int64] | None = None
    domain: Domain = "vertex"
    semantic: Semantic = "other"
    interpolation: Interpolation | None = None
    labels: Sequence[str] = ()
    storage: Storage = "double"

    def __post_init__(self) -> None:
        values = np.asarray(self.values)
        if values.dtype.kind not in "fiub" or values.ndim not in (1, 2):
            raise OptionError(f"values of a channel have the shape {values.shape} and the type {values.dtype}, "
                              "expected (k, width) or (k,) numbers")
        if values.ndim == 1:
            values = values[:, None]
        object.__setattr__(self, "values", np.ascontiguousarray(values, dtype=np.float64))
        if self.indices is not None:
            indices = np.asarray(self.indices)
            if indices.dtype.kind not in "iu":
                raise OptionError(f"indices of a channel are of the type {indices.dtype}, expected whole numbers")
            object.__setattr__(self, "indices", indices.astype(np.int64, copy=False))
        if self.interpolation is None:
            object.__setattr__(self, "interpolation", _USUAL.get(self.semantic, "linear"))

    def __getitem__(self, element: Any) -> Floats:
        """Values of elements of the domain, by their numbers."""
        rows = element if self.indices is None else self.indices[element]
        return cast(Floats, self.values[rows])

    def _native(self, name: str, counts: Mapping[str, int]) -> dict[str, Any]:
        if self.domain not in counts:
            raise OptionError(f"channels[{name!r}].domain is {self.domain!r}, expected 'vertex', 'corner' or 'face'")
        expected = counts[self.domain]
        indices = np.arange(len(self.values), dtype=np.int64) if self.indices is None else self.indices.reshape(-1)
        if len(indices) != expected:
            what = "values" if self.indices is None else "indices"
            raise OptionError(f"channels[{name!r}] has {len(indices)} {what}, expected one for each of {expected} {self.domain}s")
        return {
            "name": name,
            "semantic": self.semantic,
            "domain": self.domain,
            "interpolation": self.interpolation,
            "storage": self.storage,
            "values": self.values,
            "indices": np.ascontiguousarray(indices),
            "labels": [str(label) for label in self.labels],
        }

    @staticmethod
    def _of_native(told: Mapping[str, Any], *, triangles: bool) -> Channel:
        indices = told["indices"].astype(np.int64)
        if triangles and told["domain"] == "corner":
            indices = indices.reshape(-1, 3)
        return Channel(
            told["values"],
            indices,
            domain=told["domain"],
            semantic=told["semantic"],
            interpolation=told["interpolation"],
            labels=tuple(told["labels"]),
            storage=told["storage"],
        )


def told_channels(told: Iterable[Mapping[str, Any]], *, triangles: bool) -> dict[str, Channel]:
    """Channels by name, as the native half tells of them."""
    return {one["name"]: Channel._of_native(one, triangles=triangles) for one in told}


def channel_of(name: str, value: Any, counts: Mapping[str, int]) -> Channel:
    """A channel from an array: its length tells what has its values, its name or type what they mean."""
    if isinstance(value, Channel):
        return value
    array = np.asarray(value)
    if array.dtype.kind not in "fiub" or array.ndim == 0:
        raise OptionError(f"channels[{name!r}] is {type(value).__name__} of the type {array.dtype}, expected numbers")
    fits = [domain for domain in ("vertex", "corner", "face") if len(array) == counts[domain]]
    if array.ndim == 3 and array.shape[0] == counts["face"] and array.shape[0] * array.shape[1] == counts["corner"]:
        fits, array = ["corner"], array.reshape(-1, array.shape[2])
    if len(fits) != 1:
        several = ", ".join(f"{count} by {domain}" for domain, count in counts.items())
        problem = "fits several" if fits else "fits none"
        raise OptionError(f"channels[{name!r}] has {len(array)} rows, which {problem} of {several}; a limitmesh.Channel says which")
    return Channel(array, domain=cast(Domain, fits[0]), semantic=_semantic(name, array))


def _semantic(name: str, array: npt.NDArray[Any]) -> Semantic:
    low = name.lower()
    if any(word in low for word in ("uv", "texcoord", "texture")):
        return "texture"
    if any(word in low for word in ("colour", "color", "rgb")):
        return "colour"
    return "label" if array.dtype.kind in "iub" else "other"


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(Shown):
    """A mesh as a file or another library has it: nothing of it is looked at before it is used.

    Parameters
    ----------
    vertices
        (n, 3) positions.
    faces
        (m, 3) or (m, k) vertex numbers, or a list of polygons.
    channels
        What vertices, corners and faces carry: `Channel` or arrays, by name.
    creases
        Sharp edges: pairs of vertices, perhaps with a sharpness in levels (otherwise for ever).
    corners
        Vertices that stay where they are, perhaps with a sharpness.
    material_libraries
        Files that describe the materials that channels name.
    texture_files
        Pictures that texture coordinates are places on, where a PLY file names them.
    left_out
        What else the file held, in words.

    Examples
    --------
    >>> import limitmesh
    >>> mesh = limitmesh.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> limitmesh.info(mesh)["watertight"]
    True
    >>> mesh
    Mesh(4 vertices, 4 faces)
    """

    vertices: Any
    faces: Any
    channels: Mapping[str, Channel | npt.ArrayLike] = field(default_factory=dict)
    creases: Any = None
    corners: Any = None
    material_libraries: Sequence[str] = ()
    texture_files: Sequence[str] = ()
    left_out: Sequence[str] = ()

    def __repr__(self) -> str:
        carried = {"channels": self.channels, "creases": self.creases, "corners": self.corners, "left_out": self.left_out}
        told = "".join(f", {name}={text}" for name, value in carried.items() if (text := shown(value)))
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} faces{told})"

    def with_channels(self, channels: Mapping[str, Channel | npt.ArrayLike] | None) -> Mesh:
        """The same with further channels, or others of the same names.

        >>> import limitmesh
        >>> cup = limitmesh.load("builtin:cup")
        >>> list(cup.with_channels({"height": cup.vertices[:, 1]}).channels)
        ['height']
        """
        return self if not channels else replace(self, channels={**self.channels, **channels})

    def _native(self) -> MeshIn:
        vertices = _arrays.vertices_of(self.vertices)
        corners, starts = _arrays.faces_of(self.faces)
        counts = {
            "vertex": len(vertices),
            "corner": len(corners),
            "face": len(corners) // 3 if starts is None else len(starts) - 1,
        }
        channels = [channel_of(name, value, counts)._native(name, counts) for name, value in self.channels.items()]
        return {
            "vertices": vertices,
            "corners": corners,
            "starts": starts,
            "creases": _arrays.creases_of(self.creases),
            "corner_tags": _arrays.corner_tags_of(self.corners),
            "channels": channels,
        }
