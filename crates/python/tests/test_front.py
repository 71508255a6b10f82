"""Fronts, beside fresh ones, measured distances and what cameras see; across interrupts and forks."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import limitmesh

OCTAHEDRON = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
FACES = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def surface(front: limitmesh.Front) -> set[tuple[tuple[float, ...], ...]]:
    """Its triangles by their positions, each from its least corner."""
    found = set()
    for triangle in front.vertices[front.faces].tolist():
        corners = [tuple(corner) for corner in triangle]
        least = corners.index(min(corners))
        found.add(tuple(corners[least:] + corners[:least]))
    assert len(found) == len(front.faces)
    return found


def test_a_front_begins_with_the_limits_of_its_control_mesh():
    front = limitmesh.Front(OCTAHEDRON, FACES)
    np.testing.assert_allclose(front.vertices, 24 / 55 * OCTAHEDRON, atol=1e-15)
    assert {tuple(sorted(row)) for row in front.faces.tolist()} == {tuple(sorted(row)) for row in FACES.tolist()}
    assert front.levels == 0 and front.pixels is None and front.certified


def test_a_front_is_a_fresh_one_for_each_demand():
    front = limitmesh.Front(OCTAHEDRON, FACES)
    camera = limitmesh.Camera((0, 0.3, 3), width=400, height=300)
    demands = [
        {"tolerance": 0.02},
        {"tolerance": "0.2%"},
        {"tolerance": 0.05},
        {"triangles": 300},
        {"cameras": camera, "pixels": 0.5},
        {"tolerance": 0.001, "max_levels": 2},
        {"tolerance": 0.02},
    ]
    for demand in demands:
        front.update(**demand)
        fresh = limitmesh.Front(OCTAHEDRON, FACES, threads=1)
        fresh.update(**demand)
        assert surface(front) == surface(fresh), demand
        assert (front.bound, front.pixels, front.levels) == (fresh.bound, fresh.pixels, fresh.levels)


def test_its_bound_is_kept_as_measured():
    front = limitmesh.Front(OCTAHEDRON, FACES)
    bounds = []
    for tolerance in (0.05, 0.01, 0.002):
        front.update(tolerance=tolerance)
        distance = limitmesh.measure((front.vertices, front.faces), limit_of=(OCTAHEDRON, FACES), certified=True)
        assert distance.lower <= front.bound <= tolerance
        edges = np.sort(np.concatenate([front.faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
        bounds.append(front.bound)
    front.update(triangles=len(front.faces))
    assert front.bound <= bounds[-1]
    few = front.update(triangles=100)
    assert len(front.faces) <= 100 and few.merged > 0 and front.bound > bounds[-1]


def test_changes_are_all_that_changed():
    front = limitmesh.Front("builtin:head")
    vertices, faces = front.vertices, front.faces
    touched = []
    for turn in np.linspace(0.0, 0.2, 12):
        eye = (3 * np.sin(turn), 0.2, 3 * np.cos(turn))
        changes = front.update(cameras=limitmesh.Camera(eye, width=300, height=200), pixels=1)
        assert front.pixels <= 1
        for own, new, rows in ((vertices, front.vertices, changes.vertices), (faces, front.faces, changes.faces)):
            kept = np.ones(len(new), bool)
            kept[rows] = False
            common = min(len(own), len(new))
            assert kept[common:].sum() == 0
            np.testing.assert_array_equal(own[:common][kept[:common]], new[:common][kept[:common]])
            assert (np.diff(rows) > 0).all()
        touched.append(len(changes.faces) / len(front.faces))
        vertices, faces = front.vertices, front.faces
    assert np.median(touched[1:]) < 0.5
    same = front.update(cameras=limitmesh.Camera(eye, width=300, height=200), pixels=1)
    assert len(same.vertices) == len(same.faces) == same.divided == same.merged == 0
    assert front.vertices is front.vertices


def test_what_somebody_holds_does_not_change():
    front = limitmesh.Front(OCTAHEDRON, FACES)
    front.update(tolerance=0.01)
    held = front.vertices, front.faces
    copies = [array.copy() for array in held]
    front.update(triangles=8)
    front.update(tolerance=0.001)
    for array, copy in zip(held, copies):
        np.testing.assert_array_equal(array, copy)


def test_interrupts_end_an_update_and_the_next_gives_what_a_fresh_front_does():
    program = textwrap.dedent(
        """
        import os, signal, threading, time, limitmesh
        # In the background of a shell it is ignored from the start.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        front = limitmesh.Front("builtin:bunny")
        def interrupt():
            global sent
            sent = time.perf_counter()
            os.kill(os.getpid(), signal.SIGINT)
        threading.Timer(0.5, interrupt).start()
        try:
            while True:
                front.update(tolerance=0.0, triangles=300_000)
                front.update(triangles=1)
        except KeyboardInterrupt:
            print("interrupted")
        # Between two updates nothing is cancelled: then the next goes on from the last, to the same.
        fresh = limitmesh.Front("builtin:bunny")
        for own in (front, fresh):
            own.update(tolerance="1%")
        triangles = [sorted(map(bytes, own.vertices[own.faces])) for own in (front, fresh)]
        assert triangles[0] == triangles[1]
        print(front.certified)
        """
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout.split() == ["interrupted", "True"], done.stderr


class Enough(Exception):
    pass


def at_call(count: int, told: list[limitmesh.Progress]):
    def progress(at: limitmesh.Progress) -> None:
        told.append(at)
        if len(told) == count:
            raise Enough

    return progress


@pytest.mark.parametrize(
    "long",
    [
        {"tolerance": 0.0, "triangles": 500_000},
        {"tolerance": "0.0002%", "triangles": 3_000_000},
        {"cameras": limitmesh.Camera((0, 0, 3)), "pixels": 0.01, "triangles": 800_000},
    ],
)
def test_what_progress_raises_ends_an_update_and_the_next_is_a_fresh_front(long):
    front = limitmesh.Front("builtin:bunny")
    front.update(tolerance="1%")
    vertices, faces, bound = front.vertices, front.faces, front.bound
    for count in (1, 3):
        told: list[limitmesh.Progress] = []
        with pytest.raises(Enough):
            front.update(**long, progress=at_call(count, told))
        assert len(told) == count and all(at.stage == "refining" for at in told)
        # It is as it was.
        assert front.vertices is vertices and front.faces is faces and front.bound == bound
    all_rows = []
    for demand in ({"tolerance": "0.5%"}, {"triangles": 9000}, {"tolerance": "0.5%"}):
        changes = front.update(**demand)
        all_rows.append(len(changes.vertices) == len(front.vertices) and len(changes.faces) == len(front.faces))
        fresh = limitmesh.Front("builtin:bunny")
        fresh.update(**demand)
        assert surface(front) == surface(fresh)
        assert (front.bound, front.levels) == (fresh.bound, fresh.levels)
    assert all_rows == [True, False, False]


def test_the_beginning_of_a_front_ends_when_progress_raises():
    mesh = limitmesh.refine("builtin:bunny", method="uniform", levels=5, origins=False)
    told: list[limitmesh.Progress] = []
    with pytest.raises(Enough):
        limitmesh.Front(mesh, progress=at_call(1, told))
    assert len(told) == 1


def test_short_updates_need_not_tell():
    told: list[limitmesh.Progress] = []
    front = limitmesh.Front(OCTAHEDRON, FACES, progress=told.append)
    front.update(tolerance=0.01, progress=told.append)
    assert front.bound <= 0.01 and all(isinstance(at, limitmesh.Progress) for at in told)


def in_a_child(front: limitmesh.Front) -> int:
    front.update(tolerance=0.001)
    return len(front.faces)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_front_lives_on_in_both_after_a_fork():
    front = limitmesh.Front(OCTAHEDRON, FACES)
    front.update(tolerance=0.01)
    before = surface(front)
    # Python warns of forks with threads: there are none.
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.write(write, str(in_a_child(front)).encode())
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    count = int(os.read(read, 100))
    changes = front.update(tolerance=0.01)
    assert surface(front) == before and len(changes.faces) == len(front.faces)
    assert in_a_child(front) == count
    os.close(read)
    os.close(write)


def test_threads_end_with_their_front():
    if not os.path.isdir("/proc/self/task"):
        pytest.skip("there is no list of threads")
    fronts = [limitmesh.Front(OCTAHEDRON, FACES, threads=2) for _ in range(3)]
    during = len(os.listdir("/proc/self/task"))
    del fronts
    assert len(os.listdir("/proc/self/task")) == during - 6


def test_fronts_pickle():
    front = limitmesh.Front("builtin:bunny", crease_angle=60)
    front.update(tolerance="1%")
    again = pickle.loads(pickle.dumps(front))
    assert surface(again) == surface(front)
    assert (again.bound, again.certified, again.levels, repr(again)) == (front.bound, front.certified, front.levels, repr(front))
    for demand in ({"tolerance": "0.5%"}, {"triangles": "9k"}):
        for one in (front, again):
            changes = one.update(**demand)
            assert len(changes.faces) > 0
        assert surface(again) == surface(front)


def test_an_update_within_an_update_is_refused():
    front = limitmesh.Front("builtin:bunny")
    met: list[RuntimeError] = []

    def progress(_: limitmesh.Progress) -> None:
        if not met:
            with pytest.raises(RuntimeError, match="another thread, or this update's own progress function") as caught:
                front.update(tolerance="1%")
            met.append(caught.value)

    front.update(tolerance=0.0, triangles=300_000, progress=progress)
    assert len(met) == 1 and len(front.faces) <= 300_000


def test_two_threads_at_one_front_are_told():
    front = limitmesh.Front("builtin:bunny")
    met: list[BaseException] = []

    def update() -> None:
        try:
            front.update(triangles=200_000)
        except RuntimeError as why:
            met.append(why)

    threads = [threading.Thread(target=update) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(met) <= 1 and all("each thread needs one of its own" in str(why) for why in met)
    front.update(tolerance="1%")
    assert front.bound > 0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "nothing is asked for"),
        ({"tolerance": -1}, "tolerance is -1"),
        ({"tolerance": "x"}, "tolerance is 'x'"),
        ({"pixels": 1}, "needs cameras"),
        ({"pixels": 0, "cameras": limitmesh.Camera((0, 0, 5))}, "pixels is 0"),
        ({"tolerance": 1, "cameras": limitmesh.Camera((0, 0, 5))}, "one of them"),
        ({"cameras": [5]}, r"cameras\[0\]"),
        ({"cameras": limitmesh.Camera((0, 0, 0))}, "eye"),
        ({"triangles": 0}, "triangles is 0"),
        ({"max_levels": -1, "tolerance": 1}, "max_levels is -1"),
        ({"max_levels": 31, "tolerance": 1}, "max_levels is 31, expected at most 30"),
        ({"max_levels": 1e18, "tolerance": 1}, "expected at most 30"),
        ({"progress": 5, "tolerance": 1}, "progress is 5, expected a function"),
    ],
)
def test_demands_that_are_none(options, words):
    front = limitmesh.Front(OCTAHEDRON, FACES)
    front.update(tolerance=0.01)
    before = surface(front)
    with pytest.raises(limitmesh.OptionError, match=words):
        front.update(**options)
    # It is as it was, and goes on from there.
    assert surface(front) == before
    assert len(front.update(tolerance=0.011).faces) < len(front.faces)


def test_meshes_that_are_none():
    with pytest.raises(limitmesh.MeshError, match=r"faces\[1\] names vertex 6"):
        limitmesh.Front(OCTAHEDRON, [[0, 1, 2], [0, 1, 6]])
    with pytest.raises(limitmesh.MeshError, match=r"vertices\[0, 0\] is NaN"):
        limitmesh.Front(OCTAHEDRON * [np.nan, 1, 1], FACES)
    with pytest.raises(limitmesh.OptionError, match="scheme is 'sqrt3'"):
        limitmesh.Front(OCTAHEDRON, FACES, scheme="sqrt3")
