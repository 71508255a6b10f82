"""What a mesh carries comes through as with Blender's own modifier: the same values at the same places."""

import pytest

bpy = pytest.importorskip("bpy", reason="the module bpy is not installed: pip install bpy")

import numpy as np  # noqa: E402
from scenes import CUBE, HOUSE, SHEET, Matched, Shape, add, numbered, of_corners, read, smooth, subdivided  # noqa: E402

FLOATS = {"colour": ("FLOAT_COLOR", "color", 4), "bytes": ("BYTE_COLOR", "color_srgb", 4), "heat": ("FLOAT", "value", 1), "flow": ("FLOAT_VECTOR", "vector", 3)}


@pytest.mark.parametrize("shape", [CUBE, HOUSE, SHEET], ids=["quads", "polygons", "open"])
@pytest.mark.parametrize("mode", bpy.types.SubsurfModifier.bl_rna.properties["uv_smooth"].enum_items.keys())
def test_texture_coordinates(shape, mode):
    an_object = numbered(add(*shape))
    mesh = an_object.data
    places = read(mesh.vertices, "co", 3)[read(mesh.loops, "vertex_index", 1, np.int32)]
    # One with seams everywhere, one projected through the mesh, one with a seam between two halves.
    slanted = places[:, :2] * np.float32(0.2) + places[:, 2:] * np.float32((0.05, 0.11))
    halves = slanted + (of_corners(mesh, np.arange(len(mesh.polygons)) < 3) * 5)[:, None]
    maps = {"torn": np.random.default_rng(1).random(slanted.shape), "slanted": slanted, "halves": halves}
    for name, uv in maps.items():
        mesh.uv_layers.new(name=name).uv.foreach_set("vector", uv.astype(np.float32).reshape(-1))
    mesh.uv_layers.active_index = 1
    mesh.uv_layers[2].active_render = True
    witness = subdivided(an_object, 6, uv_smooth=mode)
    an_object.modifiers.new("Subdivision", "SUBSURF").uv_smooth = mode
    smooth(an_object, 0.02)
    assert [layer.name for layer in mesh.uv_layers] == list(maps)
    assert mesh.uv_layers.active.name == "slanted" and [layer.active_render for layer in mesh.uv_layers] == [False, False, True]
    matched = Matched(mesh, witness)
    for name in maps:
        own, blenders = matched.pair(name, "vector", 2)
        np.testing.assert_allclose(own, blenders, atol=2e-6, err_msg=name)


@pytest.mark.parametrize("shape", [CUBE, HOUSE, SHEET], ids=["quads", "polygons", "open"])
@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_colours_and_other_numbers(shape, domain):
    an_object = numbered(add(*shape))
    mesh = an_object.data
    random = np.random.default_rng(2)
    for name, (kind, value, width) in FLOATS.items():
        attribute = mesh.attributes.new(name, kind, domain)
        attribute.data.foreach_set(value, random.random(width * len(attribute.data)).astype(np.float32))
    mesh.attributes.active_color_name, mesh.attributes.default_color_name = "bytes", "colour"
    witness = subdivided(an_object, 6)
    smooth(an_object, 0.02)
    assert (mesh.attributes.active_color_name, mesh.attributes.default_color_name) == ("bytes", "colour")
    matched = Matched(mesh, witness)
    for name, (kind, value, width) in FLOATS.items():
        own, blenders = matched.pair(name, value, width)
        # Blender rounds bytes twice where polygons are divided.
        np.testing.assert_allclose(own, blenders, atol=2.1 / 255 if kind == "BYTE_COLOR" else 1e-6, err_msg=name)


@pytest.mark.parametrize("shape", [CUBE, HOUSE, SHEET], ids=["quads", "polygons", "open"])
def test_vertex_groups(shape):
    an_object = numbered(add(*shape))
    random = np.random.default_rng(3)
    for name in ("all", "none", "one"):
        an_object.vertex_groups.new(name=name)
    for vertex in range(len(shape[0])):
        an_object.vertex_groups["all"].add([vertex], random.random(), "REPLACE")
    an_object.vertex_groups["one"].add([2], 0.7, "REPLACE")
    an_object.vertex_groups["one"].lock_weight = True
    an_object.vertex_groups.active_index = 2
    witness = subdivided(an_object, 6)
    smooth(an_object, 0.02)
    assert [(group.name, group.lock_weight) for group in an_object.vertex_groups] == [("all", False), ("none", False), ("one", True)]
    assert an_object.vertex_groups.active.name == "one"
    matched = Matched(an_object.data, witness)
    for group in range(3):
        own, blenders = matched.pair_of_weights(group)
        np.testing.assert_allclose(own, blenders, atol=1e-6)


def test_faces_inherit():
    an_object = numbered(add(*HOUSE))
    mesh = an_object.data
    for name in "abc":
        mesh.materials.append(bpy.data.materials.new(name))
    materials, is_flat = np.array([0, 1, 2, 0, 1, 2, 2]), np.array([0, 1, 0, 0, 1, 0, 1], dtype=bool)
    mesh.polygons.foreach_set("material_index", materials)
    mesh.polygons.foreach_set("use_smooth", ~is_flat)
    witness = subdivided(an_object, 6)
    smooth(an_object, 0.02)
    faces = read(mesh.attributes["face"].data, "value", 1, np.int32)
    np.testing.assert_array_equal(read(mesh.polygons, "material_index", 1, np.int32), materials[faces])
    np.testing.assert_array_equal(read(mesh.polygons, "use_smooth", 1, bool), ~is_flat[faces])
    assert [material.name[0] for material in mesh.materials] == ["a", "b", "c"]
    # The faces are where Blender has them: each corner is at one of the same face.
    Matched(mesh, witness)


def test_marks_of_edges_lie_along_them():
    an_object = add(*HOUSE)
    mesh = an_object.data
    marked = [(0, 1), (3, 8), (2, 7)]
    for name, kind in (("sharp_edge", "BOOLEAN"), ("uv_seam", "BOOLEAN"), ("crease_edge", "FLOAT")):
        attribute = mesh.attributes.new(name, kind, "EDGE")
        for edge in mesh.edges:
            attribute.data[edge.index].value = tuple(sorted(edge.vertices)) in marked
    witness = subdivided(an_object, 6)
    smooth(an_object, 0.01)
    for name in ("sharp_edge", "uv_seam", "crease_edge"):
        lengths, places = [], []
        for one in (mesh, witness):
            is_marked = read(one.attributes[name].data, "value") > 0
            ends = read(one.vertices, "co", 3)[read(one.edges, "vertices", 2, np.int32)[is_marked]]
            lengths.append(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum())
            places.append(ends.reshape(-1, 3))
        assert lengths[0] == pytest.approx(lengths[1], rel=1e-2)
        nearest = np.linalg.norm(places[0][:, None] - places[1], axis=2).min(axis=1)
        # Where marks end, so do creases, and Blender's limit is an approximation.
        assert nearest.max() < 1e-4


def test_whole_numbers_are_not_blended():
    an_object = add(*CUBE)
    for domain in ("POINT", "CORNER"):
        values = an_object.data.attributes.new(domain.lower(), "INT", domain).data
        values.foreach_set("value", np.arange(len(values), dtype=np.int32) * 1_000_003)
    smooth(an_object, 0.01)
    for domain in ("POINT", "CORNER"):
        attribute = an_object.data.attributes[domain.lower()]
        assert attribute.data_type == "INT" and not (read(attribute.data, "value", 1, np.int32) % 1_000_003).any()


def test_what_is_not_carried_is_reported(said):
    an_object = add(*CUBE)
    an_object.data.attributes.new("note", "STRING", "FACE")
    an_object.data.normals_split_custom_set([(0, 0, 1)] * 24)
    smooth(an_object, 0.01)
    assert "not carried: custom normals, note" in said()


def test_shape_keys_lead_to_the_surfaces_of_their_cages(said):
    an_object = add(*CUBE)
    mesh = an_object.data
    an_object.shape_key_add(name="Basis")
    up, wide = an_object.shape_key_add(name="up"), an_object.shape_key_add(name="wide")
    for row in range(4):
        up.data[row].co.z -= 1
        wide.data[row].co.x *= 2
    up.slider_max, up.value, wide.value, wide.relative_key, wide.mute = 2.0, 1.5, 0.5, up, True
    up.driver_add("value").driver.expression = "1.5"
    wide.keyframe_insert("value", frame=3)
    action = mesh.shape_keys.animation_data.action
    cages = {name: read(mesh.shape_keys.key_blocks[name].data, "co", 3).tolist() for name in ("up", "wide")}
    surfaces = {name: Shape.of(subdivided(add(cage, CUBE[1]), 6)) for name, cage in cages.items()}
    before = len(bpy.data.meshes), len(bpy.data.shape_keys)
    result = smooth(an_object, 0.01)
    assert "the distance is that of Basis" in said()
    keys = mesh.shape_keys
    assert [(one.name, one.value, one.mute, one.relative_key.name) for one in keys.key_blocks] == [
        ("Basis", keys.key_blocks[0].value, False, "Basis"), ("up", 1.5, False, "Basis"), ("wide", 0.5, True, "up"),
    ]
    assert [curve.data_path for curve in keys.animation_data.drivers] == ['key_blocks["up"].value']
    assert keys.animation_data.action == action
    np.testing.assert_allclose(read(keys.key_blocks["Basis"].data, "co", 3), result.vertices, atol=1e-6)
    for name, surface in surfaces.items():
        assert surface.distances(read(keys.key_blocks[name].data, "co", 3).astype(float)).max() < 2e-6
    assert (len(bpy.data.meshes), len(bpy.data.shape_keys)) == before
