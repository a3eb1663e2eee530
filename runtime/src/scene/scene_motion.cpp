// SceneMotion: its contents and its first build.
#include "scene/scene_motion.h"

#include "context/commands.h"
#include "context/resources.h"
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/materials.h"
#include "data/scene_checks.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// The stretches that SceneMotion::timer measures.
inline constexpr std::uint32_t kDeformStretch = 0;
inline constexpr std::uint32_t kBlasStretch = 1;
inline constexpr std::uint32_t kTlasStretch = 2;
inline constexpr std::uint32_t kStretches = 3;

// The decisions of an update.
struct Decisions {
    std::vector<bool> deformed;  // indexed by instance
    std::vector<BuildAction> blases;
    BuildAction tlas = BuildAction::Keep;
};

// Returns the boxes of the scene's instances in world space.
std::vector<Box> boxesOf(const SceneMotion& motion, std::span<const InstanceView> instances);

// Places the instances of the TLAS and the draws as the pose says. An instance that is flattened or not
// visible keeps its last place and is hidden. Returns whether an instance of the TLAS has changed.
bool place(GpuScene::State& state, std::span<const InstanceView> instances);

// Writes the records of instances, lights and materials and the instances of the TLAS to the staging buffer,
// from which they are copied.
void stage(GpuScene::State& state, std::span<const InstanceView> instances,
           std::span<const LightView> lights);

// Records all the work of the device, with the dependencies before and after it.
void recordAll(GpuScene::State& state, VkCommandBuffer commands, const Decisions& decisions);

Result<RefittedBlases> RefittedBlases::create(Context::State& context, MemoryPool& pool,
                                              std::span<const BlasInput> inputs) {
    RefittedBlases blases(context);
    for (const BlasInput& input : inputs) {
        BlasBuild build = describeBuild(context, input);
        GLINT_TRY(auto structure, createStructure(context, pool, build.structureBytes,
                                                  VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
        build.info.dstAccelerationStructure = structure.handle.get();
        blases.structures_.push_back(std::move(structure));
        blases.builds_.push_back(std::move(build));
    }
    std::vector<BlasWork> works;
    for (const BlasBuild& build : blases.builds_) {
        works.push_back({&build});
    }
    blases.scratchBytes_ = scratchBytesOf(context, works);
    GLINT_TRY(blases.scratch_, createScratch(context, pool, blases.scratchBytes_));
    return blases;
}

void RefittedBlases::record(VkCommandBuffer commands, std::span<const BuildAction> actions) const {
    std::vector<BlasWork> works;
    for (std::size_t i = 0; i < builds_.size(); ++i) {
        if (actions[i] != BuildAction::Keep) {
            works.push_back({&builds_[i], actions[i] == BuildAction::Refit});
        }
    }
    recordBuilds(*context_, commands, works, {scratch_.address, scratchBytes_});
}

VkDeviceSize RefittedBlases::bytes() const {
    VkDeviceSize bytes = 0;
    for (const BlasBuild& build : builds_) {
        bytes += build.structureBytes;
    }
    return bytes;
}

void RefittedBlases::addMemory(std::vector<MemoryItem>& items) const {
    for (const AccelerationStructure& structure : structures_) {
        addTo(items, "refitted bottom levels", structure.buffer);
    }
    addTo(items, "scratch of structures", scratch_.buffer);
}

namespace {

constexpr VkPipelineStageFlags2 kBuildStage = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
// Copied poses and records are visible to the pass that deforms, and copied instances to the build.
constexpr MemoryDependency kCopyToMotion{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | kBuildStage,
                                         VK_ACCESS_2_SHADER_READ_BIT};
constexpr MemoryDependency kDeformToBuild{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          VK_ACCESS_2_SHADER_WRITE_BIT, kBuildStage,
                                          VK_ACCESS_2_SHADER_READ_BIT};
constexpr MemoryDependency kBlasToTlas{kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                       kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};
// Results are visible to all commands that draw and trace next.
constexpr MemoryDependency kMotionToAll{
    kBuildStage | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_WRITE_BIT |
        VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

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
    copy(motion.lightOffset, motion.lightNodeOffset, state.lights);
    copy(motion.lightNodeOffset, motion.emitterOffset, state.lightNodes);
    copy(motion.emitterOffset, motion.placedOffset, state.emitterRecords);
    copy(motion.placedOffset, motion.materialOffset, motion.placedBuffer);
    std::vector<VkBufferCopy> regions;
    for (std::size_t i = 0; i < state.changing.size(); ++i) {
        const VkDeviceSize bytes = state.materialLayout.recordBytes;
        regions.push_back({motion.materialOffset + i * bytes, state.changing[i].material * bytes, bytes});
    }
    if (!regions.empty()) {
        state.context.vk.CmdCopyBuffer(commands, motion.staging.handle.get(), state.materials.handle.get(),
                                       static_cast<std::uint32_t>(regions.size()), regions.data());
    }
}

void recordTlas(const GpuScene::State& state, VkCommandBuffer commands, BuildAction action) {
    const SceneMotion& motion = *state.motion;
    if (action == BuildAction::Keep) {
        return;
    }
    recordTlasBuild(state.context, commands, motion.tlas, state.tlas.handle.get(),
                    action == BuildAction::Refit);
}

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

// Orders the instances for a TLAS that is built anew, by their present positions. An update keeps the order
// of the last build.
void orderPlaced(SceneMotion& motion, const InstanceOrder& order, std::span<const InstanceView> instances) {
    const std::vector<std::uint32_t> places = order.at(instances, motion.partInstances);
    motion.partInstances = permuted<PartInstance>(motion.partInstances, places);
    motion.placed = permuted<VkAccelerationStructureInstanceKHR>(motion.placed, places);
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

}  // namespace

std::vector<Box> boxesOf(const SceneMotion& motion, std::span<const InstanceView> instances) {
    std::vector<Box> boxes;
    boxes.reserve(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        boxes.push_back(motion.bounds[i]->at(instances[i]));
    }
    return boxes;
}

bool place(GpuScene::State& state, std::span<const InstanceView> instances) {
    SceneMotion& motion = *state.motion;
    bool changed = false;
    std::vector<bool> whole(instances.size());
    std::vector<bool> mirrored(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        whole[i] = instances[i].visible && isInvertible(instances[i].objectToWorld);
        mirrored[i] = (makeInstanceRecord(instances[i].objectToWorld).flags & gpu::kInstanceMirrored) != 0;
    }
    for (std::size_t i = 0; i < motion.placed.size(); ++i) {
        VkAccelerationStructureInstanceKHR& placed = motion.placed[i];
        const std::uint32_t instance = motion.partInstances[i].instance;
        const std::uint32_t mask = whole[instance] ? 0xFF : 0;
        const std::array<float, 12>& rows = instances[instance].objectToWorld;
        changed = changed || mask != placed.mask;
        placed.mask = mask & 0xFFU;
        if (whole[instance] && !std::equal(rows.begin(), rows.end(), &placed.transform.matrix[0][0])) {
            std::memcpy(&placed.transform, rows.data(), sizeof(placed.transform));
            changed = true;
        }
    }
    bool redrawn = state.batches.empty();
    for (Draw& draw : state.draws) {
        const bool hidden = !whole[draw.instance];
        redrawn = redrawn || draw.hidden != hidden || draw.mirrored != mirrored[draw.instance];
        draw.hidden = hidden;
        draw.mirrored = mirrored[draw.instance];
    }
    if (redrawn) {
        state.batches = batchDraws(state.draws);
    }
    return changed;
}

void stage(GpuScene::State& state, std::span<const InstanceView> instances,
           std::span<const LightView> lights) {
    const SceneMotion& motion = *state.motion;
    std::uint8_t* const bytes = motion.staging.mapped;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const gpu::InstanceRecord record = makeInstanceRecord(instances[i].objectToWorld);
        std::memcpy(bytes + i * sizeof(record), &record, sizeof(record));
    }
    const std::vector<gpu::LightRecord> records = makeLightRecords(lights);
    if (!records.empty()) {
        std::memcpy(bytes + motion.lightOffset, records.data(), records.size() * sizeof(gpu::LightRecord));
    }
    state.emitters.takeMaterials(state.changing);
    const std::vector<EmitterBounds> emitters = state.emitters.boundsAt(instances);
    if (motion.placedOffset > motion.emitterOffset) {
        state.emitters.setLeaves(emitters);
        std::memcpy(bytes + motion.emitterOffset, state.emitters.records.data(),
                    motion.placedOffset - motion.emitterOffset);
    }
    if (!state.lightTree.nodes.empty()) {
        refitLightTree(state.lightTree, records, emitters);
        std::memcpy(bytes + motion.lightNodeOffset, state.lightTree.nodes.data(),
                    state.lightTree.nodes.size() * sizeof(gpu::LightNode));
    }
    if (!motion.placed.empty()) {
        std::memcpy(bytes + motion.placedOffset, motion.placed.data(),
                    motion.placed.size() * sizeof(VkAccelerationStructureInstanceKHR));
    }
    for (std::size_t i = 0; i < state.changing.size(); ++i) {
        const std::vector<std::uint8_t>& record = state.changing[i].record;
        std::memcpy(bytes + motion.materialOffset + i * record.size(), record.data(), record.size());
    }
}

void recordAll(GpuScene::State& state, VkCommandBuffer commands, const Decisions& decisions) {
    SceneMotion& motion = *state.motion;
    motion.timer.recordReset(commands);
    // Earlier frames may still read the memory that the copies overwrite.
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

Status recordMotion(GpuScene::State& state, VkCommandBuffer commands, const MotionView& view) {
    if (!state.motion) {
        return makeError("scene-still", "", "the scene was uploaded as one that does not move",
                         "set SceneView::moves before the upload");
    }
    if (state.upload) {
        return makeError(
            "scene-upload", "", "the scene's upload is not complete, and has the memory of its first pose",
            "call GpuScene::complete() for the frame of the upload, when the device is done with it");
    }
    SceneMotion& motion = *state.motion;
    const MotionShape shape{motion.meshes, motion.jointCounts, motion.weightCounts, motion.lightTypes};
    GLINT_TRY_DO(checkMotion(view, shape));
    GLINT_TRY_DO(takeMaterials(view.materials, state.materialLayout, state.changing));
    state.origin = view.origin;
    const bool changed = place(state, view.instances);
    std::vector<bool> deformed =
        motion.deformer ? motion.deformer->setPose(view.instances) : std::vector<bool>(view.instances.size());
    const std::vector<Box> boxes = boxesOf(motion, view.instances);
    const Decisions decisions = decide(motion, std::move(deformed), changed, boxes, view.builds);
    if (state.instanceOrder && decisions.tlas == BuildAction::Build) {
        orderPlaced(motion, *state.instanceOrder, view.instances);
    }
    stage(state, view.instances, view.lights);
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
        GLINT_TRY(auto milliseconds, state.motion->timer.read(kStretches));
        statistics.deformMs = milliseconds[kDeformStretch];
        statistics.blasMs = milliseconds[kBlasStretch];
        statistics.tlasMs = milliseconds[kTlasStretch];
    }
    return statistics;
}

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
    TlasBuild& build = motion.tlas.build;
    GLINT_TRY_DO(describeTlas(state.context, motion.placedBuffer.address, motion.placed.size(), true, build));
    GLINT_TRY(state.tlas, createStructure(state.context, state.pool, build.sizes.accelerationStructureSize,
                                          VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR));
    GLINT_TRY(motion.tlasScratch,
              createScratch(state.context, motion.pool,
                            std::max(build.sizes.buildScratchSize, build.sizes.updateScratchSize)));
    motion.tlas.scratch = motion.tlasScratch.address;
    motion.tlas.count = static_cast<std::uint32_t>(motion.placed.size());
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
