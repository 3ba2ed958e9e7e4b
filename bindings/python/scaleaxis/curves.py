# SPDX-License-Identifier: Apache-2.0
"""Curve skeletons."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._progress import Progress, part_of, telling
from .data import MedialComplex, Polygons, core_of
from .errors import warn
from .files import Path
from .loading import load_with
from .page import NO_MESH, Page, boundary_of, page_path, viewed_axis, write_page
from .pipeline import axis as axis_of
from .result import Axis
from .solids import BallUnion
from .stages import Json, scaled

if TYPE_CHECKING:
    import networkx

SkeletonRadius = Literal["inscribed", "mean"]


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
    axis: Axis | None = field(default=None)  #: that it was made from; None: from a complex

    @property
    def ends(self) -> Ints:
        """The nodes of one edge."""
        return np.flatnonzero(self.degrees == 1).astype(np.int32)

    @property
    def junctions(self) -> Ints:
        """The nodes of three edges or more."""
        return np.flatnonzero(self.degrees > 2).astype(np.int32)

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

    def nearest_nodes(self, points: npt.ArrayLike, *, threads: int = 0) -> Ints:
        """For each of N × 3 points the node that it belongs to: see `Axis.nearest_vertices`."""
        return self.vertex_nodes[self._axis().nearest_vertices(points, threads=threads)]

    def _axis(self) -> Axis:
        if self.axis is None:
            raise ValueError("the skeleton was made from a complex: vertex_nodes has the node of each of its vertices")
        return self.axis

    def save(self, path: Path) -> None:
        """Writes SWC (a tree for each component, loops cut), GraphML, JSON, VTP (polylines) or PLY (an axis)."""
        _core.write_skeleton(path, self._fields())

    def view(self, path: Path | None = None) -> Page:
        """A page of the curves, coloured by radius, in the shape: see `Axis.view`."""
        name = self.axis.name if self.axis else "skeleton"
        path = page_path(path, name)
        curves = viewed_axis(_core.skeleton_complex(self._fields()), self.axis.scale if self.axis else 1.0)
        shape = boundary_of(self.axis) if self.axis else NO_MESH
        model = _core.view_data(name, *shape, [curves], json.dumps(self.statistics), None)
        return write_page(path, name, [model])

    def measures(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        pieces: Literal["whole", "components", "parts"] = "whole",
        *,
        angle: float = 120.0,
        threads: int = 0,
        progress: Progress = None,
    ) -> list[dict[str, Any]]:
        """Rows of a table: volume, area, thickness, sheets, branches and topology of the solid, of its components, or
        of its parts, what belongs to each branch. `pandas.DataFrame` takes them.

        vertices, faces: the closed surface of the solid; thickness is asked at its vertices.
        angle: as for `thickness`.
        """
        given = _arrays.mesh(vertices, faces)
        with telling(progress) as tell:
            rows = _core.measures(core_of(self._axis().complex), self._fields(), *given, pieces, angle, threads, tell)
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
        }

    def to_networkx(self) -> networkx.Graph[int]:
        """A graph: nodes with "pos", "radius", "branch" and "component", edges with "length"."""
        import networkx

        lengths = np.linalg.norm(np.diff(self.nodes[self.edges], axis=1)[:, 0], axis=1)
        graph: networkx.Graph[int] = networkx.Graph()
        for i, place in enumerate(self.nodes.tolist()):
            graph.add_node(
                i,
                pos=tuple(place),
                radius=float(self.radii[i]),
                branch=int(self.node_branches[i]),
                component=int(self.node_components[i]),
            )
        for (a, b), length in zip(self.edges.tolist(), lengths.tolist()):
            graph.add_edge(a, b, length=length)
        return graph

    def __repr__(self) -> str:
        return (
            f"Skeleton({len(self.nodes):,} nodes, {len(self.branches):,} branches, {len(self.ends):,} ends, "
            f"{len(self.junctions):,} junctions)"
        )


def _skeleton_of(core: dict[str, Any], axis: Axis | None) -> Skeleton:
    rest = {name: value for name, value in core.items() if not name.startswith(("branch_", "face_"))}
    rest["statistics"] = json.loads(rest["statistics"])
    return Skeleton(
        branches=Polygons(core["branch_offsets"], core["branch_nodes"]),
        faces=Polygons(core["face_offsets"], core["face_nodes"]),
        axis=axis,
        **rest,
    )


def skeleton(
    solid: Any,
    *,
    spacing: float | None = None,
    significance: float = 1.0,
    radius: SkeletonRadius = "inscribed",
    scale: float | None = None,
    threads: int = 0,
    progress: Progress = None,
    **options: Any,
) -> Skeleton:
    """The curve skeleton of a solid: its axis with the sheets reduced to curves, of the same homotopy type.

    solid: anything that `axis` takes, with the `options` of `axis`; an `Axis`, best one with `sharp=False`; or a
        `MedialComplex`.
    spacing: distance of the nodes along branches, at most, as a length; default: a hundredth of the diagonal.
    significance: how far a branch sticks out of the others to stay, relative to its own radius; 0: all of them.
    radius: "inscribed": of the largest ball in the solid around the node; "mean": mean distance to the surface in the
        plane normal to the branch, which noise does not make smaller; only for a solid.
    scale: factor s of the axis, default 1.1; of a complex: by which its balls had been grown, default 1.

    Sheets that enclose a void stay, as `faces`. Raises as `axis`.
    """

    def values(s: float) -> tuple[float, float, float, str, int]:
        return (0.0 if spacing is None else spacing, significance, s, radius, threads)

    if isinstance(solid, MedialComplex):
        with telling(progress) as tell:
            core = _core.skeleton(core_of(solid), *values(1.0 if scale is None else scale), tell)
        return _skeleton_of(core, None)
    if isinstance(solid, Axis):
        union = BallUnion(scaled(solid.balls, solid.scale))
        with telling(progress) as tell:
            core = _core.skeleton_in_union(core_of(solid.complex), union._core, *values(solid.scale), tell)
        return _skeleton_of(core, solid)
    s = 1.1 if scale is None else scale
    pipeline = {name: options.pop(name) for name in list(options) if name in _PIPELINE}
    with telling(progress) as tell:
        loaded = load_with(solid, options, threads, part_of(tell, 0.0, 0.1))  # type: ignore[arg-type]
        given = loaded.solid if loaded.solid is not None else loaded.samples
        axis = axis_of(given, scale=s, sharp=False, threads=threads, progress=part_of(tell, 0.1, 0.8), **pipeline)
        object.__setattr__(axis, "points", loaded.points)
        rest = part_of(tell, 0.8, 1.0)
        if loaded.solid is not None and loaded.solid.knows_nearest:
            core = _core.skeleton_in_solid(core_of(axis.complex), loaded.solid._core, *values(s), rest)
        else:
            union = BallUnion(scaled(axis.balls, s))
            core = _core.skeleton_in_union(core_of(axis.complex), union._core, *values(s), rest)
    warn(loaded.warnings)
    return _skeleton_of(core, axis)


_PIPELINE = (
    *("delta", "delta_abs", "delta_range", "angle", "clean", "clean_abs", "union", "smooth", "sampling"),
    *("keep_samples", "seed"),
)

__all__ = ["Skeleton", "SkeletonRadius", "skeleton"]
