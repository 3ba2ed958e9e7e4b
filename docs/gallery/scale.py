# SPDX-License-Identifier: Apache-2.0
"""
What s does
===========

The factor s decides how small a feature must be, in relation to what it sits on, to lose its branch of the axis.
"""

# %%
# Several scales share one sampling, so they cost little more than one. Balls that vanish in others once all
# have grown are *hidden*: they have no part in the axis.

import pyvista
import scaleaxis

axes = scaleaxis.axis("cat.obj", scale=[1.0, 1.1, 1.5])
for axis in axes:
    hidden = axis.statistics["axis"]["hidden_balls"]
    print(f"s = {axis.scale}: {hidden:5} of {len(axis.balls)} balls hidden by others, {axis.complex.sheets:4} sheets")

# %%
# Above the axis, below the solid that it stands for: the union of the balls of the axis, as a mesh. At s = 1
# every feature has its branch. At 1.5 the muscles of the shoulder and the muzzle have lost theirs, for they are
# small beside the body; ears, paws and tail stand alone, and keep theirs, with their place and thickness.

solid = pyvista.PolyData.from_regular_faces(*axes[0].boundary)

plotter = pyvista.Plotter(shape=(2, 3), window_size=(1350, 1000), border=False)
for column, axis in enumerate(axes):
    plotter.subplot(0, column)
    plotter.add_text(f"s = {axis.scale:g}", position="upper_edge", font_size=14)
    plotter.add_mesh(solid, color="lightblue", opacity=0.12, smooth_shading=True)
    plotter.add_mesh(axis.to_pyvista(), scalars="radius", line_width=3, show_scalar_bar=False)
    plotter.subplot(1, column)
    simplified = axis.mesh()
    plotter.add_mesh(
        pyvista.PolyData.from_regular_faces(simplified.vertices, simplified.faces),
        color="lightblue",
        smooth_shading=True,
        split_sharp_edges=True,
    )
plotter.link_views()
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.15)
plotter.show()

# %%
# Which s is right depends on the use: 1 to 1.05 for measuring thickness, 1.1 to 1.2 for a clean axis of a shape
# from a scanner or an image, 1.3 and more for a coarse skeleton. A large s may also close a narrow gap; then a
# warning names the place.
