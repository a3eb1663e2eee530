// Arrays of records on the device, which follow their RecordStores.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "data/retired.h"
#include "scene/record_store.h"

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// An array on the device, and the size that it should have.
struct RecordArray {
    RecordStore& store;
    Buffer& device;
    std::uint32_t capacity = 0;  // in records; 0 if nothing reads the array, which then has no buffer
    MemoryPool* pool = nullptr;  // of a buffer of another size
    VkBufferUsageFlags usage = 0;
};

// The capacity of an array that doubles when it is full.
inline std::uint32_t grownCapacity(std::uint32_t count, std::uint32_t now) {
    return count > now ? std::max(count, 2 * now) : std::max(now, 1U);
}

// Brings arrays up to date in one recording. Its functions get the same arrays in the same order. Everything
// that it has made is discarded with it, unless it was recorded.
class ArrayUpdate {
public:
    // `staging` is the pool of staging memory.
    ArrayUpdate(Context::State& context, MemoryPool& staging) : context_(context), stagingPool_(staging) {}
    ~ArrayUpdate();
    ArrayUpdate(const ArrayUpdate&) = delete;
    ArrayUpdate& operator=(const ArrayUpdate&) = delete;

    // Makes the buffers of arrays that get another capacity. Errors: those of buffers.
    Status prepareBuffers(std::span<const RecordArray> arrays);
    // Makes the staging memory of the records that the device does not have. Errors: those of buffers.
    Status prepareStaging(std::span<const RecordArray> arrays);
    // Returns the new buffer of an array, which has no handle if the array keeps the one that it has.
    const Buffer& bufferOf(std::size_t array) const {
        return made_[array];
    }
    bool hasWork() const;
    // Copies old content into new buffers, which the arrays get. `retired` gets the old ones.
    void recordResizes(VkCommandBuffer commands, std::span<const RecordArray> arrays, Retired& retired);
    // Copies the changed records. The caller keeps the result until the device has completed the copies.
    Buffer recordCopies(VkCommandBuffer commands, std::span<const RecordArray> arrays);

private:
    Context::State& context_;
    MemoryPool& stagingPool_;
    std::vector<Buffer> made_;
    std::vector<MemoryPool*> pools_;  // of these buffers
    Buffer staging_;
};

}  // namespace glint
