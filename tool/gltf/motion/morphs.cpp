#include "gltf/motion/morphs.h"

#include "gltf/document/accessor.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace glint::gltf {

namespace {

constexpr const char* kExportMorphs = "export the mesh again";
// Limits all nodes of a scene together. A thousand figures with a thousand targets each have a quarter of it.
constexpr std::uint64_t kMaxWeights = 1ULL << 22;

// Reads one attribute of a target if the target has it. Alpha that is missing does not change.
template <std::size_t N>
Status readDifferences(const PrimitiveSource& source, const Json& target, const std::string& pointer,
                       const char* attribute, std::size_t vertices,
                       std::vector<std::array<float, N>>& differences) {
    const Json* accessor = find(target, attribute);
    if (accessor == nullptr) {
        return okStatus();
    }
    Document& document = source.document;
    const std::string place = pointer + "/" + attribute;
    GLINT_TRY(const auto elements,
              readFloats(document, accessor->get<int>(), N == 4 ? Integers::Normalized : Integers::AsValues));
    if (elements.components < 3 || elements.components > N) {
        return document.error("attribute-type", place,
                              fmt::format("has {} components, not {}", elements.components, N),
                              kExportMorphs);
    }
    if (elements.count != vertices) {
        return document.error("attribute-count", place,
                              fmt::format("has {} elements, POSITION has {}", elements.count, vertices),
                              kExportMorphs);
    }
    differences.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        std::copy_n(&elements.values[elements.components * i], elements.components, differences[i].begin());
    }
    return okStatus();
}

// Reads the weights that a node or a mesh lists. There are as many as targets.
std::vector<double> readWeights(Document& document, const Json& list, std::size_t targets,
                                const std::string& pointer) {
    std::vector<double> weights;
    for (const Json& weight : list) {
        weights.push_back(weight.get<double>());
    }
    if (weights.size() != targets) {
        document.warn("morph-weights", pointer,
                      fmt::format("has {} weights for {} morph targets; missing ones are 0, others ignored",
                                  weights.size(), targets),
                      "give a weight for each target");
    }
    weights.resize(targets, 0.0);
    return weights;
}

std::size_t countTargets(const Mesh& mesh) {
    std::size_t count = 0;
    for (const Primitive& primitive : mesh.primitives) {
        count = std::max(count, primitive.targets.size());
    }
    return count;
}

// Warns of attributes that glTF lets a target change and that Glint does not change.
void warnOfUnread(Document& document, const Json& target, const std::string& pointer) {
    for (const auto& [name, accessor] : target.items()) {
        if (!name.starts_with('_') &&
            std::ranges::find(kTargetAttributes, name) == std::end(kTargetAttributes)) {
            document.warn("morph-attribute", pointer + "/" + name,
                          "Glint does not morph this attribute; its differences are left out",
                          "animate the texture's transform instead, or give each shape a mesh of its own");
        }
    }
}

}  // namespace

void compareTargets(Document& document, std::size_t mesh) {
    const Json& primitives = arrayMember(document.json()["meshes"][mesh], "primitives");
    for (std::size_t i = 1; i < primitives.size(); ++i) {
        const std::size_t first = arrayMember(primitives[0], "targets").size();
        const std::size_t own = arrayMember(primitives[i], "targets").size();
        if (own != first) {
            document.warn("morph-targets", fmt::format("/meshes/{}/primitives/{}", mesh, i),
                          fmt::format("has {} morph targets, and the mesh's first primitive has {}; the "
                                      "targets that one of them lacks don't change it",
                                      own, first),
                          "give all primitives of the mesh the same targets");
        }
    }
}

Status readTargets(const PrimitiveSource& source, Primitive& primitive) {
    const Json& targets = arrayMember(source.json, "targets");
    const std::size_t vertices = primitive.positions.size();
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const std::string pointer = fmt::format("{}/targets/{}", primitive.pointer, i);
        MorphTarget& target = primitive.targets.emplace_back();
        warnOfUnread(source.document, targets[i], pointer);
        const auto read = [&](const char* attribute, bool isBased, auto& differences) {
            if (!isBased && find(targets[i], attribute) != nullptr) {
                source.document.warn(
                    "morph-attribute", pointer + "/" + attribute,
                    "the primitive itself has no such attribute; its differences are left out",
                    kExportMorphs);
                return okStatus();
            }
            return readDifferences(source, targets[i], pointer, attribute, vertices, differences);
        };
        GLINT_TRY_DO(read("POSITION", true, target.positions));
        GLINT_TRY_DO(read("NORMAL", !primitive.normals.empty(), target.normals));
        GLINT_TRY_DO(read("TANGENT", !primitive.tangents.empty(), target.tangents));
        GLINT_TRY_DO(read("COLOR_0", !primitive.colors.empty(), target.colors));
    }
    return okStatus();
}

Status importMorphWeights(Document& document, Scene& scene) {
    const Json& meshes = arrayMember(document.json(), "meshes");
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        Mesh& mesh = scene.meshes[i];
        const std::size_t targets = countTargets(mesh);
        mesh.weights.assign(targets, 0.0);
        const Json* weights = find(meshes[i], "weights");
        if (weights != nullptr && targets > 0) {
            mesh.weights = readWeights(document, *weights, targets, fmt::format("/meshes/{}/weights", i));
        }
    }
    std::uint64_t total = 0;
    for (Node& node : scene.nodes) {
        if (node.mesh < 0) {
            continue;
        }
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        total += mesh.weights.size();
        if (total > kMaxWeights) {
            return document.error(
                "morph-limit", fmt::format("/nodes/{}", node.source),
                fmt::format("with its {} morph targets the nodes of the scene pass the limit of {} weights",
                            mesh.weights.size(), kMaxWeights),
                "leave out targets, or split the scene");
        }
        node.restWeights = mesh.weights;
        const Json* weights =
            find(document.json()["nodes"][static_cast<std::size_t>(node.source)], "weights");
        if (weights != nullptr && !mesh.weights.empty()) {
            node.restWeights = readWeights(document, *weights, mesh.weights.size(),
                                           fmt::format("/nodes/{}/weights", node.source));
        }
        node.weights = node.restWeights;
    }
    return okStatus();
}

}  // namespace glint::gltf
