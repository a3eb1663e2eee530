#!/usr/bin/env python3
"""Measures what --shadow-through costs, by the number of panes between surfaces and their lights.

    benchmarks/measure_shadows.py [--glint FILE] [--panes 0,1,2,4,8] [--kinds glass,blend,mask] [--size WxH]
                                  [--rounds N] [--tracer NAME] [--device NAME] [--bounces N] [--processor]
    benchmarks/measure_shadows.py --write FILE [--scene candle|vase|nested|apart]
    benchmarks/measure_shadows.py --write FILE --slab ROUGHNESS,INDEX

A floor with columns stands under lamps, with panes between them: of coloured glass, of BLEND with an alpha of 0.4, or
of MASK with a texture of holes. The scene is rendered with each setting in turn, in an order that changes from round to
round. Prints Markdown, a row as soon as it is measured: the device time of the passes that send shadow rays (first hits
and the shading of hits), and the ratio to the default in the same round. With --processor it is the processor time of
all passes, for devices on the processor while other programs run: that of many samples, less that of two.

--write writes another scene of the documents instead: a candle in a holder of blue glass (docs/shadows.md), a vase made
by BLEND (docs/materials.md), or a coloured ball of glass in a block of glass or beside it (docs/paths.md). With --slab
it is a floor below a slab of clear glass, which fills its sky (docs/shadows.md).
"""
import argparse
import json
import math
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))
from scene_parts import Buffer, png, sphere, write_scene  # noqa: E402

SETTINGS = ("alpha", "opaque", "glass")
DEFAULT = "alpha"


def mesh(buffer, material, positions, normals, indices, uvs=()):
    columns = [positions[axis::3] for axis in range(3)]
    attributes = {"POSITION": buffer.add(positions, 3, min=[min(c) for c in columns], max=[max(c) for c in columns]),
                  "NORMAL": buffer.add(normals, 3)}
    if uvs:
        attributes["TEXCOORD_0"] = buffer.add(uvs, 2)
    return {"primitives": [{"attributes": attributes, "indices": buffer.add_indices(indices), "material": material}]}


def quad(buffer, material, corner, right, up, repeats=0):
    """Returns a mesh: a parallelogram whose front looks along right x up. Its UVs, if any, repeat so many times."""
    corners = [corner, [c + r for c, r in zip(corner, right)],
               [c + r + u for c, r, u in zip(corner, right, up)], [c + u for c, u in zip(corner, up)]]
    normal = [right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
              right[0] * up[1] - right[1] * up[0]]
    length = math.sqrt(sum(n * n for n in normal))
    return mesh(buffer, material, [c for point in corners for c in point], [n / length for n in normal] * 4,
                [0, 1, 2, 0, 2, 3], [0, repeats, repeats, repeats, repeats, 0, 0, 0] if repeats else ())


def turned(buffer, material, profile, segments=96):
    """Returns a mesh: a profile of (radius, height), turned about the y axis. A profile that rises faces outwards."""
    positions, normals, indices = [], [], []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        first = len(positions) // 3
        length = math.hypot(r1 - r0, y1 - y0)
        out, up = (y1 - y0) / length, -(r1 - r0) / length
        for segment in range(segments + 1):
            angle = 2 * math.pi * segment / segments
            x, z = math.cos(angle), -math.sin(angle)
            positions += [r0 * x, y0, r0 * z, r1 * x, y1, r1 * z]
            normals += [out * x, up, out * z] * 2
        for segment in range(segments):
            a = first + 2 * segment
            indices += [a, a + 2, a + 1, a + 1, a + 2, a + 3]
    return mesh(buffer, material, positions, normals, indices)


def turned_smoothly(buffer, material, profile, segments=96):
    """The same with normals that are smooth along the profile, too."""
    positions, normals, indices = [], [], []
    for row, (radius, height) in enumerate(profile):
        before, after = profile[max(row - 1, 0)], profile[min(row + 1, len(profile) - 1)]
        length = math.hypot(after[0] - before[0], after[1] - before[1])
        out, up = (after[1] - before[1]) / length, (before[0] - after[0]) / length
        for segment in range(segments + 1):
            angle = 2 * math.pi * segment / segments
            x, z = math.cos(angle), -math.sin(angle)
            positions += [radius * x, height, radius * z]
            normals += [out * x, up, out * z]
            if row > 0 and segment > 0:
                a = row * (segments + 1) + segment
                b = a - segments - 1
                indices += [b - 1, b, a, b - 1, a, a - 1]
    return mesh(buffer, material, positions, normals, indices)


def ball(buffer, material, radius):
    positions, normals, _, _, indices = sphere(64, 32)
    return mesh(buffer, material, [radius * p for p in positions], normals, indices)


def glass(color, **volume):
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    if volume:
        extensions["KHR_materials_volume"] = volume
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 0},
            "extensions": extensions}


def matte(*color):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 0.8}}


def point_lights(lamps):
    """Returns nodes and the extension of lamps at [x, y, z] with candela."""
    nodes = [{"translation": place, "extensions": {"KHR_lights_punctual": {"light": number}}}
             for number, (place, _) in enumerate(lamps)]
    lights = [{"type": "point", "intensity": candela} for _, candela in lamps]
    return nodes, {"KHR_lights_punctual": {"lights": lights}}


USED = ["KHR_materials_transmission", "KHR_materials_volume", "KHR_lights_punctual"]


def camera(yfov, place, pitch):
    return ({"camera": 0, "translation": place, "rotation": [math.sin(-pitch / 2), 0, 0, math.cos(pitch / 2)]},
            [{"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": 16 / 9, "znear": 0.01}}])


def sheet(kind, color):
    """Returns the material of a pane. The texture of MASK is texture 0."""
    if kind == "glass":
        return glass(color)
    alpha = 0.4 if kind == "blend" else 1
    material = {"pbrMetallicRoughness": {"baseColorFactor": [*color, alpha], "metallicFactor": 0},
                "alphaMode": kind.upper(), "doubleSided": True}
    if kind == "mask":
        material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    return material


def hole(x, y):
    """A pixel of a texture of 16 x 16 with a round hole."""
    return 255, 255, 255, 0 if math.hypot(x - 7.5, y - 7.5) < 5 else 255


def write_panes(path, kind, panes):
    """Writes a floor with columns under four lamps, and `panes` sheets of a kind between them."""
    buffer = Buffer()
    materials = [matte(0.7, 0.7, 0.7), matte(0.6, 0.5, 0.4)]
    textures = {}
    if panes:
        materials += [sheet(kind, color) for color in ((0.95, 0.8, 0.6), (0.7, 0.9, 0.95))]
        if kind == "mask":
            textures = {"images": [{"uri": png(16, 16, hole)}], "textures": [{"source": 0}]}
    meshes = [quad(buffer, 0, [-8, 0, 6], [16, 0, 0], [0, 0, -16])]
    meshes += [turned(buffer, 1, [(0.3, 0), (0.3, 1.4), (0, 1.4)], 24)]
    # The panes are above the view.
    meshes += [quad(buffer, 2 + number % 2, [-9, 3.0 + 0.1 * number, 8], [18, 0, 0], [0, 0, -20],
                    24 if kind == "mask" else 0) for number in range(panes)]
    nodes = [{"mesh": 0}] + [{"mesh": 1, "translation": [x, 0, z]} for x in (-3, -1, 1, 3) for z in (-6, -3, 0)]
    nodes += [{"mesh": 2 + number} for number in range(panes)]
    view, cameras = camera(0.7, [0, 2.2, 5.5], 0.3)
    lamps, lights = point_lights([([x, 5.5, z], 30) for x in (-3, 3) for z in (-5, 1)])
    write_scene(path, USED, nodes + [view] + lamps, buffer, meshes=meshes, materials=materials, cameras=cameras,
                extensions=lights, **textures)


def write_candle(path):
    """Writes a white candle in a holder of blue glass, beside one that stands free."""
    buffer = Buffer()
    blue = glass((1, 1, 1), thicknessFactor=0.1, attenuationColor=[0.25, 0.5, 0.95], attenuationDistance=0.15)
    materials = [matte(0.6, 0.6, 0.6), matte(0.85, 0.82, 0.75), blue]
    candle = [(0.22, 0), (0.22, 0.75), (0, 0.75)]
    # Outside upwards, over the rim, inside downwards, across the ground inside, and back below.
    holder = [(0.0, 0.001), (0.5, 0.001), (0.62, 0.5), (0.5, 1.2), (0.42, 1.2), (0.54, 0.5), (0.42, 0.05), (0.0, 0.05)]
    meshes = [quad(buffer, 0, [-5, 0, 4], [10, 0, 0], [0, 0, -8]), turned(buffer, 1, candle),
              turned(buffer, 2, holder)]
    nodes = [{"mesh": 0}, {"mesh": 1, "translation": [-0.7, 0.06, 0]}, {"mesh": 2, "translation": [-0.7, 0, 0]},
             {"mesh": 1, "translation": [0.7, 0, 0]}]
    view, cameras = camera(0.6, [0, 1.5, 3.6], 0.28)
    lamps, lights = point_lights([([2.0, 2.5, 2.5], 30), ([-3.0, 3.0, 1.0], 15)])
    write_scene(path, USED, nodes + [view] + lamps, buffer, meshes=meshes, materials=materials, cameras=cameras,
                extensions=lights)


def write_vase(path):
    """Writes a vase of smooth glass that is made by BLEND, with sand and two stalks in it, beside a matte one."""
    buffer = Buffer()
    vase = {"pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.9, 0.95, 0.25], "metallicFactor": 0,
                                     "roughnessFactor": 0.03}, "alphaMode": "BLEND", "doubleSided": True}
    materials = [matte(0.6, 0.6, 0.6), vase, matte(0.75, 0.5, 0.25), matte(0.1, 0.45, 0.12), matte(0.8, 0.08, 0.1),
                 matte(0.75, 0.9, 0.95)]
    profile = [(0.32 + 0.14 * math.sin(4.4 * h / 1.3 + 0.3), h) for h in [1.3 * i / 48 for i in range(49)]]
    profile = [(0.0, 0.0)] + profile
    sand = [(0.9 * r, h + 0.02) for r, h in profile[:14]] + [(0.0, profile[14][1])]
    stalk = [(0.03, 0.1), (0.03, 1.65), (0.0, 1.66)]
    meshes = [quad(buffer, 0, [-5, 0, 4], [10, 0, 0], [0, 0, -8]), turned_smoothly(buffer, 1, profile),
              turned(buffer, 2, sand), turned(buffer, 3, stalk, 16), ball(buffer, 4, 0.16),
              turned_smoothly(buffer, 5, profile)]
    nodes = [{"mesh": 0}]
    for x, number in ((-0.65, 1), (0.65, 5)):
        nodes += [{"mesh": number, "translation": [x, 0, 0]}, {"mesh": 2, "translation": [x, 0, 0]}]
        for side in (-1, 1):
            lean = [0, 0, -side * math.sin(0.06), math.cos(0.06)]
            nodes += [{"mesh": 3, "translation": [x, 0, 0.1 * side], "rotation": lean},
                      {"mesh": 4, "translation": [x + side * 0.2, 1.68, 0.1 * side]}]
    view, cameras = camera(0.6, [0, 1.6, 3.8], 0.22)
    lamps, lights = point_lights([([2.0, 3.0, 2.5], 40), ([-3.0, 3.0, 1.0], 20)])
    write_scene(path, ["KHR_lights_punctual"], nodes + [view] + lamps, buffer, meshes=meshes, materials=materials,
                cameras=cameras, extensions=lights)


def box(buffer, material, low, high):
    """Returns a mesh of six sides that face outwards."""
    x, y, z = ([high[axis] - low[axis] if axis == side else 0 for axis in range(3)] for side in range(3))
    minus = [[-c for c in side] for side in (x, y, z)]
    sides = [(low, y, x), (low, x, z), (low, z, y), (high, minus[0], minus[1]), (high, minus[2], minus[0]),
             (high, minus[1], minus[2])]
    meshes = [quad(buffer, material, *side) for side in sides]
    return {"primitives": [part for side in meshes for part in side["primitives"]]}


def write_volumes(path, nested):
    """Writes a ball of coloured glass in a block of clear glass, or beside it, on a floor. The camera "mirror" sees a
    mirror in front of it, which shows both. The camera "direct" is where its image is, behind the mirror's back."""
    buffer = Buffer()
    clear = glass((1, 1, 1), thicknessFactor=1, attenuationColor=[0.9, 0.95, 0.95], attenuationDistance=1.0)
    ruby = glass((1, 1, 1), thicknessFactor=1, attenuationColor=[0.9, 0.4, 0.3], attenuationDistance=0.4)
    for material, index in ((clear, 1.5), (ruby, 1.7)):
        material["extensions"]["KHR_materials_ior"] = {"ior": index}
    metal = {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 1, "roughnessFactor": 0}}
    meshes = [quad(buffer, 0, [-6, 0, 8], [12, 0, 0], [0, 0, -14]), box(buffer, 1, [-0.6, 0.1, 1.4], [0.6, 1.3, 2.6]),
              ball(buffer, 2, 0.4), quad(buffer, 3, [-1.2, 0.2, -1], [2.4, 0, 0], [0, 1.6, 0])]
    nodes = [{"mesh": 0}, {"mesh": 1}, {"mesh": 2, "translation": [0 if nested else 1.3, 0.7, 2]}, {"mesh": 3},
             {"camera": 0, "translation": [0, 1, 0]},
             {"camera": 1, "translation": [0, 1, -2], "rotation": [0, 1, 0, 0]}]
    lens = {"yfov": 0.55, "aspectRatio": 16 / 9, "znear": 0.01}
    cameras = [{"name": name, "type": "perspective", "perspective": lens} for name in ("mirror", "direct")]
    write_scene(path, [*USED[:2], "KHR_materials_ior"], nodes, buffer, meshes=meshes,
                materials=[matte(0.7, 0.7, 0.7), clear, ruby, metal], cameras=cameras)


def write_nested(path):
    write_volumes(path, True)


def write_apart(path):
    write_volumes(path, False)


def write_slab(path, roughness, index):
    """Writes a diffuse floor that sees nothing but a wide slab of clear glass, from between the two."""
    buffer = Buffer()
    clear = glass((1, 1, 1), thicknessFactor=0.2)
    clear["pbrMetallicRoughness"]["roughnessFactor"] = roughness
    clear["extensions"]["KHR_materials_ior"] = {"ior": index}
    floor = matte(0.5, 0.5, 0.5)
    floor["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
    meshes = [quad(buffer, 0, [-40, 0, 40], [80, 0, 0], [0, 0, -80]), box(buffer, 1, [-40, 1, -40], [40, 1.2, 40])]
    view, cameras = camera(0.7, [0, 0.8, 0.5], 1.0)
    write_scene(path, [*USED[:2], "KHR_materials_ior", "KHR_materials_specular"], [{"mesh": 0}, {"mesh": 1}, view],
                buffer, meshes=meshes, materials=[floor, clear], cameras=cameras)


WRITERS = {"candle": write_candle, "vase": write_vase, "nested": write_nested, "apart": write_apart}


def render(arguments, scene, folder, setting, samples):
    """Renders once, and returns the statistics file."""
    stats = folder / "stats.json"
    command = [arguments.glint, "render", scene, "-o", folder / "picture.png", "--size", arguments.size, "--spp",
               str(samples), "--strategy", "uber", "--tracer", arguments.tracer, "--effects", "shadow,reflection",
               "--max-roughness", "1", "--bounces", str(arguments.bounces), "--shadow-through", setting, "--stats",
               stats]
    if arguments.device:
        command += ["--device", arguments.device]
    subprocess.run(command, check=True, capture_output=True)
    return stats


def device_time(arguments, scene, folder, setting):
    """Returns the milliseconds of the passes that send shadow rays."""
    passes = json.loads(render(arguments, scene, folder, setting, 2).read_text())["passes"]
    return sum(entry["milliseconds"] for entry in passes if entry["name"] == "uber" or entry["name"].startswith("first "))


def processor_time(arguments, scene, folder, setting):
    """Returns the milliseconds of processor time that a sample takes."""
    def spent(samples):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        render(arguments, scene, folder, setting, samples)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    more = 48
    return 1000 * (spent(2 + more) - spent(2)) / more


def spread(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="default build/release/bin/glint")
    parser.add_argument("--panes", default="0,1,2,4,8", help="default 0,1,2,4,8")
    parser.add_argument("--kinds", default="glass", help="of panes: glass, blend and mask; default glass")
    parser.add_argument("--size", default="640x360", help="default 640x360")
    parser.add_argument("--rounds", type=int, default=5, help="default 5")
    parser.add_argument("--tracer", default="auto", help="auto, ray-query or ray-pipeline; default auto")
    parser.add_argument("--device", help="part of the device's name; default the first that will do")
    parser.add_argument("--bounces", type=int, default=1, help="default 1")
    parser.add_argument("--processor", action="store_true", help="measure processor time, of all passes")
    parser.add_argument("--write", type=pathlib.Path, help="write a scene to this file, and end")
    parser.add_argument("--scene", choices=WRITERS, default="candle", help="the scene of --write; default candle")
    parser.add_argument("--slab", help="ROUGHNESS,INDEX of the slab that --write writes instead")
    arguments = parser.parse_args()
    if arguments.write and arguments.slab:
        write_slab(arguments.write, *map(float, arguments.slab.split(",")))
        return
    if arguments.write:
        WRITERS[arguments.scene](arguments.write)
        return
    measure = processor_time if arguments.processor else device_time
    chance = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="glint-shadows-") as name:
        folder = pathlib.Path(name)
        others = [setting for setting in SETTINGS if setting != DEFAULT]
        print(f"{arguments.size}, {arguments.rounds} rounds, {arguments.bounces} bounces, "
              f"ms of {'processor time of ' if arguments.processor else ''}a sample\n")
        print(f"| panes | {DEFAULT}, ms | " + " | ".join(f"{setting} / {DEFAULT}" for setting in others) + " |")
        print("|---|---|" + "---|" * len(others), flush=True)
        for kind in arguments.kinds.split(","):
            for count in [int(count) for count in arguments.panes.split(",")]:
                scene = folder / f"{kind}{count}.gltf"
                write_panes(scene, kind, count)
                times = {setting: [] for setting in SETTINGS}
                for _ in range(arguments.rounds):
                    for setting in chance.sample(SETTINGS, len(SETTINGS)):
                        times[setting].append(measure(arguments, scene, folder, setting))
                ratios = [[now / then for now, then in zip(times[setting], times[DEFAULT])] for setting in others]
                print(f"| {count} {kind} | {spread(times[DEFAULT])} | " +
                      " | ".join(spread(ratio) for ratio in ratios) + " |", flush=True)


if __name__ == "__main__":
    main()
