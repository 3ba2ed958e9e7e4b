# SPDX-License-Identifier: Apache-2.0
"""Solids: what is inside? Made of meshes, images, functions, points and balls."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import Seed, checked
from ._progress import Progress, telling
from .adapt import as_balls, as_complex, as_mesh, core_of_image
from .data import Mesh, Polygons, Topology, core_of
from .errors import Warning, warnings_of
from .similarity import similarity_of

Function = Callable[[Floats], npt.ArrayLike]
"""f(points: N × 3) → N values, negative inside."""


class Solid:
    """A bounded solid S, which the stages ask where it is. May be asked from several threads at once."""

    __slots__ = ("_core",)

    def __init__(self, core: _core.CoreSolid) -> None:
        """Solids are made by `load`, `mesh_solid`, `image_solid`, `function_solid`, `cloud_solid`, `union_solid`."""
        self._core = core

    @property
    def bounds(self) -> Floats:
        """2 × 3: the least and the largest coordinates."""
        return self._core.bounds()

    @property
    def diagonal(self) -> float:
        """The length of the diagonal of the bounds."""
        return float(np.linalg.norm(np.diff(self.bounds, axis=0)))

    @property
    def knows_nearest(self) -> bool:
        """Does the solid know the points of its boundary that are nearest to given ones?"""
        return self._core.knows_nearest()

    @property
    def batch_size(self) -> int:
        """How many questions a call should hold."""
        return self._core.batch_size()

    @property
    def topology(self) -> Topology | None:
        """Topology of the solid, if it is known."""
        known = self._core.topology()
        return known and Topology(*known)

    @property
    def warnings(self) -> list[Warning]:
        """What was repaired in the input, and what is odd about it."""
        return warnings_of(self._core.warnings())

    def inside(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which of N × 3 points lie in S."""
        return self._core.inside(_arrays.points(points))

    def crossings(
        self, inside_ends: npt.ArrayLike, outside_ends: npt.ArrayLike, references: npt.ArrayLike | None = None
    ) -> Floats:
        """Where N segments leave S, N × 3. Of several crossings the one farthest from the reference (default: from the
        inside end). NaN where there is none, or an even number of them.
        """
        begin = _arrays.points(inside_ends, "inside_ends")
        end = _arrays.points(outside_ends, "outside_ends")
        far = begin if references is None else _arrays.points(references, "references")
        if not len(begin) == len(end) == len(far):
            raise ValueError(f"there must be as many ends as references: {len(begin)}, {len(end)}, {len(far)}")
        return self._core.crossings(begin, end, far)

    def nearest(self, points: npt.ArrayLike, bounds: float | npt.ArrayLike = np.inf) -> Floats:
        """The points of the boundary nearest to N × 3 points; NaN where none is closer than the bounds (one, or N)."""
        asked = _arrays.points(points)
        return self._core.nearest(asked, _arrays.scalars(bounds, "bounds", len(asked), finite=False))

    @checked
    def seeds(self, spacing: float, seed: Seed = 1, *, threads: int = 0) -> Floats:
        """Points of the boundary, dense enough for a Poisson-disk sample of radius `spacing` to be chosen from them."""
        return self._core.seeds(spacing, seed, threads, None)

    def __repr__(self) -> str:
        least, largest = (bound.round(6).tolist() for bound in self.bounds)
        return f"Solid(bounds {least} … {largest})"

    def __reduce__(self) -> Any:
        raise TypeError("a Solid cannot be pickled: pickle what it was made of")


@checked
def mesh_solid(
    vertices: Any, faces: npt.ArrayLike | None = None, *, threads: int = 0, progress: Progress = None
) -> Solid:
    """The solid bounded by a closed triangle mesh, two arrays or one mesh as `axis` takes it: all points of non-zero
    winding number. Repairs the mesh first.
    """
    with telling(progress) as tell:
        return Solid(_core.mesh_solid(*as_mesh(vertices, faces), threads, tell))


@checked
def image_solid(
    image: Any,
    iso: float = 0.5,
    is_below: bool = False,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> Solid:
    """The solid where the trilinear interpolant of an image, in any form, lies above the level (or below it)."""
    with telling(progress) as tell:
        return Solid(_core.image_solid(*core_of_image(image), iso, is_below, threads, tell))


def checked_function(function: Function) -> Callable[[Floats], Floats]:
    """The function with its answers as the C++ part takes them."""

    def values(points: Floats) -> Floats:
        answer = np.asarray(function(points))
        if answer.shape != (len(points),):
            raise ValueError(
                f"the function must return one value for each of {len(points)} points, "
                f"but the shape of its answer is {answer.shape}"
            )
        return _arrays.floats(answer, "what the function returns", (), finite=False)

    return values


@checked
def function_solid(
    function: Function,
    bounds: npt.ArrayLike,
    smallest_feature: float = 0.0,
    clip: bool = False,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> Solid:
    """The solid where f(points: N × 3) → N is negative. It is called from one thread at a time, though not always the
    same. `bounds`: 2 × 3, a box in which the solid ends. `smallest_feature`: the diameter of parts that are found
    for sure (default: 1/128 of the diagonal). `clip`: closes the solid where the bounds cut it.
    """
    if not callable(function):
        raise TypeError(f"a function is needed, not {type(function).__name__}")
    with telling(progress) as tell:
        asked = checked_function(function)
        return Solid(_core.function_solid(asked, _arrays.box(bounds), smallest_feature, clip, threads, tell))


def cloud(points: npt.ArrayLike, normals: npt.ArrayLike | None) -> tuple[Floats, Floats]:
    """Points and as many normals, or none."""
    # Neither needs to be finite: such points are left out, such normals count as unknown.
    places = _arrays.points(points, empty=False, finite=False)
    known = np.empty((0, 3)) if normals is None else _arrays.floats(normals, "normals", (3,), finite=False)
    if normals is not None and len(known) != len(places):
        raise ValueError(f"there are {len(known)} normals for {len(places)} points")
    return places, known


@checked
def cloud_solid(
    points: npt.ArrayLike,
    normals: npt.ArrayLike | None = None,
    kernel: float | None = None,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> Solid:
    """The solid behind the surface that moving least squares put through the points. Estimates normals where there are
    none. `kernel`: radius of the weights' support, in spacings of the points.
    """
    with telling(progress) as tell:
        return Solid(_core.cloud_solid(*cloud(points, normals), kernel, threads, tell))


@checked
def union_solid(balls: Any, *, threads: int = 0, progress: Progress = None) -> Solid:
    """A union of balls (N × 4: centre, radius) as a solid that can be sampled."""
    with telling(progress) as tell:
        return Solid(_core.union_solid(as_balls(balls), threads, tell))


class Envelope:
    """The union of the balls all over a medial mesh, interpolated linearly along its edges and in its triangles. For
    `mesh`, `compare` and `sample_field`, too. May be used from several threads at once."""

    __slots__ = ("_complex", "_core")

    @checked
    def __init__(self, axis: Any) -> None:
        """axis: an `Axis` or a `MedialComplex`."""
        self._complex = as_complex(axis)
        self._core = _core.CoreEnvelope(core_of(self._complex))

    @property
    def bounds(self) -> Floats:
        """2 × 3: the box around the balls."""
        return self._core.bounds()

    @property
    def topology(self) -> Topology:
        """Topology of the medial mesh: that of the envelope, too, unless balls meet where the mesh does not."""
        return Topology(*self._core.topology())

    @checked
    def signed_distances(self, points: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """For each point the least signed distance to a ball: negative inside, 0 on the boundary."""
        return self._core.signed_distances(_arrays.points(points), threads, None)

    @checked
    def inside(self, points: npt.ArrayLike, *, threads: int = 0) -> npt.NDArray[np.bool_]:
        """Does each point lie in the envelope or on its boundary?"""
        return self._core.inside(_arrays.points(points), threads, None)

    def __reduce__(self) -> Any:
        return Envelope, (self._complex,)


class BallUnion:
    """A union of balls that keeps what several stages need of it. May be used from several threads at once."""

    __slots__ = ("_core",)

    def __init__(self, balls: Any) -> None:
        """balls: N × 4, centre and radius; those of a file, axis or other result."""
        self._core = balls if isinstance(balls, _core.CoreUnion) else _core.CoreUnion(as_balls(balls))

    @property
    def _stands_for(self) -> Floats:
        return self.balls

    @property
    def balls(self) -> Floats:
        """N × 4: the balls as given."""
        return self._core.balls()

    @property
    def bounds(self) -> Floats:
        """2 × 3: the box around the balls."""
        return self._core.bounds()

    @checked
    def topology(self, *, threads: int = 0, progress: Progress = None) -> Topology:
        """Topology of the union, which is that of its dual complex."""
        with telling(progress) as tell:
            return Topology(*self._core.topology(threads, tell))

    @checked
    def neighbors(self, *, threads: int = 0, progress: Progress = None) -> Polygons:
        """For each ball those with which it shares an edge of the dual complex."""
        with telling(progress) as tell:
            return Polygons(*self._core.neighbors(threads, tell))

    @checked
    def boundary_vertices(self, *, threads: int = 0, progress: Progress = None) -> tuple[Floats, Ints, Ints]:
        """The points where three spheres meet that no ball covers, V × 3; the balls of the spheres, V × 3; and the two
        vertices of each singular triangle of the dual complex, P × 2.
        """
        with telling(progress) as tell:
            core = self._core.boundary_vertices(threads, tell)
            return core["points"], core["balls"], core["pairs"]

    @checked
    def nearest_balls(self, points: npt.ArrayLike, *, threads: int = 0) -> tuple[Ints, Floats]:
        """For each point the ball whose signed distance, that to its centre less its radius, is least, and that distance."""
        return self._core.nearest_balls(_arrays.points(points), threads, None)

    @checked
    def signed_distances(self, points: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """For each point the least signed distance to a ball: negative inside, 0 on the boundary."""
        return self._core.signed_distances(_arrays.points(points), threads, None)

    @checked
    def inside(self, points: npt.ArrayLike, *, threads: int = 0) -> npt.NDArray[np.bool_]:
        """Does each point lie in the union or on its boundary?"""
        return self._core.inside(_arrays.points(points), threads, None)

    @checked
    def distances_to_boundary(self, points: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """The distance of each point, inside or outside, to the nearest point of the boundary."""
        return self._core.distances_to_boundary(_arrays.points(points), threads, None)

    def transformed(self, matrix: npt.ArrayLike) -> BallUnion:
        """The union after a similarity, 3 × 4 or 4 × 4; others are refused, since balls would not stay balls."""
        return BallUnion(similarity_of(matrix).balls(self.balls))

    def __len__(self) -> int:
        return len(self.balls)

    def __repr__(self) -> str:
        return f"BallUnion({len(self):,} balls)"

    def __reduce__(self) -> Any:
        return BallUnion, (self.balls,)


@checked
def repair_mesh(
    vertices: Any, faces: npt.ArrayLike | None = None, *, threads: int = 0, progress: Progress = None
) -> tuple[Mesh, dict[str, Any]]:
    """The mesh with all repaired that can be without a change of the solid, and the report of what was found. Never
    raises for a bad mesh: `report["fault"]` then says why it bounds no solid. (In C++: `repair`.)
    """
    with telling(progress) as tell:
        core = _core.repair_mesh(*as_mesh(vertices, faces), threads, tell)
    report: dict[str, Any] = json.loads(core["report"])
    return Mesh(core["vertices"], core["triangles"]), report
