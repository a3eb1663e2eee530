#!/usr/bin/env python3
"""Makes the film strip of docs/live.md: an animation that plays while parts of its scene are edited.

    benchmarks/view/edit_strip.py docs/images/live_edits.png [--glint FILE] [--size WxH] [--spp N]

Writes a scene of a pendulum and some objects, another one of a lamp on a stand, and a file of edits into a
folder of its own, plays the edits with `glint render --edits` and joins every second picture.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "examples"), str(ROOT / "scripts")]

from scene_parts import Buffer, sphere, write_scene  # noqa: E402
from views import sheet  # noqa: E402

FRAMES = 16
FPS = 8

EDITS = [
    {"frame": 4, "edit": "duplicate", "node": "Pendulum", "name": "Second", "translation": [1.3, 2.6, -0.6]},
    {"frame": 6, "edit": "material", "node": "Globe", "material": "Mirror"},
    {"frame": 8, "edit": "hide", "node": "Block"},
    {"frame": 8, "edit": "move", "node": "Globe", "translation": [0.2, 0.4, 1.0]},
    {"frame": 10, "edit": "add", "file": "lamp.gltf", "translation": [-1.4, 0, 0.6]},
    {"frame": 12, "edit": "delete", "node": "Pendulum"},
    {"frame": 14, "edit": "light", "node": "Sun", "color": [1, 0.45, 0.2], "intensity": 1.5},
]


def ball(buffer):
    positions, normals, _, _, indices = sphere(40, 20)
    return {"attributes": {"POSITION": buffer.add(positions, 3, min=[-1, -1, -1], max=[1, 1, 1]),
                           "NORMAL": buffer.add(normals, 3)}, "indices": buffer.add_indices(indices)}


def box(buffer):
    positions, normals, indices = [], [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            first = len(positions) // 3
            for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = side, u * side, v
                positions += corner
                normal = [0.0, 0.0, 0.0]
                normal[axis] = side
                normals += normal
            indices += (first, first + 1, first + 2, first, first + 2, first + 3)
    return {"attributes": {"POSITION": buffer.add(positions, 3, min=[-1, -1, -1], max=[1, 1, 1]),
                           "NORMAL": buffer.add(normals, 3)}, "indices": buffer.add_indices(indices)}


def material(name, color, metallic, roughness, **more):
    return {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic,
                                                   "roughnessFactor": roughness}, **more}


def light(kind, **more):
    return {"KHR_lights_punctual": {"lights": [{"type": kind, **more}]}}


def write_room(path):
    buffer = Buffer()
    shapes = [ball(buffer), box(buffer)]
    times = [i / FPS for i in range(FRAMES + 1)]
    turns = []
    for time in times:
        angle = 0.7 * math.cos(math.pi * time)
        turns += (0.0, 0.0, math.sin(0.5 * angle), math.cos(0.5 * angle))
    sampler = {"input": buffer.add(times, 1, min=[times[0]], max=[times[-1]]), "output": buffer.add(turns, 4)}
    materials = [material("Ground", (0.45, 0.5, 0.55), 0, 0.25), material("Steel", (0.8, 0.8, 0.85), 1, 0.3),
                 material("Red", (0.8, 0.1, 0.06), 0, 0.35), material("Green", (0.15, 0.5, 0.2), 0, 0.6),
                 material("Mirror", (0.95, 0.93, 0.9), 1, 0.02)]
    meshes = [{"primitives": [{**shapes[shape], "material": number}]}
              for shape, number in ((1, 0), (1, 1), (0, 2), (0, 3), (1, 3))]
    sun = [math.sin(-0.45), 0, 0, math.cos(-0.45)]
    nodes = [{"name": "Ground", "mesh": 0, "translation": [0, -0.1, 0], "scale": [4, 0.1, 4]},
             {"name": "Pendulum", "translation": [-0.3, 2.6, -0.6], "children": [2, 3]},
             {"name": "Rod", "mesh": 1, "translation": [0, -0.8, 0], "scale": [0.03, 0.8, 0.03]},
             {"name": "Bob", "mesh": 2, "translation": [0, -1.8, 0], "scale": [0.32, 0.32, 0.32]},
             {"name": "Globe", "mesh": 3, "translation": [-1.5, 0.4, 0.5], "scale": [0.4, 0.4, 0.4]},
             {"name": "Block", "mesh": 4, "translation": [1.3, 0.35, 0.9], "scale": [0.35, 0.35, 0.35]},
             {"name": "Sun", "rotation": sun, "extensions": {"KHR_lights_punctual": {"light": 0}}}]
    write_scene(path, ["KHR_lights_punctual"], nodes, buffer, materials=materials, meshes=meshes,
                extensions=light("directional", intensity=2.5),
                animations=[{"name": "Swing", "samplers": [sampler],
                             "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}])
    scene = json.loads(path.read_text(encoding="utf-8"))
    scene["scenes"][0]["nodes"] = [0, 1, 4, 5, 6]
    path.write_text(json.dumps(scene), encoding="utf-8")


def write_lamp(path):
    buffer = Buffer()
    shapes = [box(buffer), ball(buffer)]
    materials = [material("Wood", (0.35, 0.2, 0.1), 0, 0.5),
                 material("Shade", (0.9, 0.8, 0.6), 0, 0.8, emissiveFactor=[1.0, 0.8, 0.5])]
    meshes = [{"primitives": [{**shape, "material": number}]} for number, shape in enumerate(shapes)]
    nodes = [{"name": "Stand", "mesh": 0, "translation": [0, 0.5, 0], "scale": [0.06, 0.5, 0.06]},
             {"name": "Shade", "mesh": 1, "translation": [0, 1.2, 0], "scale": [0.25, 0.25, 0.25]},
             {"name": "Bulb", "translation": [0.4, 1.3, 0.5],
              "extensions": {"KHR_lights_punctual": {"light": 0}}}]
    write_scene(path, ["KHR_lights_punctual"], nodes, buffer, materials=materials, meshes=meshes,
                extensions=light("point", color=[1, 0.75, 0.45], intensity=4))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint")
    parser.add_argument("--size", default="200x150")
    parser.add_argument("--spp", default="64")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_room(folder / "room.gltf")
        write_lamp(folder / "lamp.gltf")
        (folder / "edits.json").write_text(json.dumps({"edits": EDITS}), encoding="utf-8")
        subprocess.run([options.glint, "render", folder / "room.gltf", "-o", folder / "out.png", "--edits",
                        folder / "edits.json", "--frames", f"0:{FRAMES - 1}", "--fps", str(FPS), "--size", options.size,
                        "--spp", options.spp, "--camera", "0.3,2.2,6.5/0,1,0/32", "--sky", "0.6"], check=True)
        sheet(options.output, [folder / f"out.{frame:04}.png" for frame in range(1, FRAMES, 2)], 4)


if __name__ == "__main__":
    main()
