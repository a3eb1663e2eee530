// GpuScene: poses, which are edits of many things at once.
#include "context/parallel.h"
#include "data/materials.h"
#include "data/scene_checks.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace glint {
namespace {

// Checks the materials of a pose, and takes them if all are known.
Status poseMaterials(SceneStore& store, std::span<const MaterialView> materials) {
    GpuScene::State& scene = store.scene;
    const std::vector<ChangingMaterial> last = scene.changing;
    GLINT_TRY_DO(takeMaterials(materials, scene.materialLayout, scene.changing));
    for (std::size_t i = 0; i < last.size(); ++i) {
        const ChangingMaterial& changing = scene.changing[i];
        if (changing.record == last[i].record) {
            continue;
        }
        std::uint32_t index = changing.material;
        if (store.editable) {
            const MaterialHandle handle = store.firstMaterials[index];
            if (store.materialSlots.find(handle) == nullptr) {
                continue;  // an edit has removed it
            }
            index = handle.index;
        }
        const std::span<const std::uint8_t> old = store.materials.at(index);
        std::vector<std::uint8_t> record(old.begin(), old.end());
        takeValues(changing.record, scene.materialLayout, record);
        writeMaterial(store, index, record);
    }
    return okStatus();
}

// Moves the things that a pose does not give, because edits have added them, to another origin.
void moveOrigin(SceneStore& store, const std::array<double, 3>& origin) {
    std::array<float, 3> shift{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shift[axis] = static_cast<float>(store.scene.origin[axis] - origin[axis]);
    }
    store.scene.origin = origin;
    if (shift == std::array<float, 3>{} || !store.editable) {
        return;
    }
    std::set<std::uint32_t> given;
    for (const InstanceHandle handle : store.firstInstances) {
        if (store.instanceSlots.find(handle) != nullptr) {
            given.insert(handle.index);
        }
    }
    store.instanceSlots.forEach([&](InstanceHandle handle, const StoredInstance& instance) {
        if (!given.contains(handle.index)) {
            Rows rows = instance.objectToWorld;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rows[4 * axis + 3] += shift[axis];
            }
            moveInstance(store, handle, rows, instance.visible);
        }
    });
    for (const LightHandle handle : store.lightOrder) {
        if (std::ranges::find(store.firstLights, handle) == store.firstLights.end()) {
            LightView light = *store.lightSlots.find(handle);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                light.position[axis] += shift[axis];
            }
            setLight(store, handle, light);
        }
    }
}

Status poseInstances(SceneStore& store, std::span<const InstanceView> instances) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const InstanceView& view = instances[i];
        const InstanceHandle handle = store.firstInstances[i];
        const StoredInstance* const instance = store.instanceSlots.find(handle);
        if (instance == nullptr) {
            continue;
        }
        const bool moves = store.lastRows[i] != view.objectToWorld;
        const bool shows = store.lastVisible[i] != view.visible;
        store.lastRows[i] = view.objectToWorld;
        store.lastVisible[i] = view.visible;
        if (moves || shows) {
            const Rows rows = moves ? view.objectToWorld : instance->objectToWorld;
            moveInstance(store, handle, rows, shows ? view.visible : instance->visible);
        }
        // An edit may have given the instance another mesh, which has no pose here.
        if (instance->mesh == store.firstMeshes.at(view.mesh)) {
            GLINT_TRY_DO(poseInstance(store, store.cases ? &store.cases->package() : nullptr, handle, view));
        }
    }
    return okStatus();
}

void poseLights(SceneStore& store, std::span<const LightView> lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const LightHandle handle = store.firstLights[i];
        const gpu::LightRecord record = makeLightRecord(lights[i]);
        // Floats count by their bits. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
        const bool changes = std::memcmp(&record, &store.lastLights[i], sizeof record) != 0;
        store.lastLights[i] = record;
        if (changes && store.lightSlots.find(handle) != nullptr) {
            setLight(store, handle, lights[i]);
        }
    }
}

}  // namespace

Status GpuScene::update(VkCommandBuffer commands, const MotionView& motion, std::uint64_t frame) try {
    SceneStore& store = *state_->store;
    if (!store.keeps()) {
        return makeError("scene-still", "", "the scene was uploaded as one that neither moves nor is edited",
                         "set SceneView::moves before the upload");
    }
    GLINT_TRY_DO(checkFrame(store, frame));
    GLINT_TRY_DO(checkMotion(motion, store.posedShape));
    GLINT_TRY_DO(poseMaterials(store, motion.materials));
    moveOrigin(store, motion.origin);
    GLINT_TRY_DO(poseInstances(store, motion.instances));
    poseLights(store, motion.lights);
    GLINT_TRY_DO(recordChanges(store, commands, frame, motion.builds));
    store.posed = true;
    return okStatus();
}
GLINT_CATCH

Result<GpuScene::MotionStatistics> GpuScene::motion() const try {
    const SceneStore& store = *state_->store;
    if (!store.posed) {
        return makeError("frame-not-recorded", "", "no update has been recorded",
                         "record an update, submit it and wait for it first");
    }
    MotionStatistics statistics = store.statistics;
    const bool isTimed = statistics.topLevel != MotionStatistics::TopLevel::Kept;
    if (isTimed && store.timer->available()) {
        GLINT_TRY(const auto times, readTimes(store));
        statistics.deformMs = times[0];
        statistics.blasMs = times[1];
        statistics.tlasMs = times[2];
    }
    return statistics;
}
GLINT_CATCH

}  // namespace glint
