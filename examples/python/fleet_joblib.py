"""A folder of meshes with joblib: a process for each processor, one thread in each."""

from _fleet import pairs, table
from joblib import Parallel, delayed

import limitmesh


def smooth(source: str, target: str) -> tuple[str, int, object]:
    try:
        report = limitmesh.refine_file(source, target, tolerance="0.5%", threads=1)
    except limitmesh.Error as why:  # What is wrong with one mesh is data.
        return source, 0, str(why)
    return source, report["output"]["triangles"], report["error"]["upper_percent"]


if __name__ == "__main__":
    table(Parallel(n_jobs=-1, return_as="generator")(delayed(smooth)(*pair) for pair in pairs()))
