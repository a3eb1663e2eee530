// SceneMotion: its contents and its first build.
#include "motion/scene_motion.h"

#include "motion/motion_record.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <map>
#include <utility>

namespace glint {
namespace {

constexpr std::array<float, 12> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// Stores the properties that later poses are compared with.
void rememberScene(SceneMotion& motion, const SceneView& scene) {
    std::map<std::uint32_t, const MotionBounds*> byMesh;
    for (const InstanceView& instance : scene.instances) {
        motion.meshes.push_back(instance.mesh);
        motion.jointCounts.push_back(instance.joints.size());
        motion.weightCounts.push_back(instance.morphWeights.size());
        const MotionBounds*& bounds = byMesh[instance.mesh];
        if (bounds == nullptr) {
            const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
            motion.boundsOfMeshes.push_back(
                std::make_unique<MotionBounds>(scene.primitives.subspan(own.first, own.end - own.first)));
            bounds = motion.boundsOfMeshes.back().get();
        }
        motion.bounds.push_back(bounds);
    }
    for (const LightView& light : scene.lights) {
        motion.lightTypes.push_back(static_cast<std::uint32_t>(light.type));
    }
}

Status createBuffers(GpuScene::State& state, std::size_t lights) {
    SceneMotion& motion = *state.motion;
    const std::size_t placed = std::max(motion.placed.size(), std::size_t{1});
    GLINT_TRY(motion.placedBuffer,
              createBuffer(state.context, motion.pool, placed * sizeof(VkAccelerationStructureInstanceKHR),
                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    motion.lightOffset = motion.meshes.size() * sizeof(gpu::InstanceRecord);
    motion.lightNodeOffset = motion.lightOffset + lights * sizeof(gpu::LightRecord);
    motion.emitterOffset = motion.lightNodeOffset + state.lightTree.nodes.size() * sizeof(gpu::LightNode);
    // A hierarchy tells which triangles are dark.
    const std::size_t emitters = state.lightNodes.address == 0 ? state.emitters.records.size() : 0;
    motion.placedOffset = motion.emitterOffset + emitters * sizeof(gpu::EmitterRecord);
    motion.materialOffset =
        motion.placedOffset + motion.placed.size() * sizeof(VkAccelerationStructureInstanceKHR);
    const VkDeviceSize bytes =
        motion.materialOffset + state.changing.size() * state.materialLayout.recordBytes;
    GLINT_TRY(motion.staging, createBuffer(state.context, motion.pool, std::max<VkDeviceSize>(bytes, 1),
                                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
    return okStatus();
}

Status createTlas(GpuScene::State& state) {
    SceneMotion& motion = *state.motion;
    TlasBuild& build = motion.tlasBuild;
    GLINT_TRY_DO(describeTlas(state.context, motion.placedBuffer.address, motion.placed.size(), true, build));
    GLINT_TRY(state.tlas, createStructure(state.context, state.pool, build.sizes.accelerationStructureSize,
                                          VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR));
    GLINT_TRY(motion.tlasScratch,
              createScratch(state.context, motion.pool,
                            std::max(build.sizes.buildScratchSize, build.sizes.updateScratchSize)));
    build.info.dstAccelerationStructure = state.tlas.handle.get();
    build.info.scratchData.deviceAddress = motion.tlasScratch.address;
    return okStatus();
}

// Queues all builds for the first time.
void buildAll(GpuScene::State& state, const SceneView& scene, Uploader& uploader) {
    SceneMotion& motion = *state.motion;
    const std::vector<Box> boxes = boxesOf(motion, scene.instances);
    Decisions decisions;
    decisions.deformed.resize(scene.instances.size());
    for (std::size_t i = 0; i < motion.blasHistories.size(); ++i) {
        decisions.blases.push_back(BuildAction::Build);
        motion.blasHistories[i].apply(BuildAction::Build, boxes[motion.blasInstances[i]].surface());
    }
    decisions.tlas = BuildAction::Build;
    motion.tlasHistory.apply(decisions.tlas, boxes);
    stage(state, scene.instances, scene.lights);
    uploader.add([&state, decisions = std::move(decisions)](VkCommandBuffer commands) {
        recordAll(state, commands, decisions);
    });
}

}  // namespace

Status createMotion(GpuScene::State& state, const SceneView& scene, const SceneLayout& layout,
                    std::span<const BlasInput> refitted, std::unique_ptr<Deformer> deformer,
                    Uploader& uploader) {
    GLINT_TRY(auto timer, Timer::create(state.context, kStretches));
    state.motion = std::make_unique<SceneMotion>(state.context, std::move(timer));
    SceneMotion& motion = *state.motion;
    motion.deformer = std::move(deformer);
    rememberScene(motion, scene);
    if (!refitted.empty()) {
        GLINT_TRY(auto blases, RefittedBlases::create(state.context, motion.pool, refitted));
        motion.blases = std::make_unique<RefittedBlases>(std::move(blases));
        state.statistics.blasCount += static_cast<std::uint32_t>(refitted.size());
        state.statistics.blasBytes += motion.blases->bytes();
        state.statistics.blasUncompactedBytes += motion.blases->bytes();
    }
    for (std::size_t part = 0; part < layout.parts.size(); ++part) {
        if (layout.parts[part].instance) {
            state.partBlases[part] = motion.blases->address(motion.blasHistories.size());
            motion.blasInstances.push_back(*layout.parts[part].instance);
            motion.blasHistories.emplace_back();
        }
    }
    motion.partInstances = layout.partInstances;
    for (const PartInstance& placed : layout.partInstances) {
        motion.placed.push_back(makePlaced(layout.parts[placed.part].doubleSided, placed, kIdentity,
                                           state.partBlases[placed.part]));
    }
    state.draws = layout.draws;
    place(state, scene.instances);
    GLINT_TRY_DO(createBuffers(state, scene.lights.size()));
    GLINT_TRY_DO(createTlas(state));
    buildAll(state, scene, uploader);
    return okStatus();
}

void readFirstBuild(GpuScene::State& state) {
    const SceneMotion& motion = *state.motion;
    if (motion.recorded || !motion.timer.available()) {
        return;
    }
    if (const Result<std::vector<double>> milliseconds = motion.timer.read(kStretches)) {
        state.statistics.blasBuildMs += (*milliseconds)[kBlasStretch];
        state.statistics.tlasBuildMs = (*milliseconds)[kTlasStretch];
    }
}

}  // namespace glint
