# SPDX-License-Identifier: Apache-2.0
"""A volume in one call."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

from .. import _core
from ..batch.call import _storage as storage_of
from ..batch.exits import bytes_of
from ..batch.progress import Counts, Progress, told
from ..batch.runners import dask_client, in_threads, on_dask, processors
from ..batch.storage import Storage
from ..curves import skeleton as skeleton_of
from ..data import MedialComplex, Topology
from ..errors import Error, FileError, InvalidOption
from ..files import write_axis
from ..stages import clean as clean_axis
from ..stages import filter as filter_axis
from ..stages import topology
from .blocks import MOVES, Options, Task, blocks_of, merged_labels, part_name, peak_memory, polygons_name
from .causes import CAUSES
from .formats import NANOMETRES
from .neuroglancer import write_precomputed
from .plan import Block, DepthMap, first_edge
from .sources import Source, Triple, source_of
from .stitching import part_of, stitched
from .worker import UNWRITTEN, Row, compute, known_row, servers

PARTS_FORMATS = ("ply", "vtp")
_FIRST_MOVE = 1e-4  # as the perturbation of `medial_axis`; doubled for all blocks if one of them contradicts itself
_INCONSISTENT = "result"  # the code of InconsistentResult
_MOST_FACES = 5_000_000  # of which Betti numbers are computed: seconds, beside minutes for the axis
_ROOM = "make room or let it be written, and call again: what is done stays"
# Bytes a face. Measured on axes of 200,000 and 600,000 faces: 457 stitched, 499 with the filter, 886 with cleaning.
_STITCHED, _CLEANED = 550, 950
_TOGETHER = 512  # voxels along an axis: within them depths are found by one process, a second or several for each
_EXPLAINED = 8  # blocks: each takes as long as twenty checks of it
_FINEST = 0.01  # voxels: the step of thickness, if the largest fits into 16 bits


@dataclass(frozen=True)
class Report:
    """What a call has made; `report.json` in the output is the same."""

    block: int  #: voxels along an axis
    blocks: int  #: that are not empty
    computed: int  #: in this call
    samples: int
    vertices: int
    faces: int
    euler: int | None  #: Euler characteristic of the axis
    solid_euler: int | None  #: of the solid between the voxels
    topology: Topology | None  #: of the stitched axis, if that was filtered or small enough
    largest_depth: float  #: voxels
    peak_memory: int  #: of the largest process of a block, bytes
    stitching_memory: int  #: of this process
    cpu_seconds: float  #: of all blocks
    mismatches: dict[Triple, int]  #: of blocks, by their first voxel: Euler characteristic of the axis less the solid's
    #: of the first of these blocks, what it is (growing, contact or thin: see docs/volumes.md) and a voxel where it is
    causes: dict[Triple, tuple[str, Triple]]
    axis: MedialComplex | None = None

    @property
    def agrees(self) -> bool | None:
        """Has the axis the Euler characteristic of the solid?"""
        return None if self.euler is None else self.euler == self.solid_euler


def memory_of(memory: str | int) -> int:
    """Of 4GB, 500M or a number. Raises InvalidOption."""
    size = memory if isinstance(memory, int) else bytes_of(memory)
    if size is None:
        raise InvalidOption(f"memory must be a size as '4GB', not {memory!r}")
    return size


def _key(kind: str, source: Source, low: Any, *told: Any) -> str:
    text = json.dumps([source, low, _core.version, *told], sort_keys=True)
    place = "-".join(map(str, low))
    return f"{kind}-{place}-{hashlib.blake2b(text.encode(), digest_size=12).hexdigest()}"


def _place(task: Task) -> str:
    return f"the block at voxel {', '.join(map(str, task.low))}"


def _lost(task: Task, _: str, **known: Any) -> list[Row]:
    return [{"key": task.keys[0], **known}]


class _Runs:
    """Tasks on this machine or on Dask; what is there is not computed again."""

    def __init__(self, storage: Storage, scheduler: Any, workers: int, progress: Progress) -> None:
        self.storage, self.scheduler, self.workers, self.progress = storage, scheduler, workers, progress
        self.computed = 0

    def rows(self, tasks: list[Task], check: Callable[[int], object] | None = None) -> list[Row]:
        """In the order of the tasks. Raises Error for the first that has no result, once all others are done; at once
        if results cannot be written, if a block contradicts itself, or if `check` does, which is told how many faces there
        are so far.
        """
        faces = 0
        counts = Counts(len(tasks))
        by_key = {task.keys[0]: task for task in tasks}
        rows: dict[str, Row] = {}
        missing = []
        for task in tasks:
            row = known_row(self.storage, task.keys[0])
            if row is None:
                missing.append(task)
            else:
                rows[task.keys[0]] = row
                counts.skipped += 1
                faces += row.get("faces", 0)
        if check is not None:
            check(faces)
        with told(self.progress, counts) as tell:
            for found in self._computed(iter(missing)) if missing else ():
                row = found[0]
                if row.get("code") == UNWRITTEN:
                    raise Error(
                        f"{self.storage.root}: {_place(by_key[row['key']])}: {row['error']}: {_ROOM}", UNWRITTEN
                    )
                if row.get("code") == _INCONSISTENT:  # then all are computed anew
                    raise Error(f"{_place(by_key[row['key']])}: {row['error']}", _INCONSISTENT)
                rows[row["key"]] = row
                self.computed += "error" not in row
                faces += row.get("faces", 0)
                if check is not None:
                    check(faces)
                counts.tried += 1
                counts.done += "error" not in row
                counts.failed += "error" in row
                tell()
        for task in tasks:
            row = rows[task.keys[0]]
            if "error" in row:
                raise Error(f"{_place(task)}: {row['error']}", row.get("code") or "volume.block")
        return [rows[task.keys[0]] for task in tasks]

    def _computed(self, tasks: Iterator[Task]) -> Iterator[list[Row]]:
        if self.scheduler is None:
            yield from in_threads(tasks, self.workers, compute, servers.stop_all)
        else:
            with dask_client(self.scheduler, self.workers) as client:
                yield from on_dask(tasks, client, compute, _lost)


def _table(rows: list[Row], spacing: float) -> str:
    """Of each label its voxels, its volume, and the box around it."""
    merged = merged_labels(row["labels"] for row in rows)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["label", "voxels", "volume", "low_x", "low_y", "low_z", "high_x", "high_y", "high_z"])
    for label in sorted(merged, key=int):
        count, *box = merged[label]
        writer.writerow([label, count, f"{count * spacing**3:.9g}", *box])
    return text.getvalue()


def _begin_thickness(storage: Storage, source: Source, step: float, chunk: int) -> None:
    """A multiscale image of OME-Zarr 0.4. Chunks of 0 are left out, so that none may be there of another volume."""
    steps: list[dict[str, Any]] = [{"type": "scale", "scale": [source.spacing] * 3}]
    if source.is_upright:  # this format has no directions
        steps.append({"type": "translation", "translation": list(source.origin[::-1])})
    unit = {"unit": source.unit} if source.unit in NANOMETRES else {}
    axes = [{"name": name, "type": "space", **unit} for name in "zyx"]
    levels = [{"path": "0", "coordinateTransformations": steps}]
    image = {"version": "0.4", "name": "thickness", "axes": axes, "datasets": levels}
    array = {
        "zarr_format": 2,
        "shape": source.sizes[::-1],
        "chunks": [chunk] * 3,
        "dtype": "<u2",
        "compressor": {"id": "zlib", "level": 1},
        "fill_value": 0,
        "order": "C",
        "filters": None,
        "dimension_separator": ".",
    }
    values = {"scale_factor": step * source.spacing, "add_offset": 0.0, "quantity": "diameter", **unit}
    contents = {
        "0/.zarray": array,
        "0/.zattrs": values,
        ".zgroup": {"zarr_format": 2},
        ".zattrs": {"multiscales": [image], "scaleaxis": _key("thickness", source, (), step)},
    }
    written = {f"thickness.zarr/{name}": json.dumps(content).encode() for name, content in contents.items()}
    if any(storage.read(name) != content for name, content in written.items()):
        storage.remove("thickness.zarr")
        for name, content in written.items():
            storage.write(name, content)


def _tidy(storage: Storage) -> None:
    """Without what killed processes have left behind in the middle of writing."""
    for folder in ("blocks", "thickness.zarr/0", "skeletons", "thickness.zarr", ""):
        for name in [name for name in storage.names(folder) if re.search(r"[.]part[0-9]*$", name)]:
            storage.remove(f"{folder}/{name}".lstrip("/"))


@contextmanager
def _writing(storage: Storage) -> Iterator[None]:
    """Around what writes results. What is done stays."""
    try:
        yield
    except Error as error:
        if isinstance(error, FileError) and error.code == "file.write":
            raise Error(f"{error}: {_ROOM}", UNWRITTEN) from None
        raise
    except OSError as error:
        what = (error.strerror or str(error)).lower()
        raise Error(f"{storage.root}: results cannot be written: {what}: {_ROOM}", UNWRITTEN) from None
    finally:
        with suppress(OSError):
            _tidy(storage)


class _Wanted(NamedTuple):
    axis: bool
    stitch: bool
    thickness: bool
    angle: float | None
    clean: float | None
    skeleton: bool
    parts_format: str


def _saved(storage: Storage, name: str, save: Callable[[Path], object]) -> None:
    """Where results are, or through a file of this machine. The library's own writers leave nothing in part."""
    if storage.is_local:
        save(Path(storage.path(name)))
        return
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / os.path.basename(name)
        save(file)
        storage.write(name, file.read_bytes())


def _global_steps(storage: Storage, source: Source, complex: MedialComplex, wanted: _Wanted) -> Topology | None:
    """What is made of the stitched axis. Returns its topology where that costs little beside the rest."""
    left = complex
    if wanted.angle is not None:
        left = filter_axis(left, wanted.angle).complex
    if wanted.clean is not None:
        left = clean_axis(left, wanted.clean).complex
    if left is not complex:
        _saved(storage, "filtered.ply", lambda file: write_axis(file, left, polygons=True))
    if wanted.skeleton:
        curves = skeleton_of(left)
        _saved(storage, "skeleton.swc", curves.save)
        segment = source.labels[0] if len(source.labels) == 1 else 1
        write_precomputed(storage, curves, segment, source.unit)
    return topology(left) if len(left.faces) <= _MOST_FACES else None


def _mismatches(runs: _Runs, parts: list[Task]) -> tuple[dict[Triple, int], dict[Triple, tuple[str, Triple]]]:
    """The blocks whose axis has another Euler characteristic than their solid, each as a solid of its own that ends
    where its core does; and the causes.
    """

    def rows(kind: str, parts: list[Task]) -> Iterator[tuple[Triple, Row]]:
        every = []
        for part in parts:
            key = _key(kind, part.source, part.low, part.high, part.options, part.largest_depth)
            every.append(part._replace(kind=kind, keys=[key]))
        yield from zip((part.low for part in parts), runs.rows(every))

    checks = ((low, row["euler"] - row["solid_euler"]) for low, row in rows("check", parts) if "euler" in row)
    found = {low: much for low, much in checks if much}
    wrong = [part for part in parts if part.low in found][:_EXPLAINED]
    causes = {low: (row["cause"], tuple(row["place"])) for low, row in rows("explain", wrong) if "cause" in row}
    return found, causes


def _options(scale: float, smoothing: int, seed: int) -> None:
    if not (isinstance(scale, (int, float)) and math.isfinite(scale) and scale >= 1):
        raise InvalidOption(f"scale must be a number of at least 1, not {scale!r}")
    if smoothing not in range(5):
        raise InvalidOption(f"smoothing must be 0 to 4, not {smoothing!r}")
    if not isinstance(seed, int) or seed < 0:
        raise InvalidOption(f"seed must be a whole number of at least 0, not {seed!r}")


def _axis_rows(
    runs: _Runs, tasks: Callable[[float], list[Task]], check: Callable[[int], object] | None = None
) -> tuple[list[Row], list[Task]]:
    """Balls are moved more, in all blocks, until no block contradicts itself."""
    move = _FIRST_MOVE
    for attempt in range(MOVES):
        try:
            every = tasks(move)
            return runs.rows(every, check), every
        except Error as error:
            if error.code != _INCONSISTENT or attempt == MOVES - 1:
                raise
            move *= 2
    raise AssertionError


class _Stitched(NamedTuple):
    axis: MedialComplex | None
    topology: Topology | None
    mismatches: dict[Triple, int]
    causes: dict[Triple, tuple[str, Triple]]


def _check_stitching(faces: int, wanted: _Wanted, memory: int) -> None:
    """Raises InvalidOption if the stitched axis would not fit."""
    needed = peak_memory() + faces * (_STITCHED if wanted.clean is None else _CLEANED)
    if needed > memory:
        raise InvalidOption(
            f"the blocks that are done have {faces} faces, which take {needed / 1e9:.2g} GB when they are stitched, "
            f"and the memory is {memory / 1e9:.2g} GB: give more, for what is done stays, leave the axis in parts, "
            "or take a coarser level"
        )


def _put_together(
    runs: _Runs, source: Source, every: list[Task], rows: list[Row], wanted: _Wanted, scale: float
) -> _Stitched:
    """The parts as one axis, and what is made of that."""
    storage = runs.storage
    differs = sum(row["euler"] for row in rows) != sum(row["solid_euler"] for row in rows)
    mismatches, causes = _mismatches(runs, every) if differs else ({}, {})
    if not wanted.stitch:
        return _Stitched(None, None, mismatches, causes)
    contents = (storage.read(part_name(at.keys[0])) for at, row in zip(every, rows) if row["vertices"])
    complex = stitched((part_of(content or b"") for content in contents), source, scale)
    euler = sum(row["euler"] for row in rows)
    count = len(complex.vertices) - len(complex.edges) + len(complex.faces)
    if count != euler:
        raise Error(
            f"the parts do not fit: together their Euler characteristic is {euler}, stitched {count}", "volume.stitch"
        )
    _saved(storage, "axis.ply", lambda file: write_axis(file, complex, polygons=True))
    return _Stitched(complex, _global_steps(storage, source, complex, wanted), mismatches, causes)


def _write_report(storage: Storage, told: dict[str, Any]) -> None:
    """What stitching takes differs from call to call: the report of what was there already stays as it is."""
    try:
        known = json.loads(storage.read("report.json") or b"{}")
    except ValueError:
        known = {}
    if known | {"stitching_memory": told["stitching_memory"]} != told:
        storage.write("report.json", json.dumps(told, indent=1).encode())


def _check_labels(source: Source, depth_rows: list[Row]) -> None:
    """Raises InvalidOption if one of several labels is that of no voxel."""
    found = {label for row in depth_rows for label in row["chosen"]}
    absent = [label for label in source.labels if label not in found]
    if absent and len(source.labels) > 1:
        raise InvalidOption(f"no voxel has the label {absent[0]}: choose labels that the volume has")


def _results(runs: _Runs, source: Source, options: Options, wanted: _Wanted, memory: int, block: int | None) -> Report:
    storage, share = runs.storage, memory // runs.workers
    threads = max(1, processors() // runs.workers) if runs.scheduler is None else 1

    def task(kind: str, low: Any, high: Any, options: Options, told: Any, **more: Any) -> Task:
        key = _key(kind, source, low, high, options, told)
        return Task(kind, [key], storage, source, options, low, high, threads, **more)

    unused = Options(1.0, 0, 0, 0.0)  # depths are those of voxels
    first = first_edge(share)
    together = max(first, _TOGETHER // first * first)
    places = blocks_of((0, 0, 0), source.sizes, together)
    depth_rows = runs.rows([task("depths", low, high, unused, "chosen", edge=first) for low, high in places])
    depths = DepthMap.of(source.sizes, depth_rows)
    edge, blocks = depths.plan(options.scale if wanted.axis else None, share, block)
    largest = float(depths.depths.max())
    if not blocks:
        raise InvalidOption("no voxel is inside: another label or level?")
    _check_labels(source, depth_rows)
    step = max(_FINEST, 2 * largest / 65535)
    chunk = math.gcd(edge, 128)
    if wanted.thickness:
        _begin_thickness(storage, source, step, chunk)

    def parts(move: float) -> list[Task]:
        moved = options._replace(move=move)
        thickness = (step, chunk) if wanted.thickness else None

        def of(at: Block) -> Task:
            told: tuple[Any, ...] = (at.halo, at.largest_depth, wanted.axis, thickness)
            told += () if wanted.parts_format == "ply" else (wanted.parts_format,)
            more = {
                "halo": at.halo,
                "largest_depth": at.largest_depth,
                "wants_axis": wanted.axis,
                "content": at.content,
                "parts_format": wanted.parts_format,
            }
            return task("part", at.low, at.high, moved, told, **more, thickness=thickness)

        return [of(at) for at in blocks]

    is_stitched = wanted.axis and wanted.stitch
    rows, every = _axis_rows(
        runs, parts, (lambda faces: _check_stitching(faces, wanted, memory)) if is_stitched else None
    )
    if any(row["labels"] for row in depth_rows):
        storage.write("labels.csv", _table(depth_rows, source.spacing).encode())
    found = _put_together(runs, source, every, rows, wanted, options.scale) if wanted.axis else None
    report = Report(
        block=edge,
        blocks=len(blocks),
        computed=runs.computed,
        samples=int(depths.crossings.sum()),
        vertices=0 if found is None or found.axis is None else len(found.axis.vertices),
        faces=0 if found is None else sum(row["faces"] for row in rows),
        euler=None if found is None else sum(row["euler"] for row in rows),
        solid_euler=None if found is None else sum(row["solid_euler"] for row in rows),
        topology=None if found is None else found.topology,
        largest_depth=largest,
        peak_memory=max(row["peak_memory"] for row in [*depth_rows, *rows]),
        stitching_memory=_core.peak_memory(),
        cpu_seconds=sum(row["seconds"] for row in [*depth_rows, *rows]),
        mismatches={} if found is None else found.mismatches,
        causes={} if found is None else found.causes,
        axis=None if found is None else found.axis,
    )
    told = {name: value for name, value in vars(report).items() if name not in ("axis", "computed")}
    told |= {
        "agrees": report.agrees,
        "mismatches": [[*low, much] for low, much in report.mismatches.items()],
        "causes": [[*low, cause, *place] for low, (cause, place) in report.causes.items()],
        "unit": source.unit,
        "parts": [polygons_name(at.keys[0], at.parts_format) for at, row in zip(every, rows) if row.get("vertices")],
    }
    _write_report(storage, json.loads(json.dumps(told, default=str)))
    return report


def volume(
    source: str | os.PathLike[str] | Source,
    output: str | os.PathLike[str],
    *,
    memory: str | int = "4GB",
    workers: int | None = None,
    scheduler: Any = None,
    block: int | None = None,
    label: int | Sequence[int] | None = None,
    level: float | None = None,
    below: bool = False,
    dataset: str | int | None = None,
    spacing: float | None = None,
    smoothing: int = 1,
    scale: float = 1.1,
    seed: int = 1,
    axis: bool = True,
    stitch: bool = True,
    parts_format: Literal["ply", "vtp"] = "ply",
    thickness: bool = False,
    angle: float | None = None,
    clean: float | None = None,
    skeleton: bool = False,
    progress: Progress = None,
    storage_options: dict[str, Any] | None = None,
) -> Report:
    """The axis and the thickness of a volume in blocks, to the last bit those of the whole. What an earlier call has done
    is skipped.

    source: .npy, Zarr, OME-Zarr or N5, NRRD or NIfTI of raw data, Neuroglancer precomputed.
    output: a folder, or a location of fsspec: gets `axis.ply`, `thickness.zarr`, `labels.csv`, `report.json`, `blocks`,
        which has a file of each part of the axis.
    memory: of all workers together. It decides how large blocks are, if `block` does not.
    workers: blocks at a time on this machine (default: its processors).
    scheduler: of Dask, as for `batch`; then `workers` says how many share the memory.
    block: voxels along an axis, a multiple of 32.
    label: one label, or several that are one solid. None: all voxels other than 0.
    level, below: the solid is above this value, or below it.
    dataset: the array in a Zarr, or the level of a multiscale image or of a precomputed volume.
    spacing: of voxels, in place of that of the file.
    smoothing: how often a mask is smoothed by [1 2 1] along each axis, 0 to 4. Voxels stay on their side.
    scale: s, by which balls are grown.
    seed: of what is moved to be in general position.
    axis, thickness: what is wanted of each block.
    stitch: whether the parts of the axis are put together, which has to fit into the memory, .55 kB a face.
    parts_format: of the parts: ply or vtp.
    angle, clean: of the stitched axis sheets below this object angle (degrees) and what has less erosion thickness than
        this length are removed, as by `filter` and `clean`: `filtered.ply`.
    skeleton: the curve skeleton of what is left: `skeleton.swc`, and `skeletons`, precomputed for Neuroglancer.

    Raises InvalidOption before any work, or before any axis if no voxel has one of the labels, or if a block needs more
    than its share of the memory; FileError where the volume cannot be read; Error naming a block that has no result.
    """
    _options(scale, smoothing, seed)
    if not (axis or thickness):
        raise InvalidOption("nothing is wanted: ask for the axis or the thickness")
    if parts_format not in PARTS_FORMATS:
        raise InvalidOption(f"parts_format must be ply or vtp, not {parts_format!r}")
    if not (axis and stitch) and (skeleton or angle is not None or clean is not None):
        raise InvalidOption("angle, clean and skeleton are of the stitched axis: leave them out, or stitch")
    if block is not None and (not isinstance(block, int) or block < 32 or block % 32):
        raise InvalidOption(f"block must be a multiple of 32 voxels, not {block!r}")
    at_a_time = processors() if workers is None else workers
    if not isinstance(at_a_time, int) or at_a_time < 1:
        raise InvalidOption(f"workers must be at least 1, not {workers!r}")
    labels = () if label is None else (label,) if isinstance(label, int) else tuple(dict.fromkeys(label))
    if label is not None and not labels:
        raise InvalidOption("label is an empty list: give a label, or None for all voxels other than 0")
    known = (
        source
        if isinstance(source, Source)
        else source_of(source, labels=labels, level=level, below=below, dataset=dataset, spacing=spacing)
    )
    storage = storage_of(output, storage_options)
    runs = _Runs(storage, scheduler, at_a_time, progress)
    wanted = _Wanted(axis, stitch, thickness, angle, clean, skeleton, parts_format)
    options = Options(float(scale), smoothing, seed, _FIRST_MOVE)
    with _writing(storage):
        return _results(runs, known, options, wanted, memory_of(memory), block)


__all__ = ["CAUSES", "PARTS_FORMATS", "Report", "memory_of", "volume"]
