#!/usr/bin/env python3
"""Measures the time at equal error of `--lights all` and `--lights K` by the number of lights, on any device.

    benchmarks/measure_lights.py [--glint PROGRAM] [--counts 8 64 512 4096] [--samples 1 4] [--size WxH] [--spp N]
                                 [--rounds N] [--all-rounds N] [--tracer auto|ray-query|ray-pipeline] [--device NAME]
                                 [--json FILE]

The scene is generated: a floor with boxes under a field of point lights, whose total flux does not depend on their
number. The camera's sample positions are those of `--spp N` in every picture, so `all` has no error of its own. Each
round renders every count with every choice once, one after the other, so that what else the machine does slows all
alike. --all-rounds renders `all` only in the first N rounds, because it takes long with 100,000 lights. The error is
the relMse of `glint compare` against `all`, which falls as 1 / samples: it is given for one sample. The time is the median
over the rounds of the device time of the lighting pass, for a sample. `--lights all` has no error after one sample. K
needs error / TARGET samples, and at least one. Prints a Markdown table, and writes JSON.
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import struct
import subprocess
import sys
import tempfile

# The relMse at which times are compared: a relative error of 5 %.
TARGET = 0.05**2


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stderr}")
    return done.stdout


def box(lower, upper):
    """Triangles of a box with normals, as (position, normal) for each corner."""
    corners = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            normal = [0.0, 0.0, 0.0]
            normal[axis] = 1.0 if side else -1.0
            square = []
            for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = [0.0, 0.0, 0.0]
                place[axis] = (lower, upper)[side][axis]
                place[a] = (lower, upper)[x][a]
                place[b] = (lower, upper)[y][b]
                square.append(place)
            order = (0, 1, 2, 0, 2, 3) if side else (0, 2, 1, 0, 3, 2)
            corners += [(square[i], normal) for i in order]
    return corners


def floor_with_boxes(generator):
    """Triangles of a floor of 20 m by 20 m with 25 boxes."""
    corners = box((-10, -0.1, -10), (10, 0, 10))
    for i in range(25):
        x, z = -8 + 4 * (i % 5), -8 + 4 * (i // 5)
        corners += box((x - 0.4, 0, z - 0.4), (x + 0.4, 0.5 + generator.random(), z + 0.4))
    return corners


def light_field(generator, count):
    """Place, intensity and colour of each light: between 0.5 m and 2.5 m above the floor."""
    lights = []
    for _ in range(count):
        intensity = 400.0 / count * 2.0 * generator.random()
        color = [generator.random(), 0.6, generator.random()]
        place = [20 * generator.random() - 10, 0.5 + 2 * generator.random(), 20 * generator.random() - 10]
        lights.append((place, intensity, color))
    return lights


def write_scene(path, count):
    """The floor with boxes, and the lights above it."""
    generator = random.Random(1)
    corners = floor_with_boxes(generator)
    positions = b"".join(struct.pack("<3f", *place) for place, _ in corners)
    normals = b"".join(struct.pack("<3f", *normal) for _, normal in corners)
    path.with_suffix(".bin").write_bytes(positions + normals)
    lights, nodes = [], [{"mesh": 0}]
    for i, (place, intensity, color) in enumerate(light_field(generator, count)):
        lights.append({"type": "point", "intensity": intensity, "color": color})
        nodes.append({"translation": place, "extensions": {"KHR_lights_punctual": {"light": i}}})
    # 12 m above and 14 m before the middle, 40 degrees down.
    nodes.append({"camera": 0, "translation": [0, 12, 14],
                  "rotation": [-math.sin(math.radians(20)), 0, 0, math.cos(math.radians(20))]})
    lower = [min(place[i] for place, _ in corners) for i in range(3)]
    upper = [max(place[i] for place, _ in corners) for i in range(3)]
    accessor = {"componentType": 5126, "count": len(corners), "type": "VEC3"}
    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.6,
                                                "baseColorFactor": [0.7, 0.7, 0.7, 1]}}],
        "accessors": [{"bufferView": 0, "min": lower, "max": upper, **accessor}, {"bufferView": 1, **accessor}],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)},
                        {"buffer": 0, "byteOffset": len(positions), "byteLength": len(normals)}],
        "buffers": [{"uri": path.with_suffix(".bin").name, "byteLength": len(positions + normals)}],
    }
    path.write_text(json.dumps(scene))


def lighting_ms(stats):
    """The device time of the lighting pass of a sample."""
    passes = json.loads(stats.read_text())["passes"]
    return sum(entry["milliseconds"] for entry in passes if entry["name"] == "lighting")


def spread(values):
    low, median, high = statistics.quantiles(values, n=4) if len(values) > 1 else [values[0]] * 3
    return f"{median:.3g} ({low:.3g} to {high:.3g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--counts", type=int, nargs="+", default=[8, 16, 32, 64, 512, 4096])
    parser.add_argument("--samples", nargs="+", default=["1", "4"])
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--all-rounds", type=int, help="at least 1; default: every round")
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--device", default="")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    choices = ["all", *options.samples]
    results = []
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        for count in options.counts:
            write_scene(folder / f"{count}.gltf", count)
            for choice in choices:
                run(options.glint, "compile", folder / f"{count}.gltf", "-o", folder / f"{count}-{choice}", "--strategy",
                    "uber", "--effects", "shadow", "--lights", choice,
                    *(["--tracer", "all"] if options.tracer == "auto" else ["--tracer", options.tracer]))
        times = {}
        for turn in range(options.rounds):
            for count in options.counts:
                for choice in choices:
                    if choice == "all" and options.all_rounds and turn >= options.all_rounds:
                        continue
                    run(options.glint, "render", folder / f"{count}.gltf", "-o", folder / f"{count}-{choice}.exr",
                        "--package", folder / f"{count}-{choice}", "--strategy", "uber", "--tracer", options.tracer,
                        "--size", options.size, "--sky", 0, "--spp", options.spp, "--stats", folder / "stats.json",
                        *(["--device", options.device] if options.device else []))
                    times.setdefault((count, choice), []).append(lighting_ms(folder / "stats.json"))
        device = json.loads((folder / "stats.json").read_text())["device"]
        for count in options.counts:
            for choice in choices:
                report = json.loads(run(options.glint, "compare", folder / f"{count}-{choice}.exr",
                                        folder / f"{count}-all.exr", "--json"))
                ratios = [own / whole for own, whole in zip(times[count, choice], times[count, "all"])]
                results.append({"lights": count, "choice": choice, "milliseconds": times[count, choice],
                                "ratioToAll": ratios, "relMseOfSample": report["relMse"] * options.spp})
    print("| lights | `--lights` | ms a sample | time over that of all | relMse of a sample | ms at relMse "
          f"{TARGET:.2g} |\n|--:|---|--:|--:|--:|--:|")
    for row in results:
        needed = max(row["relMseOfSample"] / TARGET, 1.0)
        print(f"| {row['lights']:,} | {row['choice']} | {spread(row['milliseconds'])} | {spread(row['ratioToAll'])} | "
              f"{row['relMseOfSample']:.3g} | {needed * statistics.median(row['milliseconds']):.3g} |")
    if options.json:
        report = {"device": device, "size": options.size, "spp": options.spp, "targetRelMse": TARGET,
                  "results": results}
        options.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
