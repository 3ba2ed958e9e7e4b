# SPDX-License-Identifier: Apache-2.0
"""What napari shows in its menus: labels → axis, skeleton, thickness. The manifest is napari.yaml."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import scaleaxis

if TYPE_CHECKING:
    import napari.layers
    import napari.types


def _input(labels: napari.layers.Labels, label: int) -> dict[str, Any]:
    """The options of an image: lengths are those of the layer's scale, so that balls are round."""
    if labels.data.ndim != 3:
        raise ValueError(f"labels of three dimensions are needed, not of {labels.data.ndim}")
    solid = {"nonzero": True} if label == 0 else {"labels": label}
    return {**solid, "spacing": tuple(map(float, labels.scale))}


def _place(labels: napari.layers.Labels) -> dict[str, Any]:
    """Where a layer lies whose data have the scale of the labels in them."""
    names = ("rotate", "shear", "translate", "affine", "units", "axis_labels")
    return {name: getattr(labels, name) for name in names if hasattr(labels, name)}


def sheets(
    labels: napari.layers.Labels, label: int = 0, delta: float = 0.01, scale: float = 1.1
) -> napari.types.LayerDataTuple:
    """The discrete scale axis as a surface, coloured by the radius of its balls; label 0: all of them together."""
    axis = scaleaxis.axis(np.asarray(labels.data), delta, scale, **_input(labels, label))
    options = {"name": f"axis of {labels.name}", "colormap": "viridis", **_place(labels)}
    return (axis.vertices, axis.triangles, axis.radii), options, "surface"


def skeleton(
    labels: napari.layers.Labels, label: int = 0, delta: float = 0.01, scale: float = 1.1
) -> napari.types.LayerDataTuple:
    """The curve skeleton as a path for each branch, with its mean radius and its length; label 0: all together."""
    found = scaleaxis.skeleton(np.asarray(labels.data), delta=delta, scale=scale, **_input(labels, label))
    branches = [np.asarray(branch) for branch in found.branches]
    options = {
        "name": f"skeleton of {labels.name}",
        "shape_type": "path",
        "edge_width": 0.5 * float(np.min(labels.scale)),
        "edge_color": "radius",
        "edge_colormap": "viridis",
        "features": {"radius": [found.radii[branch].mean() for branch in branches], "length": found.lengths},
        **_place(labels),
    }
    return [found.nodes[branch] for branch in branches], options, "shapes"


def thickness(labels: napari.layers.Labels, label: int = 0, delta: float = 0.01) -> napari.types.LayerDataTuple:
    """Local thickness, the diameter of the largest ball inside that contains the voxel, as an image; 0 outside."""
    values = np.asarray(labels.data)
    options = _input(labels, label)
    axis = scaleaxis.axis(values, delta, 1.0, **options)
    mask = scaleaxis.Image(values == label if label else values != 0, spacing=options["spacing"])
    found = scaleaxis.thickness_image(axis, mask)
    shown = {"name": f"thickness of {labels.name}", "colormap": "inferno", "scale": labels.scale, **_place(labels)}
    return found.values, shown, "image"
