"""Builds the extension from the wheel and has Blender install it into an empty folder, as a user does.

The wheel is what LIMITMESH_WHEEL names, or the one in target/wheels. Tests are skipped without it, and without the module bpy.
"""

from __future__ import annotations

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
from collections.abc import Callable

import pytest

BLENDER = pathlib.Path(__file__).parent.parent
HAS_BPY = importlib.util.find_spec("bpy") is not None

# Before bpy is imported: Blender's own folders stay as they are.
_folder = tempfile.TemporaryDirectory(prefix="limitmesh-blender-")
os.environ["BLENDER_USER_RESOURCES"] = _folder.name


def wheel() -> pathlib.Path | None:
    named = os.environ.get("LIMITMESH_WHEEL")
    found = [pathlib.Path(named)] if named else sorted((BLENDER.parent.parent / "target/wheels").glob("limitmesh-*.whl"))
    return found[-1] if found else None


@pytest.fixture(scope="session")
def archive(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The extension as a user downloads it."""
    if (found := wheel()) is None:
        pytest.skip("no wheel of limitmesh: LIMITMESH_WHEEL names one")
    command = [sys.executable, BLENDER / "build.py", found, "--out", tmp_path_factory.mktemp("extension")]
    return pathlib.Path(subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip())


@pytest.fixture(scope="session")
def extension(archive: pathlib.Path) -> str:
    """The extension's module, installed and switched on by Blender's own operator."""
    if not HAS_BPY:
        pytest.skip("the module bpy is not installed: pip install bpy")
    import bpy  # which makes the next module known
    import addon_utils

    addon_utils.enable("bl_pkg")
    bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
    return "bl_ext.user_default.limitmesh"


@pytest.fixture(autouse=True)
def scene(extension: str) -> None:
    """An empty scene."""
    import bpy

    for an_object in list(bpy.data.objects):
        bpy.data.objects.remove(an_object)
    settings = bpy.context.scene.unit_settings
    settings.system, settings.scale_length = "METRIC", 1.0


@pytest.fixture
def said(capfd: pytest.CaptureFixture[str]) -> Callable[[], str]:
    """What operators reported since it was asked last."""
    capfd.readouterr()
    return lambda: capfd.readouterr().out
