# SPDX-License-Identifier: Apache-2.0
"""Whatever users have → a solid. Other packages are known by what their objects have, and are not imported for it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._progress import Progress, Tell, telling
from .data import Image, MedialComplex, Mesh, Samples, core_of_image
from .errors import InvalidOption, Warning, warn, warnings_of
from .files import FileKind
from .solids import BallUnion, Solid, checked_function, cloud
from .stages import Json, samples_of

PointsMethod = Literal["mls", "crust"]
TriangleSolid = Literal["auto", "winding", "wrap", "thicken"]


class InputOptions(TypedDict, total=False):
    """How an input becomes a solid. Options of another kind of input are refused."""

    kind: FileKind | None
    triangles: TriangleSolid | None
    opening: float | None
    thickness: float | None
    normals: npt.ArrayLike | None
    points: PointsMethod | None
    kernel: float | None
    spacing: float | npt.ArrayLike | None
    origin: npt.ArrayLike | None
    direction: npt.ArrayLike | None
    iso: float | None
    below: bool
    labels: float | Sequence[float] | None
    nonzero: bool
    mask_smoothing: float | None
    bounds: npt.ArrayLike | None
    smallest_feature: float | None


_OF_MESHES = {"triangles", "opening", "thickness"}
_OF_FILES = {"kind", "iso", "below", "labels", "nonzero", "mask_smoothing", "points", "kernel"} | _OF_MESHES
_OF_IMAGES = {"iso", "below", "labels", "nonzero", "mask_smoothing"}
_OF_VOXELS = _OF_IMAGES | {"spacing", "origin", "direction"}
_OF_POINTS = {"normals", "points", "kernel"}
_OF_FUNCTIONS = {"bounds", "smallest_feature"}


@dataclass(frozen=True, eq=False)
class LoadedSolid:
    """A solid, or in its place the samples of its boundary where the input is such samples already."""

    kind: str  #: "mesh", "image", "points", "union", "function" or "solid"
    solid: Solid | None
    samples: Samples | None
    mesh: Mesh | None  #: of a mesh, repaired
    report: Json  #: what is in the input
    warnings: list[Warning]
    costs: list[Json]


def _loaded(core: dict[str, Any]) -> LoadedSolid:
    mesh = Mesh(core["mesh"]["vertices"], core["mesh"]["triangles"])
    return LoadedSolid(
        kind=core["kind"],
        solid=core["solid"] and Solid(core["solid"]),
        samples=core["samples"] and samples_of(core["samples"]),
        mesh=mesh if len(mesh.triangles) else None,
        report=json.loads(core["input"]),
        warnings=warnings_of(core["warnings"]),
        costs=json.loads(core["costs"]),
    )


def _of_solid(kind: str, solid: Solid | None, samples: Samples | None = None) -> LoadedSolid:
    return LoadedSolid(kind, solid, samples, None, {}, solid.warnings if solid else [], [])


def _surface_of_grid(grid: Any) -> Any:
    try:
        return grid.extract_surface(algorithm=None)
    except TypeError:  # PyVista before 0.47
        return grid.extract_surface()


def mesh_of(given: Any) -> tuple[npt.ArrayLike, npt.ArrayLike] | None:
    """Vertices and faces of what may be a mesh: of trimesh, PyVista, Open3D or a pair."""
    if isinstance(given, (tuple, list)) and len(given) == 2 and np.ndim(given[0]) == 2:
        return given[0], given[1]
    if hasattr(given, "extract_surface") and hasattr(given, "n_cells"):  # a mesh or a grid of PyVista
        surface = given if hasattr(given, "is_all_triangles") else _surface_of_grid(given)
        triangles = (surface if surface.is_all_triangles else surface.triangulate()).faces
        return surface.points, np.asarray(triangles).reshape(-1, 4)[:, 1:]
    if hasattr(given, "vertices") and hasattr(given, "faces"):
        return given.vertices, given.faces
    if hasattr(given, "vertices") and hasattr(given, "triangles"):
        return given.vertices, given.triangles
    return None


def _image_of(given: Any) -> Image | None:
    """An image of nibabel, SimpleITK, or of the library."""
    if isinstance(given, Image):
        return given
    if hasattr(given, "dataobj") and hasattr(given, "affine"):
        affine = np.asarray(given.affine, dtype=np.float64)
        return Image(np.asanyarray(given.dataobj), affine[:3, 3], affine[:3, :3].T)
    if hasattr(given, "GetDirection") and hasattr(given, "GetSpacing"):
        import SimpleITK

        direction = np.asarray(given.GetDirection(), dtype=np.float64)
        if direction.shape != (9,):
            raise ValueError(f"the image must have three dimensions, not {given.GetDimension()}")
        steps = (direction.reshape(3, 3) * np.asarray(given.GetSpacing())).T
        return Image(SimpleITK.GetArrayViewFromImage(given).T, np.asarray(given.GetOrigin()), steps)
    return None


def _labels(given: float | Sequence[float] | None) -> list[float]:
    return [] if given is None else cast("list[float]", np.atleast_1d(np.asarray(given, dtype=np.float64)).tolist())


def _image_arguments(options: InputOptions) -> tuple[float | None, bool, list[float], bool, float | None]:
    return (
        options.get("iso"),
        options.get("below", False),
        _labels(options.get("labels")),
        options.get("nonzero", False),
        options.get("mask_smoothing"),
    )


def _mesh_arguments(options: InputOptions) -> tuple[str | None, float, float]:
    return options.get("triangles"), options.get("opening") or 0.0, options.get("thickness") or 0.0


def _load_image(image: Image, options: InputOptions, threads: int, tell: Tell | None) -> LoadedSolid:
    iso, below, labels, nonzero, smoothing = _image_arguments(options)
    values, place = core_of_image(image)
    return _loaded(_core.load_image(values, place, iso, below, labels, nonzero, smoothing, threads, tell))


def _load_function(
    function: Callable[[Floats], npt.ArrayLike], options: InputOptions, threads: int, tell: Tell | None
) -> LoadedSolid:
    bounds = options.get("bounds")
    if bounds is None:
        raise InvalidOption("a function needs bounds: the least and the largest coordinates of a box around the solid")
    feature = options.get("smallest_feature") or 0.0
    solid = Solid(_core.function_solid(checked_function(function), _arrays.box(bounds), feature, threads, tell))
    return _of_solid("function", solid)


def _refuse(options: InputOptions, allowed: set[str], kind: str) -> None:
    given = {name for name, value in options.items() if value is not None and value is not False}
    if given - allowed:
        names = ", ".join(sorted(given - allowed))
        raise InvalidOption(f"{names} has no effect on {kind}: leave it out", "option")


def _load(given: Any, options: InputOptions, threads: int, tell: Tell | None) -> LoadedSolid:
    if isinstance(given, (str, os.PathLike)):
        _refuse(options, _OF_FILES, "a file")
        method, kernel = options.get("points"), options.get("kernel")
        images = _image_arguments(options)
        triangles = _mesh_arguments(options)
        return _loaded(_core.load_file(given, options.get("kind"), *images, method, kernel, *triangles, threads, tell))
    if isinstance(given, Samples):
        _refuse(options, set(), "samples")
        return _of_solid("samples", None, given)
    if isinstance(given, Solid):
        _refuse(options, set(), "a solid")
        return _of_solid("solid", given)
    balls = given.balls if isinstance(given, (BallUnion, MedialComplex)) else None
    mesh = None if balls is not None else mesh_of(given)
    if mesh is not None:
        _refuse(options, _OF_MESHES, "a mesh")
        return _loaded(_core.load_mesh(*_arrays.mesh(*mesh), *_mesh_arguments(options), threads, tell))
    image = _image_of(given)
    if image is not None:
        _refuse(options, _OF_IMAGES, "an image")
        return _load_image(image, options, threads, tell)
    if callable(given):
        _refuse(options, _OF_FUNCTIONS, "a function")
        return _load_function(given, options, threads, tell)
    array = np.asarray(given if balls is None else balls)
    if array.ndim == 3:
        _refuse(options, _OF_VOXELS, "an array of voxels")
        place = _arrays.place(options.get("spacing"), options.get("origin"), options.get("direction"))
        return _load_image(Image(array, place[0], place[1:]), options, threads, tell)
    if array.ndim == 2 and array.shape[1] == 3:
        _refuse(options, _OF_POINTS, "points")
        arrays = cloud(array, options.get("normals"))
        return _loaded(_core.load_points(*arrays, options.get("points"), options.get("kernel"), threads, tell))
    if array.ndim == 2 and array.shape[1] == 4:
        _refuse(options, set(), "balls")
        return _of_solid("union", Solid(_core.union_solid(_arrays.balls(array), threads, tell)))
    what = f"an array of shape {array.shape}" if array.dtype != object else type(given).__name__
    raise ValueError(
        f"{what} is no solid: give a path, (vertices, faces), a mesh of trimesh or PyVista, voxels (three dimensions), "
        "an image of nibabel or SimpleITK, points (N × 3), balls (N × 4), or a function with bounds"
    )


def load_with(given: Any, options: InputOptions, threads: int, tell: Tell | None) -> LoadedSolid:
    """`load` without the warnings."""
    chosen = cast(InputOptions, {name: value for name, value in options.items() if value is not None})
    return _load(given, chosen, threads, tell)


def load(
    solid: Any,
    *,
    kind: FileKind | None = None,
    triangles: TriangleSolid | None = None,
    opening: float | None = None,
    thickness: float | None = None,
    normals: npt.ArrayLike | None = None,
    points: PointsMethod | None = None,
    kernel: float | None = None,
    spacing: float | npt.ArrayLike | None = None,
    origin: npt.ArrayLike | None = None,
    direction: npt.ArrayLike | None = None,
    iso: float | None = None,
    below: bool = False,
    labels: float | Sequence[float] | None = None,
    nonzero: bool = False,
    mask_smoothing: float | None = None,
    bounds: npt.ArrayLike | None = None,
    smallest_feature: float | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> LoadedSolid:
    """Makes a solid of anything that `axis` takes, with the same options. (In C++: `load_solid`.)"""
    options = InputOptions(
        kind=kind,
        triangles=triangles,
        opening=opening,
        thickness=thickness,
        normals=normals,
        points=points,
        kernel=kernel,
        spacing=spacing,
        origin=origin,
        direction=direction,
        iso=iso,
        below=below,
        labels=labels,
        nonzero=nonzero,
        mask_smoothing=mask_smoothing,
        bounds=bounds,
        smallest_feature=smallest_feature,
    )
    with telling(progress) as tell:
        loaded = load_with(solid, options, threads, tell)
    warn(loaded.warnings)
    return loaded


__all__ = ["InputOptions", "LoadedSolid", "PointsMethod", "TriangleSolid", "load"]
