# SPDX-License-Identifier: Apache-2.0
"""How far a call is: as data, and as a line on a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field


@dataclass
class Counts:
    """Models by what became of them."""

    total: int
    done: int = 0  #: computed in this call
    skipped: int = 0  #: whose results were there
    failed: int = 0  #: in this call or, if it does not try them again, in an earlier one
    lost: int = 0  #: that failed for no fault of theirs: a full disk, a worker that is gone; the next call tries again
    tried: int = 0  #: in this call: what the time left is estimated by
    start: float = field(default_factory=time.monotonic, repr=False)

    @property
    def finished(self) -> int:
        return self.done + self.skipped + self.failed + self.lost

    @property
    def seconds(self) -> float:
        return time.monotonic() - self.start

    @property
    def seconds_left(self) -> float | None:
        """If the rest takes as long as what was computed; None before anything was."""
        return self.seconds / self.tried * (self.total - self.finished) if self.tried else None

    def __str__(self) -> str:
        parts = [f"{self.done} done"]
        parts += [f"{count} {name}" for name in ("skipped", "failed", "lost") if (count := getattr(self, name))]
        return ", ".join(parts)


Progress = bool | Callable[[Counts], object] | None
"""None: a line on standard error if that is a terminal; True, False: always, never; or a function that is called
after each model, in the thread of the caller."""

_INTERVAL = 0.1  # seconds between two lines


def clock(seconds: float) -> str:
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02}:{whole % 60:02}" if hours else f"{minutes}:{whole % 60:02}"


def line_of(counts: Counts) -> str:
    left = counts.seconds_left
    rest = "" if left is None else f", {clock(left)} left"
    return f"{counts.finished} of {counts.total}: {counts}{rest}"


@contextmanager
def told(progress: Progress, counts: Counts) -> Iterator[Callable[[], object]]:
    """The function that is called after each model."""
    if callable(progress):
        known = progress
        yield lambda: known(counts)
        return
    if not (sys.stderr.isatty() if progress is None else progress):
        yield lambda: None
        return
    last = -_INTERVAL

    def show(is_end: bool = False) -> None:
        nonlocal last
        if is_end or time.monotonic() - last >= _INTERVAL:
            last = time.monotonic()
            print(f"\r{line_of(counts)}\x1b[K", end="", file=sys.stderr, flush=True)

    try:
        yield show
    finally:
        show(is_end=True)
        print(file=sys.stderr)
