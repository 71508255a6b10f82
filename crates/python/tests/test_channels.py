"""What is carried along, against interpolation by hand."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh


def test_linear_channels_are_barycentric(grid):
    vertices, faces = grid
    heat = np.sin(np.arange(25.0))
    found = limitmesh.refine(vertices, faces, tolerance=0.01, channels={"heat": heat})
    expected = (heat[found.barycentric_vertices] * found.barycentric).sum(axis=1)
    np.testing.assert_allclose(found.at_vertices("heat")[:, 0], expected, atol=1e-12)
    assert found.at_corners("heat").shape == (len(found.faces), 3, 1)


def test_smooth_channels_follow_positions(octahedron):
    vertices, faces = octahedron
    own = limitmesh.Channel(vertices, interpolation="smooth-none")
    found = limitmesh.refine(vertices, faces, tolerance=0.01, channels={"own": own})
    np.testing.assert_allclose(found.at_vertices("own"), found.vertices, atol=1e-12)


def test_face_channels_are_inherited(grid):
    vertices, faces = grid
    material = np.arange(len(faces)) % 3
    found = limitmesh.refine(vertices, faces, tolerance=0.01, channels={"material": material})
    channel = found.channels["material"]
    assert channel.domain == "face" and channel.semantic == "label"
    np.testing.assert_array_equal(channel[:][:, 0], material[found.parent_face])


def test_seams_stay_seams():
    # Two squares side by side, each with the whole texture.
    vertices = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.5], [0, 1, 0], [1, 1, 0], [2, 1, 0.5]], dtype=float)
    quads = [[0, 1, 4, 3], [1, 2, 5, 4]]
    corners = np.tile([[0, 0], [1, 0], [1, 1], [0, 1]], (2, 1)).astype(float)
    uv = limitmesh.Channel(corners, domain="corner", semantic="texture")
    found = limitmesh.refine(vertices, quads, tolerance=0.001, channels={"uv": uv})
    with pytest.raises(limitmesh.OptionError, match="several values at vertex"):
        found.at_vertices("uv")
    split = found.split("uv")
    assert len(split.vertices) > len(found.vertices)
    np.testing.assert_array_equal(split.values["uv"][split.faces], found.at_corners("uv"))
    np.testing.assert_array_equal(split.vertices[split.faces], found.vertices[found.faces])
    np.testing.assert_array_equal(found.vertices[split.sources], split.vertices)
    assert split.values["uv"].min() >= -1e-12 and split.values["uv"].max() <= 1 + 1e-12
    by_row = found.channels["uv"]
    assert by_row.indices.shape == found.faces.shape


def test_three_dimensional_arrays_are_corners(octahedron):
    vertices, faces = octahedron
    uv = vertices[faces][:, :, :2]
    found = limitmesh.refine(vertices, faces, tolerance=0.05, channels={"uv": uv})
    assert found.channels["uv"].semantic == "texture"
    with pytest.raises(limitmesh.OptionError, match="no channel 'st'"):
        found.at_vertices("st")


def test_flat_regions_end_where_the_values_of_faces_do():
    # A drum of 24 facets, its ends fans around their middles, which are the last two vertices.
    turn = np.arange(24) * np.pi / 12
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    vertices = np.concatenate([ring, ring + [0, 0, 1], [[0, 0, 0], [0, 0, 1]]])
    i, j = np.arange(24), (np.arange(24) + 1) % 24
    faces = np.concatenate([np.stack(rows, axis=1) for rows in ((i, j, j + 24), (i, j + 24, i + 24), (j, i, 0 * i + 48), (i + 24, j + 24, 0 * i + 49))])
    refined = lambda **channels: limitmesh.refine(vertices, faces, crease_angle=60, tolerance=1e-4, channels=channels)
    plain = len(refined().faces)
    # As trimesh reads STL files.
    constant = refined(stl=np.zeros(96, dtype=np.int64))
    assert len(constant.faces) == plain and (constant.channels["stl"][:] == 0).all()
    assert len(refined(heat=np.ones(50)).faces) == plain
    half = refined(half=(np.arange(96) % 24 < 12).astype(np.int64))
    divided = len(limitmesh.refine(vertices, faces, crease_angle=60, tolerance=1e-4, flat_regions=False).faces)
    assert plain <= len(half.faces) < divided / 2
    # The facets from 0 to 11 are above the plane y = 0, on which both halves end by symmetry.
    y = half.vertices[half.faces][:, :, 1].mean(axis=1)
    np.testing.assert_array_equal(half.channels["half"][:][:, 0], (y > 0).astype(float))


def test_results_are_meshes_again(octahedron):
    vertices, faces = octahedron
    once = limitmesh.refine(vertices, faces, tolerance=0.1, channels={"x": vertices[:, 0]})
    twice = limitmesh.refine(once, tolerance=0.01)
    assert twice.at_vertices("x").shape == (len(twice.vertices), 1)


@pytest.mark.parametrize("options", [{"method": "uniform", "levels": 3}, {"tolerance": 0.01, "optimize": True}])
def test_other_ways_carry_channels_too(octahedron, options):
    vertices, faces = octahedron
    uv = limitmesh.Channel(vertices, interpolation="smooth-none")
    part = np.arange(8) // 4
    found = limitmesh.refine(vertices, faces, channels={"own": uv, "part": part}, **options)
    assert found.at_vertices("own").shape == found.vertices.shape
    # All z are at least 0 in the first half, and at most 0 in the other.
    z = found.vertices[found.faces][:, :, 2].mean(axis=1)
    np.testing.assert_array_equal(found.channels["part"][:][:, 0], (z < 0).astype(float))
    if "optimize" in options:
        np.testing.assert_allclose(found.at_vertices("own"), found.vertices, atol=1e-9)
