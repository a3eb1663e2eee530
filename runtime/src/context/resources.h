// Device memory in blocks, because drivers allow only few allocations, and the buffers and images that own
// their place in it.
#pragma once

#include "context/device_objects.h"

#include <glint/context.h>
#include <glint/package_shape.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glint {

inline VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

struct Allocation;
// The place of a resource in memory. It returns to its pool when no resource has it any more.
using Memory = std::shared_ptr<const Allocation>;
struct MemoryBlocks;

struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::uint8_t* mapped = nullptr;  // null for memory that the host can't see
    std::uint32_t type = 0;          // of the memory
    const MemoryBlocks* pool = nullptr;
    Memory lender{};  // of a resource whose memory this one shares; null: none
};

// Tiling of a resource; buffers are linear. Shared memory holds an image, and at other times buffers.
enum class Tiling { Linear, Optimal, Shared };

// Memory that buffers share with an image: the rest of an allocation for Tiling::Shared.
struct SharedMemory {
    Memory memory;           // null: there is none to share
    VkDeviceSize begin = 0;  // in the VkDeviceMemory
    VkDeviceSize end = 0;

    // Takes memory for a buffer, or returns null if the rest is too small or has an unsuitable type.
    Memory take(const VkMemoryRequirements& requirements);

    // Returns whether that many bytes may still fit.
    bool holds(VkDeviceSize bytes) const {
        return begin + bytes <= end;
    }
};

// Device memory of HostServices or of Vulkan.
class DeviceMemory {
public:
    DeviceMemory() = default;
    DeviceMemory(Context::State& context, const HostServices::MemoryRange& range)
        : context_(&context), range_(range) {}
    ~DeviceMemory();
    DeviceMemory(DeviceMemory&& other) noexcept
        : context_(std::exchange(other.context_, nullptr)), range_(other.range_) {}
    DeviceMemory& operator=(DeviceMemory&& other) noexcept {
        std::swap(context_, other.context_);
        std::swap(range_, other.range_);
        return *this;
    }
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    const HostServices::MemoryRange& range() const {
        return range_;
    }

private:
    Context::State* context_ = nullptr;  // null: there is no memory
    HostServices::MemoryRange range_;
};

// The memory of a pool, which lives as long as the pool or one of its resources.
struct MemoryBlocks {
    struct Range {
        VkDeviceSize begin = 0;
        VkDeviceSize end = 0;
    };
    struct Block {
        DeviceMemory memory;
        Tiling tiling = Tiling::Linear;
        VkDeviceSize bytes = 0;
        std::vector<Range> free;  // by ascending offset; no two of them touch
        std::uint8_t* mapped = nullptr;
        bool isOfHost = false;  // HostServices gave the memory

        bool isEmpty() const {
            return free.size() == 1 && free.front().end - free.front().begin == bytes;
        }
        // Returns the first free range that has room, or none.
        std::vector<Range>::iterator findRoom(const VkMemoryRequirements& requirements);
    };
    std::vector<Block> all;
    bool keepsSpare = false;  // MemoryPool::Use::EachFrame

    // Takes back a range of the block that holds `place`. A block without a resource is freed, or kept as a
    // spare one.
    void release(const Allocation& place, const Range& range);
    // Returns the size of all blocks, including memory that was not handed out.
    VkDeviceSize bytes() const;
};

// Hands out memory. The Context must outlive the resources that live in it, which are destroyed on the thread
// that uses the pool.
class MemoryPool {
public:
    // Memory that each frame takes and gives back stays allocated, up to 4 MiB of each kind.
    enum class Use { Lasting, EachFrame };
    // `name` is that of its resources for debuggers, and must outlive it.
    explicit MemoryPool(Context::State& context, const char* name = "scene", Use use = Use::Lasting)
        : context_(&context), name_(name), blocks_(std::make_shared<MemoryBlocks>()) {
        blocks_->keepsSpare = use == Use::EachFrame;
    }

    // Takes memory of the preferred kind, or if there is none left, of any kind that fits. Errors:
    // "memory-type", "memory-size" (above the device's limit), "memory-count", "vulkan-call"; nothing has
    // changed then.
    Result<Memory> allocate(const VkMemoryRequirements& requirements, MemoryUse use, Tiling tiling);

    // Returns the size of all allocations, including memory that was not handed out.
    VkDeviceSize bytes() const {
        return blocks_->bytes();
    }
    const char* name() const {
        return name_;
    }
    bool has(const Allocation& place) const {
        return place.pool == blocks_.get();
    }

private:
    using Block = MemoryBlocks::Block;
    // Returns a block with room for the resource, which is there or is made, in memory of the type.
    Result<Block*> findBlock(std::uint32_t type, const VkMemoryRequirements& requirements, MemoryUse use,
                             Tiling tiling);
    Result<Block*> makeBlock(std::uint32_t type, Tiling tiling, VkDeviceSize bytes, MemoryUse use);
    // Asks the caller's allocator for the memory of one resource.
    Result<Block*> askHost(const VkMemoryRequirements& requirements, MemoryUse use, Tiling tiling);
    Result<Block*> addBlock(const HostServices::MemoryRange& range, Tiling tiling, VkDeviceSize bytes,
                            MemoryUse use);

    Context::State* context_;
    const char* name_;
    std::shared_ptr<MemoryBlocks> blocks_;
};

struct Buffer {
    Memory memory;
    UniqueBuffer handle;
    VkDeviceSize bytes = 0;
    VkDeviceAddress address = 0;
    std::uint8_t* mapped = nullptr;  // null for MemoryUse::Device
    MemoryUse use = MemoryUse::Device;
};

// Creates a buffer of at least one byte, with a device address. A buffer for which `shared` has room lies
// there, whatever `use` is.
Result<Buffer> createBuffer(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                            VkBufferUsageFlags usage, MemoryUse use = MemoryUse::Device,
                            SharedMemory* shared = nullptr);

// A buffer with content from an aligned address on. Vulkan aligns the addresses of buffers for their usage
// only.
struct AlignedBuffer {
    Buffer buffer;
    VkDeviceAddress address = 0;

    VkDeviceSize offset() const {
        return address - buffer.address;
    }
};
// Creates a buffer with room for `bytes` at a multiple of the alignment.
Result<AlignedBuffer> createAligned(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                    VkDeviceSize alignment, VkBufferUsageFlags usage,
                                    MemoryUse use = MemoryUse::Device);

struct DeviceImage {
    Memory memory;
    UniqueImage handle;
    UniqueImageView view;  // view of all mips, unless it says otherwise
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkComponentMapping components{};  // of the view
    package::TextureEntry::Dimension dimension = package::TextureEntry::Dimension::Flat;
    std::uint32_t layers = 1;  // or faces, or slices
    VkDeviceSize bytes = 0;    // size in memory
};

struct ImageInfo {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    VkComponentMapping components{};  // of the view
    package::TextureEntry::Dimension dimension = package::TextureEntry::Dimension::Flat;
    std::uint32_t layers = 1;  // of all views; of a cube its faces, of a 3D image its slices
};

// Creates a view of the mips from `firstMip` on.
Result<UniqueImageView> createImageView(Context::State& context, VkImage image, const ImageInfo& info,
                                        std::uint32_t firstMip);

// Creates an image on the device, in an undefined layout. With Tiling::Shared buffers may share its memory.
Result<DeviceImage> createImage(Context::State& context, MemoryPool& pool, const ImageInfo& info,
                                Tiling tiling = Tiling::Optimal);

// Returns the range of all layers and mips of an image.
VkImageSubresourceRange wholeImage(VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

// Adds an item, or adds its bytes to the item of the same name and use.
void addTo(std::vector<MemoryItem>& items, MemoryItem item);
// Adds a buffer or image to the items, or to the item of the same name. A resource without a handle adds
// nothing.
void addTo(std::vector<MemoryItem>& items, std::string name, const Buffer& buffer);
void addTo(std::vector<MemoryItem>& items, std::string name, const DeviceImage& image);

}  // namespace glint
