# SPDX-License-Identifier: Apache-2.0
"""Midsurfaces."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from . import _core
from ._arrays import Floats, Ints
from ._progress import Progress, part_of, telling
from .data import MedialComplex, Mesh, complex_of, core_of
from .errors import warn
from .files import Path, write_axis, write_mesh
from .loading import load_with
from .pipeline import axis as axis_of
from .result import Axis


@dataclass(frozen=True, eq=False, repr=False)
class Midsurface:
    """A surface halfway between the sides of walls: sheets that meet in seams, in the units of the axis."""

    vertices: Floats  #: V × 3
    triangles: Ints  #: T × 3; an edge of a seam has three of them or more
    thickness: Floats  #: V: diameter of the ball there
    triangle_sheets: Ints  #: T
    areas: Floats  #: S: of the sheets, the largest first
    means: Floats  #: S: mean thickness over the area
    minima: Floats  #: S: least thickness
    maxima: Floats  #: S: largest thickness
    seams: int  #: chains of edges of three triangles or more
    seam_length: float
    complex: MedialComplex  #: the surface as a medial complex, for all that takes one
    axis: Axis | None = field(default=None)  #: that it was made from; None: from a complex

    def save(self, path: Path) -> None:
        """Writes PLY and VTP with thickness and sheets, OBJ with a group for each sheet, GLB; or STL and OFF."""
        if str(path).lower().endswith((".stl", ".off")):
            write_mesh(path, Mesh(self.vertices, self.triangles))
        else:
            write_axis(path, self.complex, values={"thickness": self.thickness})

    def __repr__(self) -> str:
        return f"Midsurface({len(self.triangles):,} triangles, {len(self.areas):,} sheets, {self.seams:,} seams)"


def midsurface(
    solid: Any,
    *,
    angle: float = 60.0,
    extend: bool = True,
    threads: int = 0,
    progress: Progress = None,
    **options: Any,
) -> Midsurface:
    """What lies between opposite sides of a solid of walls, as triangles with thickness; empty where there are no walls.

    solid: anything that `axis` takes, with `delta`, `scale`, `seed`, `sampling` and the options of loading; an `Axis`
        or a `MedialComplex`, whose envelope stands for the solid.
    angle: least object angle of what counts as a wall, in degrees, (0, 90]: half the angle between its contacts.
    extend: whether the surface goes on from its border to the surface of the solid.
    """
    if isinstance(solid, (MedialComplex, Axis)):
        complex = solid.complex if isinstance(solid, Axis) else solid
        with telling(progress) as tell:
            core = _core.midsurface(core_of(complex), None, angle, extend, threads, tell)
        return _midsurface_of(core, solid if isinstance(solid, Axis) else None)
    pipeline = {name: options.pop(name) for name in list(options) if name in _PIPELINE}
    with telling(progress) as tell:
        loaded = load_with(solid, options, threads, part_of(tell, 0.0, 0.1))  # type: ignore[arg-type]
        given = loaded.solid if loaded.solid is not None else loaded.samples
        axis = axis_of(given, threads=threads, progress=part_of(tell, 0.1, 0.9), **pipeline)
        core_solid = None if loaded.solid is None else loaded.solid._core
        rest = part_of(tell, 0.9, 1.0)
        core = _core.midsurface(core_of(axis.complex), core_solid, angle, extend, threads, rest)
    warn(loaded.warnings)
    return _midsurface_of(core, axis)


def _midsurface_of(core: dict[str, Any], axis: Axis | None) -> Midsurface:
    rest = {name: value for name, value in core.items() if name != "complex"}
    return Midsurface(complex=complex_of(core["complex"]), axis=axis, **rest)


_PIPELINE = ("delta", "delta_abs", "delta_range", "scale", "sampling", "seed")

__all__ = ["Midsurface", "midsurface"]
