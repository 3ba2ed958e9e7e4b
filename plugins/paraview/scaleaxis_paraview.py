# SPDX-License-Identifier: Apache-2.0
"""Filters of ParaView: the scale axis, the curve skeleton, and the local thickness of a surface or of labels.

Tools → Manage Plugins → Load New takes this file, or `paraview.simple.LoadPlugin`. Python has to find scaleaxis.
"""

from __future__ import annotations

import warnings

import numpy as np
from paraview.util.vtkAlgorithm import smdomain, smproperty, smproxy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter


def _mesh_of(surface):
    triangulated = vtkTriangleFilter()
    triangulated.PassVertsOff()
    triangulated.PassLinesOff()
    triangulated.SetInputData(surface)
    triangulated.Update()
    data = triangulated.GetOutput()
    if data.GetNumberOfPolys() == 0:
        raise ValueError("the surface has no polygons")
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(data.GetPoints().GetData()), corners.reshape(-1, 3)


def _image_of(image):
    """The active scalars of points as voxels."""
    import scaleaxis

    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise ValueError("the image has no scalars at its points")
    turn = image.GetDirectionMatrix()
    direction = np.array([[turn.GetElement(i, k) for k in range(3)] for i in range(3)])
    steps = (direction * image.GetSpacing()).T
    origin = np.array(image.GetOrigin()) + np.array(image.GetExtent()[::2]) @ steps
    return scaleaxis.Image(vtk_to_numpy(scalars).reshape(image.GetDimensions(), order="F"), origin, steps)


def _fill(output, vertices, polygons, lines, of_points, of_polygons):
    """Lines come first among the cells; they have the sheet -1."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices), deep=True))
    output.SetPoints(points)

    def cells(offsets, indices):
        made = vtkCellArray()
        arrays = (
            numpy_to_vtkIdTypeArray(np.asarray(array, dtype=np.int64).copy(), deep=True) for array in (offsets, indices)
        )
        made.SetData(*arrays)
        return made

    output.SetLines(cells(np.arange(0, lines.size + 1, 2), lines.ravel()))
    output.SetPolys(cells(polygons.offsets, polygons.indices))
    for name, values in of_points.items():
        _add(output.GetPointData(), name, values)
    for name, values in of_polygons.items():
        others = np.full(len(lines), 0 if values.dtype.kind == "f" else -1, dtype=values.dtype)
        _add(output.GetCellData(), name, np.concatenate([others, values]))
    if of_points:
        output.GetPointData().SetActiveScalars(next(iter(of_points)))


def _add(data, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)


class _Filter(VTKPythonAlgorithmBase):
    """A surface or an image → polygons and lines."""

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=1, outputType="vtkPolyData")
        self._options = {"delta": 0.01, "scale": 1.1}

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject")
        return 1

    def RequestData(self, request, inputs, outputs):
        given = vtkDataObject.GetData(inputs[0])
        is_image = isinstance(given, vtkImageData)
        solid = _image_of(given) if is_image else _mesh_of(given)
        options = dict(self._options, **({"nonzero": True} if is_image else {}))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            self.make(solid, options, vtkPolyData.GetData(outputs))
        for warning in told:
            print(f"scaleaxis: {warning.message}")
        return 1

    def _set(self, name, value):
        if self._options[name] != value:
            self._options[name] = value
            self.Modified()

    @smproperty.doublevector(name="Delta", default_values=[0.01])
    @smdomain.doublerange(min=0.001, max=0.1)
    def SetDelta(self, value):
        self._set("delta", value)

    @smproperty.doublevector(name="Growth", default_values=[1.1])
    @smdomain.doublerange(min=1.0, max=2.0)
    def SetGrowth(self, value):
        self._set("scale", value)


def _filter(label):
    """What makes a class a filter of surfaces and images."""

    def decorated(known):
        known.SetDelta, known.SetGrowth = (
            _Filter.SetDelta,
            _Filter.SetGrowth,
        )  # it looks for properties in the class alone
        known = smdomain.datatype(dataTypes=["vtkPolyData", "vtkImageData"], composite_data_supported=False)(known)
        return smproxy.filter(name=known.__name__, label=label)(smproperty.input(name="Input", port_index=0)(known))

    return decorated


@_filter("Scale Axis")
class ScaleAxis(_Filter):
    """Sheets and curves, with the radius of points, sheet and angle of cells."""

    def make(self, solid, options, output):
        import scaleaxis

        axis = scaleaxis.axis(solid, **options)
        of_polygons = {"sheet": axis.sheets, "angle": axis.angles}
        _fill(output, axis.vertices, axis.polygons, axis.curves, {"radius": axis.radii}, of_polygons)


@_filter("Curve Skeleton")
class CurveSkeleton(_Filter):
    """Lines, with the radius and the branch of points; the filter Tube makes them as thick as the solid."""

    def make(self, solid, options, output):
        import scaleaxis

        found = scaleaxis.skeleton(solid, **options)
        _fill(output, found.nodes, found.faces, found.edges, {"radius": found.radii, "branch": found.node_branches}, {})


@_filter("Local Thickness")
class LocalThickness(_Filter):
    """The surface of the solid in triangles, with thickness and foot_thickness of points."""

    def make(self, solid, options, output):
        import scaleaxis

        found = scaleaxis.axis(solid, **options).thickness()
        vertices, triangles = found.surface
        polygons = scaleaxis.Polygons(np.arange(0, triangles.size + 1, 3), triangles.ravel())
        none = np.empty((0, 2), dtype=np.int32)
        _fill(output, vertices, polygons, none, {"thickness": found.local, "foot_thickness": found.foot}, {})
