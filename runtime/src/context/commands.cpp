#include "context/commands.h"

#include "context/vulkan_error.h"

#include <limits>

namespace glint {

Result<CommandRunner> CommandRunner::create(Context::State& context) {
    CommandRunner runner(context);
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = context.handles.queueFamily;
    VkCommandPool pool = VK_NULL_HANDLE;
    const VkDevice device = context.handles.device;
    VkResult result = context.vk.CreateCommandPool(device, &poolInfo, nullptr, &pool);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateCommandPool", result);
    }
    runner.pool_ = UniqueCommandPool(context, pool);

    VkCommandBufferAllocateInfo bufferInfo{};
    bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    bufferInfo.commandPool = pool;
    bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    bufferInfo.commandBufferCount = 1;
    result = context.vk.AllocateCommandBuffers(device, &bufferInfo, &runner.commands_);
    if (result != VK_SUCCESS) {
        return vulkanError("vkAllocateCommandBuffers", result);
    }

    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    result = context.vk.CreateFence(device, &fenceInfo, nullptr, &fence);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateFence", result);
    }
    runner.fence_ = UniqueFence(context, fence);
    return runner;
}

Result<VkCommandBuffer> CommandRunner::begin() {
    VkResult result = context_->vk.ResetCommandPool(context_->handles.device, pool_.get(), 0);
    if (result != VK_SUCCESS) {
        return vulkanError("vkResetCommandPool", result);
    }
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = context_->vk.BeginCommandBuffer(commands_, &info);
    if (result != VK_SUCCESS) {
        return vulkanError("vkBeginCommandBuffer", result);
    }
    return commands_;
}

Status CommandRunner::submitAndWait() {
    const DeviceTable& vk = context_->vk;
    VkResult result = vk.EndCommandBuffer(commands_);
    if (result != VK_SUCCESS) {
        return vulkanError("vkEndCommandBuffer", result);
    }
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = commands_;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    const VkFence fence = fence_.get();
    result = vk.QueueSubmit2(context_->handles.queue, 1, &submit, fence);
    if (result != VK_SUCCESS) {
        return vulkanError("vkQueueSubmit2", result);
    }
    // There is no time limit: a driver ends work that hangs, and a CPU device may take long.
    result = vk.WaitForFences(context_->handles.device, 1, &fence, VK_TRUE,
                              std::numeric_limits<std::uint64_t>::max());
    if (result != VK_SUCCESS) {
        return vulkanError("vkWaitForFences", result);
    }
    result = vk.ResetFences(context_->handles.device, 1, &fence);
    if (result != VK_SUCCESS) {
        return vulkanError("vkResetFences", result);
    }
    return okStatus();
}

Status runOnce(Context::State& context, const std::function<Status(VkCommandBuffer)>& record) {
    GLINT_TRY(auto runner, CommandRunner::create(context));
    GLINT_TRY(const auto commands, runner.begin());
    const Status recorded = record(commands);
    return recorded ? runner.submitAndWait() : recorded;
}

void recordDependency(const Context::State& context, VkCommandBuffer commands,
                      const MemoryDependency& dependency) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = dependency.fromStages;
    barrier.srcAccessMask = dependency.fromAccess;
    barrier.dstStageMask = dependency.toStages;
    barrier.dstAccessMask = dependency.toAccess;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    context.vk.CmdPipelineBarrier2(commands, &info);
}

void recordTransition(const Context::State& context, VkCommandBuffer commands,
                      const ImageTransition& transition) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = transition.dependency.fromStages;
    barrier.srcAccessMask = transition.dependency.fromAccess;
    barrier.dstStageMask = transition.dependency.toStages;
    barrier.dstAccessMask = transition.dependency.toAccess;
    barrier.oldLayout = transition.from;
    barrier.newLayout = transition.to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = transition.image;
    barrier.subresourceRange = {transition.aspect, transition.firstMip, transition.mipCount, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    context.vk.CmdPipelineBarrier2(commands, &info);
}

}  // namespace glint
