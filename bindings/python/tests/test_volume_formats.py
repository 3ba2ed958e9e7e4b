# SPDX-License-Identifier: Apache-2.0
"""Volumes that other software has written: their voxels, and where these are."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any

import nibabel
import nrrd
import numpy as np
import numpy.typing as npt
import pytest
import scaleaxis
import tensorstore
import zarr
from scaleaxis import Error, FileError, InvalidOption
from scaleaxis.volumes import volume
from scaleaxis.volumes.sources import Source, source_of

Values = npt.NDArray[Any]
SIZES = (37, 29, 23)  # x, y, z: no multiples of chunks, each another
CHUNK = 8


def values_of(kind: str) -> Values:
    """Each voxel another value, as far as the type has as many; z first."""
    x, y, z = np.indices(SIZES).transpose(0, 3, 2, 1)
    return np.asarray((x + 41 * y + 1200 * z) % 251 if kind.endswith("1") else x + 41 * y + 1200 * z, kind)


def check(source: Source, values: Values, *, origin: Any = (0, 0, 0), spacing: float = 1.0, unit: str = "") -> None:
    assert source.sizes == SIZES
    assert (source.spacing, source.unit) == (pytest.approx(spacing), unit)
    assert source.origin == pytest.approx(tuple(origin))
    for low, high in (((0, 0, 0), SIZES), ((5, 7, 3), (17, 8, 23)), ((36, 28, 22), SIZES), ((7, 8, 9), (9, 16, 17))):
        found = source.read(low, high)
        assert found.flags.c_contiguous
        assert np.array_equal(found, values[tuple(slice(a, b) for a, b in zip(low[::-1], high[::-1]))])


def check_as_read(path: Path) -> None:
    """That the voxels lie where `read_image` has them."""
    source, image = source_of(path), scaleaxis.read_image(path)
    assert source.sizes == image.values.shape
    assert np.allclose(source.origin, image.origin, atol=1e-6)
    assert np.allclose(np.array(source.directions) * source.spacing, image.steps, atol=1e-6)
    assert np.array_equal(source.read((0, 0, 0), source.sizes), image.values.T)


def ome(name: str, folder: Path, values: Values, axes: str, kind: int, transforms: Any) -> Path:
    """As zarr writes it, with axes in any order; c and t have one entry."""
    path = folder / f"{name}.zarr"
    group = zarr.open_group(str(path), mode="w", zarr_format=2 if kind == 4 else 3)
    order = tuple("zyx".index(axis) for axis in axes if axis in "zyx")
    shaped = values.transpose(order).reshape([1 if a in "tc" else values.shape["zyx".index(a)] for a in axes])
    types = {"t": "time", "c": "channel"}
    told = [{"name": axis, "type": types.get(axis, "space")} for axis in axes]
    for axis in told:
        if axis["type"] == "space":
            axis["unit"] = "micrometer"
    levels = [{"path": f"level{i}", "coordinateTransformations": steps} for i, steps in enumerate(transforms)]
    image = {"axes": told, "datasets": levels}
    if kind == 4:
        group.attrs["multiscales"] = [{"version": "0.4", **image}]
    else:
        group.attrs["ome"] = {"version": "0.5", "multiscales": [image]}
    chunks = tuple(min(CHUNK, n) for n in shaped.shape)
    more = {} if kind == 4 else {"shards": tuple(2 * n for n in chunks)}
    for i in range(len(transforms)):
        array = group.create_array(f"level{i}", shape=shaped.shape, chunks=chunks, dtype=shaped.dtype, **more)
        array[:] = shaped
    return path


def steps(axes: str, scale: float, shifts: dict[str, float] | None = None) -> list[dict[str, Any]]:
    told: list[dict[str, Any]] = [{"type": "scale", "scale": [scale if a in "xyz" else 1.0 for a in axes]}]
    if shifts is not None:
        told.append({"type": "translation", "translation": [shifts.get(axis, 0.0) for axis in axes]})
    return told


@pytest.mark.parametrize("dtype", ["u1", ">u2", "<i4", ">f4", "f8", "<u8"])
@pytest.mark.parametrize(("axes", "kind"), [("zyx", 4), ("tczyx", 4), ("czyx", 5), ("xyz", 4), ("yxzc", 5)])
def test_ome_zarr(axes: str, kind: int, dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    told = [steps(axes, 0.5, {"x": 10, "y": 20, "z": 30}), steps(axes, 1.0, {"x": 11, "y": 21, "z": 31})]
    path = ome("v", tmp_path, values, axes, kind, told)
    check(source_of(path), values, origin=(10, 20, 30), spacing=0.5, unit="micrometer")
    for dataset in (1, "level1"):
        check(source_of(path, dataset=dataset), values, origin=(11, 21, 31), spacing=1.0, unit="micrometer")
    check(source_of(path / "level1"), values, origin=(11, 21, 31), spacing=1.0, unit="micrometer")


def test_ome_zarr_transformations_of_the_image_come_last(tmp_path: Path) -> None:
    path = ome("v", tmp_path, values_of("u2"), "zyx", 5, [steps("zyx", 2.0, {"x": 1})])
    group = zarr.open_group(str(path), mode="r+")
    told = dict(group.attrs["ome"])
    told["multiscales"][0]["coordinateTransformations"] = steps("zyx", 3.0, {"z": 5})
    group.attrs["ome"] = told
    check(source_of(path), values_of("u2"), origin=(3, 0, 5), spacing=6.0, unit="micrometer")


def test_ome_zarr_labels(tmp_path: Path) -> None:
    path = ome("v", tmp_path, values_of("u1"), "zyx", 4, [steps("zyx", 1.0)])
    zarr.open_group(str(path / "labels"), mode="w", zarr_format=2).attrs["labels"] = ["cells"]
    cells = values_of("u2")
    shutil.move(ome("cells", tmp_path, cells, "zyx", 4, [steps("zyx", 2.0, {"x": 4})]), path / "labels/cells")
    for dataset in ("labels/cells", "labels/cells/0", "labels/cells/level0"):
        check(source_of(path, dataset=dataset), cells, origin=(4, 0, 0), spacing=2.0, unit="micrometer")
    check(source_of(path / "labels/cells"), cells, origin=(4, 0, 0), spacing=2.0, unit="micrometer")
    with pytest.raises(InvalidOption, match="is a group: say which array by dataset; there are: labels/cells$"):
        source_of(path, dataset="labels")


@pytest.mark.parametrize("driver", ["zarr", "zarr3"])
def test_zarr_of_tensorstore(driver: str, tmp_path: Path) -> None:
    values = values_of("<u4")
    spec = {"driver": driver, "kvstore": f"file://{tmp_path}/v.zarr/", "create": True}
    tensorstore.open(spec, dtype=tensorstore.uint32, shape=values.shape).result().write(values).result()
    check(source_of(tmp_path / "v.zarr"), values)


def test_zarr_with_named_axes(tmp_path: Path) -> None:
    values = values_of("u2")
    names = {"dimension_names": ["x", "y", "z"]}
    zarr.create_array(str(tmp_path / "v.zarr"), data=np.ascontiguousarray(values.T), chunks=(CHUNK,) * 3, **names)
    check(source_of(tmp_path / "v.zarr"), values)


def test_zarr_without_some_chunks(tmp_path: Path) -> None:
    values = values_of("u2")
    values[:CHUNK, :CHUNK, :CHUNK] = 7
    array = zarr.create_array(
        str(tmp_path / "v.zarr"),
        shape=values.shape,
        chunks=(CHUNK,) * 3,
        dtype="u2",
        fill_value=7,
        order="F",
        zarr_format=2,
    )
    array[:] = values
    check(source_of(tmp_path / "v.zarr"), values)


def n5(folder: Path, name: str, values: Values, **attributes: Any) -> None:
    """As tensorstore writes it: attributes and blocks have x first, numbers their first byte first."""
    spec = {
        "driver": "n5",
        "kvstore": f"file://{folder}/v.n5/{name}/",
        "metadata": {"blockSize": [8, 16, 5], "compression": {"type": "gzip"}, "dataType": str(values.dtype)},
        "create": True,
    }
    tensorstore.open(spec, shape=values.shape[::-1]).result().write(values.T).result()
    file = folder / "v.n5" / name / "attributes.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), **attributes}))


@pytest.mark.parametrize("dtype", ["u1", "u2", "u8", "i4", "f4"])
def test_n5(dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    n5(tmp_path, "", values, resolution=[2, 2, 2], units=["nm"] * 3, offset=[1, 2, 3])
    check(source_of(tmp_path / "v.n5"), values, origin=(1, 2, 3), spacing=2.0, unit="nanometer")


def test_n5_levels(tmp_path: Path) -> None:
    """As n5-viewer has them, and COSEM."""
    values = values_of("u2")
    pixel = {"pixelResolution": {"unit": "um", "dimensions": [0.5] * 3}}
    n5(tmp_path, "em/s0", values, **pixel)
    n5(tmp_path, "em/s1", values, **pixel, downsamplingFactors=[2, 2, 2])
    transform = {"axes": ["z", "y", "x"], "units": ["nm"] * 3, "scale": [4.0] * 3, "translate": [30.0, 20.0, 10.0]}
    n5(tmp_path, "seg/s0", values, transform=transform)
    path = tmp_path / "v.n5"
    for dataset in ("em", "em/s0", "em/0"):
        check(source_of(path, dataset=dataset), values, spacing=0.5, unit="micrometer")
    check(source_of(path, dataset="em/1"), values, origin=[0.25] * 3, spacing=1.0, unit="micrometer")
    check(source_of(path, dataset="seg"), values, origin=(10, 20, 30), spacing=4.0, unit="nanometer")
    with pytest.raises(InvalidOption, match="v.n5 is a group: say which .* there are: em/s0, em/s1, seg/s0$"):
        source_of(path)
    with pytest.raises(InvalidOption, match="has no array em/s9; there are: em/s0, em/s1, seg/s0$"):
        source_of(path, dataset="em/s9")


def precomputed_by_tensorstore(folder: Path, values: Values, resolution: list[int]) -> None:
    spec = {
        "driver": "neuroglancer_precomputed",
        "kvstore": f"file://{folder}/pre/",
        "multiscale_metadata": {"type": "segmentation", "data_type": str(values.dtype), "num_channels": 1},
        "scale_metadata": {
            "size": list(SIZES),
            "resolution": resolution,
            "voxel_offset": [100, 200, 300],
            "chunk_size": [16, 8, 8],
            "encoding": "compressed_segmentation",
            "compressed_segmentation_block_size": [8, 8, 8],
            "sharding": {
                "@type": "neuroglancer_uint64_sharded_v1",
                "preshift_bits": 1,
                "minishard_bits": 1,
                "shard_bits": 1,
                "hash": "identity",
            },
        },
        "create": True,
    }
    tensorstore.open(spec).result().write(values.T[..., None]).result()


def precomputed_by_cloud_volume(folder: Path, values: Values, resolution: list[int]) -> None:
    from cloudvolume import CloudVolume

    CloudVolume.from_numpy(
        np.asfortranarray(values.T),
        vol_path=f"file://{folder}/pre",
        resolution=resolution,
        voxel_offset=[100, 200, 300],
        chunk_size=[16, 8, 8],
        layer_type="segmentation",
        progress=False,
        compress=False,
    )


@pytest.mark.parametrize("library", ["tensorstore", "cloud-volume"])
@pytest.mark.parametrize("write", [precomputed_by_tensorstore, precomputed_by_cloud_volume])
def test_precomputed(write: Any, library: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values = values_of("u8")
    write(tmp_path, values, [8, 8, 8])
    if library == "tensorstore":
        monkeypatch.setitem(sys.modules, "cloudvolume", None)
    source = source_of(f"precomputed://{tmp_path}/pre", dataset=0)
    check(source, values, origin=(804, 1604, 2404), spacing=8.0, unit="nanometer")
    with pytest.raises(FileError, match="with dataset 3"):
        source_of(tmp_path / "pre", dataset=3)
    with pytest.raises(InvalidOption, match="number of a level, not 'em'"):
        source_of(tmp_path / "pre", dataset="em")


@pytest.mark.parametrize("dtype", ["u1", "<u2", ">u2", ">i4", "<f4", ">f8"])
@pytest.mark.parametrize("name", ["v.nrrd", "v.nhdr"])
def test_nrrd(name: str, dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    turned = [[0, 2, 0], [-2, 0, 0], [0, 0, 2]]
    header = {"encoding": "raw", "space": "RAS", "space directions": turned, "space origin": [5, 6, 7]}
    header |= {"endian": "big" if dtype.startswith(">") else "little", "space units": ["mm"] * 3}
    nrrd.write(str(tmp_path / name), values.T, header, index_order="F")
    source = source_of(tmp_path / name)
    check(source, values, origin=(5, 6, 7), spacing=2.0, unit="millimeter")
    assert source.directions == ((0, 1, 0), (-1, 0, 0), (0, 0, 1))


def test_nrrd_without_space(tmp_path: Path) -> None:
    nrrd.write(str(tmp_path / "v.nrrd"), values_of("u2").T, {"encoding": "raw", "spacings": [3, 3, 3]})
    check(source_of(tmp_path / "v.nrrd"), values_of("u2"), spacing=3.0)


@pytest.mark.parametrize(
    "fields",
    [
        "spacings: 3 3 3",
        "spacings: 3 -3 3",
        "spacings: 1 nan none",
        "spacings: 3 3 3\naxis mins: 1 2 4",
        "spacings: 3 3 3\naxis mins: 1 nan 4\ncenters: node cell ???",
        "axis mins: 1 2 4\naxis maxs: 7 10 14",
        "axismins: 1 2 4\naxismaxs: 4 6 9\ncenterings: Cell cell ???",
        "axis mins: 1 2 4\naxis maxs: 5 8 12\ncenters: node node node",
        "axis mins: 1 2 4\naxis maxs: 7 8 12\ncenters: ??? node node",
        "axis mins: 1 2 4\nspacings: 2 2 2\nspacings:=3 3 3\n# spacings: 4 4 4\na key:=axis maxs: 1 1 1",
        "space directions: (0,2,0) (2,0,0) (0,0,-2)\nspace origin: (1,2,3)",
    ],
)
def test_nrrd_lies_where_read_image_has_it(fields: str, tmp_path: Path) -> None:
    head = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 4 5\nendian: little\nencoding: raw\n{fields}\n\n"
    (tmp_path / "v.nrrd").write_bytes(head.encode() + bytes(range(60)))
    check_as_read(tmp_path / "v.nrrd")


@pytest.mark.parametrize(
    ("slope", "shift"), [(0, 0), (0, 3), (1, 0), (np.nan, np.nan), (np.nan, 2), (np.inf, 0), (1, np.nan)]
)
def test_nifti_that_is_not_scaled(slope: float, shift: float, tmp_path: Path) -> None:
    nibabel.save(nibabel.Nifti1Image(values_of("<i2").T, np.eye(4)), tmp_path / "v.nii")
    content = bytearray((tmp_path / "v.nii").read_bytes())
    content[112:120] = np.array([slope, shift], "<f4").tobytes()
    (tmp_path / "v.nii").write_bytes(content)
    check_as_read(tmp_path / "v.nii")
    content[112:120] = np.array([2, 0], "<f4").tobytes()
    (tmp_path / "v.nii").write_bytes(content)
    with pytest.raises(FileError, match="has scaled values"):
        source_of(tmp_path / "v.nii")


@pytest.mark.parametrize("dtype", ["u1", "<u2", ">u2", ">i4", "<f4", ">f8"])
@pytest.mark.parametrize("kind", ["Nifti1Image", "Nifti2Image"])
@pytest.mark.parametrize("form", ["sform", "qform", "neither"])
def test_nifti(form: str, kind: str, dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    affine = np.array([[0, -2, 0, 5], [-2, 0, 0, 6], [0, 0, 2, 7], [0, 0, 0, 1.0]])
    image = getattr(nibabel, kind)(values.T, affine)
    swapped = image.header.as_byteswapped(">" if dtype.startswith(">") else "<")
    image = getattr(nibabel, kind)(values.T, affine, swapped)
    image.header.set_xyzt_units("mm", "sec")
    image.set_sform(affine, 1 if form == "sform" else 0)
    image.set_qform(affine, 1 if form == "qform" else 0)
    nibabel.save(image, tmp_path / "v.nii")
    source = source_of(tmp_path / "v.nii")
    place = (0, 0, 0) if form == "neither" else (5, 6, 7)
    check(source, values, origin=place, spacing=2.0, unit="millimeter")
    steps = np.array(nibabel.load(tmp_path / "v.nii").affine)[:3, :3].T / 2
    expected = np.diag([-1, -1, 1]) if form == "neither" else steps
    assert np.allclose(source.directions, expected, atol=1e-6)
    check_as_read(tmp_path / "v.nii")


@pytest.mark.parametrize("dtype", ["<f4", ">f8"])
def test_what_is_not_a_number_is_0_in_nifti(dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    values[3, 2, 1], values[4, 5, 6], values[7, 8, 9] = np.nan, np.inf, -np.inf
    nibabel.save(nibabel.Nifti1Image(values.T, np.eye(4)), tmp_path / "v.nii")
    found = source_of(tmp_path / "v.nii").read((0, 0, 0), SIZES)
    assert np.array_equal(found, np.where(np.isfinite(values), values, 0))
    assert np.array_equal(found, scaleaxis.read_image(tmp_path / "v.nii").values.T)


@pytest.mark.parametrize("dtype", ["<f4", ">f8"])
def test_what_is_not_a_number_is_refused_in_other_formats(dtype: str, tmp_path: Path) -> None:
    values = values_of(dtype)
    values[13, 12, 11] = np.nan
    np.save(tmp_path / "v.npy", values)
    nrrd.write(str(tmp_path / "v.nrrd"), values.T, {"encoding": "raw"}, index_order="F")
    zarr.save_array(str(tmp_path / "v.zarr"), values)
    for name in ("v.npy", "v.nrrd", "v.zarr"):
        source = source_of(tmp_path / name)
        source.read((0, 0, 0), (11, 29, 23))
        with pytest.raises(FileError, match=r"voxel \(11, 12, 13\) is not a number"):
            source.read((7, 8, 9), SIZES)
        with pytest.raises(Error, match=r"voxel \(11, 12, 13\) is not a number"):
            volume(source, tmp_path / "out", workers=1)
    with pytest.raises(FileError, match=r"voxel \(11, 12, 13\) is not a number"):
        scaleaxis.axis(tmp_path / "v.nrrd", nonzero=True)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", ["?", "u1", ">u2", ">f4"])
def test_npy(dtype: str, order: Any, tmp_path: Path) -> None:
    values = np.array(values_of("u2") % 2 if dtype == "?" else values_of(dtype), dtype, order=order)
    np.save(tmp_path / "v.npy", values)
    check(source_of(tmp_path / "v.npy"), values)
    np.save(tmp_path / "four.npy", values[None])
    check(source_of(tmp_path / "four.npy"), values)


def test_packed_precomputed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By default cloud-volume packs chunks, which tensorstore does not find."""
    path, _ = ball(tmp_path, "pre")
    assert source_of(path).read((20, 12, 14), (21, 13, 15)).item() == 1
    monkeypatch.setitem(sys.modules, "cloudvolume", None)
    with pytest.raises(InvalidOption, match="packed chunks, which need cloudvolume"):
        source_of(path)


def unequal(folder: Path, kind: str) -> Path:
    values, sides = values_of("u2"), [1, 1, 3]
    if kind == "zarr":
        told = [[{"type": "scale", "scale": [3.0, 1.0, 1.0]}]]
        return ome("v", folder, values, "zyx", 5, told)
    if kind == "n5":
        n5(folder, "", values, resolution=sides)
    elif kind == "pre":
        precomputed_by_cloud_volume(folder, values, sides)
    elif kind == "nrrd":
        nrrd.write(str(folder / "v.nrrd"), values.T, {"encoding": "raw", "spacings": sides})
    else:
        nibabel.save(nibabel.Nifti1Image(values.T, np.diag([*sides, 1])), folder / "v.nii")
    return folder / "pre" if kind == "pre" else folder / f"v.{kind}"


@pytest.mark.parametrize("kind", ["zarr", "n5", "pre", "nrrd", "nii"])
def test_unequal_voxels(kind: str, tmp_path: Path) -> None:
    path = unequal(tmp_path, kind)
    with pytest.raises(FileError, match="has voxels of 1 x 1 x 3: resample it to cubes"):
        source_of(path)
    assert source_of(path, spacing=2.0).spacing == 2.0


def test_what_is_wrong_is_one_line(tmp_path: Path) -> None:
    def told(match: str, path: Path | str, kind: Any = FileError, **options: Any) -> None:
        with pytest.raises(kind, match=match) as error:
            source_of(path, **options)
        assert len(str(error.value).splitlines()) == 1

    path = ome("v", tmp_path, values_of("u2"), "zyx", 5, [steps("zyx", 1.0)] * 2)
    told("has no array level7; there are: level0, level1$", path, InvalidOption, dataset="level7")
    told("has no array 7; there are: level0, level1$", path, InvalidOption, dataset=7)
    told("leave dataset out", path / "level0", InvalidOption, dataset=0)
    zarr.open_group(str(tmp_path / "plain.zarr"), mode="w").create_array("raw", data=values_of("u2"))
    told("is a group: say which array by dataset; there are: raw$", tmp_path / "plain.zarr", InvalidOption)
    check(source_of(tmp_path / "plain.zarr", dataset="raw"), values_of("u2"))
    for name in ("no.zarr", "no.n5", "no.npy", "no.nii", "no.nrrd"):
        told("there is no such file or folder", tmp_path / name)
    (tmp_path / "empty.zarr").mkdir()
    told("cannot be read as zarr", tmp_path / "empty.zarr")
    (tmp_path / "empty.n5").mkdir()
    told("there are: none", tmp_path / "empty.n5", InvalidOption)
    for name in ("v.npy", "v.nrrd", "v.nii"):
        (tmp_path / name).write_bytes(b"nothing of this kind" * 40)
        told("cannot be read as npy|is no NRRD|is no NIfTI", tmp_path / name)
    ome("two", tmp_path, values_of("u2"), "zyx", 4, [steps("zyx", 1.0)])
    image = dict(zarr.open_group(str(tmp_path / "two.zarr"), mode="r").attrs)
    image["multiscales"][0]["axes"][0]["name"] = "c"
    zarr.open_group(str(tmp_path / "two.zarr"), mode="r+").attrs.update(image)
    told("has the axes c, y, x: a volume has x, y and z", tmp_path / "two.zarr")
    np.save(tmp_path / "channels.npy", np.stack([values_of("u1")] * 2))
    told("has the shape .2, 23, 29, 37.: a volume has three axes", tmp_path / "channels.npy")
    np.save(tmp_path / "complex.npy", values_of("u1").astype("c8"))
    told("type complex64: a volume has numbers", tmp_path / "complex.npy")
    nrrd.write(str(tmp_path / "packed.nrrd"), values_of("u1").T, {"encoding": "gzip"})
    told("raw data of three dimensions: unpack it", tmp_path / "packed.nrrd")
    skewed = {"encoding": "raw", "space": "RAS", "space directions": [[1, 0, 0], [0.6, 0.8, 0], [0, 0, 1]]}
    nrrd.write(str(tmp_path / "skewed.nrrd"), values_of("u1").T, {**skewed, "space origin": [0, 0, 0]})
    told("not at right angles", tmp_path / "skewed.nrrd")
    nibabel.save(nibabel.Nifti1Image(values_of("u1").T, np.eye(4)), tmp_path / "packed.nii.gz")
    told("unpack it with gunzip", tmp_path / "packed.nii.gz")
    scaled = nibabel.Nifti1Image(values_of("u1").T, np.eye(4))
    scaled.header.set_slope_inter(2.0, 1.0)
    nibabel.save(scaled, tmp_path / "scaled.nii")
    told("scaled values", tmp_path / "scaled.nii")


def test_short_files(tmp_path: Path) -> None:
    np.save(tmp_path / "v.npy", values_of("u2"))
    nrrd.write(str(tmp_path / "v.nrrd"), values_of("u2").T, {"encoding": "raw"})
    nibabel.save(nibabel.Nifti1Image(values_of("u2").T, np.eye(4)), tmp_path / "v.nii")
    for name in ("v.npy", "v.nrrd", "v.nii"):
        content = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(content[:-1000])
        with pytest.raises(FileError, match="is too short: .* bytes, where its header tells of|cannot be read as npy"):
            source_of(tmp_path / name)


def test_damaged_chunks(tmp_path: Path) -> None:
    mask = np.ones((40, 40, 40), np.uint8)
    zarr.create_array(str(tmp_path / "v.zarr"), data=mask, chunks=(20,) * 3)
    chunk = tmp_path / "v.zarr/c/1/1/1"
    chunk.write_bytes(b"damaged")
    with pytest.raises(FileError, match="the voxels from 0, 0, 0 on cannot be read: a chunk there is damaged"):
        source_of(tmp_path / "v.zarr").read((0, 0, 0), (40, 40, 40))
    from scaleaxis import Error

    with pytest.raises(Error, match="the block at voxel 0, 0, 0: .*v.zarr: the voxels .* a chunk there is damaged"):
        volume(tmp_path / "v.zarr", tmp_path / "out", progress=False)


def ball(folder: Path, kind: str) -> tuple[Path, float]:
    """A ball around the voxel (20, 12, 14), in voxels of 2."""
    z, y, x = np.indices((32, 28, 40))
    mask = ((x - 20) ** 2 + (y - 12) ** 2 + (z - 14) ** 2 < 64).astype(np.uint8)
    if kind == "n5":
        n5(folder, "", mask, resolution=[2, 2, 2], offset=[10, 20, 30])
    else:
        from cloudvolume import CloudVolume

        CloudVolume.from_numpy(
            np.asfortranarray(mask.T),
            vol_path=f"file://{folder}/pre",
            resolution=[2, 2, 2],
            voxel_offset=[5, 10, 15],
            chunk_size=[16, 16, 16],
            layer_type="segmentation",
            progress=False,
        )
    return folder / ("v.n5" if kind == "n5" else "pre"), 0.0 if kind == "n5" else 1.0


@pytest.mark.parametrize("kind", ["n5", "pre"])
def test_workers_read_them_too(kind: str, tmp_path: Path) -> None:
    path, half = ball(tmp_path, kind)
    report = volume(path, tmp_path / "out", workers=1, memory="2GB", progress=False)
    assert report.axis is not None
    center = report.axis.vertices.mean(axis=0)
    assert np.abs(center - (np.array([50, 44, 58]) + half)).max() < 0.5
    assert report.axis.radii.max() == pytest.approx(15, abs=0.5)


def test_the_axis_lies_where_directions_put_it(tmp_path: Path) -> None:
    z, y, x = np.indices((24, 24, 32))
    mask = ((x - 20) ** 2 + (y - 10) ** 2 + (z - 12) ** 2 < 36).astype(np.uint8)
    affine = np.array([[0, -2, 0, 5], [-2, 0, 0, 6], [0, 0, 2, 7], [0, 0, 0, 1.0]])
    nibabel.save(nibabel.Nifti1Image(mask.T, affine), tmp_path / "v.nii")
    report = volume(tmp_path / "v.nii", tmp_path / "out", workers=1, memory="2GB", progress=False)
    assert report.axis is not None
    assert np.abs(report.axis.vertices.mean(axis=0) - affine[:3] @ [20, 10, 12, 1]).max() < 0.5
