#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Cuts the benchmark in this folder out of the rendered scenes that it was made from.

usage: prepare.py SCENES

SCENES holds gt/ and methods/ of the full scenes (480 x 270 pixels, 81 and 61 frames). Taken over unchanged: ground
truth poses and meshes, fused clouds, and every depth map of every 6th (crane) or 4th (office) frame. COLMAP and GLOMAP
models lose their 2-D observations and tracks, which nothing here reads; poses, cameras and points keep every bit.
"""
import pathlib
import shutil
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
SCENES = {"crane": ["crane"], "office": ["office_vlow", "office_high"]}
EVERY = {"crane": 6, "office": 4}


class Reader:
    """Numbers one after another from bytes."""

    def __init__(self, path):
        self.bytes, self.at = path.read_bytes(), 0

    def take(self, n):
        self.at += n
        return self.bytes[self.at - n : self.at]

    def number(self, code):
        return struct.unpack("<" + code, self.take(struct.calcsize("<" + code)))[0]

    def text(self):
        return self.take(self.bytes.index(b"\0", self.at) + 1 - self.at)


def without_observations(path):
    """images.bin: count; id, q, t, camera (64 + 4 bytes), name, 2-D points of 24 bytes."""
    r = Reader(path)
    out = [r.take(8)]
    for _ in range(struct.unpack("<Q", out[0])[0]):
        out += [r.take(64), r.text(), struct.pack("<Q", 0)]
        r.take(24 * r.number("Q"))
    assert r.at == len(r.bytes), path
    return b"".join(out)


def without_tracks(path):
    """points3D.bin: count; id, position, colour, error (43 bytes), track elements of 8 bytes."""
    r = Reader(path)
    out = [r.take(8)]
    for _ in range(struct.unpack("<Q", out[0])[0]):
        out += [r.take(43), struct.pack("<Q", 0)]
        r.take(8 * r.number("Q"))
    assert r.at == len(r.bytes), path
    return b"".join(out)


def copy(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def copy_model(source, target):
    target.mkdir(parents=True)
    (target / "images.bin").write_bytes(without_observations(source / "images.bin"))
    (target / "points3D.bin").write_bytes(without_tracks(source / "points3D.bin"))
    for name in ("cameras.bin", "frames.bin", "rigs.bin"):
        if (source / name).exists():
            copy(source / name, target / name)


def copy_depth(source, target, every):
    for path in sorted(source.glob("*.exr")):
        if int(path.stem) % every == 0:
            copy(path, target / path.name)


def copy_truth(source, target, every):
    for name in ("mesh.ply", "poses/cameras.txt", "poses/images.txt", "poses/points3D.txt"):
        copy(source / name, target / name)
    copy_depth(source / "depth", target / "depth", every)


def copy_methods(source, target, folder, every):
    for method in ("colmap", "glomap"):
        for model in sorted((source / method / folder / "sparse").iterdir()):
            copy_model(model, target / method / folder / "sparse" / model.name)
    for method in ("sgbm_colmap", "sgbm_gtposes"):
        if not (source / method / folder).exists():
            continue
        copy(source / method / folder / "fused.ply", target / method / folder / "fused.ply")
        copy_depth(source / method / folder / "depth", target / method / folder / "depth", every)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    scenes = pathlib.Path(sys.argv[1])
    for part in ("gt", "methods"):
        shutil.rmtree(HERE / part, ignore_errors=True)
    for scene, folders in SCENES.items():
        copy_truth(scenes / "gt" / scene, HERE / "gt" / scene, EVERY[scene])
        for folder in folders:
            copy_methods(scenes / "methods", HERE / "methods", folder, EVERY[scene])


main()
