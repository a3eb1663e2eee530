"""Makes synthetic scenes that ask for given features, which benchmarks/measure_merge_model.py and benchmarks/measure_merge.sh
compile.

A wish is a set of features by their names in the feature table, "clearcoat" or "normalTexture". complete() adds
the features that a feature needs to be in a key.
"""
import base64
import json
import struct
import zlib

EXTENSION_TEXTURES = {
    "clearcoatTexture": "clearcoat",
    "clearcoatRoughnessTexture": "clearcoat",
    "clearcoatNormalTexture": "clearcoat",
    "sheenColorTexture": "sheen",
    "sheenRoughnessTexture": "sheen",
    "anisotropyTexture": "anisotropy",
    "specularTexture": "specular",
    "specularColorTexture": "specular",
    "iridescenceTexture": "iridescence",
    "iridescenceThicknessTexture": "iridescence",
    "transmissionTexture": "transmission",
    "thicknessTexture": "volume",
    "diffuseTransmissionTexture": "diffuse_transmission",
    "diffuseTransmissionColorTexture": "diffuse_transmission",
}
TEXTURES = ["baseColorTexture", "metallicRoughnessTexture", "normalTexture", "occlusionTexture", "emissiveTexture"]
TEXTURES += EXTENSION_TEXTURES
# With these values the lobe is in the key.
LOBES = {
    "unlit": ("unlit", {}),
    "specularGlossiness": ("pbrSpecularGlossiness", {"glossinessFactor": 0.6}),
    "ior": ("ior", {"ior": 1.4}),
    "specular": ("specular", {"specularFactor": 0.8}),
    "clearcoat": ("clearcoat", {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.2}),
    "sheen": ("sheen", {"sheenColorFactor": [0.8, 0.7, 0.6], "sheenRoughnessFactor": 0.5}),
    "anisotropy": ("anisotropy", {"anisotropyStrength": 0.7}),
    "iridescence": (
        "iridescence",
        {"iridescenceFactor": 1, "iridescenceThicknessMinimum": 100, "iridescenceThicknessMaximum": 500},
    ),
    "transmission": ("transmission", {"transmissionFactor": 0.8}),
    "diffuseTransmission": ("diffuse_transmission", {"diffuseTransmissionFactor": 0.6}),
    "volume": ("volume", {"thicknessFactor": 0.3}),
    "attenuation": ("volume", {"attenuationColor": [0.6, 0.8, 0.7], "attenuationDistance": 0.5}),
    "dispersion": ("dispersion", {"dispersion": 0.3}),
}
INPUTS = ["emissiveStrength", "texCoord1", "textureTransform", "vertexColor", "normals", "tangents", "doubleSided"]
INPUTS += ["clearcoatSharesNormal", "partialMetal"]
NEEDS = {
    "attenuation": ["volume"],
    "dispersion": ["volume", "transmission"],
    "clearcoatSharesNormal": ["clearcoat", "normalTexture"],
    "thicknessTexture": ["attenuation", "volume"],
    "textureTransform": ["baseColorTexture"],
    "texCoord1": ["baseColorTexture"],
    "tangents": ["normals", "normalTexture"],
}
LOBE_OF_EXTENSION = {extension: lobe for lobe, (extension, _) in LOBES.items() if lobe != "attenuation"}
FEATURES = [*LOBES, *TEXTURES, *INPUTS]


def complete(wish):
    """The wish with what its features need, so that each is in the key."""
    wish = set(wish)
    for feature in sorted(wish):
        wish.update(NEEDS.get(feature, []))
        if feature in EXTENSION_TEXTURES:
            wish.add(LOBE_OF_EXTENSION[EXTENSION_TEXTURES[feature]])
    if wish & {"attenuation", "volume", "dispersion"}:
        wish.add("volume")
        if not wish & {"transmission", "diffuseTransmission"}:
            wish.add("transmission")
    return frozenset(wish)


def make_material(wish, name, roughness=0.4):
    """A glTF material; texture 0 is the base's normals, 1 the coat's, 2 everything else."""
    base = {"metallicFactor": 0.5 if "partialMetal" in wish else 0, "roughnessFactor": roughness}
    extensions = {}
    for lobe in sorted(wish & LOBES.keys()):
        extension, values = LOBES[lobe]
        extensions.setdefault(f"KHR_materials_{extension}", {}).update(values)
    material = {"name": name, "pbrMetallicRoughness": base, "extensions": extensions, "emissiveFactor": [0.1, 0.1, 0.1]}
    shares = "clearcoatSharesNormal" in wish
    textures = [t for t in TEXTURES if t in wish or (shares and t == "clearcoatNormalTexture")]
    for place, texture in enumerate(textures):
        info = {"index": 0 if texture == "normalTexture" or shares and texture == "clearcoatNormalTexture" else 2}
        if texture == "clearcoatNormalTexture" and not shares:
            info["index"] = 1
        if "texCoord1" in wish and place == 0:
            info["texCoord"] = 1
        if "textureTransform" in wish and place == 0:
            info["extensions"] = {"KHR_texture_transform": {"offset": [0.1, 0.2], "scale": [2, 2]}}
        if texture in ("baseColorTexture", "metallicRoughnessTexture"):
            base[texture] = info
        elif texture in EXTENSION_TEXTURES:
            extensions[f"KHR_materials_{EXTENSION_TEXTURES[texture]}"][texture] = info
        else:
            material[texture] = info
    if "pbrSpecularGlossiness" in {LOBES[lobe][0] for lobe in wish & LOBES.keys()}:
        slots = {"baseColorTexture": "diffuseTexture", "metallicRoughnessTexture": "specularGlossinessTexture"}
        for ours, theirs in slots.items():
            if ours in base:
                extensions["KHR_materials_pbrSpecularGlossiness"][theirs] = base.pop(ours)
    if "emissiveStrength" in wish:
        extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": 2}
    if "doubleSided" in wish:
        material["doubleSided"] = True
    return material


def png_bytes(pixel):
    """An image of two RGB pixels as a file: this one and another. Constant textures would leave the materials."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 2, 0, 0, 0))
    return data + chunk(b"IDAT", zlib.compress(bytes([0, *pixel, *(channel ^ 64 for channel in pixel)]))) + chunk(b"IEND", b"")


def png(pixel):
    """The same image as a data URI."""
    return "data:image/png;base64," + base64.b64encode(png_bytes(pixel)).decode()


# This is a unit square in z = 0 that faces +z: first the attributes of four vertices, then the indices.
ATTRIBUTES = {
    "POSITION": ("VEC3", [(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]),
    "NORMAL": ("VEC3", [(0, 0, 1)] * 4),
    "TANGENT": ("VEC4", [(1, 0, 0, 1)] * 4),
    "TEXCOORD_0": ("VEC2", [(0, 1), (1, 1), (1, 0), (0, 0)]),
    "TEXCOORD_1": ("VEC2", [(0, 1), (1, 1), (1, 0), (0, 0)]),
    "COLOR_0": ("VEC3", [(1, 0.9, 0.8), (0.9, 1, 0.8), (0.8, 0.9, 1), (1, 1, 0.9)]),
}


def make_scene(wishes, placements=None, mirror=None):
    """A scene of one square a wish, as glTF with everything inline.

    placements: (wish, x, y, z, scale) of each square; by default one each in a row. mirror: a square of a smooth metal,
    (x, y, z, scale), turned towards -z, for rays to start from.
    """
    buffer, views, accessors = bytearray(), [], []

    def add(kind, component, count, data, **more):
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        buffer.extend(data + b"\0" * (-len(data) % 4))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
        return len(accessors) - 1

    ids = {}
    for name, (kind, values) in ATTRIBUTES.items():
        data = b"".join(struct.pack(f"<{len(v)}f", *v) for v in values)
        more = {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0]} if name == "POSITION" else {}
        ids[name] = add(kind, 5126, 4, data, **more)
    indices = add("SCALAR", 5123, 6, struct.pack("<6H", 0, 1, 2, 0, 2, 3))

    def attributes(wish):
        names = ["POSITION", "TEXCOORD_0", "TEXCOORD_1"]
        names += ["NORMAL"] if "normals" in wish else []
        names += ["TANGENT"] if "tangents" in wish else []
        names += ["COLOR_0"] if "vertexColor" in wish else []
        return {name: ids[name] for name in names}

    wishes = list(wishes)
    materials = [make_material(wish, f"{i}: {' '.join(sorted(wish)) or 'plain'}") for i, wish in enumerate(wishes)]
    meshes = [
        {"primitives": [{"attributes": attributes(wish), "indices": indices, "material": i}]}
        for i, wish in enumerate(wishes)
    ]
    if placements is None:
        placements = [(wish, i, 0, 0, 1) for i, wish in enumerate(wishes)]
    nodes = [
        {"mesh": wishes.index(wish), "translation": [x, y, z], "scale": [scale] * 3} for wish, x, y, z, scale in placements
    ]
    if mirror is not None:
        x, y, z, scale = mirror
        smooth = {"metallicFactor": 1, "roughnessFactor": 0}
        materials.append({"name": "mirror", "pbrMetallicRoughness": smooth})
        primitive = {"attributes": attributes({"normals"}), "indices": indices, "material": len(materials) - 1}
        meshes.append({"primitives": [primitive]})
        nodes.append({"mesh": len(meshes) - 1, "translation": [x, y, z], "scale": [scale] * 3, "rotation": [0, 1, 0, 0]})
        nodes.append({"camera": 0, "translation": [x, y, z - scale], "rotation": [0, 1, 0, 0]})
    used = {e for m in materials for e in m.get("extensions", {})} | {"KHR_texture_transform"}
    scene = {
        "asset": {"version": "2.0", "generator": "benchmarks/merge_scenes.py"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "textures": [{"source": i, "sampler": 0} for i in range(3)],
        "samplers": [{}],
        "images": [{"uri": png(pixel)} for pixel in ((128, 128, 255), (128, 140, 250), (200, 180, 160))],
        "accessors": accessors,
        "bufferViews": views,
        "extensionsUsed": sorted(used),
        "buffers": [
            {"byteLength": len(buffer), "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}
        ],
    }
    if mirror is not None:
        scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}]
    return json.dumps(scene)
