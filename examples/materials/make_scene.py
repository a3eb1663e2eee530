#!/usr/bin/env python3
"""Writes a scene of spheres on a floor in two rows, one with each of the example materials.

usage: make_scene.py OUTPUT.gltf
"""

import base64
import json
import math
import struct
import sys

SEGMENTS = 32
RINGS = 16


def sphere():
    """Returns positions, normals, tangents, UVs and indices of a unit sphere."""
    positions, normals, tangents, uvs, indices = [], [], [], [], []
    for ring in range(RINGS + 1):
        theta = math.pi * ring / RINGS
        for segment in range(SEGMENTS + 1):
            phi = 2 * math.pi * segment / SEGMENTS
            n = (math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi))
            positions += n
            normals += n
            tangents += (-math.sin(phi), 0.0, -math.cos(phi), 1.0)
            uvs += (segment / SEGMENTS, ring / RINGS)
    for ring in range(RINGS):
        for segment in range(SEGMENTS):
            a = ring * (SEGMENTS + 1) + segment
            b = a + SEGMENTS + 1
            if ring > 0:
                indices += (a, b, a + 1)
            if ring < RINGS - 1:
                indices += (a + 1, b, b + 1)
    return positions, normals, tangents, uvs, indices


# Spheres of the front row; the others stand behind.
FRONT = 6

MATERIALS = [
    {"name": "Paint with flakes",
     "pbrMetallicRoughness": {"baseColorFactor": [0.02, 0.05, 0.25, 1], "metallicFactor": 0, "roughnessFactor": 0.5},
     "extensions": {"EXAMPLE_materials_flakes": {"flakeCoverage": 0.5, "flakeColor": [0.5, 0.6, 0.9],
                                                 "flakeSize": 0.03, "flakeTilt": 0.35, "flakeRoughness": 0.25},
                    "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}}},
    {"name": "Retroreflector",
     "pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.4, 0.4, 1], "metallicFactor": 0, "roughnessFactor": 0.8},
     "extensions": {"EXAMPLE_materials_retroreflection": {"retroreflectionFactor": 0.8,
                                                          "retroreflectionColor": [1, 0.85, 0.3],
                                                          "retroreflectionRoughness": 0.45}}},
    {"name": "Satin",
     "pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.02, 0.06, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"EXAMPLE_materials_fibre": {"fibreFactor": 0.6, "fibreColor": [1, 0.45, 0.5],
                                                "fibreWidth": 0.12}}},
    {"name": "Dusty brass",
     "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.65, 0.3, 1], "metallicFactor": 1, "roughnessFactor": 0.25},
     "extras": {"dust": {"amount": 0.8, "scale": 0.3}}},
    {"name": "Triplanar",
     "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.7},
     "extensions": {"EXAMPLE_materials_triplanar": {"triplanarScale": 0.7, "triplanarColorTexture": {"index": 0},
                                                    "triplanarNormalTexture": {"index": 1}}}},
    {"name": "Terrain",
     "pbrMetallicRoughness": {"metallicFactor": 0},
     "extensions": {"EXAMPLE_materials_terrain": {"terrainScale": 0.25}}},
    {"name": "Lava",
     "pbrMetallicRoughness": {"baseColorFactor": [0.03, 0.025, 0.022, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"EXAMPLE_materials_lava": {"lavaStrength": 6, "lavaScale": 0.3}}},
    {"name": "Perforated steel", "alphaMode": "MASK", "doubleSided": True,
     "pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.6, 0.62, 1], "metallicFactor": 1, "roughnessFactor": 0.35},
     "extensions": {"EXAMPLE_materials_perforation": {"perforationRows": [36, 18], "perforationRadius": 0.32}}},
    {"name": "Flowing bricks",
     "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.6},
     "extensions": {"EXAMPLE_materials_flow": {"flowVelocity": [0.05, 0], "flowRipple": 0.03, "flowWaves": 3}}},
    {"name": "Varnished wood",
     "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.3, 0.14, 1], "metallicFactor": 0, "roughnessFactor": 0.7},
     "extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatColorFactor": [1, 0.8, 0.55],
                                           "coatRoughnessFactor": 0.1, "coatIor": 1.6}}},
    {"name": "Fuzzy cloth",
     "pbrMetallicRoughness": {"baseColorFactor": [0.05, 0.08, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"KHR_materials_fuzz": {"fuzzFactor": 0.9, "fuzzColorFactor": [0.7, 0.8, 1],
                                           "fuzzRoughnessFactor": 0.5}}},
    {"name": "Clay",
     "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.3, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 1}}},
    {"name": "Floor",
     "pbrMetallicRoughness": {"baseColorFactor": [0.35, 0.35, 0.35, 1], "metallicFactor": 0, "roughnessFactor": 0.9}},
]


def png(width, height, pixel):
    """Returns a PNG of 8-bit RGB whose pixels are pixel(x, y)."""
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel(x, y)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def brick(x, y):
    """Returns how far a texel of a 64 by 64 wall is from the joint, in texels, and which brick it is of."""
    row = y // 16
    x = (x + 16 * (row % 2)) % 64
    return min(x % 32, 31 - x % 32, y % 16, 15 - y % 16), row * 2 + x // 32


def brick_color(x, y):
    edge, number = brick(x, y)
    shade = 20 * (number * 7 % 5)
    return (150 + shade // 2, 70 + shade // 3, 50) if edge >= 1 else (170, 165, 155)


def brick_normal(x, y):
    def height(u, v):
        return min(brick(u % 64, v % 64)[0], 3)

    dx, dy = height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1)
    length = math.sqrt(dx * dx + dy * dy + 9)
    return tuple(round(127.5 + 127.5 * c / length) for c in (-dx, dy, 3))


def terrain_shares(positions):
    """Returns the shares of grass, rock and snow for each vertex: by height."""
    shares = []
    for y in positions[1::3]:
        snow = min(max((y - 0.35) / 0.3, 0), 1)
        grass = min(max((0.1 - y) / 0.4, 0), 1)
        shares += (grass, 1 - snow - grass, snow)
    return shares


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    positions, normals, tangents, uvs, indices = sphere()
    floor = [-12, 0, 6, 12, 0, 6, 12, 0, -9, -12, 0, -9]
    data = b""
    views, accessors = [], []

    def add(values, form, kind, size, component, **more):
        nonlocal data
        packed = struct.pack(f"<{len(values)}{form}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // size,
                          "type": kind, **more})
        data += packed + b"\0" * (-len(packed) % 4)
        return len(accessors) - 1

    ball = {"POSITION": add(positions, "f", "VEC3", 3, 5126, min=[-1, -1, -1], max=[1, 1, 1]),
            "NORMAL": add(normals, "f", "VEC3", 3, 5126), "TANGENT": add(tangents, "f", "VEC4", 4, 5126),
            "TEXCOORD_0": add(uvs, "f", "VEC2", 2, 5126)}
    hills = {**ball, "_TERRAIN": add(terrain_shares(positions), "f", "VEC3", 3, 5126)}
    faces = add(indices, "H", "SCALAR", 1, 5123)
    ground = {"POSITION": add(floor, "f", "VEC3", 3, 5126, min=[-12, 0, -9], max=[12, 0, 6])}
    ground_faces = add([0, 1, 2, 0, 2, 3], "H", "SCALAR", 1, 5123)
    count = len(MATERIALS)
    meshes = [{"primitives": [{"attributes": hills if m["name"] == "Terrain" else ball, "indices": faces,
                               "material": i}]} for i, m in enumerate(MATERIALS[:-1])]
    meshes.append({"primitives": [{"attributes": ground, "indices": ground_faces, "material": count - 1}]})

    def place(i):
        row, column = (0, i) if i < FRONT else (1, i - FRONT)
        return [2.3 * (column - (FRONT - 1) / 2), 1, 1.2 - 3.2 * row]

    nodes = [{"mesh": i, "translation": place(i)} for i in range(count - 1)]
    nodes.append({"mesh": count - 1})
    nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}},
                  "rotation": [-0.5, 0.2, 0.1, 0.83666]})
    nodes.append({"camera": 0, "translation": [0, 8.4, 16], "rotation": [-0.21644, 0, 0, 0.9763]})
    images = [{"mimeType": "image/png", "uri": "data:image/png;base64," + base64.b64encode(png(64, 64, f)).decode()}
              for f in (brick_color, brick_normal)]
    names = sorted({name for m in MATERIALS for name in m.get("extensions", {})} | {"KHR_lights_punctual"})
    scene = {"asset": {"version": "2.0", "generator": "make_scene.py"}, "extensionsUsed": names, "scene": 0,
             "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes, "materials": MATERIALS,
             "images": images, "textures": [{"source": 0}, {"source": 1}],
             "cameras": [{"type": "perspective", "perspective": {"yfov": 0.284, "znear": 0.1, "aspectRatio": 3}}],
             "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2.5}]}},
             "accessors": accessors, "bufferViews": views,
             "buffers": [{"byteLength": len(data),
                          "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        json.dump(scene, file)


if __name__ == "__main__":
    main()
