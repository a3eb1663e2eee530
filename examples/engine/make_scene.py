#!/usr/bin/env python3
"""Writes the scene of the engine example: spheres and a tilted tile on a tiled floor, under a sun.

usage: make_scene.py OUTPUT.gltf
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from scene_parts import Buffer, png, sphere, write_scene

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


def tile(x, y):
    return (225, 220, 205) if (x // 8 + y // 8) % 2 else (60, 80, 95)


def dent(x, y):
    dx, dy = (x % 16 - 7.5) / 8, (y % 16 - 7.5) / 8
    inside = dx * dx + dy * dy < 0.9
    n = (0.5 * dx, 0.5 * dy, 1) if inside else (0, 0, 1)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(round(127.5 + 127.5 * c / length) for c in n)


def ring_colors():
    """Returns a colour for each vertex of the sphere."""
    return [c for ring in range(RINGS + 1) for _ in range(SEGMENTS + 1)
            for c in (0.1 + 0.8 * ring / RINGS, 0.3, 0.9 - 0.8 * ring / RINGS, 1)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    buffer = Buffer()
    positions, normals, tangents, uvs, indices = sphere(SEGMENTS, RINGS, (4, 2))
    plain = {"POSITION": buffer.add(positions, 3, min=[-1, -1, -1], max=[1, 1, 1]),
             "NORMAL": buffer.add(normals, 3)}
    mapped = {**plain, "TANGENT": buffer.add(tangents, 4), "TEXCOORD_0": buffer.add(uvs, 2)}
    painted = {**plain, "COLOR_0": buffer.add(ring_colors(), 4)}
    ball = buffer.add_indices(indices)
    floor = {"POSITION": buffer.add([-6, 0, 4, 6, 0, 4, 6, 0, -6, -6, 0, -6], 3, min=[-6, 0, -6],
                             max=[6, 0, 4]),
             "NORMAL": buffer.add([0, 1, 0] * 4, 3),
             "TEXCOORD_0": buffer.add([0, 5, 6, 5, 6, 0, 0, 0], 2)}
    square = buffer.add_indices([0, 1, 2, 0, 2, 3])

    shapes = [(floor, square, 0), (plain, ball, 1), (painted, ball, 2), (mapped, ball, 3), (plain, ball, 4),
              (plain, ball, 5)]
    meshes = [{"primitives": [{"attributes": a, "indices": i, "material": m}]} for a, i, m in shapes]
    places = [[0, 0, 0], [-2.4, 0.9, 0], [0, 0.9, -0.8], [2.4, 0.9, 0], [-1.1, 0.5, 1.5], [1.3, 0.35, 1.4]]
    sizes = [1, 0.9, 0.9, 0.9, 0.5, 0.35]
    nodes = [{"mesh": i, "translation": p, "scale": [s] * 3} for i, (p, s) in enumerate(zip(places, sizes))]
    nodes.append({"mesh": 1, "translation": [0.1, 0.4, 1.9], "scale": [0.4] * 3})
    nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.5, 0.2, 0.1, 0.83666]})
    nodes.append({"camera": 0, "translation": [0, 2.4, 6.5], "rotation": [-0.1305, 0, 0, 0.99144]})
    write_scene(sys.argv[1], ["KHR_lights_punctual", "KHR_materials_sheen", "KHR_materials_unlit"], nodes, buffer,
                meshes=meshes, materials=MATERIALS,
                images=[{"uri": png(64, 64, tile)}, {"uri": png(64, 64, dent)}],
                samplers=[{"magFilter": 9729, "minFilter": 9987}],
                textures=[{"source": 0, "sampler": 0}, {"source": 1, "sampler": 0}],
                cameras=[{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.1}}],
                extensions={"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2.5}]}})


if __name__ == "__main__":
    main()
