# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""A material for each label: procedural, from noise in the world's coordinates, so that nothing repeats."""

import zlib

import bpy

from nodes import Nodes

SOILING = {"very_low": 0.05, "low": 0.3, "medium": 0.6, "high": 1.0}


def glass(n, soiling):
    """Part transparent, part reflective, panes never quite plane. Soiling changes roughness and dirt alone."""
    # Every pane leans and bulges a little of its own: what it reflects is warped over metres.
    pane = n.math("MULTIPLY", n.of_solid, 40.0)
    lifted = n.new("ShaderNodeCombineXYZ")
    n.feed(lifted.inputs[2], pane)
    waves = n.noise(0.55, 0.0, at=n.vector("ADD", n.position, lifted.outputs[0]))
    normal = n.bump(waves, 0.35, 0.012)
    streaks = n.noise(1.0, 2.0, 0.7, at=n.stretched((9.0, 9.0, 0.9)))
    stains = n.step(n.noise(1.6, 4.0, 0.7), 0.36, 0.62)
    dirt = n.math("MULTIPLY", stains, n.step(streaks, 0.34, 0.66))
    film = n.math("MULTIPLY_ADD", dirt, 0.85, 0.1)
    roughness = n.math("MULTIPLY_ADD", film, 0.42 * soiling, 0.008)
    reflection = n.glossy((0.86, 0.91, 0.93), roughness, normal)
    fresnel = n.new("ShaderNodeLayerWeight")
    fresnel.inputs["Blend"].default_value = 0.28
    n.feed(fresnel.inputs["Normal"], normal)
    share = n.range(fresnel.outputs["Fresnel"], 0.26, 1.0)
    clean = n.mix_shaders(share, n.shader("BsdfTransparent", Color=(0.86, 0.92, 0.91)), reflection)
    dust = n.shader("BsdfDiffuse", Color=n.ramp(streaks, (0.3, (0.30, 0.26, 0.20)), (0.7, (0.52, 0.48, 0.40))))
    outside = n.mix_shaders(n.math("MULTIPLY", film, 0.75 * soiling), clean, dust)
    # The inner face and shadows need no pattern: most of the time of a glass facade would go there.
    plain = n.math("MAXIMUM", n.backfacing, n.new("ShaderNodeLightPath").outputs["Is Shadow Ray"])
    return n.mix_shaders(plain, outside, n.shader("BsdfTransparent", Color=(1 - 0.3 * soiling,) * 3))


def mottled(*colors, grain=6.0, low=0.55, roughness=0.8, metallic=0.0, per_solid=0.12):
    """Colours over fine noise, darker in large blots, every solid a little different."""
    def build(n, _):
        fine = n.noise(grain, 4.0, 0.65)
        places = [0.3 + 0.4 * k / max(1, len(colors) - 1) for k in range(len(colors))]
        color = n.ramp(fine, *zip(places, colors))
        color = n.shaded(color, low, 1.0, n.step(n.noise(0.35 + grain / 30, 4.0), 0.3, 0.62))
        color = n.shaded(color, 1 - per_solid, 1 + per_solid, n.of_solid)
        return n.principled(color, roughness, metallic)
    return build


def concrete(light, stains=0.5):
    """Blots, pores, and dark runs down upright faces."""
    def build(n, _):
        color = n.ramp(n.noise(3.0, 4.0, 0.7), (0.25, tuple(0.72 * c for c in light)), (0.75, light))
        runs = n.step(n.noise(1.0, 5.0, 0.65, at=n.stretched((2.6, 2.6, 0.16))), 0.36, 0.66)
        color = n.shaded(color, 1 - stains, 1.0, runs)
        pores = n.step(n.noise(26.0, 3.0), 0.34, 0.42)
        color = n.shaded(color, 0.68, 1.0, pores)
        return n.principled(n.shaded(color, 0.9, 1.08, n.of_solid), 0.85)
    return build


def masonry(first, second, mortar, size=(0.25, 0.075), stains=0.5):
    def build(n, _):
        bricks = n.new("ShaderNodeTexBrick", offset=0.5, squash=1.0)
        n.feed(bricks.inputs["Vector"], n.wall_place())
        for name, value in (("Color1", first), ("Color2", second), ("Mortar", mortar), ("Scale", 1.0),
                            ("Mortar Size", 0.008), ("Mortar Smooth", 0.3), ("Bias", 0.0), ("Brick Width", size[0]),
                            ("Row Height", size[1])):
            n.feed(bricks.inputs[name], value)
        color = n.shaded(bricks.outputs[0], 1 - stains, 1.0, n.step(n.noise(0.45, 4.0, 0.7), 0.3, 0.64))
        color = n.shaded(color, 0.7, 1.1, n.noise(14.0, 4.0))
        runs = n.step(n.noise(1.0, 4.0, 0.6, at=n.stretched((1.4, 1.4, 0.1))), 0.34, 0.6)
        color = n.shaded(color, 0.72, 1.0, runs)
        return n.principled(n.shaded(color, 0.85, 1.15, n.of_solid), 0.88)
    return build


def slabs(light, dark, size):
    """Paving: slabs that differ, joints, chewing gum and oil."""
    def build(n, _):
        stones = n.new("ShaderNodeTexBrick", offset=0.5)
        n.feed(stones.inputs["Vector"], n.position)
        for name, value in (("Color1", light), ("Color2", dark), ("Mortar", (0.06, 0.06, 0.055)), ("Scale", 1.0),
                            ("Mortar Size", 0.012), ("Brick Width", size), ("Row Height", size / 2)):
            n.feed(stones.inputs[name], value)
        color = n.shaded(stones.outputs[0], 0.5, 1.0, n.step(n.noise(0.3, 4.0, 0.7), 0.32, 0.62))
        color = n.shaded(color, 0.55, 1.05, n.step(n.noise(18.0, 4.0), 0.36, 0.52))
        return n.principled(color, 0.8)
    return build


def asphalt(n, _):
    color = n.ramp(n.noise(60.0, 3.0, 0.8), (0.35, (0.035, 0.036, 0.04)), (0.65, (0.13, 0.13, 0.135)))
    patches = n.step(n.noise(0.25, 4.0, 0.75), 0.4, 0.56)
    cracks = n.step(n.math("ABSOLUTE", n.math("SUBTRACT", n.noise(1.1, 4.0, 0.6), 0.5)), 0.0, 0.012)
    return n.principled(n.shaded(n.shaded(color, 0.6, 1.25, patches), 0.45, 1.0, cracks), 0.85)


def grass(n, _):
    color = n.ramp(n.noise(22.0, 4.0, 0.75), (0.3, (0.018, 0.035, 0.008)), (0.5, (0.06, 0.11, 0.02)),
                   (0.72, (0.16, 0.17, 0.05)))
    color = n.mix(n.step(n.noise(0.3, 5.0), 0.45, 0.7), color, (0.13, 0.095, 0.05))
    return n.principled(color, 0.95)


def foliage(n, _):
    leaves = n.noise(7.0, 6.0, 0.8)
    color = n.ramp(leaves, (0.36, (0.004, 0.010, 0.003)), (0.5, (0.035, 0.075, 0.014)), (0.62, (0.11, 0.16, 0.035)),
                   (0.75, (0.2, 0.24, 0.07)))
    color = n.shaded(color, 0.7, 1.3, n.of_solid)
    return n.principled(color, 0.75, 0.0, n.bump(leaves, 1.0, 0.35))


def painted(color, rust=(0.13, 0.045, 0.018), worn=0.6, roughness=0.42, metallic=0.0):
    """Paint on steel: faded, chipped to rust where the noise is above `worn`."""
    def build(n, _):
        faded = n.shaded(color, 0.62, 1.05, n.step(n.noise(0.7, 4.0, 0.7), 0.28, 0.68))
        faded = n.shaded(faded, 0.78, 1.05, n.noise(9.0, 5.0, 0.7))
        chips = n.step(n.noise(5.0, 4.0, 0.75), worn, worn + 0.06)
        color_now = n.mix(chips, n.shaded(faded, 0.86, 1.1, n.of_solid), n.shaded(rust, 0.5, 1.4, n.noise(40.0)))
        return n.principled(color_now, n.range(chips, roughness, 0.9), metallic)
    return build


def car_paint(color):
    def build(n, _):
        dusty = n.noise(3.0, 4.0, 0.7)
        return n.principled(n.shaded(color, 0.75, 1.0, dusty), n.range(dusty, 0.5, 0.15), 0.2)
    return build


def water(n, _):
    waves = n.math("ADD", n.noise(0.9, 5.0, 0.6, at=n.stretched((1.0, 0.45, 1.0))),
                   n.math("MULTIPLY", n.noise(5.0, 3.0), 0.18))
    normal = n.bump(waves, 0.5, 0.16)
    color = n.ramp(n.noise(0.12, 4.0), (0.3, (0.012, 0.028, 0.022)), (0.7, (0.035, 0.06, 0.045)))
    return n.principled(color, 0.09, 0.0, normal)


def solar(n, _):
    """Cells behind glass."""
    cells = n.new("ShaderNodeTexBrick", offset=0.0)
    n.feed(cells.inputs["Vector"], n.position)
    for name, value in (("Color1", (0.008, 0.014, 0.05)), ("Color2", (0.014, 0.022, 0.08)),
                        ("Mortar", (0.3, 0.32, 0.35)), ("Scale", 1.0), ("Mortar Size", 0.004), ("Brick Width", 0.168),
                        ("Row Height", 0.155)):
        n.feed(cells.inputs[name], value)
    return n.principled(n.shaded(cells.outputs[0], 0.6, 1.1, n.noise(6.0)), n.range(n.noise(2.0), 0.06, 0.2))


def planks(n, _):
    grain = n.noise(4.0, 4.0, 0.7, at=n.stretched((1.0, 7.0, 7.0)))
    color = n.ramp(grain, (0.3, (0.16, 0.09, 0.045)), (0.7, (0.42, 0.28, 0.16)))
    return n.principled(n.shaded(color, 0.7, 1.2, n.of_solid), 0.7)


def lining(n, _):
    """Inside of a house: every solid its own muted colour."""
    color = n.ramp(n.of_solid, (0.0, (0.5, 0.47, 0.42)), (0.35, (0.28, 0.32, 0.36)), (0.7, (0.45, 0.33, 0.22)),
                   (1.0, (0.56, 0.54, 0.5)))
    return n.principled(n.shaded(color, 0.6, 1.05, n.noise(2.0, 5.0)), 0.8)


def lamp(n, _):
    return n.shader("Emission", Color=(1.0, 0.93, 0.8), Strength=1.6)


def sign(n, _):
    """White board with bars of two colours."""
    bars = n.step(n.noise(2.2, 2.0, at=n.stretched((1.0, 1.0, 0.3))), 0.5, 0.51)
    return n.principled(n.mix(bars, (0.75, 0.75, 0.72), (0.04, 0.12, 0.35)), 0.5)


STEEL_GRAY = (0.30, 0.31, 0.32)
BY_LABEL = {
    "glass": glass,
    "asphalt": asphalt, "road": asphalt, "grass": grass, "foliage": foliage, "water": water, "solar": solar,
    "car_red": car_paint((0.36, 0.02, 0.02)), "car_white": car_paint((0.66, 0.66, 0.64)),
    "car_blue": car_paint((0.03, 0.08, 0.22)), "car_silver": car_paint((0.42, 0.43, 0.45)),
    "car_black": car_paint((0.02, 0.02, 0.022)), "timber": planks, "interior": lining, "partition": lining, "cabinet": lining,
    "light": lamp, "sign": sign,
    "concrete": concrete((0.46, 0.44, 0.41)), "concrete_light": concrete((0.62, 0.6, 0.56), 0.62),
    "wall": concrete((0.68, 0.66, 0.61), 0.35), "stone": concrete((0.33, 0.31, 0.28), 0.6),
    "kerb": concrete((0.5, 0.49, 0.46), 0.3), "footpath": slabs((0.36, 0.34, 0.31), (0.28, 0.27, 0.25), 0.9),
    "paving": slabs((0.40, 0.385, 0.36), (0.29, 0.285, 0.275), 1.2),
    "paving_dark": slabs((0.2, 0.19, 0.18), (0.13, 0.13, 0.13), 0.6),
    "brick_red": masonry((0.30, 0.075, 0.045), (0.18, 0.045, 0.03), (0.42, 0.40, 0.37)),
    "brick_yellow": masonry((0.50, 0.35, 0.15), (0.36, 0.23, 0.09), (0.5, 0.47, 0.42)),
    "brick_white": masonry((0.62, 0.60, 0.56), (0.44, 0.42, 0.39), (0.26, 0.25, 0.24)),
    "gravel": mottled((0.10, 0.095, 0.09), (0.33, 0.32, 0.30), (0.56, 0.54, 0.5), grain=24.0),
    "soil": mottled((0.085, 0.055, 0.034), (0.24, 0.17, 0.11), (0.40, 0.31, 0.22), grain=3.0, low=0.4),
    "bark": mottled((0.05, 0.035, 0.025), (0.2, 0.15, 0.11), grain=14.0),
    "frame": painted((0.055, 0.06, 0.065), worn=0.74, roughness=0.35),
    "panel": painted((0.58, 0.59, 0.58), worn=0.72, roughness=0.4),
    "coping": painted((0.24, 0.25, 0.26), worn=0.72), "cladding": painted((0.34, 0.37, 0.40), worn=0.7),
    "door": painted((0.16, 0.22, 0.2), worn=0.68), "rail": painted((0.09, 0.16, 0.15), worn=0.64),
    "arch": painted((0.36, 0.47, 0.46), worn=0.63), "truss": painted((0.72, 0.36, 0.02), worn=0.62),
    "cabin": painted((0.74, 0.40, 0.03), worn=0.68), "hook": painted((0.68, 0.42, 0.02), worn=0.56),
    "container_blue": painted((0.035, 0.12, 0.28), worn=0.62),
    "container_green": painted((0.05, 0.2, 0.1), worn=0.62),
    "container_orange": painted((0.48, 0.13, 0.03), worn=0.62),
    "sign_red": painted((0.5, 0.02, 0.02), worn=0.75), "tank": painted((0.52, 0.54, 0.55), worn=0.66),
    "pipe": painted((0.36, 0.34, 0.30), worn=0.62), "rust": painted((0.16, 0.06, 0.025), worn=0.5),
    "steel": painted(STEEL_GRAY, worn=0.66, roughness=0.45, metallic=0.5),
    "metal": painted((0.52, 0.53, 0.54), worn=0.7, roughness=0.35, metallic=0.6),
    "grating": painted((0.2, 0.21, 0.21), worn=0.6, metallic=0.4),
    "cable": painted((0.12, 0.12, 0.125), worn=0.64, roughness=0.5, metallic=0.5),
    "marking": mottled((0.45, 0.45, 0.43), (0.78, 0.77, 0.74), grain=14.0, low=0.5),
    "blind": mottled((0.56, 0.54, 0.49), (0.64, 0.62, 0.58), grain=2.0, low=0.85, per_solid=0.25),
    "tyre": mottled((0.012, 0.012, 0.012), (0.04, 0.04, 0.04), grain=12.0, roughness=0.9),
    "car_glass": mottled((0.01, 0.012, 0.014), (0.03, 0.034, 0.036), grain=2.0, roughness=0.06),
    "screen": mottled((0.008, 0.008, 0.01), (0.02, 0.02, 0.024), grain=3.0, roughness=0.15),
}


def unknown(label):
    """Labels of other scenes: a muted colour of their own."""
    bits = zlib.crc32(label.encode())
    color = tuple(0.15 + 0.4 * (bits >> shift & 255) / 255 for shift in (0, 8, 16))
    return mottled(tuple(0.6 * c for c in color), color)


def of_label(label, soiling):
    material = bpy.data.materials.new(label)
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    nodes.finish(BY_LABEL.get(label, unknown(label))(nodes, soiling))
    return material


def opaque():
    """What stands for every material where depth is rendered: panes hide what is behind them."""
    material = bpy.data.materials.new("opaque")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    nodes.finish(nodes.shader("Emission"))
    return material
