#include "gltf/import.h"

#include "gltf/derived_tangents.h"
#include "gltf/document/document.h"
#include "gltf/expected_hits.h"
#include "gltf/losses.h"
#include "gltf/materials.h"
#include "gltf/meshes.h"
#include "gltf/motion/animations.h"
#include "gltf/motion/instancing.h"
#include "gltf/motion/morphs.h"
#include "gltf/motion/nodes.h"
#include "gltf/motion/skinning.h"
#include "gltf/texture_content.h"
#include "gltf/trusted_textures.h"
#include "gltf/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace glint::gltf {

namespace {

using gltf::Document;

bool usesMaterial(const Scene& scene, std::size_t material) {
    return std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) {
        return std::ranges::any_of(mesh.primitives, [&](const Primitive& primitive) {
            return static_cast<std::size_t>(primitive.material) == material;
        });
    });
}

Status fillScene(Document& document, Scene& scene) {
    GLINT_TRY_DO(importMaterials(document, scene));
    GLINT_TRY_DO(importNodes(document, scene));
    std::vector<bool> placed(gltf::arraySize(document.json(), "/meshes"));
    for (const Node& node : scene.nodes) {
        if (node.mesh >= 0) {
            placed[static_cast<std::size_t>(node.mesh)] = true;
        }
    }
    GLINT_TRY_DO(importMeshes(document, placed, scene));
    GLINT_TRY_DO(importMorphWeights(document, scene));
    GLINT_TRY_DO(importSkins(document, scene));
    GLINT_TRY_DO(importInstances(document, scene));
    importAnimations(document, scene);
    settleColors(document, scene);
    GLINT_TRY_DO(applyVariant(document, scene));
    if (usesMaterial(scene, scene.materials.size())) {
        scene.defaultMaterial = static_cast<int>(scene.materials.size());
        scene.materials.emplace_back(*document.options().materialModel).name = "default";
    }
    warnOfNothingDrawn(document, scene);
    warnOfMissingInputs(document, scene);
    scene.trustsTextures = document.options().trustTextures;
    if (scene.trustsTextures) {
        GLINT_TRY_DO(readTextureContent(document.options(), scene));
        mergeSameTextures(scene);
        for (Mesh& mesh : scene.meshes) {
            for (Primitive& primitive : mesh.primitives) {
                primitive.derivesTangents = derivesTangents(primitive);
            }
        }
        foldConstantTextures(scene);
    }
    scene.files = document.files();
    scene.warnings.insert(scene.warnings.begin(), document.warnings().begin(), document.warnings().end());
    return okStatus();
}

}  // namespace

Result<Scene> importScene(const std::filesystem::path& path, const ImportOptions& options) {
    // The JSON library and the allocator throw exceptions, which must not leave this function.
    try {
        GLINT_TRY(const auto document, Document::open(path, options));
        Scene scene;
        scene.path = path.string();
        GLINT_TRY_DO(fillScene(*document, scene));
        return scene;
    } catch (const std::bad_alloc&) {
        return makeError("out-of-memory", path.string(), "the scene does not fit into memory",
                         "simplify the scene, or use a machine with more memory");
    } catch (const std::exception& exception) {
        return makeError("gltf", path.string(), exception.what(),
                         "export the scene again; the Khronos glTF validator explains the rules");
    }
}

std::string sceneLabel(const Scene& scene, std::size_t number) {
    const std::string& name = scene.scenesInFile[number];
    return name.empty() ? std::to_string(number) : fmt::format("{} \"{}\"", number, name);
}

SceneInFile sceneInFile(const Scene& scene) {
    const int index = scene.sceneInFile;
    return {index, index < 0 ? "" : scene.scenesInFile[static_cast<std::size_t>(index)]};
}

namespace {

// Returns a bit for each of the model's attributes that the primitive has.
std::uint64_t attributesOf(const Scene& scene, const Primitive& primitive) {
    if (primitive.attributes.empty()) {
        return 0;
    }
    const std::vector<materials::VertexAttribute>& known =
        scene.materials[static_cast<std::size_t>(primitive.material)].model().attributes;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const bool given = std::ranges::find(primitive.attributes, known[i].gltf, &VertexValues::name) !=
                           primitive.attributes.end();
        bits |= std::uint64_t{given} << i;
    }
    return bits;
}

}  // namespace

materials::PrimitiveInputs inputsOf(const Scene& scene, std::size_t mesh, std::size_t index) {
    const Primitive& primitive = scene.meshes[mesh].primitives[index];
    materials::PrimitiveInputs input;
    input.mesh = static_cast<int>(mesh);
    input.primitive = static_cast<int>(index);
    input.material = primitive.material;
    input.hasNormals = !primitive.normals.empty();
    input.hasTangents = !primitive.tangents.empty();
    input.hasTexCoords0 = !primitive.texCoords0.empty();
    input.hasTexCoords1 = !primitive.texCoords1.empty();
    input.colors = primitive.colorContent;
    input.attributes = attributesOf(scene, primitive);
    input.seen = primitive.seen;
    input.derivesTangents = primitive.derivesTangents;
    return input;
}

std::vector<materials::PrimitiveInputs> planningInputs(const Scene& scene) {
    std::vector<materials::PrimitiveInputs> inputs;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        for (std::size_t i = 0; i < scene.meshes[mesh].primitives.size(); ++i) {
            inputs.push_back(inputsOf(scene, mesh, i));
        }
    }
    expectHits(scene, inputs);
    return inputs;
}

}  // namespace glint::gltf
