# SPDX-License-Identifier: Apache-2.0
"""Volumes that are read block by block: what a worker needs to open one, as plain data."""

from __future__ import annotations

import gzip
import hashlib
import json
import os
import re
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import FileError, InvalidOption

Triple = tuple[int, int, int]
Bytes = npt.NDArray[np.uint8]
Values = npt.NDArray[Any]

_UNISOTROPIC = 0.01  # Balls are round in voxels: spacings may differ by as much as scanners' do by rounding


class Source(NamedTuple):
    """A volume and what of it is solid. Sizes and places are in the order x, y, z; arrays have z first."""

    path: str
    kind: str  #: npy, zarr, nrrd, nifti or precomputed
    sizes: Triple
    spacing: float
    origin: tuple[float, float, float]
    dataset: str | None = None  #: within a Zarr; of precomputed, the mip level
    labels: tuple[int, ...] = ()  #: together one solid; none: all voxels other than 0
    level: float | None = None  #: the solid is above it
    below: bool = False
    identity: str = ""  #: of the content, as far as sizes and times of files tell

    def read(self, low: Triple, high: Triple) -> Values:
        """The voxels from `low` to before `high`, which lie in the volume."""
        return _read(self.path, self.kind, self.dataset, low, high)


def _fault(path: str, what: str) -> FileError:
    return FileError(f"{path}: {what}", "volume.file")


def _imported(name: str, use: str) -> Any:
    try:
        return __import__(name)
    except ImportError:
        raise InvalidOption(f"{use} need {name}: pip install {name.replace('cloudvolume', 'cloud-volume')}") from None


def _nrrd(path: str) -> tuple[dict[str, str], str, int]:
    """The fields of a header, the file of the data, and where they begin."""
    with open(path, "rb") as file:
        if not file.readline().startswith(b"NRRD"):
            raise _fault(path, "is no NRRD")
        fields = {}
        while line := file.readline().decode("ascii", "replace").strip():
            if not line.startswith("#"):
                name, _, value = line.partition(":")
                fields[name.strip().lower()] = value.lstrip("= ").strip()
        begin = file.tell()
    data = fields.get("data file") or fields.get("datafile")
    if data:
        return fields, str(Path(path).parent / data), int(fields.get("byte skip", "0"))
    return fields, path, begin


_NRRD_TYPES = {
    **dict.fromkeys(("signed char", "int8", "int8_t"), "i1"),
    **dict.fromkeys(("uchar", "unsigned char", "uint8", "uint8_t"), "u1"),
    **dict.fromkeys(("short", "short int", "signed short", "signed short int", "int16", "int16_t"), "i2"),
    **dict.fromkeys(("ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"), "u2"),
    **dict.fromkeys(("int", "signed int", "int32", "int32_t"), "i4"),
    **dict.fromkeys(("uint", "unsigned int", "uint32", "uint32_t"), "u4"),
    **dict.fromkeys(("longlong", "long long", "long long int", "signed long long", "int64", "int64_t"), "i8"),
    **dict.fromkeys(("ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"), "u8"),
    "float": "f4",
    "double": "f8",
}


def _open_nrrd(path: str) -> tuple[Values, list[float], list[float]]:
    fields, data, begin = _nrrd(path)
    if fields.get("encoding", "").lower() != "raw" or fields.get("dimension") != "3":
        raise _fault(
            path, "is read by memory map, which takes raw data of three dimensions: unpack it, or convert it to Zarr"
        )
    dtype = np.dtype(_NRRD_TYPES[fields["type"].lower()])
    dtype = dtype.newbyteorder(">" if fields.get("endian", "little").lower() == "big" else "<")
    sizes = [int(size) for size in fields["sizes"].split()]
    if "space directions" in fields:
        vectors = re.findall(r"\(([^)]*)\)", fields["space directions"])
        spacing = [float(np.linalg.norm([float(x) for x in vector.split(",")])) for vector in vectors]
    else:
        spacing = [float(x) if x != "nan" else 1.0 for x in fields.get("spacings", "1 1 1").split()]
    found = re.search(r"\(([^)]*)\)", fields.get("space origin", "(0,0,0)"))
    origin = [float(x) for x in found[1].split(",")] if found else [0.0, 0.0, 0.0]
    return np.memmap(data, dtype, "r", begin, tuple(sizes[::-1])), spacing, origin


def _open_nifti(path: str) -> tuple[Values, list[float], list[float]]:
    if path.endswith(".gz"):
        raise _fault(path, "is packed, so that blocks cannot be read: unpack it with gunzip")
    with open(path, "rb") as file:
        head = file.read(352)
    order = "<" if head[:4] == (348).to_bytes(4, "little") else ">"
    types = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}
    dim = np.frombuffer(head, order + "i2", 8, 40)
    code = int(np.frombuffer(head, order + "i2", 1, 70)[0])
    if len(head) < 352 or head[344:347] != b"n+1" or dim[0] < 3 or code not in types or any(dim[4 : dim[0] + 1] > 1):
        raise _fault(path, "is no NIfTI-1 of three dimensions in one file")
    spacing = [float(x) for x in np.frombuffer(head, order + "f4", 3, 80)]
    begin = int(np.frombuffer(head, order + "f4", 1, 108)[0])
    rows = np.frombuffer(head, order + "f4", 12, 280).reshape(3, 4)
    origin = [float(x) for x in rows[:, 3]] if np.frombuffer(head, order + "i2", 1, 254)[0] > 0 else [0.0] * 3
    slope, shift = np.frombuffer(head, order + "f4", 2, 112)
    if (slope, shift) not in ((0.0, 0.0), (1.0, 0.0)):
        raise _fault(path, "has scaled values: convert it to Zarr")
    return (
        np.memmap(path, np.dtype(order + types[code]), "r", begin, tuple(int(n) for n in dim[3:0:-1])),
        spacing,
        origin,
    )


def _zarr_array(path: str, dataset: str | None) -> tuple[Any, list[float], list[float]]:
    zarr = _imported("zarr", "Zarr and N5")
    if path.rstrip("/").endswith(".n5"):
        store = zarr.N5FSStore(path) if hasattr(zarr, "N5FSStore") else None
        if store is None:
            raise _fault(path, "is N5, which zarr reads in its versions 2: pip install 'zarr<3'")
        node = zarr.open(store, mode="r")
    else:
        node = zarr.open(path, mode="r")
    spacing, origin, last = [1.0] * 3, [0.0] * 3, None
    if not hasattr(node, "shape"):
        attributes = dict(node.attrs)
        images = attributes.get("ome", attributes).get("multiscales")
        if images:
            levels = [level["path"] for level in images[0]["datasets"]]
            if dataset is None or dataset.isdigit() and dataset not in levels and int(dataset) < len(levels):
                dataset = levels[int(dataset or 0)]
            names = [axis if isinstance(axis, str) else axis["name"] for axis in images[0].get("axes", "tczyx")]
            last = [names.index(name) for name in "xyz" if name in names]
            if len(last) != 3 or last != sorted(last, reverse=True):
                raise _fault(path, f"has the axes {', '.join(names)}: only those in the order z, y, x are read")
            scales, shifts = np.ones(len(names)), np.zeros(len(names))
            found: dict[str, Any] = next((level for level in images[0]["datasets"] if level["path"] == dataset), {})
            for step in [*found.get("coordinateTransformations", []), *images[0].get("coordinateTransformations", [])]:
                scales *= step.get("scale", 1.0)
                shifts = shifts * step.get("scale", 1.0) + np.asarray(step.get("translation", 0.0))
            spacing, origin = [float(scales[i]) for i in last], [float(shifts[i]) for i in last]
        if dataset is None:
            raise InvalidOption(f"{path} is a group: say which array by dataset, one of {', '.join(sorted(node))}")
        node = node[dataset]
    if any(size > 1 for size in node.shape[:-3]) or len(node.shape) < 3:
        raise _fault(path, f"has the shape {node.shape}: a volume has three axes")
    return node, spacing, origin


class _Precomputed:
    """Neuroglancer's, whose arrays have x first."""

    def __init__(self, path: str, mip: str | None) -> None:
        cloudvolume = _imported("cloudvolume", "precomputed volumes")
        url = path if "://" in path else "file://" + os.path.abspath(path)
        self.volume = cloudvolume.CloudVolume(url, mip=int(mip or 0), progress=False, fill_missing=True)
        self.shape = tuple(int(n) for n in self.volume.shape[2::-1])

    def __getitem__(self, at: Any) -> Values:
        z, y, x = at[-3:]
        offset = [int(n) for n in self.volume.voxel_offset]
        x, y, z = (slice(s.start + o, s.stop + o) for s, o in zip((x, y, z), offset))
        return np.asarray(self.volume[x, y, z])[..., 0].T


@lru_cache(maxsize=8)
def _opened(path: str, kind: str, dataset: str | None) -> tuple[Any, list[float], list[float]]:
    try:
        if kind == "npy":
            return np.load(path, mmap_mode="r"), [1.0] * 3, [0.0] * 3
        if kind == "nrrd":
            return _open_nrrd(path)
        if kind == "nifti":
            return _open_nifti(path)
        if kind == "precomputed":
            array = _Precomputed(path, dataset)
            spacing = [float(x) for x in array.volume.resolution]
            return array, spacing, [float(o) * s for o, s in zip(array.volume.voxel_offset, spacing)]
        return _zarr_array(path, dataset)
    except (FileError, InvalidOption, MemoryError):
        raise
    except (OSError, ValueError, KeyError, EOFError, gzip.BadGzipFile) as error:
        raise _fault(path, f"cannot be read: {error}") from None


def _read(path: str, kind: str, dataset: str | None, low: Triple, high: Triple) -> Values:
    array = _opened(path, kind, dataset)[0]
    at = tuple(slice(a, b) for a, b in zip(low[::-1], high[::-1]))
    return np.asarray(array[(0,) * (len(array.shape) - 3) + at])


def _kind_of(path: str) -> str:
    name = path.rstrip("/").lower()
    if path.startswith("precomputed://"):
        return "precomputed"
    for kind, endings in {"npy": (".npy",), "nrrd": (".nrrd", ".nhdr"), "nifti": (".nii", ".nii.gz")}.items():
        if name.endswith(endings):
            return kind
    if os.path.isfile(os.path.join(path, "info")):
        return "precomputed"
    if name.endswith((".zarr", ".n5")) or os.path.isdir(path) or "://" in path:
        return "zarr"
    raise InvalidOption(f"{path}: a volume is a .npy, .zarr, .n5, .nrrd, .nii or precomputed one")


def _identity(path: str, dataset: str | None) -> str:
    """Of files their size and time; of folders those of the files that describe them, and of the folders."""
    told: list[Any] = [os.path.abspath(path) if "://" not in path else path, dataset]
    if os.path.exists(path):
        names = [path]
        if os.path.isdir(path):
            known = (".zarray", ".zattrs", ".zgroup", "zarr.json", "attributes.json", "info")
            names = sorted(str(file) for name in known for file in Path(path).glob(f"**/{name}"))
        for name in names:
            stat = os.stat(name)
            told.append([os.path.relpath(name, path), stat.st_size, stat.st_mtime_ns])
    return hashlib.blake2b(json.dumps(told).encode(), digest_size=16).hexdigest()


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
    if within is not None and kind not in ("zarr", "precomputed"):
        raise InvalidOption(f"{text} holds one array: leave dataset out")
    array, steps, origin = _opened(text, kind, within)
    if len(array.shape) < 3 or min(array.shape[-3:]) < 1:
        raise _fault(text, f"has the shape {array.shape}: a volume has three axes")
    if spacing is None:
        if max(steps) - min(steps) > _UNISOTROPIC * max(steps):
            told = " x ".join(f"{step:g}" for step in steps)
            raise _fault(text, f"has voxels of {told}: resample it to cubes, or say which spacing to take for all")
        spacing = steps[0]
    depth, height, width = (int(n) for n in array.shape[-3:])
    x, y, z = origin
    identity = _identity(text, within)
    return Source(text, kind, (width, height, depth), float(spacing), (x, y, z), within, labels, level, below, identity)
