"""As fine as a camera sees it: within half a pixel in its picture, coarse where nobody looks."""

import math

from _folder import folder

import limitmesh

camera = limitmesh.Camera(eye=(0.0, 0.5, 4.0), target=(0.0, 0.0, 0.0), fov=30.0, width=1280, height=720)
seen = limitmesh.refine("builtin:bunny", pixels=0.5, cameras=[camera])
seen.save(folder() / "bunny_seen.ply")
print(f"{len(seen.faces):,} triangles within {seen.pixels:.3f} pixels")

# Half a pixel, as long as it is where the camera is nearest: so fine everywhere, it takes more.
nearest = (camera.eye[2] - seen.vertices[:, 2]).min()
pixel = nearest * 2.0 * math.tan(math.radians(15.0)) / 720
everywhere = limitmesh.estimate("builtin:bunny", tolerance=0.5 * pixel)
print(f"everywhere within {0.5 * pixel:.6f}: about {everywhere.triangles:,}")
