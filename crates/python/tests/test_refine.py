"""Refinement against closed forms and NumPy, not against its own numbers."""

from __future__ import annotations

import base64
import gzip
import html
import json
import pathlib
import pickle
import re
import urllib.parse
import urllib.request
import warnings

import numpy as np
import pytest

import limitmesh


def loop_step(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One step of Loop subdivision of a closed mesh, by the book."""
    edges: dict[tuple[int, int], list[int]] = {}
    around: list[set[int]] = [set() for _ in vertices]
    for face in faces:
        for i in range(3):
            a, b, c = (int(face[(i + k) % 3]) for k in range(3))
            edges.setdefault((min(a, b), max(a, b)), []).append(c)
            around[a] |= {b, c}
    fine = []
    for v, ring in enumerate(around):
        k = len(ring)
        beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / k) / 4) ** 2) / k
        fine.append((1 - k * beta) * vertices[v] + beta * sum(vertices[u] for u in ring))
    number = {}
    for (a, b), (c, d) in edges.items():
        number[a, b] = len(fine)
        fine.append(3 / 8 * (vertices[a] + vertices[b]) + (vertices[c] + vertices[d]) / 8)
    middle = lambda a, b: number[min(a, b), max(a, b)]
    parts = []
    for a, b, c in faces.tolist():
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        parts += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    return np.array(fine), np.array(parts)


def limits(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Where the vertices of a closed mesh go in the limit, by the closed form of Loop's."""
    around: list[set[int]] = [set() for _ in vertices]
    for face in faces.tolist():
        for i in range(3):
            around[face[i]] |= {face[i - 1], face[i - 2]}
    moved = []
    for v, ring in enumerate(around):
        k = len(ring)
        beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / k) / 4) ** 2) / k
        weight = 1 / (3 / (8 * beta) + k)
        moved.append((1 - k * weight) * vertices[v] + weight * sum(vertices[u] for u in ring))
    return np.array(moved)


def test_uniform_refinement_is_loops(octahedron):
    expected_vertices, expected_faces = loop_step(*loop_step(*octahedron))
    expected_vertices = limits(expected_vertices, expected_faces)
    found = limitmesh.refine(*octahedron, method="uniform", levels=2)
    assert found.vertices.shape == expected_vertices.shape
    assert found.faces.shape == expected_faces.shape
    # As sets of points: the order is each one's own.
    order = lambda points: points[np.lexsort(np.round(points, 9).T)]
    np.testing.assert_allclose(order(found.vertices), order(expected_vertices), atol=1e-12)
    assert found.error is None and found.stop == "levels"


@pytest.mark.parametrize("levels", [0, 1, 3, 5])
@pytest.mark.parametrize("index_dtype", [np.int32, np.uint32, np.int64])
def test_uniform_triangles_come_from_their_faces(octahedron, levels, index_dtype):
    vertices, faces = octahedron
    found = limitmesh.refine(vertices, faces, method="uniform", levels=levels, index_dtype=index_dtype)
    assert found.faces.dtype == index_dtype and len(found.faces) == 8 * 4**levels and found.levels == levels
    np.testing.assert_array_equal(found.parent_face, np.arange(8).repeat(4**levels))
    # Corners are where they are on their faces: three of a row of equal parts, a part's area apart.
    places = np.einsum("nk,nkx->nx", found.barycentric, vertices[found.barycentric_vertices])
    np.testing.assert_allclose(np.abs(places).sum(axis=1), 1.0)
    assert (np.sign(places[found.faces].mean(axis=1)) == np.sign(vertices[faces[found.parent_face]].mean(axis=1))).all()
    sides = np.diff(places[found.faces], axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    np.testing.assert_allclose(area, np.sqrt(3.0) / 4**levels)
    # The surface has the octahedron's symmetries.
    np.testing.assert_allclose(found.normals[:6], vertices, atol=1e-12)
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.barycentric, found.barycentric)
    carried = limitmesh.refine(vertices, faces, method="uniform", levels=levels, channels={"x": vertices[:, 0]})
    assert carried.vertices.tobytes() == found.vertices.tobytes()
    np.testing.assert_allclose(carried.at_vertices("x")[:, 0], places[:, 0], atol=1e-12)


@pytest.mark.parametrize("count", [5000, 5e3, "5000", "5k", "5K", " 5,000 ", "5_000", "5e3", "0.005M", "5.0k"])
def test_counts_are_taken_as_people_write_them(count):
    assert len(limitmesh.refine("builtin:cup", triangles=count).faces) == len(limitmesh.refine("builtin:cup", triangles=5000).faces)
    with pytest.warns(limitmesh.StoppedShort):
        assert len(limitmesh.refine("builtin:cup", tolerance=1e-9, max_triangles=count).faces) <= 5000


@pytest.mark.parametrize("count", ["", "k", "1.5", "-1", "1,5", "20,00", ",000", "1e-3", "nan", "inf", "20kk", "0x10", "0", "1_0"])
def test_what_is_no_count_is_refused(count):
    with pytest.raises(limitmesh.OptionError, match="triangles is .*, expected a whole number of at least 1, such as '20000', '20,000', '20k' or '2e4'"):
        limitmesh.refine("builtin:cup", triangles=count)


def test_meshes_and_results_are_shown_in_a_line(octahedron):
    vertices, faces = octahedron
    many = np.zeros((100_000, 3))
    mesh = limitmesh.Mesh(many, many.astype(int), {"heat": many[:, 0]}, creases=[(0, 1)] * 1000)
    assert str(mesh) == "Mesh(100000 vertices, 100000 faces, channels=<heat>, creases=<1000 rows>)"
    assert repr(limitmesh.Mesh(vertices.tolist(), faces.tolist())) == "Mesh(6 vertices, 8 faces)"
    found = limitmesh.refine(vertices, faces, tolerance=0.01, channels={"x": vertices[:, 0]})
    assert repr(found.channels["x"]).startswith("Channel(values=<")
    front = limitmesh.Front(vertices, faces)
    shown = [
        found,
        found.split(),
        found.channels["x"],
        limitmesh.simplify(found, triangles=100),
        limitmesh.repair(vertices, faces),
        limitmesh.project(vertices, vertices, faces),
        limitmesh.intersect(2.0 * vertices, -vertices, vertices, faces),
        limitmesh.limit_surface(vertices, faces, at=[0], barycentric=[[1, 0, 0]]),
        limitmesh.levels_of_detail(vertices, faces, levels=2),
        limitmesh.refine_frames([vertices, 2.0 * vertices], faces, tolerance=0.1),
        front.update(tolerance=0.01),
        front,
    ]
    for one in shown:
        text = f"{one} {one!r}"
        assert "\n" not in text and "array" not in text and len(text) < 2500, text


def test_limits_are_those_of_many_steps(octahedron):
    vertices, faces = octahedron
    positions, normals = limitmesh.limit(vertices, faces)
    fine_vertices, fine_faces = vertices, faces
    for _ in range(5):
        fine_vertices, fine_faces = loop_step(fine_vertices, fine_faces)
    np.testing.assert_allclose(positions, fine_vertices[:6], atol=1e-3)
    np.testing.assert_allclose(normals, vertices, atol=1e-12)
    # In closed form: (5/8 v + 3/8 mean of the ring) tends to the limit with weight 1/(1 + 3/(8 beta k)) of the ring.
    k = 4
    beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / k) / 4) ** 2) / k
    ring = 1 / (3 / (8 * beta) + k)
    np.testing.assert_allclose(positions, (1 - k * ring) * vertices, atol=1e-14)


def test_a_tolerance_is_kept(octahedron):
    found = limitmesh.refine(*octahedron, tolerance=0.01)
    assert found.met and found.stop == "met"
    assert found.error.certified and found.error.lower <= found.error.upper <= 0.01
    # Five levels stand for the limit surface, about 1e-3 off.
    vertices, faces = octahedron
    for _ in range(5):
        vertices, faces = loop_step(vertices, faces)
    distance = limitmesh.measure(found, (vertices, faces), certified=True)
    assert distance.certified and distance.lower <= found.error.upper + 2e-3
    edges = np.sort(np.concatenate([found.faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    np.testing.assert_allclose(np.linalg.norm(found.normals, axis=1), 1.0, atol=1e-12)


def test_results_are_arrays_of_their_own(octahedron):
    found = limitmesh.refine(*octahedron, tolerance=0.05)
    n, m = len(found.vertices), len(found.faces)
    assert found.vertices.dtype == np.float64 and found.faces.dtype == np.int64
    assert found.vertices.shape == found.normals.shape == found.barycentric.shape == (n, 3)
    assert found.faces.shape == (m, 3) and found.parent_face.shape == (m,)
    assert found.vertices.flags.writeable and found.vertices.flags.c_contiguous
    for dtype in (np.int32, np.uint32, np.uint64, "int64"):
        other = limitmesh.refine(*octahedron, tolerance=0.05, index_dtype=dtype)
        for name in ("faces", "parent_face", "vertex_face", "barycentric_vertices"):
            assert getattr(other, name).dtype == np.dtype(dtype)
            np.testing.assert_array_equal(getattr(other, name), getattr(found, name))
    for dtype in (np.int16, float, "apples"):
        with pytest.raises(limitmesh.OptionError, match="index_dtype"):
            limitmesh.refine(*octahedron, tolerance=0.05, index_dtype=dtype)


def test_origins_are_places_of_the_input(grid):
    vertices, faces = grid
    found = limitmesh.refine(vertices, faces, tolerance=0.01, flat_regions=False)
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1.0)
    # Which triangle it is, is told twice.
    assert (np.sort(faces[found.vertex_face], axis=1) == np.sort(found.barycentric_vertices, axis=1)).all()
    # x and y are linear, so their limits inside are where the barycentric coordinates say; the boundary is a spline of its own.
    places = np.einsum("nk,nkx->nx", found.barycentric, vertices[found.barycentric_vertices])
    inside = (places[:, :2] >= 1.0).all(axis=1) & (places[:, :2] <= 3.0).all(axis=1)
    assert inside.sum() > 20
    np.testing.assert_allclose(found.vertices[inside, :2], places[inside, :2], atol=1e-12)
    corners = vertices[faces[found.parent_face]][:, :, :2]
    middles = places[found.faces][:, :, :2].mean(axis=1)
    assert (middles >= corners.min(axis=1) - 1e-9).all() and (middles <= corners.max(axis=1) + 1e-9).all()


@pytest.mark.parametrize("options", [{"tolerance": 0.01}, {"method": "uniform", "levels": 2}])
def test_places_on_polygons_that_were_divided_are_not_of_three_vertices(options):
    ring = np.exp(2j * np.pi * np.arange(5) / 5)
    vertices = np.concatenate([np.column_stack([ring.real, ring.imag, np.full(5, z)]) for z in (0.0, 1.0)])
    sides = [[i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i] for i in range(5)]
    found = limitmesh.refine((vertices, [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *sides]), **options)
    assert found.barycentric is None and found.barycentric_vertices is None
    # The polygons are known: what is in the middle of one is of that one.
    assert set(found.vertex_face) == set(range(7))
    for face, z in ((0, found.vertices[:, 2].min()), (1, found.vertices[:, 2].max())):
        middle = np.linalg.norm(found.vertices - [0, 0, z], axis=1).argmin()
        assert found.vertex_face[middle] == face
    # Quads are not divided.
    cube = limitmesh.refine((vertices[[0, 1, 3, 4, 5, 6, 8, 9]], np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])), **options)
    assert cube.barycentric.shape == (len(cube.vertices), 3)


@pytest.mark.parametrize("method", ["uniform", "limit-normal", "amresh"])
def test_origins_of_steps_are_places_of_the_input(grid, method):
    vertices, faces = grid
    angle = None if method == "uniform" else 3
    found = limitmesh.refine(vertices, faces, method=method, levels=2, angle=angle)
    assert len(found.faces) > len(faces)
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1.0)
    assert (np.sort(faces[found.vertex_face], axis=1) == np.sort(found.barycentric_vertices, axis=1)).all()
    places = np.einsum("nk,nkx->nx", found.barycentric, vertices[found.barycentric_vertices])
    # Each triangle is a part of its face: parts have the area of the whole together.
    sides = np.diff(places[found.faces][:, :, :2], axis=1)
    area = np.abs(np.linalg.det(sides)) / 2
    np.testing.assert_allclose(np.bincount(found.parent_face, area, len(faces)), 0.5)
    corners = vertices[faces[found.parent_face]][:, :, :2]
    middles = places[found.faces][:, :, :2].mean(axis=1)
    assert (middles >= corners.min(axis=1) - 1e-9).all() and (middles <= corners.max(axis=1) + 1e-9).all()
    if method == "uniform":
        # Steps keep x and y where they are linear around, and divide every face in four.
        np.testing.assert_array_equal(found.parent_face, np.arange(len(faces)).repeat(16))
        inside = (places[:, :2] >= 1.0).all(axis=1) & (places[:, :2] <= 3.0).all(axis=1)
        np.testing.assert_allclose(found.vertices[inside, :2], places[inside, :2], atol=1e-12)
    bare = limitmesh.refine(vertices, faces, method=method, levels=2, angle=angle, origins=False)
    assert bare.vertices.tobytes() == found.vertices.tobytes() and bare.barycentric is None and bare.parent_face is None


def test_whatever_asarray_takes_gives_the_same(octahedron):
    vertices, faces = octahedron
    expected = limitmesh.refine(vertices, faces, tolerance=0.05)
    read_only = vertices.copy()
    read_only.flags.writeable = False
    others = [
        (vertices.astype(np.float32), faces),
        (vertices.astype(np.int8), faces),
        (np.asfortranarray(vertices), np.asfortranarray(faces)),
        (read_only, faces.astype(np.uint8)),
        (vertices.tolist(), faces.tolist()),
        (vertices[::-1][::-1], faces.astype(float)),
        (np.hstack([vertices, vertices])[:, ::2][:, [0, 2, 1]][:, [0, 2, 1]] * 0 + vertices, [tuple(f) for f in faces]),
        (vertices.astype(">f8"), faces.astype(">i4")),
        (tuple(map(tuple, vertices)), faces.astype(np.uint64)),
        (vertices, [np.array(f) for f in faces]),
        (np.ma.masked_array(vertices), faces),
    ]
    for other in others:
        found = limitmesh.refine(*other, tolerance=0.05)
        assert found.vertices.tobytes() == expected.vertices.tobytes()
        assert found.faces.tobytes() == expected.faces.tobytes()
    assert limitmesh.refine((vertices, faces), tolerance=0.05).faces.tobytes() == expected.faces.tobytes()
    assert limitmesh.refine(limitmesh.Mesh(vertices, faces), tolerance=0.05).faces.tobytes() == expected.faces.tobytes()


def test_corners_are_no_mask(octahedron):
    mask = np.zeros(6, dtype=bool)
    mask[5] = True
    with pytest.raises(limitmesh.OptionError, match="flatnonzero"):
        limitmesh.refine(*octahedron, corners=mask)


def test_polygons_of_any_number_of_corners():
    corners = [[0, 0, 0], [2, 0, 0], [3, 1, 0], [1, 2, 0], [0, 1, 0], [1, 1, 2]]
    faces = [[4, 3, 2, 1, 0], [0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 0, 5]]
    found = limitmesh.refine(corners, faces, tolerance="1%")
    assert found.diagnosis.findings["polygons"] == limitmesh.Finding(1, (0,))
    assert found.diagnosis.clean and set(found.parent_face.tolist()) == set(range(6))
    squares = limitmesh.refine("builtin:cube", tolerance="1%")
    assert limitmesh.info("builtin:cube")["watertight"] and squares.met


def test_threads_do_not_matter():
    one = limitmesh.refine("builtin:cup", tolerance="0.05%", threads=1)
    three = limitmesh.refine("builtin:cup", tolerance="0.05%", threads=3)
    for name in ("vertices", "faces", "normals", "barycentric", "parent_face"):
        assert getattr(one, name).tobytes() == getattr(three, name).tobytes()


def test_the_environment_says_how_many_threads(monkeypatch, octahedron):
    monkeypatch.setenv("LIMITMESH_NUM_THREADS", "2")
    assert limitmesh.refine(*octahedron, tolerance=0.05).met
    monkeypatch.setenv("LIMITMESH_NUM_THREADS", "none")
    with pytest.raises(limitmesh.OptionError, match="LIMITMESH_NUM_THREADS"):
        limitmesh.refine(*octahedron)


def test_goals(octahedron):
    assert len(limitmesh.refine(*octahedron, triangles=500).faces) <= 500
    assert len(limitmesh.refine(*octahedron, triangles=2e2).faces) <= 200
    optimised = limitmesh.refine(*octahedron, tolerance=0.01, optimize=True)
    plain = limitmesh.refine(*octahedron, tolerance=0.01)
    assert len(optimised.faces) < len(plain.faces) and optimised.error.upper <= 0.01
    assert set(optimised.parent_face.tolist()) <= set(range(8))
    angle = limitmesh.refine(*octahedron, angle=10)
    sides = angle.vertices[angle.faces]
    normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosines = np.einsum("mx,mkx->mk", normals, angle.corner_normals)
    assert (cosines >= np.cos(np.radians(10)) - 1e-12).all()
    camera = limitmesh.Camera(eye=(0, 0, 5), width=640, height=480)
    seen = limitmesh.refine(*octahedron, cameras=camera)
    assert seen.pixels <= 1.0
    stepwise = limitmesh.refine(*octahedron, method="limit-normal", angle=10, levels=2)
    assert 8 < len(stepwise.faces) <= 128
    assert len(limitmesh.refine(*octahedron, method="amresh", levels=1).faces) == 32


def test_creases_have_a_normal_a_side():
    found = limitmesh.refine("builtin:cube", crease_angle=30, tolerance="1%")
    sides = found.vertices[found.faces]
    normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(found.corner_normals, np.repeat(normals[:, None], 3, axis=1), atol=1e-9)
    split = found.split()
    assert len(split.vertices) == 24
    np.testing.assert_array_equal(split.vertices[split.faces], found.vertices[found.faces])
    np.testing.assert_allclose(split.normals[split.faces], found.corner_normals, atol=1e-6)
    by_hand = limitmesh.refine("builtin:cube", creases=[[0, 1]], tolerance="1%")
    assert by_hand.faces.shape != found.faces.shape


def test_creases_by_hand_are_those_by_angle():
    cube = limitmesh.load("builtin:cube")
    quads = np.asarray(cube.faces)
    edges = np.concatenate([quads[:, [i, (i + 1) % quads.shape[1]]] for i in range(quads.shape[1])])
    sharp = np.unique(np.sort(edges, axis=1), axis=0)
    if quads.shape[1] == 3:
        length = np.linalg.norm(cube.vertices[sharp[:, 0]] - cube.vertices[sharp[:, 1]], axis=1)
        sharp = sharp[length < 1.1 * length.min()]
    assert len(sharp) == 12
    by_hand = limitmesh.refine(cube, creases=sharp, tolerance="1%", concave_corners="divided")
    by_angle = limitmesh.refine(cube, crease_angle=30, tolerance="1%")
    assert by_hand.vertices.tobytes() == by_angle.vertices.tobytes()


def test_interpolation_passes_through_the_vertices(octahedron):
    vertices, faces = octahedron
    found = limitmesh.refine(vertices, faces, interpolate=True, tolerance=0.01)
    np.testing.assert_allclose(found.vertices[:6], vertices, atol=1e-9)
    near = limitmesh.refine(vertices, faces, interpolate="1%", tolerance=0.01)
    assert np.linalg.norm(near.vertices[:6] - vertices, axis=1).max() <= 0.01 * np.sqrt(12) + 1e-9
    np.testing.assert_allclose(limitmesh.limit(vertices, faces, interpolate=True).positions, vertices, atol=1e-9)


def test_stopping_short_warns_or_raises(octahedron):
    with pytest.warns(limitmesh.StoppedShort, match="max_triangles"):
        found = limitmesh.refine(*octahedron, tolerance=1e-6, max_triangles=1000)
    assert found.stop == "triangle-cap" and not found.met and len(found.faces) <= 1000
    with pytest.warns(limitmesh.StoppedShort, match="max_memory"):
        found = limitmesh.refine(*octahedron, tolerance=1e-9, max_memory="1MB")
    assert found.stop == "memory-cap"
    with pytest.raises(limitmesh.ToleranceNotMet, match="max_levels") as caught:
        limitmesh.refine(*octahedron, tolerance=1e-9, max_levels=2, strict=True)
    assert len(caught.value.result.faces) > 8
    again = pickle.loads(pickle.dumps(caught.value))
    assert isinstance(again, limitmesh.ToleranceNotMet) and len(again.result.faces) == len(caught.value.result.faces)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        limitmesh.refine(*octahedron, tolerance=0.1, strict=True)


def test_results_pickle(octahedron):
    found = limitmesh.refine(*octahedron, tolerance=0.05, channels={"x": octahedron[0][:, 0]})
    again = pickle.loads(pickle.dumps(found))
    assert again.vertices.tobytes() == found.vertices.tobytes()
    assert again.error == found.error and again.diagnosis == found.diagnosis
    assert again.corner_normals.tobytes() == found.corner_normals.tobytes()
    np.testing.assert_array_equal(again.at_vertices("x"), found.at_vertices("x"))
    with pytest.raises(AttributeError):
        found.stop = "never"


def test_options_and_errors_pickle(octahedron):
    camera = limitmesh.Camera(eye=(0, 0, 5))
    assert pickle.loads(pickle.dumps(camera)) == camera
    mesh = limitmesh.Mesh(*octahedron, {"x": limitmesh.Channel(octahedron[0][:, 0])}, creases=[(0, 2)])
    again = pickle.loads(pickle.dumps(mesh))
    options = {"cameras": camera, "pixels": 2.0, "crease_angle": 80, "threads": 1}
    options = pickle.loads(pickle.dumps(options))
    assert limitmesh.refine(again, **options).vertices.tobytes() == limitmesh.refine(mesh, **options).vertices.tobytes()
    assert pickle.loads(pickle.dumps(limitmesh.estimate(mesh, tolerance="1%"))) == limitmesh.estimate(mesh, tolerance="1%")
    for kind in (limitmesh.Error, limitmesh.MeshError, limitmesh.OptionError, limitmesh.ReadError):
        told = pickle.loads(pickle.dumps(kind("faces[3]")))
        assert type(told) is kind and str(told) == "faces[3]"


def test_notebooks_see_the_page(octahedron, tmp_path, monkeypatch):
    found = limitmesh.refine(*octahedron)
    shown = found._repr_html_()
    assert shown.startswith("<div><iframe") and "certainly within" in shown
    assert html.escape(found.page()) in shown
    data = json.loads(re.search(r'id="limitmesh">(.*?)</script>', found.page("a <b>"))[1])
    (stop,) = data["stops"]
    assert data["name"] == "a <b>" and data["live"] is None
    assert stop["report"]["triangles"] == len(found.faces) and stop["report"]["upper"] == found.error.upper
    packed = re.search(rf'id="{stop["parts"]["glb"]["blob"]}">(.*?)</script>', found.page())[1]
    found.save(tmp_path / "mesh.glb")
    assert gzip.decompress(base64.b64decode(packed)) == (tmp_path / "mesh.glb").read_bytes()
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    found.view()
    path = pathlib.Path(urllib.request.url2pathname(urllib.parse.urlparse(opened[0]).path))
    assert path.read_text(encoding="utf-8") == found.page()
    path.unlink()


def test_estimates_are_near(octahedron):
    found = limitmesh.estimate(*octahedron, tolerance=0.005)
    assert found.counted and found.triangles == len(limitmesh.refine(*octahedron, tolerance=0.005).faces)


def test_repairs_are_told():
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]
    faces = [[0, 2, 1], [4, 1, 3], [1, 2, 3], [2, 3, 4], [2, 1, 0]]
    found = limitmesh.refine(vertices, faces, tolerance="1%")
    assert not found.diagnosis.clean
    assert found.diagnosis.findings["flipped_faces"].first == (3,)
    assert found.diagnosis.findings["repeated_faces"].first == (4,)
    with pytest.raises(limitmesh.MeshError, match="repair"):
        limitmesh.refine(vertices, faces, tolerance="1%", repair=False)
    mended = limitmesh.repair(vertices, faces)
    assert mended.faces.shape == (4, 3) and len(mended.vertices) == 4
    np.testing.assert_array_equal(np.asarray(vertices)[mended.parent_vertices], mended.vertices[mended.faces])


def test_limits_of_vertices_without_faces():
    positions, normals = limitmesh.limit([[9, 9, 9], [0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 2, 3]], boundary="fixed")
    assert np.isnan(positions[0]).all() and np.isnan(normals[0]).all()
    np.testing.assert_array_equal(positions[1:], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
