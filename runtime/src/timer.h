// Device time of stretches of a command buffer.
#pragma once

#include "device_handle.h"

#include <cstdint>
#include <vector>

namespace glint {

class Timer {
public:
    // Room for `capacity` stretches. A queue family without timestamps makes a timer that records nothing.
    static Result<Timer> create(Context::State& context, std::uint32_t capacity);

    bool available() const {
        return pool_.get() != VK_NULL_HANDLE;
    }
    // Forgets earlier results; outside a render pass, before the first stretch of a recording.
    void recordReset(VkCommandBuffer commands) const;
    // Marks wait for all earlier commands, so that stretches do not overlap.
    void recordBegin(VkCommandBuffer commands, std::uint32_t stretch) const;
    void recordEnd(VkCommandBuffer commands, std::uint32_t stretch) const;
    // Milliseconds of stretches [0, count), once the device has done them.
    // Errors: "timings-unavailable", "timings-pending", "vulkan-call".
    Result<std::vector<double>> read(std::uint32_t count) const;

private:
    explicit Timer(Context::State& context) : context_(&context) {}
    void recordMark(VkCommandBuffer commands, std::uint32_t query) const;

    Context::State* context_;
    UniqueQueryPool pool_;
    std::uint32_t queries_ = 0;
};

}  // namespace glint
