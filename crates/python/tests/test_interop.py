"""Other libraries' meshes there and back, where these are installed."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import limitmesh


def box() -> tuple[np.ndarray, np.ndarray]:
    """Twice as long as wide, twice as wide as high; its volume is 1."""
    corners = np.array([[x, y, z] for x in (0.0, 2.0) for y in (0.0, 1.0) for z in (0.0, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([[a, b, c] for a, b, c, d in quads] + [[a, c, d] for a, b, c, d in quads])


def test_parts_are_watertight_for_trimesh():
    trimesh = pytest.importorskip("trimesh")
    fine = limitmesh.refine(*box(), crease_angle=30, channels={"part": np.arange(12)})
    assert len(fine.split().vertices) > len(fine.vertices)
    back = limitmesh.to_trimesh(fine)
    assert back.is_watertight and back.is_winding_consistent and abs(back.volume - 1.0) < 1e-12
    assert len(back.vertices) == len(fine.vertices) and len(back.face_attributes["part"]) == len(back.faces)
    # Its normals are trimesh's own: at a corner of a box they lean towards all three sides.
    own = trimesh.Trimesh(fine.vertices, fine.faces, process=False)
    np.testing.assert_allclose(back.vertex_normals, own.vertex_normals)


def test_nothing_is_imported_before_it_is_needed():
    program = (
        "import sys, limitmesh; limitmesh.refine('builtin:cup');"
        "print([name for name in ('trimesh', 'pyvista', 'meshio', 'open3d', 'matplotlib', 'fsspec', 'pyarrow') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.strip() == "[]"


def test_what_is_missing_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ImportError, match="pip install trimesh"):
        limitmesh.to_trimesh(limitmesh.refine("builtin:cup"))


def test_trimesh_there_and_back(octahedron):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = octahedron
    mesh = trimesh.Trimesh(vertices, faces, process=False, vertex_attributes={"heat": vertices[:, 2]})
    mesh.visual = trimesh.visual.TextureVisuals(uv=vertices[:, :2])
    fine = limitmesh.refine(mesh, tolerance=0.05)
    np.testing.assert_allclose(
        fine.at_vertices("heat")[:, 0], (vertices[fine.barycentric_vertices, 2] * fine.barycentric).sum(axis=1), atol=1e-12
    )
    back = limitmesh.to_trimesh(fine, visual=mesh.visual)
    assert back.is_watertight and len(back.faces) == len(fine.faces)
    np.testing.assert_allclose(back.vertices, fine.vertices)
    np.testing.assert_allclose(back.vertex_normals, fine.normals, atol=1e-6)
    np.testing.assert_allclose(back.visual.uv, fine.at_vertices("uv"))
    assert back.vertex_attributes["heat"].shape == (len(back.vertices),)


def test_trimesh_colours(octahedron):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = octahedron
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.visual.vertex_colors = np.tile([255, 0, 51, 255], (6, 1)).astype(np.uint8)
    back = limitmesh.to_trimesh(limitmesh.refine(mesh, tolerance=0.05))
    assert (back.visual.vertex_colors == [255, 0, 51, 255]).all()
    mesh.visual = trimesh.visual.ColorVisuals(mesh, face_colors=np.arange(32).reshape(8, 4).astype(np.uint8))
    fine = limitmesh.refine(mesh, tolerance=0.05)
    back = limitmesh.to_trimesh(fine)
    assert (back.visual.face_colors == np.arange(32).reshape(8, 4)[fine.parent_face]).all()


def test_pyvista_there_and_back():
    pyvista = pytest.importorskip("pyvista")
    plane = pyvista.Plane(i_resolution=4, j_resolution=4)
    plane.points[:, 2] = 0.1 * np.sin(9 * plane.points[:, 0])
    plane.point_data["heat"] = plane.points[:, 0].astype(float)
    plane.cell_data["part"] = np.arange(plane.n_cells)
    fine = limitmesh.refine(plane, tolerance="0.1%")
    assert not np.asarray(limitmesh.from_pyvista(plane).faces).ndim == 0
    back = limitmesh.to_pyvista(fine)
    assert back.n_cells == len(fine.faces)
    np.testing.assert_array_equal(back.cell_data["part"], fine.parent_face)
    np.testing.assert_allclose(back.point_data["heat"], fine.at_vertices("heat")[:, 0])
    assert back.active_texture_coordinates.shape == (back.n_points, 2)
    volume = pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid()
    assert limitmesh.refine(volume, crease_angle=30).error.certified


def accessors():
    """PyVista with a registry of accessors."""
    pyvista = pytest.importorskip("pyvista", minversion="0.48")
    pyvista.registered_accessors()
    return pyvista


def test_pyvista_finds_limitmesh_by_itself():
    accessors()
    program = (
        "import sys, pyvista; print('limitmesh' in sys.modules, 'limitmesh' in dir(pyvista.Sphere()));"
        "print(pyvista.Icosahedron().limitmesh.refine('0.1%').n_open_edges)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.split() == ["False", "True", "0"]


def test_pyvista_in_one_call():
    pyvista = accessors()
    mesh = pyvista.Icosahedron()
    heat = mesh.points[:, 0].astype(np.float32)
    gaps = np.where(np.arange(mesh.n_points) == 3, np.nan, 1.0)
    mesh.point_data.update({"heat": heat, "flow": mesh.points.astype(np.float64), "gaps": gaps})
    mesh.point_data.update({"id": np.arange(mesh.n_points, dtype=np.int16) + 2**14, "big": np.arange(mesh.n_points) + 2**60})
    mesh.point_data["RGB"] = np.tile(np.array([255, 0, 51], dtype=np.uint8), (mesh.n_points, 1))
    mesh.point_data["name"] = np.array([f"point {i}" for i in range(mesh.n_points)])
    mesh.cell_data.update({"part": np.arange(mesh.n_cells, dtype=np.uint8), "stress": np.linspace(0, 1, mesh.n_cells, dtype=np.float32)})
    mesh.cell_data.update({"on": np.arange(mesh.n_cells) % 2 == 0, "heat": np.arange(mesh.n_cells), "hole": np.full(mesh.n_cells, np.nan)})
    mesh.cell_data["label"] = np.array([f"cell {i}" for i in range(mesh.n_cells)])
    mesh.field_data["unit"] = ["mm"]
    mesh.set_active_scalars("part", preference="cell")
    before = mesh.copy()
    fine = mesh.limitmesh.refine("0.1%")
    assert mesh == before and isinstance(fine, pyvista.PolyData) and fine.is_all_triangles and fine.n_open_edges == 0
    own = limitmesh.refine(mesh.points, mesh.regular_faces, tolerance="0.1%")
    np.testing.assert_array_equal(fine.points, own.vertices)
    np.testing.assert_array_equal(fine.regular_faces, own.faces)
    assert fine.active_scalars_name == "part" and list(fine.field_data["unit"]) == ["mm"]
    # Weights of the corners of the face that a point was on are a witness of their own.
    weights, corners = own.barycentric, own.barycentric_vertices
    for name in ("heat", "flow", "RGB"):
        given = mesh.point_data[name]
        assert fine.point_data[name].dtype == given.dtype
        found = np.einsum("nk,nk...->n...", weights, np.asarray(given, dtype=float)[corners])
        np.testing.assert_allclose(fine.point_data[name], found, atol=1e-6)
    # The nearest point has the greatest weight; halfway between two it is one of them.
    nearest = np.isclose(weights, weights.max(axis=1, keepdims=True), atol=1e-9)
    for name in ("id", "big", "name", "gaps"):
        values, given = np.asarray(fine.point_data[name]), np.asarray(mesh.point_data[name])
        assert values.dtype == given.dtype
        is_one = values[:, None] == given[corners]
        if name == "gaps":
            is_one |= np.isnan(values)[:, None] & np.isnan(given[corners])
        assert (is_one & nearest).any(axis=1).all()
    for name in ("part", "stress", "on", "heat", "hole", "label"):
        given = np.asarray(mesh.cell_data[name])
        assert fine.cell_data[name].dtype == given.dtype
        np.testing.assert_array_equal(fine.cell_data[name], given[own.parent_face])
    np.testing.assert_array_equal(fine.cell_data["parent_face"], own.parent_face)
    # Again, from what it gave.
    again = fine.limitmesh.refine(triangles=3000)
    assert again.n_cells <= 3000 and again.point_data["id"].dtype == np.int16


def test_pyvista_faces_stand_after_points_and_lines():
    pyvista = accessors()
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    mesh = pyvista.PolyData(points, verts=[1, 0], lines=[2, 0, 1], faces=[4, 0, 1, 2, 3])
    mesh.cell_data["part"] = [7, 8, 9]
    fine = mesh.limitmesh.refine("1%", boundary="fixed")
    assert set(fine.cell_data["part"]) == {9} and fine.active_texture_coordinates is None
    plane = pyvista.Plane(i_resolution=4, j_resolution=4)
    assert plane.limitmesh.refine("1%", flat_regions=False).active_texture_coordinates.shape[1] == 2
    strips = pyvista.Sphere().strip()
    assert strips.n_strips and strips.limitmesh.refine("1%").n_open_edges == 0


def test_pyvista_measures_and_projects():
    pyvista = accessors()
    mesh = pyvista.Icosahedron()
    fine = mesh.limitmesh.refine("0.1%")
    found = fine.limitmesh.measure(limit_of=mesh, certified=True)
    assert found.certified and found.upper <= 0.001 * mesh.length
    assert mesh.limitmesh.measure(fine).lower > 0.001 * mesh.length
    # Along its own normals the points of a surface are as far away as they were moved.
    moved = fine.copy()
    moved.points = fine.points + 0.01 * fine.point_data["Normals"]
    back = mesh.limitmesh.project(moved)
    assert back.n_cells == moved.n_cells and "Normals" in back.point_data and back.active_scalars_name == "distance"
    np.testing.assert_allclose(back.point_data["signed_distance"], 0.01, atol=1e-5)
    np.testing.assert_allclose(back.points, fine.points, atol=1e-4)
    assert mesh.limitmesh.project([[2.0, 0, 0]]).n_points == 1


def test_pyvista_data_that_are_no_surface():
    pyvista = accessors()
    volume = pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid()
    for call in (lambda own: own.refine("1%"), lambda own: own.measure(pyvista.Sphere()), lambda own: own.project([[0, 0, 0]])):
        with pytest.raises(limitmesh.MeshError, match=r"UnstructuredGrid is no surface.*extract_surface\(\)"):
            call(volume.limitmesh)
    with pytest.raises(limitmesh.MeshError, match="no faces"):
        pyvista.PolyData([[0.0, 0, 0]]).limitmesh.refine("1%")
    fine = volume.extract_surface(algorithm=None).limitmesh.refine("1%", crease_angle=30)
    assert fine.n_open_edges == 0 and "vtkOriginalCellIds" in fine.cell_data


def test_trimesh_in_one_call(octahedron):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = octahedron
    mesh = trimesh.Trimesh(vertices, faces, process=False, vertex_attributes={"heat": vertices[:, 2]}, metadata={"name": "eight"})
    mesh.visual = trimesh.visual.TextureVisuals(uv=vertices[:, :2], material=trimesh.visual.material.SimpleMaterial(name="blue"))
    fine = limitmesh.refine_trimesh(mesh, 0.05)
    own = limitmesh.refine(vertices, faces, tolerance=0.05)
    assert fine.is_watertight and fine.metadata["name"] == "eight" and fine.visual.material.name == "blue"
    np.testing.assert_array_equal(fine.vertices, own.vertices)
    assert fine.visual.uv.shape == (len(own.vertices), 2) and len(fine.vertex_attributes["heat"]) == len(own.vertices)
    part = limitmesh.refine_trimesh(trimesh.creation.cylinder(1.0, 2.0), "0.1%", creases="auto")
    assert part.is_watertight and abs(part.volume / (2 * np.pi) - 1) < 0.01
    # Parts that touch stay two.
    one, other = trimesh.creation.box(), trimesh.creation.box()
    other.apply_translation([1, 0, 0])
    both = limitmesh.refine_trimesh(trimesh.util.concatenate([one, other]), "1%", crease_angle=30)
    assert both.is_watertight and abs(both.volume - 2) < 1e-9
    with pytest.raises(limitmesh.MeshError, match="a trimesh scene"):
        limitmesh.refine_trimesh(trimesh.Scene([mesh]))


def test_meshio_there_and_back(grid):
    meshio = pytest.importorskip("meshio")
    vertices, faces = grid
    mesh = meshio.Mesh(
        vertices,
        [("triangle", faces[:10]), ("line", [[0, 1]]), ("triangle", faces[10:])],
        point_data={"heat": vertices[:, 0], "flow": vertices},
        cell_data={"part": [np.arange(10), np.array([99]), np.arange(10, len(faces))]},
    )
    fine = limitmesh.refine(mesh, tolerance=0.01)
    back = limitmesh.to_meshio(fine)
    assert back.point_data["flow"].shape == back.points.shape
    np.testing.assert_array_equal(back.cell_data["part"][0], fine.parent_face)
    mixed = meshio.Mesh(vertices, [("quad", [[0, 1, 6, 5]]), ("triangle", [[1, 2, 6]])])
    assert limitmesh.refine(mixed, tolerance=0.1).diagnosis.findings["polygons"].count == 1
    with pytest.raises(limitmesh.MeshError, match="tetra"):
        limitmesh.from_meshio(meshio.Mesh(vertices, [("tetra", [[0, 1, 5, 7]])]))
    flat = meshio.Mesh(vertices[:, :2], [("triangle", faces)])
    assert (limitmesh.refine(flat, boundary="fixed", flat_regions=False).vertices[:, 2] == 0.0).all()


def test_open3d(octahedron):
    open3d = pytest.importorskip("open3d")
    vertices, faces = octahedron
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces)
    )
    mesh.vertex_colors = open3d.utility.Vector3dVector(np.abs(vertices))
    mesh.triangle_uvs = open3d.utility.Vector2dVector(vertices[faces].reshape(-1, 3)[:, :2])
    fine = limitmesh.refine(mesh, tolerance=0.05)
    assert set(fine.channels) == {"uv", "colour"}


def test_plots(octahedron):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    axes = limitmesh.refine(*octahedron).plot(backend="matplotlib", show=False)
    assert axes.name == "3d"
    with pytest.raises(limitmesh.OptionError, match="crayons"):
        limitmesh.refine(*octahedron).plot(backend="crayons")


def test_what_trimesh_has_beside_meshes():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene([trimesh.creation.box()])
    with pytest.raises(limitmesh.MeshError, match="a trimesh scene, expected one mesh"):
        limitmesh.refine(scene)
    assert limitmesh.refine(scene.to_mesh(), crease_angle=30).met
    with pytest.raises(limitmesh.MeshError, match="PointCloud has no faces"):
        limitmesh.refine(trimesh.PointCloud([[0, 0, 0], [1, 0, 0], [0, 1, 0]]))
