#include "context/resources.h"

#include "context/vulkan_table.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

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
    Block block;
    GLINT_TRY(block.memory,
              createHandle<UniqueMemory>(*context_, context_->vk.AllocateMemory, "vkAllocateMemory", info));
    block.type = type;
    block.tiling = tiling;
    block.bytes = bytes;
    block.free.push_back({0, bytes});
    if (map) {
        void* mapped = nullptr;
        const VkResult result = context_->vk.MapMemory(context_->handles.device, block.memory.get(), 0,
                                                       VK_WHOLE_SIZE, 0, &mapped);
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

Result<Buffer> createBuffer(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                            VkBufferUsageFlags usage, MemoryUse use, SharedMemory* shared) {
    Buffer buffer;
    buffer.bytes = std::max<VkDeviceSize>(bytes, 1);
    if (buffer.bytes > context.limits.maxBufferBytes) {
        return makeError("buffer-size", "",
                         "a buffer of " + std::to_string(bytes) + " bytes is above the device's limit of " +
                             std::to_string(context.limits.maxBufferBytes),
                         "split the mesh or use a smaller image");
    }
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = buffer.bytes;
    info.usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    GLINT_TRY(buffer.handle,
              createHandle<UniqueBuffer>(context, context.vk.CreateBuffer, "vkCreateBuffer", info));

    const VkDevice device = context.handles.device;
    const VkBuffer handle = buffer.handle.get();
    VkMemoryRequirements requirements{};
    context.vk.GetBufferMemoryRequirements(device, handle, &requirements);
    Result<Allocation> memory = Allocation{};
    if (shared == nullptr || !shared->take(requirements, *memory)) {
        memory = pool.allocate(requirements, use, Tiling::Linear);
    }
    if (!memory) {
        return memory.error();
    }
    const VkResult result = context.vk.BindBufferMemory(device, handle, memory->memory, memory->offset);
    if (result != VK_SUCCESS) {
        return vulkanError("vkBindBufferMemory", result);
    }
    buffer.memory = *memory;
    buffer.mapped = memory->mapped;
    buffer.use = use;
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = handle;
    buffer.address = context.vk.GetBufferDeviceAddress(device, &address);
    return buffer;
}

Result<UniqueImageView> createImageView(Context::State& context, VkImage image, const ImageInfo& info,
                                        std::uint32_t firstMip) {
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.components = info.components;
    view.subresourceRange = wholeImage(info.aspect);
    view.subresourceRange.baseMipLevel = firstMip;
    return createHandle<UniqueImageView>(context, context.vk.CreateImageView, "vkCreateImageView", view);
}

Result<DeviceImage> createImage(Context::State& context, MemoryPool& pool, const ImageInfo& info,
                                Tiling tiling) {
    DeviceImage image;
    image.format = info.format;
    image.extent = info.extent;
    image.mips = info.mips;
    image.components = info.components;
    VkImageCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = info.format;
    create.extent = {info.extent.width, info.extent.height, 1};
    create.mipLevels = info.mips;
    create.arrayLayers = 1;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = info.usage;
    GLINT_TRY(image.handle,
              createHandle<UniqueImage>(context, context.vk.CreateImage, "vkCreateImage", create));

    const VkDevice device = context.handles.device;
    const VkImage handle = image.handle.get();
    VkMemoryRequirements requirements{};
    context.vk.GetImageMemoryRequirements(device, handle, &requirements);
    image.bytes = requirements.size;
    GLINT_TRY(auto memory, pool.allocate(requirements, MemoryUse::Device, tiling));
    const VkResult result = context.vk.BindImageMemory(device, handle, memory.memory, memory.offset);
    if (result != VK_SUCCESS) {
        return vulkanError("vkBindImageMemory", result);
    }
    image.memory = memory;
    GLINT_TRY(image.view, createImageView(context, handle, info, 0));
    return image;
}

VkImageSubresourceRange wholeImage(VkImageAspectFlags aspect) {
    return {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
}

void addTo(std::vector<MemoryItem>& items, MemoryItem item) {
    const auto known = std::ranges::find_if(items, [&](const MemoryItem& other) {
        return other.name == item.name && other.use == item.use && other.isImage == item.isImage;
    });
    if (known == items.end()) {
        items.push_back(std::move(item));
        return;
    }
    known->count += item.count;
    known->bytes += item.bytes;
}

void addTo(std::vector<MemoryItem>& items, std::string name, const Buffer& buffer) {
    if (buffer.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {std::move(name), buffer.use, false, 1, buffer.bytes});
    }
}

void addTo(std::vector<MemoryItem>& items, std::string name, const DeviceImage& image) {
    if (image.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {std::move(name), MemoryUse::Device, true, 1, image.bytes});
    }
}

}  // namespace glint
