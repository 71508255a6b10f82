"""What a mesh of Blender carries in addition to its shape: attributes, vertex groups and shape keys, from the control mesh to the refined one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy
import limitmesh
import numpy as np
import numpy.typing as npt

from .control import Floats, Integers, read

# How an attribute's type is read: the name of its values, how many there are, and what each is.
_TYPES: dict[str, tuple[str, int, npt.DTypeLike]] = {
    "FLOAT": ("value", 1, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    # Blended as they are stored, as Blender does.
    "BYTE_COLOR": ("color_srgb", 4, np.float32),
    "QUATERNION": ("value", 4, np.float32),
    "FLOAT4X4": ("value", 16, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "INT16_2D": ("value", 2, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "BOOLEAN": ("value", 1, bool),
}

# OpenSubdiv's names for Blender's UV Smooth.
_UV_SMOOTH: dict[str, limitmesh._mesh.Interpolation] = {
    "NONE": "linear",
    "PRESERVE_CORNERS": "smooth-corners-only",
    "PRESERVE_CORNERS_AND_JUNCTIONS": "smooth-corners-plus1",
    "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE": "smooth-corners-plus2",
    "PRESERVE_BOUNDARIES": "smooth-boundaries",
    "SMOOTH_ALL": "smooth-none",
}

# The range is before the value, which has to be in it.
_KEY_SETTINGS = ("slider_min", "slider_max", "value", "mute", "vertex_group", "interpolation", "lock_shape")


@dataclass(frozen=True)
class Sources:
    """Where the elements of the refined mesh came from, as rows of those of the control mesh; -1 for none.

    Vertices of the refined mesh are those of `refined`, and then loose ones. `corners` are rows of the corners of its triangles.
    """

    refined: limitmesh.Refined
    corners: Integers
    faces: Integers
    edges: Integers
    nearest_vertices: Integers
    vertices: Integers

    @property
    def loose_vertices(self) -> Integers:
        return self.vertices[len(self.refined.vertices):]

    def at_vertices(self, name: str, values: Floats) -> Floats:
        """A channel made of these values, at all vertices."""
        return np.concatenate([self.refined.at_vertices(name), values[self.loose_vertices]])

    def at_corners(self, name: str) -> Floats:
        """A channel at all corners."""
        values = self.refined.at_corners(name)
        return values.reshape(-1, values.shape[2])[self.corners]


@dataclass(frozen=True)
class Attribute:
    """An attribute of a mesh, read."""

    name: str
    data_type: str
    domain: str
    values: npt.NDArray[Any]

    @property
    def is_blended(self) -> bool:
        # Sharp vertices stay where they are: no other vertex has part of their sharpness.
        return self.values.dtype.kind == "f" and self.name != "crease_vert"

    def channel(self, mesh: bpy.types.Mesh, uv: limitmesh._mesh.Interpolation) -> limitmesh.Channel | None:
        """What limitmesh carries along; none for what elements inherit."""
        if self.domain == "POINT" and self.is_blended:
            return limitmesh.Channel(self.values)
        if self.domain != "CORNER":
            return None
        if self.data_type != "FLOAT2":
            how: limitmesh._mesh.Interpolation = "linear" if self.is_blended else "nearest"
            return limitmesh.Channel(self.values, domain="corner", interpolation=how)
        # Corners at one vertex with equal values have no seam between them. As in Blender, there is one where a texture is mirrored:
        # the third value sees to that.
        values = np.column_stack([self.values, _is_upright(mesh, self.values)])
        return limitmesh.Channel(values, domain="corner", semantic="texture", interpolation=uv)

    def carried(self, key: str, sources: Sources) -> npt.NDArray[Any]:
        """The values on the refined mesh."""
        if self.domain == "CORNER":
            return sources.at_corners(key)[:, :self.values.shape[1]]
        if self.domain == "POINT" and self.is_blended:
            return sources.at_vertices(key, self.values)
        inherited = {"FACE": sources.faces, "EDGE": sources.edges, "POINT": sources.nearest_vertices}
        rows = sources.vertices if self.name == "crease_vert" else inherited[self.domain]
        return np.where((rows >= 0)[:, None], self.values[rows], 0)

    def write(self, mesh: bpy.types.Mesh, values: npt.NDArray[Any]) -> None:
        name, _, dtype = _TYPES[self.data_type]
        attribute = mesh.attributes.get(self.name) or mesh.attributes.new(self.name, self.data_type, self.domain)
        attribute.data.foreach_set(name, np.ascontiguousarray(values, dtype).reshape(-1))


def _is_upright(mesh: bpy.types.Mesh, uv: Floats) -> npt.NDArray[np.bool_]:
    """By corner, whether its face runs counter-clockwise on the texture, as Blender asks."""
    starts, counts = read(mesh.polygons, "loop_start", dtype=np.int32), read(mesh.polygons, "loop_total", dtype=np.int32)
    after = np.arange(len(uv)) + 1
    after[starts + counts - 1] = starts
    twice_areas = np.add.reduceat(uv[:, 0] * uv[after, 1] - uv[after, 0] * uv[:, 1], starts)
    return np.repeat(twice_areas > 0.0, counts)


class Luggage:
    """All that an object's mesh carries. `left` names what cannot be carried."""

    def __init__(self, an_object: bpy.types.Object, modifier: bpy.types.Modifier | None) -> None:
        mesh = an_object.data
        self.attributes, self.left = _attributes(mesh)
        self.groups = [(group.name, group.lock_weight) for group in an_object.vertex_groups]
        self.weights = _weights(mesh, len(self.groups))
        self.keys = [(block.name, read(block.data, "co", 3)) for block in mesh.shape_keys.key_blocks] if mesh.shape_keys else []
        self.uv = _UV_SMOOTH[modifier.uv_smooth if modifier else "PRESERVE_BOUNDARIES"]
        self.uv_maps = (mesh.uv_layers.active_index, [layer.active_render for layer in mesh.uv_layers])
        self.colours = (mesh.attributes.active_color_name, mesh.attributes.default_color_name)

    def channels(self, mesh: bpy.types.Mesh) -> dict[str, limitmesh.Channel]:
        """What limitmesh carries along."""
        found = {f"attribute {one.name}": one.channel(mesh, self.uv) for one in self.attributes}
        if self.groups:
            found["weights"] = limitmesh.Channel(self.weights)
        # Where a vertex of the limit surface goes as control points move.
        for name, positions in self.keys:
            found[f"key {name}"] = limitmesh.Channel(positions, interpolation="smooth-none")
        return {name: channel for name, channel in found.items() if channel is not None}

    def write_attributes(self, mesh: bpy.types.Mesh, sources: Sources) -> None:
        for one in self.attributes:
            one.write(mesh, one.carried(f"attribute {one.name}", sources))
        active, rendered = self.uv_maps
        for layer, is_rendered in zip(mesh.uv_layers, rendered):
            layer.active_render = is_rendered
        if mesh.uv_layers:
            mesh.uv_layers.active_index = active
        mesh.attributes.active_color_name, mesh.attributes.default_color_name = self.colours

    def write_groups(self, an_object: bpy.types.Object, sources: Sources) -> None:
        """Of an object whose mesh has no groups yet."""
        if not self.groups:
            return
        weights = sources.at_vertices("weights", self.weights)
        for (name, is_locked), column in zip(self.groups, weights.T):
            group = an_object.vertex_groups.new(name=name)
            for vertex in np.flatnonzero(column > 0.0).tolist():
                group.add((vertex,), column[vertex], "REPLACE")
            group.lock_weight = is_locked

    def write_keys(self, an_object: bpy.types.Object, sources: Sources, old: bpy.types.Key) -> None:
        """Shape keys with the settings and the animation of the old ones, of an object whose mesh has none yet."""
        for name, positions in self.keys:
            block = an_object.shape_key_add(name=name, from_mix=False)
            block.data.foreach_set("co", sources.at_vertices(f"key {name}", positions).astype(np.float32).reshape(-1))
        new = an_object.data.shape_keys
        _copy(old, new, "use_relative", "eval_time")
        for before, after in zip(old.key_blocks, new.key_blocks):
            _copy(before, after, *_KEY_SETTINGS)
            after.relative_key = new.key_blocks[before.relative_key.name]
        if (animation := old.animation_data) is not None:
            copy = new.animation_data_create()
            # Blender before 4.4 has no slots.
            _copy(animation, copy, "action", *(["action_slot"] if animation.action and hasattr(animation, "action_slot") else []))
            for driver in animation.drivers:
                copy.drivers.from_existing(src_driver=driver)


def _copy(before: bpy.types.bpy_struct, after: bpy.types.bpy_struct, *settings: str) -> None:
    for setting in settings:
        setattr(after, setting, getattr(before, setting))


def _attributes(mesh: bpy.types.Mesh) -> tuple[list[Attribute], list[str]]:
    """Attributes that are carried, and the names of others. Those with a dot are Blender's own notes on what is selected and hidden."""
    found: list[Attribute] = []
    left = ["custom normals"] if mesh.has_custom_normals else []
    for attribute in mesh.attributes:
        if attribute.name.startswith(".") or attribute.name in ("position", "custom_normal"):
            continue
        if attribute.data_type not in _TYPES:
            left.append(attribute.name)
            continue
        name, width, dtype = _TYPES[attribute.data_type]
        values = read(attribute.data, name, width, dtype).reshape(-1, width)
        found.append(Attribute(attribute.name, attribute.data_type, attribute.domain, values))
    return found, left


def _weights(mesh: bpy.types.Mesh, groups: int) -> Floats:
    """(n, groups) weights of all vertices."""
    weights = np.zeros((len(mesh.vertices), groups))
    for vertex, group, weight in _weights_in(mesh) if groups else ():
        weights[vertex, group] = weight
    return weights


def _weights_in(mesh: bpy.types.Mesh) -> Iterator[tuple[int, int, float]]:
    for vertex in mesh.vertices:
        for element in vertex.groups:
            yield vertex.index, element.group, element.weight
