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


def test_quads_of_catmull_clark_are_pairs_of_triangles(tmp_path):
    vertices = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], dtype=float)
    cube = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    for how in ({"tolerance": 0.01}, {"method": "uniform", "levels": 2}):
        found = limitmesh.refine(vertices, cube, scheme="catmull-clark", quads=True, **how)
        assert len(found.quads) > 0 and 2 * len(found.quads) + len(found.triangles) == len(found.faces)
        # Both halves of a quad, cut either way, have the edges of the triangles that it replaces.
        def edges(faces):
            return {tuple(sorted(edge)) for face in faces.tolist() for edge in zip(face, face[1:] + face[:1], strict=True)}
        assert edges(found.quads) | edges(found.triangles) <= edges(found.faces)
        assert len(edges(found.faces)) - len(edges(found.quads) | edges(found.triangles)) == len(found.quads)
        # The corners of a quad are corners of its two triangles, and of no other.
        assert (found.faces.reshape(-1)[found.quad_corners] == found.quads).all()
        rows = np.sort(found.quad_corners // 3, axis=1)
        assert (rows[:, 0] < rows[:, 3]).all() and len(np.unique(rows)) == 2 * len(found.quads)
        # The middle of a face of the cube came from the middle of a diagonal.
        assert len(found.vertex_face) == len(found.vertices) and found.barycentric.shape == (len(found.vertices), 3)
        path = tmp_path / "quads.ply"
        found.save(path)
        sides = [len(face) for face in limitmesh.load(path).faces]
        assert sides.count(4) == len(found.quads)
    with pytest.raises(limitmesh.OptionError, match="catmull-clark"):
        limitmesh.refine(vertices, cube, quads=True, scheme="loop")
    with pytest.raises(limitmesh.OptionError, match="distances"):
        limitmesh.refine(vertices, cube, quads=True, angle=5, scheme="catmull-clark")


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


def test_smooth_triangles_are_a_rule_of_catmull_clark():
    vertices = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    plain, smooth = (
        limitmesh.limit(vertices, faces, scheme="catmull-clark", smooth_triangles=smooth).positions for smooth in (False, True)
    )
    # A corner after a step is (v + mean of edges + mean of faces) / 3; its limit (2 v' + 2 mean of e' + 4 mean of F') / 8 on quads.
    for found, middle in ((plain, 2 / 3), (smooth, 0.03 * 2 + 0.47 * 2 / 3)):
        v = vertices[0]
        point = (v - v / 3 + v / 9) / 3
        edges, centres = middle * v / 3, v / 9
        quads = (point + 2 * edges + centres) / 4
        assert np.abs(found[0] - (2 * point + 2 * edges + 4 * quads) / 8).max() < 1e-12
    with pytest.raises(limitmesh.OptionError, match="catmull-clark"):
        limitmesh.refine(vertices, faces, smooth_triangles=True, scheme="loop")


def test_cages_know_their_vertices_and_polygons():
    vertices = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    mixed = quads[:5] + [[1, 3, 7], [1, 7, 5]]
    for faces in (quads, mixed):
        positions = limitmesh.limit(vertices, faces, scheme="catmull-clark").positions
        assert (np.sign(positions) == np.sign(vertices)).all()
        assert (positions[[0, 2, 4, 6]].round(9) != 0).all()
    assert np.abs(limitmesh.limit(vertices, quads, scheme="catmull-clark").positions - vertices / 2).max() < 1e-12
