# SPDX-License-Identifier: Apache-2.0
"""What is computed of one block, in a process of its own."""

from __future__ import annotations

import hashlib
import io
import math
import resource
import zlib
from collections.abc import Iterable, Iterator
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from ..batch.storage import Storage
from .sources import Bytes, Source, Triple
from .stitching import ply_of_part

CELL = 32  # voxels: of these cubes it is kept how deep the solid is, so that blocks know what is around them
_FIRST_HALO = 8  # voxels: most solids are less deep, and others are met again with a halo that is large enough
_MOST_LABELS = 65535  # more than that are no labels

Place = list[list[int]]


class Options(NamedTuple):
    """Of the results: part of their names."""

    scale: float
    smoothing: int
    seed: int
    move: float


class Task(NamedTuple):
    """Plain data, which goes to workers."""

    kind: str  #: depths, part or check
    keys: list[str]  #: one: the name of the result
    storage: Storage
    source: Source
    options: Options
    low: Triple
    high: Triple
    threads: int
    edge: int = 0  #: of the blocks whose depths are found one after the other
    halo: int = 0
    largest_depth: float = 0.0  #: near enough to matter
    wants_axis: bool = True
    thickness: tuple[float, int] | None = None  #: voxels for each step of 16 bits, and the size of chunks


def row_name(key: str) -> str:
    return f"blocks/{key}.json"


def part_name(key: str) -> str:
    return f"blocks/{key}.npz"


def polygons_name(key: str) -> str:
    return f"blocks/{key}.ply"


def digest(content: bytes) -> str:
    return hashlib.blake2b(content, digest_size=8).hexdigest()


def _write(task: Task, row: dict[str, Any], name: str, content: bytes) -> None:
    """A result of a block, of which its row knows the digest."""
    task.storage.write(name, content)
    row.setdefault("files", {})[name] = digest(content)


def _mask(source: Source, values: npt.NDArray[Any]) -> Bytes:
    if source.level is not None:
        return np.asarray(values < source.level if source.below else values > source.level, np.uint8)
    if source.labels:
        return np.asarray(np.isin(values, source.labels), np.uint8)
    return np.asarray(values != 0, np.uint8)


def _array(source: Source, low: npt.NDArray[np.int64], high: npt.NDArray[np.int64]) -> tuple[npt.NDArray[Any], Any]:
    """The voxels from `low` to `high` as far as they are in the volume, and how many layers are missing."""
    sizes = np.array(source.sizes)
    inner_low, inner_high = np.maximum(low, 0), np.minimum(high, sizes)
    values = source.read(tuple(inner_low.tolist()), tuple(inner_high.tolist()))
    missing = [(int(a), int(b)) for a, b in zip((inner_low - low)[::-1], (high - inner_high)[::-1])]
    return values, missing


def _limits(task: Task, halo: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Of an array with such a halo: in the volume, and one layer beyond its ends."""
    sizes = np.array(task.source.sizes)
    return np.maximum(np.array(task.low) - halo, -1), np.minimum(np.array(task.high) + halo + 1, sizes + 1)


def _field(task: Task, low: Any, high: Any, threads: int) -> npt.NDArray[np.float32]:
    """The values from `low` to `high`, negative inside. What is beyond the volume is outside."""
    source, passes = task.source, task.options.smoothing
    if source.level is not None:
        values, missing = _array(source, low, high)
        field = values.astype(np.float32) - np.float32(source.level)
        field = field if source.below else -field
        # Beyond the ends it is as far outside as it is inside at the border: the solid ends half way.
        beyond = np.pad(np.zeros(field.shape, bool), missing, constant_values=True)
        field = np.pad(field, missing, mode="edge")
        np.abs(field, out=field, where=beyond)
        field[beyond & (field == 0)] = 1e-30  # outside, and other than 0
        return field
    margin = passes + 1  # what smoothing looks at
    values, missing = _array(source, low - margin, high + margin)
    mask = np.pad(_mask(source, values), missing)
    del values
    field = _core.mask_values(mask, passes, threads).reshape(mask.shape)
    return np.ascontiguousarray(field[(slice(margin, -margin),) * 3])


def _place(task: Task, low: npt.NDArray[np.int64]) -> Place:
    return [low.tolist(), list(task.low), list(task.high), list(task.source.sizes)]


def _padded_mask(task: Task, halo: int) -> tuple[Bytes, npt.NDArray[np.int64]]:
    low, high = _limits(task, halo)
    values, missing = _array(task.source, low, high)
    return np.pad(_mask(task.source, values), missing), low


def _core_of(task: Task, array: npt.NDArray[Any], low: npt.NDArray[np.int64]) -> npt.NDArray[Any]:
    at = [slice(a - o, b - o) for a, b, o in zip(task.low, task.high, low.tolist())]
    return array[tuple(at[::-1])]


def _cells_around(inside: npt.NDArray[Any], shape: tuple[int, ...]) -> list[slice] | None:
    """The box of cells, in an array of this shape, of all that is inside and the voxels before it; None if nothing is."""
    box = []
    for axis, size in enumerate(shape):
        found = np.flatnonzero(inside.any(axis=tuple({0, 1, 2} - {axis})))
        if not len(found):
            return None
        first, last = max(0, int(found[0]) - 1), int(found[-1])
        box.append(slice(first // CELL * CELL, min((last // CELL + 1) * CELL, size)))
    return box


def _part_of_core(task: Task, box: list[slice]) -> Task:
    x, y, z = ((a + at.start, a + at.stop) for a, at in zip(task.low, box[::-1]))
    return task._replace(low=(x[0], y[0], z[0]), high=(x[1], y[1], z[1]))


def _labels(values: npt.NDArray[Any], low: Triple) -> dict[str, list[int]]:
    """Of each label its voxels and the box around them."""
    if values.dtype.kind not in "iu":
        return {}
    _, height, width = values.shape
    # Runs of voxels along x are a hundred times fewer.
    flat = np.ascontiguousarray(values).reshape(-1)
    is_first = np.ones(flat.size, bool)
    np.not_equal(flat[1:], flat[:-1], out=is_first[1:])
    is_first[::width] = True
    begins = np.flatnonzero(is_first)
    lengths = np.diff(begins, append=flat.size)
    inside = flat[begins] != 0
    begins, lengths = begins[inside], lengths[inside]
    found, number = np.unique(flat[begins], return_inverse=True)
    if len(found) > _MOST_LABELS:
        return {}
    counts = np.bincount(number, lengths, len(found))
    x, y, z = begins % width, begins // width % height, begins // width // height
    boxes = np.empty((len(found), 6), np.int64)
    boxes[:, :3], boxes[:, 3:] = np.iinfo(np.int64).max, -1
    for axis, (first, last) in enumerate(((x, x + lengths - 1), (y, y), (z, z))):
        np.minimum.at(boxes[:, axis], number, first + low[axis])
        np.maximum.at(boxes[:, 3 + axis], number, last + low[axis])
    return {str(label): [int(count), *box.tolist()] for label, count, box in zip(found, counts, boxes)}


def merged_labels(rows: Iterable[dict[str, list[int]]]) -> dict[str, list[int]]:
    """Of each label its voxels and the box around them, of rows that have some of them."""
    merged: dict[str, list[int]] = {}
    for row in rows:
        for label, (count, *box) in row.items():
            known = merged.setdefault(label, [0, *box])
            known[0] += count
            known[1:4] = map(min, known[1:4], box[:3])
            known[4:] = map(max, known[4:], box[3:])
    return merged


def blocks_of(low: Triple, high: Triple, edge: int) -> Iterator[tuple[Triple, Triple]]:
    for z, y, x in product(*(range(a, b, edge) for a, b in zip(low[::-1], high[::-1]))):
        yield (x, y, z), (min(x + edge, high[0]), min(y + edge, high[1]), min(z + edge, high[2]))


def _depths(task: Task) -> dict[str, Any]:
    """Of each cell of the core the voxels inside, the largest depth, and the crossings of lattice edges. Empty space
    takes less time than a process: one does many blocks, one after the other.
    """
    rows = [
        _depths_of_block(task._replace(low=low, high=high)) for low, high in blocks_of(task.low, task.high, task.edge)
    ]
    cells = [cell for row in rows for cell in row["cells"]]
    return {"cells": cells, "labels": merged_labels(row["labels"] for row in rows)}


def _depths_of_block(task: Task) -> dict[str, Any]:
    source = task.source
    labels = {}
    values, _ = _array(source, *_limits(task, 0))
    shape = tuple(b - a for a, b in zip(task.low, task.high))[::-1]
    if source.level is None:
        known = _cells_around(values != 0, shape)
        if known is not None:
            core_values = values[tuple(slice(size) for size in shape)]
            labels = _labels(core_values[tuple(known)], _part_of_core(task, known).low)
    box = _cells_around(_mask(source, values), shape)
    if box is None:
        return {"cells": [], "labels": labels}
    del values
    task = _part_of_core(task, box)
    halo = _FIRST_HALO
    while True:
        mask, low = _padded_mask(task, halo)
        depths = _core.squared_depths(mask, task.threads).reshape(mask.shape)
        core = _core_of(task, depths, low)
        reaches_all = all(a < 0 for a in low) and all(
            o + n > size for o, n, size in zip(low.tolist(), mask.shape[::-1], source.sizes)
        )
        deepest = int(core.max())  # or less: what is beyond the array may be nearer
        if reaches_all or deepest <= halo * halo:
            break
        halo = min(4 * halo, math.isqrt(deepest - 1) + 1)
    sides = np.zeros(core.shape, np.uint8)  # crossings at each voxel
    for axis in range(3):
        begin = [slice(a - o, b - o) for a, b, o in zip(task.low, task.high, low.tolist())][::-1]
        here = mask[tuple(begin)]
        begin[axis] = slice(begin[axis].start + 1, begin[axis].stop + 1)
        sides += here != mask[tuple(begin)]
    cells = []
    steps = [range(0, size, CELL) for size in core.shape]
    inside = _core_of(task, mask, low)
    for z in steps[0]:
        for y in steps[1]:
            for x in steps[2]:
                at = (slice(z, z + CELL), slice(y, y + CELL), slice(x, x + CELL))
                voxels = int(np.count_nonzero(inside[at]))
                crossings = int(sides[at].sum())
                if voxels or crossings:
                    cell = [(o + c) // CELL for o, c in zip(task.low, (x, y, z))]
                    cells.append([*cell, voxels, int(core[at].max()), crossings])
    return {"cells": cells, "labels": labels}


def npz(**arrays: npt.NDArray[Any]) -> bytes:
    """The same bytes for the same arrays."""
    file = io.BytesIO()
    np.savez(file, **arrays)  # type: ignore[arg-type]
    return file.getvalue()


def _write_thickness(task: Task, row: dict[str, Any]) -> None:
    assert task.thickness is not None
    step, chunk = task.thickness
    mask, low = _padded_mask(task, 2 * math.ceil(task.largest_depth) + 2)
    shape = tuple(b - a for a, b in zip(task.low, task.high))[::-1]
    values = _core.thickness_of_block(mask, _place(task, low), task.threads).reshape(shape)
    for z in range(0, shape[0], chunk):
        for y in range(0, shape[1], chunk):
            for x in range(0, shape[2], chunk):
                part = values[z : z + chunk, y : y + chunk, x : x + chunk]
                if part.any():
                    part = np.rint(part / np.float32(step)).astype("<u2")
                    full = np.pad(part, [(0, chunk - size) for size in part.shape])
                    place = [(o + c) // chunk for o, c in zip(task.low[::-1], (z, y, x))]
                    name = f"thickness.zarr/0/{'.'.join(map(str, place))}"
                    _write(task, row, name, zlib.compress(full.tobytes(), 1))


def _parts(task: Task) -> dict[str, Any]:
    row: dict[str, Any] = {"low": task.low, "high": task.high}
    if task.thickness is not None:
        _write_thickness(task, row)
    if not task.wants_axis:
        return row
    halo = task.halo
    options = task.options
    while True:
        low, high = _limits(task, halo)
        field = _field(task, low, high, task.threads)
        part = _core.axis_of_block(
            field,
            _place(task, low),
            options.scale,
            task.largest_depth,
            options.seed,
            options.move,
            task.threads,
        )
        if part["is_certain"]:
            break
        halo = math.ceil(part["halo"]) + 1
    names = ("vertices", "radii", "face_offsets", "face_vertices", "angles", "curves")
    if len(part["vertices"]):
        arrays = {name: part[name] for name in names}
        _write(task, row, part_name(task.keys[0]), npz(**arrays))
        _write(task, row, polygons_name(task.keys[0]), ply_of_part(arrays, task.source, options.scale))
    row.update({name: part[name] for name in ("euler", "solid_euler", "samples", "balls")})
    row.update(vertices=len(part["vertices"]), faces=len(part["face_offsets"]) - 1, halo=halo)
    return row


def _checked(task: Task) -> dict[str, Any]:
    """The Euler characteristics of the axis and of the solid of the core alone, as if it ended where the core does.
    Neighbours share a layer of voxels, so that what is wrong between them is in one of them.
    """
    low = np.array(task.low)
    high = np.minimum(np.array(task.high) + 1, np.array(task.source.sizes))
    sizes = (high - low).tolist()
    field = np.pad(_field(task, low, high, task.threads), 1, mode="edge")
    for axis in range(3):
        for end in (0, -1):
            side = np.moveaxis(field, axis, 0)[end]
            np.abs(side, out=side)
            side[side == 0] = 1e-30  # outside, and other than 0
    place = [[-1] * 3, [0] * 3, sizes, sizes]
    options = task.options
    part = _core.axis_of_block(
        field, place, options.scale, task.largest_depth, options.seed, options.move, task.threads
    )
    return {name: part[name] for name in ("euler", "solid_euler")}


_WORK = {"depths": _depths, "part": _parts, "check": _checked}


def peak_memory() -> int:
    """Of this process, bytes. Linux counts in `ru_maxrss` what the process was before it became this program."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM"))
    except (OSError, StopIteration):
        return _core.peak_memory()


def computed(task: Task) -> dict[str, Any]:
    """The row of a task, whose results are written."""
    row = _WORK[task.kind](task)
    usage = resource.getrusage(resource.RUSAGE_SELF)
    row["seconds"] = usage.ru_utime + usage.ru_stime
    row["peak_memory"] = peak_memory()
    return row
