"""Rays and facing, beside closed forms and a fine mesh in NumPy."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh

OCTAHEDRON = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
FACES = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def met(origin: np.ndarray, direction: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Where a ray meets triangles (m, 3, 3), ascending, by the book (Möller and Trumbore)."""
    a, b, c = triangles.transpose(1, 0, 2)
    across = np.cross(direction, c - a)
    determinant = np.einsum("ij,ij->i", b - a, across)
    u = np.einsum("ij,ij->i", origin - a, across) / determinant
    beside = np.cross(origin - a, b - a)
    v = beside @ direction / determinant
    t = np.einsum("ij,ij->i", c - a, beside) / determinant
    return np.sort(t[(u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0)])


def test_rays_through_known_points_of_an_octahedron():
    origins = 3.0 * np.concatenate([OCTAHEDRON, OCTAHEDRON[FACES].sum(axis=1)])
    found = limitmesh.intersect(origins, -origins, OCTAHEDRON, FACES)
    np.testing.assert_array_equal(found.rays, np.repeat(np.arange(14), 2))
    np.testing.assert_array_equal(found.crossing, np.tile([1, -1], 14))
    # The limit of a vertex is 24/55 of it; that of a face's middle is by three points of the surface.
    middle = limitmesh.limit_surface(OCTAHEDRON, FACES, at=[0], barycentric=[[1 / 3, 1 / 3, 1 / 3]]).positions[0]
    radius = np.where(np.arange(14) < 6, 24 / 55, np.linalg.norm(middle))
    away = np.linalg.norm(origins, axis=1)
    np.testing.assert_allclose(found.t[::2], (away - radius) / away, atol=1e-9)
    np.testing.assert_allclose(found.t[1::2], (away + radius) / away, atol=1e-9)
    np.testing.assert_allclose(found.normals[::2], origins / away[:, None], atol=1e-8)
    np.testing.assert_allclose(found.points, origins[found.rays] * (1 - found.t)[:, None], atol=1e-9)
    there = limitmesh.limit_surface(OCTAHEDRON, FACES, at=found.faces, barycentric=found.barycentric)
    np.testing.assert_allclose(there.positions, found.points, atol=1e-9)


def test_no_hit_is_missed_beside_a_fine_mesh():
    torus = limitmesh.load("builtin:torus")
    fine = limitmesh.refine(torus, tolerance="0.01%", origins=False)
    triangles = fine.vertices[fine.faces]
    random = np.random.default_rng(5)
    low, high = fine.vertices.min(axis=0), fine.vertices.max(axis=0)
    size = np.linalg.norm(high - low)
    through = random.uniform(low, high, (60, 3))
    directions = random.normal(size=(60, 3))
    origins = through - size * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    found = limitmesh.intersect(origins, directions, torus, threads=1)
    first = limitmesh.intersect(origins, directions, torus, first=True)
    compared = 0
    for row in range(60):
        own = found.rays == row
        expected = met(origins[row], directions[row], triangles)
        unit = directions[row] / np.linalg.norm(directions[row])
        if (np.abs(found.normals[own] @ unit) < 0.1).any():
            continue
        # What is 0.01 % off is met so much later at most, over the cosine.
        assert own.sum() == len(expected), row
        np.testing.assert_allclose(found.t[own] * np.linalg.norm(directions[row]), expected * np.linalg.norm(directions[row]), atol=2e-3 * size)
        np.testing.assert_array_equal(found.crossing[own], np.tile([1, -1], own.sum() // 2))
        np.testing.assert_array_equal(first.t[first.rays == row], found.t[own][:1])
        compared += own.sum()
    assert compared > 40
    again = limitmesh.intersect(origins, directions, torus, threads=3)
    assert again.points.tobytes() == found.points.tobytes()


def test_parts_of_lines_and_one_direction_for_all():
    along = [0, 0, -2]
    lines = limitmesh.intersect([[0, 0, -9]], along, OCTAHEDRON, FACES, between=(-np.inf, np.inf))
    np.testing.assert_allclose(lines.t, [-(9 + 24 / 55) / 2, -(9 - 24 / 55) / 2])
    assert len(limitmesh.intersect([[0, 0, -9]], along, OCTAHEDRON, FACES).t) == 0
    short = limitmesh.intersect([[0, 0, 2], [0, 0, 3]], along, OCTAHEDRON, FACES, between=(0, 1))
    assert short.rays.tolist() == [0] and short.crossing.tolist() == [1]
    none = limitmesh.intersect(np.zeros((0, 3)), np.zeros((0, 3)), OCTAHEDRON, FACES)
    assert none.points.shape == (0, 3) and none.rays.shape == (0,)


@pytest.mark.parametrize(
    ("origins", "directions", "options", "words"),
    [
        ([[0, 0]], [[1, 0, 0]], {}, "origins has the shape"),
        ([[0, 0, 0], [0, 0, np.nan]], [1, 0, 0], {}, r"origins\[1\]"),
        ([[0, 0, 0]], [[1, 0, np.inf]], {}, r"directions\[0\]"),
        ([[0, 0, 0]] * 2, [[1, 0, 0], [0, 0, 0]], {}, r"directions\[1\] is 0"),
        ([[0, 0, 0]] * 2, [[1, 0, 0]] * 3, {}, "directions has 3 rows, expected 2"),
        ([["a", "b", "c"]], [1, 0, 0], {}, "origins is no array"),
        ([0, 0, 0], [1, 0, 0], {"between": (1, 0)}, "between is"),
        ([0, 0, 0], [1, 0, 0], {"between": 3}, "between is 3"),
        ([0, 0, 0], [1, 0, 0], {"tolerance": 0}, "tolerance is 0"),
        ([0, 0, 0], [1, 0, 0], {"scheme": "butterfly"}, "butterfly"),
        ([0, 0, 0], [1, 0, 0], {"threads": 0}, "threads is 0"),
    ],
)
def test_rays_that_are_none(origins, directions, options, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.intersect(origins, directions, OCTAHEDRON, FACES, **options)


def test_meshes_that_are_none_name_the_row():
    with pytest.raises(limitmesh.MeshError, match=r"faces\[1\] names vertex 9 in column 2"):
        limitmesh.intersect([0, 0, 9], [0, 0, 1], OCTAHEDRON, [[0, 1, 2], [0, 1, 9]])
    broken = OCTAHEDRON.copy()
    broken[2, 1] = np.nan
    with pytest.raises(limitmesh.MeshError, match=r"vertices\[2, 1\] is NaN"):
        limitmesh.facing(broken, FACES, eye=[9, 9, 9])


@pytest.mark.parametrize("where", [{"view": [0.3, -1.0, 0.2]}, {"eye": [0.9, 0.8, 0.1]}, {"eye": [4.0, -7.0, 5.0]}])
def test_facing_is_what_many_points_say(where):
    torus = limitmesh.repair("builtin:torus")
    found = limitmesh.facing(torus.vertices, torus.faces, **where)
    assert found.dtype == np.int8 and found.shape == (len(torus.faces),)
    i, j = np.divmod(np.arange(121), 11)
    inside = i + j <= 10
    places = np.stack([10 - i - j, i, j], axis=1)[inside] / 10
    at = np.repeat(np.arange(len(torus.faces)), len(places))
    points = limitmesh.limit_surface(torus.vertices, torus.faces, at=at, barycentric=np.tile(places, (len(torus.faces), 1)))
    sight = np.asarray(where["view"]) if "view" in where else points.positions - where["eye"]
    side = np.sign(-(points.normals * sight).sum(axis=1)).reshape(-1, len(places))
    truth = np.where((side == 1).all(axis=1), 1, np.where((side == -1).all(axis=1), -1, 0))
    decided = found != 0
    np.testing.assert_array_equal(found[decided], truth[decided])
    # Few that could be decided are not.
    assert (truth != 0).sum() > 10 and (decided & (truth != 0)).sum() > 0.9 * (truth != 0).sum()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "one of them"),
        ({"view": [0, 0, 1], "eye": [0, 0, 1]}, "one of them"),
        ({"view": [0, 0, 0]}, "expected a direction"),
        ({"view": [0, 1]}, "view is"),
        ({"eye": [0, 1, np.nan]}, "eye is"),
    ],
)
def test_viewpoints_that_are_none(options, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.facing(OCTAHEDRON, FACES, **options)


def test_facing_of_what_is_repaired_is_refused():
    with pytest.raises(limitmesh.MeshError, match="repair"):
        limitmesh.facing(OCTAHEDRON, [[0, 1, 3, 4]], view=[0, 0, -1])
