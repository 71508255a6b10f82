"""Points projected onto the limit surface, beside closed forms and dense samples."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh

OCTAHEDRON = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
FACES = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def test_vertices_of_an_octahedron():
    found = limitmesh.project(3.0 * OCTAHEDRON, OCTAHEDRON, FACES)
    np.testing.assert_allclose(found.points, 24 / 55 * OCTAHEDRON, atol=1e-5)
    np.testing.assert_allclose(found.signed, 3 - 24 / 55, atol=1e-6)
    np.testing.assert_allclose(found.normals, OCTAHEDRON, atol=1e-4)


def test_no_sample_is_nearer():
    random = np.random.default_rng(3)
    points = random.uniform(-0.8, 0.8, (50, 3))
    at = np.repeat(np.arange(8), 4000)
    samples = limitmesh.limit_surface(OCTAHEDRON, FACES, at=at, barycentric=random.dirichlet([1, 1, 1], len(at)))
    nearest = np.linalg.norm(points[:, None] - samples.positions, axis=2).min(axis=1)
    found = limitmesh.project(points, OCTAHEDRON, FACES, tolerance=1e-9, threads=1)
    assert (found.lower <= found.distances).all() and (found.distances - found.lower <= 1.001e-9).all()
    assert (found.distances <= nearest + 1e-9).all() and (nearest - found.distances < 0.02).all()
    there = limitmesh.limit_surface(OCTAHEDRON, FACES, at=found.faces, barycentric=found.barycentric)
    np.testing.assert_allclose(there.positions, found.points, atol=1e-12)
    # The surface is about a sphere of radius 0.41 to 0.44.
    radius = np.linalg.norm(points, axis=1)
    assert (found.signed[radius < 0.4] < 0).all() and (found.signed[radius > 0.45] > 0).all()
    assert (radius < 0.4).any()


def test_open_surfaces_have_two_sides():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    points = [[0.5, 0.3, 2], [0.5, 0.3, -1]]
    found = limitmesh.project(points, square, [[0, 1, 2], [0, 2, 3]], boundary="corners")
    np.testing.assert_allclose(found.signed, [2, -1], atol=1e-6)


@pytest.mark.parametrize(
    ("points", "words"),
    [([[0, 0]], "shape"), ([[0, 0, np.nan]], r"points\[0\]"), ([["a", "b", "c"]], "numbers"), (3.0, "shape")],
)
def test_points_that_are_none(points, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.project(points, OCTAHEDRON, FACES)


def test_options_that_are_none():
    assert limitmesh.project([], OCTAHEDRON, FACES).points.shape == (0, 3)
    with pytest.raises(limitmesh.OptionError, match="tolerance"):
        limitmesh.project([[0, 0, 1]], OCTAHEDRON, FACES, tolerance=0)
    with pytest.raises(limitmesh.Error, match="butterfly"):
        limitmesh.project([[0, 0, 1]], OCTAHEDRON, FACES, scheme="butterfly")
