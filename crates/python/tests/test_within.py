"""The smoothest mesh near the input: voxels of a ball, against the ball, the voxels' own faces and the divergence theorem."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import limitmesh


def voxel_ball(radius: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Outer squares of the voxels around whole-numbered points of a ball, as quads, and how many voxels there are."""
    span = range(-radius, radius + 1)
    inside = {point for point in itertools.product(span, repeat=3) if sum(x * x for x in point) <= radius * radius}
    squares = []
    for point in sorted(inside):
        for axis, side in itertools.product(range(3), (-1, 1)):
            beyond = list(point)
            beyond[axis] += side
            if tuple(beyond) in inside:
                continue
            square = np.tile(np.array(point, dtype=float), (4, 1))
            square[:, axis] += 0.5 * side
            square[:, (axis + 1) % 3] += 0.5 * np.array([-1, 1, 1, -1])
            square[:, (axis + 2) % 3] += 0.5 * side * np.array([-1, -1, 1, 1])
            squares.append(square)
    vertices, faces = np.unique(np.concatenate(squares), axis=0, return_inverse=True)
    return vertices, faces.reshape(-1, 4), len(inside)


def distance_to_squares(points: np.ndarray, squares: np.ndarray) -> np.ndarray:
    """From points to the nearest of squares along the axes: what is beyond their boxes."""
    low, high = squares.min(axis=1), squares.max(axis=1)
    nearest = []
    for point in points:
        beyond = np.maximum(np.maximum(low - point, point - high), 0.0)
        nearest.append(np.sqrt((beyond**2).sum(axis=1).min()))
    return np.array(nearest)


def test_a_ball_of_voxels_becomes_round():
    vertices, faces, voxels = voxel_ball(10)
    found = limitmesh.refine(vertices, faces, within=0.87, strict=True)
    radii = np.linalg.norm(found.vertices, axis=1)
    assert radii.std() <= 0.07 and found.met
    a, b, c = (found.vertices[found.faces[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(voxels, rel=0.01)
    assert found.input_distance is not None
    lower, upper = found.input_distance
    assert lower <= upper <= 0.87
    points = np.concatenate([found.vertices[::7], (a + b + c)[::7] / 3])
    assert distance_to_squares(points, vertices[faces]).max() <= 0.87
    assert limitmesh.refine(vertices, faces, within="2%").input_distance[1] <= 0.02 * np.linalg.norm(np.ptp(vertices, axis=0))
    assert limitmesh.refine(vertices, faces, tolerance=0.1).input_distance is None


def test_what_does_not_go_with_it_is_refused():
    for options in (
        {"tolerance": 0.1},
        {"interpolate": True},
        {"interpolate": 0.1},
        {"optimize": True},
        {"method": "uniform"},
        {"scheme": "sqrt3"},
        {"scheme": "butterfly"},
    ):
        with pytest.raises(limitmesh.OptionError, match="within"):
            limitmesh.refine("builtin:cup", within=0.1, **options)
    for length in (0.0, -1.0, "0%", float("nan"), True):
        with pytest.raises(limitmesh.OptionError, match="within"):
            limitmesh.refine("builtin:cup", within=length)


def test_files_are_refined_within_a_distance(tmp_path):
    vertices, faces, _ = voxel_ball(5)
    limitmesh.save(tmp_path / "ball.obj", limitmesh.Mesh(vertices, faces))
    report = limitmesh.refine_file(tmp_path / "ball.obj", tmp_path / "round.ply", within=0.8)
    assert report["parameters"]["within"] == 0.8
    assert report["input_distance"]["upper"] <= 0.8
    radii = np.linalg.norm(limitmesh.load(tmp_path / "round.ply").vertices, axis=1)
    assert radii.std() <= 0.1
