// Recording, submission and waiting, barriers, and the device time of stretches of a command buffer.
#pragma once

#include "context/device_objects.h"

#include <cstdint>
#include <functional>
#include <string_view>
#include <type_traits>
#include <vector>

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

// Makes all later commands wait for all earlier ones. So frames run one after the other, whichever renderer
// recorded the previous one.
inline constexpr MemoryDependency kAllToAll{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

// Orders fills and copies that write the same memory.
inline constexpr MemoryDependency kTransferToTransfer{
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};

inline constexpr MemoryDependency kCopyToHost{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                              VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

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

// Begin and end a label around commands, with DeviceHandles::debugUtils.
void beginLabel(const Context::State& context, VkCommandBuffer commands, std::string_view name);
void endLabel(const Context::State& context, VkCommandBuffer commands);

class Timer {
public:
    // Makes a timer for at most `capacity` stretches. On a queue family without timestamps the timer records
    // nothing.
    static Result<Timer> create(Context::State& context, std::uint32_t capacity);

    bool available() const {
        return pool_.get() != VK_NULL_HANDLE;
    }
    // Forgets earlier results. It must be recorded outside a render pass, before the first stretch of a
    // recording.
    void recordReset(VkCommandBuffer commands) const;
    // Each mark waits for all earlier commands, so that stretches do not overlap.
    void recordBegin(VkCommandBuffer commands, std::uint32_t stretch) const;
    void recordEnd(VkCommandBuffer commands, std::uint32_t stretch) const;
    // Returns the milliseconds of stretches [0, count), which the device must have completed. Errors:
    // "timings-unavailable", "timings-pending", "vulkan-call".
    Result<std::vector<double>> read(std::uint32_t count) const;

private:
    explicit Timer(Context::State& context) : context_(&context) {}
    void recordMark(VkCommandBuffer commands, std::uint32_t query) const;

    Context::State* context_;
    UniqueQueryPool pool_;
    std::uint32_t queries_ = 0;
};

}  // namespace glint
