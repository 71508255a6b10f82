"""Writing and reading of triangles with their normals by trimesh.

Usage: export.py IN.ply FOLDER REPEATS ENDING...; prints for each ending the least seconds of writing a file and of reading it.
"""

import os
import sys
import time

import trimesh

path, folder, repeats = sys.argv[1], sys.argv[2], int(sys.argv[3])
mesh = trimesh.load(path, process=False)
# Found when it is asked for first: not while a file is written.
mesh.vertex_normals

for ending in sys.argv[4:]:
    to = os.path.join(folder, f"peer.{ending}")
    least = [float("inf")] * 2
    for _ in range(repeats):
        if os.path.exists(to):
            os.remove(to)
        start = time.perf_counter()
        mesh.export(to)
        written = time.perf_counter()
        trimesh.load(to, process=False)
        read = time.perf_counter()
        least = [min(least[0], written - start), min(least[1], read - written)]
    print(*least)
