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
    // The range that MemoryPool::release() gives back. It includes the gap before `offset`.
    VkDeviceSize begin = 0;
    VkDeviceSize bytes = 0;
    std::uint32_t type = 0;  // of the memory
};

// Tiling of a resource; buffers are linear. Shared memory holds an image, and at other times buffers.
enum class Tiling { Linear, Optimal, Shared };

// Memory that buffers share with an image: the rest of an allocation for Tiling::Shared.
struct SharedMemory {
    Allocation memory;       // without memory: there is none to share
    VkDeviceSize begin = 0;  // in `memory`
    VkDeviceSize end = 0;

    // Takes memory for a buffer. Returns false if the rest is too small or has an unsuitable type.
    bool take(const VkMemoryRequirements& requirements, Allocation& taken);
};

// Hands out memory, and frees all of it when it is destroyed. The resources that live in it must be destroyed
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

    // Takes back memory that no resource uses any more. A block without a resource is freed. An allocation
    // without memory changes nothing.
    void release(const Allocation& allocation);

    // Returns the size of all allocations, including memory that was not handed out.
    VkDeviceSize bytes() const;

private:
    struct Range {
        VkDeviceSize begin = 0;
        VkDeviceSize end = 0;
    };
    struct Block {
        UniqueMemory memory;
        std::uint32_t type = 0;
        Tiling tiling = Tiling::Linear;
        VkDeviceSize bytes = 0;
        std::vector<Range> free;  // by ascending offset; no two of them touch
        std::uint8_t* mapped = nullptr;

        // Returns the first free range that has room, or none.
        std::vector<Range>::iterator findRoom(const VkMemoryRequirements& requirements);
    };
    Result<Block> makeBlock(std::uint32_t type, Tiling tiling, VkDeviceSize bytes, bool map);

    Context::State* context_;
    std::vector<Block> blocks_;
};

}  // namespace glint
