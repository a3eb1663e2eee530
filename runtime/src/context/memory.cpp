#include "context/memory.h"

#include "context/vulkan_error.h"

#include <algorithm>
#include <optional>
#include <string>

namespace glint {
namespace {

// The largest size of a block. maxMemoryAllocationCount is at least 4096, and 4096 blocks of this size make
// 256 GiB. Blocks of a memory type double up to it, so that small scenes take little memory.
constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kFirstBlockBytes = VkDeviceSize{1} << 20;

VkMemoryPropertyFlags requiredFlags(MemoryUse use) {
    return use == MemoryUse::Device
               ? VkMemoryPropertyFlags{0}
               : VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

VkMemoryPropertyFlags preferredFlags(MemoryUse use) {
    switch (use) {
        case MemoryUse::Device:
        case MemoryUse::Shared:
            return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        case MemoryUse::Readback:
            return VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        case MemoryUse::Upload:
            break;
    }
    return 0;
}

std::optional<std::uint32_t> chooseType(const VkPhysicalDeviceMemoryProperties& memory,
                                        std::uint32_t typeBits, VkMemoryPropertyFlags flags) {
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
        if ((typeBits >> type & 1U) != 0 && (memory.memoryTypes[type].propertyFlags & flags) == flags) {
            return type;
        }
    }
    return std::nullopt;
}

}  // namespace

bool SharedMemory::take(const VkMemoryRequirements& requirements, Allocation& taken) {
    const VkDeviceSize offset = alignUp(begin, requirements.alignment);
    if (memory.memory == VK_NULL_HANDLE || (requirements.memoryTypeBits >> memory.type & 1U) == 0 ||
        offset + requirements.size > end) {
        return false;
    }
    // The pool has already handed out this memory, so there is nothing to give back.
    taken = Allocation{};
    taken.memory = memory.memory;
    taken.offset = offset;
    taken.type = memory.type;
    begin = offset + requirements.size;
    return true;
}

Result<MemoryPool::Block> MemoryPool::makeBlock(std::uint32_t type, Tiling tiling, VkDeviceSize bytes,
                                                bool map) {
    if (bytes > context_->limits.maxAllocationBytes) {
        return makeError("memory-size", "",
                         "a resource of " + std::to_string(bytes) + " bytes is above the device's limit of " +
                             std::to_string(context_->limits.maxAllocationBytes),
                         "split the mesh or use smaller textures");
    }
    if (blocks_.size() >= context_->limits.core.maxMemoryAllocationCount) {
        return makeError("memory-count", "", "the scene needs more memory allocations than the device has",
                         "use a smaller scene");
    }
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.pNext = tiling == Tiling::Optimal ? nullptr : &flags;
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkResult result = context_->vk.AllocateMemory(context_->handles.device, &info, nullptr, &memory);
    if (result != VK_SUCCESS) {
        return vulkanError("vkAllocateMemory", result);
    }
    Block block;
    block.memory = UniqueMemory(*context_, memory);
    block.type = type;
    block.tiling = tiling;
    block.bytes = bytes;
    block.free.push_back({0, bytes});
    if (map) {
        void* mapped = nullptr;
        result = context_->vk.MapMemory(context_->handles.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) {
            return vulkanError("vkMapMemory", result);
        }
        block.mapped = static_cast<std::uint8_t*>(mapped);
    }
    return block;
}

Result<Allocation> MemoryPool::allocate(const VkMemoryRequirements& requirements, MemoryUse use,
                                        Tiling tiling) {
    const VkPhysicalDeviceMemoryProperties& memory = context_->limits.memory;
    std::optional<std::uint32_t> type =
        chooseType(memory, requirements.memoryTypeBits, requiredFlags(use) | preferredFlags(use));
    if (!type) {
        type = chooseType(memory, requirements.memoryTypeBits, requiredFlags(use));
    }
    if (!type) {
        return makeError("memory-type", "", "the device has no memory of the kind that a resource needs",
                         "update the driver or use another device");
    }
    // Linear and optimal resources never share a block, which satisfies bufferImageGranularity.
    auto block = std::ranges::find_if(blocks_, [&](Block& candidate) {
        const bool reachable = use == MemoryUse::Device || candidate.mapped != nullptr;
        return candidate.type == *type && candidate.tiling == tiling && reachable &&
               candidate.findRoom(requirements) != candidate.free.end();
    });
    if (block == blocks_.end()) {
        // A block takes at most an eighth of the heap, so that one block does not fill a small heap.
        const VkDeviceSize heap = memory.memoryHeaps[memory.memoryTypes[*type].heapIndex].size;
        VkDeviceSize taken = kFirstBlockBytes;
        for (const Block& other : blocks_) {
            taken += other.type == *type && other.tiling == tiling ? other.bytes : 0;
        }
        // Few resources share memory, so these blocks are no larger than they need to be.
        const VkDeviceSize usual = tiling == Tiling::Shared ? 0 : std::min({kBlockBytes, heap / 8, taken});
        GLINT_TRY(auto made,
                  makeBlock(*type, tiling, std::max(usual, requirements.size), use != MemoryUse::Device));
        blocks_.push_back(std::move(made));
        block = blocks_.end() - 1;
    }
    Allocation allocation;
    allocation.memory = block->memory.get();
    allocation.type = block->type;
    const auto room = block->findRoom(requirements);
    allocation.begin = room->begin;
    allocation.offset = alignUp(room->begin, requirements.alignment);
    allocation.bytes = allocation.offset + requirements.size - allocation.begin;
    allocation.mapped = block->mapped == nullptr ? nullptr : block->mapped + allocation.offset;
    room->begin += allocation.bytes;
    if (room->begin == room->end) {
        block->free.erase(room);
    }
    return allocation;
}

std::vector<MemoryPool::Range>::iterator MemoryPool::Block::findRoom(
    const VkMemoryRequirements& requirements) {
    return std::ranges::find_if(free, [&](const Range& range) {
        return alignUp(range.begin, requirements.alignment) + requirements.size <= range.end;
    });
}

void MemoryPool::release(const Allocation& allocation) {
    const auto block = std::ranges::find_if(
        blocks_, [&](const Block& candidate) { return candidate.memory.get() == allocation.memory; });
    if (block == blocks_.end() || allocation.bytes == 0) {
        return;
    }
    std::vector<Range>& free = block->free;
    auto place = std::ranges::lower_bound(free, allocation.begin, {}, &Range::begin);
    place = free.insert(place, {allocation.begin, allocation.begin + allocation.bytes});
    if (const auto next = place + 1; next != free.end() && next->begin == place->end) {
        place->end = next->end;
        free.erase(next);
    }
    if (place != free.begin() && (place - 1)->end == place->begin) {
        (place - 1)->end = place->end;
        free.erase(place);
    }
    if (free.front().begin == 0 && free.front().end == block->bytes) {
        blocks_.erase(block);
    }
}

VkDeviceSize MemoryPool::bytes() const {
    VkDeviceSize sum = 0;
    for (const Block& block : blocks_) {
        sum += block.bytes;
    }
    return sum;
}

}  // namespace glint
