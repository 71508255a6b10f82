"""A folder of meshes with Ray: a task takes one processor, and runs again where its machine is lost."""

import ray
from _fleet import pairs, table

import limitmesh


@ray.remote(num_cpus=1, max_retries=2)
def smooth(source: str, target: str) -> tuple[str, int, object]:
    try:
        report = limitmesh.refine_file(source, target, tolerance="0.5%", threads=1)
    except limitmesh.Error as why:  # What is wrong with one mesh is data.
        return source, 0, str(why)
    return source, report["output"]["triangles"], report["error"]["upper_percent"]


if __name__ == "__main__":
    ray.init(include_dashboard=False, log_to_driver=False)
    table(ray.get([smooth.remote(*pair) for pair in pairs()]))
