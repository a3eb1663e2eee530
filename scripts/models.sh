#!/usr/bin/env bash
# Finds or fetches the scenes by others that tests, measurements and documents use.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'TEXT'
usage: eval "$(scripts/models.sh)"       sets GLINT_MODELS in this shell
       scripts/models.sh --list          prints each model, its repository, commit and path
       scripts/models.sh --check         compares checksums of the models with those that Glint was measured with

The folder is the first of
  1. the folder that the environment variable GLINT_MODELS names,
  2. ../shared/models,
  3. build/models, into which the models are fetched by git, each from its repository at its commit.
If a model is not available, the script names it, and tests that need it are skipped. Exits with 1 only if --check
finds a difference.
TEXT
}

# Each line is a model: folder, repository on GitHub, commit, path, certainty of the origin, checksum.
#   hash    a file of that repository has the checksum of the model's file
#   size    the .gltf at that commit and path is as long as the model's
#   path    the path exists at that commit; its contents were not compared
#   folder  the model's folder exists at that commit; this path in it was not seen
#   other   the .gltf at that commit is another version than the model's: the checksum differs
#   local   rebuilt by hand after KhronosGroup/glTF-Sample-Assets Models/DiffuseTransmissionTest; it can't be fetched
# The checksum is the first 16 digits of `sha256sum` over the folder's files in the order of their names. The folder
# "invalid", a selection of the validator's data, has none.
readonly kAssets=KhronosGroup/glTF-Sample-Assets
readonly kModels=KhronosGroup/glTF-Sample-Models
table() {
    cat <<TEXT
features/AlphaBlendModeTest $kAssets 7731bb9c3776a013324d5ae836e16d8a5a4a4ba5 Models/AlphaBlendModeTest/glTF path 94fa6e63f13d3599
features/AnisotropyBarnLamp-ktx2 $kAssets 3a1531e3f39ab20812ee05de6be1c5342983ac35 Models/AnisotropyBarnLamp/glTF-KTX-BasisU other 619040aef9653c1a
features/AnisotropyStrengthTest $kAssets 5bad5aaa0bbb5d0f9cdc934e626f27d0df1e79b8 Models/AnisotropyStrengthTest/glTF size e13b9e5e82e43fb8
features/Avocado-draco $kModels c038bf19bd13a1b78f2003b7c5a92a10a5235a6d 2.0/Avocado/glTF-Draco size fdbe17709dcbc578
features/ClearCoatTest $kModels ae3abc39240a35a8f71439345ed72132f68a1456 2.0/ClearCoatTest/glTF other 7b118089e2f4f616
features/DiffuseTransmissionTest-rebuilt - - - local 48bb78eedb30da68
features/Duck-quantized $kAssets ae2ae44d6b35650ad05b3c7cd9258559b4174d14 Models/Duck/glTF-Quantized other f07a5e53807ec1e0
features/EmissiveStrengthTest $kAssets a79b03e72fb37f532164892fb96143852fc89c4f Models/EmissiveStrengthTest/glTF folder cff9f9845f60f886
features/IridescenceSuzanne $kModels c038bf19bd13a1b78f2003b7c5a92a10a5235a6d 2.0/IridescenceSuzanne/glTF-Binary path 6b3361df2f624450
features/MeshPrimitiveModes $kModels 035cf0417991745bb0b0e6e657cecc082fff4fab 2.0/MeshPrimitiveModes/glTF-Embedded size 68e194ce79352cbb
features/MorphPrimitivesTest $kModels 052b009c89cf56d2a6d36bdac9769604a1f641a6 2.0/MorphPrimitivesTest/glTF-Binary path 44e1cffaa7b5f2b1
features/NegativeScaleTest $kModels 9b1e2c8f115a471efc2e2269cb188e769211ad10 2.0/NegativeScaleTest/glTF-Binary path 661e30ce2bde5343
features/NormalTangentMirrorTest $kModels c589f377c84b4767ef1532e51e92173f47b1eb42 2.0/NormalTangentMirrorTest/glTF size b6e50fc0e8ee6a3d
features/SheenChair $kModels f5384ae5c1847e52a5b2d3717cc4459caeaaf594 2.0/SheenChair/glTF size c1dc9c736d9c8473
features/SimpleSkin $kModels b0b14c8f1b3bce365a2e13e4451870004e139aec 2.0/SimpleSkin/glTF-Embedded other 45294daa08defc58
features/SimpleSparseAccessor $kAssets 53f1f7b54eddb3766cedf98f3be7879de949f2e0 Models/SimpleSparseAccessor/glTF-Embedded other 63e603b2fbc33d7c
features/SpecularTest $kModels 094748010f4c0615a6c6610a3f822d17034b85e9 2.0/SpecularTest/glTF-Binary path 796eea8c1c05dc38
features/TextureTransformMultiTest $kAssets d45d9667f1940cc15acf106c3ea219bf6ee1b6c6 Models/TextureTransformMultiTest/glTF-Binary path bc2075af68ddbdbf
features/TransmissionRoughnessTest $kModels dd9082554a09b20fd80e681aa5dd1567fcec4b3f 2.0/TransmissionRoughnessTest/glTF-Binary folder c63820f331bce0e6
features/box-textured-separate-webp CesiumGS/gltf-pipeline d40326f463ed78b9f3f2e8237d54e445e6c3f14c specs/data/2.0/extensions/EXT_texture_webp/box-textured-separate size f7e1a879ac468c16
features/dispersion-test $kAssets 70937cfc125655acaadd9034c999e05d8b4aa022 Models/DispersionTest/glTF-Binary hash dd0c293b8ee3a16d
features/pirate zeux/meshoptimizer 308d7b4bff0291786f6283531afbfbf34272b52a demo/pirate.glb path a9eb90c19119298d
invalid KhronosGroup/glTF-Validator 1be41dd1acdfe21ee9e577577bc2183e6861345a test/base/data size -
large/2CylinderEngine $kModels 0589a6c81e90244e16fa78ad798863fdb5dccfbe 2.0/2CylinderEngine/glTF-Binary path d98c01d0c28a6209
large/BrainStem $kModels c24544db53c54925fd8a948725c5ce4e9478b781 2.0/BrainStem/glTF-Binary path b1c9c114c8bf6bf7
large/MetalRoughSpheresNoTextures $kModels 82440c5a3d3da7a9397191bc36b289658f50aea2 2.0/MetalRoughSpheresNoTextures/glTF-Binary folder c9712a039b9ffb62
large/ReciprocatingSaw $kModels c24544db53c54925fd8a948725c5ce4e9478b781 2.0/ReciprocatingSaw/glTF-Binary path 12d6fcdcada19237
large/VC $kModels 3a23e287d204b894425987cd1e46e68cb1861d71 2.0/VC/glTF-Binary path 4bb27ae0a99a818e
TEXT
}

# checksum FOLDER: prints the checksum of the folder.
checksum() {
    (cd "$1" && find . -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -c1-16)
}

say() {
    printf 'models.sh: %s\n' "$*" >&2
}

# fetch FOLDER REPOSITORY COMMIT PATH: copies the path at that commit into the folder. Returns false if that
# is not possible.
fetch() {
    local folder=$1 repository=$2 commit=$3 path=$4 clone kept
    clone=$models/.git-${repository//\//-}
    if [[ ! -d $clone ]]; then
        git init -q "$clone"
        git -C "$clone" remote add origin "https://github.com/$repository"
        git -C "$clone" config core.sparseCheckout true
    fi
    # Only the files at the path are fetched from the commit.
    printf '/%s\n' "$path" >"$clone/.git/info/sparse-checkout"
    GIT_TERMINAL_PROMPT=0 timeout 300 git -C "$clone" fetch -q --depth 1 --filter=blob:none origin "$commit" 2>/dev/null &&
        GIT_TERMINAL_PROMPT=0 timeout 300 git -C "$clone" checkout -q --force FETCH_HEAD 2>/dev/null || return 1
    kept=$(mktemp -d "$models/.new-XXXXXX")
    if [[ -d $clone/$path ]]; then
        cp -r "$clone/$path/." "$kept"
    elif [[ -f $clone/$path ]]; then
        cp "$clone/$path" "$kept"
    else
        rmdir "$kept"
        return 1
    fi
    # In two repositories, the files have other names than the models.
    if [[ ! -e $kept/${folder##*/}.glb && $(find "$kept" -name '*.glb' | wc -l) -eq 1 ]]; then
        mv "$kept"/*.glb "$kept/${folder##*/}.glb"
    fi
    find "$kept" -name '*.report.json' -delete
    mkdir -p "$models/${folder%/*}"
    mv "$kept" "$models/$folder"
}

mode=${1:-}
if [[ $# -gt 1 || ! $mode =~ ^(|--list|--check|-h|--help)$ ]]; then
    usage >&2
    exit 2
fi
if [[ $mode == -h || $mode == --help ]]; then
    usage
    exit 0
fi
if [[ $mode == --list ]]; then
    table | awk '{ printf "%-40s https://github.com/%s %s %s (%s)\n", $1, $2, $3, $4, $5 }'
    exit 0
fi

fetches=false
if [[ -n ${GLINT_MODELS:-} ]]; then
    models=$GLINT_MODELS
elif [[ -d ../shared/models ]]; then
    models=../shared/models
else
    models=build/models
    mkdir -p "$models"
    fetches=true
fi

differs=false
unreachable=false
missing=()
while read -r folder repository commit path sure expected; do
    if [[ ! -d $models/$folder ]]; then
        if [[ $fetches == false || $unreachable == true || $sure == local ]]; then
            missing+=("$folder")
            continue
        fi
        say "fetching $folder"
        if ! fetch "$folder" "$repository" "$commit" "$path"; then
            if ! timeout 60 git ls-remote -q "https://github.com/$repository" HEAD >/dev/null 2>&1; then
                unreachable=true
            fi
            missing+=("$folder")
            continue
        fi
        [[ $expected == - || $(checksum "$models/$folder") == "$expected" ]] ||
            say "$folder is another version than the one that Glint was measured with"
    fi
    if [[ $mode == --check && $expected != - && $(checksum "$models/$folder") != "$expected" ]]; then
        say "$folder differs"
        differs=true
    fi
done < <(table)
[[ $unreachable == false ]] || say "github.com can't be reached: nothing more is fetched"
if [[ ${#missing[@]} -eq $(table | wc -l) ]]; then
    say "there is no model in $models; what needs one is left out"
elif [[ ${#missing[@]} -gt 0 ]]; then
    say "not in $models, and left out where it is needed: ${missing[*]}"
fi
if [[ $mode == --check ]]; then
    [[ $differs == false ]]
    exit
fi
printf 'export GLINT_MODELS=%q\n' "$(realpath -m "$models")"
