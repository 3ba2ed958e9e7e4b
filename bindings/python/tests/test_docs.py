# SPDX-License-Identifier: Apache-2.0
"""The code of docs/python.md and docs/batch.md runs as it stands there."""

from __future__ import annotations

import re
import shutil

import pytest
import scaleaxis
from conftest import ROOT


def blocks_of(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.S | re.M)


BLOCKS = blocks_of("python.md")


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
