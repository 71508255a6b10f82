"""The annotations are those of the code."""

from __future__ import annotations

import inspect
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


def test_everything_public_is_documented_with_an_example():
    for name in limitmesh.__all__:
        thing = getattr(limitmesh, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(thing), name
        if inspect.isfunction(thing):
            assert ">>>" in inspect.getdoc(thing), name
