# SPDX-License-Identifier: Apache-2.0
"""
Round trip: shape, axis, mesh, distance
=======================================

From a shape to its axis, from the axis back to a shape, and how far the two are apart.
"""

# %%
# The axis has a ball at each vertex. The union of these balls is the simplified solid; ``mesh`` makes a closed
# triangle mesh of it.

import pyvista
import scaleaxis

axis = scaleaxis.axis("cat.obj", delta=0.01, scale=1.1)
simplified = axis.mesh()
simplified

# %%
# ``compare`` measures the distances both ways, between surfaces and not only between their vertices.

distance = scaleaxis.compare("cat.obj", simplified, spacing=0.005)
print(f"largest distance {distance.max:.4f}, that is {100 * distance.max / axis.diagonal:.2f} % of the diagonal")
print(f"mean, from the cat to the simplified solid: {distance.a_to_b.mean:.5f}")

# %%
# Where are they apart? The balls give the signed distance of any point: negative inside, positive outside. On
# the surface of the cat, red is what the simplified solid does not reach: the rims of the ears, the tips of the
# paws, and bumps that are small beside what they sit on. The scale is in per cent of the diagonal.

solid = scaleaxis.Envelope(axis)  # of the balls all over the axis
cat = pyvista.PolyData.from_regular_faces(*axis.boundary)
cat["distance"] = 100 * solid.signed_distances(cat.points) / axis.diagonal

plotter = pyvista.Plotter(shape=(1, 2), window_size=(1350, 700), border=False)
plotter.add_text("simplified solid", position="upper_edge", font_size=14)
plotter.add_mesh(
    pyvista.PolyData.from_regular_faces(simplified.vertices, simplified.faces), color="lightblue", smooth_shading=True
)
plotter.subplot(0, 1)
plotter.add_text("what it has lost", position="upper_edge", font_size=14)
plotter.add_mesh(
    cat,
    scalars="distance",
    cmap="OrRd",
    clim=(0, 0.5),
    smooth_shading=True,
    scalar_bar_args={"title": "%", "position_x": 0.06, "position_y": 0.5, "height": 0.4, "fmt": "%.1f"},
)
plotter.link_views()
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.15)
plotter.show()
