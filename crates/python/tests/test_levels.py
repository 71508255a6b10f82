"""Levels of detail, beside the distances of their meshes and what a geomorph is at both ends."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import limitmesh


def beyond(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """How far points are from triangles (m, 3, 3), at most: to sixteen points a side of each."""
    i, j = np.divmod(np.arange(17 * 17), 17)
    i, j = i[i + j <= 16], j[i + j <= 16]
    weights = np.stack([16 - i - j, i, j], axis=1) / 16
    samples = np.einsum("wk,mkx->mwx", weights, triangles).reshape(-1, 3)
    return np.array([np.linalg.norm(samples - point, axis=1).min() for point in points])


def test_levels_are_within_their_tolerances_and_nested(octahedron):
    levels = limitmesh.levels_of_detail(*octahedron, tolerances=[0.1, 0.02, 0.004])
    assert [level.tolerance for level in levels] == [0.1, 0.02, 0.004]
    counts = [len(level.faces) for level in levels]
    assert counts == sorted(set(counts))
    for level in levels:
        assert level.error.certified and level.error.upper <= level.tolerance
        assert level.error.lower <= level.error.upper <= level.deviation + 1e-15
        distance = limitmesh.measure(level.refined, limit_of=octahedron, certified=True)
        assert distance.lower <= level.error.upper and distance.upper <= level.tolerance * 1.01
        assert level.coarser is None and level.coarser_normals is None and level.coarser_corner_normals is None
        np.testing.assert_allclose(np.linalg.norm(level.normals, axis=1), 1.0)
    # Vertices of a coarser level are among the finer one's.
    for coarse, fine in zip(levels, levels[1:]):
        finer = {tuple(row) for row in fine.vertices.tolist()}
        assert all(tuple(row) in finer for row in coarse.vertices.tolist())


def test_geomorphs_begin_on_the_coarser_level_and_end_on_their_own(octahedron):
    coarsest, *levels = limitmesh.levels_of_detail(*octahedron, tolerances=["5%", "1%", "0.4%"], morph=True)
    assert coarsest.coarser is None
    coarse = coarsest
    for fine in levels:
        np.testing.assert_array_equal(fine.at(1), fine.vertices)
        np.testing.assert_array_equal(fine.at(0), fine.coarser)
        np.testing.assert_allclose(fine.at(0.25), 0.75 * fine.coarser + 0.25 * fine.vertices, atol=1e-15)
        assert fine.deviation_at(0) == fine.coarser_deviation <= coarse.tolerance
        assert fine.deviation_at(1) == fine.deviation <= fine.tolerance
        # What both levels have does not move; all begins on the coarser level, whose closing triangles may be folded a little.
        among = {tuple(row): at for at, row in enumerate(fine.vertices.tolist())}
        own = [among[tuple(row)] for row in coarse.vertices.tolist()]
        np.testing.assert_array_equal(fine.coarser[own], coarse.vertices)
        size = np.linalg.norm(np.diff(coarse.vertices[coarse.faces], axis=1), axis=2).max() / 16
        assert (beyond(fine.coarser, coarse.vertices[coarse.faces]) < size).all()
        for t in (0.0, 0.5, 0.9):
            distance = limitmesh.measure((fine.at(t), fine.faces), limit_of=octahedron, certified=True)
            assert distance.lower <= fine.deviation_at(t)
        coarse = fine


def test_levels_by_number_and_ratio(octahedron):
    levels = limitmesh.levels_of_detail(*octahedron, levels=3, tolerance=0.01, ratio=0.5)
    np.testing.assert_allclose([level.tolerance for level in levels], [0.04, 0.02, 0.01])
    diagonal = np.linalg.norm([2, 2, 2])
    usual = limitmesh.levels_of_detail(*octahedron)
    np.testing.assert_allclose([level.tolerance / diagonal for level in usual], [0.064, 0.016, 0.004, 0.001])
    again = limitmesh.levels_of_detail(*octahedron, threads=1, index_dtype=np.uint32)
    assert again[-1].vertices.tobytes() == usual[-1].vertices.tobytes() and again[-1].faces.dtype == np.uint32


def test_switching_distances_are_what_a_camera_sees(octahedron):
    (level,) = limitmesh.levels_of_detail(*octahedron, tolerances=[0.01])
    camera = limitmesh.Camera((0, 0, 9), fov=60, height=500)
    away = level.switching_distance(camera, pixels=2)
    # A length at this distance, in the middle of the picture.
    assert level.error.upper / (2 * away * np.tan(np.radians(30))) * 500 == pytest.approx(2)
    (morphing,) = limitmesh.levels_of_detail(*octahedron, tolerances=[0.01], morph=True)
    assert morphing.deviation / (2 * morphing.switching_distance(camera) * np.tan(np.radians(30))) * 500 == pytest.approx(1)
    with pytest.raises(limitmesh.OptionError, match="pixels is 0"):
        level.switching_distance(pixels=0)
    with pytest.raises(limitmesh.OptionError, match="expected a limitmesh.Camera"):
        level.switching_distance((0, 0, 9))


def test_channels_and_sharp_edges_go_along():
    vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    height = {"height": limitmesh.Channel(vertices[:, 2], interpolation="smooth-none")}
    options = {"creases": [[0, 1]], "channels": height, "morph": True}
    coarse, fine = limitmesh.levels_of_detail(vertices, faces, tolerances=[0.1, 0.02], **options)
    for level in (coarse, fine):
        np.testing.assert_allclose(level.refined.at_vertices("height")[:, 0], level.vertices[:, 2], atol=1e-12)
    own = fine.coarser_corner_normals
    assert own.shape == (*fine.faces.shape, 3)
    differs = (own != fine.coarser_normals[fine.faces]).any(axis=2)
    # Only at corners whose vertices are on the sharp edge.
    sharp = np.zeros(len(fine.vertices), bool)
    sharp[fine.faces[(fine.refined.corner_normals != fine.normals[fine.faces]).any(axis=2)]] = True
    assert differs.any() and sharp[fine.faces[differs]].all()
    again = pickle.loads(pickle.dumps(fine))
    assert again.vertices.tobytes() == fine.vertices.tobytes() and again.at(0).tobytes() == fine.at(0).tobytes()


def test_caps_end_the_levels(octahedron):
    with pytest.warns(limitmesh.StoppedShort, match="level 2 of 3, counted from the coarsest: max_triangles"):
        found = limitmesh.levels_of_detail(*octahedron, tolerances=[0.1, 1e-4, 1e-6], max_triangles=1000)
    assert len(found) == 2 and len(found[1].faces) <= 1000
    with pytest.raises(limitmesh.ToleranceNotMet) as raised:
        limitmesh.levels_of_detail(*octahedron, tolerances=[0.1, 1e-4], max_triangles=1000, strict=True)
    assert len(raised.value.result) == 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerances": [0.1, 0.2]}, r"tolerances\[1\] is 0.2, expected less than"),
        ({"tolerances": [0.1, "50%"]}, r"tolerances\[1\] is 1.7"),
        ({"tolerances": [0.1, np.nan]}, r"tolerances\[1\] is nan"),
        ({"tolerances": []}, "tolerances is empty"),
        ({"tolerances": 0.1}, "expected a list"),
        ({"tolerances": [0.1], "levels": 3}, "levels does not go with tolerances"),
        ({"levels": 0}, "levels is 0"),
        ({"levels": 1000}, "at most 64"),
        ({"ratio": 1}, "ratio is 1"),
        ({"tolerance": -1}, "tolerance is -1"),
        ({"scheme": "sqrt3"}, "scheme is 'sqrt3'"),
        ({"channels": {"x": [1, 2]}}, "fits none"),
    ],
)
def test_levels_that_make_no_sense(octahedron, options, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.levels_of_detail(*octahedron, **options)


def test_moments_and_meshes_that_are_none(octahedron):
    coarse, fine = limitmesh.levels_of_detail(*octahedron, tolerances=[0.1, 0.03], morph=True)
    for t in (-0.1, 1.1, np.nan, "half"):
        with pytest.raises(limitmesh.OptionError, match="t is"):
            fine.at(t)
    with pytest.raises(limitmesh.OptionError, match="no geomorph"):
        coarse.at(0.5)
    vertices, faces = octahedron
    with pytest.raises(limitmesh.MeshError, match=r"faces\[1\] names vertex 6 in column 2"):
        limitmesh.levels_of_detail(vertices, [[0, 2, 4], [2, 1, 6]])
    vertices[4, 0] = np.inf
    with pytest.raises(limitmesh.MeshError, match=r"vertices\[4, 0\] is inf"):
        limitmesh.levels_of_detail(vertices, faces)
