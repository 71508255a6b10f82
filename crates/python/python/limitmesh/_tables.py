"""Jobs and results of batches as tables of Parquet, which pyarrow reads and writes.

A column of jobs has an option's name; a cell without a value is an option that is not given. Of results ``error`` and ``report`` are
texts of JSON, as their parts differ from job to job.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from itertools import islice
from typing import Any

from ._library import library
from ._limitmesh import ReadError

_NUMBERS = ("line", "output_bytes")
_OBJECTS = ("error", "report")
_COLUMNS = ("line", "key", "input", "output", "status", "why", "output_bytes", "error", "report")
_ROWS = 10_000
"""Written at once."""


def is_table(name: str) -> bool:
    """Whether a file's name is that of a table."""
    return name.lower().endswith(".parquet")


def jobs_of(table: str, lines: str | os.PathLike[str]) -> None:
    """Writes the jobs of a table as lines."""
    with open(lines, "w", encoding="utf-8") as file:
        for row in _rows(table):
            given = {name: value for name, value in row.items() if value is not None}
            try:
                file.write(json.dumps(given) + "\n")
            except TypeError as why:
                raise ReadError(f"{table} has a job with a value that is neither text nor number: {why}") from why


def lines_of(table: str, lines: str | os.PathLike[str]) -> None:
    """Writes the results of a table as lines."""
    with open(lines, "w", encoding="utf-8") as file:
        for row in _rows(table):
            if set(row) != set(_COLUMNS):
                raise ReadError(f"{table} has other columns than results of jobs")
            # A line has what its status calls for; of dry runs the bytes are null.
            absent = [name for name in ("why", *_OBJECTS) if row[name] is None] + (["output_bytes"] if row["error"] is not None else [])
            found = {name: json.loads(row[name]) if name in _OBJECTS else row[name] for name in _COLUMNS if name not in absent}
            file.write(json.dumps(found, separators=(",", ":"), ensure_ascii=False) + "\n")


def results_of(lines: str | os.PathLike[str], table: str | os.PathLike[str]) -> None:
    """Writes lines of results as a table."""
    arrow, parquet = library("pyarrow"), library("pyarrow.parquet")
    types = {name: arrow.int64() if name in _NUMBERS else arrow.string() for name in _COLUMNS}
    schema = arrow.schema(list(types.items()))
    with parquet.ParquetWriter(os.fspath(table), schema) as writer, open(lines, encoding="utf-8") as file:
        while rows := [_row(line) for line in islice(file, _ROWS)]:
            writer.write_table(arrow.Table.from_pylist(rows, schema))


def _row(line: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(line)
    return {**found, **{name: json.dumps(found[name]) for name in _OBJECTS if name in found}}


def _rows(table: str) -> Iterator[dict[str, Any]]:
    try:
        for part in library("pyarrow.parquet").ParquetFile(table).iter_batches():
            yield from part.to_pylist()
    except (OSError, library("pyarrow").ArrowInvalid) as why:
        raise ReadError(f"{table} cannot be read: {why}") from why
