# SPDX-License-Identifier: Apache-2.0
"""Tasks → rows, in threads of this process or on Dask. Both take tasks as they need them, so that a few of them are
in memory at a time, however many there are.
"""

from __future__ import annotations

import asyncio
import logging
import os
import uuid
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from itertools import islice
from typing import Any

from ..errors import Error, InvalidOption
from .worker import Row, compute, rows_of, servers

_STAYS = "call again, what is done stays"
# Dask's own errors of connections are kinds of OSError; before Python 3.11 the other one is none.
_UNREACHABLE = (OSError, asyncio.TimeoutError)

Work = Callable[[Any], list[Row]]
"""What a worker does with a task, which has `keys`. It raises nothing."""

Lost = Callable[..., list[Row]]
"""The rows of a task whose worker failed: of the task, "lost", `reason` and `error`."""


def processors() -> int:
    """That this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_threads(
    tasks: Iterator[Any], workers: int, work: Work = compute, stop: Callable[[], None] = servers.stop_all
) -> Iterator[list[Row]]:
    """As many models at a time as there are workers."""
    with ThreadPoolExecutor(workers) as pool:
        try:
            running: set[Future[list[Row]]] = {pool.submit(work, task) for task in islice(tasks, workers)}
            while running:
                finished, running = wait(running, return_when=FIRST_COMPLETED)
                running |= {pool.submit(work, task) for task in islice(tasks, len(finished))}
                for future in finished:
                    yield future.result()
        finally:
            stop()  # threads end with their servers, also in the middle of a model


def _imported() -> Any:
    try:
        import distributed
    except ImportError:
        raise InvalidOption(
            "Dask is not installed: pip install 'scaleaxis[batch]', or use a shard (1/1: all models), which needs none",
        ) from None
    return distributed


@contextmanager
def _silenced(name: str) -> Iterator[None]:
    """A logger that tells nothing below what is critical."""
    logger = logging.getLogger(name)
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


@contextmanager
def dask_client(scheduler: Any, workers: int | None) -> Iterator[Any]:
    """A client of a scheduler: its address, a client, a cluster, or None for one of this machine."""
    distributed = _imported()
    if isinstance(scheduler, distributed.Client):
        yield scheduler
    elif scheduler is not None:
        try:
            client = distributed.Client(scheduler)
        except _UNREACHABLE as error:
            raise Error(f"there is no scheduler at {scheduler}: {error}", "batch.scheduler") from None
        try:
            yield client
        finally:
            with suppress(*_UNREACHABLE):  # it may be gone
                client.close()
    else:
        # Models have processes of their own, so that workers can be threads: they start at once, and a script
        # needs no `if __name__ == "__main__"`.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the dashboard's usual port may be taken
            cluster = distributed.LocalCluster(
                n_workers=1,
                threads_per_worker=workers or processors(),
                processes=False,
                memory_limit=0,
                dashboard_address="127.0.0.1:8787",
                silence_logs=logging.ERROR,
            )
        # A heartbeat on its way when the cluster closes is an error with a traceback to Tornado, and none to anyone else.
        with _silenced("tornado.application"), cluster, distributed.Client(cluster) as client:
            try:
                yield client
            finally:
                servers.stop_all()  # the cluster waits for its threads


@contextmanager
def _reaching() -> Iterator[None]:
    """Around what asks the scheduler, and nothing else: rows that cannot be written are OSErrors too."""
    try:
        yield
    except _UNREACHABLE:
        raise Error(f"the scheduler is gone: {_STAYS}", "batch.scheduler") from None


def _window(client: Any) -> int:
    """Tasks in flight: so many that no worker waits for the client. Clusters may grow meanwhile."""
    slots = 0
    with suppress(AssertionError):  # Tornado's own, once in some hundred runs; it is a hint, and the next call asks again
        slots = sum(client.nthreads().values())
    return max(16, 3 * slots)


def _why(result: Any) -> str:
    error = result[1] if isinstance(result, tuple) and len(result) == 3 else result
    return " ".join(str(error).split()) or type(error).__name__


def on_dask(tasks: Iterator[Any], client: Any, work: Work = compute, lost: Lost = rows_of) -> Iterator[list[Row]]:
    """In the order in which they are done."""
    distributed = _imported()
    run = uuid.uuid4().hex  # two calls may ask the same cluster for the same
    running: dict[str, Any] = {}
    completed = distributed.as_completed(with_results=True, raise_errors=False)

    def submit() -> None:
        with _reaching():
            window = _window(client)
        for task in islice(tasks, max(0, window - len(running))):
            name = f"axis-{task.keys[0]}-{run}"
            running[name] = task
            completed.add(client.submit(work, task, key=name, pure=False))

    submit()
    while running:
        with _reaching():
            future, result = next(completed)
        task = running.pop(future.key)
        status = future.status
        del future  # the cluster then forgets it
        if status == "finished":
            yield result
        elif status == "error":
            # compute() raises nothing: a worker died of it several times, or is not able to run it.
            yield lost(task, "lost", reason="worker", error=f"the worker failed: {_why(result)}")
        else:
            raise Error(f"the cluster has cancelled models: {_STAYS}", "batch.cancelled")
        submit()
