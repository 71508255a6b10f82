"""What a user meets: refusals, reports, undo, caps, shared meshes."""

import pytest

bpy = pytest.importorskip("bpy", reason="the module bpy is not installed: pip install bpy")

import numpy as np  # noqa: E402
from scenes import CUBE, HOUSE, Shape, activate, add, link, read, smooth, subdivided  # noqa: E402

smoothing = bpy.ops.object.limitmesh_smooth


def test_the_report_is_proven(said):
    smooth(add(*CUBE), 0.01)
    assert said().startswith("Info: Within 8.097 mm of the limit surface, proven; 516 faces")


@pytest.mark.parametrize("system, unit, scale, expected", [
    ("METRIC", 0.01, 1.0, " mm of"), ("METRIC", 0.01, 0.001, " µm of"), ("IMPERIAL", 0.01, 1.0, " thou of"), ("NONE", 0.01, 1.0, "Within 0.008097 of"),
])
def test_the_report_has_the_scenes_unit_and_never_rounds_down(said, system, unit, scale, expected):
    settings = bpy.context.scene.unit_settings
    settings.system, settings.scale_length = system, scale
    an_object = add(*CUBE)
    witness = Shape.of(subdivided(an_object, 6))
    result = smooth(an_object, unit)
    text = said()
    assert expected in text
    told = bpy.utils.units.to_value(system, "LENGTH", text.split("Within ")[1].split(" of the")[0]) / (1.0 if system == "NONE" else scale)
    found = max(witness.distances(result.samples()).max(), result.distances(witness.vertices).max())
    assert found <= told <= unit * 1.001


@pytest.mark.parametrize("system", ["METRIC", "IMPERIAL", "NONE"])
def test_flat_meshes_have_no_distance_but_that_of_rounding(said, system):
    bpy.context.scene.unit_settings.system = system
    an_object = add([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    an_object.data.attributes.new("crease_vert", "FLOAT", "POINT").data.foreach_set("value", np.ones(4, dtype=np.float32))
    smooth(an_object, 0.01)
    text = said().split("Within ")[1].split(" of the")[0]
    assert 0.0 < bpy.utils.units.to_value(system, "LENGTH", text) < 1e-4


def test_without_a_tolerance_it_is_a_thousandth_of_the_size():
    an_object, other = add(*CUBE), add(*CUBE)
    smooth(an_object)
    smooth(other, 0.001 * np.sqrt(12))
    assert len(an_object.data.polygons) == len(other.data.polygons) > 1000


def test_undo_and_redo():
    add(*CUBE, name="cube")
    bpy.ops.ed.undo_push(message="before")
    smooth(bpy.data.objects["cube"], 0.01)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    mesh = bpy.data.objects["cube"].data
    assert len(mesh.polygons) == 6 and np.abs(read(mesh.vertices, "co", 3)).min() == 1.0
    bpy.ops.ed.redo()
    assert len(bpy.data.objects["cube"].data.polygons) == 516
    assert {"REGISTER", "UNDO"} <= set(bpy.types.OBJECT_OT_limitmesh_smooth.bl_options)


def test_where_it_cannot_be_called():
    an_object = add(*CUBE)
    assert smoothing.poll()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not smoothing.poll()
    with pytest.raises(RuntimeError, match="Object Mode"):
        smoothing(tolerance=0.01)
    bpy.ops.object.mode_set(mode="OBJECT")
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    activate(camera)
    assert not smoothing.poll()
    bpy.context.view_layer.objects.active = None
    assert not smoothing.poll()
    assert len(an_object.data.polygons) == 6


@pytest.mark.parametrize("vertices, faces, edges", [([], [], []), ([(0, 0, 0), (1, 0, 0)], [], [(0, 1)])], ids=["empty", "an edge"])
def test_meshes_without_faces_are_refused(vertices, faces, edges):
    an_object = add(vertices, faces, edges)
    with pytest.raises(RuntimeError, match="the mesh has no faces"):
        smoothing(tolerance=0.01)
    assert len(an_object.data.vertices) == len(vertices)


def test_flat_objects_and_multiresolution_are_refused():
    an_object = add(*CUBE)
    an_object.scale.x = 0
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="a scale of 0"):
        smoothing(tolerance=0.01)
    an_object.scale.x = 1
    bpy.context.view_layer.update()
    an_object.modifiers.new("Multires", "MULTIRES")
    with pytest.raises(RuntimeError, match="Multiresolution"):
        smoothing(tolerance=0.01)
    assert len(an_object.data.polygons) == 6


def test_loose_parts_stay(said):
    loose = [(2, 2, 2), (3, 2, 2), (5, 5, 5)]
    an_object = add(CUBE[0] + loose, CUBE[1], [(7, 8), (8, 9)])
    an_object.vertex_groups.new(name="loose").add([9, 10], 0.5, "REPLACE")
    heat = an_object.data.attributes.new("heat", "FLOAT", "POINT")
    heat.data.foreach_set("value", np.arange(11, dtype=np.float32))
    smooth(an_object, 0.01)
    assert "3 vertices and 2 edges in no face kept as they are" in said()
    mesh = an_object.data
    edges = [sorted(tuple(mesh.vertices[end].co) for end in edge.vertices) for edge in mesh.edges if edge.is_loose]
    # The vertex on which the edges hang stays where it is, as in Blender.
    assert sorted(edges) == [[(1, 1, 1), (2, 2, 2)], [(2, 2, 2), (3, 2, 2)]]
    last = len(mesh.vertices) - 3
    assert [tuple(vertex.co) for vertex in mesh.vertices[last:]] == loose
    assert [round(heat.value, 6) for heat in mesh.attributes["heat"].data[last:]] == [8, 9, 10]
    assert [[element.weight for element in vertex.groups] for vertex in mesh.vertices[last:]] == [[], [0.5], [0.5]]


def test_an_object_that_shares_its_mesh(said):
    an_object = add(*CUBE)
    other = link(an_object.data, "other")
    smooth(an_object, 0.01)
    assert other.data == an_object.data and "2 objects share the mesh, and all changed" in said()


def test_the_cap_is_kept_and_reported(said):
    an_object = add(*CUBE)
    smooth(an_object, 1e-4, most=2000)
    text = said()
    assert "0.1 mm not reached, since it takes more than 2,000 triangles. Within " in text and text.startswith("Warning: ")
    assert len(an_object.data.loops) - 2 * len(an_object.data.polygons) <= 2000


def test_tolerances_below_single_precision_are_reported(said):
    an_object = add([(x + 1e4, y, z) for x, y, z in CUBE[0]], CUBE[1])
    smooth(an_object, 5e-4)
    assert "not reached, since single precision ends before" in said()


def test_faces_keep_their_sides(said):
    vertices, faces = CUBE
    for turned in ([], range(6), [0]):
        own = [face[::-1] if row in turned else face for row, face in enumerate(faces)]
        an_object = add(vertices, own)
        an_object.data.attributes.new("face", "INT", "FACE").data.foreach_set("value", np.arange(6, dtype=np.int32))
        smooth(an_object, 0.01)
        rows = read(an_object.data.attributes["face"].data, "value", 1, np.int32)
        normals, middles = (read(an_object.data.polygons, name, 3) for name in ("normal", "center"))
        np.testing.assert_array_equal((normals * middles).sum(axis=1) < 0, np.isin(rows, list(turned)))
        assert "Warning" not in said()


def test_sheets_at_an_edge_are_reported(said):
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, -1, 0.5), (1, -1, 0.5)]
    smooth(add(vertices, [(0, 1, 3, 2), (0, 1, 5, 4), (0, 1, 7, 6)]), 0.01)
    assert "1 edge with more than two faces: cut into sheets" in said()


def test_equal_places_are_not_joined():
    # Two squares side by side that share no vertex.
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0)]
    an_object = add(vertices, [(0, 1, 2, 3), (4, 5, 6, 7)])
    witness = Shape.of(subdivided(an_object, 5))
    result = smooth(an_object, 0.01)
    assert witness.distances(result.vertices).max() < 1e-6 and witness.vertices[:, 0].max() == pytest.approx(result.vertices[:, 0].max())


def test_what_hangs_on_the_object_stays():
    an_object = add(*HOUSE)
    an_object["note"], an_object.data["note"] = 1, 2
    mirror = an_object.modifiers.new("Mirror", "MIRROR")
    name = an_object.data.name
    smooth(an_object, 0.05)
    assert (an_object["note"], an_object.data["note"], an_object.data.name) == (1, 2, name)
    assert mirror.show_viewport and len(an_object.modifiers) == 1
