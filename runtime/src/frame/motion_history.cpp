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
    if (isChanging(scene)) {
        GLINT_TRY_DO(history->makeRoom());
    }
    return history;
}

Status MotionHistory::makeRoom() {
    if (!isChanging(*scene_)) {
        return okStatus();
    }
    const VkDeviceSize wanted = instanceRecords(*scene_).bytes;
    if (instances_.bytes < wanted) {
        GLINT_TRY(auto buffer, createBuffer(scene_->context, pool_, wanted, kHistoryUsage));
        outgrown_.add(std::exchange(instances_, std::move(buffer)));
        hasInstances_ = false;
    }
    return shapes_ == shapeVersion(*scene_) ? okStatus() : makeVertices();
}

// Geometries that do not deform keep their positions, in whatever form they are.
Status MotionHistory::makeVertices() {
    std::vector<gpu::PreviousVertices> table;
    std::vector<Copy> copies;
    VkDeviceSize bytes = 0;
    std::vector<std::size_t> deformed;  // places in `table` of `copies`, one for each geometry that deforms
    std::vector<std::size_t> copyOf;
    for (const GeometryPositions& own : geometryPositions(*scene_)) {
        table.push_back({own.positions});
        if (own.buffer == VK_NULL_HANDLE) {
            continue;
        }
        const auto known = std::ranges::find_if(copies, [&](const Copy& copy) {
            return copy.source == own.buffer && copy.region.srcOffset == own.offset;
        });
        deformed.push_back(table.size() - 1);
        copyOf.push_back(static_cast<std::size_t>(known - copies.begin()));
        if (known == copies.end()) {
            const VkDeviceSize size = VkDeviceSize{3 * sizeof(float)} * own.vertexCount;
            copies.push_back({own.buffer, {own.offset, bytes, size}});
            bytes += alignUp(size, kVertexAlignment);
        }
    }
    Buffer vertices;
    Buffer places;
    if (!copies.empty()) {
        GLINT_TRY(vertices, createBuffer(scene_->context, pool_, bytes, kHistoryUsage));
        for (std::size_t i = 0; i < deformed.size(); ++i) {
            table[deformed[i]].positions = vertices.address + copies[copyOf[i]].region.dstOffset;
        }
        GLINT_TRY(places, createBuffer(scene_->context, pool_, table.size() * sizeof(gpu::PreviousVertices),
                                       kHistoryUsage));
    } else {
        table.clear();
    }
    outgrown_.add(std::exchange(vertices_, std::move(vertices)));
    outgrown_.add(std::exchange(table_, std::move(places)));
    newTable_ = std::move(table);
    copies_ = std::move(copies);
    hasVertices_ = false;
    shapes_ = shapeVersion(*scene_);
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
    constants.previousInstances = hasInstances_ ? instances_.address : instanceRecords(*scene_).address;
    const bool hasVertices = hasInstances_ && hasVertices_;
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
    const Buffer& instances = instanceRecords(*scene_);
    const VkBufferCopy all{0, 0, std::min(instances_.bytes, instances.bytes)};
    vk.CmdCopyBuffer(commands, instances.handle.get(), instances_.handle.get(), 1, &all);
    for (const Copy& copy : copies_) {
        vk.CmdCopyBuffer(commands, copy.source, vertices_.handle.get(), 1, &copy.region);
    }
    hasInstances_ = true;
    hasVertices_ = table_.handle.get() != VK_NULL_HANDLE;
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
