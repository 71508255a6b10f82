"""MeshLab's sampled Hausdorff distance, both ways.

Usage: meshlab_distance.py A B SAMPLES; prints "forward backward seconds" (the seconds of both calls together).
"""

import sys
import time

import pymeshlab

a, b, samples = sys.argv[1], sys.argv[2], int(sys.argv[3])
meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(a)
meshes.load_new_mesh(b)


def distance(sampled, target):
    start = time.perf_counter()
    result = meshes.get_hausdorff_distance(
        sampledmesh=sampled,
        targetmesh=target,
        samplevert=True,
        sampleedge=True,
        sampleface=True,
        samplenum=samples,
        maxdist=pymeshlab.PercentageValue(50),
    )
    return result["max"], time.perf_counter() - start


forward, seconds_forward = distance(0, 1)
backward, seconds_backward = distance(1, 0)
print(forward, backward, seconds_forward + seconds_backward)
