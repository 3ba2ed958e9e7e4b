# SPDX-License-Identifier: Apache-2.0
"""Results in other packages, and as pictures; what PyVista finds by itself."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import scaleaxis
from conftest import ball_mesh


@pytest.fixture(scope="module")
def axis(box):
    return scaleaxis.axis(box, delta=0.04)


@pytest.fixture(scope="module")
def ring(torus):
    return scaleaxis.skeleton(torus, delta=0.03)


def test_skeleton_in_pyvista(ring):
    data = ring.to_pyvista()
    assert data.n_points == len(ring.nodes) and data.n_lines == len(ring.edges)
    assert np.array_equal(data.point_data["radius"], ring.radii)
    assert data.length and data.compute_cell_sizes()["Length"].sum() == pytest.approx(4 * np.pi, rel=0.01)


def test_osteoid(ring, axis):
    skeleton = ring.to_osteoid()
    assert skeleton.space == "physical" and skeleton.vertices.dtype == np.float32
    assert skeleton.cable_length() == pytest.approx(ring.lengths.sum(), rel=1e-5)
    assert np.array_equal(skeleton.radius, ring.radii.astype(np.float32))
    assert len(axis.to_osteoid().edges) == len(axis.edges)


def test_osteoid_knows_the_way_to_voxels():
    i, j, k = np.indices((60, 12, 12))
    rod = (np.hypot(j - 5.5, k - 5.5) < 4) & (i > 2) & (i < 57)
    skeleton = scaleaxis.skeleton(rod, spacing=0.5, origin=(10, 20, 30), delta=0.05).to_osteoid()
    transform = skeleton.transform
    voxels = np.linalg.solve(transform[:, :3], (skeleton.vertices - transform[:, 3]).T).T
    assert np.abs(voxels[:, 1:] - 5.5).max() < 0.3 and voxels[:, 0].min() > 2 and voxels[:, 0].max() < 57


def test_midsurface_in_other_packages():
    plate = np.zeros((24, 24, 8), dtype=bool)
    plate[2:-2, 2:-2, 3:5] = True
    middle = scaleaxis.midsurface(plate, delta=0.02, extend=False)
    data, mesh = middle.to_pyvista(), middle.to_trimesh()
    assert len(middle.triangles) > 0 and data.n_cells == len(mesh.faces) == len(middle.triangles)
    assert data.area == pytest.approx(mesh.area) == pytest.approx(middle.areas.sum())
    assert np.array_equal(data.point_data["thickness"], mesh.vertex_attributes["thickness"])


def test_tables_for_notebooks(axis, ring):
    text = axis._repr_html_()
    assert text.startswith("<table>") and f'<td style="text-align: left">{len(axis.vertices):,}</td>' in text
    assert f"{axis.complex.sheets} sheets" in text and "1 components, 0 tunnels, 0 voids" in text
    named = scaleaxis.Axis(**{**axis.__dict__, "name": "<a & b>", "warnings": [scaleaxis.Warning("odd <one>")]})
    assert "&lt;a &amp; b&gt;" in named._repr_html_() and "odd &lt;one&gt;" in named._repr_html_()
    assert f"{ring.lengths.sum():.4g}" in ring._repr_html_()
    middle = scaleaxis.midsurface(axis, angle=80)
    assert f"{len(middle.triangles):,} in" in middle._repr_html_()


def test_parts_of_plots(axis, ring):
    import pyvista

    plotter = pyvista.Plotter(off_screen=True)
    assert axis.plot(plotter=plotter, scalars="sheet") is plotter
    assert len(plotter.meshes) == 2 and plotter.meshes[0].n_cells == len(axis.boundary.triangles)
    ring.plot(plotter=plotter, shape=False)
    assert len(plotter.meshes) == 3 and plotter.meshes[2].n_lines == len(ring.edges)
    plotter.close()


PICTURE = """
import sys
import pyvista, scaleaxis
pyvista.OFF_SCREEN = True
axis = scaleaxis.axis(sys.argv[1], delta=0.05)
plotter = axis.plot(plotter=pyvista.Plotter())
picture = plotter.screenshot(return_img=True)
print(len({tuple(pixel) for pixel in picture.reshape(-1, 3).tolist()}))
"""


def test_picture_is_drawn(cat, monkeypatch):
    if sys.platform == "linux":  # without a screen
        monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    drawn = subprocess.run([sys.executable, "-c", PICTURE, cat], capture_output=True, text=True, check=True)
    assert int(drawn.stdout.split()[-1]) > 1000  # colours


# A process of its own, which knows PyVista alone.
FOUND = """
import sys
import pyvista
assert "scaleaxis" not in sys.modules
ball = pyvista.Icosphere(radius=2.0, nsub=4)
assert "scaleaxis" in dir(ball)
axis = ball.scaleaxis.axis(delta=0.05)
assert abs(axis["radius"].max() - 2.0) < 0.02
print("found")
"""


def test_accessor_is_found_by_pyvista():
    run = subprocess.run([sys.executable, "-c", FOUND], capture_output=True, text=True, check=True)
    assert run.stdout == "found\n"


def test_accessor(torus, ring):
    import pyvista

    data = pyvista.PolyData.from_regular_faces(*torus)
    curve = data.scaleaxis.skeleton(delta=0.03)
    assert np.array_equal(curve.points, ring.nodes)
    surface = data.scaleaxis.thickness(delta=0.03, edge=0.0)
    assert np.array_equal(surface.points, torus[0])
    assert np.abs(surface["thickness"] - 1.0).max() < 0.03 and np.abs(surface["foot_thickness"] - 1.0).max() < 0.03
    with pytest.raises(ValueError, match="one scale"):
        data.scaleaxis.axis(delta=0.05, scale=[1.0, 1.1])
    with pytest.raises(TypeError, match="delta"):
        data.scaleaxis.axis(detla=0.05)


@pytest.mark.parametrize("of_cells", [False, True])
def test_image_of_pyvista_is_voxels(of_cells):
    import pyvista

    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    size = np.array([20, 24, 28])
    grid = pyvista.ImageData(
        dimensions=size + of_cells, spacing=(0.5, 0.4, 0.3), origin=(1, 2, 3), direction_matrix=turn
    )
    grid.extent = grid.extent + np.repeat([5, -3, 7], 2)  # as of a part that extract_subset has cut out
    places = (grid.cell_centers() if of_cells else grid).points
    middle = places.mean(axis=0)
    values = (np.linalg.norm(places - middle, axis=1) < 3.0).astype(np.uint8)
    (grid.cell_data if of_cells else grid.point_data)["label"] = values
    grid.set_active_scalars("label")
    axis = grid.scaleaxis.axis(delta=0.03)
    largest = axis["radius"].argmax()
    assert axis["radius"][largest] == pytest.approx(3.0, abs=0.25)  # half a voxel
    assert np.linalg.norm(axis.points[largest] - middle) < 0.25


def test_ma_files_are_read_by_pyvista(axis, tmp_path):
    import pyvista

    axis.save(tmp_path / "box.ma")
    read = pyvista.read(tmp_path / "box.ma")
    known = scaleaxis.read_axis(tmp_path / "box.ma").to_pyvista()
    assert read == known and read.n_points == len(axis.vertices)
    assert np.array_equal(read["radius"], axis.radii)


# Delaunay triangulations and nearest points.


def volumes(points, tetrahedra):
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def test_delaunay_of_random_points_is_that_of_qhull():
    from scipy.spatial import ConvexHull
    from scipy.spatial import Delaunay as Qhull

    points = np.random.default_rng(1).random((2000, 3))
    tetrahedra, neighbors = scaleaxis.delaunay(points)
    assert tetrahedra.dtype == neighbors.dtype == np.int32
    assert {tuple(row) for row in np.sort(tetrahedra)} == {tuple(row) for row in np.sort(Qhull(points).simplices)}
    found = volumes(points, tetrahedra)
    assert found.min() > 0 and found.sum() == pytest.approx(ConvexHull(points).volume)
    for t, k in zip(*np.nonzero(neighbors >= 0)):
        assert set(np.delete(tetrahedra[t], k)) < set(tetrahedra[neighbors[t, k]])
    assert (neighbors == -1).sum() == len(ConvexHull(points).simplices)
    again = scaleaxis.delaunay(np.asfortranarray(points), threads=1)
    assert np.array_equal(again.tetrahedra, tetrahedra) and np.array_equal(again.neighbors, neighbors)


def test_weighted_delaunay_hides_balls():
    points = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [1, 1, 1], [4, 0, 0]], dtype=float)
    plain = scaleaxis.delaunay(points)
    assert len(plain.tetrahedra) == 4 and np.setdiff1d(np.arange(6), plain.tetrahedra).tolist() == [5]
    weighted = scaleaxis.delaunay(points, [8, 8, 8, 8, -1, 9])
    assert weighted.tetrahedra.tolist() == [[0, 2, 3, 5]] and weighted.neighbors.tolist() == [[-1] * 4]
    assert len(scaleaxis.delaunay(points, 3).tetrahedra) == 4  # one weight for all


def test_delaunay_of_grids_and_flat_sets():
    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3), axis=-1).reshape(-1, 3)
    found = volumes(grid, scaleaxis.delaunay(grid).tetrahedra)
    assert found.min() > 0 and found.sum() == pytest.approx(125)
    assert scaleaxis.delaunay(grid[grid[:, 2] == 0]).tetrahedra.shape == (0, 4)
    assert scaleaxis.delaunay([]).tetrahedra.shape == (0, 4)


def test_delaunay_refuses(torus):
    with pytest.raises(ValueError, match="row 1"):
        scaleaxis.delaunay([[0, 0, 0], [np.nan, 0, 0]])
    with pytest.raises(ValueError, match="N × 3"):
        scaleaxis.delaunay([[0, 0]])
    with pytest.raises(ValueError, match="4 entries"):
        scaleaxis.delaunay(np.eye(4)[:, :3], [1, 2, 3])
    with pytest.raises(scaleaxis.UnusableInput, match="point 0") as error:
        scaleaxis.delaunay([[1e70, 0, 0]])
    assert error.value.element == "point" and error.value.index == 0


def test_nearest_is_that_of_all_triangles(torus):
    import trimesh

    points = np.random.default_rng(2).uniform(-3, 3, (100, 3))
    near = scaleaxis.nearest(torus, points)
    for i, p in enumerate(points):
        places = trimesh.triangles.closest_point(torus[0][torus[1]], np.tile(p, (len(torus[1]), 1)))
        distances = np.linalg.norm(places - p, axis=1)
        assert near.distances[i] == pytest.approx(distances.min())
        assert distances[near.triangles[i]] == pytest.approx(distances.min())
        assert np.linalg.norm(near.points[i] - p) == pytest.approx(distances.min())
    corners = torus[0][torus[1][near.triangles]]  # the point lies in that triangle
    weights = np.linalg.solve(corners.transpose(0, 2, 1), near.points[:, :, None])[:, :, 0]
    assert weights.min() > -1e-9 and np.allclose(weights.sum(axis=1), 1)
    assert near.triangles.dtype == np.int32
    again = scaleaxis.nearest(torus, points[::-1], threads=1)
    assert np.array_equal(again.triangles[::-1], near.triangles) and np.array_equal(again.points[::-1], near.points)


def test_nearest_of_meshes_in_other_forms(cat):
    mesh = scaleaxis.read_mesh(cat)
    centers = mesh.vertices[mesh.triangles].mean(axis=1)
    near = scaleaxis.nearest(cat, centers)
    assert near.distances.max() < 1e-9 and np.array_equal(near.triangles, np.arange(len(mesh.triangles)))
    one = scaleaxis.nearest(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), [[0.25, 0.25, 2], [-1, 0, 0]])
    assert one.distances.tolist() == [2, 1] and one.points.tolist() == [[0.25, 0.25, 0], [0, 0, 0]]
    assert len(scaleaxis.nearest(ball_mesh(), np.empty((0, 3))).distances) == 0
    with pytest.raises(ValueError, match="empty"):
        scaleaxis.nearest((np.eye(3), np.empty((0, 3), dtype=int)), [[0, 0, 0]])
    with pytest.raises(ValueError, match="finite"):
        scaleaxis.nearest(cat, [[0, 0, np.inf]])
