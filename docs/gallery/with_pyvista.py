# SPDX-License-Identifier: Apache-2.0
"""
PyVista: thickness of a solid
=============================

What PyVista can do with an axis: measure, cut open, draw balls.
"""

# %%
# The radius of the axis is half the thickness of the solid around it. Carried to the surface, it is a map of
# thickness: each point of the surface takes the radius of the ball that is nearest to it.

import numpy as np
import pyvista
import scaleaxis

axis = scaleaxis.axis("cat.obj", delta=0.01, scale=1.05)
cat = pyvista.PolyData.from_regular_faces(*axis.boundary)
nearest = axis.nearest_vertices(cat.points)
cat["thickness"] = 2 * axis.radii[nearest]

plotter = pyvista.Plotter()
plotter.add_mesh(cat, scalars="thickness", cmap="turbo", smooth_shading=True)
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()

# %%
# ``to_pyvista`` returns a ``PolyData`` with polygons and curves: points have ``radius``, cells have ``sheet``
# and ``angle``. So all filters of PyVista work on it. Here the cat is cut open, and one half of its axis stays.

surface = axis.to_pyvista()
normal, origin = (0.25, 0.0, 1.0), cat.center

plotter = pyvista.Plotter()
plotter.add_mesh(cat.clip(normal, origin=origin), color="lightblue", smooth_shading=True, opacity=0.5)
plotter.add_mesh(surface, scalars="angle", cmap="viridis", line_width=4, scalar_bar_args={"title": "angle"})
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()

# %%
# A few balls of the axis: the largest one, then again and again the largest whose centre no chosen ball covers.
# So few spheres are a proxy for collisions.

chosen = []
free = np.ones(len(axis.radii), dtype=bool)
while free.any():
    largest = np.flatnonzero(free)[axis.radii[free].argmax()]
    chosen.append(largest)
    free &= np.linalg.norm(axis.vertices - axis.vertices[largest], axis=1) > axis.radii[largest]
centers = pyvista.PolyData(axis.vertices[chosen])
centers["radius"] = axis.radii[chosen]
balls = centers.glyph(scale="radius", geom=pyvista.Sphere(radius=1.0), orient=False)
print(f"{len(chosen)} balls of {len(axis.radii)}")

plotter = pyvista.Plotter()
plotter.add_mesh(balls, color="darkorange", smooth_shading=True)
plotter.add_mesh(cat, color="lightblue", opacity=0.2, smooth_shading=True)
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()
