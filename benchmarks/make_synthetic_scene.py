#!/usr/bin/env python3
"""Writes a synthetic scene of many materials over a given number of keys. benchmarks/measure_compile.py compiles it.

    benchmarks/make_synthetic_scene.py FOLDER [--materials N] [--keys K] [--extra-key]

FOLDER gets scene.gltf, scene.bin and three images. Material i has the i mod K-th set of features, values of its
own, and a square. --extra-key gives the last material a set of features that no other has.
"""
import argparse
import json
import pathlib
import struct

from merge_scenes import ATTRIBUTES, complete, make_material, png_bytes

# A key is a number whose bits say which of these it has. K keys use the first log2(K) of them.
SWITCHES = [
    "baseColorTexture",
    "normalTexture",
    "clearcoat",
    "metallicRoughnessTexture",
    "sheen",
    "emissiveTexture",
    "occlusionTexture",
    "specular",
    "vertexColor",
]
EXTRA = frozenset({"anisotropy", "iridescence", "normals"})
PIXELS = {"normal.png": (128, 128, 255), "coat.png": (128, 140, 250), "other.png": (200, 180, 160)}
MAX_KEYS = 1 << len(SWITCHES)


def wish_of(key):
    """The features of a key, by its number."""
    chosen = {name for bit, name in enumerate(SWITCHES) if key >> bit & 1}
    return complete(chosen | {"normals"})


def material_of(wish, number):
    """A material with values of its own."""
    material = make_material(wish, f"material {number}", roughness=0.2 + 0.6 * (number % 997) / 997)
    material["pbrMetallicRoughness"]["baseColorFactor"] = [0.3 + 0.5 * (number % 101) / 101, 0.5, 0.6, 1]
    return material


def pack_attributes():
    """The square's buffer, buffer views and accessors; accessor indices by name."""
    buffer, views, accessors, ids = bytearray(), [], [], {}
    indices = ("SCALAR", 5123, struct.pack("<6H", 0, 1, 2, 0, 2, 3), 6)
    entries = {
        name: (kind, 5126, b"".join(struct.pack(f"<{len(v)}f", *v) for v in values), 4)
        for name, (kind, values) in ATTRIBUTES.items()
    }
    for name, (kind, component, data, count) in {**entries, "indices": indices}.items():
        ids[name] = len(accessors)
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        accessor = {"bufferView": ids[name], "componentType": component, "count": count, "type": kind}
        if name == "POSITION":
            accessor.update(min=[-0.5, -0.5, 0], max=[0.5, 0.5, 0])
        accessors.append(accessor)
        buffer.extend(data + b"\0" * (-len(data) % 4))
    return bytes(buffer), views, accessors, ids


def make_scene(count, keys, extra_key):
    """The scene as a dictionary, and its buffer."""
    buffer, views, accessors, ids = pack_attributes()
    wishes = [wish_of(key) for key in range(keys)]
    materials, meshes, nodes = [], [], []
    for number in range(count):
        wish = complete(EXTRA) if extra_key and number == count - 1 else wishes[number % keys]
        materials.append(material_of(wish, number))
        names = ["POSITION", "NORMAL", "TEXCOORD_0"] + (["COLOR_0"] if "vertexColor" in wish else [])
        attributes = {name: ids[name] for name in names}
        meshes.append({"primitives": [{"attributes": attributes, "indices": ids["indices"], "material": number}]})
        nodes.append({"mesh": number, "translation": [number % 100, number // 100, 0]})
    scene = {
        "asset": {"version": "2.0", "generator": "benchmarks/make_synthetic_scene.py"},
        "scene": 0,
        "scenes": [{"nodes": list(range(count))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "textures": [{"source": i, "sampler": 0} for i in range(len(PIXELS))],
        "samplers": [{}],
        "images": [{"uri": name} for name in PIXELS],
        "accessors": accessors,
        "bufferViews": views,
        "extensionsUsed": sorted({e for m in materials for e in m.get("extensions", {})}),
        "buffers": [{"uri": "scene.bin", "byteLength": len(buffer)}],
    }
    if not scene["extensionsUsed"]:
        del scene["extensionsUsed"]
    return scene, buffer


def write_scene(folder, count, keys, extra_key=False):
    """Writes the scene's files; returns the path of scene.gltf."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    scene, buffer = make_scene(count, keys, extra_key)
    for name, pixel in PIXELS.items():
        (folder / name).write_bytes(png_bytes(pixel))
    (folder / "scene.bin").write_bytes(buffer)
    path = folder / "scene.gltf"
    path.write_text(json.dumps(scene))
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder")
    parser.add_argument("--materials", type=int, default=10000, help="default 10000")
    parser.add_argument("--keys", type=int, default=64, help=f"1 to {MAX_KEYS}; default 64")
    parser.add_argument("--extra-key", action="store_true", help="one key more, of the last material")
    arguments = parser.parse_args()
    if not 1 <= arguments.keys <= min(MAX_KEYS, arguments.materials):
        parser.error(f"--keys must be 1 to {MAX_KEYS}, and not above the number of materials")
    print(write_scene(arguments.folder, arguments.materials, arguments.keys, arguments.extra_key))


if __name__ == "__main__":
    main()
