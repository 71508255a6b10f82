"""How the program starts itself in another process: by the native half alone, as NumPy and the package take longer to import than a small
mesh to refine."""

from __future__ import annotations

import sys

from . import _limitmesh

_START = (
    "import sys; from importlib.util import module_from_spec, spec_from_file_location as spec_of; "
    "spec = spec_of('limitmesh._limitmesh', sys.argv[1]); native = module_from_spec(spec); spec.loader.exec_module(native); "
    "sys.exit(native.program(['limitmesh', *sys.argv[2:]], []))"
)


def again() -> list[str]:
    """The command, up to the program's arguments."""
    # The native half needs none of what Python finds in the user's surroundings.
    return [sys.executable, "-I", "-S", "-c", _START, _limitmesh.__file__]
