"""``creases="auto"``: what looks like a part keeps its sharp edges and its size, against exact shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import limitmesh

SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def box(x, y, z):
    """A box of triangles."""
    vertices = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * [x, y, z]
    faces = [triangle for a, b, c, d in SIDES for triangle in ([a, b, c], [a, c, d])]
    return vertices.astype(float), faces


def peg(facets, radius, height):
    """A peg between flat ends."""
    turns = 2 * np.pi * np.arange(facets) / facets
    ring = np.stack([radius * np.cos(turns), radius * np.sin(turns), 0 * turns], axis=1)
    vertices = np.concatenate([ring, ring + [0, 0, height]])
    faces = []
    for i in range(facets):
        j = (i + 1) % facets
        faces += [[i, j, j + facets], [i, j + facets, i + facets]]
    for i in range(1, facets - 1):
        faces += [[0, i + 1, i], [facets, facets + i, facets + i + 1]]
    return vertices, faces


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_a_box_is_itself_where_that_is_asked_for():
    vertices, faces = box(40, 20, 5)
    found = limitmesh.refine(vertices, faces, creases="auto")
    assert volume(found) == pytest.approx(4000, abs=1e-6)
    assert found.crease_angle == 30
    assert found.interpolation["folded_regions"] == 0
    plain = limitmesh.refine(vertices, faces)
    assert volume(plain) < 2000
    assert (plain.crease_angle, plain.interpolation) == (None, None)
    assert limitmesh.refine(vertices, faces, crease_angle=40).crease_angle == 40


def test_a_peg_keeps_its_radius_unless_that_is_refused():
    vertices, faces = peg(16, 5, 8)
    exact = math.pi * 25 * 8
    assert volume(limitmesh.refine(vertices, faces, creases="auto", tolerance="0.01%")) == pytest.approx(exact, rel=1e-3)
    smaller = limitmesh.refine(vertices, faces, creases="auto", interpolate=False, tolerance="0.01%")
    assert (smaller.crease_angle, smaller.interpolation) == (30, None)
    assert volume(smaller) < 0.96 * exact
    fine = limitmesh.refine(vertices, faces, creases="auto", tolerance="0.01%")
    near = limitmesh.measure(fine, limit_of=(vertices, faces), creases="auto")
    assert near.lower < 2e-3


def test_cages_and_tagged_meshes_are_not_looked_at():
    vertices, faces = box(4, 2, 1)
    cage = limitmesh.refine(vertices, SIDES, creases="auto")
    assert cage.crease_angle is None
    assert volume(cage) < 5
    tagged = limitmesh.Mesh(vertices, faces, creases=[(0, 1)])
    assert limitmesh.refine(tagged, creases="auto").crease_angle is None
    assert limitmesh.info((vertices, SIDES))["dihedrals"]["look"] == "cage"
    assert limitmesh.info((vertices, faces))["dihedrals"]["look"] == "part"


def test_files_too(tmp_path):
    source, target = tmp_path / "box.stl", tmp_path / "out.ply"
    limitmesh.save(source, box(40, 20, 5))
    report = limitmesh.refine_file(source, target, creases="auto")
    assert report["size"]["after"]["volume"] == pytest.approx(4000, abs=1e-6)
    assert report["parameters"]["crease_angle_auto"]
    assert report["notes"][0].startswith("looks like a part: 12 edges")
    as_the_program = limitmesh.refine_file(source, target)
    assert as_the_program["size"] == report["size"]
    for options in ({"creases": "none"}, {"method": "uniform"}):
        assert limitmesh.refine_file(source, target, **options)["size"]["after"]["volume"] < 2000
    with pytest.raises(limitmesh.OptionError, match="interpolate=False"):
        limitmesh.refine_file(source, target, interpolate=False)
    plain = limitmesh.refine_file(source, target, interpolate=False, creases="none")
    assert plain["size"]["after"]["volume"] < 2000
    with pytest.raises(limitmesh.OptionError, match="overwrite"):
        limitmesh.refine_file(source, source)
    limitmesh.refine_file(source, source, overwrite=True)


def test_what_contradicts_itself_is_refused():
    vertices, faces = box(1, 1, 1)
    for options in ({"creases": "auto", "crease_angle": 30}, {"creases": "sharp"}):
        with pytest.raises(limitmesh.OptionError, match="crease"):
            limitmesh.refine(vertices, faces, **options)
