// Imports EXT_mesh_gpu_instancing: many placements of the mesh of one node.
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
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace glint::gltf {

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
