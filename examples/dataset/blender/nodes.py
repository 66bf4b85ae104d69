# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Shader nodes as expressions: every method adds nodes to one material and returns an output socket."""

import bpy


class Nodes:
    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()
        geometry = self.new("ShaderNodeNewGeometry")
        self.position, self.normal = geometry.outputs["Position"], geometry.outputs["True Normal"]
        self.of_solid, self.backfacing = geometry.outputs["Random Per Island"], geometry.outputs["Backfacing"]

    def new(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def feed(self, socket, value):
        """A socket gets the output of a node, or a constant."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, tuple) and len(value) == 3 and socket.type == "RGBA":
            socket.default_value = (*value, 1)
        else:
            socket.default_value = value

    def math(self, operation, a, b=0.0, c=0.0):
        node = self.new("ShaderNodeMath", operation=operation)
        for socket, value in zip(node.inputs, (a, b, c)):
            self.feed(socket, value)
        return node.outputs[0]

    def vector(self, operation, a, b=None):
        node = self.new("ShaderNodeVectorMath", operation=operation)
        self.feed(node.inputs[0], a)
        if b is not None:
            self.feed(node.inputs[1], b)
        return node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]

    def stretched(self, scale):
        """Positions with axes scaled: noise over them is drawn out where the scale is small."""
        return self.vector("MULTIPLY", self.position, scale)

    def noise(self, scale, detail=4.0, roughness=0.6, at=None):
        node = self.new("ShaderNodeTexNoise")
        self.feed(node.inputs["Vector"], self.position if at is None else at)
        for name, value in (("Scale", scale), ("Detail", detail), ("Roughness", roughness)):
            node.inputs[name].default_value = value
        return node.outputs[0]

    def step(self, value, low, high):
        """0 below `low`, 1 above `high`, smooth between."""
        node = self.new("ShaderNodeMapRange", interpolation_type="SMOOTHSTEP", clamp=True)
        self.feed(node.inputs["Value"], value)
        node.inputs["From Min"].default_value, node.inputs["From Max"].default_value = low, high
        return node.outputs[0]

    def range(self, value, low, high):
        """A value in 0..1 to low..high."""
        return self.math("MULTIPLY_ADD", value, high - low, low)

    def mix(self, share, a, b, blend="MIX"):
        node = self.new("ShaderNodeMixRGB", blend_type=blend)
        for socket, value in zip(node.inputs, (share, a, b)):
            self.feed(socket, value)
        return node.outputs[0]

    def ramp(self, value, *stops):
        node = self.new("ShaderNodeValToRGB")
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (place, color) in zip(elements, stops):
            element.position, element.color = place, (*color, 1)
        self.feed(node.inputs[0], value)
        return node.outputs[0]

    def shaded(self, color, low, high, value):
        """A colour darkened and lightened: times low..high by a value in 0..1."""
        gray = self.new("ShaderNodeCombineXYZ")
        for socket in gray.inputs:
            self.feed(socket, self.range(value, low, high))
        return self.mix(1.0, color, gray.outputs[0], "MULTIPLY")

    def bump(self, height, strength, distance):
        node = self.new("ShaderNodeBump")
        node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = strength, distance
        self.feed(node.inputs["Height"], height)
        return node.outputs[0]

    def wall_place(self):
        """Coordinates (along the wall, up, 0) on upright faces of any direction."""
        along = self.vector("NORMALIZE", self.vector("CROSS_PRODUCT", (0.0, 0.0, 1.0), self.normal))
        place, split = self.new("ShaderNodeCombineXYZ"), self.new("ShaderNodeSeparateXYZ")
        self.feed(split.inputs[0], self.position)
        self.feed(place.inputs[0], self.vector("DOT_PRODUCT", along, self.position))
        self.feed(place.inputs[1], split.outputs[2])
        return place.outputs[0]

    def principled(self, color, roughness=0.6, metallic=0.0, normal=None):
        node = self.new("ShaderNodeBsdfPrincipled")
        self.feed(node.inputs["Base Color"], color)
        self.feed(node.inputs["Roughness"], roughness)
        self.feed(node.inputs["Metallic"], metallic)
        if normal is not None:
            self.feed(node.inputs["Normal"], normal)
        return node.outputs[0]

    def glossy(self, color, roughness, normal):
        try:
            node = self.new("ShaderNodeBsdfGlossy")
        except RuntimeError:  # Blender 4 calls it so
            node = self.new("ShaderNodeBsdfAnisotropic")
        for name, value in (("Color", color), ("Roughness", roughness), ("Normal", normal)):
            self.feed(node.inputs[name], value)
        return node.outputs[0]

    def shader(self, kind, **inputs):
        node = self.new("ShaderNode" + kind)
        for name, value in inputs.items():
            self.feed(node.inputs[name], value)
        return node.outputs[0]

    def mix_shaders(self, share, a, b):
        node = self.new("ShaderNodeMixShader")
        for socket, value in zip(node.inputs, (share, a, b)):
            self.feed(socket, value)
        return node.outputs[0]

    def finish(self, shader):
        self.feed(self.new("ShaderNodeOutputMaterial").inputs[0], shader)
