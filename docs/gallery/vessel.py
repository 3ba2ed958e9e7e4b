# SPDX-License-Identifier: Apache-2.0
"""
Vessel from an image
====================

Centre lines and radii of a branching vessel in a 3D image.
"""

# %%
# The image stands for a scan: a tree of vessels drawn into an array of voxels, blurred as by a scanner, and
# with noise. Voxels are twice as long in z as they are in x and y, as they often are.

import matplotlib.pyplot as plt
import networkx
import numpy as np
import pyvista
import scaleaxis

spacing = np.array([0.5, 0.5, 1.0])  # mm
random = np.random.default_rng(4)


def branches(start, direction, radius, depth):
    """The segments of a tree: begin, end, radius at each."""
    end = start + direction * (5 + 4 * radius)
    yield start, end, radius, 0.85 * radius
    if depth:
        side = np.cross(direction, random.normal(size=3))
        side /= np.linalg.norm(side)
        for angle, thinner in ((0.5, 0.82), (-0.7, 0.7)):
            turned = np.cos(angle) * direction + np.sin(angle) * side
            yield from branches(end, turned, thinner * radius, depth - 1)


tree = list(branches(np.zeros(3), np.array([0.0, 0.0, 1.0]), 4.0, 3))
ends = np.array([place for begin, end, *_ in tree for place in (begin, end)])
origin = ends.min(axis=0) - 6
shape = np.ceil((ends.max(axis=0) + 6 - origin) / spacing).astype(int)
voxels = origin + spacing * np.moveaxis(np.indices(shape), 0, -1)

depth = np.full(shape, 1e-9)  # e to the power of twice the distance to the walls, in mm
for begin, end, first, last in tree:
    low = ((np.minimum(begin, end) - first - 3 - origin) // spacing).astype(int).clip(0)
    high = ((np.maximum(begin, end) + first + 3 - origin) // spacing).astype(int) + 1
    around = tuple(map(slice, low, high))
    along = end - begin
    t = np.clip((voxels[around] - begin) @ along / (along @ along), 0, 1)
    to_center = np.linalg.norm(voxels[around] - begin - t[..., None] * along, axis=-1)
    depth[around] += np.exp(2 * (first + t * (last - first) - to_center))
image = 100 * depth / (1 + depth) + random.normal(scale=4, size=shape)

plt.figure(figsize=(7, 5))
plt.imshow(image.max(axis=1).T, cmap="gray", aspect=spacing[2] / spacing[0], origin="lower")
plt.title(f"the image, {' × '.join(map(str, shape))} voxels: the brightest along y")
plt.axis("off")
plt.tight_layout()

# %%
# Where the image is brighter than ``iso``, there is vessel. Between voxels it is interpolated, so the surface
# is finer than the voxels. Bumps of noise on the walls would each get a branch; s = 1.2 keeps them out.

axis = scaleaxis.axis(image, spacing=spacing, origin=origin, iso=50, delta_abs=0.6, scale=1.2, angle=60)
print(axis)
print(axis.topology)

# %%
# Vessels are round, so the axis is close to lines: curves, and narrow strips where a vessel is not quite round. Its
# radii are those of the vessels, in mm.

walls = pyvista.ImageData(dimensions=shape, spacing=spacing, origin=origin).contour([50], image.ravel(order="F"))
lines = axis.to_pyvista().extract_all_edges()

plotter = pyvista.Plotter()
plotter.add_mesh(walls, color="indianred", opacity=0.2, smooth_shading=True)
plotter.add_mesh(lines.tube(radius=0.35), scalars="radius", scalar_bar_args={"title": "radius, mm"})
plotter.view_vector((0.2, 1.0, 0.1), viewup=(0, 0, 1))
plotter.camera.zoom(1.3)
plotter.show()

# %%
# As a graph it has paths: here from the root to the farthest tip. The radius along the path is larger at junctions,
# where there is more room, and elsewhere a little smaller than what was drawn, since balls touch the dents of noise.

graph = axis.to_networkx()
root = axis.vertices[:, 2].argmin()
lengths, paths = networkx.single_source_dijkstra(graph, root, weight="length")
path = paths[max(lengths, key=lengths.get)]


def drawn_radius(place):
    """That of the segment whose centre line is nearest."""
    found = []
    for begin, end, first, last in tree:
        along = end - begin
        t = np.clip((place - begin) @ along / (along @ along), 0, 1)
        found.append((np.linalg.norm(place - begin - t * along), first + t * (last - first)))
    return min(found)[1]


plt.figure(figsize=(7, 4))
plt.plot([lengths[i] for i in path], axis.radii[path], label="radius of the axis")
plt.plot([lengths[i] for i in path], [drawn_radius(axis.vertices[i]) for i in path], ":", color="gray", label="drawn")
plt.xlabel("length from the root, mm")
plt.ylabel("radius, mm")
plt.ylim(0)
plt.legend(frameon=False)
plt.tight_layout()

# sphinx_gallery_thumbnail_number = 2
