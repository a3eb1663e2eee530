#include "scene/record_arrays.h"

#include "context/commands.h"
#include "context/vulkan_table.h"

#include <cstring>
#include <utility>

namespace glint {
namespace {

constexpr VkBufferUsageFlags kRecordUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

}  // namespace

ArrayUpdate::~ArrayUpdate() {
    for (std::size_t i = 0; i < made_.size(); ++i) {
        discard(*pools_[i], std::move(made_[i]));
    }
    discard(stagingPool_, std::move(staging_));
}

Status ArrayUpdate::prepareBuffers(std::span<const RecordArray> arrays) {
    for (const auto& [records, device, capacity, pool, usage] : arrays) {
        made_.emplace_back();
        pools_.push_back(pool);
        if (capacity == 0 || capacity == records.capacity) {
            continue;
        }
        GLINT_TRY(made_.back(),
                  createBuffer(context_, *pool, capacity * records.stride(), kRecordUsage | usage));
        if (device.handle.get() == VK_NULL_HANDLE) {
            records.touchAll();
        }
    }
    return okStatus();
}

Status ArrayUpdate::prepareStaging(std::span<const RecordArray> arrays) {
    VkDeviceSize bytes = 0;
    for (const RecordArray& array : arrays) {
        for (const IndexRange& range : array.store.dirty()) {
            bytes += (range.end - range.first) * array.store.stride();
        }
    }
    if (bytes > 0) {
        GLINT_TRY(staging_, createBuffer(context_, stagingPool_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                         MemoryUse::Upload));
    }
    return okStatus();
}

bool ArrayUpdate::hasWork() const {
    return staging_.handle.get() != VK_NULL_HANDLE || std::ranges::any_of(made_, [](const Buffer& buffer) {
               return buffer.handle.get() != VK_NULL_HANDLE;
           });
}

void ArrayUpdate::recordResizes(VkCommandBuffer commands, std::span<const RecordArray> arrays,
                                Retired& retired) {
    bool copied = false;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const auto& [records, device, capacity, pool, usage] = arrays[i];
        Buffer& resized = made_[i];
        if (resized.handle.get() == VK_NULL_HANDLE) {
            continue;
        }
        const std::uint32_t kept = std::min({records.capacity, capacity, records.count()});
        if (kept > 0 && device.handle.get() != VK_NULL_HANDLE) {
            const VkBufferCopy region{0, 0, kept * records.stride()};
            context_.vk.CmdCopyBuffer(commands, device.handle.get(), resized.handle.get(), 1, &region);
            copied = true;
        }
        retired.add(std::move(device));
        device = std::move(resized);
        records.capacity = capacity;
    }
    if (copied) {
        recordDependency(context_, commands, kTransferToTransfer);
    }
}

Buffer ArrayUpdate::recordCopies(VkCommandBuffer commands, std::span<const RecordArray> arrays) {
    VkDeviceSize from = 0;
    for (const RecordArray& array : arrays) {
        RecordStore& records = array.store;
        std::vector<VkBufferCopy> regions;
        for (const IndexRange& range : records.dirty()) {
            const std::span<const std::uint8_t> bytes = records.at(range);
            std::memcpy(staging_.mapped + from, bytes.data(), bytes.size());
            regions.push_back({from, range.first * records.stride(), bytes.size()});
            from += bytes.size();
        }
        if (!regions.empty() && array.device.handle.get() != VK_NULL_HANDLE) {
            context_.vk.CmdCopyBuffer(commands, staging_.handle.get(), array.device.handle.get(),
                                      static_cast<std::uint32_t>(regions.size()), regions.data());
        }
        records.clearDirty();
    }
    return std::exchange(staging_, {});
}

}  // namespace glint
