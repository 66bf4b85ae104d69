# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Pictures and depth of frames with Cycles. A frame that is there is left alone; a file is there in full or not at all."""

import json
import pathlib
import time

import bpy

import materials
import scene

GPU_KINDS = ("OPTIX", "CUDA", "HIP", "ONEAPI", "METAL")


def use_device(wanted):
    """Sets the device of Cycles and returns its name. "auto" takes a graphics card where there is one."""
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    if wanted == "cpu":
        return "CPU"
    preferences = bpy.context.preferences.addons["cycles"].preferences
    for kind in GPU_KINDS:
        try:
            preferences.compute_device_type = kind
        except TypeError:  # not in this build
            continue
        preferences.get_devices()
        cards = [device for device in preferences.devices if device.type == kind]
        for device in preferences.devices:
            device.use = device.type == kind
        if cards:
            cycles.device = "GPU"
            return kind
    if wanted == "gpu":
        raise RuntimeError("no graphics card that this build of Blender can use")
    return "CPU"


def use_denoiser(wanted):
    """Sets the denoiser and returns its name, or "none". Debian's Blender has none: take more samples there."""
    cycles = bpy.context.scene.cycles
    cycles.use_denoising = False
    if wanted == "off":
        return "none"
    try:
        cycles.denoiser = "OPENIMAGEDENOISE"
    except TypeError:
        if wanted == "on":
            raise RuntimeError("this build of Blender has no OpenImageDenoise") from None
        return "none"
    cycles.use_denoising = True
    return "OpenImageDenoise"


def prepare(options):
    """Settings of Cycles; returns what a picture depends on beside its camera."""
    here = bpy.context.scene
    here.render.engine = "CYCLES"
    cycles = here.cycles
    cycles.samples, cycles.use_adaptive_sampling = options.samples, True
    cycles.adaptive_threshold, cycles.adaptive_min_samples = 0.05, max(6, options.samples // 4)
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces = 3, 1, 3
    cycles.transmission_bounces, cycles.transparent_max_bounces = 0, 6
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_indirect = 3
    if options.threads:
        here.render.threads_mode, here.render.threads = "FIXED", options.threads
    here.render.use_persistent_data = True
    here.view_settings.view_transform = "Standard"
    here.render.image_settings.file_format = "PNG"
    here.render.image_settings.color_mode, here.render.image_settings.color_depth = "RGB", "8"
    for what in ("date", "time", "render_time", "frame", "camera", "scene", "filename", "memory", "hostname"):
        setattr(here.render, "use_stamp_" + what, False)  # two runs give the same bytes
    return {"blender": bpy.app.version_string, "device": use_device(options.device),
            "denoiser": use_denoiser(options.denoise), "samples": options.samples, "seed": options.seed,
            "soiling": options.soiling, "width": options.width}


def _keep_facts(path, facts):
    """Frames that were drawn otherwise are not mixed with these; the machine may differ."""
    if path.exists():
        before = json.loads(path.read_text())
        for name in ("samples", "seed", "soiling", "width", "denoiser"):
            if before.get(name) != facts[name]:
                raise ValueError(f"{path.parent}: has pictures with {name} {before.get(name)}, not {facts[name]}")
    path.write_text(json.dumps(facts, indent=2, sort_keys=True) + "\n")


def _write(frame, folder, suffix, draw):
    """`draw` makes the file of a frame under another name; returns seconds, or None where it was there."""
    target = folder / (frame.stem + suffix)
    for left in folder.glob(f".{frame.stem}.partial*"):
        left.unlink()
    if target.exists():
        return None
    began = time.monotonic()
    try:
        draw(folder / f".{frame.stem}.partial")
        made = list(folder.glob(f".{frame.stem}.partial*"))
        if len(made) != 1 or made[0].stat().st_size == 0:
            raise RuntimeError(f"{target}: Blender has written nothing")
        made[0].rename(target)
    finally:
        for left in folder.glob(f".{frame.stem}.partial*"):
            left.unlink()
    return time.monotonic() - began


def _all(frames, folder, suffix, draw, width):
    folder.mkdir(parents=True, exist_ok=True)
    for frame in frames:
        scene.place_camera(frame, width)
        seconds = _write(frame, folder, suffix, lambda path, frame=frame: draw(frame, path))
        print(f"{folder.name}/{frame.stem}{suffix}: " + ("kept" if seconds is None else f"{seconds:.1f} s"), flush=True)


def images(frames, out, options):
    here = bpy.context.scene

    def draw(frame, path):
        here.cycles.seed = options.seed + frame.number
        here.render.filepath = str(path) + ".png"
        bpy.ops.render.render(write_still=True)

    _all(frames, out / "images", ".png", draw, options.width)


def depth(frames, out, options):
    """Planar z at pixel centres, everything opaque; sky is 1e10."""
    here = bpy.context.scene
    here.cycles.samples, here.cycles.use_denoising = 1, False
    here.world = None
    for layer in here.view_layers:
        layer.use_pass_z, layer.material_override = True, materials.opaque()
    here.use_nodes = True
    tree = here.node_tree
    tree.nodes.clear()
    layers, file = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeOutputFile")
    file.format.file_format, file.format.color_depth, file.format.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    file.layer_slots.clear()
    file.layer_slots.new("Depth")
    tree.links.new(layers.outputs["Depth"], file.inputs[0])

    def draw(frame, path):
        file.base_path = str(path)
        bpy.ops.render.render()

    _all(frames, out / "depth_blender", ".exr", draw, options.width)


def run(options):
    if options.mesh:
        scene.add_mesh(options.mesh, options.soiling)
        scene.add_sky()
    elif not bpy.data.filepath:
        raise ValueError("--mesh expected, or a .blend file before --python")
    frames = scene.read_frames(options.transforms, options.frames)
    if not frames:
        raise ValueError(f"{options.transforms}: no frame is in {options.frames}")
    out, maps = pathlib.Path(options.out), options.maps.split(",")
    out.mkdir(parents=True, exist_ok=True)
    facts = prepare(options)
    if "images" in maps:
        _keep_facts(out / "render.json", facts)
        images(frames, out, options)
    if "depth" in maps:
        depth(frames, out, options)
