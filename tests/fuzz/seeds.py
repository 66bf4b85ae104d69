# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Writes small sound files for the fuzzer, a folder for each reader: what it would not find by chance.

usage: seeds.py FOLDER

They reach the codecs, types and clauses of formats that no file of the benchmark or the zoo has.
"""

import io
import json
import pathlib
import struct
import sys
import zipfile
import zlib

TURN = "0 -1 0 1 1 0 0 2 0 0 1 3"  # a pose: a quarter about z, then a step
LAST = " 0 0 0 1"


def packed(kind, *values):
    return struct.pack(f"<{len(values)}{kind}", *values)


def text(*lines):
    return ("\n".join(lines) + "\n").encode()


# Clouds ------------------------------------------------------------------------------------------

PCD = text("# .PCD v0.7", "VERSION 0.7", "FIELDS x y z rgb normal_x normal_y normal_z label _ t i",
           "SIZE 4 4 8 4 4 4 4 2 1 8 1", "TYPE F F F F F F F U U I I", "COUNT 1 1 1 1 1 1 1 1 3 1 1",
           "WIDTH 2", "HEIGHT 1", "VIEWPOINT 0 0 1 1 0 0 0", "POINTS 2")
PCD_ROW = (packed("f", 1, 2), packed("d", 3), packed("I", 0xFF901020), packed("f", 0, 0, 1), packed("H", 7), b"abc",
           packed("q", -1), b"\xff")


def pcd():
    row = b"".join(PCD_ROW)
    fields = [packed("f", 1), packed("f", 2), packed("d", 3), *PCD_ROW[2:3], *[packed("f", v) for v in (0, 0, 1)], *PCD_ROW[4:]]
    plain = b"".join(2 * field for field in fields)
    literal = b"".join(bytes([len(plain[i:i + 32]) - 1]) + plain[i:i + 32] for i in range(0, len(plain), 32))
    repeated = b"\x00\x00" + b"\xe0" + bytes([len(plain) - 1 - 9]) + b"\x00"  # a zero, and it again
    for name, data in ("literal", literal), ("repeated", repeated):
        yield name, PCD + text("DATA binary_compressed") + packed("I", len(data), len(plain)) + data
    yield "integers", text("VERSION .7", "FIELDS x y z rgba label", "SIZE 1 4 8 4 8", "TYPE I I U I U", "POINTS 2",
                           "DATA binary") + 2 * (b"\xff" + packed("i", -2) + packed("Q", 3) + packed("i", -4) + packed("Q", 5))
    yield "binary", PCD + text("DATA binary") + 2 * row
    yield "ascii", PCD + text("DATA ascii", *2 * ["1 2 3 4.2e9 0 0 1 7 1 2 3 -1 -1"])


def las():
    # Point format: bytes of a record, where the version puts the number of points.
    for form, size, minor in (2, 26, 2), (7, 36, 4), (10, 67, 4):
        header = bytearray(375)
        header[0:4], header[24:26], header[104] = b"LASF", bytes([1, minor]), form
        header[96:100], header[105:107] = packed("I", 375), packed("H", size)
        header[107:111] = packed("I", 2 if minor < 4 else 0)
        header[131:179] = packed("d", 0.001, 0.001, 0.001, 500000, 5400000, 100)
        header[247:255] = packed("Q", 2)
        yield f"format{form}", bytes(header) + 2 * (packed("i", 1001, 2002, -3) + bytes(range(size - 12)))


def ply():
    head = ("ply", "comment labels: 0=ground 1=tower 7=roof", "comment a comment")
    names = ("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "label", "a", "b")
    for name, byte_order, kinds in (
        ("big", ">", "fffffffBBBHi"), ("doubles", "<", "ddddddffIbhB"), ("shorts", "<", "hhhfffHHHIBb")):
        kinds = (kinds + "BB")[:len(names)]
        types = {"b": "char", "B": "uchar", "h": "short", "H": "ushort", "i": "int", "I": "uint", "f": "float", "d": "double"}
        columns = [f"property {types[k]} {n}" for k, n in zip(kinds, names)]
        row = struct.pack(byte_order + kinds, *[1 if k in "fd" else i for i, k in enumerate(kinds)])
        fmt = f"format binary_{'big' if byte_order == '>' else 'little'}_endian 1.0"
        face = struct.pack(byte_order + "B4IB", 4, 0, 1, 2, 3, 7)
        yield name, text(*head, fmt, "element vertex 4", *columns, "element face 1", "property list uchar uint vertex_indices",
                         "property uchar label", "element edge 1", "property list int float data", "end_header"
                         ) + 4 * row + face + struct.pack(byte_order + "if", 1, 2)
    for name in ("packed", "rows"):
        yield name, text("ply", "format binary_little_endian 1.0", "element vertex 2", "property float x", "property float y",
                         "property float z", *(["property list uchar char w"] if name == "rows" else []), "end_header"
                         ) + 2 * (packed("f", 1, 2, 3) + (b"\2ab" if name == "rows" else b""))
    yield "ascii", text("ply", "format ascii 1.0", "element vertex 2", "property float x", "property float y", "property float z",
                        "property uchar red", "property float green", "property ushort blue", "end_header", *2 * ["1 2 inf 3 0.5 9"])
    yield "splats", text("ply", "format ascii 1.0", "element vertex 1", "property float x", "property float y", "property float z",
                         "property float f_dc_0", "property float opacity", "end_header", "1 2 3 4 5")
    yield "list", text("ply", "format ascii 1.0", "obj_info none", "element other 1", "property list uchar int i",
                       "element vertex 1", "property float x", "property float y", "property list short float w",
                       "property float z", "end_header", "2 1 2", "1 2 2 8 9 3")


def xyz():
    yield "names", text("// made up", "x,y,z,nx,ny,nz,red,green,blue", "1,2,3,0,0,1,255,0,7", "4,5,6,0,1,0,nan,-1,1e-400")
    yield "pts", text("2", "1 2 3 -9 255 0 0 0 0 1", "+4 5 6 7 1 2 3 0 1 0")
    yield "unknown", text("1;2;3;0.5;0.5", "4;5;6;0.5;0.5")


# Arrays ------------------------------------------------------------------------------------------

def npy(descr, shape, data, fortran=False, version=1):
    words = f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}".encode()
    length = packed("H", len(words)) if version == 1 else packed("I", len(words))
    return b"\x93NUMPY" + bytes([version, 0]) + length + words + data


def npz(method, **members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name + ".npy"), content, method)
    return file.getvalue()


def zip64(name, content):
    """One stored member whose sizes and place, and those of the directory, stand in zip64 fields."""
    name, most = name.encode() + b".npy", 0xFFFFFFFF
    extra = packed("H", 1, 24) + packed("Q", len(content), len(content), 0)
    fields = packed("H", 45, 0, 0, 0, 33) + packed("I", zlib.crc32(content), most, most) + packed("H", len(name), len(extra))
    member = b"PK\3\4" + fields + name + extra + content
    entry = b"PK\1\2" + packed("H", 45) + fields + packed("H", 0, 0, 0) + packed("I", 0, most) + name + extra
    end = b"PK\6\6" + packed("Q", 44) + packed("H", 45, 45) + packed("I", 0, 0) + packed("Q", 1, 1, len(entry), len(member))
    locator = b"PK\6\7" + packed("I", 0) + packed("Q", len(member) + len(entry)) + packed("I", 1)
    return member + entry + end + locator + b"PK\5\6" + packed("H", 0, 0, 0xFFFF, 0xFFFF) + packed("I", most, most) + packed("H", 0)


POINTS = npy("<f4", "(2, 3)", packed("f", 1, 2, 3, 4, 5, 6))
EYE = (0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1)
K = npy("<f8", "(1, 3, 3)", packed("d", 50, 0, 20, 0, 50, 20, 0, 0, 1))


def arrays():
    for kind in "b1 i1 i2 i4 i8 u1 u2 u4 u8 f2 f4 f8".split():
        yield kind, npy((">" if kind[1] != "1" else "|") + kind, "(2, 3)", bytes(6 * int(kind[1])), fortran=kind == "f4", version=2)
    yield "integers", npy("<i8", "(2, 3)", packed("q", 1, 2, 3, 4, 5, 6), fortran=True)


def npz_clouds():
    colors = npy("|u1", "(2, 3)", bytes(range(6)))
    yield "stored", npz(zipfile.ZIP_STORED, points=POINTS, colors=colors)
    yield "deflated", npz(zipfile.ZIP_DEFLATED, other=POINTS, rgb=colors, text=npy("|O", "()", b"\x80"))
    yield "zip64", zip64("xyz", POINTS)


def npz_maps():
    for name, method in ("stored", zipfile.ZIP_STORED), ("deflated", zipfile.ZIP_DEFLATED):
        yield name, npz(method, local_points=npy("<f4", "(1, 2, 2, 2, 3)", packed("f", *range(24))), conf=POINTS)
        yield name + "-one", npz(method, any=npy("<f8", "(2, 2, 1)", packed("d", 1, 2, 3, 4)))
    yield "zip64", zip64("depth", npy(">f4", "(2, 2, 2)", bytes(32)))


def npy_poses():
    yield "one", npy("<f8", "(4, 4)", packed("d", *EYE))
    yield "many", npy("<f4", "(1, 2, 3, 4)", packed("f", *EYE[:12], *EYE[:12]))


def npz_poses():
    poses = npy("<f8", "(1, 1, 4, 4)", packed("d", *EYE))
    for key in "extrinsics exts extrinsic camera_poses cam_c2w pose c2w w2c".split():
        yield key, npz(zipfile.ZIP_DEFLATED, **{key: poses}, intrinsics=K, depth=npy("<f4", "(1, 10, 20, 1)", bytes(800)))
    yield "small", npz(zipfile.ZIP_STORED, pose=poses, K=K, depths=npy("<f4", "(1, 8, 8)", bytes(256)))


# Depth and pictures ------------------------------------------------------------------------------

def exr(compression, channels, blocks, tiles=None, window=(0, 0, 3, 1), parts=1):
    """Blocks come in the order of the file, each (coordinates, bytes)."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + packed("i", len(value)) + value

    listed = b"".join(name.encode() + b"\0" + packed("i", kind, 0, 1, 1) for name, kind in channels) + b"\0"
    header = attribute("channels", "chlist", listed) + attribute("compression", "compression", bytes([compression]))
    header += attribute("dataWindow", "box2i", packed("i", *window)) + attribute("displayWindow", "box2i", packed("i", 0, 0, 3, 1))
    if tiles:
        header += attribute("tiles", "tiledesc", packed("I", *tiles) + b"\0")
    if parts > 1:
        kind = b"tiledimage" if tiles else b"scanlineimage"
        header += attribute("type", "string", kind) + attribute("chunkCount", "int", packed("i", len(blocks)))
        headers = b"".join(header + attribute("name", "string", b"part%d" % i) + b"\0" for i in range(parts)) + b"\0"
    else:
        headers = header + b"\0"
    flags = (0x1000 if parts > 1 else 0x200 if tiles else 0) | 2
    start = packed("I", 20000630, flags) + headers
    data, offsets = b"", []
    for part in range(parts):
        for place, block in blocks:
            offsets.append(len(start) + 8 * len(blocks) * parts + len(data))
            data += (packed("i", part) if parts > 1 else b"") + packed("i", *place, len(block)) + block
    return start + packed("Q", *offsets) + data


def differences(raw):
    """The bytes as RLE and ZIP have them: even ones first, then what changes."""
    halves = raw[0::2] + raw[1::2]
    return halves[:1] + bytes((b - a + 128) % 256 for a, b in zip(halves, halves[1:]))


def runs(raw):
    """Runs of equal bytes, and a byte alone as such."""
    out, i = b"", 0
    while i < len(raw):
        n = 1
        while n < 128 and raw[i:i + 1] == raw[i + n:i + n + 1]:
            n += 1
        out += bytes([n - 1]) + raw[i:i + 1] if n > 1 else b"\xff" + raw[i:i + 1]
        i += n
    return out


def exrs():
    line = packed("f", 1, 1, 1, 1)
    yield "rle", exr(1, [("Z", 2)], [((y,), runs(differences(bytes(64)))) for y in (0, 1)], window=(0, 0, 15, 1))
    yield "half", exr(0, [("Z", 1)], [((y,), packed("H", 0x3C00, 0x7BFF, 1, 0x7C00)) for y in (0, 1)])
    yield "integer", exr(0, [("Z", 0)], [((y,), packed("I", 1, 2, 3, 4)) for y in (0, 1)])
    yield "zips", exr(2, [("Z", 2)], [((y,), zlib.compress(differences(4 * line))) for y in (0, 1)], window=(0, 0, 15, 1))
    many = [("A", 1), ("U", 0), ("Z", 2)]  # half, integer, float
    planes = zlib.compress(bytes(2 * 64 * (2 + 4 + 3)))
    yield "pxr24", exr(5, many, [((0,), planes)], window=(0, 0, 63, 1))
    yield "none", exr(0, many, [((y,), bytes(8) + packed("I", 1, 2, 3, 4) + line) for y in (0, 1)])
    tile = packed("f", 1, 2, 3, 4)
    yield "tiles", exr(0, [("Z", 2)], [((x, 0, 0, 0), tile) for x in (0, 1)], tiles=(2, 2))
    yield "parts", exr(0, [("V", 2)], [((y,), line) for y in (0, 1)], parts=2)
    yield "part-tiles", exr(0, [("Z", 2)], [((x, 0, 0, 0), tile) for x in (0, 1)], tiles=(2, 2), parts=2)
    yield "window", exr(0, [("R", 2), ("G", 2), ("B", 2)], [((-1,), 9 * packed("f", 1))], window=(-1, -1, 1, -1))
    yield "dwaa", exr(8, [("Y", 1)], [((0,), b"no")])


def dmap():
    for tag, exponent in (b"DR", 0), (b"D2", 255):
        head = tag + bytes([15, exponent]) + packed("I", 4, 4, 2, 2) + packed("f", 0, 9) + (packed("f", 1) if tag == b"D2" else b"")
        head += packed("H", 3) + b"a.b" + packed("I", 2, 7, 8) + packed("d", *EYE, *EYE[:5])
        yield tag.decode(), head + (packed("f", 1, 2, 3, 4) if tag == b"DR" else packed("H", 0x3C00, 0x4200, 0, 1)) + bytes(90)


def png(color, bits, row, height=2, interlaced=0, extra=b""):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 4, height, bits, color, 0, 0, interlaced)
    rows = b"".join(bytes([y % 5]) + row for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pngs():
    palette = b"PLTE" + bytes(range(12))
    palette = struct.pack(">I", 12) + palette + struct.pack(">I", zlib.crc32(palette))
    for name, color, samples in ("gray", 0, 1), ("rgb", 2, 3), ("gray-alpha", 4, 2), ("rgba", 6, 4):
        for bits in (8, 16):
            yield f"{name}{bits}", png(color, bits, bytes(4 * samples * bits // 8), height=6)
    for bits in (1, 2, 4, 8):
        yield f"palette{bits}", png(3, bits, bytes((4 * bits + 7) // 8), extra=palette)
        yield f"gray-of-{bits}", png(0, bits, b"\x5a" * ((4 * bits + 7) // 8))
    yield "interlaced", png(0, 16, bytes(8), height=8, interlaced=1)


# Meshes ------------------------------------------------------------------------------------------

def glb(description, buffer):
    words = json.dumps(description).encode()
    chunks = packed("I", len(words)) + b"JSON" + words + packed("I", len(buffer)) + b"BIN\0" + buffer
    return b"glTF" + packed("I", 2, 12 + len(chunks)) + chunks


def glbs():
    buffer = packed("f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0) + bytes(range(16)) + packed("H", 0, 1, 2, 0, 2, 3)
    buffer += packed("I", 0, 1, 2, 3) + bytes([0, 1, 2, 3]) + packed("H", *range(16)) + packed("f", *[0.5] * 16)
    views = [(0, 48), (48, 16), (64, 12), (76, 16), (92, 4), (96, 32), (128, 64)]
    kinds = [(5126, 4, "VEC3"), (5121, 4, "VEC4"), (5123, 6, "SCALAR"), (5125, 4, "SCALAR"), (5121, 4, "SCALAR"),
             (5123, 4, "VEC4"), (5126, 4, "VEC4")]
    description = {
        "buffers": [{"byteLength": len(buffer)}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": n} for at, n in views],
        "accessors": [{"bufferView": i, "componentType": c, "count": n, "type": t, "byteOffset": 0}
                      for i, (c, n, t) in enumerate(kinds)],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
    }

    def with_primitives(primitives, nodes):
        return glb({**description, "meshes": [{"name": "m", "primitives": primitives}], "nodes": nodes}, buffer)

    position = {"attributes": {"POSITION": 0}}
    turned = [{"children": [1, 2], "translation": [1, 2, 3], "rotation": [0, 0, 0.6, 0.8], "scale": [2, 2, 2]},
              {"mesh": 0, "name": "a"}, {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1]}]
    yield "list", with_primitives([{**position, "indices": 2}, {**position, "mode": 1}], turned)
    yield "strip", with_primitives([{**position, "indices": 3, "mode": 5}, {**position, "indices": 4, "mode": 6}], [{"mesh": 0}])
    yield "points", with_primitives([{"attributes": {"POSITION": 0, "COLOR_0": c}, "mode": 0} for c in (1, 5, 6)], [{"mesh": 0}])
    del description["scenes"]
    description["extensionsRequired"] = ["KHR_materials_unlit"]
    description["bufferViews"][0]["byteStride"] = 12
    yield "roots", with_primitives([position], turned)


# Poses -------------------------------------------------------------------------------------------

def pose_rows():
    for name, line in (("tum", "1.5 1 2 3 0 0 0.6 0.8"), ("tum-nan", "1 nan 2 3 0 0 0 1"), ("kitti", TURN), ("da3", TURN + LAST),
                       ("euroc", "1403636579763555584, 1, 2, 3, 0.8, 0, 0, 0.6, 0, 0")):
        yield name, text("# a comment", line, line)


def pose_logs():
    matrix = ("1 0 0 0", "0 1 0 0", "0 0 1 0", "0 0 0 1")
    yield "found and lost", text("0 0 0", "0 -1 0 1", "1 0 0 2", "0 0 1 3", "0 0 0 1", "1 -1 0", *matrix)


def pose_tables():
    yield "reality-capture", text("#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2", "a b.jpg,1,2,3,10,20,30,24,0,0,0.1,0,0,0,0,0")
    yield "euroc", text("#timestamp [ns],x", "1403636579763555584,1,2,3,0.8,0,0,0.6,0,0,0,0,0,0,0,0,0")


def transforms():
    matrix = [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    frame = {"file_path": "./a b.png", "transform_matrix": matrix}
    sized = {"w": 40, "h": 30, "fl_x": 50, "fl_y": 51, "cx": 20, "cy": 15}
    for name, shared in (
        ("angle", {"camera_angle_x": 0.8, "w": 40, "h": 30}), ("pinhole", sized), ("opencv", {**sized, "k1": 0.1, "p2": 0.1}),
        ("full", {**sized, "k3": 0.1}), ("fisheye", {**sized, "camera_model": "OPENCV_FISHEYE", "k4": 0.1}),
        ("sphere", {"camera_model": "EQUIRECTANGULAR", "w": 40, "h": 30}), ("other", {**sized, "k4": 0.1, "camera_model": "RADIAL"})):
        yield name, json.dumps({**shared, "frames": [frame, {**frame, "transform_matrix": matrix[:3], "fl_x": 49}]}).encode()


def opensfm():
    kinds = "perspective fisheye spherical equirectangular simple_radial radial brown fisheye_opencv dual".split()
    cameras = {k: {"projection_type": k, "width": 40, "height": 30, "focal": 0.8, "k1": 0.1, "c_x": 0.01, "focal_x": 0.7} for k in kinds}

    def shots(of):
        return {f"{k}.jpg": {"camera": k, "rotation": [0, 0, 1.5], "translation": [1, 2, 3]} for k in of}

    part = {"cameras": cameras, "points": {"1": {"coordinates": [1, 2, 3]}}}
    yield "known", json.dumps([{**part, "shots": shots(kinds[:-1])}, {**part, "shots": shots(kinds[:1])}]).encode()
    yield "unknown", json.dumps([{**part, "shots": shots(kinds)}]).encode()


def metashape():
    def sensor(i, kind, words):
        return (f'<sensor id="{i}"><resolution width="40" height="30"/><calibration type="{kind}" class="adjusted">'
                f"{words}</calibration></sensor>")

    words = "".join(f"<{n}>0.1</{n}>" for n in "f cx cy b1 b2 k1 k2 k3 k4 p1 p2".split())
    world = "<transform><rotation>0 -1 0 1 0 0 0 0 1</rotation><translation>1 2 3</translation><scale>2</scale></transform>"
    for name, of_chunk, of_component in ("chunk", world, ""), ("component", "", world), ("alone", "", ""):
        for kinds in ("frame", "fisheye", "spherical"), ("frame", "unknown", "frame"):
            sensors = "".join(sensor(i, kind, words) for i, kind in enumerate(kinds))
            cameras = "".join(f'<camera id="{i}" sensor_id="{i}" component_id="{i % 2}" label="{i}"><transform>{TURN}{LAST}</transform>'
                              "</camera>" for i in range(3))
            yield f"{name}-{kinds[1]}", (
                f'<?xml version="1.0"?><document version="2"><chunk><sensors>{sensors}</sensors><components><component id="0">'
                f'{of_component}</component></components><cameras>{cameras}<group><camera id="9" label="lost"/></group></cameras>'
                f"{of_chunk}</chunk></document>").encode()


def colmap_text():
    """Files of a model, parted by form feeds: images, cameras, points3D, rigs, frames."""
    pose = "1 0 0 0 1 2 3"
    files = (text(f"1 {pose} 1 a b.png", "1 2 -1", f"2 {pose} 2 c.png", ""),
             text("1 PINHOLE 4 3 5 5 2 1.5", "2 OPENCV 4 3 5 5 2 1 0 0 0 0"), text("1 0.5 1 2 10 20 30 0.5 1 0 2 1"),
             text(f"1 3 CAMERA 1 CAMERA 2 1 {pose} IMU 1 0"), text(f"1 1 {pose} 3 CAMERA 1 1 CAMERA 2 2 IMU 1 9"))
    yield "model", b"\f".join(files)


def colmap_rigs():
    pose = packed("d", 1, 0, 0, 0, 1, 2, 3)
    yield "sensors", packed("Q", 1) + packed("I", 1, 3) + packed("i", 0) + packed("I", 1) + packed("i", 0) + packed(
        "I", 2) + b"\1" + pose + packed("i", 1) + packed("I", 1) + b"\0"


SEEDS = {
    "cloud.las": las, "cloud.npy": arrays, "cloud.npz": npz_clouds, "cloud.pcd": pcd, "cloud.ply": ply, "cloud.xyz": xyz,
    "colmap.rigs": colmap_rigs, "colmap.text": colmap_text, "depth.dmap": dmap, "depth.exr": exrs, "depth.npy": arrays,
    "depth.npz": npz_maps, "depth.png": pngs, "image.png": pngs, "mesh.glb": glbs, "mesh.ply": ply, "poses.csv": pose_tables,
    "poses.json": transforms, "poses.log": pose_logs, "poses.npy": npy_poses, "poses.npz": npz_poses, "poses.opensfm": opensfm,
    "poses.txt": pose_rows, "poses.xml": metashape, "stack.npy": arrays, "stack.npz": npz_maps,
}


def main(folder):
    for reader, seeds in SEEDS.items():
        place = pathlib.Path(folder, reader)
        place.mkdir(parents=True, exist_ok=True)
        for name, content in seeds():
            (place / name).write_bytes(content)


if __name__ == "__main__":
    main(*sys.argv[1:])
