# SPDX-License-Identifier: Apache-2.0
"""What is measured by an axis: thickness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._progress import Progress, telling
from .data import Image, core_of, core_of_image, image_of
from .files import Path
from .page import Page, page_path, viewed_axis, write_page

if TYPE_CHECKING:
    from .result import Axis


@dataclass(frozen=True, eq=False, repr=False)
class Thickness:
    """Thickness at N points of a surface, in the units of the axis."""

    local: Floats  #: N: local thickness, the diameter of the largest ball in the solid that contains the point
    foot: Floats  #: N: diameter of the ball that touches the surface there
    balls: Floats  #: N × 4: centre and radius of the ball of `local`

    def view(
        self,
        vertices: npt.ArrayLike,
        triangles: npt.ArrayLike,
        path: Path | None = None,
        *,
        limit: float | None = None,
        axis: Axis | None = None,
        name: str = "thickness",
    ) -> Page:
        """A page with the surface in the colours of its thickness: see `Axis.view`.

        vertices, triangles: V × 3, the points, in their order; F × 3.
        limit: below which connected pieces of the surface get a border.
        axis: shown in the surface.
        """
        path = page_path(path, name)
        shape = _arrays.mesh(vertices, triangles)
        local, foot = (_arrays.scalars(values, "thickness", len(shape[0])) for values in (self.local, self.foot))
        regions = np.empty(0, dtype=np.int32) if limit is None else thin_regions(*shape, local, limit).vertex_regions
        axes = [] if axis is None else [viewed_axis(core_of(axis.complex), axis.scale)]
        model = _core.view_data(name, *shape, axes, "", (local, foot, regions, limit))
        return write_page(path, name, [model])

    def __repr__(self) -> str:
        return f"Thickness({len(self.local):,} points)"


@dataclass(frozen=True, eq=False, repr=False)
class ThinRegions:
    """Connected pieces of a surface, N, where values are below a limit; the one with the least value comes first."""

    areas: Floats  #: N
    minima: Floats  #: N: the least value
    minimum_vertices: Ints  #: N: where that is
    vertex_regions: Ints  #: V: the piece of each vertex; -1 where the value is not below the limit

    def __repr__(self) -> str:
        return f"ThinRegions({len(self.areas):,} regions)"


def thickness(
    axis: Any, points: npt.ArrayLike, *, angle: float = 120.0, threads: int = 0, progress: Progress = None
) -> Thickness:
    """Local thickness (Hildebrand and Rüegsegger 1997) and thickness at the foot point, at points of the surface.

    axis: an `Axis` or a `MedialComplex`.
    points: N × 3, near the boundary of the solid.
    angle: least angle in degrees, [0, 180), between two contacts of a ball, seen from its centre, for which it counts:
        balls in edges see less, so that these do not read as thin. 0: all balls count.
    """
    with telling(progress) as tell:
        core = _core.thickness(
            core_of(getattr(axis, "complex", axis)), _arrays.points(points), angle, threads, tell
        )
    return Thickness(**core)


def thickness_image(
    axis: Any, mask: Image, *, angle: float = 120.0, threads: int = 0, progress: Progress = None
) -> Image:
    """Local thickness at the points of a grid.

    axis: an `Axis` or a `MedialComplex`.
    mask: other than 0 at the points in the solid; elsewhere the result is 0.
    angle: as for `thickness`.
    """
    with telling(progress) as tell:
        core = _core.thickness_image(
            core_of(getattr(axis, "complex", axis)), *core_of_image(mask), angle, threads, tell
        )
    return replace(image_of(core), unit=mask.unit, space=mask.space)


def thin_regions(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, values: npt.ArrayLike, limit: float
) -> ThinRegions:
    """The connected pieces of a surface where values at its vertices, as thickness, are below a limit.

    vertices: V × 3.
    triangles: F × 3.
    values: V.
    """
    given = _arrays.mesh(vertices, triangles)
    return ThinRegions(**_core.thin_regions(*given, _arrays.scalars(values, "values", len(given[0])), limit))
