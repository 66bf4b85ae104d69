# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""peers_depth.py FOLDER N: what users run today, on the files of time_depth.

Prints milliseconds of numpy's srmse and of all errors in float64, and frames a second of the whole
pipeline: OpenCV reads where it is here and can, else zlib and numpy."""
import os
import struct
import sys
import time
import zlib

import numpy as np

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
try:
    import cv2
except ImportError:
    cv2 = None


def read_zip_exr(path):
    """One float channel, 16 lines a block."""
    with open(path, "rb") as file:
        data = file.read()
    place, window = 8, None
    while data[place]:
        end = data.index(b"\0", place)
        name, place = data[place:end], end + 1
        place = data.index(b"\0", place) + 1
        (size,) = struct.unpack_from("<i", data, place)
        if name == b"dataWindow":
            window = struct.unpack_from("<4i", data, place + 4)
        place += 4 + size
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    image = np.empty((height, width), np.float32)
    for offset in struct.unpack_from("<%dQ" % ((height + 15) // 16), data, place + 1):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = image[y : y + 16]
        block = data[offset + 8 : offset + 8 + size]
        if size < rows.nbytes:
            delta = np.frombuffer(zlib.decompress(block), np.uint8).copy()
            delta[1:] -= 128
            delta = np.cumsum(delta, dtype=np.uint8)
            half = (len(delta) + 1) // 2
            mixed = np.empty_like(delta)
            mixed[0::2], mixed[1::2] = delta[:half], delta[half:]
            block = mixed.tobytes()
        rows[:] = np.frombuffer(block, np.float32).reshape(rows.shape)
    return image


def read(path):
    image = cv2.imread(path, cv2.IMREAD_UNCHANGED) if cv2 else None
    return read_zip_exr(path) if image is None else image


def srmse(est, ref):
    valid = (ref > 0) & (est > 0) & np.isfinite(ref) & np.isfinite(est)
    d = np.log(ref[valid].astype(np.float64)) - np.log(est[valid].astype(np.float64))
    return np.mean((d - d.mean()) ** 2)


def errors(est, ref):
    valid = (ref > 0) & (est > 0) & np.isfinite(ref) & np.isfinite(est)
    e, r = est[valid].astype(np.float64), ref[valid].astype(np.float64)
    d = np.log(r) - np.log(e)
    difference = np.abs(e - r)
    inverse = 1 / e - 1 / r
    ratio = np.maximum(e / r, r / e)
    return [
        np.mean((d - d.mean()) ** 2), np.sqrt(np.mean(d**2)), np.mean(np.abs(d)) / np.log(10),
        np.mean(difference / r), np.mean(difference**2 / r), np.sqrt(np.mean(difference**2)), np.mean(difference),
        np.sqrt(np.mean(inverse**2)), np.mean(np.abs(inverse)),
        np.mean(ratio < 1.25), np.mean(ratio < 1.25**2), np.mean(ratio < 1.25**3), valid.sum() / (ref > 0).sum(),
    ]  # fmt: skip


def milliseconds(work):
    times = []
    for _ in range(5):
        start = time.perf_counter()
        work()
        times.append(1000 * (time.perf_counter() - start))
    return sorted(times)[2]


folder, n = sys.argv[1], int(sys.argv[2])
pairs = [(f"{folder}/{i}.est.exr", f"{folder}/{i}.gt.exr") for i in range(n)]
first = [read(path) for path in pairs[0]]
print("srmse %.3f" % milliseconds(lambda: srmse(*first)))
print("all %.3f" % milliseconds(lambda: errors(*first)))
print("value %.17g" % srmse(*first))
begin = time.perf_counter()
for est, ref in pairs:
    errors(read(est), read(ref))
print("by", "OpenCV" if cv2 and cv2.imread(pairs[0][0], cv2.IMREAD_UNCHANGED) is not None else "zlib")
print("pipeline %.3f" % (n / (time.perf_counter() - begin)))
