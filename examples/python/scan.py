"""A scan smoothed: the surface passes within a tolerance of the measured points, and the picture shows how far they were moved."""

from importlib.util import find_spec

import numpy as np
from _folder import folder

import limitmesh

scan = limitmesh.load("builtin:teddy")
smooth = limitmesh.refine(scan, tolerance="0.05%", interpolate="0.2%")
# Where each vertex was on the scan's triangles, and how far that is from where it is now.
corners = np.asarray(scan.vertices)[smooth.barycentric_vertices]
moved = np.linalg.norm(smooth.vertices - np.einsum("nk,nkx->nx", smooth.barycentric, corners), axis=1)
print(f"{len(smooth.faces):,} triangles; the greatest move from the scan is {moved.max():.3g}, the mean {moved.mean():.3g}")

if find_spec("pyvista"):
    import pyvista

    mesh = limitmesh.to_pyvista(smooth)
    mesh.point_data["moved"] = moved
    plotter = pyvista.Plotter(off_screen=True, window_size=(640, 480))
    plotter.add_mesh(mesh, scalars="moved", smooth_shading=True)
    plotter.screenshot(folder() / "scan.png")
else:
    (folder() / "scan.png").write_bytes(smooth._picture(640, 480))
