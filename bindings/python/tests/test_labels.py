# SPDX-License-Identifier: Apache-2.0
"""The axes of all labels of an image, against those of one label at a time."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import scaleaxis
from conftest import seconds_to_interrupt

PLACE = {"spacing": (0.5, 0.5, 1.0), "origin": (1.0, 2.0, 3.0), "direction": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}


def ball(places, middle, radius):
    return ((places - np.array(middle)[:, None, None, None]) ** 2).sum(axis=0) < radius**2


def labelled(n=36):
    """Two balls and a plate; the largest ball has the largest label."""
    places = np.indices((n, n, n)) * (36 / n)
    values = np.zeros((n, n, n), dtype=np.uint16)
    values[ball(places, (11, 11, 11), 7.0)] = 3
    values[ball(places, (25, 25, 18), 9.0)] = 500
    values[n // 2 : n // 2 + 2, n // 8 : -n // 8, -n // 9 : -n // 18] = 7
    return values


def fine():
    """A label that is soon done and one that takes many seconds, and a tolerance as a length."""
    values = labelled(150) // 500
    values[4:10, 4:10, 4:10] = 2
    values[values == 1] = 3
    return values, 0.15


def is_same(a, b):
    return (
        np.array_equal(a.balls, b.balls)
        and np.array_equal(a.vertices, b.vertices)
        and np.array_equal(a.radii, b.radii)
        and np.array_equal(a.edges, b.edges)
        and np.array_equal(a.polygons.indices, b.polygons.indices)
        and a.topology == b.topology
        and list(map(str, a.warnings)) == list(map(str, b.warnings))
    )


@pytest.mark.parametrize("threads", [1, 3])
def test_same_as_one_label_at_a_time(threads):
    values = labelled()
    found = list(scaleaxis.label_axes(values, 0.03, threads=threads, **PLACE))
    assert [label for label, _ in found] == [3, 7, 500]
    for label, axis in found:
        assert is_same(axis, scaleaxis.axis(values, 0.03, labels=label, **PLACE))
        assert axis.name == f"solid-label{label}" and axis.statistics["label"] == label
    assert found[2][1].radii.max() == pytest.approx(4.5, abs=0.4)


def test_options_and_several_scales():
    values = labelled()
    options = {"mask_smoothing": 1.0, "smooth": 0, "center": False, "union": "polar"}
    for label, axes in scaleaxis.label_axes(values, 0.04, [1.0, 1.2], **options):
        assert [axis.scale for axis in axes] == [1.0, 1.2]
        for axis, expected in zip(axes, scaleaxis.axis(values, 0.04, [1.0, 1.2], labels=label, **options)):
            assert is_same(axis, expected)


@pytest.mark.parametrize("name", ["cells.nii.gz", "cells.nrrd", "cells.vti"])
def test_files(tmp_path, name):
    values, file = labelled(), tmp_path / name
    if name.endswith(".vti"):
        numbers = " ".join(map(str, values.T.ravel()))
        extent = f'"0 {len(values) - 1} 0 {len(values) - 1} 0 {len(values) - 1}"'
        file.write_text(
            f'<VTKFile type="ImageData"><ImageData WholeExtent={extent} Origin="0 0 0" Spacing="1 1 1"><Piece '
            f'Extent={extent}><PointData Scalars="l"><DataArray type="UInt16" Name="l" format="ascii">{numbers}'
            "</DataArray></PointData></Piece></ImageData></VTKFile>"
        )
    else:
        import SimpleITK as itk

        itk.WriteImage(itk.GetImageFromArray(values.T), str(file))
    found = dict(scaleaxis.label_axes(file, 0.03))
    assert list(found) == [3, 7, 500]
    assert found[7].name.endswith("-label7")
    assert is_same(found[7], scaleaxis.axis(file, 0.03, labels=7))


def test_labels_without_an_axis_are_left_out():
    values = labelled()
    values[1, 1, 1] = 5
    with pytest.warns(scaleaxis.Warning, match="label 5: delta must lie between") as told:
        found = dict(scaleaxis.label_axes(values, delta_abs=2.0))
    assert list(found) == [3, 7, 500]
    assert told[0].filename == __file__


def test_options_that_suit_no_label():
    values = labelled(12)
    for options in ({"iso": 1.0}, {"labels": 3}, {"nonzero": True}, {"bounds": [[0, 0, 0], [1, 1, 1]]}):
        with pytest.raises(scaleaxis.InvalidOption, match="has no effect"):
            scaleaxis.label_axes(values, **options)
    with pytest.raises(scaleaxis.InvalidOption, match="delta must lie between"):
        next(scaleaxis.label_axes(values, 7.0))
    with pytest.raises(scaleaxis.InvalidOption, match="scale"):
        next(scaleaxis.label_axes(values, 0.1, 0.5))
    with pytest.raises(TypeError, match="radius"):
        scaleaxis.label_axes(values, radius=1)
    with pytest.raises(scaleaxis.UnusableInput, match="no labels"):
        next(scaleaxis.label_axes(values * 0.5))
    with pytest.raises(ValueError, match="three dimensions"):
        scaleaxis.label_axes(np.zeros((4, 3)))


def test_progress_is_told_and_cancels():
    told = []
    list(scaleaxis.label_axes(labelled(), 0.03, progress=lambda *stage: told.append(stage)))
    assert told and all(stage == "labels" for stage, _ in told)
    parts = [part for _, part in told]
    assert parts == sorted(parts) and parts[-1] <= 1.0

    values, length = fine()
    start = time.process_time()  # what other processes do does not count
    with pytest.raises(scaleaxis.Cancelled):
        list(scaleaxis.label_axes(values, delta_abs=length, progress=lambda stage, part: False))
    assert time.process_time() - start < 3.0


def test_leaving_the_loop_stops_the_rest():
    values, length = fine()
    threads = threading.active_count()
    start = time.process_time()
    for label, _ in scaleaxis.label_axes(values, delta_abs=length, threads=2):
        assert label == 2
        break
    assert time.process_time() - start < 15.0
    assert threading.active_count() == threads


INTERRUPTED = """
import sys, time
sys.path.insert(0, {tests!r})
import scaleaxis
from test_labels import fine
print("ready", flush=True)
values, length = fine()
pairs = scaleaxis.label_axes(values, delta_abs=length)
try:
    list(pairs)
except KeyboardInterrupt:
    print("interrupted", time.time(), flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")
def test_interrupt_stops_at_once():
    code = INTERRUPTED.format(tests=os.path.dirname(__file__))
    assert seconds_to_interrupt(code, 1.5) < 5.0  # not interrupted: half a minute


def test_the_interpreter_does_not_wait_for_the_rest():
    code = f"""
import sys
sys.path.insert(0, {os.path.dirname(__file__)!r})
import scaleaxis
from test_labels import fine
values, length = fine()
pairs = scaleaxis.label_axes(values, delta_abs=length, threads=2)
print(next(pairs)[0], flush=True)
"""
    start = time.perf_counter()
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert (result.stdout, result.returncode) == ("2\n", 0), result.stderr
    assert time.perf_counter() - start < 30.0


@pytest.mark.parametrize("kind", [np.uint32, np.int64, np.uint64, np.float64])
def test_labels_beyond_single_precision(kind):
    first = 2**24 if kind == np.uint32 else 2**52 if kind == np.float64 else 720575940379283000
    values = np.zeros((16, 16, 16), dtype=kind)
    values[2:7, 2:7, 2:7] = first
    values[9:14, 9:14, 9:14] = first + 1
    found = dict(scaleaxis.label_axes(values, 0.1))
    assert list(found) == [first, first + 1]
    for label, axis in found.items():
        assert axis.topology.components == 1 and axis.statistics["label"] == label
        assert [one["label"] for one in axis.statistics["image"]["labels"]] == [first, first + 1]
        alone = scaleaxis.axis(values, 0.1, labels=kind(label))
        np.testing.assert_array_equal(alone.vertices, axis.vertices)
    assert scaleaxis.axis(values, 0.1, labels=[first, first + 1]).topology.components == 2
    assert scaleaxis.axis(values, 0.1, nonzero=True).topology.components == 2
    with pytest.raises(scaleaxis.UnusableInput, match=f"no voxel has the label {first + 2}"):
        scaleaxis.axis(values, labels=first + 2)


def test_labels_of_files_beyond_single_precision_are_refused(tmp_path):
    import SimpleITK as itk

    values = np.zeros((8, 8, 8), dtype=np.uint32)
    values[2:6, 2:6, 2:6] = 2**24 + 1
    itk.WriteImage(itk.GetImageFromArray(values), str(tmp_path / "a.nrrd"))
    for call in (lambda file: list(scaleaxis.label_axes(file)), lambda file: scaleaxis.axis(file, labels=2**24 + 1)):
        with pytest.raises(scaleaxis.UnusableInput, match="told apart up to 2\\^24"):
            call(tmp_path / "a.nrrd")


def two_beyond(first):
    values = np.zeros((16, 16, 16), dtype=np.uint32)
    values[2:7, 2:7, 2:7] = first
    values[9:14, 9:14, 9:14] = 2**24 + 1
    return values


def test_labels_of_arrays_of_numpy_are_not_merged_in_files(tmp_path):
    np.save(tmp_path / "a.npy", two_beyond(2**24))
    read = scaleaxis.read_image(tmp_path / "a.npy")
    for given in (tmp_path / "a.npy", read):
        for function in (scaleaxis.label_axes, lambda image: scaleaxis.each_label(scaleaxis.spheres, image)):
            with pytest.raises(scaleaxis.UnusableInput, match="told apart up to 2\\^24"):
                list(function(given))
        with pytest.raises(scaleaxis.UnusableInput, match="told apart up to 2\\^24"):
            scaleaxis.axis(given, labels=2**24 + 1)
        assert scaleaxis.axis(given, 0.1, labels=2**24).topology.components == 1
    with pytest.raises(ValueError, match="whole numbers up to 2\\^24"):
        scaleaxis.write_image(tmp_path / "b.nrrd", two_beyond(2**24))
    assert list(dict(scaleaxis.label_axes(two_beyond(2**24), 0.1))) == [2**24, 2**24 + 1]


@pytest.mark.parametrize("kind", [np.int32, np.uint32, np.int64, np.float32, np.float64])
def test_the_largest_label_of_single_precision_is_one(tmp_path, kind):
    values = np.where(two_beyond(2**24) == 2**24, 2**24, 0).astype(kind)
    np.save(tmp_path / "a.npy", values)
    scaleaxis.write_image(tmp_path / "b.nrrd", values)
    for given in (values, tmp_path / "a.npy", tmp_path / "b.nrrd"):
        assert list(dict(scaleaxis.label_axes(given, 0.1))) == [2**24]
        assert scaleaxis.axis(given, 0.1, labels=2**24).topology.components == 1
    with pytest.raises(scaleaxis.UnusableInput):
        scaleaxis.axis(values, labels=2**24 + 1)


def test_a_label_that_is_given_twice_counts_once():
    values = two_beyond(3)
    for first in (3, 2**24 + 3):  # labels of more than 24 bits are numbered
        values[2:7, 2:7, 2:7], values[9:14, 9:14, 9:14] = first, first + 1
        expected = scaleaxis.axis(values, 0.1, labels=[first, first + 1])
        found = scaleaxis.axis(values, 0.1, labels=[first + 1, first, first + 1])
        np.testing.assert_array_equal(found.vertices, expected.vertices)
        with pytest.raises(scaleaxis.UnusableInput, match=f"no voxel has the label {first + 2}"):
            scaleaxis.axis(values, labels=[first, first + 2, first + 2])


def test_each_label_calls_any_function():
    values = labelled()
    curves = dict(scaleaxis.each_label(scaleaxis.skeleton, values, delta=0.05, **PLACE))
    assert list(curves) == [3, 7, 500]
    for label, found in curves.items():
        expected = scaleaxis.skeleton(values, delta=0.05, labels=label, **PLACE)
        np.testing.assert_allclose(found.nodes, expected.nodes, atol=1e-9)
    few = dict(scaleaxis.each_label(scaleaxis.spheres, values, count=4))
    assert [len(one.balls) for one in few.values()] == [4, 4, 4]
    with pytest.warns(scaleaxis.Warning, match="label (3|500): no wall") as told:
        sheets = dict(scaleaxis.each_label(lambda image, **options: one_sheet(image, **options), values))
    assert list(sheets) == [7] and len(told) == 2
    with pytest.warns(scaleaxis.Warning), pytest.raises(scaleaxis.UnusableInput, match="no wall"):
        dict(scaleaxis.each_label(lambda image, **options: one_sheet(image, **options), values * (values != 7)))
    with pytest.raises(scaleaxis.UnusableInput, match="no labels"):
        dict(scaleaxis.each_label(scaleaxis.skeleton, values * 0.5))


def test_each_label_keeps_the_voxels_of_the_image():
    values = labelled()
    for label, expected in scaleaxis.label_axes(values, 0.05, **PLACE):
        for function in (scaleaxis.axis, scaleaxis.skeleton):
            found = dict(scaleaxis.each_label(function, values, delta=0.05, **PLACE))[label]
            axis = found if isinstance(found, scaleaxis.Axis) else found.axis
            np.testing.assert_allclose(axis.transform, expected.transform)
    both = dict(scaleaxis.each_label(scaleaxis.axis, values, delta=0.05, scale=[1.0, 1.1], **PLACE))
    assert all((one.transform[:, 3] == PLACE["origin"]).all() for axes in both.values() for one in axes)


def test_each_label_takes_masks_and_files_and_refuses_images_without_labels(tmp_path):
    mask = np.zeros((9, 9, 9), dtype=bool)
    mask[2:7, 2:7, 2:7] = True
    np.save(tmp_path / "a.npy", mask * 3.0)
    for given, label in ((mask, 1), (mask * 3.0, 3), (tmp_path / "a.npy", 3)):
        found = list(dict(scaleaxis.each_label(scaleaxis.axis, given, delta=0.1)))
        assert found == [label] and type(found[0]) is int
    with pytest.raises(scaleaxis.UnusableInput, match="no labels"):
        list(scaleaxis.each_label(scaleaxis.axis, np.zeros((9, 9, 9), dtype=int)))
    with pytest.raises(scaleaxis.InvalidOption, match="every label"):
        scaleaxis.each_label(scaleaxis.axis, mask, labels=1)


def one_sheet(image, labels):
    if labels != 7:
        raise scaleaxis.UnusableInput("no wall")
    return scaleaxis.midsurface(image, labels=labels, delta=0.02)


def test_voids_are_filled():
    values = labelled()
    values[10:13, 10:13, 10:13] = 0
    assert scaleaxis.load(values, labels=3).solid.topology.voids == 1
    assert scaleaxis.load(values, labels=3, fill_voids=True).solid.topology.voids == 0
    found = dict(scaleaxis.label_axes(values, 0.03, fill_voids=True))
    assert found[3].topology.voids == 0
