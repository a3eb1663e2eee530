#include "context/resources.h"

#include "context/vulkan_table.h"

#include <algorithm>
#include <string>
#include <utility>

namespace glint {
namespace {

// The largest size of a block. maxMemoryAllocationCount is at least 4096, and 4096 blocks of this size make
// 256 GiB. Blocks of a memory type double up to it, so that small scenes take little memory.
constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kFirstBlockBytes = VkDeviceSize{1} << 20;
// The most that a block without resources has.
constexpr VkDeviceSize kSpareBytes = VkDeviceSize{4} << 20;

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

// Returns the types of memory that fit, those with the preferred flags first.
std::vector<std::uint32_t> suitableTypes(const VkPhysicalDeviceMemoryProperties& memory,
                                         std::uint32_t typeBits, MemoryUse use) {
    // Memory with other flags needs features, or special resources.
    constexpr VkMemoryPropertyFlags kOrdinary =
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
        VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    std::vector<std::uint32_t> types;
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
        const VkMemoryPropertyFlags flags = memory.memoryTypes[type].propertyFlags;
        if ((typeBits >> type & 1U) != 0 && (flags & ~kOrdinary) == 0 &&
            (flags & requiredFlags(use)) == requiredFlags(use)) {
            types.push_back(type);
        }
    }
    std::stable_partition(types.begin(), types.end(), [&](std::uint32_t type) {
        return (memory.memoryTypes[type].propertyFlags & preferredFlags(use)) == preferredFlags(use);
    });
    return types;
}

}  // namespace

DeviceMemory::~DeviceMemory() {
    if (context_ == nullptr) {
        return;
    }
    if (context_->services.freeMemory) {
        context_->services.freeMemory(range_);
    } else {
        context_->vk.FreeMemory(context_->handles.device, range_.memory, context_->services.allocation);
    }
}

Memory SharedMemory::take(const VkMemoryRequirements& requirements) {
    const VkDeviceSize offset = alignUp(begin, requirements.alignment);
    if (memory == nullptr || (requirements.memoryTypeBits >> memory->type & 1U) == 0 ||
        offset + requirements.size > end) {
        return nullptr;
    }
    begin = offset + requirements.size;
    return std::make_shared<const Allocation>(
        Allocation{memory->memory, offset, nullptr, memory->type, memory->pool, memory});
}

Result<MemoryBlocks::Block*> MemoryPool::addBlock(const HostServices::MemoryRange& range, Tiling tiling,
                                                  VkDeviceSize bytes, MemoryUse use) {
    Block block;
    block.memory = DeviceMemory(*context_, range);
    block.tiling = tiling;
    block.bytes = bytes;
    block.free.push_back({0, bytes});
    if (use != MemoryUse::Device) {
        void* mapped = nullptr;
        GLINT_TRY_DO(
            statusOf("vkMapMemory", context_->services.mapMemory
                                        ? context_->services.mapMemory(range, mapped)
                                        : context_->vk.MapMemory(context_->handles.device, range.memory, 0,
                                                                 VK_WHOLE_SIZE, 0, &mapped)));
        block.mapped = static_cast<std::uint8_t*>(mapped);
    }
    blocks_->all.push_back(std::move(block));
    return &blocks_->all.back();
}

Result<MemoryBlocks::Block*> MemoryPool::askHost(const VkMemoryRequirements& requirements, MemoryUse use,
                                                 Tiling tiling) {
    const std::string name = context_->services.namePrefix + name_;
    // The depth image shares its memory with buffers, which have addresses.
    const HostServices::MemoryRequest request{
        .requirements = requirements,
        .use = use,
        .required = requiredFlags(use),
        .preferred = preferredFlags(use),
        .flags =
            tiling == Tiling::Optimal ? 0U : VkMemoryAllocateFlags{VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT},
        .isImage = tiling != Tiling::Linear,
        .name = name.c_str()};
    HostServices::MemoryRange range;
    GLINT_TRY_DO(statusOf("HostServices::allocateMemory", context_->services.allocateMemory(request, range)));
    GLINT_TRY(Block* const block, addBlock(range, tiling, requirements.size, use));
    block->isOfHost = true;
    return block;
}

Result<MemoryBlocks::Block*> MemoryPool::makeBlock(std::uint32_t type, Tiling tiling, VkDeviceSize bytes,
                                                   MemoryUse use) {
    if (bytes > context_->limits.maxAllocationBytes) {
        return makeError("memory-size", "",
                         phrase("a resource of ", bytes, " bytes is above the device's limit of ",
                                context_->limits.maxAllocationBytes),
                         "split the mesh or use smaller textures");
    }
    if (blocks_->all.size() >= context_->limits.core.maxMemoryAllocationCount) {
        return makeError("memory-count", "", "the scene needs more memory allocations than the device has",
                         "use a smaller scene");
    }
    const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                          .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                              .pNext = tiling == Tiling::Optimal ? nullptr : &flags,
                              .allocationSize = bytes,
                              .memoryTypeIndex = type};
    HostServices::MemoryRange range{.type = type};
    GLINT_TRY_DO(statusOf("vkAllocateMemory",
                          context_->vk.AllocateMemory(context_->handles.device, &info,
                                                      context_->services.allocation, &range.memory)));
    nameObject(*context_, VK_OBJECT_TYPE_DEVICE_MEMORY,
               (std::uint64_t)range.memory,  // NOLINT: may be a number
               name_);
    return addBlock(range, tiling, bytes, use);
}

Result<MemoryBlocks::Block*> MemoryPool::findBlock(std::uint32_t type,
                                                   const VkMemoryRequirements& requirements, MemoryUse use,
                                                   Tiling tiling) {
    // Linear and optimal resources never share a block, which satisfies bufferImageGranularity.
    const auto block = std::ranges::find_if(blocks_->all, [&](Block& candidate) {
        const bool reachable = use == MemoryUse::Device || candidate.mapped != nullptr;
        return candidate.memory.range().type == type && candidate.tiling == tiling && reachable &&
               candidate.findRoom(requirements) != candidate.free.end();
    });
    if (block != blocks_->all.end()) {
        return &*block;
    }
    // A block takes at most an eighth of the heap, so that one block does not fill a small heap.
    const VkPhysicalDeviceMemoryProperties& memory = context_->limits.memory;
    const VkDeviceSize heap = memory.memoryHeaps[memory.memoryTypes[type].heapIndex].size;
    VkDeviceSize taken = kFirstBlockBytes;
    for (const Block& other : blocks_->all) {
        taken += other.memory.range().type == type && other.tiling == tiling ? other.bytes : 0;
    }
    // Few resources share memory, so these blocks are no larger than they need to be.
    const VkDeviceSize usual = tiling == Tiling::Shared ? 0 : std::min({kBlockBytes, heap / 8, taken});
    Result<Block*> made = makeBlock(type, tiling, std::max(usual, requirements.size), use);
    if (!made && made.error().kind == ErrorKind::OutOfDeviceMemory && usual > requirements.size) {
        made = makeBlock(type, tiling, requirements.size, use);
    }
    return made;
}

Result<Memory> MemoryPool::allocate(const VkMemoryRequirements& requirements, MemoryUse use, Tiling tiling) {
    Result<Block*> found =
        makeError("memory-type", "", "the device has no memory of the kind that a resource needs",
                  "update the driver or use another device");
    if (context_->services.allocateMemory) {
        found = askHost(requirements, use, tiling);
    } else {
        const VkPhysicalDeviceMemoryProperties& memory = context_->limits.memory;
        std::uint32_t fullHeaps = 0;
        for (const std::uint32_t type : suitableTypes(memory, requirements.memoryTypeBits, use)) {
            const std::uint32_t heap = 1U << memory.memoryTypes[type].heapIndex;
            if ((fullHeaps & heap) != 0) {
                continue;
            }
            found = findBlock(type, requirements, use, tiling);
            if (found || found.error().kind != ErrorKind::OutOfDeviceMemory) {
                break;
            }
            fullHeaps |= heap;
        }
        if (found && fullHeaps != 0) {
            context_->jobs.report(makeWarning("memory-heap", name_,
                                              "the heap for this memory is full, and another one is used",
                                              "use a smaller scene, smaller textures or a smaller image"));
        }
    }
    if (!found) {
        return found.error();
    }
    Block& block = **found;
    const HostServices::MemoryRange& range = block.memory.range();
    const auto room = block.findRoom(requirements);
    const VkDeviceSize inBlock = alignUp(room->begin, requirements.alignment);
    // The range that is given back includes the gap before the resource.
    const MemoryBlocks::Range taken{room->begin, inBlock + requirements.size};
    room->begin = taken.end;
    if (room->begin == room->end) {
        block.free.erase(room);
    }
    const auto give = [blocks = blocks_, taken](const Allocation* place) {
        blocks->release(*place, taken);
        delete place;
    };
    return Memory(new Allocation{range.memory,
                                 range.offset + inBlock,
                                 block.mapped == nullptr ? nullptr : block.mapped + inBlock,
                                 range.type,
                                 blocks_.get(),
                                 {}},
                  give);
}

std::vector<MemoryBlocks::Range>::iterator MemoryBlocks::Block::findRoom(
    const VkMemoryRequirements& requirements) {
    return std::ranges::find_if(free, [&](const Range& range) {
        return alignUp(range.begin, requirements.alignment) + requirements.size <= range.end;
    });
}

void MemoryBlocks::release(const Allocation& place, const Range& range) {
    const auto block = std::ranges::find_if(all, [&](const Block& candidate) {
        const HostServices::MemoryRange& whole = candidate.memory.range();
        return whole.memory == place.memory && place.offset >= whole.offset &&
               place.offset < whole.offset + candidate.bytes;
    });
    std::vector<Range>& free = block->free;
    auto added = free.insert(std::ranges::lower_bound(free, range.begin, {}, &Range::begin), range);
    if (const auto next = added + 1; next != free.end() && next->begin == added->end) {
        added->end = next->end;
        free.erase(next);
    }
    if (added != free.begin() && (added - 1)->end == added->begin) {
        (added - 1)->end = added->end;
        free.erase(added);
    }
    if (!block->isEmpty()) {
        return;
    }
    const auto spare = std::ranges::find_if(all, [&](const Block& other) {
        return &other != &*block && other.isEmpty() && other.tiling == block->tiling &&
               other.memory.range().type == block->memory.range().type &&
               (other.mapped == nullptr) == (block->mapped == nullptr);
    });
    if (!keepsSpare || block->isOfHost || block->bytes > kSpareBytes) {
        all.erase(block);
    } else if (spare != all.end()) {
        all.erase(spare->bytes < block->bytes ? spare : block);
    }
}

VkDeviceSize MemoryBlocks::bytes() const {
    VkDeviceSize sum = 0;
    for (const Block& block : all) {
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
                         phrase("a buffer of ", bytes, " bytes is above the device's limit of ",
                                context.limits.maxBufferBytes),
                         "split the mesh or use a smaller image");
    }
    const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                  .size = buffer.bytes,
                                  .usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT};
    GLINT_TRY(buffer.handle, createHandle<UniqueBuffer>(context, context.vk.CreateBuffer, "vkCreateBuffer",
                                                        info, pool.name()));

    const VkDevice device = context.handles.device;
    const VkBuffer handle = buffer.handle.get();
    VkMemoryRequirements requirements{};
    context.vk.GetBufferMemoryRequirements(device, handle, &requirements);
    buffer.memory = shared != nullptr ? shared->take(requirements) : nullptr;
    if (buffer.memory == nullptr) {
        GLINT_TRY(buffer.memory, pool.allocate(requirements, use, Tiling::Linear));
    }
    GLINT_TRY_DO(
        statusOf("vkBindBufferMemory",
                 context.vk.BindBufferMemory(device, handle, buffer.memory->memory, buffer.memory->offset)));
    buffer.mapped = buffer.memory->mapped;
    buffer.use = use;
    VkBufferDeviceAddressInfo address{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                      .buffer = handle};
    buffer.address = context.vk.GetBufferDeviceAddress(device, &address);
    return buffer;
}

Result<AlignedBuffer> createAligned(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                    VkDeviceSize alignment, VkBufferUsageFlags usage, MemoryUse use) {
    GLINT_TRY(auto buffer, createBuffer(context, pool, bytes + alignment, usage, use));
    const VkDeviceAddress address = alignUp(buffer.address, alignment);
    return AlignedBuffer{std::move(buffer), address};
}

namespace {

// By TextureEntry::Dimension.
struct DimensionInfo {
    VkImageViewType view;
    VkImageType image;
    VkImageCreateFlags flags;
};
constexpr DimensionInfo kDimensions[] = {
    {VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_TYPE_2D, 0},
    {VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_IMAGE_TYPE_2D, 0},
    {VK_IMAGE_VIEW_TYPE_CUBE, VK_IMAGE_TYPE_2D, VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT},
    {VK_IMAGE_VIEW_TYPE_3D, VK_IMAGE_TYPE_3D, 0}};

}  // namespace

Result<UniqueImageView> createImageView(Context::State& context, VkImage image, const ImageInfo& info,
                                        std::uint32_t firstMip) {
    VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                               .image = image,
                               .viewType = kDimensions[static_cast<std::size_t>(info.dimension)].view,
                               .format = info.format,
                               .components = info.components,
                               .subresourceRange = wholeImage(info.aspect)};
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
    image.dimension = info.dimension;
    image.layers = info.layers;
    const DimensionInfo& dimension = kDimensions[static_cast<std::size_t>(info.dimension)];
    const bool isVolume = info.dimension == package::TextureEntry::Dimension::Volume;
    const VkImageCreateInfo create{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .flags = dimension.flags,
        .imageType = dimension.image,
        .format = info.format,
        .extent = {info.extent.width, info.extent.height, isVolume ? info.layers : 1},
        .mipLevels = info.mips,
        .arrayLayers = isVolume ? 1 : info.layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = info.usage};
    GLINT_TRY(image.handle, createHandle<UniqueImage>(context, context.vk.CreateImage, "vkCreateImage",
                                                      create, pool.name()));

    const VkDevice device = context.handles.device;
    const VkImage handle = image.handle.get();
    VkMemoryRequirements requirements{};
    context.vk.GetImageMemoryRequirements(device, handle, &requirements);
    image.bytes = requirements.size;
    GLINT_TRY(image.memory, pool.allocate(requirements, MemoryUse::Device, tiling));
    GLINT_TRY_DO(
        statusOf("vkBindImageMemory",
                 context.vk.BindImageMemory(device, handle, image.memory->memory, image.memory->offset)));
    GLINT_TRY(image.view, createImageView(context, handle, info, 0));
    return image;
}

VkImageSubresourceRange wholeImage(VkImageAspectFlags aspect) {
    return {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
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
