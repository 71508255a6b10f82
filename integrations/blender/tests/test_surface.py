"""The smooth surface is Blender's own: the one of its Subdivision Surface modifier, with Use Limit Surface."""

import pytest

bpy = pytest.importorskip("bpy", reason="the module bpy is not installed: pip install bpy")

import numpy as np  # noqa: E402
from scenes import CUBE, HOUSE, OCTAHEDRON, SHEET, Shape, add, check_surface, smooth, subdivided  # noqa: E402


@pytest.mark.parametrize("shape", [CUBE, HOUSE, SHEET], ids=["quads", "polygons", "open"])
@pytest.mark.parametrize("tolerance", [0.05, 0.005])
def test_catmull_clark(shape, tolerance):
    an_object = add(*shape)
    witness = Shape.of(subdivided(an_object, 6))
    check_surface(smooth(an_object, tolerance), witness, tolerance)


def test_most_faces_are_quads():
    an_object = add(*HOUSE)
    smooth(an_object, 0.01)
    sides = [len(face.vertices) for face in an_object.data.polygons]
    assert sides.count(4) > 0.9 * len(sides) and set(sides) == {3, 4}


def test_it_takes_fewer_faces_where_the_surface_is_flat():
    box = add(*CUBE)
    box.data.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", np.ones(12, dtype=np.float32))
    smooth(box, 0.01)
    assert len(box.data.polygons) <= 12


@pytest.mark.parametrize("mode, stays", [("ALL", False), ("PRESERVE_CORNERS", True)])
def test_boundaries_follow_the_modifier(mode, stays):
    an_object = add(*SHEET)
    witness = Shape.of(subdivided(an_object, 6, boundary_smooth=mode))
    modifier = an_object.modifiers.new("Subdivision", "SUBSURF")
    modifier.boundary_smooth = mode
    result = smooth(an_object, 0.01)
    check_surface(result, witness, 0.01)
    assert bool((np.linalg.norm(result.vertices - SHEET[0][0], axis=1) < 1e-6).any()) is stays
    assert not modifier.show_viewport and not modifier.show_render


def creased(edges, vertices=()):
    an_object = add(*CUBE)
    of_edges = an_object.data.attributes.new("crease_edge", "FLOAT", "EDGE").data
    for row, crease in edges:
        of_edges[row].value = crease
    of_vertices = an_object.data.attributes.new("crease_vert", "FLOAT", "POINT").data
    for row, crease in vertices:
        of_vertices[row].value = crease
    return an_object


# Up to level 5 an edge of crease 0.7, whose sharpness is 4.9, is as sharp as any.
@pytest.mark.parametrize("crease, levels", [(0.2, 7), (0.45, 7), (0.7, 8), (1.0, 7)])
def test_creased_edges(crease, levels):
    an_object = creased([(0, crease), (1, crease), (5, 0.3)])
    # Where creases end Blender's limit is an approximation; its plain subdivision tends to the surface, by half a level at such places.
    coarse, fine = (Shape.of(subdivided(an_object, level, use_limit_surface=False)) for level in (levels - 2, levels))
    result = smooth(an_object, 0.01)
    assert fine.distances(result.vertices).max() <= max(0.3 * coarse.distances(result.vertices).max(), 1e-6)
    check_surface(result, fine, 0.01, off=6e-4)


@pytest.mark.parametrize("crease", [0.3, 1.0])
def test_creased_vertices(crease):
    an_object = creased([(4, 0.4)], [(0, crease), (6, crease)])
    coarse, fine = (Shape.of(subdivided(an_object, levels, use_limit_surface=False)) for levels in (5, 7))
    result = smooth(an_object, 0.01)
    assert fine.distances(result.vertices).max() <= max(0.3 * coarse.distances(result.vertices).max(), 1e-6)
    check_surface(result, fine, 0.01, off=6e-4)


def test_creases_are_left_out_with_the_modifier():
    an_object = creased([(0, 1.0)])
    an_object.modifiers.new("Subdivision", "SUBSURF").use_creases = False
    plain = Shape.of(subdivided(add(*CUBE), 6))
    check_surface(smooth(an_object, 0.01), plain, 0.01)


@pytest.mark.parametrize("scale", [(1, 1, 1), (3, 0.2, 1), (-2, 1, 1), (0.001, 0.001, 0.002)])
def test_the_tolerance_is_in_the_scene(scale):
    an_object = add(*CUBE)
    an_object.scale, an_object.rotation_euler, an_object.location = scale, (0.4, 1.1, -2.0), (100, -50, 7)
    bpy.context.view_layer.update()
    linear = np.array(an_object.matrix_world)[:3, :3]
    witness = Shape.of(subdivided(an_object, 6), linear)
    tolerance = 0.005 * max(map(abs, scale))
    check_surface(smooth(an_object, tolerance), witness, tolerance, off=1e-6 * max(map(abs, scale)))


def test_a_parent_scales_too(said):
    parent = bpy.data.objects.new("parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (100, 100, 100)
    an_object = add(*CUBE)
    an_object.parent = parent
    result = smooth(an_object, 1.0)
    assert np.abs(result.vertices).max() > 50
    alone = add(*CUBE)
    smooth(alone, 0.01)
    assert len(alone.data.polygons) == len(an_object.data.polygons)


def test_triangles_follow_loop():
    an_object = add(*OCTAHEDRON)
    result = smooth(an_object, 0.01)
    vertices, faces = np.array(OCTAHEDRON[0], dtype=float), np.array(OCTAHEDRON[1])
    for _ in range(6):
        vertices, faces = loop(vertices, faces)
    # Six levels are within 4⁻⁶ of the surface.
    check_surface(result, Shape(vertices, faces, len(faces)), 0.01, off=4.0**-6)


def test_triangles_may_follow_catmull_clark():
    an_object = add(*OCTAHEDRON)
    witness = Shape.of(subdivided(an_object, 6))
    check_surface(smooth(an_object, 0.01, scheme="CATMULL_CLARK"), witness, 0.01)


def loop(vertices, faces):
    """A step of Loop's scheme for a closed mesh, from its definition."""
    around = [set() for _ in vertices]
    opposite = {}
    for a, b, c in faces.tolist():
        for start, end, other in ((a, b, c), (b, c, a), (c, a, b)):
            around[start].update((end, other))
            opposite.setdefault((min(start, end), max(start, end)), []).append(other)
    moved = []
    for vertex, ring in zip(vertices, around):
        n = len(ring)
        beta = (0.625 - (0.375 + 0.25 * np.cos(2 * np.pi / n)) ** 2) / n
        moved.append((1 - n * beta) * vertex + beta * vertices[list(ring)].sum(axis=0))
    middle = {}
    for (a, b), (c, d) in opposite.items():
        middle[a, b] = middle[b, a] = len(moved)
        moved.append(0.375 * (vertices[a] + vertices[b]) + 0.125 * (vertices[c] + vertices[d]))
    divided = []
    for a, b, c in faces.tolist():
        ab, bc, ca = middle[a, b], middle[b, c], middle[c, a]
        divided += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.array(moved), np.array(divided)
