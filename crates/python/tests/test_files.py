"""Files: what is written is read again, and refined as the program does."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import limitmesh


def textured_glb() -> bytes:
    """Two triangles with texture coordinates and a material."""
    positions = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.3], [0, 1, 0]], dtype="<f4")
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype="<f4")
    indices = np.array([0, 1, 2, 0, 2, 3], dtype="<u2")
    blobs = [positions.tobytes(), uv.tobytes(), indices.tobytes()]
    views, at = [], 0
    for blob in blobs:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(blob)})
        at += len(blob)
    document = {
        "asset": {"version": "2.0", "extras": {"kept": [1, 2, 3]}},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "Only"}],
        "materials": [{"name": "Paint"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "buffers": [{"byteLength": at}],
        "bufferViews": views,
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0.30000001192092896]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(blobs)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def test_a_textured_asset_is_edited(tmp_path):
    source, target = tmp_path / "in.glb", tmp_path / "out.glb"
    source.write_bytes(textured_glb())
    report = limitmesh.refine_file(source, target, tolerance=0.001)
    assert report["meshes"][0]["stop"] == "met" and report["meshes"][0]["error"]["certified"]
    assert report["meshes"][0]["output"]["triangles"] > 2 and isinstance(report["notes"], list)
    data = target.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + size])
    assert document["asset"]["extras"] == {"kept": [1, 2, 3]} and document["materials"][0]["name"] == "Paint"
    assert "TEXCOORD_0" in document["meshes"][0]["primitives"][0]["attributes"]


@pytest.mark.parametrize("extension", ["obj", "ply", "stl", "off", "glb"])
def test_results_are_written_and_read(tmp_path, octahedron, extension):
    vertices, faces = octahedron
    found = limitmesh.refine(vertices, faces, tolerance=0.05, channels={"uv": vertices[:, :2]})
    path = tmp_path / f"fine.{extension}"
    found.save(path)
    again = limitmesh.load(path)
    assert len(again.faces) == len(found.faces)
    exact = extension in ("obj", "ply", "off")
    np.testing.assert_allclose(
        np.asarray(again.vertices)[np.asarray(again.faces)], found.vertices[found.faces], atol=0 if exact else 1e-6
    )
    assert bool(again.channels) == (extension != "stl")


def normals_of_corners(path):
    """The corners of a file's triangles with their normals, by the text of OBJ and by the accessors of glTF."""
    if path.suffix == ".obj":
        rows = {"v": [], "vn": []}
        corners = []
        for word, *values in map(str.split, path.read_text().splitlines()):
            if word in rows:
                rows[word].append([float(x) for x in values])
            elif word == "f":
                corners += [tuple(int(x) - 1 for x in value.split("/")[::2]) for value in values]
        places, normals = np.array(corners).T
        return np.array(rows["v"])[places], np.array(rows["vn"])[normals]
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20 : 20 + size]), data[28 + size :]

    def values(accessor, kind, width):
        accessor = document["accessors"][accessor]
        start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(binary, kind, accessor["count"] * width, start).reshape(-1, width)

    (primitive,) = document["meshes"][0]["primitives"]
    attributes = primitive["attributes"]
    kind = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32}[document["accessors"][primitive["indices"]]["componentType"]]
    rows = values(primitive["indices"], kind, 1)[:, 0]
    return tuple(values(attributes[name], np.float32, 3)[rows].astype(float) for name in ("POSITION", "NORMAL"))


@pytest.mark.parametrize("extension", ["obj", "glb"])
def test_each_side_of_a_sharp_edge_keeps_its_normals(tmp_path, extension):
    turn = np.arange(16) * np.pi / 8
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    vertices = np.vstack([np.c_[rim, np.full(16, z)] for z in (0, 2)])
    sides = [[i, (i + 1) % 16, 16 + (i + 1) % 16] for i in range(16)] + [[i, 16 + (i + 1) % 16, 16 + i] for i in range(16)]
    ends = [[0, i + 1, i] for i in range(1, 15)] + [[16, 16 + i, 17 + i] for i in range(1, 15)]
    found = limitmesh.refine(vertices, sides + ends, creases="auto", channels={"height": vertices[:, 2]})
    path = tmp_path / f"peg.{extension}"
    found.save(path)
    points, normals = normals_of_corners(path)
    assert len(points) == 3 * len(found.faces)
    flat = np.repeat(np.ptp(points.reshape(-1, 3, 3)[:, :, 2], axis=1) == 0, 3)
    # Of a cylinder: along the axis on its ends, straight away from it elsewhere.
    np.testing.assert_allclose(normals[flat], np.c_[np.zeros((flat.sum(), 2)), points[flat, 2] - 1], atol=1e-6)
    np.testing.assert_allclose(normals[~flat, 2], 0, atol=1e-6)
    away = points[~flat, :2] / np.linalg.norm(points[~flat, :2], axis=1, keepdims=True)
    assert (np.sum(away * normals[~flat, :2], axis=1) > np.cos(np.pi / 16)).all()


def test_files_are_refined_as_the_program_does(tmp_path):
    mine, its = tmp_path / "mine.ply", tmp_path / "its.ply"
    report = limitmesh.refine_file("builtin:cup", mine, tolerance="0.2%", crease_angle=40, threads=2)
    command = [sys.executable, "-m", "limitmesh", "refine", "builtin:cup", "-o", str(its), "--tolerance", "0.2%"]
    done = subprocess.run([*command, "--crease-angle", "40"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert mine.read_bytes() == its.read_bytes()
    assert any("triangles" in line for line in report["notes"])
    arrays = limitmesh.refine("builtin:cup", tolerance="0.2%", crease_angle=40)
    np.testing.assert_array_equal(arrays.vertices, limitmesh.load(mine).vertices)


def test_a_proof_is_confirmed_by_the_checker_in_python(tmp_path):
    check = Path(__file__).parents[2] / "check/tests/check.py"
    result, proof = tmp_path / "a.ply", tmp_path / "a.proof"
    report = limitmesh.refine_file("builtin:tetrahedron", result, tolerance="1%", proof=proof)
    assert any("proves" in note for note in report["notes"])
    run = lambda *more: subprocess.run([sys.executable, check, "-", result, proof, *more], capture_output=True, text=True)
    assert run().stdout.startswith("confirmed")
    below = run("--at", repr(0.99 * report["error"]["lower"]))
    assert below.returncode == 1 and "refused" in below.stdout
    with pytest.raises(limitmesh.OptionError, match="--optimize"):
        limitmesh.refine_file("builtin:tetrahedron", result, optimize=True, proof=proof)


def test_the_program_is_there():
    done = subprocess.run([sys.executable, "-m", "limitmesh", "--version"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and limitmesh.__version__ in done.stdout
    done = subprocess.run([sys.executable, "-m", "limitmesh", "refine"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "INPUT" in done.stderr


def test_what_cannot_be_read_or_written(tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nv 1 0\n")
    with pytest.raises(limitmesh.ReadError, match="line 2"):
        limitmesh.load(broken)
    with pytest.raises(limitmesh.ReadError, match="line 2"):
        limitmesh.refine_file(broken, tmp_path / "out.ply")
    with pytest.raises(limitmesh.OptionError, match="no-such-format"):
        limitmesh.refine_file("builtin:cup", tmp_path / "out.no-such-format")
    with pytest.raises(limitmesh.Error):
        limitmesh.refine_file("builtin:cup", tmp_path / "no-folder" / "out.ply")
    with pytest.raises(limitmesh.OptionError, match="uv"):
        limitmesh.refine_file("builtin:cup", tmp_path / "out.ply", uv="--help")
    with pytest.raises(limitmesh.OptionError):
        limitmesh.refine_file("-", tmp_path / "out.ply")
    with pytest.raises(limitmesh.ReadError, match="no-folder"):
        limitmesh.save(tmp_path / "no-folder" / "out.ply", "builtin:cube")
    assert sorted(os.listdir(tmp_path)) == ["broken.obj"]


def test_stopping_short_of_a_file(tmp_path):
    options = {"tolerance": "1e-6%", "max_triangles": 2000}
    with pytest.warns(limitmesh.StoppedShort):
        report = limitmesh.refine_file("builtin:cup", tmp_path / "a.ply", **options)
    assert report["stop"] == "triangle-cap" and (tmp_path / "a.ply").exists()
    with pytest.raises(limitmesh.ToleranceNotMet) as caught:
        limitmesh.refine_file("builtin:cup", tmp_path / "b.ply", strict=True, **options)
    assert caught.value.result["stop"] == "triangle-cap"


def test_progress_of_files_can_stop_them(tmp_path):
    def progress(at):
        raise KeyError("enough")

    target = tmp_path / "big.ply"
    with pytest.raises(KeyError, match="enough"):
        limitmesh.refine_file("builtin:bunny", target, tolerance="1e-7%", max_memory="4GB", progress=progress)
    assert not target.exists()


def test_models_can_be_loaded():
    for name in limitmesh.models():
        mesh = limitmesh.load(f"builtin:{name}")
        assert np.asarray(mesh.vertices).shape[1] == 3 and len(mesh.faces) > 0


@pytest.mark.skipif("LIMITMESH_MODELS" not in os.environ, reason="skipped: LIMITMESH_MODELS is not set")
def test_real_meshes_are_read_and_refined():
    folder = Path(os.environ["LIMITMESH_MODELS"])
    for name in ("duck.glb", "teapot.obj", "bunny_1k.off", "featuretype.stl", "sphere_320.ply"):
        found = limitmesh.refine(folder / name, tolerance="1%")
        assert found.met and found.error.upper <= 0.01 * limitmesh.info(folder / name)["bounding_box"]["diagonal"]


def test_the_program_does_batches_with_processes_of_its_own(tmp_path):
    jobs = [{"input": f"builtin:{name}", "output": str(tmp_path / f"{name}.ply"), "tolerance": "1%"} for name in ("cube", "cup")]
    (tmp_path / "jobs.jsonl").write_text("\n".join(map(json.dumps, jobs)))
    command = [sys.executable, "-m", "limitmesh", "batch", str(tmp_path / "jobs.jsonl"), "-o", str(tmp_path / "results.jsonl")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    results = [json.loads(line) for line in (tmp_path / "results.jsonl").read_text().splitlines()]
    for job, result in zip(jobs, results, strict=True):
        assert result["status"] == "done"
        written = result["report"]["output"]
        assert len(limitmesh.load(job["output"]).faces) == written["triangles"] - written["quads"]
