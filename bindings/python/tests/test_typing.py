# SPDX-License-Identifier: Apache-2.0
"""The package and a script that uses it, as mypy sees them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

USER = """
from __future__ import annotations
import numpy as np
import numpy.typing as npt
import scaleaxis

one: scaleaxis.Axis = scaleaxis.axis("cat.obj", delta=0.01, scale=1.1)
many: list[scaleaxis.Axis] = scaleaxis.axis("cat.obj", scale=[1.0, 1.1])
vertices: npt.NDArray[np.float64] = one.vertices
sheets: npt.NDArray[np.int32] = one.sheets
tunnels: int | None = one.topology.tunnels

def show(stage: str, part: float) -> None: ...

def ball(points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(np.linalg.norm(points, axis=1) - 1)

scaleaxis.axis(ball, bounds=[[-2, -2, -2], [2, 2, 2]], progress=show)
scaleaxis.axis(np.zeros((3, 3, 3)), spacing=(1.0, 2.0, 2.0), nonzero=True)
of_vertices: npt.NDArray[np.int32] = one.transformed(np.eye(4)).mesh_map
columns = one.to_pandas().vertices.columns
of_skeleton: scaleaxis.Axis | None = scaleaxis.skeleton("cat.obj", delta=0.02, spacing=2.0, node_spacing=0.1).axis
some: scaleaxis.Polygons = one.polygons[1:3]
kept = scaleaxis.filter(scaleaxis.medial_axis(one.balls).complex, 20.0).complex
tetrahedra: npt.NDArray[np.int32] = scaleaxis.delaunay(one.vertices, weights=one.radii**2).tetrahedra
places, distances, triangles = scaleaxis.nearest("cat.obj", [[0.0, 0.0, 0.0]])
nearest: npt.NDArray[np.float64] = distances
cable: float = scaleaxis.skeleton(one).to_osteoid().cable_length()
shown = one.plot(shape=False, cmap="viridis"), one.to_pyvista().n_points, one.complex.to_pyvista().n_cells
try:
    scaleaxis.axis((np.zeros((3, 3)), np.zeros((1, 3))))
except scaleaxis.Error as error:
    code: str = error.code
"""

WRONG = """
import scaleaxis
scaleaxis.delaunay([[0, 0, 0]], weight=[1])
scaleaxis.axis("cat.obj", union="round")
scaleaxis.axis("cat.obj").vertex
scaleaxis.axis("cat.obj", progress=lambda stage: None)
scaleaxis.axis("cat.obj", spacings=1.0)
scaleaxis.load("cat.obj", labels="liver")
wrong: list[scaleaxis.Axis] = scaleaxis.axis("cat.obj")
scaleaxis.axis("cat.obj", sampling="dense")
scaleaxis.skeleton("cat.obj", sharp=True)
scaleaxis.midsurface("cat.obj", detla=0.1)
next(scaleaxis.label_axes("cells.nii", thread=1))
"""


def mypy(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "mypy", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_package(pytestconfig):
    result = mypy("--config-file", str(pytestconfig.rootpath / "pyproject.toml"))
    assert result.returncode == 0, result.stdout


def test_script_of_a_user(tmp_path: Path):
    (tmp_path / "user.py").write_text(USER)
    (tmp_path / "wrong.py").write_text(WRONG)
    right = mypy("--strict", "--cache-dir", str(tmp_path), str(tmp_path / "user.py"))
    assert right.returncode == 0, right.stdout
    wrong = mypy("--strict", "--cache-dir", str(tmp_path), str(tmp_path / "wrong.py"))
    lines = {int(line.split(":")[1]) for line in wrong.stdout.splitlines() if " error: " in line}
    assert lines == set(range(3, 14)), wrong.stdout
