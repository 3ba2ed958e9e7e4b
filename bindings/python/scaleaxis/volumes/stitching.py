# SPDX-License-Identifier: Apache-2.0
"""The parts of an axis put together: vertices are the same if their coordinates are, to the last bit."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt

from ..data import MedialComplex, Polygons
from ..files import write_axis
from .sources import Source

_Arrays = dict[str, npt.NDArray[np.float64]]


def part_of(content: bytes) -> _Arrays:
    with np.load(io.BytesIO(content)) as file:
        return dict(file)


def ply_of_part(part: _Arrays, source: Source, scale: float) -> bytes:
    """A part by itself, in units of the volume. Written here, for a complex of it would take as long as its axis."""
    vertices = np.column_stack([_places(part["vertices"], source), part["radii"] * source.spacing]).astype("<f8")
    offsets = np.asarray(part["face_offsets"], np.int64)
    sizes, curves = np.diff(offsets), np.asarray(part["curves"], "<i4").reshape(-1, 2)
    lines = ["ply", "format binary_little_endian 1.0", "comment made by scaleaxis", f"comment scale {scale!r}"]
    lines += [f"element vertex {len(vertices)}", *(f"property double {name}" for name in ("x", "y", "z", "radius"))]
    lines += [f"element face {len(sizes)}", "property list uchar int vertex_indices", "property double angle"]
    lines += [f"element edge {len(curves)}", "property int vertex1", "property int vertex2", "end_header", ""]
    out = io.BytesIO()
    out.write("\n".join(lines).encode() + vertices.tobytes())
    for size in np.unique(sizes):  # records of the same length
        there = np.flatnonzero(sizes == size)
        rows = np.empty(len(there), [("count", "u1"), ("corners", "<i4", (size,)), ("angle", "<f8")])
        rows["count"], rows["angle"] = size, part["angles"][there]
        for corner in range(size):
            rows["corners"][:, corner] = part["face_vertices"][offsets[there] + corner]
        out.write(rows.tobytes())
    out.write(curves.tobytes())
    return out.getvalue()


def vtp_of_part(part: _Arrays, source: Source, scale: float) -> bytes:
    """The same by the library's writer, with the sheet of each face within the part."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.vtp"
        write_axis(file, stitched([part], source, scale), polygons=True)
        return file.read_bytes()


def _numbered(vertices: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """The positions of distinct vertices, ascending by x, y, z, and the number of each vertex among them."""
    order = np.lexsort(vertices.T[::-1])
    ordered = vertices[order]
    is_new = np.ones(len(order), bool)
    is_new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    numbers = np.empty(len(order), np.int64)
    numbers[order] = np.cumsum(is_new) - 1
    return order[is_new], numbers


def _ordered(faces: Polygons, angles: npt.NDArray[np.float64]) -> tuple[Polygons, npt.NDArray[np.float64]]:
    """Ascending by their corners. Faces that share three are the same, and none is there twice."""
    firsts = [faces.indices[faces.offsets[:-1] + k] for k in (2, 1, 0)]
    order = np.lexsort(firsts)
    sizes = faces.sizes[order]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    at = np.arange(offsets[-1]) + np.repeat(faces.offsets[:-1][order] - offsets[:-1], sizes)
    return Polygons(offsets.astype(np.int32), faces.indices[at]), angles[order]


def _places(voxels: npt.NDArray[np.float64], source: Source) -> npt.NDArray[np.float64]:
    """In space. Written out, for products of matrices may be rounded otherwise on another machine."""
    if source.is_upright:
        upright: npt.NDArray[np.float64] = voxels * source.spacing + np.array(source.origin)
        return upright
    places = np.tile(np.array(source.origin), (len(voxels), 1))
    sides = [voxels[:, [axis]] * source.spacing * np.array(source.directions[axis]) for axis in range(3)]
    places += sides[0] + sides[1] + sides[2]
    return places


def stitched(parts: Iterable[_Arrays], source: Source, scale: float) -> MedialComplex:
    """In units of the volume. The same whatever the parts are, and in whatever order they come."""
    vertices, radii, sizes, corners, angles, curves = [], [], [], [], [], []
    count = 0
    for part in parts:
        vertices.append(part["vertices"])
        radii.append(part["radii"])
        sizes.append(np.diff(part["face_offsets"]))
        corners.append(part["face_vertices"].astype(np.int64) + count)
        angles.append(part["angles"])
        curves.append(part["curves"].astype(np.int64) + count)
        count += len(part["vertices"])
    if not vertices:
        return MedialComplex.from_polygons(np.empty((0, 3)), np.empty(0))
    places = np.concatenate(vertices)
    distinct, numbers = _numbered(places)
    offsets = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
    lists = Polygons(offsets.astype(np.int32), numbers[np.concatenate(corners)].astype(np.int32))
    faces, face_angles = _ordered(lists, np.concatenate(angles))
    edges = np.sort(numbers[np.concatenate(curves)], axis=1)
    complex = MedialComplex.from_polygons(
        _places(places[distinct], source),
        np.concatenate(radii)[distinct] * source.spacing,
        faces,
        edges[np.lexsort(edges.T[::-1])].astype(np.int32),
        scale,
    )
    complex.face_angles[:] = face_angles
    return complex
