"""The limit surface at places, beside what is known of a paraboloid and a solid."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh

OCTAHEDRON = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
FACES = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def test_a_paraboloid_bends_as_it_does():
    # On a lattice of unit triangles, heights x² + y² − 1/2 have x² + y² as their limit.
    i, j = (part.ravel() for part in np.meshgrid(np.arange(-3, 4), np.arange(-3, 4), indexing="xy"))
    x, y = i + 0.5 * j, np.sqrt(0.75) * j
    vertices = np.column_stack([x, y, x * x + y * y - 0.5])
    first = np.array([v for v in range(42) if (v + 1) % 7])
    faces = np.concatenate(
        [np.column_stack([first, first + 1, first + 7]), np.column_stack([first + 1, first + 8, first + 7])]
    )
    centre = np.flatnonzero((np.abs(i[faces]) <= 1).all(axis=1) & (np.abs(j[faces]) <= 1).all(axis=1))
    weights = np.random.default_rng(7).dirichlet([1, 1, 1], len(centre))
    found = limitmesh.limit_surface(vertices, faces, at=centre, barycentric=weights)
    squared = (found.positions[:, :2] ** 2).sum(axis=1)
    np.testing.assert_allclose(found.positions[:, 2], squared, atol=1e-12)
    np.testing.assert_allclose(found.gaussian, 4 / (1 + 4 * squared) ** 2, atol=1e-10)
    np.testing.assert_allclose(found.mean, (2 + 4 * squared) / (1 + 4 * squared) ** 1.5, atol=1e-10)
    np.testing.assert_allclose(found.principal.prod(axis=1), found.gaussian, atol=1e-10)
    normals = np.cross(found.first[:, 0], found.first[:, 1])
    np.testing.assert_allclose(found.normals, normals / np.linalg.norm(normals, axis=1, keepdims=True), atol=1e-12)
    assert found.second.shape == (len(centre), 3, 3) and found.directions.shape == (len(centre), 2, 3)


def test_irregular_vertices_have_limits_and_no_curvature():
    found = limitmesh.limit_surface(OCTAHEDRON, FACES, at=[0, 0], barycentric=[[1, 0, 0], [0.5, 0.3, 0.2]])
    positions, normals = limitmesh.limit(OCTAHEDRON, FACES)
    np.testing.assert_allclose(found.positions[0], positions[0], atol=1e-15)
    np.testing.assert_allclose(found.normals[0], normals[0], atol=1e-15)
    np.testing.assert_allclose(found.positions[1], [0.32634375, 0.20559375, 0.144], atol=1e-15)
    assert np.isnan(found.gaussian[0]) and np.isnan(found.first[0]).all() and np.isfinite(found.gaussian[1])
    none = limitmesh.limit_surface(OCTAHEDRON, FACES, at=[], barycentric=[])
    assert none.positions.shape == (0, 3) and none.principal.shape == (0, 2)


@pytest.mark.parametrize(
    ("at", "barycentric", "words"),
    [
        ([8], [[1, 0, 0]], r"at\[0\] names face 8, expected 0 to 7"),
        ([0, -1], [[1, 0, 0]] * 2, r"at\[1\] names face -1"),
        ([0.5], [[1, 0, 0]], "whole numbers"),
        ([0], [[1, 0]], "barycentric has the shape"),
        ([0, 1], [[1, 0, 0], [0.5, 0.6, 0]], r"barycentric\[1\]: the weights add up to 1\.1 rather than 1"),
        ([0], [[0.333, 0.333, 0.333]], r"barycentric\[0\]: the weights add up to 0\.999"),
        ([0], [[1.5, -0.5, 0]], r"barycentric\[0\]: the weight -0\.5 is below 0"),
        ([0], [[np.nan, 0.5, 0.5]], r"barycentric\[0\]"),
        ([0], [["a", 0, 0]], "barycentric is no array"),
    ],
)
def test_places_that_are_none_are_errors(at, barycentric, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.limit_surface(OCTAHEDRON, FACES, at=at, barycentric=barycentric)


def test_weights_with_few_digits_are_the_place_that_was_meant():
    few = [[0.333333] * 3, [0.3333] * 3, [0.5, 0.5 + 1e-9, -1e-9]]
    found = limitmesh.limit_surface(OCTAHEDRON, FACES, at=[0, 0, 4], barycentric=few)
    meant = limitmesh.limit_surface(OCTAHEDRON, FACES, at=[0, 0, 4], barycentric=[[1 / 3] * 3] * 2 + [[0.5, 0.5, 0]])
    np.testing.assert_allclose(found.positions, meant.positions, atol=1e-8)
    np.testing.assert_allclose(found.gaussian, meant.gaussian, rtol=1e-7)
    np.testing.assert_allclose(found.positions[0], found.positions[1], atol=1e-15)


def test_faces_that_are_repaired_are_refused():
    with pytest.raises(limitmesh.MeshError, match="repair"):
        limitmesh.limit_surface(OCTAHEDRON, [[0, 1, 3, 4]], at=[0], barycentric=[[1, 0, 0]])
    clean = limitmesh.repair(OCTAHEDRON, [[0, 1, 3, 4]])
    found = limitmesh.limit_surface(clean.vertices, clean.faces, at=[0], barycentric=[[0.2, 0.3, 0.5]])
    assert np.isfinite(found.positions).all()
