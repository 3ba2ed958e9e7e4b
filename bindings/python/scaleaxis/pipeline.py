# SPDX-License-Identifier: Apache-2.0
"""The whole pipeline in one call."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path as _Path
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy.typing as npt

from . import _arrays, _core
from ._progress import Progress, Tell, part_of, telling
from .data import Samples, Topology, complex_of, core_of_samples
from .errors import InvalidOption, warn, warnings_of
from .loading import InputOptions, Length, LoadedSolid, load_with
from .result import Axis
from .solids import Solid
from .stages import Sizing, UnionKind, samples_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

Method = Literal["scale", "angle", "lambda"]

DEFAULT_DELTA_RANGE: tuple[float, float] = _core.default_delta_range
"""The coarsest and the finest δ that `delta="auto"` tries."""

_LOADING = 0.15  # its share of the progress


def _length(relative: float | None, absolute: float | None, name: str) -> Length:
    if relative is not None and absolute is not None:
        raise InvalidOption(f"{name} and {name}_abs are the same option: leave one of them out", "option")
    if absolute is not None:
        return absolute, True
    return None if relative is None else (relative, False)


def _delta_range(delta: Any, given: tuple[float, float] | None) -> tuple[float, float] | None:
    if delta == "auto":
        return DEFAULT_DELTA_RANGE if given is None else given
    if given is not None:
        raise InvalidOption('delta_range has no effect without delta="auto": leave it out', "option")
    return None


def name_of(given: Any) -> str:
    return _Path(given).stem if isinstance(given, (str, os.PathLike)) else "solid"


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
            scale=one["scale"],
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
    return scale is None or not hasattr(scale, "__len__")


def axis_options(
    delta: float | Literal["auto"] | None = None,
    scale: float | Sequence[float] | npt.NDArray[Any] | None = None,
    *,
    delta_abs: float | None = None,
    delta_range: tuple[float, float] | None = None,
    angle: float | None = None,
    method: Method = "scale",
    lambda_: float | None = None,
    lambda_abs: float | None = None,
    sharp: bool = True,
    sharp_angle: float | None = None,
    clean: float | None = None,
    clean_abs: float | None = None,
    compact: bool = False,
    error: float | None = None,
    error_abs: float | None = None,
    vertices: int | None = None,
    union: UnionKind | None = None,
    dense: bool = False,
    smooth: int | None = None,
    center: bool = True,
    sampling: Sizing = "adaptive",
    keep_samples: bool = False,
    seed: int = 1,
) -> dict[str, Any]:
    """The options of `axis` under their names in C++."""
    default_scale = 1.1 if method == "scale" else 1.0  # the local methods grow nothing
    precision = _length(error, error_abs, "error")
    return {
        "delta": _length(None if delta == "auto" else delta, delta_abs, "delta"),
        "delta_range": _delta_range(delta, delta_range),
        "union_kind": union,
        "method": method,
        "scales": _arrays.scales(default_scale if scale is None else scale),
        "filter_angle": angle,
        "lambda": _length(lambda_, lambda_abs, "lambda"),
        "reaches_sharp_edges": sharp,
        "sharp_angle": sharp_angle,
        "cleaning": _length(clean, clean_abs, "clean"),
        "compact": (precision, vertices) if compact or precision or vertices is not None else None,
        "is_dense": dense,
        "smoothing_rounds": smooth,
        "is_centered": center,
        "sizing": sampling,
        "keeps_samples": keep_samples,
        "seed": seed,
    }


@overload
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: float = ...,
    *,
    delta_abs: float | None = ...,
    delta_range: tuple[float, float] | None = ...,
    angle: float | None = ...,
    method: Method = ...,
    lambda_: float | None = ...,
    lambda_abs: float | None = ...,
    sharp: bool = ...,
    sharp_angle: float | None = ...,
    clean: float | None = ...,
    clean_abs: float | None = ...,
    compact: bool = ...,
    error: float | None = ...,
    error_abs: float | None = ...,
    vertices: int | None = ...,
    union: UnionKind | None = ...,
    dense: bool = ...,
    smooth: int | None = ...,
    center: bool = ...,
    sampling: Sizing = ...,
    keep_samples: bool = ...,
    seed: int = ...,
    threads: int = ...,
    progress: Progress = ...,
    **inputs: Unpack[InputOptions],
) -> Axis: ...
@overload
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = ...,
    scale: Sequence[float] | npt.NDArray[Any] = ...,
    *,
    delta_abs: float | None = ...,
    delta_range: tuple[float, float] | None = ...,
    angle: float | None = ...,
    method: Method = ...,
    lambda_: float | None = ...,
    lambda_abs: float | None = ...,
    sharp: bool = ...,
    sharp_angle: float | None = ...,
    clean: float | None = ...,
    clean_abs: float | None = ...,
    compact: bool = ...,
    error: float | None = ...,
    error_abs: float | None = ...,
    vertices: int | None = ...,
    union: UnionKind | None = ...,
    dense: bool = ...,
    smooth: int | None = ...,
    center: bool = ...,
    sampling: Sizing = ...,
    keep_samples: bool = ...,
    seed: int = ...,
    threads: int = ...,
    progress: Progress = ...,
    **inputs: Unpack[InputOptions],
) -> list[Axis]: ...
def axis(
    solid: Any,
    delta: float | Literal["auto"] | None = None,
    scale: float | Sequence[float] | npt.NDArray[Any] | None = None,
    *,
    delta_abs: float | None = None,
    delta_range: tuple[float, float] | None = None,
    angle: float | None = None,
    method: Method = "scale",
    lambda_: float | None = None,
    lambda_abs: float | None = None,
    sharp: bool = True,
    sharp_angle: float | None = None,
    clean: float | None = None,
    clean_abs: float | None = None,
    compact: bool = False,
    error: float | None = None,
    error_abs: float | None = None,
    vertices: int | None = None,
    union: UnionKind | None = None,
    dense: bool = False,
    smooth: int | None = None,
    center: bool = True,
    sampling: Sizing = "adaptive",
    keep_samples: bool = False,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
    **inputs: Unpack[InputOptions],
) -> Axis | list[Axis]:
    """The discrete scale axis of a solid. Options are those of the program `scaleaxis axis`.

    solid: a path; (vertices, faces); a mesh of trimesh or PyVista; voxels, an array of three dimensions; an image of
        nibabel or SimpleITK; points, N × 3; balls, N × 4; a function f(points: N × 3) → N, negative inside, with
        `bounds`; a `Solid`, or `Samples` of its boundary.
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
        radius 0; least angle between the normals on both sides of such an edge, degrees, default 30.
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
    threads: 0: all that the machine has. The result does not depend on it.
    progress: True for a bar of tqdm, or a function (stage, fraction), which cancels by returning False.

    inputs: what the input means, see `InputOptions`. Files: as what they hold, and `kind`. Meshes: `triangles`, what they
        make solid: "winding" (what they wind around, holes closed), "wrap" (what a ball of diameter `opening` cannot
        reach from outside) or "thicken" (what is within half of `thickness`), "auto" by default. Points: `normals`,
        N × 3; `points`: "mls" or "crust"; `kernel`. Voxels: `spacing`, `origin`, `direction` (one column for each
        index); what is solid: `iso` (with `below`), `labels`, or `nonzero`, none of them for masks; `mask_smoothing`.
        Functions: `bounds`, 2 × 3; `smallest_feature`; `clip` closes the solid at the bounds.

    Raises InvalidOption, UnusableInput, FileError, InconsistentResult, Cancelled.
    """
    options = axis_options(
        delta,
        scale,
        delta_abs=delta_abs,
        delta_range=delta_range,
        angle=angle,
        method=method,
        lambda_=lambda_,
        lambda_abs=lambda_abs,
        sharp=sharp,
        sharp_angle=sharp_angle,
        clean=clean,
        clean_abs=clean_abs,
        compact=compact,
        error=error,
        error_abs=error_abs,
        vertices=vertices,
        union=union,
        dense=dense,
        smooth=smooth,
        center=center,
        sampling=sampling,
        keep_samples=keep_samples,
        seed=seed,
    )
    given = getattr(solid, "complex", solid) if isinstance(solid, Axis) else solid
    with telling(progress) as tell:
        finest = _core.finest_delta(options)
        loaded = load_with(given, inputs, threads, part_of(tell, 0.0, _LOADING), finest)
        core = _run(loaded, options, threads, part_of(tell, _LOADING, 1.0))
    axes = axes_of(core, loaded, name_of(solid))
    warn(axes[0].warnings)
    return axes[0] if is_one(scale) else axes


def scale_axis(
    solid: Solid | Samples,
    *,
    delta: float | Literal["auto"] | None = None,
    delta_abs: float | None = None,
    delta_range: tuple[float, float] | None = None,
    union_kind: UnionKind | None = None,
    method: Method = "scale",
    scales: Sequence[float] = (1.1,),
    filter_angle: float | None = None,
    lambda_: float | None = None,
    lambda_abs: float | None = None,
    reaches_sharp_edges: bool = True,
    sharp_angle: float | None = None,
    cleaning: float | None = None,
    cleaning_abs: float | None = None,
    compact: bool = False,
    compact_error: float | None = None,
    compact_error_abs: float | None = None,
    compact_vertices: int | None = None,
    is_dense: bool = False,
    smoothing_rounds: int | None = None,
    is_centered: bool = True,
    sizing: Sizing = "adaptive",
    keeps_samples: bool = False,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> list[Axis]:
    """`axis` of a solid, or of samples of its boundary, with the names that the options have in C++."""
    return axis(
        solid,
        delta,
        list(scales),
        delta_abs=delta_abs,
        delta_range=delta_range,
        union=union_kind,
        method=method,
        angle=filter_angle,
        lambda_=lambda_,
        lambda_abs=lambda_abs,
        sharp=reaches_sharp_edges,
        sharp_angle=sharp_angle,
        clean=cleaning,
        clean_abs=cleaning_abs,
        compact=compact,
        error=compact_error,
        error_abs=compact_error_abs,
        vertices=compact_vertices,
        dense=is_dense,
        smooth=smoothing_rounds,
        center=is_centered,
        sampling=sizing,
        keep_samples=keeps_samples,
        seed=seed,
        threads=threads,
        progress=progress,
    )
