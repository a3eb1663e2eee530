"""What the scripts share that write the examples' scenes: spheres, pictures and the buffer of a glTF file."""

import base64
import json
import math
import struct
import zlib


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def png(width, height, pixel):
    """Returns a PNG file as a URI. Its pixels are pixel(x, y): three or four numbers from 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    color_type = 6 if len(pixel(0, 0)) == 4 else 2
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel(x, y)) for y in range(height))
    return data_uri("image/png", b"\x89PNG\r\n\x1a\n" +
                    chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0)) +
                    chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def sphere(segments, rings, turns=(1, 1)):
    """Returns positions, normals, tangents, UVs and indices of a unit sphere: ring by ring from its top. The UVs
    go that many times over a texture."""
    positions, normals, tangents, uvs, indices = [], [], [], [], []
    for ring in range(rings + 1):
        theta = math.pi * ring / rings
        for segment in range(segments + 1):
            phi = 2 * math.pi * segment / segments
            n = (math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi))
            positions += n
            normals += n
            tangents += (-math.sin(phi), 0.0, -math.cos(phi), 1.0)
            uvs += (turns[0] * segment / segments, turns[1] * ring / rings)
    for ring in range(rings):
        for segment in range(segments):
            a = ring * (segments + 1) + segment
            b = a + segments + 1
            indices += (a, b, a + 1) if ring > 0 else ()
            indices += (a + 1, b, b + 1) if ring < rings - 1 else ()
    return positions, normals, tangents, uvs, indices


class Buffer:
    """The data of a glTF file, with its accessors."""

    def __init__(self):
        self.data = b""
        self.views = []
        self.accessors = []

    def add(self, values, size, **more):
        """Adds floats in groups of `size`, and returns the number of their accessor."""
        return self._add(values, "f", 5126, ("SCALAR", "VEC2", "VEC3", "VEC4")[size - 1], size, more)

    def add_indices(self, values):
        return self._add(values, "H", 5123, "SCALAR", 1, {})

    def _add(self, values, form, component, kind, size, more):
        packed = struct.pack(f"<{len(values)}{form}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component,
                               "count": len(values) // size, "type": kind, **more})
        self.data += packed + b"\0" * (-len(packed) % 4)
        return len(self.accessors) - 1


def write_scene(path, extension_names, nodes, buffer, **members):
    """Writes a file with one scene, in which all nodes are. `extension_names` are those that it uses."""
    scene = {"asset": {"version": "2.0", "generator": "make_scene.py"}, "extensionsUsed": extension_names,
             "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, **members,
             "accessors": buffer.accessors, "bufferViews": buffer.views,
             "buffers": [{"byteLength": len(buffer.data),
                          "uri": data_uri("application/octet-stream", buffer.data)}]}
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
        file.write("\n")
