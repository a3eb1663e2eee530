#include "scene/record_store.h"

#include "context/commands.h"
#include "context/vulkan_table.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

namespace glint {

void RunAllocator::insert(std::uint32_t first, std::uint32_t count) {
    free_.emplace(first, count);
    bySize_.emplace(count, first);
}

void RunAllocator::erase(Place place) {
    bySize_.erase({place->second, place->first});
    free_.erase(place);
}

std::uint32_t RunAllocator::allocate(std::uint32_t count) {
    const auto room = bySize_.lower_bound({count, 0});
    if (count == 0 || room == bySize_.end()) {
        const std::uint32_t first = count == 0 ? 0 : end_;
        end_ += count;
        return first;
    }
    const auto [size, first] = *room;
    erase(free_.find(first));
    if (size > count) {
        insert(first + count, size - count);
    }
    return first;
}

void RunAllocator::release(std::uint32_t first, std::uint32_t count) {
    if (count == 0) {
        return;
    }
    const auto next = free_.lower_bound(first);
    const bool touchesNext = next != free_.end() && next->first == first + count;
    const auto before = next == free_.begin() ? free_.end() : std::prev(next);
    const bool touchesBefore = before != free_.end() && before->first + before->second == first;
    if (touchesNext) {
        count += next->second;
        erase(next);
    }
    if (touchesBefore) {
        first = before->first;
        count += before->second;
        erase(before);
    }
    if (first + count == end_) {
        end_ = first;
    } else {
        insert(first, count);
    }
}

void RecordStore::writeBytes(std::uint32_t index, std::span<const std::uint8_t> record) {
    const std::size_t place = index * stride_;
    if (bytes_.size() < place + stride_) {
        bytes_.resize(place + stride_);
    }
    std::ranges::copy(record, bytes_.begin() + static_cast<std::ptrdiff_t>(place));
    if (!dirty_.empty() && dirty_.back().end == index) {
        ++dirty_.back().end;
    } else {
        dirty_.push_back({index, index + 1});
    }
}

void RecordStore::replaceBytes(std::span<const std::uint8_t> records) {
    const auto wanted = static_cast<std::uint32_t>(records.size() / stride_);
    shrink(wanted);
    for (std::uint32_t index = 0; index < wanted; ++index) {
        const std::span<const std::uint8_t> record = records.subspan(index * stride_, stride_);
        if (index >= count() || !std::ranges::equal(record, at(index))) {
            writeBytes(index, record);
        }
    }
}

void RecordStore::shrink(std::uint32_t count) {
    if (count < this->count()) {
        bytes_.resize(count * stride_);
        std::erase_if(dirty_, [&](const IndexRange& range) { return range.first >= count; });
        for (IndexRange& range : dirty_) {
            range.end = std::min(range.end, count);
        }
    }
}

std::vector<IndexRange> RecordStore::dirty() const {
    std::vector<IndexRange> sorted = dirty_;
    std::ranges::sort(sorted, {}, &IndexRange::first);
    std::vector<IndexRange> runs;
    for (const IndexRange& range : sorted) {
        if (!runs.empty() && range.first <= runs.back().end) {
            runs.back().end = std::max(runs.back().end, range.end);
        } else {
            runs.push_back(range);
        }
    }
    return runs;
}

namespace {

constexpr VkBufferUsageFlags kRecordUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

}  // namespace

Status ArrayUpdate::prepareBuffers(std::span<const ArrayTarget> arrays) {
    for (const auto& [records, capacity, pool, usage] : arrays) {
        made_.emplace_back();
        if (capacity == 0 || capacity == records.capacity) {
            continue;
        }
        GLINT_TRY(made_.back(),
                  createBuffer(context_, *pool, capacity * records.stride(), kRecordUsage | usage));
        if (records.device.handle.get() == VK_NULL_HANDLE) {
            records.touchAll();
        }
    }
    return okStatus();
}

Status ArrayUpdate::prepareStaging(std::span<const ArrayTarget> arrays) {
    VkDeviceSize bytes = 0;
    for (const ArrayTarget& target : arrays) {
        for (const IndexRange& range : target.array.dirty()) {
            bytes += (range.end - range.first) * target.array.stride();
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

void ArrayUpdate::recordResizes(VkCommandBuffer commands, std::span<const ArrayTarget> arrays,
                                Retired& retired) {
    bool copied = false;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const auto& [records, capacity, pool, usage] = arrays[i];
        Buffer& device = records.device;
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

Buffer ArrayUpdate::recordCopies(VkCommandBuffer commands, std::span<const ArrayTarget> arrays) {
    VkDeviceSize from = 0;
    for (const ArrayTarget& target : arrays) {
        RecordArray& records = target.array;
        std::vector<VkBufferCopy> regions;
        for (const IndexRange& range : records.dirty()) {
            const std::span<const std::uint8_t> bytes = records.at(range);
            std::memcpy(staging_.mapped + from, bytes.data(), bytes.size());
            regions.push_back({from, range.first * records.stride(), bytes.size()});
            from += bytes.size();
        }
        if (!regions.empty() && records.device.handle.get() != VK_NULL_HANDLE) {
            context_.vk.CmdCopyBuffer(commands, staging_.handle.get(), records.device.handle.get(),
                                      static_cast<std::uint32_t>(regions.size()), regions.data());
        }
        records.clearDirty();
    }
    return std::exchange(staging_, {});
}

}  // namespace glint
