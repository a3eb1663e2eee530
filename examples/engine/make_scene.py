#!/usr/bin/env python3
"""Writes the scene of the engine example: spheres and a tilted tile on a tiled floor, under a sun.

usage: make_scene.py OUTPUT.gltf
"""

import base64
import json
import math
import struct
import sys
import zlib

SEGMENTS, RINGS = 48, 24

MATERIALS = [
    {"name": "Tiles", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0,
                                               "roughnessFactor": 0.25}},
    {"name": "Gold", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.77, 0.34, 1], "roughnessFactor": 0.1}},
    {"name": "Painted", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.4}},
    {"name": "Hammered steel", "pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.62, 0.65, 1],
                                                        "roughnessFactor": 0.3}, "normalTexture": {"index": 1}},
    {"name": "Velvet", "pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.02, 0.05, 1], "metallicFactor": 0},
     "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [0.8, 0.4, 0.5], "sheenRoughnessFactor": 0.4}}},
    {"name": "Lamp", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.85, 0.6, 1]},
     "extensions": {"KHR_materials_unlit": {}}},
]


def png(width, height, pixel):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel(x, y)) for y in range(height))
    data = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
    return "data:image/png;base64," + base64.b64encode(data).decode()


def tile(x, y):
    return (225, 220, 205) if (x // 8 + y // 8) % 2 else (60, 80, 95)


def dent(x, y):
    dx, dy = (x % 16 - 7.5) / 8, (y % 16 - 7.5) / 8
    inside = dx * dx + dy * dy < 0.9
    n = (0.5 * dx, 0.5 * dy, 1) if inside else (0, 0, 1)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(round(127.5 + 127.5 * c / length) for c in n)


def sphere():
    positions, normals, tangents, uvs, colors, indices = [], [], [], [], [], []
    for ring in range(RINGS + 1):
        theta = math.pi * ring / RINGS
        for segment in range(SEGMENTS + 1):
            phi = 2 * math.pi * segment / SEGMENTS
            n = (math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi))
            positions += n
            normals += n
            tangents += (-math.sin(phi), 0.0, -math.cos(phi), 1.0)
            uvs += (4 * segment / SEGMENTS, 2 * ring / RINGS)
            colors += (0.1 + 0.8 * ring / RINGS, 0.3, 0.9 - 0.8 * ring / RINGS, 1)
    for ring in range(RINGS):
        for segment in range(SEGMENTS):
            a = ring * (SEGMENTS + 1) + segment
            b = a + SEGMENTS + 1
            indices += (a, b, a + 1) if ring > 0 else ()
            indices += (a + 1, b, b + 1) if ring < RINGS - 1 else ()
    return positions, normals, tangents, uvs, colors, indices


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    data, views, accessors = b"", [], []

    def add(values, form, kind, size, component, **more):
        nonlocal data
        packed = struct.pack(f"<{len(values)}{form}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // size,
                          "type": kind, **more})
        data += packed + b"\0" * (-len(packed) % 4)
        return len(accessors) - 1

    positions, normals, tangents, uvs, colors, indices = sphere()
    plain = {"POSITION": add(positions, "f", "VEC3", 3, 5126, min=[-1, -1, -1], max=[1, 1, 1]),
             "NORMAL": add(normals, "f", "VEC3", 3, 5126)}
    mapped = {**plain, "TANGENT": add(tangents, "f", "VEC4", 4, 5126), "TEXCOORD_0": add(uvs, "f", "VEC2", 2, 5126)}
    painted = {**plain, "COLOR_0": add(colors, "f", "VEC4", 4, 5126)}
    ball = add(indices, "H", "SCALAR", 1, 5123)
    floor = {"POSITION": add([-6, 0, 4, 6, 0, 4, 6, 0, -6, -6, 0, -6], "f", "VEC3", 3, 5126, min=[-6, 0, -6],
                             max=[6, 0, 4]),
             "NORMAL": add([0, 1, 0] * 4, "f", "VEC3", 3, 5126),
             "TEXCOORD_0": add([0, 5, 6, 5, 6, 0, 0, 0], "f", "VEC2", 2, 5126)}
    square = add([0, 1, 2, 0, 2, 3], "H", "SCALAR", 1, 5123)

    shapes = [(floor, square, 0), (plain, ball, 1), (painted, ball, 2), (mapped, ball, 3), (plain, ball, 4),
              (plain, ball, 5)]
    meshes = [{"primitives": [{"attributes": a, "indices": i, "material": m}]} for a, i, m in shapes]
    places = [[0, 0, 0], [-2.4, 0.9, 0], [0, 0.9, -0.8], [2.4, 0.9, 0], [-1.1, 0.5, 1.5], [1.3, 0.35, 1.4]]
    sizes = [1, 0.9, 0.9, 0.9, 0.5, 0.35]
    nodes = [{"mesh": i, "translation": p, "scale": [s] * 3} for i, (p, s) in enumerate(zip(places, sizes))]
    nodes.append({"mesh": 1, "translation": [0.1, 0.4, 1.9], "scale": [0.4] * 3})
    nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.5, 0.2, 0.1, 0.83666]})
    nodes.append({"camera": 0, "translation": [0, 2.4, 6.5], "rotation": [-0.1305, 0, 0, 0.99144]})
    scene = {"asset": {"version": "2.0", "generator": "make_scene.py"},
             "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_sheen", "KHR_materials_unlit"], "scene": 0,
             "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes, "materials": MATERIALS,
             "images": [{"uri": png(64, 64, tile)}, {"uri": png(64, 64, dent)}],
             "samplers": [{"magFilter": 9729, "minFilter": 9987}],
             "textures": [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 0}],
             "cameras": [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.1}}],
             "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2.5}]}},
             "accessors": accessors, "bufferViews": views,
             "buffers": [{"byteLength": len(data),
                          "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        json.dump(scene, file)
        file.write("\n")


if __name__ == "__main__":
    main()
