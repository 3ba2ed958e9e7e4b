# SPDX-License-Identifier: Apache-2.0
"""A server of the Model Context Protocol over standard input and output: `scaleaxis-mcp`, or `python -m scaleaxis.mcp`.

Tools take the path of a file and return JSON; `walls` and `thickness` a picture, too. `pip install scaleaxis[mcp]`.
"""

from __future__ import annotations

import json
import struct
import warnings
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Floats
from .covering import spheres as few_spheres
from .curves import skeleton as curve_skeleton
from .data import Mesh
from .findings import thickness_at
from .findings import walls as find_walls
from .kernels import nearest
from .loading import load
from .measures import with_short_edges
from .pipeline import axis
from .stages import Json

_PIXELS = 480
_TRIANGLES = 300  # along the diagonal: squares of three pixels leave no gaps
_VIEW = np.array([[0.87, 0.5, 0.0], [-0.25, 0.43, 0.87], [0.43, -0.75, 0.5]])  # right, up, to the viewer
_BELOW = np.array([[-1.0], [1.0], [-1.0]])  # right and depth turn round


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = np.insert(pixels.reshape(height, -1), 0, 0, axis=1).tobytes()
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def picture_of(mesh: Mesh, colors: npt.NDArray[np.uint8]) -> bytes:
    """A PNG of a mesh with a colour (RGB) for each vertex, seen from above, and from below on the other side."""
    extent = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) or 1.0
    fine = with_short_edges(mesh, extent / _TRIANGLES)
    corners = fine.vertices[fine.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    places = corners.mean(axis=1)
    of_mesh = np.asarray(mesh.triangles)[nearest(mesh, places).triangles]
    to_corners = np.linalg.norm(np.asarray(mesh.vertices)[of_mesh] - places[:, None], axis=2)
    shown = colors[of_mesh[np.arange(len(of_mesh)), to_corners.argmin(axis=1)]]
    middle = (fine.vertices.min(axis=0) + fine.vertices.max(axis=0)) / 2
    return _png(np.hstack([_points_seen(places - middle, normals, shown, view) for view in (_VIEW, _VIEW * _BELOW)]))


def _points_seen(
    places: Floats, normals: Floats, colors: npt.NDArray[np.uint8], view: Floats
) -> npt.NDArray[np.uint8]:
    """Those that face the viewer, as squares of 3 pixels, the nearest last."""
    seen = places @ view.T
    scale = 0.9 * _PIXELS / max(float(2 * np.abs(seen[:, :2]).max(initial=0.0)), 1e-300)
    slopes = normals @ view[2]
    order = np.argsort(seen[:, 2], kind="stable")
    order = order[slopes[order] > 0]
    at = np.clip((seen[order, :2] * [scale, -scale] + _PIXELS / 2).astype(int), 1, _PIXELS - 2)
    shaded = (colors[order] * (0.45 + 0.55 * slopes[order, None])).astype(np.uint8)
    pixels = np.full((_PIXELS, _PIXELS, 3), 255, dtype=np.uint8)
    depths = np.full((_PIXELS, _PIXELS), -np.inf)
    for dx, dy in np.ndindex(3, 3):
        np.maximum.at(depths, (at[:, 1] + dy - 1, at[:, 0] + dx - 1), seen[order, 2])
    near = depths[at[:, 1], at[:, 0]] <= seen[order, 2] + 4 / scale  # not what shows through between points
    for dx, dy in np.ndindex(3, 3):
        pixels[at[near, 1] + dy - 1, at[near, 0] + dx - 1] = shaded[near]
    return pixels


def _colors_of(values: Floats, most: float) -> npt.NDArray[np.uint8]:
    """Red where they are small, blue where they are large."""
    part = np.clip(np.asarray(values) / most, 0, 1)[:, None]
    return np.asarray(np.array([220, 50, 40]) * (1 - part) + np.array([90, 140, 220]) * part, dtype=np.uint8)


def _quiet(work: Callable[[], Any]) -> tuple[Any, list[str]]:
    """What a function returns, and its warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = work()
    return result, [str(warning.message) for warning in caught]


def info(path: str) -> Json:
    """What is in the file of a solid: bounds, volume, area, topology, repairs, faults. Lengths in its units."""
    loaded, told = _quiet(lambda: load(path))
    return {"kind": loaded.kind, "input": loaded.report, "warnings": told}


def walls_and_picture(
    path: str, min_wall: float | None, min_gap: float | None, max_wall: float | None
) -> tuple[Json, bytes]:
    found, told = _quiet(lambda: find_walls(path, min_wall=min_wall, min_gap=min_gap, max_wall=max_wall))
    colors = np.full((len(found.surface.vertices), 3), (190, 196, 206), dtype=np.uint8)
    for findings, color in ((found.gap_findings, (240, 160, 60)), (found.wall_findings, (220, 50, 40))):
        if findings is not None:
            colors[findings >= 0] = color
    return {**found.document, "warnings": told}, picture_of(found.surface, colors)


def thickness_and_picture(path: str, points: list[list[float]] | None) -> tuple[Json, bytes | None]:
    if points is not None:
        values, told = _quiet(lambda: thickness_at(path, points))
        return {"thickness": values.tolist(), "warnings": told}, None
    measured, told = _quiet(lambda: axis(path).thickness())
    local, mesh = measured.local, measured.surface
    least, most = int(local.argmin()), int(local.argmax())
    document = {
        "minimum": float(local[least]),
        "minimum_place": mesh.vertices[least].tolist(),
        "maximum": float(local[most]),
        "maximum_place": mesh.vertices[most].tolist(),
        "warnings": told,
    }
    return document, picture_of(mesh, _colors_of(local, float(local[most])))


def skeleton(path: str) -> Json:
    """The curve skeleton of a solid: nodes with radii, edges, branches as lists of nodes, and its topology."""
    found, told = _quiet(lambda: curve_skeleton(path))
    return {
        "nodes": found.nodes.tolist(),
        "radii": found.radii.tolist(),
        "edges": found.edges.tolist(),
        "branches": [branch.tolist() for branch in found.branches],
        "statistics": found.statistics,
        "warnings": told,
    }


def spheres(path: str, count: int = 32, inside: bool = False) -> Json:
    """A few balls that cover a solid with the least protrusion, or that lie inside it: centres and radii."""
    found, told = _quiet(lambda: few_spheres(path, count, inside=inside))
    return {"balls": np.asarray(found.balls).tolist(), "warnings": told}


def server() -> Any:
    """The server, with its tools."""
    try:
        from mcp.server.mcpserver import Image, MCPServer
    except ImportError:  # version 1
        from mcp.server.fastmcp import FastMCP as MCPServer
        from mcp.server.fastmcp import Image

    made = MCPServer("scaleaxis", instructions="Walls, gaps, thickness, skeletons and spheres of solids in files.")

    def shown(document: Json, picture: bytes | None) -> list[Any]:
        text = json.dumps(document)
        return [text] if picture is None else [text, Image(data=picture, format="png")]

    def walls(
        path: str, min_wall: float | None = None, min_gap: float | None = None, max_wall: float | None = None
    ) -> list[Any]:
        """Walls of a solid that are thinner than min_wall or thicker than max_wall, and gaps narrower than min_gap, as
        JSON, each with place, value, direction and area, and a picture: walls red, gaps orange. Lengths in units of
        the file (STL, OBJ, 3MF, STEP with cadquery-ocp…).
        """
        return shown(*walls_and_picture(path, min_wall, min_gap, max_wall))

    def thickness(path: str, points: list[list[float]] | None = None) -> list[Any]:
        """Wall thickness of a solid: at points on its surface, or else the least and the largest with their places and
        a picture, red where it is thin.
        """
        return shown(*thickness_and_picture(path, points))

    for tool in (info, walls, thickness, skeleton, spheres):
        made.add_tool(tool, structured_output=False)
    return made


def main() -> None:
    server().run()


if __name__ == "__main__":
    main()
