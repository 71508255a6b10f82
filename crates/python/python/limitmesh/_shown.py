"""How meshes and results are shown: arrays by their shapes, not by their numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

_LONGEST = 60
"""Letters of a value."""

_MOST = 8
"""Rows that are written out."""


class Shown:
    """A dataclass that is shown by its fields, but for those that hold nothing."""

    def __repr__(self) -> str:
        values = ((own.name, getattr(self, own.name)) for own in fields(self) if not own.name.startswith("_"))  # type: ignore[arg-type]
        told = ((name, shown(value)) for name, value in values)
        return f"{type(self).__name__}({', '.join(f'{name}={text}' for name, text in told if text)})"


def shown(value: Any) -> str:
    """A value in a few words: nothing for nothing."""
    if value is None or (isinstance(value, (tuple, list, Mapping)) and not value):
        return ""
    if isinstance(value, np.ndarray):
        return f"<{' x '.join(map(str, value.shape))} {value.dtype}>"
    if isinstance(value, Mapping):
        return _cut(f"<{', '.join(map(str, value))}>")
    if isinstance(value, (tuple, list)):
        text = "" if len(value) > _MOST or any(isinstance(own, np.ndarray) for own in value) else repr(value)
        return text if 0 < len(text) <= _LONGEST else f"<{len(value)} rows>"
    return _cut(repr(value))


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 2] + "…" + text[-1]
