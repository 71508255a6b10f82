"""Where examples write."""

import sys
import tempfile
from pathlib import Path


def folder() -> Path:
    """The folder that is named, or a temporary one."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="limitmesh-"))
    path.mkdir(parents=True, exist_ok=True)
    return path
