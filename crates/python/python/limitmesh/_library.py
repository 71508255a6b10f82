"""Other libraries, imported when they are needed, and what meshes are called in them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

UV = "uv"
COLOUR = "colour"


def library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError as why:
        raise ImportError(f"{name} is not installed, and is what this function is for: pip install {name}") from why
