# SPDX-License-Identifier: Apache-2.0
"""
Volume in blocks
================

An image that is larger than memory is cut into blocks; what they give is, to the last bit, what the whole gives. This
one is small, so that both can be compared.
"""

# %%
# Three rings, as voxels in a file that is read block by block. Zarr, NRRD, NIfTI and others will do as well.

import tempfile
from pathlib import Path

import numpy as np
import pyvista
import scaleaxis
from scaleaxis.volumes import volume

folder = Path(tempfile.mkdtemp())
z, y, x = np.indices((40, 40, 96)) - np.array([20.3, 20.1, 24.2]).reshape(3, 1, 1, 1)
rings = [np.hypot(np.hypot(x - shift, y) - 13, z) < 3 for shift in (0, 24, 48)]
np.save(folder / "rings.npy", np.logical_or.reduce(rings).astype(np.uint8))

# %%
# In blocks of 32 voxels, and in one piece. Each block is read with a halo, which is as wide as the solid is thick there
# times about five.

parts = volume(folder / "rings.npy", folder / "parts", block=32, angle=30, thickness=True)
whole = volume(folder / "rings.npy", folder / "whole", block=96)
print(parts.blocks, "blocks and", whole.blocks)
print("the same bytes:", (folder / "parts/axis.ply").read_bytes() == (folder / "whole/axis.ply").read_bytes())

# %%
# The topology of the axis is that of the voxels: one part with three tunnels.

print(parts.topology, "and of the solid an Euler characteristic of", parts.solid_euler)

# %%
# The axis without what is seen at less than 30°, coloured by radius; and where the blocks meet.

complex = scaleaxis.read_axis(folder / "parts/filtered.ply")
plotter = pyvista.Plotter(window_size=(900, 500))
plotter.add_mesh(complex.to_pyvista(), scalars="radius", line_width=3)
for place in (32, 64):
    plane = pyvista.Plane(center=(place, 20, 20), direction=(1, 0, 0), i_size=40, j_size=40)
    plotter.add_mesh(plane, color="gray", opacity=0.3)
plotter.show()
