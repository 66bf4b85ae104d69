# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Blender's pictures of a generated scene: repeatable, resumable, and as deep as the ray caster says.

usage: test_blender.py AIB_LUA SOURCE_ROOT
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

WIDTH, HEIGHT, FOCAL = 160, 90, 50 / 36 * 160
# World from camera, OpenGL axes: along the bridge, and down on its deck from the side.
POSES = [
    [[0, 0.08715574, -0.9961947, -52], [-1, 0, 0, -1], [0, 0.9961947, 0.08715574, 13.5], [0, 0, 0, 1]],
    [[1, 0, 0, 6], [0, 0.64278761, -0.76604444, -24], [0, 0.76604444, 0.64278761, 28], [0, 0, 0, 1]],
]


class Bench:
    def __init__(self, aib_lua, root, folder):
        self.aib_lua, self.here = aib_lua, pathlib.Path(root, "tests/dataset")
        self.script = pathlib.Path(root, "examples/dataset/blender.sh")
        self.folder, self.faults = folder, 0

    def check(self, holds, what):
        print(("ok      " if holds else "FAILED  ") + what)
        self.faults += not holds

    def lua(self, script, *arguments):
        done = subprocess.run([self.aib_lua, str(self.here / script), *map(str, arguments)], capture_output=True,
                              text=True)
        print(done.stdout + done.stderr, end="")
        return done.returncode

    def blender(self, *words):
        """Exit code of blender.sh; what it says where it fails is printed."""
        done = subprocess.run([str(word) for word in (self.script, *words)], capture_output=True, text=True)
        if done.returncode:
            print(done.stdout + done.stderr, end="")
        return done.returncode

    def render(self, out, *more):
        return self.blender("render", "--mesh", self.folder / "mesh.ply", "--transforms", self.folder / "transforms.json",
                            "--out", self.folder / out, "--samples", 2, "--threads", 1, "--device", "cpu", *more)


def write_transforms(path):
    # A principal point off the middle: the camera's shift is part of what is compared.
    shared = {"w": WIDTH, "h": HEIGHT, "fl_x": FOCAL, "fl_y": FOCAL, "cx": 83.5, "cy": 41.25}
    frames = [{"file_path": f"{k:06d}.png", "transform_matrix": pose} for k, pose in enumerate(POSES)]
    path.write_text(json.dumps({**shared, "frames": frames}))


def files(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*"))}


def check_rendering(bench):
    folder = bench.folder
    write_transforms(folder / "transforms.json")
    bench.check(bench.lua("write_scene.lua", "bridge", folder / "mesh.ply") == 0, "the scene is written")
    bench.check(bench.render("first", "--maps", "images,depth") == 0, "two frames are rendered")
    bench.check(bench.render("second", "--maps", "images,depth") == 0, "and again")
    for part in ("images", "depth_blender"):
        first = files(folder / "first" / part)
        bench.check(len(first) == 2 and first == files(folder / "second" / part), f"{part}: the same bytes")
    bench.check(bench.lua("compare_depth.lua", folder, folder / "first/depth_blender") == 0,
                "depth is that of the ray caster")
    images = folder / "second/images"
    wanted = files(images)
    kept = (images / "000000.png").stat().st_mtime_ns
    (images / "000001.png").unlink()
    (images / ".000001.partial.png").write_bytes(b"half")
    bench.check(bench.render("second", "--frames", "0:2") == 0, "a stopped run goes on")
    bench.check(files(images) == wanted and (images / "000000.png").stat().st_mtime_ns == kept,
                "the missing frame alone is made, nothing is left behind")
    bench.check(bench.render("second", "--soiling", "high") == 1, "pictures of another soiling are not mixed with these")
    bench.check(bench.render("third", "--mesh", folder / "no.ply") == 1, "a mesh that is not there is exit code 1")


def check_export(bench):
    """Blender's own cube: what is exported is what it renders."""
    folder = bench.folder / "cube"
    folder.mkdir()
    blend = folder / "cube.blend"
    save = f"import bpy; bpy.ops.wm.save_as_mainfile(filepath={str(blend)!r})"
    subprocess.run(["blender", "-b", "--factory-startup", "--python-expr", save], capture_output=True, check=True)
    bench.check(bench.blender(blend, "export", "--out", folder, "--cameras", "all") == 0, "a file is exported")
    bench.check(bench.blender(blend, "render", "--transforms", folder / "transforms.json", "--out", folder, "--maps",
                              "depth", "--width", WIDTH) == 0, "and rendered")
    bench.check(bench.lua("compare_depth.lua", folder, folder / "depth_blender") == 0,
                "its depth is that of the exported mesh")


def main(aib_lua, root):
    if not shutil.which("blender"):
        print("SKIPPED: blender: Blender is not here")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(aib_lua, root, pathlib.Path(folder))
        check_rendering(bench)
        check_export(bench)
    return 1 if bench.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
