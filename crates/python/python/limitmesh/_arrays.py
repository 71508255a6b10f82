"""Meshes as people have them, brought to the arrays that the native half takes.

Everything here looks at each number once and copies it only where its type or order asks for that; what is wrong is an error that
names the row.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypedDict

import numpy as np
import numpy.typing as npt

from ._limitmesh import MeshError, OptionError

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class MeshIn(TypedDict):
    """What the native half takes for a mesh."""

    vertices: Floats
    corners: Integers
    starts: Integers | None
    creases: list[tuple[int, int, float]]
    corner_tags: list[tuple[int, float]]
    channels: list[dict[str, Any]]


def vertices_of(vertices: npt.ArrayLike, name: str = "vertices") -> Floats:
    """Rows of three finite numbers, (n, 3) and C-contiguous."""
    array = _numbers(vertices, name)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"{name} have the shape {array.shape}, expected (n, 3)")
    return np.ascontiguousarray(array, dtype=np.float64)


def check_finite(rows: Floats, name: str, error: type[Exception]) -> None:
    """Refuses rows with what is no finite number, by the first of them."""
    is_finite = np.isfinite(rows).all(axis=1)
    if not is_finite.all():
        row = int(np.argmin(is_finite))
        raise error(f"{name}[{row}] is {rows[row]}, expected finite numbers")


def _numbers(values: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "fiu":
            if array.dtype.kind in "OUSb" and array.size:
                _name_row(values, name)
            array = array.astype(np.float64)
    except MeshError:
        raise
    except (ValueError, TypeError) as why:
        _name_row(values, name)
        raise MeshError(f"{name} are no array of numbers: {why}") from None
    return array


def _name_row(values: Any, name: str) -> None:
    """Raises an error that names the first row that is none, if one can be found."""
    try:
        rows = list(values)
    except TypeError:
        raise MeshError(f"{name} are {type(values).__name__}, expected rows of three numbers") from None
    for row, value in enumerate(rows):
        try:
            good = np.asarray(value, dtype=np.float64)
            fits = good.shape == (3,) and np.asarray(value).dtype.kind in "fiu"
        except (ValueError, TypeError):
            fits = False
        if not fits:
            raise MeshError(f"{name}[{row}] is {_shortened(value)}, expected three numbers")


def _shortened(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def faces_of(faces: Any) -> tuple[Integers, Integers | None]:
    """The vertices of all polygons one after the other, and where each starts; no starts where all are triangles."""
    array = faces if isinstance(faces, np.ndarray) else None
    if array is None:
        try:
            array = np.asarray(faces)
        except ValueError:
            # Rows of different lengths.
            return _polygons(faces)
        except TypeError:
            raise MeshError(f"faces are {type(faces).__name__}, expected rows of vertex numbers") from None
    if array.dtype.kind == "O":
        return _polygons(faces)
    if array.size == 0 and array.ndim < 2:
        return np.zeros(0, dtype=np.int64), None
    if array.ndim != 2:
        raise MeshError(f"faces have the shape {array.shape}, expected (m, 3), or a list of polygons")
    whole = _whole(array)
    count, width = array.shape
    flat = np.ascontiguousarray(whole).reshape(-1)
    if width == 3:
        return flat, None
    return flat, np.arange(count + 1, dtype=np.int64) * width


def _whole(array: npt.NDArray[Any]) -> Integers:
    """Vertex numbers as integers; fractions are refused."""
    if array.dtype.kind == "u" and array.dtype.itemsize == 8 and array.size:
        beyond = array > np.iinfo(np.int64).max
        if beyond.any():
            row, column = np.argwhere(beyond)[0]
            raise MeshError(f"faces[{row}] names vertex {array[row, column]} in column {column}, which is too large")
    if array.dtype.kind in "iu":
        return array.astype(np.int64, copy=False)
    if array.dtype.kind == "f":
        with np.errstate(invalid="ignore"):
            # Beyond this, neighbouring whole numbers are the same.
            bad = ~((array == np.floor(array)) & (np.abs(array) < 2.0**53))
        if bad.any():
            row, column = np.argwhere(bad)[0]
            raise MeshError(f"faces[{row}] names vertex {array[row, column]} in column {column}, expected a whole number")
        return array.astype(np.int64)
    raise MeshError(f"faces are of the type {array.dtype}, expected whole numbers")


def _polygons(faces: Iterable[Sequence[Any]]) -> tuple[Integers, Integers]:
    """Polygons of any number of corners."""
    corners: list[Integers] = []
    starts = [0]
    for row, polygon in enumerate(faces):
        try:
            own = np.asarray(polygon)
        except (ValueError, TypeError):
            own = np.asarray(None)
        if own.dtype.kind not in "iuf" and own.size or own.ndim != 1:
            raise MeshError(f"faces[{row}] is {_shortened(polygon)}, expected a row of vertex numbers")
        if own.size and own.dtype.kind == "f" and not (own == np.floor(own)).all():
            raise MeshError(f"faces[{row}] is {_shortened(polygon)}, expected whole numbers")
        corners.append(own.astype(np.int64))
        starts.append(starts[-1] + own.size)
    flat = np.concatenate(corners) if corners else np.zeros(0, dtype=np.int64)
    return np.ascontiguousarray(flat), np.asarray(starts, dtype=np.int64)


def creases_of(creases: Any) -> list[tuple[int, int, float]]:
    """Edges by their ends, with a sharpness or for ever sharp."""
    found = []
    for row, crease in enumerate([] if creases is None else creases):
        values = _tag(crease, "creases", row, (2, 3), "two vertices, and perhaps a sharpness")
        sharpness = _sharpness(values[2] if len(values) == 3 else np.inf, "creases", row)
        found.append((_vertex(values[0], "creases", row), _vertex(values[1], "creases", row), sharpness))
    return found


def corner_tags_of(corners: Any) -> list[tuple[int, float]]:
    """Vertices that stay, with a sharpness or for ever."""
    found = []
    if isinstance(corners, np.ndarray) and corners.dtype == np.bool_:
        raise OptionError("corners are true or false by vertex, expected vertex numbers: np.flatnonzero gives them")
    for row, corner in enumerate([] if corners is None else corners):
        value = (corner,) if np.ndim(corner) == 0 else corner
        values = _tag(value, "corners", row, (1, 2), "a vertex, and perhaps a sharpness")
        sharpness = _sharpness(values[1] if len(values) == 2 else np.inf, "corners", row)
        found.append((_vertex(values[0], "corners", row), sharpness))
    return found


def _tag(value: Any, name: str, row: int, lengths: tuple[int, int], expected: str) -> list[float]:
    try:
        values = [float(x) for x in value]
    except (ValueError, TypeError):
        values = []
    if len(values) not in lengths:
        raise OptionError(f"{name}[{row}] is {_shortened(value)}, expected {expected}")
    return values


def _vertex(value: float, name: str, row: int) -> int:
    if not (value == np.floor(value) and abs(value) < 2**53):
        raise OptionError(f"{name}[{row}] names vertex {value}, expected a whole number")
    return int(value)


def _sharpness(value: float, name: str, row: int) -> float:
    if not value >= 0.0:
        raise OptionError(f"{name}[{row}] has the sharpness {value}, expected at least 0")
    return value
