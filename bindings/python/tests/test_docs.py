# SPDX-License-Identifier: Apache-2.0
"""The code of README.md and of the pages in docs runs as it stands there."""

from __future__ import annotations

import re
import shutil

import numpy as np
import pytest
import scaleaxis
from conftest import ROOT


def blocks_of(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.S | re.M)


BLOCKS = blocks_of("python.md")
# Pages of tasks, each with one snippet of its own.
TASKS = sorted(
    file.name
    for file in (ROOT / "docs").glob("*.md")
    if file.name not in ("python.md", "batch.md", "index.md") and blocks_of(file.name)
)


def test_there_are_blocks():
    assert len(BLOCKS) >= 8


@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_block(number, tmp_path, monkeypatch):
    """Each begins with what the first ones have made: `axis` of `cat.obj`."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "data/cat.obj", tmp_path)
    code = BLOCKS[number]
    names = {"__name__": "__main__"}
    if number > 0:
        exec("import numpy as np, scaleaxis\naxis = scaleaxis.axis('cat.obj', delta=0.03)", names)
    exec(compile(code, f"docs/python.md, block {number}", "exec"), names)


def test_readme(tmp_path, monkeypatch):
    """As from the project's folder."""
    shutil.copytree(ROOT / "data", tmp_path / "data", ignore=lambda folder, names: {*names} - {"cat.obj"})
    monkeypatch.chdir(tmp_path)
    blocks = blocks_of("../README.md")
    assert len(blocks) == 1
    exec(compile(blocks[0], "README.md", "exec"), {"__name__": "__main__"})
    assert (tmp_path / "cat-axis.ply").is_file()


def plate():
    x, y, z = np.meshgrid([0.0, 40.0], [0.0, 30.0], [0.0, 3.0], indexing="ij")
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [triangle for a, b, c, d in sides for triangle in ([a, b, c], [a, c, d])]
    return scaleaxis.Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), np.array(triangles))


ROBOT = """<robot name="arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><cylinder radius="0.03" length="0.4"/></geometry></collision></link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="arm"/><origin xyz="0 0 0.3"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>"""


def test_there_are_tasks():
    assert len(TASKS) >= 15


@pytest.mark.filterwarnings("ignore")  # those of the cat's vertices as a cloud
@pytest.mark.parametrize("page", TASKS)
def test_task(page, tmp_path, monkeypatch):
    """Whatever a page names is the cat, or a plate: files, arrays of points and voxels, and `axis` of it."""
    pandas = pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "data/cat.obj", tmp_path)
    cat = scaleaxis.read_mesh("cat.obj")
    for name in ("part.stl", "link.stl", "shell.stl", "neuron.ply", "oak.ply"):
        scaleaxis.write_mesh(name, cat)
    scaleaxis.write_mesh("bracket.stl", plate())  # a cat has no walls
    corners, triangles = plate()
    corners = (corners - corners.min(axis=0)) / np.ptp(corners, axis=0)
    scaleaxis.write_mesh("aorta.stl", (corners * [20, 100, 20] + [210, 85, 16], triangles))  # a bar where the vessel is
    (tmp_path / "robot.urdf").write_text(ROBOT)
    axis = scaleaxis.axis(cat)
    scaleaxis.write_axis("axis.ma", scaleaxis.axis(cat, scale=1, clean=0, sharp=False).complex)
    voxels = np.zeros((30, 30, 30), dtype=bool)
    voxels[5:25, 5:25, 8:20] = True
    names = {"np": np, "pandas": pandas, "scaleaxis": scaleaxis, "axis": axis, "voxels": voxels}
    names |= {"points": cat.vertices, "normals": None, "__name__": "__main__"}
    for block in blocks_of(page):
        exec(compile(block, f"docs/{page}", "exec"), names)


@pytest.mark.filterwarnings("ignore")  # those of Dask
def test_batch(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "models").mkdir()
    vertices, faces = scaleaxis.read_mesh(ROOT / "data/cat.obj")
    for i in range(3):
        scaleaxis.write_mesh(tmp_path / "models" / f"{i}.off", (vertices * [1, 1, 1 + i], faces))
    blocks = blocks_of("batch.md")
    assert len(blocks) == 1
    exec(compile(blocks[0], "docs/batch.md", "exec"), {"__name__": "__main__"})
    assert len(list(tmp_path.glob("results/axes/*/*.ply"))) == 3
