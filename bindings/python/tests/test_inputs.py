# SPDX-License-Identifier: Apache-2.0
"""Everything that can be a solid."""

from __future__ import annotations

import json
import subprocess
import threading
import warnings
import zipfile

import numpy as np
import pytest
import scaleaxis
from conftest import ball_mesh, distance_to_ring


def ball_voxels(radius=10.0, n=28, spacing=(1.0, 1.0, 1.0)):
    """Signed distances, negative outside, to a ball in the middle."""
    places = np.indices((n, n, n)).reshape(3, -1).T * spacing
    middle = np.array(spacing) * (n - 1) / 2
    return (radius - np.linalg.norm(places - middle, axis=1)).reshape(n, n, n), middle


def is_axis_of_ball(axis, middle, radius, tolerance):
    assert axis.radii.max() == pytest.approx(radius, abs=tolerance)
    assert axis.vertices[axis.radii.argmax()] == pytest.approx(middle, abs=tolerance)
    return True


def test_path_text_and_arrays_agree(cat):
    mesh = scaleaxis.read_mesh(cat)
    expected = scaleaxis.axis(cat, delta=0.03)
    for solid in (str(cat), mesh, (mesh.vertices.tolist(), mesh.triangles.tolist()), list(mesh)):
        assert np.array_equal(scaleaxis.axis(solid, delta=0.03).vertices, expected.vertices)
    assert expected.name == "cat"


def test_objects_with_vertices_and_faces(ball):
    class Mesh:
        vertices, faces = ball

    assert is_axis_of_ball(scaleaxis.axis(Mesh(), delta=0.03), [0, 0, 0], 1.0, 0.02)


def test_quads_are_cut():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    axis = scaleaxis.axis((corners, quads), delta=0.03)
    assert axis.radii.max() == pytest.approx(0.5, abs=0.01)


def test_triangles_that_bound_no_solid(ball):
    vertices, faces = ball
    with pytest.warns(scaleaxis.Warning, match="hole closed"):
        holed = scaleaxis.load((vertices, faces[1:]))
    assert holed.report["method"]["name"] == "winding" and len(holed.report["holes"]) == 1
    assert len(holed.mesh.triangles) == len(faces)

    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float), np.array([[0, 1, 2], [0, 2, 3]])
    with pytest.raises(scaleaxis.UnusableInput, match="no inside"):
        scaleaxis.load(square)
    thick = scaleaxis.load(square, triangles="thicken", thickness=0.2)
    assert thick.report["method"]["name"] == "thicken"
    assert thick.solid.inside([[0.5, 0.5, 0.09], [0.5, 0.5, 0.11]]).tolist() == [True, False]

    wrap = scaleaxis.load((vertices, faces[1:]), triangles="wrap", opening=0.5)
    assert wrap.solid.inside([[0, 0, 0], [0, 0, 1.1]]).tolist() == [True, False]
    for options in ({"triangles": "wrap"}, {"opening": 0.5}, {"triangles": "thicken", "thickness": -1.0}):
        with pytest.raises(scaleaxis.InvalidOption):
            scaleaxis.load(square, **options)
    with pytest.raises(scaleaxis.InvalidOption, match="triangles"):
        scaleaxis.load(np.array([[0, 0, 0, 1.0]]), triangles="wrap", opening=1)


def test_trimesh(torus):
    import trimesh

    axis = scaleaxis.axis(trimesh.Trimesh(*torus, process=False), delta=0.02)
    assert np.array_equal(axis.vertices, scaleaxis.axis(torus, delta=0.02).vertices)


def test_pyvista(torus):
    import pyvista

    data = pyvista.PolyData.from_regular_faces(*torus)
    expected = scaleaxis.axis(torus, delta=0.02)
    assert np.array_equal(scaleaxis.axis(data, delta=0.02).vertices, expected.vertices)
    cube = pyvista.Cube()  # of quads
    assert scaleaxis.axis(cube, delta=0.03).radii.max() == pytest.approx(0.5, abs=0.01)
    grid = pyvista.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid()
    assert scaleaxis.axis(grid, delta=0.03).radii.max() == pytest.approx(1.5, abs=0.01)


def test_level_of_voxels():
    values, middle = ball_voxels()
    axis = scaleaxis.axis(values, delta=0.03, iso=0.0)
    assert is_axis_of_ball(axis, middle, 10.0, 0.3)
    below = scaleaxis.axis(-values, delta=0.03, iso=0.0, below=True)
    assert is_axis_of_ball(below, middle, 10.0, 0.3)


def test_mask_with_spacing_origin_and_direction():
    spacing = np.array([0.5, 1.0, 2.0])
    values, middle = ball_voxels(6.0, 28, spacing)
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=float)
    origin = np.array([5.0, 6.0, 7.0])
    options = {"spacing": spacing, "origin": origin, "direction": turned}
    axis = scaleaxis.axis(values > 0, delta=0.03, **options)
    assert is_axis_of_ball(axis, origin + turned @ middle, 6.0, 0.5)
    labels = (values > 0) * 3 + (values > 4) * 4
    assert is_axis_of_ball(
        scaleaxis.axis(labels, delta=0.03, labels=[3, 7], **options), origin + turned @ middle, 6.0, 0.5
    )
    inner = scaleaxis.axis(labels, delta=0.03, labels=7, **options)
    assert inner.radii.max() < 3.0
    with pytest.raises(scaleaxis.InvalidOption, match="what of the image is solid"):
        scaleaxis.axis(labels, delta=0.03, **options)
    assert is_axis_of_ball(
        scaleaxis.axis(labels, delta=0.03, nonzero=True, **options), origin + turned @ middle, 6.0, 0.5
    )


def test_layout_of_voxels_does_not_matter():
    values, _ = ball_voxels(5.0, 16)
    values[:8] += 0.3  # no symmetry
    expected = scaleaxis.axis(values.astype(np.float32), delta=0.04, iso=0.0).vertices
    for other in (np.asfortranarray(values.astype(np.float32)), values.astype(np.float32)[::-1][::-1]):
        assert np.array_equal(scaleaxis.axis(other, delta=0.04, iso=0.0).vertices, expected)


def test_nibabel():
    import nibabel

    values, _ = ball_voxels(6.0, 20)
    affine = np.array([[0, -2, 0, 10], [1, 0, 0, 20], [0, 0, 3, 30], [0, 0, 0, 1]], dtype=float)
    axis = scaleaxis.axis(nibabel.Nifti1Image((values > 0).astype(np.uint8), affine), delta=0.03)
    with_time = nibabel.Nifti1Image((values > 0).astype(np.uint8)[..., None], affine)
    assert np.array_equal(scaleaxis.axis(with_time, delta=0.03).vertices, axis.vertices)
    middle = (affine @ [9.5, 9.5, 9.5, 1.0])[:3]
    ends = axis.vertices.min(axis=0), axis.vertices.max(axis=0)
    assert np.mean(ends, axis=0) == pytest.approx(middle, abs=0.5)


def test_simpleitk():
    import SimpleITK as itk

    values = np.zeros((10, 14, 18), dtype=np.uint8)  # k, j, i
    values[2:8, 2:12, 2:16] = 1
    image = itk.GetImageFromArray(values)
    image.SetSpacing((1.0, 2.0, 3.0))
    image.SetOrigin((100.0, 200.0, 300.0))
    image.SetDirection((0, -1, 0, 1, 0, 0, 0, 0, 1))
    axis = scaleaxis.axis(image, delta=0.03, mask_smoothing=0)
    middle = image.TransformContinuousIndexToPhysicalPoint((8.5, 6.5, 4.5))
    assert (axis.balls[:, :3].min(axis=0) + axis.balls[:, :3].max(axis=0)) / 2 == pytest.approx(middle, abs=0.6)


@pytest.mark.parametrize("name", ["ball.nii", "ball.nii.gz", "ball.nrrd", "ball.mha"])
def test_files_of_images(tmp_path, name):
    import SimpleITK as itk

    values, middle = ball_voxels(6.0, 20)
    labels = ((values > 0) * 2 + (values > 3)).astype(np.uint8)
    image = itk.GetImageFromArray(labels.T)
    image.SetSpacing((2.0, 2.0, 2.0))
    image.SetOrigin((100.0, 200.0, 300.0))
    image.SetDirection((0, -1, 0, 1, 0, 0, 0, 0, 1))
    itk.WriteImage(image, str(tmp_path / name))
    axis = scaleaxis.axis(tmp_path / name, delta=0.03, labels=[2, 3])
    expected = scaleaxis.axis(image, delta=0.03, labels=[2, 3])
    # SimpleITK's x goes to the left, and y to the back; those of NIfTI to the right, and to the front.
    sign = np.array([-1.0, -1.0, 1.0]) if ".nii" in name else np.ones(3)
    assert np.allclose(axis.transform, sign[:, None] * expected.transform, atol=1e-4)
    assert axis.transform[0, 1] == pytest.approx(-2 * sign[0])
    place = np.array(image.TransformContinuousIndexToPhysicalPoint(middle.tolist()))
    assert is_axis_of_ball(axis, sign * place, 12.0, 0.6)
    assert axis.statistics["image"]["unit"] == axis.statistics["unit"] == ("mm" if ".nii" in name else None)
    space = "right-anterior-superior" if ".nii" in name else "left-posterior-superior"
    assert axis.statistics["image"]["space"] == space
    assert expected.statistics["image"]["space"] == "left-posterior-superior"
    with pytest.raises(scaleaxis.InvalidOption, match="what of the image is solid"):
        scaleaxis.axis(tmp_path / name)
    with pytest.raises(scaleaxis.InvalidOption, match="kernel"):
        scaleaxis.axis(tmp_path / name, labels=2, kernel=3)
    (tmp_path / f"broken-{name}").write_bytes(b"no image")
    with pytest.raises(scaleaxis.FileError, match="broken"):
        scaleaxis.axis(tmp_path / f"broken-{name}")
    with pytest.raises(scaleaxis.FileError):
        scaleaxis.axis(tmp_path / f"missing-{name}")


@pytest.mark.program
@pytest.mark.parametrize("name", ["mask.nii", "mask.nrrd", "turned.nrrd", "mask.mha"])
def test_images_lie_where_the_program_has_them(tmp_path, program, name):
    """With their unit and their space."""
    import SimpleITK as itk

    mask = (ball_voxels(6.0, 16)[0] > 0).astype(np.uint8)
    mask[:8] *= np.arange(16, dtype=np.uint8) > 6  # no symmetry
    file = tmp_path / name
    if name == "turned.nrrd":
        head = "NRRD0004\ntype: uint8\ndimension: 3\nspace: RAS\nsizes: 16 16 16\nspace origin: (5,6,7)\n"
        head += 'space directions: (0,2,0) (-2,0,0) (0,0,2)\nspace units: "um" "um" "um"\nencoding: raw\n\n'
        file.write_bytes(head.encode() + mask.T.tobytes())
    else:
        image = itk.GetImageFromArray(mask.T)
        image.SetSpacing((2.0, 2.0, 3.0))
        image.SetOrigin((5.0, 6.0, 7.0))
        itk.WriteImage(image, str(file))
    if name == "mask.mha":
        file.write_bytes(file.read_bytes().replace(b"ElementDataFile", b"DistanceUnits = um\nElementDataFile"))
    results = tmp_path / "axis.ply", tmp_path / "statistics.json"
    command = [program, "axis", file, "--delta", "0.05", "-o", results[0], "--stats", results[1], "-q"]
    subprocess.run(list(map(str, command)), check=True)
    axis = scaleaxis.axis(file, delta=0.05)
    assert np.allclose(scaleaxis.read_axis(results[0]).vertices, axis.vertices, atol=1e-4)
    expected = json.loads(results[1].read_text())["results"][0]
    assert axis.statistics["image"]["space"] == expected["image"]["space"]
    assert axis.statistics["unit"] == expected["unit"] == {"mask.nii": "mm", "mask.nrrd": None}.get(name, "um")


def test_units_of_images(tmp_path):
    import nibabel

    mask = (ball_voxels(6.0, 16)[0] > 0).astype(np.uint8)
    for said, unit in [("mm", "mm"), ("micron", "um"), ("meter", "m"), ("unknown", None)]:
        image = nibabel.Nifti1Image(mask, np.eye(4))
        image.header.set_xyzt_units(said)
        assert scaleaxis.axis(image, delta=0.05).statistics["unit"] == unit
    assert scaleaxis.axis(mask, delta=0.05).statistics["unit"] is None
    image = scaleaxis.Image(mask, unit="um", space="right-anterior-superior")
    assert scaleaxis.axis(image, delta=0.05).statistics["unit"] == "um"
    scaleaxis.write_image(tmp_path / "mask.nrrd", image)
    assert b'space units: "um" "um" "um"' in (tmp_path / "mask.nrrd").read_bytes()[:400]


def test_points_with_and_without_normals():
    places = ball_mesh(1.0, 4)[0]
    for options in ({}, {"points": "mls"}, {"points": "crust"}):
        given = {} if options.get("points") == "crust" else {"delta": 0.05}
        if not options:
            given = {}
        assert is_axis_of_ball(scaleaxis.axis(places, **given, **options), [0, 0, 0], 1.0, 0.05)
    assert is_axis_of_ball(scaleaxis.axis(places, delta=0.05, normals=places), [0, 0, 0], 1.0, 0.05)
    with pytest.raises(ValueError, match="3 normals for"):
        scaleaxis.axis(places, normals=places[:3])
    with pytest.raises(scaleaxis.InvalidOption, match="delta has no effect"):
        scaleaxis.axis(places, delta=0.05, points="crust")


def test_points_that_are_not_finite_are_left_out():
    places = ball_mesh(1.0, 4)[0]
    expected = scaleaxis.axis(places, delta=0.05, normals=places)
    bad = np.array([[np.nan, np.nan, np.nan], [0, np.inf, 0]])
    with pytest.warns(scaleaxis.Warning, match="2 of .* points have a coordinate that is not a finite number"):
        axis = scaleaxis.axis(np.vstack([bad, places]), delta=0.05, normals=np.vstack([bad, places]))
    assert np.array_equal(axis.vertices, expected.vertices)


def test_a_function_is_closed_by_its_bounds():
    def cylinder(points: np.ndarray) -> np.ndarray:
        return np.hypot(points[:, 0], points[:, 1]) - 1

    bounds = [[-2, -2, -1], [2, 2, 1]]
    with pytest.raises(scaleaxis.UnusableInput, match="bounds cut the solid"):
        scaleaxis.axis(cylinder, bounds=bounds)
    axis = scaleaxis.axis(cylinder, bounds=bounds, clip=True, delta=0.05)
    assert axis.radii.max() == pytest.approx(1.0, abs=0.02)
    inside = scaleaxis.function_solid(cylinder, bounds, clip=True).inside([[0, 0, 0.99], [0, 0, 1.01]])
    assert inside.tolist() == [True, False]


def test_balls_and_unions():
    balls = np.array([[0, 0, 0, 1.0], [1.5, 0, 0, 1.0]])
    expected = scaleaxis.axis(balls, delta=0.03)
    assert expected.radii.max() == pytest.approx(1.0, abs=0.01)
    assert np.array_equal(scaleaxis.axis(scaleaxis.BallUnion(balls), delta=0.03).vertices, expected.vertices)
    assert scaleaxis.axis(expected.complex, delta=0.03).radii.max() == pytest.approx(1.0, abs=0.02)


def test_function_is_called_in_batches_by_one_thread_at_a_time():
    sizes, inside = [], threading.Lock()

    def torus(points: np.ndarray) -> np.ndarray:
        assert inside.acquire(blocking=False), "two threads at a time"
        sizes.append(len(points))
        values = distance_to_ring(points) - 0.5
        inside.release()
        return values

    axis = scaleaxis.axis(torus, delta=0.02, bounds=[[-3, -3, -1], [3, 3, 1]])
    assert axis.topology.tunnels == 1
    assert distance_to_ring(axis.vertices).max() < 0.1
    assert np.mean(sizes) > 100 and max(sizes) <= 16384


def test_faults_of_functions():
    bounds = [[-2, -2, -2], [2, 2, 2]]
    with pytest.raises(scaleaxis.InvalidOption, match="needs bounds"):
        scaleaxis.axis(lambda p: p[:, 0])
    with pytest.raises(ZeroDivisionError):
        scaleaxis.axis(lambda p: 1 / 0, bounds=bounds)
    with pytest.raises(ValueError, match="one value for each of"):
        scaleaxis.axis(lambda p: p, bounds=bounds)
    with pytest.raises(scaleaxis.UnusableInput, match="not a number"):
        scaleaxis.axis(lambda p: np.full(len(p), np.nan), bounds=bounds)
    with pytest.raises(scaleaxis.UnusableInput, match="nowhere negative"):
        scaleaxis.axis(lambda p: np.ones(len(p)), bounds=bounds)
    calls = []

    def late(points):
        calls.append(len(points))
        if len(calls) > 20:
            raise KeyError("late")
        return np.linalg.norm(points, axis=1) - 1

    with pytest.raises(KeyError, match="late"):
        scaleaxis.axis(late, bounds=bounds, delta=0.02)


def test_function_of_other_types():
    bounds = [-2, -2, -2, 2, 2, 2]
    axis = scaleaxis.axis(
        lambda p: (np.linalg.norm(p, axis=1) - 1).astype(np.float32).tolist(), bounds=bounds, delta=0.05
    )
    assert axis.radii.max() == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("solid", "options", "message"),
    [
        (np.zeros((4, 4)), {"normals": np.zeros((4, 3))}, "normals has no effect on balls"),
        (np.zeros((4, 5)), {}, "is no solid"),
        (np.zeros(7), {}, "is no solid"),
        (object(), {}, "object is no solid"),
        (None, {}, "is no solid"),
        (np.zeros((0, 3)), {}, "empty"),
        (np.zeros((0, 4, 4)), {}, "empty"),
        ((np.zeros((0, 3)), np.zeros((0, 3))), {}, "empty"),
        (np.ones((3, 3, 3)), {"kernel": 3.0}, "kernel has no effect on an array of voxels"),
        (np.ones((3, 3, 3)), {"spacing": [1, 0, 1]}, "spacing must be positive"),
        (np.ones((3, 3, 3)), {"spacing": [1, 1]}, "spacing must have 3 entries"),
        (np.ones((3, 3, 3)), {"direction": np.eye(2)}, "direction must be 3 × 3"),
        (np.full((3, 3, 3), np.nan), {}, "finite"),
        (np.zeros((3, 3, 3), dtype=np.uint8), {}, "all voxels are 0: the mask is empty"),
        (np.zeros((3, 3, 3), dtype=np.uint8), {"labels": 1}, "no voxel has the label 1: all its values are 0"),
        (np.zeros((3, 3, 3), dtype=complex), {}, "real numbers"),
        ("no/such/file.obj", {"spacing": 2}, "spacing has no effect on a file"),
    ],
)
def test_clear_errors(solid, options, message):
    with pytest.raises(ValueError, match=message):
        scaleaxis.axis(solid, **options)


def test_load_has_solid_and_report(cat, ball):
    loaded = scaleaxis.load(cat)
    assert loaded.kind == "mesh" and loaded.report["triangles"] == len(loaded.mesh.triangles)
    assert loaded.solid.topology.tunnels == 0
    assert [cost["stage"] for cost in loaded.costs] == ["reading", "repair", "search tree"]
    values, _ = ball_voxels(5.0, 16)
    assert scaleaxis.load(values, iso=0.0).report["sizes"] == [16, 16, 16]
    assert scaleaxis.load(ball[0]).kind == "points"
    assert scaleaxis.load(ball[0], points="crust").samples is not None
    assert scaleaxis.axis(scaleaxis.load(ball).solid, delta=0.05).radii.max() == pytest.approx(1.0, abs=0.02)


MODEL = """<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" name="a"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="0" v2="3" v3="2"/></triangles>
</mesh></object>
</resources><build><item objectid="1"/><item objectid="1" transform="2 0 0 0 2 0 0 0 2 9 0 0"/></build></model>"""
RELATIONS = """<Relationships><Relationship Target="/3D/3dmodel.model"
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"""


def test_objects_of_3mf(tmp_path):
    file = tmp_path / "two.3mf"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", RELATIONS)
        archive.writestr("3D/3dmodel.model", MODEL)
    small, large = scaleaxis.read_objects(file)
    assert small.name == large.name == "a"
    np.testing.assert_array_equal(large.mesh.vertices, 2 * small.mesh.vertices + [9, 0, 0])
    for objects, volume in (None, 9 / 6), (1, 1 / 6), ([2], 8 / 6), ((1, 2), 9 / 6):
        assert scaleaxis.load(file, objects=objects).report["volume"] == pytest.approx(volume)
    with pytest.raises(scaleaxis.InvalidOption, match="there is no object 3: the file has 2"):
        scaleaxis.load(file, objects=3)


def test_objects_of_gltf(tmp_path):
    import trimesh

    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1, 2, 3)), node_name="box")
    ball = trimesh.creation.icosphere(subdivisions=2)
    scene.add_geometry(ball, node_name="ball", transform=trimesh.transformations.translation_matrix((5, 0, 0)))
    file = tmp_path / "scene.glb"
    scene.export(file)
    objects = {one.name: one.mesh for one in scaleaxis.read_objects(file)}
    assert sorted(objects) == ["ball", "box"]
    np.testing.assert_allclose(objects["ball"].vertices, ball.vertices + [5, 0, 0], atol=1e-6)
    np.testing.assert_array_equal(objects["ball"].triangles, ball.faces)
    assert scaleaxis.load(file).report["volume"] == pytest.approx(6 + ball.volume, rel=1e-6)
    file.write_bytes(b"glTF" + bytes(20))
    with pytest.raises(scaleaxis.FileError, match="scene.glb: "):
        scaleaxis.load(file)


def test_units_of_3mf(tmp_path):
    file = tmp_path / "inches.3mf"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("_rels/.rels", RELATIONS)
        archive.writestr("3D/3dmodel.model", MODEL.replace("<model ", '<model unit="inch" ', 1))
    assert scaleaxis.load(file).report["unit"] == "in"


def test_tables_and_vertices_are_points(tmp_path, cat):
    table = tmp_path / "a.csv"
    table.write_text("name,X,Y,Z\na,1,2,3\nb,4,5,6\n")
    assert scaleaxis.file_kind(table) == "points"
    np.testing.assert_array_equal(scaleaxis.read_points(table).points, [[1, 2, 3], [4, 5, 6]])
    mesh = tmp_path / "a.stl"
    scaleaxis.write_mesh(mesh, scaleaxis.read_mesh(cat))
    with pytest.warns(scaleaxis.Warning, match="points lie on a border"):
        assert scaleaxis.load(mesh, kind="points").kind == "points"


def test_results_of_the_package_are_inputs(torus, tmp_path):
    """Of whatever has a mesh, points or balls; and of functions that take these."""
    import trimesh

    file = tmp_path / "torus.off"
    scaleaxis.write_mesh(file, torus)
    axis = scaleaxis.axis(torus, delta=0.03, scale=1)
    mesh = axis.mesh()
    samples = scaleaxis.sample(scaleaxis.load(file).solid, 0.03 * axis.diagonal)
    union = scaleaxis.union_of(samples, scaleaxis.load(file).solid)
    medial = scaleaxis.medial_axis(axis.balls)
    given = [axis, axis.complex, mesh, mesh.mesh, scaleaxis.boundary_mesh(samples), samples, union, medial]
    given += [scaleaxis.load(file), scaleaxis.read_objects(file)[0], scaleaxis.read_points(file), axis.skeleton()]
    given += [scaleaxis.spheres(file, 50), scaleaxis.filtration(axis), scaleaxis.BallUnion(axis), axis.boundary]
    given += [scaleaxis.filter(medial), scaleaxis.clean(axis, 0.01), scaleaxis.simplify(axis, 0.05)]
    for one in given:
        solid = scaleaxis.load(one)
        bounds = solid.samples.points if solid.solid is None else solid.solid.bounds
        assert np.ptp(bounds, axis=0) == pytest.approx(np.ptp(axis.boundary.vertices, axis=0), rel=0.2), type(one)

    pair = mesh.vertices, mesh.faces
    for one in (mesh, axis.boundary, trimesh.Trimesh(*mesh), pair, scaleaxis.read_objects(file)[0]):
        scaleaxis.write_mesh(tmp_path / "a.stl", one)
        assert len(scaleaxis.read_mesh(tmp_path / "a.stl").faces) > 100
        assert scaleaxis.compare(one, file, 0.02).max < 0.3
    for one in (axis, axis.complex, axis.skeleton(), medial, axis.complex.balls, scaleaxis.BallUnion(axis)):
        scaleaxis.write_balls(tmp_path / "a.txt", one)
        assert len(scaleaxis.BallUnion(one)) == len(scaleaxis.read_balls(tmp_path / "a.txt"))
    scaleaxis.write_axis(tmp_path / "a.ply", medial)
    known = scaleaxis.thickness(medial, mesh.vertices[:9])
    of_file = scaleaxis.thickness(tmp_path / "a.ply", mesh.vertices[:9])
    assert known.local == pytest.approx(of_file.local, rel=1e-5)
    with pytest.raises(TypeError, match="an axis or a MedialComplex is needed, not an array of shape"):
        scaleaxis.thickness(np.zeros((3, 4)), mesh.vertices)
    with pytest.raises(TypeError, match="a mesh is needed"):
        scaleaxis.write_mesh(tmp_path / "a.stl", np.zeros((3, 4)))
    with pytest.raises(TypeError, match="complex must be MedialComplex, not"):
        scaleaxis.filter(mesh)
    assert scaleaxis.load(file).inside([[0.0, 0.0, 50.0]]).tolist() == [False]
    assert scaleaxis.mesh_solid(mesh).bounds == pytest.approx(scaleaxis.mesh_solid(*mesh).bounds)


def test_scenes_and_points_of_other_packages(ball):
    import pyvista
    import trimesh

    box = trimesh.creation.box((1, 2, 3))
    moved = trimesh.transformations.translation_matrix((5, 0, 0))
    scene = trimesh.Scene([box])
    scene.add_geometry(box, transform=moved)
    bounds = scaleaxis.load(scene).solid.bounds
    assert bounds == pytest.approx(np.array([[-0.5, -1, -1.5], [5.5, 1, 1.5]]), abs=0.01)
    expected = scaleaxis.axis(ball[0]).vertices
    own = scaleaxis.PointCloud(ball[0], np.empty((0, 3)))
    for points in (trimesh.PointCloud(ball[0]), pyvista.PolyData(ball[0]), own):
        assert scaleaxis.load(points).kind == "points"
        assert np.array_equal(scaleaxis.axis(points).vertices, expected)
    with_normals = scaleaxis.PointCloud(ball[0], ball[0])
    assert np.array_equal(
        scaleaxis.axis(with_normals, delta=0.05).vertices, scaleaxis.axis(ball[0], 0.05, normals=ball[0]).vertices
    )


def test_images_in_any_form(tmp_path):
    """Every function that takes an image takes all of them."""
    import nibabel
    import SimpleITK as itk

    values = np.zeros((12, 9, 8), dtype=np.uint8)
    values[2:10, 2:7, 2:6] = 1
    own = scaleaxis.Image(values, spacing=(2, 1, 1))
    of_itk = itk.GetImageFromArray(values.T)
    of_itk.SetSpacing((2.0, 1.0, 1.0))
    scaleaxis.write_image(tmp_path / "a.nii.gz", own)
    scaleaxis.check_image_output(tmp_path / "a.nii.gz")
    again = (tmp_path / "a.nii.gz").read_bytes()
    images = [own, nibabel.Nifti1Image(values, np.diag([2.0, 1, 1, 1])), of_itk, tmp_path / "a.nii.gz"]
    axis = scaleaxis.axis(own, delta=0.05)
    expected = scaleaxis.thickness_image(axis, own)
    assert expected.values.max() == pytest.approx(4.2, abs=0.3) and expected.spacing.tolist() == [2, 1, 1]
    for image in images:
        assert np.array_equal(scaleaxis.axis(image, delta=0.05).vertices, axis.vertices)
        assert np.array_equal(scaleaxis.thickness_image(axis, image).values, expected.values)
        assert scaleaxis.image_topology(image).components == 1
        assert scaleaxis.smoothed_mask(image).spacing.tolist() == [2, 1, 1]
        assert scaleaxis.image_solid(image).inside([[18.9, 4, 4], [19.1, 4, 4]]).tolist() == [True, False]
        assert [label for label, _ in scaleaxis.label_axes(image, 0.05)] == [1]
        scaleaxis.write_image(tmp_path / "b.nrrd", image)
        assert np.array_equal(scaleaxis.read_image(tmp_path / "b.nrrd").values, values)
    assert scaleaxis.image_topology(values).components == 1
    scaleaxis.write_image(tmp_path / "a.nii.gz", own)
    assert (tmp_path / "a.nii.gz").read_bytes() == again
    assert np.array_equal(nibabel.load(tmp_path / "a.nii.gz").get_fdata(), values)
    with pytest.raises(TypeError, match="an image is needed"):
        scaleaxis.thickness_image(axis, ball_mesh())
    with pytest.raises(scaleaxis.InvalidOption, match="steps have no effect beside spacing"):
        scaleaxis.Image(values, steps=np.eye(3), spacing=2)


def test_a_mask_may_fill_its_array():
    """The solid is closed half a voxel beyond the outermost centres, as it is where one voxel is 0."""
    full = np.ones((20, 10, 10), dtype=bool)
    for smoothing in (None, 0):
        with pytest.warns(scaleaxis.Warning, match="closed at the border"):
            solid = scaleaxis.load(full, mask_smoothing=smoothing).solid
        assert solid.inside([[-0.45, 5, 5], [19.45, 5, 5], [10, 9.45, 5]]).all()
        assert not solid.inside([[-0.55, 5, 5], [19.55, 5, 5], [10, 9.55, 5]]).any()
    with pytest.raises(scaleaxis.UnusableInput, match="all voxels are above 0.5"):
        scaleaxis.load(np.arange(1.0, 28.0).reshape(3, 3, 3), iso=0.5)


def test_a_tolerance_for_points_is_never_refused_for_how_clean_they_are(tmp_path):
    """They may become samples themselves: then a warning says so, as of the program."""
    places = ball_mesh(1.0, 4)[0]
    rough = places + np.random.default_rng(0).normal(scale=0.05, size=places.shape)
    np.savetxt(tmp_path / "clean.xyz", places)
    expected = scaleaxis.axis(places)
    assert expected.statistics["points"]["method"]["name"] == "crust"
    for options in ({"delta": 0.05}, {"delta_abs": 0.15}, {"delta": "auto"}, {"sampling": "uniform"}):
        name = next(iter(options))
        for points in (places, tmp_path / "clean.xyz"):
            with pytest.warns(scaleaxis.Warning, match=f'{name} had no effect.*points="mls"') as told:
                axis = scaleaxis.axis(points, **options)
            assert [one.message.code for one in told] == ["points.unused_options"] and len(axis.warnings) == 1
            np.testing.assert_allclose(axis.vertices, expected.vertices, atol=1e-9)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert scaleaxis.axis(rough, **options).statistics["points"]["method"]["name"] == "mls"
    assert scaleaxis.axis(places, delta=0.05, points="mls").radii.max() == pytest.approx(1.0, abs=0.05)
    for call in (scaleaxis.skeleton, scaleaxis.midsurface):
        with pytest.warns(scaleaxis.Warning, match="delta had no effect"):
            call(places, delta=0.05)
    with pytest.raises(scaleaxis.InvalidOption, match='delta has no effect with points="crust".*points="mls"'):
        scaleaxis.axis(places, delta=0.05, points="crust")
