#!/usr/bin/env python3
"""Measures what rays save where alpha tests are decided at upload.

    benchmarks/measure_opacity.py [--glint FILE] [--cells 1,4,8] [--plants N] [--size WxH] [--rounds N] [--tracer NAME]
                                  [--scene FILE…] [--write FOLDER]

Plants with leaves on cards stand on a mirror in the sun. A card shows a leaf of a texture of 256 x 256 texels, and is
cut into C x C cells of two triangles each. Every scene is rendered with --opacity proved and tested in turn, in an
order that changes from round to round. Prints Markdown: triangles by their state, alpha tests for each ray, the device
time of the passes that send rays (as the ratio of both in the same round), bytes of bottom levels, and the time of
the proofs. Where the pictures of a scene are not equal to the bit, it goes on and prints below the table how many pixels
differ and by how much, with one sample of the picture (a pixel that differs saw another triangle, or another place of
it). Surfaces of the scene that lie in the same place are counted, too: there the driver chooses. Exits with 1 then.
"""
import argparse
import base64
import json
import math
import pathlib
import random
import statistics
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))
from scene_parts import Buffer, png, write_scene  # noqa: E402

CARDS = 24  # of a plant
RAY_PASSES = ("trace", "first ", "shadow", "uber", "hit shaders")


def leaf_alpha(x, y):
    """Returns the alpha of a lobed leaf with a hole, with soft edges of two texels."""
    u, v = (x + 0.5) / 256 - 0.5, (y + 0.5) / 256 - 0.5
    radius, angle = math.hypot(u, v), math.atan2(v, u)
    edge = 0.34 + 0.1 * math.cos(5 * angle) - radius
    hole = math.hypot(u - 0.1, v) - 0.06
    return max(0, min(255, int(128 + 128 * min(edge, hole) * 128)))


def make_plant(buffer, cells, chance):
    """Returns a primitive: cards of cells x cells squares, which are bent a little, around a stem."""
    positions, normals, uvs, indices = [], [], [], []
    for _ in range(CARDS):
        turn, lift, tilt = chance.uniform(0, 2 * math.pi), chance.uniform(0.1, 1.2), chance.uniform(-0.6, 0.6)
        across, up = (math.cos(turn), 0.0, math.sin(turn)), (-math.sin(turn) * math.sin(tilt), math.cos(tilt),
                                                           math.cos(turn) * math.sin(tilt))
        normal = tuple(across[(i + 1) % 3] * up[(i + 2) % 3] - across[(i + 2) % 3] * up[(i + 1) % 3] for i in range(3))
        first = len(positions) // 3
        for row in range(cells + 1):
            for column in range(cells + 1):
                u, v = column / cells, row / cells
                bend = 0.05 * math.sin(math.pi * u)
                positions += (0.5 * (u - 0.5) * across[i] + 0.5 * v * up[i] + bend * normal[i] + (lift if i == 1 else 0)
                              for i in range(3))
                normals += normal
                uvs += (u, 1 - v)
        for row in range(cells):
            for column in range(cells):
                a = first + row * (cells + 1) + column
                b = a + cells + 1
                indices += (a, a + 1, b, a + 1, b + 1, b)
    low = [min(positions[i::3]) for i in range(3)]
    high = [max(positions[i::3]) for i in range(3)]
    attributes = {"POSITION": buffer.add(positions, 3, min=low, max=high), "NORMAL": buffer.add(normals, 3),
                  "TEXCOORD_0": buffer.add(uvs, 2)}
    return {"attributes": attributes, "indices": buffer.add_indices(indices), "material": 0}


def make_scene(path, cells, plants):
    buffer, chance = Buffer(), random.Random(3)
    meshes = [{"primitives": [make_plant(buffer, cells, chance)]} for _ in range(3)]
    ground = {"POSITION": buffer.add([-9, 0, -9, 9, 0, -9, 9, 0, 9, -9, 0, 9], 3, min=[-9, 0, -9], max=[9, 0, 9]),
              "NORMAL": buffer.add([0.0, 1.0, 0.0] * 4, 3)}
    meshes.append({"primitives": [{"attributes": ground, "indices": buffer.add_indices([0, 2, 1, 0, 3, 2]),
                                   "material": 1}]})
    nodes = [{"mesh": 3}, {"camera": 0, "translation": [0, 1.2, 4.5]}]
    for _ in range(plants):
        turn = chance.uniform(0, 2 * math.pi)
        nodes.append({"mesh": chance.randrange(3), "rotation": [0, math.sin(turn / 2), 0, math.cos(turn / 2)],
                      "translation": [chance.uniform(-3, 3), 0, chance.uniform(-4, 2.5)]})
    leaf = png(256, 256, lambda x, y: (60 + x // 4, 140, 50, leaf_alpha(x, y)))
    write_scene(path, [], nodes, buffer, meshes=meshes, textures=[{"source": 0}], images=[{"uri": leaf}],
                materials=[{"name": "leaf", "alphaMode": "MASK", "doubleSided": True,
                            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0}},
                           {"name": "water", "pbrMetallicRoughness": {"roughnessFactor": 0.0}}],
                cameras=[{"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 16 / 9, "znear": 0.01}}])


def render(glint, scene, use, folder, arguments):
    """Renders once. Returns the report and the bytes of the picture."""
    stats, picture = folder / f"{use}.json", folder / f"{use}.exr"
    command = [glint, "render", scene, "-o", picture, "--size", arguments.size, "--tracer", arguments.tracer,
               "--strategy", "visibility", "--opacity", use, "--stats", stats]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads(stats.read_text()), picture.read_bytes()


def difference(glint, scene, folder):
    """Returns how far the last two pictures of a scene are apart, in words."""
    result = subprocess.run([glint, "compare", folder / "proved.exr", folder / "tested.exr", "--json"], check=True,
                            capture_output=True)
    found = json.loads(result.stdout)
    worst, relative = found["maxAbsolute"], found["maxRelative"]
    return (f"{found['differing']} of {found['pixels']} pixels differ, by {worst['value']:.3g} at most (in "
            f"{worst['channel']} at {worst['x']}, {worst['y']}), relative to max(1, radiance) by "
            f"{relative['value']:.3g}; RMSE {found['rmse']:.3g}; {coincident(scene)}")


def coincident(scene):
    """Returns in words how many triangles of a scene's meshes lie in the place of another of the same mesh."""
    document = json.loads(scene.read_text())
    if any("uri" not in buffer or not buffer["uri"].startswith("data:") for buffer in document["buffers"]):
        return "coincident triangles were not counted"
    data = [base64.b64decode(buffer["uri"].split(",", 1)[1]) for buffer in document["buffers"]]

    def read(accessor, code, parts):
        given = document["accessors"][accessor]
        view = document["bufferViews"][given["bufferView"]]
        first = view.get("byteOffset", 0) + given.get("byteOffset", 0)
        return struct.unpack_from(f"<{given['count'] * parts}{code}", data[view["buffer"]], first)

    again = 0
    for mesh in document["meshes"]:
        seen = set()
        for primitive in mesh["primitives"]:
            at = read(primitive["attributes"]["POSITION"], "f", 3)
            kind = {5123: "H", 5125: "I"}[document["accessors"][primitive["indices"]]["componentType"]]
            corners = read(primitive["indices"], kind, 1)
            for i in range(0, len(corners), 3):
                place = frozenset(at[3 * c:3 * c + 3] for c in corners[i:i + 3])
                again += place in seen
                seen.add(place)
    return f"{again} triangles lie in the place of another"


def spread(values, digits):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def measure(scene, label, folder, arguments, chance):
    times = {"proved": [], "tested": []}
    reports, pictures = {}, {}
    for _ in range(arguments.rounds):
        for use in chance.sample(list(times), 2):
            reports[use], pictures[use] = render(arguments.glint, scene, use, folder, arguments)
            times[use].append(sum(entry["milliseconds"] for entry in reports[use]["passes"]
                                  if entry["name"].startswith(RAY_PASSES)))
    different = None
    if pictures["proved"] != pictures["tested"]:
        different = f"{label}: {difference(arguments.glint, scene, folder)}"
    proved = reports["proved"]["sceneStatistics"]
    masked = max(proved["maskedTriangles"], 1)
    rays = {use: max(sum(effect["rays"] for effect in reports[use]["effects"]), 1) for use in reports}
    each = {use: reports[use]["counters"]["alphaTests"] / rays[use] for use in reports}
    ratio = [a / b for a, b in zip(times["proved"], times["tested"])]
    blas = {use: reports[use]["sceneStatistics"]["blasBytes"] for use in reports}
    print(f"| {label} | {proved['maskedTriangles']:,} | {100 * proved['provedOpaque'] / masked:.0f} % | "
          f"{100 * proved['provedTransparent'] / masked:.0f} % | {each['tested']:.2f} | {each['proved']:.2f} | "
          f"{spread(times['tested'], 1)} | {spread(ratio, 2)} | {blas['tested']:,} | {blas['proved']:,} | "
          f"{proved['opacityMs']:.1f} |", flush=True)
    return different


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="default build/release/bin/glint")
    parser.add_argument("--cells", default="1,4,8", help="default 1,4,8")
    parser.add_argument("--plants", type=int, default=40, help="default 40")
    parser.add_argument("--size", default="320x180", help="default 320x180")
    parser.add_argument("--rounds", type=int, default=5, help="default 5")
    parser.add_argument("--tracer", default="auto", help="auto, ray-query or ray-pipeline; default auto")
    parser.add_argument("--scene", action="append", default=[], help="measures this scene, too")
    parser.add_argument("--write", type=pathlib.Path, help="writes the scenes into this folder and stops")
    arguments = parser.parse_args()
    chance = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="glint-opacity-") as name:
        folder = arguments.write or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        scenes = []
        for cells in arguments.cells.split(","):
            scenes.append((folder / f"cells{cells}.gltf", f"{cells} × {cells} cells"))
            make_scene(scenes[-1][0], int(cells), arguments.plants)
        if arguments.write:
            return
        print("| scene | masked triangles | opaque | transparent | tests a ray: tested | proved | tested, ms | "
              "proved / tested | BLAS bytes: tested | proved | proofs, ms |")
        print("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
        different = []
        for scene, label in scenes + [(pathlib.Path(path), pathlib.Path(path).stem) for path in arguments.scene]:
            different.append(measure(scene, label, folder, arguments, chance))
        for line in filter(None, different):
            print(f"\n{line}")
        if any(different):
            sys.exit(1)


if __name__ == "__main__":
    main()
