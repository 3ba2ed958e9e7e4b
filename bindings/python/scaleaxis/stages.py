# SPDX-License-Identifier: Apache-2.0
"""The stages alone, under their names in C++: solid → samples → union of balls → axis."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import Seed, checked
from ._progress import Progress, telling
from .adapt import as_balls
from .data import (
    MedialComplex,
    Mesh,
    Samples,
    Topology,
    complex_of,
    core_of,
    core_of_samples,
)
from .errors import Place, Warning, warn, warnings_of
from .solids import BallUnion, Solid, cloud

Json = dict[str, Any]
Sizing = Literal["adaptive", "uniform"]
UnionKind = Literal["polar", "fitted"]
LocalMeasure = Literal["object_angle", "circumradius"]
SheetAngle = Literal["largest", "by_area"]

DEFAULT_SLACK = 0.01
"""The slack of fitted balls that is small beside all that the sampling leaves, in units of its tolerance."""


def samples_of(core: dict[str, Any]) -> Samples:
    return Samples(**{**core, "statistics": json.loads(core["statistics"])})


@checked
def tolerance_of(delta: float, diagonal: float) -> float:
    """The tolerance, as a length, of a solid whose bounding box has this diagonal."""
    return _core.tolerance_of(delta, False, diagonal)


# Stage 1


@checked
def sample(
    solid: Solid,
    tolerance: float,
    *,
    sampling: Sizing = "adaptive",
    seed: Seed = 1,
    needs_manifold: bool = False,
    facet_distance: float = np.inf,
    creases: npt.ArrayLike | None = None,
    growth_limit: float = 2.0,
    max_samples: int = 1 << 26,
    threads: int = 0,
    progress: Progress = None,
) -> Samples:
    """Samples of the boundary of a solid, so close together that the union of their balls is within the tolerance of it.

    tolerance: δ as a length.
    sampling: "adaptive": as far apart as the solid lets them; "uniform": no restricted Delaunay facet has a surface
        Delaunay ball of a larger radius than δ, as in the paper.
    creases: segments of sharp edges, N × 2 × 3, that are to be edges of the facets.

    Other options as those of `SamplingOptions` in C++.
    """
    with telling(progress) as tell:
        core = _core.sample(
            solid._core,
            tolerance,
            sampling,
            seed,
            needs_manifold,
            facet_distance,
            _arrays.floats(() if creases is None else creases, "creases", (2, 3)).reshape(-1, 3),
            growth_limit,
            max_samples,
            threads,
            tell,
        )
    return samples_of(core)


@checked
def crust(
    points: npt.ArrayLike, normals: npt.ArrayLike | None = None, *, threads: int = 0, progress: Progress = None
) -> Samples:
    """The points as samples of a boundary, with the Delaunay tetrahedra that lie inside (power crust)."""
    with telling(progress) as tell:
        return samples_of(_core.crust(*cloud(points, normals), threads, tell))


# Stage 2


@checked
def inner_balls(samples: Samples, *, threads: int = 0, progress: Progress = None) -> Floats:
    """The inner polar balls of the samples, N × 4."""
    with telling(progress) as tell:
        return _core.inner_balls(core_of_samples(samples), threads, tell)


class FittedBalls(NamedTuple):
    """Balls in the solid, each of which touches its boundary at its contacts."""

    balls: Floats  #: B × 4
    contacts: Floats  #: B × 2 × 3
    given: Ints  #: B; position of the ball that each was fitted from
    statistics: Json

    @property
    def _stands_for(self) -> Floats:
        return self.balls


class Gap(NamedTuple):
    """A place outside the solid that the union covers once its balls have grown."""

    place: Place
    width: float
    scale: float


class RepairedBalls(NamedTuple):
    """Those given come first, unchanged."""

    balls: Floats  #: B × 4
    contacts: Floats  #: B × 2 × 3
    gaps: list[Gap]  #: those that a scale of at most 2 closes, the first to close first
    topology: Topology  #: of the union
    statistics: Json

    @property
    def _stands_for(self) -> Floats:
        return self.balls


class SolidUnion(NamedTuple):
    """The union of balls that stands for a solid."""

    balls: Floats  #: B × 4
    contacts: Floats  #: B × 2 × 3; empty if the balls were not fitted
    fit: Json | None  #: what fitting and repair did
    costs: list[Json]
    warnings: list[Warning]

    @property
    def _stands_for(self) -> Floats:
        return self.balls


@checked
def fit(
    balls: npt.ArrayLike, solid: Solid, slack: float, *, threads: int = 0, progress: Progress = None
) -> FittedBalls:
    """Fits balls to a solid that knows nearest points. `slack`: length below which differences do not matter, as
    `DEFAULT_SLACK * samples.tolerance`.
    """
    with telling(progress) as tell:
        return FittedBalls(**_core.fit(as_balls(balls), solid._core, slack, threads, tell))


@checked
def repair(
    fitted: FittedBalls,
    samples: Samples,
    solid: Solid,
    *,
    slack: float | None = None,
    topology: Topology | None = None,
    max_rounds: int = 32,
    growth_limit: float = 8.0,
    perturbation: float = 1e-4,
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> RepairedBalls:
    """Adds balls to a union of fitted balls until it has the topology of the solid, or nothing more is found to do."""
    balls = _arrays.balls(fitted.balls)
    contacts = _arrays.contacts(fitted.contacts)
    if len(balls) != len(contacts):
        raise ValueError(f"there are {len(contacts)} contacts for {len(balls)} balls")
    with telling(progress) as tell:
        core = _core.repair(
            balls,
            contacts,
            core_of_samples(samples),
            solid._core,
            topology,
            max_rounds,
            growth_limit,
            DEFAULT_SLACK * samples.tolerance if slack is None else slack,
            perturbation,
            seed,
            threads,
            tell,
        )
    return RepairedBalls(
        core["balls"],
        core["contacts"],
        [Gap(*gap) for gap in core["gaps"]],
        Topology(*core["topology"]),
        json.loads(core["report"])["repair"],
    )


@checked
def union_of(
    samples: Samples,
    solid: Solid,
    *,
    kind: UnionKind | None = None,
    topology: Topology | None = None,
    seed: Seed = 1,
    keeps_all: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> SolidUnion:
    """Samples → balls as `axis` takes them.

    These are `inner_balls`; where balls are fitted, `fit`, a choice of as many as it takes for the error, and `repair`.

    keeps_all: whether fitted balls stay that the error does not need; `axis` keeps them for uniform samples.
    """
    with telling(progress) as tell:
        core = _core.union_of(core_of_samples(samples), solid._core, kind, topology, seed, keeps_all, threads, tell)
    return SolidUnion(
        core["balls"],
        core["contacts"],
        core["fit"] and json.loads(core["fit"]),
        json.loads(core["costs"]),
        warnings_of(core["warnings"]),
    )


@checked
def default_union(solid: Solid) -> UnionKind:
    """Fitted balls for solids that know the nearest points of their boundary, polar ones for others."""
    return cast(UnionKind, _core.default_union(solid._core))


@checked
def union_accuracy(
    balls: npt.ArrayLike, contacts: npt.ArrayLike, samples: Samples, *, threads: int = 0, progress: Progress = None
) -> Json:
    """How a union of inscribed balls compares with its solid: distances of the samples to it, thinnest and thickest."""
    given = as_balls(balls)
    touching = _arrays.contacts(contacts)
    if len(given) != len(touching) or len(given) == 0:
        raise ValueError(f"there must be balls, and contacts of each: {len(given)} balls, {len(touching)} contacts")
    with telling(progress) as tell:
        report = _core.union_accuracy(given, touching, core_of_samples(samples), threads, tell)
    return cast(Json, json.loads(report)["accuracy"])


@checked
def scaled(balls: npt.ArrayLike, factor: float) -> Floats:
    """The balls with all radii multiplied by a factor."""
    return _core.scaled(as_balls(balls), factor)


@checked
def perturbed(balls: npt.ArrayLike, amount: float, seed: Seed = 1) -> Floats:
    """The balls with each centre moved by at most `amount` of the radius."""
    return _core.perturbed(as_balls(balls), amount, seed)


@checked
def check_balls(balls: npt.ArrayLike) -> None:
    """Raises UnusableInput for the first that is no ball."""
    _core.check_balls(as_balls(balls))


@checked
def distinct_balls(balls: npt.ArrayLike) -> Floats:
    """Of balls that coincide only the first."""
    return _core.distinct_balls(as_balls(balls))


@checked
def distinct_positions(balls: npt.ArrayLike) -> Ints:
    """The positions of `distinct_balls` in the array, ascending."""
    return _core.distinct_positions(as_balls(balls))


# Stage 3


class MedialAxis(NamedTuple):
    """The exact medial axis of a union of balls."""

    complex: MedialComplex
    ball_union: BallUnion  #: the balls given, after the perturbation
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class FilteredComplex(NamedTuple):
    """What a filter keeps."""

    complex: MedialComplex
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class SharpComplex(NamedTuple):
    """A complex whose sheets end on sharp edges."""

    complex: MedialComplex
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class CleanedComplex(NamedTuple):
    """What cleaning keeps."""

    complex: MedialComplex
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class CenteredComplex(NamedTuple):
    """A complex whose balls touch the solid."""

    complex: MedialComplex
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class SimplifiedComplex(NamedTuple):
    """A compact medial mesh."""

    complex: MedialComplex
    statistics: Json

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex


class ErosionThickness(NamedTuple):
    """When a fire that starts at the border of a complex comes by; infinite where it never does."""

    burn_times: Floats  #: #V
    thickness: Floats  #: #V, burn time minus radius
    corner_burn_times: Floats  #: of each corner of each face, in the order of `faces.indices`


@checked
def medial_axis(
    balls: npt.ArrayLike | BallUnion,
    *,
    perturbation: float = 1e-4,
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> MedialAxis:
    """The medial axis of a union of balls (N × 4). That of a `BallUnion` is not perturbed, unless it has to be."""
    with telling(progress) as tell:
        if isinstance(balls, BallUnion):
            core = _core.medial_axis_of_union(balls._core, perturbation, seed, threads, tell)
        else:
            core = _core.medial_axis(as_balls(balls), perturbation, seed, threads, tell)
    warn(warnings_of(core["warnings"]))
    report = json.loads(core["statistics"])
    statistics = {name: report[name] for name in ("balls", "hidden_balls", "dual_complex", "medial_complex")}
    return MedialAxis(complex_of(core["complex"]), BallUnion(core["ball_union"]), statistics)


@checked
def topology(of: MedialComplex | Samples) -> Topology | None:
    """Topology of a complex; or of what the restricted facets of samples bound, if they form a closed manifold."""
    if isinstance(of, Samples):
        known = _core.topology_of_samples(core_of_samples(of))
        return known and Topology(*known)
    return Topology(*_core.topology_of_complex(core_of(of)))


# Stage 4


def _filtered(core: dict[str, Any]) -> FilteredComplex:
    return FilteredComplex(complex_of(core["complex"]), json.loads(core["statistics"])["filter"])


@checked
def filter(
    complex: MedialComplex,
    angle: float = 30.0,
    *,
    measure: SheetAngle = "largest",
    threads: int = 0,
    progress: Progress = None,
) -> FilteredComplex:
    """Removes sheets and curves whose largest object angle is below `angle` (degrees), the least important first, where
    that keeps the topology: angles are those at which the boundary of the grown balls is seen.

    With the measure "by_area", for clean axes, sheets alone, by the angle that faces of a fifth of their area exceed.
    Where such sheets meet each other alone, as in a bar with six sides, the curve in which they meet stays.
    """
    with telling(progress) as tell:
        return _filtered(_core.filter(core_of(complex), angle, measure, threads, tell))


@checked
def with_object_angles(complex: MedialComplex) -> MedialComplex:
    """The complex with object angles for the faces that have none, as in files: computed from the radii, which say where
    the contacts of a face are; after `with_linear_radii` their slope is the cosine of the angle.
    """
    return complex_of(_core.with_object_angles(core_of(complex)))


@checked
def with_linear_radii(complex: MedialComplex) -> MedialComplex:
    """The complex of another program, a medial mesh of spheres, cones and slabs: its radii are linear between vertices,
    however far apart these are. Call it for such files before `densify`, `smooth` and `clean`.
    """
    return complex_of(_core.with_linear_radii(core_of(complex)))


@checked
def thresholded(
    complex: MedialComplex,
    measure: LocalMeasure,
    threshold: float,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> FilteredComplex:
    """What a local method keeps: that on which the measure somewhere is at least the threshold, degrees or a length."""
    with telling(progress) as tell:
        return _filtered(_core.thresholded(core_of(complex), measure, threshold, threads, tell))


@checked
def erosion_thickness(complex: MedialComplex, *, threads: int = 0, progress: Progress = None) -> ErosionThickness:
    """Burn time and erosion thickness (Yan et al. 2016): how far the largest ball at the border of the axis sticks out
    of the ball at a vertex. The fire starts at the border when the radius there has passed, burns with unit speed, and
    waits where sheets meet until all but one have burnt.
    """
    with telling(progress) as tell:
        return ErosionThickness(**_core.erosion_thickness(core_of(complex), threads, tell))


@checked
def extend_to_sharp_edges(
    complex: MedialComplex,
    solid: Solid,
    tolerance: float,
    angle: float = 30.0,
    scale: float = 1.0,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> SharpComplex:
    """Goes on with the sheets of a filtered complex up to the convex sharp edges of the solid, in balls of radius 0,
    and with seams into its corners.

    tolerance: δ of the sampling as a length.
    angle: least angle between the normals on both sides of an edge, degrees.
    scale: factor by which the balls have been grown, of a complex that is not shrunk yet; edges whose sheets growing
        takes are not looked for.
    """
    with telling(progress) as tell:
        core = _core.extend_to_sharp_edges(core_of(complex), solid._core, tolerance, angle, scale, threads, tell)
    return SharpComplex(complex_of(core["complex"]), json.loads(core["statistics"])["sharp_edges"])


@checked
def center(
    complex: MedialComplex,
    solid: Solid,
    tolerance: float,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> CenteredComplex:
    """Makes the balls of a filtered and shrunk complex touch the solid: vertices go to the middle between the tangent
    planes at their contacts if their balls grow there, and radii become the distances from its boundary. Edges are
    halved where balls in between do not touch.

    tolerance: δ of the sampling as a length: no vertex moves farther, and no ball grows by more.
    """
    with telling(progress) as tell:
        core = _core.center(core_of(complex), solid._core, tolerance, threads, tell)
    return CenteredComplex(complex_of(core["complex"]), json.loads(core["statistics"])["centering"])


@checked
def clean(
    complex: MedialComplex,
    thickness: float,
    *,
    finds_ridges: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> CleanedComplex:
    """Removes what has less erosion thickness, by collapses, which keep the topology: teeth, crumbs and hairs go, sheets
    narrower than about twice the thickness become curves.

    thickness: in the units of the complex.
    finds_ridges: whether edges are cut at ridges between their ends. Without, sheets whose faces are as large as the
        sheets are wide are lost though they are wider than that, and seams that end less than twice the thickness
        before the border of a sheet folded along them stay as they are.
    """
    with telling(progress) as tell:
        core = _core.clean(core_of(complex), thickness, finds_ridges, threads, tell)
    return CleanedComplex(complex_of(core["complex"]), json.loads(core["statistics"])["cleaning"])


@checked
def contract_slivers(
    complex: MedialComplex, tolerance: float, *, threads: int = 0, progress: Progress = None
) -> MedialComplex:
    """Draws sheets together that are narrower on average than half of `tolerance`, or than a quarter of their smallest
    ball, by contractions, which keep the topology. Where four sheets of a solid meet in a seam, those of a union meet by
    threes, and what lies between has no width once balls touch the solid. Seams that end less than `tolerance` before the
    border of a sheet folded along them end on it.

    tolerance: δ of the sampling as a length.
    """
    with telling(progress) as tell:
        return complex_of(_core.contract_slivers(core_of(complex), tolerance, threads, tell))


@checked
def simplify(
    complex: MedialComplex,
    error: float | None = None,
    *,
    vertices: int | None = None,
    anchors: Sequence[int] = (),
    threads: int = 0,
    progress: Progress = None,
) -> SimplifiedComplex:
    """Collapses edges until few vertices are left, between which centres and radii are interpolated linearly (`Envelope`).
    Topology, sheets, seams, borders and curves stay.

    error: in the units of the complex: no ball before sticks out of those after by more, nor the other way round. None: as
        large as the number of vertices asks for.
    vertices: the number at which to stop.
    anchors: vertices that stay as they are.
    """
    with telling(progress) as tell:
        core = _core.simplify(core_of(complex), error, vertices, list(anchors), threads, tell)
    return SimplifiedComplex(complex_of(core["complex"]), json.loads(core["statistics"])["simplification"])


# Stage 5


@checked
def shrink(complex: MedialComplex, scale: float) -> MedialComplex:
    """Divides all radii by the factor by which the balls had been grown, which becomes the `scale` of the complex."""
    return complex_of(_core.shrink(core_of(complex), scale))


@checked
def densify(
    complex: MedialComplex,
    *,
    meeting_angle: float = 150.0,
    most_vertices: int | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> MedialComplex:
    """Samples a shrunk complex until the balls at the ends of every edge meet at this angle: the union of the balls at
    its vertices is the simplified solid.
    """
    with telling(progress) as tell:
        return complex_of(_core.densify(core_of(complex), meeting_angle, most_vertices, threads, tell))


# Stage 6


@checked
def smooth(
    complex: MedialComplex,
    ball_union: BallUnion | None,
    rounds: int,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> MedialComplex:
    """Smooths the boundaries of sheets of a filtered and shrunk complex. `ball_union`: that of `medial_axis`; None: that
    of the balls of the complex after `densify`, as for complexes from files. Then faces are divided first where linear
    radii are not right to 0.002 of the diagonal; the vertices given come first.
    """
    with telling(progress) as tell:
        if ball_union is None:
            return complex_of(_core.smooth_alone(core_of(complex), rounds, threads, tell))
        return complex_of(_core.smooth(core_of(complex), ball_union._core, rounds, threads, tell))


# Back to a surface


@dataclass(frozen=True)
class BoundaryMesh:
    """A closed manifold mesh of the boundary, oriented outward."""

    vertices: Floats
    triangles: Ints
    copied_vertices: int
    parted_edges: int
    lost_samples: int

    @property
    def mesh(self) -> Mesh:
        return Mesh(self.vertices, self.triangles)

    @property
    def _stands_for(self) -> Mesh:
        return self.mesh


@checked
def boundary_mesh(samples: Samples, *, threads: int = 0, progress: Progress = None) -> BoundaryMesh:
    """The restricted Delaunay triangles of the samples."""
    with telling(progress) as tell:
        return BoundaryMesh(**_core.boundary_mesh(core_of_samples(samples), threads, tell))
