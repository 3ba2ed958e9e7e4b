# SPDX-License-Identifier: Apache-2.0
"""Skeletons in the terms of programs for vessels (VMTK), neurons (NEURON, navis) and trees (TreeQSM)."""

import csv
import subprocess
import sys

import numpy as np
import pytest
import scaleaxis
import vtk
from vtk.util.numpy_support import vtk_to_numpy

TIPS = np.array([[0.0, 0, -5], [2.4, 0, 3.2], [-1.8, 0, 2.4]])  # 5, 4 and 3 from the origin, in one plane
RADII = np.array([0.6, 0.5, 0.4])
BOUNDS = [[-3, -1, -6], [4, 1, 5]]


def tubes(points):
    """A Y of three tubes from the origin, with round ends."""
    distances = []
    for tip, radius in zip(TIPS, RADII):
        at = np.clip(points @ tip / (tip @ tip), 0, 1)
        distances.append(np.linalg.norm(points - at[:, None] * tip, axis=1) - radius)
    return np.min(distances, axis=0)


def ring(points):
    """A torus of radii 2 and 0.5 with a handle of radius 0.4 that leads away from it."""
    x, y, z = points.T
    torus = np.hypot(np.hypot(x, y) - 2, z) - 0.5
    at = np.clip(x, 2, 6)
    return np.minimum(torus, np.sqrt((x - at) ** 2 + y**2 + z**2) - 0.4)


@pytest.fixture(scope="module")
def fork():
    return scaleaxis.skeleton(tubes, bounds=BOUNDS, delta=0.01)


@pytest.fixture(scope="module")
def loop():
    return scaleaxis.skeleton(ring, bounds=[[-3, -3, -1], [7, 3, 1]], delta=0.01)


def polydata(file):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


# As VMTK's filters make them: name, type, components.
OF_POINTS = {
    "MaximumInscribedSphereRadius": (vtk.VTK_DOUBLE, 1),
    "Abscissas": (vtk.VTK_DOUBLE, 1),
    "ParallelTransportNormals": (vtk.VTK_DOUBLE, 3),
    "Curvature": (vtk.VTK_DOUBLE, 1),
    "Torsion": (vtk.VTK_DOUBLE, 1),
    "FrenetTangent": (vtk.VTK_DOUBLE, 3),
    "FrenetNormal": (vtk.VTK_DOUBLE, 3),
    "FrenetBinormal": (vtk.VTK_DOUBLE, 3),
    "CenterlineSectionArea": (vtk.VTK_DOUBLE, 1),
    "CenterlineSectionMinSize": (vtk.VTK_DOUBLE, 1),
    "CenterlineSectionMaxSize": (vtk.VTK_DOUBLE, 1),
    "CenterlineSectionShape": (vtk.VTK_DOUBLE, 1),
    "CenterlineSectionClosed": (vtk.VTK_INT, 1),
}
OF_CELLS = {
    "CenterlineIds": (vtk.VTK_INT, 1),
    "GroupIds": (vtk.VTK_INT, 1),
    "TractIds": (vtk.VTK_INT, 1),
    "Blanking": (vtk.VTK_INT, 1),
    "Length": (vtk.VTK_DOUBLE, 1),
    "Tortuosity": (vtk.VTK_DOUBLE, 1),
}


def test_vtp_has_the_arrays_of_vmtk(fork, tmp_path):
    fork.with_sections(scaleaxis.function_solid(tubes, BOUNDS)).save(tmp_path / "fork.vtp")
    data = polydata(tmp_path / "fork.vtp")
    for owner, arrays in ((data.GetPointData(), OF_POINTS), (data.GetCellData(), OF_CELLS)):
        for name, (kind, components) in arrays.items():
            array = owner.GetArray(name)
            assert array is not None, name
            assert (array.GetDataType(), array.GetNumberOfComponents()) == (kind, components), name
    values = {name: vtk_to_numpy(data.GetPointData().GetArray(name)) for name in OF_POINTS}
    cells = {name: vtk_to_numpy(data.GetCellData().GetArray(name)) for name in OF_CELLS}
    places = vtk_to_numpy(data.GetPoints().GetData())
    assert data.GetNumberOfLines() == data.GetNumberOfCells() == 3
    assert all(data.GetCellType(c) == vtk.VTK_POLY_LINE for c in range(3))
    assert sorted(cells["GroupIds"]) == [0, 1, 2] and not cells["Blanking"].any()
    # Two centerlines lead from the thickest end to the others; the branch that both are on is counted to the first.
    assert sorted(zip(cells["CenterlineIds"], cells["TractIds"])) == [(0, 0), (0, 1), (1, 1)]
    seen = []
    for c in range(3):
        ids = [data.GetCell(c).GetPointId(k) for k in range(data.GetCell(c).GetNumberOfPoints())]
        seen += ids
        steps = np.linalg.norm(np.diff(places[ids], axis=0), axis=1)
        assert values["Abscissas"][ids] == pytest.approx(np.insert(np.cumsum(steps), 0, 0))
        assert cells["Length"][c] == pytest.approx(steps.sum())
        tip = TIPS[np.argmin([min(np.linalg.norm(places[i] - t) for i in (ids[0], ids[-1])) for t in TIPS])]
        inner = [i for i in ids if 1.2 < np.linalg.norm(places[i]) < np.linalg.norm(tip) - 0.5]
        radius = RADII[np.flatnonzero((TIPS == tip).all(axis=1))[0]]
        assert values["MaximumInscribedSphereRadius"][inner] == pytest.approx(radius, abs=0.02)
        assert values["CenterlineSectionArea"][inner] == pytest.approx(np.pi * radius**2, rel=0.05)
        # Lines lead away from the root, the trunk's towards the origin.
        outward = (tip if tip[2] > 0 else -tip) / np.linalg.norm(tip)
        assert (values["FrenetTangent"][inner] @ outward > 0.99).all()
        assert np.abs((values["ParallelTransportNormals"][inner] * values["FrenetTangent"][inner]).sum(axis=1)).max() < 1e-9
    assert sorted(seen) == list(range(len(places)))  # lines share no points


def test_branches_of_a_fork(fork):
    assert sorted(fork.lengths) == pytest.approx([3, 4, 5], abs=0.6)  # they meet in the ball of the trunk
    for branch in range(3):
        geometry = fork.geometry(branch)
        assert geometry.length == pytest.approx(fork.lengths[branch])
        assert geometry.tangents.shape == (len(fork.branches[branch]), 3)
    with pytest.raises(IndexError, match="there are 3"):
        fork.geometry(3)


def test_path(fork):
    path = fork.path(TIPS[1], TIPS[2])
    assert len(path.branches) == 1 and path.axis is None
    assert path.lengths == pytest.approx([7], abs=0.6)  # it cuts the corner in the ball of the trunk
    np.testing.assert_allclose(path.nodes[0], TIPS[1], atol=0.1)
    np.testing.assert_allclose(path.nodes[-1], TIPS[2], atol=0.1)
    assert path.resampled(0.5).radii[[0, -1]] == pytest.approx([0.5, 0.4], abs=0.02)
    with pytest.raises(ValueError, match="three numbers"):
        fork.path([0, 0], [1, 1, 1])


def test_root(fork, tmp_path):
    rooted = fork.rooted_at(TIPS[2])
    assert list(rooted.to_navis().root) == [rooted.root]
    np.testing.assert_allclose(fork.nodes[rooted.root], TIPS[2], atol=0.1)
    assert rooted.resampled(0.3).root >= 0
    # A path leads from its start to its end, even if that is thicker.
    fork.path(TIPS[2], TIPS[0]).save(tmp_path / "path.vtp")
    data = polydata(tmp_path / "path.vtp")
    line = [data.GetPoint(data.GetCell(0).GetPointId(k)) for k in (0, data.GetNumberOfPoints() - 1)]
    np.testing.assert_allclose(line, TIPS[[2, 0]], atol=0.1)


def test_even_steps(fork):
    even = fork.resampled(0.25)
    assert even.axis is fork.axis and even.lengths == pytest.approx(fork.lengths, rel=0.01)
    for branch in range(3):
        steps = np.diff(even.geometry(branch).abscissas)
        assert steps.max() <= 0.25 and steps == pytest.approx(steps[0], rel=0.05)
    assert even.vertex_nodes.max() < len(even.nodes) < len(fork.nodes)
    assert set(even.node_branches[even.nearest_nodes(0.9 * TIPS)]) == {0, 1, 2}
    with pytest.raises(scaleaxis.InvalidOption, match="step"):
        fork.resampled(0.0)


def test_sections(fork):
    assert fork.sections is None
    sections = fork.with_sections(fork.axis.mesh().mesh).sections
    far = (np.linalg.norm(fork.nodes, axis=1) > 1.2) & (fork.degrees == 2)
    assert sections.is_closed[far].all()
    assert sections.areas[far] == pytest.approx(np.pi * fork.radii[far] ** 2, rel=0.06)
    with pytest.raises(ValueError, match="solid"):
        fork.with_sections(scaleaxis.load(fork.axis.mesh().mesh.vertices, points="crust"))


IMPORT = """
import sys
from neuron import h

h.load_file("stdlib.hoc")
h.load_file("import3d.hoc")
reader = h.Import3d_SWC_read()
reader.input(sys.argv[1])


class Cell:
    pass


cell = Cell()  # owns the sections
h.Import3d_GUI(reader, False).instantiate(cell)
sections = list(h.allsec())
print(int(reader.err), len(sections), sum(s.parentseg() is None for s in sections), sum(s.L for s in sections))
"""


def imported(file):
    """What NEURON makes of an SWC file: errors, sections, roots, length. It keeps a global model, so it runs alone."""
    done = subprocess.run([sys.executable, "-c", IMPORT, str(file)], capture_output=True, text=True, check=True)
    errors, sections, roots, length = done.stdout.split()[-4:]
    return int(errors), int(sections), int(roots), float(length)


def test_neuron_imports_swc(fork, loop, tmp_path):
    fork.save(tmp_path / "fork.swc")
    errors, sections, roots, length = imported(tmp_path / "fork.swc")
    assert (errors, sections, roots) == (0, 3, 1)
    assert length == pytest.approx(fork.lengths.sum(), rel=1e-6)
    with pytest.warns(scaleaxis.Warning, match="1 is cut") as told:
        loop.save(tmp_path / "loop.swc")
    assert told[0].message.code == "skeleton.loops"
    assert "# loop cut: an edge between" in (tmp_path / "loop.swc").read_text()
    errors, sections, roots, length = imported(tmp_path / "loop.swc")
    assert (errors, sections, roots) == (0, 3, 1)
    steps = np.linalg.norm(np.diff(loop.nodes[loop.edges], axis=1), axis=2)
    assert loop.lengths.sum() - 1.01 * steps.max() < length < loop.lengths.sum()
    assert told[0].message.place[0] == pytest.approx(-2, abs=0.1)  # the far side of the ring


@pytest.mark.filterwarnings("ignore::scaleaxis.Warning")
def test_navis(fork, loop):
    neuron = fork.to_navis()
    assert neuron.n_trees == 1 and neuron.n_branches == 1 and neuron.n_ends == 3 - 1
    assert neuron.cable_length == pytest.approx(fork.lengths.sum(), rel=1e-5)
    assert set(neuron.nodes.node_id) == set(range(len(fork.nodes)))
    assert loop.to_navis().n_trees == 1


@pytest.mark.filterwarnings("ignore::scaleaxis.Warning")
def test_cylinders(fork, loop, tmp_path):
    table = fork.cylinders()
    assert (table["parent"] < table["id"]).all() and (table["parent"] == 0).sum() == 1
    assert table["length"].sum() == pytest.approx(fork.lengths.sum())
    order = table["branch_order"]
    assert set(order) == {0, 1} and len(set(table["branch"])) == 2
    # The trunk, 5 long, goes on in the thicker of the two, 4 long.
    assert table["length"][order == 0].sum() == pytest.approx(9, abs=0.6)
    volume = (np.pi * table["radius"] ** 2 * table["length"]).sum()
    assert volume == pytest.approx(np.pi * (0.36 * 5 + 0.25 * 4 + 0.16 * 3), rel=0.08)
    starts = np.column_stack([table[f"start_{c}"] for c in "xyz"])
    axes = np.column_stack([table[f"axis_{c}"] for c in "xyz"])
    ends = starts + table["length"][:, None] * axes
    grown = table["parent"] > 0
    np.testing.assert_allclose(starts[grown], ends[table["parent"][grown] - 1], atol=1e-9)
    fork.save(tmp_path / "fork.csv")
    with open(tmp_path / "fork.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(table)
    for name, values in table.items():
        np.testing.assert_array_equal([float(row[name]) for row in rows], values)
    loop.save(tmp_path / "loop.csv")
