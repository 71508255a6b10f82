"""Quadric edge collapse by MeshLab or meshoptimizer.

Usage: simplify.py meshlab|meshoptimizer IN.ply OUT.ply TRIANGLES; prints the processor seconds of the collapse alone.
"""

import sys
import time

peer, path, result, triangles = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])

import numpy
import pymeshlab

meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(path)
if peer == "meshlab":
    start = time.process_time()
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=triangles, preservetopology=True)
    seconds = time.process_time() - start
else:
    import meshoptimizer

    mesh = meshes.current_mesh()
    positions = numpy.ascontiguousarray(mesh.vertex_matrix(), dtype=numpy.float32)
    indices = numpy.ascontiguousarray(mesh.face_matrix(), dtype=numpy.uint32).reshape(-1)
    out = numpy.zeros_like(indices)
    start = time.process_time()
    count = meshoptimizer.simplify(
        out, indices, positions, target_index_count=3 * triangles, target_error=1.0
    )
    seconds = time.process_time() - start
    faces = out[:count].reshape(-1, 3)
    used, renumbered = numpy.unique(faces, return_inverse=True)
    faces = renumbered.reshape(-1, 3)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(positions[used].astype(numpy.float64), faces.astype(numpy.int32)))
meshes.save_current_mesh(result, save_vertex_normal=False, save_face_quality=False)
print(seconds)
