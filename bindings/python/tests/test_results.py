# SPDX-License-Identifier: Apache-2.0
"""What can be done with results."""

from __future__ import annotations

import base64
import copy
import html
import json
import pickle
import re
import subprocess
import sys
import zlib
from dataclasses import replace

import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh


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
    envelope = pickle.loads(pickle.dumps(scaleaxis.Envelope(axis)))
    np.testing.assert_array_equal(envelope.bounds, scaleaxis.Envelope(axis).bounds)
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
    assert scaleaxis.read_axis(tmp_path / name).scale == (axis.scale if name == "axis.ply" else 1.0)
    from_bytes = scaleaxis.read_axis((tmp_path / name).read_bytes(), name)
    assert np.array_equal(from_bytes.vertices, axis.vertices)


def test_ply_of_triangles_and_of_polygons(axis, tmp_path):
    axis.save(tmp_path / "triangles.ply")
    axis.save(tmp_path / "polygons.ply", polygons=True)
    text = (tmp_path / "triangles.ply").read_text()
    assert "property double erosion_thickness" in text and "element edge" not in text
    assert b"element edge" in (tmp_path / "polygons.ply").read_bytes()
    for name in ("triangles.ply", "polygons.ply"):
        read = scaleaxis.read_axis(tmp_path / name)
        assert np.array_equal(read.faces.indices, axis.polygons.indices)
        assert np.array_equal(read.edges, axis.edges)
        assert np.array_equal(read.face_sheets, axis.sheets)
    # Each vertex is a line behind the head: x, y, z, radius, erosion thickness.
    first = text[text.index("end_header\n") + 11 :].splitlines()[: len(axis.vertices)]
    written = [float(line.split()[4]) for line in first]
    thickness = scaleaxis.erosion_thickness(axis.complex).thickness
    assert np.array_equal(written, np.where(np.isfinite(thickness), thickness, -1.0))
    scaleaxis.write_axis(tmp_path / "own.ply", replace(axis.complex, scale=1.5))
    assert scaleaxis.read_axis((tmp_path / "own.ply").read_bytes()).scale == 1.5
    scaleaxis.write_axis(tmp_path / "own.vtp", axis, values={"twice": 2 * axis.radii})
    assert 'Name="twice"' in (tmp_path / "own.vtp").read_text()
    with pytest.raises(scaleaxis.InvalidOption, match="values 'twice'"):
        scaleaxis.write_axis(tmp_path / "own.ply", axis, values={"twice": [1.0]})


@pytest.fixture
def stored(axis, tmp_path):
    axis.save(tmp_path / "axis.ply")
    return tmp_path / "axis.ply"


def test_trimesh_reads_the_ply(axis, stored):
    import trimesh

    mesh = trimesh.load(stored, process=False)
    assert np.array_equal(mesh.vertices, axis.vertices)
    count = len(axis.triangles)
    assert np.array_equal(mesh.faces[:count], axis.triangles)
    assert np.array_equal(mesh.faces[count:, :2], axis.curves)  # as triangles (a, b, b)
    raw = mesh.metadata["_ply_raw"]
    assert np.array_equal(raw["vertex"]["data"]["radius"].ravel(), axis.radii)
    assert np.array_equal(raw["face"]["data"]["sheet"].ravel()[:count], axis.sheets[axis.polygons.triangulated()[1]])


def test_meshio_reads_the_ply(axis, stored):
    import meshio

    mesh = meshio.read(stored)
    assert np.array_equal(mesh.points, axis.vertices)
    assert np.array_equal(mesh.point_data["radius"], axis.radii)
    assert np.array_equal(mesh.cells_dict["triangle"][: len(axis.triangles)], axis.triangles)
    assert len(mesh.cell_data["sheet"][0]) == len(axis.triangles) + len(axis.curves)


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
    vti = (
        b'<VTKFile type="ImageData"><ImageData WholeExtent="0 2 0 1 0 1" Spacing="1 2 3"><Piece Extent="0 2 0 1 0 1">'
        b'<PointData Scalars="s"><DataArray type="UInt8" Name="s" format="ascii">'
        + " ".join(map(str, range(12))).encode()
        + b"</DataArray></PointData></Piece></ImageData></VTKFile>"
    )
    assert scaleaxis.read_image(vti).values[2, 1, 0] == 5
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
    mesh = axis.to_trimesh()
    assert np.array_equal(mesh.vertices, axis.vertices) and np.array_equal(mesh.faces, axis.triangles)
    assert np.array_equal(mesh.vertex_attributes["radius"], axis.radii)
    assert len(mesh.face_attributes["sheet"]) == len(axis.triangles)


def test_pyvista(axis, ring):
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
    import networkx

    graph = ring.to_networkx()
    assert graph.number_of_nodes() == len(ring.vertices) and graph.number_of_edges() == len(ring.edges)
    assert networkx.number_connected_components(graph) == 1
    first = graph.nodes[0]
    assert first["pos"] == tuple(ring.vertices[0]) and first["radius"] == ring.radii[0]
    a, b = ring.edges[0]
    assert graph.edges[a, b]["length"] == pytest.approx(np.linalg.norm(ring.vertices[a] - ring.vertices[b]))


def nearest_by_force(vertices, radii, points):
    """The first of the balls with the least signed distance; those on sharp edges, of radius 0, do not count."""
    radii = np.where(radii > 0.0, radii, -np.inf)
    return np.array([np.argmin(np.linalg.norm(vertices - p, axis=1) - radii) for p in points])


def test_mesh_map(axis, box, torus):
    for result, (vertices, _) in ((axis, box), (scaleaxis.axis(torus, delta=0.03), torus)):
        assert result.mesh_map.dtype == np.int32 and result.mesh_map.shape == (len(vertices),)
        assert np.array_equal(result.mesh_map, nearest_by_force(result.vertices, result.radii, vertices))
        assert result.mesh_map is result.mesh_map
    # Around a ring, the vertices of the mesh belong to those of the axis beside them.
    angle = [np.arctan2(places[:, 1], places[:, 0]) for places in (vertices, result.vertices[result.mesh_map])]
    assert np.abs(np.exp(1j * angle[0]) - np.exp(1j * angle[1])).max() < 0.2


def test_mesh_map_is_that_of_what_was_given(box, cat, tmp_path):
    vertices, faces = box
    doubled = np.concatenate([vertices, vertices[:2]]), faces  # two vertices of no face, which a repair removes
    with pytest.warns(scaleaxis.Warning):
        of_doubled = scaleaxis.axis(doubled, delta=0.05)
    assert len(of_doubled.mesh_map) == 10 and np.array_equal(of_doubled.mesh_map[8:], of_doubled.mesh_map[:2])
    of_file = scaleaxis.axis(cat, delta=0.05)
    assert len(of_file.mesh_map) == len(of_file.boundary.vertices)
    places = scaleaxis.axis(box, delta=0.03, keep_samples=True).samples.points
    of_points = scaleaxis.axis(places, points="crust")
    assert len(of_points.mesh_map) == len(places)
    again = pickle.loads(pickle.dumps(of_points))
    assert np.array_equal(again.mesh_map, of_points.mesh_map)
    of_mask = scaleaxis.axis(np.pad(np.ones((6, 6, 6), dtype=bool), 2), delta=0.05)
    with pytest.raises(ValueError, match="nearest_vertices"):
        _ = of_mask.mesh_map
    assert len(of_mask.nearest_vertices([[1, 2, 3], [4, 5, 6]])) == 2


def test_of_equal_balls_the_first_is_nearest():
    axis = scaleaxis.axis(np.array([[0, 0, 0, 1.0], [3, 0, 0, 1.0]]), delta=0.1, scale=1.0)
    first = np.sort(np.argsort(np.abs(np.linalg.norm(axis.vertices - [1.5, 0, 0], axis=1) - axis.radii - 0.5))[:2])[0]
    assert axis.nearest_vertices([[1.5, 0, 0]]).tolist() == [first]


def similarity(factor=2.5, mirror=False):
    """A turn about an odd axis, a factor, a shift."""
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn)) * (-1 if mirror else 1)
    return np.column_stack([factor * turn, [10.0, -20.0, 30.0]])


@pytest.mark.parametrize("mirror", [False, True])
def test_transformed(axis, mirror):
    matrix = similarity(mirror=mirror)
    moved = axis.transformed(matrix)

    def place(points):
        return points @ matrix[:, :3].T + matrix[:, 3]

    assert np.allclose(moved.vertices, place(axis.vertices)) and np.allclose(moved.radii, 2.5 * axis.radii)
    assert np.allclose(moved.balls[:, :3], place(axis.balls[:, :3]))
    assert np.allclose(moved.contacts, place(axis.contacts)) and np.allclose(moved.points, place(axis.points))
    # Balls still touch the boundary at their contacts, but for the slack of the fit.
    reach = np.linalg.norm(moved.ball_contacts - moved.balls[:, None, :3], axis=2)
    assert (np.abs(reach - moved.balls[:, 3:]) <= 0.01001 * moved.tolerance).all()
    assert np.array_equal(moved.mesh_map, axis.mesh_map) and moved.topology == axis.topology
    assert moved.tolerance == pytest.approx(2.5 * axis.tolerance)
    scaleaxis.check(moved.complex)
    solid = scaleaxis.mesh_solid(*moved.boundary)  # oriented outward, or it would warn
    assert not solid.warnings and solid.inside(moved.balls[:, :3]).all()
    again = np.sort(scaleaxis.inner_balls(moved.samples)[:, 3])
    assert np.allclose(again, 2.5 * np.sort(scaleaxis.inner_balls(axis.samples)[:, 3]))
    four = np.vstack([matrix, [0, 0, 0, 1]])
    assert np.array_equal(axis.transformed(four).vertices, moved.vertices)
    back = moved.transformed(np.linalg.inv(four))
    assert np.allclose(back.vertices, axis.vertices) and np.allclose(back.transform, np.eye(3, 4))
    union = scaleaxis.BallUnion(axis.balls).transformed(matrix)
    assert np.allclose(union.balls, moved.balls)


@pytest.mark.parametrize(
    ("matrix", "error", "message"),
    [
        (np.diag([1.0, 1.0, 2.0, 1.0]), scaleaxis.InvalidOption, "stretches by 2 in one direction and by 1 in"),
        (np.zeros((3, 4)), scaleaxis.InvalidOption, "stretches by 0"),
        (np.array([[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]), scaleaxis.InvalidOption, "ellipsoids"),
        (np.eye(3), ValueError, "3 × 4 or 4 × 4"),
        (np.full((3, 4), np.nan), ValueError, "finite"),
        (np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1.0]]), ValueError, "last row"),
    ],
)
def test_other_maps_are_refused(axis, matrix, error, message):
    for thing in (axis, axis.complex, scaleaxis.BallUnion(axis.balls), axis.samples):
        with pytest.raises(error, match=message):
            thing.transformed(matrix)


def test_transform_leads_from_voxels_to_places(axis):
    assert np.array_equal(axis.transform, np.eye(3, 4))
    mask = np.pad(np.ones((4, 6, 8), dtype=bool), 3)
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=float)
    of_mask = scaleaxis.axis(mask, spacing=[1, 2, 3], origin=[5, 6, 7], direction=turned, delta=0.05)
    expected = [[0, -2, 0, 5], [1, 0, 0, 6], [0, 0, 3, 7]]
    assert np.allclose(of_mask.transform, expected)
    middle = of_mask.transform @ [4.5, 5.5, 6.5, 1.0]
    ends = of_mask.balls[:, :3].min(axis=0) + of_mask.balls[:, :3].max(axis=0)
    assert ends / 2 == pytest.approx(middle, abs=0.6)
    moved = of_mask.transformed(np.column_stack([2 * np.eye(3), [1, 1, 1]]))
    assert np.allclose(moved.transform, 2 * np.array(expected) + [[0, 0, 0, 1]] * 3)


def test_pandas(axis, ring):
    import pandas

    for result in (axis, ring):
        vertices, sheets, statistics = result.to_pandas()
        assert np.array_equal(vertices[["x", "y", "z"]], result.vertices)
        assert np.array_equal(vertices["radius"], result.radii)
        assert len(sheets) == result.complex.sheets and sheets["polygons"].sum() == len(result.polygons)
        # By hand, one after the other.
        for sheet in range(len(sheets)):
            members = [polygon for i, polygon in enumerate(result.polygons) if result.sheets[i] == sheet]
            radii = result.radii[np.unique(np.concatenate(members))]
            assert sheets["radius_min"][sheet] == radii.min() and sheets["radius_max"][sheet] == radii.max()
            assert sheets["radius_mean"][sheet] == pytest.approx(radii.mean())
            assert sheets["angle"][sheet] == result.angles[result.sheets == sheet].max()
        for vertex in range(0, len(vertices), 37):
            beside = [i for i, polygon in enumerate(result.polygons) if vertex in polygon]
            assert vertices["sheets"][vertex] == len(set(result.sheets[beside]))
            expected = max(result.angles[beside], default=np.nan)
            assert vertices["angle"][vertex] == pytest.approx(expected, nan_ok=True)
        assert len(statistics) == 1 and statistics["axis.result.sheets"][0] == len(sheets)
    if len(axis.curves) == 0:
        areas = axis.to_pyvista().compute_cell_sizes()["Area"]
        by_sheet = pandas.Series(areas).groupby(axis.sheets).sum()
        assert np.allclose(axis.to_pandas().sheets["area"], by_sheet, rtol=1e-3)


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


def model_of(page):
    """The header of the model on a page: docs/dev/viewer.md."""
    (data,) = re.findall(r'<script type="application/x-scaleaxis">([^<]*)</script>', page.html)
    content = zlib.decompress(base64.b64decode(data))
    return json.loads(content[12 : 12 + int.from_bytes(content[8:12], "little")])


def test_view_of_other_results(box, tmp_path):
    axis = scaleaxis.axis(box, delta=0.05, scale=1.0)
    vertices, triangles = axis.boundary

    nested = scaleaxis.filtration(axis)
    page = nested.view(tmp_path / "nested.html", shape=axis.boundary, name="a box")
    model = model_of(page)
    assert "a box" in page.html and model["shape"]["points"][0]["count"] == len(vertices)
    levels, plateau = nested.profile()
    scales = model["axes"][0]["scales"]
    assert scales["plateau"] == [plateau.begin, plateau.middle, plateau.end]
    shown = [(level.scale, level.sheets, level.balls, level.area, level.curve_length, level.volume) for level in levels]
    assert scales["levels"] == [list(level) for level in shown]
    assert model_of(nested.view(tmp_path / "nested.html"))["shape"] is None

    curves = scaleaxis.skeleton(axis)
    model = model_of(curves.view(tmp_path / "curves.html"))
    assert model["axes"][0]["curves"]["count"] == 2 * len(curves.edges) and model["shape"]
    assert model["statistics"]["branches"] == len(curves.branches)
    assert model_of(scaleaxis.skeleton(axis.complex).view(tmp_path / "curves.html"))["shape"] is None

    vertices, triangles = scaleaxis.with_short_edges((vertices, triangles), 0.1)
    found = scaleaxis.thickness(axis, vertices)
    model = model_of(found.view(vertices, triangles, tmp_path / "thickness.html", limit=0.5, axis=axis))
    assert model["thickness"]["largest"] == max(found.local.max(), found.foot.max())
    assert model["thickness"]["limit"] == 0.5 and model["thickness"]["regions"]["count"] == len(vertices)
    assert len(model["axes"]) == 1 and model["axes"][0]["scale"] == 1.0
    plain = found.view(vertices, triangles)
    try:
        assert model_of(plain)["thickness"]["regions"] is None and not model_of(plain)["axes"]
    finally:
        plain.path.unlink()
    with pytest.raises(ValueError, match="thickness"):
        found.view(vertices[:4], [[0, 1, 2]], tmp_path / "thickness.html")
    with pytest.raises(scaleaxis.FileError):
        nested.view(tmp_path / "nested.txt")


def test_other_packages_are_imported_only_when_asked_for():
    others = "trimesh pyvista networkx pandas nibabel SimpleITK tqdm scipy matplotlib IPython"
    code = f"import sys, scaleaxis; print([m for m in '{others}'.split() if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_objects_of_other_packages_are_copies(box):
    vertices = np.array(box[0])
    axis = scaleaxis.axis((vertices, box[1]), delta=0.05)
    before = pickle.dumps(axis)
    surface = axis.to_pyvista()
    surface.points += 100
    surface["radius"] *= 2
    surface.cell_data["sheet"] += 1
    mesh = axis.to_trimesh()
    mesh.vertices += 1
    mesh.vertex_attributes["radius"][:] = 0
    mesh.face_attributes["angle"][:] = 0
    for table in axis.to_pandas():
        for column in table.columns:
            if table[column].dtype.kind == "f":
                table[column].to_numpy(copy=False).setflags(write=True)
                table.loc[:, column] = 0.0
    vertices += 5  # of the user
    assert pickle.dumps(axis) == before


def test_slices_of_polygons(box):
    polygons = scaleaxis.axis(box, delta=0.05).polygons
    part = polygons[1:7:2]
    assert len(part) == 3
    for one, known in zip(part, [polygons[1], polygons[3], polygons[5]]):
        assert one.tolist() == known.tolist()
    assert len(polygons[:0]) == 0 and len(polygons[:]) == len(polygons)


def test_areas_of_thin_regions_of_long_triangles():
    """A block 10 long whose height grows from 0.5 to 1.5: what is thinner than 1 is its lower half."""
    corners = [[x, y, z] for x, height in ((0, 0.5), (10, 1.5)) for y in (0, 4) for z in (0, height)]
    corners, faces = np.array(corners, dtype=float), box_mesh()[1]
    axis = scaleaxis.axis((corners, faces), delta=0.02)
    with pytest.warns(scaleaxis.Warning, match="with_short_edges") as told:
        scaleaxis.thin_regions(corners, faces, axis.thickness(corners).local, 1.0)
    assert told[0].message.code == "surface.long_edges"
    fine = scaleaxis.with_short_edges((corners, faces), 0.2)
    assert np.array_equal(fine.vertices[:8], corners)
    sides = fine.vertices[fine.triangles] - np.roll(fine.vertices[fine.triangles], 1, axis=1)
    assert np.linalg.norm(sides, axis=2).max() <= 0.2
    thin = scaleaxis.thin_regions(*fine, axis.thickness(fine.vertices).local, 1.0)
    # Top and bottom, two sides, one end.
    assert thin.areas.sum() == pytest.approx(2 * 4 * 5 + 2 * 0.75 * 5 + 4 * 0.5, rel=0.05)
    for of_mesh in (axis.thickness(), axis.thickness((corners, faces)), scaleaxis.thickness(axis, axis.boundary)):
        assert of_mesh.thin_regions(1.0).areas.sum() == pytest.approx(thin.areas.sum(), rel=0.01)
        assert np.array_equal(of_mesh.surface.vertices[:8], corners) and len(of_mesh.local) > 100
    assert len(axis.thickness((corners, faces), edge=0).local) == 8
    assert axis.thickness().view(limit=1.0).path.exists()
    of_balls = scaleaxis.axis(lambda p: np.linalg.norm(p, axis=1) - 1, 0.05, bounds=[[-1.1] * 3, [1.1] * 3]).thickness()
    assert np.median(of_balls.local) == pytest.approx(2, abs=0.05)
    with pytest.raises(ValueError, match="vertices and triangles of the surface are needed"):
        axis.thickness(corners).thin_regions(1.0)
    with pytest.raises(ValueError, match="points"):
        scaleaxis.thickness(axis.complex)


def test_names_of_files():
    from scaleaxis.pipeline import name_of

    assert [name_of(name) for name in ("a/cat.obj", "v.nii.gz", "x.y.stl")] == ["cat", "v", "x.y"]
