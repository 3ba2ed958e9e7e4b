# SPDX-License-Identifier: Apache-2.0
"""What volumes in blocks write, as other software reads it."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import osteoid
import pytest
import pyvista
import scaleaxis
import scipy.ndimage
import tensorstore
import zarr
from scaleaxis import InvalidOption
from scaleaxis.volumes import Report, volume

pytestmark = pytest.mark.filterwarnings("ignore:trees have no loops")  # of which SWC files are made

SPACING, ORIGIN = 0.5, (10.0, 20.0, 30.0)  # micrometres; x, y, z


def labels() -> np.ndarray:
    """Two rings with a joint, which are label 7, and a ball, which is 300; of label 5 nothing is asked."""
    z, y, x = np.indices((40, 40, 96)) - np.array([20.3, 20.1, 24.2]).reshape(3, 1, 1, 1)
    rings = [np.hypot(np.hypot(x - shift, y) - 13, z) < 2.6 for shift in (0, 24)]
    found = 7 * np.logical_or.reduce(rings).astype(np.uint16)
    found[(x - 56) ** 2 + y**2 + z**2 < 81] = 300
    found[:3, :3] = 5
    return found


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Report, Path]:
    folder = tmp_path_factory.mktemp("made")
    group = zarr.open_group(str(folder / "v.zarr"), mode="w")
    axes = [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
    steps = [
        {"type": "scale", "scale": [SPACING] * 3},
        {"type": "translation", "translation": list(ORIGIN[::-1])},
    ]
    image = {"axes": axes, "datasets": [{"path": "s0", "coordinateTransformations": steps}]}
    group.attrs["ome"] = {"version": "0.5", "multiscales": [image]}
    group.create_array("s0", data=labels(), chunks=(16,) * 3)
    wanted: dict[str, Any] = {"label": 7, "thickness": True, "angle": 20.0, "skeleton": True, "block": 32}
    report = volume(folder / "v.zarr", folder / "out", memory="4GB", workers=2, progress=False, **wanted)
    return report, folder / "out"


def test_parts_are_the_axis(made: tuple[Report, Path]) -> None:
    """Together they have its faces, each once, at the same places, in two readers."""
    report, output = made
    names = json.loads((output / "report.json").read_text())["parts"]
    assert report.axis is not None and 1 < len(names) <= report.blocks
    parts = [scaleaxis.read_axis(output / name) for name in names]
    parts = [getattr(part, "complex", part) for part in parts]
    assert sum(len(part.faces) for part in parts) == report.faces

    def faces_of(complexes: list[Any]) -> list[bytes]:
        corners = [np.sort(np.round(c.vertices[face], 3), axis=0).tobytes() for c in complexes for face in c.faces]
        return sorted(corners)

    whole = scaleaxis.read_axis(output / "axis.ply")
    assert faces_of(parts) == faces_of([getattr(whole, "complex", whole)])
    assert sum(pyvista.read(output / name).n_cells for name in names) >= report.faces


def test_parts_as_vtp(made: tuple[Report, Path], tmp_path: Path) -> None:
    """The same faces, vertices and radii as in PLY, for another reader, and the same stitched file."""
    report, output = made
    told: dict[str, Any] = {"memory": "4GB", "workers": 2, "progress": False, "label": 7, "block": 32}
    volume(output.parent / "v.zarr", tmp_path, parts_format="vtp", **told)
    names = json.loads((tmp_path / "report.json").read_text())["parts"]
    assert len(names) > 1 and all(name.endswith(".vtp") for name in names)
    assert not list(tmp_path.glob("blocks/*.ply"))
    assert (tmp_path / "axis.ply").read_bytes() == (output / "axis.ply").read_bytes()
    known = json.loads((output / "report.json").read_text())["parts"]
    faces = 0
    for name, other in zip(names, known):
        part, ply = pyvista.read(tmp_path / name), pyvista.read(output / other)
        faces += part.GetNumberOfPolys()
        assert (part.GetNumberOfPolys(), part.n_points) == (ply.GetNumberOfPolys(), ply.n_points)
        assert np.allclose(np.sort(part.points, axis=0), np.sort(ply.points, axis=0), atol=1e-5)
        radii = np.load((output / other).with_suffix(".npz"))["radii"]  # in voxels
        assert np.allclose(np.sort(part["radius"]), np.sort(radii) * SPACING)
    assert faces == report.faces
    with pytest.raises(InvalidOption, match="parts_format must be ply or vtp"):
        volume(output.parent / "v.zarr", tmp_path, parts_format="obj", **told)  # type: ignore[arg-type]


def test_thickness_is_a_valid_image(made: tuple[Report, Path]) -> None:
    _, output = made
    group = zarr.open_group(str(output / "thickness.zarr"), mode="r")
    if sys.version_info >= (3, 11):  # there is no ome-zarr-models for older ones
        import ome_zarr_models

        image = ome_zarr_models.open_ome_zarr(group)
        assert type(image).__name__ == "Image" and image.ome_zarr_version == "0.4"
        multiscale = image.attributes.multiscales[0]
        assert [(axis.name, axis.type, axis.unit) for axis in multiscale.axes] == [
            (name, "space", "micrometer") for name in "zyx"
        ]
        scale, shift = multiscale.datasets[0].coordinateTransformations
        assert scale.scale == [SPACING] * 3 and shift.translation == list(ORIGIN[::-1])
    values = np.asarray(group["0"])
    assert values.dtype == np.uint16 and values.shape == labels().shape
    assert (values > 0).tolist() == (labels() == 7).tolist()
    told = dict(group["0"].attrs)
    largest = values.max() * told["scale_factor"] + told["add_offset"]
    assert (told["unit"], told["quantity"]) == ("micrometer", "diameter")
    assert largest == pytest.approx(2 * SPACING * scipy.ndimage.distance_transform_edt(labels() == 7).max(), abs=0.01)
    store = tensorstore.open({"driver": "zarr", "kvstore": f"file://{output}/thickness.zarr/0/"}, open=True).result()
    assert np.array_equal(store.read().result(), values)


def test_thickness_is_a_volume_again(made: tuple[Report, Path], tmp_path: Path) -> None:
    report, output = made
    again = volume(output / "thickness.zarr", tmp_path / "out", memory="4GB", workers=2, progress=False)
    assert report.axis is not None and again.axis is not None
    assert np.array_equal(again.axis.vertices, report.axis.vertices)


def test_skeletons_of_neuroglancer(made: tuple[Report, Path], tmp_path: Path) -> None:
    """In nanometres, with radii, under the number of the label: as osteoid and cloud-volume read them."""
    from cloudvolume import CloudVolume

    _, output = made
    info = json.loads((output / "skeletons/info").read_text())
    content = (output / "skeletons/7").read_bytes()
    found = osteoid.Skeleton.from_precomputed(content, segid=7, vertex_attributes=info["vertex_attributes"])
    swc = np.loadtxt(output / "skeleton.swc", comments="#", ndmin=2)
    assert len(found.vertices) >= len(np.unique(swc[:, 2:5], axis=0))
    assert len(found.components()) == 1 and len(found.edges) == len(found.vertices) + 1  # two loops
    assert found.radius.min() > 1000 and found.radius.max() < 2500  # about 2.6 voxels of 500 nm
    whole = CloudVolume.create_new_info(
        1, "segmentation", "uint16", "raw", [500] * 3, [0] * 3, (96, 40, 40), "skeletons"
    )
    (tmp_path / "layer").mkdir()
    (tmp_path / "layer/skeletons").symlink_to(output / "skeletons")
    layer = CloudVolume(f"file://{tmp_path}/layer", info=whole)
    layer.commit_info()
    read = layer.skeleton.get(7)
    assert np.array_equal(read.vertices, found.vertices) and np.array_equal(read.radius, found.radius)
    voxels = (read.vertices / 500 - np.array(ORIGIN) / SPACING).round().astype(int)
    assert (labels()[tuple(voxels.T[::-1])] == 7).all()


def test_skeleton_as_swc(made: tuple[Report, Path]) -> None:
    _, output = made
    rows = np.loadtxt(output / "skeleton.swc", comments="#", ndmin=2)
    voxels = ((rows[:, 2:5] - ORIGIN) / SPACING).round().astype(int)
    assert (labels()[tuple(voxels.T[::-1])] == 7).all()
    assert (rows[:, 5] > 1).all() and (rows[:, 5] < 2.5).all()
    assert {int(parent) for parent in rows[:, 6]} <= {-1, *map(int, rows[:, 0])}


def test_table_of_labels(made: tuple[Report, Path]) -> None:
    """Those that span blocks are one."""
    _, output = made
    rows = {int(row["label"]): row for row in csv.DictReader((output / "labels.csv").read_text().splitlines())}
    assert sorted(rows) == [5, 7, 300]
    boxes = scipy.ndimage.find_objects(labels())
    for label, row in rows.items():
        count = int((labels() == label).sum())
        assert int(row["voxels"]) == count and float(row["volume"]) == pytest.approx(count * SPACING**3)
        for axis, place in zip("zyx", boxes[label - 1]):
            assert (int(row[f"low_{axis}"]), int(row[f"high_{axis}"])) == (place.start, place.stop - 1)


def test_report(made: tuple[Report, Path]) -> None:
    report, output = made
    told = json.loads((output / "report.json").read_text())
    assert told["agrees"] is True and told["unit"] == "micrometer" and told["mismatches"] == []
    assert (told["faces"], told["blocks"], told["euler"]) == (report.faces, report.blocks, report.euler)
    assert told["peak_memory"] > 0 and told["stitching_memory"] > 0
