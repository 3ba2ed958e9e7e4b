# SPDX-License-Identifier: Apache-2.0
"""All models in one call."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Literal

from ..errors import Error, InvalidOption
from .models import Model, Models, list_models, runs_of, share_of
from .progress import Counts, Progress, told
from .rows import Identity, Journal, Known, identity_of, journal, known_rows, short, write_parquet
from .runners import dask_client, in_threads, on_dask, processors
from .storage import Storage, is_url
from .worker import Row, Task, content_hash, key_of, known_row, options_text, row_of

Format = Literal["ply", "ma", "vtp", "obj", "glb"]
FORMATS: tuple[Format, ...] = ("ply", "ma", "vtp", "obj", "glb")
LEAST_MEMORY = 2**28  # what is loaded before a model comes takes a part of it


@dataclass(frozen=True)
class Settings:
    """Of one call, the same for all models."""

    storage: Storage
    extension: str
    threads: int
    time_limit: float | None
    memory_limit: int | None
    tries_failed: bool


@dataclass
class Call:
    """What is known while models are at work."""

    settings: Settings
    counts: Counts
    journal: Journal
    known: dict[Identity, Known]
    tell: Callable[[], object]
    waiting: dict[str, list[Model]] = field(default_factory=dict)  #: by key in work: further models that are the same


def _add(call: Call, row: Row | None, kind: str) -> None:
    """Counts a model, and appends its row if there is a new one."""
    if row is not None:
        call.journal.add(row)
    setattr(call.counts, kind, getattr(call.counts, kind) + 1)
    call.tell()


def _is_missing(call: Call, model: Model, key: str) -> bool:
    """Is there an axis to be computed? What is known of it is counted."""
    settings = call.settings
    if key in call.waiting:
        call.waiting[key].append(model)
        return False
    earlier = call.known.get(identity_of(model.path, options_text(model.options)))
    status = earlier.status if earlier is not None and earlier.key == short(key) else None
    if status == "failed" and not settings.tries_failed:
        _add(call, None, "failed")
        return False
    there = known_row(model, key, settings.storage, settings.extension)
    if there is not None:
        _add(call, None if status == "done" else there, "skipped")
        return False
    call.waiting[key] = []
    return True


def _task(call: Call, run: list[Model]) -> Task | None:
    """What is to be computed of models that share a sampling; None if nothing is."""
    settings = call.settings
    try:
        content = content_hash(run[0].path)
    except Exception as error:  # file systems of fsspec raise anything
        message = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        for model in run:
            _add(call, row_of(model, None, "failed", reason="input", error=message, code="file.open"), "failed")
        return None
    every = [(model, key_of(content, model.path, model.options, settings.extension)) for model in run]
    missing = [(model, key) for model, key in every if _is_missing(call, model, key)]
    if not missing:
        return None
    models, keys = [model for model, _ in missing], [key for _, key in missing]
    limits = settings.time_limit, settings.memory_limit
    return Task(models, keys, settings.storage, settings.extension, settings.threads, *limits)


def _tasks(call: Call, runs: list[list[Model]]) -> Iterator[Task]:
    for run in runs:
        task = _task(call, run)
        if task is not None:
            yield task


def _finish(call: Call, rows: list[Row]) -> None:
    for row in rows:
        call.counts.tried += 1
        _add(call, row, row["status"])
        for model in call.waiting.pop(row["key"]):
            same = {**row, "path": model.path, "options": options_text(model.options)}
            _add(call, same, "skipped" if row["status"] == "done" else row["status"])


def _storage(output: Any, options: dict[str, Any] | None) -> Storage:
    text = os.fspath(output)
    if is_url(text):
        storage = Storage(text, options or {})
        try:
            list(storage.names())  # whether there is such a file system
        except InvalidOption:
            raise
        except Exception as error:
            raise InvalidOption(f"{text}: there is no such location: {error}") from None
        return storage
    if options:
        raise InvalidOption("storage_options have no effect on a folder: leave them out")
    if os.path.exists(text) and not os.path.isdir(text):
        raise InvalidOption(f"{text} is a file: the output is a folder")
    return Storage(os.path.abspath(text))


def _check(condition: bool, message: str) -> None:
    if not condition:
        raise InvalidOption(message)


def _is_count(value: Any, least: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= least


def _check_share(shard: tuple[int, int] | None) -> None:
    if shard is not None:
        _check(
            len(shard) == 2 and all(_is_count(number, 0) for number in shard) and 1 <= shard[0] <= shard[1],
            f"shard must be (I, N) with I from 1 to N, not {shard!r}",
        )


def batch(
    models: Models,
    output: str | os.PathLike[str],
    *,
    format: Format = "ply",
    scheduler: Any = None,
    workers: int | None = None,
    threads: int | None = None,
    shard: tuple[int, int] | None = None,
    time_limit: float | None = None,
    memory_limit: int | None = None,
    retry: Literal["failed"] | None = None,
    progress: Progress = None,
    storage_options: dict[str, Any] | None = None,
    **options: Any,
) -> Counts:
    """The axes of many models, each in a process of its own. What an earlier call has done is skipped.

    models: a file, folder or glob; a table, .csv or .parquet, with a column `path` and others named as options; or a
        list of these, and of pairs (path, options).
    output: a folder, or a location of fsspec ("s3://…"): gets `rows.jsonl`, `rows.parquet` and the folder `axes`.
    format: of the axes: ply, ma, vtp, obj or glb.
    scheduler: of Dask: an address, a `distributed.Client`, or a cluster, as of dask-jobqueue. None: this machine.
    workers: models at a time on this machine (default: its processors; with `shard` one).
    threads: for each model (default: the processors shared among the workers; with a scheduler one).
    shard: (I, N): the I-th of N shares of the models, from 1, without Dask.
    time_limit, memory_limit: of each model with all its scales, in seconds and bytes (at least 2²⁸).
    retry: "failed": tries again what failed in earlier calls.
    progress: None: a line on standard error if that is a terminal; or True, False, or a function of `Counts`.
    storage_options: of fsspec, for the output.
    options: those of `scaleaxis.axis` that files can have: delta, scale, angle, smooth… Several scales share one
        sampling, and have a row each.

    Returns how many axes were done, skipped, failed and lost. Raises InvalidOption before any work, FileError where the
    list of models cannot be read, OSError if rows cannot be written, Error if the scheduler is gone.
    """
    _check(format in FORMATS, f"format must be one of {', '.join(FORMATS)}, not {format!r}")
    _check(retry in (None, "failed"), f"retry must be 'failed' or None, not {retry!r}")
    _check(workers is None or _is_count(workers, 1), f"workers must be at least 1, not {workers!r}")
    _check(threads is None or _is_count(threads, 0), f"threads must be at least 0, not {threads!r}")
    _check(scheduler is None or shard is None, "shards need no scheduler: leave one of them out")
    _check(scheduler is None or workers is None, "a scheduler has its own workers: leave workers out")
    _check_share(shard)
    if time_limit is not None:
        is_time = isinstance(time_limit, (int, float)) and math.isfinite(time_limit) and time_limit > 0
        _check(is_time, f"time_limit must be a positive number of seconds, not {time_limit!r}")
    is_memory = memory_limit is None or _is_count(memory_limit, LEAST_MEMORY)
    _check(is_memory, f"memory_limit must be at least {LEAST_MEMORY} bytes, not {memory_limit!r}")
    _check(hasattr(os, "fork"), f"batches need fork(), which {platform.system()} does not have")

    storage = _storage(output, storage_options)
    runs = runs_of(list_models(models, options))
    name = "rows"
    if shard is not None:
        runs = share_of(runs, shard[0] - 1, shard[1])
        name = f"rows-{shard[0]}-of-{shard[1]}"
    at_a_time = workers or (1 if shard else processors())
    if threads is None:
        threads = 1 if scheduler is not None else max(1, processors() // at_a_time)
    settings = Settings(storage, f".{format}", threads, time_limit, memory_limit, retry == "failed")
    counts = Counts(sum(map(len, runs)))
    known = known_rows(storage)

    with told(progress, counts) as tell, journal(storage, name) as rows:
        call = Call(settings, counts, rows, known, tell)
        tasks = _tasks(call, runs)
        if shard is not None:
            for finished in in_threads(tasks, at_a_time):
                _finish(call, finished)
        else:
            with dask_client(scheduler, at_a_time) as client:
                for finished in on_dask(tasks, client):
                    _finish(call, finished)
    write_parquet(storage)
    return counts


__all__ = ["Counts", "Error", "Format", "batch"]
