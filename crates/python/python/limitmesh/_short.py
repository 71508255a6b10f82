"""Results that fall short of what was asked for: why, and the warning or the error that says so."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ._level import Level
from ._limitmesh import Error
from ._refined import Refined


class ToleranceNotMet(Error):
    """A cap ended a refinement before its goals were met, and ``strict`` was asked for.

    Attributes
    ----------
    result
        What was reached by then: a `Refined`, free of cracks; of `levels_of_detail` the levels, of `refine_file` the report.
    """

    result: Refined | list[Level] | dict[str, Any]

    def __init__(self, message: str, result: Refined | list[Level] | dict[str, Any]) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type[ToleranceNotMet], tuple[str, Any]]:
        return (type(self), (str(self), self.result))


class StoppedShort(UserWarning):
    """A cap ended a refinement before its goals were met: the result's ``stop`` says which."""


def why(result: Refined, goals: dict[str, Any], strict: bool = False) -> str | None:
    """Why a result is less than what was asked for, if it is; with ``strict`` no triangle near the input may be turned over."""
    if result.stop == "input-distance" and result.input_distance is not None:
        return f"within could not be kept: the result is within {result.input_distance[1]:.4g} of the input"
    if strict and goals.get("within") is not None and result.inverted:
        return f"{result.inverted} triangles are turned over"
    if result.stop == "met":
        return None
    count = len(result.faces)
    reached = f"what was reached has {count} triangles"
    if result.error is not None and np.isfinite(result.error.upper):
        reached += f" within {result.error.upper:.4g}"
    if result.stop == "triangle-cap":
        return f"max_triangles came before the goals: {reached}"
    if result.stop == "memory-cap":
        return f"max_memory came before the goals: {reached}"
    if result.stop == "level-cap":
        return f"max_levels came before the goals: {reached}"
    if result.stop == "rounding":
        return f"the tolerance is finer than rounding leaves certain: {reached}"
    if result.stop == "triangles" and goals["triangles"] is not None and count > goals["triangles"]:
        below = "; optimize=True goes below" if goals["method"] == "exact" and not goals["sqrt3"] else ""
        return f"the control mesh has more than the {goals['triangles']} triangles asked for{below}: {reached}"
    return None


def tell(short: str | None, result: Refined | list[Level] | dict[str, Any], strict: bool) -> None:
    """Raises or warns, where a result falls short, in the name of the function that calls this."""
    if short is None:
        return
    if strict:
        raise ToleranceNotMet(short, result)
    warnings.warn(short, StoppedShort, stacklevel=3)
