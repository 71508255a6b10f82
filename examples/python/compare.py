"""The distance to the limit surface at as many triangles or more: other libraries' subdivision beside exact refinement."""

from importlib.util import find_spec

import numpy as np

import limitmesh

mesh = limitmesh.load("builtin:bunny")
vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
results = {}
if find_spec("trimesh"):
    import trimesh

    results["trimesh.remesh.subdivide_loop"] = trimesh.remesh.subdivide_loop(vertices, faces, iterations=1)
if find_spec("pyvista"):
    import pyvista

    loop = pyvista.PolyData.from_regular_faces(vertices, faces).subdivide(1, subfilter="loop")
    results["pyvista subdivide, loop"] = (loop.points, loop.regular_faces)
uniform = limitmesh.refine(mesh, method="uniform", levels=1)
results["uniform, limitmesh"] = (uniform.vertices, uniform.faces)
results["exact, limitmesh"] = limitmesh.refine(mesh, triangles=len(uniform.faces))

print("| method | triangles | distance to the limit surface |\n|---|---|---|")
for name, result in results.items():
    found = limitmesh.measure(result, limit_of=mesh, certified=True)
    count = len(result.faces if isinstance(result, limitmesh.Refined) else result[1])
    print(f"| {name} | {count:,} | {found.lower:.2e} to {found.upper:.2e} |")
