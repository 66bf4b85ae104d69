#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""A synthetic job of the paper's size: 4763 frames of 504 x 280 depth in one NPZ, their poses, and 50 M points.

    full_size.py FOLDER SHELL      makes the data (3.3 GB, needs numpy) and evaluates it with the shell aib-lua

Prints time and the peak of resident memory of each step. The frames are 16 of their own, repeated; the poses are a
serpentine with noise in a frame and scale of their own.
"""
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np

FRAMES, WIDTH, HEIGHT, POINTS = 4763, 504, 280, 50_000_000
folder, shell = Path(sys.argv[1]), sys.argv[2]
random = np.random.default_rng(1)


def write_stack(file, name, shape, frames):
    """One array of float32, frame by frame, as numpy.savez stores it."""
    with file.open(name + ".npy", "w", force_zip64=True) as member:
        header = {"descr": "<f4", "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(member, header)
        for frame in frames:
            member.write(np.ascontiguousarray(frame, "<f4").tobytes())


def positions():
    row, column = np.divmod(np.arange(FRAMES), 100)
    column = np.where(row % 2 == 0, column, 99 - column)
    return np.stack([0.5 * column, np.zeros(FRAMES), 0.4 * row], axis=1)


def make_method(truth):
    """Depth Anything 3's layout, in a frame of its own: scale 1/3."""
    out = folder / "method"
    out.mkdir(parents=True, exist_ok=True)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    some = [(5 + np.sin(x / 40 + k) + 0.5 * np.cos(y / 25)) / 3 * np.exp(0.02 * random.standard_normal(x.shape))
            for k in range(16)]
    centres = (truth + 0.05 * random.standard_normal(truth.shape)) / 3
    extrinsics = np.zeros((FRAMES, 3, 4), np.float32)
    extrinsics[:, :, :3] = np.eye(3)
    extrinsics[:, :, 3] = -centres
    intrinsics = np.tile(np.array([[700, 0, 252], [0, 700, 140], [0, 0, 1]], np.float32), (FRAMES, 1, 1))
    with zipfile.ZipFile(out / "results.npz", "w", zipfile.ZIP_STORED, allowZip64=True) as file:
        write_stack(file, "depth", (FRAMES, HEIGHT, WIDTH), (some[i % 16] for i in range(FRAMES)))
        write_stack(file, "extrinsics", extrinsics.shape, [extrinsics])
        write_stack(file, "intrinsics", intrinsics.shape, [intrinsics])
    (out / "names.txt").write_text("".join(f"{i:06d}.png\n" for i in range(FRAMES)))


def make_truth(truth):
    out = folder / "truth"
    out.mkdir(parents=True, exist_ok=True)
    (out / "cameras.txt").write_text("1 PINHOLE 504 280 700 700 252 140\n")
    (out / "points3D.txt").write_text("")
    with open(out / "images.txt", "w") as file:
        for i, c in enumerate(truth):
            file.write(f"{i + 1} 1 0 0 0 {-c[0]:.9g} {-c[1]:.9g} {-c[2]:.9g} 1 {i:06d}.png\n\n")
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    np.save(out / "depth.npy", 5 + np.sin(x / 40) + 0.5 * np.cos(y / 25))


def make_cloud(path, n, noise):
    """Points on a wavy square of 50 m."""
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
                   b"property float x\nproperty float y\nproperty float z\nend_header\n" % n)
        for begin in range(0, n, 1 << 20):
            xy = 50 * random.random((min(1 << 20, n - begin), 2))
            z = np.sin(xy[:, 0]) + noise * random.standard_normal(len(xy))
            file.write(np.column_stack([xy, z]).astype("<f4").tobytes())


def measured(*words):
    """Runs a command; its seconds and peak memory."""
    run = subprocess.run(["/usr/bin/time", "-f", "%e s, %M kB", *words], capture_output=True, text=True)
    print(" ".join(words[1:3]), "->", run.stderr.strip().splitlines()[-1], flush=True)
    run.check_returncode()
    return run.stdout


def main():
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "benchmark.lua").exists():
        truth = positions()
        make_method(truth)
        make_truth(truth)
        make_cloud(folder / "estimate.ply", POINTS, 0.01)
        make_cloud(folder / "reference.ply", 1_000_000, 0)
        (folder / "benchmark.lua").write_text("""return {
  scenes = { { name = "office", poses = "truth", depth = "truth/depth.npy" } },
  methods = { { name = "DA3", parameters = "estimated", results = { { scene = "office", output = "method" } } } },
}
""")
        (folder / "cloud.lua").write_text("""local aib = require "aib"
local c = aib.stream.compare_clouds(arg[1], arg[2], { memory = "2GB", tau = { 0.05 } })
print(c.accuracy, c.completeness, c.n_estimate)
""")
    print(measured(shell, "asset_inspection", str(folder), "--confidence", "0", "--stride", "200"))
    print(measured(shell, str(folder / "cloud.lua"), str(folder / "estimate.ply"), str(folder / "reference.ply")))


if __name__ == "__main__":
    main()
