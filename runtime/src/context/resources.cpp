#include "context/resources.h"

#include "context/vulkan_error.h"

#include <algorithm>
#include <string>
#include <utility>

namespace glint {

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
    VkBuffer handle = VK_NULL_HANDLE;
    const VkDevice device = context.handles.device;
    VkResult result = context.vk.CreateBuffer(device, &info, nullptr, &handle);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateBuffer", result);
    }
    buffer.handle = UniqueBuffer(context, handle);

    VkMemoryRequirements requirements{};
    context.vk.GetBufferMemoryRequirements(device, handle, &requirements);
    Result<Allocation> memory = Allocation{};
    if (shared == nullptr || !shared->take(requirements, *memory)) {
        memory = pool.allocate(requirements, use, Tiling::Linear);
    }
    if (!memory) {
        return memory.error();
    }
    result = context.vk.BindBufferMemory(device, handle, memory->memory, memory->offset);
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
    VkImage handle = VK_NULL_HANDLE;
    const VkDevice device = context.handles.device;
    VkResult result = context.vk.CreateImage(device, &create, nullptr, &handle);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateImage", result);
    }
    image.handle = UniqueImage(context, handle);

    VkMemoryRequirements requirements{};
    context.vk.GetImageMemoryRequirements(device, handle, &requirements);
    image.bytes = requirements.size;
    GLINT_TRY(auto memory, pool.allocate(requirements, MemoryUse::Device, tiling));
    result = context.vk.BindImageMemory(device, handle, memory.memory, memory.offset);
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

}  // namespace glint
