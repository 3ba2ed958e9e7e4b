# SPDX-License-Identifier: Apache-2.0
"""The whole pipeline in one call."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._options import Seed, checked, length_of
from ._progress import Progress, Tell, part_of, telling
from .adapt import is_path
from .data import Topology, complex_of, core_of_samples
from .errors import InvalidOption, Warning, warn, warnings_of
from .loading import InputOptions, Length, LoadedSolid, load_with
from .result import Axis
from .stages import Sizing, UnionKind, samples_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

Method = Literal["scale", "angle", "lambda"]

DEFAULT_DELTA_RANGE: tuple[float, float] = _core.default_delta_range
"""The coarsest and the finest δ that `delta="auto"` tries."""

DEFAULT_SCALE = 1.1
"""s of the method "scale"."""

_LOADING = 0.15  # its share of the progress


class SamplingOptions(InputOptions, total=False):
    """How a solid is sampled, see `axis`; and how an input becomes one."""

    delta_abs: float | None
    delta_range: tuple[float, float] | None
    union: UnionKind | None
    sampling: Sizing
    keep_samples: bool
    seed: Seed


class AxisOptions(SamplingOptions, total=False):
    """All options of `axis`."""

    angle: float | None
    method: Method
    lambda_: float | None
    lambda_abs: float | None
    sharp: bool
    sharp_angle: float | None
    clean: float | None
    clean_abs: float | None
    compact: bool
    error: float | None
    error_abs: float | None
    vertices: int | None
    dense: bool
    smooth: int | None
    center: bool


DEFAULTS: Mapping[str, Any] = {
    "method": "scale",
    "sharp": True,
    "compact": False,
    "dense": False,
    "center": True,
    "sampling": "adaptive",
    "keep_samples": False,
    "seed": 1,
    "below": False,
    "nonzero": False,
    "fill_voids": False,
    "clip": False,
}
"""Of the options that are not None where they are not given."""


def _delta_range(delta: Any, given: tuple[float, float] | None) -> tuple[float, float] | None:
    if delta == "auto":
        return DEFAULT_DELTA_RANGE if given is None else given
    if given is not None:
        raise InvalidOption('delta_range has no effect without delta="auto": leave it out')
    return None


def name_of(given: Any) -> str:
    if not is_path(given):
        return "solid"
    name = Path(given).name
    return Path(name[:-3] if name.lower().endswith(".gz") else name).stem


def axes_of(core: dict[str, Any], loaded: LoadedSolid, name: str, **more: Any) -> list[Axis]:
    """`more`: what else belongs into the statistics."""
    # The solid tells its warnings again.
    repeated = len(loaded.solid.warnings) if loaded.solid else 0
    warnings = loaded.warnings + warnings_of(core["warnings"])[repeated:]
    topology = core["solid_topology"] and Topology(*core["solid_topology"])
    shared = {
        **more,
        loaded.kind: loaded.report,
        "unit": loaded.report.get("unit"),
        "solid": topology and topology._asdict(),
        "delta_choice": core["delta_choice"] and json.loads(core["delta_choice"]),
        "tolerance": core["tolerance"],
        "diagonal": core["diagonal"],
        "samples": core["sample_count"],
        "sampling": json.loads(core["sampling"]),
        "balls": len(core["balls"]),
        "fit": core["fit"] and json.loads(core["fit"]),
        "costs": loaded.costs + json.loads(core["costs"]),
    }
    samples = core["samples"] and samples_of(core["samples"])
    return [
        Axis(
            complex=complex_of(one["complex"]),
            balls=core["balls"],
            ball_contacts=core["contacts"],
            tolerance=core["tolerance"],
            diagonal=core["diagonal"],
            statistics={**shared, "axis": json.loads(one["report"])},
            warnings=warnings,
            boundary=loaded.mesh,
            samples=samples,
            points=loaded.points,
            transform=loaded.transform,
            is_mask=loaded.is_mask,
            name=name,
        )
        for one in core["axes"]
    ]


def _run(loaded: LoadedSolid, options: dict[str, Any], threads: int, tell: Tell | None) -> dict[str, Any]:
    source: _core.CoreSolid | dict[str, Any]
    if loaded.samples is not None:
        source = core_of_samples(loaded.samples)
    else:
        assert loaded.solid is not None  # it has one of the two
        source = loaded.solid._core
    return _core.scale_axis(source, options, threads, tell)


def is_one(scale: Any) -> bool:
    """Is it one scale, which has one axis and not a list of them?"""
    return scale is None or np.ndim(scale) == 0


def axis_options(delta: Any, scale: Any, given: AxisOptions) -> dict[str, Any]:
    """The options of `axis` under their names in C++."""
    options = {**dict.fromkeys(AxisOptions.__annotations__), **DEFAULTS, **given}

    def length(name: str) -> Length:
        return length_of(options[name], options[name.removesuffix("_") + "_abs"], name)

    default_scale = DEFAULT_SCALE if options["method"] == "scale" else 1.0  # the local methods grow nothing
    precision, vertices = length("error"), options["vertices"]
    return {
        "delta": length_of(None if delta == "auto" else delta, options["delta_abs"], "delta"),
        "delta_range": _delta_range(delta, options["delta_range"]),
        "union_kind": options["union"],
        "method": options["method"],
        "scales": _arrays.scales(default_scale if scale is None else scale),
        "filter_angle": options["angle"],
        "lambda": length("lambda_"),
        "reaches_sharp_edges": options["sharp"],
        "sharp_angle": options["sharp_angle"],
        "cleaning": length("clean"),
        "compact": (precision, vertices) if options["compact"] or precision or vertices is not None else None,
        "is_dense": options["dense"],
        "smoothing_rounds": options["smooth"],
        "is_centered": options["center"],
        "sizing": options["sampling"],
        "keeps_samples": options["keep_samples"],
        "seed": options["seed"],
    }


def inputs_of(options: Mapping[str, Any]) -> InputOptions:
    """Those that say what the input means."""
    return cast(InputOptions, {name: options[name] for name in InputOptions.__annotations__ if name in options})


def refuse_beside_axis(options: Mapping[str, Any]) -> None:
    """Raises InvalidOption for options of what is there already."""
    given = [name for name, value in options.items() if value is not None]
    if given:
        hint = "; the distance of nodes is node_spacing" if "spacing" in given else ""
        raise InvalidOption(f"{', '.join(given)} has no effect on an axis, which is there already: leave it out{hint}")


_OF_SAMPLING = ("delta_abs", "delta_range", "sampling")


def _without_unused(loaded: LoadedSolid, delta: Any, options: AxisOptions) -> tuple[LoadedSolid, AxisOptions]:
    """As the program has it: where points turn out to be the samples themselves, options of the sampling do nothing, with
    a warning; where this was asked for they are refused.
    """
    given = {"delta": delta, **{name: options.get(name) for name in _OF_SAMPLING}}
    unused = " and ".join(name for name, value in given.items() if value not in (None, DEFAULTS.get(name)))
    if loaded.kind != "points" or loaded.samples is None or not unused:
        return loaded, options
    if options.get("points") is not None:
        raise InvalidOption(f'{unused} has no effect with points="crust": leave it out, or take points="mls"')
    warning = Warning(
        f'{unused} had no effect: the points are so clean that they are the samples; points="mls" obeys it',
        "points.unused_options",
    )
    rest = {name: value for name, value in options.items() if name not in _OF_SAMPLING}
    return replace(loaded, warnings=[*loaded.warnings, warning]), cast(AxisOptions, rest)


def computed(
    solid: Any, delta: Any, scale: Any, options: Mapping[str, Any], threads: int, tell: Tell | None
) -> tuple[list[Axis], LoadedSolid]:
    """The axes of a solid, one for each scale, and what it was loaded as; without the warnings."""
    given = cast(AxisOptions, options)
    chosen = axis_options(delta, scale, given)
    finest = _core.finest_delta(chosen)
    loaded = load_with(solid, inputs_of(options), threads, part_of(tell, 0.0, _LOADING), finest)
    loaded, used = _without_unused(loaded, delta, given)
    if used is not given:
        chosen = axis_options(None, scale, used)
    core = _run(loaded, chosen, threads, part_of(tell, _LOADING, 1.0))
    return axes_of(core, loaded, name_of(solid)), loaded


@overload
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: float = ...,
    *,
    threads: int = ...,
    progress: Progress = ...,
    **options: Unpack[AxisOptions],
) -> Axis: ...
@overload
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: Sequence[float] | npt.NDArray[Any] = ...,
    *,
    threads: int = ...,
    progress: Progress = ...,
    **options: Unpack[AxisOptions],
) -> list[Axis]: ...
@checked(defaults=DEFAULTS)
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = None,
    scale: float | Sequence[float] | npt.NDArray[Any] | None = None,
    *,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[AxisOptions],
) -> Axis | list[Axis]:
    """The discrete scale axis of a solid. Options are those of the program `scaleaxis axis`.

    solid: a path; (vertices, faces); a mesh or points of trimesh or PyVista; voxels, an array of three dimensions; an
        image of nibabel or SimpleITK; points, N × 3; balls, N × 4; a function f(points: N × 3) → N, negative inside,
        with `bounds`; a `Solid`, `Samples` of its boundary; any result of this package that has a mesh or balls.
    delta, delta_abs: tolerance of the sampling, relative to the diagonal of the solid's bounding box (default 0.01), or
        as a length. Half of it means two to three times the balls, and the time; with uniform sampling four times.
        "auto": the coarsest of `delta_range` at which the balls have the topology of the solid and no sample is farther
        than δ from them; `statistics["delta_choice"]` tells what was tried.
    delta_range: the coarsest and the finest δ that "auto" tries; default `DEFAULT_DELTA_RANGE`.
    scale: factor s, default 1.1. At 1 every feature keeps its branch, at 1.05 to 1.2 noise and small bumps lose theirs,
        at 1.5 only the main parts remain. Several share one sampling; the result is then a list.
    angle: object angle in degrees below which sheets are removed where that keeps the topology; default 30; 0: none.
    method, lambda_, lambda_abs: "angle" and "lambda" are local methods for comparison.
    sharp, sharp_angle: whether sheets end on convex sharp edges of the solid, and seams in its corners, in balls of
        radius 0; least angle between the normals on both sides of such an edge, degrees, default twice that of the
        filter and a degree.
    clean, clean_abs: erosion thickness below which parts are removed (teeth, crumbs and hairs; thin limbs become curves),
        relative to the diagonal of the solid's bounding box, or as a length; default half of δ; 0: nothing.
    compact: whether to simplify the axis to a mesh of few vertices, between which balls are interpolated: see `simplify`.
    error, error_abs, vertices: ask for it, too: how far balls before and after may stick out of each other, relative to
        the diagonal of the solid's bounding box or as a length, default a quarter of δ; the number at which to stop.
    union: "fitted" (the default where it can be) or "polar".
    dense: samples the axis until its balls overlap well.
    smooth: rounds of smoothing along the boundaries of sheets and along curves; default 40, 0 where nothing is cleaned.
    center: whether the balls of the axis are made to touch the solid.
    sampling: how far apart samples are: "adaptive": as far as the solid lets them, so that the balls stay within half
        of δ; "uniform": δ, as in the paper.
    keep_samples: whether the result has the samples.
    seed: of the random choices.
    threads: 0: all that the machine has. The result does not depend on it.
    progress: True for a bar of tqdm, or a function (stage, fraction), which cancels by returning False.

    The rest says what the input means, see `InputOptions`. Files: as what they hold, `kind`, and `objects`. Meshes:
        `triangles`, what they make solid: "winding" (what they wind around, holes closed), "wrap" (what a ball of
        diameter `opening` cannot reach from outside) or "thicken" (what is within half of `thickness`), "auto" by
        default. Points: `normals`, N × 3; `points`: "mls" or "crust"; `kernel`. Voxels: `spacing`, `origin`,
        `direction` (one column for each index); what is solid: `iso` (with `below`), `labels`, or `nonzero`, none of
        them for masks; `mask_smoothing`, `fill_voids`. Functions: `bounds`, 2 × 3; `smallest_feature`; `clip` closes the solid at
        the bounds.

    Raises InvalidOption, UnusableInput, FileError, InconsistentResult, Cancelled.
    """
    with telling(progress) as tell:
        axes, _ = computed(solid, delta, scale, options, threads, tell)
    warn(axes[0].warnings)
    return axes[0] if is_one(scale) else axes
