"""A refined mesh in the place of an object's mesh."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import limitmesh
import numpy as np
import numpy.typing as npt

from .control import Control, Floats, Integers, read
from .luggage import Luggage, Sources

PLACES = "places"
"""The channel that reports where on a face of the control mesh each corner is."""


def places_of(control: Control) -> limitmesh.Channel:
    """The corners of the control mesh's faces, each on a regular polygon that runs counter-clockwise on the unit circle."""
    sides = np.repeat(control.sides, control.sides)
    turns = 2.0 * np.pi / sides * (np.arange(len(sides)) - np.repeat(control.starts, control.sides))
    return limitmesh.Channel(np.column_stack([np.cos(turns), np.sin(turns)]), domain="corner", interpolation="linear")


def write(an_object: bpy.types.Object, control: Control, refined: limitmesh.Refined, luggage: Luggage, scale: Floats) -> float:
    """Replaces the object's mesh; gives how far a vertex moved at most as its coordinates became 32-bit numbers."""
    mesh = an_object.data
    positions = (refined.vertices @ np.linalg.inv(scale).T).astype(np.float32)
    moved = np.linalg.norm(positions.astype(np.float64) @ scale.T - refined.vertices, axis=1).max(initial=0.0)
    old_edges = read(mesh.edges, "vertices", 2, np.int32).astype(np.int64)[control.loose_edges]
    faces = _faces(refined)
    parents = _parents(control, refined, faces)
    vertices, loose_edges = _vertices(control, parents, old_edges)
    positions = np.concatenate([positions, read(mesh.vertices, "co", 3)[vertices[len(positions):]]])

    # A copy holds what Blender has no other place for while the shape keys are away.
    keys_of = mesh.copy() if mesh.shape_keys else None
    if keys_of:
        an_object.shape_key_clear()
    active_group = an_object.vertex_groups.active_index
    mesh.clear_geometry()
    _fill(mesh, positions, loose_edges, refined.faces.reshape(-1)[faces.corners], faces.starts)
    sources = Sources(
        refined,
        faces.corners,
        parents.faces[faces.starts],
        _edges(mesh, control, parents, loose_edges),
        np.concatenate([parents.nearest_vertices, vertices[len(refined.vertices):]]),
        vertices,
    )
    luggage.write_attributes(mesh, sources)
    luggage.write_groups(an_object, sources)
    an_object.vertex_groups.active_index = active_group
    if keys_of:
        luggage.write_keys(an_object, sources, keys_of.shape_keys)
        bpy.data.meshes.remove(keys_of)
    mesh.update()
    return float(moved)


@dataclass(frozen=True)
class _Faces:
    """The new mesh's corners, face by face, as rows of the corners of refined triangles, and where each face starts."""

    corners: Integers
    starts: Integers


def _faces(refined: limitmesh.Refined) -> _Faces:
    """Quads, and then triangles in none of them. All keep the side that they had, whichever way limitmesh turned them."""
    quads = refined.quad_corners
    is_single = np.ones(len(refined.faces), dtype=bool)
    is_single[quads // 3] = False
    singles = 3 * np.flatnonzero(is_single)[:, None] + np.arange(3)
    places = refined.at_corners(PLACES).reshape(-1, 2)
    for corners in (quads, singles):
        a, b, c = (places[corners[:, at]].T for at in range(3))
        is_turned = (b - a)[0] * (c - a)[1] < (b - a)[1] * (c - a)[0]
        corners[is_turned] = corners[is_turned, ::-1]
    starts = np.concatenate([4 * np.arange(len(quads)), 4 * len(quads) + 3 * np.arange(len(singles))])
    return _Faces(np.concatenate([quads.reshape(-1), singles.reshape(-1)]), starts)


@dataclass(frozen=True)
class _Parents:
    """Rows of the control mesh: by new corner its face, and the edge on which the side that begins there lies, or -1; by new vertex the
    nearest vertex, and the one that it is, or -1."""

    faces: Integers
    edges: Integers
    nearest_vertices: Integers
    vertices: Integers


_NEAR = 1e-9
"""What rounding does to places at most, by far."""


def _parents(control: Control, refined: limitmesh.Refined, faces: _Faces) -> _Parents:
    places = refined.at_corners(PLACES).reshape(-1, 2)[faces.corners]
    parents = refined.parent_face[faces.corners // 3]
    turn = 2.0 * np.pi / control.sides[parents]

    def rows(steps: Floats) -> Integers:
        return control.starts[parents] + steps.astype(np.int64) % control.sides[parents]

    nearest = control.corner_vertices[rows(np.round(_angle(places) / turn))]
    is_same = np.linalg.norm(places, axis=1) > 1.0 - _NEAR
    of_vertices = np.full((2, len(refined.vertices)), -1, dtype=np.int64)
    of_vertices[0, refined.faces.reshape(-1)[faces.corners]] = nearest
    of_vertices[1, refined.faces.reshape(-1)[faces.corners[is_same]]] = nearest[is_same]
    # The middle of a side is on a side of the polygon if both ends are.
    after = np.arange(1, len(places) + 1)
    after[np.append(faces.starts[1:], len(places)) - 1] = faces.starts
    middles = 0.5 * (places + places[after])
    steps = np.floor(_angle(middles) / turn)
    outwards = (steps + 0.5) * turn
    is_along = middles[:, 0] * np.cos(outwards) + middles[:, 1] * np.sin(outwards) > np.cos(0.5 * turn) - _NEAR
    return _Parents(parents, np.where(is_along, control.corner_edges[rows(steps)], -1), of_vertices[0], of_vertices[1])


def _angle(places: Floats) -> Floats:
    return np.arctan2(places[:, 1], places[:, 0]) % (2.0 * np.pi)


def _vertices(control: Control, parents: _Parents, loose_edges: Integers) -> tuple[Integers, Integers]:
    """The control mesh's vertex that each new vertex is, with the loose ones at the end, and the loose edges between new vertices."""
    # Ends of loose edges are missing where the face that they hung on was no face.
    kept = np.union1d(control.loose_vertices, np.setdiff1d(loose_edges, parents.vertices))
    vertices = np.concatenate([parents.vertices, kept])
    new = np.empty(len(control.vertices), dtype=np.int64)
    rows = np.flatnonzero(vertices >= 0)[::-1]
    new[vertices[rows]] = rows
    return vertices, new[loose_edges]


def _fill(mesh: bpy.types.Mesh, positions: npt.NDArray[np.float32], edges: Integers, corners: Integers, starts: Integers) -> None:
    """Vertices, loose edges and faces of an empty mesh."""
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.reshape(-1))
    mesh.edges.add(len(edges))
    mesh.edges.foreach_set("vertices", edges.astype(np.int32).reshape(-1))
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners.astype(np.int32))
    mesh.polygons.add(len(starts))
    mesh.polygons.foreach_set("loop_start", starts.astype(np.int32))
    mesh.update(calc_edges=True)


def _edges(mesh: bpy.types.Mesh, control: Control, parents: _Parents, loose_edges: Integers) -> Integers:
    """By new edge the one of the control mesh on which it lies, or -1."""
    found = np.full(len(mesh.edges), -1, dtype=np.int64)
    found[read(mesh.loops, "edge_index", dtype=np.int32)] = parents.edges
    old = {frozenset(ends): row for ends, row in zip(loose_edges.tolist(), control.loose_edges.tolist())}
    for row in np.flatnonzero(read(mesh.edges, "is_loose", dtype=bool)) if old else ():
        found[row] = old[frozenset(mesh.edges[row].vertices)]
    return found
