# SPDX-License-Identifier: Apache-2.0
"""Arrays in any layout and type give the same; those of the right one are not copied; others are refused clearly."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import scaleaxis
from scaleaxis import _arrays


def layouts(array: np.ndarray) -> list[np.ndarray]:
    strided = np.zeros((2 * len(array), array.shape[1] + 3), dtype=array.dtype)[::2, 1:-2]
    strided[:] = array
    read_only = array.copy()
    read_only.setflags(write=False)
    swapped = array.astype(array.dtype.newbyteorder())
    backwards = np.ascontiguousarray(array[::-1])[::-1]
    return [np.asfortranarray(array), strided, read_only, swapped, backwards]


def test_any_layout_of_a_mesh(box):
    vertices, faces = box
    expected = scaleaxis.axis(box, delta=0.05).vertices
    for other in layouts(vertices):
        assert np.array_equal(scaleaxis.axis((other, faces), delta=0.05).vertices, expected)
    for other in layouts(faces):
        assert np.array_equal(scaleaxis.axis((vertices, other), delta=0.05).vertices, expected)


@pytest.mark.parametrize("dtype", [np.float32, np.float16, np.int64, np.uint8, np.longdouble])
def test_any_type_of_vertices(box, dtype):
    expected = scaleaxis.axis(box, delta=0.05).vertices  # of small whole numbers
    assert np.array_equal(scaleaxis.axis((box[0].astype(dtype), box[1]), delta=0.05).vertices, expected)


@pytest.mark.parametrize("dtype", [np.int64, np.uint64, np.uint8, np.float64])
def test_any_type_of_faces(box, dtype):
    expected = scaleaxis.axis(box, delta=0.05).vertices
    assert np.array_equal(scaleaxis.axis((box[0], box[1].astype(dtype)), delta=0.05).vertices, expected)


def test_arrays_of_the_right_type_are_not_copied(box):
    vertices, faces = _arrays.mesh(*box)
    assert vertices is box[0] or np.shares_memory(vertices, box[0])
    assert np.shares_memory(faces, box[1])
    places = np.random.default_rng(1).normal(size=(100, 3))
    places.setflags(write=False)
    assert np.shares_memory(_arrays.points(places), places)
    balls = np.ones((5, 4))
    assert np.shares_memory(_arrays.balls(balls), balls)
    voxels = np.zeros((4, 5, 6), dtype=np.float32, order="F")
    assert np.shares_memory(_arrays.voxels(voxels), voxels)


GROWTH = """
import numpy as np, scaleaxis
union = scaleaxis.BallUnion([[0, 0, 0, 1.0]])
union.inside(np.zeros((10, 3)))
places = np.ones((4_000_000, 3), order={order!r})  # 96 MB
before = scaleaxis.peak_memory()
union.inside(places)
print(scaleaxis.peak_memory() - before)
"""


@pytest.mark.parametrize(("order", "is_copied"), [("C", False), ("F", True)])
def test_the_module_looks_at_arrays_where_they_lie(order, is_copied):
    """In a process of its own, whose peak of memory is that of this call."""
    code = [sys.executable, "-c", GROWTH.format(order=order)]
    growth = int(subprocess.run(code, capture_output=True, text=True, check=True).stdout)
    assert (growth > 90e6) == is_copied, growth


def test_results_own_their_memory(box):
    axis = scaleaxis.axis(box, delta=0.05)
    vertices = axis.vertices
    copy = vertices.copy()
    assert vertices.flags.c_contiguous and vertices.flags.writeable and not vertices.flags.owndata
    del axis
    junk = [np.full(vertices.shape, 7.0) for _ in range(20)]
    assert np.array_equal(vertices, copy) and junk


POINTS = np.zeros((5, 3))
FACES = np.zeros((2, 3), dtype=int)
NAN = np.array([[0, 0, 0], [0, np.nan, 0], [1, 1, 1]])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: scaleaxis.axis((POINTS[:, :2], FACES)), r"vertices must be N × 3, but its shape is \(5, 2\)"),
        (lambda: scaleaxis.axis((POINTS, FACES[:, :2])), r"faces must be N × 3, but its shape is \(2, 2\)"),
        (lambda: scaleaxis.axis((NAN, FACES)), "vertices must be finite, but row 1 is not"),
        (lambda: scaleaxis.axis((POINTS, FACES + 5)), "faces must lie from 0 to 4, but they go from 5 to 5"),
        (lambda: scaleaxis.axis((POINTS, FACES - 1)), "faces must lie from 0 to 4"),
        (lambda: scaleaxis.axis((POINTS, FACES + 0.5)), "faces must hold whole numbers"),
        (lambda: scaleaxis.axis((POINTS, [["a", "b", "c"]])), "faces must hold real numbers"),
        (lambda: scaleaxis.axis(([[1, 2, 3], [1, 2]], FACES)), "solid|inhomogeneous|vertices"),
        (lambda: scaleaxis.axis((POINTS, np.zeros((0, 3)))), "the mesh is empty: it has no faces"),
        (lambda: scaleaxis.axis(POINTS.astype(complex)), "real numbers"),
        (lambda: scaleaxis.axis(POINTS, scale=[]), "scale is empty"),
        (lambda: scaleaxis.axis(POINTS, scale=[1.0, np.nan]), "scale must be finite"),
        (lambda: scaleaxis.BallUnion(POINTS), r"balls must be N × 4, but its shape is \(5, 3\)"),
        (lambda: scaleaxis.BallUnion(np.full((2, 4), np.nan)), "ball 1"),
        (lambda: scaleaxis.medial_axis(np.empty((0, 4))), "ball"),
        (lambda: scaleaxis.function_solid(len, [0, 1]), r"bounds must be .* its shape is \(2,\)"),
        (lambda: scaleaxis.BallUnion([[0, 0, 0, 1]]).inside([1, 2, 3]), "points must be N × 3"),
        (lambda: scaleaxis.BallUnion([[0, 0, 0, 1]]).inside(NAN), "points must be finite, but row 1"),
        (lambda: scaleaxis.image_solid(np.zeros((3, 3))), "voxels must have three dimensions"),
    ],
)
def test_faults_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_nothing_asked_nothing_answered():
    union = scaleaxis.BallUnion([[0, 0, 0, 1.0]])
    assert union.inside([]).shape == (0,)
    assert union.signed_distances(np.empty((0, 3))).shape == (0,)
    assert scaleaxis.union_solid([[0, 0, 0, 1.0]]).nearest([]).shape == (0, 3)
    assert scaleaxis.scaled(np.empty((0, 4)), 2.0).shape == (0, 4)
