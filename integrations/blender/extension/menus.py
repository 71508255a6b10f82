"""Where the operators are found: the Object menu, and a tab of the sidebar."""

import bpy

from .measuring import MeasureSubdivision
from .smoothing import SmoothToTolerance


class LimitmeshPanel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_limitmesh"
    bl_label = "limitmesh"
    bl_category = "limitmesh"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        _draw(self, context)


def _draw(menu: bpy.types.Menu | bpy.types.Panel, _context: bpy.types.Context) -> None:
    for operator in (SmoothToTolerance, MeasureSubdivision):
        menu.layout.operator(operator.bl_idname)


def _draw_in_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.separator()
    _draw(menu, context)


def register() -> None:
    bpy.utils.register_class(LimitmeshPanel)
    bpy.types.VIEW3D_MT_object.append(_draw_in_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_draw_in_menu)
    bpy.utils.unregister_class(LimitmeshPanel)
