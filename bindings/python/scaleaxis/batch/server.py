# SPDX-License-Identifier: Apache-2.0
"""A process that has the package loaded and forks itself for each model.

So a model has a process for itself, which the kernel limits and measures, and which costs milliseconds; numpy and the
library are loaded once. It reads requests, a JSON object a line, and answers each with a line. It ends with its input,
and the model at work and its folder with it, so that nothing is left of a worker that is killed.
"""

from __future__ import annotations

import gc
import json
import os
import select
import shutil
import signal
import sys
import time
import warnings
from functools import partial
from typing import Any

from .. import errors
from ..pipeline import axis
from ..result import Axis
from .servers import forked, leave_signals_to_caller

DEBUG = "SCALEAXIS_BATCH_DEBUG"
"""For tests: a JSON object; "crash", "hang", "eat" and "slow" are parts of names of models that do so, "log" is a file
that gets a line for each model that is computed."""


def _debug(path: str) -> None:
    asked = json.loads(os.environ.get(DEBUG) or "{}")
    name = os.path.basename(path)
    if "log" in asked:
        with open(asked["log"], "a", encoding="utf-8") as log:
            log.write(name + "\n")
    if asked.get("crash", "/") in name:
        os.abort()
    while asked.get("hang", "/") in name:
        time.sleep(1)
    if asked.get("slow", "/") in name:
        time.sleep(0.2)
    if asked.get("eat", "/") in name:
        eaten = []
        for _ in range(64):
            eaten.append(b"1" * 2**26)


def _counts(topology: dict[str, Any] | None, prefix: str) -> dict[str, Any]:
    return {f"{prefix}{name}": topology and topology[name] for name in ("components", "euler", "tunnels", "voids")}


def _computed(request: dict[str, Any]) -> dict[str, Any]:
    """The parts of the rows that the results tell."""
    _debug(request["name"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are counted in the row
        results = axis(request["file"], threads=request["threads"], **request["options"])
    for result, output in zip(results, request["outputs"]):
        result.save(output)
    return {"axes": [_row_of(result) for result in results]}


def _row_of(result: Axis) -> dict[str, Any]:
    known = result.statistics
    return {
        "vertices": len(result.vertices),
        "edges": len(result.edges),
        "polygons": len(result.polygons),
        "sheets": result.complex.sheets,
        "balls": len(result.balls),
        "samples": known["samples"],
        **_counts(result.topology._asdict(), ""),
        **_counts(known["solid"], "solid_"),
        "diagonal": result.diagonal,
        "tolerance": result.tolerance,
        "warnings": sorted({warning.code for warning in result.warnings}),
    }


def _failure(error: BaseException) -> dict[str, Any]:
    if isinstance(error, MemoryError):
        return {"reason": "memory", "error": "it needs more memory than it may have"}
    if isinstance(error, errors.InvalidOption):
        reason = "option"
    elif isinstance(error, (errors.FileError, ValueError)):  # UnusableInput is a ValueError
        reason = "input"
    else:
        reason = "error"
    text = " ".join(str(error).split()) or type(error).__name__
    return {"reason": reason, "error": text, "code": getattr(error, "code", None)}


def _limit_memory(most_bytes: int | None) -> None:
    if most_bytes is None:
        return
    import resource

    # What is written to, and not addresses alone, of which threads reserve far more than they use.
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    resource.setrlimit(kind, (most_bytes, most_bytes))


def _run_forked(request: dict[str, Any], pipe: int) -> None:
    """In the process of the model."""
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(os.open(request["messages"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), 2)
    os.dup2(2, 1)
    try:
        _limit_memory(request["memory_limit"])
        answer = _computed(request)
    except BaseException as error:
        answer = _failure(error)
    os.write(pipe, json.dumps(answer).encode())


def _answer_of(pipe: int, process: int, request: dict[str, Any]) -> tuple[bytes, bool]:
    """What the process of the model writes until its end, and whether the time was over before."""
    time_limit = request["time_limit"]
    deadline = None if time_limit is None else time.monotonic() + time_limit
    answer = b""
    while True:
        rest = None if deadline is None else max(0.0, deadline - time.monotonic())
        ready, _, _ = select.select([0, pipe], [], [], rest)
        if 0 in ready:  # nobody asks while an answer is due: it is the end
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            shutil.rmtree(request["folder"], ignore_errors=True)
            os._exit(0)
        if not ready:
            os.kill(process, signal.SIGKILL)
            return b"", True
        part = os.read(pipe, 2**16)
        if not part:
            return answer, False
        answer += part


def _last_message(file: str) -> str:
    try:
        with open(file, encoding="utf-8", errors="replace") as messages:
            lines = [line.strip() for line in messages.read()[-2000:].splitlines() if line.strip()]
    except OSError:
        lines = []
    return f": {lines[-1]}" if lines else ""


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _answer(request: dict[str, Any]) -> dict[str, Any]:
    start = time.monotonic()
    process, read_end = forked(partial(_run_forked, request))
    text, is_late = _answer_of(read_end, process, request)
    os.close(read_end)
    _, status, usage = os.wait4(process, 0)
    answer: dict[str, Any]
    if is_late:
        answer = {"reason": "time", "error": f"it took longer than {request['time_limit']:g} s"}
    elif os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGTERM:
        answer = {"lost": True, "error": "it was stopped with its job"}
    elif os.WIFSIGNALED(status):
        name = _signal_name(os.WTERMSIG(status))
        answer = {"reason": "crash", "error": f"it was ended by {name}{_last_message(request['messages'])}"}
    elif not text:
        answer = {"reason": "crash", "error": f"it ended without a result{_last_message(request['messages'])}"}
    else:
        answer = json.loads(text)
    answer["seconds"] = time.monotonic() - start
    answer["peak_memory"] = usage.ru_maxrss * (1024 if sys.platform == "linux" else 1)
    return answer


def main() -> None:
    """Answers requests until standard input ends."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    leave_signals_to_caller()
    gc.freeze()  # what is loaded stays shared with the processes of the models
    folder = None
    for line in iter(sys.stdin.buffer.readline, b""):
        request = json.loads(line)
        folder = request["folder"]
        print(json.dumps(_answer(request)), file=answers, flush=True)
    if folder is not None:  # gone, unless the worker was killed while it stored results
        shutil.rmtree(folder, ignore_errors=True)
