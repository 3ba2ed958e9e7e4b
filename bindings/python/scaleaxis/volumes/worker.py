# SPDX-License-Identifier: Apache-2.0
"""A process for each block, so that its memory is its own, and a block that is killed harms no other.

It is the fork of a process that has the package loaded: that takes ten milliseconds, a new process several hundred. Both
end with their input.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
from contextlib import suppress
from typing import Any

from ..batch.storage import Storage
from ..errors import Error
from .blocks import Task, computed, digest, row_name

DEBUG = "SCALEAXIS_VOLUMES_DEBUG"
"""For tests: a JSON object; "log" is a file that gets a line for each block that is computed, "kill" the name of a file:
the first block that can remove it kills itself."""

_TRIES = 3  # a process that is killed was perhaps the victim of another's memory

Row = dict[str, Any]

# Changes of both are atomic.
_idle: list[subprocess.Popen[bytes]] = []
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


def _start() -> subprocess.Popen[bytes]:
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONSAFEPATH": "1"}
    return subprocess.Popen(
        [sys.executable, "-c", "from scaleaxis.volumes.worker import main; main()"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
    )


def _end(server: subprocess.Popen[bytes]) -> bytes:
    """Returns what it told."""
    assert server.stdin is not None and server.stdout is not None and server.stderr is not None
    with suppress(OSError):
        server.stdin.close()
    told = server.stderr.read()
    server.wait()
    for pipe in (server.stdout, server.stderr):
        pipe.close()
    return told


def _server() -> subprocess.Popen[bytes]:
    with suppress(IndexError):
        while True:
            server = _idle.pop()
            if server.stdin is not None and not server.stdin.closed:
                return server
    return _start()


def _ask(task: Task) -> tuple[bytes, int | None, str]:
    """The row, as bytes; without one, how the process ended: the signal, or what it told."""
    server = _server()
    assert server.stdin is not None and server.stdout is not None
    _busy.add(server)
    answer = b""
    try:
        request = pickle.dumps((task, os.environ.get(DEBUG)))
        server.stdin.write(len(request).to_bytes(8, "little") + request)
        server.stdin.flush()
        answer = server.stdout.readline()
    except (BrokenPipeError, ValueError):  # ValueError: its input was closed
        pass
    except BaseException:  # an interrupt: this answer would be taken for that of the next block
        _end(server)
        raise
    finally:
        _busy.discard(server)
    if answer.endswith(b"\n") and not server.stdin.closed:
        _idle.append(server)
        row, number = json.loads(answer)
        return row.encode(), number, ""
    told = _end(server).decode(errors="replace").strip().splitlines()
    return b"", -server.returncode if server.returncode < 0 else None, told[-1] if told else ""


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


def stop_all() -> None:
    """Ends all processes, and the blocks at work: they notice the end of their input."""
    for server in list(_busy):
        if server.stdin is not None:
            server.stdin.close()
    while _idle:
        with suppress(IndexError):
            _end(_idle.pop())


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
    """In the process of the block. Never returns."""
    try:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        threading.Thread(target=_end_with_input, daemon=True).start()
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # nobody reads it
        with os.fdopen(pipe, "wb") as answers:
            answers.write(json.dumps(_row(task)).encode())
    finally:
        os._exit(0)


def main() -> None:
    """Answers requests until standard input ends, each with a line: the row as a text, and the signal that has ended the
    process of the block.
    """
    # Both are for the caller, who then closes the input; schedulers send them to all processes of a job.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    while len(head := sys.stdin.buffer.read(8)) == 8:
        task, debug = pickle.loads(sys.stdin.buffer.read(int.from_bytes(head, "little")))
        os.environ[DEBUG] = debug or ""
        read_end, write_end = os.pipe()
        process = os.fork()
        if process == 0:
            os.close(read_end)
            _run_forked(task, write_end)
        os.close(write_end)
        with os.fdopen(read_end, "rb") as answers:
            text = answers.read()
        status = os.waitpid(process, 0)[1]
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else None
        print(json.dumps([text.decode(), number]), flush=True)
