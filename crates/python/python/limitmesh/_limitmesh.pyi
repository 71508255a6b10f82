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

@final
class Front:
    def __new__(
        cls, mesh: Any, control: dict[str, Any], threads: int, progress: _Callback
    ) -> Front: ...
    def update(
        self, demand: dict[str, Any] | None, progress: _Callback
    ) -> tuple[
        int,
        npt.NDArray[np.uint32],
        npt.NDArray[np.float64],
        int,
        npt.NDArray[np.uint32],
        npt.NDArray[np.uint32],
        tuple[int, int, float, bool, float | None, int],
    ]: ...

@final
class Origins:
    def rows(
        self,
    ) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.float64]]: ...

@final
class Replay:
    def at(
        self, positions: npt.NDArray[np.float64], threads: int
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]: ...

def replay(
    mesh: Any,
    control: dict[str, Any],
    goals: dict[str, Any],
    has_wide_indices: bool,
    threads: int,
    progress: _Callback,
) -> tuple[dict[str, Any], Replay]: ...
def refine_frames(
    mesh: Any,
    frames: npt.NDArray[np.float64],
    control: dict[str, Any],
    goals: dict[str, Any],
    has_wide_indices: bool,
    threads: int,
    progress: _Callback,
) -> tuple[dict[str, Any], list[tuple[float, float, bool, tuple[float, float, float]]], Replay]: ...
def refine(
    mesh: Any,
    control: dict[str, Any],
    goals: dict[str, Any],
    has_wide_indices: bool,
    threads: int,
    progress: _Callback,
) -> dict[str, Any]: ...
def estimate(
    mesh: Any, control: dict[str, Any], goals: dict[str, Any], threads: int, progress: _Callback
) -> tuple[int, int, bool]: ...
def measure(
    surface: Any, reference: Any, how: dict[str, Any], threads: int, progress: _Callback
) -> dict[str, Any]: ...
def measure_limit(
    surface: Any,
    reference: Any,
    control: dict[str, Any],
    how: dict[str, Any],
    levels: int | None,
    threads: int,
    progress: _Callback,
) -> dict[str, Any]: ...
def levels_of_detail(
    mesh: Any,
    control: dict[str, Any],
    detail: dict[str, Any],
    has_wide_indices: bool,
    threads: int,
    progress: _Callback,
) -> list[dict[str, Any]]: ...
def switching_distance(
    deviation: float, pixels: float, height: float, fov_degrees: float
) -> float: ...
def limit(
    mesh: Any, control: dict[str, Any], threads: int, progress: _Callback
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]: ...
def limit_surface(
    mesh: Any,
    control: dict[str, Any],
    faces: npt.NDArray[np.int64],
    weights: npt.NDArray[np.float64],
    threads: int,
    progress: _Callback,
) -> tuple[
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
]: ...
def facing(
    mesh: Any,
    control: dict[str, Any],
    eye: list[float] | None,
    view: list[float],
    threads: int,
    progress: _Callback,
) -> npt.NDArray[np.int8]: ...
def intersect(
    origins: npt.NDArray[np.float64],
    directions: npt.NDArray[np.float64],
    mesh: Any,
    control: dict[str, Any],
    casting: dict[str, Any],
    threads: int,
    progress: _Callback,
) -> tuple[
    npt.NDArray[np.int64],
    npt.NDArray[np.float64],
    npt.NDArray[np.int64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.int8],
]: ...
def project(
    points: npt.NDArray[np.float64],
    mesh: Any,
    control: dict[str, Any],
    tolerance: tuple[float, bool],
    threads: int,
    progress: _Callback,
) -> tuple[
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.int64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
    npt.NDArray[np.float64],
]: ...
def examine(mesh: Any, control: dict[str, Any], threads: int) -> tuple[str, dict[str, Any] | None]: ...
def simplify(
    mesh: Any,
    control: dict[str, Any],
    tolerance: tuple[float, bool] | None,
    triangles: int | None,
    certify: bool,
    threads: int,
    progress: _Callback,
) -> dict[str, Any]: ...
def repair(mesh: Any, control: dict[str, Any], threads: int) -> dict[str, Any]: ...
def picture(
    vertices: npt.NDArray[np.float64],
    faces: npt.NDArray[np.uint32],
    normals: npt.NDArray[np.float64] | None,
    width: int,
    height: int,
    wireframe: bool,
    threads: int,
) -> bytes: ...
def models() -> list[tuple[str, str]]: ...
def load(path: str) -> dict[str, Any]: ...
def save(
    path: str,
    vertices: npt.NDArray[np.float64],
    faces: npt.NDArray[np.uint32],
    normals: npt.NDArray[np.float64] | None,
    channels: list[dict[str, Any]],
    linked: list[list[str]],
    ascii: bool,
) -> list[str]: ...
def end_threads() -> None: ...
def program(arguments: list[str], again: list[str]) -> int: ...
def refine_file(arguments: list[str], threads: int, progress: _Callback) -> tuple[str | None, list[str]]: ...
