// SceneEditor: the work of the device for the edits since the last recording.
#include "context/commands.h"
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/traversal_order.h"
#include "scene/scene_editor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>

namespace glint {
namespace {

using Placed = VkAccelerationStructureInstanceKHR;

constexpr VkDeviceSize kPlacedAlignment = 16;  // of the array of instances that a TLAS is built from
constexpr VkBufferUsageFlags kRecordUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
// An array of records on the device. It has no buffer if the package's shaders don't read it.
struct Array {
    RecordStore& store;
    Buffer& device;
    bool isRead = true;
};
constexpr std::size_t kArrays = 7;

// Everything that a recording needs to allocate. Its destructor discards everything that was not handed over.
struct Prepared {
    explicit Prepared(MemoryPool& memory) : pool(memory) {}
    ~Prepared() {
        for (Buffer& buffer : arrays) {
            discard(pool, std::move(buffer));
        }
        discard(pool, std::move(staging));
        discard(pool, std::move(scratch.buffer));
        discard(pool, std::move(tlas));
        discard(pool, std::move(tlasScratch.buffer));
    }
    Prepared(const Prepared&) = delete;
    Prepared& operator=(const Prepared&) = delete;

    MemoryPool& pool;
    std::array<Buffer, kArrays> arrays;  // for those arrays that get another size
    std::array<std::uint32_t, kArrays> capacities{};
    Buffer staging;
    Scratch scratch;
    AccelerationStructure tlas;
    Scratch tlasScratch;
    std::uint32_t tlasCapacity = 0;
    std::optional<DescriptorSet> set;
    TlasBuild build;
};

class EditRecorder {
public:
    EditRecorder(SceneEditor::State& state, VkCommandBuffer commands)
        : state_(state),
          scene_(state.scene),
          context_(state.scene.context),
          commands_(commands),
          prepared_(state.scene.pool) {}

    Status record(std::uint64_t frame) {
        if (state_.emittersDirty) {
            emitters_ = gatherEmitters(state_);
            state_.firstEmitters.replace(
                std::span<const std::uint32_t>(emitters_.firstsOf(state_.geometries.count())));
        }
        if (lightsChange()) {
            writeLights();
        }
        if (state_.tlasDirty) {
            gatherPlaced();
        }
        for (const auto& step : {&EditRecorder::prepareArrays, &EditRecorder::prepareTlas,
                                 &EditRecorder::prepareStaging, &EditRecorder::prepareSet}) {
            GLINT_TRY_DO((this->*step)());
        }
        if (state_.drawsDirty) {
            scene_.batches = batchDraws(drawsOf());
        }
        recordAll();
        finish();
        state_.retired.close(frame);
        state_.lastFrame = frame;
        return okStatus();
    }

private:
    std::array<Array, kArrays> arrays() {
        return {{{state_.geometries, scene_.geometries},
                 {state_.instances, scene_.instances},
                 {state_.materials, scene_.materials},
                 {state_.lights, scene_.lights},
                 {state_.lightNodes, scene_.lightNodes, state_.buildsTree},
                 {state_.emitters, scene_.emitterRecords, state_.emission != nullptr},
                 {state_.firstEmitters, scene_.firstEmitters, state_.emission != nullptr}}};
    }

    bool lightsChange() const {
        return state_.lightsDirty || state_.emittersDirty;
    }

    // Writes records of all lights, and the hierarchy over them and the emissive triangles.
    void writeLights() {
        std::vector<gpu::LightRecord> records;
        for (const LightHandle handle : state_.lightOrder) {
            records.push_back(makeLightRecord(*state_.lightSlots.find(handle)));
        }
        state_.lights.replace(std::span<const gpu::LightRecord>(records));
        Emitters& emitters = state_.emittersDirty ? emitters_ : scene_.emitters;
        const std::vector<EmitterBounds> bounds = emitters.boundsAt(emissiveViews(state_));
        if (state_.buildsTree) {
            tree_ = buildLightTree(records, bounds);
            state_.lightNodes.replace(std::span<const gpu::LightNode>(tree_.nodes));
            emitters.setLeaves(tree_);
        } else {
            emitters.setLeaves(bounds);
        }
        state_.emitters.replace(std::span<const gpu::EmitterRecord>(emitters.records));
    }

    // Makes the array that the TLAS is built from.
    void gatherPlaced() {
        std::vector<LeafBox> boxes;
        state_.instanceSlots.forEach([&](InstanceHandle /*handle*/, const EditedInstance& instance) {
            if (!instance.isShown()) {
                return;
            }
            std::uint32_t geometry = instance.firstGeometry;
            for (const EditedMeshPrimitive& primitive : state_.meshes.find(instance.mesh)->primitives) {
                for (const EditedPart& part : primitive.parts) {
                    placed_.push_back(placedAt(instance, part, geometry++));
                    if (state_.leafOrder != nullptr) {
                        boxes.emplace_back(transformed(part.box, instance.objectToWorld));
                    }
                }
            }
        });
        if (state_.leafOrder != nullptr) {
            placed_ = permuted<Placed>(placed_, state_.leafOrder(boxes, 1));
        }
    }

    // A BLAS is opaque, and seen from both sides, if the material of the geometry says so.
    Placed placedAt(const EditedInstance& instance, const EditedPart& part, std::uint32_t geometry) const {
        const auto record = state_.geometries.read<gpu::GeometryRecord>(geometry);
        const bool doubleSided = (record.flags & gpu::kGeometryDoubleSided) != 0;
        Placed placed = makePlaced(doubleSided, {0, 0, geometry}, instance.objectToWorld, part.blas.address);
        const bool opaque = (record.flags & (gpu::kGeometryAlphaTested | gpu::kGeometryPassesLight)) == 0;
        const std::uint32_t flags =
            placed.flags | static_cast<std::uint32_t>(opaque ? VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR
                                                             : VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR);
        placed.flags = flags & 0xFFU;
        // The shader binding table has a record for each shader ID.
        placed.instanceShaderBindingTableRecordOffset = record.shaderId & 0xFFFFFFU;
        return placed;
    }

    std::vector<Draw> drawsOf() const {
        std::vector<Draw> draws;
        std::uint64_t triangles = 0;
        state_.instanceSlots.forEach([&](InstanceHandle handle, const EditedInstance& instance) {
            const auto record = state_.instances.read<gpu::InstanceRecord>(handle.index);
            std::uint32_t geometry = instance.firstGeometry;
            std::uint32_t primitiveOfMesh = 0;
            for (const EditedMeshPrimitive& primitive : state_.meshes.find(instance.mesh)->primitives) {
                for (const EditedPart& part : primitive.parts) {
                    const auto shaded = state_.geometries.read<gpu::GeometryRecord>(geometry);
                    draws.push_back({geometry++, 3 * part.triangles.count,
                                     (shaded.flags & gpu::kGeometryDoubleSided) != 0,
                                     (record.flags & gpu::kInstanceMirrored) != 0, handle.index,
                                     !instance.isShown(), primitiveOfMesh});
                    triangles += part.triangles.count;
                }
                ++primitiveOfMesh;
            }
        });
        scene_.statistics.triangles = triangles;
        scene_.statistics.geometries = static_cast<std::uint32_t>(draws.size());
        return draws;
    }

    // The size that an array or the TLAS should have. It doubles, and shrinks only after trim().
    std::uint32_t capacityFor(std::uint32_t count, std::uint32_t now, std::uint32_t first) const {
        if (state_.upload != nullptr) {
            return std::max(count, 1U);
        }
        if (count > now) {
            return std::max(count, 2 * now);
        }
        return state_.trims ? std::max(count, first) : now;
    }

    Status prepareArrays() {
        std::size_t i = 0;
        for (const auto& [store, device, isRead] : arrays()) {
            const std::uint32_t capacity = capacityFor(store.count(), store.capacity, store.firstCapacity);
            prepared_.capacities[i] = capacity;
            if (capacity != store.capacity && isRead) {
                GLINT_TRY(prepared_.arrays[i],
                          createBuffer(context_, scene_.pool, capacity * store.stride(), kRecordUsage));
            }
            ++i;
        }
        return okStatus();
    }

    Status prepareTlas() {
        if (!state_.tlasDirty && !state_.trims) {
            return okStatus();
        }
        if (!state_.tlasDirty) {
            gatherPlaced();
            state_.tlasDirty = true;
        }
        const auto count = static_cast<std::uint32_t>(placed_.size());
        const std::uint32_t capacity = capacityFor(count, state_.tlasCapacity, state_.firstTlasCapacity);
        TlasBuild& build = prepared_.build;
        GLINT_TRY_DO(describeTlas(context_, 0, capacity, false, build));
        if (capacity == state_.tlasCapacity) {
            return okStatus();
        }
        prepared_.tlasCapacity = capacity;
        GLINT_TRY(prepared_.tlas,
                  createStructure(context_, scene_.pool, build.sizes.accelerationStructureSize,
                                  VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR));
        GLINT_TRY(prepared_.tlasScratch, createScratch(context_, scene_.pool, build.sizes.buildScratchSize));
        return okStatus();
    }

    // Makes the staging buffer: the instances of the TLAS, then records. Also makes scratch memory for
    // BLASes.
    Status prepareStaging() {
        recordsFrom_ = placed_.size() * sizeof(Placed) + kPlacedAlignment;
        VkDeviceSize bytes = recordsFrom_;
        for (const auto& [store, device, isRead] : arrays()) {
            for (const IndexRange& range : store.dirty()) {
                bytes += (range.end - range.first) * store.stride();
            }
        }
        if (state_.tlasDirty || bytes > recordsFrom_) {
            GLINT_TRY(prepared_.staging,
                      createBuffer(context_, scene_.pool, bytes,
                                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                       VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR,
                                   MemoryUse::Upload));
        }
        scratchBytes_ = scratchBytesOf(context_, pendingBuilds());
        if (scratchBytes_ > 0) {
            GLINT_TRY(prepared_.scratch, createScratch(context_, scene_.pool, scratchBytes_));
        }
        return okStatus();
    }

    // Sets of frames in flight stay as they are: another version gets another set.
    Status prepareSet() {
        const bool newTlas = prepared_.tlas.handle.get() != VK_NULL_HANDLE;
        if (!state_.setDirty && !newTlas) {
            return okStatus();
        }
        GLINT_TRY(prepared_.set,
                  makeSceneSet(scene_, newTlas ? prepared_.tlas.handle.get() : scene_.tlas.handle.get(),
                               state_.white.view.get()));
        return okStatus();
    }

    bool hasWork() const {
        const bool resized = std::ranges::any_of(
            prepared_.arrays, [](const Buffer& buffer) { return buffer.handle.get() != VK_NULL_HANDLE; });
        return resized || state_.tlasDirty || prepared_.staging.handle.get() != VK_NULL_HANDLE ||
               !state_.builds.empty() || state_.uploader->waiting() > 0;
    }

    void recordAll() {
        if (!hasWork()) {
            return;
        }
        // Earlier frames may still read the memory that is written here.
        recordDependency(context_, commands_, kAllToAll);
        recordResizes();
        for (Buffer& staging : state_.uploader->record(commands_)) {
            if (state_.upload != nullptr) {
                state_.upload->keep(std::move(staging));
            } else {
                state_.retired.add(std::move(staging));
            }
        }
        recordCopies();
        recordDependency(context_, commands_, kAllToAll);
        recordBuilds(context_, commands_, pendingBuilds(), {prepared_.scratch.address, scratchBytes_});
        if (state_.tlasDirty) {
            recordDependency(context_, commands_, kBuildsInOrder);
            recordTlas();
        }
        recordDependency(context_, commands_, kAllToAll);
    }

    // Copies old content into arrays of another size.
    void recordResizes() {
        std::size_t i = 0;
        bool copied = false;
        for (const auto& [store, device, isRead] : arrays()) {
            Buffer& resized = prepared_.arrays[i];
            if (resized.handle.get() != VK_NULL_HANDLE) {
                const std::uint32_t kept = std::min({store.capacity, prepared_.capacities[i], store.count()});
                if (kept > 0 && device.handle.get() != VK_NULL_HANDLE) {
                    const VkBufferCopy region{0, 0, kept * store.stride()};
                    context_.vk.CmdCopyBuffer(commands_, device.handle.get(), resized.handle.get(), 1,
                                              &region);
                    copied = true;
                }
                state_.retired.add(std::move(device));
                device = std::move(resized);
                store.capacity = prepared_.capacities[i];
            }
            ++i;
        }
        if (copied) {
            recordDependency(context_, commands_, kTransferToTransfer);
        }
    }

    void recordCopies() {
        VkDeviceSize from = recordsFrom_;
        for (const auto& [store, device, isRead] : arrays()) {
            std::vector<VkBufferCopy> regions;
            for (const IndexRange& range : store.dirty()) {
                const VkDeviceSize bytes = (range.end - range.first) * store.stride();
                std::memcpy(prepared_.staging.mapped + from, store.at(range.first).data(), bytes);
                regions.push_back({from, range.first * store.stride(), bytes});
                from += bytes;
            }
            if (!regions.empty()) {
                context_.vk.CmdCopyBuffer(commands_, prepared_.staging.handle.get(), device.handle.get(),
                                          static_cast<std::uint32_t>(regions.size()), regions.data());
            }
            store.clearDirty();
        }
    }

    std::vector<BlasWork> pendingBuilds() const {
        std::vector<BlasWork> builds;
        for (const SceneEditor::State::PendingBuild& pending : state_.builds) {
            builds.push_back({&pending.build});
        }
        return builds;
    }

    void recordTlas() {
        if (prepared_.tlas.handle.get() != VK_NULL_HANDLE) {
            state_.retired.add(std::move(scene_.tlas));
            state_.retired.add(std::move(state_.tlasScratch.buffer));
            scene_.tlas = std::move(prepared_.tlas);
            state_.tlasScratch = std::move(prepared_.tlasScratch);
            state_.tlasCapacity = prepared_.tlasCapacity;
        }
        const VkDeviceSize slack =
            alignUp(prepared_.staging.address, kPlacedAlignment) - prepared_.staging.address;
        if (!placed_.empty()) {
            std::memcpy(prepared_.staging.mapped + slack, placed_.data(), placed_.size() * sizeof(Placed));
        }
        prepared_.build.geometry.geometry.instances.data.deviceAddress = prepared_.staging.address + slack;
        recordTlasBuild(
            context_, commands_,
            {prepared_.build, state_.tlasScratch.address, static_cast<std::uint32_t>(placed_.size())},
            scene_.tlas.handle.get());
    }

    // Takes over everything that was prepared, and notes that nothing is pending.
    void finish() {
        if (prepared_.set) {
            state_.retired.add(std::move(scene_.descriptorPool));
            scene_.descriptorPool = std::move(prepared_.set->pool);
            scene_.set = prepared_.set->set;
        }
        state_.retired.add(std::move(prepared_.staging));
        state_.retired.add(std::move(prepared_.scratch.buffer));
        if (lightsChange()) {
            scene_.lightCount = state_.lights.count();
            scene_.lightTree = std::move(tree_);
        }
        if (state_.emittersDirty) {
            scene_.emitters = std::move(emitters_);
            scene_.emitterCount = state_.emitters.count();
        }
        scene_.statistics.instances = static_cast<std::uint32_t>(state_.instanceSlots.count());
        for (SceneEditor::State::PendingBuild& built : state_.builds) {
            state_.retired.add(std::move(built.input));
        }
        state_.builds.clear();
        state_.tlasDirty = false;
        state_.drawsDirty = false;
        state_.lightsDirty = false;
        state_.emittersDirty = false;
        state_.setDirty = false;
        state_.trims = false;
    }

    SceneEditor::State& state_;
    GpuScene::State& scene_;
    Context::State& context_;
    VkCommandBuffer commands_;
    Prepared prepared_;
    std::vector<Placed> placed_;
    LightTree tree_;
    Emitters emitters_;
    VkDeviceSize recordsFrom_ = 0;
    VkDeviceSize scratchBytes_ = 0;
};

}  // namespace

Status recordEdits(SceneEditor::State& state, VkCommandBuffer commands, std::uint64_t frame) {
    return EditRecorder(state, commands).record(frame);
}

}  // namespace glint
