# SPDX-License-Identifier: Apache-2.0
"""Sizes of elements for meshers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import checked
from ._progress import Progress, part_of, telling
from .data import Mesh
from .errors import warn
from .files import Path
from .findings import surface_of
from .loading import InputOptions, load_with

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, eq=False)
class SizeMesh:
    """Tetrahedra with sizes at their vertices, between which they are linear. They fill a box around the solid."""

    vertices: Floats  #: V × 3
    sizes: Floats  #: V
    tetrahedra: Ints  #: T × 4

    def __repr__(self) -> str:
        return f"SizeMesh({len(self.vertices):,} vertices, {len(self.tetrahedra):,} tetrahedra)"


@dataclass(frozen=True, eq=False, repr=False)
class SizeField:
    """Sizes of elements at all points: what `size_field` returns."""

    _core: Any

    @checked
    def __call__(self, points: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """The sizes at N × 3 points."""
        sizes: Floats = self._core.sizes(_arrays.points(points), threads)
        return sizes

    def gmsh_callback(self, dim: int, tag: int, x: float, y: float, z: float, lc: float) -> float:
        """For `gmsh.model.mesh.setSizeCallback`: the size at a point, or `lc`, what Gmsh asks for, where that is less."""
        size: float = self._core.at(x, y, z)
        return min(size, lc)

    @cached_property
    def surface(self) -> Mesh:
        """The surface of the solid, with vertices where sizes change."""
        core = self._core.surface()
        return Mesh(core["vertices"], core["triangles"])

    @cached_property
    def sizes(self) -> Floats:
        """V: the sizes at the vertices of `surface`."""
        sizes: Floats = self._core.surface()["sizes"]
        return sizes

    @checked
    def background(self, *, threads: int = 0, progress: Progress = None) -> SizeMesh:
        """Tetrahedra with vertices on the surface and halfway between its sides."""
        with telling(progress) as tell:
            return SizeMesh(**self._core.background(threads, tell))

    @checked
    def save(self, path: Path, *, mesh: Path | None = None) -> None:
        """Writes a view for Gmsh (.pos, .msh), or for mmg a .sol and beside it the surface as .mesh.

        mesh: of the .sol, a mesh of tetrahedra in Medit's text format that is there already.
        """
        self._core.write(path, mesh)

    def __repr__(self) -> str:
        return f"SizeField({self.sizes.min():.6g} ... {self.sizes.max():.6g} on the surface)"


@checked
def size_field(
    solid: Any,
    *,
    elements_across: float = 3.0,
    min_size: float | None = None,
    max_size: float | None = None,
    gradation: float = 0.3,
    of: Literal["thickness", "feature-size"] = "thickness",
    angle: float = 128.0,
    delta: float = 0.01,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[InputOptions],
) -> SizeField:
    """Sizes of elements for a mesh of a solid, from how thick it is.

    solid: anything that `axis` takes, also shapes of build123d, CadQuery and OCP, and STEP files.
    elements_across: how many elements lie across a wall, [0.1, 100].
    min_size, max_size: limits of sizes, lengths; `min_size` is 1/1000 of the diagonal if it is not given.
    gradation: largest difference of sizes for each unit of distance, [0.01, 10].
    of: what is divided by the number of elements: the thickness of the wall, or twice the distance to the medial axis,
        inside or outside, which is small at narrow holes and slots, too.
    angle: least angle in degrees, [60, 179], between two contacts of a ball for which they lie on opposite sides.
    delta: tolerance of the surface, relative to the diagonal, of what is no mesh.
    options: those of inputs, see `InputOptions`.
    """
    with telling(progress) as tell:
        loaded = load_with(solid, options, threads, part_of(tell, 0.0, 0.3))
        surface = surface_of(loaded, delta, threads, part_of(tell, 0.3, 0.5))
        assert loaded.solid is not None
        core = _core.size_field(
            loaded.solid._core,
            *surface,
            of == "thickness",
            elements_across,
            min_size,
            max_size,
            gradation,
            angle,
            threads,
            part_of(tell, 0.5, 1.0),
        )
    warn(loaded.warnings)
    return SizeField(core)
