# SPDX-License-Identifier: Apache-2.0
"""Midsurfaces."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from . import _core
from ._options import checked
from ._progress import Progress, part_of, telling
from .adapt import adapted
from .data import MedialComplex, core_of
from .errors import warn
from .pipeline import SamplingOptions, computed, refuse_beside_axis
from .result import Axis, Midsurface, midsurface_of

if TYPE_CHECKING:
    from typing_extensions import Unpack


@checked
def midsurface(
    solid: Any,
    *,
    angle: float = 64.0,
    extend: bool = True,
    delta: float | Literal["auto"] | None = None,
    scale: float | None = None,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[SamplingOptions],
) -> Midsurface:
    """What lies between opposite sides of a solid of walls, as triangles with thickness; empty where there are no walls.

    solid: anything that `axis` takes; an `Axis` or a `MedialComplex`, whose envelope stands for the solid.
    angle: least object angle of what counts as a wall, in degrees, (0, 90]: half the angle between its contacts.
    extend: whether the surface goes on from its border to the surface of the solid.
    delta, scale, options: as those of `axis`, and of inputs. Of an axis they are refused.
    """
    if isinstance(solid, Axis):
        refuse_beside_axis({**options, "delta": delta, "scale": scale})
        return solid.midsurface(angle=angle, extend=extend, threads=threads, progress=progress)
    known = adapted(solid)
    if isinstance(known, MedialComplex):
        refuse_beside_axis({**options, "delta": delta, "scale": scale})
        with telling(progress) as tell:
            core = _core.midsurface(core_of(known), None, angle, extend, threads, tell)
        return midsurface_of(core, None, partial(_core.shells, core_of(known), None, angle))
    with telling(progress) as tell:
        (axis,), loaded = computed(solid, delta, scale, {**options}, threads, part_of(tell, 0.0, 0.9))
        shape = None if loaded.solid is None else loaded.solid._core
        core = _core.midsurface(core_of(axis.complex), shape, angle, extend, threads, part_of(tell, 0.9, 1.0))
    warn(axis.warnings)
    return midsurface_of(core, axis, partial(_core.shells, core_of(axis.complex), shape, angle))
