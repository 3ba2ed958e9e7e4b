# SPDX-License-Identifier: Apache-2.0
"""A process for each block, so that its memory is its own, and a block that is killed harms no other.

It reads a task from standard input, and ends with it.
"""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
import threading
from typing import Any

from ..batch.storage import Storage
from ..errors import Error
from .blocks import Task, computed, digest, row_name

DEBUG = "SCALEAXIS_VOLUMES_DEBUG"
"""For tests: a JSON object; "log" is a file that gets a line for each block that is computed, "kill" the name of a file:
the first block that can remove it kills itself."""

_TRIES = 3  # a process that is killed was perhaps the victim of another's memory

Row = dict[str, Any]
_busy: set[subprocess.Popen[bytes]] = set()


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


def compute(task: Task) -> list[Row]:
    """One row, with `error` if there is no result. Raises nothing."""
    row = known_row(task.storage, task.keys[0])
    if row is not None:  # of a worker of Dask that was killed before it could tell
        return [row]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONSAFEPATH": "1"}
    message = ""
    for _ in range(_TRIES):
        process = subprocess.Popen(
            [sys.executable, "-c", "from scaleaxis.volumes.worker import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
        )
        assert process.stdin is not None and process.stdout is not None and process.stderr is not None
        _busy.add(process)
        try:
            request = pickle.dumps(task)
            process.stdin.write(len(request).to_bytes(8, "little") + request)
            process.stdin.flush()
            answer, told = process.stdout.read(), process.stderr.read()
        except (BrokenPipeError, ValueError):  # ValueError: its input was closed
            answer, told = b"", b""
        finally:
            _busy.discard(process)
            process.wait()
            for pipe in (process.stdin, process.stdout, process.stderr):
                pipe.close()
        if answer:
            return [json.loads(answer)]
        if process.returncode >= 0:
            message = (told.decode(errors="replace").strip().splitlines() or ["its process ended without a word"])[-1]
            break
        message = f"its process was ended by signal {-process.returncode}, {_TRIES} times: too little memory, perhaps"
    return [{"key": task.keys[0], "error": message}]


def stop_all() -> None:
    """Ends the blocks at work: they notice the end of their input."""
    for process in list(_busy):
        if process.stdin is not None:
            process.stdin.close()


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
    sys.stdin.buffer.read(1)
    os._exit(1)


def main() -> None:
    size = int.from_bytes(sys.stdin.buffer.read(8), "little")
    task: Task = pickle.loads(sys.stdin.buffer.read(size))
    threading.Thread(target=_end_with_input, daemon=True).start()
    try:
        _debug(task)
        row = {"key": task.keys[0], **computed(task)}
        task.storage.write(row_name(task.keys[0]), json.dumps(row).encode())
    except MemoryError:
        row = {"key": task.keys[0], "error": "it needs more memory than there is: use smaller blocks or fewer workers"}
    except Error as error:
        row = {
            "key": task.keys[0],
            "error": str(error),
            "code": UNWRITTEN if error.code == "file.write" else error.code,
        }
    except OSError as error:
        what = (error.strerror or str(error)).lower()
        row = {"key": task.keys[0], "error": f"its result cannot be written: {what}", "code": UNWRITTEN}
    except Exception as error:
        text = " ".join(str(error).split()) or type(error).__name__
        row = {"key": task.keys[0], "error": text}
    sys.stdout.write(json.dumps(row))
    sys.stdout.flush()
    os._exit(0)
