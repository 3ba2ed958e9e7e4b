# SPDX-License-Identifier: Apache-2.0
"""The code of docs/python.md runs as it stands there."""

from __future__ import annotations

import re
import shutil

import pytest
from conftest import ROOT

BLOCKS = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(encoding="utf-8"), re.S | re.M)


def test_there_are_blocks():
    assert len(BLOCKS) >= 8


@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_block(number, tmp_path, monkeypatch):
    """Each begins with what the first ones have made: `axis` of `cat.obj`."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "data/cat.obj", tmp_path)
    code = BLOCKS[number]
    for package in re.findall(r"(?:import |to_)(pyvista|nibabel|SimpleITK|trimesh|networkx)", code):
        pytest.importorskip(package)
    names = {"__name__": "__main__"}
    if number > 0:
        exec("import numpy as np, scaleaxis\naxis = scaleaxis.axis('cat.obj', delta=0.03)", names)
    exec(compile(code, f"docs/python.md, block {number}", "exec"), names)
