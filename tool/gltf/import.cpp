#include "gltf/import.h"

#include "gltf/document/document.h"
#include "gltf/material_set.h"
#include "gltf/planning_inputs.h"
#include "gltf/steps.h"
#include "gltf/trusted_textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::gltf {

// ---- What the file asks for and a picture can't show ----

namespace {

const Mesh& meshOf(const Scene& scene, const Node& node) {
    return scene.meshes[static_cast<std::size_t>(node.mesh)];
}

// Lists the first few primitives without triangles, with their reasons.
std::string leftOutText(const Scene& scene) {
    constexpr std::size_t kShown = 3;
    std::string text;
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) {
        for (const std::string& reason : mesh.leftOut) {
            text += ++count > kShown ? "" : (count > 1 ? "; " : "") + reason;
        }
    }
    return count > kShown ? fmt::format("{}; and {} more", text, count - kShown) : text;
}

// Returns an empty text if a node draws a triangle.
std::string whyNothingIsDrawn(const Scene& scene) {
    bool hasMesh = false;
    bool isShown = false;
    bool isPlaced = false;
    for (const Node& node : scene.nodes) {
        const bool has = node.mesh >= 0;
        const bool shows = has && node.canShow;
        const bool places = shows && (node.instancing < 0 ||
                                      scene.instancings[static_cast<std::size_t>(node.instancing)].count > 0);
        if (places && !meshOf(scene, node).primitives.empty()) {
            return {};
        }
        hasMesh = hasMesh || has;
        isShown = isShown || shows;
        isPlaced = isPlaced || places;
    }
    if (scene.nodes.empty()) {
        return "it has no nodes";
    }
    if (!hasMesh) {
        return fmt::format("none of its {} nodes has a mesh", scene.nodes.size());
    }
    if (!isShown) {
        return "each node with a mesh is hidden at all times (KHR_node_visibility)";
    }
    return isPlaced ? "no primitive has a triangle: " + leftOutText(scene) : "its nodes have no instances";
}

// Returns whether a scene of the file has a node with a mesh.
bool hasMeshes(const Document& document, std::size_t scene) {
    const tinygltf::Model& model = document.model();
    std::vector<bool> known(model.nodes.size());
    bool found = false;
    visitTrees(document, model.scenes[scene].nodes, [&](std::size_t node) {
        found = found || model.nodes[node].mesh >= 0;
        const bool isNew = !known[node] && !found;
        known[node] = true;
        return isNew;
    });
    return found;
}

// One texture or lobe of a material that primitives lack the input of.
struct Loss {
    std::string reason;
    std::string primitive;  // the first
    std::size_t count = 0;
};

// Warns if no node draws a triangle, and says why: "nothing-drawn". Meshes and animations must have been
// imported.
void warnOfNothingDrawn(Document& document, const Scene& scene) {
    const std::string why = whyNothingIsDrawn(scene);
    if (why.empty()) {
        return;
    }
    std::string hint = "export the scene again, with triangles that a node draws";
    for (std::size_t i = scene.scenesInFile.size(); i-- > 0;) {
        if (static_cast<int>(i) != scene.sceneInFile && hasMeshes(document, i)) {
            hint = fmt::format("choose the scene {} by --scene {}", sceneLabel(scene, i), i);
        }
    }
    document.warn("nothing-drawn", scene.sceneInFile < 0 ? "" : fmt::format("/scenes/{}", scene.sceneInFile),
                  "a picture shows no surface: " + why, hint);
}

// Warns of each texture and lobe that a material asks for and a drawn primitive lacks the input of:
// "input-missing".
void warnOfMissingInputs(Document& document, const Scene& scene) {
    std::vector<bool> drawn(scene.meshes.size());
    for (const Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            drawn[static_cast<std::size_t>(node.mesh)] = true;
        }
    }
    std::map<std::pair<int, int>, Loss> losses;  // by material and feature
    // Primitives of one material with the same attributes lack the same.
    using Attributes = std::tuple<int, bool, bool, bool, bool, std::uint64_t>;
    std::map<Attributes, std::vector<std::pair<int, std::string>>> known;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        for (std::size_t i = 0; drawn[mesh] && i < scene.meshes[mesh].primitives.size(); ++i) {
            const materials::PrimitiveInputs inputs = inputsOf(scene, mesh, i);
            const materials::Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
            const auto [found, isNew] =
                known.try_emplace({inputs.material, inputs.hasNormals, inputs.hasTangents,
                                   inputs.hasTexCoords0, inputs.hasTexCoords1, inputs.attributes});
            if (isNew) {
                found->second = materials::lostInputs(material, inputs);
            }
            for (const auto& [feature, reason] : found->second) {
                Loss& loss = losses[{inputs.material, feature}];
                if (loss.count++ == 0) {
                    loss.reason = reason;
                    loss.primitive = scene.meshes[mesh].primitives[i].pointer;
                }
            }
        }
    }
    for (const auto& [place, loss] : losses) {
        const auto& [material, feature] = place;
        const std::vector<materials::Feature>& features =
            scene.materials[static_cast<std::size_t>(material)].model().features;
        const std::string more = loss.count > 1 ? fmt::format(" and {} more", loss.count - 1) : "";
        document.warn(
            "input-missing", fmt::format("/materials/{}", material),
            fmt::format("{} is left out on {}{}: {}", features[static_cast<std::size_t>(feature)].name,
                        loss.primitive, more, loss.reason),
            "give the mesh what it lacks, or let the material read what the mesh has");
    }
}

// ---- The import ----

bool usesMaterial(const Scene& scene, std::size_t material) {
    return std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) {
        return std::ranges::any_of(mesh.primitives, [&](const Primitive& primitive) {
            return static_cast<std::size_t>(primitive.material) == material ||
                   (!primitive.variantMaterials.empty() &&
                    static_cast<std::size_t>(primitive.variantMaterials.back()) == material);
        });
    });
}

std::string rangeText(const materials::Parameter& parameter, const materials::ValueInterval& range) {
    return parameter.type->kind == materials::NumberKind::Truth ? "false or true"
           : parameter.type->kind == materials::NumberKind::Name
               ? fmt::format("{}", fmt::join(parameter.names, " or "))
           : parameter.type->isAddress() ? "any"
                                         : fmt::format("{:.4g} to {:.4g}", range.low, range.high);
}

// Planning takes the whole range of values that a program may set; pictures show those of the list.
Status addRunTimeValues(const Document& document, Scene& scene) {
    for (const EditedValue& edited : document.edited()) {
        const materials::Material& rest = scene.materials[static_cast<std::size_t>(edited.material)];
        if (scene.animatedMaterials.empty() || scene.animatedMaterials.back().material != edited.material) {
            scene.animatedMaterials.push_back({edited.material, rest, rest, {}});
            scene.animatedMaterials.back().planned.ranges = rangesOf(rest);
        }
        AnimatedMaterial& animated = scene.animatedMaterials.back();
        const materials::Parameter& parameter =
            rest.model().parameters[static_cast<std::size_t>(edited.parameter)];
        const materials::ValueInterval& range = edited.range;
        for (int i = 0; i < parameter.numbers; ++i) {
            const auto place = static_cast<std::size_t>(parameter.first) + static_cast<std::size_t>(i);
            if (rest.values[place] < range.low || rest.values[place] > range.high) {
                return document.error(
                    "material-list", edited.pointer,
                    fmt::format("{} is {}, which is not within {} to {}", parameter.declared,
                                rest.values[place], range.low, range.high),
                    "give it a value within the range, or widen the range");
            }
            animated.planned.ranges[place] = range;
        }
        animated.edited.push_back(fmt::format("{} {}", parameter.name, rangeText(parameter, range)));
    }
    return okStatus();
}

// Pictures show white textures and level normals where a program gives the texels.
void fillRunTimeImages(const ImportOptions& options, Scene& scene) {
    if (!options.decodeImages && !options.keepImageFiles) {
        return;
    }
    for (Image& image : scene.images) {
        if (image.isAtRunTime) {
            image.width = image.height = 1;
            image.pixels = {255, 255, 255, 255};
        }
    }
    for (const materials::Material& material : scene.materials) {
        for (const auto& [slot, info] : material.textures) {
            if (info.texture < 0) {
                continue;
            }
            Image& image = scene.images[static_cast<std::size_t>(
                scene.textures[static_cast<std::size_t>(info.texture)].image)];
            if (!image.isAtRunTime) {
                continue;
            }
            if (material.readsOf(static_cast<int>(slot)).isNormals) {
                image.pixels = {128, 128, 255, 255};
            }
            image.dimension = material.model().textures[slot].dimension;
            image.layers = image.dimension == package::TextureEntry::Dimension::Cube ? 6 : 1;
            image.pixels.resize(4 * static_cast<std::size_t>(image.layers), 255);
        }
    }
}

Status fillScene(Document& document, Scene& scene) {
    GLINT_TRY_DO(importMaterials(document, scene));
    GLINT_TRY_DO(importNodes(document, scene));
    std::vector<bool> placed(document.model().meshes.size());
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
    GLINT_TRY_DO(addRunTimeValues(document, scene));
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
    fillRunTimeImages(document.options(), scene);
    scene.files = document.files();
    scene.warnings.insert(scene.warnings.begin(), document.warnings().begin(), document.warnings().end());
    return okStatus();
}

// `Source` is a path, or a set of materials with one.
template <typename Source>
Result<Scene> readScene(const Source& source, const std::filesystem::path& path,
                        const ImportOptions& options) {
    // The JSON library and the allocator throw exceptions, which must not leave this function.
    try {
        GLINT_TRY(const auto document, Document::open(source, options));
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

}  // namespace

Result<Scene> importScene(const std::filesystem::path& path, const ImportOptions& options) {
    return readScene(path, path, options);
}

Result<Scene> importMaterials(const MaterialSet& set, const ImportOptions& options) {
    return readScene(set, set.path, options);
}

}  // namespace glint::gltf
