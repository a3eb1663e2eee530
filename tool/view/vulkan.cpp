#include "view/vulkan.h"

#include <fmt/format.h>

namespace glint::view {

Diagnostic callError(const char* call, VkResult result) {
    return makeError("vulkan-call", "", fmt::format("{} failed with {}", call, static_cast<int>(result)),
                     result == VK_ERROR_DEVICE_LOST ? "the driver gave up; start again"
                                                    : "use a smaller window, or another device");
}

Status checkCall(const char* call, VkResult result) {
    return result == VK_SUCCESS ? okStatus() : Status(callError(call, result));
}

namespace {

// Allocates memory of the first type that has all these properties. Vulkan has one for each use here.
Result<VkDeviceMemory> allocate(const Context& context, const VkMemoryRequirements& needs,
                                VkMemoryPropertyFlags properties) {
    VkPhysicalDeviceMemoryProperties types{};
    vkGetPhysicalDeviceMemoryProperties(context.handles().physicalDevice, &types);
    std::uint32_t type = 0;
    while (type < types.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1U) == 0 ||
            (types.memoryTypes[type].propertyFlags & properties) != properties)) {
        ++type;
    }
    const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                          .pNext = nullptr,
                                          .allocationSize = needs.size,
                                          .memoryTypeIndex = type};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    GLINT_TRY_DO(checkCall("vkAllocateMemory",
                           vkAllocateMemory(context.handles().device, &allocation, nullptr, &memory)));
    return memory;
}

}  // namespace

Result<HostBuffer> HostBuffer::create(const Context& context, std::size_t bytes) {
    VkDevice device = context.handles().device;
    HostBuffer made;
    made.bytes = bytes;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    GLINT_TRY_DO(checkCall("vkCreateBuffer", vkCreateBuffer(device, &info, nullptr, &made.handle)));
    made.buffer_ = {device, made.handle};
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, made.handle, &needs);
    GLINT_TRY(
        auto memory,
        allocate(context, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT));
    made.memory_ = {device, memory};
    GLINT_TRY_DO(checkCall("vkBindBufferMemory", vkBindBufferMemory(device, made.handle, memory, 0)));
    void* data = nullptr;
    GLINT_TRY_DO(checkCall("vkMapMemory", vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data)));
    made.data = static_cast<std::uint8_t*>(data);
    return made;
}

Result<DeviceImage> DeviceImage::create(const Context& context, std::uint32_t width, std::uint32_t height) {
    VkDevice device = context.handles().device;
    DeviceImage made;
    made.width = width;
    made.height = height;
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
    GLINT_TRY_DO(checkCall("vkCreateImage", vkCreateImage(device, &info, nullptr, &made.image)));
    made.image_ = {device, made.image};
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, made.image, &needs);
    GLINT_TRY(auto memory, allocate(context, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
    made.memory_ = {device, memory};
    GLINT_TRY_DO(checkCall("vkBindImageMemory", vkBindImageMemory(device, made.image, memory, 0)));
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = made.image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = info.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    GLINT_TRY_DO(checkCall("vkCreateImageView", vkCreateImageView(device, &viewInfo, nullptr, &made.view)));
    made.view_ = {device, made.view};
    return made;
}

Status createCommands(const Context& context, VkCommandPool& pool, VkCommandBuffer& commands) {
    VkDevice device = context.handles().device;
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = context.handles().queueFamily;
    GLINT_TRY_DO(checkCall("vkCreateCommandPool", vkCreateCommandPool(device, &poolInfo, nullptr, &pool)));
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    return checkCall("vkAllocateCommandBuffers", vkAllocateCommandBuffers(device, &info, &commands));
}

Result<OneTimeCommands> OneTimeCommands::create(const Context& context) {
    OneTimeCommands made;
    VkCommandPool pool = VK_NULL_HANDLE;
    Status created = createCommands(context, pool, made.commands_);
    made.pool_ = {context.handles().device, pool};
    GLINT_TRY_DO(std::move(created));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    GLINT_TRY_DO(checkCall("vkBeginCommandBuffer", vkBeginCommandBuffer(made.commands_, &begin)));
    return made;
}

Status OneTimeCommands::submit(const Context& context) {
    GLINT_TRY_DO(checkCall("vkEndCommandBuffer", vkEndCommandBuffer(commands_)));
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    return checkCall("vkQueueSubmit", vkQueueSubmit(context.handles().queue, 1, &submit, VK_NULL_HANDLE));
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
