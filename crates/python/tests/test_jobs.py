"""Long calls: signals, progress, threads and processes. What takes how long is measured elsewhere; here it must come to an end."""

from __future__ import annotations

import concurrent.futures
import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings

import numpy as np
import pytest

import limitmesh

# Minutes on any machine.
LONG = {"source": "builtin:bunny", "tolerance": "1e-9%", "max_triangles": 2_000_000_000, "max_memory": "8GB"}


def long_call(progress=None):
    options = dict(LONG)
    return limitmesh.refine(options.pop("source"), progress=progress, **options)


def test_what_progress_raises_ends_the_call():
    class Enough(Exception):
        pass

    told = []

    def progress(at):
        told.append(at)
        if len(told) == 3:
            raise Enough("three times")

    with pytest.raises(Enough, match="three times"):
        long_call(progress)
    assert len(told) == 3
    assert all(isinstance(at, limitmesh.Progress) and at.stage and at.done >= 0 for at in told)


def test_interrupts_end_the_call():
    program = textwrap.dedent(
        """
        import os, signal, threading, time, limitmesh
        # In the background of a shell it is ignored from the start.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        def interrupt():
            global sent
            sent = time.perf_counter()
            os.kill(os.getpid(), signal.SIGINT)
        threading.Timer(1.0, interrupt).start()
        try:
            limitmesh.refine("builtin:bunny", tolerance="1e-9%", max_triangles=2_000_000_000, max_memory="8GB")
        except KeyboardInterrupt:
            print("interrupted after", time.perf_counter() - sent)
        """
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("interrupted after")


def test_handlers_of_other_signals_run():
    met = []
    before = signal.signal(signal.SIGALRM, lambda *_: met.append(time.perf_counter()) or 1 / 0)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(ZeroDivisionError):
            long_call()
        assert met
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_other_threads_go_on():
    stop, counted = threading.Event(), [0]

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    before = counted[0]
    calls = []

    def progress(at):
        calls.append(counted[0])
        if len(calls) == 10:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        long_call(progress)
    stop.set()
    counter.join()
    assert counted[0] - before > 20


def test_calls_from_many_threads_agree():
    expected = limitmesh.refine("builtin:cup", tolerance="0.2%")
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: limitmesh.refine("builtin:cup", tolerance="0.2%", threads=2), range(12)))
    assert all(one.vertices.tobytes() == expected.vertices.tobytes() for one in found)


def in_a_child(name: str) -> bytes:
    return limitmesh.refine(name, tolerance="0.2%", threads=2).vertices.tobytes()


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_that_are_started_after_a_call(method):
    expected = in_a_child("builtin:cup")
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.map_async(in_a_child, ["builtin:cup"] * 4).get(timeout=120)
    assert all(one == expected for one in found)


def by_joblib(job, names):
    joblib = pytest.importorskip("joblib")
    return joblib.Parallel(n_jobs=2, backend="loky")(joblib.delayed(job)(name) for name in names)


def by_dask(job, names):
    distributed = pytest.importorskip("dask.distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        return client.gather(client.map(job, names, pure=False))


def by_ray(job, names):
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        return ray.get([ray.remote(job).remote(name) for name in names])
    finally:
        ray.shutdown()


@pytest.mark.parametrize("engine", [by_joblib, by_dask, by_ray])
@pytest.mark.filterwarnings("ignore")
def test_engines_that_are_started_after_a_call(engine):
    # Pickled by value: an engine's processes need not find this file.
    def job(name):
        import limitmesh

        return limitmesh.refine(name, tolerance="0.2%", threads=1).vertices.tobytes()

    expected = in_a_child("builtin:cup")
    assert all(one == expected for one in engine(job, ["builtin:cup"] * 4))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_amid_a_call_of_another_thread():
    started = threading.Event()

    def progress(at):
        started.set()
        if done.is_set():
            raise InterruptedError

    done = threading.Event()

    def work():
        with pytest.raises(InterruptedError):
            long_call(progress)

    thread = threading.Thread(target=work)
    thread.start()
    assert started.wait(30)
    child = os.fork()
    if child == 0:
        os._exit(0 if len(in_a_child("builtin:cup")) > 1000 else 1)
    try:
        for _ in range(600):
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                break
            time.sleep(0.1)
        else:
            os.kill(child, signal.SIGKILL)
            pytest.fail("the child hangs")
        assert status == 0
    finally:
        done.set()
        thread.join()


needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
needs_tasks = pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="no /proc here")


def last_line_of(program: str) -> str:
    command = [sys.executable, "-W", "error", "-c", textwrap.dedent(program)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()[-1]


@needs_fork
@needs_tasks
def test_no_threads_are_left_when_a_process_is_forked():
    # From 3.12 on Python also warns of threads, which is an error here.
    program = """
        import os, time, warnings
        counts = []
        def count():
            # A thread that was waited for may stand in the list for a moment.
            end = time.monotonic() + 10
            while len(os.listdir("/proc/self/task")) > 1 and time.monotonic() < end:
                time.sleep(0.001)
            counts.append(len(os.listdir("/proc/self/task")))
        # Called last, as those that are registered later are called earlier.
        os.register_at_fork(before=count)
        os.environ["OPENBLAS_NUM_THREADS"] = "1"
        import limitmesh
        for threads in (1, 3, 3):
            expected = limitmesh.refine("builtin:cup", tolerance="0.5%", threads=threads).vertices.tobytes()
        child = os.fork()
        found = limitmesh.refine("builtin:cup", tolerance="0.5%", threads=3).vertices.tobytes()
        if child == 0:
            os._exit(0 if found == expected else 1)
        print(counts, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), found == expected)
        """
    assert last_line_of(program) == "[1] 0 True"


@needs_fork
def test_forks_that_python_does_not_know_of():
    program = """
        import ctypes, os, time
        import limitmesh
        expected = limitmesh.refine("builtin:cup", tolerance="0.5%", threads=2).vertices.tobytes()
        child = ctypes.PyDLL(None).fork()
        if child == 0:
            for threads in (2, 1):
                found = limitmesh.refine("builtin:cup", tolerance="0.5%", threads=threads).vertices.tobytes()
            os._exit(0 if found == expected else 1)
        for _ in range(600):
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                break
            time.sleep(0.1)
        else:
            os.kill(child, 9)
        print(ended == child and status == 0)
        """
    assert last_line_of(program) == "True"


@needs_tasks
def test_threads_are_kept_and_do_not_grow_in_number(octahedron):
    def count() -> int:
        return len(os.listdir("/proc/self/task"))

    limitmesh.refine(*octahedron, tolerance=0.05, threads=2)
    before = count()
    for _ in range(20):
        limitmesh.refine(*octahedron, tolerance=0.05, threads=2)
    assert count() <= before
    for threads in range(1, 9):
        limitmesh.refine(*octahedron, tolerance=0.05, threads=threads)
    deadline = time.monotonic() + 30
    while count() > before + 6 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert count() <= before + 6


def resident() -> int:
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="no /proc here")
def test_a_thousand_calls_leave_nothing_behind(octahedron):
    vertices, faces = octahedron
    bad = np.array([[0, 1, 9]])

    def calls(count):
        for _ in range(count):
            limitmesh.refine(vertices, faces, tolerance=0.02, threads=1, channels={"x": vertices[:, 0]})
            limitmesh.limit(vertices, faces, threads=1)
            with pytest.raises(limitmesh.MeshError):
                limitmesh.refine(vertices, bad, threads=1)
        gc.collect()

    calls(200)
    before = resident()
    calls(1000)
    assert resident() - before < 5 * 2**20


def test_options_that_are_looked_up_late(octahedron):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert limitmesh.refine(*octahedron, max_memory=None, progress=lambda at: None).met
