"""What a call costs beside the library's own work: python crates/python/benchmarks/overhead.py

Medians of calls one after the other: the whole call, the library's own time in it (``seconds`` of the result), and the difference. Run it on
an idle machine.
"""

from __future__ import annotations

import statistics
import time

import limitmesh


def row(name: str, calls: int, **options: object) -> str:
    mesh = limitmesh.load("builtin:cup")
    whole, own = [], []
    triangles = 0
    for _ in range(calls):
        start = time.perf_counter()
        found = limitmesh.refine(mesh.vertices, mesh.faces, **options)
        whole.append(time.perf_counter() - start)
        own.append(found.seconds)
        triangles = len(found.faces)
        del found
    difference = statistics.median(a - b for a, b in zip(whole, own, strict=True))
    call = statistics.median(whole)
    return f"| {name} | {triangles:,} | {1e6 * call:,.0f} | {1e6 * difference:,.0f} | {100 * difference / call:.2f} % |"


if __name__ == "__main__":
    print("| call | triangles | µs | of which the binding | share |\n|---|---|---|---|---|")
    print(row("`triangles=1`", 500, triangles=1, threads=1, max_memory=None))
    for tolerance, calls in (("1%", 200), ("0.1%", 100), ("0.01%", 20), ("0.001%", 5)):
        for threads in (1, 2):
            print(row(f"`tolerance='{tolerance}', threads={threads}`", calls, tolerance=tolerance, threads=threads))
