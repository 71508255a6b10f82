"""A faceted cylinder: smooth it shrinks, interpolated it keeps its radius, and its rims stay sharp."""

import numpy as np
from _folder import folder

import limitmesh

SIDES, RADIUS, HEIGHT = 16, 5.0, 8.0
angles = 2.0 * np.pi * np.arange(SIDES) / SIDES
ring = RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
vertices = np.concatenate([np.column_stack([ring, np.full(SIDES, z)]) for z in (0.0, HEIGHT)])
sides = [[i, (i + 1) % SIDES, SIDES + (i + 1) % SIDES, SIDES + i] for i in range(SIDES)]
ends = [list(range(SIDES))[::-1], list(range(SIDES, 2 * SIDES))]

for name, options in {"shrunk": {}, "kept": {"interpolate": True}}.items():
    part = limitmesh.refine(vertices, sides + ends, tolerance=0.001, crease_angle=30, **options)
    radius = np.linalg.norm(part.vertices[:, :2], axis=1)
    volume = limitmesh.info(part)["volume"]
    part.save(folder() / f"cylinder_{name}.ply")
    print(f"{name}: radius up to {radius.max():.4f} of {RADIUS}, volume {volume / (np.pi * RADIUS**2 * HEIGHT):.2%} of a cylinder's")
