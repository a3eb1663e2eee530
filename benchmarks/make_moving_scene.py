#!/usr/bin/env python3
"""Makes a glTF scene of COUNT tetrahedra on a square grid, each of which moves up and down by a metre, in a phase of its own.

    benchmarks/make_moving_scene.py COUNT FOLDER     writes FOLDER/moving.gltf and moving.bin
"""

import json
import math
import pathlib
import struct
import sys

SECONDS = 4
KEYFRAMES = 17


def main(count, folder):
    data = bytearray()
    views = []
    accessors = []

    def accessor(values, kind, component, width, **more):
        packed = struct.pack(f"<{len(values)}{component}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data.extend(packed)
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if component == "f" else 5125,
                          "count": len(values) // width, "type": kind, **more})
        return len(accessors) - 1

    corners = [0, 0.4, 0, -0.3, -0.2, 0.3, 0.3, -0.2, 0.3, 0, -0.2, -0.4]
    positions = accessor(corners, "VEC3", "f", 3, min=[-0.3, -0.2, -0.4], max=[0.3, 0.4, 0.3])
    indices = accessor([0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2], "SCALAR", "I", 1)
    times = [SECONDS * i / (KEYFRAMES - 1) for i in range(KEYFRAMES)]
    clock = accessor(times, "SCALAR", "f", 1, min=[0], max=[SECONDS])
    side = math.ceil(math.sqrt(count))
    nodes, samplers, channels = [], [], []
    for i in range(count):
        x, z = i % side, i // side
        path = []
        for time in times:
            path += [x, math.sin(2 * math.pi * (time / SECONDS + i * 0.618)), z]
        nodes.append({"mesh": 0, "translation": path[:3]})
        samplers.append({"input": clock, "output": accessor(path, "VEC3", "f", 3)})
        channels.append({"sampler": i, "target": {"node": i, "path": "translation"}})
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(count))}], "nodes": nodes,
             "meshes": [{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}],
             "animations": [{"name": "waves", "samplers": samplers, "channels": channels}], "accessors": accessors,
             "bufferViews": views, "buffers": [{"uri": "moving.bin", "byteLength": len(data)}]}
    target = pathlib.Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    (target / "moving.bin").write_bytes(data)
    (target / "moving.gltf").write_text(json.dumps(scene))


if __name__ == "__main__":
    if len(sys.argv) != 3 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    main(int(sys.argv[1]), sys.argv[2])
