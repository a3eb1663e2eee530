#!/usr/bin/env python3
"""Measures the error of the light of a light with a size, by the roughness of the surface.

    benchmarks/lights/measure_sized_lights.py [--bin DIR] [--roughness 0.05,0.1,0.2,0.4] [--spp N] [--shadow-spp 1,16]
                                              [--sized-lights off,on] [--truth N] [--size WxH]
                                              [--lamps N] [--lights all|K] [--rounds N]

A metal floor is lit by a spherical lamp of radius 0.25 m alone, or by --lamps N of them above it. Their radius is then
0.25 m over the cube root of N, and together they are as bright. The truth is that of glint_oracle, which also lets the
rays of lobes find the lamps. Prints Markdown: the RMSE of glint render with light samples alone and with rays of lobes
(--sized-lights), and what the RMSE of the oracle would be with the same number of samples. With --rounds it prints the
device time of first hits instead, in ms a sample: the median of so many rounds, and the least. DIR holds both
programs (build/release/bin).
"""
import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "examples")]
from measure_shadows import camera, point_lights, quad  # noqa: E402
from scene_parts import Buffer, write_scene  # noqa: E402

RADIUS = 0.25
CANDELA = 4


def lamps_of(count):
    """Places and intensities of lamps: one above the middle, or many above all of the floor that the camera sees."""
    if count == 1:
        return [([0, 0.9, -1.2], CANDELA)]
    generator = random.Random(1)
    return [([4 * generator.random() - 2, 0.4 + 1.2 * generator.random(), 3.5 * generator.random() - 3],
             CANDELA / count) for _ in range(count)]


def write_floor(path, roughness, count):
    buffer = Buffer()
    material = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.9, 0.9, 1], "metallicFactor": 1,
                                         "roughnessFactor": roughness}}
    view, cameras = camera(0.5, [0, 1.2, 2.2], 0.5)
    lamps, lights = point_lights(lamps_of(count))
    meshes = [quad(buffer, 0, [-4, 0, 4], [8, 0, 0], [0, 0, -8])]
    write_scene(path, ["KHR_lights_punctual"], [{"mesh": 0}, view] + lamps, buffer, meshes=meshes,
                materials=[material], cameras=cameras, extensions=lights)


class Floor:
    """The scene of one roughness, in a folder of its own."""

    def __init__(self, arguments, folder, roughness):
        self.arguments, self.folder = arguments, folder
        self.scene, self.picture = folder / "floor.gltf", folder / "floor.exr"
        radius = f"{RADIUS / arguments.lamps ** (1 / 3):.4g}"
        self.options = ["--size", arguments.size, "--light-radius", radius]
        write_floor(self.scene, float(roughness), arguments.lamps)

    def render(self, sized, points):
        """Returns the device time of first hits, ms a sample."""
        stats = self.folder / "stats.json"
        subprocess.run([self.arguments.bin / "glint", "render", self.scene, *self.options, "--sky", "0", "--spp",
                        str(self.arguments.spp), "--shadow-spp", points, "--strategy", "uber", "--merge", "all",
                        "--effects", "shadow,reflection", "--max-roughness", "1", f"--sized-lights={sized}", "--lights",
                        self.arguments.lights, "--stats", stats, "--quiet", "-o", self.picture], check=True)
        passes = json.loads(stats.read_text())["passes"]
        return sum(entry["milliseconds"] for entry in passes if entry["name"].startswith("first "))

    def truth(self):
        """What glint_oracle says of the last picture."""
        report = self.folder / "floor.json"
        subprocess.run([self.arguments.bin / "glint_oracle", self.scene, *self.options, "--bounces", "0", "--no-sky",
                        "--samples", str(self.arguments.truth), "--against", self.picture, "--device-spp",
                        str(self.arguments.spp), "--json", report], check=True, stdout=subprocess.DEVNULL)
        return json.loads(report.read_text())


def print_errors(floor, roughness, columns):
    row = []
    for column in columns:
        floor.render(*column)
        truth = floor.truth()
        row.append(f"{truth['difference']['rmse']:.2g}")
    row.append(f"{truth['difference']['expectedRmse']:.2g}")
    print(f"| {roughness} | {truth['mean']:.2f} | " + " | ".join(row) + " |", flush=True)


def print_times(floor, roughness, columns, rounds):
    times = {column: [] for column in columns}
    for _ in range(rounds):
        for column in columns:
            times[column].append(floor.render(*column))
    row = [f"{statistics.median(values):.3g} ({min(values):.3g})" for values in times.values()]
    print(f"| {roughness} | " + " | ".join(row) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--roughness", default="0.05,0.1,0.2,0.4")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--shadow-spp", default="1,16")
    parser.add_argument("--sized-lights", default="off,on")
    parser.add_argument("--truth", type=int, default=2048, help="samples of the truth")
    parser.add_argument("--size", default="32x18")
    parser.add_argument("--lamps", type=int, default=1)
    parser.add_argument("--lights", default="all", help="how many of the lamps a surface takes")
    parser.add_argument("--rounds", type=int, default=0, help="print times instead of errors")
    arguments = parser.parse_args()
    columns = [(sized, n) for sized in arguments.sized_lights.split(",") for n in arguments.shadow_spp.split(",")]
    titles = "".join(f" `{sized}`, {n} |" for sized, n in columns)
    print(f"| roughness |{titles}" if arguments.rounds else f"| roughness | mean |{titles} oracle |")
    print("|--:|" + "--:|" * (len(columns) + (0 if arguments.rounds else 2)))
    with tempfile.TemporaryDirectory() as folder:
        for roughness in arguments.roughness.split(","):
            floor = Floor(arguments, pathlib.Path(folder), roughness)
            if arguments.rounds:
                print_times(floor, roughness, columns, arguments.rounds)
            else:
                print_errors(floor, roughness, columns)


if __name__ == "__main__":
    main()
