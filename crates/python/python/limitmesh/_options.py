"""Options as people write them, checked, and completed for the native half."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, TypedDict, TypeVar

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, check_finite
from ._limitmesh import OptionError

Length: TypeAlias = float | str
"""A length in the mesh's unit, or with ``"%"`` a part of the diagonal of the mesh's bounding box."""

Count: TypeAlias = int | str
"""A whole number; as a text it may be written "20k", "1.5M", "2e4" or "20,000"."""

Boundary: TypeAlias = Literal["smooth", "corners", "fixed"]
Scheme: TypeAlias = Literal["loop", "loop-warren", "butterfly", "catmull-clark"]
RefiningScheme: TypeAlias = Literal["loop", "loop-warren", "butterfly", "catmull-clark", "sqrt3"]
Method: TypeAlias = Literal["exact", "limit-normal", "amresh", "uniform", "planarity", "vertex-error"]


@dataclass(frozen=True)
class Camera:
    """A perspective camera, for ``pixels``.

    Parameters
    ----------
    eye, target
        Where it stands, and a point in the middle of its picture, in the mesh's unit.
    up
        A direction that points up in its picture.
    fov
        Angle of view from the bottom to the top of the picture, in degrees: above 0, below 180.
    width, height
        Size of the picture in pixels.

    Examples
    --------
    >>> import limitmesh
    >>> camera = limitmesh.Camera(eye=(0, -4, 2), target=(0, 0, 0), up=(0, 0, 1))
    >>> cup = limitmesh.load("builtin:cup")
    >>> seen = limitmesh.refine(cup, pixels=1, cameras=[camera])
    >>> seen.pixels <= 1
    True
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    fov: float = 45.0
    width: int = 1920
    height: int = 1080


@dataclass(frozen=True)
class Progress:
    """How far a call has come, as its ``progress`` is told.

    Attributes
    ----------
    stage
        What is being done, in words.
    done, total
        Units of this stage that are done, and that there will be where that is known.
    triangles
        Of the mesh that is being made, or looked at.
    """

    stage: str
    done: int
    total: int | None
    triangles: int


ProgressCallback: TypeAlias = Callable[[Progress], object]

_Made = TypeVar("_Made")


def number(value: Any, name: str, expected: str, fits: Callable[[float], bool]) -> float:
    """A number, or an error that says what was expected."""
    try:
        if isinstance(value, (bool, np.bool_, str)):
            raise TypeError
        found = float(value)
    except (TypeError, ValueError):
        found = float("nan")
    if not fits(found):
        raise OptionError(f"{name} is {value!r}, expected {expected}")
    return found


def positive(value: Any, name: str) -> float:
    """A finite number above 0."""
    return number(value, name, "a number above 0", lambda x: 0.0 < x < np.inf)


def whole(value: Any, name: str, least: int) -> int:
    """A whole number; counts may be written as floats are, such as 2e4, and as people write them, such as "20k"."""
    expected = f"a whole number of at least {least}"

    def fits(x: float) -> bool:
        return bool(x >= least and x == np.floor(x) < 2**62)

    if isinstance(value, str):
        found = _count_of(value)
        if not fits(found):
            raise OptionError(f"{name} is {value!r}, expected {expected}, such as '20000', '20,000', '20k' or '2e4'")
        return int(found)
    return int(number(value, name, expected, fits))


_THOUSANDS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9}


def _count_of(text: str) -> float:
    """A number with k, M or G for thousands, millions and thousands of millions, and separators between thousands; NaN where it is none."""
    found = re.fullmatch(r"\s*(\d{1,3}(?:,\d{3})+|\d{1,3}(?:_\d{3})+|\d+\.?\d*(?:e\+?\d+)?)\s*([kmg]?)\s*", text, re.IGNORECASE)
    if not found:
        return float("nan")
    amount = float(re.sub("[,_]", "", found[1])) * _THOUSANDS[found[2].lower()]
    # 1.1 M is a whole number but for what rounding makes of it.
    return np.round(amount) if np.isfinite(amount) and abs(amount - np.round(amount)) <= 1e-9 * amount else amount


def extent(value: Length, name: str, *, zero: bool = False) -> tuple[float, bool]:
    """A length, and whether it is a part of the diagonal."""
    expected = f"a length {'of at least' if zero else 'above'} 0, or with % a part of the diagonal such as '0.1%'"

    def fits(x: float) -> bool:
        return np.isfinite(x) and (x > 0.0 or (zero and x == 0.0))

    if isinstance(value, str):
        text = value.strip()
        try:
            found = float(text.removesuffix("%"))
        except ValueError:
            found = float("nan")
        if not fits(found):
            raise OptionError(f"{name} is {value!r}, expected {expected}")
        return (found / 100.0, True) if text.endswith("%") else (found, False)
    return number(value, name, expected, fits), False


def point(value: Any, name: str) -> list[float]:
    """Three finite numbers."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (ValueError, TypeError):
        array = np.zeros(0)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise OptionError(f"{name} is {value!r}, expected three numbers")
    return [float(x) for x in array]


def rows_of(values: npt.ArrayLike, name: str) -> Floats:
    """Numbers, C-contiguous: rows of three if all is well; none are no rows of three."""
    try:
        rows = np.ascontiguousarray(values, dtype=np.float64)
    except (ValueError, TypeError):
        raise OptionError(f"{name} is no array of numbers, expected (n, 3)") from None
    return rows if rows.size else rows.reshape(-1, 3)


def points_of(points: npt.ArrayLike, name: str) -> Floats:
    """Rows of three finite numbers, (n, 3) and C-contiguous."""
    rows = rows_of(points, name)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise OptionError(f"{name} has the shape {rows.shape}, expected (n, 3)")
    check_finite(rows, name, OptionError)
    return rows


_UNITS = {"": 1, "B": 1, "K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}


def memory(value: float | str | None) -> int | None:
    """Bytes: a number, such as "2GB", or a part of the machine's such as "50%"."""
    if value is None:
        return None
    if isinstance(value, str):
        return _memory_of(value)
    return int(number(value, "max_memory", "bytes above 0", lambda x: 0.0 < x < 2**62))


@functools.cache
def _memory_of(value: str) -> int | None:
    text = value.strip()
    found = re.fullmatch(r"([0-9.]+(?:e[0-9]+)?)\s*(%|[KMGT]?i?B?)", text, re.IGNORECASE)
    try:
        amount = float(found[1]) if found else float("nan")
    except ValueError:
        amount = float("nan")
    if not found or not amount > 0.0:
        raise OptionError(f"max_memory is {value!r}, expected bytes, such as '500MB', or '50%' of the machine's")
    if found[2] == "%":
        whole_memory = machine_memory()
        return None if whole_memory is None else int(amount / 100.0 * whole_memory)
    return int(amount * _UNITS[found[2].upper().rstrip("B").rstrip("I")])


@functools.cache
def machine_memory() -> int | None:
    """Bytes that this process may have: the machine's, or fewer where its container has a limit."""
    limits = []
    try:
        limits.append(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        pass
    for path in ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"):
        try:
            with open(path, encoding="ascii") as file:
                limits.append(int(file.read()))
        except (OSError, ValueError):
            pass
    return min(limits) if limits else None


def threads_of(threads: int | None) -> int:
    """How many threads: as asked for, ``LIMITMESH_NUM_THREADS``, or as many as this process may run on."""
    if threads is None:
        named = os.environ.get("LIMITMESH_NUM_THREADS", "").strip()
        if named:
            if not named.isdigit() or int(named) == 0:
                raise OptionError(f"LIMITMESH_NUM_THREADS is {named!r}, expected a whole number of at least 1")
            return min(int(named), MOST_THREADS)
        if hasattr(os, "sched_getaffinity"):
            return min(len(os.sched_getaffinity(0)), MOST_THREADS)
        return min(os.cpu_count() or 1, MOST_THREADS)
    return min(whole(threads, "threads", 1), MOST_THREADS)


MOST_THREADS = 256


Told: TypeAlias = Callable[[str, int, int | None, int], object] | None
"""What the native half calls."""


def work_of(threads: int | None, progress: ProgressCallback | None) -> tuple[int, Told]:
    """How a job is done: on so many threads, and who is told of its progress."""
    return threads_of(threads), callback_of(progress)


def callback_of(progress: ProgressCallback | None) -> Told:
    """What the native half calls."""
    if progress is None:
        return None
    if not callable(progress):
        raise OptionError(f"progress is {progress!r}, expected a function")
    call = progress
    return lambda stage, done, total, triangles: call(Progress(stage, done, total, triangles))


class ControlOptions(TypedDict, total=False):
    """What `control_of` takes, for those who pass it on."""

    interpolate: bool | Length | None
    crease_angle: float | None
    boundary: str
    concave_corners: str | None
    scheme: str | None
    smooth_triangles: bool
    weld: float | None
    repair: bool


def control_of(
    *,
    interpolate: bool | Length | None = None,
    auto_creases: bool = False,
    crease_angle: float | None = None,
    boundary: str = "smooth",
    concave_corners: str | None = None,
    scheme: str | None = None,
    smooth_triangles: bool = False,
    weld: float | None = 0.0,
    repair: bool = True,
) -> dict[str, Any]:
    """How the control mesh comes about; without a scheme by Loop's."""
    scheme = scheme or ("catmull-clark" if smooth_triangles else "loop")
    for name, value, expected in (
        ("boundary", boundary, ("smooth", "corners", "fixed")),
        ("scheme", scheme, ("loop", "loop-warren", "butterfly", "catmull-clark")),
        ("concave_corners", concave_corners, (None, "divided", "as-tagged")),
    ):
        one_of(value, name, expected)
    if smooth_triangles and scheme != "catmull-clark":
        raise OptionError(f"smooth_triangles is a rule of scheme='catmull-clark'; it does not go with {scheme!r}")
    if crease_angle is not None:
        if auto_creases:
            raise OptionError("creases='auto' finds an angle; crease_angle does not go with it")
        crease_angle = angle_of(crease_angle, "crease_angle")
    usual = "divided" if auto_creases or crease_angle is not None or boundary != "smooth" else "as-tagged"
    within: tuple[float, bool] | None
    if interpolate is False or interpolate is None:
        within = None
    elif interpolate is True:
        within = (0.0, False)
    else:
        within = extent(interpolate, "interpolate", zero=True)
    return {
        "weld": -1.0 if weld is None else number(weld, "weld", "a distance of at least 0, or None", _is_distance),
        "repair": bool(repair),
        "boundary": boundary,
        "crease_angle": crease_angle,
        "auto_creases": auto_creases,
        "leads_parts": auto_creases and interpolate is None,
        "divides_concave_corners": (concave_corners or usual) == "divided",
        "interpolate": within,
        "scheme": scheme,
        "smooth_triangles": bool(smooth_triangles),
    }


def _is_distance(x: float) -> bool:
    return 0.0 <= x < np.inf


def one_of(value: Any, name: str, expected: tuple[str | None, ...]) -> None:
    """Refuses what is none of some words."""
    if not (value is None or isinstance(value, str)) or value not in expected:
        words = " or ".join(repr(word) for word in expected)
        raise OptionError(f"{name} is {value!r}, expected {words}")


def angle_of(value: float, name: str) -> float:
    """Degrees above 0, at most 180."""
    return number(value, name, "degrees above 0, at most 180", lambda x: 0.0 < x <= 180.0)


def cameras_of(cameras: Iterable[Camera]) -> list[tuple[Any, ...]]:
    """Cameras for the native half."""
    found = []
    if not isinstance(cameras, Iterable):
        raise OptionError(f"cameras is {cameras!r}, expected limitmesh.Camera objects in a list")
    for row, camera in enumerate(cameras):
        if not isinstance(camera, Camera):
            raise OptionError(f"cameras[{row}] is {camera!r}, expected a limitmesh.Camera")
        name = f"cameras[{row}]"
        places = [point(getattr(camera, field), f"{name}.{field}") for field in ("eye", "target", "up")]
        fov = number(camera.fov, f"{name}.fov", "degrees above 0, below 180", lambda x: 0.0 < x < 180.0)
        size = [whole(getattr(camera, field), f"{name}.{field}", 1) for field in ("width", "height")]
        if max(size) >= 2**31:
            raise OptionError(f"{name} has a picture of {size[0]} x {size[1]}, which is too large")
        found.append((*places, fov, *size))
    return found


def seen_by(
    pixels: float | None, cameras: Camera | Iterable[Camera] | None
) -> tuple[float | None, list[tuple[Any, ...]]]:
    """What may be seen of an error, 1 where there are cameras and no number, and the cameras for the native half."""
    looking = [] if cameras is None else cameras_of([cameras] if isinstance(cameras, Camera) else cameras)
    return 1.0 if looking and pixels is None else pixels, looking


def index_dtype_of(index_dtype: npt.DTypeLike) -> np.dtype[Any]:
    """The type of a result's vertex numbers."""
    try:
        dtype = np.dtype(index_dtype)
    except TypeError:
        dtype = np.dtype(np.float64)
    if dtype.kind not in "iu" or dtype.itemsize < 4:
        raise OptionError(f"index_dtype is {index_dtype!r}, expected whole numbers of 32 or 64 bits")
    return dtype


def of_refinement(
    *,
    interpolate: bool | Length | None,
    auto_creases: bool,
    crease_angle: float | None,
    boundary: str,
    concave_corners: str | None,
    scheme: str,
    smooth_triangles: bool,
    weld: float | None,
    repair: bool,
    **goals: Any,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """How the control mesh comes about, and the goals."""
    one_of(scheme, "scheme", ("loop", "loop-warren", "butterfly", "catmull-clark", "sqrt3"))
    sqrt3 = scheme == "sqrt3"
    if sqrt3 and interpolate not in (False, None):
        raise OptionError("interpolate does not go with scheme='sqrt3'; it is for the schemes that divide triangles in four")
    is_near = goals.get("within") is not None
    if is_near and interpolate not in (False, None):
        raise OptionError("interpolate does not go with within, which leads the surface as near to the vertices as it has to be")
    if scheme == "catmull-clark" and (is_near or goals.get("optimize")):
        raise OptionError("within and optimize do not go with scheme='catmull-clark'; they are for triangles")
    if goals.get("quads") and scheme != "catmull-clark":
        raise OptionError("quads are for scheme='catmull-clark', whose meshes have some")
    if is_near and scheme == "butterfly":
        raise OptionError("within smooths by moving control points; scheme='butterfly' passes through them")
    control = control_of(
        # Neither leads the surface of a part through its vertices.
        interpolate=False if sqrt3 or is_near else interpolate,
        auto_creases=auto_creases,
        crease_angle=crease_angle,
        boundary=boundary,
        concave_corners=concave_corners,
        # Nothing but what is refused above asks for the control mesh's scheme.
        scheme="loop" if sqrt3 else scheme,
        smooth_triangles=smooth_triangles,
        weld=weld,
        repair=repair,
    )
    return control, goals_of(sqrt3=sqrt3, **goals)


def remembered(make: Callable[..., _Made], **options: Any) -> _Made:
    """What `make` makes of options, made once of those that are alike: what is refined often is refined alike."""
    # Anything else could be changed in place, and be told from nothing that it was before.
    if all(type(value) in _PLAIN for value in options.values()):
        return _remembered(make, **options)  # type: ignore[return-value]
    return make(**options)


_PLAIN = frozenset((type(None), bool, int, float, str))


@functools.lru_cache(maxsize=256, typed=True)
def _remembered(make: Callable[..., object], **options: Any) -> object:
    return make(**options)


_STEPS = ("limit-normal", "amresh", "uniform")
_QUADTREE = ("planarity", "vertex-error")


def _refuse(method: str, sqrt3: bool, given: dict[str, bool]) -> None:
    """Refuses options that a method has no answer to."""
    refused: tuple[str, ...]
    if sqrt3:
        if method not in ("exact", "uniform"):
            raise OptionError(f"method is {method!r}, expected 'exact' or 'uniform' with scheme='sqrt3', which has criteria of its own")
        how, refused = "scheme='sqrt3'", ("pixels", "optimize", "balance", "view", "eye")
    else:
        how, refused = f"method={method!r}", ()
    if method in _STEPS:
        for name in ("tolerance", "triangles", "pixels", "optimize", "balance"):
            if given[name]:
                raise OptionError(f"{name} is a goal of method='exact', not of {method!r}")
    elif given["levels"]:
        raise OptionError(f"levels are steps of the other methods; with method={method!r} they follow from the goals")
    if method in _QUADTREE:
        refused = ("pixels", "optimize", "balance", "view", "eye")
        if method == "vertex-error":
            refused = (*refused, "angle")
        elif given["angle"] and given["tolerance"]:
            raise OptionError("angle and tolerance: method='planarity' goes by one of them")
    for name in refused:
        if given[name]:
            raise OptionError(f"{name} does not go with {how}")


def goals_of(
    *,
    method: str = "exact",
    sqrt3: bool = False,
    levels: int | None = None,
    tolerance: Length | None = None,
    within: Length | None = None,
    triangles: Count | None = None,
    angle: float | None = None,
    pixels: float | None = None,
    cameras: Camera | Iterable[Camera] | None = None,
    view: npt.ArrayLike | None = None,
    eye: npt.ArrayLike | None = None,
    dilatation: float = 1.0,
    optimize: bool = False,
    balance: bool = False,
    flat_regions: bool = True,
    quads: bool = False,
    origins: bool = True,
    max_triangles: Count | None = None,
    max_levels: int | None = None,
    max_memory: float | str | None = None,
) -> dict[str, Any]:
    """Goals and caps."""
    one_of(method, "method", ("exact", *_STEPS, *_QUADTREE))
    pixels, looking = seen_by(pixels, cameras)
    given = {
        "levels": levels is not None,
        "tolerance": tolerance is not None,
        "triangles": triangles is not None,
        "angle": angle is not None,
        "pixels": pixels is not None,
        "optimize": bool(optimize),
        "balance": bool(balance),
        "view": view is not None,
        "eye": eye is not None,
    }
    _refuse(method, sqrt3, given)
    if optimize and balance:
        raise OptionError("balance does not go with optimize, whose vertices stay on the limit surface")
    if within is not None:
        if sqrt3 or method != "exact":
            raise OptionError("within is a goal of method='exact' and the schemes that divide triangles in four")
        for name in ("tolerance", "optimize"):
            if given[name]:
                raise OptionError(f"{name} does not go with within, which is how near the input the result has to be")
    if within is None and not any(given[name] for name in ("tolerance", "triangles", "angle", "pixels")):
        if method in ("exact", "vertex-error"):
            tolerance = "0.1%"
        elif method == "planarity":
            angle = 10.0
    if quads and (method not in ("exact", "uniform") or given["angle"] or given["pixels"]):
        raise OptionError("quads go with method='exact' and 'uniform', and keep distances; not angle and pixels")
    if view is not None and eye is not None:
        raise OptionError("view and eye: one of them says where the viewer is")
    return {
        "method": method,
        "sqrt3": sqrt3,
        "levels": 3 if levels is None else whole(levels, "levels", 0),
        "tolerance": None if tolerance is None else extent(tolerance, "tolerance"),
        "within": None if within is None else extent(within, "within"),
        "triangles": None if triangles is None else whole(triangles, "triangles", 1),
        "angle": None if angle is None else angle_of(angle, "angle"),
        "pixels": None if pixels is None else positive(pixels, "pixels"),
        "cameras": looking,
        "eye": None if eye is None else point(eye, "eye"),
        "view": None if view is None else point(view, "view"),
        "dilatation": number(dilatation, "dilatation", "a number of at least 0", _is_distance),
        "optimize": bool(optimize),
        "balance": bool(balance),
        "flat_regions": bool(flat_regions),
        "quads": bool(quads),
        "origins": bool(origins),
        "max_triangles": None if max_triangles is None else whole(max_triangles, "max_triangles", 1),
        "max_levels": None if max_levels is None else whole(max_levels, "max_levels", 1),
        "max_memory": memory(max_memory),
    }
