# SPDX-License-Identifier: Apache-2.0
"""A few balls in place of a solid."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._progress import Progress, telling
from .errors import InvalidOption, warn
from .loading import InputOptions, load_with
from .solids import Solid, union_solid
from .stages import Sizing, inner_balls, sample, tolerance_of, union_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

_DEFAULT_DELTA = 0.01
_SCORED = 0.004  # of the diagonal: spacing of the points that the result is measured at


@dataclass(frozen=True)
class FewBalls:
    """Balls that stand for a solid.

    balls: N × 4, centres and radii.
    statistics: `error`, the bound of the protrusion or the largest gap found; `greedy_error`, `greedy_count`, what greedy
        set cover alone reaches; `count_bound`, so many candidates are needed at least for this error.
    scores: `coverage`, `surface_coverage`, `largest_gap`, `mean_gap`, `largest_protrusion`, `mean_protrusion`,
        `protrusion_95`, `volume_ratio`, `outside_share`; lengths in units of the solid. Empty if they were not measured.
    """

    balls: Floats
    statistics: dict[str, Any]
    scores: dict[str, Any]


def ball_scores(
    balls: npt.ArrayLike,
    points: npt.ArrayLike,
    solid: Solid,
    *,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> dict[str, Any]:
    """How balls stand for a solid that knows nearest points: see `FewBalls.scores`. `points` of the surface, N × 3."""
    with telling(progress) as tell:
        core = _core.ball_scores(_arrays.balls(balls), _arrays.points(points), solid._core, seed, threads, tell)
    scores: dict[str, Any] = json.loads(core)
    return scores


def few_balls(
    candidates: npt.ArrayLike,
    points: npt.ArrayLike,
    solid: Solid,
    count: int | None = None,
    *,
    error: float | None = None,
    inside: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> FewBalls:
    """A few balls that cover a solid, or lie inside it, begun with candidates: the stage alone, without scores.

    candidates: balls inside the solid, N × 4, best maximal ones. points: of its surface, N × 3.
    count: number of balls. error: in its place, how far a ball may stick out, or a point be from the balls, as a length.
    """
    with telling(progress) as tell:
        core = _core.few_balls(
            _arrays.balls(candidates), _arrays.points(points), solid._core, inside, count, error, threads, tell
        )
    return FewBalls(core["balls"], json.loads(core["statistics"]), {})


def spheres(
    solid: Any,
    count: int | None = None,
    *,
    error: float | None = None,
    error_abs: float | None = None,
    inside: bool = False,
    delta: float = _DEFAULT_DELTA,
    sampling: Sizing = "adaptive",
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
    **inputs: Unpack[InputOptions],
) -> FewBalls:
    """A few balls that cover a solid with the least protrusion, or lie inside it with the least gap, as
    `scaleaxis spheres`.

    solid, inputs: as `axis` takes them.
    count: number of balls.
    error, error_abs: in its place: as few balls as stick out by no more than this, or leave no larger gap; relative to
        the diagonal of the solid's bounding box, or as a length.
    delta: tolerance of the sampling, whose balls are the candidates, relative to the diagonal.
    sampling: as of `axis`.

    Raises InvalidOption, UnusableInput, FileError, Cancelled.
    """
    if sum(option is not None for option in (count, error, error_abs)) != 1:
        raise InvalidOption("one of count, error and error_abs is needed, and only one", "option")
    with telling(progress) as tell:
        loaded = load_with(solid, inputs, threads, tell)
    warn(loaded.warnings)
    if loaded.solid is not None and loaded.solid.knows_nearest:
        shape = loaded.solid
    elif loaded.solid is not None:
        rough = sample(loaded.solid, _tolerance(loaded.solid, delta), sampling=sampling, seed=seed, threads=threads)
        shape = union_solid(union_of(rough, loaded.solid, seed=seed, threads=threads).balls)
    else:
        assert loaded.samples is not None  # it has one of the two
        shape = union_solid(inner_balls(loaded.samples, threads=threads))
    samples = sample(shape, _tolerance(shape, delta), sampling=sampling, seed=seed, threads=threads)
    candidates = union_of(samples, shape, seed=seed, threads=threads).balls
    diagonal = shape.diagonal
    length = error * diagonal if error is not None else error_abs
    few = few_balls(candidates, samples.points, shape, count, error=length, inside=inside, threads=threads)
    points = shape.seeds(_SCORED * diagonal, seed=seed + 1)
    scores = ball_scores(few.balls, points if len(points) else samples.points, shape, seed=seed, threads=threads)
    return FewBalls(few.balls, few.statistics, scores)


def _tolerance(solid: Solid, delta: float) -> float:
    return tolerance_of(delta, solid.diagonal)


__all__ = ["FewBalls", "ball_scores", "few_balls", "spheres"]
