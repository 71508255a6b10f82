"""``mesh.limitmesh`` of PyVista's datasets: PyVista 0.48 and newer import this module when it is used first (entry point ``pyvista.accessors``)."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista

from ._incoming import carried
from ._limitmesh import MeshError
from ._measure import Distance, measure
from ._options import Length
from ._outgoing import Outgoing, to_pyvista
from ._project import project
from ._refine import refine
from ._refined import Refined


@pyvista.register_dataset_accessor("limitmesh", pyvista.DataSet)
class Accessor:
    """What limitmesh does with a surface: ``mesh.limitmesh``.

    >>> import limitmesh
    >>> import pyvista
    >>> mesh = pyvista.Icosahedron()
    >>> smooth = mesh.limitmesh.refine("0.1%")
    >>> mesh.limitmesh.measure(smooth).upper > 0
    True
    """

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def refine(self, tolerance: Length | None = None, **options: Any) -> Any:
        """A ``pyvista.PolyData`` within a distance of the smooth surface, with the data of points and cells.

        Numbers of points are blended and keep their type. Whole numbers, texts and arrays with gaps (NaN) are those of the nearest
        point, and data of cells those of the cell that a triangle came from. Field data go along. A closed mesh stays closed: points
        stand once on sharp edges, and have limit normals where there are none of these.

        Parameters
        ----------
        tolerance, options
            As for `limitmesh.refine`.

        Raises
        ------
        MeshError
            The dataset is no surface; and as `limitmesh.refine`.
        OptionError
            As `limitmesh.refine`.
        """
        surface = self._surface()
        bare = surface.copy(deep=False)
        bare.cell_data.clear()
        for name, values in surface.point_data.items():
            if not _is_blended(name, values):
                bare.point_data.remove(name)
        fine = refine(bare, tolerance=tolerance, **options)
        outgoing = fine._outgoing(sides=False)
        made = to_pyvista(outgoing)
        for name, values in _data_of_points(surface, bare, fine, outgoing).items():
            made.point_data[name] = values
        if fine.parent_face is not None:
            # Points and lines are cells, too, and stand before the faces.
            cells = fine.parent_face + (surface.n_verts + surface.n_lines)
            for name, values in surface.cell_data.items():
                if name not in ("Normals", "parent_face"):
                    made.cell_data[name] = np.asarray(values)[cells]
        for name, values in surface.field_data.items():
            made.field_data[name] = values
        _show_as(surface, made)
        return made

    def measure(self, other: Any = None, **options: Any) -> Distance:
        """`limitmesh.measure`: the distance from this mesh to another one, or with ``limit_of`` to the limit surface of one."""
        return measure(self._surface(), other, **options)

    def project(self, points: Any, **options: Any) -> Any:
        """`limitmesh.project`: the closest points of this mesh's limit surface to points, or to the points of a dataset.

        A ``pyvista.PolyData`` with ``distance``, ``signed_distance``, ``Normals`` and ``face`` (of this mesh) of its points; that of a
        ``PolyData`` has its cells and data, too.
        """
        is_mesh = isinstance(points, pyvista.PolyData)
        given = np.asarray(points.points if isinstance(points, pyvista.DataSet) else points, dtype=np.float64)
        found = project(given, self._surface(), **options)
        made = points.copy() if is_mesh else pyvista.PolyData(found.points)
        made.points = found.points
        made.point_data["distance"] = found.distances
        made.point_data["signed_distance"] = found.signed
        made.point_data["face"] = np.asarray(found.faces, dtype=np.int64)
        made.point_data["Normals"] = found.normals
        made.point_data.active_normals_name = "Normals"
        made.set_active_scalars("distance")
        return made

    def _surface(self) -> Any:
        kind = type(self._dataset).__name__
        if not isinstance(self._dataset, pyvista.PolyData):
            raise MeshError(f"the {kind} is no surface, expected a PolyData: its extract_surface() gives the outside")
        if self._dataset.n_strips:
            return self._dataset.triangulate()
        if self._dataset.n_cells == self._dataset.n_verts + self._dataset.n_lines:
            raise MeshError(f"the {kind} has points and lines, but no faces")
        return self._dataset


def _is_blended(name: str, values: npt.NDArray[Any]) -> bool:
    """Whether values between those of points mean something."""
    channel = carried(name, values, "vertex")
    return channel is not None and (values.dtype.kind == "f" or channel.semantic == "colour")


def _data_of_points(surface: Any, blended: Any, fine: Refined, outgoing: Outgoing) -> dict[str, npt.NDArray[Any]]:
    """Data of points with the types that they had: those that another dataset has as well are blended, the others of the nearest point."""
    found = {}
    for name in set(blended.point_data) & set(outgoing.by_vertex):
        values, dtype = outgoing.by_vertex[name], surface.point_data[name].dtype
        values = values.reshape(len(values), *surface.point_data[name].shape[1:])
        found[name] = (np.rint(values) if dtype.kind in "iu" else values).astype(dtype)
    if fine._nearest is not None:
        nearest = fine._nearest[outgoing.sources]
        for name in set(surface.point_data) - set(blended.point_data) - {"Normals"}:
            found[name] = np.asarray(surface.point_data[name])[nearest]
    return {name: found[name] for name in surface.point_data if name in found}


def _show_as(surface: Any, made: Any) -> None:
    """Colours a mesh by the array by which another one is coloured."""
    association, name = surface.active_scalars_info
    preference = "cell" if association == pyvista.FieldAssociation.CELL else "point"
    data = made.cell_data if preference == "cell" else made.point_data
    made.set_active_scalars(name if name in data else None, preference=preference)
