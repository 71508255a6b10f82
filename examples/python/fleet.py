"""A folder of meshes, one process each: joblib where it is installed, the standard library's pool otherwise."""

import os
from concurrent.futures import ProcessPoolExecutor
from importlib.util import find_spec
from pathlib import Path

import limitmesh


def smooth(name: str) -> tuple[str, int, float | str]:
    """One mesh on one thread; what is wrong with it is data."""
    try:
        found = limitmesh.refine(name, tolerance="0.5%", threads=1)
    except limitmesh.Error as why:
        return name, 0, str(why)
    return name, len(found.faces), found.error.upper


if __name__ == "__main__":
    folder = Path(os.environ.get("LIMITMESH_MODELS", "../shared/models"))
    files = sorted(str(path) for path in folder.glob("*") if path.suffix in (".off", ".stl", ".ply") and path.stat().st_size < 10**6)
    names = files or [f"builtin:{name}" for name in limitmesh.models()]
    if find_spec("joblib"):
        from joblib import Parallel, delayed

        rows = Parallel(n_jobs=2)(delayed(smooth)(name) for name in names)
    else:
        with ProcessPoolExecutor(2) as pool:
            rows = list(pool.map(smooth, names))
    for name, triangles, off in rows:
        print(f"{Path(name).name:24} {triangles:9,}  {off if isinstance(off, str) else format(off, '.2e')}")
