# SPDX-License-Identifier: Apache-2.0
"""The filters in ParaView without a window."""

from __future__ import annotations

import inspect
from pathlib import Path

import numpy as np
import pytest
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

# Debian's ParaView 5.11.0 asks its Python 3.11 for what that has no more.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

simple.LoadPlugin(str(Path(__file__).parent / "scaleaxis_paraview.py"), remote=False, ns=globals())


def arrays(proxy):
    data = servermanager.Fetch(proxy)
    points, cells = data.GetPointData(), data.GetCellData()
    named = {
        group.GetArrayName(i): vtk_to_numpy(group.GetArray(i))
        for group in (points, cells)
        for i in range(group.GetNumberOfArrays())
    }
    return data, vtk_to_numpy(data.GetPoints().GetData()), named


@pytest.fixture
def torus():
    source = simple.Superquadric
    return simple.Clean(
        Input=simple.Triangulate(
            Input=source(Toroidal=1, Size=2.5, Thickness=0.25, ThetaResolution=96, PhiResolution=48, ThetaRoundness=1)
        )
    )


def test_axis_of_a_sphere():
    ball = simple.Sphere(Radius=2, Center=(1, 2, 3), ThetaResolution=64, PhiResolution=64)
    _, places, named = arrays(ScaleAxis(Input=ball, Delta=0.05))  # noqa: F821
    largest = named["radius"].argmax()
    assert named["radius"][largest] == pytest.approx(2, abs=0.02)
    assert np.linalg.norm(places[largest] - [1, 2, 3]) < 0.05


def test_skeleton_of_a_ring(torus):
    data, places, named = arrays(CurveSkeleton(Input=torus, Delta=0.02))  # noqa: F821
    assert data.GetNumberOfLines() > 20 and set(named) == {"radius", "branch"}
    middle = places.mean(axis=0)
    reach = np.linalg.norm(places - middle, axis=1)
    assert reach.std() < 0.05 * reach.mean()


def test_thickness_of_a_sphere():
    ball = simple.Sphere(Radius=1, ThetaResolution=64, PhiResolution=64)
    data, places, named = arrays(LocalThickness(Input=ball, Delta=0.05))  # noqa: F821
    assert data.GetNumberOfPolys() > 1000 and len(named["thickness"]) == len(places)
    assert np.abs(named["thickness"] - 2).max() < 0.05


def test_axis_of_voxels():
    source = simple.Wavelet(WholeExtent=[-10, 10, -10, 10, -10, 10])
    mask = simple.Calculator(Input=source, ResultArrayName="mask", Function="(coordsX^2+coordsY^2+coordsZ^2)<36")
    _, places, named = arrays(ScaleAxis(Input=mask, Delta=0.05))  # noqa: F821
    largest = named["radius"].argmax()
    # The last voxels along each axis are those at 5: those at 6 are not below.
    assert named["radius"][largest] == pytest.approx(5.5, abs=0.2) and np.abs(places[largest]).max() < 0.3


def test_options_make_it_anew():
    box = simple.Box()
    axis = ScaleAxis(Input=box, Delta=0.05, Growth=1.0)  # noqa: F821
    before = arrays(axis)[0].GetNumberOfPoints()
    axis.Delta = 0.02
    assert arrays(axis)[0].GetNumberOfPoints() > before
