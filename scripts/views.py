#!/usr/bin/env python3
"""Makes the pictures of docs/views.md, and prints the command and the numbers of each.

    scripts/views.py [--build FOLDER] [--out FOLDER] [--size WxH] [--only NAME,...]
    scripts/views.py --problems [--models FOLDER] [--rounds N] [--only city|chair]
                                           what views find in scenes by others, and what mends it

The build has to have the targets glint and glint_gallery. Pictures are docs/images/views_NAME.png.
"""

import argparse
import json
import pathlib
import statistics
import struct
import subprocess
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent

# A view and what its command needs beside the gallery, for the package and for the picture. The scene "broken" is the gallery with two lamps whose intensity is
# near the largest float.
PLAIN = ["--strategy", "uber", "--merge", "none"]
VIEWS = {
    "shader": (PLAIN, []),
    "key": (PLAIN, []),
    "material": (PLAIN, []),
    "hit-shader": (PLAIN, []),
    "fallback": (PLAIN + ["--fallback"], []),
    "bucket": (["--strategy", "sorted-uber", "--merge", "none"], []),
    "divergence": (PLAIN, []),
    "branches": (PLAIN, []),
    "rays": (PLAIN, []),
    "candidates": (PLAIN, ["--opacity", "tested", "--camera", "-2.3,1.5,0.6/-3.6,1.5,-3/50"]),
    "cost": (PLAIN, []),
    "clocks": (PLAIN, []),
    "texture-level": (PLAIN, []),
    "footprint": (PLAIN, []),
    "hit-distance": (PLAIN, []),
    "non-finite": (PLAIN, []),
    "difference": (PLAIN + ["--effects", "shadow"], ["--view-reference", "reference.exr"]),
}
# Most views are drawn with one package that has all of these layers, because the driver then makes its pipelines once.
LAYERS = "lobes,material,shader,branches,footprint,texture-level,hit-shader,rays,candidates,non-finite,workgroup,cases-run,distance"
# Those that need a package of their own. The view clocks would count what the other layers take.
ALONE = {"clocks", "fallback", "difference"}
BROKEN = {"non-finite"}
CITY_CAMERA = "8"


def run(program, *arguments):
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, arguments))}\n{done.stderr}")


def pixels_of(file):
    """The width, the height and the rows of an 8-bit RGB PNG (PNG specification, sections 4 and 9)."""
    data = file.read_bytes()
    place, packed = 8, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place : place + 8])
        body = data[place + 8 : place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            if (depth, color, interlaced) != (8, 2, 0):
                raise SystemExit(f"{file}: no 8-bit RGB")
        elif kind == b"IDAT":
            packed += body
        place += length + 12
    raw, bytes_of_row = zlib.decompress(packed), 3 * width
    above, rows = bytearray(bytes_of_row), []
    for y in range(height):
        start = y * (bytes_of_row + 1)
        kind, row = raw[start], bytearray(raw[start + 1 : start + 1 + bytes_of_row])
        for x in range(bytes_of_row):
            left = row[x - 3] if x >= 3 else 0
            corner = above[x - 3] if x >= 3 else 0
            if kind == 1:
                row[x] = row[x] + left & 255
            elif kind == 2:
                row[x] = row[x] + above[x] & 255
            elif kind == 3:
                row[x] = row[x] + (left + above[x]) // 2 & 255
            elif kind == 4:
                guess = left + above[x] - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above[x]), 1, above[x]), (abs(guess - corner), 2, corner))
                row[x] = row[x] + near[2] & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


def write_png(file, width, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    # Each row is stored as its difference to the one above, or as it is: whichever has the smaller sum.
    above, raw = bytes(3 * width), bytearray()
    for row in rows:
        change = bytes(a - b & 255 for a, b in zip(row, above))
        size = sum(min(value, 256 - value) for value in change)
        own = bytes(row[x] - (row[x - 3] if x >= 3 else 0) & 255 for x in range(len(row)))
        if sum(min(value, 256 - value) for value in own) < size:
            raw += b"\1" + own
        else:
            raw += b"\2" + change
        above = row
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b""))


def sheet(out, files, columns):
    """Puts pictures of one width beside and below each other, on black."""
    rows = []
    for first in range(0, len(files), columns):
        parts = [pixels_of(file) for file in files[first : first + columns]]
        width = parts[0][0]
        for y in range(max(height for _, height, _ in parts)):
            line = b"".join(own[y] if y < height else bytes(3 * width) for _, height, own in parts)
            rows.append(line + bytes(3 * width * (columns - len(parts))))
    write_png(out, len(rows[0]) // 3, rows)


def numbers_of(view):
    if view["numbers"] > 0:
        return ", ".join(f"{name} {view[name]:.4g}" for name in ("least", "median", "mean", "percentile99", "greatest"))
    return ", ".join(f"{one['name']}: {one['pixels']}" for one in view["categories"][:4])


def draw_views(glint, gallery, arguments, folder):
    run(gallery, folder)
    scene = folder / "gallery.gltf"
    broken = json.loads(scene.read_text())
    for light in broken["extensions"]["KHR_lights_punctual"]["lights"]:
        if light["name"] in ("Lantern light", "Lamp light"):
            light["intensity"] = 3.4e38
    (folder / "broken.gltf").write_text(json.dumps(broken))
    size = ["--size", arguments.size]
    packages = {}
    for name, (compiled, options) in VIEWS.items():
        if arguments.only and name not in arguments.only:
            continue
        if name == "difference":
            run(glint, "render", scene, "-o", folder / "reference.exr", *size, *PLAIN)
        given = [str(folder / word) if word.endswith(".exr") else word for word in options]
        source = folder / ("broken.gltf" if name in BROKEN else "gallery.gltf")
        shaders = compiled
        if name not in ALONE:
            if tuple(compiled) not in packages:
                packages[tuple(compiled)] = folder / f"package{len(packages)}"
                run(glint, "compile", scene, "-o", packages[tuple(compiled)], "--layers", LAYERS, *compiled)
            shaders = ["--package", packages[tuple(compiled)], *compiled[:2]]
        picture, stats = arguments.out / f"views_{name.replace('-', '_')}.png", folder / f"{name}.json"
        run(glint, "render", source, "-o", picture, *size, "--view", name, "--stats", stats, *given, *shaders)
        width, _, rows = pixels_of(picture)
        write_png(picture, width, rows)
        print(f"glint render {source.name} -o {name}.png --size {arguments.size} --view {name} {' '.join(compiled + options)}")
        print(f"    {numbers_of(json.loads(stats.read_text())['view'])}; {picture.stat().st_size} bytes", flush=True)


def without_false_occlusion(source, target):
    """Removes the occlusion textures that are the material's colour texture. Returns how many there were, and of how many."""
    data = source.read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    document = json.loads(data[20 : 20 + length])
    removed = 0
    for material in document["materials"]:
        color = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        if color is not None and material.get("occlusionTexture") == color:
            del material["occlusionTexture"]
            removed += 1
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    target.write_bytes(b"glTF" + struct.pack("<III", 2, 20 + len(text) + len(rest), len(text)) + b"JSON" + text + rest)
    return removed, len(document["materials"])


def draw_city(glint, arguments, folder):
    scenes = {"before": arguments.models / "large/VC/VC.glb", "after": folder / "city.glb"}
    removed, count = without_false_occlusion(scenes["before"], scenes["after"])
    print(f"{removed} of {count} materials have their colour texture as occlusion, too")
    shown = ["--size", arguments.size, "--camera", CITY_CAMERA, "--merge", "none"]
    for name, scene in scenes.items():
        for view in ("shader", "cost"):
            stats = folder / f"{name}.{view}.json"
            run(glint, "render", scene, "-o", folder / f"{name}.{view}.png", *shown, "--view", view, "--stats", stats)
            print(f"{name}, {view}: {numbers_of(json.loads(stats.read_text())['view'])}", flush=True)
        for file in ("png", "exr"):
            run(glint, "render", scene, "-o", folder / f"{name}.{file}", *shown, "--spp", "4", "--exposure", "0")
    run(glint, "render", scenes["before"], "-o", folder / "change.png", *shown, "--spp", "4", "--view", "difference",
        "--view-reference", folder / "after.exr", "--stats", folder / "change.json")
    print(f"difference: {numbers_of(json.loads((folder / 'change.json').read_text())['view'])}")
    time_both(glint, {name: [scene, *shown] for name, scene in scenes.items()}, arguments.rounds, folder)
    files = [folder / f"{name}{kind}" for kind in (".png", ".shader.png") for name in scenes]
    sheet(arguments.out / "views_city.png", files, 2)


def draw_chair(glint, arguments, folder):
    scene = arguments.models / "features/SheenChair/SheenChair.gltf"
    ways = {"before": [], "after": ["--max-roughness", "0.29"]}
    shown = ["--size", arguments.size, "--strategy", "uber"]
    for name, options in ways.items():
        stats = folder / f"{name}.json"
        compiled = subprocess.run([str(glint), "compile", str(scene), "-o", str(folder / name), *shown[2:], *options],
                                  capture_output=True, text=True, check=True)
        run(glint, "render", scene, "-o", folder / f"{name}.exr", *shown, "--spp", "64", "--stats", stats, *options)
        read = json.loads(stats.read_text())
        sent = sum(one["rays"] for one in read["effects"] if one["name"] == "reflection")
        print(f"{name}: reflection rays of a sample {sent}, pipelines {read['footprint']['pipelines']}, "
              f"renderer {read['footprint']['bytes']} bytes")
        print("".join(f"    {line}\n" for line in compiled.stdout.splitlines() if "bytes" in line), end="", flush=True)
    run(glint, "render", scene, "-o", folder / "before.png", *shown, "--spp", "64")
    run(glint, "render", scene, "-o", folder / "hits.png", *shown, "--view", "hit-shader", "--stats", folder / "hits.json")
    print(f"hit-shader: {numbers_of(json.loads((folder / 'hits.json').read_text())['view'])}")
    compared = subprocess.run([str(glint), "compare", str(folder / "before.exr"), str(folder / "after.exr")],
                              capture_output=True, text=True, check=False)
    print("".join(line + "\n" for line in compared.stdout.splitlines() if line.startswith(("relMSE", "largest"))), end="")
    time_both(glint, {name: [scene, *shown, *options] for name, options in ways.items()}, arguments.rounds, folder)
    sheet(arguments.out / "views_chair.png", [folder / "before.png", folder / "hits.png"], 2)


def time_both(glint, ways, rounds, folder):
    """Times both ways in turn, so that what else the machine does slows both alike."""
    times = {name: [] for name in ways}
    for _ in range(rounds):
        for name, words in ways.items():
            run(glint, "render", words[0], "-o", folder / "timed.png", *words[1:], "--stats", folder / "timed.json")
            times[name].append(sum(one["milliseconds"] for one in json.loads((folder / "timed.json").read_text())["passes"]))
    for name, values in times.items():
        if values:
            print(f"{name}: passes of a sample {statistics.median(values):.1f} ms ({min(values):.1f} to {max(values):.1f}), {len(values)} rounds")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--only", type=lambda text: text.split(","), default=[])
    parser.add_argument("--problems", action="store_true")
    parser.add_argument("--models", type=pathlib.Path, default=ROOT.parent / "shared/models")
    parser.add_argument("--rounds", type=int, default=0)
    arguments = parser.parse_args()
    glint, gallery = arguments.build / "bin/glint", arguments.build / "bin/gallery"
    with tempfile.TemporaryDirectory() as name:
        if arguments.problems:
            if "city" in arguments.only or not arguments.only:
                draw_city(glint, arguments, pathlib.Path(name))
            if "chair" in arguments.only or not arguments.only:
                draw_chair(glint, arguments, pathlib.Path(name))
        else:
            draw_views(glint, gallery, arguments, pathlib.Path(name))


if __name__ == "__main__":
    main()
