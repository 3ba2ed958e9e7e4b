# SPDX-License-Identifier: Apache-2.0
"""Results as objects of other packages, which are imported when asked for; as pictures and as tables."""

from __future__ import annotations

import html
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, Ints

if TYPE_CHECKING:
    import navis
    import networkx
    import osteoid
    import pyvista
    import trimesh

Values = Mapping[str, npt.NDArray[Any]]


class Lists(Protocol):
    """`Polygons`, whose module needs this one."""

    @property
    def offsets(self) -> Ints: ...
    @property
    def indices(self) -> Ints: ...
    @property
    def sizes(self) -> Ints: ...


def pyvista_of(
    vertices: Floats, polygons: Lists, lines: Ints, of_points: Values, of_polygons: Values
) -> pyvista.PolyData:
    """Points that are in nothing else, lines and polygons, with values; copies. For other cells than polygons values
    are -1, or 0 where they have fractions.
    """
    import pyvista

    alone = np.setdiff1d(np.arange(len(vertices)), np.concatenate([polygons.indices, lines.ravel()]))
    # Each list of corners with its length before it.
    cells = np.insert(polygons.indices, polygons.offsets[:-1], polygons.sizes)
    lists = np.insert(lines, 0, 2, axis=1).ravel()
    places = vertices.copy()
    data = pyvista.PolyData(
        places,
        faces=cells if len(cells) else None,
        lines=lists if len(lists) else None,
        verts=np.insert(alone[:, None], 0, 1, axis=1).ravel() if len(alone) else None,
    )
    for name, values in of_points.items():
        data.point_data[name] = values.copy()
    for name, values in of_polygons.items():
        others = np.full(len(alone) + len(lines), 0 if values.dtype.kind == "f" else -1, dtype=values.dtype)
        data.cell_data[name] = np.concatenate([others, values])
    return data


def trimesh_of(vertices: Floats, triangles: Ints, of_vertices: Values, of_faces: Values) -> trimesh.Trimesh:
    """Triangles with values; copies."""
    import trimesh

    return trimesh.Trimesh(
        vertices=vertices.copy(),
        faces=triangles.copy(),
        process=False,
        vertex_attributes={name: values.copy() for name, values in of_vertices.items()},
        face_attributes={name: values.copy() for name, values in of_faces.items()},
    )


def networkx_of(vertices: Floats, edges: Ints, of_vertices: Values, **about: Any) -> networkx.Graph[int]:
    """A graph: nodes with "pos" and values, edges with "length"."""
    import networkx

    lengths = np.linalg.norm(np.diff(vertices[edges], axis=1)[:, 0], axis=1)
    graph: networkx.Graph[int] = networkx.Graph(**about)
    columns = [values.tolist() for values in of_vertices.values()]
    for i, (place, *values) in enumerate(zip(vertices.tolist(), *columns)):
        graph.add_node(i, pos=tuple(place), **dict(zip(of_vertices, values)))
    for (a, b), length in zip(edges.tolist(), lengths.tolist()):
        graph.add_edge(a, b, length=length)
    return graph


def osteoid_of(vertices: Floats, edges: Ints, radii: Floats, transform: Floats) -> osteoid.Skeleton:
    """Vertices and edges in places, and how voxels lead there; copies in its types."""
    import osteoid

    return osteoid.Skeleton(
        vertices=vertices.astype(np.float32),
        edges=edges.astype(np.uint32),
        radii=radii.astype(np.float32),
        transform=transform.astype(np.float32),
        space="physical",
    )


def navis_of(nodes: Floats, radii: Floats, tree: Ints, parents: Ints, name: str) -> navis.TreeNeuron:
    """Trees as a navis.TreeNeuron, whose node ids are those of the nodes."""
    import navis
    import pandas

    x, y, z = nodes[tree].T
    above = np.where(parents >= 0, tree[parents], -1)
    columns = {"node_id": tree, "parent_id": above, "x": x, "y": y, "z": z, "radius": radii[tree], "label": 0}
    return navis.TreeNeuron(pandas.DataFrame(columns), name=name)


def plotted(
    data: pyvista.PolyData,
    shape: tuple[Floats, Ints] | None,
    plotter: pyvista.Plotter | None,
    options: Mapping[str, Any],
) -> Any:
    """Draws `data` in a translucent shape. Returns what `show` does, or the plotter given, to which it is added."""
    import pyvista

    canvas = pyvista.Plotter() if plotter is None else plotter
    if shape is not None:
        surface = pyvista.PolyData.from_regular_faces(*shape)
        canvas.add_mesh(surface, color="white", opacity=0.2, smooth_shading=True, split_sharp_edges=True)
    canvas.add_mesh(data, **{"line_width": 3, **options})
    return canvas.show() if plotter is None else plotter


def table_of(title: str, rows: Mapping[str, object]) -> str:
    """HTML that notebooks show."""
    cells = "".join(
        f'<tr><th style="text-align: left">{html.escape(name)}</th>'
        f'<td style="text-align: left">{html.escape(str(value))}</td></tr>'
        for name, value in rows.items()
    )
    return f"<table><caption>{html.escape(title)}</caption>{cells}</table>"


def span_of(values: Floats) -> str:
    """The least and the largest value in words."""
    return f"{values.min():.4g} … {values.max():.4g}" if len(values) else "none"
