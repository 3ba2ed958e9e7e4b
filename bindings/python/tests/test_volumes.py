# SPDX-License-Identifier: Apache-2.0
"""Volumes in blocks: the same, to the last bit, as in one piece."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import scaleaxis
import scipy.ndimage
from scaleaxis import FileError, InvalidOption, _core
from scaleaxis.batch.command import main
from scaleaxis.volumes import Report, blocks, call, sources, volume, worker
from scaleaxis.volumes.causes import CAUSES
from scaleaxis.volumes.stitching import part_of
from scaleaxis.volumes.worker import DEBUG

Mask = npt.NDArray[Any]
SHAPE = (40, 40, 96)  # z, y, x: blocks of 32 have a rim within the volume along x
ONE = 96
CORNERS = list(np.ndindex(2, 2, 2))


def noise(seed: int, sigma: float) -> npt.NDArray[np.float64]:
    grey = scipy.ndimage.gaussian_filter(np.random.default_rng(seed).standard_normal(SHAPE), sigma, mode="wrap")
    return grey / grey.std()


def trabecular() -> Mask:
    return (np.abs(noise(3, 4.0)) < 0.15).astype(np.uint8)


def labels() -> Mask:
    seeds = np.random.default_rng(5).uniform(0, 1, (30, 3)) * SHAPE
    places = np.stack(np.indices(SHAPE), -1).reshape(-1, 3)
    cells = np.argmin(((places[:, None] - seeds) ** 2).sum(-1), axis=1).reshape(SHAPE)
    walls = scipy.ndimage.maximum_filter(cells, 3) != scipy.ndimage.minimum_filter(cells, 3)
    return np.where(walls, 1 + cells % 3, 0).astype(np.uint16)


def tubes() -> Mask:
    z, y, x = np.indices(SHAPE) - np.array([20.3, 20.1, 24.2]).reshape(3, 1, 1, 1)
    rings = [np.hypot(np.hypot(x - shift, y) - 13, z) < 2.6 for shift in (0, 24, 48)]
    return np.logical_or.reduce(rings).astype(np.uint8)


KINDS = {"trabecular": trabecular, "labels": labels, "tubes": tubes}


def saved(folder: Path, array: Mask) -> Path:
    np.save(folder / "volume.npy", array)
    return folder / "volume.npy"


def run(source: Path, output: Path, **options: Any) -> Report:
    return volume(source, output, **{"memory": "8GB", "workers": 2, "progress": False, **options})


def files(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


def thickness_of(folder: Path) -> npt.NDArray[np.uint16]:
    zarr = pytest.importorskip("zarr")
    return np.asarray(zarr.open(str(folder / "thickness.zarr"), mode="r")["0"])


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Names of the blocks that were computed."""
    monkeypatch.setenv(DEBUG, json.dumps({"log": str(tmp_path / "log")}))
    yield tmp_path / "log"


@pytest.mark.parametrize("kind", KINDS)
def test_blocks_give_what_the_whole_gives(kind: str, tmp_path: Path) -> None:
    source = saved(tmp_path, KINDS[kind]())
    options = {"label": 2, "thickness": True} if kind == "labels" else {"thickness": True}
    whole = run(source, tmp_path / "whole", block=ONE, **options)
    parts = run(source, tmp_path / "parts", block=32, **options)
    assert whole.blocks == 1 and parts.blocks > 3
    assert whole.axis is not None and parts.axis is not None and whole.faces > 1000
    for name in ("vertices", "radii", "edges", "face_angles", "face_sheets"):
        assert np.array_equal(getattr(whole.axis, name), getattr(parts.axis, name)), name
    assert np.array_equal(whole.axis.faces.indices, parts.axis.faces.indices)
    assert (tmp_path / "whole/axis.ply").read_bytes() == (tmp_path / "parts/axis.ply").read_bytes()
    assert np.array_equal(thickness_of(tmp_path / "whole"), thickness_of(tmp_path / "parts"))
    assert whole.topology == parts.topology and whole.topology is not None
    assert (whole.euler, whole.solid_euler) == (parts.euler, parts.solid_euler)
    assert whole.topology.euler == whole.euler


def test_the_halo_matters(tmp_path: Path) -> None:
    """A block without a halo is not what the whole gives: the comparison above can fail."""
    source = saved(tmp_path, tubes())
    run(source, tmp_path / "out", block=32)
    halos = [json.loads(row.read_bytes())["halo"] for row in (tmp_path / "out/blocks").glob("part*.json")]
    parts = [part_of(part.read_bytes()) for part in (tmp_path / "out/blocks").glob("*.npz")]
    assert max(halos) + 32 < SHAPE[2]  # some block does not see all
    owned = [{vertex.tobytes() for vertex in part["vertices"]} for part in parts]
    assert any(a & b for i, a in enumerate(owned) for b in owned[:i])  # seams share vertices


def test_topology_is_that_of_the_solid(tmp_path: Path) -> None:
    mask = tubes()
    report = run(saved(tmp_path, mask), tmp_path / "out", block=32)
    assert report.agrees and report.topology is not None
    image = scaleaxis.Image(mask.astype(np.float32))
    assert report.topology == scaleaxis.axis(image, delta=0.02, mask_smoothing=0).topology


def test_a_mismatch_names_the_block(tmp_path: Path) -> None:
    """Two plates one voxel apart, which growing joins in places, in one of the blocks."""
    mask = np.zeros(SHAPE, np.uint8)
    mask[10:16, 8:30, 40:60] = 1
    mask[17:23, 8:30, 40:60] = 1
    mask[5:30, 5:30, 4:20] = 1
    report = run(saved(tmp_path, mask), tmp_path / "out", block=32, scale=1.5)
    assert report.agrees is False and set(report.mismatches) == {(32, 0, 0)}
    told = json.loads((tmp_path / "out/report.json").read_text())
    assert told["mismatches"] == [[32, 0, 0, report.mismatches[32, 0, 0]]]


def plates(gap: int, thickness: int) -> Mask:
    mask = np.zeros(SHAPE, np.uint8)
    mask[8 : 8 + thickness, 8:30, 40:60] = mask[8 + thickness + gap : 8 + 2 * thickness + gap, 8:30, 40:60] = 1
    return mask


def gap_closed_by_growing() -> tuple[Mask, dict[str, Any], Any]:
    """Two plates two voxels apart, whose gap grows together."""
    return plates(2, 8), {"scale": 1.5}, ((40, 8, 16), (60, 30, 18))


def touching_in_an_edge() -> tuple[Mask, dict[str, Any], Any]:
    """Two cubes that share an edge alone: apart for the solid, joined by the axis. Two others share nothing."""
    mask = np.zeros(SHAPE, np.uint8)
    mask[8:16, 8:16, 40:48] = mask[8:16, 16:24, 48:56] = 1
    mask[8:16, 8:16, 4:12] = mask[8:16, 24:32, 20:28] = 1
    return mask, {"smoothing": 0, "scale": 1.3}, ((46, 14, 7), (50, 18, 17))


def hole_of_a_voxel() -> tuple[Mask, dict[str, Any], Any]:
    """A plate with a hole that is a voxel wide, and one of five voxels."""
    mask = np.zeros(SHAPE, np.uint8)
    mask[8:16, 8:30, 20:70] = 1
    mask[8:16, 14:19, 28:33] = mask[8:16, 16, 50] = 0
    return mask, {"smoothing": 0}, ((49, 15, 8), (52, 18, 16))


@pytest.mark.parametrize(
    ("kind", "made"),
    [("growing", gap_closed_by_growing), ("contact", touching_in_an_edge), ("thin", hole_of_a_voxel)],
)
def test_a_mismatch_has_a_cause_and_a_place(
    kind: str, made: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mask, options, (low, high) = made()
    report = run(saved(tmp_path, mask), tmp_path / "out", block=96, **options)
    assert report.agrees is False and set(report.causes) == {(0, 0, 0)}
    cause, place = report.causes[0, 0, 0]
    assert cause == kind
    assert all(a <= at < b for a, at, b in zip(low, place, high)), place
    told = json.loads((tmp_path / "out/report.json").read_text())
    assert told["causes"] == [[0, 0, 0, cause, *place]]
    words = [f"--{name}={value}" for name, value in options.items()]
    assert main(["volume", str(tmp_path / "volume.npy"), "-o", str(tmp_path / "out"), "--block=96", *words]) == 0
    assert f": {CAUSES[kind]}, at voxel {', '.join(map(str, place))}" in capsys.readouterr().out


def test_a_block_that_cannot_be_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As at s = 1: a comparison moves balls more by itself, and is left out if that does not help."""
    mask, options, _ = hole_of_a_voxel()
    axis_of_block = _core.axis_of_block
    asked: list[float] = []

    def contradicts(least: float) -> Any:
        def of(field: Any, place: Any, scale: float, depth: float, seed: int, move: float, threads: int) -> Any:
            asked.append(move)
            if len(asked) > 1 and move < least:  # the first is the part itself
                raise scaleaxis.InconsistentResult("it contradicts itself", "result")
            return axis_of_block(field, place, scale, depth, seed, move, threads)

        return of

    monkeypatch.setattr(call, "in_threads", lambda tasks, *_: ([worker._row(task)] for task in tasks))
    source = saved(tmp_path, mask)
    for least, is_named in ((3e-4, True), (1.0, False)):
        asked.clear()
        monkeypatch.setattr(_core, "axis_of_block", contradicts(least))
        report = run(source, tmp_path / str(least), block=96, **options)
        assert report.agrees is False and bool(report.mismatches) == is_named
        assert asked[:4] == [1e-4, 1e-4, 2e-4, 4e-4]


def test_balls_of_all_blocks_are_moved_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If one of them contradicts itself: at once, whatever is left of the first round."""
    axis_of_block = _core.axis_of_block
    asked: list[float] = []

    def contradicts(field: Any, place: Any, scale: float, depth: float, seed: int, move: float, threads: int) -> Any:
        asked.append(move)
        if move < 2e-4 and len(asked) == 2:
            raise scaleaxis.InconsistentResult("it contradicts itself", "result")
        return axis_of_block(field, place, scale, depth, seed, move, threads)

    monkeypatch.setattr(call, "in_threads", lambda tasks, *_: ([worker._row(task)] for task in tasks))
    monkeypatch.setattr(_core, "axis_of_block", contradicts)
    report = run(saved(tmp_path, tubes()), tmp_path / "out", block=32)
    assert report.blocks > 3 and report.agrees
    assert asked == [1e-4] * 2 + [2e-4] * report.blocks


def well_composed(mask: Mask) -> Mask:
    """With voxels more, until none touch in an edge or a corner alone, nor gaps between them."""
    whole = np.pad(mask != 0, 1)
    while True:
        corners = np.stack([whole[z : z - 1 or None, y : y - 1 or None, x : x - 1 or None] for z, y, x in CORNERS])
        corners = corners.reshape(2, 2, 2, *corners.shape[1:])
        crosses = (corners == corners[::-1, ::-1, ::-1]).all((0, 1, 2)) & np.isin(corners.sum((0, 1, 2)), (2, 6))
        for axis in range(3):
            for end in range(2):
                (a, b), (c, d) = np.moveaxis(corners, axis, 0)[end]
                crosses |= (a == d) & (b == c) & (a != b)
        if not crosses.any():
            return whole[1:-1, 1:-1, 1:-1]
        for z, y, x in CORNERS:
            whole[z : z - 1 or None, y : y - 1 or None, x : x - 1 or None] |= crosses


def euler_of_voxels(mask: Mask) -> int:
    """Of voxels that are connected through their sides."""
    whole, total = mask != 0, 0
    for axes in ([], [0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]):
        cells = whole
        for axis in axes:
            size = cells.shape[axis]
            cells = np.take(cells, range(1, size), axis) & np.take(cells, range(size - 1), axis)
        total += (-1) ** len(axes) * int(cells.sum())
    return total


@pytest.mark.parametrize("seed", range(4))
def test_topology_of_random_fields(seed: int, tmp_path: Path) -> None:
    """The solid has the topology of the voxels, where that is the same for all kinds of neighbourhood. The axis has
    that of the solid, or the report says where it has not.
    """
    smooth = scipy.ndimage.gaussian_filter(np.random.default_rng(seed).standard_normal(SHAPE), 3.5)
    mask = well_composed(np.pad((smooth > 0.8 * smooth.std())[2:-2, 2:-2, 2:-2], 2))
    for smoothing in (0, 1):
        report = run(saved(tmp_path, mask), tmp_path / f"out{smoothing}", block=32, smoothing=smoothing)
        assert report.solid_euler == euler_of_voxels(mask), seed
        assert report.agrees or report.mismatches, (seed, report)
    assert report.agrees, (seed, report)


@pytest.mark.parametrize("seed", range(2))
def test_topology_of_noise(seed: int, tmp_path: Path) -> None:
    """Features as small as voxels, which no scale is right for: their block is named, and no other."""
    mask = np.zeros(SHAPE, np.uint8)
    mask[4:24, 4:24, 4:24] = np.random.default_rng(seed).uniform(size=(20,) * 3) < 0.3
    report = run(saved(tmp_path, mask), tmp_path / "out", block=32, smoothing=0)
    assert report.agrees is False and set(report.mismatches) == {(0, 0, 0)}, seed
    assert report.euler is not None and report.solid_euler is not None
    assert report.mismatches[0, 0, 0] == report.euler - report.solid_euler, seed


def test_stitching_keeps_to_the_memory(tmp_path: Path, log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = saved(tmp_path, tubes())
    monkeypatch.setattr(call, "_STITCHED", 100_000)  # bytes a face: as if there were many
    with pytest.raises(
        InvalidOption, match=r"the blocks that are done have \d+ faces, which take .* GB when they are stitched"
    ):
        run(source, tmp_path / "out", memory="2GB", block=32, workers=1)
    done = {json.loads(row.read_bytes())["key"] for row in (tmp_path / "out/blocks").glob("*.json")}
    log.write_text("")
    parts = run(source, tmp_path / "out", memory="2GB", block=32, workers=1, stitch=False)
    assert parts.axis is None and not (tmp_path / "out/axis.ply").exists()
    assert not done & set(log.read_text().split())
    monkeypatch.undo()
    report = run(source, tmp_path / "out", block=32)
    assert report.computed == 0 and report.axis is not None
    assert (parts.faces, parts.euler, parts.solid_euler) == (report.faces, report.euler, report.solid_euler)
    assert report.faces == len(report.axis.faces)
    with pytest.raises(InvalidOption, match="of the stitched axis"):
        run(source, tmp_path / "out", stitch=False, skeleton=True)


def test_boxes_hold_what_is_there_and_little_else() -> None:
    """Each cell of something is in one box; voids between them are in none."""
    for seed in range(20):
        cells = np.random.default_rng(seed).uniform(size=(5, 9, 7)) < 0.02 * (seed % 5)
        times = np.zeros(cells.shape, int)
        for box in blocks.boxes_of(cells):
            times[box] += 1
        assert (times[cells] == 1).all() and times.max() <= 1, seed
    corners = np.zeros((8, 8, 8), bool)
    corners[0, 0, 0] = corners[7, 7, 7] = corners[7, 7, 6] = True
    assert sum(corners[box].size for box in blocks.boxes_of(corners)) == 3
    assert blocks.boxes_of(np.ones((2, 3, 4), bool)) == [(slice(0, 2), slice(0, 3), slice(0, 4))]


@pytest.mark.parametrize("place", [(0, 0, 0), (60, 70, 64), (100, 160, 97)])
@pytest.mark.parametrize("kind", ["mask", "label", "level"])
def test_voids_are_not_read(place: Any, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball in a large volume: but for one look at all of it, only what is around the ball. Thickness is that of a volume
    that ends beside it.
    """
    z, y, x = np.indices((40, 40, 40)) - 20
    ball = ((x * x + y * y + z * z < 100) * 5).astype(np.uint8)
    whole = np.zeros((200, 200, 200), np.uint8)
    at = tuple(slice(a, a + 40) for a in place)
    whole[at] = ball
    if kind == "label":
        whole[150:155, 10:190, 10:20] = 3
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    options: dict[str, Any] = {"mask": {}, "label": {"label": 5}, "level": {"level": 2.5}}[kind]
    read = []

    def counted(source: Any, low: Any, high: Any) -> Any:
        read.append(int(np.prod(np.subtract(high, low))))
        return sources._read(source.path, source.kind, source.dataset, low, high)

    monkeypatch.setattr(sources.Source, "read", counted)
    monkeypatch.setattr(call, "in_threads", lambda tasks, *_: ([worker._row(task)] for task in tasks))
    options |= {"thickness": True, "block": 96}
    report = run(saved(tmp_path / "a", whole), tmp_path / "a/out", **options)
    assert sum(read) < 2 * whole.size  # with all voxels around each block: more than ten times
    alone = np.pad(ball, 30)
    small = run(saved(tmp_path / "b", alone), tmp_path / "b/out", **options)
    assert (report.samples, report.largest_depth) == (small.samples, small.largest_depth)
    assert (report.euler, report.solid_euler) == (1, 1)
    moved = thickness_of(tmp_path / "a/out")
    assert np.array_equal(moved[at], thickness_of(tmp_path / "b/out")[30:-30, 30:-30, 30:-30])
    assert np.count_nonzero(moved) == np.count_nonzero(ball)


def test_processes_of_blocks_are_forks_of_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started = []
    start = worker.servers.start
    monkeypatch.setattr(worker.servers, "start", lambda: started.append(start()) or started[-1])
    report = run(saved(tmp_path, tubes()), tmp_path / "out", block=32, workers=1)
    # One for depths, one for parts.
    assert report.computed > 4 and [server.returncode for server in started] == [0, 0]
    assert not worker.servers.idle and not worker.servers.busy


def test_thickness_is_that_of_the_definition(tmp_path: Path) -> None:
    mask = np.pad(trabecular()[8:28, 8:28, 8:40], 1)
    run(saved(tmp_path, mask), tmp_path / "out", thickness=True, axis=False)
    depths = scipy.ndimage.distance_transform_edt(mask)
    expected = np.zeros(mask.shape)
    places = np.argwhere(depths > 0)
    for center in places:
        depth = depths[tuple(center)]
        near = places[((places - center) ** 2).sum(1) < depth * depth - 1e-9]
        at = tuple(near.T)
        expected[at] = np.maximum(expected[at], 2 * depth)
    assert np.abs(thickness_of(tmp_path / "out") * 0.01 - expected).max() < 0.0051


def test_the_same_call_computes_nothing_twice(tmp_path: Path, log: Path) -> None:
    source = saved(tmp_path, tubes())
    first = run(source, tmp_path / "out", block=32)
    before = files(tmp_path / "out")
    assert len(log.read_text().split()) == first.computed
    again = run(source, tmp_path / "out", block=32)
    assert again.computed == 0 and len(log.read_text().split()) == first.computed
    assert files(tmp_path / "out") == before
    other = run(source, tmp_path / "out", block=32, seed=2)
    assert 0 < other.computed < first.computed  # depths are the same


def test_on_a_cluster(tmp_path: Path) -> None:
    import distributed

    source = saved(tmp_path, tubes())
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    ) as cluster:
        run(source, tmp_path / "cluster", block=32, scheduler=cluster)
    run(source, tmp_path / "whole", block=ONE)
    assert (tmp_path / "cluster/axis.ply").read_bytes() == (tmp_path / "whole/axis.ply").read_bytes()


def test_a_killed_block_is_tried_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = saved(tmp_path, tubes())
    run(source, tmp_path / "whole", block=32)
    (tmp_path / "once").touch()
    monkeypatch.setenv(DEBUG, json.dumps({"kill": str(tmp_path / "once")}))
    run(source, tmp_path / "killed", block=32)
    assert not (tmp_path / "once").exists()
    assert (tmp_path / "killed/axis.ply").read_bytes() == (tmp_path / "whole/axis.ply").read_bytes()


def test_a_killed_call_goes_on(tmp_path: Path, log: Path) -> None:
    source = saved(tmp_path, tubes())
    output = tmp_path / "out"
    code = "import sys; from scaleaxis.batch.command import main; main(sys.argv[1:])"
    words = ["volume", str(source), "-o", str(output), "--memory", "8GB", "--workers", "1", "--block", "32", "-q"]
    process = subprocess.Popen([sys.executable, "-c", code, *words])
    deadline = time.monotonic() + 120
    while not list(output.glob("blocks/part*.json")) and time.monotonic() < deadline:
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    time.sleep(0.5)  # the block at work ends with its input
    finished = {json.loads(row.read_bytes())["key"] for row in output.glob("blocks/*.json")}
    log.write_text("")
    report = run(source, output, block=32)
    assert not finished & set(log.read_text().split())
    assert report.computed == len(log.read_text().split()) > 0
    run(source, tmp_path / "whole", block=32)
    assert (output / "axis.ply").read_bytes() == (tmp_path / "whole/axis.ply").read_bytes()
    assert not list(output.rglob("*.part"))


def test_memory_is_refused_before(tmp_path: Path) -> None:
    source = saved(tmp_path, trabecular())
    with pytest.raises(InvalidOption, match=r"the block at voxel .* takes about .* GB"):
        run(source, tmp_path / "out", memory="300MB", block=96)
    assert not list((tmp_path / "out").glob("blocks/part*"))
    report = run(source, tmp_path / "out", memory="2GB", workers=1, thickness=True, axis=False)
    assert report.peak_memory < 2e9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"block": 40}, "multiple of 32"),
        ({"scale": 0.5}, "scale must"),
        ({"smoothing": 9}, "smoothing must"),
        ({"memory": "much"}, "memory must"),
        ({"label": 77}, "no voxel is inside"),
        ({"label": [77, 78]}, "no voxel is inside"),
        ({"label": [1, 77]}, "no voxel has the label 77"),
        ({"label": []}, "label is an empty list"),
        ({"label": 1, "level": 0.5}, "exclude each other"),
        ({"axis": False}, "nothing is wanted"),
    ],
)
def test_wrong_options(options: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidOption, match=message):
        run(saved(tmp_path, tubes()), tmp_path / "out", **options)


def _nrrd(folder: Path, mask: Mask) -> Path:
    sizes = " ".join(str(size) for size in mask.shape[::-1])
    head = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {sizes}\nspacings: 2 2 2\nencoding: raw\n\n"
    (folder / "v.nrrd").write_bytes(head.encode() + mask.tobytes())
    return folder / "v.nrrd"


def _nifti(folder: Path, mask: Mask) -> Path:
    import nibabel

    nibabel.save(nibabel.Nifti1Image(mask.T, np.diag([2.0, 2.0, 2.0, 1.0])), folder / "v.nii")
    return folder / "v.nii"


def _zarr(folder: Path, mask: Mask) -> Path:
    import zarr

    group = zarr.open_group(str(folder / "v.zarr"), mode="w")
    steps = [{"type": "scale", "scale": [1.0, 2.0, 2.0, 2.0]}]
    axes = [{"name": name, "type": "space"} for name in "czyx"]
    datasets = [{"path": "s0", "coordinateTransformations": steps}]
    group.attrs["ome"] = {"version": "0.5", "multiscales": [{"axes": axes, "datasets": datasets}]}
    array = group.create_array("s0", shape=(1, *mask.shape), chunks=(1, 16, 16, 16), dtype="u1")
    array[0] = mask
    return folder / "v.zarr"


@pytest.mark.parametrize("write", [_nrrd, _nifti, _zarr])
def test_formats(write: Any, tmp_path: Path) -> None:
    mask = tubes()
    expected = run(saved(tmp_path, mask), tmp_path / "npy", spacing=2.0)
    found = run(write(tmp_path, mask), tmp_path / "other", thickness=True)
    assert expected.axis is not None and found.axis is not None
    assert np.array_equal(expected.axis.vertices, found.axis.vertices)
    assert thickness_of(tmp_path / "other").shape == mask.shape


def test_levels_and_labels(tmp_path: Path) -> None:
    grey = noise(4, 4.0).astype(np.float32)
    report = run(saved(tmp_path, grey), tmp_path / "grey", level=1.2, block=32)
    whole = run(saved(tmp_path, grey), tmp_path / "whole", level=1.2, block=ONE)
    assert report.axis is not None and whole.axis is not None
    assert np.array_equal(report.axis.vertices, whole.axis.vertices)
    assert not (tmp_path / "grey/labels.csv").exists()
    run(saved(tmp_path, labels()), tmp_path / "labels", axis=False, thickness=True)
    rows = (tmp_path / "labels/labels.csv").read_text().splitlines()
    assert [int(row.split(",")[1]) for row in rows[1:]] == [int((labels() == label).sum()) for label in (1, 2, 3)]


@pytest.mark.parametrize("dtype", [np.uint8, np.int64, np.float32])
def test_labels_that_are_in_some_blocks_only(dtype: Any, tmp_path: Path) -> None:
    """A label may be given twice, and all of them have to be somewhere."""
    array = np.zeros((8, 8, 96), dtype)
    array[2:6, 2:6, 2:6], array[2:6, 2:6, 80:84] = 1, 2
    source = saved(tmp_path, array)
    known = run(source, tmp_path / "known", label=[1, 2], block=32)
    assert known.topology is not None and known.topology.components == 2
    again = run(source, tmp_path / "again", label=[1, 2, 1], block=32)
    assert again.axis is not None and known.axis is not None
    assert np.array_equal(again.axis.vertices, known.axis.vertices)
    for label in (0, 3):
        with pytest.raises(InvalidOption, match="no voxel has the label 3"):
            run(source, tmp_path / "other", label=[label, 1, 2, 3], block=32)


def test_unreadable(tmp_path: Path) -> None:
    (tmp_path / "bad.nrrd").write_bytes(b"NRRD0004\ntype: uint8\nencoding: gzip\ndimension: 3\n\n")
    with pytest.raises(FileError, match="raw data"):
        run(tmp_path / "bad.nrrd", tmp_path / "out")
    with pytest.raises(InvalidOption, match="a volume is a"):
        run(tmp_path / "bad.txt", tmp_path / "out")


@pytest.mark.filterwarnings("ignore:trees have no loops")  # of which the SWC file is made
def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = str(saved(tmp_path, tubes()))
    words = ["volume", source, "-o", str(tmp_path / "out"), "--memory", "8GB", "--workers", "2"]
    assert main([*words, "--angle", "30", "--clean", "1", "--skeleton"]) == 0
    assert "of the solid" in capsys.readouterr().out
    assert {"axis.ply", "filtered.ply", "skeleton.swc", "report.json"} <= set(os.listdir(tmp_path / "out"))
    assert (tmp_path / "out/skeletons/info").exists()
    assert main([*words, "--label", "9"]) == 2
