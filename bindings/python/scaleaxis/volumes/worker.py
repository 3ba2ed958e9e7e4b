# SPDX-License-Identifier: Apache-2.0
"""A process for each block, so that its memory is its own, and a block that is killed harms no other.

It is the fork of a server (`..batch.servers`). Both end with their input.
"""

from __future__ import annotations

import json
import os
import pickle
import sys
import threading
from functools import partial
from typing import Any

from ..batch.servers import ServerPool, forked, leave_signals_to_caller
from ..batch.storage import Storage
from ..errors import Error
from .blocks import Task, computed, digest, row_name

DEBUG = "SCALEAXIS_VOLUMES_DEBUG"
"""For tests: a JSON object; "log" is a file that gets a line for each block that is computed, "kill" the name of a file:
the first block that can remove it kills itself."""

_TRIES = 3  # a process that is killed was perhaps the victim of another's memory

Row = dict[str, Any]

servers = ServerPool("scaleaxis.volumes.worker", keeps_messages=True)

UNWRITTEN = "volume.storage"
"""The code of a row whose result cannot be written: nor can those of others."""


def known_row(storage: Storage, key: str) -> Row | None:
    """The row of a block whose results are there, and whole: it is written last."""
    text = storage.read(row_name(key))
    try:
        row: Row | None = json.loads(text) if text else None
    except ValueError:
        return None
    for name, known in row.get("files", {}).items() if row else ():
        content = storage.read(name)
        if content is None or digest(content) != known:
            return None
    return row


def _ask(task: Task) -> tuple[bytes, int | None, str]:
    """The row, as bytes; without one, how the process ended: the signal, or what it told."""
    request = pickle.dumps((task, os.environ.get(DEBUG)))
    line, status, told = servers.ask(len(request).to_bytes(8, "little") + request)
    if line:
        row, number = json.loads(line)
        return row.encode(), number, ""
    return b"", -status if status is not None and status < 0 else None, told


def compute(task: Task) -> list[Row]:
    """One row, with `error` if there is no result. Raises nothing."""
    row = known_row(task.storage, task.keys[0])
    if row is not None:  # of a worker of Dask that was killed before it could tell
        return [row]
    for _ in range(_TRIES):
        answer, number, told = _ask(task)
        if answer:
            return [json.loads(answer)]
        if number is None:
            return [{"key": task.keys[0], "error": told or "its process ended without a word"}]
    message = f"its process was ended by signal {number}, {_TRIES} times: too little memory, perhaps"
    return [{"key": task.keys[0], "error": message}]


def _debug(task: Task) -> None:
    asked = json.loads(os.environ.get(DEBUG) or "{}")
    if "log" in asked:
        with open(asked["log"], "a", encoding="utf-8") as log:
            log.write(task.keys[0] + "\n")
    if "kill" in asked:
        try:
            os.remove(asked["kill"])
        except FileNotFoundError:
            return
        os.kill(os.getpid(), 9)


def _end_with_input() -> None:
    os.read(0, 1)
    os._exit(1)


def _row(task: Task) -> Row:
    try:
        _debug(task)
        row = {"key": task.keys[0], **computed(task)}
        task.storage.write(row_name(task.keys[0]), json.dumps(row).encode())
        return row
    except MemoryError:
        return {"key": task.keys[0], "error": "it needs more memory than there is: use smaller blocks or fewer workers"}
    except Error as error:
        code = UNWRITTEN if error.code == "file.write" else error.code
        return {"key": task.keys[0], "error": str(error), "code": code}
    except OSError as error:
        what = (error.strerror or str(error)).lower()
        return {"key": task.keys[0], "error": f"its result cannot be written: {what}", "code": UNWRITTEN}
    except Exception as error:
        return {"key": task.keys[0], "error": " ".join(str(error).split()) or type(error).__name__}


def _run_forked(task: Task, pipe: int) -> None:
    """In the process of the block."""
    threading.Thread(target=_end_with_input, daemon=True).start()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # nobody reads it
    with os.fdopen(pipe, "wb") as answers:
        answers.write(json.dumps(_row(task)).encode())


def main() -> None:
    """Answers requests until standard input ends, each with a line: the row as a text, and the signal that has ended the
    process of the block.
    """
    leave_signals_to_caller()
    while len(head := sys.stdin.buffer.read(8)) == 8:
        task, debug = pickle.loads(sys.stdin.buffer.read(int.from_bytes(head, "little")))
        os.environ[DEBUG] = debug or ""
        process, read_end = forked(partial(_run_forked, task))
        with os.fdopen(read_end, "rb") as answers:
            text = answers.read()
        status = os.waitpid(process, 0)[1]
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else None
        print(json.dumps([text.decode(), number]), flush=True)
