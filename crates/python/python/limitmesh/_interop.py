"""Results as meshes of other libraries: trimesh, PyVista and meshio, which are imported when they are needed.

Channels go back under their names. `_incoming` has the way here, and `_outgoing` what each library takes.
"""

from __future__ import annotations

import copy
from typing import Any

from . import _outgoing
from ._incoming import from_trimesh
from ._inputs import as_mesh
from ._outgoing import Outgoing
from ._options import Length
from ._refine import refine
from ._refined import Refined
from ._simplify import repair


def _outgoing_of(mesh: Refined | Any, *, sides: bool = True) -> Outgoing:
    if isinstance(mesh, Refined):
        return mesh._outgoing(sides=sides)
    mended = repair(as_mesh(mesh))
    return Outgoing(mended.vertices, mended.faces, None, {}, {}, frozenset(), None)


def refine_trimesh(mesh: Any, tolerance: Length | None = None, **options: Any) -> Any:
    """`refine` for trimesh: a ``trimesh.Trimesh`` in, a finer one out, with its material, texture coordinates, colours, attributes and metadata.

    A closed mesh stays closed: its ``is_watertight`` holds.

    Parameters
    ----------
    mesh
        A ``trimesh.Trimesh``.
    tolerance, options
        As for `refine`.

    Raises
    ------
    MeshError, OptionError
        As `refine`.

    Examples
    --------
    >>> import limitmesh
    >>> import trimesh
    >>> smooth = limitmesh.refine_trimesh(trimesh.creation.icosphere(subdivisions=1), "0.1%")
    >>> smooth.is_watertight, len(smooth.faces) > 80
    (True, True)
    """
    given = from_trimesh(mesh)
    if mesh.is_watertight:
        # Its parts may touch, and would become one.
        options.setdefault("weld", None)
    made = to_trimesh(refine(given, tolerance=tolerance, **options), visual=mesh.visual)
    made.metadata.update(copy.deepcopy(mesh.metadata))
    return made


def to_trimesh(mesh: Refined | Any, *, visual: Any = None) -> Any:
    """A ``trimesh.Trimesh`` of a result, with its limit normals, texture coordinates, colours and attributes.

    Where texture coordinates have seams, vertices stand once for each side, as trimesh has one value a vertex. Sharp edges do not
    divide them, so that a closed part is watertight; trimesh finds the normals of a mesh with sharp edges itself, and
    ``Refined.corner_normals`` has those of the limit surface.

    Parameters
    ----------
    mesh
        A result, or any mesh.
    visual
        That of the mesh which was refined, whose material is taken over.

    Examples
    --------
    >>> import limitmesh
    >>> import trimesh
    >>> limitmesh.to_trimesh(limitmesh.refine("builtin:cube", crease_angle=30)).is_watertight
    True
    """
    return _outgoing.to_trimesh(_outgoing_of(mesh, sides=False), visual)


def to_pyvista(mesh: Refined | Any) -> Any:
    """A ``pyvista.PolyData`` of a result, with its limit normals and channels as data of points and cells.

    Where channels have seams, or edges are sharp, points stand once for each side.

    >>> import limitmesh
    >>> import pyvista
    >>> limitmesh.to_pyvista(limitmesh.refine("builtin:cup")).n_open_edges
    0
    """
    return _outgoing.to_pyvista(_outgoing_of(mesh))


def to_meshio(mesh: Refined | Any) -> Any:
    """A ``meshio.Mesh`` of a result, with its channels as data of points and cells; points stand once for each side of seams.

    >>> import limitmesh
    >>> import meshio
    >>> fine = limitmesh.refine("builtin:cup")
    >>> len(limitmesh.to_meshio(fine).cells[0].data) == len(fine.faces)
    True
    """
    return _outgoing.to_meshio(_outgoing_of(mesh))
