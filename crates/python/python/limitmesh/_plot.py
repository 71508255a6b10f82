"""Drawing results with PyVista or Matplotlib, which are imported when they are needed."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Floats
from ._limitmesh import OptionError
from ._outgoing import Outgoing, to_pyvista

Triangles = tuple[Floats, npt.NDArray[np.integer[Any]]]


def plot(
    mesh: Triangles, outgoing: Callable[[], Outgoing], *, backend: str | None, show: bool, options: dict[str, Any]
) -> Any:
    """See `Refined.plot`; ``outgoing`` gives all that a mesh carries, to a library that draws it."""
    if backend is None:
        backend = "pyvista" if find_spec("pyvista") else "matplotlib"
    if backend not in ("pyvista", "matplotlib"):
        raise OptionError(f"backend is {backend!r}, expected 'pyvista' or 'matplotlib'")
    if find_spec(backend) is None:
        raise OptionError(f"{backend} is not installed; plot() draws with pyvista or matplotlib")
    return _pyvista(outgoing(), show, options) if backend == "pyvista" else _matplotlib(mesh, show, options)


def _pyvista(mesh: Outgoing, show: bool, options: dict[str, Any]) -> Any:
    import pyvista

    plotter = pyvista.Plotter()
    plotter.add_mesh(to_pyvista(mesh), **options)
    return plotter.show() if show else plotter


def _matplotlib(mesh: Triangles, show: bool, options: dict[str, Any]) -> Any:
    from matplotlib import pyplot

    axes: Any = pyplot.figure().add_subplot(projection="3d")
    vertices, faces = mesh
    x, y, z = vertices.T
    axes.plot_trisurf(x, y, z, triangles=np.asarray(faces), **options)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    axes.set_box_aspect(np.maximum(high - low, 1e-9 * (high - low).max() or 1.0))
    if show:
        pyplot.show()
    return axes
