// Checks whether skins, morph targets and motion are well formed.
#include "scene/geometry.h"
#include "scene/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace glint {
namespace {

constexpr const char* kGiveAll = "give as many as at upload, in the same order";

Diagnostic attributeError(const PrimitiveView& view, const std::string& what, const char* hint) {
    return makeError("scene-attribute",
                     "mesh " + std::to_string(view.mesh) + ", primitive " + std::to_string(view.primitive),
                     what, hint);
}

Status checkTargets(const PrimitiveView& view) {
    for (const MorphTargetView& target : view.targets) {
        struct Member {
            std::size_t count;
            std::size_t base;
        };
        for (const Member& member : {Member{target.positions.size(), view.positions.size()},
                                     Member{target.normals.size(), view.normals.size()},
                                     Member{target.tangents.size(), view.tangents.size()}}) {
            if (member.count != 0 && member.count != member.base) {
                return attributeError(view,
                                      "a morph target has " + std::to_string(member.count) +
                                          " differences to an attribute of " + std::to_string(member.base) +
                                          " elements",
                                      "give a difference for each element, or none");
            }
        }
    }
    return okStatus();
}

Status checkInfluences(const PrimitiveView& view) {
    if (view.joints.size() != view.jointWeights.size()) {
        return attributeError(view, "the joints are not as many as their weights", "give a weight a joint");
    }
    if (!view.joints.empty() && (view.positions.empty() || view.joints.size() % view.positions.size() != 0)) {
        return attributeError(view, "the joints are not as many for each vertex",
                              "give each vertex the same number; weights may be 0");
    }
    return okStatus();
}

// Returns one more than the largest joint index that a vertex of the mesh uses.
std::size_t jointsNeeded(std::span<const PrimitiveView> primitives) {
    std::size_t needed = 0;
    for (const PrimitiveView& view : primitives) {
        for (const std::uint16_t joint : view.joints) {
            needed = std::max(needed, joint + std::size_t{1});
        }
    }
    return needed;
}

bool isFinite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

Status checkPose(const InstanceView& instance, const std::string& where) {
    for (const std::array<float, 12>& joint : instance.joints) {
        if (!isFinite(joint)) {
            return makeError("scene-motion", where, "a joint has a number that is not finite",
                             "repair the pose");
        }
    }
    if (!isFinite(instance.morphWeights)) {
        return makeError("scene-motion", where, "a morph weight is not finite", "repair the pose");
    }
    return okStatus();
}

Diagnostic otherCount(const std::string& where, const std::string& what, std::size_t count,
                      std::size_t expected) {
    return makeError("scene-motion", where,
                     "there are " + std::to_string(count) + " " + what + ", at upload there were " +
                         std::to_string(expected),
                     kGiveAll);
}

}  // namespace

Status checkDeformation(const SceneView& scene) {
    for (const PrimitiveView& view : scene.primitives) {
        GLINT_TRY_DO(checkTargets(view));
        GLINT_TRY_DO(checkInfluences(view));
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const InstanceView& instance = scene.instances[i];
        const std::string where = "instance " + std::to_string(i);
        GLINT_TRY_DO(checkPose(instance, where));
        const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
        const std::span<const PrimitiveView> primitives =
            scene.primitives.subspan(own.first, own.end - own.first);
        const std::size_t needed = instance.joints.empty() ? 0 : jointsNeeded(primitives);
        if (needed > instance.joints.size()) {
            return makeError("scene-index", where,
                             "a vertex follows joint " + std::to_string(needed - 1) + ", there are " +
                                 std::to_string(instance.joints.size()),
                             "give every joint that the mesh follows");
        }
        std::size_t targets = 0;
        for (const PrimitiveView& view : primitives) {
            targets = std::max(targets, view.targets.size());
        }
        if (instance.morphWeights.size() > targets) {
            return makeError("scene-motion", where,
                             "there are " + std::to_string(instance.morphWeights.size()) + " weights for " +
                                 std::to_string(targets) + " morph targets",
                             "give one weight for each target");
        }
    }
    return okStatus();
}

Status checkMotion(const MotionView& motion, const MotionShape& shape) {
    if (motion.instances.size() != shape.meshes.size()) {
        return otherCount("", "instances", motion.instances.size(), shape.meshes.size());
    }
    if (motion.lights.size() != shape.lightTypes.size()) {
        return otherCount("", "lights", motion.lights.size(), shape.lightTypes.size());
    }
    for (std::size_t i = 0; i < motion.instances.size(); ++i) {
        const InstanceView& instance = motion.instances[i];
        const std::string where = "instance " + std::to_string(i);
        if (instance.mesh != shape.meshes[i]) {
            return makeError("scene-motion", where, "the instance has another mesh than at upload", kGiveAll);
        }
        if (instance.joints.size() != shape.jointCounts[i]) {
            return otherCount(where, "joints", instance.joints.size(), shape.jointCounts[i]);
        }
        if (instance.morphWeights.size() != shape.weightCounts[i]) {
            return otherCount(where, "morph weights", instance.morphWeights.size(), shape.weightCounts[i]);
        }
        GLINT_TRY_DO(checkPose(instance, where));
    }
    for (std::size_t i = 0; i < motion.lights.size(); ++i) {
        if (static_cast<std::uint32_t>(motion.lights[i].type) != shape.lightTypes[i]) {
            return makeError("scene-motion", "light " + std::to_string(i),
                             "the light has another type than at upload", kGiveAll);
        }
    }
    GLINT_TRY_DO(checkOrigin(motion.origin));
    return checkLights(motion.lights);
}

}  // namespace glint
