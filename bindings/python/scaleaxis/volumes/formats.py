# SPDX-License-Identifier: Apache-2.0
"""Opens volumes of each format, so that blocks can be read: by memory map, zarr, tensorstore or cloud-volume."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import FileError, InvalidOption

Values = npt.NDArray[Any]

NANOMETRES = {"angstrom": 0.1, "nanometer": 1.0, "micrometer": 1e3, "millimeter": 1e6, "centimeter": 1e7, "meter": 1e9}
_SHORT = {"a": "angstrom", "nm": "nanometer", "mm": "millimeter", "cm": "centimeter", "m": "meter"}
_SHORT |= dict.fromkeys(("um", "µm", "μm", "micron", "microns"), "micrometer")


class Opened(NamedTuple):
    """An array that can be sliced, and where its voxels are."""

    array: Any
    axes: tuple[int, int, int]  #: which of its dimensions are z, y and x; all others have one entry
    steps: Values  #: 3 × 3: a row for each of x, y and z, the vector from one voxel to the next
    origin: tuple[float, float, float]  #: the centre of the first voxel
    unit: str = ""  #: of all lengths, in the words of OME-Zarr, if the file says it


def fault(path: str, what: str) -> FileError:
    return FileError(f"{path}: {what}", "volume.file")


def imported(name: str, use: str) -> Any:
    try:
        return __import__(name)
    except ImportError:
        raise InvalidOption(f"{use} need {name}: pip install {name.replace('cloudvolume', 'cloud-volume')}") from None


def _unit(*names: Any) -> str:
    """In the words of OME-Zarr; none if it is another along each axis."""
    given = {str(name).strip(' "').lower() for name in names}
    name = given.pop() if len(given) == 1 else ""
    return _SHORT.get(name, name.replace("metre", "meter"))


def _upright(array: Any, axes: Sequence[int], spacing: Sequence[float], origin: Sequence[float], unit: str) -> Opened:
    """With axes along those of space. `spacing` and `origin` are in the order x, y, z."""
    z, y, x = axes
    a, b, c = map(float, origin)
    return Opened(array, (z, y, x), np.diag([float(step) for step in spacing]), (a, b, c), unit)


def _last_three(array: Any) -> tuple[int, int, int]:
    count = len(array.shape)
    return count - 3, count - 2, count - 1


def _places_of(names: Sequence[str], path: str) -> tuple[int, int, int]:
    """Of z, y and x among the names of axes."""
    lower = [str(name).lower() for name in names]
    if sorted(name for name in lower if name in "xyz") != ["x", "y", "z"]:
        raise fault(path, f"has the axes {', '.join(map(str, names))}: a volume has x, y and z")
    return lower.index("z"), lower.index("y"), lower.index("x")


def _mapped(path: str, data: str, dtype: Any, begin: int, shape: tuple[int, ...]) -> Values:
    there, needed = os.path.getsize(data), begin + math.prod(shape) * dtype.itemsize
    if there < needed:
        raise fault(path, f"is too short: {there} bytes, where its header tells of {needed}")
    return np.memmap(data, dtype, "r", begin, shape)


def open_npy(path: str, _: str | None) -> Opened:
    array = np.load(path, mmap_mode="r")
    return _upright(array, _last_three(array), [1.0] * 3, [0.0] * 3, "")


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


def _nrrd_header(path: str) -> tuple[dict[str, str], int]:
    """The fields, and where they end."""
    with open(path, "rb") as file:
        if not file.readline().startswith(b"NRRD"):
            raise fault(path, "is no NRRD")
        fields = {}
        while line := file.readline().decode("utf-8", "replace").strip():
            name, colon, value = line.partition(": ")
            if colon and not name.startswith("#") and ":=" not in name:  # those of keys are no fields
                fields[name.strip().lower().replace(" ", "")] = value.strip()
        return fields, file.tell()


def _vectors(text: str) -> Values:
    found = re.findall(r"\(([^)]*)\)", text)
    return np.array([[float(x) for x in vector.split(",")] for vector in found])


def _nrrd_place(fields: dict[str, str], sizes: list[int]) -> tuple[list[float], list[float]]:
    """Spacing and origin of an image without directions, as `read_image` has them: what is not said follows from the
    ends of the axes, which are corners of cells, or nodes.
    """

    def numbers(name: str) -> list[float]:
        words = fields[name].split() if name in fields else ["nan"] * 3
        return [math.nan if word == "none" else float(word) for word in words]

    kinds = fields.get("centers", fields.get("centerings", "??? ??? ???"))
    is_node = [kind.lower() == "node" for kind in kinds.split()]
    lows, highs = numbers("axismins"), numbers("axismaxs")
    ranges = [(b - a) / max(1, n - node) for a, b, n, node in zip(lows, highs, sizes, is_node)]
    spacing = [of if math.isnan(told) else told for told, of in zip(numbers("spacings"), ranges)]
    origin = [a if node or math.isnan(step) else a + step / 2 for a, step, node in zip(lows, spacing, is_node)]
    return [1.0 if math.isnan(x) else x for x in spacing], [0.0 if math.isnan(x) else x for x in origin]


def open_nrrd(path: str, _: str | None) -> Opened:
    fields, begin = _nrrd_header(path)
    if fields.get("encoding", "").lower() != "raw" or fields.get("dimension") != "3":
        raise fault(
            path, "is read by memory map, which takes raw data of three dimensions: unpack it, or convert it to Zarr"
        )
    dtype = np.dtype(_NRRD_TYPES[fields["type"].lower()])
    dtype = dtype.newbyteorder(">" if fields.get("endian", "little").lower() == "big" else "<")
    sizes = [int(size) for size in fields["sizes"].split()]
    data, detached = path, fields.get("datafile")
    if detached:
        if detached.startswith("LIST") or "%" in detached:
            raise fault(path, "has its data in several files: put them into one, or convert it to Zarr")
        data, begin = str(Path(path).parent / detached), 0
    skip, lines = int(fields.get("byteskip", "0")), int(fields.get("lineskip", "0"))
    with open(data, "rb") as file:
        file.seek(begin)
        for _line in range(lines):
            file.readline()
        begin = file.tell() + skip
    if skip == -1:  # the data are the end of the file
        begin = os.path.getsize(data) - math.prod(sizes) * dtype.itemsize
    array = _mapped(path, data, dtype, begin, tuple(sizes[::-1]))
    unit = _unit(*fields.get("spaceunits", fields.get("units", "")).split())
    if "spacedirections" in fields:
        origin = _vectors(fields.get("spaceorigin", "(0,0,0)"))[0]
        return Opened(array, (0, 1, 2), _vectors(fields["spacedirections"]), tuple(origin.tolist()), unit)
    return _upright(array, (0, 1, 2), *_nrrd_place(fields, sizes), unit)


class _Nifti(NamedTuple):
    """Types and places of what is needed of a header."""

    dim: tuple[str, int]
    type: int
    real: str
    pixdim: int
    offset: tuple[str, int]
    slope: int
    code: str
    units: tuple[str, int]
    qform: int
    sform: int
    quaternion: int
    rows: int
    bytes: int


_NIFTI = {
    348: _Nifti(("i2", 40), 70, "f4", 76, ("f4", 108), 112, "i2", ("u1", 123), 252, 254, 256, 280, 352),
    540: _Nifti(("i8", 16), 12, "f8", 104, ("i8", 168), 176, "i4", ("i4", 500), 344, 348, 352, 400, 544),
}
_NIFTI_TYPES = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}


def _turned(b: float, c: float, d: float) -> Values:
    """The rotation of a quaternion of length 1, whose first number is what is left."""
    left = 1 - b * b - c * c - d * d
    if left < 1e-7:  # rounding of 32 bits: half a turn, as NIfTI's own reader takes it
        length = math.sqrt(b * b + c * c + d * d)
        a, b, c, d = 0.0, b / length, c / length, d / length
    else:
        a = math.sqrt(left)
    return np.array(
        [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ]
    )


def open_nifti(path: str, _: str | None) -> Opened:
    if path.endswith(".gz"):
        raise fault(path, "is packed, so that blocks cannot be read: unpack it with gunzip")
    with open(path, "rb") as file:
        head = file.read(544)
    order, size = next(
        ((order, size) for order in "<>" for size in _NIFTI if head[:4] == np.array(size, order + "i4").tobytes()),
        ("<", 0),
    )
    at = _NIFTI.get(size)
    if at is None or len(head) < at.bytes or (head[344:347] if size == 348 else head[4:7]) not in (b"n+1", b"n+2"):
        raise fault(path, "is no NIfTI in one file")

    def numbers(kind: str, begin: int, count: int = 1) -> list[Any]:
        found: list[Any] = np.frombuffer(head, order + kind, count, begin).tolist()
        return found

    dim, code = numbers(*at.dim, 8), numbers("i2", at.type)[0]
    if dim[0] < 3 or any(n > 1 for n in dim[4 : dim[0] + 1]) or code not in _NIFTI_TYPES:
        raise fault(path, "is no image of three dimensions with one number a voxel")
    slope, shift = numbers(at.real, at.slope, 2)
    is_scale = math.isfinite(slope) and slope != 0
    if is_scale and (slope, shift if math.isfinite(shift) else 0.0) != (1.0, 0.0):
        raise fault(path, "has scaled values: convert it to Zarr")
    dtype = np.dtype(order + _NIFTI_TYPES[code])
    array = _mapped(path, path, dtype, max(size, int(numbers(*at.offset)[0])), tuple(dim[3:0:-1]))
    unit = {1: "meter", 2: "millimeter", 3: "micrometer"}.get(numbers(*at.units)[0] & 7, "")
    pixdim = numbers(at.real, at.pixdim, 4)
    if numbers(at.code, at.sform)[0] > 0:
        rows = np.array(numbers(at.real, at.rows, 12)).reshape(3, 4)
        return Opened(array, (0, 1, 2), rows[:, :3].T, tuple(rows[:, 3].tolist()), unit)
    if numbers(at.code, at.qform)[0] > 0:
        b, c, d, *origin = numbers(at.real, at.quaternion, 6)
        sides = np.array(pixdim[1:]) * [1, 1, -1 if pixdim[0] < 0 else 1]
        return Opened(array, (0, 1, 2), (_turned(b, c, d) * sides).T, tuple(origin), unit)
    # Without either x and y of the first voxels are at the right and in front.
    return _upright(array, (0, 1, 2), [-pixdim[1], -pixdim[2], pixdim[3]], [0.0] * 3, unit)


def _choice(path: str, dataset: str | None, there: Iterator[str]) -> InvalidOption:
    names = ", ".join(sorted(there)) or "none"
    if dataset is None:
        return InvalidOption(f"{path} is a group: say which array by dataset; there are: {names}")
    return InvalidOption(f"{path} has no array {dataset}; there are: {names}")


def _images(node: Any) -> list[Any]:
    attributes = dict(node.attrs)
    found = attributes.get("ome", attributes).get("multiscales")
    return found if isinstance(found, list) else []


def _levels(node: Any) -> list[str]:
    return [level["path"] for level in _images(node)[0]["datasets"]] if _images(node) else []


def _in_zarr(path: str, root: Any, dataset: str | None) -> tuple[Any, Any, str]:
    """An array, the group that may describe it, and its name there."""
    group, name = root, ""
    for part in (dataset or "").strip("/").split("/"):
        levels = _levels(group)
        if part.isdigit() and part not in group and int(part) < len(levels):
            part = levels[int(part)]
        if part and part not in group:
            raise _choice(path, dataset, iter(group))
        node = group[part] if part else group
        if hasattr(node, "shape"):
            return node, group, part
        group = node
    levels = _levels(group)
    if not levels:
        inner = (f"{dataset}/{name}".removeprefix("None/") for name in group)
        raise _choice(path, None, inner)
    name = levels[0]
    return group[name], group, name


def open_zarr(path: str, dataset: str | None) -> Opened:
    zarr = imported("zarr", "Zarr volumes")
    root = zarr.open(path, mode="r")
    if hasattr(root, "shape"):
        if dataset is not None:
            raise InvalidOption(f"{path} holds one array: leave dataset out")
        array = root
        above, _, name = path.rstrip("/").rpartition("/")
        try:  # what describes a level of an image lies above it
            group = zarr.open_group(above, mode="r")
        except Exception:
            group = None
    else:
        array, group, name = _in_zarr(path, root, dataset)
    names = getattr(getattr(array, "metadata", None), "dimension_names", None) or ()
    is_named = {"x", "y", "z"} <= {str(name).lower() for name in names}
    axes = _places_of(names, path) if is_named else _last_three(array)
    if group is None or name not in _levels(group):
        return _upright(array, axes, [1.0] * 3, [0.0] * 3, "")
    image = _images(group)[0]
    told = [axis if isinstance(axis, dict) else {"name": axis} for axis in image.get("axes", "tczyx")]
    axes = _places_of([axis["name"] for axis in told], path)
    scale, shift = np.ones(len(told)), np.zeros(len(told))
    level = next(level for level in image["datasets"] if level["path"] == name)
    for step in [*level.get("coordinateTransformations", []), *image.get("coordinateTransformations", [])]:
        scale *= step.get("scale", 1.0)
        shift = shift * step.get("scale", 1.0) + np.asarray(step.get("translation", 0.0))
    xyz = list(axes[::-1])
    unit = _unit(*(told[i].get("unit", "") for i in xyz))
    return _upright(array, axes, scale[xyz].tolist(), shift[xyz].tolist(), unit)


class _Tensorstore:
    """An array of tensorstore, which begins at 0."""

    def __init__(self, spec: dict[str, Any]) -> None:
        tensorstore = imported("tensorstore", "N5 and precomputed volumes")
        store = tensorstore.open(spec, read=True, open=True).result()
        self._store = store[tensorstore.d[:].translate_to[0]]
        self.shape = tuple(int(n) for n in self._store.shape)
        self.dtype = np.dtype(self._store.dtype.numpy_dtype)
        self.spec = store.spec().to_json()

    def __getitem__(self, at: Any) -> Values:
        return np.asarray(self._store[at].read().result())


def _url(path: str) -> str:
    return path if "://" in path else "file://" + os.path.abspath(path)


def _n5_place(told: dict[str, Any], above: dict[str, Any], name: str, axes: list[str]) -> tuple[Any, Any, str]:
    """Spacing, origin and unit of an array of N5, from the attributes that BigDataViewer, n5-viewer, COSEM and
    tensorstore write. All have x first, but for the transform, which names its axes.
    """
    levels = (above.get("multiscales") or [{}])[0].get("datasets", [])
    here: dict[str, Any] = next((level for level in levels if level.get("path") == name), {})
    transform = told.get("transform") or here.get("transform")
    if transform:
        order = [transform["axes"].index(axis) for axis in "xyz"]
        scale, shift = ([float(transform[key][i]) for i in order] for key in ("scale", "translate"))
        return scale, shift, _unit(*(transform.get("units", [""] * len(axes))[i] for i in order))
    pixel = told.get("pixelResolution") or above.get("pixelResolution") or told.get("resolution")
    pixel = pixel or above.get("resolution") or [1.0] * len(axes)
    unit = _unit(*told.get("units", above.get("units", [""])))
    if isinstance(pixel, dict):
        pixel, unit = pixel["dimensions"], _unit(pixel.get("unit", ""))
    order = [axes.index(axis) for axis in "xyz"]
    factors = told.get("downsamplingFactors", [1] * len(axes))
    offset = told.get("offset", [0.0] * len(axes))
    scale = [pixel[i] * factors[i] for i in order]
    # A voxel of a coarser level has its centre in the middle of those that it is made of.
    return scale, [offset[i] + pixel[i] * (factors[i] - 1) / 2 for i in order], unit


def open_n5(path: str, dataset: str | None) -> Opened:
    tensorstore = imported("tensorstore", "N5 volumes")
    store = tensorstore.KvStore.open(_url(path).rstrip("/") + "/").result()

    def attributes(name: str) -> dict[str, Any]:
        content = store.read(f"{name}/attributes.json".lstrip("/")).result().value
        found: dict[str, Any] = json.loads(content) if content else {}
        return found

    def arrays() -> Iterator[str]:
        for key in store.list().result():
            name = key.decode().removesuffix("attributes.json").rstrip("/")
            if key.endswith(b"attributes.json") and "dimensions" in attributes(name):
                yield name

    name = (dataset or "").strip("/")
    head, _, last = name.rpartition("/")
    levels = (attributes(head).get("multiscales") or [{}])[0].get("datasets", [])
    number = [f"s{last}", *(level["path"] for level in levels[int(last) : int(last) + 1])] if last.isdigit() else []
    choices = [name, f"{name}/s0", *(f"{head}/{at}" for at in number)]
    inner = (attributes(name).get("multiscales") or [{}])[0].get("datasets", [])
    choices += [f"{name}/{level['path']}" for level in inner[:1]]
    found = next((at.strip("/") for at in choices if "dimensions" in attributes(at.strip("/"))), None)
    if found is None:
        raise _choice(path, dataset, arrays())
    array = _Tensorstore({"driver": "n5", "kvstore": _url(path).rstrip("/") + "/" + (found + "/" if found else "")})
    told = attributes(found)
    head, _, last = found.rpartition("/")
    axes = [str(axis).lower() for axis in told.get("axes", "xyzct"[: len(array.shape)])]
    scale, shift, unit = _n5_place(told, attributes(head), last, axes)
    return _upright(array, _places_of(axes, path), scale, shift, unit)


class _CloudVolume:
    def __init__(self, path: str, mip: int) -> None:
        cloudvolume = imported("cloudvolume", "precomputed volumes")
        self._volume = cloudvolume.CloudVolume(_url(path), mip=mip, progress=False, fill_missing=True)
        self.shape = tuple(int(n) for n in self._volume.shape)
        self.dtype = np.dtype(self._volume.dtype)
        self.offset = [int(n) for n in self._volume.voxel_offset]
        self.resolution = [float(x) for x in self._volume.resolution]

    def __getitem__(self, at: Any) -> Values:
        moved = tuple(slice(a.start + o, a.stop + o) for a, o in zip(at[:3], self.offset))
        return np.asarray(self._volume[moved])[(..., *at[3:])]


def _precomputed_by_tensorstore(path: str, mip: int) -> tuple[Any, list[int], list[float]]:
    spec = {"driver": "neuroglancer_precomputed", "kvstore": _url(path).rstrip("/") + "/", "scale_index": mip}
    array = _Tensorstore(spec)
    scale = array.spec["scale_metadata"]
    folder = os.path.join(path, scale["key"])
    if os.path.isdir(folder):
        with os.scandir(folder) as entries:
            # To tensorstore these chunks are not there, and their voxels are 0.
            if any(entry.name.endswith((".gz", ".br", ".zstd", ".xz")) for entry in entries):
                raise InvalidOption(f"{path} has packed chunks, which need cloudvolume: pip install cloud-volume")
    return array, scale.get("voxel_offset", [0, 0, 0]), scale["resolution"]


def open_precomputed(path: str, mip: str | None) -> Opened:
    """By cloud-volume, or by tensorstore where that is not installed."""
    if mip is not None and not mip.isdigit():
        raise InvalidOption(f"dataset of a precomputed volume is the number of a level, not {mip!r}")
    try:
        import cloudvolume  # noqa: F401
    except ImportError:
        array, offset, resolution = _precomputed_by_tensorstore(path, int(mip or 0))
    else:
        array = _CloudVolume(path, int(mip or 0))
        offset, resolution = array.offset, array.resolution
    # The first voxel goes from its offset to one more.
    origin = [(o + 0.5) * step for o, step in zip(offset, resolution)]
    return _upright(array, (2, 1, 0), resolution, origin, "nanometer")


OPENERS: dict[str, Callable[[str, str | None], Opened]] = {
    "npy": open_npy,
    "nrrd": open_nrrd,
    "nifti": open_nifti,
    "zarr": open_zarr,
    "n5": open_n5,
    "precomputed": open_precomputed,
}
