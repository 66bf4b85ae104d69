#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Cuts three frames of each method out of the full batches, with numpy: cut.py FOLDER_OF_METHODS"""
import shutil
import sys
from pathlib import Path

import numpy as np

source, here = Path(sys.argv[1]), Path(__file__).parent
FRAMES = 3


def names(folder, batch, first=0):
    lines = (batch / "names.txt").read_text().split()[first:first + FRAMES]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "names.txt").write_text("\n".join(lines) + "\n")


def members(path):
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name] for name in file.files if name not in ("image", "images", "pose_enc_list")}


def da3():
    batch = source / "da3/crane/batch_000"
    arrays = {k: v[:FRAMES] for k, v in members(batch / "exports/mini_npz/results.npz").items()}
    folder = here / "da3"
    names(folder, batch)
    (folder / "exports/mini_npz").mkdir(parents=True, exist_ok=True)
    np.savez_compressed(folder / "exports/mini_npz/results.npz", **arrays)

    # The other spelling of its documentation, with the intrinsics of the original image (480 x 270) as its race leaves.
    size = np.diag([480 / 168, 270 / 98, 1]).astype(np.float32)
    folder = here / "da3_spelling"
    names(folder, batch)
    np.savez_compressed(folder / "results.npz", depth=arrays["depth"], conf=arrays["conf"],
                        exts=arrays["extrinsics"], ixts=size @ arrays["intrinsics"])

    folder = here / "da3_streaming"
    (folder / "results_output").mkdir(parents=True, exist_ok=True)
    names(folder, batch)
    poses, k = [], []
    for i in range(FRAMES):
        np.savez_compressed(folder / f"results_output/frame_{i}.npz", depth=arrays["depth"][i], conf=arrays["conf"][i])
        m = np.eye(4)
        m[:3] = arrays["extrinsics"][i]
        poses.append(" ".join(f"{x:.9g}" for x in np.linalg.inv(m).ravel()))
        intrinsics = arrays["intrinsics"][i]
        k.append(" ".join(f"{intrinsics[at]:.9g}" for at in ((0, 0), (1, 1), (0, 2), (1, 2))))
    (folder / "camera_poses.txt").write_text("\n".join(poses) + "\n")
    (folder / "intrinsic.txt").write_text("\n".join(k) + "\n")


def vggt():
    batch = source / "vggt/crane/batch_000"
    arrays = {k: v[:FRAMES] for k, v in members(batch / "predictions.npz").items()}
    folder = here / "vggt"
    names(folder, batch)
    np.savez_compressed(folder / "predictions.npz", pose_enc_list=None, **arrays)


def pi3():
    for k, batch in enumerate(("batch_000", "batch_001")):  # with and without the leading axis of length 1
        path = source / "pi3/crane" / batch
        arrays = members(path / "res.npz")
        cut = {name: a[:, :FRAMES] if a.shape[0] == 1 else a[:FRAMES] for name, a in arrays.items() if name != "points"}
        folder = here / "pi3" / f"batch_{k:03d}"
        names(folder, path)
        np.savez_compressed(folder / "res.npz", **cut)
    path = source / "pi3/crane/batch_006"
    arrays = members(path / "predictions.npz")
    folder = here / "pi3_demo"
    names(folder, path)
    np.savez_compressed(folder / "predictions.npz", **{name: a[:1] for name, a in arrays.items()})
    (folder / "names.txt").write_text((path / "names.txt").read_text().split()[0] + "\n")


def cut3r():
    batch = source / "cut3r/office/batch_000"
    folder = here / "cut3r"
    names(folder, batch)
    for part, extension in (("depth", "npy"), ("conf", "npy"), ("camera", "npz")):
        (folder / part).mkdir(exist_ok=True)
        for i in range(FRAMES):
            shutil.copyfile(batch / part / f"{i:06d}.{extension}", folder / part / f"{i:06d}.{extension}")


def monst3r():
    batch = source / "monst3r/office/batch_000"
    folder = here / "monst3r"
    names(folder, batch)
    for i in range(FRAMES):
        for name in (f"frame_{i:04d}.npy", f"conf_{i}.npy"):
            shutil.copyfile(batch / name, folder / name)
    for name in ("pred_traj.txt", "pred_intrinsics.txt", "pred_focal.txt"):
        lines = (batch / name).read_text().splitlines()[:FRAMES]
        (folder / name).write_text("\n".join(lines) + "\n")


for method in (da3, vggt, pi3, cut3r, monst3r):
    method()
