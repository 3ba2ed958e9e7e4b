# SPDX-License-Identifier: Apache-2.0
"""Unions of balls as meshes and images, and distances between surfaces."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, Ints
from ._options import Seed, checked, length_of, stood_for
from ._progress import Progress, telling
from .adapt import adapted, as_balls, as_mesh, core_of_image, is_path
from .data import Image, Mesh, Topology, image_of
from .errors import Place, Warning, warn, warnings_of
from .files import file_kind
from .solids import BallUnion, Envelope
from .stages import Json

# As of `scaleaxis mesh` and `scaleaxis compare`.
_DELTA = 0.01
_SPACING = 0.002


@dataclass(frozen=True, eq=False, repr=False)
class UnionMesh:
    """The boundary of a union of balls as a closed manifold mesh, and what was measured on the way."""

    vertices: Floats  #: V × 3
    triangles: Ints  #: F × 3
    statistics: Json
    warnings: list[Warning]

    @property
    def faces(self) -> Ints:
        """The triangles, under the name that trimesh has for them."""
        return self.triangles

    @property
    def mesh(self) -> Mesh:
        return Mesh(self.vertices, self.triangles)

    @property
    def _stands_for(self) -> Mesh:
        return self.mesh

    def __iter__(self) -> Iterator[npt.NDArray[Any]]:
        """Vertices and triangles: `trimesh.Trimesh(*mesh)`."""
        return iter(self.mesh)

    def __repr__(self) -> str:
        return f"UnionMesh({len(self.vertices):,} vertices, {len(self.triangles):,} triangles)"


@checked
def mesh(
    balls: Any,
    delta: float | None = None,
    *,
    delta_abs: float | None = None,
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> UnionMesh:
    """The boundary of a union of balls as a triangle mesh. (In C++: `union_mesh`.)

    balls: N × 4 numbers, a file, a BallUnion, an axis, which should be a dense one (`Axis.mesh` sees to that), or an
    `Envelope`.
    delta, delta_abs: tolerance of the sampling, relative to the diagonal of the box around the balls (default 0.01), or
        as a length.
    """
    tolerance, is_length = length_of(delta, delta_abs, "delta") or (_DELTA, False)
    known = stood_for(balls)
    given = known._core if isinstance(known, Envelope) else as_balls(known)
    with telling(progress) as tell:
        core = _core.union_mesh(given, tolerance, is_length, seed, threads, tell)
    found = warnings_of(core["warnings"])
    warn(found)
    return UnionMesh(core["vertices"], core["triangles"], json.loads(core["statistics"]), found)


@dataclass(frozen=True)
class OneSidedDistance:
    """The distances of the points of one surface to the other one, in units of the surfaces."""

    max: float  #: one-sided Hausdorff distance: that of `farthest`
    error: float  #: the true one is between `max` and `max + error`
    mean: float
    rms: float
    farthest: Place
    samples: int


class SurfaceDistance(NamedTuple):
    """Distances both ways."""

    a_to_b: OneSidedDistance
    b_to_a: OneSidedDistance

    @property
    def max(self) -> float:
        """Two-sided Hausdorff distance."""
        return max(self.a_to_b.max, self.b_to_a.max)

    @property
    def error(self) -> float:
        """How much larger that can be."""
        return max(side.max + side.error for side in self) - self.max


Surface = Any


def _surface_of(given: Surface) -> Floats | tuple[Floats, Ints] | _core.CoreEnvelope:
    known = adapted(given)
    if isinstance(known, Envelope):
        return known._core
    is_mesh = file_kind(known) == "mesh" if is_path(known) else isinstance(known, Mesh)
    return as_mesh(known) if is_mesh else as_balls(known)


@checked
def compare(
    a: Surface,
    b: Surface,
    spacing: float | None = None,
    *,
    spacing_abs: float | None = None,
    accuracy: float | None = None,
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> SurfaceDistance:
    """Distances between two surfaces: meshes, unions of balls, files of these, `Envelope`s. (In C++: `surface_distance`.)

    spacing, spacing_abs: every point of a surface is at most this far from one whose distance is computed; relative to
    the diagonal of A (default 0.002), or as a length. accuracy: a length; default: a hundredth of the spacing.
    """
    length, is_length = length_of(spacing, spacing_abs, "spacing") or (_SPACING, False)
    surfaces = _surface_of(a), _surface_of(b)
    if not is_length:
        length *= float(np.linalg.norm(np.diff(_core.surface_bounds(surfaces[0]), axis=0)))
    precision = 0.01 * length if accuracy is None else accuracy
    with telling(progress) as tell:
        sides = _core.surface_distance(*surfaces, length, precision, seed, threads, tell)
    return SurfaceDistance(*(OneSidedDistance(**side) for side in sides))


@checked
def sample_field(balls: Any, resolution: int = 128, *, threads: int = 0, progress: Progress = None) -> Image:
    """The signed distance to a union of balls, or an `Envelope`, on a grid with so many points along its longest
    side: negative inside. (In C++: `signed_distance_image`.)
    """
    union = balls if isinstance(balls, (BallUnion, Envelope)) else BallUnion(balls)
    with telling(progress) as tell:
        return image_of(_core.signed_distance_image(union._core, resolution, threads, tell))


@checked
def smoothed_mask(mask: Any, width: float = 0.7, *, threads: int = 0, progress: Progress = None) -> Image:
    """A grey image of a mask, which is an image in any form, above 0.5 inside, without its staircase; only the part
    around the mask.
    """
    with telling(progress) as tell:
        return image_of(_core.smoothed_mask(*core_of_image(mask), width, threads, tell))


@checked
def image_topology(
    image: Any,
    iso: float = 0.5,
    is_below: bool = False,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> Topology:
    """Topology of the solid that `image_solid` makes, exactly. (In C++: `topology`.)"""
    with telling(progress) as tell:
        return Topology(*_core.topology_of_image(*core_of_image(image), iso, is_below, threads, tell))
