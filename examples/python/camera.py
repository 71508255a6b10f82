"""As fine as a camera sees it: within half a pixel in its picture, coarse where nobody looks."""

from _folder import folder

import limitmesh

camera = limitmesh.Camera(eye=(0.0, 0.5, 4.0), target=(0.0, 0.0, 0.0), fov=30.0, width=1280, height=720)
seen = limitmesh.refine("builtin:bunny", pixels=0.5, cameras=[camera])
seen.save(folder() / "bunny_seen.ply")
print(f"{len(seen.faces):,} triangles within {seen.pixels:.3f} pixels; everywhere that fine they would be more:")
everywhere = limitmesh.estimate("builtin:bunny", tolerance=max(seen.error.lower, 1e-5))
print(f"about {everywhere.triangles:,}")
