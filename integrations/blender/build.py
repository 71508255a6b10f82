"""Builds the extension that Blender installs: `python build.py WHEEL... [--out FOLDER]`.

The wheels are limitmesh's, one for each platform that the extension is for. The version is the workspace's.
"""

from __future__ import annotations

import argparse
import pathlib
import tomllib
import zipfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent.parent

# Blender's names of the platforms that wheels are for.
PLATFORMS = {
    ("linux", "x86_64"): "linux-x64",
    ("linux", "aarch64"): "linux-arm64",
    ("win", "amd64"): "windows-x64",
    ("win", "arm64"): "windows-arm64",
    ("macosx", "x86_64"): "macos-x64",
    ("macosx", "arm64"): "macos-arm64",
}


def platforms_of(wheel: pathlib.Path) -> list[str]:
    """Blender's names of the platforms that a wheel's name has."""
    tag = wheel.stem.split("-")[-1].replace("universal2", "x86_64_arm64")
    found = [name for (system, machine), name in PLATFORMS.items() if system in tag and machine in tag]
    if not found:
        raise SystemExit(f"{wheel.name} is for no platform that Blender has")
    return found


def build(wheels: list[pathlib.Path], folder: pathlib.Path) -> pathlib.Path:
    """Writes the extension's archive into a folder; gives its path."""
    version = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    platforms = sorted({platform for wheel in wheels for platform in platforms_of(wheel)})
    fields = {"version": version, "platforms": platforms, "wheels": [f"./wheels/{wheel.name}" for wheel in wheels]}
    manifest = (HERE / "extension/blender_manifest.toml").read_text(encoding="utf-8")
    # What lists and texts are in Python, they are in TOML, too.
    manifest += "".join(f"{name} = {value!r}\n" for name, value in fields.items())
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"limitmesh-blender-{version}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("blender_manifest.toml", manifest)
        for source in sorted((HERE / "extension").glob("*.py")):
            archive.write(source, source.name)
        for licence in sorted(ROOT.glob("LICENSE-*")):
            archive.write(licence, licence.name)
        for wheel in wheels:
            archive.write(wheel, f"wheels/{wheel.name}")
    return path


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("wheels", nargs="+", type=pathlib.Path, help="wheels of limitmesh, one for each platform")
    arguments.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="the folder for the archive")
    given = arguments.parse_args()
    print(build(given.wheels, given.out))


if __name__ == "__main__":
    main()
