# SPDX-License-Identifier: Apache-2.0
"""What a worker does with a model: passes it to a server (server.py), and puts the result where it belongs.

Workers are threads of this process, or of Dask's.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import platform
import shutil
import tempfile
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, NamedTuple

from .. import _core
from .models import Model
from .options import Options, scale_of
from .servers import ServerPool
from .storage import Storage, is_url, opened

Row = dict[str, Any]

servers = ServerPool("scaleaxis.batch.server")


class Task(NamedTuple):
    """Plain data: the models that one sampling is made for, which differ in the scale."""

    models: list[Model]
    keys: list[str]
    storage: Storage
    extension: str
    threads: int
    time_limit: float | None
    memory_limit: int | None


def content_hash(path: str) -> str:
    """Of what is in a file. Raises OSError."""
    digest = hashlib.blake2b(digest_size=16)
    with opened(path) as file:
        while block := file.read(2**20):
            digest.update(block)
    return digest.hexdigest()


def key_of(content: str, path: str, options: Options, extension: str) -> str:
    """The name of a result: the same for the same content, kind of file, options and version of the library."""
    kind = "".join(Path(path).suffixes[-2:]).lower() if path.lower().endswith(".gz") else Path(path).suffix.lower()
    told = json.dumps([content, kind, options, extension, _core.version], sort_keys=True)
    return hashlib.blake2b(told.encode(), digest_size=16).hexdigest()


def result_name(key: str, extension: str) -> str:
    return f"axes/{key[:2]}/{key}{extension}"  # no folder has millions of files


def row_name(key: str) -> str:
    return f"axes/{key[:2]}/{key}.json"


def options_text(options: Options) -> str:
    return json.dumps(options, sort_keys=True)


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="microseconds")


def row_of(model: Model, key: str | None, status: str, **known: Any) -> Row:
    return {
        "path": model.path,
        "scale": scale_of(model.options),
        "status": status,
        "key": key,
        "options": options_text(model.options),
        **known,
        "ended": _now(),
    }


def known_row(model: Model, key: str, storage: Storage, extension: str) -> Row | None:
    """The row of a model whose result is there."""
    text = storage.read(row_name(key))
    try:
        row: Row = json.loads(text) if text else {}
    except ValueError:
        return None
    if row.get("status") != "done" or not storage.exists(result_name(key, extension)):
        return None
    return {**row, **row_of(model, key, "done")}


def _ask(request: dict[str, Any]) -> dict[str, Any]:
    line, status, _ = servers.ask(json.dumps(request).encode() + b"\n")
    if not line:
        return {"lost": True, "error": f"the process that starts models has ended, with status {status}"}
    known: dict[str, Any] = json.loads(line)
    return known


def _local_copy(path: str, folder: str) -> str:
    if not is_url(path):
        return path
    target = os.path.join(folder, path.rpartition("/")[2])
    with opened(path) as source, open(target, "wb") as copy:
        shutil.copyfileobj(source, copy)
    return target


def _described(error: BaseException) -> str:
    text = " ".join(str(error).split())
    number = getattr(error, "errno", None)
    return os.strerror(number) if isinstance(error, OSError) and number == errno.ENOSPC else text


def rows_of(task: Task, status: str, **known: Any) -> list[Row]:
    """The same of all models of a task."""
    return [row_of(model, key, status, **known) for model, key in zip(task.models, task.keys)]


def _stored(task: Task, i: int, file: str, known: dict[str, Any]) -> Row:
    """Puts a result where it belongs. Its row comes last: where it is, the result is."""
    key = task.keys[i]
    name = result_name(key, task.extension)
    row = row_of(task.models[i], key, "done", **known, result=name, version=_core.version)
    try:
        task.storage.write(name, Path(file).read_bytes())
        task.storage.write(row_name(key), json.dumps(row).encode())
    except Exception as error:  # file systems of fsspec raise anything
        message = f"the result cannot be written to {task.storage.path(name)}: {_described(error)}"
        return row_of(task.models[i], key, "lost", reason="writing", error=message)
    return row


def _computed(task: Task, folder: str) -> list[Row]:
    path, options = task.models[0]
    files = [os.path.join(folder, f"axis{i}{task.extension}") for i in range(len(task.models))]
    try:
        source = _local_copy(path, folder)
    except Exception as error:
        return rows_of(task, "lost", reason="reading", error=f"cannot be read: {_described(error)}")
    request = {
        "file": source,
        "name": path,
        "options": {**options, "scale": [scale_of(model.options) for model in task.models]},
        "outputs": files,
        "folder": folder,
        "messages": os.path.join(folder, "messages.txt"),
        "threads": task.threads,
        "time_limit": task.time_limit,
        "memory_limit": task.memory_limit,
    }
    answer = _ask(request)
    answer["host"] = platform.node()
    if answer.pop("lost", False):
        return rows_of(task, "lost", reason="worker", **answer)
    if "error" in answer:
        return rows_of(task, "failed", **answer)
    axes = answer.pop("axes")
    return [_stored(task, i, files[i], {**answer, **axes[i]}) for i in range(len(axes))]


def compute(task: Task) -> list[Row]:
    """The rows of the models. What is wrong with them or their surroundings is in the rows."""
    try:
        # Dask gives a task again to another worker if the first is lost, perhaps after its work was done.
        every = list(zip(task.models, task.keys))
        known = {key: known_row(model, key, task.storage, task.extension) for model, key in every}
        rest = [(model, key) for model, key in every if known[key] is None]
        rows = [row for row in known.values() if row is not None]
        if rest:
            left = task._replace(models=[model for model, _ in rest], keys=[key for _, key in rest])
            with tempfile.TemporaryDirectory(prefix="scaleaxis-") as folder:
                rows += _computed(left, folder)
        return rows
    except Exception as error:
        return rows_of(task, "lost", reason="worker", error=_described(error))
