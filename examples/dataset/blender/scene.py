# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The scene in Blender: a labelled mesh with materials, the sky, the camera of a frame."""

import json
import math
import pathlib

import bpy
import numpy as np
from mathutils import Matrix

import materials
import ply
from nodes import Nodes


def _smooth_where_round(mesh, angle_deg=38):
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    if hasattr(mesh, "use_auto_smooth"):  # before Blender 4.1
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(angle_deg)
    else:
        mesh.set_sharp_from_angle(angle=math.radians(angle_deg))


def add_mesh(path, soiling):
    """One object for each label of the mesh. What was in the scene before is gone."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    vertices, triangles, labels, names = ply.read(path)
    for k, name in enumerate(names):
        chosen = triangles[labels == k]
        if not len(chosen):
            continue
        used, corners = np.unique(chosen, return_inverse=True)
        mesh = bpy.data.meshes.new(name)
        mesh.vertices.add(len(used))
        mesh.vertices.foreach_set("co", vertices[used].astype(np.float32).ravel())
        mesh.loops.add(chosen.size)
        mesh.loops.foreach_set("vertex_index", corners.ravel().astype(np.int32))
        mesh.polygons.add(len(chosen))
        mesh.polygons.foreach_set("loop_start", np.arange(0, chosen.size, 3, dtype=np.int32))
        if bpy.app.version < (3, 6, 0):  # later versions know it from the starts
            mesh.polygons.foreach_set("loop_total", np.full(len(chosen), 3, np.int32))
        mesh.update(calc_edges=True)
        if mesh.validate():
            raise ValueError(f"{path}: the faces labelled {name} have duplicates or no area")
        _smooth_where_round(mesh)
        mesh.materials.append(materials.of_label(name, soiling))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def add_sky(sun_elevation_deg=38.0, sun_azimuth_deg=232.0):
    """A sun and a blue sky with clouds, which glass can reflect."""
    elevation, azimuth = math.radians(sun_elevation_deg), math.radians(sun_azimuth_deg)
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle, sun.color = 4.6, math.radians(0.53), (1.0, 0.93, 0.84)
    lamp = bpy.data.objects.new("sun", sun)
    # A lamp shines along its own -z.
    lamp.rotation_euler = (math.pi / 2 - elevation, 0, azimuth + math.pi / 2)
    bpy.context.scene.collection.objects.link(lamp)
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", 256  # soft light; the sun is a lamp
    n = Nodes(world.node_tree)
    place = n.new("ShaderNodeTexCoord").outputs["Generated"]
    split = n.new("ShaderNodeSeparateXYZ")
    n.feed(split.inputs[0], place)
    height = n.math("MAXIMUM", split.outputs[2], 0.0)
    # Clouds lie on a layer: their place is where a ray meets it.
    layer = n.new("ShaderNodeCombineXYZ")
    for socket, axis in zip(layer.inputs, split.outputs[:2]):
        n.feed(socket, n.math("DIVIDE", axis, n.math("ADD", height, 0.16)))
    clouds = n.step(n.noise(1.15, 6.0, 0.58, at=layer.outputs[0]), 0.47, 0.70)
    clouds = n.math("MULTIPLY", clouds, n.step(height, 0.03, 0.2))  # haze at the horizon
    up = n.math("MULTIPLY_ADD", split.outputs[2], 0.5, 0.5)
    blue = n.ramp(up, (0.45, (0.26, 0.29, 0.26)), (0.497, (0.48, 0.54, 0.57)), (0.503, (0.62, 0.72, 0.80)),
                  (0.56, (0.36, 0.54, 0.78)), (0.85, (0.09, 0.23, 0.56)))
    white = n.ramp(n.noise(2.3, 4.0, 0.6, at=layer.outputs[0]), (0.3, (0.52, 0.55, 0.60)), (0.62, (0.98, 0.98, 0.97)))
    cloudy = n.shader("Background", Color=n.mix(clouds, blue, white), Strength=1.15)
    # Light on rough surfaces needs no shapes, and clouds take time.
    plain = n.shader("Background", Color=n.mix(0.35, blue, (0.8, 0.82, 0.84)), Strength=1.15)
    rays = n.new("ShaderNodeLightPath").outputs
    seen = n.math("MAXIMUM", rays["Is Camera Ray"], rays["Is Glossy Ray"])
    n.feed(n.new("ShaderNodeOutputWorld").inputs[0], n.mix_shaders(seen, plain, cloudy))


class Frame:
    """A picture to be taken: name without extension, place in the list, world from camera, intrinsics."""

    def __init__(self, number, entry, shared):
        def value(key, default):
            return float(entry.get(key, shared.get(key, default)))

        self.number = number
        self.stem = pathlib.PurePath(entry["file_path"]).stem
        self.world_from_camera = Matrix(entry["transform_matrix"])
        self.width, self.height = int(value("w", 0)), int(value("h", 0))
        angle = value("camera_angle_x", 0)
        self.fx = value("fl_x", self.width / 2 / math.tan(angle / 2) if angle else 0)
        self.fy = value("fl_y", self.fx)
        self.cx, self.cy = value("cx", self.width / 2), value("cy", self.height / 2)
        if not (self.width > 0 and self.height > 0 and self.fx > 0):
            raise ValueError(f"{self.stem}: w, h and fl_x (or camera_angle_x) expected")
        if any(value(key, 0) for key in ("k1", "k2", "k3", "k4", "p1", "p2")):
            raise ValueError(f"{self.stem}: Blender has no lens distortion; render without and warp")


def read_frames(path, chosen):
    """The frames of a transforms.json that START:STOP:STEP (of their order, as in Python) names."""
    content = json.loads(pathlib.Path(path).read_text())
    frames = [Frame(k, entry, content) for k, entry in enumerate(content["frames"])]
    stems = {frame.stem for frame in frames}
    if len(stems) != len(frames):
        raise ValueError(f"{path}: two frames have one name")
    if not chosen:
        return frames
    parts = [int(part) if part else None for part in chosen.split(":")]
    return [frames[parts[0]]] if len(parts) == 1 else frames[slice(*parts)]


def place_camera(frame, width=None):
    """The scene looks through the frame's camera; `width` scales the picture."""
    scene = bpy.context.scene
    if scene.camera is None or scene.camera.name != "aib_camera":
        camera = bpy.data.cameras.new("aib_camera")
        camera.sensor_width, camera.sensor_fit, camera.clip_start, camera.clip_end = 36, "HORIZONTAL", 0.02, 5000
        scene.camera = bpy.data.objects.new("aib_camera", camera)
        scene.collection.objects.link(scene.camera)
    camera, render, aspect = scene.camera.data, scene.render, frame.fx / frame.fy
    camera.lens = frame.fx * camera.sensor_width / frame.width
    camera.shift_x = (frame.width / 2 - frame.cx) / frame.width
    camera.shift_y = (frame.cy - frame.height / 2) * aspect / frame.width
    render.pixel_aspect_x, render.pixel_aspect_y = (1, aspect) if aspect >= 1 else (1 / aspect, 1)
    scale = (width or frame.width) / frame.width
    render.resolution_x, render.resolution_y = round(frame.width * scale), round(frame.height * scale)
    render.resolution_percentage = 100
    scene.camera.matrix_world = frame.world_from_camera
