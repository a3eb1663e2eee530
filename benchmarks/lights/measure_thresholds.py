#!/usr/bin/env python3
"""Measures the time of a frame on both sides of each number at which a default changes.

    benchmarks/lights/measure_thresholds.py [--glint PROGRAM] [--only NAME...] [--size WxH] [--spp N] [--rounds N]
                                            [--tracer auto|ray-query|ray-pipeline] [--device NAME] [--json FILE]

Each threshold has a generated scene for the last number below it and one for the first above it, rendered with the
default's settings. Where a number of lights decides, it is searched with `glint compile` and `glint inspect`; where a
number of cases decides about the strategy, with `glint render`. Both sides
are rendered in turn, after one round that does not count. The time is the median over the rounds of the device time of
all passes of a sample, with quartiles. Prints a Markdown table, and writes JSON.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import statistics
import struct
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import measure_emissive  # noqa: E402
import measure_lights  # noqa: E402
from measure_lights import run, spread  # noqa: E402


def edited(path, change):
    """Changes the scene of a file."""
    scene = json.loads(path.read_text(encoding="utf-8"))
    change(scene)
    path.write_text(json.dumps(scene))


def add_points(path, count):
    """Adds point lights to the scene of a file."""

    def change(scene):
        generator = measure_lights.random.Random(2)
        scene["extensionsUsed"].append("KHR_lights_punctual")
        lights = scene.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
        for place, intensity, color in measure_lights.light_field(generator, count):
            lights.append({"type": "point", "intensity": intensity, "color": color})
            scene["nodes"].append({"translation": place,
                                   "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})
            scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)

    edited(path, change)


def lights(path, count):
    measure_lights.write_scene(path, count)


def triangles(path, count):
    measure_emissive.write_scene(path, count)


def triangles_and_points(path, count):
    measure_emissive.write_scene(path, 64)
    add_points(path, count)


def roughness(path, thousandths):
    """The floor as a glossy metal."""
    measure_lights.write_scene(path, 4)

    def change(scene):
        scene["materials"][0]["pbrMetallicRoughness"].update(
            {"metallicFactor": 1, "roughnessFactor": thousandths / 1000})

    edited(path, change)


def vertices(path, count):
    """A hilly strip of so many vertices: two rows, and a triangle for each vertex but two."""
    columns = count // 2
    row = [(20 * i / columns - 10, math.sin(i), -10 + 20 * side) for i in range(columns) for side in (0, 1)]
    order = [corner for i in range(columns - 1)
             for corner in (2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3)]
    data = b"".join(struct.pack("<3f", *place) for place in row) + struct.pack(f"<{len(order)}I", *order)
    path.with_suffix(".bin").write_bytes(data)
    measure_lights.write_scene(path.with_name("floor.gltf"), 4)
    scene = json.loads(path.with_name("floor.gltf").read_text(encoding="utf-8"))
    start = 12 * len(row)
    scene["buffers"] = [{"uri": path.with_suffix(".bin").name, "byteLength": len(data)}]
    scene["bufferViews"] = [{"buffer": 0, "byteLength": start},
                            {"buffer": 0, "byteOffset": start, "byteLength": len(data) - start}]
    scene["accessors"] = [{"bufferView": 0, "componentType": 5126, "count": len(row), "type": "VEC3",
                           "min": [-10, -1, -10], "max": [10, 1, 10]},
                          {"bufferView": 1, "componentType": 5125, "count": len(order), "type": "SCALAR"}]
    scene["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}]
    scene["materials"][0]["doubleSided"] = True
    path.write_text(json.dumps(scene))


def materials(path, count):
    """Squares of so many materials, each with its own set of features."""
    make = pathlib.Path(__file__).resolve().parent.parent / "make_synthetic_scene.py"
    folder = path.with_suffix(".parts")
    run(sys.executable, make, folder, "--materials", count, "--keys", count)
    for file in folder.iterdir():
        file.rename(path if file.suffix == ".gltf" else path.with_name(file.name))


def plain(path, _):
    measure_lights.write_scene(path, 4)


class Threshold:
    """A default, and the scene and settings of a number. `below` and `above` are the numbers on both sides."""

    def __init__(self, default, write, below, above, settings=lambda number: [], size=None, strategy="uber"):
        self.default, self.write, self.sides = default, write, (below, above)
        self.settings, self.size, self.strategy = settings, size, strategy


# By the name for --only. Sides that are None are searched.
THRESHOLDS = {
    "lights": Threshold("`--lights`: all, or samples", lights, None, None),
    "triangles": Threshold("`--lights`: samples of emissive triangles", triangles, 15, 16,
                           lambda number: ["--emissive-lights", "on"]),
    "apart": Threshold("point lights beside emissive triangles: all, or samples", triangles_and_points, 16, 17,
                       lambda number: ["--emissive-lights", "on"]),
    "emissive": Threshold("`--emissive-lights`: on, or off", triangles, 262144, 262146,
                          lambda number: ["--bounces", 2]),
    "roughness": Threshold("`--effects`, `--max-roughness`: reflection rays (thousandths of roughness)", roughness, 300,
                           301, lambda number: ["--effects", "auto"]),
    "mirror": Threshold("`--mirror-roughness`: mirror, or lobe (thousandths)", roughness, 50, 51,
                        lambda number: ["--effects", "auto"]),
    "bounces": Threshold("bounces that are always recorded", plain, 8, 9,
                         lambda number: ["--effects", "auto,indirect-diffuse", "--bounces", number]),
    "indices": Threshold("indices of 16 or 32 bits (vertices)", vertices, 65536, 65538),
    "strategy": Threshold("`--strategy auto` (cases)", materials, None, None,
                          lambda number: ["--effects", "reflection", "--max-roughness", 1, "--merge", "none"],
                          strategy="auto"),
    "merge": Threshold("`--merge auto`: the budget (keys)", materials, 32, 33,
                       lambda number: ["--effects", "reflection", "--max-roughness", 1, "--merge", "auto"],
                       strategy="auto"),
    "bands": Threshold("bands: one, or two, where the GPU is not discrete (rows of 1,024 pixels)", plain, 512, 513,
                       size=lambda number: f"1024x{number}"),
}


class Measurement:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder

    def prepare(self, name, number):
        """The scene and the package of a number."""
        threshold = THRESHOLDS[name]
        path = self.folder / f"{name}-{number}.gltf"
        threshold.write(path, number)
        tracer = "all" if self.options.tracer == "auto" else self.options.tracer
        settings = threshold.settings(number)
        strategy = "all" if threshold.strategy == "auto" else threshold.strategy
        run(self.options.glint, "compile", path, "-o", path.with_suffix(""), "--strategy", strategy, "--tracer", tracer,
            *([] if "--effects" in settings else ["--effects", "shadow"]), *settings)
        inspected = json.loads(run(self.options.glint, "inspect", path.with_suffix(""), "--json"))
        return path, inspected["settings"]["lights"]

    def search(self):
        """The most lights of which all are taken."""
        below, above = 1, 4096
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (middle, above) if self.prepare("lights", middle)[1] == "all" else (below, middle)
        return below, above

    def search_strategy(self):
        """The last number of cases with which another strategy is chosen than with one more."""
        before = None
        for number in range(1, 65):
            path, _ = self.prepare("strategy", number)
            self.time("strategy", number, path)
            if before not in (None, self.strategy):
                return number - 1, number
            before = self.strategy
        sys.exit(f"measure_thresholds: with 1 to 64 cases --strategy auto chooses {before}")

    def time(self, name, number, path):
        threshold = THRESHOLDS[name]
        stats = self.folder / "stats.json"
        bounces = [word for word in threshold.settings(number) if word != "on"]
        run(self.options.glint, "render", path, "-o", self.folder / "picture.exr", "--package", path.with_suffix(""),
            "--strategy", threshold.strategy, "--tracer", self.options.tracer, "--size",
            threshold.size(number) if threshold.size else self.options.size, "--sky", 0, "--spp", self.options.spp,
            "--stats", stats, *(bounces[bounces.index("--bounces"):] if "--bounces" in bounces else []),
            *(["--device", self.options.device] if self.options.device else []))
        told = json.loads(stats.read_text())
        self.device, self.strategy = told["device"], told["strategy"]
        return measure_lights.times_of(stats)[1]

    def measure(self, name):
        threshold = THRESHOLDS[name]
        search = {"lights": self.search, "strategy": self.search_strategy}
        sides = search[name]() if threshold.sides[0] is None else threshold.sides
        with concurrent.futures.ThreadPoolExecutor() as pool:
            prepared = list(pool.map(lambda number: self.prepare(name, number), sides))
        times, strategies = [[], []], ["", ""]
        for turn in range(self.options.rounds + 1):
            for side in (0, 1):
                time = self.time(name, sides[side], prepared[side][0])
                strategies[side] = self.strategy
                if turn > 0:
                    times[side].append(time)
        return {"name": name, "default": threshold.default, "numbers": sides, "milliseconds": times,
                "lights": [taken for _, taken in prepared], "strategies": strategies}


def row_of(result):
    below, above = (statistics.median(times) for times in result["milliseconds"])
    def text_of(number, lights, strategy):
        if result["name"] in ("lights", "triangles", "apart"):
            return f"{number:,} (`{lights}`)"
        return f"{number:,} (`{strategy}`)" if result["name"] in ("strategy", "merge") else f"{number:,}"

    texts = [text_of(*side) for side in zip(result["numbers"], result["lights"], result["strategies"])]
    return (f"| {result['default']} | {texts[0]} | {spread(result['milliseconds'][0])} | {texts[1]} | "
            f"{spread(result['milliseconds'][1])} | {above / below:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--only", nargs="+", choices=THRESHOLDS, default=list(THRESHOLDS))
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--device", default="")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measurement = Measurement(options, pathlib.Path(folder))
        print("| default | below | ms | above | ms | ratio |\n|---|--:|--:|--:|--:|--:|", flush=True)
        results = []
        for name in options.only:
            results.append(measurement.measure(name))
            print(row_of(results[-1]), flush=True)
    if options.json:
        options.json.write_text(json.dumps({"device": measurement.device, "size": options.size, "spp": options.spp,
                                            "results": results}, indent=1) + "\n")


if __name__ == "__main__":
    main()
