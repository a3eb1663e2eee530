// Device memory in blocks. Many resources share an allocation, because drivers allow only few allocations.
#pragma once

#include "context/device_handle.h"

#include <glint/memory_report.h>

#include <cstdint>
#include <vector>

namespace glint {

inline VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

// The place of a resource in memory. `mapped` is null for memory that the host can't see.
struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::uint8_t* mapped = nullptr;
};

enum class Tiling { Linear, Optimal };  // tiling of the resource; buffers are linear

// Hands out memory and frees all of it when it is destroyed. The resources that live in it must be destroyed
// before.
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

    // Returns the size of all allocations, including memory that was not handed out.
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
