# SPDX-License-Identifier: Apache-2.0
"""Whatever users have → the plain data of this package.

Objects of other packages are known by what they have; the packages are not imported for it.
"""

from __future__ import annotations

import os
from typing import Any, TypeGuard, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import stood_for
from .cad import is_shape, is_step, mesh_of_shape, mesh_of_step
from .data import Image, MedialComplex, Mesh, PointCloud, complex_of, image_of


def is_path(given: Any) -> TypeGuard[str | os.PathLike[str]]:
    return isinstance(given, (str, os.PathLike))


def _mesh_of_scene(scene: Any) -> Any:
    """All meshes of a scene of trimesh, at their places."""
    return scene.to_mesh() if hasattr(scene, "to_mesh") else scene.dump(concatenate=True)


def _surface_of_grid(grid: Any) -> Any:
    try:
        return grid.extract_surface(algorithm=None)
    except TypeError:  # PyVista before 0.47
        return grid.extract_surface()


def _of_pyvista(given: Any) -> Mesh | PointCloud | Image:
    """Of a grid of cubes the active scalars as voxels, if it has any; of others the surface, or else the points."""
    scalars = given.active_scalars if hasattr(given, "direction_matrix") else None
    if scalars is not None:
        is_of_cells = len(scalars) != given.n_points
        sizes = [n - 1 if is_of_cells else n for n in given.dimensions]
        steps = np.asarray(given.direction_matrix) * np.asarray(given.spacing)
        first = np.asarray(given.extent[::2]) + (0.5 if is_of_cells else 0.0)  # not 0 in parts; the middle of a cell
        origin = np.asarray(given.origin) + steps @ first
        return Image(np.asarray(scalars).reshape(sizes, order="F"), origin, steps.T)
    surface = given if hasattr(given, "is_all_triangles") else _surface_of_grid(given)
    triangles = (surface if surface.is_all_triangles else surface.triangulate()).faces
    if len(triangles) == 0:
        return PointCloud(surface.points, np.empty((0, 3)))
    return Mesh(surface.points, np.asarray(triangles).reshape(-1, 4)[:, 1:])


_UNITS_OF_NIBABEL = {"mm": "mm", "meter": "m", "micron": "um"}


def _of_nibabel(image: Any) -> Image:
    affine = np.asarray(image.affine, dtype=np.float64)
    units = getattr(image.header, "get_xyzt_units", None)  # those of other formats than NIfTI have none
    unit = _UNITS_OF_NIBABEL.get(units()[0], "") if units else ""
    values = np.asanyarray(image.dataobj)
    values = values.reshape(values.shape[:3] + tuple(n for n in values.shape[3:] if n != 1))
    return Image(values, affine[:3, 3], affine[:3, :3].T, unit, "right-anterior-superior")


def _unit_of_simpleitk(image: Any) -> str:
    """Of metres and micrometres in NIfTI SimpleITK converts the spacing alone: then no unit is true."""
    if image.HasMetaDataKey("xyzt_units"):
        return "mm" if int(image.GetMetaData("xyzt_units")) & 7 == 2 else ""
    return cast(str, image.GetMetaData("ITK_VoxelUnits")) if image.HasMetaDataKey("ITK_VoxelUnits") else ""


def _of_simpleitk(image: Any) -> Image:
    import SimpleITK

    direction = np.asarray(image.GetDirection(), dtype=np.float64)
    if direction.shape != (9,):
        raise ValueError(f"the image must have three dimensions, not {image.GetDimension()}")
    # A copy: a view does not keep the image alive, which may be gone before it is looked at.
    values = SimpleITK.GetArrayFromImage(image).T
    place = {"spacing": image.GetSpacing(), "direction": direction.reshape(3, 3)}
    unit = _unit_of_simpleitk(image)
    return Image(values, image.GetOrigin(), unit=unit, space="left-posterior-superior", **place)


def adapted(given: Any) -> Any:
    """A path, function, `Mesh`, `Image`, `PointCloud`, `MedialComplex`, `Samples`, `Solid`, `Envelope`, or an array."""
    given = stood_for(given)
    if is_path(given) and is_step(given):
        return mesh_of_step(given)
    if is_path(given) or isinstance(given, (np.ndarray, Mesh, Image, PointCloud, MedialComplex)):
        return given
    if isinstance(given, (tuple, list)):
        is_mesh = len(given) == 2 and np.ndim(given[0]) == 2
        return Mesh(given[0], given[1]) if is_mesh else np.asarray(given)
    if hasattr(given, "geometry") and hasattr(given, "graph"):
        given = _mesh_of_scene(given)
    if hasattr(given, "extract_surface") and hasattr(given, "n_cells"):
        return _of_pyvista(given)
    if hasattr(given, "dataobj") and hasattr(given, "affine"):
        return _of_nibabel(given)
    if hasattr(given, "GetDirection") and hasattr(given, "GetSpacing"):
        return _of_simpleitk(given)
    if is_shape(given):
        return mesh_of_shape(given)
    if hasattr(given, "vertices"):
        faces = getattr(given, "faces", None) if hasattr(given, "faces") else getattr(given, "triangles", None)
        return PointCloud(given.vertices, np.empty((0, 3))) if faces is None else Mesh(given.vertices, faces)
    if hasattr(given, "__array__") or hasattr(given, "__dlpack__"):
        return np.asarray(given)
    return given


def described(given: Any) -> str:
    if isinstance(given, np.ndarray):
        return f"an array of shape {given.shape}"
    return "None" if given is None else type(given).__name__


def _read_as(given: Any, kind: str) -> Any:
    """What a file holds, in place of its path."""
    if not is_path(given):
        return given
    if kind == "mesh":
        core = _core.read_mesh(given, "input")
        return Mesh(core["vertices"], core["triangles"])
    if kind == "image":
        return image_of(_core.read_image(given, "input"))
    if kind == "axis":
        return complex_of(_core.read_axis(given, "input", None))
    return _core.read_balls(given, "input") if _core.file_kind(given) == "balls" else _read_as(given, "axis")


def as_mesh(given: Any, faces: npt.ArrayLike | None = None) -> tuple[Floats, Ints]:
    """Vertices and triangles of a mesh in any form, or of a file; or of arrays with `faces` beside the vertices."""
    if faces is not None:
        return _arrays.mesh(given, faces)
    mesh = _read_as(adapted(given), "mesh")
    if not isinstance(mesh, Mesh):
        raise TypeError(f"a mesh is needed, as (vertices, faces), not {described(mesh)}")
    return _arrays.mesh(*mesh)


def as_image(given: Any) -> Image:
    """An image in any form, or of a file; of an array one with voxels of size 1."""
    image = _read_as(adapted(given), "image")
    if isinstance(image, np.ndarray):
        image = Image(image)
    if not isinstance(image, Image):
        raise TypeError(f"an image is needed, as an array of three dimensions, not {described(image)}")
    return image


def core_of_image(given: Any) -> tuple[npt.NDArray[np.float32], Floats]:
    """The values and the place of an image in any form, as the C++ part takes them."""
    image = as_image(given)
    place = np.vstack([_arrays.scalars(image.origin, "origin", 3), image.steps])
    return _arrays.voxels(image.values), np.ascontiguousarray(place)


def as_complex(given: Any) -> MedialComplex:
    """The medial complex that a result has, or a file."""
    known = _read_as(adapted(given), "axis")
    if not isinstance(known, MedialComplex):
        raise TypeError(f"an axis or a MedialComplex is needed, not {described(known)}")
    return known


def as_balls(given: Any) -> Floats:
    """N × 4 numbers, the balls of a result or of a file; those of an axis on sharp edges add nothing to a union."""
    known = _read_as(adapted(given), "balls")
    if not isinstance(known, MedialComplex):
        return _arrays.balls(known)
    return _arrays.balls(known.balls[known.radii != 0.0])


