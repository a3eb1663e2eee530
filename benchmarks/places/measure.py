#!/usr/bin/env python3
"""Measures how far the picture of a room depends on where the room is and on how large it is.

    benchmarks/places/measure.py GLINT [--distances A:B] [--scales A:B] [OPTION…]

The room of some metres is moved by 10^A to 10^B times its unit, and scaled by 10^A to 10^B: intensities of lights with
the square, all lengths with it. Prints a table in Markdown: the worst difference to the picture at the origin, relative
to the larger of 1 and the value, and the root of the mean of squared differences. OPTION goes to `glint render`.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOM = [  # corner, right, up, material
    ([-4, 0, 4], [8, 0, 0], [0, 0, -8], 0),
    ([-1, 0, -2], [3, 0, 0], [0, 2, 0.25], 1),
    ([-2, 0, -1], [0.75, 0, 0.5], [0, 1, 0], 2),
    ([-2.5, 0.5, 1], [0, 0, -1], [0, 1, 0], 3),
]
MATERIALS = [
    {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.7, 1], "metallicFactor": 0, "roughnessFactor": 0.9}},
    {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}},
    {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1], "metallicFactor": 0}},
    {"emissiveFactor": [1, 0.7, 0.3], "pbrMetallicRoughness": {"metallicFactor": 0}},
]
RADIUS = 0.25  # of the lamps
VIEW = [0.9, 0.1]  # the camera's field of view and near plane


def write_room(path, scale, distance):
    data = bytearray()
    views, accessors, meshes, nodes = [], [], [], []

    def accessor(values, kind, component, width, **more):
        packed = struct.pack(f"<{len(values)}{component}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data.extend(packed)
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if component == "f" else 5125,
                          "count": len(values) // width, "type": kind, **more})
        return len(accessors) - 1

    for number, (corner, right, up, material) in enumerate(ROOM):
        corners = [[c + a * r + b * u for c, r, u in zip(corner, right, up)] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        bounds = {name: [pick(p[axis] for p in corners) for axis in range(3)] for name, pick in (("min", min), ("max", max))}
        attributes = {"POSITION": accessor(sum(corners, []), "VEC3", "f", 3, **bounds)}
        indices = accessor([0, 1, 2, 0, 2, 3], "SCALAR", "I", 1)
        meshes.append({"primitives": [{"attributes": attributes, "indices": indices, "material": material}]})
        nodes.append({"mesh": number, "scale": [scale] * 3})
    lamps = [("point", [1, 2.5, 1], 12), ("spot", [-0.5, 3, 2], 20)]
    lights = []
    for number, (kind, place, candela) in enumerate(lamps):
        lights.append({"type": kind, "intensity": candela * scale * scale, "range": 12 * scale})
        nodes.append({"translation": [scale * x for x in place], "rotation": [-0.4472136, 0, 0, 0.8944272],
                      "extensions": {"KHR_lights_punctual": {"light": number}}})
    nodes.append({"camera": 0, "translation": [0.25 * scale, 2 * scale, 5.5 * scale],
                  "rotation": [-0.1414214, 0, 0, 0.9899495]})
    nodes.append({"children": list(range(len(nodes))), "translation": [scale * distance * x for x in (1, 0.125, -0.75)]})
    camera = {"type": "perspective", "perspective": {"yfov": VIEW[0], "znear": VIEW[1] * scale}}
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [len(nodes) - 1]}], "nodes": nodes,
             "meshes": meshes, "materials": MATERIALS, "cameras": [camera], "accessors": accessors, "bufferViews": views,
             "buffers": [{"uri": "room.bin", "byteLength": len(data)}], "extensionsUsed": ["KHR_lights_punctual"],
             "extensions": {"KHR_lights_punctual": {"lights": lights}}}
    (path / "room.bin").write_bytes(data)
    (path / "room.gltf").write_text(json.dumps(scene))


def picture(arguments, folder, scale, distance, name):
    write_room(folder, scale, distance)
    subprocess.run([arguments.glint, "render", folder / "room.gltf", "-o", folder / name, "--size", "64x48", "--spp", "4",
                    "--effects", "shadow,reflection,indirect-diffuse", "--light-radius", str(RADIUS * scale), "--lights",
                    "2", "--bounces", "2", "--max-roughness", "1", "--emissive-lights", "on", "--quiet",
                    *arguments.options], check=True)


def difference(arguments, folder):
    compared = subprocess.run([arguments.glint, "compare", folder / "moved.exr", folder / "origin.exr", "--json"],
                              check=True, capture_output=True, text=True)
    found = json.loads(compared.stdout)
    unreal = f" | {found['nonFinite']} pixels are not finite" if found["nonFinite"] else ""
    return f"{found['maxRelative']['value']:.2g} | {found['rmse']:.2g}{unreal}"


def decades(text):
    first, last = (int(number) for number in text.split(":"))
    return range(first, last + 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("--distances", type=decades, default=decades("0:9"))
    parser.add_argument("--scales", type=decades, default=decades("-6:6"))
    arguments, arguments.options = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        picture(arguments, folder, 1.0, 0.0, "origin.exr")
        print("| | worst difference | RMSE |\n|---|---|---|")
        for kind, exponents in (("moved by", arguments.distances), ("scaled by", arguments.scales)):
            for exponent in exponents:
                place = (1.0, 10.0**exponent) if kind == "moved by" else (10.0**exponent, 0.0)
                picture(arguments, folder, *place, "moved.exr")
                print(f"| {kind} 1e{exponent} | {difference(arguments, folder)} |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
