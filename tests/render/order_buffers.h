// The data that an OrderKernel reads and writes on the device.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "interop/frame.h"
#include "render/order_kernel.h"

#include <cstdint>
#include <memory>

namespace glint::testing {

// A dependency between commands of any kind.
inline constexpr MemoryDependency kEverything{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

struct OrderBuffers {
    explicit OrderBuffers(Context::State& context) : pool(context) {}

    MemoryPool pool;
    Buffer constants;
    Buffer staged;  // keys, hits, geometries
    Buffer keys;
    Buffer hits;
    Buffer geometries;
    Buffer slots;
    Buffer visited;
    Buffer counts;
    Buffer begins;
    Buffer cursors;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    gpu::FrameConstants values{};  // of the constants
    std::uint32_t rays = 0;
};

// Errors: "vulkan-call" and those of memory. Without hits only the check can't run.
Result<std::unique_ptr<OrderBuffers>> createOrderBuffers(Context::State& context, const OrderProblem& problem,
                                                         std::uint32_t bucketCount,
                                                         package::HitRecordFormat hitRecord, bool withHits);

// Uploads the problem. All other words get a value that nobody writes, so that omissions are visible.
void recordInput(Context::State& context, VkCommandBuffer commands, const OrderBuffers& buffers);

// Copies results to where readResult() finds them.
void recordOutput(Context::State& context, VkCommandBuffer commands, const OrderBuffers& buffers);
OrderResult readResult(const OrderBuffers& buffers);

}  // namespace glint::testing
