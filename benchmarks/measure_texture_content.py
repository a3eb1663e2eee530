#!/usr/bin/env python3
"""Measures what the knowledge of textures removes from packages, and what it costs (docs/materials.md).

    benchmarks/measure_texture_content.py GLINT SCENE... [--no-pictures]

Each scene, and one that is generated, is compiled with --no-trust-textures and without, each with an empty cache of its own.
One table has what is in the packages: effects, distinct features of hits, cases, modules, bytes of SPIR-V, bytes of a
material, and the greatest difference of two pictures of 64 x 36 pixels. The other has processor seconds: cold; planning
again with everything in the cache, as after an edit of the scene; and when nothing has changed.
"""
import argparse
import json
import pathlib
import resource
import shutil
import struct
import subprocess
import tempfile
import zlib

from merge_scenes import ATTRIBUTES

COMPILE = ["--effects", "auto", "--strategy", "visibility", "--merge", "none"]


def png(width, texel):
    """A square image of RGBA whose texels are texel(x, y), as bytes of a file."""
    rows = b"".join(bytes([0]) + bytes(c for x in range(width) for c in texel(x, y)) for y in range(width))

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, width, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def noise(x, y):
    value = (x * 7919 + y * 104729) * 2654435761 % 2**32
    return value >> 24, value >> 16 & 255, value >> 8 & 255


def generated(folder):
    """A row of squares. Each has a texture whose content decides."""
    images = {
        "rough": lambda x, y: (*noise(x, y)[:1], 128 + noise(x, y)[1] // 2, 255, 255),
        "constant": lambda x, y: (9, 100, 50, 255),
        "halves": lambda x, y: (0 if x < 128 else noise(x, y)[0], 200, 0 if x < 128 else 255, 255),
        "flat": lambda x, y: (128 - (x + y) % 2, 128, 255, 255),
        "open": lambda x, y: (255, 255, 255, 255),
        "cutout": lambda x, y: (*noise(x, y), 255 if x < 160 else 0),
        "copy": lambda x, y: (*noise(x, y), 255 if x < 160 else 0),
    }
    slot = {name: {"index": i} for i, name in enumerate(images)}
    base = {"pbrMetallicRoughness": {"baseColorTexture": slot["cutout"]}}
    materials = [
        {"name": "rough", "pbrMetallicRoughness": {"metallicRoughnessTexture": slot["rough"]}},
        {"name": "constant", "pbrMetallicRoughness": {"metallicRoughnessTexture": slot["constant"],
                                                      "metallicFactor": 0.5}},
        {"name": "no glass here", "pbrMetallicRoughness": {"metallicFactor": 0},
         "extensions": {"KHR_materials_transmission": {
             "transmissionFactor": 1, "transmissionTexture": slot["halves"]}}},
        {"name": "no coat here", "extensions": {"KHR_materials_clearcoat": {
            "clearcoatFactor": 1, "clearcoatTexture": slot["halves"]}}},
        {"name": "flat", "normalTexture": slot["flat"], **base},
        {"name": "open", "occlusionTexture": slot["open"], **base},
        {"name": "mask", "alphaMode": "MASK", **base},
        {"name": "copy", "pbrMetallicRoughness": {"baseColorTexture": slot["copy"]}},
    ]
    buffer, views, accessors = bytearray(), [], []

    def add(rows, kind, component="f"):
        data = struct.pack(f"<{sum(map(len, rows))}{component}", *(v for row in rows for v in row))
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        buffer.extend(data + b"\0" * (-len(data) % 4))
        accessor = {"bufferView": len(views) - 1, "componentType": 5126 if component == "f" else 5123,
                    "count": len(rows), "type": kind}
        if kind == "VEC3":
            accessor |= {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]}
        accessors.append(accessor)
        return len(accessors) - 1

    position = add(ATTRIBUTES["POSITION"][1], "VEC3")
    normal = add(ATTRIBUTES["NORMAL"][1], "VEC3")
    # The left part of the images, and away from what filters blend into it.
    coordinates = add([(0.2, 0.8), (0.3, 0.8), (0.3, 0.2), (0.2, 0.2)], "VEC2")
    indices = add([(i,) for i in (0, 1, 2, 0, 2, 3)], "SCALAR", "H")
    primitive = {"attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": coordinates}, "indices": indices}
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(materials)))}],
        "nodes": [{"mesh": i, "translation": [1.1 * i, 0, 0]} for i in range(len(materials))],
        "meshes": [{"primitives": [{**primitive, "material": i}]} for i in range(len(materials))],
        "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{"uri": "scene.bin", "byteLength": len(buffer)}],
        "textures": [{"source": i, "sampler": 0} for i in range(len(images))],
        "samplers": [{"minFilter": 9729, "magFilter": 9729}],
        "images": [{"uri": f"{name}.png"} for name in images],
        "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_transmission"],
    }
    folder.mkdir(parents=True)
    for name, texel in images.items():
        (folder / f"{name}.png").write_bytes(png(256, texel))
    (folder / "scene.bin").write_bytes(buffer)
    (folder / "scene.gltf").write_text(json.dumps(scene))
    return folder / "scene.gltf"


def run(*command):
    """Returns what the command prints as JSON, and the processor seconds that it takes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(glint, scene, trust, work, pictures):
    cache = work / "cache"
    shutil.rmtree(work, ignore_errors=True)
    line = [glint, "compile", scene, *COMPILE, f"--trust-textures={trust}", "--cache", cache, "--json", "-o"]
    _, cold = run(*line, work / "package")
    _, again = run(*line, work / "other")
    report, nothing = run(*line, work / "other")
    assert report["upToDate"]
    manifest = json.loads((work / "package" / "manifest.json").read_text())
    inspected, _ = run(glint, "inspect", work / "package", "--json")
    shaders = [s for s in manifest["shaders"] if s]
    result = {
        "effects": sorted(e["name"] for e in manifest["effects"] if e["chosen"]),
        "features": sorted({f for s in shaders for part in ("always", "sometimes") for f in s[part]}),
        "cases": manifest["counts"]["cases"],
        "modules": len(list((work / "package").rglob("*.spv"))),
        "spirv": report["spirvBytes"],
        "record": find(inspected, "bytesPerMaterial"),
        "seconds": (cold, again, nothing),
    }
    if pictures:
        picture = work / "picture.exr"
        run(glint, "render", scene, "-o", picture, "--size", "64x36", "--spp", "1", "--effects", "auto",
            f"--trust-textures={trust}", "--json")
        result["picture"] = picture
    return result


def find(tree, name):
    """Returns the first value of that name in nested JSON."""
    if isinstance(tree, dict):
        if name in tree:
            return tree[name]
        tree = list(tree.values())
    for part in tree if isinstance(tree, list) else []:
        found = find(part, name)
        if found is not None:
            return found
    return None


def pair(off, on):
    return f"{off:,}" if off == on else f"{off:,} → {on:,}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--no-pictures", action="store_true")
    arguments = parser.parse_args()
    content, times = [], []
    with tempfile.TemporaryDirectory() as temporary:
        work = pathlib.Path(temporary)
        for scene in [generated(work / "generated"), *arguments.scenes]:
            off, on = (measure(arguments.glint, scene, trust, work / trust, not arguments.no_pictures)
                       for trust in ("off", "on"))
            name = scene.parent.name
            lost = [f for f in off["features"] if f not in on["features"]]
            lost += [f"{e} (effect)" for e in off["effects"] if e not in on["effects"]]
            same = "not drawn"
            if not arguments.no_pictures:
                compared, _ = run(arguments.glint, "compare", off["picture"], on["picture"], "--json")
                same = "equal" if compared["maxAbsolute"]["value"] == 0 else f"{compared['maxAbsolute']['value']:.1e}"
            content.append(f"| {name} | {', '.join(lost) or '-'} | {pair(off['cases'], on['cases'])} | "
                           f"{pair(off['modules'], on['modules'])} | {pair(off['spirv'], on['spirv'])} | "
                           f"{pair(off['record'], on['record'])} | {same} |")
            times.append(f"| {name} | " + " | ".join(f"{a:.2f} → {b:.2f}"
                                                     for a, b in zip(off["seconds"], on["seconds"])) + " |")
            print(content[-1] + "\n" + times[-1], flush=True)
    print("\n| scene | removed | cases | modules | bytes of SPIR-V | bytes of a material | pictures |")
    print("|---|---|---:|---:|---:|---:|---|\n" + "\n".join(content))
    print("\n| scene | cold, s | planned again, s | nothing changed, s |\n|---|---:|---:|---:|\n" + "\n".join(times))


if __name__ == "__main__":
    main()
