# SPDX-License-Identifier: Apache-2.0
"""Curve skeletons."""

import json

import networkx
import numpy as np
import pytest
import scaleaxis


def arms(points):
    """Three arms of radius 0.5 from the origin, 4, 3 and 3 long."""
    tips = np.array([[4.0, 0, 0], [-1.8, 2.4, 0], [-1.8, -2.4, 0]])
    distances = []
    for tip in tips:
        at = np.clip(points @ tip / (tip @ tip), 0, 1)
        distances.append(np.linalg.norm(points - at[:, None] * tip, axis=1))
    return np.min(distances, axis=0) - 0.5


BOUNDS = [[-3, -4, -1], [5, 4, 1]]


@pytest.fixture(scope="module")
def skeleton():
    return scaleaxis.skeleton(arms, bounds=BOUNDS, delta=0.01)


def test_nodes_branches_and_radii(skeleton):
    assert (len(skeleton.branches), len(skeleton.ends), len(skeleton.junctions)) == (3, 3, 1)
    assert sorted(skeleton.lengths) == pytest.approx([3, 3, 4], abs=0.45)  # the junction is not quite at the origin
    far = np.linalg.norm(skeleton.nodes, axis=1) > 1
    assert skeleton.radii[far] == pytest.approx(0.5, abs=0.02)
    assert skeleton.statistics["is_homotopic"] is True
    assert repr(skeleton) == f"Skeleton({len(skeleton.nodes)} nodes, 3 branches, 3 ends, 1 junctions)"
    parts = skeleton.node_branches[skeleton.nearest_nodes([[3, 0, 0.5], [-1.5, 2, 0.5], [-1.5, -2, 0.5]])]
    assert sorted(parts) == [0, 1, 2]
    with pytest.raises(ValueError, match="points"):
        skeleton.mesh_map


def test_options(skeleton):
    fine = scaleaxis.skeleton(arms, bounds=BOUNDS, delta=0.01, node_spacing=0.05, radius="mean")
    assert len(fine.nodes) > len(skeleton.nodes)
    assert scaleaxis.skeleton(arms, bounds=BOUNDS, delta=0.02, significance=50.0).nodes.shape == (1, 3)
    with pytest.raises(scaleaxis.InvalidOption, match="significance"):
        scaleaxis.skeleton(arms, bounds=BOUNDS, delta=0.02, significance=-1.0)


def test_of_an_axis_and_of_a_complex(skeleton):
    axis = skeleton.axis
    again = axis.skeleton()
    assert np.array_equal(again.nodes, scaleaxis.skeleton(axis).nodes)
    assert len(again.branches) == 3 and again.nodes.shape[1] == 3
    alone = scaleaxis.skeleton(axis.complex)
    assert len(alone.branches) == 3 and len(alone.vertex_nodes) == len(axis.vertices)
    with pytest.raises(ValueError, match="complex"):
        alone.nearest_nodes([[0, 0, 0]])
    with pytest.raises(scaleaxis.InvalidOption, match="mean"):
        scaleaxis.skeleton(axis.complex, radius="mean")


def test_parts_of_a_mesh(skeleton):
    mesh = skeleton.axis.mesh().mesh
    of_mesh = scaleaxis.skeleton(mesh, delta=0.02)
    assert len(of_mesh.mesh_map) == len(mesh.vertices)
    parts = of_mesh.node_branches[of_mesh.mesh_map]
    assert set(parts) == {0, 1, 2}
    assert len(set(parts[mesh.vertices[:, 0] > 1])) == 1


def test_files_and_graphs(skeleton, tmp_path):
    for name in ("s.swc", "s.graphml", "s.json", "s.vtp", "s.ply"):
        skeleton.save(tmp_path / name)
    rows = np.loadtxt(tmp_path / "s.swc")
    assert len(rows) == len(skeleton.nodes) and (rows[:, 6] < rows[:, 0]).all() and (rows[:, 6] == -1).sum() == 1
    graph = networkx.read_graphml(tmp_path / "s.graphml")
    assert (graph.number_of_nodes(), graph.number_of_edges()) == (len(skeleton.nodes), len(skeleton.edges))
    assert len(json.loads((tmp_path / "s.json").read_text())["branches"]) == 3
    assert len(scaleaxis.read_axis(tmp_path / "s.ply").vertices) == len(skeleton.nodes)
    graph = skeleton.to_networkx()
    assert graph.nodes[0]["radius"] == skeleton.radii[0]
    lengths = networkx.get_edge_attributes(graph, "length")
    assert sum(lengths.values()) == pytest.approx(skeleton.lengths.sum())
    with pytest.raises(scaleaxis.FileError):
        skeleton.save(tmp_path / "s.stl")


def test_measures(box):
    skeleton = scaleaxis.skeleton(box, delta=0.02)
    vertices, faces = box
    (row,) = skeleton.measures(vertices, faces)
    assert row["volume"] == pytest.approx(24) and row["area"] == pytest.approx(52)
    assert row["mean_thickness"] == pytest.approx(2, abs=0.05)
    assert (row["branches"], row["components"], row["tunnels"], row["voids"]) == (len(skeleton.branches), 1, 0, 0)
    assert len(skeleton.measures(vertices, faces, "components")) == 1
    (part,) = skeleton.measures(vertices, faces, "parts")  # that of the node alone
    assert (part["branches"], part["area"]) == (len(skeleton.branches), pytest.approx(52)) == (0, 52)
    with pytest.raises(ValueError, match="pieces"):
        skeleton.measures(vertices, faces, "rows")


def test_spacing_is_that_of_voxels():
    mask = np.zeros((30, 20, 20), dtype=bool)
    mask[3:27, 6:14, 6:14] = True
    known = scaleaxis.skeleton(scaleaxis.load(mask, spacing=0.5).solid)
    for spacing in (0.5, (0.5, 0.5, 0.5)):
        skeleton = scaleaxis.skeleton(mask, spacing=spacing)
        assert np.array_equal(skeleton.nodes, known.nodes)
        assert skeleton.radii.max() == pytest.approx(2.0, abs=0.1)
    assert len(scaleaxis.skeleton(mask, spacing=0.5, node_spacing=2.0).nodes) < 10 < len(known.nodes)


def test_the_axis_of_a_result_is_that_of_the_input(cat):
    mask = np.zeros((30, 20, 20), dtype=bool)
    mask[3:27, 6:14, 6:14] = True
    image = scaleaxis.Image(mask, [5.0, 6, 7], np.diag([2.0, 1, 1]), "mm")
    for call in (scaleaxis.skeleton, scaleaxis.midsurface):
        for given in (cat, image):
            known = scaleaxis.axis(given, delta=0.04)
            axis = call(given, delta=0.04).axis
            assert axis.name == known.name and axis.diagonal == known.diagonal
            assert axis.statistics["unit"] == known.statistics["unit"]
            np.testing.assert_array_equal(axis.transform, known.transform)
        of_mesh = call(cat, delta=0.04).axis
        np.testing.assert_array_equal(of_mesh.boundary.vertices, scaleaxis.read_mesh(cat).vertices)
        assert len(of_mesh.mesh_map) == len(of_mesh.boundary.vertices)
    skeleton = scaleaxis.skeleton(cat, delta=0.04)
    assert len(skeleton.measures(skeleton.axis.boundary)) == 1


def tube(sides=32, rings=21):
    """A pipe of radius 1 and length 10 along z, without its ends."""
    angles = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.column_stack([np.tile(circle, (rings, 1)), np.repeat(np.linspace(0, 10, rings), sides)])
    a = np.arange((rings - 1) * sides)
    b = a - a % sides + (a + 1) % sides
    return vertices, np.concatenate([np.column_stack([a, b, b + sides]), np.column_stack([a, b + sides, a + sides])])


@pytest.mark.filterwarnings("ignore::scaleaxis.Warning")  # that holes were closed
def test_curves_are_led_to_openings():
    short = scaleaxis.skeleton(tube(), delta=0.02)
    led = scaleaxis.skeleton(tube(), delta=0.02, to_openings=True)
    assert short.lengths == pytest.approx([8], abs=0.3) and led.lengths == pytest.approx([10], abs=0.01)
    ends = led.nodes[led.ends]
    np.testing.assert_allclose(ends[np.argsort(ends[:, 2])], [[0, 0, 0], [0, 0, 10]], atol=1e-9)
    steps = np.linalg.norm(np.diff(led.nodes[led.edges], axis=1), axis=2)
    assert steps.max() <= 0.0101 * led.axis.diagonal
    assert led.statistics["length"] == pytest.approx(led.lengths.sum())
    loaded = scaleaxis.load(tube())
    assert sorted(loaded.holes[:, 2]) == pytest.approx([0, 10])
    np.testing.assert_array_equal(scaleaxis.skeleton(loaded, delta=0.02, to_openings=True).nodes, led.nodes)


def test_openings_are_those_that_were_closed(box, skeleton):
    with pytest.raises(scaleaxis.InvalidOption, match="to_openings has no effect on solid, no hole of which was closed"):
        scaleaxis.skeleton(box, delta=0.05, to_openings=True)
    for known in (skeleton.axis, skeleton.axis.complex):
        with pytest.raises(scaleaxis.InvalidOption, match="to_openings has no effect on an axis"):
            scaleaxis.skeleton(known, to_openings=True)
