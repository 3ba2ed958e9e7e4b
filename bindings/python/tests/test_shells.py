# SPDX-License-Identifier: Apache-2.0
"""Shell meshes, solved by CalculiX beside theory and beside the solid in hexahedra."""

from __future__ import annotations

import itertools
import re
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest
import scaleaxis

YOUNG, POISSON = 210000.0, 0.3
SHEAR = YOUNG / (2 * (1 + POISSON))

Filled = Callable[[int, int, int], bool]


@dataclass
class Boxes:
    """The cells of a grid of planes that are filled: a closed surface, and hexahedra."""

    planes: tuple[list[float], list[float], list[float]]
    filled: Filled

    def cells(self) -> set[tuple[int, ...]]:
        return {cell for cell in itertools.product(*(range(len(p) - 1) for p in self.planes)) if self.filled(*cell)}

    def surface(self) -> tuple[np.ndarray, np.ndarray]:
        cells, ids, triangles = self.cells(), {}, []
        for cell, axis, side in itertools.product(sorted(cells), range(3), (0, 1)):
            beside = list(cell)
            beside[axis] += 2 * side - 1
            if tuple(beside) in cells:
                continue
            corners = []
            for i, j in [(0, 0), (1, 0), (1, 1), (0, 1)][:: 2 * side - 1]:
                at = list(cell)
                at[axis] += side
                at[(axis + 1) % 3] += i
                at[(axis + 2) % 3] += j
                corners.append(ids.setdefault(tuple(at), len(ids)))
            triangles += [corners[:3], [corners[0], *corners[2:]]]
        return np.array([[self.planes[k][at[k]] for k in range(3)] for at in ids]), np.array(triangles, dtype=np.int32)

    def hexahedra(self, size: float) -> tuple[np.ndarray, list[list[int]]]:
        """With edges no longer than that, and middles (C3D20R)."""
        fine = []
        for planes in self.planes:
            counts = [max(1, round((b - a) / size)) for a, b in zip(planes, planes[1:])]
            parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(planes, planes[1:], counts)]
            fine.append(np.concatenate([*parts, planes[-1:]]))
        coarse = [np.searchsorted(p, f[:-1] + 1e-9) - 1 for p, f in zip(self.planes, fine)]
        corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
        bottom, top, sides = (
            [(0, 1), (1, 2), (2, 3), (3, 0)],
            [(4, 5), (5, 6), (6, 7), (7, 4)],
            [(0, 4), (1, 5), (2, 6), (3, 7)],
        )
        middles = [tuple((a + b) // 2 for a, b in zip(corners[i], corners[j])) for i, j in bottom + top + sides]
        ids: dict[tuple[int, ...], int] = {}
        elements = []
        for cell in itertools.product(*(range(len(f) - 1) for f in fine)):
            if self.filled(*(int(coarse[k][cell[k]]) for k in range(3))):
                elements.append(
                    [
                        ids.setdefault(tuple(2 * c + o for c, o in zip(cell, offset)), len(ids))
                        for offset in corners + middles
                    ]
                )
        doubled = [np.interp(np.arange(2 * len(f) - 1) / 2, np.arange(len(f)), f) for f in fine]
        return np.array([[doubled[k][at[k]] for k in range(3)] for at in ids]), elements


def deflection(
    folder: Path, mesh: str, nodes: np.ndarray, fixed: np.ndarray, loaded: np.ndarray, axis: int, dofs: str
) -> float:
    """Of the loaded nodes, on average, under a force of 1 along an axis that they share."""

    def set_of(name: str, chosen: np.ndarray) -> str:
        return f"*NSET, NSET={name}\n" + "".join(f"{v + 1},\n" for v in np.flatnonzero(chosen))

    (folder / "job.inp").write_text(
        f"*MATERIAL, NAME=WALL\n*ELASTIC\n{YOUNG}, {POISSON}\n{mesh}{set_of('FIXED', fixed)}{set_of('LOADED', loaded)}"
        f"*BOUNDARY\nFIXED, {dofs}\n*STEP\n*STATIC\n*CLOAD\nLOADED, {axis + 1}, {1.0 / loaded.sum()}\n"
        "*NODE PRINT, NSET=LOADED\nU\n*END STEP\n"
    )
    done = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, check=False)
    rows = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+)$", (folder / "job.dat").read_text(), re.M)
    assert len(rows) == loaded.sum(), done.stdout[-2000:]
    return float(np.mean([float(row[axis]) for row in rows]))


def shells_of(boxes: Boxes, size: float, delta: float) -> scaleaxis.ShellMesh:
    return scaleaxis.midsurface(boxes.surface(), delta=delta).shells(size=size)


def shell_deflection(folder: Path, shells: scaleaxis.ShellMesh, fixed, loaded, axis: int) -> float:
    shells.save(folder / "shells.inp")
    nodes = np.vstack([shells.vertices, shells.middles])
    return deflection(folder, "*INCLUDE, INPUT=shells.inp\n", nodes, fixed(nodes), loaded(nodes), axis, "1, 6")


def solid_deflection(folder: Path, boxes: Boxes, size: float, fixed, loaded, axis: int) -> float:
    nodes, elements = boxes.hexahedra(size)
    lines = ["*NODE"] + [f"{v + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for v, (x, y, z) in enumerate(nodes)]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=ALL")
    for e, element in enumerate(elements):
        numbers = [e + 1] + [v + 1 for v in element]
        lines += [", ".join(map(str, numbers[:11])) + ",", ", ".join(map(str, numbers[11:]))]
    lines.append("*SOLID SECTION, ELSET=ALL, MATERIAL=WALL\n")
    return deflection(folder, "\n".join(lines), nodes, fixed(nodes), loaded(nodes), axis, "1, 3")


def near(axis: int, value: float):
    return lambda p: np.abs(p[:, axis] - value) < 1e-3


PLATE = Boxes(([0, 40], [0, 20], [-0.5, 0.5]), lambda *_: True)
I_BEAM = Boxes(([0, 100], [-6, -0.5, 0.5, 6], [-10, -9, 9, 10]), lambda i, j, k: k != 1 or j == 1)
TUBE = Boxes(([0, 100], [-6, -5, 5, 6], [-5, -4, 4, 5]), lambda i, j, k: not (k == 1 and j == 1))
# A base, a wall, and two ribs between them.
BRACKET = Boxes(
    ([0, 5, 6, 34, 35, 40], [0, 1, 20, 30], [0, 1, 20, 30]),
    lambda i, j, k: k == 0 or j == 0 or (i in (1, 3) and j == k == 1),
)


def test_a_plate_bends_as_the_solid(tmp_path: Path) -> None:
    shells = shells_of(PLATE, 2.0, 0.01)
    assert shells.areas.sum() == pytest.approx(800, rel=1e-6)
    assert np.ptp(shells.thickness) == 0 and shells.thickness[0, 0] == pytest.approx(1, rel=1e-3)
    found = shell_deflection(tmp_path, shells, near(0, 0), near(0, 40), 2)
    wanted = solid_deflection(tmp_path, PLATE, 1.0, near(0, 0), near(0, 40), 2)
    assert found == pytest.approx(wanted, rel=0.01)
    beam = 40**3 / (3 * YOUNG * 20 / 12)
    assert beam * (1 - POISSON**2) < found < beam


def test_a_tapered_plate_bends_as_theory_says(tmp_path: Path) -> None:
    length, width, root, tip = 80.0, 10.0, 3.0, 1.5
    ends = [(x, t) for x, t in ((0.0, root), (length, tip))]
    vertices = np.array([(x, y, side * t / 2) for x, t in ends for y in (0.0, width) for side in (-1, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], dtype=np.int32)
    shells = scaleaxis.midsurface((vertices, triangles), delta=0.004).shells(size=2.5)
    wanted = np.interp(shells.vertices[:, 0], [0, length], [root, tip])
    assert shells.thickness == pytest.approx(wanted[shells.triangles], rel=0.02)
    found = shell_deflection(tmp_path, shells, near(0, 0), near(0, length), 2)
    assert "*NODAL THICKNESS" in (tmp_path / "shells.inp").read_text()
    # Euler and Bernoulli: the square of the distance from the tip over E I, along the beam.
    x = (np.arange(10_000) + 0.5) / 10_000 * length
    theory = np.mean(x**2 / (YOUNG * width * (tip + (root - tip) * x / length) ** 3 / 12)) * length
    assert found == pytest.approx(theory, rel=0.02)


@pytest.mark.parametrize(
    ("boxes", "inertia", "shear_area"),
    [(I_BEAM, (12 * 20**3 - 11 * 18**3) / 12, 19.0), (TUBE, (12 * 10**3 - 10 * 8**3) / 12, 18.0)],
    ids=["I", "tube"],
)
def test_beams_bend_as_theory_says(tmp_path: Path, boxes: Boxes, inertia: float, shear_area: float) -> None:
    shells = shells_of(boxes, 2.0, 0.004)
    found = shell_deflection(tmp_path, shells, near(0, 0), near(0, 100), 2)
    assert found == pytest.approx(100**3 / (3 * YOUNG * inertia) + 100 / (SHEAR * shear_area), rel=0.03)


def test_a_bracket_with_ribs_bends_as_the_solid(tmp_path: Path) -> None:
    shells = shells_of(BRACKET, 2.0, 0.006)
    assert shells.areas.tolist() == pytest.approx([1180, 1180, 380.25, 380.25], rel=1e-4)
    # It hangs from the upper rim of its wall.
    found = shell_deflection(tmp_path, shells, near(2, 30), near(1, 30), 2)
    wanted = solid_deflection(tmp_path, BRACKET, 2.0, near(2, 30), near(1, 30), 2)
    assert found == pytest.approx(wanted, rel=0.03)


def test_seams_are_shared(tmp_path: Path) -> None:
    shells = shells_of(BRACKET, 3.0, 0.006)
    ends = np.sort(np.vstack([shells.triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    edges, counts = np.unique(ends, axis=0, return_counts=True)
    lengths = np.linalg.norm(np.diff(shells.vertices[edges], axis=1)[:, 0], axis=1)
    assert lengths[counts == 3].sum() == pytest.approx(4 * 19.5, rel=1e-3)  # feet of the ribs
    assert set(counts) == {1, 2, 3}
    assert shells.least_angle > 20 and lengths.max() < 1.5 * 3.0
    for name, order in itertools.product(["a.bdf", "a.msh", "a.vtu"], [1, 2]):
        shells.save(tmp_path / name, order=order)
        if name != "a.bdf" or order == 1:  # meshio knows no CTRIA6
            mesh = meshio.read(tmp_path / name)
            cells = np.vstack([block.data for block in mesh.cells])
            assert cells.shape == (len(shells.triangles), 3 * order)
            middles = shells.middles[shells.triangle_middles]
            assert (
                mesh.points[cells[:, 3:]]
                == pytest.approx(
                    middles[np.argsort(shells.triangle_sheets, kind="stable")] if name == "a.msh" else middles
                )
                or order == 1
            )
    with pytest.raises(scaleaxis.FileError, match="cannot write"):
        shells.save(tmp_path / "a.stl")
    with pytest.raises(scaleaxis.InvalidOption, match="more than 0"):
        scaleaxis.midsurface(PLATE.surface(), delta=0.01).shells(size=0.0)
