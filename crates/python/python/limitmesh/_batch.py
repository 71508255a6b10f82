"""Many meshes: `limitmesh batch` of the program, with files at addresses and with tables."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _limitmesh, _options, _tables
from ._again import again
from ._files import _name
from ._limitmesh import OptionError
from ._options import ProgressCallback
from ._remote import RemoteFiles, is_address


@dataclass(frozen=True)
class Batch:
    """How many jobs of a batch had which result.

    Attributes
    ----------
    jobs
        All of them, or those of the shard.
    kept
        Results that were there from before.
    done, stopped_short, failed
        Jobs that met all goals, that a cap ended before that, and that have no result.
    """

    jobs: int
    kept: int
    done: int
    stopped_short: int
    failed: int


def batch(
    jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    results: str | os.PathLike[str],
    *,
    shard: str | tuple[int, int] | None = None,
    resume: bool = False,
    processes: int | None = None,
    threads: int = 1,
    time_limit: float | None = None,
    memory_limit: float | str | None = None,
    progress: ProgressCallback | None = None,
) -> Batch:
    """Refines many meshes as the program ``limitmesh batch`` does, each in a process of its own; a job that fails does not stop others.

    Jobs, results, inputs and outputs may be at addresses of fsspec, such as ``s3://bucket/a.stl`` (``limitmesh[fsspec]``, and the
    package of the scheme, such as s3fs). They are copied to a temporary folder and back. With an output comes what it names, such as
    the buffers of a ``.gltf``; with an input what a ``.gltf`` names.

    Parameters
    ----------
    jobs
        A file of JSON lines or a table of Parquet (``limitmesh[parquet]``), or the jobs: an ``input``, an ``output``, and options of the
        program's ``refine`` by their names.
    results
        The file for a line for each job, or a table if its name ends with .parquet. At an address, and as a table, it is written when the batch
        ends.
    shard
        A part of the jobs for an array of machines, ``(i, n)`` or "i/n" with i from 0 to n - 1. Each has results of its own.
    resume
        Goes on with the results that are there, and does what is missing or failed.
    processes, threads
        How many at once, and threads of each. Default: as many processes as there are processors.
    time_limit, memory_limit
        Seconds and bytes (such as "2GB") that a job may take.
    progress
        Called with a `Progress` that counts jobs.

    Raises
    ------
    OptionError
        An option is out of range.
    ReadError
        The jobs cannot be read, or the results cannot be written.

    Examples
    --------
    >>> import limitmesh, os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     jobs = [{"input": "builtin:cup", "output": os.path.join(folder, "cup.ply"), "tolerance": "1%"}]
    ...     limitmesh.batch(jobs, os.path.join(folder, "results.jsonl"))
    Batch(jobs=1, kept=0, done=1, stopped_short=0, failed=0)
    """
    files = RemoteFiles()
    target = _name(results, "results")
    with tempfile.TemporaryDirectory(prefix="limitmesh-") as folder:
        lines = _lines(jobs, Path(folder), files)
        is_copied = is_address(target) or _tables.is_table(target)
        here = os.path.join(folder, "results.jsonl") if is_copied else target
        if is_copied:
            _fetch_results(target, here, resume, Path(folder), files)
        arguments = [lines, f"--output={here}", f"--threads={_options.threads_of(threads)}", *(["--resume"] if resume else [])]
        for name, value in (
            ("shard", shard if shard is None or isinstance(shard, str) else "/".join(map(str, shard))),
            ("jobs", None if processes is None else _options.whole(processes, "processes", 1)),
            ("time-limit", time_limit),
            ("memory-limit", memory_limit),
        ):
            if value is not None:
                arguments.append(f"--{name}={value}")
        try:
            counts = _limitmesh.batch(arguments, again(), files, _options.callback_of(progress))
        finally:
            # Also what an interrupt left: it can be resumed.
            if is_copied and os.path.exists(here):
                _store_results(here, target, Path(folder), files)
    return Batch(*counts)


def _lines(jobs: Any, folder: Path, files: RemoteFiles) -> str:
    """The file of the jobs' lines, on this machine."""
    lines = folder / "jobs.jsonl"
    if not isinstance(jobs, (str, os.PathLike)):
        with open(lines, "w", encoding="utf-8") as file:
            for job in jobs:
                if not isinstance(job, Mapping):
                    raise OptionError(f"jobs has {job!r}, expected a dict with an input, an output, and options")
                file.write(json.dumps(dict(job), default=_plain) + "\n")
        return str(lines)
    name = _name(jobs, "jobs")
    if is_address(name):
        name = files.fetch_to(name, folder / ("jobs.parquet" if _tables.is_table(name) else "jobs.jsonl"))
    if _tables.is_table(name):
        _tables.jobs_of(name, lines)
        return str(lines)
    return name


def _plain(value: Any) -> Any:
    """A number of NumPy, or a path, as JSON has it."""
    return value.item() if hasattr(value, "item") else os.fspath(value)


def _fetch_results(target: str, here: str, resume: bool, folder: Path, files: RemoteFiles) -> None:
    """Earlier results as lines."""
    is_there = files.size(target) is not None if is_address(target) else os.path.exists(target)
    if is_there and not resume:
        raise _limitmesh.ReadError(f"{target} is there already; resume=True goes on with it")
    if not is_there:
        # What cannot be written is found before any work.
        Path(here).touch()
        _store_results(here, target, folder, files)
    elif _tables.is_table(target):
        table = files.fetch_to(target, folder / "earlier.parquet") if is_address(target) else target
        _tables.lines_of(table, here)
    else:
        files.fetch_to(target, Path(here))


def _store_results(here: str, target: str, folder: Path, files: RemoteFiles) -> None:
    """Lines of results as the file that was asked for."""
    try:
        made = Path(here)
        if _tables.is_table(target):
            made = folder / "results.parquet" if is_address(target) else Path(f"{target}.unfinished")
            _tables.results_of(here, made)
        if is_address(target):
            files.store(made, target)
        else:
            os.replace(made, target)
    except OSError as why:
        raise _limitmesh.ReadError(f"{target} cannot be written: {why}") from why
