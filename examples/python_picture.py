#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A picture of an axis inside its solid, by PyVista without a screen: python_picture.py MESH PICTURE"""

import sys

import pyvista
import scaleaxis

axis = scaleaxis.axis(sys.argv[1], delta=0.01, scale=1.1)
solid = pyvista.PolyData.from_regular_faces(*axis.boundary)
plotter = pyvista.Plotter(off_screen=True, window_size=(900, 700))
plotter.add_mesh(solid, color="white", opacity=0.12)
plotter.add_mesh(
    axis.to_pyvista(), scalars="radius", cmap="viridis", scalar_bar_args={"title": "radius", "vertical": True}
)
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.screenshot(sys.argv[2])
