#!/usr/bin/env python3
"""Measures time and error of `--lights` by the number of lights, on any device.

    benchmarks/measure_lights.py [--glint PROGRAM] [--before PROGRAM] [--scene FILE] [--counts 8 64 512 4096]
                                 [--samples 1 4 auto] [--effects LIST] [--size WxH] [--spp N] [--reference-spp N]
                                 [--rounds N] [--all-rounds N] [--seconds N] [--tracer auto|ray-query|ray-pipeline]
                                 [--device NAME] [--json FILE]

The scene is generated: a floor with boxes under a field of point lights, whose total flux does not depend on their
number. With --scene it is that glTF file with such a field before it, on the side of +z. The camera's sample positions
are those of `--spp N` in every picture, so `all` has no error of its own. Each round renders every count with every
choice once, one after the other, so that what else the machine does slows all alike; after --seconds no round begins.
--all-rounds renders `all` only in the first N rounds, because it takes long with 100,000 lights. --before measures
another program, too: its choices have the word "before". The error is the relMse of `glint compare` against `all`,
which falls as 1 / samples: it is given for one sample. With --reference-spp, JSON also has the error against so many
samples of 64 lights, or of all up to 64: that of a pixel's edges and textures is part of it. The time is the median
over the rounds of the device time of first hits, for a sample. JSON also has that of all passes. `--lights all`
has no error after one sample. K needs error / TARGET samples, and at least one. Prints a Markdown table, and writes
JSON.
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import statistics
import struct
import subprocess
import sys
import tempfile
import time

# The relMse at which times are compared: a relative error of 5 %.
TARGET = 0.05**2
MOST_SAMPLES = 64  # of --lights


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


def world_bounds(scene):
    """The box of all meshes. Rotations of nodes are left out, so it is rough."""
    lower, upper = [math.inf] * 3, [-math.inf] * 3

    def visit(index, place, scale):
        node = scene["nodes"][index]
        moved = node.get("matrix", [0] * 12 + node.get("translation", [0, 0, 0]))[12:15]
        place = [place[i] + scale[i] * moved[i] for i in range(3)]
        scale = [scale[i] * node.get("scale", [1, 1, 1])[i] for i in range(3)]
        for primitive in scene["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            box_of = scene["accessors"][primitive["attributes"]["POSITION"]]
            for i in range(3):
                for corner in (box_of["min"][i], box_of["max"][i]):
                    lower[i] = min(lower[i], place[i] + scale[i] * corner)
                    upper[i] = max(upper[i], place[i] + scale[i] * corner)
        for child in node.get("children", []):
            visit(child, place, scale)

    for root in scene["scenes"][scene.get("scene", 0)]["nodes"]:
        visit(root, [0, 0, 0], [1, 1, 1])
    return lower, upper


def add_lights(source, path, count):
    """Writes the scene with a field of lights before it. Its files are found through links beside the copy."""
    scene = json.loads(source.read_text(encoding="utf-8"))
    for file in source.parent.iterdir():
        link = path.parent / file.name
        if not link.exists():
            link.symlink_to(file.resolve())
    lower, upper = world_bounds(scene)
    size = math.dist(lower, upper)
    generator = random.Random(1)
    field = scene.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
    for _ in range(count):
        color = [generator.random(), 0.6, generator.random()]
        field.append({"type": "point", "intensity": size**2 / count * 2.0 * generator.random(), "color": color})
        place = [lower[i] + (upper[i] - lower[i]) * generator.random() for i in (0, 1)]
        place.append(upper[2] + size * (0.1 + 0.3 * generator.random()))
        scene["nodes"].append({"translation": place, "extensions": {"KHR_lights_punctual": {"light": len(field) - 1}}})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)
    used = scene.setdefault("extensionsUsed", [])
    if "KHR_lights_punctual" not in used:
        used.append("KHR_lights_punctual")
    path.write_text(json.dumps(scene))


def times_of(stats):
    """The device time of the first hits of a sample, and that of all passes."""
    passes = json.loads(stats.read_text())["passes"]
    return (sum(entry["milliseconds"] for entry in passes if entry["name"].startswith("first ")),
            sum(entry["milliseconds"] for entry in passes))


def spread(values):
    low, median, high = statistics.quantiles(values, n=4) if len(values) > 1 else [values[0]] * 3
    return f"{median:.3g} ({low:.3g} to {high:.3g})"


class Measurement:
    """Scenes, packages and pictures in a folder, and the times of the pictures."""

    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        self.times = {}
        self.tracer = ["--tracer", options.tracer]

    def choices(self, count):
        """The choices of --lights for so many lights, each with its program. No number is above that of the lights."""
        result = [("all", self.options.glint)]
        for choice in self.options.samples:
            if choice.isdigit() and int(choice) > count:
                continue
            result.append((choice, self.options.glint))
            if self.options.before:
                result.append((f"{choice} before", self.options.before))
        return result

    def compile(self):
        for count in self.options.counts:
            path = self.folder / f"{count}.gltf"
            if self.options.scene:
                add_lights(self.options.scene, path, count)
            else:
                write_scene(path, count)
        tracer = ["--tracer", "all"] if self.options.tracer == "auto" else self.tracer
        packages = {(count, choice): program for count in self.options.counts
                    for choice, program in self.choices(count)}
        if self.options.reference_spp:
            packages |= {(count, self.reference_choice(count)): self.options.glint for count in self.options.counts}
        with concurrent.futures.ThreadPoolExecutor(max(1, os.cpu_count() // 2)) as pool:
            jobs = [pool.submit(run, program, "compile", self.folder / f"{count}.gltf", "-o",
                                self.package(count, choice), "--strategy", "uber", "--effects", self.options.effects,
                                "--lights", choice.split()[0], *tracer)
                    for (count, choice), program in packages.items()]
            for job in jobs:
                job.result()

    @staticmethod
    def reference_choice(count):
        return "all" if count <= MOST_SAMPLES else str(MOST_SAMPLES)

    def package(self, count, choice):
        return self.folder / f"{count}-{choice.replace(' ', '-')}"

    def picture(self, count, choice):
        return self.package(count, choice).with_suffix(".exr")

    def render(self, count, choice, program, spp, picture):
        stats = self.folder / "stats.json"
        run(program, "render", self.folder / f"{count}.gltf", "-o", picture, "--package", self.package(count, choice),
            "--strategy", "uber", *self.tracer, "--size", self.options.size, "--sky", 0, "--spp", spp, "--stats", stats,
            *(["--device", self.options.device] if self.options.device else []))
        return stats

    def rounds(self):
        begin = time.monotonic()
        for turn in range(self.options.rounds):
            if turn > 0 and time.monotonic() - begin > self.options.seconds:
                break
            for count in self.options.counts:
                for choice, program in self.choices(count):
                    if choice == "all" and self.options.all_rounds and turn >= self.options.all_rounds:
                        continue
                    stats = self.render(count, choice, program, self.options.spp, self.picture(count, choice))
                    self.times.setdefault((count, choice), []).append(times_of(stats))
                    self.device = json.loads(stats.read_text())["device"]

    def error(self, picture, reference):
        report = json.loads(run(self.options.glint, "compare", picture, reference, "--json"))
        return report["relMse"] * self.options.spp

    def results(self):
        for count in self.options.counts:
            reference = None
            if self.options.reference_spp:
                reference = self.folder / f"{count}-reference.exr"
                self.render(count, self.reference_choice(count), self.options.glint, self.options.reference_spp,
                            reference)
            for choice, _ in self.choices(count):
                first, frames = zip(*self.times[count, choice])
                ratios = [own / whole for own, (whole, _) in zip(first, self.times[count, "all"])]
                inspected = json.loads(run(self.options.glint, "inspect", self.package(count, choice), "--json"))
                row = {"lights": count, "choice": choice, "taken": inspected["settings"]["lights"],
                       "milliseconds": first, "frameMilliseconds": frames, "ratioToAll": ratios,
                       "relMseOfSample": self.error(self.picture(count, choice), self.picture(count, "all"))}
                if reference:
                    row["errorOfSample"] = self.error(self.picture(count, choice), reference)
                yield row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--before", help="another program, of an older Glint")
    parser.add_argument("--scene", type=pathlib.Path)
    parser.add_argument("--counts", type=int, nargs="+", default=[8, 16, 32, 64, 512, 4096])
    parser.add_argument("--samples", nargs="+", default=["1", "4"])
    parser.add_argument("--effects", default="shadow")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--reference-spp", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--all-rounds", type=int, help="at least 1; default: every round")
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--device", default="")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as text:
        measurement = Measurement(options, pathlib.Path(text))
        measurement.compile()
        measurement.rounds()
        results = list(measurement.results())
    print("| lights | `--lights` | ms a sample | time over that of all | relMse of a sample | ms at relMse "
          f"{TARGET:.2g} |\n|--:|---|--:|--:|--:|--:|")
    for row in results:
        needed = max(row["relMseOfSample"] / TARGET, 1.0)
        print(f"| {row['lights']:,} | {row['choice']} | {spread(row['milliseconds'])} | {spread(row['ratioToAll'])} | "
              f"{row['relMseOfSample']:.3g} | {needed * statistics.median(row['milliseconds']):.3g} |")
    if options.json:
        report = {"device": measurement.device, "scene": options.scene.name if options.scene else "floor with boxes",
                  "effects": options.effects, "size": options.size, "spp": options.spp,
                  "referenceSpp": options.reference_spp, "targetRelMse": TARGET, "results": results}
        options.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
