# SPDX-License-Identifier: Apache-2.0
"""What can be done with results."""

from __future__ import annotations

import copy
import html
import pickle
import subprocess
import sys

import numpy as np
import pytest
import scaleaxis


@pytest.fixture(scope="module")
def axis(box):
    return scaleaxis.axis(box, delta=0.04, keep_samples=True)


@pytest.fixture(scope="module")
def ring(torus):
    return scaleaxis.axis(torus, delta=0.02, scale=1.3)


def test_arrays(axis):
    count = len(axis.polygons)
    assert axis.vertices.shape == (len(axis.radii), 3)
    assert axis.sheets.shape == axis.angles.shape == (count,)
    assert axis.contacts.shape == (count, 2, 3)
    assert axis.ball_contacts.shape == (len(axis.balls), 2, 3)
    assert axis.sheets.max() == axis.complex.sheets - 1
    assert 0 < axis.angles.min() and axis.angles.max() <= 90
    assert len(axis.triangles) == (axis.polygons.sizes - 2).sum()
    assert {tuple(sorted(edge)) for edge in axis.triangles[:, :2].tolist()} & set(map(tuple, axis.edges.tolist()))
    assert axis.samples.tolerance == axis.tolerance
    assert axis.topology == scaleaxis.topology(axis.complex)


def test_repr(axis):
    assert repr(axis).startswith("Axis(s = 1.1 of solid: ")
    assert f"{len(axis.vertices):,} vertices" in repr(axis) and "balls" in repr(axis)
    assert f"{len(axis.vertices):,} vertices" in repr(axis.complex)


def same(a, b):
    assert np.array_equal(a.vertices, b.vertices) and np.array_equal(a.polygons.indices, b.polygons.indices)
    assert a.statistics == b.statistics and str(a.warnings) == str(b.warnings)
    assert np.array_equal(a.contacts, b.contacts) and repr(a) == repr(b)
    assert np.array_equal(a.samples.inside, b.samples.inside)
    return True


def test_pickle_and_copy(axis):
    assert same(axis, pickle.loads(pickle.dumps(axis)))
    assert same(axis, copy.deepcopy(axis))
    union = pickle.loads(pickle.dumps(scaleaxis.BallUnion(axis.balls)))
    assert np.array_equal(union.balls, axis.balls)
    again = pickle.loads(pickle.dumps(axis))  # and it can be used
    assert len(scaleaxis.filter(again.complex, 60).complex.faces) <= len(again.polygons)
    assert np.array_equal(scaleaxis.inner_balls(again.samples), scaleaxis.inner_balls(axis.samples))


@pytest.mark.parametrize("name", ["axis.ply", "axis.ma"])
def test_save_and_read(axis, tmp_path, name):
    axis.save(tmp_path / name)
    read = scaleaxis.read_axis(tmp_path / name)
    assert np.array_equal(read.vertices, axis.vertices) and np.array_equal(read.radii, axis.radii)
    assert scaleaxis.file_kind(tmp_path / name) == "axis"
    from_bytes = scaleaxis.read_axis((tmp_path / name).read_bytes(), name)
    assert np.array_equal(from_bytes.vertices, axis.vertices)


@pytest.mark.parametrize("name", ["axis.vtp", "axis.obj", "axis.glb"])
def test_save(axis, tmp_path, name):
    axis.save(str(tmp_path / name))
    assert (tmp_path / name).stat().st_size > 10_000


def test_files_of_other_kinds(axis, box, tmp_path):
    scaleaxis.write_balls(tmp_path / "balls.ply", axis.balls)
    assert np.array_equal(scaleaxis.read_balls(tmp_path / "balls.ply"), axis.balls)
    scaleaxis.write_mesh(tmp_path / "box.off", box)
    read = scaleaxis.read_mesh(tmp_path / "box.off")
    assert np.array_equal(read.vertices, box[0]) and np.array_equal(read.triangles, box[1])
    cloud = scaleaxis.read_points(b"0 0 0 0 0 1\n1 2 3 1 0 0\n", "points.xyz")
    assert cloud.points.tolist() == [[0, 0, 0], [1, 2, 3]] and cloud.normals.tolist() == [[0, 0, 1], [1, 0, 0]]
    field = scaleaxis.sample_field(axis.complex, 16)
    scaleaxis.write_image(tmp_path / "field.nrrd", field)
    data = (tmp_path / "field.nrrd").read_bytes()
    assert data.startswith(b"NRRD")
    values = np.frombuffer(data, "<f4", field.values.size, len(data) - 4 * field.values.size)
    assert np.array_equal(values.reshape(field.values.shape, order="F"), field.values)
    vol = b"X: 3\nY: 2\nZ: 2\nVersion: 2\n.\n" + bytes(range(12))
    assert scaleaxis.read_image(vol, "a.vol").values[2, 1, 0] == 5
    for check, name in [
        (scaleaxis.check_balls_output, "a.ply"),
        (scaleaxis.check_mesh_output, "a.stl"),
        (scaleaxis.check_axis_output, "a.glb"),
        (scaleaxis.check_image_output, "a.nrrd"),
    ]:
        check(tmp_path / name)
        with pytest.raises(scaleaxis.FileError):
            check(tmp_path / "a.docx")
    scaleaxis.write_axis(tmp_path / "a.ma", axis)
    assert (tmp_path / "a.ma").exists()


def test_mesh_of_the_simplified_solid(axis):
    mesh = axis.mesh()
    assert mesh.statistics["mesh"]["genus"] == 0
    volume = (
        np.einsum(
            "ij,ij->i",
            mesh.vertices[mesh.triangles[:, 0]],
            np.cross(mesh.vertices[mesh.triangles[:, 1]], mesh.vertices[mesh.triangles[:, 2]]),
        ).sum()
        / 6
    )
    assert volume == pytest.approx(2 * 3 * 4, rel=0.1)  # sharp edges are cut
    assert len(axis.mesh(delta_abs=axis.tolerance * 2).vertices) < len(mesh.vertices)
    assert len(axis.densified().vertices) >= len(axis.vertices)


def test_trimesh(axis):
    pytest.importorskip("trimesh")
    mesh = axis.to_trimesh()
    assert np.array_equal(mesh.vertices, axis.vertices) and np.array_equal(mesh.faces, axis.triangles)
    assert np.array_equal(mesh.vertex_attributes["radius"], axis.radii)
    assert len(mesh.face_attributes["sheet"]) == len(axis.triangles)


def test_pyvista(axis, ring):
    pytest.importorskip("pyvista")
    data = axis.to_pyvista()
    assert data.n_points == len(axis.vertices) and data.n_cells == len(axis.polygons) + len(axis.curves)
    assert np.array_equal(data.point_data["radius"], axis.radii)
    assert data.get_cell(len(axis.curves)).point_ids == axis.polygons[0].tolist()
    assert data.cell_data["sheet"][len(axis.curves)] == axis.sheets[0]
    only_curves = scaleaxis.axis(np.array([[0, 0, 0, 1.0], [1.2, 0, 0, 0.8]]), delta=0.05, scale=1.0)
    line = only_curves.to_pyvista()
    assert line.n_cells == len(only_curves.curves) + len(only_curves.polygons)
    assert ring.to_pyvista().n_points == len(ring.vertices)


def test_networkx(ring):
    networkx = pytest.importorskip("networkx")
    graph = ring.to_networkx()
    assert graph.number_of_nodes() == len(ring.vertices) and graph.number_of_edges() == len(ring.edges)
    assert networkx.number_connected_components(graph) == 1
    first = graph.nodes[0]
    assert first["pos"] == tuple(ring.vertices[0]) and first["radius"] == ring.radii[0]
    a, b = ring.edges[0]
    assert graph.edges[a, b]["length"] == pytest.approx(np.linalg.norm(ring.vertices[a] - ring.vertices[b]))


def test_view(axis, box, tmp_path):
    page = axis.view(tmp_path / "box.html")
    assert page.path == tmp_path / "box.html" and page.html.lstrip().lower().startswith("<!doctype html")
    inline = page._repr_html_()
    assert inline.startswith("<iframe") and html.unescape(inline).count(page.html) == 1
    axes = scaleaxis.axis(box, delta=0.05, scale=[1.0, 1.2])
    scales = scaleaxis.view(axes, tmp_path / "scales.html", title="Two scales of a box")
    assert "Two scales of a box" in scales.html
    assert len(scaleaxis.view([*axes, axis], tmp_path / "all.html").html) > len(scales.html)
    points = scaleaxis.axis(scaleaxis.union_solid([[0, 0, 0, 1.0]]), delta=0.1).view()
    try:
        assert points.path.suffix == ".html" and points.path.exists()
    finally:
        points.path.unlink()
    with pytest.raises(scaleaxis.FileError):
        axis.view(tmp_path / "box.txt")
    with pytest.raises(ValueError, match="no axis"):
        scaleaxis.view([])


def test_other_packages_are_imported_only_when_asked_for():
    others = "trimesh pyvista networkx pandas nibabel SimpleITK tqdm scipy matplotlib IPython"
    code = f"import sys, scaleaxis; print([m for m in '{others}'.split() if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
