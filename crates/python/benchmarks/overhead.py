"""What a call costs beside the library's own work: python crates/python/benchmarks/overhead.py

The library works on threads of its own, so the processor time of the calling thread is what the binding takes: to check and copy the
arrays, start threads, wait, and hand out the results. Medians of calls one after the other, beside the processor time of all threads.
"""

from __future__ import annotations

import statistics
import time

import limitmesh


def row(name: str, calls: int, **options: object) -> str:
    cage = limitmesh.repair("builtin:head")
    whole, own = [], []
    triangles = 0
    for _ in range(calls):
        start, own_start = time.process_time(), time.thread_time()
        found = limitmesh.refine(cage.vertices, cage.faces, **options)
        own.append(time.thread_time() - own_start)
        whole.append(time.process_time() - start)
        triangles = len(found.faces)
    binding, call = statistics.median(own), statistics.median(whole)
    return f"| {name} | {triangles:,} | {1e6 * call:,.0f} | {1e6 * binding:,.0f} | {100 * binding / call:.2f} % |"


if __name__ == "__main__":
    print("| call | triangles | processor µs | of which the binding | share |\n|---|---|---|---|---|")
    for tolerance, calls in (("10%", 200), ("1%", 200), ("0.1%", 50), ("0.01%", 10), ("0.001%", 3)):
        for threads in (1, 2):
            print(row(f"`tolerance='{tolerance}', threads={threads}`", calls, tolerance=tolerance, threads=threads))
