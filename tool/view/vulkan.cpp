#include "view/vulkan.h"

#include <fmt/format.h>

#include <string>

namespace glint::view {

Diagnostic callError(const char* call, VkResult result) {
    return makeError("vulkan-call", "", fmt::format("{} failed with {}", call, static_cast<int>(result)),
                     result == VK_ERROR_DEVICE_LOST ? "the driver gave up; start again"
                                                    : "use a smaller window, or another device");
}

namespace {

// Allocates memory of the first type that has all these properties. Vulkan has one for each use here.
VkResult allocate(const Context& context, const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties,
                  VkDeviceMemory& memory) {
    VkPhysicalDeviceMemoryProperties types{};
    vkGetPhysicalDeviceMemoryProperties(context.handles().physicalDevice, &types);
    std::uint32_t type = 0;
    while (type < types.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1U) == 0 ||
            (types.memoryTypes[type].propertyFlags & properties) != properties)) {
        ++type;
    }
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = type;
    return vkAllocateMemory(context.handles().device, &allocation, nullptr, &memory);
}

}  // namespace

HostBuffer& HostBuffer::operator=(HostBuffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

HostBuffer::~HostBuffer() {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyBuffer(device_, buffer_, nullptr);
        vkFreeMemory(device_, memory_, nullptr);
    }
}

Result<HostBuffer> HostBuffer::create(const Context& context, std::size_t bytes) {
    HostBuffer made;
    made.device_ = context.handles().device;
    made.bytes_ = bytes;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    VkResult result = vkCreateBuffer(made.device_, &info, nullptr, &made.buffer_);
    if (result != VK_SUCCESS) {
        return callError("vkCreateBuffer", result);
    }
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(made.device_, made.buffer_, &needs);
    result =
        allocate(context, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                 made.memory_);
    if (result == VK_SUCCESS) {
        result = vkBindBufferMemory(made.device_, made.buffer_, made.memory_, 0);
    }
    void* data = nullptr;
    if (result == VK_SUCCESS) {
        result = vkMapMemory(made.device_, made.memory_, 0, VK_WHOLE_SIZE, 0, &data);
    }
    made.data_ = static_cast<std::uint8_t*>(data);
    return result == VK_SUCCESS ? Result<HostBuffer>(std::move(made)) : callError("vkAllocateMemory", result);
}

DeviceImage& DeviceImage::operator=(DeviceImage&& other) noexcept {
    std::swap(image, other.image);
    std::swap(view, other.view);
    std::swap(width, other.width);
    std::swap(height, other.height);
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
    return *this;
}

DeviceImage::~DeviceImage() {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyImageView(device_, view, nullptr);
        vkDestroyImage(device_, image, nullptr);
        vkFreeMemory(device_, memory_, nullptr);
    }
}

Result<DeviceImage> DeviceImage::create(const Context& context, std::uint32_t width, std::uint32_t height) {
    DeviceImage made;
    made.width = width;
    made.height = height;
    made.device_ = context.handles().device;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.extent = {width, height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkResult result = vkCreateImage(made.device_, &info, nullptr, &made.image);
    if (result != VK_SUCCESS) {
        return callError("vkCreateImage", result);
    }
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(made.device_, made.image, &needs);
    result = allocate(context, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, made.memory_);
    if (result == VK_SUCCESS) {
        result = vkBindImageMemory(made.device_, made.image, made.memory_, 0);
    }
    if (result != VK_SUCCESS) {
        return callError("vkAllocateMemory", result);
    }
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = made.image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = info.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    result = vkCreateImageView(made.device_, &viewInfo, nullptr, &made.view);
    return result == VK_SUCCESS ? Result<DeviceImage>(std::move(made))
                                : callError("vkCreateImageView", result);
}

Status createCommands(const Context& context, VkCommandPool& pool, VkCommandBuffer& commands) {
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = context.handles().queueFamily;
    VkResult result = vkCreateCommandPool(context.handles().device, &poolInfo, nullptr, &pool);
    if (result != VK_SUCCESS) {
        return callError("vkCreateCommandPool", result);
    }
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    result = vkAllocateCommandBuffers(context.handles().device, &info, &commands);
    return result == VK_SUCCESS ? okStatus() : Status(callError("vkAllocateCommandBuffers", result));
}

Result<OneTimeCommands> OneTimeCommands::create(const Context& context) {
    OneTimeCommands made;
    made.device_ = context.handles().device;
    GLINT_TRY_DO(createCommands(context, made.pool_, made.commands_));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    const VkResult result = vkBeginCommandBuffer(made.commands_, &begin);
    if (result != VK_SUCCESS) {
        return callError("vkBeginCommandBuffer", result);
    }
    return made;
}

OneTimeCommands& OneTimeCommands::operator=(OneTimeCommands&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pool_, other.pool_);
    std::swap(commands_, other.commands_);
    return *this;
}

OneTimeCommands::~OneTimeCommands() {
    if (pool_ != VK_NULL_HANDLE) {
        vkDestroyCommandPool(device_, pool_, nullptr);
    }
}

Status OneTimeCommands::submit(const Context& context) {
    VkResult result = vkEndCommandBuffer(commands_);
    if (result != VK_SUCCESS) {
        return callError("vkEndCommandBuffer", result);
    }
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    result = vkQueueSubmit(context.handles().queue, 1, &submit, VK_NULL_HANDLE);
    return result == VK_SUCCESS ? okStatus() : Status(callError("vkQueueSubmit", result));
}

void recordBarrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void recordLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace glint::view
