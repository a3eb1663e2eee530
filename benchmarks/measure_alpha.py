#!/usr/bin/env python3
"""Measures what alpha costs rays, by the number of candidates that a ray tests.

    benchmarks/measure_alpha.py [--glint FILE] [--layers 0,1,2,4,8,16] [--size WxH] [--rounds N] [--tracer NAME]

A mirror shows a wall behind a stack of layers, each with a texture whose alpha is 0, so that every ray passes all of
them. They have the alpha mode MASK or BLEND, and every ray tests MASK (--opacity tested); beside them stands the same
scene without the layers. All are rendered in turn, in an order that changes from round to round. Prints Markdown: the
device time of the pass that traces, as the ratio to the scene without layers in the same round, and as nanoseconds
for each ray and layer.
"""
import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))
from scene_parts import Buffer, png, write_scene  # noqa: E402


def quad(buffer, material, half, z, facing):
    """Returns a mesh: a square about the axis z, whose front looks along z in the direction `facing`."""
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    if facing < 0:
        corners.reverse()
    positions = [c for x, y in corners for c in (x, y, z)]
    attributes = {
        "POSITION": buffer.add(positions, 3, min=[-half, -half, z], max=[half, half, z]),
        "NORMAL": buffer.add([0.0, 0.0, float(facing)] * 4, 3),
        "TEXCOORD_0": buffer.add([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], 2)}
    return {"primitives": [{"attributes": attributes, "indices": buffer.add_indices([0, 1, 2, 0, 2, 3]),
                            "material": material}]}


def make_scene(path, mode, layers):
    """Writes a mirror before the camera, which shows `layers` squares and a wall behind the camera."""
    buffer = Buffer()
    materials = [
        {"name": "mirror", "pbrMetallicRoughness": {"roughnessFactor": 0.0}},
        {"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0}},
        {"name": "layer", "alphaMode": mode, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    meshes = [quad(buffer, 0, 2.0, -1.0, 1), quad(buffer, 1, 100.0, 2.0 + layers, -1)]
    meshes += [quad(buffer, 2, 100.0, 1.0 + layer, -1) for layer in range(layers)]
    nodes = [{"mesh": mesh} for mesh in range(len(meshes))] + [{"camera": 0}]
    write_scene(path, [], nodes, buffer, meshes=meshes, materials=materials, textures=[{"source": 0}],
                images=[{"uri": png(4, 4, lambda x, y: (255, 255, 255, 0))}],
                cameras=[{"type": "perspective", "perspective": {"yfov": 1.5, "aspectRatio": 16 / 9, "znear": 0.01}}])


def trace_time(glint, scene, folder, arguments):
    """Renders once; returns the milliseconds and the rays of the pass that traces."""
    stats = folder / "stats.json"
    subprocess.run([glint, "render", scene, "-o", folder / "picture.png", "--size", arguments.size, "--strategy",
                    "visibility", "--tracer", arguments.tracer, "--effects", "reflection", "--no-sun",
                    "--opacity", "tested", "--stats", stats], check=True, capture_output=True)
    report = json.loads(stats.read_text())
    passes = [entry["milliseconds"] for entry in report["passes"] if entry["name"] == "trace"]
    return sum(passes), report["counters"]["rays"]


def spread(values, digits):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="default build/release/bin/glint")
    parser.add_argument("--layers", default="1,2,4,8,16", help="default 1,2,4,8,16")
    parser.add_argument("--size", default="640x360", help="default 640x360")
    parser.add_argument("--rounds", type=int, default=7, help="default 7")
    parser.add_argument("--tracer", default="auto", help="auto, ray-query or ray-pipeline; default auto")
    arguments = parser.parse_args()
    counts = [int(count) for count in arguments.layers.split(",")]
    chance = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="glint-alpha-") as name:
        folder = pathlib.Path(name)
        cases = [("MASK", 0)] + [(mode, count) for mode in ("MASK", "BLEND") for count in counts]
        for mode, count in cases:
            make_scene(folder / f"{mode}{count}.gltf", mode, count)
        times = {case: [] for case in cases}
        rays = 0
        for _ in range(arguments.rounds):
            for case in chance.sample(cases, len(cases)):
                milliseconds, rays = trace_time(arguments.glint, folder / f"{case[0]}{case[1]}.gltf", folder, arguments)
                times[case].append(milliseconds)
    bare = times[("MASK", 0)]
    print(f"{rays:,} rays, {arguments.rounds} rounds; without layers {spread(bare, 2)} ms\n")
    print("| layers | MASK, ratio | BLEND, ratio | MASK, ns a ray and layer | BLEND, ns a ray and layer |")
    print("|---|---|---|---|---|")
    for count in counts:
        cells = [[now / then for now, then in zip(times[(mode, count)], bare)] for mode in ("MASK", "BLEND")]
        each = [[(now - then) * 1e6 / (rays * count) for now, then in zip(times[(mode, count)], bare)]
                for mode in ("MASK", "BLEND")]
        print(f"| {count} | " + " | ".join([spread(cell, 2) for cell in cells] + [spread(cell, 3) for cell in each]) +
              " |")


if __name__ == "__main__":
    main()
