"""Five lines from a model to a certified, textured result."""

from _folder import folder

import limitmesh

cup = limitmesh.load("builtin:cup")
texture = limitmesh.Channel(cup.vertices[:, [0, 1]], semantic="texture")
smooth = limitmesh.refine(cup.vertices, cup.faces, tolerance="0.1%", channels={"uv": texture})
smooth.save(folder() / "cup.obj")
print(f"{len(smooth.faces)} triangles, certainly within {smooth.error.upper:.3g}: {smooth.error.certified}")
