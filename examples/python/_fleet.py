"""What the examples of fleets share: which meshes there are, and the table of what became of them."""

import os
from collections.abc import Iterable
from pathlib import Path

from _folder import folder

import limitmesh

FORMATS = (".obj", ".off", ".ply", ".stl")


def pairs() -> list[tuple[str, str]]:
    """What to refine, and where to write it: the meshes below a megabyte in the folder of models, or the built-in ones."""
    models = Path(os.environ.get("LIMITMESH_MODELS", "../shared/models"))
    files = [path for path in sorted(models.glob("*")) if path.suffix in FORMATS and path.stat().st_size < 10**6]
    to = folder()
    if files:
        return [(str(path), str(to / path.name)) for path in files]
    return [(f"builtin:{name}", str(to / f"{name}.ply")) for name in limitmesh.models()]


def table(rows: Iterable[tuple[str, int, object]]) -> None:
    """A line for each mesh: its name, triangles, and the distance in per cent of the diagonal, or what was wrong."""
    for name, triangles, off in rows:
        print(f"{Path(name).name:28} {triangles:10,}  {off}")
