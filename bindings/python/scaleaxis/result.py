# SPDX-License-Identifier: Apache-2.0
"""Results of a run: the axis of a solid, and what is made of it. They know each other, and so share a file."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, Ints
from ._options import Length, Seed, checked
from ._progress import Progress, part_of, telling
from .adapt import as_mesh
from .data import MedialComplex, Mesh, Polygons, Samples, Topology, complex_of, core_of, mesh_after
from .errors import InvalidOption, Warning, warn, warnings_of
from .files import Path, write_axis, write_mesh
from .loading import load_with
from .measures import Thickness, thickness
from .objects import navis_of, networkx_of, osteoid_of, plotted, pyvista_of, span_of, table_of, trimesh_of
from .page import NO_MESH, Page, boundary_of, page_path, view, viewed_axis, write_page
from .similarity import similarity_of
from .solids import BallUnion
from .stages import Json, densify, erosion_thickness, scaled
from .surfaces import UnionMesh, mesh

if TYPE_CHECKING:
    import navis
    import networkx
    import osteoid
    import pandas
    import pyvista
    import trimesh

SkeletonRadius = Literal["inscribed", "mean"]


class Tables(NamedTuple):
    """An axis as tables of pandas."""

    #: a row for each: x, y, z, radius, angle (the largest of its polygons; NaN: none), sheets (how many)
    vertices: pandas.DataFrame
    #: a row for each: polygons (how many), area, angle (the largest), radius_min, radius_mean, radius_max
    sheets: pandas.DataFrame
    #: one row; columns as "axis.result.sheets"
    statistics: pandas.DataFrame


@dataclass(frozen=True, eq=False, repr=False)
class Axis:
    """The discrete scale axis of a solid for one scale.

    Its vertices carry the radius of a ball inside the solid. Faces are convex polygons, in sheets that meet at seams;
    edges without a face are curves.
    """

    complex: MedialComplex
    balls: Floats  #: B × 4: the union of balls that approximates the solid, before growing; shared by all scales
    ball_contacts: Floats  #: B × 2 × 3: where each touches the boundary of the solid; empty if they were not fitted
    tolerance: float  #: δ as a length
    diagonal: float  #: of the solid's bounding box
    statistics: Mapping[str, Any]  #: as the program's JSON, see docs/statistics.md, with the axis under "axis"
    warnings: list[Warning]
    boundary: Mesh | None = None  #: of an input that was a mesh: that mesh, repaired
    samples: Samples | None = None  #: with `keep_samples`
    points: Floats | None = None  #: P × 3: vertices or points of the input, as given; of a file, those of `boundary`
    #: 3 × 4: of an image, takes the indices of a voxel to its place, in the units of the axis. Others: the identity.
    transform: Floats = field(default_factory=lambda: np.eye(3, 4))
    is_mask: bool = False  #: of an image: each voxel is solid or is not, where no `iso` was given
    name: str = field(default="solid")

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex

    @property
    def scale(self) -> float:
        """The factor by which its balls had been grown, and the radii divided."""
        return self.complex.scale

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
        return self.complex.curves

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

    @cached_property
    def mesh_map(self) -> Ints:
        """P: for each of the `points` of the input the vertex of the axis that it belongs to, see `nearest_vertices`.
        Computed when it is first asked for. Raises ValueError if the input had no points: an image, function, solid….
        """
        if self.points is None:
            raise ValueError(
                f"{self.name} was given without vertices or points that could be mapped: use nearest_vertices(points)"
            )
        return self.nearest_vertices(self.points)

    @checked
    def nearest_vertices(self, points: npt.ArrayLike, *, threads: int = 0) -> Ints:
        """For each of N × 3 points the vertex of the axis whose ball is nearest: the one with the least signed distance,
        to the vertex less its radius, of several the first. Inside balls that is the one in which the point is deepest.
        Vertices on sharp edges, of radius 0, do not count.
        """
        vertices = np.flatnonzero(self.radii > 0.0)  # balls on sharp edges add nothing to a union
        union = BallUnion(self.complex.balls[vertices])
        return vertices[union.nearest_balls(points, threads=threads)[0]].astype(np.int32)

    @checked
    def thickness(
        self,
        points: Any = None,
        *,
        angle: float = 128.0,
        edge: float = 0.01,
        threads: int = 0,
        progress: Progress = None,
    ) -> Thickness:
        """Local thickness and thickness at the foot point, at N × 3 points of the surface, or of a mesh; default: of the
        mesh of the input. See `scaleaxis.thickness`.
        """
        return thickness(self, points, angle=angle, edge=edge, threads=threads, progress=progress)

    def transformed(self, matrix: npt.ArrayLike) -> Axis:
        """The axis, its balls, and all that belongs to them after a similarity, 3 × 4 or 4 × 4: rotation, reflection,
        one factor for all directions, and shift. Others are refused with InvalidOption: balls would not stay balls.

        `tolerance` and `diagonal` are multiplied by the factor, `transform` then leads to the new places; `statistics`
        stay those of the run, in its units.
        """
        similarity = similarity_of(matrix)
        return replace(
            self,
            complex=self.complex.transformed(matrix),
            balls=similarity.balls(self.balls),
            ball_contacts=similarity.points(self.ball_contacts),
            tolerance=self.tolerance * similarity.factor,
            diagonal=self.diagonal * similarity.factor,
            boundary=self.boundary and mesh_after(self.boundary, similarity),
            samples=self.samples and self.samples.transformed(matrix),
            points=None if self.points is None else similarity.points(self.points),
            transform=similarity.linear @ self.transform + np.column_stack([np.zeros((3, 3)), similarity.shift]),
        )

    @checked
    def densified(self, *, threads: int = 0, progress: Progress = None) -> MedialComplex:
        """The axis with so many vertices that the union of their balls is the simplified solid."""
        return densify(self.complex, threads=threads, progress=progress)

    @checked
    def mesh(
        self,
        *,
        delta_abs: float | None = None,
        seed: Seed = 1,
        threads: int = 0,
        progress: Progress = None,
    ) -> UnionMesh:
        """The simplified solid as a closed triangle mesh. `delta_abs`: default: the tolerance of the axis."""
        with telling(progress) as tell:
            dense = self.densified(threads=threads, progress=part_of(tell, 0.0, 0.1))
            return mesh(
                dense,
                delta_abs=self.tolerance if delta_abs is None else delta_abs,
                seed=seed,
                threads=threads,
                progress=part_of(tell, 0.1, 1.0),
            )

    @checked
    def skeleton(
        self,
        *,
        node_spacing: Length | None = None,
        significance: float = 1.0,
        radius: SkeletonRadius = "inscribed",
        threads: int = 0,
        progress: Progress = None,
    ) -> Skeleton:
        """The curve skeleton of the axis, best of one with `sharp=False`: see `scaleaxis.skeleton`."""
        union = BallUnion(scaled(self.balls, self.scale))
        options = node_spacing or 0.0, significance, radius, threads
        with telling(progress) as tell:
            return skeleton_of(_core.skeleton_in_union(core_of(self.complex), union._core, *options, tell), self)

    @checked
    def midsurface(
        self, *, angle: float = 64.0, extend: bool = True, threads: int = 0, progress: Progress = None
    ) -> Midsurface:
        """What of the axis lies between opposite sides of walls: see `scaleaxis.midsurface`."""
        with telling(progress) as tell:
            core = _core.midsurface(core_of(self.complex), None, angle, extend, threads, tell)
        return midsurface_of(core, self, partial(_core.shells, core_of(self.complex), None, angle))

    @checked
    def save(self, path: Path, *, polygons: bool = False) -> None:
        """Writes the axis to PLY, .ma, VTP, OBJ or GLB; to PLY and VTP with the erosion thickness of its vertices.

        polygons: PLY as binary polygons and edges, in place of the triangles that more programs read.
        """
        has_values = str(path).lower().endswith((".ply", ".vtp"))
        values = {"erosion_thickness": erosion_thickness(self.complex).thickness} if has_values else {}
        write_axis(path, self.complex, polygons=polygons, values=values)

    @checked
    def view(self, path: Path | None = None) -> Page:
        """An interactive page. In Jupyter it shows itself as the value of a cell; elsewhere open its `path`."""
        return view(self, path)

    def to_trimesh(self) -> trimesh.Trimesh:
        """The triangles as a trimesh.Trimesh, a copy, with the radii in `vertex_attributes["radius"]`."""
        triangles, owner = self.polygons.triangulated()
        of_faces: dict[str, npt.NDArray[Any]] = {"sheet": self.sheets[owner], "angle": self.angles[owner]}
        return trimesh_of(self.vertices, triangles, {"radius": self.radii}, of_faces)

    def to_pyvista(self) -> pyvista.PolyData:
        """Isolated balls, curves and polygons as cells of a pyvista.PolyData, in this order, with "radius" of points,
        "sheet" and "angle" of cells; a copy.
        """
        return self.complex.to_pyvista()

    def to_networkx(self) -> networkx.Graph[int]:
        """Vertices and edges as a graph: nodes with "pos" and "radius", edges with "length"."""
        return networkx_of(self.vertices, self.edges, {"radius": self.radii}, scale=self.scale)

    def to_osteoid(self) -> osteoid.Skeleton:
        """Vertices and all edges as an osteoid.Skeleton in physical space, with `transform`; a copy in single
        precision. A curve skeleton is what most of its methods are for: see `Skeleton.to_osteoid`. Its `voxel_space()` (0.7) takes
        the origin off last, which is right where voxels have the size 1 or the origin is 0.
        """
        return osteoid_of(self.vertices, self.edges, self.radii, self.transform)

    def plot(self, *, shape: bool = True, plotter: pyvista.Plotter | None = None, **options: Any) -> Any:
        """Draws the axis by PyVista, coloured by radius.

        shape: whether the surface of the solid is drawn around it, translucent.
        plotter: to add it to; it is returned, and not shown. Default: a new one, which is shown.
        options: of `pyvista.Plotter.add_mesh`, as `scalars="sheet"`.
        """
        surface = boundary_of(self) if shape else None
        return plotted(self.to_pyvista(), surface, plotter, {"scalars": "radius", **options})

    def to_pandas(self) -> Tables:
        """Vertices, sheets and statistics as tables of pandas."""
        import pandas

        polygons, radii, sheets = self.polygons, self.radii, self.sheets
        owner = np.repeat(np.arange(len(polygons)), polygons.sizes)  # of each corner
        angles = np.full(len(radii), -np.inf)
        np.maximum.at(angles, polygons.indices, self.angles[owner])
        # Vertices of sheets, each once.
        members = np.unique(np.stack([sheets[owner], polygons.indices], axis=1), axis=0)
        vertices = pandas.DataFrame(self.vertices, columns=["x", "y", "z"], copy=True)
        vertices["radius"] = radii.copy()
        vertices["angle"] = np.where(np.isfinite(angles), angles, np.nan)
        vertices["sheets"] = np.bincount(members[:, 1], minlength=len(radii))

        triangles, polygon = polygons.triangulated()
        a, b, c = (self.vertices[triangles[:, k]] for k in range(3))
        normals = np.zeros((len(polygons), 3))  # vectors, so that what folds back does not count twice
        np.add.at(normals, polygon, np.cross(b - a, c - a) / 2)
        areas = np.linalg.norm(normals, axis=1)
        count = self.complex.sheets
        in_sheets = pandas.Series(radii[members[:, 1]]).groupby(members[:, 0])
        table = pandas.DataFrame(
            {
                "polygons": np.bincount(sheets, minlength=count),
                "area": np.bincount(sheets, weights=areas, minlength=count),
                "angle": pandas.Series(self.angles).groupby(sheets).max(),
                "radius_min": in_sheets.min(),
                "radius_mean": in_sheets.mean(),
                "radius_max": in_sheets.max(),
            },
            index=pandas.RangeIndex(count, name="sheet"),
        )
        vertices.index.name = "vertex"
        return Tables(vertices, table, pandas.json_normalize(dict(self.statistics)))

    def _repr_html_(self) -> str:
        topology = self.topology
        rows = {
            "vertices": f"{len(self.vertices):,}",
            "edges": f"{len(self.edges):,}, {len(self.curves):,} of them curves",
            "polygons": f"{len(self.polygons):,} in {self.complex.sheets:,} sheets",
            "radii": span_of(self.radii),
            "balls of the solid": f"{len(self.balls):,}",
            "tolerance δ": f"{self.tolerance:.4g}, {self.tolerance / self.diagonal:.3g} of the diagonal",
            "topology": f"{topology.components} components, {topology.tunnels} tunnels, {topology.voids} voids",
            **({"warnings": "; ".join(map(str, self.warnings))} if self.warnings else {}),
        }
        return table_of(f"Axis of {self.name}, s = {self.scale:g}", rows)

    def __repr__(self) -> str:
        return (
            f"Axis(s = {self.scale:g} of {self.name}: {len(self.vertices):,} vertices, {len(self.edges):,} edges, "
            f"{len(self.polygons):,} polygons in {self.complex.sheets:,} sheets, of {len(self.balls):,} balls)"
        )


def _three(place: npt.ArrayLike) -> list[float]:
    numbers = np.asarray(place, dtype=np.float64)
    if numbers.shape != (3,):
        raise ValueError(f"a place has three numbers, and not shape {numbers.shape}")
    return cast(list[float], numbers.tolist())


class BranchGeometry(NamedTuple):
    """A branch as a curve in space; arrays have a row for each of its nodes."""

    abscissas: Floats  #: lengths from its first node
    curvature: Floats
    torsion: Floats  #: positive: a right-handed helix; 0 where the curve is straight
    tangents: Floats
    normals: Floats  #: to the centre of curvature
    binormals: Floats
    parallel_normals: Floats  #: normals that do not turn around the curve
    length: float
    tortuosity: float  #: length / distance of the ends - 1


class Sections(NamedTuple):
    """Cross-sections of a solid at the nodes of its skeleton, in planes normal to the branches."""

    areas: Floats
    least_widths: Floats  #: of the chords through the node
    largest_widths: Floats
    is_closed: npt.NDArray[np.bool_]  #: False: the plane runs on into other parts of the solid, as at junctions


@dataclass(frozen=True, eq=False, repr=False)
class Skeleton:
    """A curve skeleton: nodes with radii, edges between them, and the branches that they form."""

    nodes: Floats  #: N × 3
    radii: Floats  #: N
    edges: Ints  #: E × 2
    branches: Polygons  #: the nodes of each branch, from one end or junction to the next
    node_branches: Ints  #: N: a branch that the node is on, of a junction the thickest; -1: none
    node_components: Ints  #: N
    degrees: Ints  #: N: the number of edges: 1 at ends, 3 or more at junctions
    faces: Polygons  #: of sheets around voids, which no curve can stand for
    vertex_nodes: Ints  #: of each vertex of the axis: the node that it has shrunk to
    statistics: Json
    section_values: Floats = field(default_factory=lambda: np.empty((0, 4)))  #: see `sections`
    root: int = -1  #: the node that the tree of its component grows from; -1: the thickest end
    axis: Axis | None = field(default=None)  #: that it was made from; None: from a complex

    @property
    def _stands_for(self) -> MedialComplex:
        return complex_of(_core.skeleton_complex(self._fields()))

    @property
    def ends(self) -> Ints:
        """The nodes of one edge."""
        return np.flatnonzero(self.degrees == 1).astype(np.int32)

    @property
    def junctions(self) -> Ints:
        """The nodes where three or more branches meet."""
        edges = [np.concatenate([branch[:-1], branch[1:]]) for branch in self.branches]
        nodes = np.concatenate(edges) if edges else np.empty(0, np.int32)
        return np.flatnonzero(np.bincount(nodes, minlength=len(self.nodes)) > 2).astype(np.int32)

    @cached_property
    def lengths(self) -> Floats:
        """The length of each branch."""
        steps = [np.diff(self.nodes[branch], axis=0) for branch in self.branches]
        return np.array([np.linalg.norm(step, axis=1).sum() for step in steps])

    @cached_property
    def mesh_map(self) -> Ints:
        """Of each vertex or point of the input the node that it belongs to; `node_branches[mesh_map]` are its parts.
        Raises ValueError if the input had no points.
        """
        return self.vertex_nodes[self._axis().mesh_map]

    @checked
    def nearest_nodes(self, points: npt.ArrayLike, *, threads: int = 0) -> Ints:
        """For each of N × 3 points the node that it belongs to: see `Axis.nearest_vertices`."""
        return self.vertex_nodes[self._axis().nearest_vertices(points, threads=threads)]

    def _axis(self) -> Axis:
        if self.axis is None:
            raise ValueError("the skeleton was made from a complex: vertex_nodes has the node of each of its vertices")
        return self.axis

    @checked
    def save(self, path: Path) -> None:
        """Writes SWC (a tree for each component, loops cut), GraphML, JSON, VTP (polylines, with VMTK's arrays), CSV
        (`cylinders`) or PLY (an axis). Warns of what a file of trees loses.
        """
        warn(warnings_of(_core.write_skeleton(path, self._fields())))

    @checked
    def rooted_at(self, place: npt.ArrayLike) -> Skeleton:
        """The same, with the node nearest to a place as `root`: trees and centerlines lead away from it."""
        return replace(self, root=_core.nearest_node(self._fields(), _three(place)))

    @checked
    def path(self, start: npt.ArrayLike, end: npt.ArrayLike) -> Skeleton:
        """The shortest way along the curves between the nodes nearest to two places: a skeleton of one branch. Raises
        UnusableInput if no curve leads from one to the other.
        """
        return skeleton_of(_core.path_between(self._fields(), _three(start), _three(end)))

    @checked
    def resampled(self, step: float) -> Skeleton:
        """The same curves with nodes at even steps along each branch, of at most `step`; without `sections`."""
        return skeleton_of(_core.resampled(self._fields(), step), self.axis)

    @checked
    def with_sections(self, solid: Any, *, threads: int = 0, progress: Progress = None) -> Skeleton:
        """The same with `sections` of the solid, which is anything that `axis` takes."""
        with telling(progress) as tell:
            loaded = load_with(solid, {}, threads, tell)
            if loaded.solid is None:
                raise ValueError("sections need a solid, and points without normals are none: give a mesh or an image")
            core = _core.with_sections(self._fields(), loaded.solid._core, threads, tell)
        return skeleton_of(core, self.axis)

    @property
    def sections(self) -> Sections | None:
        """Area and widths of cross-sections at each node, if they were asked for: see `with_sections`."""
        area, least, largest, closed = self.section_values.T
        return Sections(area, least, largest, closed != 0) if len(self.section_values) else None

    @checked
    def geometry(self, branch: int) -> BranchGeometry:
        """Frames, curvature and torsion along a branch, of cubics fitted to the nodes within twice the radius."""
        if not 0 <= branch < len(self.branches):
            raise IndexError(f"there is no branch {branch}: there are {len(self.branches)}")
        return BranchGeometry(**_core.branch_geometry(self._fields(), branch))

    def cylinders(self) -> dict[str, npt.NDArray[Any]]:
        """A quantitative structure model: columns, a row for each edge, in the terms of TreeQSM. `pandas.DataFrame`
        takes them. Ids, branches and positions count from 1; parent 0: none.
        """
        numbers, places = _core.cylinders(self._fields())
        parent, branch, order, position = places.T
        names = ("start_x", "start_y", "start_z", "axis_x", "axis_y", "axis_z", "length", "radius")
        return {
            "id": np.arange(1, len(parent) + 1, dtype=np.int32),
            "parent": parent + 1,
            **dict(zip(names, numbers.T)),
            "branch": branch + 1,
            "branch_order": order,
            "position_in_branch": position + 1,
        }

    @checked
    def view(self, path: Path | None = None) -> Page:
        """A page of the curves, coloured by radius, in the shape: see `Axis.view`."""
        name = self.axis.name if self.axis else "skeleton"
        path = page_path(path, name)
        scale = self.axis.scale if self.axis else 1.0
        curves = viewed_axis({**_core.skeleton_complex(self._fields()), "scale": scale})
        shape = boundary_of(self.axis) if self.axis else NO_MESH
        model = _core.view_data(name, *shape, [curves], json.dumps(self.statistics), None)
        return write_page(path, name, [model])

    @checked
    def measures(
        self,
        vertices: Any,
        faces: npt.ArrayLike | None = None,
        pieces: Literal["whole", "components", "parts"] = "whole",
        *,
        angle: float = 128.0,
        threads: int = 0,
        progress: Progress = None,
    ) -> list[dict[str, Any]]:
        """Rows of a table: volume, area, thickness, sheets, branches and topology of the solid, of its components, or
        of its parts, what belongs to each branch and then to what has none. `pandas.DataFrame` takes them.

        vertices, faces: the closed surface of the solid, two arrays or one mesh; thickness is asked at its vertices. What
            it has twice, as where parts overlap, counts twice: take `axis.mesh()` instead.
        angle: as for `thickness`.
        """
        axis = self._axis()
        given = Mesh(*as_mesh(vertices, faces))
        with telling(progress) as tell:
            first, rest = part_of(tell, 0.0, 0.5), part_of(tell, 0.5, 1.0)
            local = thickness(axis, given, angle=angle, edge=0.0, threads=threads, progress=first).local
            rows = _core.measures(core_of(axis.complex), self._fields(), *given, local, pieces, threads, rest)
        return [json.loads(row) for row in rows]

    def _fields(self) -> dict[str, Any]:
        return {
            "nodes": self.nodes,
            "radii": self.radii,
            "edges": self.edges,
            "branch_offsets": self.branches.offsets,
            "branch_nodes": self.branches.indices,
            "node_branches": self.node_branches,
            "node_components": self.node_components,
            "face_offsets": self.faces.offsets,
            "face_nodes": self.faces.indices,
            "vertex_nodes": self.vertex_nodes,
            "section_values": self.section_values,
            "root": self.root,
        }

    def to_networkx(self) -> networkx.Graph[int]:
        """A graph: nodes with "pos", "radius", "branch" and "component", edges with "length"."""
        return networkx_of(self.nodes, self.edges, self._node_values())

    def to_pyvista(self) -> pyvista.PolyData:
        """Edges and `faces` as a pyvista.PolyData with "radius", "branch" and "component" of points; a copy."""
        return pyvista_of(self.nodes, self.faces, self.edges, self._node_values(), {})

    def to_osteoid(self) -> osteoid.Skeleton:
        """An osteoid.Skeleton in physical space, with `transform` of the axis; a copy in single precision."""
        transform = np.eye(3, 4) if self.axis is None else self.axis.transform
        return osteoid_of(self.nodes, self.edges, self.radii, transform)

    def to_navis(self) -> navis.TreeNeuron:
        """A navis.TreeNeuron: trees as in SWC; node ids are those of `nodes`. Warns of loops that were cut."""
        tree, parents, cuts = _core.skeleton_tree(self._fields())
        warn(warnings_of(cuts))
        return navis_of(self.nodes, self.radii, tree, parents, self.axis.name if self.axis else "skeleton")

    def plot(self, *, shape: bool = True, plotter: pyvista.Plotter | None = None, **options: Any) -> Any:
        """Draws the curves by PyVista, coloured by radius: see `Axis.plot`."""
        surface = boundary_of(self.axis) if shape and self.axis else None
        return plotted(self.to_pyvista(), surface, plotter, {"scalars": "radius", **options})

    def _node_values(self) -> dict[str, npt.NDArray[Any]]:
        values: dict[str, npt.NDArray[Any]] = {
            "radius": self.radii,
            "branch": self.node_branches,
            "component": self.node_components,
        }
        return {**values, "section_area": self.sections.areas} if self.sections else values

    def _repr_html_(self) -> str:
        rows = {
            "nodes": f"{len(self.nodes):,}",
            "branches": f"{len(self.branches):,}",
            "ends": f"{len(self.ends):,}",
            "junctions": f"{len(self.junctions):,}",
            "radii": span_of(self.radii),
            "length": f"{self.lengths.sum():.4g}",
        }
        return table_of("Skeleton", rows)

    def __repr__(self) -> str:
        return (
            f"Skeleton({len(self.nodes):,} nodes, {len(self.branches):,} branches, {len(self.ends):,} ends, "
            f"{len(self.junctions):,} junctions)"
        )


def skeleton_of(core: dict[str, Any], axis: Axis | None = None) -> Skeleton:
    rest = {name: value for name, value in core.items() if not name.startswith(("branch_", "face_"))}
    rest["statistics"] = json.loads(rest["statistics"])
    return Skeleton(
        branches=Polygons(core["branch_offsets"], core["branch_nodes"]),
        faces=Polygons(core["face_offsets"], core["face_nodes"]),
        axis=axis,
        **rest,
    )


@dataclass(frozen=True, eq=False, repr=False)
class Midsurface:
    """A surface halfway between the sides of walls: sheets that meet in seams, in the units of the axis."""

    vertices: Floats  #: V × 3
    triangles: Ints  #: T × 3; an edge of a seam has three of them or more
    thickness: Floats  #: V: diameter of the ball there
    triangle_sheets: Ints  #: T
    areas: Floats  #: S: of the sheets, the largest first
    means: Floats  #: S: mean thickness over the area
    minima: Floats  #: S: least thickness
    maxima: Floats  #: S: largest thickness
    seams: int  #: chains of edges of three triangles or more
    seam_length: float
    complex: MedialComplex  #: the surface as a medial complex, for all that takes one
    axis: Axis | None = field(default=None)  #: that it was made from; None: from a complex
    _shells: Callable[[float, int, Any], dict[str, Any]] | None = field(default=None)

    def __getstate__(self) -> dict[str, Any]:  # a solid cannot be pickled
        return {**vars(self), "_shells": None}

    @property
    def _stands_for(self) -> MedialComplex:
        return self.complex

    @checked
    def shells(self, size: float, *, threads: int = 0, progress: Progress = None) -> ShellMesh:
        """A mesh for the finite-element method: conforming triangles with edges about `size` long."""
        if self._shells is None:
            raise InvalidOption("this midsurface has lost what it was made from: ask the function that makes one")
        with telling(progress) as tell:
            return ShellMesh(**self._shells(size, threads, tell))

    @checked
    def save(self, path: Path) -> None:
        """Writes PLY and VTP with thickness and sheets, OBJ with a group for each sheet, GLB; or STL and OFF."""
        if str(path).lower().endswith((".stl", ".off")):
            write_mesh(path, Mesh(self.vertices, self.triangles))
        else:
            write_axis(path, self.complex, values={"thickness": self.thickness})

    def to_trimesh(self) -> trimesh.Trimesh:
        """The triangles as a trimesh.Trimesh, a copy, with `vertex_attributes["thickness"]`."""
        return trimesh_of(self.vertices, self.triangles, {"thickness": self.thickness}, {"sheet": self.triangle_sheets})

    def to_pyvista(self) -> pyvista.PolyData:
        """The triangles as a pyvista.PolyData with "thickness" of points and "sheet" of cells; a copy."""
        corners = Polygons(np.arange(0, self.triangles.size + 1, 3, dtype=np.int32), self.triangles.reshape(-1))
        none = np.empty((0, 2), dtype=np.int32)
        return pyvista_of(self.vertices, corners, none, {"thickness": self.thickness}, {"sheet": self.triangle_sheets})

    def plot(self, *, shape: bool = True, plotter: pyvista.Plotter | None = None, **options: Any) -> Any:
        """Draws the sheets by PyVista, coloured by thickness: see `Axis.plot`."""
        surface = boundary_of(self.axis) if shape and self.axis else None
        return plotted(self.to_pyvista(), surface, plotter, {"scalars": "thickness", **options})

    def _repr_html_(self) -> str:
        rows = {
            "triangles": f"{len(self.triangles):,} in {len(self.areas):,} sheets",
            "area": f"{self.areas.sum():.4g}",
            "thickness": span_of(self.thickness),
            "seams": f"{self.seams:,}, {self.seam_length:.4g} long",
        }
        return table_of("Midsurface", rows)

    def __repr__(self) -> str:
        return f"Midsurface({len(self.triangles):,} triangles, {len(self.areas):,} sheets, {self.seams:,} seams)"


@dataclass(frozen=True, eq=False, repr=False)
class ShellMesh:
    """The midsurface of walls for the finite-element method: where walls meet, they share vertices."""

    vertices: Floats  #: V × 3
    triangles: Ints  #: T × 3
    thickness: Floats  #: T × 3: of the wall at the corners of each triangle
    triangle_sheets: Ints  #: T: smooth parts, between seams, bends and borders
    middles: Floats  #: E × 3: of the edges, for quadratic elements
    triangle_middles: Ints  #: T × 3: of the sides from each corner to the next
    areas: Floats  #: S: of the sheets, the largest first
    means: Floats  #: S: mean thickness over the area
    minima: Floats  #: S: least thickness; the same as the largest where a sheet is even
    maxima: Floats  #: S: largest thickness
    seam_length: float
    border_length: float
    least_angle: float  #: of all triangles, in degrees
    mean_edge: float  #: length

    @checked
    def save(self, path: Path, *, order: Annotated[int, range(1, 3)] | None = None) -> None:
        """Writes .inp (CalculiX, Abaqus), .bdf (Nastran), .msh (Gmsh) or .vtu.

        order: 1, triangles with three nodes; 2, with six; None: 2 in .inp, 1 in the others.
        """
        _core.write_shells(path, vars(self), order or 0)

    def to_trimesh(self) -> trimesh.Trimesh:
        """The triangles as a trimesh.Trimesh, a copy, with `face_attributes["sheet"]`."""
        return trimesh_of(self.vertices, self.triangles, {}, {"sheet": self.triangle_sheets})

    def __repr__(self) -> str:
        return f"ShellMesh({len(self.triangles):,} triangles, {len(self.areas):,} sheets)"


def midsurface_of(
    core: dict[str, Any], axis: Axis | None, shells: Callable[[float, int, Any], dict[str, Any]]
) -> Midsurface:
    rest = {name: value for name, value in core.items() if name != "complex"}
    return Midsurface(complex=complex_of(core["complex"]), axis=axis, _shells=shells, **rest)
