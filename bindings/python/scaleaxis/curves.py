# SPDX-License-Identifier: Apache-2.0
"""Curve skeletons."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from . import _core
from ._arrays import Floats
from ._options import Length, checked
from ._progress import Progress, part_of, telling
from .adapt import adapted
from .data import MedialComplex, core_of
from .errors import InvalidOption, warn
from .pipeline import SamplingOptions, computed, refuse_beside_axis
from .result import Axis, Skeleton, SkeletonRadius, skeleton_of
from .solids import BallUnion
from .stages import scaled

if TYPE_CHECKING:
    from typing_extensions import Unpack


class SkeletonOptions(SamplingOptions, total=False):
    """Those options of `axis` that skeletons have."""

    angle: float | None
    clean: float | None
    clean_abs: float | None
    smooth: int | None


_NODE_SPACING = 0.01  # of the diagonal, where none is given


def _led_to_openings(core: dict[str, Any], axis: Axis, holes: Floats, node_spacing: float | None) -> dict[str, Any]:
    if not len(holes):
        raise InvalidOption(f"to_openings has no effect on {axis.name}, no hole of which was closed: leave it out")
    return _core.led_to_openings(core_of(axis.complex), core, holes, node_spacing or _NODE_SPACING * axis.diagonal)


@checked
def skeleton(
    solid: Any,
    *,
    node_spacing: Length | None = None,
    significance: float = 1.0,
    radius: SkeletonRadius = "inscribed",
    to_openings: bool = False,
    delta: float | Literal["auto"] | None = None,
    scale: float | None = None,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[SkeletonOptions],
) -> Skeleton:
    """The curve skeleton of a solid: its axis with the sheets reduced to curves, of the same homotopy type.

    solid: anything that `axis` takes; an `Axis`, best one with `sharp=False`; or a `MedialComplex`.
    node_spacing: distance of the nodes along branches, at most, as a length; default: a hundredth of the diagonal.
    significance: how far a branch sticks out of the others to stay, relative to its own radius; 0: all of them.
    radius: "inscribed": of the largest ball in the solid around the node; "mean": mean distance to the surface in the
        plane normal to the branch, which noise does not make smaller; only for a solid.
    to_openings: leads curves on to the middles of holes that were closed in a mesh, as of vessels that are cut: by
        themselves they end a radius before. Refused where no hole was closed.
    delta, scale, options: as those of `axis`, and of inputs (`spacing` is that of voxels). Of an axis they are refused.

    Sheets that enclose a void stay, as `faces`. Raises as `axis`.
    """

    values = (node_spacing or 0.0, significance, radius, threads)
    of_solids = {**options, "delta": delta, "scale": scale, "to_openings": to_openings or None}

    if isinstance(solid, Axis):
        refuse_beside_axis(of_solids)
        return solid.skeleton(
            node_spacing=node_spacing, significance=significance, radius=radius, threads=threads, progress=progress
        )
    known = adapted(solid)
    if isinstance(known, MedialComplex):
        refuse_beside_axis(of_solids)
        with telling(progress) as tell:
            return skeleton_of(_core.skeleton(core_of(known), *values, tell))
    with telling(progress) as tell:
        (axis,), loaded = computed(solid, delta, scale, {**options, "sharp": False}, threads, part_of(tell, 0.0, 0.8))
        given = core_of(axis.complex), *values, part_of(tell, 0.8, 1.0)
        if loaded.solid is not None and loaded.solid.knows_nearest:
            core = _core.skeleton_in_solid(given[0], loaded.solid._core, *given[1:])
        else:
            core = _core.skeleton_in_union(given[0], BallUnion(scaled(axis.balls, axis.scale))._core, *given[1:])
        if to_openings:
            core = _led_to_openings(core, axis, loaded.holes, node_spacing)
    warn(axis.warnings)
    return skeleton_of(core, axis)
