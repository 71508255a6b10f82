"""Distances of shapes whose distance is known."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
FACES = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("certified", [False, True])
def test_parallel_squares(certified):
    found = limitmesh.measure((SQUARE, FACES), (SQUARE + [0, 0, 0.25], FACES), certified=certified)
    assert found.lower == pytest.approx(0.25, rel=0.02) and found.certified is certified
    assert found.lower <= 0.25 + 1e-12 <= found.upper + 1e-11
    assert found.forward.at[2] == 0.0 and found.forward.to[2] == pytest.approx(0.25)
    assert found.diagonal == pytest.approx(np.sqrt(2))
    if not certified:
        assert found.forward.mean == pytest.approx(0.25) and found.forward.samples > 1000


def test_directions_differ():
    half = SQUARE * [0.5, 1, 1]
    found = limitmesh.measure((SQUARE, [[0, 1, 2, 3]]), (half, FACES), certified=True, gap="0.01%")
    assert found.forward.lower == pytest.approx(0.5, rel=1e-3) and found.backward.upper < 1e-3


def test_distance_to_a_limit_surface(octahedron):
    vertices, faces = octahedron
    fine = limitmesh.refine(vertices, faces, tolerance=0.01)
    certified = limitmesh.measure(fine, limit_of=(vertices, faces), certified=True)
    sampled = limitmesh.measure(fine, limit_of=(vertices, faces), samples=20_000)
    assert certified.lower <= fine.error.upper and certified.upper >= fine.error.lower
    assert sampled.lower <= certified.upper + 2e-3
    # The control mesh is farthest at its corners, whose limits are known.
    corner = np.linalg.norm(limitmesh.limit(vertices, faces).positions - vertices, axis=1).max()
    coarse = limitmesh.measure((vertices, faces), limit_of=(vertices, faces), certified=True, gap=0.01)
    assert coarse.lower <= corner + 1e-9 and coarse.upper >= corner - 1e-9


def test_what_makes_no_sense():
    with pytest.raises(limitmesh.OptionError, match="one of them"):
        limitmesh.measure((SQUARE, FACES))
    with pytest.raises(limitmesh.OptionError, match="gap and max_work"):
        limitmesh.measure((SQUARE, FACES), (SQUARE, FACES), gap=1)
    with pytest.raises(limitmesh.MeshError, match="no triangles"):
        limitmesh.measure((SQUARE, []), (SQUARE, FACES))
    with pytest.raises(limitmesh.MeshError, match="NaN"):
        limitmesh.measure((SQUARE * np.nan, FACES), (SQUARE, FACES))
    with pytest.raises(limitmesh.OptionError, match="butterfly"):
        limitmesh.measure((SQUARE, FACES), limit_of=(SQUARE, FACES), scheme="butterfly", certified=True)


def test_info_of_a_cube():
    found = limitmesh.info("builtin:cube")
    size = np.ptp(limitmesh.load("builtin:cube").vertices, axis=0)
    assert found["volume"] == pytest.approx(size.prod()) and found["genus"] == 0
    assert found["area"] == pytest.approx(2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]))
    assert found["diagnosis"].clean and found["watertight"]
    opened = limitmesh.info(SQUARE, FACES)
    assert opened["volume"] is None and opened["boundary_edges"] == 4


def test_simplified_vertices_are_the_inputs(grid):
    fine = limitmesh.refine(*grid, tolerance=0.001)
    found = limitmesh.simplify(fine, tolerance=0.02)
    assert len(found.faces) < len(fine.faces) / 2 and found.bound <= 0.02
    np.testing.assert_array_equal(found.vertices, fine.vertices[found.parent_vertex])
    between = limitmesh.measure(found, fine, certified=True)
    assert between.lower <= found.bound
    few = limitmesh.simplify(fine, triangles=40, certify=False)
    assert len(few.faces) <= 40 and few.bound is None
