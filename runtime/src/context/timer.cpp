#include "context/timer.h"

#include "context/vulkan_error.h"

namespace glint {

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
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = timer.queries_;
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
        if (result != VK_SUCCESS) {
            return vulkanError("vkGetQueryPoolResults", result);
        }
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
