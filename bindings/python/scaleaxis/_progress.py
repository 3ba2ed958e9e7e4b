# SPDX-License-Identifier: Apache-2.0
"""Progress: as a function of the user, or as a bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

Tell = Callable[[str, float], object]
"""Called with the name of the stage and the part of the whole that is done. False cancels the call."""

Progress = bool | Tell | None
"""None or False: none; True: a bar of tqdm; or a function (see `Tell`)."""


@contextmanager
def telling(progress: Progress) -> Iterator[Tell | None]:
    """The function that is told the progress of a call."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        from tqdm.auto import tqdm

        with tqdm(total=100.0, bar_format="{desc:<12}{percentage:3.0f}%|{bar}| {elapsed}") as bar:

            def show(stage: str, fraction: float) -> None:
                bar.set_description_str(stage, refresh=False)
                bar.update(100.0 * fraction - bar.n)

            yield show
    elif callable(progress):
        told = progress

        def tell(stage: str, fraction: float) -> object:
            answer = told(stage, fraction)
            return bool(answer) if isinstance(answer, np.bool_) else answer

        yield tell
    else:
        raise TypeError(f"progress must be None, True or a function, not {type(progress).__name__}")


def part_of(tell: Tell | None, begin: float, end: float) -> Tell | None:
    """For a call that makes the progress from `begin` to `end` of the whole."""
    if tell is None:
        return None
    known = tell
    return lambda stage, fraction: known(stage, begin + (end - begin) * fraction)
