"""One model with fewer and fewer triangles, and how far each is off its limit surface, proven."""

from _folder import folder

import limitmesh

print("triangles  at most off")
for triangles in (100_000, 20_000, 5_000, 2_000):
    level = limitmesh.refine("builtin:bunny", triangles=triangles)
    level.save(folder() / f"bunny_{triangles}.ply")
    print(f"{len(level.faces):9,}  {level.error.upper:.2e}")
