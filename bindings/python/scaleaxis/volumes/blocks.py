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
from ..errors import Error, InconsistentResult
from .causes import repairs
from .sources import Bytes, Source, Triple
from .stitching import ply_of_part, vtp_of_part

CELL = 32  # voxels: of these cubes it is kept how deep the solid is, so that blocks know what is around them
_FIRST_HALO = 8  # voxels: most solids are less deep, and others are met again with a halo that is large enough
MOVES = 4  # of balls, each twice as far as the one before
_GROUP = 8  # voxels: places nearer to each other are one when the place of a difference is sought
_MOST_LABELS = 65535  # more than that are no labels

Place = list[list[int]]
_Voxel = npt.NDArray[np.int64]  # x first


class Options(NamedTuple):
    """Of the results: part of their names."""

    scale: float
    smoothing: int
    seed: int
    move: float


class Task(NamedTuple):
    """Plain data, which goes to workers."""

    kind: str  #: depths, part, check or explain
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
    content: tuple[Triple, Triple] | None = None  #: no voxel inside with this halo is beyond it; None: not known
    parts_format: str = "ply"
    thickness: tuple[float, int] | None = None  #: voxels for each step of 16 bits, and the size of chunks


def row_name(key: str) -> str:
    return f"blocks/{key}.json"


def part_name(key: str) -> str:
    return f"blocks/{key}.npz"


def polygons_name(key: str, extension: str) -> str:
    return f"blocks/{key}.{extension}"


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


def _array(source: Source, low: _Voxel, high: _Voxel) -> tuple[npt.NDArray[Any], Any]:
    """The voxels from `low` to `high` as far as they are in the volume, and how many layers are missing."""
    sizes = np.array(source.sizes)
    inner_low, inner_high = np.maximum(low, 0), np.minimum(high, sizes)
    values = source.read(tuple(inner_low.tolist()), tuple(inner_high.tolist()))
    missing = [(int(a), int(b)) for a, b in zip((inner_low - low)[::-1], (high - inner_high)[::-1])]
    return values, missing


def _limits(task: Task, halo: int) -> tuple[_Voxel, _Voxel]:
    """Of an array with such a halo: in the volume, and one layer beyond its ends."""
    sizes = np.array(task.source.sizes)
    return np.maximum(np.array(task.low) - halo, -1), np.minimum(np.array(task.high) + halo + 1, sizes + 1)


def box_of(mask: npt.NDArray[Any]) -> tuple[slice, ...] | None:
    """Around all that is not 0."""
    box = []
    for axis in range(3):
        found = np.flatnonzero(mask.any(axis=tuple({0, 1, 2} - {axis})))
        if not len(found):
            return None
        box.append(slice(int(found[0]), int(found[-1]) + 1))
    return tuple(box)


def _inside(task: Task, low: _Voxel, high: _Voxel) -> tuple[Bytes, _Voxel] | None:
    """The mask between `low` and `high`, cut to what is inside, and its first voxel. None if nothing is."""
    low, high = np.maximum(low, 0), np.minimum(high, task.source.sizes)
    if task.content is not None:
        low, high = np.maximum(low, task.content[0]), np.minimum(high, task.content[1])
    if (low >= high).any():
        return None
    mask = _mask(task.source, task.source.read(tuple(low.tolist()), tuple(high.tolist())))
    box = box_of(mask)
    return None if box is None else (np.ascontiguousarray(mask[box]), low + [at.start for at in box[::-1]])


def _ends(array: npt.NDArray[Any], low: _Voxel) -> _Voxel:
    return low + array.shape[::-1]


def _padded(mask: Bytes, at: _Voxel, low: _Voxel, high: _Voxel) -> Bytes:
    """From `low` to `high`, what was cut off outside."""
    return np.pad(mask, list(zip((at - low)[::-1], (high - _ends(mask, at))[::-1])))


def _field(task: Task, low: _Voxel, high: _Voxel) -> tuple[npt.NDArray[np.float32], _Voxel]:
    """The values between `low` and `high`, negative inside, as far as the solid and a layer around it reach, and the first
    voxel. What is beyond the volume is outside.
    """
    source, passes = task.source, task.options.smoothing
    margin = 0 if source.level is not None else passes + 1  # what smoothing looks at
    found = _inside(task, low - margin, high + margin)
    if found is None:
        raise Error(f"{source.path}: nothing is inside any more: it has changed, so give another output")
    mask, at = found
    first, last = np.maximum(at - 1, low), np.minimum(_ends(mask, at) + 1, high)
    if source.level is not None:
        del mask
        values, missing = _array(source, first, last)
        field = values.astype(np.float32) - np.float32(source.level)
        field = field if source.below else -field
        # Beyond the ends it is as far outside as it is inside at the border: the solid ends half way.
        beyond = np.pad(np.zeros(field.shape, bool), missing, constant_values=True)
        field = np.pad(field, missing, mode="edge")
        np.abs(field, out=field, where=beyond)
        field[beyond & (field == 0)] = 1e-30  # outside, and other than 0
        return field, first
    mask = _padded(mask, at, first - margin, last + margin)
    field = _core.mask_values(mask, passes, task.threads).reshape(mask.shape)
    return np.ascontiguousarray(field[(slice(margin, -margin),) * 3]), first


def _place(task: Task, array: npt.NDArray[Any], at: _Voxel, low: _Voxel, high: _Voxel) -> Place:
    """Of an array that begins at `at`, and that has all there is between `low` and `high`."""
    empty = [(at - low).tolist(), (high - _ends(array, at)).tolist()]
    return [at.tolist(), list(task.low), list(task.high), list(task.source.sizes), *empty]


def _core_of(task: Task, array: npt.NDArray[Any], low: _Voxel) -> npt.NDArray[Any]:
    at = [slice(a - o, b - o) for a, b, o in zip(task.low, task.high, low.tolist())]
    return array[tuple(at[::-1])]


def _occupied(values: npt.NDArray[Any], shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Of each cell in an array of this shape, whether there is anything but 0 in it, or in the layer after it."""
    for axis, size in enumerate(shape):
        layers = np.moveaxis(values, axis, 0)
        values = np.stack([layers[at : at + CELL + 1].any(axis=0) for at in range(0, size, CELL)], axis)
    return values


def boxes_of(cells: npt.NDArray[np.bool_], low: tuple[int, ...] = (0, 0, 0)) -> list[tuple[slice, ...]]:
    """Of boxes around all that is there. A box is halved along its longest axis if its halves, each cut to what is in
    it, have fewer voxels with what is around them.
    """
    box = box_of(cells)
    if box is None:
        return []
    cells = cells[box]
    low = tuple(a + at.start for a, at in zip(low, box))
    whole = [tuple(slice(a, a + n) for a, n in zip(low, cells.shape))]
    axis = int(np.argmax(cells.shape))
    middle = cells.shape[axis] // 2
    if cells.all() or middle == 0:
        return whole
    halves = []
    for begin, half in zip((0, middle), np.split(cells, [middle], axis)):
        halves += boxes_of(half, tuple(a + begin * (n == axis) for n, a in enumerate(low)))
    return halves if sum(map(_volume, halves)) < _volume(whole[0]) else whole


def _volume(box: tuple[slice, ...]) -> int:
    return math.prod((at.stop - at.start) * CELL + 2 * _FIRST_HALO for at in box)


def _voxels(box: tuple[slice, ...], shape: tuple[int, ...]) -> tuple[slice, ...]:
    """Of cells, in an array of this shape."""
    return tuple(slice(at.start * CELL, min(at.stop * CELL, size)) for at, size in zip(box, shape))


def _part_of_core(task: Task, box: tuple[slice, ...]) -> Task:
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
    """Of each cell of the core the voxels inside, the largest depth, and the crossings of lattice edges; which labels
    are there, of several that are solid. Empty space takes less time than a process: one does many blocks, one after
    the other.
    """
    rows = [
        _depths_of_block(task._replace(low=low, high=high)) for low, high in blocks_of(task.low, task.high, task.edge)
    ]
    cells = [cell for row in rows for cell in row["cells"]]
    chosen = sorted({label for row in rows for label in row["chosen"]})
    return {"cells": cells, "labels": merged_labels(row["labels"] for row in rows), "chosen": chosen}


def _depths_of_block(task: Task) -> dict[str, Any]:
    source = task.source
    values, _ = _array(source, *_limits(task, 0))
    shape = tuple(b - a for a, b in zip(task.low, task.high))[::-1]
    labels: dict[str, list[int]] = {}
    chosen: list[int] = []
    if source.level is None:
        boxes = [_voxels(box, shape) for box in boxes_of(_occupied(values, shape))]
        labels = merged_labels(_labels(values[box], _part_of_core(task, box).low) for box in boxes)
    if source.level is not None or source.labels:
        mask = _mask(source, values)
        boxes = [_voxels(box, shape) for box in boxes_of(_occupied(mask, shape))]
        inside = values[mask != 0] if len(source.labels) > 1 else values[:0]
        chosen = [label for label in source.labels if (inside == label).any()]
        del mask, inside
    del values
    cells = [cell for box in boxes for cell in _depths_of_box(_part_of_core(task, box))]
    return {"cells": cells, "labels": labels, "chosen": chosen}


def _depths_of_box(task: Task) -> list[list[int]]:
    source = task.source
    halo = _FIRST_HALO
    while True:
        low, high = _limits(task, halo)
        values, missing = _array(source, low, high)
        mask = np.pad(_mask(source, values), missing)
        del values
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
    return cells


def npz(**arrays: npt.NDArray[Any]) -> bytes:
    """The same bytes for the same arrays."""
    file = io.BytesIO()
    np.savez(file, **arrays)  # type: ignore[arg-type]
    return file.getvalue()


def _write_thickness(task: Task, row: dict[str, Any]) -> None:
    assert task.thickness is not None
    step, chunk = task.thickness
    low, high = _limits(task, 2 * math.ceil(task.largest_depth) + 2)
    found = _inside(task, low, high)
    assert found is not None
    mask, at = found
    core = np.maximum(at, task.low), np.minimum(_ends(mask, at), task.high)
    low, high = np.maximum(at - 1, low), np.minimum(_ends(mask, at) + 1, high)
    place = [low.tolist(), core[0].tolist(), core[1].tolist(), list(task.source.sizes), [0] * 3, [0] * 3]
    # The chunks around it.
    first = core[0] // chunk * chunk
    shape = tuple((core[1] - first)[::-1].tolist())
    values = np.zeros(shape, np.float32)
    part = values[tuple(slice(a - o, None) for a, o in zip(core[0][::-1], first[::-1]))]
    part[...] = _core.thickness_of_block(_padded(mask, at, low, high), place, task.threads).reshape(part.shape)
    for z in range(0, shape[0], chunk):
        for y in range(0, shape[1], chunk):
            for x in range(0, shape[2], chunk):
                part = values[z : z + chunk, y : y + chunk, x : x + chunk]
                if part.any():
                    part = np.rint(part / np.float32(step)).astype("<u2")
                    full = np.pad(part, [(0, chunk - size) for size in part.shape])
                    place = [(o + c) // chunk for o, c in zip(first[::-1].tolist(), (z, y, x))]
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
        field, at = _field(task, low, high)
        part = _core.axis_of_block(
            field,
            _place(task, field, at, low, high),
            options.scale,
            task.largest_depth,
            options.seed,
            options.move,
            task.threads,
        )
        if part["is_certain"]:
            break
        halo = math.ceil(part["halo"]) + 1
        task = task._replace(content=None)
    names = ("vertices", "radii", "face_offsets", "face_vertices", "angles", "curves")
    if len(part["vertices"]):
        arrays = {name: part[name] for name in names}
        _write(task, row, part_name(task.keys[0]), npz(**arrays))
        write = vtp_of_part if task.parts_format == "vtp" else ply_of_part
        content = write(arrays, task.source, options.scale)
        _write(task, row, polygons_name(task.keys[0], task.parts_format), content)
    row.update({name: part[name] for name in ("euler", "solid_euler", "samples", "balls")})
    row.update(vertices=len(part["vertices"]), faces=len(part["face_offsets"]) - 1, halo=halo)
    return row


def _alone(task: Task) -> tuple[npt.NDArray[np.float32], _Voxel, Place]:
    """The values of the core as of a solid that ends where the core does, and the first voxel. Neighbours share a layer of
    voxels, so that what is wrong between them is in one of them.
    """
    low = np.array(task.low)
    high = np.minimum(np.array(task.high) + 1, np.array(task.source.sizes))
    field, at = _field(task, low, high)
    field = np.pad(field, 1, mode="edge")
    for axis in range(3):
        for end in (0, -1):
            side = np.moveaxis(field, axis, 0)[end]
            np.abs(side, out=side)
            side[side == 0] = 1e-30  # outside, and other than 0
    sizes = tuple((high - low).tolist())
    alone = task._replace(low=(0, 0, 0), high=sizes, source=task.source._replace(sizes=sizes))
    return field, at - 1, _place(alone, field, at - low - 1, np.full(3, -1), high - low + 1)


def _euler_of(task: Task, field: npt.NDArray[np.float32], place: Place) -> dict[str, Any]:
    """The Euler characteristics of the axis and of the solid of a core alone. Balls are moved as it likes, for it has no
    neighbours; empty if none of the moves helps.
    """
    options = task.options
    for attempt in range(MOVES):
        move = options.move * 2**attempt
        try:
            part = _core.axis_of_block(
                field, place, options.scale, task.largest_depth, options.seed, move, task.threads
            )
        except InconsistentResult:
            continue
        return {name: part[name] for name in ("euler", "solid_euler")}
    return {}


def _checked(task: Task) -> dict[str, Any]:
    field, _, place = _alone(task)
    return _euler_of(task, field, place)


def _explained(task: Task) -> dict[str, Any]:
    """What makes the Euler characteristics of a core differ, and a voxel where it does. Places of a kind are filled: if the
    two agree then, it was these. Where: the first group of places that changes the difference, if all before it are
    filled, too.
    """
    field, at, place = _alone(task)

    def difference(filled: Any) -> int | None:
        values = field.copy()
        values[filled] = -np.maximum(np.abs(values[filled]), np.float32(1e-30))
        euler = _euler_of(task, values, place)
        return euler["euler"] - euler["solid_euler"] if euler else None

    none = np.zeros(field.shape, bool)
    known = difference(none)
    if not known:
        return {}
    best: tuple[int, str, npt.NDArray[np.bool_]] | None = None
    for kind, filled in repairs(field < 0, task.options.scale, task.threads):
        left = difference(filled) if filled.any() else None
        if left is not None and abs(left) < (abs(known) if best is None else best[0]):
            best = (abs(left), kind, filled)
        if left == 0:
            break
    if best is None:
        return {}
    _, cause, filled = best
    voxels = np.argwhere(filled)
    groups, number = np.unique(voxels // _GROUP, axis=0, return_inverse=True)
    number = number.reshape(-1)
    low, high = 0, len(groups)  # with the groups before `low` the difference is as it was, before `high` it is not
    while high - low > 1:
        middle = (low + high) // 2
        some = none.copy()
        some[tuple(voxels[number < middle].T)] = True
        low, high = (middle, high) if difference(some) == known else (low, middle)
    return {"cause": cause, "place": (at + voxels[number == low][0][::-1]).tolist()}


_WORK = {"depths": _depths, "part": _parts, "check": _checked, "explain": _explained}


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
