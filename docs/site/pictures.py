# SPDX-License-Identifier: Apache-2.0
"""The pictures of how-it-works.md, and the model that the gallery reads: pictures.py FOLDER GALLERY_FOLDER

In the plane, everything is computed as the pipeline does it in space: samples of a boundary, the circles around
the Voronoi vertices inside, the same grown by s, the medial axis of their union, and the same shrunk by s. The
axis of a union of discs comes from many points of its boundary.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import contourpy
import matplotlib.pyplot as plt
import numpy as np
import pyvista
import scaleaxis
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from scipy.spatial import Delaunay, Voronoi, cKDTree

BLUE, ORANGE, RED, GREY = "#9ecae1", "#f28e2b", "#c0392b", "#444444"
CAT = Path(__file__).resolve().parents[2] / "data/cat.obj"
ALONG = np.linspace(0, 1, 500)
ARM = cKDTree(np.column_stack([1.2 + 2.0 * ALONG, 0.5 * ALONG**2]))  # its middle line


class Curves(NamedTuple):
    """A medial axis in the plane."""

    points: np.ndarray  # V × 2
    radii: np.ndarray  # V
    edges: np.ndarray  # E × 2


def shape(x: np.ndarray, y: np.ndarray, noise: float = 0.0) -> np.ndarray:
    """A body with a bump on it, and an arm about as thick as the bump; negative inside."""
    body = np.hypot(x / 1.5, y) - 1.0
    bump = np.hypot(x + 0.35, y - 0.98) - 0.17
    arm = ARM.query(np.stack([x, y], axis=-1))[0] - 0.17
    ripples = np.sin(23 * np.arctan2(y, x)) * np.cos(9 * np.arctan2(y, x)) * (np.hypot(x / 1.5, y) > 0.8) * (x < 1.35)
    return np.minimum(np.minimum(body, bump), arm) + noise * ripples


def boundary(noise: float = 0.0) -> np.ndarray:
    """The closed curve around the shape, N × 2."""
    x, y = np.meshgrid(np.linspace(-1.8, 3.7, 1101), np.linspace(-1.4, 1.6, 601))
    lines = contourpy.contour_generator(x, y, shape(x, y, noise)).lines(0.0)
    return max(lines, key=len)


def sampled(curve: np.ndarray, spacing: float) -> np.ndarray:
    """Points of a closed curve, evenly apart."""
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    count = int(np.ceil(lengths[-1] / spacing))
    at = np.arange(count) * lengths[-1] / count
    return np.column_stack([np.interp(at, lengths, coordinate) for coordinate in curve.T])


def inner_discs(samples: np.ndarray, noise: float = 0.0) -> np.ndarray:
    """N × 3: the circumcircles of Delaunay triangles whose centres lie inside."""
    a, b, c = np.moveaxis(samples[Delaunay(samples).simplices], 1, 0)
    u, v = b - a, c - a
    determinant = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = (u**2).sum(axis=1), (v**2).sum(axis=1)
    offset = np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu]) / determinant[:, None]
    center = a + offset
    inside = shape(*center.T, noise) < 0
    return np.column_stack([center, np.linalg.norm(offset, axis=1)])[inside]


def scaled(discs: np.ndarray, s: float) -> np.ndarray:
    return discs * [1, 1, s]


def is_hidden(discs: np.ndarray) -> np.ndarray:
    """Which discs lie in the union of the others, that is, have no part in its boundary."""
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    return np.array([not len(uncovered(disc[:2] + disc[2] * circle, discs)) for disc in discs])


def uncovered(points: np.ndarray, discs: np.ndarray) -> np.ndarray:
    """The points that lie in no disc."""
    depth = np.linalg.norm(points[:, None] - discs[None, :, :2], axis=-1) - discs[:, 2]
    return points[depth.min(axis=1) > -1e-9]


def union_boundary(discs: np.ndarray, spacing: float = 0.012) -> np.ndarray:
    """Points of the boundary of a union."""
    found = []
    for x, y, radius in discs:
        turn = np.linspace(0, 2 * np.pi, max(24, int(2 * np.pi * radius / spacing)), endpoint=False)
        found.append(uncovered(np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)]), discs))
    return np.concatenate(found)


def medial_axis(points: np.ndarray, inside: Callable[[np.ndarray], np.ndarray], angle: float) -> Curves:
    """The Voronoi edges inside, given many points of the boundary. Edges that see the two points next to them under
    less than twice the angle vanish from free ends, so that what is connected stays so.
    """
    diagram = Voronoi(points)
    is_inside = inside(diagram.vertices)
    edges = np.array(diagram.ridge_vertices)
    kept = (edges >= 0).all(axis=1) & is_inside[edges].all(axis=1)
    edges, contacts = edges[kept], points[diagram.ridge_points[kept]]
    middle = diagram.vertices[edges].mean(axis=1)
    first, second = contacts[:, 0] - middle, contacts[:, 1] - middle
    cosine = (first * second).sum(axis=1) / np.linalg.norm(first, axis=1) / np.linalg.norm(second, axis=1)
    is_weak = np.degrees(np.arccos(np.clip(cosine, -1, 1))) / 2 < angle
    remaining = np.ones(len(edges), dtype=bool)
    while True:
        degree = np.bincount(edges[remaining].ravel(), minlength=len(diagram.vertices))
        free = remaining & is_weak & (degree[edges] == 1).any(axis=1)
        if not free.any():
            break
        remaining &= ~free
    radii = np.zeros(len(diagram.vertices))
    for side in (0, 1):
        radii[edges[:, side]] = np.linalg.norm(diagram.vertices[edges[:, side]] - contacts[:, 0], axis=1)
    return Curves(diagram.vertices, radii, edges[remaining])


def axis_of_shape(curve: np.ndarray, noise: float) -> Curves:
    return medial_axis(sampled(curve, 0.01), lambda points: shape(*points.T, noise) < -0.01, 14.0)


def axis_of_discs(discs: np.ndarray) -> Curves:
    def inside(points: np.ndarray) -> np.ndarray:
        depth = np.linalg.norm(points[:, None] - discs[None, :, :2], axis=-1) - discs[:, 2]
        return depth.min(axis=1) < -1e-3

    return medial_axis(union_boundary(discs), inside, 30.0)


# Drawing


def draw_discs(
    plot: Axes, discs: np.ndarray, color: str, edge: str = "none", alpha: float = 1.0, width: float = 0.5
) -> None:
    size = 2 * discs[:, 2]
    plot.add_collection(
        EllipseCollection(
            size,
            size,
            np.zeros(len(discs)),
            offsets=discs[:, :2],
            units="xy",
            offset_transform=plot.transData,
            facecolors=color,
            edgecolors=edge,
            linewidths=width,
            alpha=alpha,
        )
    )


def draw_axis(plot: Axes, axis: Curves, color: str = RED) -> None:
    plot.add_collection(LineCollection(axis.points[axis.edges], colors=color, linewidths=2.2, capstyle="round"))


def draw_outline(plot: Axes, curve: np.ndarray) -> None:
    plot.plot(*np.vstack([curve, curve[:1]]).T, color=GREY, linewidth=1.1)


def panels(rows: int, columns: int, titles: list[str]) -> tuple[Figure, list[Axes]]:
    figure, plots = plt.subplots(rows, columns, figsize=(4.3 * columns, 2.85 * rows), squeeze=False)
    every = list(plots.flat)
    for plot, title in zip(every, titles):
        plot.set_title(title, fontsize=12)
        plot.set_xlim(-1.95, 3.65)
        plot.set_ylim(-1.4, 1.6)
        plot.set_aspect("equal")
        plot.axis("off")
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1 - 0.13 / rows, wspace=0.02, hspace=0.12)
    return figure, every


def draw_instability() -> Figure:
    figure, plots = panels(1, 2, ["a shape and its medial axis", "the same with ripples of 2 %"])
    for plot, noise in zip(plots, (0.0, 0.02)):
        curve = boundary(noise)
        plot.fill(*curve.T, color=BLUE, alpha=0.5)
        draw_outline(plot, curve)
        draw_axis(plot, axis_of_shape(curve, noise))
    return figure


def draw_samples() -> Figure:
    figure, plots = panels(2, 2, ["samples, δ large", "samples, δ small", "their balls", "their balls"])
    curve = boundary(0.02)
    for column, spacing in enumerate((0.28, 0.09)):
        samples = sampled(curve, spacing)
        plots[column].fill(*curve.T, color=BLUE, alpha=0.35)
        draw_outline(plots[column], curve)
        plots[column].plot(*samples.T, "o", color=GREY, markersize=4 - 1.2 * column)
        discs = inner_discs(samples, 0.02)
        draw_discs(plots[2 + column], discs, BLUE, GREY, 1.0, 0.3)
        plots[2 + column].plot(*discs[:, :2].T, "o", color=RED, markersize=2)
        draw_outline(plots[2 + column], curve)
    return figure


SCALES = (1.0, 1.15, 1.4)


def draw_growing(discs: np.ndarray) -> Figure:
    figure, plots = panels(1, 3, [f"s = {s:g}" for s in SCALES])
    for plot, s in zip(plots, SCALES):
        grown = scaled(discs, s)
        hidden = is_hidden(grown)
        plot.set_xlim(-2.35, 3.65)
        plot.set_ylim(-1.6, 1.75)
        draw_discs(plot, grown, "#d6e6f2")
        draw_discs(plot, grown[~hidden], "none", "#4a7fa8", 0.6, 0.5)
        plot.plot(*grown[~hidden, :2].T, "o", color="#1f4e79", markersize=2.5)
        plot.plot(*grown[hidden, :2].T, "o", color=ORANGE, markersize=3.5)
        draw_outline(plot, boundary(0.02))
        plot.set_title(f"s = {s:g}: {hidden.sum()} of {len(discs)} balls hidden", fontsize=12)
    return figure


def draw_axes(discs: np.ndarray) -> Figure:
    titles = [f"s = {s:g}: the grown balls and their axis" for s in SCALES] + ["shrunk again"] * 3
    figure, plots = panels(2, 3, titles)
    for column, s in enumerate(SCALES):
        grown = scaled(discs, s)
        axis = axis_of_discs(grown)
        above, below = plots[column], plots[3 + column]
        for plot in (above, below):
            plot.set_xlim(-2.35, 3.65)
            plot.set_ylim(-1.6, 1.75)
        draw_discs(above, grown, BLUE)
        draw_axis(above, axis)
        used = np.unique(axis.edges)
        draw_discs(below, np.column_stack([axis.points[used], axis.radii[used] / s]), BLUE)
        draw_outline(below, boundary(0.02))
        draw_axis(below, axis)
    return figure


def spheres(balls: np.ndarray) -> pyvista.PolyData:
    centers = pyvista.PolyData(balls[:, :3])
    centers["radius"] = balls[:, 3]
    ball = pyvista.Sphere(radius=1.0, theta_resolution=20, phi_resolution=14)
    return centers.glyph(scale="radius", geom=ball, orient=False)


def draw_complex(plotter: pyvista.Plotter, complex: scaleaxis.MedialComplex) -> None:
    surface = pyvista.PolyData.from_regular_faces(complex.vertices, complex.triangles)
    surface["radius"] = complex.radii
    plotter.add_mesh(surface, scalars="radius", cmap="viridis", show_scalar_bar=False)
    uses = np.bincount(complex.face_edges, minlength=len(complex.edges))
    lines = np.insert(complex.edges[uses != 2], 0, 2, axis=1)  # borders, seams and curves
    plotter.add_mesh(pyvista.PolyData(complex.vertices, lines=lines.ravel()), color="#303030", line_width=2)


def draw_pipeline(file: Path) -> None:
    """Each stage of the pipeline, of the cat."""
    s = 1.2
    loaded = scaleaxis.load(CAT)
    solid = loaded.solid
    samples = scaleaxis.sample(solid, scaleaxis.tolerance_of(0.015, solid.diagonal))
    balls = scaleaxis.union_of(samples, solid, topology=solid.topology).balls
    grown = scaleaxis.scaled(balls, s)
    medial = scaleaxis.medial_axis(grown).complex
    kept = scaleaxis.filter(medial, 30).complex
    axis = scaleaxis.shrink(kept, s)
    vertices, faces = scaleaxis.read_mesh(CAT)

    plotter = pyvista.Plotter(shape=(2, 3), window_size=(1500, 1080), border=False)
    titles = [
        "1  samples",
        "2  balls",
        f"grown by s = {s:g}",
        "3  medial axis",
        "4  filtered",
        f"5  shrunk by s = {s:g}",
    ]
    for i, title in enumerate(titles):
        plotter.subplot(i // 3, i % 3)
        plotter.add_text(title, position=(0.04, 0.93), viewport=True, font_size=14)
    plotter.subplot(0, 0)
    plotter.add_points(samples.points, color="steelblue", point_size=7)
    plotter.subplot(0, 1)
    plotter.add_mesh(spheres(balls), color="lightblue", smooth_shading=True)
    plotter.subplot(0, 2)
    plotter.add_mesh(spheres(grown), color="orange", smooth_shading=True)
    plotter.subplot(1, 0)
    draw_complex(plotter, medial)
    plotter.subplot(1, 1)
    draw_complex(plotter, kept)
    plotter.subplot(1, 2)
    draw_complex(plotter, axis)
    plotter.add_mesh(
        pyvista.PolyData.from_regular_faces(vertices, faces), color="lightblue", opacity=0.25, smooth_shading=True
    )
    plotter.link_views()
    plotter.view_vector((0.6, 0.25, 1.0), viewup=(0, 1, 0))
    plotter.camera.zoom(1.15)
    plotter.screenshot(file)


def main(folder: Path, gallery: Path) -> None:
    pyvista.OFF_SCREEN = True
    pyvista.global_theme.background = "white"
    pyvista.global_theme.font.color = "black"
    pyvista.global_theme.font.family = "arial"
    pyvista.global_theme.anti_aliasing = "ssaa"
    pyvista.PolyData.from_regular_faces(*scaleaxis.read_mesh(CAT)).save(gallery / "cat.stl")
    folder.mkdir(parents=True, exist_ok=True)
    last = folder / "pipeline.png"
    if last.exists() and last.stat().st_mtime > Path(__file__).stat().st_mtime:
        return  # drawn before, by this script
    discs = inner_discs(sampled(boundary(0.02), 0.09), 0.02)
    for name, figure in (
        ("instability", draw_instability()),
        ("samples", draw_samples()),
        ("growing", draw_growing(discs)),
        ("axes", draw_axes(discs)),
    ):
        figure.savefig(folder / f"{name}.png", dpi=150)
    draw_pipeline(last)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
