"""Smooth any triangle mesh to a tolerance: adaptive subdivision with a proven distance to the limit surface.

>>> import limitmesh
>>> cup = limitmesh.load("builtin:cup")
>>> smooth = limitmesh.refine(cup.vertices, cup.faces, tolerance="0.1%")
>>> smooth.error.certified
True

Lengths are in the mesh's unit, or as ``"0.1%"`` parts of the diagonal of its bounding box; angles are in degrees. Nothing is
changed in place. Everything raises `Error`, a ``ValueError``, where its arguments are at fault.
"""

import os as _os

from . import _limitmesh
from ._batch import Batch, batch
from ._files import refine_file, save
from ._front import Changes, Front
from ._frames import RefinedFrames, Replay, refine_frames, replay
from ._incoming import from_meshio, from_open3d, from_pyvista, from_trimesh
from ._interop import refine_trimesh, to_meshio, to_pyvista, to_trimesh
from ._level import Level
from ._levels import levels_of_detail
from ._limitmesh import Error, MeshError, OptionError, ReadError, __version__
from ._measure import Distance, Limit, OneSided, info, limit, measure
from ._mesh import Channel, Mesh
from ._options import Camera, Progress
from ._project import Projected, project
from ._rays import Intersections, intersect
from ._read import load, models
from ._refine import Estimate, estimate, refine
from ._refined import Diagnosis, ErrorBounds, Finding, Refined, Split
from ._short import StoppedShort, ToleranceNotMet
from ._simplify import Repaired, Simplified, repair, simplify
from ._surface import SurfacePoints, facing, limit_surface

if hasattr(_os, "register_at_fork"):
    # The child would have none of the threads that are kept for the next call.
    _os.register_at_fork(before=_limitmesh.end_threads)

__all__ = [
    "Batch",
    "Camera",
    "Changes",
    "Channel",
    "Diagnosis",
    "Distance",
    "Error",
    "ErrorBounds",
    "Estimate",
    "Finding",
    "Front",
    "Intersections",
    "Level",
    "Limit",
    "Mesh",
    "MeshError",
    "OneSided",
    "OptionError",
    "Progress",
    "Projected",
    "ReadError",
    "Refined",
    "RefinedFrames",
    "Repaired",
    "Replay",
    "Simplified",
    "Split",
    "StoppedShort",
    "SurfacePoints",
    "ToleranceNotMet",
    "__version__",
    "batch",
    "estimate",
    "facing",
    "from_meshio",
    "from_open3d",
    "from_pyvista",
    "from_trimesh",
    "info",
    "intersect",
    "levels_of_detail",
    "limit",
    "limit_surface",
    "load",
    "measure",
    "models",
    "project",
    "refine",
    "refine_file",
    "refine_frames",
    "refine_trimesh",
    "repair",
    "replay",
    "save",
    "simplify",
    "to_meshio",
    "to_pyvista",
    "to_trimesh",
]
