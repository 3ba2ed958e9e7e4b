# SPDX-License-Identifier: Apache-2.0
"""
First axis
==========

From a mesh to its discrete scale axis, and a picture of it.
"""

# %%
# A file with a closed mesh is all that is needed: STL, OBJ, OFF or PLY. The defaults, δ = 0.01 of the diagonal
# and s = 1.1, are good for most shapes.

import numpy as np
import pyvista
import scaleaxis

axis = scaleaxis.axis("cat.stl")
axis

# %%
# The axis is a surface inside the solid, with curves where the solid is round, as in the tail. Each vertex has
# the radius of the ball around it that fits into the solid. Yellow is thick, violet is thin.

solid = pyvista.PolyData.from_regular_faces(*axis.boundary)

plotter = pyvista.Plotter()
plotter.add_mesh(solid, color="lightblue", opacity=0.18, smooth_shading=True)
plotter.add_mesh(axis.to_pyvista(), scalars="radius", line_width=4, scalar_bar_args={"title": "radius"})
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()

# %%
# All of it is NumPy arrays.

print(axis.vertices.shape, axis.radii.shape, axis.edges.shape, axis.triangles.shape)
print(axis.topology)

# %%
# The surface is cut into *sheets*, which meet at seams. Each polygon knows the number of its sheet, and the
# angle at which it sees the boundary. Here each sheet has a colour of its own; borders and seams are drawn as
# lines.

sheets = axis.to_pyvista()
by_size = np.argsort(np.argsort(-np.bincount(axis.sheets)))  # 0: the sheet with the most polygons
sheets.cell_data["color"] = by_size[sheets.cell_data["sheet"]] % 8
seams = sheets.extract_feature_edges(feature_edges=False, manifold_edges=False)

plotter = pyvista.Plotter()
plotter.add_mesh(solid, color="lightblue", opacity=0.12, smooth_shading=True)
plotter.add_mesh(sheets, scalars="color", cmap="Set2", show_scalar_bar=False)
plotter.add_mesh(seams, color="black", line_width=3)
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()

# %%
# What was computed is kept in a file for later, or for other programs: PLY, VTP, OBJ, GLB or .ma.

axis.save("cat-axis.ply")
