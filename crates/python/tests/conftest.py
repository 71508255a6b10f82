"""Shapes that the tests share."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest


def pytest_collection_modifyitems(items):
    """Passes over examples with libraries that are not installed."""
    for item in items:
        lines = [one.source.split() for one in item.dtest.examples] if isinstance(item, pytest.DoctestItem) else []
        for library in (line[1] for line in lines if line[:1] == ["import"]):
            if find_spec(library.rstrip(",")) is None:
                item.add_marker(pytest.mark.skip(reason=f"{library} is not installed"))


@pytest.fixture
def octahedron() -> tuple[np.ndarray, np.ndarray]:
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    return vertices, faces


@pytest.fixture
def grid() -> tuple[np.ndarray, np.ndarray]:
    """A square of 4 x 4 squares, bent a little."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    vertices = np.stack([x, y, 0.2 * np.sin(x + y)], axis=-1).reshape(-1, 3)
    at = np.arange(25).reshape(5, 5)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return vertices, faces
