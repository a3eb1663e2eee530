#!/usr/bin/env bash
# Renders real scenes with glint render, and all of light transport in double precision on the CPU (glint_oracle
# --bounces), and writes a table of their differences to out/oracle_paths/table.md. Every pixel that is off by more than
# 1e-3 is counted with its cause. Build first. Missing models are left out with a message.
#
#   scripts/oracle_paths.sh [MODELS [SAMPLES [BOUNCES]]]   the folder of scripts/models.sh; samples a pixel of the truth,
#                                                          default 1024; the bounces of both, default unlimited
#
# Environment: GLINT_BIN, the folder of the programs (build/release/bin); GLINT, the command glint; SIZE, pixels (48x27);
# DEVICE_SAMPLES, samples of glint render (256); ONLY, a regular expression for names of scenes; KEEP=1 keeps what an
# earlier run has written, so that a run which was stopped goes on.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
models=${1:-${GLINT_MODELS:-../shared/models}}
samples=${2:-1024}
bounces=${3:-unlimited}
bin=${GLINT_BIN:-build/release/bin}
glint=${GLINT:-$bin/glint}
size=${SIZE:-48x27}
device_samples=${DEVICE_SAMPLES:-256}
only=${ONLY:-.}
keep=${KEEP:-}
work=out/oracle_paths
if [[ $# -gt 3 || ! $samples =~ ^[1-9][0-9]*$ || ! $bounces =~ ^([0-9]+|unlimited)$ ]]; then
    echo "usage: scripts/oracle_paths.sh [MODELS [SAMPLES [BOUNCES]]]" >&2
    exit 2
fi
if [[ ! -x $glint || ! -x $bin/glint_oracle || ! -x $bin/gallery ]]; then
    echo "oracle_paths.sh: build first: cmake --preset release && cmake --build --preset release" >&2
    exit 1
fi
[[ -n $keep ]] || rm -rf "$work"
mkdir -p "$work"
rm -f "$work/names"
"$bin/gallery" "$work/gallery" > /dev/null
# The same scene once more, whose lights have a size.
cp "$work/gallery/gallery.gltf" "$work/gallery/gallery-sizes.gltf"
scenes=("$work/gallery/gallery.gltf" "$work/gallery/gallery-sizes.gltf")
for name in features/{ClearCoatTest/ClearCoatTest.gltf,SpecularTest/SpecularTest.glb} \
    features/AnisotropyStrengthTest/AnisotropyStrengthTest.gltf features/SheenChair/SheenChair.gltf \
    features/TextureTransformMultiTest/TextureTransformMultiTest.glb features/NegativeScaleTest/NegativeScaleTest.glb \
    features/NormalTangentMirrorTest/NormalTangentMirrorTest.gltf \
    features/EmissiveStrengthTest/EmissiveStrengthTest.gltf features/IridescenceSuzanne/IridescenceSuzanne.glb \
    features/AlphaBlendModeTest/AlphaBlendModeTest.gltf \
    features/DiffuseTransmissionTest-rebuilt/DiffuseTransmissionTest-rebuilt.gltf \
    features/TransmissionRoughnessTest/TransmissionRoughnessTest.glb features/dispersion-test/dispersion-test.glb \
    features/AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf features/Avocado-draco/Avocado.gltf \
    large/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb large/2CylinderEngine/2CylinderEngine.glb \
    large/ReciprocatingSaw/ReciprocatingSaw.glb; do
    if [[ -f $models/$name ]]; then
        scenes+=("$models/$name")
    else
        echo "oracle_paths.sh: $models has no $name" >&2
    fi
done

# Every approximation is off, as in the reference of glint bench. All light of a surface goes through rays: nothing of
# the sky counts without them. llvmpipe filters textures in floats.
paths=(--effects "auto,indirect-diffuse" --max-roughness 1 --mirror-roughness 0 --max-interfaces 64
    --bounces "$bounces")
export GALLIVM_PERF=no_aos_sampling
"$bin/glint_oracle" --write-texels "$work"
"$glint" render "$work/texels.gltf" --size 16x16 --texture-lod mip0 --quiet -o "$work/texels.exr"
for scene in "${scenes[@]}"; do
    name=$(basename "${scene%.*}")
    out=$work/$name
    [[ $name =~ $only ]] || continue
    # The oracle takes radians.
    device_lights=()
    truth_lights=()
    if [[ $name == *-sizes ]]; then
        device_lights=(--light-radius 0.1 --sun-angle 11.4591559)
        truth_lights=(--light-radius 0.1 --sun-angle 0.2)
    fi
    if [[ ! -s $out.exr ]]; then
        "$glint" render "$scene" --size "$size" --sky 1 --spp "$device_samples" --texture-lod mip0 --strategy uber \
            --merge all --batch-effects "${paths[@]}" "${device_lights[@]}" --quiet -o "$out-rendered.exr"
        mv "$out-rendered.exr" "$out.exr"
    fi
    if [[ ! -s $out.json ]]; then
        "$bin/glint_oracle" "$scene" --size "$size" --bounces "$bounces" --samples "$samples" \
            "${truth_lights[@]}" --texels "$work/texels.exr" --device-texels --against "$out.exr" \
            --device-spp "$device_samples" --json "$out.json" -o "$out-truth.png" --diff "$out-difference.png" --list 20 > "$out.txt"
    fi
    echo "$name" >> "$work/names"
    echo "oracle_paths.sh: $name done" >&2
done

python3 - "$work" "$size" "$samples" "$device_samples" "$bounces" "${paths[*]}" << 'PYTHON'
import json
import pathlib
import sys

work, size, samples, device_samples, bounces, paths = pathlib.Path(sys.argv[1]), *sys.argv[2:]
lines = [f"{size} pixels; truth: --bounces {bounces}, {samples} samples; glint render {paths}, "
         f"{device_samples} samples.", "",
         "| scene | mean of the truth | device over truth | over that which reflects below surfaces | RMSE | of samples "
         "alone | relMSE | off by > 1e-3 | why |", "|---|---|---|---|---|---|---|---|---|"]
for name in (work / "names").read_text().split():
    truth = json.loads((work / f"{name}.json").read_text())
    result = truth["difference"]
    assert result["notFinite"] == 0, name
    causes = ", ".join(f"{cause} {values['pixels']}" for cause, values in result["causes"].items())
    lines.append(f"| {name} | {truth['mean']:.4f} ± {truth['standardError'] / result['pixels'] ** 0.5:.0e} | "
                 f"{result['bias']:+.2%} ± {result['biasError']:.2%} | {result['reflectingBias']:+.2%} | "
                 f"{result['rmse']:.1e} | "
                 f"{result['expectedRmse']:.1e} | {result['relMse']:.1e} | {result['differing']} | {causes} |")
(work / "table.md").write_text("\n".join(lines) + "\n")
print("\n".join(lines))
PYTHON
