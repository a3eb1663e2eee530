#!/usr/bin/env python3
"""Writes a scene of spheres on a floor, one with each of the example materials, or several with each of the
drafts, of the models, or of OpenPBR with hair and stone.

usage: make_scene.py [--drafts | --models | --openpbr] OUTPUT.gltf
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from scene_parts import Buffer, png, sphere, write_scene

SEGMENTS, RINGS = 32, 16

# Spheres of the front row; the others stand behind, in its middle.
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
]

# The textures are those of TEXTURES.
DRAFTS = [
    {"name": "Varnished wood",
     "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.3, 0.14, 1], "metallicFactor": 0, "roughnessFactor": 0.7},
     "extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatColorFactor": [1, 0.8, 0.55],
                                           "coatRoughnessFactor": 0.1, "coatIor": 1.6}}},
    {"name": "Worn varnish",
     "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.8},
     "normalTexture": {"index": 1},
     "extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatTexture": {"index": 2},
                                           "coatColorFactor": [1, 0.9, 0.8], "coatColorTexture": {"index": 3},
                                           "coatRoughnessFactor": 0.5, "coatRoughnessTexture": {"index": 3}}}},
    {"name": "Brushed lacquer",
     "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.01, 0.02, 1], "metallicFactor": 0, "roughnessFactor": 0.6},
     "extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatRoughnessFactor": 0.25, "coatAnisotropyStrength": 0.9,
                                           "coatAnisotropyRotation": 0.6, "coatAnisotropyTexture": {"index": 4},
                                           "coatNormalTexture": {"index": 1, "scale": 0.4}}}},
    {"name": "Fuzzy cloth",
     "pbrMetallicRoughness": {"baseColorFactor": [0.05, 0.08, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"KHR_materials_fuzz": {"fuzzFactor": 0.9, "fuzzColorFactor": [0.7, 0.8, 1],
                                           "fuzzRoughnessFactor": 0.5}}},
    {"name": "Patched velvet",
     "pbrMetallicRoughness": {"baseColorFactor": [0.12, 0.02, 0.05, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"KHR_materials_fuzz": {"fuzzFactor": 1, "fuzzTexture": {"index": 2},
                                           "fuzzColorTexture": {"index": 3}, "fuzzRoughnessFactor": 0.8,
                                           "fuzzRoughnessTexture": {"index": 5}}}},
    {"name": "Clay",
     "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.3, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.9},
     "extensions": {"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 1,
                                                        "diffuseRoughnessTexture": {"index": 5}}}},
]

MODELS = [
    {"name": "Toon", "extensions": {"EXAMPLE_materials_toon": {"toonColor": [0.8, 0.25, 0.1, 1], "toonBands": 3}}},
    {"name": "Toon bricks", "extensions": {"EXAMPLE_materials_toon": {"toonBands": 5, "toonTexture": {"index": 0}}}},
    {"name": "Blinn-Phong",
     "extensions": {"EXAMPLE_materials_blinn_phong": {"diffuse": [0.05, 0.2, 0.5, 1],
                                                      "specular": [0.3, 0.3, 0.3], "shininess": 60}}},
    {"name": "Varnished Blinn-Phong",
     "extensions": {"EXAMPLE_materials_blinn_phong": {"diffuseTexture": {"index": 0},
                                                      "specularTexture": {"index": 2},
                                                      "specular": [0.5, 0.4, 0.3], "shininess": 12},
                    "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}}},
    {"name": "Leaf", "doubleSided": True,
     "extensions": {"EXAMPLE_materials_leaf": {"leafColor": [0.3, 0.6, 0.1, 1], "leafPassed": [0.5, 0.6, 0.3]}}},
    {"name": "glTF",
     "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.25, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.4}},
]



def openpbr(name, values, **more):
    return {"name": name, **more, "extensions": {"EXAMPLE_materials_openpbr": values}}


OPENPBR = [
    openpbr("Car paint", {"base_color": [0.55, 0.02, 0.03, 1], "base_metalness": 0.6, "specular_roughness": 0.4,
                          "coat_weight": 1, "coat_color": [1, 0.85, 0.8], "coat_roughness": 0.02}),
    openpbr("Brushed copper", {"base_color": [0.93, 0.62, 0.5, 1], "base_metalness": 1,
                               "specular_color": [0.98, 0.9, 0.85], "specular_roughness": 0.4,
                               "specular_roughness_anisotropy": 0.85}),
    openpbr("Glass", {"transmission_weight": 1, "specular_roughness": 0, "specular_ior": 1.6,
                      "transmission_color": [0.5, 0.85, 0.75], "transmission_depth": 1.5,
                      "transmission_dispersion_scale": 0.5}, doubleSided=True),
    openpbr("Film on metal", {"base_color": [0.5, 0.5, 0.5, 1], "base_metalness": 1, "specular_roughness": 0.15,
                              "thin_film_weight": 1, "thin_film_thickness": 0.45, "thin_film_ior": 1.5}),
    {"name": "Hair", "extensions": {"EXAMPLE_materials_hair": {"hairColor": [0.5, 0.25, 0.08, 1]}}},
    {"name": "Stone", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"EXAMPLE_materials_stone": {}}},
    openpbr("Clay", {"base_color": [0.6, 0.33, 0.2, 1], "base_diffuse_roughness": 1, "specular_weight": 0.3,
                     "specular_roughness": 0.6}),
    openpbr("Velvet", {"base_color": [0.08, 0.02, 0.2, 1], "specular_weight": 0, "fuzz_weight": 1,
                       "fuzz_color": [0.6, 0.5, 0.9], "fuzz_roughness": 0.4}),
    openpbr("Skin", {"subsurface_weight": 1, "subsurface_color": [0.8, 0.5, 0.4], "specular_roughness": 0.45}),
    openpbr("Honey", {"transmission_weight": 1, "specular_roughness": 0.05, "transmission_color": [0.9, 0.5, 0.1],
                      "transmission_depth": 0.8, "transmission_scatter": [0.3, 0.2, 0.05]}, doubleSided=True),
    openpbr("Lamp", {"base_color": [0.8, 0.8, 0.8, 1], "emission_luminance": 3, "emission_color": [1, 0.8, 0.5]}),
]

FLOOR = {"name": "Floor",
         "pbrMetallicRoughness": {"baseColorFactor": [0.35, 0.35, 0.35, 1], "metallicFactor": 0,
                                  "roughnessFactor": 0.9}}


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


def grooves(x, y):
    """The anisotropy of a texel: around a point in columns of 16, with the strength in blue."""
    angle = 2 * math.pi * (x % 16) / 16
    return round(127.5 + 127.5 * math.cos(angle)), round(127.5 + 127.5 * math.sin(angle)), 255 if y % 32 < 24 else 60


TEXTURES = [
    brick_color,
    brick_normal,
    lambda x, y: (255,) * 3 if brick(x, y)[0] >= 2 else (20,) * 3,
    lambda x, y: ((255, 120, 60), (90, 180, 255), (230, 230, 120), (160, 255, 160))[brick(x, y)[1] % 4],
    grooves,
    lambda x, y: (255, 255, 255, 60 + 24 * brick(x, y)[1]),
]


def strand(sides=6, rings=16, radius=0.035):
    """Returns positions, normals, tangents, UVs and indices of a tube down a unit sphere, in a wave."""
    positions, normals, tangents, uvs, indices = [], [], [], [], []
    for ring in range(rings + 1):
        theta = 0.03 + 2.4 * ring / rings
        bend = 0.3 * math.cos(5 * theta)
        length = math.hypot(1, bend)
        out = (math.sin(theta), math.cos(theta), 0)
        along = (math.cos(theta) / length, -math.sin(theta) / length, bend / length)
        across = (-bend * math.cos(theta) / length, bend * math.sin(theta) / length, 1 / length)
        width = radius * math.sqrt(math.sin(theta))
        for side in range(sides + 1):
            turn = 2 * math.pi * side / sides
            n = [math.cos(turn) * a + math.sin(turn) * b for a, b in zip(out, across)]
            positions += [o + w + width * c for o, w, c in zip(out, (0, 0, 0.06 * math.sin(5 * theta)), n)]
            normals += n
            tangents += (*along, 1.0)
            uvs += (side / sides, ring / rings)
    for ring in range(rings):
        for side in range(sides):
            a = ring * (sides + 1) + side
            b = a + sides + 1
            indices += (a, a + 1, b, a + 1, b + 1, b)
    return positions, normals, tangents, uvs, indices


def hair_nodes(mesh, place, count=64):
    """Returns three layers of strands about a place."""
    nodes = []
    for layer in range(3):
        for i in range(count):
            turn = math.pi * (i + layer / 3 + 0.3 * math.sin(7 * i + layer)) / count
            size = 0.94 + 0.03 * layer + 0.02 * math.sin(5 * i)
            nodes.append({"mesh": mesh, "translation": place, "scale": [round(size, 3)] * 3,
                          "rotation": [0, round(math.sin(turn), 5), 0, round(math.cos(turn), 5)]})
    return nodes


def main():
    lists = {"--drafts": DRAFTS, "--models": MODELS, "--openpbr": OPENPBR}
    others = lists.get(sys.argv[1]) if len(sys.argv) == 3 else None
    if len(sys.argv) != 2 and not others:
        sys.exit(__doc__.strip())
    materials = (others or MATERIALS) + [FLOOR]
    textures = TEXTURES if others else TEXTURES[:2]
    positions, normals, tangents, uvs, indices = sphere(SEGMENTS, RINGS)
    buffer = Buffer()
    ball = {"POSITION": buffer.add(positions, 3, min=[-1, -1, -1], max=[1, 1, 1]),
            "NORMAL": buffer.add(normals, 3), "TANGENT": buffer.add(tangents, 4), "TEXCOORD_0": buffer.add(uvs, 2)}
    if not others:
        hills = {**ball, "_TERRAIN": buffer.add(terrain_shares(positions), 3)}
    faces = buffer.add_indices(indices)
    ground = {"POSITION": buffer.add([-12, 0, 6, 12, 0, 6, 12, 0, -9, -12, 0, -9], 3, min=[-12, 0, -9], max=[12, 0, 6])}
    ground_faces = buffer.add_indices([0, 1, 2, 0, 2, 3])
    count = len(materials) - 1
    meshes = [{"primitives": [{"attributes": hills if m["name"] == "Terrain" else ball, "indices": faces,
                               "material": i}]} for i, m in enumerate(materials[:-1])]
    meshes.append({"primitives": [{"attributes": ground, "indices": ground_faces, "material": count}]})

    def place(i):
        row, column = (0, i) if i < FRONT else (1, i - FRONT)
        columns = FRONT if row == 0 else count - FRONT
        return [2.3 * (column - (columns - 1) / 2), 1, 1.2 - 3.2 * row]

    nodes = [{"mesh": i, "translation": place(i)} for i in range(count)]
    hair = next((i for i, m in enumerate(materials) if m["name"] == "Hair"), None)
    if hair is not None:
        positions, normals, tangents, uvs, indices = strand()
        low, high = ([f(positions[k::3]) for k in range(3)] for f in (min, max))
        tube = {"POSITION": buffer.add(positions, 3, min=low, max=high), "NORMAL": buffer.add(normals, 3),
                "TANGENT": buffer.add(tangents, 4), "TEXCOORD_0": buffer.add(uvs, 2)}
        meshes[hair] = {"primitives": [{"attributes": tube, "indices": buffer.add_indices(indices), "material": hair}]}
        nodes[hair:hair + 1] = hair_nodes(hair, place(hair))
    nodes.append({"mesh": count})
    nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}},
                  "rotation": [-0.5, 0.2, 0.1, 0.83666]})
    nodes.append({"camera": 0, "translation": [0, 8.4, 16], "rotation": [-0.21644, 0, 0, 0.9763]})
    names = sorted({name for m in materials for name in m.get("extensions", {})} | {"KHR_lights_punctual"})
    write_scene(sys.argv[-1], names, nodes, buffer, meshes=meshes, materials=materials,
                images=[{"uri": png(64, 64, pixel)} for pixel in textures],
                textures=[{"source": i} for i in range(len(textures))],
                cameras=[{"type": "perspective", "perspective": {"yfov": 0.284, "znear": 0.1, "aspectRatio": 3}}],
                extensions={"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2.5}]}})


if __name__ == "__main__":
    main()
