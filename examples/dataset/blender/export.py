# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""The mesh and the cameras of a .blend file: mesh.ply with a label for each material, transforms.json."""

import json
import pathlib

import bpy
import numpy as np

import ply


def _triangles_of(instance, depsgraph):
    """World vertices, triangles and material names of an object as it is rendered; None where it has no faces."""
    evaluated = instance.object
    mesh = evaluated.to_mesh() if evaluated.type in {"MESH", "CURVE", "SURFACE", "FONT", "META"} else None
    if mesh is None or evaluated.hide_render:
        return None
    mesh.calc_loop_triangles()
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
    slots = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.vertices.foreach_get("co", vertices)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    mesh.loop_triangles.foreach_get("material_index", slots)
    matrix = np.array(instance.matrix_world, np.float64)
    world = vertices.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    corners = triangles.reshape(-1, 3)
    if np.linalg.det(matrix[:3, :3]) < 0:  # a mirrored object would face inwards
        corners = corners[:, ::-1]
    materials = [slot.material.name if slot.material else evaluated.name for slot in evaluated.material_slots]
    names = [(materials[min(k, len(materials) - 1)] if materials else evaluated.name) for k in slots]
    evaluated.to_mesh_clear()
    return world, corners, names


def mesh(path):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    vertices, triangles, labels, numbers, n = [], [], [], {}, 0
    for instance in depsgraph.object_instances:
        part = _triangles_of(instance, depsgraph)
        if part is None or not len(part[1]):
            continue
        vertices.append(part[0])
        triangles.append(part[1] + n)
        labels += [numbers.setdefault(name.replace(" ", "_"), len(numbers)) for name in part[2]]
        n += len(part[0])
    if not labels:
        raise ValueError("no object of this file has faces that are rendered")
    ply.write(path, np.concatenate(vertices), np.concatenate(triangles), labels, list(numbers))
    return len(labels), len(numbers)


def _frame(camera, name):
    render, depsgraph = bpy.context.scene.render, bpy.context.evaluated_depsgraph_get()
    width = render.resolution_x * render.resolution_percentage // 100
    height = render.resolution_y * render.resolution_percentage // 100
    evaluated = camera.evaluated_get(depsgraph)
    if evaluated.data.type != "PERSP":
        raise ValueError(f"camera {camera.name}: a perspective camera expected, found {evaluated.data.type}")
    p = evaluated.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x,
                                     scale_y=render.pixel_aspect_y)
    matrix = evaluated.matrix_world.normalized()
    return {"file_path": f"images/{name}.png", "w": width, "h": height, "camera_model": "PINHOLE",
            "fl_x": p[0][0] * width / 2, "fl_y": p[1][1] * height / 2, "cx": width / 2 * (1 - p[0][2]),
            "cy": height / 2 * (1 + p[1][2]), "transform_matrix": [list(row) for row in matrix]}


def cameras(path, which):
    """The active camera at every frame of the animation, or every camera at the current one."""
    here = bpy.context.scene
    if which == "all":
        frames = [_frame(c, c.name) for c in sorted(here.objects, key=lambda o: o.name) if c.type == "CAMERA"]
    else:
        if here.camera is None:
            raise ValueError("this file has no active camera; --cameras all takes every one")
        frames = []
        for k in range(here.frame_start, here.frame_end + 1, here.frame_step):
            here.frame_set(k)
            frames.append(_frame(here.camera, f"{k:06d}"))
    pathlib.Path(path).write_text(json.dumps({"frames": frames}, indent=1) + "\n")
    return len(frames)


def run(options):
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    n_faces, n_labels = mesh(out / "mesh.ply")
    n_frames = cameras(out / "transforms.json", options.cameras)
    print(f"{out}: {n_faces} triangles with {n_labels} labels, {n_frames} frames")
