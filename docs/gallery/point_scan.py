# SPDX-License-Identifier: Apache-2.0
"""
Point scan
==========

The axis of a solid that is known by points of its surface alone.
"""

# %%
# The scan: 20,000 random points of the surface of the cat, each off by about 0.1 % of the diagonal, with rough
# normals.

import numpy as np
import pyvista
import scaleaxis

vertices, faces = scaleaxis.read_mesh("cat.obj")
a, b, c = np.moveaxis(vertices[faces], 1, 0)
normals = np.cross(b - a, c - a)
areas = np.linalg.norm(normals, axis=1)

random = np.random.default_rng(1)
chosen = random.choice(len(faces), size=20_000, p=areas / areas.sum())
u, v = random.random((2, len(chosen), 1))
u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
points = a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]
points += random.normal(scale=0.001 * np.linalg.norm(np.ptp(vertices, axis=0)), size=points.shape)
normals = (normals / areas[:, None])[chosen] + random.normal(scale=0.2, size=points.shape)

# %%
# A surface is put through the points by moving least squares, which evens out the noise, and the solid behind
# it is treated like all others. Without ``normals`` they would be estimated.

axis = scaleaxis.axis(points, normals=normals, delta=0.012, scale=1.15)
print(axis)
print(axis.topology)

# %%

plotter = pyvista.Plotter(shape=(1, 2), window_size=(1350, 700), border=False)
plotter.add_text("20,000 points", position="upper_edge", font_size=14)
plotter.add_points(points, color="steelblue", point_size=6)
plotter.subplot(0, 1)
plotter.add_text("their scale axis", position="upper_edge", font_size=14)
plotter.add_points(points, color="steelblue", opacity=0.3, point_size=4)
plotter.add_mesh(axis.to_pyvista(), scalars="radius", line_width=4, show_scalar_bar=False)
plotter.link_views()
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.15)
plotter.show()

# %%
# How far is the result from the true cat? The noise was 0.1 % of the diagonal.

distance = scaleaxis.compare("cat.obj", axis.balls, spacing=0.01)
print(f"mean distance of the cat to the balls: {100 * distance.a_to_b.mean / axis.diagonal:.2f} % of the diagonal")
