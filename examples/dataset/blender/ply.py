# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Labelled triangle meshes as binary PLY, as aib reads and writes them."""

import re

import numpy as np

TYPES = {
    "char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
    "float": "<f4", "double": "<f8", "int8": "i1", "uint8": "u1", "int16": "<i2", "uint16": "<u2",
    "int32": "<i4", "uint32": "<u4", "float32": "<f4", "float64": "<f8",
}


def _parse_header(text, path):
    """Elements as {name: (count, dtype)}, and the names of labels."""
    elements, names = {}, {}
    for line in text.splitlines():
        words = line.split()
        if line.startswith("comment labels:"):
            names = {int(k): name for k, name in re.findall(r"(\d+)=(\S+)", line)}
        elif words[:1] == ["element"]:
            fields = []
            elements[words[1]] = (int(words[2]), fields)
        elif words[:2] == ["property", "list"]:
            fields += [("n", TYPES[words[2]]), (words[4], TYPES[words[3]], 3)]
        elif words[:1] == ["property"]:
            fields.append((words[2], TYPES[words[1]]))
        elif words[:1] == ["format"] and words[1] != "binary_little_endian":
            raise ValueError(f"{path}: binary_little_endian expected, found {words[1]}")
    return {name: (n, np.dtype(fields)) for name, (n, fields) in elements.items()}, names


def read(path):
    """Vertices (N x 3), triangles (M x 3), labels (M), names of labels (a list)."""
    content = open(path, "rb").read()
    end = content.find(b"end_header\n")
    if not content.startswith(b"ply\n") or end < 0:
        raise ValueError(f"{path}: a PLY file expected")
    at = end + len(b"end_header\n")
    elements, names = _parse_header(content[:end].decode(), path)
    (n_vertices, vertex), (n_faces, face) = elements["vertex"], elements["face"]
    v = np.frombuffer(content, vertex, n_vertices, at)
    f = np.frombuffer(content, face, n_faces, at + n_vertices * vertex.itemsize)
    if n_faces and not (f["n"] == 3).all():
        raise ValueError(f"{path}: triangles expected, found other polygons")
    labels = f["label"] if "label" in face.names else np.zeros(n_faces, int)
    corners = next(name for name in face.names if name.startswith("vertex_ind"))
    n_labels = int(labels.max(initial=0)) + 1
    return (np.stack([v["x"], v["y"], v["z"]], 1), f[corners], labels.astype(int),
            [names.get(k, f"label_{k}") for k in range(n_labels)])


def write(path, vertices, triangles, labels, names):
    header = ["ply", "format binary_little_endian 1.0",
              "comment labels: " + " ".join(f"{k}={name}" for k, name in enumerate(names)),
              f"element vertex {len(vertices)}", "property float x", "property float y", "property float z",
              f"element face {len(triangles)}", "property list uchar int vertex_indices", "property int label",
              "end_header\n"]
    faces = np.zeros(len(triangles), np.dtype([("n", "u1"), ("corners", "<i4", 3), ("label", "<i4")]))
    faces["n"], faces["corners"], faces["label"] = 3, triangles, labels
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(np.asarray(vertices, "<f4").tobytes())
        file.write(faces.tobytes())
