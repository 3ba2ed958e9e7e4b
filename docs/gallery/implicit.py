# SPDX-License-Identifier: Apache-2.0
"""
Implicit function
=================

A solid is where a function is negative: a signed distance, a level set, a network, a formula.
"""

# %%
# Here a *gyroid*, a surface that divides space into two labyrinths, within a ball. The function gets many
# points at a time and returns one value each.

import numpy as np
import pyvista
import scaleaxis


def labyrinth(points):
    x, y, z = 4 * points.T
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    ball = 3 * (np.linalg.norm(points, axis=1) - 1.5)
    return np.maximum(gyroid, ball)


axis = scaleaxis.axis(labyrinth, bounds=[[-1.7] * 3, [1.7] * 3], delta=0.01, scale=1.1, smooth=10)
print(axis)
print(axis.topology)

# %%
# Only signs matter: the function need not be a distance. The axis runs through the middle of the labyrinth. It
# shows how the tunnels hang together, and how wide they are.

grid = pyvista.ImageData(dimensions=(90, 90, 90), spacing=(3.4 / 89,) * 3, origin=(-1.7,) * 3)
surface = grid.contour([0.0], scalars=labyrinth(np.asarray(grid.points)), method="flying_edges")

plotter = pyvista.Plotter(shape=(1, 2), window_size=(1350, 700), border=False)
plotter.add_text("f = 0", position="upper_edge", font_size=14)
plotter.add_mesh(surface, color="lightblue", smooth_shading=True, split_sharp_edges=True)
plotter.subplot(0, 1)
plotter.add_text("scale axis, s = 1.1", position="upper_edge", font_size=14)
plotter.add_mesh(
    axis.to_pyvista(),
    scalars="radius",
    line_width=4,
    scalar_bar_args={"title": "radius", "position_x": 0.78, "position_y": 0.03, "height": 0.3},
)
plotter.link_views()
plotter.view_vector((1.0, 0.6, 0.45), viewup=(0, 0, 1))
plotter.camera.zoom(1.3)
plotter.show()
