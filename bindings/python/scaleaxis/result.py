# SPDX-License-Identifier: Apache-2.0
"""The result of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Floats, Ints
from ._progress import Progress, part_of, telling
from .data import MedialComplex, Mesh, Polygons, Samples, Topology
from .errors import Warning
from .files import Path, write_axis
from .page import Page, view
from .stages import densify
from .surfaces import UnionMesh, mesh

if TYPE_CHECKING:
    import networkx
    import pyvista
    import trimesh


@dataclass(frozen=True, eq=False, repr=False)
class Axis:
    """The discrete scale axis of a solid for one scale.

    Its vertices carry the radius of a ball inside the solid. Faces are convex polygons, in sheets that meet at seams;
    edges without a face are curves.
    """

    scale: float
    complex: MedialComplex
    balls: Floats  #: B × 4: the union of balls that approximates the solid, before growing; shared by all scales
    ball_contacts: Floats  #: B × 2 × 3: where each touches the boundary of the solid; empty if they were not fitted
    tolerance: float  #: δ as a length
    diagonal: float  #: of the solid's bounding box
    statistics: Mapping[str, Any]  #: as the program's JSON, see docs/statistics.md, with the axis under "axis"
    warnings: list[Warning]
    boundary: Mesh | None = None  #: of an input that was a mesh: that mesh, repaired
    samples: Samples | None = None  #: with `keep_samples`
    name: str = field(default="solid")

    @property
    def vertices(self) -> Floats:
        """V × 3."""
        return self.complex.vertices

    @property
    def radii(self) -> Floats:
        """V: the radius of the ball at each vertex."""
        return self.complex.radii

    @property
    def edges(self) -> Ints:
        """E × 2: all edges, those of faces too."""
        return self.complex.edges

    @property
    def curves(self) -> Ints:
        """C × 2: the edges without a face."""
        is_side = np.zeros(len(self.edges), dtype=bool)
        is_side[self.complex.face_edges] = True
        return self.edges[~is_side]

    @property
    def polygons(self) -> Polygons:
        """F convex polygons."""
        return self.complex.faces

    @property
    def triangles(self) -> Ints:
        """T × 3: the polygons cut into triangles."""
        return self.complex.triangles

    @property
    def sheets(self) -> Ints:
        """F: the sheet of each polygon."""
        return self.complex.face_sheets

    @property
    def angles(self) -> Floats:
        """F: the object angle of each polygon, degrees."""
        return self.complex.face_angles

    @property
    def contacts(self) -> Floats:
        """F × 2 × 3: the two points of the boundary of the grown union that are closest to each polygon; empty if dense
        sampling has cut the polygons up.
        """
        return self.complex.contacts

    @property
    def topology(self) -> Topology:
        """Betti numbers and Euler characteristic."""
        return Topology(**self.statistics["axis"]["filter"]["topology"])

    def densified(self, *, threads: int = 0, progress: Progress = None) -> MedialComplex:
        """The axis with so many vertices that the union of their balls is the simplified solid."""
        return densify(self.complex, self.scale, threads=threads, progress=progress)

    def mesh(
        self,
        *,
        delta_abs: float | None = None,
        tight: bool = False,
        seed: int = 1,
        threads: int = 0,
        progress: Progress = None,
    ) -> UnionMesh:
        """The simplified solid as a closed triangle mesh. `delta_abs`: default: the tolerance of the axis."""
        with telling(progress) as tell:
            dense = self.densified(threads=threads, progress=part_of(tell, 0.0, 0.1))
            return mesh(
                dense.balls,
                delta_abs=self.tolerance if delta_abs is None else delta_abs,
                tight=tight,
                seed=seed,
                threads=threads,
                progress=part_of(tell, 0.1, 1.0),
            )

    def save(self, path: Path) -> None:
        """Writes the axis to PLY, .ma, VTP, OBJ or GLB."""
        write_axis(path, self.complex)

    def view(self, path: Path | None = None) -> Page:
        """An interactive page. In Jupyter it shows itself as the value of a cell; elsewhere open its `path`."""
        return view(self, path)

    def to_trimesh(self) -> trimesh.Trimesh:
        """The triangles as a trimesh.Trimesh, with the radii in `vertex_attributes["radius"]`."""
        import trimesh

        triangles, owner = self.polygons.triangulated()
        return trimesh.Trimesh(
            vertices=self.vertices,
            faces=triangles,
            process=False,
            vertex_attributes={"radius": self.radii},
            face_attributes={"sheet": self.sheets[owner], "angle": self.angles[owner]},
        )

    def to_pyvista(self) -> pyvista.PolyData:
        """Polygons and curves as a pyvista.PolyData: points with "radius", cells with "sheet" and "angle"."""
        import pyvista

        polygons, curves = self.polygons, self.curves
        # Each list of corners with its length before it. Cells of lines come first.
        cells = np.insert(polygons.indices, polygons.offsets[:-1], polygons.sizes)
        lines = np.insert(curves, 0, 2, axis=1).ravel()
        data = pyvista.PolyData(self.vertices, faces=cells if len(cells) else None, lines=lines if len(lines) else None)
        none = np.full(len(curves), -1, dtype=np.int32)
        data.point_data["radius"] = self.radii
        data.cell_data["sheet"] = np.concatenate([none, self.sheets])
        data.cell_data["angle"] = np.concatenate([np.zeros(len(curves)), self.angles])
        return data

    def to_networkx(self) -> networkx.Graph[int]:
        """Vertices and edges as a graph: nodes with "pos" and "radius", edges with "length"."""
        import networkx

        lengths = np.linalg.norm(np.diff(self.vertices[self.edges], axis=1)[:, 0], axis=1)
        graph: networkx.Graph[int] = networkx.Graph(scale=self.scale)
        for i, (place, radius) in enumerate(zip(self.vertices.tolist(), self.radii.tolist())):
            graph.add_node(i, pos=tuple(place), radius=radius)
        for (a, b), length in zip(self.edges.tolist(), lengths.tolist()):
            graph.add_edge(a, b, length=length)
        return graph

    def __repr__(self) -> str:
        return (
            f"Axis(s = {self.scale:g} of {self.name}: {len(self.vertices):,} vertices, {len(self.edges):,} edges, "
            f"{len(self.polygons):,} polygons in {self.complex.sheets:,} sheets, of {len(self.balls):,} balls)"
        )
