"""What both renderers render: the environment map, spheres of many materials, and models with a common camera.

Every scene is written into a folder of its own as scene.gltf or scene.glb, without punctual lights. Its last camera is
the one that both use.
"""
import base64
import dataclasses
import json
import math
import os
import pathlib
import struct
import urllib.parse

import numpy as np

import images

MAP_SIZE = (256, 512)
FIELD_OF_VIEW = math.radians(30)
SPHERE_PIXELS = 64


@dataclasses.dataclass
class Scene:
    """A scene that was written."""
    name: str
    file: pathlib.Path
    size: tuple  # width and height of the picture
    gltf: dict
    camera: int
    rows: list = dataclasses.field(default_factory=list)  # of spheres: labels; empty for a model
    columns: list = dataclasses.field(default_factory=list)
    title: str = ""  # what rows and columns mean

    @property
    def materials(self):
        return self.gltf.get("materials", [])


# ---- The light


def write_environment(path):
    """Writes a smooth sky over a darker ground with a soft bright region, an equirectangular map of radiance.

    The first row is up, the middle of a row is +X, and to its right comes +Z. Nothing is finer than a texel of the
    maps that either renderer makes of it, so that their resolutions do not matter.
    """
    height, width = MAP_SIZE
    polar = (np.arange(height) + 0.5) / height * np.pi
    azimuth = ((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi
    up = np.cos(polar)[:, None] * np.ones(width)
    x, z = np.sin(polar)[:, None] * np.cos(azimuth), np.sin(polar)[:, None] * np.sin(azimuth)

    def colour(*rgb):
        return np.array(rgb)

    def blend(t, low, high):
        return low + (high - low) * t[..., None]

    above = 1 / (1 + np.exp(-8 * up))
    sky = blend(np.clip(up, 0, 1), colour(0.75, 0.8, 0.85), colour(0.25, 0.4, 0.8))
    radiance = blend(above, colour(0.22, 0.17, 0.13), sky)
    # A lobe of 5 times the sky, with a half width of 20 degrees, in front at the left; a weaker one behind.
    for direction, width_cosine, light in (((-0.5, 0.6, 0.65), 0.06, colour(5.0, 4.4, 3.6)),
                                           ((0.8, 0.2, -0.5), 0.15, colour(0.5, 0.9, 1.2))):
        d = np.array(direction) / np.linalg.norm(direction)
        radiance = radiance + np.exp((x * d[0] + up * d[1] + z * d[2] - 1) / width_cosine)[..., None] * light
    images.write_hdr(path, radiance)


def write_sheen_albedo(path, size=64):
    """Writes the albedo of the sheen lobe, which the viewer reads from a table that its package does not hold.

    To the right grows the cosine of the view, downwards the roughness. The formulas are those of
    KHR_materials_sheen: Charlie distribution, visibility after Estevez and Kulla (2017); summed over directions.
    """

    def smith(cosine, alpha):
        m = (1 - alpha) ** 2
        ends = ((21.5473, 25.3245), (3.82987, 3.32435), (0.19823, 0.16801), (-1.97760, -1.27393),
                (-4.32054, -4.85967))
        a, b, c, d, e = (rough + (smooth - rough) * m for rough, smooth in ends)

        def exponent(t):
            return a / (1 + b * t**c) + d * t + e

        return np.exp(np.where(cosine < 0.5, exponent(cosine),
                               2 * exponent(0.5) - exponent(np.maximum(1 - cosine, 0))))

    centres = (np.arange(size) + 0.5) / size
    light = ((np.arange(128) + 0.5) / 128)[:, None]
    azimuth = (np.arange(64) + 0.5) / 64 * np.pi
    light_sine = np.sqrt(1 - light**2)
    table = np.zeros((size, size))
    for row, roughness in enumerate(centres):
        alpha = max(roughness, 0.07) ** 2
        for column, view in enumerate(centres):
            l_dot_v = light_sine * math.sqrt(1 - view**2) * np.cos(azimuth) + light * view
            half_cosine = (light + view) / np.sqrt(np.maximum(2 + 2 * l_dot_v, 1e-12))
            sine_squared = np.clip(1 - half_cosine**2, 0, 1)
            distribution = (2 + 1 / alpha) * sine_squared ** (0.5 / alpha) / (2 * np.pi)
            visibility = 1 / ((1 + smith(view, alpha) + smith(light, alpha)) * 4 * view * light)
            table[row, column] = (distribution * visibility * light).mean() * 2 * np.pi
    grey = np.round(np.clip(table, 0, 1) * 255)[..., None] * np.ones(3)
    path.write_bytes(images.png_bytes(grey))


# ---- Cameras


def look_at(position, backward):
    """The matrix of a camera's node as glTF has it: columns, one after another."""
    right = np.cross([0, 1, 0], backward)
    right /= np.linalg.norm(right)
    up = np.cross(backward, right)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, up, backward, position
    return matrix


def add_camera(gltf, matrix, field_of_view, near, far):
    """Adds a camera, and returns its index."""
    gltf.setdefault("cameras", []).append(
        {"type": "perspective", "perspective": {"yfov": field_of_view, "znear": near, "zfar": far}})
    gltf["scenes"][gltf.get("scene", 0)].setdefault("nodes", []).append(len(gltf["nodes"]))
    gltf["nodes"].append({"camera": len(gltf["cameras"]) - 1, "matrix": matrix.T.ravel().tolist()})
    return len(gltf["cameras"]) - 1


class Buffer:
    """Adds accessors to a glTF scene, with their data in a buffer of its own."""

    def __init__(self, gltf):
        self.gltf = gltf
        self.data = bytearray()
        self.number = len(gltf.setdefault("buffers", []))

    def add(self, values, kind, bounds=False):
        accessor = {"bufferView": len(self.gltf.setdefault("bufferViews", [])), "count": len(values), "type": kind,
                    "componentType": {"f": 5126, "u": 5125}[values.dtype.kind]}
        if bounds:
            flat = values.reshape(len(values), -1)
            accessor.update(min=flat.min(axis=0).tolist(), max=flat.max(axis=0).tolist())
        data = values.tobytes()
        self.gltf["bufferViews"].append({"buffer": self.number, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        self.gltf.setdefault("accessors", []).append(accessor)
        return len(self.gltf["accessors"]) - 1

    def finish(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.gltf["buffers"].append({"byteLength": len(self.data), "uri": uri})


# ---- Spheres


def sphere(rings=64, repeats=(12, 6)):
    """A unit sphere: positions, tangents, texture coordinates that repeat the texture, and indices."""
    v, u = np.meshgrid(np.linspace(0, 1, rings + 1), np.linspace(0, 1, 2 * rings + 1), indexing="ij")
    polar, azimuth = v.ravel() * np.pi, u.ravel() * 2 * np.pi
    positions = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), -np.sin(polar) * np.sin(azimuth)], axis=1)
    tangents = np.stack([-np.sin(azimuth), 0 * azimuth, -np.cos(azimuth), 0 * azimuth + 1], axis=1)
    coordinates = np.stack([u.ravel() * repeats[0], v.ravel() * repeats[1]], axis=1)
    row, column = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    a = (row * (2 * rings + 1) + column).ravel()
    b = a + 2 * rings + 1
    indices = np.stack([a, b, a + 1, a + 1, b, b + 1], axis=1).ravel()
    return (positions.astype("<f4"), tangents.astype("<f4"), coordinates.astype("<f4"), indices.astype("<u4"))


def bumps(size=64):
    """A normal map of smooth bumps, with slopes of up to 1."""
    x = (np.arange(size) + 0.5) / size * 2 * np.pi
    slope_x, slope_y = -np.cos(x)[None, :] * np.sin(x)[:, None], -np.sin(x)[None, :] * np.cos(x)[:, None]
    normal = np.stack([-slope_x, slope_y, np.ones((size, size))], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return np.round((normal * 0.5 + 0.5) * 255)


def write_spheres(folder, name, title, rows, columns, material_of):
    """Writes a sphere for each row and column, with the material that the labels of both give.

    Each sphere is farther away than the one before, and larger by as much. So they look as if they lay side by side,
    all seen from the same direction, and none is large enough in another one's view to change its light.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bumps.png").write_bytes(images.png_bytes(bumps()))
    gltf = {"asset": {"version": "2.0", "generator": "scripts/viewer/scenes.py"}, "scene": 0,
            "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
            "images": [{"uri": "bumps.png"}], "samplers": [{}], "textures": [{"source": 0, "sampler": 0}]}
    builder = Buffer(gltf)
    positions, tangents, coordinates, indices = sphere()
    attributes = {"POSITION": builder.add(positions, "VEC3", bounds=True), "NORMAL": builder.add(positions, "VEC3"),
                  "TANGENT": builder.add(tangents, "VEC4"), "TEXCOORD_0": builder.add(coordinates, "VEC2")}
    index_accessor = builder.add(indices, "SCALAR")
    builder.finish()
    first, step, cell = 1000.0, 40.0, 2.2
    for number, (row, column) in enumerate(np.ndindex(len(rows), len(columns))):
        material = material_of(rows[row], columns[column])
        material.setdefault("name", f"{rows[row]}, {columns[column]}")
        gltf["materials"].append(material)
        gltf["meshes"].append({"primitives": [{"attributes": attributes, "indices": index_accessor,
                                               "material": number}]})
        growth = 1 + number * step / first
        x, y = column - (len(columns) - 1) / 2, (len(rows) - 1) / 2 - row
        place = np.array([cell * x, cell * y, -first]) * growth
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]))
        gltf["nodes"].append({"mesh": number, "translation": place.tolist(), "scale": [growth] * 3})
    camera = add_camera(gltf, np.eye(4), 2 * math.atan(cell * len(rows) / 2 / first), first - 5, first * growth + 5)
    used = sorted({extension for material in gltf["materials"] for extension in material.get("extensions", {})})
    if used:
        gltf["extensionsUsed"] = used
    file = folder / "scene.gltf"
    file.write_text(json.dumps(gltf))
    size = (SPHERE_PIXELS * len(columns), SPHERE_PIXELS * len(rows))
    return Scene(name, file, size, gltf, camera, list(rows), list(columns), title)


def surface(colour, metallic, roughness, name=None, normal_scale=None, **extensions):
    material = {"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": metallic,
                                         "roughnessFactor": roughness}}
    if name:
        material["name"] = name
    if normal_scale:
        material["normalTexture"] = {"index": 0, "scale": normal_scale}
    if extensions:
        material["extensions"] = {f"KHR_materials_{key}": value for key, value in extensions.items()}
    return material


WHITE, GOLD, GREY, RED = (1, 1, 1), (0.9, 0.6, 0.25), (0.5, 0.5, 0.5), (0.7, 0.1, 0.08)
# The name of each sphere and its material.
LOBES = {
    "plastic 0.1": surface(RED, 0, 0.1),
    "plastic 0.5": surface(RED, 0, 0.5),
    "plastic 1": surface(RED, 0, 1),
    "ior 2.2": surface(RED, 0, 0.3, ior={"ior": 2.2}),
    "specular 0.3": surface(RED, 0, 0.3, specular={"specularFactor": 0.3}),
    "specular tint": surface(GREY, 0, 0.3, specular={"specularColorFactor": [2, 1, 0.4]}),
    "coat on red": surface(RED, 0, 0.6, clearcoat={"clearcoatFactor": 1}),
    "rough coat": surface(RED, 0, 0.6, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4}),
    "coat on metal": surface(GOLD, 1, 0.5, clearcoat={"clearcoatFactor": 1}),
    "coat, ior 2.2": surface(RED, 0, 0.6, clearcoat={"clearcoatFactor": 1}, ior={"ior": 2.2}),
    "sheen 0.3": surface(RED, 0, 0.8, sheen={"sheenColorFactor": [0.8, 0.8, 0.8], "sheenRoughnessFactor": 0.3}),
    "sheen 0.8": surface(RED, 0, 0.8, sheen={"sheenColorFactor": [0.8, 0.8, 0.8], "sheenRoughnessFactor": 0.8}),
    "film on metal": surface(GOLD, 1, 0.2, iridescence={"iridescenceFactor": 1, "iridescenceThicknessMaximum": 400}),
    "film on plastic": surface(GREY, 0, 0.2, iridescence={"iridescenceFactor": 1,
                                                          "iridescenceThicknessMaximum": 400}),
    "film, half metal": surface(GOLD, 0.5, 0.2, iridescence={"iridescenceFactor": 1,
                                                             "iridescenceThicknessMaximum": 400}),
    "diffuse transm.": surface(GREY, 0, 0.5, diffuse_transmission={"diffuseTransmissionFactor": 0.6,
                                                                   "diffuseTransmissionColorFactor": [0.3, 0.8, 0.4]}),
    "thin glass": surface(WHITE, 0, 0, transmission={"transmissionFactor": 1}),
    "thin glass 0.4": surface(WHITE, 0, 0.4, transmission={"transmissionFactor": 1}),
    "thin, half metal": surface(GOLD, 0.5, 0.3, transmission={"transmissionFactor": 1}),
    "glass": surface(WHITE, 0, 0, transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1.5}),
}


def write_all_spheres(folder):
    """Writes every grid of spheres below the folder."""
    roughness = (0, 0.25, 0.5, 0.75, 1)
    yield write_spheres(folder / "spheres_metallic", "spheres_metallic", "metallic down, roughness to the right",
                        (0, 0.25, 0.5, 0.75, 1), roughness, lambda m, r: surface(GOLD, m, r))
    yield write_spheres(folder / "spheres_anisotropy", "spheres_anisotropy",
                        "anisotropy strength down, roughness to the right", (0, 0.25, 0.5, 0.75, 1),
                        (0.1, 0.3, 0.5, 0.75),
                        lambda s, r: surface(GOLD, 1, r, anisotropy={"anisotropyStrength": s}))
    yield write_spheres(folder / "spheres_normals", "spheres_normals", "normal scale down, roughness to the right",
                        (0.5, 1, 2), (0, 0.04, 0.06, 0.2, 0.31, 0.6),
                        lambda scale, r: surface(WHITE, 1, r, normal_scale=scale))
    names = iter(LOBES)
    yield write_spheres(folder / "spheres_lobes", "spheres_lobes", "", range(4), range(5),
                        lambda *_: (lambda name: {**LOBES[name], "name": name})(next(names)))


# ---- Models


def read_model(path):
    """The JSON of a .gltf or .glb file, and the binary chunk of the latter."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data), None
    position, gltf, binary = 12, None, b""
    while position < len(data):
        size, kind = struct.unpack_from("<I4s", data, position)
        chunk = data[position + 8:position + 8 + size]
        if kind == b"JSON":
            gltf = json.loads(chunk)
        elif kind == b"BIN\0":
            binary = chunk
        position += 8 + size
    return gltf, binary


def write_model(folder, gltf, binary, source):
    """Writes the scene. Its other files are linked from the folder of the source."""
    folder.mkdir(parents=True, exist_ok=True)
    for item in gltf.get("buffers", []) + gltf.get("images", []):
        uri = item.get("uri", "data:")
        if not uri.startswith("data:"):
            link = folder / urllib.parse.unquote(uri)
            link.parent.mkdir(parents=True, exist_ok=True)
            if not os.path.lexists(link):
                link.symlink_to((source.parent / urllib.parse.unquote(uri)).resolve())
    text = json.dumps(gltf).encode()
    if binary is None:
        file = folder / "scene.gltf"
        file.write_bytes(text)
        return file
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    file = folder / "scene.glb"
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return file


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * node.get("scale", (1, 1, 1))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def bounds_of(gltf):
    """The corners of the boxes of all primitives, in world space."""
    scale_of = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
    points = []

    def visit(index, parent):
        node = gltf["nodes"][index]
        matrix = parent @ local_matrix(node)
        for primitive in gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            accessor = gltf["accessors"][primitive["attributes"]["POSITION"]]
            scale = scale_of[accessor["componentType"]] if accessor.get("normalized") else 1
            ends = np.array([accessor["min"], accessor["max"]]) / scale
            for corner in np.ndindex(2, 2, 2):
                points.append((matrix @ [*(ends[corner[axis], axis] for axis in range(3)), 1])[:3])
        for child in node.get("children", []):
            visit(child, matrix)

    for root in gltf["scenes"][gltf.get("scene", 0)]["nodes"]:
        visit(root, np.eye(4))
    points = np.array(points)
    return points.min(axis=0), points.max(axis=0)


def backward_of(extent):
    """The direction to the viewer: in front and a little above; a flat object shows its face."""
    directions = ((1, 0.1, 0.1), (0.1, 1, 0.5), (0.06, 0.1, 1))
    flat = [direction for axis, direction in enumerate(directions)
            if extent[axis] < 0.25 * min(extent[(axis + 1) % 3], extent[(axis + 2) % 3])]
    direction = np.array(flat[0] if flat else (0.4, 0.35, 1), float)
    return direction / np.linalg.norm(direction)


def fitted_camera(low, high, aspect):
    """The matrix of a camera that sees the whole box, and its distances to the planes in front and behind."""
    centre, backward = (low + high) / 2, backward_of(high - low)
    matrix = look_at(centre, backward)
    corners = np.array([[(low, high)[bit][axis] for axis, bit in enumerate(bits)] for bits in np.ndindex(2, 2, 2)])
    local = (corners - centre) @ matrix[:3, :3]
    slopes = np.array([aspect, 1]) * math.tan(FIELD_OF_VIEW / 2)
    distance = (np.abs(local[:, :2]) / slopes + local[:, 2:]).max() * 1.03
    matrix[:3, 3] = centre + distance * backward
    depth = np.abs(local[:, 2]).max() * 1.05
    return matrix, max(distance - depth, 1e-3 * distance), distance + depth


def write_with_camera(folder, name, source, size):
    """Writes a model with a camera that frames it, and without its punctual lights."""
    gltf, binary = read_model(source)
    for node in gltf["nodes"]:
        if node.get("extensions", {}).pop("KHR_lights_punctual", None) is not None and not node["extensions"]:
            del node["extensions"]
    low, high = bounds_of(gltf)
    matrix, near, far = fitted_camera(low, high, size[0] / size[1])
    camera = add_camera(gltf, matrix, FIELD_OF_VIEW, near, far)
    return Scene(name, write_model(folder / name, gltf, binary, source), size, gltf, camera)
