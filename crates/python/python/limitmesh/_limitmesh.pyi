from collections.abc import Callable
from typing import Any, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "FINDINGS",
    "Error",
    "Front",
    "MeshError",
    "OptionError",
    "Origins",
    "ReadError",
    "Replay",
    "__version__",
    "batch",
    "end_threads",
    "estimate",
    "examine",
    "facing",
    "intersect",
    "levels_of_detail",
    "limit",
    "limit_surface",
    "load",
    "measure",
    "measure_limit",
    "models",
    "page",
    "picture",
    "program",
    "project",
    "refine",
    "refine_file",
    "refine_frames",
    "repair",
    "replay",
    "save",
    "simplify",
    "switching_distance",
]
FINDINGS: tuple[str, ...]
__version__: str

class Error(ValueError): ...
class MeshError(Error): ...
class OptionError(Error): ...
class ReadError(Error): ...

_Callback = Callable[[str, int, int | None, int], object] | None
_Record = dict[str, Any]
_Floats = npt.NDArray[np.float64]
_Integers = npt.NDArray[np.int64]
_Indices = npt.NDArray[np.uint32]

@final
class Front:
    def __new__(cls, mesh: Any, control: _Record, threads: int, progress: _Callback) -> Front: ...
    def update(
        self, demand: _Record | None, progress: _Callback, is_told: bool
    ) -> tuple[int, _Indices, _Floats, int, _Indices, _Indices, tuple[int, int, float, bool, float | None, int]]: ...

@final
class Origins:
    def rows(self) -> tuple[_Integers, _Integers, _Floats, bool]: ...

@final
class Replay:
    def at(self, positions: _Floats, threads: int) -> tuple[_Floats, _Floats]: ...

def replay(
    mesh: Any, control: _Record, goals: _Record, has_wide_indices: bool, threads: int, progress: _Callback
) -> tuple[_Record, Replay]: ...
def refine_frames(
    mesh: Any, frames: _Floats, control: _Record, goals: _Record, has_wide_indices: bool, threads: int, progress: _Callback
) -> tuple[_Record, list[tuple[float, float, bool, tuple[float, float, float]]], Replay]: ...
def refine(mesh: Any, control: _Record, goals: _Record, has_wide_indices: bool, threads: int, progress: _Callback) -> _Record: ...
def estimate(mesh: Any, control: _Record, goals: _Record, threads: int, progress: _Callback) -> tuple[int, int, bool]: ...
def measure(surface: Any, reference: Any, how: _Record, threads: int, progress: _Callback) -> _Record: ...
def measure_limit(
    surface: Any, reference: Any, control: _Record, how: _Record, levels: int | None, threads: int, progress: _Callback
) -> _Record: ...
def levels_of_detail(
    mesh: Any, control: _Record, detail: _Record, has_wide_indices: bool, threads: int, progress: _Callback
) -> list[_Record]: ...
def switching_distance(deviation: float, pixels: float, height: float, fov_degrees: float) -> float: ...
def limit(mesh: Any, control: _Record, threads: int, progress: _Callback) -> tuple[_Floats, _Floats]: ...
def limit_surface(
    mesh: Any, control: _Record, faces: _Integers, weights: _Floats, threads: int, progress: _Callback
) -> tuple[_Floats, _Floats, _Floats, _Floats, _Floats, _Floats, _Floats]: ...
def facing(
    mesh: Any, control: _Record, eye: list[float] | None, view: list[float], threads: int, progress: _Callback
) -> npt.NDArray[np.int8]: ...
def intersect(
    origins: _Floats, directions: _Floats, mesh: Any, control: _Record, casting: _Record, threads: int, progress: _Callback
) -> tuple[_Integers, _Floats, _Integers, _Floats, _Floats, _Floats, npt.NDArray[np.int8]]: ...
def project(
    points: _Floats, mesh: Any, control: _Record, tolerance: tuple[float, bool], threads: int, progress: _Callback
) -> tuple[_Floats, _Floats, _Floats, _Integers, _Floats, _Floats, _Floats]: ...
def examine(mesh: Any, control: _Record, threads: int) -> tuple[str, _Record | None]: ...
def simplify(
    mesh: Any,
    control: _Record,
    tolerance: tuple[float, bool] | None,
    triangles: int | None,
    certify: bool,
    threads: int,
    progress: _Callback,
) -> _Record: ...
def repair(mesh: Any, control: _Record, threads: int) -> _Record: ...
def page(
    name: str, glb: bytes, picture: bytes, diagonal: float, report: tuple[int, int, float | None, float | None, bool, float]
) -> str: ...
def picture(
    vertices: _Floats, faces: _Indices, normals: _Floats | None, width: int, height: int, wireframe: bool, threads: int
) -> bytes: ...
def models() -> list[tuple[str, str]]: ...
def load(path: str) -> _Record: ...
def save(
    path: str,
    vertices: _Floats,
    faces: _Indices,
    quads: list[list[int]],
    normals: _Floats | None,
    normals_of_corners: _Indices | None,
    channels: list[_Record],
    linked: list[list[str]],
    ascii: bool,
) -> list[str]: ...
def end_threads() -> None: ...
def program(arguments: list[str], again: list[str]) -> int: ...
def refine_file(arguments: list[str], threads: int, progress: _Callback) -> tuple[str | None, list[str]]: ...
def batch(
    arguments: list[str], again: list[str], files: Any, progress: _Callback
) -> list[int]: ...
