// Imports what nodes do with their meshes: morph targets with their weights, skins with the influences of
// joints, and many placements of one mesh (EXT_mesh_gpu_instancing).
#include "base/vectors.h"
#include "gltf/document/accessor.h"
#include "gltf/document/validate.h"
#include "gltf/motion/transform.h"
#include "gltf/steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

// ---- Morph targets ----

namespace {

constexpr const char* kExportMorphs = "export the mesh again";
// Limits all nodes of a scene together. A thousand figures with a thousand targets each have a quarter of it.
constexpr std::uint64_t kMaxWeights = 1ULL << 22;

using Target = std::map<std::string, int>;  // accessors by attribute

// Reads one attribute of a target if the target has it. Alpha that is missing does not change.
template <std::size_t N>
Status readDifferences(Document& document, const Target& target, const std::string& pointer,
                       const char* attribute, std::size_t vertices,
                       std::vector<std::array<float, N>>& differences) {
    const int accessor = accessorOf(target, attribute);
    if (accessor < 0) {
        return okStatus();
    }
    const std::string place = pointer + "/" + attribute;
    GLINT_TRY(const auto elements,
              readFloats(document, accessor, N == 4 ? Integers::Normalized : Integers::AsValues));
    GLINT_TRY_DO(toVectors(document, elements, 3, 0.0F, place, kExportMorphs, differences));
    if (elements.count != vertices) {
        return document.error("attribute-count", place,
                              fmt::format("has {} elements, POSITION has {}", elements.count, vertices),
                              kExportMorphs);
    }
    return okStatus();
}

// Reads the weights that a node or a mesh lists. There are as many as targets.
std::vector<double> readWeights(Document& document, std::vector<double> weights, std::size_t targets,
                                const std::string& pointer) {
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
void warnOfUnread(Document& document, const Target& target, const std::string& pointer) {
    for (const auto& [name, accessor] : target) {
        if (!name.starts_with('_') &&
            std::ranges::find(kTargetAttributes, name) == std::end(kTargetAttributes)) {
            document.warn("morph-attribute", fmt::format("{}/{}", pointer, name),
                          "Glint does not morph this attribute; its differences are left out",
                          "animate the texture's transform instead, or give each shape a mesh of its own");
        }
    }
}

}  // namespace

void compareTargets(Document& document, std::size_t mesh) {
    const std::vector<tinygltf::Primitive>& primitives = document.model().meshes[mesh].primitives;
    for (std::size_t i = 1; i < primitives.size(); ++i) {
        const std::size_t first = primitives[0].targets.size();
        const std::size_t own = primitives[i].targets.size();
        if (own != first) {
            document.warn("morph-targets", fmt::format("/meshes/{}/primitives/{}", mesh, i),
                          fmt::format("has {} morph targets, and the mesh's first primitive has {}; the "
                                      "targets that one of them lacks don't change it",
                                      own, first),
                          "give all primitives of the mesh the same targets");
        }
    }
}

Status readTargets(Document& document, const tinygltf::Primitive& file, Primitive& primitive) {
    const std::vector<Target>& targets = file.targets;
    const std::size_t vertices = primitive.positions.size();
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const std::string pointer = fmt::format("{}/targets/{}", primitive.pointer, i);
        MorphTarget& target = primitive.targets.emplace_back();
        warnOfUnread(document, targets[i], pointer);
        const auto read = [&](const char* attribute, bool isBased, auto& differences) {
            if (!isBased && targets[i].contains(attribute)) {
                document.warn("morph-attribute", pointer + "/" + attribute,
                              "the primitive itself has no such attribute; its differences are left out",
                              kExportMorphs);
                return okStatus();
            }
            return readDifferences(document, targets[i], pointer, attribute, vertices, differences);
        };
        GLINT_TRY_DO(read("POSITION", true, target.positions));
        GLINT_TRY_DO(read("NORMAL", !primitive.normals.empty(), target.normals));
        GLINT_TRY_DO(read("TANGENT", !primitive.tangents.empty(), target.tangents));
        GLINT_TRY_DO(read("COLOR_0", !primitive.colors.empty(), target.colors));
    }
    return okStatus();
}

Status importMorphWeights(Document& document, Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        Mesh& mesh = scene.meshes[i];
        const std::size_t targets = countTargets(mesh);
        mesh.weights.assign(targets, 0.0);
        const std::vector<double>& weights = document.model().meshes[i].weights;
        if (!weights.empty() && targets > 0) {
            mesh.weights = readWeights(document, weights, targets, fmt::format("/meshes/{}/weights", i));
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
        const std::vector<double>& weights = fileNode(document, node).weights;
        if (!weights.empty() && !mesh.weights.empty()) {
            node.restWeights = readWeights(document, weights, mesh.weights.size(),
                                           fmt::format("/nodes/{}/weights", node.source));
        }
        node.weights = node.restWeights;
    }
    return okStatus();
}

// ---- Skins ----

namespace {

constexpr const char* kExportSkin = "export the scene again";

// A joint that a vertex follows, in the order of the file, before the weights are normalised.
struct Influence {
    std::uint16_t joint = 0;
    float weight = 0.0F;
};

// Returns the influences of one vertex that matter. A weight that is negative or NaN counts as 0.
std::vector<Influence> influencesOf(const std::vector<InfluenceSet>& sets, std::size_t vertex) {
    std::vector<Influence> influences;
    for (const InfluenceSet& set : sets) {
        for (std::size_t i = 0; i < 4; ++i) {
            const float weight = set.weights[vertex][i];
            if (weight > 0.0F && std::isfinite(weight)) {
                influences.push_back({static_cast<std::uint16_t>(set.joints[vertex][i]), weight});
            }
        }
    }
    return influences;
}

// Whether a weight is negative, or two weights above 0 are those of one joint. glTF forbids both.
bool breaksRules(const std::vector<InfluenceSet>& sets, std::size_t vertex,
                 const std::vector<Influence>& influences) {
    for (auto one = influences.begin(); one != influences.end(); ++one) {
        if (std::any_of(one + 1, influences.end(),
                        [&](const Influence& other) { return other.joint == one->joint; })) {
            return true;
        }
    }
    return std::ranges::any_of(sets, [&](const InfluenceSet& set) {
        return std::ranges::any_of(set.weights[vertex], [](float weight) { return weight < 0.0F; });
    });
}

double sumOf(const std::vector<Influence>& influences) {
    double sum = 0.0;
    for (const Influence& influence : influences) {
        sum += influence.weight;
    }
    return sum;
}

// Returns the inverse bind matrices of a skin, or identities if it gives none.
Result<std::vector<Matrix4>> readInverseBinds(Document& document, int accessor, const std::string& pointer,
                                              std::size_t joints) {
    if (accessor < 0) {
        return std::vector<Matrix4>(joints, identity());
    }
    GLINT_TRY(auto matrices, readMatrices(document, accessor));
    const std::string place = pointer + "/inverseBindMatrices";
    if (matrices.size() < joints) {
        return document.error("skin-matrices", place,
                              fmt::format("has {} matrices for {} joints", matrices.size(), joints),
                              kExportSkin);
    }
    matrices.resize(joints);
    if (!std::ranges::all_of(matrices, fitsFloat)) {
        return document.error("skin-matrices", place, "has elements that are no finite numbers", kExportSkin);
    }
    std::size_t odd = 0;
    for (Matrix4& matrix : matrices) {
        odd += clearProjection(matrix) ? 0 : 1;
    }
    if (odd > 0) {
        document.warn("skin-matrices", place,
                      fmt::format("the last row of {} matrices is not 0 0 0 1, and is ignored", odd),
                      kExportSkin);
    }
    return matrices;
}

// Returns nothing if a joint is not in the scene.
Result<std::optional<Skin>> readSkin(Document& document, std::size_t index, const NodeNumbers& numbers) {
    const tinygltf::Skin& file = document.model().skins[index];
    const std::string pointer = fmt::format("/skins/{}", index);
    Skin skin;
    skin.name = file.name;
    const std::vector<int>& joints = file.joints;
    if (joints.empty() || joints.size() > kMaxJoints) {
        return document.error("skin-joints", pointer + "/joints",
                              fmt::format("has {} joints; 1 to {} are possible", joints.size(), kMaxJoints),
                              kExportSkin);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const int node = numbers.inScene(joints[i]);
        if (node < 0) {
            document.warn("skin-joint-outside", fmt::format("{}/joints/{}", pointer, i),
                          "is a node outside of the scene; the skin is left out and its meshes keep their "
                          "bind pose",
                          "put the joints into the scene that draws the mesh");
            return std::optional<Skin>();
        }
        skin.joints.push_back(node);
    }
    GLINT_TRY(skin.inverseBinds,
              readInverseBinds(document, file.inverseBindMatrices, pointer, joints.size()));
    return std::optional(std::move(skin));
}

// Checks that every joint that the mesh's vertices follow is in the skin.
Status checkJoints(const Document& document, const Mesh& mesh, const Skin& skin) {
    for (const Primitive& primitive : mesh.primitives) {
        const SkinInfluences& influences = primitive.influences;
        for (std::size_t i = 0; i < influences.joints.size(); ++i) {
            if (influences.weights[i] > 0.0F && influences.joints[i] >= skin.joints.size()) {
                return document.error(
                    "skin-joint-range", primitive.pointer + "/attributes/JOINTS_0",
                    fmt::format("vertex {} follows joint {}, the skin has {}", i / influences.count,
                                influences.joints[i], skin.joints.size()),
                    "export the mesh again with its skin");
            }
        }
    }
    return okStatus();
}

}  // namespace

SkinInfluences joinInfluences(Document& document, const std::string& pointer,
                              const std::vector<InfluenceSet>& sets) {
    SkinInfluences joined;
    const std::size_t vertices = sets.empty() ? 0 : sets.front().joints.size();
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
        joined.count = std::max(joined.count, influencesOf(sets, vertex).size());
    }
    joined.count = vertices > 0 ? std::max<std::size_t>(joined.count, 1) : 0;
    // Rounding eight weights to 8 bits each causes a smaller error.
    constexpr double kTolerance = 0.02;
    std::size_t off = 0;
    std::size_t broken = 0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
        std::vector<Influence> influences = influencesOf(sets, vertex);
        broken += breaksRules(sets, vertex, influences) ? 1 : 0;
        const double sum = sumOf(influences);
        off += std::abs(sum - 1.0) > kTolerance ? 1 : 0;
        if (influences.empty()) {
            influences.push_back({static_cast<std::uint16_t>(sets.front().joints[vertex][0]), 1.0F});
        }
        influences.resize(joined.count, {influences.front().joint, 0.0F});
        for (const Influence& influence : influences) {
            joined.joints.push_back(influence.joint);
            joined.weights.push_back(sum > 0.0 ? static_cast<float>(influence.weight / sum)
                                               : influence.weight);
        }
    }
    if (broken > 0) {
        document.warn("skin-weights", pointer + "/attributes/WEIGHTS_0",
                      fmt::format("{} vertices have a negative weight, which counts as 0, or several weights "
                                  "for one joint, which are added",
                                  broken),
                      "export the mesh again with one weight of 0 or more for each joint");
    }
    if (off > 0) {
        document.warn("skin-weights", pointer + "/attributes/WEIGHTS_0",
                      fmt::format("the weights of {} vertices don't sum to 1; they are scaled (of a vertex "
                                  "without any, the first joint takes all)",
                                  off),
                      "export the mesh again with normalised weights");
    }
    return joined;
}

Status importSkins(Document& document, Scene& scene) {
    const NodeNumbers numbers(document, scene);
    std::map<std::size_t, int> known;  // by number in the file; -1: the skin is left out
    for (Node& node : scene.nodes) {
        const int skin = fileNode(document, node).skin;
        if (skin < 0) {
            continue;
        }
        const std::string pointer = fmt::format("/nodes/{}/skin", node.source);
        if (node.mesh < 0) {
            document.warn("skin-attribute", pointer, "belongs to a node without a mesh; it is left out",
                          kExportSkin);
            continue;
        }
        const auto index = static_cast<std::size_t>(skin);
        if (!known.contains(index)) {
            GLINT_TRY(auto read, readSkin(document, index, numbers));
            known[index] = read ? static_cast<int>(scene.skins.size()) : -1;
            if (read) {
                scene.skins.push_back(std::move(*read));
            }
        }
        node.skin = known[index];
        if (node.skin >= 0) {
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
            if (std::ranges::any_of(mesh.primitives, [](const Primitive& primitive) {
                    return primitive.influences.count == 0;
                })) {
                document.warn("skin-attribute", pointer,
                              "the mesh has primitives without joints and weights; they follow the node",
                              kExportSkin);
            }
            const Skin& followed = scene.skins[static_cast<std::size_t>(node.skin)];
            GLINT_TRY_DO(checkJoints(document, mesh, followed));
        }
    }
    return okStatus();
}

// ---- Instances ----

namespace {

constexpr const char* kExportInstances = "export the instances again";

class InstanceReader {
public:
    InstanceReader(Document& document, const Value::Object& attributes, std::string pointer)
        : document_(document), attributes_(attributes), pointer_(std::move(pointer)) {}

    // Without any of the three attributes there is one placement, because all of them would coincide.
    Result<Instancing> read() {
        Instancing instancing;
        GLINT_TRY_DO(readArray("TRANSLATION", instancing.translations));
        GLINT_TRY_DO(readArray("ROTATION", instancing.rotations));
        GLINT_TRY_DO(readArray("SCALE", instancing.scales));
        instancing.count = count_.value_or(1);
        normalize(instancing.rotations);
        return instancing;
    }

private:
    template <std::size_t N>
    Status readArray(const char* name, std::vector<std::array<float, N>>& values) {
        const auto accessor = attributes_.find(name);
        if (accessor == attributes_.end()) {
            return okStatus();
        }
        const std::string where = fmt::format("{}/{}", pointer_, name);
        // Only rotations may be integers, which then are fractions.
        GLINT_TRY(const auto elements, readFloats(document_, accessor->second.GetNumberAsInt(),
                                                  N == 4 ? Integers::Normalized : Integers::AsValues));
        GLINT_TRY_DO(toVectors(document_, elements, N, 0.0F, where, kExportInstances, values));
        if (count_ && *count_ != elements.count) {
            return document_.error(
                "attribute-count", where,
                fmt::format("has {} elements, another attribute of the node has {}", elements.count, *count_),
                kExportInstances);
        }
        count_ = elements.count;
        std::size_t damaged = 0;
        for (std::array<float, N>& value : values) {
            if (!base::isFinite(value)) {
                value.fill(0.0F);
                ++damaged;
            }
        }
        if (damaged > 0) {
            document_.warn("attribute-not-finite", where,
                           fmt::format("{} elements are NaN or infinite; 0 is used", damaged),
                           kExportInstances);
        }
        return okStatus();
    }

    void normalize(std::vector<Float4>& rotations) {
        // The rounding of quaternions to 8 bits causes a smaller error.
        constexpr float kTolerance = 0.02F;
        std::size_t off = 0;
        for (Float4& rotation : rotations) {
            const float length =
                std::hypot(std::hypot(rotation[0], rotation[1]), std::hypot(rotation[2], rotation[3]));
            off += std::abs(length - 1.0F) > kTolerance ? 1 : 0;
            if (length > 0.0F && std::isfinite(length)) {
                std::ranges::transform(rotation, rotation.begin(),
                                       [&](float number) { return number / length; });
            } else {
                rotation = {0.0F, 0.0F, 0.0F, 1.0F};
            }
        }
        if (off > 0) {
            document_.warn("node-rotation", pointer_ + "/ROTATION",
                           fmt::format("{} elements are no unit quaternions; their direction is used", off),
                           kExportInstances);
        }
    }

    Document& document_;
    const Value::Object& attributes_;
    std::string pointer_;
    std::optional<std::size_t> count_;
};

bool isSkinned(const Scene& scene, const Node& node) {
    return node.skin >= 0 &&
           std::ranges::any_of(scene.meshes[static_cast<std::size_t>(node.mesh)].primitives,
                               [](const Primitive& primitive) { return primitive.influences.count > 0; });
}

Status checkPlaces(const Document& document, const Matrix4& world, const Instancing& instancing,
                   const std::string& pointer) {
    for (std::size_t i = 0; i < instancing.count; ++i) {
        if (!fitsFloat(multiply(world, instanceTransform(instancing, i)))) {
            return document.error("node-transform", pointer,
                                  fmt::format("the transform of instance {} in the world overflows", i),
                                  "check the scales of the instances, the node and its parents");
        }
    }
    return okStatus();
}

}  // namespace

Status importInstances(Document& document, Scene& scene) {
    std::set<std::string> custom;
    for (Node& node : scene.nodes) {
        const Value* const extension =
            extensionOf(fileNode(document, node).extensions, "EXT_mesh_gpu_instancing");
        if (extension == nullptr) {
            continue;
        }
        const std::string pointer =
            fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes", node.source);
        if (node.mesh < 0) {
            document.warn("node-instances", pointer, "belong to a node without a mesh; nothing is drawn",
                          kExportInstances);
            continue;
        }
        const Value::Object& attributes = extension->Get("attributes").Get<Value::Object>();
        for (const auto& [name, accessor] : attributes) {
            if (std::ranges::find(kInstanceAttributes, name) == std::end(kInstanceAttributes)) {
                custom.insert(name);
            }
        }
        if (isSkinned(scene, node)) {
            document.warn(
                "node-instances", pointer,
                "belong to a node whose mesh follows a skin, which puts all of them into one place; the "
                "mesh is drawn once",
                "give each instance a node and a skin of its own");
            continue;
        }
        GLINT_TRY(auto read, InstanceReader(document, attributes, pointer).read());
        GLINT_TRY_DO(checkPlaces(document, node.world, read, pointer));
        node.instancing = static_cast<int>(scene.instancings.size());
        scene.instancings.push_back(std::move(read));
    }
    if (!custom.empty()) {
        document.note("node-instances", "/nodes",
                      fmt::format("attributes of instances that are an application's own are not read: {}",
                                  fmt::join(custom, ", ")));
    }
    return okStatus();
}

}  // namespace glint::gltf
