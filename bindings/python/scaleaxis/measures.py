# SPDX-License-Identifier: Apache-2.0
"""What is measured by an axis: thickness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import Length, Number, Share, checked
from ._progress import Progress, telling
from .adapt import adapted, as_complex, as_image, as_mesh, core_of_image, is_path
from .data import Image, Mesh, core_of, image_of
from .errors import Warning, warn, warnings_of
from .files import Path
from .page import AxisLike, Page, boundary_of, page_path, viewed_axis, write_page


@dataclass(frozen=True, eq=False, repr=False)
class Thickness:
    """Thickness at N points of a surface, in the units of the axis."""

    local: Floats  #: N: local thickness, the diameter of the largest ball in the solid that contains the point
    foot: Floats  #: N: diameter of the ball that touches the surface there
    balls: Floats  #: N × 4: centre and radius of the ball of `local`
    surface: Mesh | None = None  #: of a mesh: the points are its vertices

    @checked
    def thin_regions(self, limit: Length) -> ThinRegions:
        """The connected pieces of the surface that are thinner than a limit."""
        return thin_regions(*self._mesh(None, None), self.local, limit)

    def _mesh(self, vertices: Any, triangles: Any) -> tuple[Floats, Ints]:
        if vertices is None and self.surface is None:
            raise ValueError("thickness was asked at points: vertices and triangles of the surface are needed")
        return self.surface if vertices is None and self.surface else as_mesh(vertices, triangles)

    @checked
    def view(
        self,
        vertices: Any = None,
        triangles: npt.ArrayLike | None = None,
        path: Path | None = None,
        *,
        limit: Length | None = None,
        axis: AxisLike | None = None,
        name: str = "thickness",
    ) -> Page:
        """A page with the surface in the colours of its thickness: see `Axis.view`.

        vertices, triangles: V × 3, the points, in their order; F × 3; default: `surface`.
        limit: below which connected pieces of the surface get a border.
        axis: shown in the surface.
        """
        path = page_path(path, name)
        shape = self._mesh(vertices, triangles)
        local, foot = (_arrays.scalars(values, "thickness", len(shape[0])) for values in (self.local, self.foot))
        regions = np.empty(0, dtype=np.int32) if limit is None else thin_regions(*shape, local, limit).vertex_regions
        axes = [] if axis is None else [viewed_axis(core_of(axis.complex))]
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


@checked
def thickness(
    axis: Any,
    points: Any = None,
    *,
    angle: float = 128.0,
    edge: Share = 0.01,
    threads: int = 0,
    progress: Progress = None,
) -> Thickness:
    """Local thickness (Hildebrand and Rüegsegger 1997) and thickness at the foot point, at points of the surface.

    axis: an `Axis` or a `MedialComplex`, or a file with one.
    points: N × 3, near the boundary of the solid; or a mesh of the boundary in any form, whose vertices are asked for
        once its edges are short; default: the mesh of the input of an `Axis`, or else of its balls. Of points alone
        the solid is not known, and some near corners may read as thin.
    edge: of a mesh: length that no edge exceeds, relative to the diagonal; 0: the mesh stays as it is.
    angle: least angle in degrees, [0, 180), between two contacts of a ball, seen from its centre, for which it counts:
        balls in edges see less, so that these do not read as thin. 0: all balls count.

    Of an axis of a mask a warning tells where voxels do not resolve the thickness of the surface.
    """
    known = adapted(boundary_of(axis) if points is None and isinstance(axis, AxisLike) else points)
    surface = None
    if isinstance(known, Mesh) or is_path(known):
        surface = Mesh(*as_mesh(known))
        if edge > 0.0:
            surface = with_short_edges(surface, edge * float(np.linalg.norm(np.ptp(surface.vertices, axis=0))))
    with telling(progress) as tell:
        shape = surface or (_arrays.points(known), np.empty((0, 3), dtype=np.int32))
        core = _core.thickness(core_of(as_complex(axis)), *shape, angle, threads, tell)
    if surface is not None and isinstance(axis, AxisLike) and axis.is_mask:
        steps = np.ascontiguousarray(axis.transform[:, :3].T)
        warn(warnings_of(_core.unresolved_thickness(*surface, core["local"], steps)))
    return Thickness(**core, surface=surface)


@checked
def thickness_image(
    axis: Any, mask: Any, *, angle: float = 128.0, threads: int = 0, progress: Progress = None
) -> Image:
    """Local thickness at the points of a grid.

    axis: as for `thickness`.
    mask: an image in any form, other than 0 at the points in the solid; elsewhere the result is 0.
    angle: as for `thickness`.
    """
    image = as_image(mask)
    with telling(progress) as tell:
        core = _core.thickness_image(core_of(as_complex(axis)), *core_of_image(image), angle, threads, tell)
    found = image_of(core)
    return Image(found.values, found.origin, found.steps, image.unit, image.space)


@checked
def with_short_edges(mesh: Any, length: float) -> Mesh:
    """The same surface with no edge longer than a length: edges are halved as often as it takes. The vertices given
    come first. For `thickness` and `thin_regions` of meshes with long edges, as those of CAD: a hundredth of the
    diagonal is enough.
    """
    return Mesh(**_core.with_short_edges(*as_mesh(mesh), length))


# Beyond it values between vertices are guesses: twice what the program divides edges to before it asks for thickness.
_LONG_EDGE = 0.02  # of the diagonal
_MOST_GUESSED = 0.1  # of the area of thin regions; where edges are short it is 0


def _warn_of_long_edges(vertices: Floats, triangles: Ints, values: Floats, limit: float, area: float) -> None:
    is_below = (values < limit)[triangles]
    cut = triangles[is_below.any(axis=1) & ~is_below.all(axis=1)]
    a, b, c = (vertices[cut[:, k]] for k in range(3))
    longest = np.max([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0, initial=0.0)
    is_long = longest > _LONG_EDGE * np.linalg.norm(np.ptp(vertices, axis=0))
    if np.linalg.norm(np.cross(b - a, c - a)[is_long], axis=1).sum() / 2 > _MOST_GUESSED * area:
        advice = "ask for the thickness of the mesh, whose edges are then divided, or divide them by with_short_edges"
        warn([Warning(f"long edges make the area uncertain: {advice}", "surface.long_edges")])


@checked
def thin_regions(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, values: npt.ArrayLike, limit: Number
) -> ThinRegions:
    """The connected pieces of a surface where values at its vertices, as thickness, are below a limit.

    vertices: V × 3.
    triangles: F × 3; in them values are linear, so that edges should be short: see `with_short_edges`.
    values: V.
    """
    given = _arrays.mesh(vertices, triangles)
    known = _arrays.scalars(values, "values", len(given[0]))
    found = ThinRegions(**_core.thin_regions(*given, known, limit))
    _warn_of_long_edges(*given, known, limit, float(found.areas.sum()))
    return found
