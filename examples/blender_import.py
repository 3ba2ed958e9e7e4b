# SPDX-License-Identifier: Apache-2.0
"""Run in Blender: reads cat-axis.glb (scaleaxis axis cat.obj -o cat-axis.glb), and colours it by radius."""

import bpy

bpy.ops.import_scene.gltf(filepath="cat-axis.glb")  # with its folder
axis = bpy.context.selected_objects[0]

# A colour by radius, from violet over green to yellow.
material = bpy.data.materials.new("radius")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
radius, ramp = nodes.new("ShaderNodeAttribute"), nodes.new("ShaderNodeValToRGB")
radius.attribute_name = "_RADIUS"
largest = nodes.new("ShaderNodeMath")
largest.operation = "DIVIDE"
largest.inputs[1].default_value = max(value.value for value in axis.data.attributes["_RADIUS"].data)
ramp.color_ramp.elements[0].color = (0.06, 0.0, 0.1, 1)
ramp.color_ramp.elements[1].color = (0.9, 0.75, 0.02, 1)
ramp.color_ramp.elements.new(0.5).color = (0.01, 0.28, 0.26, 1)
links.new(radius.outputs["Fac"], largest.inputs[0])
links.new(largest.outputs[0], ramp.inputs[0])
links.new(ramp.outputs[0], nodes["Principled BSDF"].inputs["Base Color"])
axis.data.materials.clear()
axis.data.materials.append(material)
