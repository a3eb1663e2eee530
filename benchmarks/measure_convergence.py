#!/usr/bin/env python3
"""Measures how paths converge with each kind of light, and whether every way to render them has the same mean.

    benchmarks/measure_convergence.py [--glint PROGRAM] [--kinds NAME,...] [--size WxH] [--bounces N|unlimited]
                                      [--reference-spp N] [--seeds N] [--mean-spp N]

The scene is a yard of three walls with a block, under one kind of light: points, a spot and a sun without a size; the
same with one; a map with a bright window; the gradient sky; emissive quads; emissive quads with a texture; or lamps of
a size, textured quads and the sky together. The first table has the RMSE against a picture of --reference-spp samples
for 2 to 64 samples, five octaves, as the root of the
mean of its square over --seeds pictures, and the slope of a line through the logarithms: -0.5 is 1/sqrt(N).

The second table has the mean of the picture over --seeds pictures of --mean-spp samples with its standard error: for
each strategy, and for one light and for all. Every picture has a seed of its own. Prints Markdown, a row as soon as it
is known.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

from measure_shadows import ROOT, Buffer, quad, write_scene
from scene_parts import png

SAMPLES = (2, 4, 8, 16, 32, 64)
STRATEGIES = ("uber", "visibility", "sorted-uber", "hit-shaders")
# The options of `glint render` for each kind of light.
KINDS = {
    "points": ["--sky", "0"],
    "sizes": ["--sky", "0", "--light-radius", "0.25", "--sun-angle", "11"],
    "map": ["--environment", "map.hdr"],
    "sky": ["--sky", "1"],
    "emissive": ["--sky", "0"],
    "textured": ["--sky", "0"],
    "mixed": ["--sky", "1", "--light-radius", "0.25", "--sun-angle", "11"],
}


def material(color, roughness, metallic, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "roughnessFactor": roughness,
                                     "metallicFactor": metallic}, **more}


def lamp(strength, textured):
    more = {"emissiveTexture": {"index": 0}} if textured else {}
    return material((0, 0, 0), 1, 0, emissiveFactor=[1, 0.8, 0.5], **more,
                    extensions={"KHR_materials_emissive_strength": {"emissiveStrength": strength}})


def punctual():
    """Returns nodes and the extension of a point, a spot and a sun."""
    down = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
    places = [{"translation": [1.2, 1.4, -1.8]}, {"translation": [-1, 2, -1], "rotation": down},
              {"rotation": [-math.sin(0.6), 0, 0, math.cos(0.6)]}]
    nodes = [{**place, "extensions": {"KHR_lights_punctual": {"light": number}}} for number, place in enumerate(places)]
    lights = [{"type": "point", "intensity": 4, "color": [1, 0.9, 0.7]},
              {"type": "spot", "intensity": 8, "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.9}},
              {"type": "directional", "intensity": 0.7}]
    return nodes, {"KHR_lights_punctual": {"lights": lights}}


def write_yard(path, kind):
    buffer = Buffer()
    textured = kind in ("textured", "mixed")
    materials = [material((0.7, 0.56, 0.42), 0.8, 0), material((0.8, 0.64, 0.48), 0.45, 1),
                 material((0.6, 0.48, 0.36), 1, 0), material((0.5, 0.4, 0.3), 0.7, 0), lamp(6, textured),
                 lamp(20, textured)]
    meshes = [quad(buffer, 0, [-3, -1, 1], [6, 0, 0], [0, 0, -5]),
              quad(buffer, 1, [-3, -1, -4], [6, 0, 0], [0, 2.5, 0]),
              quad(buffer, 2, [-2, -1, -1], [0, 0, -3], [0, 2, 0]),
              quad(buffer, 3, [0.3, -1, -2.5], [0.8, 0, 0.3], [0, 0.9, 0])]
    if kind in ("emissive", "textured", "mixed"):
        meshes += [quad(buffer, 4, [-0.5, 2.2, -1.8], [1, 0, 0], [0, 0, 1]),
                   quad(buffer, 5, [2.4, -0.5, -1], [0, 0, -0.5], [0.1, 0.5, 0])]
        if textured:
            for mesh in meshes[-2:]:
                uvs = buffer.add([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], 2)
                mesh["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs
    nodes = [{"mesh": number} for number in range(len(meshes))] + [{"camera": 0}]
    more = {}
    if kind in ("points", "sizes", "mixed"):
        lights, more["extensions"] = punctual()
        nodes += lights
    if textured:
        more["textures"] = [{"source": 0}]
        more["images"] = [{"uri": png(4, 4, lambda x, y: (255, 255, 255) if (x + 4 * y) % 5 == 0 else (10, 10, 10))}]
    write_scene(path, ["KHR_lights_punctual", "KHR_materials_emissive_strength"], nodes, buffer, meshes=meshes,
                materials=materials, **more,
                cameras=[{"type": "perspective", "perspective": {"yfov": 1.2, "znear": 0.1}}])


def write_map(path):
    """Writes a Radiance picture of 32 x 16 pixels, with a window of 4 x 2."""
    window, wall = bytes((192, 192, 160, 131)), bytes((205, 205, 205, 125))
    pixels = b"".join(window if 14 <= x < 18 and 4 <= y < 6 else wall for y in range(16) for x in range(32))
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n" + pixels)


class Yard:
    """The scene of one kind of light, its package for one choice of lights, and pictures of it."""

    def __init__(self, options, folder, kind, lights):
        self.options, self.folder, self.kind = options, folder, kind
        self.light = [str(folder / word) if word.endswith(".hdr") else word for word in KINDS[kind]] + ["--no-sun"]
        self.scene = folder / f"{kind}.gltf"
        self.package = folder / f"{kind}-{lights}"
        write_yard(self.scene, kind)
        map_option = ["--environment-map"] if kind == "map" else []
        self.run("compile", self.scene, "-o", self.package, "--strategy", "all", "--merge", "all", "--effects",
                 "shadow,reflection,indirect-diffuse", "--max-roughness", "1", "--bounces", options.bounces,
                 "--emissive-lights", "--no-sized-lights", "--lights", lights, *map_option)

    def run(self, *words):
        words = [str(word) for word in (self.options.glint, *words)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)}: exit {done.returncode}\n{done.stderr}")
        return done.stdout

    def render(self, name, spp, seed, strategy="uber"):
        path = self.folder / f"{name}.exr"
        self.run("render", self.scene, "-o", path, "--package", self.package, "--strategy", strategy, "--size",
                 self.options.size, "--spp", spp, "--seed", seed, "--max-roughness", "1", "--bounces",
                 self.options.bounces, "--quiet", *self.light)
        return path

    def compare(self, picture, reference):
        return json.loads(self.run("compare", picture, reference, "--json"))


def slope_of(errors):
    places = [math.log2(samples) for samples in SAMPLES]
    values = [math.log2(error) for error in errors]
    x, y = statistics.mean(places), statistics.mean(values)
    return sum((a - x) * (b - y) for a, b in zip(places, values)) / sum((a - x) ** 2 for a in places)


def measure_errors(yard, options):
    reference = yard.render("reference", options.reference_spp, 1)
    errors = []
    for samples in SAMPLES:
        squares = [yard.compare(yard.render("picture", samples, 2 + seed), reference)["rmse"] ** 2
                   for seed in range(options.seeds)]
        errors.append(math.sqrt(statistics.mean(squares)))
    print(f"| {yard.kind} | " + " | ".join(f"{error:.2e}" for error in errors) + f" | {slope_of(errors):.2f} |",
          flush=True)


def mean_of(yard, options, strategy, first_seed):
    """The mean of a picture is its mean distance to a black one."""
    black = yard.folder / "black.exr"
    means = [yard.compare(yard.render("picture", options.mean_spp, first_seed + seed, strategy), black)["mean"]
             for seed in range(options.seeds)]
    return f"{statistics.mean(means):.5f} ± {statistics.stdev(means) / math.sqrt(len(means)):.5f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="default build/release/bin/glint")
    parser.add_argument("--kinds", default=",".join(KINDS), help="default all of them")
    parser.add_argument("--size", default="24x16", help="default 24x16")
    parser.add_argument("--bounces", default="unlimited", help="default unlimited")
    parser.add_argument("--reference-spp", type=int, default=4096, help="default 4096")
    parser.add_argument("--seeds", type=int, default=4, help="default 4")
    parser.add_argument("--mean-spp", type=int, default=64, help="default 64")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="glint-convergence-") as name:
        folder = pathlib.Path(name)
        write_map(folder / "map.hdr")
        yards = {kind: Yard(options, folder, kind, 1) for kind in options.kinds.split(",")}
        print("| light | " + " | ".join(f"{samples} samples" for samples in SAMPLES) + " | slope |")
        print("|---" * (len(SAMPLES) + 2) + "|", flush=True)
        for yard in yards.values():
            measure_errors(yard, options)
        columns = [(1, strategy) for strategy in STRATEGIES] + [("all", "uber")]
        print("\n| light | " + " | ".join(f"{strategy}, {lights} light{'' if lights == 1 else 's'}"
                                          for lights, strategy in columns) + " |")
        print("|---" * (len(columns) + 1) + "|", flush=True)
        write_yard(folder / "dark.gltf", "sky")
        next(iter(yards.values())).run("render", folder / "dark.gltf", "-o", folder / "black.exr", "--size",
                                       options.size, "--sky", "0", "--no-sun", "--quiet")
        seed = 1000
        for kind, yard in yards.items():
            cells = []
            for lights, strategy in columns:
                now = yard if lights == 1 else Yard(options, folder, kind, lights)
                cells.append(mean_of(now, options, strategy, seed))
                seed += 1000
            print(f"| {kind} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
