"""Blender extension: smooths meshes to a tolerance, and measures subdivision levels, with the package limitmesh."""

from . import measuring, menus, smoothing


def register() -> None:
    smoothing.register()
    measuring.register()
    menus.register()


def unregister() -> None:
    menus.unregister()
    measuring.unregister()
    smoothing.unregister()
