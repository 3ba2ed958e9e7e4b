# SPDX-License-Identifier: Apache-2.0
"""Many models in one call: what is there afterwards, whatever goes wrong."""

from __future__ import annotations

import csv
import errno
import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import scaleaxis
from conftest import ball_mesh, box_mesh
from scaleaxis.batch import Counts, batch, runners, server, worker
from scaleaxis.batch import command as command_module
from scaleaxis.batch.models import Model, list_models, runs_of, share_of
from scaleaxis.batch.options import checked
from scaleaxis.batch.progress import line_of
from scaleaxis.batch.storage import Storage

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="models are forked"),
    pytest.mark.filterwarnings("ignore"),  # those of other packages
]

COARSE = {"delta": 0.1}
LONG = 60.0  # seconds in which anything here ends, on a busy machine too


def write_boxes(folder: Path, count: int) -> list[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"box{i:02}.off" for i in range(count)]
    for i, file in enumerate(files):
        scaleaxis.write_mesh(file, box_mesh((2.0, 3.0, 4.0 + i)))
    return files


def rows_of(output: Path) -> list[dict]:
    return [json.loads(line) for file in sorted(output.glob("rows*.jsonl")) for line in file.open()]


def by_name(output: Path) -> dict[str, dict]:
    """The last row of each model."""
    return {Path(row["path"]).name: row for row in rows_of(output)}


@pytest.fixture
def debug(monkeypatch, tmp_path):
    """Names of models that crash and so on; the answer tells how often each was computed."""
    log = tmp_path / "computed.log"
    log.touch()

    def ask(**names: str) -> None:
        monkeypatch.setenv(server.DEBUG, json.dumps({"log": str(log), **names}))

    ask()
    ask.computed = lambda: Counter(log.read_text().split())
    return ask


def in_one_shard(models, output, **options) -> Counts:
    """Without Dask, which takes longer to start than the models here."""
    return batch(models, output, **{"shard": (1, 1), "progress": False, **COARSE, **options})


def test_results_and_rows(tmp_path, debug):
    boxes = write_boxes(tmp_path / "models", 2)
    counts = in_one_shard(tmp_path / "models", tmp_path / "out", scale=1.2)
    assert (counts.total, counts.done, counts.failed) == (2, 2, 0)
    axis = scaleaxis.axis(boxes[0], scale=1.2, **COARSE)
    axis.save(tmp_path / "expected.ply")
    row = by_name(tmp_path / "out")["box00.off"]
    assert (tmp_path / "out" / row["result"]).read_bytes() == (tmp_path / "expected.ply").read_bytes()
    assert row["status"] == "done" and json.loads(row["options"]) == {"delta": 0.1, "scale": 1.2}
    assert (row["vertices"], row["polygons"], row["balls"]) == (len(axis.vertices), len(axis.polygons), len(axis.balls))
    assert tuple(row[name] for name in axis.topology._fields) == axis.topology
    assert row["solid_components"] == 1 and 0 < row["seconds"] < LONG and 1e7 < row["peak_memory"] < 2e9
    assert not list((tmp_path / "out").rglob("*.part"))


def test_parquet_has_the_last_row_of_each_model(tmp_path, debug):
    from pyarrow import parquet

    write_boxes(tmp_path / "models", 3)
    debug(crash="box01")
    in_one_shard(tmp_path / "models", tmp_path / "out")
    debug()
    in_one_shard(tmp_path / "models", tmp_path / "out", retry="failed")
    assert len(rows_of(tmp_path / "out")) == 4
    table = parquet.read_table(tmp_path / "out" / "rows.parquet").to_pylist()
    assert sorted(Path(row["path"]).name for row in table) == ["box00.off", "box01.off", "box02.off"]
    assert all(row["status"] == "done" and row["error"] is None and row["vertices"] > 0 for row in table)


def test_what_is_done_is_skipped(tmp_path, debug):
    boxes = write_boxes(tmp_path / "models", 3)
    in_one_shard(boxes[:2], tmp_path / "out")
    counts = in_one_shard(boxes, tmp_path / "out")
    assert (counts.done, counts.skipped) == (1, 2)
    assert debug.computed() == {"box00.off": 1, "box01.off": 1, "box02.off": 1}
    assert len(rows_of(tmp_path / "out")) == 3


def test_a_result_that_was_removed_is_computed_again(tmp_path, debug):
    write_boxes(tmp_path / "models", 2)
    in_one_shard(tmp_path / "models", tmp_path / "out")
    (tmp_path / "out" / by_name(tmp_path / "out")["box01.off"]["result"]).unlink()
    counts = in_one_shard(tmp_path / "models", tmp_path / "out")
    assert (counts.done, counts.skipped) == (1, 1) and debug.computed()["box01.off"] == 2


def test_content_and_options_make_the_name(tmp_path, debug):
    (box,) = write_boxes(tmp_path / "models", 1)
    in_one_shard(box, tmp_path / "out")
    assert in_one_shard(box, tmp_path / "out", seed=1, scale=1.1, angle=None, dense=False).skipped == 1  # the defaults
    assert in_one_shard(box, tmp_path / "out", time_limit=LONG, threads=2).skipped == 1  # make no other result
    assert in_one_shard(box, tmp_path / "out", scale=1.3).done == 1
    assert in_one_shard(box, tmp_path / "out", format="obj").done == 1
    scaleaxis.write_mesh(box, box_mesh((1.0, 1.0, 1.0)))
    assert in_one_shard(box, tmp_path / "out").done == 1
    assert len({row["key"] for row in rows_of(tmp_path / "out")}) == 4


@pytest.mark.parametrize("workers", [1, 3])
def test_equal_models_are_computed_once(tmp_path, debug, workers):
    boxes = write_boxes(tmp_path / "models", 2)
    copies = [tmp_path / "models" / f"copy{i}.off" for i in range(4)]
    for copy in copies:
        copy.write_bytes(boxes[0].read_bytes())
    debug(slow="box")
    counts = in_one_shard([*boxes, *copies, boxes[0]], tmp_path / "out", workers=workers)
    assert (counts.total, counts.done, counts.skipped) == (6, 2, 4)
    assert sum(debug.computed().values()) == 2
    assert len({row["result"] for row in rows_of(tmp_path / "out")}) == 2 and len(rows_of(tmp_path / "out")) == 6


def test_bad_models_cost_themselves_alone(tmp_path, debug):
    boxes = write_boxes(tmp_path / "models", 6)
    boxes[5].write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")  # open
    missing = tmp_path / "models" / "missing.off"
    debug(crash="box00", hang="box01", eat="box02")
    counts = in_one_shard([*boxes, missing], tmp_path / "out", workers=3, time_limit=5.0, memory_limit=600_000_000)
    assert (counts.done, counts.failed, counts.lost) == (2, 5, 0)
    rows = by_name(tmp_path / "out")
    reasons = {name: row.get("reason") for name, row in rows.items()}
    assert reasons == {
        "box00.off": "crash",
        "box01.off": "time",
        "box02.off": "memory",
        "box03.off": None,
        "box04.off": None,
        "box05.off": "input",
        "missing.off": "input",
    }
    assert "SIGABRT" in rows["box00.off"]["error"] and "5 s" in rows["box01.off"]["error"]
    assert rows["box05.off"]["code"].startswith("mesh.") and 5 <= rows["box01.off"]["seconds"] < LONG
    assert rows["box02.off"]["peak_memory"] < 700_000_000

    before = debug.computed()
    counts = in_one_shard(boxes, tmp_path / "out", time_limit=5.0, memory_limit=600_000_000)
    assert (counts.skipped, counts.failed) == (2, 4) and debug.computed() == before
    debug()
    counts = in_one_shard(boxes, tmp_path / "out", retry="failed")
    assert (counts.done, counts.skipped, counts.failed) == (3, 2, 1)


def test_a_failed_model_is_tried_when_its_file_changes(tmp_path, debug):
    (box,) = write_boxes(tmp_path / "models", 1)
    text = box.read_text()
    box.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert in_one_shard(box, tmp_path / "out").failed == 1
    box.write_text(text)
    assert in_one_shard(box, tmp_path / "out").done == 1


def test_torn_lines_are_passed_over(tmp_path, debug):
    write_boxes(tmp_path / "models", 2)
    debug(crash="box01")
    in_one_shard(tmp_path / "models", tmp_path / "out")
    file = tmp_path / "out" / "rows-1-of-1.jsonl"
    file.write_bytes(file.read_bytes()[:-40])  # in the row of the crash
    debug()
    assert in_one_shard(tmp_path / "models", tmp_path / "out").done == 1
    lines = file.read_text().splitlines()
    assert len(lines) == 3 and json.loads(lines[0]) and json.loads(lines[2])["status"] == "done"
    with pytest.raises(ValueError):
        json.loads(lines[1])


def test_a_row_that_was_lost_is_told_again(tmp_path, debug):
    write_boxes(tmp_path / "models", 2)
    in_one_shard(tmp_path / "models", tmp_path / "out")
    (tmp_path / "out" / "rows-1-of-1.jsonl").unlink()
    assert in_one_shard(tmp_path / "models", tmp_path / "out").skipped == 2
    assert {row["status"] for row in rows_of(tmp_path / "out")} == {"done"} and len(rows_of(tmp_path / "out")) == 2
    assert set(debug.computed().values()) == {1}


def test_scales_share_a_sampling_and_have_rows_of_their_own(tmp_path, debug):
    boxes = write_boxes(tmp_path / "models", 2)
    counts = in_one_shard(boxes, tmp_path / "out", scale=[1.0, 1.1, 1.5])
    assert (counts.total, counts.done) == (6, 6) and debug.computed() == {"box00.off": 1, "box01.off": 1}
    for box in boxes:
        for axis in scaleaxis.axis(box, scale=[1.0, 1.1, 1.5], **COARSE):
            (row,) = [r for r in rows_of(tmp_path / "out") if (r["path"], r["scale"]) == (str(box), axis.scale)]
            axis.save(tmp_path / "expected.ply")
            assert (tmp_path / "out" / row["result"]).read_bytes() == (tmp_path / "expected.ply").read_bytes()
            assert row["polygons"] == len(axis.polygons) and json.loads(row["options"]).get("scale", 1.1) == axis.scale
    # Each scale is known for itself, whatever it was asked for with.
    alone = in_one_shard(boxes, tmp_path / "alone", scale=1.5)
    names = [{row["result"] for row in rows_of(tmp_path / out) if row["scale"] == 1.5} for out in ("out", "alone")]
    assert alone.done == 2 and names[0] == names[1]
    more = in_one_shard(boxes, tmp_path / "out", scale="1.1, 1.2,1.5")
    assert (more.done, more.skipped) == (2, 4) and debug.computed() == {"box00.off": 3, "box01.off": 3}


def test_all_scales_of_a_model_fail_together_and_are_tried_again(tmp_path, debug):
    boxes = write_boxes(tmp_path / "models", 2)
    debug(crash="box01")
    counts = in_one_shard(boxes, tmp_path / "out", scale=[1.0, 1.1])
    assert (counts.done, counts.failed) == (2, 2) and debug.computed()["box01.off"] == 1
    assert {row["scale"] for row in rows_of(tmp_path / "out") if row.get("reason") == "crash"} == {1.0, 1.1}
    debug()
    assert in_one_shard(boxes, tmp_path / "out", scale=[1.0, 1.1, 1.2]).failed == 2
    counts = in_one_shard(boxes, tmp_path / "out", scale=[1.0, 1.1, 1.2], retry="failed")
    assert (counts.done, counts.skipped, counts.failed) == (2, 4, 0)


def test_scales_of_tables_share_a_sampling(tmp_path, debug):
    write_boxes(tmp_path / "models", 2)
    (tmp_path / "table.csv").write_text(
        'path,scale\nmodels/box00.off,1.5\nmodels/box01.off,\nmodels/box00.off,"1.0,1.2"\nmodels/box00.off,1.2\n'
    )
    counts = in_one_shard(tmp_path / "table.csv", tmp_path / "out")
    assert counts.done == 4 and debug.computed() == {"box00.off": 1, "box01.off": 1}


def test_images(tmp_path, debug):
    import SimpleITK as itk

    values = np.zeros((12, 16, 20), dtype=np.uint8)
    values[2:10, 2:14, 2:10], values[2:10, 2:14, 10:18] = 1, 2
    (tmp_path / "models").mkdir()
    names = ["a.nii", "b.nii.gz", "c.nrrd", "d.mha"]
    for name in names:
        itk.WriteImage(itk.GetImageFromArray(values), str(tmp_path / "models" / name))
    (tmp_path / "models" / "e.mha").write_bytes(b"no image")
    counts = in_one_shard(tmp_path / "models", tmp_path / "out", labels=[1, 2])
    assert (counts.done, counts.failed) == (4, 1) and set(debug.computed()) == {*names, "e.mha"}
    rows = by_name(tmp_path / "out")
    assert rows["e.mha"]["reason"] == "input" and "e.mha" in rows["e.mha"]["error"]
    # NIfTI turns the axes: the solid lies otherwise, and its axis may have a vertex more.
    counts_of_vertices = [rows[name]["vertices"] for name in names]
    assert max(counts_of_vertices) <= 1.1 * min(counts_of_vertices)
    one = in_one_shard(tmp_path / "models" / "a.nii", tmp_path / "out", labels=1, mask_smoothing=0)
    assert one.done == 1 and rows_of(tmp_path / "out")[-1]["diagonal"] < rows["a.nii"]["diagonal"]
    assert in_one_shard(tmp_path / "models" / "a.nii", tmp_path / "out", iso=0.5).done == 1
    # What of it is solid must be said.
    assert in_one_shard(tmp_path / "models" / "a.nii", tmp_path / "out").failed == 1
    assert rows_of(tmp_path / "out")[-1]["reason"] == "option"


def test_shards_part_the_list(tmp_path, debug):
    models = [Model(str(i), {"scale": scale}) for i in range(11) for scale in (1.0, 1.5)]
    shares = [share_of(runs_of(models), i, 4) for i in range(4)]
    assert sorted((m for share in shares for run in share for m in run), key=str) == sorted(models, key=str)
    assert {len(share) for share in shares} == {2, 3} and all(len(run) == 2 for share in shares for run in share)
    write_boxes(tmp_path / "models", 5)
    for i in (1, 2):
        in_one_shard(tmp_path / "models", tmp_path / "out", shard=(i, 2))
    assert sorted(debug.computed().items()) == [(f"box{i:02}.off", 1) for i in range(5)]
    assert all((tmp_path / "out" / f"rows-{i}-of-2.jsonl").exists() for i in (1, 2))
    # A call for all finds what the shards have done.
    assert in_one_shard(tmp_path / "models", tmp_path / "out").skipped == 5


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_tables(tmp_path, debug, kind):
    write_boxes(tmp_path / "models", 3)
    rows = [
        {"path": "models/box00.off", "scale": 1.5, "dense": True, "labels": None},
        {"path": "models/box01.off", "scale": None, "dense": False, "labels": None},
        {"path": str(tmp_path / "models/box00.off"), "scale": 1.2, "dense": None, "labels": None},
    ]
    table = tmp_path / f"table.{kind}"
    if kind == "csv":
        with table.open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
    else:
        import pyarrow
        from pyarrow import parquet

        parquet.write_table(pyarrow.Table.from_pylist(rows), table)
    models = list_models(table, {"scale": 1.05, "angle": 20})
    folder = str(tmp_path / "models")
    assert models == [
        (f"{folder}/box00.off", {"angle": 20.0, "dense": True, "scale": 1.5}),
        (f"{folder}/box01.off", {"angle": 20.0, "scale": 1.05}),
        (f"{folder}/box00.off", {"angle": 20.0, "scale": 1.2}),
    ]
    assert in_one_shard(table, tmp_path / "out").done == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("file,scale\na.off,1.1\n", "row 1 has no 'path'"),
        ("path,scael\na.off,1.1\n", "no option scael"),
        ("path,scale\na.off,1.1\nb.off,0.5\n", "row 2: .*between 1 and 10"),
        ("path\na.off,1.1\n", "more cells"),
        ("path\n", "no models"),
    ],
)
def test_wrong_tables(tmp_path, text, message):
    (tmp_path / "table.csv").write_text(text)
    with pytest.raises(scaleaxis.Error, match=message):
        list_models(tmp_path / "table.csv", {})


def test_lists_folders_and_globs(tmp_path):
    boxes = write_boxes(tmp_path / "models", 3)
    (tmp_path / "models" / "notes.md").write_text("no model")
    paths = [str(box) for box in boxes]
    assert [model.path for model in list_models(tmp_path / "models", {})] == paths
    assert [model.path for model in list_models(f"{tmp_path}/models/*[12].off", {})] == paths[1:]
    assert [model.path for model in list_models([boxes[2], f"{tmp_path}/models/*0.off"], {})] == [paths[2], paths[0]]
    assert list_models([(boxes[0], {"scale": 2}), boxes[0]], {"seed": 5}) == [
        (paths[0], {"scale": 2.0, "seed": 5}),
        (paths[0], {"seed": 5}),
    ]
    kinds = tmp_path / "kinds"
    kinds.mkdir()
    for name in ("a.glb", "b.INR.gz", "c.npy", "d.npz", "e.xyz", "table.csv", "axis.ma", "list.txt", "f.parquet"):
        (kinds / name).touch()
    found = [os.path.basename(model.path) for model in list_models(kinds, {})]
    assert found == ["a.glb", "b.INR.gz", "c.npy", "d.npz", "e.xyz"]
    (tmp_path / "empty").mkdir()
    for nothing in (tmp_path / "empty", f"{tmp_path}/*.none", []):
        with pytest.raises(scaleaxis.Error):
            list_models(nothing, {})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"delta": "fine"}, "delta must be a number"),
        ({"delta": 0.7}, "delta must lie between"),
        ({"delta": float("nan")}, "delta must be a number"),
        ({"scale": [1.0, 1.1]}, "scale must be a number"),
        ({"scale": 0.9}, "scale must lie between"),
        ({"union": "round"}, "union must be polar or fitted"),
        ({"smooth": 1.5}, "smooth must be a number of rounds"),
        ({"seed": -1}, "seed must be a whole number"),
        ({"dense": "perhaps"}, "dense must be true or false"),
        ({"delta": 0.02, "delta_abs": 1.0}, "same option"),
        ({"delta_abs": 0}, "delta_abs must be positive"),
        ({"method": "angle", "scale": 1.2}, "only scale is 1"),
        ({"bounds": [0, 1]}, "no option bounds"),
        ({"sampling": "dense"}, "sampling must be adaptive or uniform"),
        ({"tight": False}, 'tight is gone: .*sampling="adaptive"'),
        ({"features": "yes"}, "features is gone"),
    ],
)
def test_wrong_options(options, message):
    with pytest.raises(scaleaxis.InvalidOption, match=message):
        checked(options)


def test_options():
    """Those that are right for some model are no error, and those that say nothing are left out."""
    assert checked({"delta": "0.5", "dense": "1", "labels": "1,3", "below": False, "angle": None, "seed": 1}) == {
        "delta": 0.5,
        "dense": True,
        "labels": [1.0, 3.0],
    }
    assert checked({"sampling": "adaptive"}) == {}
    assert checked({"sharp": True, "center": "yes", "dense": "no"}) == {}
    assert checked({"sharp": "false", "center": False}) == {"center": False, "sharp": False}
    assert checked({"sampling": "uniform", "scale": None}) == {"sampling": "uniform"}
    assert checked({"delta": 1e-5, "lambda_abs": 1e6, "method": "lambda"}) == {
        "delta": 1e-5,
        "lambda_abs": 1e6,
        "method": "lambda",
    }


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"shard": (0, 2)}, "shard"),
        ({"shard": (3, 2)}, "shard"),
        ({"workers": 0}, "workers"),
        ({"scheduler": "tcp://127.0.0.1:1"}, "leave one of them out"),
        ({"time_limit": 0}, "time_limit"),
        ({"memory_limit": 1000}, "memory_limit"),
        ({"retry": "all"}, "retry"),
        ({"format": "stl"}, "format"),
        ({"storage_options": {"a": 1}}, "storage_options"),
    ],
)
def test_wrong_arguments(tmp_path, cat, options, message):
    with pytest.raises(scaleaxis.InvalidOption, match=message):
        in_one_shard(cat, tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_location_of_fsspec(tmp_path, debug):
    import fsspec

    boxes = write_boxes(tmp_path / "models", 2)
    memory = fsspec.filesystem("memory")
    root = f"memory://{tmp_path.name}"
    memory.pipe_file(f"/{tmp_path.name}-models/box.off", boxes[0].read_bytes())
    debug(crash="box01")
    models = [*boxes, f"{root}-models/box.off"]
    counts = in_one_shard(models, root)
    assert (counts.done, counts.skipped, counts.failed) == (1, 1, 1)
    names = [name.rpartition("/")[2] for name in memory.find(f"/{tmp_path.name}")]
    assert sum(name.endswith(".ply") for name in names) == 1 and not any(name.endswith(".part") for name in names)
    debug()
    counts = in_one_shard(models, root, retry="failed")
    assert (counts.done, counts.skipped) == (1, 2)
    assert sum(debug.computed().values()) == 3
    with pytest.raises(scaleaxis.InvalidOption, match="no such location"):
        in_one_shard(boxes, "nothing://out")


def test_full_disk(tmp_path, debug):
    """Results do not fit, rows do: they tell it, and the next call finishes the rest."""
    import fsspec
    from fsspec.implementations.memory import MemoryFileSystem

    class Full(MemoryFileSystem):
        protocol = "full"
        store: dict = {}
        pseudo_dirs = [""]
        room = 1

        def pipe_file(self, path, value, **options):
            if ".ply" in path:
                if Full.room == 0:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                Full.room -= 1
            super().pipe_file(path, value, **options)

    fsspec.register_implementation("full", Full, clobber=True)
    write_boxes(tmp_path / "models", 3)
    counts = in_one_shard(tmp_path / "models", "full://out")
    assert (counts.done, counts.failed, counts.lost) == (1, 0, 2)
    text = "".join(file.getvalue().decode() for name, file in Full.store.items() if name.endswith(".jsonl"))
    errors = [row["error"] for row in map(json.loads, text.splitlines()) if row["status"] == "lost"]
    assert len(errors) == 2 and all("No space left on device" in error for error in errors)
    assert Full.store and not [name for name in Full.store if ".part" in name]
    Full.room = 10
    counts = in_one_shard(tmp_path / "models", "full://out")
    assert (counts.done, counts.skipped) == (2, 1) and debug.computed()["box00.off"] == 1


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_no_room_for_rows(tmp_path, debug, capsys):
    write_boxes(tmp_path / "models", 3)
    (tmp_path / "out").mkdir()
    rows = tmp_path / "out" / "rows-1-of-1.jsonl"
    rows.symlink_to("/dev/full")
    given = [str(tmp_path / "models"), "-o", str(tmp_path / "out"), "--shard", "1/1", "--delta", "0.1"]
    assert command_module.main(given) == command_module.FAILED
    assert "No space left on device" in capsys.readouterr().err
    rows.unlink()
    counts = in_one_shard(tmp_path / "models", tmp_path / "out")
    assert counts.failed == 0 and len(rows_of(tmp_path / "out")) == 3
    assert debug.computed()["box00.off"] == 1  # its result was there without its row


def run_command(*arguments: str, **options) -> subprocess.Popen[bytes]:
    code = "import sys; from scaleaxis.batch.command import main; sys.exit(main())"
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen([sys.executable, "-c", code, *map(str, arguments)], **pipes, **options)


def test_exit_statuses(tmp_path, debug, monkeypatch, capsys):
    write_boxes(tmp_path / "models", 2)

    def status(*options: str) -> int:
        given = [str(tmp_path / "models"), "-o", str(tmp_path / "out"), "--delta", "0.1", *options]
        return command_module.main(given)

    for name in ("features", "tight"):
        assert status(f"--{name}") == 2
        assert (
            f'{name} is gone: samples are as dense as the solid needs by default (sampling="adaptive")'
            in capsys.readouterr().err
        )
    debug(crash="box01")
    assert status("--shard", "1/1") == 1
    assert "2 models: 1 done, 1 failed" in capsys.readouterr().out
    debug()
    assert status("--shard", "1/1") == 1  # it is still missing
    assert status("--shard", "1/1", "--retry", "failed", "--quiet") == 0
    assert capsys.readouterr().err == ""
    for wrong in (["--scale", "0"], ["--shard", "3/2"], ["--shard"], ["--workers", "0"], ["--label"], ["--shard", "x"]):
        try:
            assert status(*wrong) == 2
        except SystemExit as end:  # of argparse
            assert end.code == 2
        error = capsys.readouterr().err.strip().splitlines()
        assert error[-1].startswith("scaleaxis-batch: ")
    monkeypatch.setenv("SLURM_ARRAY_TASK_ID", "11")
    monkeypatch.setenv("SLURM_ARRAY_TASK_COUNT", "2")
    monkeypatch.setenv("SLURM_ARRAY_TASK_MIN", "10")
    assert status("--scale", "1.4", "--shard") == 0
    assert "1 models: 1 done" in capsys.readouterr().out
    assert (tmp_path / "out" / "rows-2-of-2.jsonl").exists()


def state_of(process: int) -> tuple[str, int]:
    """A letter, and the parent."""
    try:
        with open(f"/proc/{process}/stat") as file:
            state, parent = file.read().rpartition(")")[2].split()[:2]
            return state, int(parent)
    except OSError:
        return "", 0


def is_running(process: int) -> bool:
    return state_of(process)[0] not in ("", "Z")


def family_of(parent: int) -> list[int]:
    """Its children, and theirs."""
    parents = {int(name): state_of(int(name))[1] for name in os.listdir("/proc") if name.isdigit()}
    found = [parent]
    for process in found:
        found += [child for child in parents if parents[child] == process]
    return found[1:]


def wait_until(condition, what: str) -> None:
    end = time.monotonic() + LONG
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.02)


@pytest.mark.skipif(not os.path.exists("/proc/self/stat"), reason="processes are told by /proc")
@pytest.mark.parametrize("kind", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
@pytest.mark.parametrize("mode", [["--shard", "1/1"], ["--workers", "1"]], ids=["shard", "dask"])
def test_stopped_in_the_middle(tmp_path, debug, monkeypatch, mode, kind):
    """Nothing runs on, what was done stays, and nothing else."""
    write_boxes(tmp_path / "models", 3)
    (tmp_path / "temporary").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    debug(hang="box01")
    process = run_command(tmp_path / "models", "-o", tmp_path / "out", *mode, "--delta", "0.1")
    wait_until(lambda: "box01.off" in debug.computed(), "the model was never begun")
    wait_until(lambda: len(family_of(process.pid)) == 2, "there is no server with a model")
    family = family_of(process.pid)
    process.send_signal(kind)
    _, error = process.communicate(timeout=LONG)
    assert process.returncode == (-signal.SIGKILL if kind == signal.SIGKILL else command_module.CANCELLED)
    # Dask may say more, at moments that only a busy machine finds.
    says = [line for line in error.decode().splitlines() if line.startswith("scaleaxis-batch: stopped")]
    assert len(says) == (0 if kind == signal.SIGKILL else 1), error.decode()
    wait_until(lambda: not any(map(is_running, family)), "a model runs on")
    assert not list((tmp_path / "temporary").glob("scaleaxis-*"))
    debug()
    counts = in_one_shard(tmp_path / "models", tmp_path / "out")
    assert counts.done + counts.skipped == 3 and counts.skipped >= 1 and debug.computed()["box00.off"] == 1


def test_a_model_given_twice_to_workers_is_computed_once(tmp_path, debug):
    """As Dask does where it does not know that a lost worker had done it."""
    (box,) = write_boxes(tmp_path / "models", 1)
    task = worker.Task([Model(str(box), COARSE)], ["0" * 32], Storage(str(tmp_path / "out")), ".ply", 1, None, None)
    (first,), (second,) = worker.compute(task), worker.compute(task)
    worker.servers.close_idle()
    assert first["status"] == "done" and {**first, "ended": ""} == {**second, "ended": ""}
    assert sum(debug.computed().values()) == 1


def test_files_appear_whole(tmp_path, monkeypatch):
    storage = Storage(str(tmp_path))
    storage.write("a/b", b"old")

    def fail(*_):
        raise OSError(errno.ENOSPC, "no room")

    for name in ("write_bytes", "replace"):
        with monkeypatch.context() as patch:
            patch.setattr(Path if name == "write_bytes" else os, name, fail)
            with pytest.raises(OSError, match="no room"):
                storage.write("a/b", b"new")
        assert storage.read("a/b") == b"old" and [file.name for file in (tmp_path / "a").iterdir()] == ["b"]


def test_progress(tmp_path, debug, capsys):
    write_boxes(tmp_path / "models", 3)
    debug(crash="box02")
    told = []
    in_one_shard(tmp_path / "models", tmp_path / "out", progress=lambda counts: told.append(counts.finished))
    assert told == [1, 2, 3]
    in_one_shard(tmp_path / "models", tmp_path / "out", progress=True)
    assert "3 of 3: 0 done, 2 skipped, 1 failed" in capsys.readouterr().err
    in_one_shard(tmp_path / "models", tmp_path / "out", progress=None)
    assert capsys.readouterr().err == ""  # it is no terminal
    counts = Counts(100, done=20, skipped=10, tried=20, start=time.monotonic() - 40)
    assert line_of(counts) == "30 of 100: 20 done, 10 skipped, 2:20 left"


def test_tasks_are_taken_as_they_are_needed():
    """Not all at once: there may be a million."""
    taken, most = 0, 0

    def tasks():
        nonlocal taken
        for i in range(200):
            taken += 1
            yield worker.Task([Model(str(i), {})], [f"{i:032x}"], Storage("out"), ".ply", 1, None, None)

    def work(task):
        return [{"key": task.keys[0]}]

    with runners.dask_client(None, 2) as client:
        for runner in (lambda: runners.on_dask(tasks(), client, work), lambda: runners.in_threads(tasks(), 2, work)):
            taken, most, got = 0, 0, 0
            for _ in runner():
                most, got = max(most, taken - got), got + 1
            assert got == 200 and most <= 16 + 8


@pytest.fixture(scope="module")
def cluster():
    """Of workers that are processes, as on other machines."""
    import distributed

    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as known:
        yield known


def test_dask_on_this_machine(tmp_path, debug):
    write_boxes(tmp_path / "models", 4)
    debug(crash="box01")
    counts = batch(tmp_path / "models", tmp_path / "out", workers=2, progress=False, **COARSE)
    assert (counts.done, counts.failed) == (3, 1)
    assert {row["status"] for row in rows_of(tmp_path / "out")} == {"done", "failed"}
    assert (tmp_path / "out" / "rows.jsonl").exists()


@pytest.mark.parametrize("kind", ["cluster", "address", "client"])
def test_dask_elsewhere(tmp_path, cluster, kind):
    from distributed import Client

    write_boxes(tmp_path / "models", 3)
    with Client(cluster) as client:
        scheduler = {"cluster": cluster, "address": cluster.scheduler_address, "client": client}[kind]
        counts = batch(tmp_path / "models", tmp_path / "out", scheduler=scheduler, progress=False, **COARSE)
        assert counts.done == 3 and client.status == "running"


def test_slots_are_a_hint():
    class Failing:
        def nthreads(self):
            raise AssertionError

    assert runners._window(Failing()) == 16


def test_a_cluster_cancels(tmp_path, cluster):
    from distributed import Client, Future

    write_boxes(tmp_path / "models", 12)
    with Client(cluster) as client:

        def cancel(_: Counts) -> None:
            client.cancel([Future(key, client) for key in list(client.futures)], force=True)

        with pytest.raises(scaleaxis.Error, match="has cancelled"):
            batch(tmp_path / "models", tmp_path / "out", scheduler=client, progress=cancel, **COARSE)


def test_no_scheduler(tmp_path, cat):
    import dask

    soon = dask.config.set({"distributed.comm.timeouts.connect": "1s"})
    with soon, pytest.raises(scaleaxis.Error, match="no scheduler at tcp"):
        batch(cat, tmp_path / "out", scheduler="tcp://127.0.0.1:1", progress=False)


@pytest.mark.parametrize("seed", [1])
def test_a_worker_is_killed(tmp_path, monkeypatch, seed):
    """At a random moment: all models are there, and nothing that was done is done again."""
    import distributed

    write_boxes(tmp_path / "models", 12)
    log = tmp_path / "computed.log"
    monkeypatch.setenv(server.DEBUG, json.dumps({"log": str(log), "slow": "box"}))
    random.seed(seed)
    moment, delay = random.randrange(1, 8), random.uniform(0, 0.2)
    victims = []
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = client.run(os.getpid)

        def kill(counts: Counts) -> None:
            if counts.finished == moment:
                victim = random.choice(sorted(workers.values()))
                victims.append(victim)
                threading.Timer(delay, os.kill, (victim, signal.SIGKILL)).start()

        counts = batch(tmp_path / "models", tmp_path / "out", scheduler=client, progress=kill, **COARSE)
    assert len(victims) == 1 and not is_running(victims[0])
    assert (counts.done, counts.failed, counts.lost) == (12, 0, 0)
    computed = Counter(log.read_text().split())
    # The one that was in work began twice.
    assert len(computed) == 12 and sum(computed.values()) <= 13
    assert in_one_shard(tmp_path / "models", tmp_path / "out").skipped == 12
    assert Counter(log.read_text().split()) == computed
    assert len(rows_of(tmp_path / "out")) == 12


@pytest.mark.skipif(not os.path.exists("/proc/self/stat"), reason="processes are told by /proc")
def test_a_server_is_killed(tmp_path, debug):
    """The process that starts models: one row says that it is lost, the others are done by another."""
    write_boxes(tmp_path / "models", 4)
    debug(slow="box")
    before = set(family_of(os.getpid()))

    def kill(counts: Counts) -> None:
        if counts.finished == 1:
            for process in set(family_of(os.getpid())) - before:
                if is_running(process):
                    os.kill(process, signal.SIGKILL)

    counts = in_one_shard(tmp_path / "models", tmp_path / "out", progress=kill)
    assert counts.lost + counts.failed >= 1 and counts.done + counts.lost + counts.failed == 4
    computed = debug.computed()
    done = {name for name, row in by_name(tmp_path / "out").items() if row["status"] == "done"}
    assert in_one_shard(tmp_path / "models", tmp_path / "out", retry="failed").failed == 0
    assert all(debug.computed()[name] == computed[name] for name in done)
    assert {row["status"] for row in by_name(tmp_path / "out").values()} == {"done"}


def test_the_scheduler_is_killed(tmp_path, debug):
    import dask

    write_boxes(tmp_path / "models", 30)
    debug(slow="box")
    file = tmp_path / "scheduler.json"
    command = [sys.executable, "-m", "dask"]
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    scheduler = subprocess.Popen(
        [*command, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)],
        **silent,
    )
    worker = subprocess.Popen(
        [*command, "worker", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--scheduler-file", str(file)], **silent
    )
    try:
        wait_until(lambda: file.exists() and file.read_text().endswith("}"), "the scheduler never began")

        def kill(counts: Counts) -> None:
            if counts.finished == 2:
                scheduler.kill()

        with (
            dask.config.set({"distributed.comm.timeouts.connect": "1s"}),
            pytest.raises(scaleaxis.Error, match="scheduler is gone"),
        ):
            address = json.loads(file.read_text())["address"]
            batch(tmp_path / "models", tmp_path / "out", scheduler=address, progress=kill, **COARSE)
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    done = {name for name, row in by_name(tmp_path / "out").items() if row["status"] == "done"}
    assert len(done) >= 2
    computed = debug.computed()
    debug()
    assert in_one_shard(tmp_path / "models", tmp_path / "out", workers=2).lost == 0
    assert all(debug.computed()[name] == computed[name] for name in done)
    assert len(by_name(tmp_path / "out")) == 30


def test_memory_of_a_model_is_given_back(tmp_path):
    """The peak in a row is that of its model, not of one before it."""
    (tmp_path / "models").mkdir()
    scaleaxis.write_mesh(tmp_path / "models" / "1.off", ball_mesh(rounds=3))
    (small,) = write_boxes(tmp_path / "small", 1)
    small.rename(tmp_path / "models" / "2.off")
    in_one_shard(
        [(tmp_path / "models/1.off", {"delta": 0.006, "sampling": "uniform"}), (tmp_path / "models/2.off", {})],
        tmp_path / "out",
    )
    rows = by_name(tmp_path / "out")
    assert rows["1.off"]["peak_memory"] > 1.2 * rows["2.off"]["peak_memory"]
    assert np.isfinite(rows["1.off"]["diagonal"])
