"""Distances of the modifier's levels, against distances to a far finer subdivision."""

import re

import pytest

bpy = pytest.importorskip("bpy", reason="the module bpy is not installed: pip install bpy")

import numpy as np  # noqa: E402
from scenes import CUBE, HOUSE, SHEET, Shape, activate, add, smooth, subdivided  # noqa: E402

measuring = bpy.ops.object.limitmesh_measure


def measured(said):
    """The distance, the levels and the faces that were reported."""
    said()
    assert measuring() == {"FINISHED"}
    text = said()
    found = re.search(r"Level (\d) \(([\d,]+) faces.*\) is within (.*) of the limit surface, proven, .* limitmesh needs ([\d,]+) face", text)
    assert found, text
    distance = bpy.utils.units.to_value("METRIC", "LENGTH", found[3])
    return distance, int(found[1]), int(found[2].replace(",", "")), int(found[4].replace(",", ""))


def distance(result, witness):
    """What is found of the distance between a mesh and a surface."""
    return max(witness.distances(result.samples()).max(), result.distances(witness.vertices).max())


@pytest.mark.parametrize("shape", [CUBE, HOUSE, SHEET], ids=["quads", "polygons", "open"])
@pytest.mark.parametrize("on_limit", [False, True])
def test_levels(said, shape, on_limit):
    an_object = add(*shape)
    an_object.scale = (2, 1, 1)
    bpy.context.view_layer.update()
    scale = np.diag((2.0, 1.0, 1.0))
    witness = Shape.of(subdivided(an_object, 7), scale)
    modifier = an_object.modifiers.new("Subdivision", "SUBSURF")
    modifier.use_limit_surface = on_limit
    for levels in (1, 2, 3):
        activate(an_object)
        modifier.levels = levels
        told, level, faces, needed = measured(said)
        coarse = subdivided(an_object, 0)
        own = Shape.of(coarse, scale)
        found = distance(own, witness)
        assert level == levels and faces == own.faces
        assert found <= told <= 1.15 * found + 1e-4, levels
        # As many faces are enough for this distance.
        copy = add(*shape)
        copy.scale = (2, 1, 1)
        smooth(copy, told)
        assert abs(len(copy.data.polygons) - needed) <= 0.02 * needed


def test_modifiers_before_and_after(said):
    half = add([(x + 1, y, z) for x, y, z in CUBE[0]], [face for face in CUBE[1] if face != (0, 4, 6, 2)])
    half.modifiers.new("Mirror", "MIRROR")
    modifier = half.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    wave = half.modifiers.new("Cast", "CAST")
    told, _, faces, _ = measured(said)
    assert [one.show_viewport for one in half.modifiers] == [True] * 3 and wave.factor == 0.5
    assert faces == 160
    # The same box, made without a mirror.
    whole = add(
        [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-2, 0, 2)],
        [(0, 3, 4, 1), (1, 4, 5, 2), (6, 7, 10, 9), (7, 8, 11, 10), (0, 1, 7, 6), (1, 2, 8, 7), (3, 9, 10, 4), (4, 10, 11, 5), (0, 6, 9, 3), (2, 5, 11, 8)],
    )
    whole.modifiers.new("Subdivision", "SUBSURF").levels = 2
    assert measured(said)[0] == pytest.approx(told, rel=0.1)


def test_a_low_quality_is_found(said):
    an_object = add(*CUBE)
    an_object.data.attributes.new("crease_vert", "FLOAT", "POINT").data[5].value = 1.0
    modifier = an_object.modifiers.new("Subdivision", "SUBSURF")
    modifier.use_limit_surface, modifier.levels, modifier.quality = True, 4, 2
    low = measured(said)[0]
    modifier.quality = 8
    assert low > 2 * measured(said)[0]


def test_refusals():
    an_object = add(*CUBE)
    assert not measuring.poll()
    modifier = an_object.modifiers.new("Subdivision", "SUBSURF")
    assert measuring.poll()
    modifier.subdivision_type = "SIMPLE"
    with pytest.raises(RuntimeError, match="set to Simple"):
        measuring()
    modifier.subdivision_type, modifier.levels = "CATMULL_CLARK", 6
    an_object.modifiers.new("Again", "SUBSURF").levels = 4
    with pytest.raises(RuntimeError, match="lower its viewport level"):
        measuring()
    assert all(one.show_viewport for one in an_object.modifiers)
    modifier.show_viewport = an_object.modifiers[1].show_viewport = False
    assert not measuring.poll()
