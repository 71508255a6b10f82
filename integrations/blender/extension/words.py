"""Numbers as Blender's interface shows them."""

import bpy


def length(context: bpy.types.Context, value: float) -> str:
    """A distance in the scene's unit, rounded up: what is proven of the number is true of the text."""
    settings = context.scene.unit_settings
    metres = value if settings.system == "NONE" else value * settings.scale_length
    # Blender shows no digits below this, and a distance of nothing but rounding is far below.
    shown, factor = max(metres, 1e-9), 1.0001
    while True:
        text: str = bpy.utils.units.to_string(settings.system, "LENGTH", shown, precision=4)
        if bpy.utils.units.to_value(settings.system, "LENGTH", text) >= metres:
            return text.strip()
        shown, factor = shown * factor, factor**2


def counted(count: int, one: str, many: str) -> str:
    return f"{count:,} {one if count == 1 else many}"
