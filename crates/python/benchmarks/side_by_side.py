"""limitmesh beside other libraries' subdivision, in one run: python crates/python/benchmarks/side_by_side.py [MESH ...]

Each library that is installed refines the same mesh, Loop's scheme two levels deep or by its own threshold; limitmesh gets as many triangles
as the one with most. Told are processor seconds (all threads; the least of calls that take turns, the first of each not counted), triangles,
the distance to the limit surface of the mesh (an interval that is certain), and open edges of the result.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np

import limitmesh

Result = tuple[Any, Any]


def trimesh_loop(v: Any, f: Any) -> Result:
    import trimesh

    return trimesh.remesh.subdivide_loop(v, f, iterations=2)


def pyvista_adaptive(v: Any, f: Any) -> Result:
    import pyvista

    edge = np.linalg.norm(v[f[:, 0]] - v[f[:, 1]], axis=1).mean()
    fine = pyvista.PolyData.from_regular_faces(v, f).subdivide_adaptive(max_edge_len=edge / 4)
    return np.asarray(fine.points, dtype=float), fine.regular_faces


def pymeshlab_loop(v: Any, f: Any) -> Result:
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(v, f))
    edge = np.linalg.norm(v[f[:, 0]] - v[f[:, 1]], axis=1).mean()
    meshes.meshing_surface_subdivision_loop(iterations=3, threshold=pymeshlab.PureValue(edge / 4))
    fine = meshes.current_mesh()
    return fine.vertex_matrix(), fine.face_matrix()


def igl_loop(v: Any, f: Any) -> Result:
    import igl

    return igl.loop(v, f, 2)


def gpytoolbox_loop(v: Any, f: Any) -> Result:
    import gpytoolbox

    return gpytoolbox.subdivide(v, f, method="loop", iters=2)


PEERS: dict[str, tuple[str, Callable[[Any, Any], Result]]] = {
    "trimesh `remesh.subdivide_loop`": ("trimesh", trimesh_loop),
    "PyVista `subdivide_adaptive`": ("pyvista", pyvista_adaptive),
    "PyMeshLab Loop with a threshold": ("pymeshlab", pymeshlab_loop),
    "libigl `loop`": ("igl", igl_loop),
    "gpytoolbox `subdivide`": ("gpytoolbox", gpytoolbox_loop),
}


def open_edges(faces: Any) -> int:
    edges = np.sort(np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] == 1).sum())


def compare(name: str) -> None:
    mended = limitmesh.repair(name)
    vertices, faces = mended.vertices, mended.faces
    print(f"\n{name}: {len(faces):,} triangles, {open_edges(faces)} open edges\n")
    print("| | s | triangles | distance to the limit surface | open edges |\n|---|---|---|---|---|")
    calls: dict[str, Callable[[], Result]] = {}
    results: dict[str, Result] = {}
    for peer, (module, refine) in PEERS.items():
        if not find_spec(module):
            print(f"| {peer} | not installed | | | |")
            continue
        call = lambda refine=refine: refine(vertices.copy(), faces.copy())
        try:
            results[peer] = call()
        except Exception as why:  # What others raise is told, not judged.
            print(f"| {peer} | {type(why).__name__}: {str(why)[:60]} | | | |")
            continue
        calls[peer] = call
    most = max((len(f) for _, f in results.values()), default=16 * len(faces))
    for label, options in {
        "limitmesh, as many triangles as the most": {"triangles": most},
        "limitmesh, within 0.1 % of the diagonal": {"tolerance": "0.1%"},
        "limitmesh, uniformly, twice": {"method": "uniform", "levels": 2},
    }.items():
        calls[label] = lambda options=options: limited(vertices, faces, options)
        results[label] = calls[label]()
    least = dict.fromkeys(calls, float("inf"))
    for _ in range(ROUNDS):
        for label, call in calls.items():
            start = time.process_time()
            call()
            least[label] = min(least[label], time.process_time() - start)
    for label, (v, f) in results.items():
        off = limitmesh.measure((np.asarray(v, dtype=float), np.asarray(f)), limit_of=(vertices, faces), certified=True)
        print(f"| {label} | {least[label]:.4f} | {len(f):,} | {off.lower:.2e} to {off.upper:.2e} | {open_edges(np.asarray(f))} |", flush=True)


def limited(v: Any, f: Any, options: dict[str, Any]) -> Result:
    found = limitmesh.refine(v, f, **options)
    return found.vertices, found.faces


ROUNDS = 10


if __name__ == "__main__":
    for name in sys.argv[1:] or ["builtin:bunny", "builtin:head"]:
        compare(name)
