# SPDX-License-Identifier: Apache-2.0
"""Whatever users have → a solid."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypedDict, cast

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats
from ._options import checked
from ._progress import Progress, Tell, telling
from .adapt import adapted, as_balls, as_image, core_of_image, described, is_path
from .data import Image, MedialComplex, Mesh, PointCloud, Samples
from .errors import InvalidOption, UnusableInput, Warning, warn, warnings_of
from .files import FileKind, Path
from .solids import Solid, checked_function, cloud
from .stages import Json, samples_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

PointsMethod = Literal["mls", "crust"]
TriangleSolid = Literal["auto", "winding", "wrap", "thicken"]

#: A label of an image: whole numbers as large as any array has them.
Label = Annotated[int, range(-(2**63), 2**64)] | float

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
    labels: Label | Sequence[Label] | None  #: of a label image: those that are solid
    nonzero: bool  #: all but 0 are
    mask_smoothing: float | None  #: of masks and labels: standard deviation of the Gaussian, in voxels; 0: none
    fill_voids: bool  #: of masks and labels
    bounds: npt.ArrayLike | None  #: of a function, 2 × 3: a box in which its solid ends
    smallest_feature: float | None  #: diameter of parts that are found for sure; default: 1/128 of the box's diagonal
    clip: bool  #: the solid is closed at the bounds


_OF_MESHES = {"triangles", "opening", "thickness"}
_OF_FILES = {"kind", "objects", "iso", "below", "labels", "nonzero", "mask_smoothing", "fill_voids"}
_OF_FILES |= {"points", "kernel"} | _OF_MESHES
_OF_IMAGES = {"iso", "below", "labels", "nonzero", "mask_smoothing", "fill_voids"}
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
    is_mask: bool = False  #: of an image: each voxel is solid or is not, where no `iso` was given
    #: H × 4, of a mesh: the middle of the rim and the width of each hole that was closed, the widest first
    holes: Floats = field(default_factory=lambda: np.empty((0, 4)))
    left_out: Mesh | None = None  #: of a mesh, what may be no part of the boundary: sheets, walls, or all of a wrap

    def inside(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which of N × 3 points lie in the solid."""
        if self.solid is None:
            raise ValueError("only samples of the boundary are known, not what is inside")
        return self.solid.inside(points)

    @property
    def _stands_for(self) -> Solid | Samples | None:
        return self.samples if self.solid is None else self.solid


def _transform_of(report: Json) -> Floats:
    """Of an image, as the library tells where it lies."""
    directions, spacing = np.array(report["directions"]), np.array(report["spacing"])
    return np.column_stack([directions.T * spacing, report["origin"]])


def loaded_of(core: dict[str, Any], points: Floats | None = None, *, is_mask: bool = False) -> LoadedSolid:
    mesh, left_out = (Mesh(core[name]["vertices"], core[name]["triangles"]) for name in ("mesh", "left_out"))
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
        left_out=left_out if len(left_out.triangles) else None,
        holes=core["holes"],
    )
    is_image = loaded.kind == "image"
    return replace(loaded, transform=_transform_of(report), is_mask=is_mask) if is_image else loaded


def _of_solid(kind: str, solid: Solid | None, samples: Samples | None = None) -> LoadedSolid:
    return LoadedSolid(kind, solid, samples, None, {}, solid.warnings if solid else [], [])


def labelled_image(given: Any, options: InputOptions) -> Image:
    """The image that an input is or holds, whose labels are asked for one by one."""
    known = adapted(given)
    is_array = isinstance(known, np.ndarray)
    if is_array and known.ndim != 3:
        raise ValueError(f"labels are in an image: a file, or an array of three dimensions, not of shape {known.shape}")
    places = _OF_PLACES if is_array else set()
    _refuse(options, places | {"mask_smoothing", "fill_voids"}, "the labels of an image, of which each is solid by itself")
    image = _image_of_array(known, options) if is_array else as_image(known)
    if image.values.size and np.can_cast(image.values.dtype, np.float32):
        _check_labels([float(image.values.min()), float(image.values.max())])
    return image


def _image_of_array(array: npt.NDArray[Any], options: InputOptions) -> Image:
    place = {name: options.get(name) for name in _OF_PLACES}
    return Image(array, **place)  # type: ignore[arg-type]


def _check_labels(labels: Iterable[float]) -> None:
    """Raises UnusableInput for labels that single precision, in which files are read, merges with others."""
    for label in labels:
        if abs(label) > _arrays.MOST_LABEL:
            raise UnusableInput(
                "labels of files and of 32-bit floats are told apart up to 2^24: for larger ones give an array of "
                "integers that has them, as nibabel and SimpleITK read them"
            )


def _load_file(
    file: Path, options: InputOptions, threads: int, tell: Tell | None, delta: Length
) -> LoadedSolid:
    method, kernel = options.get("points"), options.get("kernel")
    _check_labels(_labels(options.get("labels")))
    images, triangles = _image_arguments(options), _mesh_arguments(options)
    objects = _objects(options.get("objects"))
    kind = options.get("kind")
    core = _core.load_file(file, kind, *images, method, kernel, delta, *triangles, objects, threads, tell)
    return loaded_of(core, is_mask=options.get("iso") is None)


def _labels(given: Label | Sequence[Label] | None) -> list[float]:
    return [] if given is None else [given] if isinstance(given, (int, float)) else list(given)


def _objects(given: int | Sequence[int] | None) -> list[int]:
    return [] if given is None else [given] if isinstance(given, int) else list(given)


def _image_arguments(options: InputOptions) -> tuple[float | None, bool, list[float], bool, float | None, bool]:
    return (
        options.get("iso"),
        options.get("below", False),
        _labels(options.get("labels")),
        options.get("nonzero", False),
        options.get("mask_smoothing"),
        options.get("fill_voids", False),
    )


def _mesh_arguments(options: InputOptions) -> tuple[str | None, float, float]:
    return options.get("triangles"), options.get("opening") or 0.0, options.get("thickness") or 0.0


def _load_image(image: Image, options: InputOptions, threads: int, tell: Tell | None) -> LoadedSolid:
    iso, below, labels, nonzero, smoothing, fills = _image_arguments(options)
    numbers, names = (image.values, None) if iso is not None else _arrays.numbered(image.values)
    values, place = core_of_image(replace(image, values=numbers))
    frame = image.unit, image.space
    if names is not None:
        labels = [_number_of(label, names) for label in labels]
    _check_labels(labels)
    core = _core.load_image(values, place, frame, iso, below, labels, nonzero, smoothing, fills, threads, tell)
    return named(loaded_of(core, is_mask=iso is None), names)


def _number_of(label: float, names: npt.NDArray[Any]) -> float:
    found = np.flatnonzero(names == label)
    if len(found) == 0:
        raise UnusableInput(f"no voxel has the label {label}")
    return float(found[0])


def named(loaded: LoadedSolid, names: npt.NDArray[Any] | None) -> LoadedSolid:
    """With the labels of the image in its report, where numbers had stood for them."""
    if names is not None:
        for entry in loaded.report["labels"]:
            entry["label"] = names[int(entry["label"])].item()
        loaded.report["values"] = {"min": names.min().item(), "max": names.max().item()}
    return loaded


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


def _refuse(options: InputOptions, allowed: set[str], kind: str) -> None:
    given = {name for name, value in options.items() if value is not None and value is not False}
    if given - allowed:
        names = ", ".join(sorted(given - allowed))
        raise InvalidOption(f"{names} has no effect on {kind}: leave it out")


def _load_cloud(
    places: npt.ArrayLike, normals: npt.ArrayLike | None, options: InputOptions, threads: int, tell: Tell | None,
    delta: Length,
) -> LoadedSolid:
    arrays = cloud(places, normals)
    core = _core.load_points(*arrays, options.get("points"), options.get("kernel"), delta, threads, tell)
    return loaded_of(core, arrays[0].copy())


def _load(given: Any, options: InputOptions, threads: int, tell: Tell | None, delta: Length) -> LoadedSolid:
    if isinstance(given, LoadedSolid):
        _refuse(options, set(), "a solid")
        return given
    known = adapted(given)
    if is_path(known):
        _refuse(options, _OF_FILES, "a file")
        return _load_file(known, options, threads, tell, delta)
    if isinstance(known, Samples):
        _refuse(options, set(), "samples")
        return _of_solid("samples", None, known)
    if isinstance(known, Solid):
        _refuse(options, set(), "a solid")
        return _of_solid("solid", known)
    if isinstance(known, Mesh):
        _refuse(options, _OF_MESHES, "a mesh")
        vertices, faces = _arrays.mesh(*known)
        return loaded_of(_core.load_mesh(vertices, faces, *_mesh_arguments(options), threads, tell), vertices.copy())
    if isinstance(known, Image):
        _refuse(options, _OF_IMAGES, "an image")
        return _load_image(known, options, threads, tell)
    if isinstance(known, PointCloud):
        _refuse(options, _OF_POINTS, "points")
        own = known.normals if len(known.normals) else None
        return _load_cloud(known.points, options.get("normals", own), options, threads, tell, delta)
    if isinstance(known, np.ndarray) and known.ndim == 3:
        _refuse(options, _OF_VOXELS, "an array of voxels")
        return _load_image(_image_of_array(known, options), options, threads, tell)
    if isinstance(known, np.ndarray) and known.ndim == 2 and known.shape[1] == 3:
        _refuse(options, _OF_POINTS, "points")
        return _load_cloud(known, options.get("normals"), options, threads, tell, delta)
    if isinstance(known, MedialComplex) or (isinstance(known, np.ndarray) and known.ndim == 2 and known.shape[1] == 4):
        _refuse(options, set(), "balls")
        return _of_solid("union", Solid(_core.union_solid(as_balls(known), threads, tell)))
    if callable(known):
        _refuse(options, _OF_FUNCTIONS, "a function")
        return _load_function(known, options, threads, tell)
    raise ValueError(
        f"{described(known)} is no solid: give a path, (vertices, faces), a mesh of trimesh or PyVista, voxels (three "
        "dimensions), an image of nibabel or SimpleITK, points (N × 3), balls (N × 4), or a function with bounds"
    )


def load_with(
    given: Any, options: InputOptions, threads: int, tell: Tell | None, delta: Length = None
) -> LoadedSolid:
    """`load` without the warnings. Points much closer together than `delta` are thinned."""
    chosen = cast(InputOptions, {name: value for name, value in options.items() if value is not None})
    return _load(given, chosen, threads, tell, delta)


@checked
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
