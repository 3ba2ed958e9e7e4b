# SPDX-License-Identifier: Apache-2.0
"""Nested scales: at which scale balls vanish in larger ones, and a medial complex in that order."""

from __future__ import annotations

import json
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from . import _arrays, _core
from ._arrays import Floats
from ._options import checked
from ._progress import Progress, telling
from .adapt import as_balls, as_complex
from .data import MedialComplex, Mesh, complex_of, core_of
from .errors import InvalidOption, warn, warnings_of
from .page import NO_MESH, Page, page_path, write_page


class FiltrationLevel(NamedTuple):
    """What is left at a scale."""

    scale: float
    sheets: int
    balls: int  #: vertices
    area: float  #: of all sheets
    curve_length: float  #: of all edges without faces
    volume: float  #: of the union of the balls at the vertices


class ScalePlateau(NamedTuple):
    """A range of scales in which the sheets lose hardly any area."""

    begin: float
    end: float
    middle: float  #: of log s


@dataclass(frozen=True, eq=False)
class Filtration:
    """A medial complex at s = 1, and the scale at which each of its elements vanishes; infinite: never.

    `cut(s)` is what vanishes later: a subcomplex of the same homotopy type for all s, the smaller, the larger s is.
    """

    complex: MedialComplex
    ball_scales: Floats  #: V: when the ball at the vertex is covered by larger ones (`vanishing_scales`)
    vertex_scales: Floats  #: V: when the vertex vanishes, not before its ball does
    edge_scales: Floats  #: E
    face_scales: Floats  #: F
    largest_scale: float = 10.0  #: up to which it was looked

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex

    @checked
    def cut(self, scale: float) -> MedialComplex:
        """What is left at a scale. Above `largest_scale` the level is the same as there, with a warning."""
        complex, warnings = _core.cut(core_of(self.complex), self._scales(), scale)
        warn(warnings_of(warnings))
        return complex_of(complex)

    @checked
    def profile(
        self, largest_scale: float | None = None, count: int = 121
    ) -> tuple[list[FiltrationLevel], ScalePlateau]:
        """The levels at scales from 1 to the largest one in equal steps of log s, and the longest range up to s = 2
        over which the sheets lose no more than 2 % of their area.
        """
        levels, plateau, _, _ = self._profile(largest_scale, count, "")
        return [FiltrationLevel(**level) for level in json.loads(levels)], ScalePlateau(**json.loads(plateau))

    @checked
    def plot(
        self, file: str | PathLike[str], *, title: str = "", largest_scale: float | None = None, count: int = 121
    ) -> None:
        """Draws the profile to .svg, or writes its numbers to .csv."""
        extension = Path(file).suffix
        if extension == ".png":
            raise InvalidOption(
                f"{file}: plots are written to .svg; a browser or Inkscape makes a PNG of it, or "
                "`rsvg-convert -z 2 plot.svg -o plot.png`"
            )
        if extension not in (".svg", ".csv"):
            raise InvalidOption(f"{file}: plots are written to .svg, and their numbers to .csv")
        _, _, csv, svg = self._profile(largest_scale, count, title)
        Path(file).write_text(svg if extension == ".svg" else csv, encoding="utf-8", newline="")

    @checked
    def view(
        self, path: str | PathLike[str] | None = None, *, shape: Mesh | None = None, name: str = "filtration"
    ) -> Page:
        """A page with a slider over all scales above a plot of what is left: see `Axis.view`.

        shape: drawn around the axis, as `axis.boundary`.
        """
        path = page_path(path, name)
        return write_page(
            path, name, [_core.view_filtration(name, *(shape or NO_MESH), core_of(self.complex), self._scales())]
        )

    def _profile(self, largest_scale: float | None, count: int, title: str) -> tuple[str, str, str, str]:
        largest = self.largest_scale if largest_scale is None else largest_scale
        return _core.profile(core_of(self.complex), self._scales(), largest, count, title)

    def _scales(self) -> tuple[Floats, Floats, Floats, Floats, float]:
        return (
            _arrays.floats(self.ball_scales, "ball_scales", (), finite=False),
            _arrays.floats(self.vertex_scales, "vertex_scales", (), finite=False),
            _arrays.floats(self.edge_scales, "edge_scales", (), finite=False),
            _arrays.floats(self.face_scales, "face_scales", (), finite=False),
            self.largest_scale,
        )


def _filtration_of(core: dict[str, Any]) -> Filtration:
    return Filtration(**{**core, "complex": complex_of(core["complex"])})


@checked
def vanishing_scales(
    balls: Any,
    *,
    largest_scale: float = 10.0,
    tolerance: float = 1e-3,
    threads: int = 0,
    progress: Progress = None,
) -> Floats:
    """For each ball (N × 4) the scale s from which on the ball times s is covered by the larger balls times s; infinite
    beyond the largest scale. tolerance: relative, of the result, which is never too small.
    """
    with telling(progress) as tell:
        return _core.vanishing_scales(as_balls(balls), largest_scale, tolerance, threads, tell)


@checked
def filtration(
    complex: Any,
    *,
    largest_scale: float = 10.0,
    tolerance: float = 1e-3,
    threads: int = 0,
    progress: Progress = None,
) -> Filtration:
    """The axis at all scales: collapses the complex in the order in which the balls at its vertices vanish.

    complex: axis at s = 1, as `scaleaxis.axis(mesh, scale=1)`, or a file with one.
    """
    with telling(progress) as tell:
        core = core_of(as_complex(complex))
        nested, warnings = _core.filtration(core, largest_scale, tolerance, threads, tell)
    warn(warnings_of(warnings))
    return _filtration_of(nested)


@checked
def write_filtration(file: str | PathLike[str], filtration: Filtration, *, polygons: bool = False) -> None:
    """A filtration to PLY, which `read_filtration` and `scaleaxis filter --scale` read, or VTP."""
    _core.write_filtration(file, core_of(filtration.complex), filtration._scales(), polygons)


@checked
def read_filtration(file: str | PathLike[str]) -> Filtration:
    """A filtration from a PLY that `write_filtration` or `scaleaxis filtration` has written."""
    return _filtration_of(_core.read_filtration(file))
