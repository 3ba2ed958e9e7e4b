# SPDX-License-Identifier: Apache-2.0
"""All labels of an image, each a solid of its own."""

from __future__ import annotations

import math
import queue
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, TypeVar, cast, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._options import checked
from ._progress import Progress, Tell, telling
from .adapt import core_of_image
from .data import Image
from .errors import Cancelled, Error, InvalidOption, UnusableInput, Warning, warn, warnings_of
from .loading import InputOptions, labelled_image, loaded_of, named
from .pipeline import DEFAULTS, AxisOptions, axes_of, axis_options, inputs_of, is_one, name_of
from .result import Axis

if TYPE_CHECKING:
    from typing_extensions import Unpack

_Result = TypeVar("_Result")

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
    fills_voids: bool,
    options: dict[str, Any],
    has_one_scale: bool,
    threads: int,
    progress: Progress,
) -> Iterator[tuple[int, Any]]:
    numbers, names = _arrays.numbered(image.values)
    values, place = core_of_image(replace(image, values=numbers))
    frame = image.unit, image.space

    def work(deliver: Callable[[int, dict[str, Any]], None], tell: Tell) -> None:
        _core.label_axes(values, place, frame, smoothing, fills_voids, options, deliver, threads, tell)

    with telling(progress) as tell:
        for result in _in_order(work, tell):
            label = result["label"] if names is None else names[result["label"]].item()
            failed = warnings_of(result["error"])
            if failed:
                warn(_about(label, failed))
                continue
            loaded = named(loaded_of(result["input"], is_mask=True), names)
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
    mask = inputs.get("mask_smoothing"), inputs.get("fill_voids", False)
    return _pairs(given, name_of(image), *mask, chosen, is_one(scale), threads, progress)


def _boxes(values: npt.NDArray[Any], margin: int) -> Iterator[tuple[int, tuple[slice, ...]]]:
    """The labels, ascending, and the part of the image around each; those of files are floats, a mask's is True."""
    places = np.nonzero(values)
    labels, numbers = np.unique(values[places], return_inverse=True)
    low, high = (np.full((len(labels), values.ndim), start) for start in (np.iinfo(np.int64).max, -1))
    for axis, indices in enumerate(places):
        np.minimum.at(low[:, axis], numbers, indices)
        np.maximum.at(high[:, axis], numbers, indices)
    for label, first, last in zip(labels.tolist(), low.tolist(), high.tolist()):
        yield int(label), tuple(slice(max(0, a - margin), b + margin + 1) for a, b in zip(first, last))


def each_label(function: Callable[..., _Result], image: Any, /, **options: Any) -> Iterator[tuple[int, _Result]]:
    """What a function makes of each label of an image: pairs (label, result), labels ascending.

    function: called as `function(part, labels=label, **options)` with the part of the image around the label, as an
        `Image`: `skeleton`, `midsurface`, `spheres`, `axis`, or one of your own.
    image: as of `label_axes`, which computes several axes at once. `transform` is that of the whole image.
    options: those of the function but `labels`, and for arrays `spacing`, `origin` and `direction`.

    A label at which the function fails is left out, with a warning, which names it like all others; if it fails at all of
    them, the first error is raised.
    """
    if "labels" in options:
        raise InvalidOption("each_label takes every label: to choose some, set the others to 0")
    places = {name: options.pop(name) for name in ("spacing", "origin", "direction") if name in options}
    whole = labelled_image(image, cast(InputOptions, places))
    margin = 2 + math.ceil(3.0 * max(1.0, options.get("mask_smoothing") or 0.0))  # as far as smoothing looks, or farther
    return _results(function, whole, margin, options)


def _with_transform(result: Any, transform: npt.NDArray[np.float64]) -> Any:
    """An axis, those of several scales, or what was made from one, with the voxels of the whole image."""
    if isinstance(result, list):
        return [_with_transform(one, transform) for one in result]
    if isinstance(result, Axis):
        return replace(result, transform=transform)
    axis = getattr(result, "axis", None)
    return replace(result, axis=replace(axis, transform=transform)) if isinstance(axis, Axis) else result


def _results(
    function: Callable[..., _Result], whole: Image, margin: int, options: dict[str, Any]
) -> Iterator[tuple[int, _Result]]:
    values = np.asarray(whole.values)
    if not values.any() or (values.dtype.kind == "f" and (values != np.floor(values)).any()):
        raise UnusableInput("the image has no labels, which are whole numbers other than 0")
    transform = np.column_stack([np.asarray(whole.steps).T, whole.origin])
    errors: list[Error] = []
    count = 0
    for label, box in _boxes(values, margin):
        corner = whole.origin + np.array([part.start for part in box]) @ whole.steps
        part = Image(values[box], corner, whole.steps, whole.unit, whole.space)
        count += 1
        results: list[_Result] = []
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                results.append(_with_transform(function(part, labels=label, **options), transform))
            except Cancelled:
                raise
            except Error as error:
                errors.append(error)
                warnings.warn(Warning(str(error), error.code, error.element, error.index, error.place), stacklevel=1)
        warn(_about(label, [one.message for one in told if isinstance(one.message, Warning)]))
        for result in results:
            yield label, result
    if errors and len(errors) == count:
        raise errors[0]


__all__ = ["each_label", "label_axes"]
