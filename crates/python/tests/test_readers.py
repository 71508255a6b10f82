"""Files that other libraries wrote, refined, and read by them again: textures and colours are where they were."""

from __future__ import annotations

import numpy as np
import pytest

import limitmesh

SIDE = 6


def bowl() -> tuple[np.ndarray, np.ndarray]:
    """A grid over the square between -1 and 1, bent up at its sides."""
    x, y = np.meshgrid(np.linspace(-1, 1, SIDE), np.linspace(-1, 1, SIDE), indexing="xy")
    vertices = np.column_stack([x.ravel(), y.ravel(), 0.4 * (x * x + y * y).ravel()])
    first = np.array([v for v in range(SIDE * (SIDE - 1)) if (v + 1) % SIDE])
    lower = np.column_stack([first, first + 1, first + SIDE + 1])
    upper = np.column_stack([first, first + SIDE + 1, first + SIDE])
    return vertices, np.concatenate([lower, upper])


def texture_of(positions: np.ndarray) -> np.ndarray:
    """Texture coordinates as the bowl is seen from above: an affine map, which refinement by the same rules keeps."""
    return 0.5 + 0.25 * positions[:, :2] @ np.array([[1.0, 0.5], [-0.5, 1.0]])


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb"])
def test_trimesh_reads_the_texture_of_what_it_wrote(tmp_path, suffix):
    trimesh = pytest.importorskip("trimesh")
    image = pytest.importorskip("PIL.Image")
    vertices, faces = bowl()
    material = trimesh.visual.texture.SimpleMaterial(image=image.new("RGB", (4, 4), (255, 0, 0)))
    visual = trimesh.visual.TextureVisuals(uv=texture_of(vertices), material=material)
    source, target = tmp_path / f"in.{suffix}", tmp_path / f"out.{suffix}"
    trimesh.Trimesh(vertices, faces, process=False, visual=visual).export(source)
    report = limitmesh.refine_file(source, target, tolerance="0.1%", uv="none")
    mesh = trimesh.load(target, force="mesh", process=False)
    # An asset's report has a part for each of its meshes.
    written = report.get("meshes", [report])[0]["output"]
    assert len(mesh.faces) == written["triangles"] > 4 * len(faces)
    assert mesh.visual.kind == "texture"
    np.testing.assert_allclose(mesh.visual.uv, texture_of(mesh.vertices), atol=1e-6)
    if suffix != "ply":
        picture = mesh.visual.material
        picture = getattr(picture, "baseColorTexture", None) or picture.image
        assert picture.size == (4, 4)


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb"])
def test_trimesh_reads_the_colours_of_what_it_wrote(tmp_path, suffix):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = bowl()
    # Red grows along x, green falls, blue is the same everywhere.
    red = np.round(127.5 * (1 + vertices[:, 0]))
    colours = np.column_stack([red, 255 - red, np.full(len(red), 51), np.full(len(red), 255)]).astype(np.uint8)
    source, target = tmp_path / f"in.{suffix}", tmp_path / f"out.{suffix}"
    trimesh.Trimesh(vertices, faces, process=False, vertex_colors=colours).export(source)
    limitmesh.refine_file(source, target, tolerance="0.1%")
    mesh = trimesh.load(target, force="mesh", process=False)
    found = mesh.visual.vertex_colors.astype(float)
    assert len(mesh.faces) > 4 * len(faces) and mesh.visual.kind == "vertex"
    assert (found[:, 2:] == [51, 255]).all()
    # Bytes are rounded once on the way in and once on the way out, and the rim moves by less than a tenth.
    assert np.abs(found[:, 0] + found[:, 1] - 255).max() <= 2
    assert np.abs(found[:, 0] - 127.5 * (1 + mesh.vertices[:, 0])).max() < 14


def test_meshio_reads_textures_and_numbers_of_ply_files(tmp_path):
    meshio = pytest.importorskip("meshio")
    vertices, faces = bowl()
    source, target = tmp_path / "in.ply", tmp_path / "out.ply"
    texture = texture_of(vertices)
    data = {"s": texture[:, 0], "t": texture[:, 1], "height": vertices[:, 2], "part": np.full(len(vertices), 7, np.int32)}
    meshio.Mesh(vertices, [("triangle", faces)], point_data=data).write(source)
    limitmesh.refine_file(source, target, tolerance="0.1%", uv="none")
    mesh = meshio.read(target)
    found = np.column_stack([mesh.point_data["s"], mesh.point_data["t"]])
    np.testing.assert_allclose(found, texture_of(mesh.points), atol=1e-9)
    assert mesh.point_data["part"].dtype == np.int32 and (mesh.point_data["part"] == 7).all()
    assert 0.0 <= mesh.point_data["height"].min() and mesh.point_data["height"].max() <= vertices[:, 2].max()
