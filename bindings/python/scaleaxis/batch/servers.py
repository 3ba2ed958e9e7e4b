# SPDX-License-Identifier: Apache-2.0
"""Processes that have the package loaded and fork themselves for each request, and who asks them.

A fork takes ten milliseconds, a new process several hundred; and what is killed, harms no other.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple

Server = subprocess.Popen[bytes]


class Answer(NamedTuple):
    line: bytes
    """Empty: the server has ended without one."""
    status: int | None = None
    """With which it has ended."""
    told: str = ""
    """Its last message, if they are kept."""


class ServerPool:
    """Each call has a server to itself, and servers are used again."""

    def __init__(self, module: str, *, keeps_messages: bool = False) -> None:
        # Changes of both are atomic.
        self.idle: list[Server] = []
        self.busy: set[Server] = set()
        self._command = [sys.executable, "-c", f"from {module} import main; main()"]
        self._messages = subprocess.PIPE if keeps_messages else None

    def start(self) -> Server:
        # Requests are the parallel part: no threads of numpy; and nothing is imported from the current folder.
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONSAFEPATH": "1"}
        pipe = subprocess.PIPE
        return subprocess.Popen(self._command, stdin=pipe, stdout=pipe, stderr=self._messages, env=environment)

    def ask(self, request: bytes) -> Answer:
        """The line that the server answers with."""
        try:
            server = self.idle.pop()
        except IndexError:
            server = self.start()
        assert server.stdin is not None and server.stdout is not None
        self.busy.add(server)
        line = b""
        try:
            server.stdin.write(request)
            server.stdin.flush()
            line = server.stdout.readline()
        except (BrokenPipeError, ValueError):  # ValueError: its input is closed
            pass
        except BaseException:  # an interrupt: this answer would be taken for that of the next request
            _end(server)
            raise
        finally:
            self.busy.discard(server)
        if line.endswith(b"\n") and not server.stdin.closed:
            self.idle.append(server)
            return Answer(line)
        told = _end(server)
        return Answer(line if line.endswith(b"\n") else b"", server.returncode, told)

    def close_idle(self) -> None:
        """Ends the servers that are not at work."""
        with suppress(IndexError):
            while True:
                _end(self.idle.pop())

    def stop_all(self) -> None:
        """Ends all servers, and what is at work: it notices the end of its input."""
        self.close_idle()
        for server in list(self.busy):
            assert server.stdin is not None
            server.stdin.close()


def _end(server: Server) -> str:
    assert server.stdin is not None and server.stdout is not None
    for pipe in (server.stdin, server.stdout):
        with suppress(OSError):
            pipe.close()
    told = b""
    if server.stderr is not None:
        told = server.stderr.read()
        server.stderr.close()
    server.wait()
    lines = told.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else ""


def leave_signals_to_caller() -> None:
    """In a server: schedulers send them to all processes of a job, and the caller then closes the input."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)


def forked(run: Callable[[int], None]) -> tuple[int, int]:
    """A process that calls `run` with the end of a pipe to write to, and ends with it; and the end to read from."""
    read_end, write_end = os.pipe()
    process = os.fork()
    if process == 0:
        try:
            os.close(read_end)
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            run(write_end)
        finally:
            os._exit(0)
    os.close(write_end)
    return process, read_end
