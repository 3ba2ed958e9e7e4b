# SPDX-License-Identifier: Apache-2.0
"""The manifest as npe2 sees it, and the commands on labels, without a window."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from magicgui.signature import magic_signature
from napari.components import ViewerModel
from napari.layers import Image, Labels, Layer, Shapes, Surface
from npe2 import PluginManager


@pytest.fixture(scope="module")
def commands():
    manager = PluginManager.instance()
    manager.discover()
    return manager.commands


@pytest.fixture(scope="module")
def labels():
    """A torus (7) in the plane of the last two indices, ring 8, tube 2.5; and a ball (3) of radius 3 beside it."""
    scale = np.array([0.5, 0.4, 0.4])
    z, y, x = (np.indices((24, 60, 60)).T * scale).T - (scale * [12, 30, 30])[:, None, None, None]
    data = 7 * ((np.hypot(np.hypot(x, y) - 8, z) < 2.5).astype(np.int32))
    data[np.linalg.norm([z, y, x], axis=0) < 3] = 3
    return Labels(data, name="things", scale=scale, translate=(10, 20, 30))


def shown(result):
    viewer = ViewerModel()
    layer = viewer.add_layer(Layer.create(*result))
    return layer


def test_manifest_is_valid(commands):
    run = subprocess.run([sys.executable, "-m", "npe2", "validate", "napari-scaleaxis"], capture_output=True, text=True)
    assert run.returncode == 0 and "Manifest for 'scaleaxis' valid" in run.stdout, run.stdout + run.stderr
    manifest = PluginManager.instance().get_manifest("napari-scaleaxis")
    assert len(manifest.contributions.widgets) == 3


def test_sheets(commands, labels):
    layer = shown(commands.execute("napari-scaleaxis.sheets", (labels, 7, 0.03)))
    assert isinstance(layer, Surface) and layer.name == "axis of things"
    places = layer.data[0] + layer.translate - labels.translate - labels.scale * [12, 30, 30]
    ring = np.hypot(np.hypot(places[:, 1], places[:, 2]) - 8, places[:, 0])
    assert ring.max() < 0.5 and layer.data[2].max() == pytest.approx(2.5, abs=0.25)


def test_skeleton(commands, labels):
    layer = shown(commands.execute("napari-scaleaxis.skeleton", (labels, 7, 0.03)))
    assert isinstance(layer, Shapes) and set(layer.shape_type) == {"path"}
    assert layer.features["length"].sum() == pytest.approx(2 * np.pi * 8, rel=0.03)
    assert layer.features["radius"].mean() == pytest.approx(2.5, abs=0.25)
    assert tuple(layer.translate) == (10, 20, 30)


def test_thickness(commands, labels):
    layer = shown(commands.execute("napari-scaleaxis.thickness", (labels, 3, 0.03)))
    assert isinstance(layer, Image) and np.array_equal(layer.data > 0, labels.data == 3)
    assert np.allclose(layer.scale, labels.scale) and layer.data.max() == pytest.approx(6, abs=0.5)  # a voxel


def test_all_labels_and_faults(commands, labels):
    both = commands.execute("napari-scaleaxis.skeleton", (labels,), {"delta": 0.03})
    assert len(both[0]) >= 1
    with pytest.raises(ValueError, match="three dimensions"):
        commands.execute("napari-scaleaxis.sheets", (Labels(np.ones((4, 4), dtype=int)),))


def test_widgets_ask_for_a_layer_and_numbers(commands):
    for name in ("sheets", "skeleton", "thickness"):
        parameters = magic_signature(commands.get(f"napari-scaleaxis.{name}")).parameters
        assert list(parameters)[:3] == ["labels", "label", "delta"]
