# SPDX-License-Identifier: Apache-2.0
"""The axes of all labels of an image."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy.typing as npt

from . import _arrays, _core
from ._options import checked
from ._progress import Progress, Tell, telling
from .adapt import core_of_image
from .data import Image
from .errors import Cancelled, Warning, warn, warnings_of
from .loading import labelled_image, loaded_of, named
from .pipeline import DEFAULTS, AxisOptions, axes_of, axis_options, inputs_of, is_one, name_of
from .result import Axis

if TYPE_CHECKING:
    from typing_extensions import Unpack

_PATIENCE = 0.05  # seconds between two looks at the progress

_Work = Callable[[Callable[[int, dict[str, Any]], None], Tell], None]
"""Delivers results with their numbers, from 0 and in any order, and tells its progress, by which it is cancelled."""


def _in_order(work: _Work, tell: Tell | None) -> Iterator[dict[str, Any]]:
    """What `work` delivers, in the order of the numbers, while it goes on in a thread; closing this cancels it."""
    delivered: queue.SimpleQueue[tuple[int, dict[str, Any]]] = queue.SimpleQueue()
    stop = threading.Event()
    progress: list[tuple[str, float]] = [("labels", 0.0)]
    errors: list[BaseException] = []

    def told(stage: str, fraction: float) -> bool:
        progress[0] = stage, fraction
        # Nobody waits for the rest when the interpreter ends.
        return not stop.is_set() and threading.main_thread().is_alive()

    def run() -> None:
        try:
            work(lambda number, result: delivered.put((number, result)), told)
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=run, name="scaleaxis.label_axes")
    thread.start()
    waiting: dict[int, dict[str, Any]] = {}
    following = 0
    try:
        while True:
            is_done = not thread.is_alive()  # then nothing comes after what is there
            try:
                number, result = delivered.get(timeout=0 if is_done else _PATIENCE)
                waiting[number] = result
            except queue.Empty:
                if is_done:
                    break
            while following in waiting:
                yield waiting.pop(following)
                following += 1
            if tell is not None and tell(*progress[0]) is False:
                raise Cancelled("cancelled", "cancelled")
    finally:
        stop.set()
        thread.join()
    if errors:
        raise errors[0]


def _about(label: int, found: list[Warning]) -> list[Warning]:
    return [Warning(f"label {label}: {one}", one.code, one.element, one.index, one.place) for one in found]


def _pairs(
    image: Image,
    name: str,
    smoothing: float | None,
    options: dict[str, Any],
    has_one_scale: bool,
    threads: int,
    progress: Progress,
) -> Iterator[tuple[int, Any]]:
    numbers, names = _arrays.numbered(image.values)
    values, place = core_of_image(replace(image, values=numbers))
    frame = image.unit, image.space

    def work(deliver: Callable[[int, dict[str, Any]], None], tell: Tell) -> None:
        _core.label_axes(values, place, frame, smoothing, options, deliver, threads, tell)

    with telling(progress) as tell:
        for result in _in_order(work, tell):
            label = result["label"] if names is None else names[result["label"]].item()
            failed = warnings_of(result["error"])
            if failed:
                warn(_about(label, failed))
                continue
            loaded = named(loaded_of(result["input"]), names)
            axes = axes_of(result["axis"], loaded, f"{name}-label{label}", label=label)
            warn(_about(label, axes[0].warnings))
            yield label, axes[0] if has_one_scale else axes


@overload
def label_axes(
    image: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: float = ...,
    *,
    threads: int = ...,
    progress: Progress = ...,
    **options: Unpack[AxisOptions],
) -> Iterator[tuple[int, Axis]]: ...
@overload
def label_axes(
    image: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: Sequence[float] | npt.NDArray[Any] = ...,
    *,
    threads: int = ...,
    progress: Progress = ...,
    **options: Unpack[AxisOptions],
) -> Iterator[tuple[int, list[Axis]]]: ...
@checked(defaults=DEFAULTS)
def label_axes(
    image: Any,
    delta: float | Literal["auto"] | None = None,
    scale: float | Sequence[float] | npt.NDArray[Any] | None = None,
    *,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[AxisOptions],
) -> Iterator[tuple[int, Axis]] | Iterator[tuple[int, list[Axis]]]:
    """The axes of all labels of an image, each label a solid of its own: pairs (label, axis), labels ascending.

    As `scaleaxis axis --each-label`: the image is read once, each label is cut out with what is around it, and several
    are computed at once while those that are done are taken. Each axis is what `axis(image, labels=label)` gives.

    image: a path, an array of three dimensions, or an image of nibabel, SimpleITK or `read_image`.
    options: those of `axis`, and of inputs `mask_smoothing`, and for arrays `spacing`, `origin` and `direction`.
    progress: True for a bar of tqdm, or a function (stage, fraction), which cancels by returning False; told while an
        axis is waited for.

    A label that has no axis (too small for `delta_abs`) is left out, with a
    warning, which names it like all others. To stop before the last label, leave the loop, and `close()` the iterator
    if it is kept.

    Raises InvalidOption, UnusableInput, FileError, InconsistentResult, Cancelled.
    """
    chosen = axis_options(delta, scale, options)
    inputs = inputs_of(options)
    given = labelled_image(image, inputs)
    smoothing = inputs.get("mask_smoothing")
    return _pairs(given, name_of(image), smoothing, chosen, is_one(scale), threads, progress)


__all__ = ["label_axes"]
