# SPDX-License-Identifier: Apache-2.0
"""Walls that are too thin or too thick, and gaps that are too narrow."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import checked
from ._progress import Progress, part_of, telling
from .data import Mesh
from .errors import InvalidOption, warn
from .files import Path
from .loading import InputOptions, LoadedSolid, load_with
from .page import Page, page_path, write_page
from .stages import Json, boundary_mesh, sample

if TYPE_CHECKING:
    from typing_extensions import Unpack

FindingKind = Literal["thin_wall", "thick_wall", "narrow_gap"]


@dataclass(frozen=True, eq=False)
class Finding:
    """A wall or gap that passes a limit: a connected piece of the surface, both sides. In units of the solid."""

    kind: FindingKind
    value: float  #: the least thickness or width; of a thick wall the largest
    limit: float
    place: Floats  #: 3: the centre of the ball between the two sides, of diameter `value`
    radius: float  #: of that ball
    direction: Floats  #: 3: from one side to the other, of length 1
    contacts: Floats  #: 2 × 3: where the ball touches
    area: float  #: of both sides together
    bounds: Floats  #: 2 × 3: the box around the piece
    vertices: int  #: of `Walls.surface`, in the piece

    def __repr__(self) -> str:
        place = ", ".join(f"{x:.6g}" for x in self.place)
        return f"Finding({self.kind} {self.value:.6g} at ({place}), limit {self.limit:.6g})"


@dataclass(frozen=True, eq=False, repr=False)
class Walls:
    """What `walls` has found: thin walls, thick walls, gaps, the worst of each kind first."""

    findings: list[Finding]
    tolerance: float  #: a value that misses its limit by no more is no finding
    surface: Mesh  #: of the solid, with vertices where they are needed
    wall: Floats | None  #: V: thickness of the wall, up to twice the limit; None where no wall was looked for
    gap: Floats | None  #: V: the same of gaps
    wall_findings: Ints | None  #: V: the finding of a vertex, or -1
    gap_findings: Ints | None  #: V
    document: Json  #: the findings as the program writes them

    def __len__(self) -> int:
        return len(self.findings)

    def __iter__(self) -> Any:
        return iter(self.findings)

    def __getitem__(self, index: int) -> Finding:
        return self.findings[index]

    @checked
    def view(self, path: Path | None = None, *, name: str = "walls") -> Page:
        """A page with the surface in the colours of its walls and gaps, the nearer one of both: see `Axis.view`."""
        path = page_path(path, name)
        known = [values for values in (self.wall, self.gap) if values is not None]
        values = np.minimum.reduce(known)
        regions = np.maximum.reduce([r for r in (self.wall_findings, self.gap_findings) if r is not None])
        limit = min((f.limit for f in self.findings if f.kind != "thick_wall"), default=None)
        model = _core.view_data(name, *self.surface, [], "", (values, values, regions, limit))
        return write_page(path, name, [model])

    def __repr__(self) -> str:
        return f"Walls({len(self.findings):,} findings)"


def _finding_of(entry: dict[str, Any]) -> Finding:
    return Finding(
        kind=entry["kind"],
        value=entry["value"],
        limit=entry["limit"],
        place=np.array(entry["place"]),
        radius=entry["ball"]["radius"],
        direction=np.array(entry["direction"]),
        contacts=np.array(entry["contacts"]),
        area=entry["area"],
        bounds=np.array([entry["extent"]["min"], entry["extent"]["max"]]),
        vertices=entry["vertices"],
    )


def surface_of(loaded: LoadedSolid, delta: float, threads: int, tell: Any) -> Mesh:
    """The mesh, or of what has none the triangles between samples."""
    if loaded.mesh is not None:
        return loaded.mesh
    solid = loaded.solid
    if solid is None:
        raise InvalidOption('this needs a solid, not samples of its boundary: take points="mls"')
    samples = sample(solid, delta * solid.diagonal, needs_manifold=True, threads=threads, progress=tell)
    return boundary_mesh(samples, threads=threads).mesh


@checked
def walls(
    solid: Any,
    *,
    min_wall: float | None = None,
    min_gap: float | None = None,
    max_wall: float | None = None,
    angle: float = 128.0,
    edge: float = 0.03,
    delta: float = 0.01,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[InputOptions],
) -> Walls:
    """Walls that are thinner or thicker than they may be, and gaps that are narrower, with their places.

    solid: anything that `axis` takes, also shapes of build123d, CadQuery and OCP, and STEP files.
    min_wall, min_gap, max_wall: limits, lengths; what has none is not looked for.
    angle: least angle in degrees, [60, 179], between two contacts of a ball for which they lie on opposite sides: an
        edge of less than 180 less this is a thin wall, a groove as sharp a gap.
    edge: longest edge of the surface, relative to the diagonal, (0, 1]; it gets shorter ones where they are needed.
    delta: tolerance of the surface, relative to the diagonal, of what is no mesh.
    options: those of inputs, see `InputOptions`.
    """
    with telling(progress) as tell:
        loaded = load_with(solid, options, threads, part_of(tell, 0.0, 0.3))
        surface = surface_of(loaded, delta, threads, part_of(tell, 0.3, 0.5))
        assert loaded.solid is not None
        core = _core.find_walls(
            loaded.solid._core, *surface, min_wall, max_wall, min_gap, angle, edge, threads, part_of(tell, 0.5, 1.0)
        )
    warn(loaded.warnings)
    document: Json = json.loads(core["findings"])
    has_walls = min_wall is not None or max_wall is not None
    return Walls(
        findings=[_finding_of(entry) for entry in document["findings"]],
        tolerance=document["tolerance"],
        surface=Mesh(core["surface"]["vertices"], core["surface"]["triangles"]),
        wall=core["wall"] if has_walls else None,
        gap=core["gap"] if min_gap is not None else None,
        wall_findings=core["wall_findings"] if has_walls else None,
        gap_findings=core["gap_findings"] if min_gap is not None else None,
        document=document,
    )


def _opposite_at(solid: Any, points: npt.ArrayLike, is_gap: bool, angle: float, threads: int) -> Floats:
    asked = _arrays.points(points)
    loaded = load_with(solid, {}, threads, None)
    if loaded.solid is None:
        raise InvalidOption("walls need a solid, not samples of its boundary")
    return _core.wall_at(loaded.solid._core, asked, is_gap, angle, threads, None)


@checked
def thickness_at(solid: Any, points: npt.ArrayLike, *, angle: float = 128.0, threads: int = 0) -> Floats:
    """The thickness of the wall at N × 3 points on the surface of a solid or in it.

    solid: anything that `axis` takes, or the `Solid` or `LoadedSolid` made of it, which is quicker for several calls.
    angle: as for `walls`.
    """
    return _opposite_at(solid, points, False, angle, threads)


@checked
def gap_at(solid: Any, points: npt.ArrayLike, *, angle: float = 128.0, threads: int = 0) -> Floats:
    """The width of the gap at N × 3 points on the surface of a solid or outside; infinity where nothing is opposite."""
    return _opposite_at(solid, points, True, angle, threads)
