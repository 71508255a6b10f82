"""A textured asset, edited: triangles are replaced, and everything else stays to the byte."""

import os
from pathlib import Path

from _folder import folder

import limitmesh

models = Path(os.environ.get("LIMITMESH_MODELS", "../shared/models"))
if (models / "duck.glb").exists():
    report = limitmesh.refine_file(models / "duck.glb", folder() / "duck_smooth.glb", tolerance="0.1%")
    for mesh in report["meshes"]:
        print(f"{mesh['output']['triangles']:,} triangles, certainly within {mesh['error']['upper']:.3g} of the scene's unit")
else:
    print("skipped: LIMITMESH_MODELS does not name a folder with duck.glb")
