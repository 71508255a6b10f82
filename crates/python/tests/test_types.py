"""The annotations are those of the code."""

from __future__ import annotations

import ast
import graphlib
import inspect
import pathlib
import subprocess
import sys

import pytest

import limitmesh


def test_stubs_are_the_native_half():
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy.stubtest", "limitmesh._limitmesh"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout


def test_the_package_is_typed():
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "-p", "limitmesh"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout


def test_modules_import_one_way():
    folder = pathlib.Path(inspect.getfile(limitmesh)).parent
    names = {path.stem for path in folder.glob("*.py")}
    imported: dict[str, set[str]] = {}
    for name in names:
        nodes = ast.walk(ast.parse((folder / f"{name}.py").read_text(encoding="utf-8")))
        near = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 1]
        imported[name] = names & {word for node in near for word in (node.module, *(alias.name for alias in node.names)) if word}
    # A circle is an error here, wherever its imports stand.
    graphlib.TopologicalSorter(imported).prepare()


def test_everything_public_is_documented_with_an_example():
    for name in limitmesh.__all__:
        thing = getattr(limitmesh, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(thing), name
        if inspect.isfunction(thing):
            assert ">>>" in inspect.getdoc(thing), name
