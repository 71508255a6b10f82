"""What is wrong is an error that names the row, whatever it is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import limitmesh

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (CORNERS, [[0, 1, 2], [0, 1, -1]], r"faces\[1\] names vertex -1 in column 2, expected 0 to 3"),
        (CORNERS, [[0, 1, 2], [0, 4, 1]], r"faces\[1\] names vertex 4 in column 1, expected 0 to 3"),
        (CORNERS, [[0, 1, 2], [0, 2**40, 1]], r"faces\[1\] names vertex 1099511627776"),
        (CORNERS, np.array([[0, 1, 2**63]], dtype=np.uint64), r"faces\[0\] names vertex 9223372036854775808"),
        (CORNERS, [[0, 1, 2], [0, 1, 2.5]], r"faces\[1\] names vertex 2.5 in column 2, expected a whole number"),
        (CORNERS, [[0, 1, 2], [0, 1, np.nan]], r"faces\[1\] names vertex nan"),
        (CORNERS, [[0, 1, 2], [0, 1, 2, 9]], r"faces\[1\] names vertex 9 in column 3"),
        (CORNERS, [[0, 1, 2], [0, 1, 2, 1.5]], r"faces\[1\] is .*whole numbers"),
        (CORNERS, [[0, 1, 2], ["a", "b", "c", "d"]], r"faces\[1\] is"),
        (CORNERS, [["a", "b", "c"]], "faces"),
        (CORNERS, [[[0, 1, 2]]], "shape"),
        (CORNERS, 7, "faces"),
        (CORNERS, [True], "faces"),
        (CORNERS, np.ones((2, 3), dtype=bool), "faces are of the type bool"),
        (CORNERS, np.ones((2, 3), dtype=complex), "faces are of the type complex"),
        ([[0, 0, 0], [1, np.nan, 0], [0, 1, 0]], [[0, 1, 2]], r"vertices\[1, 1\] is NaN"),
        ([[0, 0, 0], [1, 0, -np.inf], [0, 1, 0]], [[0, 1, 2]], r"vertices\[1, 2\] is -inf"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], r"vertices have the shape \(3, 2\)"),
        ([[0, 0, 0], [1, 0], [0, 1, 0]], [[0, 1, 2]], r"vertices\[1\] is \[1, 0\]"),
        ([[0, 0, 0], ["x", 0, 0], [0, 1, 0]], [[0, 1, 2]], r"vertices\[1\] is"),
        (None, [[0, 1, 2]], "vertices"),
        (CORNERS, [], "no face"),
        ([], [], "no face"),
        ([], [[0, 1, 2]], "there are no vertices"),
    ],
)
def test_meshes_that_are_none(vertices, faces, words):
    with pytest.raises(limitmesh.MeshError, match=words):
        limitmesh.refine(vertices, faces)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerance": 0}, "tolerance is 0"),
        ({"tolerance": -1.0}, "tolerance"),
        ({"tolerance": "a bit"}, "tolerance is 'a bit'"),
        ({"tolerance": "-1%"}, "tolerance"),
        ({"tolerance": np.nan}, "tolerance is nan"),
        ({"tolerance": True}, "tolerance is True"),
        ({"triangles": 0}, "triangles is 0"),
        ({"triangles": 10.5}, "triangles is 10.5"),
        ({"angle": 181}, "angle is 181"),
        ({"pixels": 1}, "cameras"),
        ({"pixels": -1, "cameras": limitmesh.Camera((0, 0, 5))}, "pixels is -1"),
        ({"cameras": [(0, 0, 5)]}, r"cameras\[0\]"),
        ({"cameras": limitmesh.Camera((0, 0, 0))}, "eye"),
        ({"cameras": limitmesh.Camera((0, 0, 5), fov=180)}, r"cameras\[0\].fov is 180"),
        ({"cameras": limitmesh.Camera((0, 0, 5), width=0)}, r"cameras\[0\].width is 0"),
        ({"interpolate": -1}, "interpolate is -1"),
        ({"crease_angle": 0}, "crease_angle is 0"),
        ({"creases": [[0, 9]]}, r"creases\[0\] names vertex 9, expected 0 to 3"),
        ({"creases": [[0, 1], [1]]}, r"creases\[1\] is \[1\]"),
        ({"creases": [[0, 1, -2]]}, r"creases\[0\] has the sharpness -2"),
        ({"creases": [[0, 1.5]]}, r"creases\[0\] names vertex 1.5"),
        ({"corners": [7]}, r"corners\[0\] names vertex 7"),
        ({"boundary": "rough"}, "boundary is 'rough'"),
        ({"scheme": "doo-sabin"}, "scheme is 'doo-sabin'"),
        ({"method": "magic"}, "method is 'magic'"),
        ({"method": "uniform", "tolerance": 1}, "tolerance is a goal of method='exact'"),
        ({"levels": 3}, "levels are steps"),
        ({"optimize": True, "angle": 5}, "edges are collapsed for a tolerance or a number of triangles alone"),
        ({"optimize": True, "balance": True}, "balance does not go with optimize"),
        ({"max_memory": "lots"}, "max_memory is 'lots'"),
        ({"max_memory": -1}, "max_memory is -1"),
        ({"threads": 0}, "threads is 0"),
        ({"weld": -1}, "weld is -1"),
        ({"progress": 5}, "progress is 5"),
        ({"view": (0, 0), "angle": 5}, "view is"),
        ({"view": (0, 0, 0), "angle": 5}, "direction"),
        ({"view": (0, 0, 1), "eye": (0, 0, 1)}, "one of them"),
        ({"channels": {"x": [1, 2]}}, "fits none"),
        ({"channels": {"x": [1, 2, 3, 4]}}, "fits several"),
        ({"channels": {"x": ["a", "b", "c", "d"]}}, "expected numbers"),
        ({"channels": {"x": limitmesh.Channel([1, 2, np.nan, 4.0])}}, "NaN"),
        ({"channels": {"x": limitmesh.Channel([1, 2.0], indices=[0, 1, 2, 0])}}, "index 2"),
        ({"channels": {"x": limitmesh.Channel([1, 2.0], indices=[0, 1, -2, 0])}}, r"indices\[2\] is -2"),
        ({"channels": {"x": limitmesh.Channel([1, 2.0], domain="edge")}}, "domain is 'edge'"),
        ({"channels": {"x": limitmesh.Channel([1, 2.0, 3, 4], semantic="smell")}}, "semantic is 'smell'"),
    ],
)
def test_options_that_make_no_sense(options, words):
    with pytest.raises(limitmesh.OptionError, match=words):
        limitmesh.refine(CORNERS, FACES, **options)


def test_errors_are_value_errors_of_one_family():
    assert issubclass(limitmesh.Error, ValueError)
    for error in (limitmesh.MeshError, limitmesh.OptionError, limitmesh.ReadError, limitmesh.ToleranceNotMet):
        assert issubclass(error, limitmesh.Error) and error.__module__.startswith("limitmesh")
    with pytest.raises(limitmesh.ReadError, match="nothing.ply"):
        limitmesh.load("nothing.ply")
    with pytest.raises(limitmesh.ReadError, match="built-in model 'chair'"):
        limitmesh.load("builtin:chair")
    with pytest.raises(limitmesh.MeshError, match="int and faces are missing"):
        limitmesh.refine(5)


SOUPS = st.tuples(
    arrays.arrays(
        np.float64,
        st.tuples(st.integers(0, 12), st.just(3)),
        elements=st.one_of(st.integers(-3, 3).map(float), st.floats(width=32), st.just(np.nan), st.just(1e300)),
    ),
    st.one_of(
        arrays.arrays(np.int64, st.tuples(st.integers(0, 20), st.integers(0, 5)), elements=st.integers(-1, 12)),
        st.lists(st.lists(st.integers(0, 11), max_size=7), max_size=12),
    ),
)


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    soup=SOUPS,
    crease_angle=st.sampled_from([None, 30.0, 180.0]),
    boundary=st.sampled_from(["smooth", "corners", "fixed"]),
    interpolate=st.sampled_from([False, False, True]),
    optimize=st.booleans(),
    repair=st.booleans(),
    scheme=st.sampled_from(["loop", "loop", "loop-warren", "butterfly"]),
)
@pytest.mark.filterwarnings("ignore")
def test_random_soups_give_a_mesh_or_an_error(soup, crease_angle, boundary, interpolate, optimize, repair, scheme):
    vertices, faces = soup
    try:
        found = limitmesh.refine(
            vertices,
            faces,
            triangles=300,
            tolerance="1%",
            crease_angle=crease_angle,
            boundary=boundary,
            interpolate=interpolate,
            optimize=optimize,
            repair=repair,
            scheme=scheme,
            threads=1,
        )
    except limitmesh.Error:
        return
    assert np.isfinite(found.vertices).all() and np.isfinite(found.normals).all()
    assert found.faces.min() >= 0 and found.faces.max() < len(found.vertices)
    limitmesh.info(vertices, faces)
    limitmesh.limit(vertices, faces)
    limitmesh.repair(vertices, faces)


def of_rays(vertices, faces, **how):
    directions = np.random.default_rng(0).normal(size=(10, 3))
    found = limitmesh.intersect(-directions, directions, vertices, faces, between=(-np.inf, np.inf), **how)
    return found.points, found.t


def of_levels(vertices, faces, **how):
    options = {"tolerances": ["10%", "3%"], "morph": True, "max_triangles": 300}
    levels = limitmesh.levels_of_detail(vertices, faces, **options, **how)
    return [level.vertices if level.coarser is None else level.at(0.5) for level in levels]


def of_a_replay(vertices, faces, **how):
    moving = limitmesh.replay(vertices, faces, tolerance="5%", max_triangles=300, **how)
    positions, normals = moving(vertices)
    np.testing.assert_allclose(positions, moving.refined.vertices, atol=1e-9 * np.abs(positions).max())
    return positions, normals


def of_frames(vertices, faces, **how):
    found = limitmesh.refine_frames([vertices, 0.5 * vertices], faces, tolerance="5%", max_triangles=1000, **how)
    return found.vertices, found.normals


def of_a_front(vertices, faces, **how):
    front = limitmesh.Front(vertices, faces, **how)
    for tolerance in ("10%", "3%", "10%"):
        front.update(tolerance=tolerance, triangles=300)
    return [front.vertices[front.faces]]


def of_refinement(**options):
    def of(vertices, faces, **how):
        found = limitmesh.refine(vertices, faces, max_triangles=300, **options, **how)
        return found.vertices, found.normals, found.corner_normals

    return of


OF_SOUPS = [
    of_rays,
    of_levels,
    of_a_replay,
    of_frames,
    of_a_front,
    of_refinement(scheme="sqrt3"),
    of_refinement(scheme="sqrt3", method="uniform"),
    of_refinement(method="planarity"),
    of_refinement(method="vertex-error"),
]


@settings(max_examples=400, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    soup=SOUPS,
    of=st.sampled_from(OF_SOUPS),
    crease_angle=st.sampled_from([None, 30.0]),
    boundary=st.sampled_from(["smooth", "corners", "fixed"]),
    repair=st.booleans(),
)
@pytest.mark.filterwarnings("ignore")
def test_random_soups_give_finite_numbers_or_an_error(soup, of, crease_angle, boundary, repair):
    how = {"crease_angle": crease_angle, "boundary": boundary, "threads": 1}
    if of is not of_rays:
        how["repair"] = repair
    try:
        found = of(*soup, **how)
    except limitmesh.Error:
        return
    assert all(np.isfinite(array).all() for array in found)


def test_options_that_are_equal_but_not_the_same(octahedron):
    # What was made of options is remembered: True is 1, and an array may be changed in place.
    with pytest.warns(limitmesh.StoppedShort):
        limitmesh.refine(*octahedron, triangles=1)
    with pytest.raises(limitmesh.OptionError, match="triangles is True"):
        limitmesh.refine(*octahedron, triangles=True)
    eye = np.array([9.0, 0.0, 0.0])
    one = limitmesh.refine(*octahedron, angle=5, eye=eye)
    eye[:] = [0.0, 9.0, 0.0]
    other = limitmesh.refine(*octahedron, angle=5, eye=eye)
    again = limitmesh.refine(*octahedron, angle=5, eye=[0.0, 9.0, 0.0])
    assert one.vertices.tobytes() != other.vertices.tobytes() == again.vertices.tobytes()


@pytest.mark.parametrize("tolerance", ["0.1%", 0.01])
def test_an_option_without_its_name(tolerance):
    with pytest.raises(limitmesh.MeshError, match="options have names, such as tolerance="):
        limitmesh.refine("builtin:cup", tolerance)
