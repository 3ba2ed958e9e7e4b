# SPDX-License-Identifier: Apache-2.0
"""Threads, progress, interrupts, leaks."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scaleaxis
from conftest import seconds_to_interrupt, torus_mesh


def resident() -> int:
    gc.collect()  # exceptions hold frames, in cycles
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_calls_from_a_pool_of_threads(box, torus):
    expected = [scaleaxis.axis(solid, delta=0.03).vertices for solid in (box, torus)]
    with ThreadPoolExecutor(8) as pool:
        results = list(pool.map(lambda i: scaleaxis.axis((box, torus)[i % 2], delta=0.03).vertices, range(24)))
    assert all(np.array_equal(result, expected[i % 2]) for i, result in enumerate(results))


def test_functions_from_a_pool_of_threads():
    def radius(size):
        solid = scaleaxis.axis(lambda p: np.linalg.norm(p, axis=1) - size, bounds=[[-3] * 3, [3] * 3], delta=0.05)
        return solid.radii.max()

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(radius, [1, 1.5, 2, 2.5])) == pytest.approx([1, 1.5, 2, 2.5], rel=0.02)


def test_one_solid_asked_by_many_threads(torus):
    solid = scaleaxis.mesh_solid(*torus)
    places = np.random.default_rng(1).uniform(-3, 3, (20_000, 3))
    expected = solid.inside(places)
    with ThreadPoolExecutor(8) as pool:
        for answer in pool.map(lambda _: solid.inside(places), range(16)):
            assert np.array_equal(answer, expected)


def test_other_threads_run_meanwhile(torus):
    """The lock of the interpreter is free while the library works."""
    counts, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counts[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    scaleaxis.axis(torus, delta=0.006, sampling="uniform", threads=1)
    seconds = time.perf_counter() - start
    stop.set()
    thread.join()
    assert seconds > 0.2 and counts[0] > 50 * seconds


def test_progress_grows_to_one(torus):
    told = []
    # So many samples that their stage lasts longer than from one call to the next.
    options = {"delta": 0.004, "sampling": "uniform", "threads": 1}
    scaleaxis.axis(torus, **options, progress=lambda stage, part: told.append((stage, part)))
    parts = [part for _, part in told]
    assert len(told) > 3 and parts == sorted(parts) and parts[-1] == 1.0
    assert 0 <= parts[0] < 0.5 and "sampling" in {stage for stage, _ in told}


def test_progress_is_told_in_the_thread_of_the_caller(torus):
    threads = set()
    scaleaxis.sample(
        scaleaxis.mesh_solid(*torus), 0.03, progress=lambda stage, part: threads.add(threading.current_thread())
    )
    assert threads == {threading.current_thread()}


def test_progress_bar(torus, capsys):
    scaleaxis.axis(torus, delta=0.03, progress=True)
    assert "100%" in capsys.readouterr().err


def test_progress_cancels(torus):
    start = time.process_time()
    with pytest.raises(scaleaxis.Cancelled) as caught:
        scaleaxis.axis(torus, delta=0.001, progress=lambda stage, part: False)
    assert time.process_time() - start < 1.5 and caught.value.code == "cancelled"


@pytest.mark.parametrize("answer, cancels", [(np.bool_(False), True), (np.bool_(True), False), (0, False), (None, False)])
def test_false_of_numpy_cancels_too(torus, answer, cancels):
    told = []

    def tell(stage, part):
        told.append(stage)
        return answer

    if cancels:
        with pytest.raises(scaleaxis.Cancelled):
            scaleaxis.axis(torus, delta=0.03, progress=tell)
    else:
        scaleaxis.axis(torus, delta=0.03, progress=tell)
    assert told


def test_exceptions_of_the_progress_cancel(torus):
    def fail(stage, part):
        raise LookupError(stage)

    with pytest.raises(LookupError):
        scaleaxis.axis(torus, delta=0.001, progress=fail)


INTERRUPTED = """
import sys, time
sys.path.insert(0, {tests!r})
import numpy as np, scaleaxis
from conftest import torus_mesh
def torus(p):
    return np.hypot(np.hypot(p[:, 0], p[:, 1]) - 2, p[:, 2]) - 0.5
solid, options = {solid}
print("ready", flush=True)
try:
    scaleaxis.axis(solid, delta=0.001, sampling="uniform", **options)
except KeyboardInterrupt:
    print("interrupted", time.time(), flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")
@pytest.mark.parametrize("solid", ["torus_mesh(), {}", "torus, {'bounds': [[-3, -3, -1], [3, 3, 1]]}"])
def test_interrupt_stops_at_once(solid):
    code = INTERRUPTED.format(tests=os.path.dirname(__file__), solid=solid)
    # Half a second on a machine of one's own; this one may be shared. Not interrupted it takes minutes.
    assert seconds_to_interrupt(code, 1.0) < 5.0


def test_interrupted_call_leaves_the_library_usable(box):
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        scaleaxis.axis(torus_mesh(), delta=0.0005, sampling="uniform")
    timer.join()
    assert len(scaleaxis.axis(box, delta=0.05).vertices) > 0


def cheap_call(balls: np.ndarray) -> None:
    union = scaleaxis.BallUnion(balls)
    union.inside(balls[:, :3])
    scaleaxis.shrink(scaleaxis.MedialComplex.from_polygons(balls[:, :3], balls[:, 3], [[0, 1, 2]]), 1.1)


def failing_call(balls: np.ndarray) -> None:
    for threads in (0, 3):
        with pytest.raises(scaleaxis.InvalidOption):
            scaleaxis.sample(scaleaxis.union_solid(balls, threads=threads), -1.0, threads=threads)


def function_call(balls: np.ndarray) -> None:
    big = np.zeros(1000)  # must not stay with the function
    scaleaxis.function_solid(lambda p: np.linalg.norm(p, axis=1) - 1 + big[0], [[-2] * 3, [2] * 3], 0.5)


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="memory is told by /proc")
@pytest.mark.parametrize(("call", "times"), [(cheap_call, 10_000), (failing_call, 2_000), (function_call, 500)])
def test_memory_stays_flat(call, times):
    balls = np.column_stack([np.random.default_rng(1).normal(size=(200, 3)), np.full(200, 0.3)])
    for _ in range(times // 10):
        call(balls)

    # What is lost is lost in every round (2,000 arrays of 200 balls are 13 MB); pools of memory stop growing, some late.
    before = resident()
    for rounds in range(1, 13):
        for _ in range(times):
            call(balls)
        for _ in range(20 if rounds >= 3 else 1):
            time.sleep(0.1)  # workers that are late leave their arenas, which then go
            if rounds >= 3 and resident() - before < 3e6 * rounds:
                return
    pytest.fail(f"{(resident() - before) / 1e6:.0f} MB more after {12 * times} calls")
