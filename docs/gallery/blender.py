# SPDX-License-Identifier: Apache-2.0
"""
Blender
=======

An axis as an object in Blender, with its colours and with its radii.
"""

# %%
# GLB is what Blender, browsers and game engines read best. The axis is in it as triangles and lines, and the
# radius of each vertex as an attribute ``_RADIUS``.

import pyvista
import scaleaxis

axis = scaleaxis.axis("cat.obj", delta=0.01, scale=1.1)
axis.save("cat-axis.glb")

# %%
# What is in the file, read back by PyVista:

plotter = pyvista.Plotter()
for part in pyvista.read("cat-axis.glb").recursive_iterator():
    print(part.n_points, "points,", part.n_cells, "triangles or lines, with", part.point_data.keys())
    plotter.add_mesh(part, scalars="_RADIUS", line_width=5, scalar_bar_args={"title": "_RADIUS"})
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.1)
plotter.show()

# %%
# In Blender: *File, Import, glTF 2.0*. ``_RADIUS`` is then an attribute of the mesh, for materials and geometry
# nodes; *Mesh to Points* with it as radius draws the balls. Or in the *Scripting* tab:
#
# .. literalinclude:: ../../examples/blender_import.py
#    :language: python
#    :lines: 4-
#
# .. image:: ../images/blender.png
#    :alt: The axis of the cat, coloured by radius, inside the cat as glass, rendered by Blender
#
# .. note:: This part was not run when the site was built, since it needs Blender. The script was tried by hand with
#    ``bpy`` 5.0.1, Blender as a Python module. The picture was rendered after it by Cycles; camera, lights and the cat
#    as glass are not in the script.
