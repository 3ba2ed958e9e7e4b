# SPDX-License-Identifier: Apache-2.0
"""The operators in Blender as a module of Python, without a window."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
import scaleaxis_blender
import tomllib


@pytest.fixture(autouse=True)
def scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scaleaxis_blender.register()
    yield
    scaleaxis_blender.unregister()


def add_torus(**placed):
    bpy.ops.mesh.primitive_torus_add(major_radius=2, minor_radius=0.5, major_segments=64, minor_segments=32, **placed)


def values(data, name, count=1):
    found = np.empty(count * len(data), dtype=np.float32)
    data.foreach_get(name, found)
    return found.reshape(len(data), count) if count > 1 else found


def test_axis_lies_in_the_ring_wherever_the_object_is():
    add_torus(location=(5, 0, 1), rotation=(np.pi / 2, 0, 0))
    bpy.context.active_object.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    assert bpy.ops.object.scale_axis(delta=0.02, scale=1.3) == {"FINISHED"}
    axis = bpy.context.active_object
    assert axis.name == "Torus axis" and axis.type == "MESH" and axis.select_get()
    places = values(axis.data.vertices, "co", 3) - [5, 0, 1]
    assert np.abs(np.hypot(np.hypot(places[:, 0], places[:, 2]) - 4, places[:, 1])).max() < 0.2
    radii = values(axis.data.attributes["radius"].data, "value")
    assert len(radii) == len(places) and np.abs(radii - 1).max() < 0.1
    assert len(axis.data.attributes["sheet"].data) == len(axis.data.polygons)


def test_modifiers_count():
    add_torus()
    bpy.context.active_object.modifiers.new("two", "ARRAY").relative_offset_displace = (1.2, 0, 0)
    bpy.ops.object.scale_axis(delta=0.02, scale=1.3)
    places = values(bpy.context.active_object.data.vertices, "co", 3)
    assert np.ptp(places[:, 0]) == pytest.approx(4 + 1.2 * 5, abs=0.2)


def test_skeleton_is_a_closed_curve_as_thick_as_asked_for():
    add_torus()
    assert bpy.ops.object.curve_skeleton(delta=0.03, thickness=0.5) == {"FINISHED"}
    curve = bpy.context.active_object.data
    assert curve.bevel_depth == 0.5
    length = 0.0
    for spline in curve.splines:
        places = values(spline.points, "co", 4)[:, :3]
        length += np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
        assert np.abs(values(spline.points, "radius") - 0.5).max() < 0.05
    assert length == pytest.approx(4 * np.pi, rel=0.02)


def test_faults_are_reported():
    bpy.ops.mesh.primitive_plane_add()
    with pytest.raises(RuntimeError, match="."):
        bpy.ops.object.scale_axis()
    bpy.ops.object.empty_add()
    assert not bpy.ops.object.scale_axis.poll()


def test_manifest_is_that_of_an_extension():
    folder = Path(scaleaxis_blender.__file__).parent
    manifest = tomllib.loads((folder / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert manifest["type"] == "add-on" and manifest["id"] == "scaleaxis"
    assert len(manifest["tagline"]) <= 64 and not manifest["tagline"].endswith(".")
