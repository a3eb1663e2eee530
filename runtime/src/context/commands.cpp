#include "context/commands.h"

#include "context/vulkan_table.h"

#include <limits>
#include <string>

namespace glint {

Result<CommandRunner> CommandRunner::create(Context::State& context) {
    CommandRunner runner(context);
    const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = context.handles.queueFamily};
    GLINT_TRY(runner.pool_, createHandle<UniqueCommandPool>(context, context.vk.CreateCommandPool,
                                                            "vkCreateCommandPool", poolInfo));

    VkCommandBufferAllocateInfo bufferInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = runner.pool_.get(),
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    GLINT_TRY_DO(
        statusOf("vkAllocateCommandBuffers",
                 context.vk.AllocateCommandBuffers(context.handles.device, &bufferInfo, &runner.commands_)));
    nameObject(context, VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<std::uint64_t>(runner.commands_),
               "commands");

    const VkFenceCreateInfo fenceInfo{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    GLINT_TRY(runner.fence_,
              createHandle<UniqueFence>(context, context.vk.CreateFence, "vkCreateFence", fenceInfo));
    return runner;
}

Result<VkCommandBuffer> CommandRunner::begin() {
    GLINT_TRY_DO(statusOf("vkResetCommandPool",
                          context_->vk.ResetCommandPool(context_->handles.device, pool_.get(), 0)));
    VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                  .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    GLINT_TRY_DO(statusOf("vkBeginCommandBuffer", context_->vk.BeginCommandBuffer(commands_, &info)));
    return commands_;
}

Status CommandRunner::submitAndWait() {
    const DeviceTable& vk = context_->vk;
    GLINT_TRY_DO(statusOf("vkEndCommandBuffer", vk.EndCommandBuffer(commands_)));
    VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                       .commandBuffer = commands_};
    VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                         .commandBufferInfoCount = 1,
                         .pCommandBufferInfos = &commands};
    const VkFence fence = fence_.get();
    {
        const QueueLock lock(*context_);
        GLINT_TRY_DO(statusOf("vkQueueSubmit2", vk.QueueSubmit2(context_->handles.queue, 1, &submit, fence)));
    }
    // There is no time limit: a driver ends work that hangs, and a CPU device may take long.
    GLINT_TRY_DO(statusOf("vkWaitForFences", vk.WaitForFences(context_->handles.device, 1, &fence, VK_TRUE,
                                                              std::numeric_limits<std::uint64_t>::max())));
    return statusOf("vkResetFences", vk.ResetFences(context_->handles.device, 1, &fence));
}

Status runOnce(Context::State& context, const std::function<Status(VkCommandBuffer)>& record) {
    GLINT_TRY(auto runner, CommandRunner::create(context));
    GLINT_TRY(const auto commands, runner.begin());
    const Status recorded = record(commands);
    return recorded ? runner.submitAndWait() : recorded;
}

void recordDependency(const Context::State& context, VkCommandBuffer commands,
                      const MemoryDependency& dependency) {
    VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                             .srcStageMask = dependency.fromStages,
                             .srcAccessMask = dependency.fromAccess,
                             .dstStageMask = dependency.toStages,
                             .dstAccessMask = dependency.toAccess};
    VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    context.vk.CmdPipelineBarrier2(commands, &info);
}

void recordTransition(const Context::State& context, VkCommandBuffer commands,
                      const ImageTransition& transition) {
    VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                  .srcStageMask = transition.dependency.fromStages,
                                  .srcAccessMask = transition.dependency.fromAccess,
                                  .dstStageMask = transition.dependency.toStages,
                                  .dstAccessMask = transition.dependency.toAccess,
                                  .oldLayout = transition.from,
                                  .newLayout = transition.to,
                                  .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .image = transition.image,
                                  .subresourceRange = {transition.aspect, transition.firstMip,
                                                       transition.mipCount, 0, VK_REMAINING_ARRAY_LAYERS}};
    VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                          .imageMemoryBarrierCount = 1,
                          .pImageMemoryBarriers = &barrier};
    context.vk.CmdPipelineBarrier2(commands, &info);
}

void beginLabel(const Context::State& context, VkCommandBuffer commands, std::string_view name) {
    if (context.vk.CmdBeginDebugUtilsLabelEXT != nullptr) {
        const std::string text = context.services.namePrefix + std::string(name);
        VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                   .pLabelName = text.c_str()};
        context.vk.CmdBeginDebugUtilsLabelEXT(commands, &label);
    }
}

void endLabel(const Context::State& context, VkCommandBuffer commands) {
    if (context.vk.CmdEndDebugUtilsLabelEXT != nullptr) {
        context.vk.CmdEndDebugUtilsLabelEXT(commands);
    }
}

namespace {

// The queries of a stretch are its begin and its end, each followed by an echo that is never read. Mesa's
// lavapipe delays a timestamp until the next one is recorded. The echo makes it take the first one at once.
constexpr std::uint32_t kBegin = 0;
constexpr std::uint32_t kEnd = 2;
constexpr std::uint32_t kQueriesPerStretch = 4;

}  // namespace

Result<Timer> Timer::create(Context::State& context, std::uint32_t capacity) {
    Timer timer(context);
    if (context.limits.timestampValidBits == 0) {
        return timer;
    }
    timer.queries_ = kQueriesPerStretch * capacity;
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = timer.queries_};
    GLINT_TRY(timer.pool_,
              createHandle<UniqueQueryPool>(context, context.vk.CreateQueryPool, "vkCreateQueryPool", info));
    // It is not allowed to read a query that was never reset, but one without a result may be read.
    context.vk.ResetQueryPool(context.handles.device, timer.pool_.get(), 0, timer.queries_);
    return timer;
}

void Timer::recordReset(VkCommandBuffer commands) const {
    if (available()) {
        context_->vk.CmdResetQueryPool(commands, pool_.get(), 0, queries_);
    }
}

void Timer::recordBegin(VkCommandBuffer commands, std::uint32_t stretch) const {
    recordMark(commands, kQueriesPerStretch * stretch + kBegin);
}

void Timer::recordEnd(VkCommandBuffer commands, std::uint32_t stretch) const {
    recordMark(commands, kQueriesPerStretch * stretch + kEnd);
}

void Timer::recordMark(VkCommandBuffer commands, std::uint32_t query) const {
    if (available()) {
        for (std::uint32_t echo = 0; echo < 2; ++echo) {
            context_->vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(),
                                            query + echo);
        }
    }
}

Result<std::vector<double>> Timer::read(std::uint32_t count) const {
    if (!available()) {
        return makeError("timings-unavailable", "", "the device's queue has no timestamps",
                         "use a queue family whose timestampValidBits is not 0");
    }
    std::vector<std::uint64_t> ticks(std::size_t{kQueriesPerStretch} * count);
    if (count > 0) {
        const VkResult result =
            context_->vk.GetQueryPoolResults(context_->handles.device, pool_.get(), 0,
                                             kQueriesPerStretch * count, ticks.size() * sizeof(std::uint64_t),
                                             ticks.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
        if (result == VK_NOT_READY) {
            return makeError("timings-pending", "", "the device has not finished the recording",
                             "wait for the submission before reading its timings");
        }
        GLINT_TRY_DO(statusOf("vkGetQueryPoolResults", result));
    }
    const std::uint32_t bits = context_->limits.timestampValidBits;
    const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    std::vector<double> milliseconds(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        // The difference modulo the valid bits is correct even if the counter wraps once in between.
        const std::uint64_t* stretch = &ticks[std::size_t{kQueriesPerStretch} * i];
        const std::uint64_t elapsed = (stretch[kEnd] - stretch[kBegin]) & mask;
        milliseconds[i] = static_cast<double>(elapsed) * context_->limits.core.timestampPeriod * 1e-6;
    }
    return milliseconds;
}

}  // namespace glint
