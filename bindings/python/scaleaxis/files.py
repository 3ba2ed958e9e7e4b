# SPDX-License-Identifier: Apache-2.0
"""Reading and writing files. The format follows from content or extension: docs/formats.md describes each.

Readers take a path, or the bytes of a file; then `name` begins messages, and its extension tells the format where the
bytes do not.
"""

from __future__ import annotations

import gzip
import os
import shutil
import tempfile
from collections.abc import Mapping
from typing import Any, Literal, Union, cast

import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._options import checked
from .adapt import as_balls, as_complex, as_image, as_mesh, core_of_image
from .data import Image, MedialComplex, Mesh, MeshObject, PointCloud, complex_of, core_of, image_of
from .errors import warn, warnings_of

Path = Union[str, os.PathLike[str]]
FileKind = Literal["mesh", "points", "balls", "axis", "image"]


@checked
def file_kind(file: Path) -> FileKind:
    """What a file holds."""
    return cast(FileKind, _core.file_kind(file))


@checked
def read_mesh(file: Path | bytes, name: str = "input") -> Mesh:
    """A mesh from OBJ, OFF, PLY, STL, VTK, 3MF or glTF, all objects together: see `read_objects`."""
    core = _core.read_mesh(file, name)
    return Mesh(core["vertices"], core["triangles"])


@checked
def read_objects(file: Path | bytes, name: str = "input") -> list[MeshObject]:
    """All objects of a mesh file, at their places; of a format without objects there is one, without a name."""
    objects, warnings = _core.read_objects(file, name)
    warn(warnings_of(warnings))
    return [MeshObject(name, Mesh(core["vertices"], core["triangles"])) for name, core in objects]


@checked
def read_points(file: Path | bytes, name: str = "input") -> PointCloud:
    """Points from text (.xyz, .pts, .pwn), tables (.csv, .tsv), LAS, PCD or VTK; the vertices of meshes."""
    return PointCloud(*_core.read_points(file, name))


@checked
def read_balls(file: Path | bytes, name: str = "input") -> Floats:
    """Balls, N × 4, from PLY, text (x y z r a line) or .woff."""
    return _core.read_balls(file, name)


@checked
def read_axis(file: Path | bytes, name: str = "input", scale: float | None = None) -> MedialComplex:
    """A medial axis from PLY or .ma. PLY of `write_axis` say its scale, and which vertices are centres of balls.

    `scale`: by which the balls of a union had been grown, in place of what the file says. Without it, radii of files
    that name no centres of balls are linear between vertices, and the scale of those that do not say it is 1.
    """
    return complex_of(_core.read_axis(file, name, scale))


@checked
def read_image(file: Path | bytes, name: str = "input") -> Image:
    """A 3D image from NIfTI, NRRD, MetaImage, TIFF, VTK (.vtk, .vti), NumPy (.npy, .npz), INRIMAGE or DGtal's formats, in
    the coordinates of the file.
    """
    return image_of(_core.read_image(file, name))


@checked
def write_mesh(file: Path, mesh: Any) -> None:
    """A mesh, as `axis` takes it, to PLY, OBJ, OFF or STL."""
    _core.write_mesh(file, *as_mesh(mesh))


@checked
def write_balls(file: Path, balls: Any) -> None:
    """Balls, N × 4 or those of a result, to PLY, text or .woff."""
    _core.write_balls(file, as_balls(balls))


@checked
def write_axis(
    file: Path,
    axis: Any,
    *,
    polygons: bool = False,
    values: Mapping[str, npt.ArrayLike] | None = None,
) -> None:
    """An axis to PLY, which keeps its scale in a comment, .ma, VTP, OBJ or GLB.

    polygons: PLY as binary polygons and edges, in place of the triangles that more programs read.
    values: numbers of each vertex by their names, as {"erosion_thickness": …}; PLY and VTP have them. Those that are
        not finite are written as -1.
    """
    given = [(name, _arrays.floats(numbers, name, (), finite=False)) for name, numbers in (values or {}).items()]
    _core.write_axis(file, core_of(as_complex(axis)), polygons, given)


@checked
def write_image(file: Path, image: Any) -> None:
    """An image, as `axis` takes it, to NRRD or NIfTI (.nii, .nii.gz). Raises ValueError for integers beyond 2^24."""
    known = as_image(image)
    _arrays.check_kept(known.values)
    content = (*core_of_image(known), (known.unit, known.space))
    if not _is_packed(file):
        _core.write_image(file, *content)
        return
    check_image_output(file)
    with tempfile.TemporaryDirectory() as folder:
        plain = os.path.join(folder, "image.nii")
        _core.write_image(plain, *content)
        # No time in the file: the same image is the same bytes.
        with open(plain, "rb") as source, open(file, "wb") as target, gzip.GzipFile("", "wb", 6, target, 0) as packed:
            shutil.copyfileobj(source, packed)


def _is_packed(file: Path) -> bool:
    return os.fspath(file).lower().endswith(".nii.gz")


@checked
def check_mesh_output(file: Path) -> None:
    """Raises FileError if `write_mesh` could not write there: to be asked before a long computation."""
    _core.check_mesh_output(file)


@checked
def check_balls_output(file: Path) -> None:
    """The same for `write_balls`."""
    _core.check_balls_output(file)


@checked
def check_axis_output(file: Path) -> None:
    """The same for `write_axis`."""
    _core.check_axis_output(file)


@checked
def check_image_output(file: Path) -> None:
    """The same for `write_image`."""
    _core.check_image_output(os.fspath(file)[:-3] if _is_packed(file) else file)
