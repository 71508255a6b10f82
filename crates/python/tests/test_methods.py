"""Further schemes and methods, beside closed forms and steps by the book in NumPy."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh


def sqrt3_step(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One step of √3-subdivision of a closed mesh, by the book (Kobbelt 2000)."""
    around: list[set[int]] = [set() for _ in vertices]
    across: dict[tuple[int, int], int] = {}
    for row, (a, b, c) in enumerate(faces.tolist()):
        for u, v in ((a, b), (b, c), (c, a)):
            across[u, v] = row
            around[u] |= {v}
            around[v] |= {u}
    moved = []
    for v, ring in enumerate(around):
        n = len(ring)
        alpha = (4 - 2 * np.cos(2 * np.pi / n)) / 9
        moved.append((1 - alpha) * vertices[v] + alpha / n * sum(vertices[u] for u in ring))
    centres = vertices[faces].mean(axis=1)
    count = len(vertices)
    parts = [[u, count + across[v, u], count + row] for (u, v), row in across.items()]
    return np.concatenate([moved, centres]), np.array(parts)


def in_order(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.round(points, 9).T)]


def is_closed(faces: np.ndarray) -> bool:
    edges = np.sort(np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    return bool((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())


def test_uniform_sqrt3_is_kobbelts(octahedron):
    expected_vertices, expected_faces = sqrt3_step(*sqrt3_step(*sqrt3_step(*octahedron)))
    found = limitmesh.refine(*octahedron, scheme="sqrt3", method="uniform", levels=3)
    assert found.vertices.shape == expected_vertices.shape and found.faces.shape == expected_faces.shape
    np.testing.assert_allclose(in_order(found.vertices), in_order(expected_vertices), atol=1e-12)
    assert found.stop == "levels" and found.levels == 3 and found.error is None
    np.testing.assert_allclose(found.normals[:6], octahedron[0], atol=1e-12)
    np.testing.assert_array_equal(np.bincount(found.parent_face), 27)
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1.0)


def test_adaptive_sqrt3_is_on_the_limit_surface(octahedron):
    found = limitmesh.refine(*octahedron, scheme="sqrt3", tolerance=0.01)
    assert found.met and found.error.upper <= 0.01 and not found.error.certified and is_closed(found.faces)
    fine = octahedron
    for _ in range(8):
        fine = sqrt3_step(*fine)
    distance = limitmesh.measure(found, fine, certified=True)
    assert distance.upper < 0.015
    # All its vertices are on it.
    onto = limitmesh.measure((found.vertices, found.faces), fine)
    np.testing.assert_allclose(found.vertices[0], octahedron[0][0] * np.linalg.norm(found.vertices[0]), atol=1e-12)
    assert onto.lower < 0.015
    fewer = limitmesh.refine(*octahedron, scheme="sqrt3", triangles=100)
    assert fewer.stop == "triangles" and 90 < len(fewer.faces) <= 100
    by_angle = limitmesh.refine(*octahedron, scheme="sqrt3", angle=8)
    corners = by_angle.vertices[by_angle.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosines = np.einsum("ij,ikj->ik", normals, by_angle.normals[by_angle.faces])
    assert by_angle.met and by_angle.error is None and np.degrees(np.arccos(cosines.min())) <= 8 + 1e-9


def test_planarity_keeps_its_angle_and_its_height(octahedron):
    found = limitmesh.refine(*octahedron, method="planarity", angle=6)
    corners = found.vertices[found.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosines = np.einsum("ij,ikj->ik", normals, found.normals[found.faces])
    assert found.stop == "met" and found.error is None and is_closed(found.faces)
    # Triangles that close gaps are no nodes, and may be a little off.
    assert np.degrees(np.arccos(np.sort(cosines.min(axis=1))[len(cosines) // 20])) <= 6 + 1e-9
    points = limitmesh.limit_surface(*octahedron, at=found.vertex_face, barycentric=barycentric_of(found, octahedron[1]))
    np.testing.assert_allclose(points.positions, found.vertices, atol=1e-12)
    np.testing.assert_allclose(points.normals, found.normals, atol=1e-9)
    coarse, fine = (limitmesh.refine(*octahedron, method="planarity", tolerance=height) for height in (0.02, 0.005))
    assert len(octahedron[1]) < len(coarse.faces) < len(fine.faces)
    assert limitmesh.measure(fine, limit_of=octahedron, certified=True).upper < 0.01


def barycentric_of(found, faces):
    """Weights in the order of the faces' own corners."""
    own = faces[found.vertex_face]
    weights = np.zeros((len(own), 3))
    for i in range(3):
        for j in range(3):
            same = own[:, i] == found.barycentric_vertices[:, j]
            weights[same, i] = found.barycentric[same, j]
    return weights


def test_vertex_errors_shrink_as_the_masks_say(octahedron):
    # At a vertex of valence 4 a control point is (5/8 - 4 beta) times nearer to its limit with each level.
    k = 4
    beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / k) / 4) ** 2) / k
    start = 1 - 24 / 55
    levels = 0
    while start * (5 / 8 - k * beta) ** levels > 0.01:
        levels += 1
    found = limitmesh.refine(*octahedron, method="vertex-error", tolerance=0.01)
    assert found.stop == "met" and found.levels == levels and found.error is None
    few = limitmesh.refine(*octahedron, method="vertex-error", triangles=200)
    assert few.stop == "triangles" and 100 < len(few.faces) <= 200
    bare = limitmesh.refine(*octahedron, method="vertex-error", tolerance=0.01, origins=False)
    assert bare.vertices.tobytes() == found.vertices.tobytes() and bare.barycentric is None


def test_sharp_edges_have_two_normals():
    for options in ({"method": "planarity"}, {"scheme": "sqrt3", "tolerance": "1%"}):
        box = limitmesh.refine("builtin:cube", crease_angle=30, **options)
        corners = box.vertices[box.faces]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
        np.testing.assert_allclose(box.corner_normals, np.repeat(flat[:, None], 3, axis=1), atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(box.normals, axis=1), 1.0)
        assert not np.allclose(box.normals[box.faces], box.corner_normals)


def test_channels_go_along_with_planarity(octahedron):
    vertices, faces = octahedron
    height = {"height": limitmesh.Channel(vertices[:, 2], interpolation="smooth-none")}
    found = limitmesh.refine(vertices, faces, method="planarity", channels=height)
    # It is as smooth as the surface, whose height it is.
    np.testing.assert_allclose(found.at_vertices("height")[:, 0], found.vertices[:, 2], atol=1e-12)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"scheme": "sqrt3", "pixels": 1, "cameras": limitmesh.Camera((0, 0, 5))}, "pixels does not go with scheme='sqrt3'"),
        ({"scheme": "sqrt3", "view": (0, 0, 1), "angle": 5}, "view does not go with"),
        ({"scheme": "sqrt3", "optimize": True}, "optimize does not go with"),
        ({"scheme": "sqrt3", "balance": True}, "balance does not go with"),
        ({"scheme": "sqrt3", "interpolate": True}, "interpolate does not go with"),
        ({"scheme": "sqrt3", "method": "amresh"}, "method is 'amresh', expected 'exact' or 'uniform'"),
        ({"scheme": "sqrt3", "levels": 2}, "levels are steps"),
        ({"scheme": "sqrt3", "method": "uniform", "tolerance": 1}, "tolerance is a goal of method='exact'"),
        ({"scheme": "sqrt3", "channels": {"x": limitmesh.Channel([1, 2, 3, 4.0, 5, 6])}}, "carries none: 'x'"),
        ({"scheme": "sqrt3", "creases": [[0, 2, 1.5]]}, "sharp"),
        ({"method": "planarity", "angle": 5, "tolerance": 0.1}, "angle and tolerance"),
        ({"method": "planarity", "levels": 3}, "levels are steps"),
        ({"method": "planarity", "pixels": 1, "cameras": limitmesh.Camera((0, 0, 5))}, "pixels does not go with method='planarity'"),
        ({"method": "planarity", "eye": (0, 0, 5)}, "eye does not go with"),
        ({"method": "vertex-error", "angle": 5}, "angle does not go with method='vertex-error'"),
        ({"method": "vertex-error", "optimize": True}, "optimize does not go with"),
        ({"method": "vertex-error", "tolerance": -1}, "tolerance is -1"),
    ],
)
def test_options_that_do_not_go_together(octahedron, options, words):
    with pytest.raises(limitmesh.Error, match=words):
        limitmesh.refine(*octahedron, **options)


def test_caps_are_told(octahedron):
    for options in ({"scheme": "sqrt3", "tolerance": 1e-5}, {"method": "planarity", "angle": 0.1}):
        with pytest.warns(limitmesh.StoppedShort, match="max_triangles"):
            found = limitmesh.refine(*octahedron, max_triangles=500, **options)
        assert found.stop == "triangle-cap" and 300 < len(found.faces) <= 500
        with pytest.raises(limitmesh.ToleranceNotMet, match="max_levels"):
            limitmesh.refine(*octahedron, max_levels=2, strict=True, **options)
        with pytest.raises(limitmesh.ToleranceNotMet, match="max_memory"):
            limitmesh.refine(*octahedron, max_memory="1MB", max_triangles=2000, strict=True, **options)
    for scheme in ("loop", "sqrt3"):
        with pytest.warns(limitmesh.StoppedShort, match="max_memory"):
            found = limitmesh.refine(*octahedron, scheme=scheme, method="uniform", levels=12, max_memory="1MB")
        assert found.stop == "memory-cap" and 500 < len(found.faces) <= 2**20 / 100


def test_bad_meshes_name_the_row(octahedron):
    vertices, faces = octahedron
    vertices[3, 1] = np.nan
    for options in ({"scheme": "sqrt3"}, {"method": "planarity"}):
        with pytest.raises(limitmesh.MeshError, match=r"vertices\[3, 1\] is NaN"):
            limitmesh.refine(vertices, faces, **options)
        with pytest.raises(limitmesh.MeshError, match=r"faces\[0\] names vertex 9"):
            limitmesh.refine(vertices, [[0, 2, 9]], **options)


def test_catmull_clark_is_for_polygons():
    vertices = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    found = limitmesh.refine(vertices, quads, tolerance=0.01, scheme="catmull-clark")
    assert found.error.certified and found.error.upper <= 0.01
    # The middles of the cube's faces go to 68/81, its corners half of the way to the centre.
    sizes = np.abs(found.vertices).max(axis=1)
    assert abs(sizes.max() - 68 / 81) < 1e-12 and abs(np.linalg.norm(found.vertices[7]) - np.sqrt(0.75)) < 1e-12
    mixed = quads[:5] + [[1, 3, 7], [1, 7, 5]]
    assert limitmesh.refine(vertices, mixed, tolerance=0.01, scheme="catmull-clark").error.certified
    measured = limitmesh.measure((found.vertices, found.faces), limit_of=(vertices, quads), scheme="catmull-clark")
    assert 0.005 < measured.lower <= 0.011
    found = limitmesh.project([[0, 0, 3], [0, 0.5, 0]], vertices, quads, scheme="catmull-clark")
    assert abs(found.signed[0] - (3 - 68 / 81)) < 1e-6 and found.signed[1] < 0
    hits = limitmesh.intersect([[5, 0, 0]], [-1, 0, 0], vertices, quads, scheme="catmull-clark")
    assert np.allclose(hits.t, [5 - 68 / 81, 5 + 68 / 81], atol=1e-9) and hits.crossing.tolist() == [1, -1]
    with pytest.raises(limitmesh.OptionError, match="triangles"):
        limitmesh.refine(vertices, quads, within=0.1, scheme="catmull-clark")
