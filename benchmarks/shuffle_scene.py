#!/usr/bin/env python3
"""Copies a glTF scene with its triangles, and the nodes of each parent, in a random order, to measure traversal.

    benchmarks/shuffle_scene.py SCENE.gltf|SCENE.glb FOLDER [SEED]     writes FOLDER/ with all that the scene needs

Triangles without indices, and indices that are compressed or sparse, stay as they are; how many is printed.
"""

import base64
import json
import pathlib
import random
import shutil
import struct
import sys
import urllib.parse

SIZES = {5121: 1, 5123: 2, 5125: 4}


def read_glb(data):
    """The JSON, and the binary chunk."""
    chunks, place = [], 12
    while place + 8 <= len(data):
        length, _ = struct.unpack_from("<II", data, place)
        chunks.append(data[place + 8:place + 8 + length])
        place += 8 + length
    return json.loads(chunks[0]), bytearray(chunks[1]) if len(chunks) > 1 else bytearray()


def write_glb(scene, binary):
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def read_buffers(scene, folder, binary):
    buffers = []
    for buffer in scene.get("buffers", []):
        uri = buffer.get("uri")
        if uri is None:
            buffers.append(binary)
        elif uri.startswith("data:"):
            buffers.append(bytearray(base64.b64decode(uri.split(",", 1)[1])))
        else:
            buffers.append(bytearray((folder / urllib.parse.unquote(uri)).read_bytes()))
    return buffers


def shuffle_triangles(scene, buffers, rng):
    """Returns how many primitives were shuffled, and how many were not."""
    done, left = {}, 0
    for mesh in scene.get("meshes", []):
        for primitive in mesh["primitives"]:
            index = primitive.get("indices")
            accessor = scene["accessors"][index] if index is not None else {}
            if (primitive.get("mode", 4) != 4 or "bufferView" not in accessor or "sparse" in accessor
                    or "KHR_draco_mesh_compression" in primitive.get("extensions", {})
                    or "extensions" in scene["bufferViews"][accessor["bufferView"]]):
                left += 1
                continue
            if index in done:
                continue
            view = scene["bufferViews"][accessor["bufferView"]]
            bytes_of_triangle = 3 * SIZES[accessor["componentType"]]
            begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            buffer = buffers[view["buffer"]]
            triangles = [bytes(buffer[begin + i * bytes_of_triangle:begin + (i + 1) * bytes_of_triangle])
                         for i in range(accessor["count"] // 3)]
            rng.shuffle(triangles)
            buffer[begin:begin + len(triangles) * bytes_of_triangle] = b"".join(triangles)
            done[index] = True
    return len(done), left


def main(path, target, seed=1):
    path, target, rng = pathlib.Path(path), pathlib.Path(target), random.Random(int(seed))
    is_glb = path.suffix.lower() == ".glb"
    scene, binary = read_glb(path.read_bytes()) if is_glb else (json.loads(path.read_text()), bytearray())
    buffers = read_buffers(scene, path.parent, binary)
    shuffled, left = shuffle_triangles(scene, buffers, rng)
    for parent in scene.get("scenes", []) + scene.get("nodes", []):
        for name in ("nodes", "children"):
            if name in parent:
                rng.shuffle(parent[name])
    if target.resolve() == path.parent.resolve():
        sys.exit(f"{target}: is the folder of the scene; name another")
    # Copies may be written to, whatever the originals are.
    shutil.copytree(path.parent, target, dirs_exist_ok=True, copy_function=shutil.copyfile)
    target.chmod(0o755)
    for buffer, data in zip(scene.get("buffers", []), buffers):
        uri = buffer.get("uri")
        if uri is not None and uri.startswith("data:"):
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        elif uri is not None:
            (target / urllib.parse.unquote(uri)).write_bytes(data)
    if is_glb:
        (target / path.name).write_bytes(write_glb(scene, bytes(buffers[0]) if buffers else b""))
    else:
        (target / path.name).write_text(json.dumps(scene))
    print(f"{target / path.name}: {shuffled} index lists shuffled, {left} primitives left as they are")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
