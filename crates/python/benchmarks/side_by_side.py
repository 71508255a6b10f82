"""limitmesh beside other libraries' subdivision, in one run: python crates/python/benchmarks/side_by_side.py [MESH ...]

Each library that is installed refines the same mesh, Loop's scheme two levels deep or by its own threshold; limitmesh gets as many triangles
as the one with most. Told are processor seconds (all threads), triangles, the distance to the limit surface of the mesh (an interval that
is certain), and open edges of the result that the mesh has not.
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
    most = 0
    rows: list[tuple[str, Callable[[], Result]]] = []
    for peer, (module, refine) in PEERS.items():
        if find_spec(module):
            rows.append((peer, lambda refine=refine: refine(vertices.copy(), faces.copy())))
        else:
            print(f"| {peer} | not installed | | | |")
    for label, call in rows:
        try:
            call()  # Imports and first calls are not counted.
            start = time.process_time()
            v, f = call()
            seconds = time.process_time() - start
        except Exception as why:  # What others raise is told, not judged.
            print(f"| {label} | {type(why).__name__}: {str(why)[:60]} | | | |")
            continue
        most = max(most, len(f))
        tell(label, seconds, np.asarray(v, dtype=float), np.asarray(f), (vertices, faces))
    for label, options in {
        "limitmesh, as many triangles": {"triangles": most or 16 * len(faces)},
        "limitmesh, 0.1 % of the diagonal": {"tolerance": "0.1%"},
    }.items():
        start = time.process_time()
        found = limitmesh.refine(vertices, faces, **options)
        tell(label, time.process_time() - start, found.vertices, found.faces, (vertices, faces))


def tell(label: str, seconds: float, v: Any, f: Any, control: Result) -> None:
    off = limitmesh.measure((v, f), limit_of=control, certified=True)
    print(f"| {label} | {seconds:.3f} | {len(f):,} | {off.lower:.2e} to {off.upper:.2e} | {open_edges(f)} |", flush=True)


if __name__ == "__main__":
    for name in sys.argv[1:] or ["builtin:bunny", "builtin:head"]:
        compare(name)
