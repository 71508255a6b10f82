"""Many meshes: jobs as lines and tables, files here and at addresses."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import limitmesh

TETRAHEDRON = "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"


def lines_of(path) -> list[dict]:
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def jobs_in(folder, count: int) -> list[dict]:
    (folder / "in.obj").write_text(TETRAHEDRON)
    return [{"input": folder / "in.obj", "output": folder / f"out/{i}.ply", "tolerance": f"{10 - i}%"} for i in range(count)]


def program(*arguments) -> None:
    done = subprocess.run([sys.executable, "-m", "limitmesh", *map(str, arguments)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


@pytest.fixture
def memory():
    """A file system of fsspec, in the memory of this process."""
    fsspec = pytest.importorskip("fsspec")
    files = fsspec.filesystem("memory")
    files.store.clear()
    yield files
    files.store.clear()


def test_a_batch_gives_the_bytes_of_the_program(tmp_path):
    jobs = jobs_in(tmp_path, 3)
    lines = tmp_path / "jobs.jsonl"
    lines.write_text("".join(json.dumps({k: str(v) for k, v in job.items()}) + "\n" for job in jobs))
    program("batch", lines, "-o", tmp_path / "program.jsonl")
    meshes = [job["output"].read_bytes() for job in jobs]
    for source, name in ((lines, "lines.jsonl"), (jobs, "list.jsonl")):
        for job in jobs:
            job["output"].unlink()
        found = limitmesh.batch(source, tmp_path / name)
        assert found == limitmesh.Batch(jobs=3, kept=0, done=3, stopped_short=0, failed=0)
        assert (tmp_path / name).read_bytes() == (tmp_path / "program.jsonl").read_bytes()
        assert [job["output"].read_bytes() for job in jobs] == meshes
    with pytest.raises(limitmesh.ReadError, match="--resume"):
        limitmesh.batch(lines, tmp_path / "lines.jsonl")
    assert limitmesh.batch(lines, tmp_path / "lines.jsonl", resume=True).kept == 3


def test_progress_counts_jobs(tmp_path):
    # Work that takes so long that it must be told of.
    jobs = [{"input": "builtin:bunny", "output": tmp_path / f"{i}.ply", "tolerance": "0.01%"} for i in range(2)]
    told = []
    assert limitmesh.batch(jobs, tmp_path / "results.jsonl", progress=told.append, processes=1).done == 2
    assert told and all(at.total == 2 for at in told)
    assert sorted(told, key=lambda at: at.done) == told


def test_a_job_that_fails_does_not_stop_others(tmp_path):
    good, bad, odd = jobs_in(tmp_path, 3)
    bad["input"], odd["tolerance"] = tmp_path / "none.obj", "-1"
    short = {"input": "builtin:cube", "output": tmp_path / "short.ply", "tolerance": 1e-9, "max_triangles": 500}
    found = limitmesh.batch([bad, odd, {"input": 3}, short, good], tmp_path / "results.jsonl")
    assert found == limitmesh.Batch(jobs=5, kept=0, done=1, stopped_short=1, failed=3)
    told = lines_of(tmp_path / "results.jsonl")
    assert [line["line"] for line in told] == [1, 2, 3, 4, 5]
    assert [line["error"]["kind"] for line in told[:3]] == ["file", "options", "line"]
    with pytest.raises(limitmesh.OptionError, match="expected a dict"):
        limitmesh.batch(["a.obj"], tmp_path / "other.jsonl")
    for options in ({"shard": (8, 8)}, {"shard": "1"}, {"time_limit": 0}, {"memory_limit": "some"}, {"processes": 0}, {"threads": 0}):
        with pytest.raises(limitmesh.OptionError, match=next(iter(options)).replace("_", "-")):
            limitmesh.batch([good], tmp_path / "other.jsonl", **options)
    with pytest.raises(limitmesh.ReadError, match="none.jsonl"):
        limitmesh.batch(tmp_path / "none.jsonl", tmp_path / "other.jsonl")
    assert not (tmp_path / "other.jsonl").exists()


def test_shards_are_the_whole(tmp_path):
    jobs = jobs_in(tmp_path, 5)
    limitmesh.batch(jobs, tmp_path / "whole.jsonl")
    parts = []
    for i in range(3):
        assert limitmesh.batch(jobs, tmp_path / f"{i}.jsonl", shard=(i, 3) if i else "0/3").jobs == (2, 2, 1)[i]
        parts += (tmp_path / f"{i}.jsonl").read_text().splitlines()
    assert sorted(parts, key=lambda line: json.loads(line)["line"]) == (tmp_path / "whole.jsonl").read_text().splitlines()


def test_files_that_only_one_thread_may_read_are_read_whole(tmp_path, memory):
    # Of a file in memory there is one cursor, which all that read it share.
    mesh = TETRAHEDRON + "# a long file\n" * 100_000
    memory.pipe("/in/a.obj", mesh.encode())
    jobs = [{"input": "memory://in/a.obj", "output": f"memory://out/{i}.ply", "tolerance": "10%"} for i in range(24)]
    assert limitmesh.batch(jobs, tmp_path / "results.jsonl", processes=8).done == 24


def test_files_at_addresses(tmp_path, memory):
    jobs = jobs_in(tmp_path, 3)
    limitmesh.batch(jobs, tmp_path / "here.jsonl")
    memory.pipe("/in/a.obj", TETRAHEDRON.encode())
    memory.pipe("/in/bad.obj", b"v 0 0 0\nf 1 2 3\n")
    there = [{**job, "input": "memory://in/a.obj", "output": f"memory://out/deep/{i}.ply"} for i, job in enumerate(jobs)]
    there[0]["picture"] = "memory://pictures/0.png"
    there += [{**there[1], "input": f"memory://in/{name}.obj", "output": f"memory://out/{name}.ply"} for name in ("bad", "none")]
    memory.pipe("/jobs.jsonl", "\n".join(json.dumps(job, default=str) for job in there).encode())
    found = limitmesh.batch("memory://jobs.jsonl", "memory://results/all.jsonl")
    assert found == limitmesh.Batch(jobs=5, kept=0, done=3, stopped_short=0, failed=2)
    told = [json.loads(line) for line in memory.cat("/results/all.jsonl").splitlines()]
    here = lines_of(tmp_path / "here.jsonl")
    for i, (one, other) in enumerate(zip(told, here)):
        assert memory.cat(f"/out/deep/{i}.ply") == jobs[i]["output"].read_bytes()
        assert one["output"] == one["report"]["output"]["path"] == f"memory://out/deep/{i}.ply"
        assert one["report"]["input"]["path"] == "memory://in/a.obj"
        # The key is that of the content; the first has a picture beside.
        assert (one["key"] == other["key"]) == (i > 0)
        assert one["output_bytes"] == other["output_bytes"]
        assert one["report"]["output"]["triangles"] == other["report"]["output"]["triangles"]
    assert memory.cat("/pictures/0.png").startswith(b"\x89PNG")
    for line, name in zip(told[3:], ("bad", "none")):
        assert line["error"]["kind"] == "file" and f"memory://in/{name}.obj" in line["error"]["message"]
    assert "limitmesh-" not in memory.cat("/results/all.jsonl").decode()
    assert sorted(memory.find("/out")) == [f"/out/deep/{i}.ply" for i in range(3)]
    # A place that has folders.
    place = (tmp_path / "elsewhere").as_uri()
    assert limitmesh.batch([{**there[1], "output": f"{place}/deep/0.ply"}], f"{place}/results.jsonl").done == 1
    assert (tmp_path / "elsewhere/deep/0.ply").read_bytes() == jobs[1]["output"].read_bytes()
    # Resumed: what is there is kept, what is not is done again.
    before = memory.cat("/results/all.jsonl")
    with pytest.raises(limitmesh.ReadError, match="resume=True"):
        limitmesh.batch("memory://jobs.jsonl", "memory://results/all.jsonl")
    memory.rm("/out/deep/1.ply")
    found = limitmesh.batch("memory://jobs.jsonl", "memory://results/all.jsonl", resume=True)
    assert (found.kept, found.done, found.failed) == (2, 3, 2)
    assert memory.cat("/results/all.jsonl") == before and memory.exists("/out/deep/1.ply")


def test_documents_at_addresses_come_with_what_they_name(tmp_path, memory):
    limitmesh.save(tmp_path / "cup.gltf", "builtin:cup")
    for name in ("cup.gltf", "cup.bin"):
        memory.put_file(str(tmp_path / name), f"/in/{name}")
    found = limitmesh.batch(
        [{"input": "memory://in/cup.gltf", "output": "memory://out/smooth.gltf", "tolerance": "1%"}], tmp_path / "results.jsonl"
    )
    assert found.done == 1, (tmp_path / "results.jsonl").read_text()
    memory.get_file("/out/smooth.gltf", str(tmp_path / "smooth.gltf"))
    for buffer in json.loads((tmp_path / "smooth.gltf").read_text())["buffers"]:
        memory.get_file(f"/out/{buffer['uri']}", str(tmp_path / buffer["uri"]))
    assert limitmesh.info(tmp_path / "smooth.gltf")["watertight"]


def test_programs_do_not_take_addresses(tmp_path):
    (tmp_path / "jobs.jsonl").write_text('{"input": "s3://bucket/a.obj", "output": "a.ply"}\n')
    command = [sys.executable, "-m", "limitmesh", "batch", str(tmp_path / "jobs.jsonl"), "-o", "-"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and "limitmesh.batch" in json.loads(done.stdout)["error"]["message"]


def test_what_is_not_installed_is_an_error_of_the_job(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    found = limitmesh.batch([{"input": "s3://bucket/a.obj", "output": tmp_path / "a.ply"}], tmp_path / "results.jsonl")
    assert found.failed == 1 and "pip install fsspec" in lines_of(tmp_path / "results.jsonl")[0]["error"]["message"]


@pytest.mark.parametrize("place", ["here", "there"])
def test_tables(tmp_path, request, place):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    jobs = [{name: str(value) for name, value in job.items()} for job in jobs_in(tmp_path, 3)]
    jobs[2] |= {"input": str(tmp_path / "none.obj")}
    jobs[1] |= {"triangles": 50}
    limitmesh.batch(jobs, tmp_path / "lines.jsonl")
    table = tmp_path / "jobs.parquet"
    parquet.write_table(arrow.Table.from_pylist([{"triangles": None, **job} for job in jobs]), table)
    source, target = str(table), str(tmp_path / "results.parquet")
    if place == "there":
        memory = request.getfixturevalue("memory")
        memory.put_file(source, "/jobs.parquet")
        source, target = "memory://jobs.parquet", "memory://results.parquet"
    for resume, kept in ((False, 0), (True, 2)):
        assert limitmesh.batch(source, target, resume=resume) == limitmesh.Batch(3, kept, 2, 0, 1)
        if place == "there":
            memory.get_file("/results.parquet", str(tmp_path / "results.parquet"))
        rows = parquet.read_table(tmp_path / "results.parquet").to_pylist()
        for row, line in zip(rows, lines_of(tmp_path / "lines.jsonl"), strict=True):
            found = {name: json.loads(value) if name in ("error", "report") else value for name, value in row.items() if value is not None}
            assert found == {name: value for name, value in line.items() if value is not None}
    with pytest.raises(limitmesh.ReadError, match="resume=True"):
        limitmesh.batch(source, target)
    with pytest.raises(limitmesh.ReadError, match="cannot be written"):
        limitmesh.batch([{"input": "builtin:cup", "output": tmp_path / "cup.ply"}], tmp_path / "none/results.parquet")
    assert not (tmp_path / "cup.ply").exists()
    (tmp_path / "no.parquet").write_text("no table")
    with pytest.raises(limitmesh.ReadError, match="no.parquet cannot be read"):
        limitmesh.batch(tmp_path / "no.parquet", tmp_path / "other.jsonl")


@pytest.mark.skipif(not os.path.exists("/proc/self/cmdline"), reason="no /proc here")
def test_interrupts_end_a_batch_and_its_processes(tmp_path):
    code = textwrap.dedent(
        """
        import os, signal, sys, threading, time, limitmesh
        signal.signal(signal.SIGINT, signal.default_int_handler)
        folder = sys.argv[1]
        jobs = [{"input": "builtin:cube", "output": f"{folder}/good.ply", "triangles": 100},
                {"input": "builtin:bunny", "output": f"{folder}/long.ply", "tolerance": 1e-12}]
        def interrupt():
            while not os.path.exists(f"{folder}/good.ply"):
                time.sleep(0.01)
            time.sleep(0.5)
            os.kill(os.getpid(), signal.SIGINT)
        threading.Thread(target=interrupt).start()
        try:
            limitmesh.batch(jobs, f"{folder}/results.jsonl", processes=2)
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "interrupted", done.stderr
    commands = [path.read_bytes() for path in Path("/proc").glob("[0-9]*/cmdline") if path.exists()]
    assert not any(str(tmp_path / "long.ply").encode() in command for command in commands)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["good.ply", "results.jsonl"]
    assert [line["line"] for line in lines_of(tmp_path / "results.jsonl")] == [1]
