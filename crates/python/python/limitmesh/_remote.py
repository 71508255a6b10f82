"""Files at addresses such as ``s3://bucket/a.stl``, which fsspec copies."""

from __future__ import annotations

import json
import os
import re
import threading
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from ._library import library
from ._limitmesh import ReadError


def is_address(name: str) -> bool:
    """Whether a name has a scheme of at least two letters: ``C://`` is a drive."""
    return re.match(r"[A-Za-z0-9+.:-]{2,}://", name) is not None


class RemoteFiles:
    """Copies files there and back; the native half calls it from several threads."""

    def __init__(self) -> None:
        self._one_at_a_time = threading.Lock()

    def _turn(self, files: Any) -> AbstractContextManager[Any]:
        """To be held while files are read or written: fsspec promises only of its asynchronous file systems that threads may share them."""
        return nullcontext() if getattr(files, "async_impl", False) else self._one_at_a_time

    def fetch(self, address: str, to: str | os.PathLike[str]) -> None:
        """Copies a file, and for ``.gltf`` those that it names, into the folder of ``to``."""
        files, path = _reached(address)
        with self._turn(files):
            files.get_file(path, os.fspath(to))
            if Path(to).suffix.lower() != ".gltf":
                return
            for name in _named_by(Path(to)):
                beside = Path(to).parent / name
                beside.parent.mkdir(parents=True, exist_ok=True)
                # What is missing is an error of the mesh, or of none that matters.
                if files.exists(own := f"{files._parent(path)}/{name}"):
                    files.get_file(own, str(beside))

    def fetch_to(self, address: str, to: Path) -> str:
        """`fetch`, which gives the copy's name and says what cannot be read."""
        try:
            self.fetch(address, to)
        except OSError as why:
            raise ReadError(f"{address} cannot be read: {why}") from why
        return str(to)

    def store(self, source: str | os.PathLike[str], address: str) -> None:
        """Copies a file of this machine to an address."""
        files, path = _reached(address)
        with self._turn(files):
            try:
                files.put_file(os.fspath(source), path)
            except FileNotFoundError:
                # Buckets have no folders, other places do.
                files.makedirs(files._parent(path), exist_ok=True)
                files.put_file(os.fspath(source), path)

    def size(self, address: str) -> int | None:
        """Bytes of a file; None where there is none."""
        files, path = _reached(address)
        try:
            with self._turn(files):
                return int(files.info(path)["size"])
        except (OSError, TypeError):
            return None


def _reached(address: str) -> tuple[Any, str]:
    """The file system of an address, and the path in it."""
    files, path = library("fsspec").core.url_to_fs(address)
    return files, path


def _named_by(document: Path) -> list[str]:
    """The files below its folder that a glTF document names; a document that is none is found wrong when it is refined."""
    try:
        found = json.loads(document.read_text(encoding="utf-8"))
        entries = [*found.get("buffers", ()), *found.get("images", ())]
        names = [unquote(entry["uri"]) for entry in entries if not entry.get("uri", "data:").startswith("data:")]
    except (ValueError, TypeError, AttributeError):
        return []
    return [name for name in names if not is_address(name) and not name.startswith("/") and ".." not in Path(name).parts]
