# SPDX-License-Identifier: Apache-2.0
"""
What δ does
===========

The tolerance δ decides how closely the balls follow the solid, and so what it costs.
"""

# %%
# δ is relative to the diagonal of the bounding box (or a length: ``delta_abs``). Half of it means two to
# three times the balls and the time.

import time

import matplotlib.pyplot as plt
import pyvista
import scaleaxis

axes = []
for delta in (0.04, 0.02, 0.01):
    start = time.perf_counter()
    axes.append(scaleaxis.axis("cat.obj", delta=delta, scale=1.1))
    seconds = time.perf_counter() - start
    print(f"δ = {delta}: {len(axes[-1].balls):5} balls, {seconds:.1f} s")

# %%
# Above the balls, below the axis at s = 1.1. Balls of a coarse δ lie in the solid as well, and each touches its
# boundary; there are only fewer of them. The topology is right at each: one part, no tunnel.

plotter = pyvista.Plotter(shape=(2, 3), window_size=(1350, 1000), border=False)
for column, axis in enumerate(axes):
    delta = axis.tolerance / axis.diagonal
    centers = pyvista.PolyData(axis.balls[:, :3])
    centers["radius"] = axis.balls[:, 3]
    spheres = centers.glyph(
        scale="radius", geom=pyvista.Sphere(radius=1.0, theta_resolution=24, phi_resolution=16), orient=False
    )
    plotter.subplot(0, column)
    plotter.add_text(f"delta = {delta:g}", position="upper_edge", font_size=14)
    plotter.add_mesh(spheres, color="lightblue", smooth_shading=True)
    plotter.subplot(1, column)
    plotter.add_mesh(axis.to_pyvista(), scalars="radius", line_width=3, show_scalar_bar=False)
plotter.link_views()
plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
plotter.camera.zoom(1.15)
plotter.show()

# %%
# How far is the surface of the cat from the balls? The largest and the mean distance fall with δ.
# ``delta="auto"`` takes the coarsest δ with the right topology and no sample farther than δ.

distances = [scaleaxis.compare("cat.obj", axis.balls, spacing=0.01).a_to_b for axis in axes]
relative = [axis.tolerance / axis.diagonal for axis in axes]

figure, plot = plt.subplots(figsize=(7, 4.2))
plot.loglog(relative, [distance.max / axes[0].diagonal for distance in distances], "o-", label="largest distance")
plot.loglog(relative, [distance.mean / axes[0].diagonal for distance in distances], "s-", label="mean distance")
plot.loglog(relative, relative, ":", color="gray", label="δ")
plot.set_xlabel("δ / diagonal")
plot.set_ylabel("distance from the surface to the balls / diagonal")
plot.set_xticks(relative, [f"{delta:g}" for delta in relative])
plot.minorticks_off()
plot.legend(frameon=False)
figure.tight_layout()
