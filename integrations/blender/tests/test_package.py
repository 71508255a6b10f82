"""The archive, and what Blender makes of it."""

import pathlib
import subprocess
import sys
import tomllib
import zipfile

import pytest

bpy = pytest.importorskip("bpy", reason="the module bpy is not installed: pip install bpy")


def test_blender_finds_the_archive_valid(archive):
    tools = [pathlib.Path(folder) / "addons_core/bl_pkg/cli/blender_ext.py" for folder in bpy.utils.script_paths()]
    tool = next(path for path in tools if path.exists())
    done = subprocess.run([sys.executable, tool, "validate", archive], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_manifest_has_the_workspaces_version_and_the_wheel(archive):
    with zipfile.ZipFile(archive) as content:
        manifest = tomllib.loads(content.read("blender_manifest.toml").decode())
        names = content.namelist()
    workspace = tomllib.loads((pathlib.Path(__file__).parents[3] / "Cargo.toml").read_text(encoding="utf-8"))
    assert manifest["version"] == workspace["workspace"]["package"]["version"]
    assert [wheel.removeprefix("./") in names for wheel in manifest["wheels"]] == [True]
    assert {"__init__.py", "LICENSE-MIT", "LICENSE-APACHE"} <= set(names)


def test_blender_unpacks_the_wheel(extension):
    folder = pathlib.Path(bpy.utils.user_resource("EXTENSIONS")) / ".local/lib"
    assert [path.name for path in folder.glob("python3.*/site-packages/limitmesh")] == ["limitmesh"]


def test_it_can_be_switched_off_and_on(extension):
    import addon_utils

    assert bpy.types.VIEW3D_PT_limitmesh.is_registered
    assert "limitmesh_smooth" in dir(bpy.ops.object) and "limitmesh_measure" in dir(bpy.ops.object)
    drawn = len(bpy.types.VIEW3D_MT_object._dyn_ui_initialize())
    addon_utils.disable(extension)
    assert "limitmesh_smooth" not in dir(bpy.ops.object)
    assert len(bpy.types.VIEW3D_MT_object._dyn_ui_initialize()) == drawn - 1
    addon_utils.enable(extension)
    assert "limitmesh_smooth" in dir(bpy.ops.object)
