# SPDX-License-Identifier: Apache-2.0
"""A volume in one call."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _core
from ..batch.call import _storage as storage_of
from ..batch.exits import bytes_of
from ..batch.progress import Counts, Progress, told
from ..batch.runners import dask_client, in_threads, on_dask, processors
from ..batch.storage import Storage
from ..curves import skeleton as skeleton_of
from ..data import MedialComplex, Topology
from ..errors import Error, InvalidOption
from ..files import write_axis
from ..stages import clean as clean_axis
from ..stages import filter as filter_axis
from ..stages import topology
from .blocks import Options, Task, part_name
from .neuroglancer import write_precomputed
from .plan import Block, DepthMap, blocks_of, first_edge
from .sources import Source, Triple, source_of
from .stitching import part_of, stitched
from .worker import Row, compute, known_row, stop_all

_FIRST_MOVE = 1e-4  # as the perturbation of `medial_axis`; doubled for all blocks if one of them contradicts itself
_MOVES = 4
_INCONSISTENT = "result"  # the code of InconsistentResult
_MOST_FACES = 5_000_000  # of which Betti numbers are computed: seconds, beside minutes for the axis
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


def _lost(task: Task, _: str, **known: Any) -> list[Row]:
    return [{"key": task.keys[0], **known}]


class _Runs:
    """Tasks on this machine or on Dask; what is there is not computed again."""

    def __init__(self, storage: Storage, scheduler: Any, workers: int, progress: Progress) -> None:
        self.storage, self.scheduler, self.workers, self.progress = storage, scheduler, workers, progress
        self.computed = 0

    def rows(self, tasks: list[Task]) -> list[Row]:
        """In the order of the tasks. Raises Error for the first that has no result, once all others are done."""
        counts = Counts(len(tasks))
        rows: dict[str, Row] = {}
        missing = []
        for task in tasks:
            row = known_row(self.storage, task.keys[0])
            if row is None:
                missing.append(task)
            else:
                rows[task.keys[0]] = row
                counts.skipped += 1
        with told(self.progress, counts) as tell:
            for found in self._computed(iter(missing)) if missing else ():
                row = found[0]
                rows[row["key"]] = row
                counts.tried += 1
                counts.done += "error" not in row
                counts.failed += "error" in row
                tell()
        self.computed += counts.done
        for task in tasks:
            row = rows[task.keys[0]]
            if "error" in row:
                place = ", ".join(map(str, task.low))
                raise Error(f"the block at voxel {place}: {row['error']}", row.get("code") or "volume.block")
        return [rows[task.keys[0]] for task in tasks]

    def _computed(self, tasks: Iterator[Task]) -> Iterator[list[Row]]:
        if self.scheduler is None:
            yield from in_threads(tasks, self.workers, compute, stop_all)
        else:
            with dask_client(self.scheduler, self.workers) as client:
                yield from on_dask(tasks, client, compute, _lost)


def _table(rows: list[Row], spacing: float) -> str:
    """Of each label its voxels, its volume, and the box around it."""
    merged: dict[int, list[int]] = {}
    for row in rows:
        for label, (count, *box) in row["labels"].items():
            known = merged.setdefault(int(label), [0, *box])
            known[0] += count
            known[1:4] = map(min, known[1:4], box[:3])
            known[4:] = map(max, known[4:], box[3:])
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["label", "voxels", "volume", "low_x", "low_y", "low_z", "high_x", "high_y", "high_z"])
    for label in sorted(merged):
        count, *box = merged[label]
        writer.writerow([label, count, f"{count * spacing**3:.9g}", *box])
    return text.getvalue()


def _begin_thickness(storage: Storage, source: Source, step: float, chunk: int) -> None:
    """A multiscale image of OME-Zarr 0.4. Chunks of 0 are left out."""
    scale = [source.spacing] * 3
    shifts = {"type": "translation", "translation": list(source.origin[::-1])}
    steps = [{"type": "scale", "scale": scale}, shifts]
    axes = [{"name": name, "type": "space"} for name in "zyx"]
    image = {"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": steps}]}
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
    values = {"scale_factor": step * source.spacing, "add_offset": 0.0, "quantity": "diameter"}
    for name, content in {
        ".zgroup": {"zarr_format": 2},
        ".zattrs": {"multiscales": [image]},
        "0/.zarray": array,
        "0/.zattrs": values,
    }.items():
        storage.write(f"thickness.zarr/{name}", json.dumps(content).encode())


def _saved(storage: Storage, name: str, save: Callable[[Path], object]) -> None:
    """Through a file of this machine."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / os.path.basename(name)
        save(file)
        storage.write(name, file.read_bytes())


def _global_steps(
    storage: Storage, complex: MedialComplex, angle: float | None, least: float | None, skeleton: bool
) -> Topology | None:
    """What is made of the stitched axis. Returns its topology where that costs little beside the rest."""
    left = complex
    if angle is not None:
        left = filter_axis(left, angle).complex
    if least is not None:
        left = clean_axis(left, least).complex
    if left is not complex:
        _saved(storage, "filtered.ply", lambda file: write_axis(file, left, polygons=True))
    if skeleton:
        curves = skeleton_of(left)
        _saved(storage, "skeleton.swc", curves.save)
        write_precomputed(storage, curves)
    return topology(left) if len(left.faces) <= _MOST_FACES else None


def _mismatches(runs: _Runs, parts: list[Task]) -> dict[Triple, int]:
    """The blocks whose axis has another Euler characteristic than their solid. Both are sums over blocks and what they
    share, so that it is in one of them where those of the whole differ.
    """

    def check(part: Task) -> Task:
        key = _key("check", part.source, part.low, part.high, part.options)
        return part._replace(kind="check", keys=[key])

    checks = [check(part) for part in parts]
    rows = zip(checks, runs.rows(checks))
    return {at.low: row["euler"] - row["solid_euler"] for at, row in rows if row["euler"] != row["solid_euler"]}


def _options(scale: float, smoothing: int, seed: int) -> None:
    if not (isinstance(scale, (int, float)) and math.isfinite(scale) and scale >= 1):
        raise InvalidOption(f"scale must be a number of at least 1, not {scale!r}")
    if smoothing not in range(5):
        raise InvalidOption(f"smoothing must be 0 to 4, not {smoothing!r}")
    if not isinstance(seed, int) or seed < 0:
        raise InvalidOption(f"seed must be a whole number of at least 0, not {seed!r}")


def _axis_rows(runs: _Runs, tasks: Callable[[float], list[Task]]) -> tuple[list[Row], list[Task]]:
    """Balls are moved more, in all blocks, until no block contradicts itself."""
    move = _FIRST_MOVE
    for attempt in range(_MOVES):
        try:
            every = tasks(move)
            return runs.rows(every), every
        except Error as error:
            if error.code != _INCONSISTENT or attempt == _MOVES - 1:
                raise
            move *= 2
    raise AssertionError


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
    output: a folder, or a location of fsspec: gets `axis.ply`, `thickness.zarr`, `labels.csv`, `report.json`, `blocks`.
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
    angle, clean: of the stitched axis sheets below this object angle (degrees) and what has less erosion thickness than
        this length are removed, as by `filter` and `clean`: `filtered.ply`.
    skeleton: the curve skeleton of what is left: `skeleton.swc`, and `skeletons`, precomputed for Neuroglancer.

    Raises InvalidOption before any work, or if a block needs more than its share of the memory; FileError where the
    volume cannot be read; Error naming a block that has no result.
    """
    _options(scale, smoothing, seed)
    if not (axis or thickness):
        raise InvalidOption("nothing is wanted: ask for the axis or the thickness")
    if block is not None and (not isinstance(block, int) or block < 32 or block % 32):
        raise InvalidOption(f"block must be a multiple of 32 voxels, not {block!r}")
    at_a_time = processors() if workers is None else workers
    if not isinstance(at_a_time, int) or at_a_time < 1:
        raise InvalidOption(f"workers must be at least 1, not {workers!r}")
    labels = () if label is None else (label,) if isinstance(label, int) else tuple(label)
    known = (
        source
        if isinstance(source, Source)
        else source_of(source, labels=labels, level=level, below=below, dataset=dataset, spacing=spacing)
    )
    storage = storage_of(output, storage_options)
    share = memory_of(memory) // at_a_time
    threads = max(1, processors() // at_a_time) if scheduler is None else 1
    runs = _Runs(storage, scheduler, at_a_time, progress)

    def task(kind: str, low: Any, high: Any, options: Options, told: Any, **more: Any) -> Task:
        key = _key(kind, known, low, high, options, told)
        return Task(kind, [key], storage, known, options, low, high, threads, **more)

    options = Options(float(scale), smoothing, seed, _FIRST_MOVE)
    unused = Options(1.0, 0, 0, 0.0)  # depths are those of voxels
    first = first_edge(share)
    depth_rows = runs.rows([task("depths", low, high, unused, 0) for low, high in blocks_of(known.sizes, first)])
    depths = DepthMap.of(known.sizes, depth_rows)
    edge, blocks = depths.plan(options.scale, share, block)
    largest = float(depths.depths.max())
    if not blocks:
        raise InvalidOption("no voxel is inside: another label or level?")
    step = max(_FINEST, 2 * largest / 65535)
    chunk = math.gcd(edge, 128)
    if thickness:
        _begin_thickness(storage, known, step, chunk)

    def parts(move: float) -> list[Task]:
        moved = options._replace(move=move)
        wanted = (step, chunk) if thickness else None

        def of(at: Block) -> Task:
            told = (at.halo, at.largest_depth, axis, wanted)
            more = {"halo": at.halo, "largest_depth": at.largest_depth, "wants_axis": axis, "thickness": wanted}
            return task("part", at.low, at.high, moved, told, **more)

        return [of(at) for at in blocks]

    rows, every = _axis_rows(runs, parts)
    if any(row["labels"] for row in depth_rows):
        storage.write("labels.csv", _table(depth_rows, known.spacing).encode())
    complex: MedialComplex | None = None
    found: Topology | None = None
    euler = solid = None
    mismatches: dict[Triple, int] = {}
    if axis:
        contents = (storage.read(part_name(at.keys[0])) for at, row in zip(every, rows) if row["vertices"])
        complex = stitched((part_of(content or b"") for content in contents), known, options.scale)
        euler = sum(row["euler"] for row in rows)
        solid = sum(row["solid_euler"] for row in rows)
        count = len(complex.vertices) - len(complex.edges) + len(complex.faces)
        if count != euler:
            raise Error(
                f"the parts do not fit: together their Euler characteristic is {euler}, stitched {count}",
                "volume.stitch",
            )
        stitched_complex = complex
        _saved(storage, "axis.ply", lambda file: write_axis(file, stitched_complex, polygons=True))
        if euler != solid:
            mismatches = _mismatches(runs, every)
        found = _global_steps(storage, complex, angle, clean, skeleton)
    report = Report(
        block=edge,
        blocks=len(blocks),
        computed=runs.computed,
        samples=int(depths.crossings.sum()),
        vertices=0 if complex is None else len(complex.vertices),
        faces=0 if complex is None else len(complex.faces),
        euler=euler,
        solid_euler=solid,
        topology=found,
        largest_depth=largest,
        peak_memory=max(row["peak_memory"] for row in [*depth_rows, *rows]),
        stitching_memory=_core.peak_memory(),
        cpu_seconds=sum(row["seconds"] for row in [*depth_rows, *rows]),
        mismatches=mismatches,
        axis=complex,
    )
    told_report = {name: value for name, value in vars(report).items() if name not in ("axis", "computed")}
    told_report |= {"agrees": report.agrees, "mismatches": [[*low, much] for low, much in mismatches.items()]}
    storage.write("report.json", json.dumps(told_report, indent=1, default=str).encode())
    return report


__all__ = ["Report", "memory_of", "volume"]
