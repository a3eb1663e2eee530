#!/usr/bin/env bash
# Renders real scenes on the device and in double precision on the CPU (glint_oracle), compares the two, and writes the
# tables of docs/accuracy.md. Build first. Missing models are left out with a message.
#
#   scripts/oracle_scenes.sh [MODELS [SAMPLES]]   the folder of scripts/models.sh; samples a pixel of the converged
#                                                 pictures, default 256
#
# Environment: GLINT_BIN, the folder of the programs (build/release/bin); SIZE, pixels (96x54).
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
models=${1:-${GLINT_MODELS:-../shared/models}}
samples=${2:-256}
bin=${GLINT_BIN:-build/release/bin}
size=${SIZE:-96x54}
work=out/oracle_scenes
document=docs/accuracy.md
if [[ $# -gt 2 || ! $samples =~ ^[1-9][0-9]*$ ]]; then
    echo "usage: scripts/oracle_scenes.sh [MODELS [SAMPLES]]" >&2
    exit 2
fi
if [[ ! -x $bin/glint || ! -x $bin/glint_oracle || ! -x $bin/gallery ]]; then
    echo "oracle_scenes.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
rm -rf "$work"
mkdir -p "$work"
"$bin/gallery" "$work/gallery" > /dev/null
scenes=("$work/gallery/gallery.gltf")
for name in features/{ClearCoatTest/ClearCoatTest.gltf,SpecularTest/SpecularTest.glb} \
    features/AnisotropyStrengthTest/AnisotropyStrengthTest.gltf features/SheenChair/SheenChair.gltf \
    features/TextureTransformMultiTest/TextureTransformMultiTest.glb features/NegativeScaleTest/NegativeScaleTest.glb \
    features/NormalTangentMirrorTest/NormalTangentMirrorTest.gltf \
    features/EmissiveStrengthTest/EmissiveStrengthTest.gltf features/IridescenceSuzanne/IridescenceSuzanne.glb \
    features/AlphaBlendModeTest/AlphaBlendModeTest.gltf \
    features/DiffuseTransmissionTest-rebuilt/DiffuseTransmissionTest-rebuilt.gltf \
    features/TransmissionRoughnessTest/TransmissionRoughnessTest.glb features/dispersion-test/dispersion-test.glb \
    large/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb large/2CylinderEngine/2CylinderEngine.glb \
    large/ReciprocatingSaw/ReciprocatingSaw.glb; do
    if [[ -f $models/$name ]]; then
        scenes+=("$models/$name")
    else
        echo "oracle_scenes.sh: $models has no $name" >&2
    fi
done

render() {
    "$bin/glint" render "$@" --size "$size" --sky 1 --effects shadow,reflection --max-roughness 0.05 --mirror-roughness 0.05 \
        --texture-lod mip0 --alpha tested --hit-record full --quiet
}
# Turns off the device's default, and filters textures in single precision. Only llvmpipe has such a choice.
in_floats() {
    GALLIVM_PERF=no_aos_sampling "$@"
}
oracle() {
    "$bin/glint_oracle" "$@" --size "$size" --texels "$work/texels.exr" > /dev/null
}

"$bin/glint_oracle" --write-texels "$work"
"$bin/glint" render "$work/texels.gltf" --size 16x16 --texture-lod mip0 --quiet -o "$work/texels.exr"
for scene in "${scenes[@]}"; do
    name=$(basename "${scene%.*}")
    out=$work/$name
    render "$scene" -o "$out-centre.exr"
    in_floats render "$scene" -o "$out-floats.exr"
    in_floats render "$scene" -o "$out-mean.exr" --spp "$samples"
    oracle "$scene" --against "$out-centre.exr" --filtered "$out-floats.exr" --json "$out-centre.json" \
        -o "$out-truth.png" --diff "$out-centre.png"
    oracle "$scene" --against "$out-floats.exr" --device-texels --json "$out-floats.json"
    oracle "$scene" --against "$out-mean.exr" --spp 1024 --device-spp "$samples" --json "$out-mean.json" \
        --diff "$out-mean.png"
    oracle "$scene" --against "$out-mean.exr" --spp "$samples" --device-points --device-texels \
        --device-spp "$samples" --json "$out-points.json"
    echo "$name" >> "$work/names"
    echo "oracle_scenes.sh: $name done" >&2
done

python3 - "$work" "$document" "$size" "$samples" << 'PYTHON'
import json
import pathlib
import sys

work, document, size, samples = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]


def read(name, kind):
    return json.loads((work / f"{name}-{kind}.json").read_text())


def signed(result):
    return f"{result['signedMean']:+.1e} ± {result['signedError']:.0e}"


def causes(result):
    return ", ".join(f"{name} {cause['pixels']}" for name, cause in result["causes"].items())


names = (work / "names").read_text().split()
lines = [f"{size} pixels. At their centres, one sample:", "",
         "| scene | RMSE | relMSE | median | 99.9 % | largest | signed mean | off | why | median¹ | 99.9 %¹ | off¹ |",
         "|---|---|---|---|---|---|---|---|---|---|---|---|"]
for name in names:
    centre, floats = read(name, "centre"), read(name, "floats")
    assert centre["notFinite"] == 0, name
    lines.append(f"| {name} | {centre['rmse']:.1e} | {centre['relMse']:.1e} | {centre['median']:.1e} | "
                 f"{centre['p999']:.1e} | {centre['largest']:.1e} | {signed(centre)} | {centre['differing']} | "
                 f"{causes(centre)} | {floats['median']:.1e} | {floats['p999']:.1e} | {floats['differing']} |")
lines += ["", f"Converged, {samples} samples:", "",
          "| scene | RMSE | of independent samples | relMSE | median | 99.9 % | largest | signed mean | off | RMSE² | "
          "relMSE² | median² | 99.9 %² | largest² | signed mean² | off² |",
          "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"]
for name in names:
    mean, points = read(name, "mean"), read(name, "points")
    lines.append(f"| {name} | {mean['rmse']:.1e} | {mean['expectedRmse']:.1e} | {mean['relMse']:.1e} | "
                 f"{mean['median']:.1e} | {mean['p999']:.1e} | {mean['largest']:.1e} | {signed(mean)} | "
                 f"{mean['differing']} | {points['rmse']:.1e} | {points['relMse']:.1e} | {points['median']:.1e} | "
                 f"{points['p999']:.1e} | {points['largest']:.1e} | {signed(points)} | {points['differing']} |")

begin, end = "<!-- begin oracle -->", "<!-- end oracle -->"
text = document.read_text()
if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
    sys.exit(f"oracle_scenes.sh: {document} lacks the lines that the tables go between")
document.write_text(text[:text.index(begin) + len(begin)] + "\n" + "\n".join(lines) + "\n" + text[text.index(end):])
PYTHON
