"""Compares the pictures of Glint and of the viewer by region, and writes the report as JSON, Markdown and PNG."""
import textwrap

import numpy as np

import images

BACKGROUND = 65535  # as in page.js
MIN_PIXELS = 12  # a smaller region is left out
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
FACING = 0.5  # cosine of the view from which a surface counts as facing

COLOURS = {"baseColorTexture", "emissiveTexture", "sheenColorTexture", "specularColorTexture",
           "diffuseTransmissionColorTexture", "diffuseTexture", "specularGlossinessTexture"}

# The known differences of the viewer from the specification, found by reading its source (version 1.1.0). Each has
# a sentence, and a function that says whether it concerns a material.
FAULTS = {
    "split-sum": (
        "The map is filtered as if it were seen head-on, and a table stands for the angle (Karis 2013). Glint's "
        "prefiltered lobes do the same.",
        lambda material: not has(material, "unlit")),
    "grazing-fresnel": (
        "The reflectance of dielectrics rises twice towards grazing angles: in the table, and in the F0 that the table "
        "scales (Fdez-Agüera 2019). Rims are too bright.",
        lambda material: metallic(material) < 1 and not has(material, "unlit")),
    "anisotropy": (
        "The map is filtered by the lesser roughness alone. The lobe is not stretched; only the normal is bent.",
        lambda material: value(material, "anisotropy", "anisotropyStrength", 0) > 0),
    "coat": (
        "The coat weighs the map by Schlick's Fresnel at the view's angle, without a table for its roughness, and "
        "takes the index of the base instead of 1.5.",
        lambda material: value(material, "clearcoat", "clearcoatFactor", 0) > 0),
    "sheen": (
        "The table of the lobe sums samples of the lobe without their density, takes the roughness for alpha, and has "
        "another visibility than the extension. The package lacks the table of the albedo that scales the base; the "
        "script computes it.",
        lambda material: any(value(material, "sheen", "sheenColorFactor", (0, 0, 0)))),
    "iridescence": (
        "The film's reflectance weighs the filtered map directly: no table, no light that bounces more than once.",
        lambda material: value(material, "iridescence", "iridescenceFactor", 0) > 0),
    "screen-space": (
        "What is behind glass is looked up in a picture of the opaque objects: one interface, nothing outside of the "
        "picture, nothing behind the camera, no glass behind glass. Roughness blurs that picture.",
        lambda material: value(material, "transmission", "transmissionFactor", 0) > 0),
    "transmission-weight": (
        "What a surface does not reflect weighs the transmitted light twice.",
        lambda material: value(material, "transmission", "transmissionFactor", 0) > 0),
    "transmission-colour": (
        "The texture of the diffuse transmission's colour is read as linear instead of sRGB.",
        lambda material: "diffuseTransmissionColorTexture" in extension(material, "diffuse_transmission")),
    "specular-glossiness": (
        "Metallic stays without a value, and the textures are read as linear instead of sRGB.",
        lambda material: has(material, "pbrSpecularGlossiness")),
    "shared-texture": (
        "A texture that serves as colour and as data is read for both as its first use asks, sRGB or linear.",
        lambda material: False),
    "no-scene-light": (
        "Only the map lights a surface. Objects neither hide it from each other nor reflect in each other. This "
        "concerns the traced pictures of models.",
        lambda material: False),
}


def extension(material, name):
    return material.get("extensions", {}).get(f"KHR_materials_{name}", {})


def has(material, name):
    return f"KHR_materials_{name}" in material.get("extensions", {})


def value(material, name, key, default):
    return extension(material, name).get(key, default)


def metallic(material):
    base = material.get("pbrMetallicRoughness", {})
    return 0 if "metallicRoughnessTexture" in base else base.get("metallicFactor", 1)


def textures_of(value):
    """Yields the index of each texture in a material, and whether it is a colour."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key.endswith("Texture") and isinstance(item, dict):
                yield item["index"], key in COLOURS
            else:
                yield from textures_of(item)


def shared_textures(gltf):
    """The textures that serve as colour and as data."""
    uses = {use for material in gltf.get("materials", []) for use in textures_of(material)}
    return {index for index, _ in uses if {(index, True), (index, False)} <= uses}


def faults_of(material, shared):
    names = [name for name, (_, concerns) in FAULTS.items() if concerns(material)]
    if any(index in shared for index, _ in textures_of(material)):
        names.append("shared-texture")
    return names


# ---- Numbers


def compare(mask, glint, viewer):
    """Compares the mean radiance of the pixels. Returns nothing where they are too few, or black in the viewer."""
    count = int(mask.sum())
    if count < MIN_PIXELS:
        return None
    ours, theirs = glint[mask].mean(axis=0, dtype=float), viewer[mask].mean(axis=0, dtype=float)
    if theirs.min() < 1e-4:
        return None
    difference = (np.abs(glint[mask] - viewer[mask]) @ LUMINANCE).mean(dtype=float)
    return {"pixels": count, "glint": ours.tolist(), "viewer": theirs.tolist(), "ratio": (ours / theirs).tolist(),
            "luminanceRatio": float(ours @ LUMINANCE / (theirs @ LUMINANCE)),
            "difference": float(difference / (theirs @ LUMINANCE))}


def masks_of(scene, regions, cosines, left_out):
    """The regions of a picture, by name: all objects, their facing and grazing parts, nine cells, each material."""
    inside = (regions > 0) & (regions < BACKGROUND) & ~np.isin(regions, [index + 1 for index in left_out])
    masks = {"objects": inside, "facing": inside & (cosines >= FACING), "grazing": inside & (cosines < FACING)}
    if not scene.rows and inside.any():
        ys, xs = np.nonzero(inside)
        for row in range(3):
            for column in range(3):
                cell = np.zeros_like(inside)
                bounds = [np.linspace(axis.min(), axis.max() + 1, 4).astype(int) for axis in (ys, xs)]
                cell[bounds[0][row]:bounds[0][row + 1], bounds[1][column]:bounds[1][column + 1]] = True
                masks[f"cell {row + 1},{column + 1}"] = inside & cell
    for index, material in enumerate(scene.materials):
        masks[f"material {index} {material.get('name', '')}".rstrip()] = inside & (regions == index + 1)
    return masks


def evaluate(scene, modes, viewer, regions, cosines):
    """Everything about a scene. `modes` holds Glint's pictures by name."""
    # Glint draws blended surfaces opaque, so they say nothing about shading.
    left_out = [i for i, material in enumerate(scene.materials) if material.get("alphaMode") == "BLEND"]
    shown = [material for i, material in enumerate(scene.materials) if (regions == i + 1).any() and i not in left_out]
    masks = masks_of(scene, regions, cosines, left_out)
    shared = shared_textures(scene.gltf)
    faults = [name for name in FAULTS if any(name in faults_of(material, shared) for material in shown)]
    if not scene.rows:
        faults.append("no-scene-light")
    background = regions == BACKGROUND
    return {
        "name": scene.name,
        "size": list(viewer.shape[1::-1]),
        "faults": faults,
        "leftOut": [scene.materials[i].get("name", str(i)) for i in left_out],
        "background": {mode: compare(background, picture, viewer) for mode, picture in modes.items()},
        "regions": {name: {mode: compare(mask, picture, viewer) for mode, picture in modes.items()}
                    for name, mask in masks.items()},
        "faultsOfMaterials": {f"material {i} {material.get('name', '')}".rstrip(): faults_of(material, shared)
                              for i, material in enumerate(scene.materials)},
    }


# ---- Markdown


def ratio(result, key="luminanceRatio"):
    return "" if result is None else f"{result[key]:.2f}"


def pair(region):
    return ", ".join(ratio(region[mode]) for mode in ("prefiltered", "traced") if region[mode])


def channels(result):
    return "" if result is None else " ".join(f"{number:.2f}" for number in result["ratio"])


def span(results):
    numbers = sorted(result["luminanceRatio"] for result in results if result)
    return f"{numbers[0]:.2f} to {numbers[-1]:.2f}" if numbers else ""


def scene_table(results):
    """One row for each scene."""
    lines = ["| scene | prefiltered, R G B | traced, R G B | facing | grazing | materials, prefiltered | difference | "
             "faults of the viewer |", "|---|---|---|---|---|---|---|---|"]
    for result in results:
        regions = result["regions"]
        objects = regions["objects"]
        materials = [region["prefiltered"] for name, region in regions.items() if name.startswith("material ")]
        pairs = [pair(regions[name]) for name in ("facing", "grazing")]
        lines.append(f"| {result['name']} | {channels(objects['prefiltered'])} | {channels(objects['traced'])} | "
                     f"{pairs[0]} | {pairs[1]} | {span(materials)} | {ratio(objects['prefiltered'], 'difference')} | "
                     f"{', '.join(result['faults'])} |")
    return lines


def grid_table(scene, result):
    """One cell for each sphere."""
    regions = [region for name, region in result["regions"].items() if name.startswith("material ")]

    if not scene.title:
        lines = ["| sphere | prefiltered, R G B | traced, R G B | faults of the viewer |", "|---|---|---|---|"]
        for region, material in zip(regions, scene.materials):
            lines.append(f"| {material['name']} | {channels(region['prefiltered'])} | {channels(region['traced'])} | "
                         f"{', '.join(faults_of(material, set()))} |")
        return lines
    lines = ["| | " + " | ".join(str(label) for label in scene.columns) + " |", "|---" * (len(scene.columns) + 1) + "|"]
    for number, label in enumerate(scene.rows):
        row = regions[number * len(scene.columns):(number + 1) * len(scene.columns)]
        lines.append(f"| {label} | " + " | ".join(pair(region) for region in row) + " |")
    return lines


def markdown(scenes, results, package):
    """The report as lines: how it was made, the tables, the faults."""
    size = next((result["size"] for scene, result in zip(scenes, results) if not scene.rows), None)
    sizes = (f"models at {size[0]} × {size[1]}, " if size else "") + "spheres at 64 × 64"
    head = (f"{package}; {sizes}. Every number is a ratio, Glint to the viewer; a pair is the ratio of luminance, "
            "prefiltered and traced. \"Difference\" is the mean of the absolute differences of luminance, over the "
            "mean luminance.")
    lines = textwrap.wrap(head, 120) + [""]
    models = [result for scene, result in zip(scenes, results) if not scene.rows]
    if models:
        lines += scene_table(models) + [""]
    for scene, result in zip(scenes, results):
        if scene.rows:
            lines += [f"**{scene.name}**" + (f": {scene.title}." if scene.title else "."), ""]
            lines += grid_table(scene, result) + [""]
    named = [name for name in FAULTS if any(name in result["faults"] for result in results)]
    lines += ["| fault of the viewer | |", "|---|---|"]
    lines += [f"| {name} | {FAULTS[name][0]} |" for name in FAULTS if name in named or name == "specular-glossiness"]
    return lines


# ---- Pictures


def to_pixels(radiance, scale):
    """8-bit sRGB of linear radiance."""
    light = np.clip(radiance * scale, 0, 1)
    curve = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.round(255 * curve)


def ratio_pixels(glint, viewer, inside):
    """Grey where both agree, red where Glint is brighter, blue where it is darker; full colour is a factor of 1.5."""
    exponent = np.log((glint @ LUMINANCE + 1e-4) / (viewer @ LUMINANCE + 1e-4)) / np.log(1.5)
    amount = np.clip(exponent, -1, 1)[..., None] * inside[..., None]
    grey, red, blue = (np.array(colour, float) for colour in ((200, 200, 200), (190, 20, 20), (30, 60, 200)))
    return grey + np.where(amount > 0, amount * (red - grey), -amount * (blue - grey))


def side_by_side(modes, viewer, inside):
    """A row of pictures: Glint prefiltered, Glint traced, the viewer, the ratio of the traced one to the viewer."""
    bright = np.quantile(viewer[inside] @ LUMINANCE, 0.95) if inside.any() else 1
    scale = 0.8 / max(bright, 1e-4)
    panels = [to_pixels(picture, scale) for picture in (modes["prefiltered"], modes["traced"], viewer)]
    panels.append(ratio_pixels(modes["traced"], viewer, inside))
    gap = np.full((viewer.shape[0], 4, 3), 255.0)
    row = [panels[0]]
    for panel in panels[1:]:
        row += [gap, panel]
    return np.concatenate(row, axis=1)
