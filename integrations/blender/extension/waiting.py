"""Progress of a long call, shown at the mouse pointer."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy
import limitmesh


@contextmanager
def progress(context: bpy.types.Context) -> Iterator[Callable[[limitmesh.Progress], None]]:
    """What limitmesh calls while it works."""
    manager = context.window_manager
    manager.progress_begin(0, 9999)
    try:
        # The pointer has room for four digits: thousands of triangles.
        yield lambda told: manager.progress_update(min(told.triangles // 1000, 9999))
    finally:
        manager.progress_end()
