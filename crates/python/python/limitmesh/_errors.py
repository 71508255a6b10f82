"""What limitmesh raises and warns of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._limitmesh import Error, MeshError, OptionError, ReadError

if TYPE_CHECKING:
    from ._levels import Level
    from ._refined import Refined

__all__ = ["Error", "MeshError", "OptionError", "ReadError", "StoppedShort", "ToleranceNotMet"]


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
