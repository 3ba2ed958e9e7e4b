# SPDX-License-Identifier: Apache-2.0
"""
Data set on Dask
================

Many models in one call: here nine on this machine, and with the same call a million on a cluster.
"""

# %%
# The models: spheres with bumps, whose number and height differ, in a folder of their own.

import json
import tempfile
from pathlib import Path

import numpy as np
import pyvista
import scaleaxis
from scaleaxis.batch import batch

folder = Path(tempfile.mkdtemp())
(folder / "models").mkdir()
sphere = pyvista.Icosphere(nsub=5)
x, y, z = sphere.points.T
longitude, height = np.arctan2(y, x), np.hypot(x, y)
for arms in (2, 3, 4, 5, 6, 7):
    star = sphere.copy()
    star.points *= 1 + 0.45 * (height**arms * np.cos(arms * longitude))[:, None]
    star.save(folder / "models" / f"star-{arms}.stl")
for size in (0.4, 0.7, 1.0):
    waves = sphere.copy()
    waves.points *= 1 + size * (np.sin(4 * x) * np.sin(4 * y) * np.sin(4 * z))[:, None]
    waves.save(folder / "models" / f"waves-{size}.stl")

# %%
# Each model is a task of Dask and has a process of its own: one that crashes, or needs more than its share of
# time or memory, costs itself alone.

counts = batch(folder / "models", folder / "results", delta=0.015, scale=1.1, workers=2, time_limit=120)
print(counts)

# %%
# The same call again finds everything done. It would go on after an interruption in the same way.

print(batch(folder / "models", folder / "results", delta=0.015, scale=1.1, workers=2, time_limit=120))

# %%
# There is a row for each model, in JSON Lines and in Parquet (``pandas.read_parquet(folder / "results" /
# "rows.parquet")``), and a file with its axis.

rows = {}
for line in (folder / "results" / "rows.jsonl").read_text().splitlines():
    row = json.loads(line)
    rows[Path(row["path"]).stem] = row
print(sorted(rows["star-5"]))

# %%

plotter = pyvista.Plotter(shape=(3, 3), window_size=(1200, 1200), border=False)
for i, name in enumerate(sorted(rows)):
    complex = scaleaxis.read_axis(folder / "results" / rows[name]["result"])
    surface = pyvista.PolyData.from_regular_faces(complex.vertices, complex.triangles)
    surface["radius"] = complex.radii
    plotter.subplot(i // 3, i % 3)
    plotter.add_text(name, position="upper_edge", font_size=10)
    plotter.add_mesh(
        pyvista.read(folder / "models" / f"{name}.stl"), color="lightblue", opacity=0.2, smooth_shading=True
    )
    plotter.add_mesh(surface, scalars="radius", show_scalar_bar=False)
    plotter.view_vector((0.5, 0.35, 1.0))
    plotter.camera.zoom(1.3)
plotter.show()
