// Device memory in blocks: many resources share an allocation, as drivers allow few of them.
#pragma once

#include "device_handle.h"

#include <glint/memory_report.h>

#include <cstdint>
#include <vector>

namespace glint {

inline VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

// Where a resource lives. `mapped` is null for memory that the host can't see.
struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::uint8_t* mapped = nullptr;
};

enum class Tiling { Linear, Optimal };  // of the resource: buffers are linear

// Hands memory out and takes it back all at once, when it is destroyed: after the resources that live in it.
class MemoryPool {
public:
    explicit MemoryPool(Context::State& context) : context_(&context) {}
    MemoryPool(MemoryPool&&) noexcept = default;
    MemoryPool& operator=(MemoryPool&&) noexcept = default;
    ~MemoryPool() = default;
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;

    // Errors: "memory-type", "memory-size" (above the device's limit), "memory-count", "vulkan-call".
    Result<Allocation> allocate(const VkMemoryRequirements& requirements, MemoryUse use, Tiling tiling);

    // Of the allocations, whether handed out or not.
    VkDeviceSize bytes() const;

private:
    struct Block {
        UniqueMemory memory;
        std::uint32_t type = 0;
        Tiling tiling = Tiling::Linear;
        VkDeviceSize bytes = 0;
        VkDeviceSize used = 0;
        std::uint8_t* mapped = nullptr;
    };
    Result<Block> makeBlock(std::uint32_t type, Tiling tiling, VkDeviceSize bytes, bool map);

    Context::State* context_;
    std::vector<Block> blocks_;
};

}  // namespace glint
