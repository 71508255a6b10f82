"""Animations and replays, beside points of each frame's own limit surface and its measured distance."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import limitmesh


def bent(vertices: np.ndarray) -> list[np.ndarray]:
    """Four frames: at rest, stretched, bent, and with one vertex pulled out."""
    pulled = vertices.copy()
    pulled[0] *= 2.5
    return [
        vertices,
        vertices * [1.0, 1.0, 2.0],
        vertices + 0.4 * np.stack([vertices[:, 2] ** 2, 0 * vertices[:, 0], vertices[:, 0] * vertices[:, 1]], axis=1),
        pulled,
    ]


def places(refined: limitmesh.Refined, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the vertices are on the control faces, in the order of their corners."""
    own = faces[refined.vertex_face]
    same = own[:, :, None] == refined.barycentric_vertices[:, None]
    return refined.vertex_face, (same * refined.barycentric[:, None]).sum(axis=2)


def test_replays_and_refined_frames_pickle(octahedron):
    vertices, faces = octahedron
    moving = limitmesh.replay(vertices, faces, tolerance=0.01)
    frames = limitmesh.refine_frames(bent(vertices), faces, tolerance=0.05)
    for replay in (moving, frames.replay):
        again = pickle.loads(pickle.dumps(replay))
        assert again.faces.tobytes() == replay.faces.tobytes() and repr(again) == repr(replay)
        for positions in bent(vertices):
            for own, expected in zip(again(positions), replay(positions)):
                assert own.tobytes() == expected.tobytes()
        # And once more, from one that was prepared again.
        assert pickle.loads(pickle.dumps(again))(vertices)[0].tobytes() == replay(vertices)[0].tobytes()
    again = pickle.loads(pickle.dumps(frames))
    assert again.vertices.tobytes() == frames.vertices.tobytes() and again.errors == frames.errors
    # With what was asked for before it was pickled.
    assert pickle.loads(pickle.dumps(frames)).normals.tobytes() == frames.normals.tobytes()


def test_a_replay_is_on_each_frames_own_surface(octahedron):
    vertices, faces = octahedron
    moving = limitmesh.replay(vertices, faces, tolerance=0.01)
    assert moving.refined.met and moving.refined.error.upper <= 0.01 and moving.faces is moving.refined.faces
    at, barycentric = places(moving.refined, faces)
    for frame in bent(vertices):
        positions, normals = moving(frame)
        expected = limitmesh.limit_surface(frame, faces, at=at, barycentric=barycentric)
        np.testing.assert_allclose(positions, expected.positions, atol=1e-12)
        np.testing.assert_allclose(normals, expected.normals, atol=1e-9)
        again, _ = moving(frame.tolist(), threads=1)
        assert again.tobytes() == positions.tobytes()
    np.testing.assert_allclose(moving(vertices)[0], moving.refined.vertices, atol=1e-14)


def test_frames_share_triangles_and_each_is_within_the_tolerance(octahedron):
    vertices, faces = octahedron
    frames = bent(vertices)
    found = limitmesh.refine_frames(frames, faces, tolerance=0.02)
    assert found.refined.met and len(found.errors) == 4
    assert found.vertices.shape == found.normals.shape == (4, len(found.refined.vertices), 3)
    at, barycentric = places(found.refined, faces)
    for frame, error, positions, normals in zip(frames, found.errors, found.vertices, found.normals):
        assert error.certified and error.lower <= error.upper <= 0.02
        distance = limitmesh.measure((positions, found.faces), limit_of=(frame, faces), certified=True)
        assert distance.lower <= error.upper and error.lower <= distance.upper
        expected = limitmesh.limit_surface(frame, faces, at=at, barycentric=barycentric)
        np.testing.assert_allclose(positions, expected.positions, atol=1e-12)
        np.testing.assert_allclose(normals, expected.normals, atol=1e-9)
    alone = [len(limitmesh.refine(frame, faces, tolerance=0.02).faces) for frame in frames]
    assert max(alone) * 0.8 <= len(found.faces) <= sum(alone)
    stacked = limitmesh.refine_frames(np.stack(frames), faces, tolerance=0.02, threads=1)
    assert stacked.vertices.tobytes() == found.vertices.tobytes()
    further, _ = found.replay(1.5 * vertices)
    np.testing.assert_allclose(further, 1.5 * found.vertices[0], atol=1e-12)


@pytest.mark.parametrize("last", [[[1, 3, 7, 5]], [[1, 3, 7], [1, 7, 5]]], ids=["quads", "mixed"])
def test_frames_of_a_cage_are_near_its_own_surface(last):
    vertices = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], *last]
    frames = bent(vertices)
    found = limitmesh.refine_frames(frames, faces, tolerance=0.02)
    for frame, error, positions in zip(frames, found.errors, found.vertices):
        assert error.certified and error.upper <= 0.02
        distance = limitmesh.measure((positions, found.faces), limit_of=(frame, faces), certified=True)
        assert distance.lower <= error.upper and error.lower <= distance.upper


def test_flat_sheets_bend(grid):
    vertices, faces = grid
    flat = vertices * [1, 1, 0]
    found = limitmesh.refine_frames([flat, vertices], faces, tolerance=0.005, boundary="corners")
    assert [error.upper <= 0.005 for error in found.errors] == [True, True]
    assert (found.vertices[0][:, 2] == 0).all() and np.abs(found.vertices[1][:, 2]).max() > 0.1


def test_polygons_channels_and_unused_vertices():
    vertices = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)] + [[9, 9, 9]], float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    height = {"height": limitmesh.Channel(vertices[:, 2], interpolation="smooth-none")}
    found = limitmesh.refine_frames([vertices, 2 * vertices], quads, tolerance=0.05, channels=height)
    np.testing.assert_allclose(found.vertices[1], 2 * found.vertices[0], atol=1e-12)
    np.testing.assert_allclose(found.refined.at_vertices("height")[:, 0], found.vertices[0][:, 2], atol=1e-12)
    assert found.refined.parent_face.max() == 5


def test_what_is_welded_stays_together(octahedron):
    vertices, faces = octahedron
    twice = np.concatenate([vertices, vertices[:1]])
    split = faces.copy()
    split[0][split[0] == 0] = 6
    moving = limitmesh.replay(twice, split, tolerance=0.1)
    np.testing.assert_allclose(moving(2 * twice)[0], 2 * moving.refined.vertices, atol=1e-12)
    apart = twice.copy()
    apart[6] += 0.1
    with pytest.raises(limitmesh.MeshError, match=r"positions\[0\] and positions\[6\] are apart"):
        moving(apart)
    with pytest.raises(limitmesh.MeshError, match=r"frames\[1\]\[0\] and frames\[1\]\[6\] are apart"):
        limitmesh.refine_frames([twice, apart], split, tolerance=0.1)


def test_sheets_that_are_cut_apart_within_edges_are_refused():
    # Three faces at one edge, on sheets that meet at both of its ends elsewhere, too.
    vertices = np.array([[2, -3, -2], [-1, 2, 2], [-2, 2, 0], [-2, -2, 3], [3, -2, 3]], float)
    quads = [[0, 2, 3, 3], [3, 0, 3, 4], [4, 4, 3, 2], [1, 2, 3, 1], [4, 2, 1, 1], [1, 1, 4, 3]]
    assert any("cut into sheets" in line for line in limitmesh.repair(vertices, quads).diagnosis.repairs)
    with pytest.raises(limitmesh.MeshError, match="other positions tell nothing"):
        limitmesh.replay(vertices, quads, tolerance="5%", scheme="loop")
    with pytest.raises(limitmesh.MeshError, match="other positions tell nothing"):
        limitmesh.refine_frames([vertices, 2 * vertices], quads, tolerance="5%", scheme="loop")


def test_goals_by_angle_and_caps(octahedron):
    vertices, faces = octahedron
    found = limitmesh.refine_frames(bent(vertices), faces, angle=20)
    for frame in range(4):
        corners = found.vertices[frame][found.faces]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
        cosines = np.einsum("ij,ikj->ik", flat, found.normals[frame][found.faces])
        assert np.degrees(np.arccos(cosines.min())) <= 20 + 1e-9
    with pytest.raises(limitmesh.OptionError, match="frame 0 would take more than 20 triangles"):
        limitmesh.refine_frames([vertices, vertices], faces, tolerance=0.01, max_triangles=20)
    with pytest.warns(limitmesh.StoppedShort, match="max_levels"):
        limitmesh.refine_frames([vertices], faces, tolerance=1e-4, max_levels=1)
    with pytest.raises(limitmesh.ToleranceNotMet, match="max_triangles"):
        limitmesh.replay(vertices, faces, tolerance=1e-4, max_triangles=100, strict=True)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda frames: frames[2].__setitem__((3, 1), np.nan), r"frames\[2\]\[3\] is"),
        (lambda frames: frames.__setitem__(1, frames[1][1:]), r"frames\[1\] has 5 rows, expected 6"),
        (lambda frames: frames.__setitem__(1, frames[1][:, :2]), r"frames\[1\] have the shape \(6, 2\)"),
        (lambda frames: frames.__setitem__(0, [["a", "b", "c"]]), r"frames\[0\]\[0\] is"),
        (lambda frames: frames.clear(), "there are no frames"),
    ],
)
def test_frames_that_are_none(octahedron, change, words):
    frames = bent(octahedron[0].copy())
    change(frames)
    with pytest.raises(limitmesh.MeshError, match=words):
        limitmesh.refine_frames(frames, octahedron[1], tolerance=0.1)


def test_arguments_that_are_none(octahedron):
    vertices, faces = octahedron
    with pytest.raises(limitmesh.MeshError, match="frames is int"):
        limitmesh.refine_frames(5, faces)
    with pytest.raises(limitmesh.MeshError, match=r"faces\[0\] names vertex 7"):
        limitmesh.refine_frames([vertices], [[0, 2, 7]])
    for options, words in (({"tolerance": 0}, "tolerance is 0"), ({"scheme": "butterfly"}, "butterfly"), ({"scheme": "sqrt3"}, "sqrt3")):
        with pytest.raises(limitmesh.OptionError, match=words):
            limitmesh.refine_frames([vertices], faces, **options)
        with pytest.raises(limitmesh.OptionError, match=words):
            limitmesh.replay(vertices, faces, **options)
    moving = limitmesh.replay(vertices, faces, tolerance=0.1)
    for positions, words in (
        (vertices[1:], "positions has 5 rows, expected 6"),
        (np.full((6, 3), np.nan), r"positions\[0\] is"),
        (vertices[:, :2], "positions have the shape"),
        ("many", "positions"),
    ):
        with pytest.raises(limitmesh.MeshError, match=words):
            moving(positions)
