"""A refined mesh in the place of an object's mesh."""

from __future__ import annotations

import bpy
import limitmesh
import numpy as np

from .control import Control, Floats, Integers, read
from .luggage import Luggage, Sources


def write(an_object: bpy.types.Object, control: Control, refined: limitmesh.Refined, luggage: Luggage, scale: Floats) -> float:
    """Replaces the object's mesh; gives how far a vertex moved at most as its coordinates became 32-bit numbers."""
    mesh = an_object.data
    positions = (refined.vertices @ np.linalg.inv(scale).T).astype(np.float32)
    moved = np.linalg.norm(positions.astype(np.float64) @ scale.T - refined.vertices, axis=1).max(initial=0.0)
    old_edges = read(mesh.edges, "vertices", 2, np.int32).astype(np.int64)
    vertices, loose_edges = _vertices(control, refined, old_edges)
    loose = vertices[len(refined.vertices):]
    positions = np.concatenate([positions, read(mesh.vertices, "co", 3)[loose]])
    corners, starts = _faces(refined)

    # A copy holds what Blender has no other place for while the shape keys are away.
    keys_of = mesh.copy() if mesh.shape_keys else None
    if keys_of:
        an_object.shape_key_clear()
    mesh.clear_geometry()
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.reshape(-1))
    mesh.edges.add(len(loose_edges))
    mesh.edges.foreach_set("vertices", loose_edges.astype(np.int32).reshape(-1))
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", refined.faces.reshape(-1)[corners].astype(np.int32))
    mesh.polygons.add(len(starts))
    mesh.polygons.foreach_set("loop_start", starts.astype(np.int32))
    mesh.update(calc_edges=True)

    new_edges = read(mesh.edges, "vertices", 2, np.int32)
    sources = Sources(
        refined,
        corners,
        refined.parent_face[corners[starts] // 3],
        _parent_edges(new_edges, refined, loose, old_edges, len(control.vertices)),
        np.concatenate([_nearest(refined), loose]),
        vertices,
    )
    luggage.write_attributes(mesh, sources)
    luggage.write_groups(an_object, sources)
    if keys_of:
        luggage.write_keys(an_object, sources, keys_of.shape_keys)
        bpy.data.meshes.remove(keys_of)
    mesh.update()
    return float(moved)


SIDES = "sides"
"""The channel by which faces keep the side that they had, whichever way limitmesh turned them to agree with each other."""


def sides_of(control: Control) -> limitmesh.Channel:
    """Every face as a regular polygon that runs counter-clockwise."""
    turns = np.concatenate([np.arange(len(face)) * (2.0 * np.pi / len(face)) for face in control.faces])
    return limitmesh.Channel(np.column_stack([np.cos(turns), np.sin(turns)]), domain="corner", interpolation="linear")


def _faces(refined: limitmesh.Refined) -> tuple[Integers, Integers]:
    """Rows of the triangles' corners, face by face, and where each face starts: quads, and then triangles in none of them."""
    quads = refined.quad_corners
    is_single = np.ones(len(refined.faces), dtype=bool)
    is_single[quads // 3] = False
    singles = 3 * np.flatnonzero(is_single)[:, None] + np.arange(3)
    on_polygon = refined.at_corners(SIDES).reshape(-1, 2)
    for corners in (quads, singles):
        a, b, c = (on_polygon[corners[:, at]].T for at in range(3))
        is_turned = (b - a)[0] * (c - a)[1] < (b - a)[1] * (c - a)[0]
        corners[is_turned] = corners[is_turned, ::-1]
    starts = np.concatenate([4 * np.arange(len(quads)), 4 * len(quads) + 3 * np.arange(len(singles))])
    return np.concatenate([quads.reshape(-1), singles.reshape(-1)]), starts


def _vertices(control: Control, refined: limitmesh.Refined, old_edges: Integers) -> tuple[Integers, Integers]:
    """The control mesh's vertex that each new vertex is, with the loose ones at the end, and the loose edges between new vertices."""
    nearest = _nearest(refined)
    own = np.where(refined.barycentric.max(axis=1) == 1.0, nearest, -1)
    loose = old_edges[control.loose_edges]
    # Ends of loose edges are missing where the face that they hung on was no face.
    kept = np.union1d(control.loose_vertices, np.setdiff1d(loose, own))
    vertices = np.concatenate([own, kept])
    new = np.empty(len(control.vertices), dtype=np.int64)
    rows = np.flatnonzero(vertices >= 0)[::-1]
    new[vertices[rows]] = rows
    return vertices, new[loose]


def _nearest(refined: limitmesh.Refined) -> Integers:
    """For each vertex the one of the control mesh that it is made of for the most part."""
    best = refined.barycentric.argmax(axis=1)
    return np.take_along_axis(refined.barycentric_vertices, best[:, None], axis=1)[:, 0]


def _parent_edges(edges: Integers, refined: limitmesh.Refined, loose: Integers, old_edges: Integers, count: int) -> Integers:
    """The edge of the control mesh that each edge lies on, or -1."""
    weights, of = refined.barycentric, refined.barycentric_vertices
    # The ends of what a vertex lies on: twice itself for one that was there, nothing for one inside a face.
    low = np.where(weights > 0.0, of, count).min(axis=1)
    high = np.where(weights > 0.0, of, -1).max(axis=1)
    low[(weights > 0.0).sum(axis=1) == 3] = -1
    low, high = np.concatenate([low, loose]), np.concatenate([high, loose])
    first, last = low[edges].min(axis=1), high[edges].max(axis=1)
    ends = np.stack([low[edges], high[edges]])
    is_along = ((ends == first[:, None]) | (ends == last[:, None])).all(axis=(0, 2)) & (first >= 0)
    keys = old_edges.min(axis=1) * count + old_edges.max(axis=1)
    order = np.argsort(keys)
    wanted = first * count + last
    at = order[np.searchsorted(keys, wanted, sorter=order).clip(max=len(keys) - 1)] if len(keys) else np.zeros(len(edges), dtype=np.int64)
    return np.where(is_along & (keys[at] == wanted), at, -1) if len(keys) else at - 1
