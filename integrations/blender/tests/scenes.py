"""Objects to smooth, and Blender's own surface to compare with."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

CUBE = (
    [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)],
    [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
)

# A house: two faces have five sides.
HOUSE = (
    [(x, y, z) for z in (0, 2) for x, y in ((0, 0), (2, 0), (2, 2), (1, 3), (0, 2))],
    [(4, 3, 2, 1, 0), (5, 6, 7, 8, 9), (0, 1, 6, 5), (1, 2, 7, 6), (2, 3, 8, 7), (3, 4, 9, 8), (4, 0, 5, 9)],
)
# A sheet with open edges, bent.
SHEET = (
    [(x, y, 0.3 * x * y - 0.2 * x * x) for y in range(4) for x in range(4)],
    [(x + 4 * y, x + 1 + 4 * y, x + 5 + 4 * y, x + 4 + 4 * y) for y in range(3) for x in range(3)],
)
OCTAHEDRON = (
    [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)],
    [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)],
)


def add(vertices, faces, edges=(), name="object"):
    """A mesh object, active and alone selected."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, edges, faces)
    return link(mesh, name)


def link(mesh, name="object"):
    an_object = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(an_object)
    activate(an_object)
    return an_object


def activate(an_object):
    bpy.context.view_layer.update()
    for other in bpy.context.view_layer.objects:
        other.select_set(other == an_object)
    bpy.context.view_layer.objects.active = an_object


def smooth(an_object, tolerance=0.0, **options):
    activate(an_object)
    assert bpy.ops.object.limitmesh_smooth(tolerance=tolerance, **options) == {"FINISHED"}
    assert not an_object.data.validate(verbose=True)
    return Shape.of(an_object.data, np.array(an_object.matrix_world)[:3, :3])


def read(items, name, width=1, dtype=np.float32):
    flat = np.empty(len(items) * width, dtype)
    items.foreach_get(name, flat)
    return flat if width == 1 else flat.reshape(-1, width)


@dataclass
class Shape:
    """A mesh as arrays, with its object's scale."""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: int

    @staticmethod
    def of(mesh, scale=np.eye(3)):
        mesh.calc_loop_triangles()
        triangles = read(mesh.loop_triangles, "vertices", 3, np.int32)
        return Shape(read(mesh.vertices, "co", 3).astype(float) @ scale.T, triangles, len(mesh.polygons))

    def distances(self, points):
        """From points to the triangles."""
        tree = BVHTree.FromPolygons(self.vertices.tolist(), self.triangles.tolist())
        return np.array([tree.find_nearest(point)[3] for point in points.tolist()])

    def samples(self):
        """Corners, middles of edges and middles of triangles."""
        corners = self.vertices[self.triangles]
        return np.concatenate([self.vertices[np.unique(self.triangles)], corners.mean(axis=1), corners[:, :2].mean(axis=1), corners[:, 1:].mean(axis=1)])


def subdivided(an_object, levels=5, **settings):
    """A copy of the mesh that Blender's own modifier makes, with vertices on the limit surface."""
    modifier = an_object.modifiers.new("Witness", "SUBSURF")
    modifier.levels, modifier.quality, modifier.use_limit_surface = levels, 10, True
    for name, value in settings.items():
        setattr(modifier, name, value)
    evaluated = an_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(evaluated, preserve_all_data_layers=True, depsgraph=bpy.context.evaluated_depsgraph_get())
    an_object.modifiers.remove(modifier)
    return mesh


def check_surface(result, witness, tolerance, off=1e-6):
    """A result is within the tolerance of Blender's surface, either way, and no vertex is farther off it than this."""
    assert witness.distances(result.vertices[np.unique(result.triangles)]).max() <= off
    assert witness.distances(result.samples()).max() <= tolerance
    assert result.distances(witness.vertices).max() <= tolerance


class Matched:
    """The corners of a result, and those of Blender's own mesh at the same place of the same face.

    Faces are told apart by the attribute `face`, which both meshes inherit; vertices of both are on the limit surface, so that those at one
    place of the control mesh are at one place.
    """

    def __init__(self, mesh, witness):
        self.mesh, self.witness = mesh, witness
        # Shifted, so that no place lies where rounding goes either way.
        places = [np.column_stack([np.round(self._positions(one) + 3.1e-5, 4) + 0.0, self._faces(one)]) for one in (mesh, witness)]
        of_place = {tuple(place): row for row, place in enumerate(places[1].tolist())}
        found = [of_place.get(tuple(place), -1) for place in places[0].tolist()]
        assert min(found) >= 0, "a corner is at no corner of Blender's mesh"
        self.corners, self.vertices = np.array(found), read(mesh.loops, "vertex_index", 1, np.int32)

    @staticmethod
    def _positions(mesh):
        return read(mesh.vertices, "co", 3)[read(mesh.loops, "vertex_index", 1, np.int32)]

    @staticmethod
    def _faces(mesh):
        return of_corners(mesh, read(mesh.attributes["face"].data, "value", 1, np.int32))

    def pair(self, name, value, width):
        """An attribute of vertices or corners of both meshes, by corner of the result."""
        found = []
        for mesh in (self.mesh, self.witness):
            attribute = mesh.attributes[name]
            values = read(attribute.data, value, width).reshape(-1, width)
            found.append(values[read(mesh.loops, "vertex_index", 1, np.int32)] if attribute.domain == "POINT" else values)
        return found[0], found[1][self.corners]

    def pair_of_weights(self, group):
        found = []
        for mesh in (self.mesh, self.witness):
            weights = np.array([next((one.weight for one in vertex.groups if one.group == group), 0.0) for vertex in mesh.vertices])
            found.append(weights[read(mesh.loops, "vertex_index", 1, np.int32)])
        return found[0], found[1][self.corners]


def of_corners(mesh, of_faces):
    """Values of faces, at their corners."""
    return np.repeat(of_faces, read(mesh.polygons, "loop_total", 1, np.int32), axis=0)


def numbered(an_object):
    """The same object with the attribute `face`."""
    faces = an_object.data.attributes.new("face", "INT", "FACE")
    faces.data.foreach_set("value", np.arange(len(an_object.data.polygons), dtype=np.int32))
    return an_object
