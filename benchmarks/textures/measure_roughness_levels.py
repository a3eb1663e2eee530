#!/usr/bin/env python3
"""Measures how near mip levels of roughness come to a picture that is supersampled on the finest level.

    benchmarks/textures/measure_roughness_levels.py GLINT... [--scenes FILE,...] [--size WxH] [--seeds N] [--spp N]

Each GLINT is a program `glint`: give several builds to compare them. Floors are generated below a sun, half metal and
half dielectric. They differ in their roughness texture: squares of 0.1 and 0.9, noise from 0.3 to 0.6, and patches of
0.25 in 0.08; in squares of one texel and of 8 x 8. The reference has --spp samples per pixel with --texture-lod mip0.
The pictures have one sample per pixel, so that cones are as wide as pixels. Prints Markdown: means over the seeds of
the errors in linear light, and of FLIP.
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
sys.path.insert(0, str(ROOT / "examples"))
from scene_parts import Buffer, png, write_scene  # noqa: E402

SIDE = 64  # texels
TILES = 400
CELLS = (1, 8)  # texels a side


def roughness_textures(cell):
    """Returns textures by name: functions of x and y. Squares of `cell` texels have one number each."""
    chance = random.Random(1)
    noise = [chance.randint(77, 153) for _ in range(SIDE * SIDE)]
    patches = [20 if chance.random() < 0.7 else 64 for _ in range(SIDE * SIDE)]
    return {"squares": lambda x, y: 26 if (x // cell + y // cell) % 2 else 230,
            "noise": lambda x, y: noise[y // cell * SIDE + x // cell],
            "patches": lambda x, y: patches[y // cell * SIDE + x // cell]}


def make_floor(path, roughness):
    """Writes a floor of 40 m whose left half is metal, below a sun that shines towards the camera."""
    buffer = Buffer()
    meshes = []
    for index, (low, high) in enumerate(((-20.0, 0.0), (0.0, 20.0))):
        positions = [low, 0.0, 1.0, high, 0.0, 1.0, high, 0.0, -40.0, low, 0.0, -40.0]
        tiles = TILES / 2.0
        attributes = {
            "POSITION": buffer.add(positions, 3, min=[low, 0.0, -40.0], max=[high, 0.0, 1.0]),
            "NORMAL": buffer.add([0.0, 1.0, 0.0] * 4, 3),
            "TEXCOORD_0": buffer.add([0.0, 0.0, tiles, 0.0, tiles, 2 * tiles, 0.0, 2 * tiles], 2)}
        meshes.append({"primitives": [{"attributes": attributes, "material": index,
                                       "indices": buffer.add_indices([0, 1, 2, 0, 2, 3])}]})
    materials = [{"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}, "metallicFactor": metal,
                                           "baseColorFactor": [0.5, 0.5, 0.5, 1.0]}} for metal in (1.0, 0.0)]
    image = png(SIDE, SIDE, lambda x, y: (255, roughness(x, y), 255))
    # A sun 30 degrees above the horizon, and a camera that looks down at its highlight.
    nodes = [{"mesh": 0}, {"mesh": 1},
             {"camera": 0, "translation": [0.0, 1.5, 1.0], "rotation": [-0.216, 0.0, 0.0, 0.9763]},
             {"rotation": [0.0, 0.9659, 0.2588, 0.0], "extensions": {"KHR_lights_punctual": {"light": 0}}}]
    write_scene(path, ["KHR_lights_punctual"], nodes, buffer, meshes=meshes, materials=materials,
                images=[{"uri": image}], textures=[{"source": 0, "sampler": 0}],
                samplers=[{"minFilter": 9987, "magFilter": 9729}],
                extensions={"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3.0}]}},
                cameras=[{"type": "perspective", "perspective": {"yfov": 0.8, "aspectRatio": 16 / 9, "znear": 0.01}}])


def render(glint, scene, picture, size, *options):
    subprocess.run([glint, "render", scene, "-o", picture, "--size", size, "--effects", "none", "--strategy", "uber",
                    "--quiet", *map(str, options)], check=True)


def compare(glint, picture, reference):
    return json.loads(subprocess.run([glint, "compare", picture, reference, "--json"], check=True,
                                     capture_output=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("glint", nargs="+", help="programs to compare")
    parser.add_argument("--scenes", default="", help="further scenes, separated by commas")
    parser.add_argument("--size", default="96x54", help="default 96x54")
    parser.add_argument("--seeds", type=int, default=4, help="default 4")
    parser.add_argument("--spp", type=int, default=256, help="samples of the reference; default 256")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="glint-roughness-") as temporary:
        folder = pathlib.Path(temporary)
        scenes = {}
        for cell in CELLS:
            for kind, roughness in roughness_textures(cell).items():
                name = f"{kind}, {cell} x {cell} texels"
                scenes[name] = folder / f"{kind}{cell}.gltf"
                make_floor(scenes[name], roughness)
        scenes.update({pathlib.Path(path).stem: path for path in arguments.scenes.split(",") if path})
        print("| scene | program | relative MSE | RMSE | FLIP |\n|---|---|--:|--:|--:|")
        for title, scene in scenes.items():
            reference = folder / "reference.exr"
            render(arguments.glint[0], scene, reference, arguments.size, "--spp", arguments.spp,
                   "--texture-lod", "mip0")
            for number, glint in enumerate(arguments.glint):
                results = []
                for seed in range(1, arguments.seeds + 1):
                    picture = folder / "picture.exr"
                    render(glint, scene, picture, arguments.size, "--seed", seed)
                    results.append(compare(glint, picture, reference))
                row = [statistics.mean(result[key] for result in results) for key in ("relMse", "rmse", "flip")]
                print(f"| {title} | {number + 1} | " +
                      " | ".join(f"{value:.5f}" for value in row) + " |", flush=True)


if __name__ == "__main__":
    main()
