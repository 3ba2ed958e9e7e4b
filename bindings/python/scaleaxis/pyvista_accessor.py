# SPDX-License-Identifier: Apache-2.0
"""What PyVista finds by the entry points of the package: `mesh.scaleaxis`, and a reader of `.ma` files. It imports this
module when either is asked for first.
"""

from __future__ import annotations

from typing import Any

import pyvista

from . import curves, files, measures, pipeline
from .result import Axis


@pyvista.register_dataset_accessor("scaleaxis", pyvista.DataSet)
class ScaleAxisAccessor:
    """Axis, skeleton and thickness of a data set of PyVista, as data sets: a mesh or grid stands for what its surface
    bounds, an image for the voxels of its active scalars, points without faces for a point cloud.
    """

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def axis(self, **options: Any) -> pyvista.PolyData:
        """The discrete scale axis, with "radius" of points, "sheet" and "angle" of cells: `Axis.to_pyvista`.

        options: of `scaleaxis.axis`, with one scale.
        """
        return self._axis(options).to_pyvista()

    def skeleton(self, **options: Any) -> pyvista.PolyData:
        """The curve skeleton, with "radius", "branch" and "component" of points: `Skeleton.to_pyvista`.

        options: of `scaleaxis.skeleton`.
        """
        return curves.skeleton(self._dataset, **options).to_pyvista()

    def thickness(self, *, angle: float = 128.0, edge: float = 0.01, **options: Any) -> pyvista.PolyData:
        """The surface of the solid in triangles, with its "thickness" and its "foot_thickness" at points.

        angle, edge: of `scaleaxis.thickness`.
        options: of `scaleaxis.axis`, with one scale.
        """
        axis = self._axis(options)
        found = measures.thickness(axis, angle=angle, edge=edge, threads=options.get("threads", 0))
        assert found.surface is not None
        surface = pyvista.PolyData.from_regular_faces(found.surface.vertices, found.surface.triangles)
        surface.point_data["foot_thickness"] = found.foot
        surface.point_data["thickness"] = found.local
        return surface

    def _axis(self, options: dict[str, Any]) -> Axis:
        axis = pipeline.axis(self._dataset, **options)
        if not isinstance(axis, Axis):
            raise ValueError("one scale is needed here; scaleaxis.axis takes several")
        return axis


def read_ma(path: str, **options: Any) -> pyvista.PolyData:
    """A file `.ma`, as an axis in PyVista."""
    return files.read_axis(path).to_pyvista()
