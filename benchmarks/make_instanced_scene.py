#!/usr/bin/env python3
"""Makes a glTF scene of COUNT plants on a square field, placed by EXT_mesh_gpu_instancing: one node, one mesh of two
primitives (a green cone and a brown stem), a translation, a rotation in 16 bits and a scale for each.

    benchmarks/make_instanced_scene.py COUNT FOLDER     writes FOLDER/instanced.gltf and instanced.bin
"""

import json
import math
import pathlib
import struct
import sys

SEGMENTS = 12


def cone(bottom, top, radius):
    """Positions and triangles of a cone whose tip is above."""
    ring = [(radius * math.cos(2 * math.pi * i / SEGMENTS), bottom, -radius * math.sin(2 * math.pi * i / SEGMENTS))
            for i in range(SEGMENTS)]
    corners = ring + [(0, top, 0), (0, bottom, 0)]
    triangles = []
    for i in range(SEGMENTS):
        after = (i + 1) % SEGMENTS
        triangles += [i, after, SEGMENTS, after, i, SEGMENTS + 1]
    return corners, triangles


def main(count, folder):
    data = bytearray()
    views = []
    accessors = []

    def accessor(values, kind, component, width, **more):
        packed = struct.pack(f"<{len(values)}{component}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data.extend(packed)
        data.extend(bytes(-len(data) % 4))
        types = {"f": 5126, "I": 5125, "h": 5122}
        accessors.append({"bufferView": len(views) - 1, "componentType": types[component],
                          "count": len(values) // width, "type": kind, **more})
        return len(accessors) - 1

    primitives = []
    for material, shape in enumerate([cone(0.4, 2, 0.45), cone(0, 0.6, 0.12)]):
        corners, triangles = shape
        low = [min(corner[axis] for corner in corners) for axis in range(3)]
        high = [max(corner[axis] for corner in corners) for axis in range(3)]
        flat = [value for corner in corners for value in corner]
        primitives.append({"attributes": {"POSITION": accessor(flat, "VEC3", "f", 3, min=low, max=high)},
                           "indices": accessor(triangles, "SCALAR", "I", 1), "material": material})
    side = math.ceil(math.sqrt(count))
    places, turns, scales = [], [], []
    for i in range(count):
        noise = [(i + 1) * step % 1 for step in (0.7548776662, 0.5698402910, 0.6180339887)]
        places += [i % side + 0.6 * noise[0], 0, i // side + 0.6 * noise[1]]
        angle = math.pi * noise[2]
        turns += [0, round(32767 * math.sin(angle)), 0, round(32767 * math.cos(angle))]
        scales += [0.7 + 0.3 * noise[1], 0.5 + noise[0], 0.7 + 0.3 * noise[2]]
    attributes = {"TRANSLATION": accessor(places, "VEC3", "f", 3),
                  "ROTATION": accessor(turns, "VEC4", "h", 4, normalized=True),
                  "SCALE": accessor(scales, "VEC3", "f", 3)}
    materials = [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0,
                                                         "roughnessFactor": 0.9}}
                 for name, color in (("Leaves", [0.1, 0.35, 0.08, 1]), ("Stem", [0.25, 0.14, 0.06, 1]))]
    scene = {"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_mesh_gpu_instancing"],
             "extensionsRequired": ["EXT_mesh_gpu_instancing"], "scene": 0, "scenes": [{"nodes": [0]}],
             "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}],
             "meshes": [{"primitives": primitives}], "materials": materials, "accessors": accessors,
             "bufferViews": views, "buffers": [{"uri": "instanced.bin", "byteLength": len(data)}]}
    target = pathlib.Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    (target / "instanced.bin").write_bytes(data)
    (target / "instanced.gltf").write_text(json.dumps(scene))


if __name__ == "__main__":
    if len(sys.argv) != 3 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    main(int(sys.argv[1]), sys.argv[2])
