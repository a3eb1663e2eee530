#!/usr/bin/env python3
"""Measures the sky as a light against rays that find it by chance, for several skies, on any device.

    benchmarks/measure_sky.py [--glint PROGRAM] [--skies gradient uniform window sun] [--size WxH] [--spp N]
                              [--bounces N|unlimited] [--rounds N] [--reference-spp N]
                              [--tracer auto|ray-query|ray-pipeline] [--device NAME] [--json FILE]

The scene is the floor with boxes of measure_lights.py. It is lit by the default gradient, or by a map of 128 x 64:
uniform, with a soft bright window, or with a small sun. `off` and `on` are values of --sky-light. With unlimited
bounces both have the same mean. The error is the relMse against --reference-spp samples of `on`, which falls as 1 /
samples; it is given for one sample. The time is the median over the rounds of the device time of all passes of a
sample. `time at equal error` is that of error / TARGET samples. Prints each row when it is known.
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

from measure_lights import TARGET, floor_with_boxes, run, spread

WIDTH, HEIGHT = 128, 64


def radiance_of(sky, x, y):
    """The radiance of a texel: dim and bluish but for the uniform map."""
    if sky == "uniform":
        return 1.0, 1.0, 1.0
    distance = math.hypot(x + 0.5 - 90, y + 0.5 - 16)
    if sky == "window":
        bright = 12.0 * math.exp(-((distance / 8.0) ** 2))
        return 0.2 + bright, 0.25 + bright, 0.3 + 0.9 * bright
    return (1500.0, 1400.0, 1200.0) if distance < 1.0 else (0.2, 0.25, 0.3)


def write_map(path, sky):
    """A Radiance picture without compression."""
    texels = bytearray()
    for y in range(HEIGHT):
        for x in range(WIDTH):
            color = radiance_of(sky, x, y)
            mantissa, exponent = math.frexp(max(color))
            scale = 256.0 * mantissa / max(color)
            texels += bytes([*(min(int(value * scale), 255) for value in color), exponent + 128])
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode()
    path.write_bytes(header + bytes(texels))


def write_scene(path):
    """The floor and boxes of measure_lights.py, seen from above."""
    corners = floor_with_boxes(random.Random(1))
    data, views, accessors = b"", [], []
    for part in (0, 1):
        values = [corner[part] for corner in corners]
        piece = b"".join(struct.pack("<3f", *value) for value in values)
        accessor = {"bufferView": part, "componentType": 5126, "count": len(values), "type": "VEC3"}
        if part == 0:
            accessor["min"] = [min(value[i] for value in values) for i in range(3)]
            accessor["max"] = [max(value[i] for value in values) for i in range(3)]
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(piece)})
        accessors.append(accessor)
        data += piece
    path.with_suffix(".bin").write_bytes(data)
    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_specular"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        # 12 m above and 14 m before the middle, 40 degrees down.
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 12, 14],
                                "rotation": [-math.sin(math.radians(20)), 0, 0, math.cos(math.radians(20))]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1,
                                                "baseColorFactor": [0.5, 0.5, 0.5, 1]},
                       "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": path.with_suffix(".bin").name, "byteLength": len(data)}],
    }
    path.write_text(json.dumps(scene))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--skies", nargs="+", default=["gradient", "uniform", "window", "sun"])
    parser.add_argument("--size", default="64x36")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--reference-spp", type=int, default=512)
    parser.add_argument("--bounces", default="unlimited")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--device", default="")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    tracers = ["--tracer", "all" if options.tracer == "auto" else options.tracer]
    device = ["--device", options.device] if options.device else []
    choices = ["off", "on"]

    def environment_of(folder, sky):
        return [] if sky == "gradient" else ["--environment", folder / f"{sky}.hdr"]

    def render(folder, sky, choice, output, spp, seed=0):
        light = ["--sky", 1] if sky == "gradient" else environment_of(folder, sky)
        package = folder / f"{'gradient' if sky == 'gradient' else 'map'}-{choice}"
        run(options.glint, "render", folder / "scene.gltf", "-o", folder / output, "--package", package, "--strategy",
            "uber", "--tracer", options.tracer, "--size", options.size, *light, "--no-sun", "--spp", spp, "--seed",
            seed, "--bounces", options.bounces, "--stats", folder / "stats.json", *device)
        return json.loads((folder / "stats.json").read_text())

    results = []
    print("| sky | `--sky-light` | ms a sample | relMse of a sample | ms at relMse "
          f"{TARGET:.2g} |\n|---|---|--:|--:|--:|", flush=True)
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        write_scene(folder / "scene.gltf")
        for kind in ("gradient", "map"):
            for choice in choices:
                run(options.glint, "compile", folder / "scene.gltf", "-o", folder / f"{kind}-{choice}", "--strategy",
                    "uber", "--effects", "shadow,indirect-diffuse", "--bounces", options.bounces, f"--sky-light={choice}",
                    *(["--environment-map"] if kind == "map" else []), *tracers)
        for sky in options.skies:
            if sky != "gradient":
                write_map(folder / f"{sky}.hdr", sky)
            render(folder, sky, "on", "reference.exr", options.reference_spp, 1000)
            times = {choice: [] for choice in choices}
            errors = {choice: [] for choice in choices}
            for seed in range(options.rounds):
                for choice in choices:
                    stats = render(folder, sky, choice, f"{choice}.exr", options.spp, seed)
                    times[choice].append(sum(entry["milliseconds"] for entry in stats["passes"]))
                    report = json.loads(run(options.glint, "compare", folder / f"{choice}.exr",
                                            folder / "reference.exr", "--json"))
                    errors[choice].append(report["relMse"] * options.spp)
            for choice in choices:
                error = statistics.mean(errors[choice])
                results.append({"sky": sky, "choice": choice, "milliseconds": times[choice], "relMseOfSample": error})
                needed = max(error / TARGET, 1.0)
                print(f"| {sky} | {choice} | {spread(times[choice])} | {error:.3g} | "
                      f"{needed * statistics.median(times[choice]):.3g} |", flush=True)
    if options.json:
        report = {"size": options.size, "spp": options.spp, "bounces": options.bounces, "targetRelMse": TARGET,
                  "results": results, "command": sys.argv}
        options.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
