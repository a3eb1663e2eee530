// Recording, submission and waiting, and barriers.
#pragma once

#include "context/device_handle.h"

#include <cstdint>
#include <functional>
#include <type_traits>

namespace glint {

// One command buffer that is recorded, submitted and waited for, over and over.
class CommandRunner {
public:
    static Result<CommandRunner> create(Context::State& context);

    // Starts a recording. No earlier commands of this runner may be in flight.
    Result<VkCommandBuffer> begin();
    // Ends the recording, submits it and waits until the device has completed it.
    Status submitAndWait();

private:
    explicit CommandRunner(Context::State& context) : context_(&context) {}
    Context::State* context_;
    UniqueCommandPool pool_;
    UniqueFence fence_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// Calls record(commands) for a command buffer of its own, which it submits and waits for.
Status runOnce(Context::State& context, const std::function<Status(VkCommandBuffer)>& record);

// Does the same for a record(commands) that returns a Result with a pointer to an object that it has made.
// Calls the object's function complete() for the frame 0.
template <typename Record>
std::invoke_result_t<Record, VkCommandBuffer> makeOnce(Context::State& context, const Record& record) {
    std::invoke_result_t<Record, VkCommandBuffer> made(nullptr);
    const Status status = runOnce(context, [&](VkCommandBuffer commands) -> Status {
        made = record(commands);
        return made ? okStatus() : Status(made.error());
    });
    if (!status) {
        return status.error();
    }
    (*made)->complete(0);
    return made;
}

// A dependency that covers all memory.
struct MemoryDependency {
    VkPipelineStageFlags2 fromStages = 0;
    VkAccessFlags2 fromAccess = 0;
    VkPipelineStageFlags2 toStages = 0;
    VkAccessFlags2 toAccess = 0;
};

void recordDependency(const Context::State& context, VkCommandBuffer commands,
                      const MemoryDependency& dependency);

// Moves the mips [firstMip, firstMip + mipCount) of a colour or depth image from one layout to another.
struct ImageTransition {
    VkImage image = VK_NULL_HANDLE;
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout to = VK_IMAGE_LAYOUT_UNDEFINED;
    MemoryDependency dependency;
    std::uint32_t firstMip = 0;
    std::uint32_t mipCount = VK_REMAINING_MIP_LEVELS;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

void recordTransition(const Context::State& context, VkCommandBuffer commands,
                      const ImageTransition& transition);

}  // namespace glint
