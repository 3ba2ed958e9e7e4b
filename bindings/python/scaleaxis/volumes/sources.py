# SPDX-License-Identifier: Apache-2.0
"""Volumes that are read block by block: what a worker needs to open one, as plain data."""

from __future__ import annotations

import hashlib
import json
import os
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import FileError, InvalidOption
from .formats import OPENERS, Opened, Values, fault

Triple = tuple[int, int, int]
Bytes = npt.NDArray[np.uint8]
Matrix = tuple[tuple[float, float, float], ...]

_UNISOTROPIC = 0.01  # Balls are round in voxels: spacings may differ by as much as scanners' do by rounding
_UPRIGHT: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Source(NamedTuple):
    """A volume and what of it is solid. Sizes and places are in the order x, y, z; arrays have z first."""

    path: str
    kind: str  #: one of OPENERS
    sizes: Triple
    spacing: float
    origin: tuple[float, float, float]  #: the centre of the first voxel
    dataset: str | None = None  #: within a Zarr or N5; of precomputed, the mip level
    labels: tuple[int, ...] = ()  #: together one solid; none: all voxels other than 0
    level: float | None = None  #: the solid is above it
    below: bool = False
    identity: str = ""  #: of the content, as far as sizes and times of files tell
    directions: Matrix = _UPRIGHT  #: of x, y and z, of length 1
    unit: str = ""  #: of lengths, as OME-Zarr calls it

    @property
    def is_upright(self) -> bool:
        return self.directions == _UPRIGHT

    def read(self, low: Triple, high: Triple) -> Values:
        """The voxels from `low` to before `high`, which lie in the volume."""
        return _read(self.path, self.kind, self.dataset, low, high)


def _open(path: str, kind: str, dataset: str | None) -> Opened:
    if "://" not in path and not os.path.exists(path):
        raise fault(path, "there is no such file or folder")
    try:
        return OPENERS[kind](path, dataset)
    except (FileError, InvalidOption, MemoryError):
        raise
    except Exception:  # libraries raise errors of all kinds
        where = "" if dataset is None else f" with dataset {dataset}"
        raise fault(path, f"cannot be read as {kind}{where}: it is damaged, or of another kind") from None


_opened = lru_cache(maxsize=8)(_open)  # of a worker; a call opens anew, for the file may be another


def _read(path: str, kind: str, dataset: str | None, low: Triple, high: Triple) -> Values:
    opened = _opened(path, kind, dataset)
    at: list[int | slice] = [0] * len(opened.array.shape)
    for axis, a, b in zip(opened.axes, low[::-1], high[::-1]):
        at[axis] = slice(a, b)
    try:
        values = np.asarray(opened.array[tuple(at)])
    except MemoryError:
        raise
    except Exception:
        place = ", ".join(map(str, low))
        raise fault(path, f"the voxels from {place} on cannot be read: a chunk there is damaged") from None
    # What is left are the three axes, in the order of the array.
    values = np.ascontiguousarray(values.transpose(np.argsort(np.argsort(opened.axes))))
    return values if values.dtype.kind != "f" else _numbers(path, kind, values, low)


def _numbers(path: str, kind: str, values: Values, low: Triple) -> Values:
    """As `read_image` takes values that are not numbers: 0 in NIfTI; in others FileError is raised."""
    if kind == "nifti":
        return np.where(np.isfinite(values), values, values.dtype.type(0))
    for k, layer in enumerate(values):  # so that little memory is taken beside the values
        if np.isnan(layer).any():
            j, i = np.argwhere(np.isnan(layer))[0].tolist()
            raise fault(path, f"voxel ({low[0] + i}, {low[1] + j}, {low[2] + k}) is not a number")
    return values


def _kind_of(path: str) -> str:
    name = path.rstrip("/").lower()
    if path.startswith("precomputed://"):
        return "precomputed"
    for kind, endings in {"npy": (".npy",), "nrrd": (".nrrd", ".nhdr"), "nifti": (".nii", ".nii.gz")}.items():
        if name.endswith(endings):
            return kind
    if os.path.isfile(os.path.join(path, "info")):
        return "precomputed"
    if name.endswith(".n5") or os.path.isfile(os.path.join(path, "attributes.json")):
        return "n5"
    if name.endswith(".zarr") or os.path.isdir(path) or "://" in path:
        return "zarr"
    raise InvalidOption(f"{path}: a volume is a .npy, .zarr, .n5, .nrrd, .nii or precomputed one")


_DESCRIPTIONS = (".zarray", ".zattrs", ".zgroup", "zarr.json", "attributes.json", "info")


def _identity(path: str, dataset: str | None) -> str:
    """Of files their size and time; of folders those of the files that describe the array, on the way to it."""
    told: list[object] = [os.path.abspath(path) if "://" not in path else path, dataset]
    if os.path.isfile(path):
        names = [path]
    else:
        folders = accumulate([path, *(dataset or "").split("/")], os.path.join)
        names = [os.path.join(folder, name) for folder in folders for name in _DESCRIPTIONS]
    for name in names:
        if os.path.isfile(name):
            stat = os.stat(name)
            told.append([os.path.relpath(name, path), stat.st_size, stat.st_mtime_ns])
    return hashlib.blake2b(json.dumps(told).encode(), digest_size=16).hexdigest()


def _directions(path: str, steps: Values, lengths: Values) -> Matrix:
    directions = steps / lengths[:, None]
    if np.abs(directions @ directions.T - np.eye(3)).max() > _UNISOTROPIC:
        raise fault(path, "has axes that are not at right angles: resample it")
    return tuple((float(x), float(y), float(z)) for x, y, z in directions)


def source_of(
    path: str | os.PathLike[str],
    *,
    labels: tuple[int, ...] = (),
    level: float | None = None,
    below: bool = False,
    dataset: str | int | None = None,
    spacing: float | None = None,
) -> Source:
    """Raises FileError, InvalidOption."""
    text = os.fspath(path)
    kind = _kind_of(text)
    text = text.removeprefix("precomputed://") if kind == "precomputed" else text
    if labels and level is not None:
        raise InvalidOption("label and level exclude each other: a volume holds labels or grey values")
    if below and level is None:
        raise InvalidOption("below needs a level")
    within = None if dataset is None else str(dataset)
    if within is not None and kind not in ("zarr", "n5", "precomputed"):
        raise InvalidOption(f"{text} holds one array: leave dataset out")
    array, axes, steps, origin, unit = _open(text, kind, within)
    sizes = [int(n) for n in array.shape]
    if len(sizes) < 3 or min(sizes) < 1 or any(n > 1 for axis, n in enumerate(sizes) if axis not in axes):
        raise fault(text, f"has the shape {tuple(sizes)}: a volume has three axes, and one value a voxel")
    if np.dtype(array.dtype).kind not in "biuf":
        raise fault(text, f"has values of the type {array.dtype}: a volume has numbers")
    lengths = np.linalg.norm(steps, axis=1)
    if not (np.isfinite(lengths).all() and lengths.min() > 0 and np.isfinite(origin).all()):
        raise fault(text, "has a spacing or an origin that is no number of a place")
    if spacing is None:
        if lengths.max() - lengths.min() > _UNISOTROPIC * lengths.max():
            told = " x ".join(f"{step:g}" for step in lengths)
            raise fault(text, f"has voxels of {told}: resample it to cubes, or say which spacing to take for all")
        spacing = float(lengths[0])
    z, y, x = axes
    return Source(
        text,
        kind,
        (sizes[x], sizes[y], sizes[z]),
        float(spacing),
        origin,
        within,
        labels,
        level,
        below,
        _identity(text, within),
        _directions(text, steps, lengths),
        unit,
    )
