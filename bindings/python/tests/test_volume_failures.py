# SPDX-License-Identifier: Apache-2.0
"""Volumes in blocks when something ends early: processes that are killed, disks that are full, files that are damaged.
A second call finishes, computes no finished block twice, and gives the bytes of one that nothing happened to.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scaleaxis import Error
from scaleaxis.batch.progress import Counts
from scaleaxis.volumes import Report, volume
from scaleaxis.volumes.worker import DEBUG

pytestmark = pytest.mark.filterwarnings("ignore:trees have no loops")  # of which SWC files are made

OPTIONS: dict[str, Any] = {"block": 32, "memory": "8GB", "thickness": True, "angle": 30.0, "skeleton": True}
WORDS = ["--block", "32", "--memory", "8GB", "--thickness", "--angle", "30", "--skeleton", "-q"]
CODE = "import sys; from scaleaxis.batch.command import main; sys.exit(main(sys.argv[1:]))"


def run(source: Path, output: Path, **options: Any) -> Report:
    return volume(source, output, **{**OPTIONS, "workers": 2, "progress": False, **options})


def files(folder: Path) -> dict[str, bytes]:
    """But for times and memory."""
    found = {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}
    for name in list(found):
        if name.endswith(".json") and name.startswith(("blocks", "report")):
            row = json.loads(found[name])
            kept = {
                key: row[key] for key in row if key not in ("seconds", "peak_memory", "stitching_memory", "cpu_seconds")
            }
            found[name] = json.dumps(kept).encode()
    return found


@pytest.fixture(scope="session")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    z, y, x = np.indices((40, 40, 96)) - np.array([20.3, 20.1, 24.2]).reshape(3, 1, 1, 1)
    rings = [np.hypot(np.hypot(x - shift, y) - 13, z) < 2.6 for shift in (0, 24, 48)]
    path = tmp_path_factory.mktemp("source") / "volume.npy"
    np.save(path, np.logical_or.reduce(rings).astype(np.uint8))
    return path


@pytest.fixture(scope="session")
def made(source: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("made")
    run(source, output)
    return output


@pytest.fixture(scope="session")
def expected(made: Path) -> dict[str, bytes]:
    return files(made)


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Names of the blocks that were begun."""
    monkeypatch.setenv(DEBUG, json.dumps({"log": str(tmp_path / "log")}))
    return tmp_path / "log"


def finished(output: Path) -> set[str]:
    return {row.stem for row in output.glob("blocks/*.json")}


def check_finishes(source: Path, output: Path, log: Path, expected: dict[str, bytes]) -> None:
    done = finished(output)
    log.write_text("")
    report = run(source, output)
    begun = set(log.read_text().split())  # once more by a process that had not yet noticed its end, perhaps
    assert not done & begun and report.computed == len(begun)
    assert files(output) == expected


def wait_until(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.005)


@pytest.mark.parametrize("victims", ["call", "all"])
@pytest.mark.parametrize("after", [1, 3, 5])
def test_processes_are_killed(
    victims: str, after: int, source: Path, tmp_path: Path, log: Path, expected: dict[str, bytes]
) -> None:
    """The one that was called alone, or with all blocks at work, after so many results."""
    output = tmp_path / "out"
    words = [sys.executable, "-c", CODE, "volume", str(source), "-o", str(output), "--workers", "2", *WORDS]
    process = subprocess.Popen(words, start_new_session=True)
    wait_until(lambda: len(finished(output)) >= after)
    (os.killpg if victims == "all" else os.kill)(process.pid, signal.SIGKILL)
    process.wait()
    time.sleep(0.5)  # blocks at work end with their input
    assert not (output / "report.json").exists()
    check_finishes(source, output, log, expected)


def test_a_block_that_is_killed_each_time(
    source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, expected: dict[str, bytes]
) -> None:
    """As by the kernel where there is too little memory: one line, and what else is done stays."""
    from scaleaxis.volumes import worker

    monkeypatch.setattr(worker, "_TRIES", 1)
    (tmp_path / "once").touch()
    monkeypatch.setenv(DEBUG, json.dumps({"kill": str(tmp_path / "once")}))
    with pytest.raises(
        Error,
        match=r"the block at voxel [0-9, ]*: its process was ended by signal 9, 1 times: too little memory, perhaps$",
    ):
        run(source, tmp_path / "out")
    monkeypatch.delenv(DEBUG)
    run(source, tmp_path / "out")
    assert files(tmp_path / "out") == expected


def test_a_worker_of_dask_is_killed(source: Path, tmp_path: Path, log: Path, expected: dict[str, bytes]) -> None:
    import distributed

    victims: list[int] = []
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = client.run(os.getpid)

        def kill(counts: Counts) -> None:
            if counts.finished == 3 and not victims:
                victims.append(min(workers.values()))
                threading.Timer(0.2, os.kill, (victims[0], signal.SIGKILL)).start()

        report = run(source, tmp_path / "out", scheduler=client, progress=kill)
    assert victims and files(tmp_path / "out") == expected
    begun = Counter(log.read_text().split())
    assert len(begun) == report.computed and sum(begun.values()) <= report.computed + 1  # the one in work
    assert run(source, tmp_path / "out").computed == 0


def test_the_scheduler_of_dask_is_killed(source: Path, tmp_path: Path, log: Path, expected: dict[str, bytes]) -> None:
    import dask
    import distributed  # noqa: F401 - what it sets at first must not go with what is set below

    file, output = tmp_path / "scheduler.json", tmp_path / "out"
    command = [sys.executable, "-m", "dask"]
    silent: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    told = ["--no-dashboard", "--scheduler-file", str(file)]
    scheduler = subprocess.Popen([*command, "scheduler", "--host", "127.0.0.1", "--port", "0", *told], **silent)
    worker = subprocess.Popen([*command, "worker", "--nthreads", "1", "--no-nanny", *told], **silent)
    try:
        wait_until(lambda: file.exists() and file.read_text().endswith("}"))

        def kill(counts: Counts) -> None:
            if counts.finished == 2:
                scheduler.kill()

        with (
            dask.config.set({"distributed.comm.timeouts.connect": "1s"}),
            pytest.raises(Error, match="scheduler is gone: call again, what is done stays"),
        ):
            run(source, output, scheduler=json.loads(file.read_text())["address"], progress=kill)
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    time.sleep(0.5)
    assert len(finished(output)) >= 2
    check_finishes(source, output, log, expected)


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[None]:
    """A disk of so many bytes. Where this process may not mount one, a limit for each file does the same."""
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)], stderr=subprocess.DEVNULL, check=False
    )
    if mounted.returncode == 0:
        try:
            yield
        finally:
            subprocess.run(["umount", str(folder)], check=True)
        return
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def small_files(folder: Path, size: int) -> Iterator[None]:
    """As a quota: no file may be larger."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def check_full(result: subprocess.CompletedProcess[str]) -> None:
    assert result.returncode == 1, result.stderr
    lines = result.stderr.splitlines()
    assert len(lines) == 1 and "call again: what is done stays" in lines[0], result.stderr
    assert "no space left" in lines[0].lower() or "file too large" in lines[0].lower(), result.stderr


def call(source: Path, output: Path) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-c", CODE, "volume", str(source), "-o", str(output), "--workers", "2", *WORDS]
    return subprocess.run(words, capture_output=True, text=True, check=False)


# Bytes: for the first rows; for some parts; for all of them, but not for the stitched axis.
@pytest.mark.parametrize("share", [0.02, 0.4, 0.8])
def test_the_disk_is_full(share: float, source: Path, tmp_path: Path, log: Path, expected: dict[str, bytes]) -> None:
    # A tmpfs takes pages of 4096 bytes.
    needed = sum(-(-len(content) // 4096) * 4096 for content in expected.values())
    output = tmp_path / "disk/out"
    with small_disk(tmp_path / "disk", int(share * needed) // 4096 * 4096):
        check_full(call(source, output))
        assert not list(output.rglob("*.part*")) and not (output / "report.json").exists()
        done = finished(output)
        for name in done:  # rows tell of what is there
            for file in json.loads((output / f"blocks/{name}.json").read_bytes()).get("files", {}):
                assert (output / file).exists()
        subprocess.run(["mount", "-o", "remount,size=1g", str(tmp_path / "disk")], capture_output=True, check=False)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)
        check_finishes(source, output, log, expected)


@pytest.mark.parametrize("size", [20, 4000, 100_000])
def test_a_quota(size: int, source: Path, tmp_path: Path, log: Path, expected: dict[str, bytes]) -> None:
    assert max(map(len, expected.values())) > 100_000
    log.touch()
    with small_files(tmp_path, size):
        result = call(source, tmp_path / "out")
    check_full(result)
    check_finishes(source, tmp_path / "out", log, expected)


@pytest.mark.parametrize("name", ["blocks/part*.npz", "blocks/part*.ply", "thickness.zarr/0/*.*", "blocks/*.json"])
@pytest.mark.parametrize("harm", ["truncated", "changed", "empty", "removed"])
def test_a_damaged_result_is_computed_again(
    name: str, harm: str, source: Path, tmp_path: Path, log: Path, made: Path, expected: dict[str, bytes]
) -> None:
    shutil.copytree(made, tmp_path / "out")
    victim = max((tmp_path / "out").glob(name), key=lambda file: (file.stat().st_size, file.name))
    content = victim.read_bytes()
    middle = len(content) // 2
    if harm == "removed":
        victim.unlink()
    elif harm == "changed":
        victim.write_bytes(content[:middle] + bytes([content[middle] ^ 129]) + content[middle + 1 :])
    else:
        victim.write_bytes(content[:middle] if harm == "truncated" else b"")
    log.touch()
    report = run(source, tmp_path / "out")
    assert report.computed == 1 == len(log.read_text().split())
    assert files(tmp_path / "out") == expected
    assert run(source, tmp_path / "out").computed == 0


def test_another_volume_leaves_no_thickness_behind(source: Path, tmp_path: Path, expected: dict[str, bytes]) -> None:
    other = np.zeros((40, 40, 96), np.uint8)
    other[4:36, 4:36, 40:90] = 1
    np.save(tmp_path / "other.npy", other)
    run(tmp_path / "other.npy", tmp_path / "out", axis=False, angle=None, skeleton=False)
    run(source, tmp_path / "out")
    chunks = {name: content for name, content in files(tmp_path / "out").items() if name.startswith("thickness.zarr")}
    assert chunks == {name: content for name, content in expected.items() if name.startswith("thickness.zarr")}
