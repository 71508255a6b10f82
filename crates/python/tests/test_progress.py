"""Long calls beside refinement tell of their progress, end when they are told to, and are the same bytes for any number of threads."""

from __future__ import annotations

import functools
import signal

import numpy as np
import pytest

import limitmesh

RANDOM = np.random.default_rng(1)
DIRECTIONS = RANDOM.normal(size=(400_000, 3))


@functools.cache
def fine() -> tuple[np.ndarray, np.ndarray]:
    mesh = limitmesh.refine("builtin:head", method="uniform", levels=6, origins=False)
    return mesh.vertices, mesh.faces


def frames() -> tuple[list[np.ndarray], np.ndarray]:
    mesh = limitmesh.load("builtin:bunny")
    return [mesh.vertices * [1.0, 1.0 + 0.02 * k, 1.0] for k in range(30)], mesh.faces


# Each takes many seconds.
LONG = {
    "front": lambda **how: limitmesh.Front("builtin:bunny").update(tolerance=0.0, triangles=500_000, **how),
    "planarity": lambda **how: limitmesh.refine("builtin:bunny", method="planarity", angle=0.05, max_triangles=500_000, **how),
    "intersect": lambda **how: limitmesh.intersect(np.zeros(3), DIRECTIONS, "builtin:bunny", **how),
    "facing": lambda **how: limitmesh.facing(*fine(), eye=[0, 0, 5], **how),
    "levels_of_detail": lambda **how: limitmesh.levels_of_detail("builtin:bunny", tolerances=["1e-3%", "1e-4%"], **how),
    "refine_frames": lambda **how: limitmesh.refine_frames(*frames(), tolerance="1e-3%", **how),
    "replay": lambda **how: limitmesh.replay("builtin:bunny", tolerance="1e-5%", **how),
    "sqrt3": lambda **how: limitmesh.refine("builtin:bunny", scheme="sqrt3", tolerance="1e-6%", **how),
    "sqrt3 uniform": lambda **how: limitmesh.refine("builtin:bunny", scheme="sqrt3", method="uniform", levels=8, **how),
}


@pytest.mark.parametrize("name", LONG)
def test_what_progress_raises_ends_the_call(name):
    class Enough(Exception):
        pass

    told = []

    def progress(at):
        told.append(at)
        if len(told) == 2:
            raise Enough

    with pytest.raises(Enough):
        LONG[name](progress=progress)
    assert len(told) == 2 and all(isinstance(at, limitmesh.Progress) and at.stage for at in told)


@pytest.mark.parametrize("name", LONG)
def test_handlers_of_signals_run_and_end_the_call(name):
    fine()
    before = signal.signal(signal.SIGALRM, lambda *_: 1 / 0)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.4)
        with pytest.raises(ZeroDivisionError):
            LONG[name]()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def bytes_of(result) -> bytes:
    arrays = [value for value in vars(result).values() if isinstance(value, np.ndarray)]
    assert arrays
    return b"".join(array.tobytes() for array in arrays)


@pytest.mark.parametrize(
    "options",
    [
        {"scheme": "sqrt3", "tolerance": "0.5%"},
        {"scheme": "sqrt3", "method": "uniform"},
        {"method": "planarity"},
        {"method": "vertex-error", "crease_angle": 40},
    ],
)
def test_threads_change_nothing(options):
    one, three = (limitmesh.refine("builtin:cup", threads=threads, **options) for threads in (1, 3))
    assert bytes_of(one) == bytes_of(three)
    assert one.parent_face.tobytes() == three.parent_face.tobytes()
