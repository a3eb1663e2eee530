// SceneStore: the work of the device for the changes since the last recording.
#include "context/commands.h"
#include "context/vulkan_table.h"
#include "data/geometry.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace glint {
namespace {

// The stretches that SceneStore::timer measures.
constexpr std::uint32_t kDeformStretch = 0;
constexpr std::uint32_t kBlasStretch = 1;
constexpr std::uint32_t kTlasStretch = 2;
constexpr std::uint32_t kStretches = 3;

constexpr VkPipelineStageFlags2 kBuildStage = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
constexpr MemoryDependency kDeformToBuild{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          VK_ACCESS_2_SHADER_WRITE_BIT, kBuildStage,
                                          VK_ACCESS_2_SHADER_READ_BIT};

constexpr MemoryDependency kBuildToQuery{kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                         kBuildStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

constexpr std::size_t kArrays = 10;
constexpr std::size_t kPoseArray = 7;

// Everything that a recording needs to allocate.
struct Prepared {
    explicit Prepared(SceneStore& store)
        : kept(store.scene.pool), brief(store.upload != nullptr ? store.upload->pool : store.scene.brief) {}

    MemoryPool& kept;
    MemoryPool& brief;  // of resources that only this recording needs
    AlignedBuffer scratch;
    AccelerationStructure tlas;
    AlignedBuffer tlasScratch;
    std::uint32_t tlasCapacity = 0;
    std::optional<DescriptorSet> set;
    TlasBuild build;
    UniqueQueryPool sizes;  // of compacted BLASes
};

class Recorder {
public:
    Recorder(SceneStore& store, VkCommandBuffer commands, MotionView::Builds builds)
        : store_(store),
          scene_(store.scene),
          context_(store.scene.context),
          commands_(commands),
          rule_(builds),
          prepared_(store),
          update_(context_, prepared_.brief) {}

    Status record(std::uint64_t frame, RetiredLot* leftovers) {
        GLINT_TRY_DO(compactBuilt(store_));
        GLINT_TRY_DO(settleBlases(store_));
        settleLights(store_);
        decide();
        for (const auto& step : {&Recorder::prepareArrays, &Recorder::prepareTlas, &Recorder::prepareStaging,
                                 &Recorder::prepareSet, &Recorder::prepareSizes}) {
            GLINT_TRY_DO((this->*step)());
        }
        if (store_.drawsDirty) {
            scene_.batches = store_.draws.batches();
        }
        recordAll();
        finish(frame);
        if (leftovers != nullptr) {
            *leftovers = store_.retired.take();
        } else {
            store_.retired.close(frame);
        }
        store_.lastFrame = frame;
        return okStatus();
    }

private:
    // The arrays, with the sizes that they are to have. Those of poses and of the TLAS's instances are made
    // for the recordings that read them in a scene that does not keep them.
    std::array<ArrayTarget, kArrays> arrays() {
        const bool keeps = store_.keeps();
        const bool isLit = store_.emission.has_value();
        const bool isPosed = store_.deformPass && (keeps || !deformed_.empty());
        const bool isPlaced = keeps || tlasAction_ != BuildAction::Keep;
        const auto target = [&](RecordArray& array, bool isRead = true) {
            return ArrayTarget{array,
                               isRead ? capacityFor(array.count(), array.capacity, array.firstCapacity) : 0,
                               &prepared_.kept};
        };
        std::array<ArrayTarget, kArrays> all{
            {target(store_.geometries), target(store_.instances), target(store_.materials),
             target(store_.lights), target(store_.lightNodes), target(store_.emitterRecords, isLit),
             target(store_.firstEmitters, isLit), target(store_.poses, isPosed),
             target(store_.deforms, isPosed), target(store_.topLevel.records(), isPlaced)}};
        all.back().usage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
        for (std::size_t i = kPoseArray; i < kArrays && !keeps; ++i) {
            all[i].pool = &prepared_.brief;
        }
        return all;
    }

    // Decides which vertices are computed, and which structures are built or refitted.
    void decide() {
        for (const std::uint32_t index : store_.reshaped) {
            const StoredInstance& instance = store_.instanceSlots.at(index);
            const OwnShape& shape = *instance.shape;
            const StoredMesh& mesh = *store_.meshes.find(instance.mesh);
            const double surface = mesh.bounds->at(poseOf(store_, instance)).surface();
            std::uint32_t record = shape.records.first;
            for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
                if (shape.vertices[i].positions != 0) {
                    deformed_.emplace_back(record++, mesh.primitives[i].device.vertexCount);
                }
            }
            for (std::size_t i = 0; i < shape.builds.size(); ++i) {
                const BuildAction action = actionOf(shape, shape.histories[i], surface);
                shapes_.push_back({index, i, action, surface});
                works_.push_back({&shape.builds[i], action == BuildAction::Refit});
                if (!store_.keeps()) {
                    compacted_.emplace_back(
                        PartPlace{{}, store_.instanceSlots.handleAt(index), 0, static_cast<std::uint32_t>(i)},
                        shape.blases[i].handle.get());
                }
            }
        }
        for (const std::uint32_t index : store_.reshapedMeshes) {
            for (StoredPart& part : store_.meshes.at(index).parts) {
                const double surface = part.box.surface();
                const BuildAction action =
                    part.isBuilt ? part.history.next(true, surface) : BuildAction::Build;
                parts_.push_back({&part, action, surface});
                works_.push_back({&*part.build, action == BuildAction::Refit});
            }
        }
        for (const auto& [structure, queued] : store_.builds) {
            works_.push_back({&queued.build});
            compacted_.emplace_back(queued.place, structure);
        }
        tlasAction_ = store_.topLevel.next(!works_.empty(), rule_);
        if (store_.trims && tlasAction_ == BuildAction::Keep) {
            tlasAction_ = BuildAction::Build;
        }
        store_.topLevel.prepare(tlasAction_);
    }

    BuildAction actionOf(const OwnShape& shape, const BlasHistory& history, double surface) const {
        if (!shape.isBuilt) {
            return BuildAction::Build;
        }
        return rule_ == MotionView::Builds::ByRule  ? history.next(true, surface)
               : rule_ == MotionView::Builds::Refit ? BuildAction::Refit
                                                    : BuildAction::Build;
    }

    // The size that an array or the TLAS should have. It doubles, and shrinks only after trim().
    std::uint32_t capacityFor(std::uint32_t count, std::uint32_t now, std::uint32_t first) const {
        if (store_.upload != nullptr || !store_.keeps()) {
            return std::max(count, 1U);
        }
        if (count > now) {
            return std::max(count, 2 * now);
        }
        return store_.trims ? std::max({count, first, 1U}) : std::max(now, 1U);
    }

    Status prepareArrays() {
        GLINT_TRY_DO(update_.prepareBuffers(arrays()));
        if (const Buffer& poses = update_.bufferOf(kPoseArray); poses.handle.get() != VK_NULL_HANDLE) {
            for (const std::uint32_t instance : store_.shaped) {
                writeDeforms(store_, instance, poses.address);
            }
        }
        return okStatus();
    }

    Status prepareTlas() {
        if (tlasAction_ == BuildAction::Keep) {
            return okStatus();
        }
        const std::uint32_t count = store_.topLevel.records().count();
        const std::uint32_t capacity = capacityFor(count, store_.tlasCapacity, store_.firstTlasCapacity);
        GLINT_TRY(prepared_.build, describeTlas(context_, capacity, store_.topLevel.isUpdatable()));
        const VkAccelerationStructureBuildSizesInfoKHR& sizes = prepared_.build.sizes;
        if (capacity != store_.tlasCapacity) {
            prepared_.tlasCapacity = capacity;
            GLINT_TRY(prepared_.tlas,
                      createStructure(context_, prepared_.kept, sizes.accelerationStructureSize,
                                      VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR));
        }
        const VkDeviceSize bytes = std::max(sizes.buildScratchSize, sizes.updateScratchSize);
        if (bytes > store_.tlasScratchBytes || prepared_.tlas.handle.get() != VK_NULL_HANDLE) {
            GLINT_TRY(prepared_.tlasScratch,
                      createScratch(context_, store_.keeps() ? prepared_.kept : prepared_.brief, bytes));
            tlasScratchBytes_ = bytes;
        }
        return okStatus();
    }

    // Makes the staging buffer of the records, and scratch memory for BLASes.
    Status prepareStaging() {
        GLINT_TRY_DO(update_.prepareStaging(arrays()));
        scratchBytes_ = scratchBytesOf(context_, works_);
        if (scratchBytes_ > 0) {
            GLINT_TRY(prepared_.scratch, createScratch(context_, prepared_.brief, scratchBytes_));
        }
        return okStatus();
    }

    // Sets of frames in flight stay as they are: another version gets another set.
    Status prepareSet() {
        const bool newTlas = prepared_.tlas.handle.get() != VK_NULL_HANDLE;
        if (!store_.setDirty && !newTlas) {
            return okStatus();
        }
        GLINT_TRY(prepared_.set,
                  makeSceneSet(scene_, newTlas ? prepared_.tlas.handle.get() : scene_.tlas.handle.get(),
                               store_.white.view.get()));
        return okStatus();
    }

    // Makes room for the sizes of compacted BLASes.
    Status prepareSizes() {
        if (compacted_.empty()) {
            return okStatus();
        }
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                                         .queryCount = static_cast<std::uint32_t>(compacted_.size())};
        GLINT_TRY(prepared_.sizes, createHandle<UniqueQueryPool>(context_, context_.vk.CreateQueryPool,
                                                                 "vkCreateQueryPool", info));
        context_.vk.ResetQueryPool(context_.handles.device, prepared_.sizes.get(), 0, info.queryCount);
        return okStatus();
    }

    bool hasWork() const {
        return update_.hasWork() || tlasAction_ != BuildAction::Keep || !works_.empty() ||
               store_.uploader->waiting() > 0;
    }

    // Keeps a buffer until the device has completed the recording.
    void retire(Buffer&& buffer) {
        if (store_.upload != nullptr) {
            store_.upload->keep(std::move(buffer));
        } else {
            store_.retired.add(std::move(buffer));
        }
    }

    void recordAll() {
        if (!hasWork()) {
            return;
        }
        // Earlier frames may still read the memory that is written here.
        recordDependency(context_, commands_, kAllToAll);
        const std::array<ArrayTarget, kArrays> now = arrays();
        update_.recordResizes(commands_, now, store_.retired);
        for (Buffer& staging : store_.uploader->record(commands_)) {
            retire(std::move(staging));
        }
        retire(update_.recordCopies(commands_, now));
        recordDependency(context_, commands_, kAllToAll);
        const bool isTimed = !works_.empty() || tlasAction_ != BuildAction::Keep;
        if (isTimed) {
            store_.timer->recordReset(commands_);
        }
        recordStretch(isTimed, kDeformStretch, "deform", [&] { recordDeform(); });
        recordStretch(isTimed, kBlasStretch, "bottom levels", [&] {
            recordBuilds(context_, commands_, works_, {prepared_.scratch.address, scratchBytes_});
        });
        recordSizes();
        recordDependency(context_, commands_, kBuildsInOrder);
        recordStretch(isTimed, kTlasStretch, "top level", [&] { recordTlas(); });
        recordDependency(context_, commands_, kAllToAll);
    }

    template <typename Record>
    void recordStretch(bool isTimed, std::uint32_t stretch, const char* name, const Record& record) {
        if (!isTimed) {
            return;
        }
        beginLabel(context_, commands_, name);
        store_.timer->recordBegin(commands_, stretch);
        record();
        store_.timer->recordEnd(commands_, stretch);
        endLabel(context_, commands_);
    }

    void recordDeform() {
        if (!deformed_.empty()) {
            store_.deformPass->record(commands_, store_.deforms.device.address, deformed_);
            recordDependency(context_, commands_, kDeformToBuild);
        }
    }

    void recordSizes() {
        if (compacted_.empty()) {
            return;
        }
        std::vector<VkAccelerationStructureKHR> structures;
        for (const auto& [place, structure] : compacted_) {
            structures.push_back(structure);
        }
        recordDependency(context_, commands_, kBuildToQuery);
        context_.vk.CmdWriteAccelerationStructuresPropertiesKHR(
            commands_, static_cast<std::uint32_t>(structures.size()), structures.data(),
            VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, prepared_.sizes.get(), 0);
    }

    void recordTlas() {
        if (tlasAction_ == BuildAction::Keep) {
            return;
        }
        if (prepared_.tlas.handle.get() != VK_NULL_HANDLE) {
            store_.retired.add(std::move(scene_.tlas));
            scene_.tlas = std::move(prepared_.tlas);
            store_.tlasCapacity = prepared_.tlasCapacity;
        }
        if (prepared_.tlasScratch.buffer.handle.get() != VK_NULL_HANDLE) {
            store_.retired.add(std::move(store_.tlasScratch.buffer));
            store_.tlasScratch = std::move(prepared_.tlasScratch);
            store_.tlasScratchBytes = tlasScratchBytes_;
        }
        recordTlasBuild(context_, commands_, prepared_.build,
                        {store_.topLevel.records().device.address, store_.topLevel.records().count(),
                         store_.tlasScratch.address},
                        scene_.tlas.handle.get(), tlasAction_ == BuildAction::Refit);
    }

    // Takes over everything that was prepared, and notes that nothing is pending.
    void finish(std::uint64_t frame) {
        if (!compacted_.empty()) {
            store_.compactions.push_back({std::move(prepared_.sizes), std::move(compacted_), frame});
        }
        if (prepared_.set) {
            store_.retired.add(std::move(scene_.descriptorPool));
            scene_.descriptorPool = std::move(prepared_.set->pool);
            scene_.set = prepared_.set->set;
        }
        retire(std::move(prepared_.scratch.buffer));
        if (!store_.keeps()) {
            dropBriefs();
        }
        store_.countLights();
        scene_.statistics.instances = static_cast<std::uint32_t>(store_.instanceSlots.count());
        store_.topLevel.apply(tlasAction_);
        takeStatistics();
        for (const auto& [part, action, surface] : parts_) {
            part->isBuilt = true;
            part->history.apply(action, surface);
        }
        store_.reshaped.clear();
        store_.reshapedMeshes.clear();
        store_.builds.clear();
        store_.lightMoves = {};
        for (bool* const flag : {&store_.drawsDirty, &store_.lightsDirty, &store_.emittersDirty,
                                 &store_.setDirty, &store_.trims, &store_.compacts}) {
            *flag = false;
        }
    }

    // Gives up what a scene that stays still needs for no other recording.
    void dropBriefs() {
        retire(std::move(store_.tlasScratch.buffer));
        store_.tlasScratchBytes = 0;
        for (RecordArray* const array : {&store_.poses, &store_.deforms, &store_.topLevel.records()}) {
            retire(std::exchange(array->device, {}));
            array->capacity = 0;
        }
    }

    void takeStatistics() {
        GpuScene::MotionStatistics& statistics = store_.statistics;
        statistics = {};
        statistics.deformed = static_cast<std::uint32_t>(store_.reshaped.size());
        statistics.topLevel = static_cast<GpuScene::MotionStatistics::TopLevel>(tlasAction_);
        for (const auto& [index, part, action, surface] : shapes_) {
            OwnShape& shape = *store_.instanceSlots.at(index).shape;
            shape.isBuilt = true;
            shape.histories[part].apply(action, surface);
            ++(action == BuildAction::Refit ? statistics.refits : statistics.rebuilds);
        }
    }

    struct ShapePart {
        std::uint32_t instance = 0;
        std::size_t part = 0;
        BuildAction action = BuildAction::Keep;
        double surface = 0.0;
    };

    struct ChangedPart {
        StoredPart* part = nullptr;
        BuildAction action = BuildAction::Keep;
        double surface = 0.0;
    };

    SceneStore& store_;
    GpuScene::State& scene_;
    Context::State& context_;
    VkCommandBuffer commands_;
    MotionView::Builds rule_;
    Prepared prepared_;
    ArrayUpdate update_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> deformed_;
    std::vector<ShapePart> shapes_;
    std::vector<ChangedPart> parts_;
    std::vector<BlasWork> works_;
    decltype(Compaction::parts) compacted_;  // BLASes whose compacted sizes are asked for
    BuildAction tlasAction_ = BuildAction::Keep;
    VkDeviceSize scratchBytes_ = 0;
    VkDeviceSize tlasScratchBytes_ = 0;
};

static_assert(static_cast<int>(BuildAction::Keep) ==
              static_cast<int>(GpuScene::MotionStatistics::TopLevel::Kept));
static_assert(static_cast<int>(BuildAction::Refit) ==
              static_cast<int>(GpuScene::MotionStatistics::TopLevel::Updated));
static_assert(static_cast<int>(BuildAction::Build) ==
              static_cast<int>(GpuScene::MotionStatistics::TopLevel::Rebuilt));

}  // namespace

Status checkFrame(const SceneStore& store, std::uint64_t frame) {
    if (frame < store.lastFrame) {
        return makeError("scene-edit-frame", "",
                         phrase("frame ", frame, " is recorded after frame ", store.lastFrame),
                         "number frames in the order in which they are recorded");
    }
    return okStatus();
}

Status recordChanges(SceneStore& store, VkCommandBuffer commands, std::uint64_t frame,
                     MotionView::Builds builds, RetiredLot* leftovers) {
    if (!store.timer) {
        GLINT_TRY(auto timer, Timer::create(store.scene.context, kStretches));
        store.timer.emplace(std::move(timer));
    }
    return Recorder(store, commands, builds).record(frame, leftovers);
}

Result<std::vector<double>> readTimes(const SceneStore& store) {
    return store.timer->read(kStretches);
}

}  // namespace glint
