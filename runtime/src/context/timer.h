// Measures the device time of stretches of a command buffer.
#pragma once

#include "context/device_handle.h"

#include <cstdint>
#include <vector>

namespace glint {

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
