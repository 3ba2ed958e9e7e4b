# SPDX-License-Identifier: Apache-2.0
"""What the commands of scaleaxis-batch have in common: how they take words, and how they end."""

from __future__ import annotations

import argparse
import re
import signal
import sys
from collections.abc import Callable
from typing import Any, NoReturn

from ..errors import Error, InvalidOption

DONE, FAILED, USAGE, CANCELLED = 0, 1, 2, 5  # as of the program scaleaxis

_UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "ki": 2**10, "mi": 2**20, "gi": 2**30}


class Parser(argparse.ArgumentParser):
    def __init__(self, **settings: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        """One line; --help has the rest."""
        self.exit(USAGE, f"{self.prog}: {message}\n")


def bytes_of(text: str) -> int | None:
    """Of 4GB, 500M or a number; None if it is no size."""
    found = re.fullmatch(r"([0-9]+[.]?[0-9]*|[.][0-9]+) *([kmg]?i?)b?", text.strip().lower())
    return None if found is None or found[2] not in _UNITS else round(float(found[1]) * _UNITS[found[2]])


def _stop(*_: Any) -> NoReturn:
    raise KeyboardInterrupt


def status_of(command: str, work: Callable[[], int]) -> int:
    """The exit status of a command: that of its work, or what it ended with, which it tells in one line."""
    before = signal.signal(signal.SIGTERM, _stop)  # Slurm's at the end of the time of a job
    try:
        return work()
    except KeyboardInterrupt:
        print(f"{command}: stopped: the same command goes on", file=sys.stderr)
        return CANCELLED
    except (Error, OSError) as error:
        print(f"{command}: {error}", file=sys.stderr)
        return USAGE if isinstance(error, InvalidOption) else FAILED
    finally:
        signal.signal(signal.SIGTERM, before)
