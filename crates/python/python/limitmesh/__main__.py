"""The program ``limitmesh``, also as ``python -m limitmesh``."""

from __future__ import annotations

import sys

from ._again import again
from ._limitmesh import program


def main() -> int:
    """Runs the program with the arguments of this process; its exit code."""
    return program(["limitmesh", *sys.argv[1:]], again())


if __name__ == "__main__":
    sys.exit(main())
