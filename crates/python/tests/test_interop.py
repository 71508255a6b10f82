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
        "print([name for name in ('trimesh', 'pyvista', 'meshio', 'open3d', 'matplotlib') if name in sys.modules])"
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
    with pytest.raises(limitmesh.MeshError, match="a trimesh scene of 1 meshes, expected one mesh"):
        limitmesh.refine(scene)
    assert limitmesh.refine(scene.to_mesh(), crease_angle=30).met
    with pytest.raises(limitmesh.MeshError, match="PointCloud has no faces"):
        limitmesh.refine(trimesh.PointCloud([[0, 0, 0], [1, 0, 0], [0, 1, 0]]))
