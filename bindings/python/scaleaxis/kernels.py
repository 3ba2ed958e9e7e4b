# SPDX-License-Identifier: Apache-2.0
"""The kernels beneath the stages, for themselves: Delaunay triangulations and nearest points."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import checked
from .adapt import as_mesh


class Delaunay(NamedTuple):
    """The tetrahedra of a triangulation; `tetrahedra, neighbors = delaunay(points)` takes it apart."""

    tetrahedra: Ints  #: T × 4: points, positively oriented: det[b - a, c - a, d - a] > 0
    neighbors: Ints  #: T × 4: [t, k] is the tetrahedron opposite to corner k; -1 beyond the convex hull


@checked
def delaunay(points: npt.ArrayLike, weights: npt.ArrayLike | None = None, *, threads: int = 0) -> Delaunay:
    """The Delaunay triangulation of N × 3 points; with weights the regular one (weighted Delaunay, the dual of the
    power diagram). It fills the convex hull.

    points: with coordinates of at most 1e60.
    weights: N numbers of any sign, as the squared radii of balls.

    All signs are exact, and ties (cospherical points) are broken by a symbolic perturbation: no tetrahedron is flat, no
    sphere has a point inside, and the arrays are the same on any number of threads. In each tetrahedron the smallest
    index comes first, then the second smallest; rows ascend by their sorted indices.

    A point that is in no tetrahedron is hidden: one at the place of another (the heaviest is kept, then the first), one
    whose weight is too small for a power cell of its own, and all points if they are coplanar. They are
    `np.setdiff1d(np.arange(len(points)), tetrahedra)`.

    Raises ValueError if a number is not finite or too large, or the shapes do not fit; UnusableInput beyond 500 million
    tetrahedra, about 80 million points.
    """
    given = _arrays.points(points)
    known = np.empty(0) if weights is None else _arrays.scalars(weights, "weights", len(given))
    return Delaunay(*_core.delaunay(given, known, threads))


class NearestPoints(NamedTuple):
    """What of a mesh is nearest to N points; `_, distances, _ = nearest(mesh, points)` takes it apart."""

    points: Floats  #: N × 3: of the mesh
    distances: Floats  #: N
    triangles: Ints  #: N: the triangle that each lies on


@checked
def nearest(mesh: Any, points: npt.ArrayLike, *, threads: int = 0) -> NearestPoints:
    """The point of a mesh that is nearest to each of N × 3 points, exact to rounding.

    mesh: in any form, or a file; it may be open, intersect itself, or have triangles without area. Triangles are
        numbered as in the mesh; polygons are cut into triangles first.

    Where several triangles are equally near, as at edges and vertices, it is always the same one of them. Raises
    ValueError if a point is not finite or the mesh is empty.
    """
    return NearestPoints(*_core.nearest(*as_mesh(mesh), _arrays.points(points), threads))
