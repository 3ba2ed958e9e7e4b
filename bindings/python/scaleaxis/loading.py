# SPDX-License-Identifier: Apache-2.0
"""Whatever users have → a solid. Other packages are known by what their objects have, and are not imported for it."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, TypedDict, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._progress import Progress, Tell, telling
from .data import Image, MedialComplex, Mesh, Samples, core_of_image
from .errors import InvalidOption, Warning, warn, warnings_of
from .files import FileKind, Path, read_image
from .solids import BallUnion, Solid, checked_function, cloud
from .stages import Json, samples_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

PointsMethod = Literal["mls", "crust"]
TriangleSolid = Literal["auto", "winding", "wrap", "thicken"]

#: A value, and whether it is a length; else it is a part of the diagonal of the bounding box.
Length = tuple[float, bool] | None


class InputOptions(TypedDict, total=False):
    """How an input becomes a solid, see `axis`. Options of another kind of input are refused."""

    kind: FileKind | None  #: of a file, where its extension does not tell
    triangles: TriangleSolid | None  #: what triangles make solid; default: "auto"
    opening: float | None  #: of "wrap": the diameter of the ball, a length
    thickness: float | None  #: of "thicken": twice the distance from the triangles, a length
    objects: int | Sequence[int] | None  #: of a file with several: numbers from 1, see `read_objects`; default: all
    normals: npt.ArrayLike | None  #: of points, N × 3, outward
    points: PointsMethod | None  #: how points become a solid; default: what suits them
    kernel: float | None  #: of "mls": radius of the weights' support, in spacings of the points
    spacing: float | npt.ArrayLike | None  #: of voxels, for each index or for all
    origin: npt.ArrayLike | None  #: the place of the first voxel
    direction: npt.ArrayLike | None  #: 3 × 3, one column for each index
    iso: float | None  #: of levels of grey: the solid is above this one
    below: bool  #: or below it
    labels: float | Sequence[float] | None  #: of a label image: those that are solid
    nonzero: bool  #: all but 0 are
    mask_smoothing: float | None  #: of masks and labels: standard deviation of the Gaussian, in voxels; 0: none
    bounds: npt.ArrayLike | None  #: of a function, 2 × 3: a box in which its solid ends
    smallest_feature: float | None  #: diameter of parts that are found for sure; default: 1/128 of the box's diagonal
    clip: bool  #: the solid is closed at the bounds


_OF_MESHES = {"triangles", "opening", "thickness"}
_OF_FILES = {"kind", "objects", "iso", "below", "labels", "nonzero", "mask_smoothing", "points", "kernel"} | _OF_MESHES
_OF_IMAGES = {"iso", "below", "labels", "nonzero", "mask_smoothing"}
_OF_PLACES = {"spacing", "origin", "direction"}
_OF_VOXELS = _OF_IMAGES | _OF_PLACES
_OF_POINTS = {"normals", "points", "kernel"}
_OF_FUNCTIONS = {"bounds", "smallest_feature", "clip"}


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
    points: Floats | None = None  #: P × 3: vertices or points of the input, as given; those of the mesh, of a file
    transform: Floats = field(default_factory=lambda: np.eye(3, 4))  #: 3 × 4, of an image: indices → places


def _transform_of(report: Json) -> Floats:
    """Of an image, as the library tells where it lies."""
    directions, spacing = np.array(report["directions"]), np.array(report["spacing"])
    return np.column_stack([directions.T * spacing, report["origin"]])


def loaded_of(core: dict[str, Any], points: Floats | None = None) -> LoadedSolid:
    mesh = Mesh(core["mesh"]["vertices"], core["mesh"]["triangles"])
    report: Json = json.loads(core["input"])
    loaded = LoadedSolid(
        kind=core["kind"],
        solid=core["solid"] and Solid(core["solid"]),
        samples=core["samples"] and samples_of(core["samples"]),
        mesh=mesh if len(mesh.triangles) else None,
        report=report,
        warnings=warnings_of(core["warnings"]),
        costs=json.loads(core["costs"]),
        points=mesh.vertices if points is None and len(mesh.triangles) else points,
    )
    return replace(loaded, transform=_transform_of(report)) if loaded.kind == "image" else loaded


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


_UNITS_OF_NIBABEL = {"mm": "mm", "meter": "m", "micron": "um"}
def _unit_of_nibabel(image: Any) -> str:
    units = getattr(image.header, "get_xyzt_units", None)  # those of other formats than NIfTI have none
    return _UNITS_OF_NIBABEL.get(units()[0], "") if units else ""


def _unit_of_simpleitk(image: Any) -> str:
    """Of metres and micrometres in NIfTI SimpleITK converts the spacing alone: then no unit is true."""
    if image.HasMetaDataKey("xyzt_units"):
        return "mm" if int(image.GetMetaData("xyzt_units")) & 7 == 2 else ""
    return cast(str, image.GetMetaData("ITK_VoxelUnits")) if image.HasMetaDataKey("ITK_VoxelUnits") else ""


def _image_of(given: Any) -> Image | None:
    """An image of nibabel, SimpleITK, or of the library."""
    if isinstance(given, Image):
        return given
    if hasattr(given, "dataobj") and hasattr(given, "affine"):
        affine = np.asarray(given.affine, dtype=np.float64)
        unit = _unit_of_nibabel(given)
        return Image(np.asanyarray(given.dataobj), affine[:3, 3], affine[:3, :3].T, unit, "right-anterior-superior")
    if hasattr(given, "GetDirection") and hasattr(given, "GetSpacing"):
        import SimpleITK

        direction = np.asarray(given.GetDirection(), dtype=np.float64)
        if direction.shape != (9,):
            raise ValueError(f"the image must have three dimensions, not {given.GetDimension()}")
        steps = (direction.reshape(3, 3) * np.asarray(given.GetSpacing())).T
        # A copy: a view does not keep the image alive, which may be gone before it is looked at.
        values = SimpleITK.GetArrayFromImage(given).T
        return Image(values, np.asarray(given.GetOrigin()), steps, _unit_of_simpleitk(given))
    return None


def labelled_image(given: Any, options: InputOptions) -> Image:
    """The image that an input is or holds, whose labels are asked for one by one."""
    if isinstance(given, (str, os.PathLike)):
        _refuse(options, {"mask_smoothing"}, "the labels of a file, of which each is solid by itself")
        return read_image(given)
    image = _image_of(given)
    if image is not None:
        _refuse(options, {"mask_smoothing"}, "the labels of an image, of which each is solid by itself")
        return image
    array = np.asarray(given)
    if array.ndim != 3:
        raise ValueError(f"labels are in an image: a file, or an array of three dimensions, not of shape {array.shape}")
    _refuse(options, _OF_PLACES | {"mask_smoothing"}, "the labels of an array, of which each is solid by itself")
    return _image_of_array(array, options)


def _image_of_array(array: npt.NDArray[Any], options: InputOptions) -> Image:
    place = _arrays.place(options.get("spacing"), options.get("origin"), options.get("direction"))
    return Image(array, place[0], place[1:])


def _load_file(
    file: Path, options: InputOptions, threads: int, tell: Tell | None, delta: Length
) -> LoadedSolid:
    method, kernel = options.get("points"), options.get("kernel")
    images, triangles = _image_arguments(options), _mesh_arguments(options)
    objects = _objects(options.get("objects"))
    return loaded_of(
        _core.load_file(file, options.get("kind"), *images, method, kernel, delta, *triangles, objects, threads, tell)
    )


def _labels(given: float | Sequence[float] | None) -> list[float]:
    return [] if given is None else cast("list[float]", np.atleast_1d(np.asarray(given, dtype=np.float64)).tolist())


def _objects(given: int | Sequence[int] | None) -> list[int]:
    return [] if given is None else [operator.index(number) for number in np.atleast_1d(np.asarray(given)).tolist()]


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
    frame = image.unit, image.space
    return loaded_of(_core.load_image(values, place, frame, iso, below, labels, nonzero, smoothing, threads, tell))


def _load_function(
    function: Callable[[Floats], npt.ArrayLike], options: InputOptions, threads: int, tell: Tell | None
) -> LoadedSolid:
    bounds = options.get("bounds")
    if bounds is None:
        raise InvalidOption("a function needs bounds: the least and the largest coordinates of a box around the solid")
    feature = options.get("smallest_feature") or 0.0
    asked, box, clip = checked_function(function), _arrays.box(bounds), options.get("clip", False)
    solid = Solid(_core.function_solid(asked, box, feature, clip, threads, tell))
    return _of_solid("function", solid)


RETIRED_OPTIONS = ("features", "tight")


def refuse_retired(given: Iterable[str]) -> None:
    """Raises InvalidOption, which says what takes their place, for names of options that are gone."""
    for name in given:
        if name in RETIRED_OPTIONS:
            raise InvalidOption(
                f"{name} is gone: samples are as dense as the solid needs by default "
                '(sampling="adaptive"); leave it out',
                "option",
            )


def _refuse(options: InputOptions, allowed: set[str], kind: str) -> None:
    refuse_retired(options)
    unknown = options.keys() - InputOptions.__annotations__.keys()
    if unknown:
        known = ", ".join(InputOptions.__annotations__)
        raise TypeError(f"there is no option {', '.join(sorted(unknown))}; those of inputs are {known}")
    given = {name for name, value in options.items() if value is not None and value is not False}
    if given - allowed:
        names = ", ".join(sorted(given - allowed))
        raise InvalidOption(f"{names} has no effect on {kind}: leave it out", "option")


def _load(given: Any, options: InputOptions, threads: int, tell: Tell | None, delta: Length) -> LoadedSolid:
    if isinstance(given, (str, os.PathLike)):
        _refuse(options, _OF_FILES, "a file")
        return _load_file(given, options, threads, tell, delta)
    if isinstance(given, Samples):
        _refuse(options, set(), "samples")
        return _of_solid("samples", None, given)
    if isinstance(given, Solid):
        _refuse(options, set(), "a solid")
        return _of_solid("solid", given)
    balls = given.balls if isinstance(given, (BallUnion, MedialComplex)) else None
    if isinstance(given, MedialComplex) and balls is not None:
        balls = balls[given.radii > 0.0]  # those on sharp edges add nothing to a union
    mesh = None if balls is not None else mesh_of(given)
    if mesh is not None:
        _refuse(options, _OF_MESHES, "a mesh")
        vertices, faces = _arrays.mesh(*mesh)
        return loaded_of(_core.load_mesh(vertices, faces, *_mesh_arguments(options), threads, tell), vertices)
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
        return _load_image(_image_of_array(array, options), options, threads, tell)
    if array.ndim == 2 and array.shape[1] == 3:
        _refuse(options, _OF_POINTS, "points")
        arrays = cloud(array, options.get("normals"))
        core = _core.load_points(*arrays, options.get("points"), options.get("kernel"), delta, threads, tell)
        return loaded_of(core, arrays[0])
    if array.ndim == 2 and array.shape[1] == 4:
        _refuse(options, set(), "balls")
        return _of_solid("union", Solid(_core.union_solid(_arrays.balls(array), threads, tell)))
    what = f"an array of shape {array.shape}" if array.dtype != object else type(given).__name__
    raise ValueError(
        f"{what} is no solid: give a path, (vertices, faces), a mesh of trimesh or PyVista, voxels (three dimensions), "
        "an image of nibabel or SimpleITK, points (N × 3), balls (N × 4), or a function with bounds"
    )


def load_with(
    given: Any, options: InputOptions, threads: int, tell: Tell | None, delta: Length = None
) -> LoadedSolid:
    """`load` without the warnings. Points much closer together than `delta` are thinned."""
    chosen = cast(InputOptions, {name: value for name, value in options.items() if value is not None})
    return _load(given, chosen, threads, tell, delta)


def load(
    solid: Any,
    *,
    threads: int = 0,
    progress: Progress = None,
    **inputs: Unpack[InputOptions],
) -> LoadedSolid:
    """Makes a solid of anything that `axis` takes, with the same options. (In C++: `load_solid`.)"""
    with telling(progress) as tell:
        loaded = load_with(solid, inputs, threads, tell)
    warn(loaded.warnings)
    return loaded


__all__ = ["InputOptions", "LoadedSolid", "PointsMethod", "TriangleSolid", "load"]
