"""A folder of meshes with Dask: processes of this machine here, of a cluster with its scheduler's address."""

from _fleet import pairs, table
from dask.distributed import Client

import limitmesh


def smooth(pair: tuple[str, str]) -> tuple[str, int, object]:
    try:
        report = limitmesh.refine_file(*pair, tolerance="0.5%", threads=1)
    except limitmesh.Error as why:  # What is wrong with one mesh is data.
        return pair[0], 0, str(why)
    return pair[0], report["output"]["triangles"], report["error"]["upper_percent"]


if __name__ == "__main__":
    with Client(threads_per_worker=1, dashboard_address=None) as client:
        table(client.gather(client.map(smooth, pairs())))
