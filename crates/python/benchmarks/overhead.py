"""What a call costs beside the library's own work: python crates/python/benchmarks/overhead.py

The time of a call, less the time that the library took in it (`Refined.seconds`): arguments are checked and copied, a thread is woken, indices
become those of NumPy, and results are handed out. Told are the least of many calls, which is what the binding costs where nothing else
disturbs, their median, and both as a part of the call; and the processor time of the calling thread, whose least has nobody else's in it.
The cases take turns, so that whatever else the machine does meets all of them.
"""

from __future__ import annotations

import gc
import statistics
import time

import numpy as np

import limitmesh

TETRAHEDRON = (np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]), np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))


def mesh_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    cage = limitmesh.repair(name)
    return cage.vertices, cage.faces


def measured(mesh: tuple[np.ndarray, np.ndarray], options: dict[str, object]) -> tuple[float, float, float, int]:
    """Seconds of a call, of the binding in it and of the calling thread's processor, and triangles."""
    own, start = time.thread_time(), time.perf_counter()
    found = limitmesh.refine(*mesh, **options)
    call = time.perf_counter() - start
    return call, call - found.seconds, time.thread_time() - own, len(found.faces)


if __name__ == "__main__":
    head, bunny = mesh_of("builtin:head"), mesh_of("builtin:bunny")
    dense = limitmesh.refine("builtin:bunny", tolerance="0.02%")
    meshes = {
        "a tetrahedron": (TETRAHEDRON, ("50%",), 2000),
        "builtin:head": (head, ("10%", "0.1%", "0.01%"), 100),
        "builtin:bunny": (bunny, ("0.001%",), 10),
        "builtin:bunny, made dense": ((dense.vertices, dense.faces), ("0.5%",), 10),
    }
    cases = [
        (f"{name}, {len(mesh[1]):,} triangles", mesh, {"tolerance": tolerance, "threads": threads}, calls)
        for name, (mesh, tolerances, calls) in meshes.items()
        for tolerance in tolerances
        for threads in (1, 2)
    ]
    for _, mesh, options, _ in cases:
        measured(mesh, options)
    gc.collect()
    found: list[list[tuple[float, float, float, int]]] = [[] for _ in cases]
    rounds = 10
    for _ in range(rounds):
        for row, (_, mesh, options, calls) in zip(found, cases, strict=True):
            row.extend(measured(mesh, options) for _ in range(calls // rounds))
    print("| mesh | options | triangles | call, µs | binding, µs: least | median | part: least | median | processor of the caller, µs: least |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row, (name, _, options, _) in zip(found, cases, strict=True):
        call, binding, own = (sorted(one[i] for one in row) for i in range(3))
        parts = statistics.median(one[1] / one[0] for one in row)
        print(f"| {name} | {options['tolerance']}, {options['threads']} threads | {row[0][3]:,} | {1e6 * call[0]:,.0f} | {1e6 * binding[0]:,.0f} "
              f"| {1e6 * statistics.median(binding):,.0f} | {100 * binding[0] / call[0]:.2f} % | {100 * parts:.2f} % | {1e6 * own[0]:,.0f} |")
