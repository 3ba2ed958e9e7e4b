# SPDX-License-Identifier: Apache-2.0
"""Files of images: the values and places that nibabel and SimpleITK find in them too."""

import warnings

import numpy as np
import pytest

import scaleaxis

TYPES = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"]
AFFINE = np.array([[0, -2, 0, 10], [1.2, 0, 0.9, 20], [-0.9, 0, 1.2, -30.5], [0, 0, 0, 1]], dtype=float)


def numbers(kind="u1"):
    """Values without any symmetry, which each type can have."""
    return np.random.default_rng(7).integers(0, 100, (5, 6, 7)).astype(kind)


def expect(image, values, origin, steps):
    assert image.values.shape == values.shape
    assert np.array_equal(image.values, values.astype(np.float32))
    assert np.allclose(image.origin, origin, rtol=1e-6, atol=1e-6)
    assert np.allclose(image.steps, steps, rtol=1e-6, atol=1e-6)


def expect_as_nibabel(file):
    import nibabel
    image = nibabel.load(file)
    expect(scaleaxis.read_image(file), image.get_fdata(dtype=np.float32), image.affine[:3, 3], image.affine[:3, :3].T)


def expect_as_simpleitk(file, sign=(1, 1, 1)):
    """sign: where it turns the coordinates of the file"""
    import SimpleITK as itk
    image = itk.ReadImage(str(file))
    steps = (np.reshape(image.GetDirection(), (3, 3)) * image.GetSpacing()).T
    read = scaleaxis.read_image(file)
    expect(read, itk.GetArrayFromImage(image).T, np.multiply(image.GetOrigin(), sign), steps * sign)
    return read


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("name", ["a.nii", "a.nii.gz", "a.hdr"])
@pytest.mark.parametrize("version", [1, 2])
def test_nifti(tmp_path, kind, name, version):
    import nibabel
    single, pair = (nibabel.Nifti1Image, nibabel.Nifti1Pair) if version == 1 else (nibabel.Nifti2Image, nibabel.Nifti2Pair)
    image = (pair if name == "a.hdr" else single)(numbers(kind), AFFINE, dtype=np.dtype(kind))
    nibabel.save(image, tmp_path / name)
    expect_as_nibabel(tmp_path / name)
    if version == 1:
        expect_as_simpleitk(tmp_path / name, (-1, -1, 1))


@pytest.mark.parametrize("order", "<>")
def test_nifti_in_either_order_scaled_and_placed_by_a_rotation(tmp_path, order):
    import nibabel
    header = nibabel.Nifti1Header(endianness=order)
    header.set_data_dtype(np.int16)
    image = nibabel.Nifti1Image(numbers("i2"), None, header)
    image.header.set_slope_inter(0.25, -3)
    for codes in [(1, 0), (0, 1), (1, 1), (2, 1)]:
        image.set_qform(AFFINE, codes[0])
        image.set_sform(AFFINE if codes[1] else None, codes[1])
        nibabel.save(image, tmp_path / "a.nii")
        expect_as_nibabel(tmp_path / "a.nii")


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("name", ["a.nrrd", "a.nhdr", "a.mha", "a.mhd"])
@pytest.mark.parametrize("packed", [False, True])
def test_nrrd_and_metaimage(tmp_path, kind, name, packed):
    import SimpleITK as itk
    image = itk.GetImageFromArray(numbers(kind).T)
    image.SetSpacing((2.0, 1.5, 1.5))
    image.SetOrigin((10.0, 20.0, -30.5))
    image.SetDirection((0, -0.8, 0.6, 1, 0, 0, 0, 0.6, 0.8))
    itk.WriteImage(image, str(tmp_path / name), packed)
    assert expect_as_simpleitk(tmp_path / name).unit == ""


def test_images_refuse_masked_values_and_units_that_are_no_text():
    values = np.zeros((9, 9, 9))
    values[2:7, 2:7, 2:7] = 1
    masked = np.ma.masked_array(values, mask=np.indices(values.shape)[0] > 3)
    for function in (scaleaxis.axis, scaleaxis.Image, lambda given: list(scaleaxis.label_axes(given))):
        with pytest.raises(ValueError, match="fill them first"):
            function(masked)
    assert scaleaxis.axis(np.ma.masked_array(values, mask=False), 0.1).topology.components == 1
    with pytest.raises(TypeError, match="unit must be text"):
        scaleaxis.Image(values, unit=5)


def test_images_of_itk_lie_where_itk_writes_them(tmp_path):
    """Left, posterior, superior, also as files of other directions."""
    import SimpleITK as itk
    image = itk.GetImageFromArray(numbers("f4").T)
    image.SetSpacing((2.0, 1.5, 1.25))
    image.SetOrigin((10.0, 20.0, -30.5))
    for name in ("a.mha", "a.nii", "a.nrrd"):
        itk.WriteImage(image, str(tmp_path / name))
    written = [itk.ReadImage(str(tmp_path / "a.mha")), tmp_path / "a.mha", tmp_path / "a.nrrd"]
    for one in written:
        for name in ("b.nii", "b.nrrd"):
            scaleaxis.write_image(tmp_path / name, one)
            same, expected = scaleaxis.read_image(tmp_path / name), scaleaxis.read_image(tmp_path / f"a{name[1:]}")
            expect(same, expected.values, expected.origin, expected.steps)
            assert same.space == expected.space != ""


@pytest.mark.parametrize("kind", ["u1", "i2", "i4", "f4", "f8"])
def test_vtk(tmp_path, kind):
    import SimpleITK as itk
    image = itk.GetImageFromArray(numbers(kind).T)
    image.SetSpacing((2.0, 1.5, 1.25))
    image.SetOrigin((10.0, 20.0, -30.5))
    itk.WriteImage(image, str(tmp_path / "a.vtk"))
    expect_as_simpleitk(tmp_path / "a.vtk")


@pytest.mark.parametrize("kind", ["u1", "i2", "u2", "f4"])
@pytest.mark.parametrize("packed", [False, True])
def test_tiff(tmp_path, kind, packed):
    import SimpleITK as itk
    image = itk.GetImageFromArray(numbers(kind).T)
    image.SetSpacing((0.5, 0.25, 1.0))
    itk.WriteImage(image, str(tmp_path / "a.tif"), packed)
    expect_as_simpleitk(tmp_path / "a.tif")


@pytest.mark.parametrize("kind", [*TYPES, "f2", ">u2", ">f8", "?"])
def test_arrays(tmp_path, kind):
    """As the same array in memory."""
    values = numbers().astype(kind)
    for array in (values, np.asfortranarray(values)):
        np.save(tmp_path / "a.npy", array)
        np.savez(tmp_path / "a.npz", image=array, spacing=np.ones(3))
        np.savez_compressed(tmp_path / "b.npz", array)
        for name in ("a.npy", "a.npz", "b.npz"):
            expect(scaleaxis.read_image(tmp_path / name), values, np.zeros(3), np.eye(3))
    mask = np.zeros((9, 8, 12), dtype=bool)
    mask[2:7, 2:6, 2:10] = True
    np.save(tmp_path / "mask.npy", mask)
    assert np.array_equal(scaleaxis.axis(tmp_path / "mask.npy", delta=0.1).vertices, scaleaxis.axis(mask, delta=0.1).vertices)


def test_faults(tmp_path):
    for name in ("broken.nii", "broken.nrrd", "broken.mha", "broken.tif", "broken.npy"):
        (tmp_path / name).write_bytes(b"no image")
        with pytest.raises(scaleaxis.FileError, match=name):
            scaleaxis.axis(tmp_path / name)
    (tmp_path / "scan.dcm").write_bytes(b"\0" * 128 + b"DICM" + b"\0" * 9)
    with pytest.raises(scaleaxis.FileError, match="dcm2niix") as caught:
        scaleaxis.axis(tmp_path / "scan.dcm")
    assert caught.value.code == "file.unsupported"


def slice_of(thick):
    """A plate across the slices of an image, as many voxels thick."""
    values = np.zeros((24, 24, 16), dtype=np.uint8)
    values[3:21, 3:21, 6 : 6 + thick] = 1
    return values


def codes_of(call):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        call()
    return [one.message.code for one in told if isinstance(one.message, scaleaxis.Warning)]


@pytest.mark.filterwarnings("ignore::scaleaxis.Warning")
def test_warns_of_thickness_that_voxels_do_not_resolve(tmp_path):
    code = "image.unresolved_thickness"
    thin = scaleaxis.axis(slice_of(1))
    assert thin.is_mask and codes_of(thin.thickness).count(code) == 1
    surface = thin.mesh().mesh
    assert codes_of(lambda: thin.thickness(surface.vertices)) == []  # points have no area
    skeleton = scaleaxis.skeleton(slice_of(1))
    assert codes_of(lambda: skeleton.measures(surface)).count(code) == 1
    ((_, of_label),) = scaleaxis.label_axes(slice_of(1))
    assert codes_of(of_label.thickness).count(code) == 1
    assert code not in codes_of(scaleaxis.axis(slice_of(4)).thickness)
    field = scaleaxis.axis(slice_of(1).astype(np.float32), iso=0.5)
    assert not field.is_mask and code not in codes_of(field.thickness)
    scaleaxis.write_image(tmp_path / "slice.nrrd", scaleaxis.Image(slice_of(1)))
    of_file = scaleaxis.load(tmp_path / "slice.nrrd"), scaleaxis.load(tmp_path / "slice.nrrd", iso=0.5)
    assert [loaded.is_mask for loaded in of_file] == [True, False]
