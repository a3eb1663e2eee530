#include "frame/motion_history.h"

#include "context/commands.h"
#include "context/resources.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

constexpr VkBufferUsageFlags kHistoryUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkDeviceSize kVertexAlignment = 16;

// Shaders and copies have read the arrays of the previous frame, and have written those of this one.
constexpr MemoryDependency kFrameToCopy{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};

// Returns where in a buffer of the list an address is; null if in none.
const Buffer* bufferAt(const std::vector<Buffer>& buffers, VkDeviceAddress address) {
    const auto found = std::ranges::find_if(buffers, [&](const Buffer& buffer) {
        return address >= buffer.address && address < buffer.address + buffer.bytes;
    });
    return found == buffers.end() ? nullptr : &*found;
}

// The rows of FrameConstants::previousView for the camera of the constants.
void fillView(const gpu::FrameConstants& constants, gpu::vec4 (&rows)[4]) {
    const auto unjittered = [&](const gpu::vec4& row, float jitter, std::uint32_t pixels) {
        const float shift = 2.0F * jitter / static_cast<float>(pixels);
        const gpu::vec4& w = constants.worldToClip[3];
        return gpu::vec4{row.x + w.x * shift, row.y + w.y * shift, row.z + w.z * shift, row.w + w.w * shift};
    };
    rows[0] = unjittered(constants.worldToClip[0], constants.jitter.x, constants.width);
    rows[1] = unjittered(constants.worldToClip[1], constants.jitter.y, constants.height);
    const gpu::vec3& forward = constants.cameraForward;
    const gpu::vec3& position = constants.cameraPosition;
    rows[2] = {forward.x, forward.y, forward.z,
               -(forward.x * position.x + forward.y * position.y + forward.z * position.z)};
    rows[3] = constants.worldToClip[3];
}

}  // namespace

Result<std::unique_ptr<MotionHistory>> MotionHistory::create(const GpuScene::State& scene) {
    std::unique_ptr<MotionHistory> history(new MotionHistory(scene));
    GLINT_TRY_DO(history->makeRoom());
    if (scene.motion != nullptr && !scene.deformed.addresses.empty()) {
        GLINT_TRY_DO(history->createVertices());
    }
    return history;
}

Status MotionHistory::makeRoom() {
    const bool moves = scene_->motion != nullptr || scene_->editor != nullptr;
    if (!moves || instances_.bytes >= scene_->instances.bytes) {
        return okStatus();
    }
    GLINT_TRY(auto buffer, createBuffer(scene_->context, pool_, scene_->instances.bytes, kHistoryUsage));
    outgrown_.add(std::exchange(instances_, std::move(buffer)));
    hasInstances_ = false;
    return okStatus();
}

// Geometries that do not deform keep their positions, in whatever form they are.
Status MotionHistory::createVertices() {
    std::vector<gpu::PreviousVertices>& table = newTable_;
    table.reserve(scene_->geometryPositions.size());
    VkDeviceSize bytes = 0;
    std::vector<std::size_t> deformed;  // places in `table` of `copies_`, one for each geometry that deforms
    std::vector<std::size_t> copyOf;
    for (const GeometryPositions& own : scene_->geometryPositions) {
        const Buffer* const source =
            own.vertexCount > 0 ? bufferAt(scene_->deformed.buffers, own.positions) : nullptr;
        table.push_back({own.positions});
        if (source == nullptr) {
            continue;
        }
        const VkDeviceSize offset = own.positions - source->address;
        const auto known = std::ranges::find_if(copies_, [&](const Copy& copy) {
            return copy.source == source->handle.get() && copy.region.srcOffset == offset;
        });
        deformed.push_back(table.size() - 1);
        copyOf.push_back(static_cast<std::size_t>(known - copies_.begin()));
        if (known == copies_.end()) {
            const VkDeviceSize size = VkDeviceSize{3 * sizeof(float)} * own.vertexCount;
            copies_.push_back({source->handle.get(), {offset, bytes, size}});
            bytes += (size + kVertexAlignment - 1) / kVertexAlignment * kVertexAlignment;
        }
    }
    if (copies_.empty()) {
        table.clear();
        return okStatus();
    }
    GLINT_TRY(vertices_, createBuffer(scene_->context, pool_, bytes, kHistoryUsage));
    for (std::size_t i = 0; i < deformed.size(); ++i) {
        table[deformed[i]].positions = vertices_.address + copies_[copyOf[i]].region.dstOffset;
    }
    GLINT_TRY(table_, createBuffer(scene_->context, pool_, table.size() * sizeof(gpu::PreviousVertices),
                                   kHistoryUsage));
    return okStatus();
}

void MotionHistory::recordTable(VkCommandBuffer commands) {
    constexpr std::size_t kMostBytes = 65536;  // of vkCmdUpdateBuffer()
    const std::span<const std::uint8_t> bytes = bytesOf(std::span<const gpu::PreviousVertices>(newTable_));
    for (std::size_t at = 0; at < bytes.size(); at += kMostBytes) {
        const auto part = bytes.subspan(at, std::min(kMostBytes, bytes.size() - at));
        scene_->context.vk.CmdUpdateBuffer(commands, table_.handle.get(), at, part.size(), part.data());
    }
    if (!bytes.empty()) {
        recordDependency(scene_->context, commands,
                         {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
    }
    newTable_.clear();
}

void MotionHistory::fill(gpu::FrameConstants& constants) {
    fillView(constants, next_.rows);
    std::ranges::copy(view_ ? view_->rows : next_.rows, constants.previousView);
    constants.previousInstances = hasInstances_ ? instances_.address : scene_->instances.address;
    const bool hasVertices = hasInstances_ && table_.handle.get() != VK_NULL_HANDLE;
    constants.previousVertices = hasVertices ? table_.address : 0;
    constants.hasPreviousVertices = hasVertices ? 1 : 0;
}

void MotionHistory::record(VkCommandBuffer commands, std::uint64_t recording) {
    view_ = next_;
    outgrown_.close(recording);
    if (instances_.handle.get() == VK_NULL_HANDLE) {
        return;
    }
    recordDependency(scene_->context, commands, kFrameToCopy);
    recordTable(commands);
    const DeviceTable& vk = scene_->context.vk;
    const VkBufferCopy all{0, 0, std::min(instances_.bytes, scene_->instances.bytes)};
    vk.CmdCopyBuffer(commands, scene_->instances.handle.get(), instances_.handle.get(), 1, &all);
    for (const Copy& copy : copies_) {
        vk.CmdCopyBuffer(commands, copy.source, vertices_.handle.get(), 1, &copy.region);
    }
    hasInstances_ = true;
}

void MotionHistory::addMemory(std::vector<MemoryItem>& items) const {
    addTo(items, "instances of the frame before", instances_);
    if (outgrown_.bytes() > 0) {
        addTo(items, {"instances of the frame before", MemoryUse::Device, false, outgrown_.count(),
                      outgrown_.bytes()});
    }
    addTo(items, "vertices of the frame before", vertices_);
    addTo(items, "vertices of the frame before", table_);
}

}  // namespace glint
