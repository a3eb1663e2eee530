"""Renders scenes with Glint and with the Khronos glTF viewer and reports the ratios.

scripts/viewer_compare.sh runs it.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import numpy as np

import browser
import images
import report
import scenes

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "materials.md"
BEGIN, END = "<!-- begin viewer -->", "<!-- end viewer -->"
MODES = {
    "prefiltered": ["--effects", "none", "--spp", "16"],
    "traced": ["--effects", "reflection,refraction", "--max-roughness", "1", "--spp", "64"],
}
BACKGROUND_DIFFERENCE = 0.01  # at most; more means that cameras or maps differ

# How far the luminance of each sphere may be from the viewer's, where no fault of the viewer is that large.
BOUNDS = {"spheres_metallic": 0.1, "spheres_normals": 0.1}

# Models that the viewer reads, and that have materials. Draco and meshopt compression need further packages.
MODELS = [
    "AlphaBlendModeTest/AlphaBlendModeTest.gltf",
    "AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf",
    "AnisotropyStrengthTest/AnisotropyStrengthTest.gltf",
    "ClearCoatTest/ClearCoatTest.gltf",
    "DiffuseTransmissionTest-rebuilt/DiffuseTransmissionTest-rebuilt.gltf",
    "Duck-quantized/Duck.gltf",
    "EmissiveStrengthTest/EmissiveStrengthTest.gltf",
    "IridescenceSuzanne/IridescenceSuzanne.glb",
    "MorphPrimitivesTest/MorphPrimitivesTest.glb",
    "NegativeScaleTest/NegativeScaleTest.glb",
    "NormalTangentMirrorTest/NormalTangentMirrorTest.gltf",
    "SheenChair/SheenChair.gltf",
    "SpecularTest/SpecularTest.glb",
    "TextureTransformMultiTest/TextureTransformMultiTest.glb",
    "TransmissionRoughnessTest/TransmissionRoughnessTest.glb",
    "box-textured-separate-webp/box-textured-separate.gltf",
    "dispersion-test/dispersion-test.glb",
]
# The pictures of the document.
PICTURES = ["spheres_metallic", "spheres_anisotropy", "spheres_normals", "TextureTransformMultiTest",
            "AnisotropyStrengthTest"]


def say(message):
    print(f"viewer_compare.sh: {message}", file=sys.stderr, flush=True)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--package", type=pathlib.Path, required=True, help="the folder of the viewer's package")
    parser.add_argument("--package-name", required=True)
    parser.add_argument("--glint", type=pathlib.Path, required=True)
    parser.add_argument("--models", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--size", default="320x240", help="of the models' pictures")
    parser.add_argument("--scenes", default="", help="only these, separated by commas")
    parser.add_argument("--document", action="store_true", help="also write the table and pictures of the document")
    return parser.parse_args()


def write_scenes(options):
    """Writes every wanted scene."""
    wanted = set(filter(None, options.scenes.split(",")))
    found = [scene for scene in scenes.write_all_spheres(options.out / "scenes")
             if not wanted or scene.name in wanted]
    size = tuple(int(number) for number in options.size.split("x"))
    for path in MODELS:
        source = options.models / "features" / path
        name = source.parent.name
        if wanted and name not in wanted:
            continue
        if not source.exists():
            say(f"{name} is left out: {source} is not there")
            continue
        found.append(scenes.write_with_camera(options.out / "scenes", name, source, size))
    unknown = wanted - {scene.name for scene in found}
    if unknown:
        say(f"no such scene: {', '.join(sorted(unknown))}")
        sys.exit(2)
    return found


def render_glint(options, scene, mode):
    """Renders a scene and returns the linear picture."""
    output = scene.file.parent / f"{mode}.exr"
    subprocess.run([options.glint, "render", scene.file, "-o", output, "--size", f"{scene.size[0]}x{scene.size[1]}",
                    "--camera", str(scene.camera), "--environment", options.out / "map.hdr", "--no-sun", "--quiet",
                    *MODES[mode]], check=True)
    return images.read_exr(output)


def render_viewer(viewer, scene):
    """Renders a scene and returns the linear picture, the regions and the cosines of the view."""
    viewer.use_scene(f"scenes/{scene.file.parent.name}/{scene.file.name}")
    picture = viewer.render(scene.camera, *scene.size)
    np.savez_compressed(scene.file.parent / "viewer.npz", radiance=picture[0], regions=picture[1], cosines=picture[2])
    return picture


def compare_scene(options, viewer, scene):
    """Renders a scene with both and writes its picture. Returns its result, and what is wrong with it."""
    begin = time.monotonic()
    theirs, regions, cosines = render_viewer(viewer, scene)
    between = time.monotonic()
    modes = {mode: render_glint(options, scene, mode) for mode in MODES}
    result = report.evaluate(scene, modes, theirs, regions, cosines)
    inside = (regions > 0) & (regions < report.BACKGROUND)
    picture = report.side_by_side(modes, theirs, inside)
    (options.out / f"{scene.name}.png").write_bytes(images.png_bytes(picture))
    say(f"{scene.name}: viewer {between - begin:.0f} s, Glint {time.monotonic() - between:.0f} s, ratio "
        f"{report.channels(result['regions']['objects']['prefiltered'])} prefiltered, "
        f"{report.channels(result['regions']['objects']['traced'])} traced")
    return result, mismatches(scene, result, modes)


def mismatches(scene, result, modes):
    """Says what keeps a comparison from meaning something. The backgrounds depend on camera and map alone."""
    lines = [f"the background differs by {100 * part['difference']:.1f} % ({mode}): cameras or maps do not match"
             for mode, part in result["background"].items() if part and part["difference"] > BACKGROUND_DIFFERENCE]
    lines += [f"Glint's picture has pixels that are not finite ({mode})" for mode, picture in modes.items()
              if not np.isfinite(picture).all()]
    compared = sum(region["prefiltered"] is not None for name, region in result["regions"].items()
                   if name.startswith("material "))
    expected = len(scene.rows) * len(scene.columns) if scene.rows else 1
    if compared < expected:
        lines.append(f"the viewer shows {compared} of at least {expected} materials")
    return [f"{result['name']}: {line}" for line in lines]


def outliers(result):
    """Says how many spheres are farther from the viewer than their bound, and which is the farthest."""
    bound = BOUNDS.get(result["name"])
    lines = []
    for mode in MODES:
        ratios = {name.partition(" ")[2]: region[mode]["luminanceRatio"] for name, region in result["regions"].items()
                  if bound and name.startswith("material ") and region[mode]}
        far = {name: ratio for name, ratio in ratios.items() if abs(ratio - 1) > bound}
        if far:
            name = max(far, key=lambda key: abs(far[key] - 1))
            lines.append(f"{result['name']}, {mode}: {len(far)} of {len(ratios)} spheres are more than {bound:.0%} "
                         f"from the viewer's luminance; {name} has {far[name]:.2f} times as much")
    return lines


def update_document(lines, pictures):
    """Replaces the text between the markers, and the pictures."""
    before, found, rest = DOCUMENT.read_text(encoding="utf-8").partition(BEGIN)
    _, found_end, after = rest.partition(END)
    if not found or not found_end:
        raise SystemExit(f"viewer_compare.sh: {DOCUMENT} lacks the lines that the table goes between")
    DOCUMENT.write_text(before + BEGIN + "\n" + "\n".join(lines).rstrip() + "\n" + END + after, encoding="utf-8")
    for name, data in pictures.items():
        (DOCUMENT.parent / "images" / f"viewer_{name}.jpg").write_bytes(data)


def main():
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    scenes.write_environment(options.out / "map.hdr")
    scenes.write_sheen_albedo(options.out / "sheen_albedo.png")
    wanted = write_scenes(options)
    results, done, failures, outside = [], [], [], []
    with browser.Viewer(options.package, options.out) as viewer:
        begin = time.monotonic()
        viewer.use_environment("map.hdr", "sheen_albedo.png")
        say(f"the viewer has filtered the map in {time.monotonic() - begin:.0f} s")
        for scene in wanted:
            try:
                result, wrong = compare_scene(options, viewer, scene)
            except (browser.ViewerError, subprocess.CalledProcessError) as error:
                failures.append(f"{scene.name}: {error}")
                continue
            failures += wrong
            outside += outliers(result)
            results.append(result)
            done.append(scene)
        pictures = {scene.name: viewer.to_jpeg(f"{scene.name}.png") for scene in done
                    if options.document and scene.name in PICTURES}
    lines = report.markdown(done, results, options.package_name)
    (options.out / "viewer.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    faults = {name: text for name, (text, _) in report.FAULTS.items()}
    data = {"viewer": options.package_name, "modes": MODES, "faults": faults, "scenes": results}
    (options.out / "viewer.json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    if options.document and not failures:
        update_document(lines, pictures)
    say(f"{len(results)} scenes in {options.out}: viewer.md, viewer.json, pictures")
    for failure in failures + outside:
        say(f"error: {failure}")
    sys.exit(1 if failures or outside else 0)


if __name__ == "__main__":
    main()
