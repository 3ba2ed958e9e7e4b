# SPDX-License-Identifier: Apache-2.0
"""Operators on the active mesh: its discrete scale axis as a mesh, its skeleton as a curve as thick as the balls."""

from __future__ import annotations

import warnings

import bpy
import numpy as np
from bpy.props import FloatProperty


def _world_mesh(context: bpy.types.Context) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of the active object after its modifiers, in the units of the scene."""
    seen = context.active_object.evaluated_get(context.evaluated_depsgraph_get())
    mesh = seen.to_mesh()
    try:
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices))
        triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.vertices.foreach_get("co", vertices)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        seen.to_mesh_clear()
    matrix = np.array(seen.matrix_world)
    placed = vertices.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    return placed, triangles.reshape(-1, 3)


def _add(context: bpy.types.Context, name: str, data: bpy.types.ID) -> None:
    """Makes an object of it, the active one."""
    made = bpy.data.objects.new(name, data)
    context.collection.objects.link(made)
    for other in context.selected_objects:
        other.select_set(False)
    made.select_set(True)
    context.view_layer.objects.active = made


class _OfActiveMesh:
    bl_options = {"REGISTER", "UNDO"}

    delta: FloatProperty(  # type: ignore[valid-type]
        name="δ",
        description="Tolerance, relative to the diagonal of the mesh",
        default=0.01,
        min=0.001,
        max=0.2,
        precision=4,
    )
    scale: FloatProperty(  # type: ignore[valid-type]
        name="Scale", description="Factor by which balls grow: small branches vanish", default=1.1, min=1.0, max=10.0
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.active_object is not None and context.active_object.type == "MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        import scaleaxis

        try:
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                self.make(context, _world_mesh(context))
            for warning in told:
                self.report({"WARNING"}, str(warning.message))
        except (scaleaxis.Error, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class OBJECT_OT_scale_axis(_OfActiveMesh, bpy.types.Operator):
    """Adds the scale axis of the active mesh: polygons and edges, with the attributes radius, sheet and angle"""

    bl_idname = "object.scale_axis"
    bl_label = "Scale Axis"

    def make(self, context: bpy.types.Context, given: tuple[np.ndarray, np.ndarray]) -> None:
        import scaleaxis

        axis = scaleaxis.axis(given, self.delta, self.scale)
        name = f"{context.active_object.name} axis"
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(axis.vertices, axis.curves.tolist(), [polygon.tolist() for polygon in axis.polygons])
        mesh.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", axis.radii.astype(np.float32))
        mesh.attributes.new("sheet", "INT", "FACE").data.foreach_set("value", axis.sheets)
        mesh.attributes.new("angle", "FLOAT", "FACE").data.foreach_set("value", axis.angles.astype(np.float32))
        _add(context, name, mesh)


class OBJECT_OT_curve_skeleton(_OfActiveMesh, bpy.types.Operator):
    """Adds the curve skeleton of the active mesh: a spline for each branch, as thick as the balls around it"""

    bl_idname = "object.curve_skeleton"
    bl_label = "Curve Skeleton"

    thickness: FloatProperty(  # type: ignore[valid-type]
        name="Thickness", description="Of the splines, in radii of the balls", default=0.2, min=0.0, max=1.0
    )

    def make(self, context: bpy.types.Context, given: tuple[np.ndarray, np.ndarray]) -> None:
        import scaleaxis

        skeleton = scaleaxis.skeleton(given, delta=self.delta, scale=self.scale)
        name = f"{context.active_object.name} skeleton"
        curve = bpy.data.curves.new(name, "CURVE")
        curve.dimensions = "3D"
        curve.bevel_depth = self.thickness  # times the radius of a point
        for branch in skeleton.branches:
            spline = curve.splines.new("POLY")
            spline.points.add(len(branch) - 1)
            places = np.column_stack([skeleton.nodes[branch], np.ones(len(branch))])
            spline.points.foreach_set("co", places.astype(np.float32).ravel())
            spline.points.foreach_set("radius", skeleton.radii[branch].astype(np.float32))
        _add(context, name, curve)


class VIEW3D_PT_scale_axis(bpy.types.Panel):
    bl_label = "Scale axis"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Scale axis"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.operator(OBJECT_OT_scale_axis.bl_idname)
        self.layout.operator(OBJECT_OT_curve_skeleton.bl_idname)


_CLASSES = (OBJECT_OT_scale_axis, OBJECT_OT_curve_skeleton, VIEW3D_PT_scale_axis)


def _menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(OBJECT_OT_scale_axis.bl_idname)
    self.layout.operator(OBJECT_OT_curve_skeleton.bl_idname)


def register() -> None:
    for known in _CLASSES:
        bpy.utils.register_class(known)
    bpy.types.VIEW3D_MT_object.append(_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_menu)
    for known in reversed(_CLASSES):
        bpy.utils.unregister_class(known)
