"""Drawing results with PyVista or Matplotlib, which are imported when they are needed."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np

from ._limitmesh import OptionError

if TYPE_CHECKING:
    from ._refined import Refined


def plot(mesh: Refined, *, backend: str | None, show: bool, options: dict[str, Any]) -> Any:
    """See `Refined.plot`."""
    if backend is None:
        backend = "pyvista" if find_spec("pyvista") else "matplotlib"
    if backend not in ("pyvista", "matplotlib"):
        raise OptionError(f"backend is {backend!r}, expected 'pyvista' or 'matplotlib'")
    if find_spec(backend) is None:
        raise OptionError(f"{backend} is not installed; plot() draws with pyvista or matplotlib")
    return (_pyvista if backend == "pyvista" else _matplotlib)(mesh, show, options)


def _pyvista(mesh: Refined, show: bool, options: dict[str, Any]) -> Any:
    import pyvista

    from ._interop import to_pyvista

    plotter = pyvista.Plotter()
    plotter.add_mesh(to_pyvista(mesh), **options)
    return plotter.show() if show else plotter


def _matplotlib(mesh: Refined, show: bool, options: dict[str, Any]) -> Any:
    from matplotlib import pyplot

    axes: Any = pyplot.figure().add_subplot(projection="3d")
    x, y, z = mesh.vertices.T
    axes.plot_trisurf(x, y, z, triangles=np.asarray(mesh.faces), **options)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    axes.set_box_aspect(np.maximum(high - low, 1e-9 * (high - low).max() or 1.0))
    if show:
        pyplot.show()
    return axes
