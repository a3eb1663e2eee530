#include "scene_motion.h"

#include "gpu_scene_state.h"
#include "instance_math.h"
#include "pass_dependencies.h"
#include "scene_checks.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace glint {
namespace {

// Stretches of the timer.
constexpr std::uint32_t kDeformStretch = 0;
constexpr std::uint32_t kBlasStretch = 1;
constexpr std::uint32_t kTlasStretch = 2;
constexpr std::uint32_t kStretches = 3;

constexpr VkPipelineStageFlags2 kBuildStage = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
// Poses and records into the pass that deforms, and instances into the build.
constexpr MemoryDependency kCopyToMotion{
    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | kBuildStage, VK_ACCESS_2_SHADER_READ_BIT};
constexpr MemoryDependency kDeformToBuild{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          VK_ACCESS_2_SHADER_WRITE_BIT, kBuildStage,
                                          VK_ACCESS_2_SHADER_READ_BIT};
constexpr MemoryDependency kBlasToTlas{kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                       kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};
// Whoever draws and traces next.
constexpr MemoryDependency kMotionToAll{
    kBuildStage | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_WRITE_BIT |
        VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

constexpr std::array<float, 12> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// What later poses are compared with.
void rememberScene(SceneMotion& motion, const SceneView& scene) {
    std::map<std::uint32_t, const MotionBounds*> byMesh;
    for (const InstanceView& instance : scene.instances) {
        motion.meshes.push_back(instance.mesh);
        motion.jointCounts.push_back(instance.joints.size());
        motion.weightCounts.push_back(instance.morphWeights.size());
        const MotionBounds*& bounds = byMesh[instance.mesh];
        if (bounds == nullptr) {
            const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
            motion.boundsOfMeshes.push_back(std::make_unique<MotionBounds>(
                scene.primitives.subspan(own.first, own.end - own.first)));
            bounds = motion.boundsOfMeshes.back().get();
        }
        motion.bounds.push_back(bounds);
    }
    for (const LightView& light : scene.lights) {
        motion.lightTypes.push_back(static_cast<std::uint32_t>(light.type));
    }
}

std::vector<Box> boxesOf(const SceneMotion& motion, std::span<const InstanceView> instances) {
    std::vector<Box> boxes;
    boxes.reserve(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        boxes.push_back(motion.bounds[i]->at(instances[i]));
    }
    return boxes;
}

Status createBuffers(GpuScene::State& state, std::size_t lights) {
    SceneMotion& motion = *state.motion;
    const std::size_t placed = std::max(motion.placed.size(), std::size_t{1});
    Result<Buffer> placedBuffer =
        createBuffer(state.context, motion.pool, placed * sizeof(VkAccelerationStructureInstanceKHR),
                     VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                         VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!placedBuffer) {
        return placedBuffer.error();
    }
    motion.placedBuffer = std::move(*placedBuffer);
    motion.lightOffset = motion.meshes.size() * sizeof(gpu::InstanceRecord);
    motion.placedOffset = motion.lightOffset + lights * sizeof(gpu::LightRecord);
    const VkDeviceSize bytes =
        motion.placedOffset + motion.placed.size() * sizeof(VkAccelerationStructureInstanceKHR);
    Result<Buffer> staging =
        createBuffer(state.context, motion.pool, std::max<VkDeviceSize>(bytes, 1),
                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload);
    if (!staging) {
        return staging.error();
    }
    motion.staging = std::move(*staging);
    return okStatus();
}

Status createTlas(GpuScene::State& state) {
    SceneMotion& motion = *state.motion;
    TlasBuild& build = motion.tlasBuild;
    if (Status s =
            describeTlas(state.context, motion.placedBuffer.address, motion.placed.size(), true, build);
        !s) {
        return s;
    }
    Result<AccelerationStructure> tlas =
        createStructure(state.context, motion.pool, build.sizes.accelerationStructureSize,
                        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    if (!tlas) {
        return tlas.error();
    }
    state.tlas = std::move(*tlas);
    Result<Scratch> scratch =
        createScratch(state.context, motion.pool,
                      std::max(build.sizes.buildScratchSize, build.sizes.updateScratchSize));
    if (!scratch) {
        return scratch.error();
    }
    motion.tlasScratch = std::move(*scratch);
    build.info.dstAccelerationStructure = state.tlas.handle.get();
    build.info.scratchData.deviceAddress = motion.tlasScratch.address;
    return okStatus();
}

// Instances of the top level as the pose has them; what is flattened keeps its last place, out of sight.
bool place(SceneMotion& motion, std::span<const InstanceView> instances, std::vector<Draw>& draws) {
    bool changed = false;
    std::vector<bool> whole(instances.size());
    std::vector<bool> mirrored(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        whole[i] = isInvertible(instances[i].objectToWorld);
        mirrored[i] = (makeInstanceRecord(instances[i].objectToWorld).flags & gpu::kInstanceMirrored) != 0;
    }
    for (std::size_t i = 0; i < motion.placed.size(); ++i) {
        VkAccelerationStructureInstanceKHR& placed = motion.placed[i];
        const std::uint32_t instance = motion.partInstances[i].instance;
        const std::uint32_t mask = whole[instance] ? 0xFF : 0;
        const void* const rows = instances[instance].objectToWorld.data();
        changed = changed || mask != placed.mask;
        placed.mask = mask & 0xFFU;
        if (whole[instance] && std::memcmp(&placed.transform, rows, sizeof(placed.transform)) != 0) {
            std::memcpy(&placed.transform, rows, sizeof(placed.transform));
            changed = true;
        }
    }
    for (Draw& draw : draws) {
        draw.hidden = !whole[draw.instance];
        draw.mirrored = mirrored[draw.instance];
    }
    return changed;
}

// Records of instances and lights, and the instances of the top level, where the copy starts from.
void stage(const SceneMotion& motion, std::span<const InstanceView> instances,
           std::span<const LightView> lights) {
    std::uint8_t* const bytes = motion.staging.mapped;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const gpu::InstanceRecord record = makeInstanceRecord(instances[i].objectToWorld);
        std::memcpy(bytes + i * sizeof(record), &record, sizeof(record));
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const gpu::LightRecord record = makeLightRecord(lights[i]);
        std::memcpy(bytes + motion.lightOffset + i * sizeof(record), &record, sizeof(record));
    }
    if (!motion.placed.empty()) {
        std::memcpy(bytes + motion.placedOffset, motion.placed.data(),
                    motion.placed.size() * sizeof(VkAccelerationStructureInstanceKHR));
    }
}

void recordCopies(const GpuScene::State& state, VkCommandBuffer commands) {
    const SceneMotion& motion = *state.motion;
    const auto copy = [&](VkDeviceSize from, VkDeviceSize to, const Buffer& target) {
        if (to > from) {
            const VkBufferCopy region{from, 0, to - from};
            state.context.vk.CmdCopyBuffer(commands, motion.staging.handle.get(), target.handle.get(), 1,
                                           &region);
        }
    };
    copy(0, motion.lightOffset, state.instances);
    copy(motion.lightOffset, motion.placedOffset, state.lights);
    copy(motion.placedOffset,
         motion.placedOffset + motion.placed.size() * sizeof(VkAccelerationStructureInstanceKHR),
         motion.placedBuffer);
}

void recordTlas(const GpuScene::State& state, VkCommandBuffer commands, BuildAction action) {
    const SceneMotion& motion = *state.motion;
    if (action == BuildAction::Keep) {
        return;
    }
    VkAccelerationStructureBuildGeometryInfoKHR info = motion.tlasBuild.info;
    info.pGeometries = &motion.tlasBuild.geometry;
    if (action == BuildAction::Refit) {
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        info.srcAccelerationStructure = info.dstAccelerationStructure;
    }
    VkAccelerationStructureBuildRangeInfoKHR range{};
    range.primitiveCount = static_cast<std::uint32_t>(motion.placed.size());
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    state.context.vk.CmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
}

// What an update does.
struct Decisions {
    std::vector<bool> deformed;        // by instance
    std::vector<BuildAction> blases;
    BuildAction tlas = BuildAction::Keep;
};

BuildAction chosen(BuildAction byRule, MotionView::Builds builds) {
    if (byRule == BuildAction::Keep || builds == MotionView::Builds::ByRule) {
        return byRule;
    }
    return builds == MotionView::Builds::Refit ? BuildAction::Refit : BuildAction::Build;
}

Decisions decide(SceneMotion& motion, std::vector<bool> deformed, bool placedChanged,
                 std::span<const Box> boxes, MotionView::Builds builds) {
    Decisions decisions;
    bool anyBlas = false;
    for (std::size_t i = 0; i < motion.blasHistories.size(); ++i) {
        BlasHistory& history = motion.blasHistories[i];
        const std::uint32_t instance = motion.blasInstances[i];
        const double surface = boxes[instance].surface();
        const BuildAction action = chosen(history.next(deformed[instance], surface), builds);
        history.apply(action, surface);
        anyBlas = anyBlas || action != BuildAction::Keep;
        decisions.blases.push_back(action);
    }
    decisions.tlas = chosen(motion.tlasHistory.next(placedChanged || anyBlas, boxes), builds);
    motion.tlasHistory.apply(decisions.tlas, boxes);
    decisions.deformed = std::move(deformed);
    return decisions;
}

void beginLabel(const Context::State& context, VkCommandBuffer commands, const char* name) {
    if (context.vk.CmdBeginDebugUtilsLabelEXT != nullptr) {
        VkDebugUtilsLabelEXT label{};
        label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
        label.pLabelName = name;
        context.vk.CmdBeginDebugUtilsLabelEXT(commands, &label);
    }
}

void endLabel(const Context::State& context, VkCommandBuffer commands) {
    if (context.vk.CmdEndDebugUtilsLabelEXT != nullptr) {
        context.vk.CmdEndDebugUtilsLabelEXT(commands);
    }
}

template <typename Record>
void recordStretch(const GpuScene::State& state, VkCommandBuffer commands, std::uint32_t stretch,
                   const char* name, const Record& record) {
    beginLabel(state.context, commands, name);
    state.motion->timer.recordBegin(commands, stretch);
    record();
    state.motion->timer.recordEnd(commands, stretch);
    endLabel(state.context, commands);
}

void recordAll(GpuScene::State& state, VkCommandBuffer commands, const Decisions& decisions) {
    SceneMotion& motion = *state.motion;
    motion.timer.recordReset(commands);
    // Frames that still read what is overwritten here.
    recordDependency(state.context, commands, kAllToAll);
    recordCopies(state, commands);
    if (motion.deformer) {
        motion.deformer->recordPose(commands);
    }
    recordDependency(state.context, commands, kCopyToMotion);
    recordStretch(state, commands, kDeformStretch, "deform", [&] {
        if (motion.deformer) {
            motion.deformer->recordDeform(commands, decisions.deformed);
        }
    });
    recordDependency(state.context, commands, kDeformToBuild);
    recordStretch(state, commands, kBlasStretch, "refit", [&] {
        if (motion.blases) {
            motion.blases->record(commands, decisions.blases);
        }
    });
    recordDependency(state.context, commands, kBlasToTlas);
    recordStretch(state, commands, kTlasStretch, "top level",
                  [&] { recordTlas(state, commands, decisions.tlas); });
    recordDependency(state.context, commands, kMotionToAll);
}

MotionStatistics countsOf(const Decisions& decisions) {
    const auto count = [](const auto& values, auto value) {
        return static_cast<std::uint32_t>(std::ranges::count(values, value));
    };
    MotionStatistics statistics;
    statistics.deformed = count(decisions.deformed, true);
    statistics.refits = count(decisions.blases, BuildAction::Refit);
    statistics.rebuilds = count(decisions.blases, BuildAction::Build);
    statistics.topLevel = static_cast<MotionStatistics::TopLevel>(decisions.tlas);
    return statistics;
}

static_assert(static_cast<int>(BuildAction::Keep) == static_cast<int>(MotionStatistics::TopLevel::Kept));
static_assert(static_cast<int>(BuildAction::Refit) == static_cast<int>(MotionStatistics::TopLevel::Updated));
static_assert(static_cast<int>(BuildAction::Build) == static_cast<int>(MotionStatistics::TopLevel::Rebuilt));

// The first build of everything.
Status buildAll(GpuScene::State& state, const SceneView& scene) {
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
    stage(motion, scene.instances, scene.lights);
    Result<CommandRunner> runner = CommandRunner::create(state.context);
    if (!runner) {
        return runner.error();
    }
    Result<VkCommandBuffer> commands = runner->begin();
    if (!commands) {
        return commands.error();
    }
    recordAll(state, *commands, decisions);
    if (Status s = runner->submitAndWait(); !s) {
        return s;
    }
    if (motion.timer.available()) {
        Result<std::vector<double>> milliseconds = motion.timer.read(kStretches);
        if (!milliseconds) {
            return milliseconds.error();
        }
        state.statistics.blasBuildMs += (*milliseconds)[kBlasStretch];
        state.statistics.tlasBuildMs = (*milliseconds)[kTlasStretch];
    }
    return okStatus();
}

}  // namespace

Status createMotion(GpuScene::State& state, const SceneView& scene, const SceneLayout& layout,
                    std::span<const BlasInput> refitted, std::unique_ptr<Deformer> deformer) {
    Result<Timer> timer = Timer::create(state.context, kStretches);
    if (!timer) {
        return timer.error();
    }
    state.motion = std::make_unique<SceneMotion>(state.context, std::move(*timer));
    SceneMotion& motion = *state.motion;
    motion.deformer = std::move(deformer);
    rememberScene(motion, scene);
    if (!refitted.empty()) {
        Result<RefittedBlases> blases = RefittedBlases::create(state.context, motion.pool, refitted);
        if (!blases) {
            return blases.error();
        }
        motion.blases = std::make_unique<RefittedBlases>(std::move(*blases));
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
    place(motion, scene.instances, state.draws);
    if (Status s = createBuffers(state, scene.lights.size()); !s) {
        return s;
    }
    if (Status s = createTlas(state); !s) {
        return s;
    }
    return buildAll(state, scene);
}

Status recordMotion(GpuScene::State& state, VkCommandBuffer commands, const MotionView& view) {
    if (!state.motion) {
        return makeError("scene-still", "", "the scene was uploaded as one that does not move",
                         "set SceneView::moves before the upload");
    }
    SceneMotion& motion = *state.motion;
    const MotionShape shape{motion.meshes, motion.jointCounts, motion.weightCounts, motion.lightTypes};
    if (Status s = checkMotion(view, shape); !s) {
        return s;
    }
    const bool changed = place(motion, view.instances, state.draws);
    std::vector<bool> deformed = motion.deformer ? motion.deformer->setPose(view.instances)
                                                 : std::vector<bool>(view.instances.size());
    const std::vector<Box> boxes = boxesOf(motion, view.instances);
    const Decisions decisions = decide(motion, std::move(deformed), changed, boxes, view.builds);
    stage(motion, view.instances, view.lights);
    recordAll(state, commands, decisions);
    motion.statistics = countsOf(decisions);
    motion.recorded = true;
    return okStatus();
}

Result<MotionStatistics> readMotion(const GpuScene::State& state) {
    if (!state.motion || !state.motion->recorded) {
        return makeError("frame-not-recorded", "", "no update has been recorded",
                         "record an update, submit it and wait for it first");
    }
    MotionStatistics statistics = state.motion->statistics;
    if (state.motion->timer.available()) {
        Result<std::vector<double>> milliseconds = state.motion->timer.read(kStretches);
        if (!milliseconds) {
            return milliseconds.error();
        }
        statistics.deformMs = (*milliseconds)[kDeformStretch];
        statistics.blasMs = (*milliseconds)[kBlasStretch];
        statistics.tlasMs = (*milliseconds)[kTlasStretch];
    }
    return statistics;
}

}  // namespace glint
