#!/usr/bin/env python3
"""Measures emissive triangles as lights against finding them by chance, by their number, on any device.

    benchmarks/measure_emissive.py [--glint PROGRAM] [--counts 8 64 512 4096] [--samples all 1 8] [--size WxH] [--spp N]
                                   [--bounces N] [--rounds N] [--reference-spp N] [--build 100000]
                                   [--tracer auto|ray-query|ray-pipeline] [--device NAME] [--json FILE]

The scene is that of measure_lights.py with lamps of two triangles in place of points: each shines down, and the flux of
all does not depend on their number. `chance` has --no-emissive-lights, and one bounce more, so that the mean is the
same. The others have --emissive-lights and --lights K. The error is the relMse against --reference-spp samples of
--lights 8, which falls as 1 / samples; it is given for one sample. The time is the median over the rounds of the device
time of all passes of a sample. `time at equal error` is that of error / TARGET samples. --build renders one sample with so
many triangles and prints the memory of the lights and the time of the whole command. Prints each row when it is known.
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import struct
import sys
import tempfile
import time

from measure_lights import TARGET, floor_with_boxes, run, spread


def lamp(place, side):
    """Corners of a square that faces down, as measure_lights.box() gives them."""
    x, y, z = place
    half = side / 2
    square = [[x - half, y, z - half], [x + half, y, z - half], [x + half, y, z + half], [x - half, y, z + half]]
    return [(square[i], [0.0, -1.0, 0.0]) for i in (0, 1, 2, 0, 2, 3)]


def write_scene(path, triangles):
    """The floor of measure_lights.py, and lamps between 0.5 m and 2.5 m above it."""
    generator = random.Random(1)
    matte = floor_with_boxes(generator)
    lamps = []
    count = max(triangles // 2, 1)
    side = min(0.5, 8.0 / math.sqrt(count) / 4.0)
    for _ in range(count):
        place = (20 * generator.random() - 10, 0.5 + 2 * generator.random(), 20 * generator.random() - 10)
        lamps += lamp(place, side)
    data, views, accessors, primitives = b"", [], [], []
    for number, corners in enumerate((matte, lamps)):
        for part in (0, 1):
            values = [corner[part] for corner in corners]
            piece = b"".join(struct.pack("<3f", *value) for value in values)
            accessor = {"bufferView": len(views), "componentType": 5126, "count": len(values), "type": "VEC3"}
            if part == 0:
                accessor["min"] = [min(value[i] for value in values) for i in range(3)]
                accessor["max"] = [max(value[i] for value in values) for i in range(3)]
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(piece)})
            accessors.append(accessor)
            data += piece
        primitives.append({"attributes": {"POSITION": 2 * number, "NORMAL": 2 * number + 1}, "material": number})
    path.with_suffix(".bin").write_bytes(data)
    base = {"metallicFactor": 0, "roughnessFactor": 1}
    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        # 12 m above and 14 m before the middle, 40 degrees down.
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 12, 14],
                                "rotation": [-math.sin(math.radians(20)), 0, 0, math.cos(math.radians(20))]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": primitives}],
        "materials": [
            {"pbrMetallicRoughness": {**base, "baseColorFactor": [0.7, 0.7, 0.7, 1]},
             "extensions": {"KHR_materials_specular": {"specularFactor": 0}}},
            {"pbrMetallicRoughness": {**base, "baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 0.9, 0.7],
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200.0 / (count * side * side)},
                            "KHR_materials_specular": {"specularFactor": 0}}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": path.with_suffix(".bin").name, "byteLength": len(data)}],
    }
    path.write_text(json.dumps(scene))


def settings_of(choice, bounces):
    """What the package of a choice is compiled with."""
    if choice == "chance":
        return ["--no-emissive-lights", "--bounces", bounces + 1]
    return ["--emissive-lights", "--lights", choice, "--bounces", bounces]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--counts", type=int, nargs="+", default=[8, 64, 512, 4096])
    parser.add_argument("--samples", nargs="+", default=["all", "1", "8"])
    parser.add_argument("--size", default="96x54")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--reference-spp", type=int, default=256)
    parser.add_argument("--bounces", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--build", type=int, default=100000)
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--device", default="")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    tracers = ["--tracer", "all" if options.tracer == "auto" else options.tracer]
    device = ["--device", options.device] if options.device else []

    def compile_package(folder, count, choice):
        run(options.glint, "compile", folder / f"{count}.gltf", "-o", folder / f"{count}-{choice}", "--strategy", "uber",
            "--effects", "shadow,indirect-diffuse", *settings_of(choice, options.bounces), *tracers)

    def render(folder, count, choice, output, spp):
        run(options.glint, "render", folder / f"{count}.gltf", "-o", folder / output, "--package",
            folder / f"{count}-{choice}", "--strategy", "uber", "--tracer", options.tracer, "--size", options.size,
            "--sky", 0, "--no-sun", "--spp", spp, "--bounces",
            options.bounces + (1 if choice == "chance" else 0), "--stats", folder / "stats.json", *device)
        return json.loads((folder / "stats.json").read_text())

    results, build = [], None
    print("| triangles | lights | ms a sample | relMse of a sample | ms at relMse "
          f"{TARGET:.2g} |\n|--:|---|--:|--:|--:|", flush=True)
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        for count in options.counts:
            write_scene(folder / f"{count}.gltf", count)
            choices = ["chance", *options.samples]
            for choice in choices + (["8"] if "8" not in choices else []):
                compile_package(folder, count, choice)
            render(folder, count, "8", "reference.exr", options.reference_spp)
            times = {choice: [] for choice in choices}
            for _ in range(options.rounds):
                for choice in choices:
                    stats = render(folder, count, choice, f"{choice}.exr", options.spp)
                    times[choice].append(sum(entry["milliseconds"] for entry in stats["passes"]))
            for choice in choices:
                report = json.loads(run(options.glint, "compare", folder / f"{choice}.exr", folder / "reference.exr",
                                        "--json"))
                row = {"triangles": count, "choice": choice, "milliseconds": times[choice],
                       "relMseOfSample": report["relMse"] * options.spp}
                results.append(row)
                needed = max(row["relMseOfSample"] / TARGET, 1.0)
                print(f"| {count:,} | {choice} | {spread(times[choice])} | {row['relMseOfSample']:.3g} | "
                      f"{needed * statistics.median(times[choice]):.3g} |", flush=True)
        if options.build:
            write_scene(folder / f"{options.build}.gltf", options.build)
            compile_package(folder, options.build, "8")
            begin = time.monotonic()
            stats = render(folder, options.build, "8", "build.exr", 1)
            build = {"triangles": options.build, "seconds": time.monotonic() - begin,
                     "memory": {entry["name"]: entry["bytes"] for entry in stats.get("memory", {}).get("scene", [])
                                if entry["name"] in ("light nodes", "emissive triangles")}}
            print(f"\n{options.build:,} triangles: {build['seconds']:.2f} s for the whole command, {build['memory']}",
                  flush=True)
    if options.json:
        report = {"size": options.size, "spp": options.spp, "bounces": options.bounces, "targetRelMse": TARGET,
                  "results": results, "build": build, "command": sys.argv}
        options.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
