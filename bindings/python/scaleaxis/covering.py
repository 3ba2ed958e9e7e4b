# SPDX-License-Identifier: Apache-2.0
"""A few balls in place of a solid."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._options import Seed, checked, length_of
from ._progress import Progress, part_of, telling
from .adapt import as_balls
from .data import Samples
from .errors import InvalidOption, warn
from .loading import InputOptions, load_with
from .solids import Solid, union_solid
from .stages import Sizing, boundary_mesh, inner_balls, sample, tolerance_of, union_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

_DEFAULT_DELTA = 0.01
_SCORED = 0.004  # of the diagonal: spacing of the points that the result is measured at
_POINTS_OF_SPACING = 10.0  # of `points_left_out` for each square of its spacing

# An axis ("x", "-z") or a normal, and an offset along it: balls stay where it is no less.
Clip = tuple[Any, float]
_AXES = {
    sign + axis: tuple(factor * (axis == other) for other in "xyz")
    for axis in "xyz"
    for sign, factor in (("", 1.0), ("-", -1.0))
}


def planes_of(clip: Sequence[Clip]) -> list[tuple[tuple[float, float, float], float]]:
    """Normals and offsets of planes, for the core."""
    planes = []
    for axis, offset in clip:
        if isinstance(axis, str) and axis not in _AXES:
            raise InvalidOption(f"{axis!r} is no axis: x, y, z, -x, -y, -z are, or a normal")
        x, y, z = _AXES[axis] if isinstance(axis, str) else axis
        planes.append(((float(x), float(y), float(z)), float(offset)))
    return planes


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

    @property
    def _stands_for(self) -> Floats:
        return self.balls


@checked
def ball_scores(
    balls: Any,
    points: npt.ArrayLike,
    solid: Solid,
    *,
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> dict[str, Any]:
    """How balls stand for a solid that knows nearest points: see `FewBalls.scores`. `points` of the surface, N × 3."""
    with telling(progress) as tell:
        core = _core.ball_scores(as_balls(balls), _arrays.points(points), solid._core, seed, threads, tell)
    scores: dict[str, Any] = json.loads(core)
    return scores


@checked
def few_balls(
    candidates: Any,
    points: npt.ArrayLike,
    solid: Solid,
    count: int | None = None,
    *,
    error: float | None = None,
    inside: bool = False,
    clip_planes: Sequence[Clip] = (),
    threads: int = 0,
    progress: Progress = None,
) -> FewBalls:
    """A few balls that cover a solid, or lie inside it, begun with candidates: the stage alone, without scores.

    candidates: balls inside the solid, N × 4, best maximal ones. points: of its surface, N × 3.
    count: number of balls. error: how far a ball may stick out, or a point be from the balls, as a length. Of covering
        balls both may be given: so many that stick out no farther, and leave uncovered what they do not reach.
    clip_planes: planes that no ball reaches through, an axis ("x", "-z") or a normal, and an offset along it.
    """
    with telling(progress) as tell:
        core = _core.few_balls(
            as_balls(candidates),
            _arrays.points(points),
            solid._core,
            inside,
            count,
            error,
            planes_of(clip_planes),
            threads,
            tell,
        )
    return FewBalls(core["balls"], json.loads(core["statistics"]), {})


@checked
def spheres(
    solid: Any,
    count: int | None = None,
    *,
    error: float | None = None,
    error_abs: float | None = None,
    inside: bool = False,
    clip_planes: Sequence[Clip] = (),
    delta: float = _DEFAULT_DELTA,
    sampling: Sizing = "adaptive",
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
    **inputs: Unpack[InputOptions],
) -> FewBalls:
    """A few balls that cover a solid with the least protrusion, or lie inside it with the least gap, as
    `scaleaxis spheres`.

    solid, inputs: as `axis` takes them.
    count: number of balls.
    error, error_abs: as few balls as stick out by no more than this, or leave no larger gap; relative to the diagonal of
        the solid's bounding box, or as a length. With count so many covering balls, which leave uncovered what they do
        not reach then.
    clip_planes: planes that no ball reaches through: `[("z", 0.0)]` for a floor; a normal may stand in place of the axis.
    delta: tolerance of the sampling, whose balls are the candidates, relative to the diagonal.
    sampling: as of `axis`.

    Raises InvalidOption, UnusableInput, FileError, Cancelled.
    """
    largest = length_of(error, error_abs, "error")
    if count is None and largest is None:
        raise InvalidOption("count is needed, or one of error and error_abs, or both")
    with telling(progress) as tell:

        def part(begin: float, end: float) -> dict[str, Any]:
            return {"threads": threads, "progress": part_of(tell, begin, end)}

        def sampled(of: Solid, begin: float, end: float) -> tuple[Samples, Floats]:
            middle = 0.5 * (begin + end)
            samples = sample(of, tolerance_of(delta, of.diagonal), sampling=sampling, seed=seed, **part(begin, middle))
            return samples, union_of(samples, of, seed=seed, keeps_all=True, **part(middle, end)).balls

        loaded = load_with(solid, inputs, threads, part_of(tell, 0.0, 0.1))
        if loaded.solid is not None and loaded.solid.knows_nearest:
            shape = loaded.solid
        elif loaded.solid is not None:
            shape = union_solid(sampled(loaded.solid, 0.1, 0.3)[1], **part(0.3, 0.32))
        else:
            assert loaded.samples is not None  # it has one of the two
            shape = union_solid(inner_balls(loaded.samples, **part(0.1, 0.3)), **part(0.3, 0.32))
        samples, candidates = sampled(shape, 0.32, 0.6)
        length, is_length = largest or (None, True)
        if length is not None and not is_length:
            length *= shape.diagonal
        few = few_balls(
            candidates,
            samples.points,
            shape,
            count,
            error=length,
            inside=inside,
            clip_planes=clip_planes,
            **part(0.6, 0.9),
        )
        spacing = _SCORED * shape.diagonal
        points = shape.seeds(spacing, seed=seed + 1, threads=threads)
        points = points if len(points) else samples.points
        if loaded.left_out is not None:
            # As dense as the points of the solid, which may be ten for each square of the spacing, or one.
            boundary = boundary_mesh(samples, threads=threads)
            a, b, c = np.moveaxis(boundary.vertices[boundary.triangles], 1, 0)
            area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
            as_dense = float(np.sqrt(_POINTS_OF_SPACING * area / len(points)))
            others = _core.points_left_out(*loaded.left_out, shape._core, as_dense, seed + 1, threads, None)
            points = np.concatenate([points, others])
        scores = ball_scores(few.balls, points, shape, seed=seed, **part(0.9, 1.0))
    warn(loaded.warnings)
    return FewBalls(few.balls, few.statistics, scores)


__all__ = ["FewBalls", "ball_scores", "few_balls", "spheres"]
