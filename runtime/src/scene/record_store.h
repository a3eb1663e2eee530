// Entries that handles name, and arrays of records that are edited in place and grow, on the host and on the
// device.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "data/retired.h"

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint {

// Entries at indices that stay the same. A new entry gets the lowest free index, so that arrays on the device
// stay short. Every entry has a generation of its own, so a handle that outlives its entry finds nothing.
template <typename Entry, typename Handle>
class Slots {
public:
    // Returns the handle that the next add() gives.
    Handle next() const {
        return {free_.empty() ? end() : *free_.begin(), generation_ + 1};
    }
    Handle add(Entry entry) {
        const Handle handle = next();
        if (handle.index == slots_.size()) {
            slots_.emplace_back();
        } else {
            free_.erase(free_.begin());
        }
        slots_[handle.index] = {++generation_, std::move(entry)};
        ++count_;
        return handle;
    }
    // Returns null if the handle names nothing.
    Entry* find(Handle handle) {
        const bool named = handle.index < slots_.size() && slots_[handle.index].entry &&
                           slots_[handle.index].generation == handle.generation;
        return named ? &*slots_[handle.index].entry : nullptr;
    }
    const Entry* find(Handle handle) const {
        return const_cast<Slots*>(this)->find(handle);
    }
    bool has(std::uint32_t index) const {
        return index < slots_.size() && slots_[index].entry.has_value();
    }
    // Requires an index with an entry.
    Entry& at(std::uint32_t index) {
        return *slots_[index].entry;
    }
    const Entry& at(std::uint32_t index) const {
        return *slots_[index].entry;
    }
    Handle handleAt(std::uint32_t index) const {
        return {index, slots_[index].generation};
    }
    // Requires a handle that names an entry.
    Entry take(Handle handle) {
        Entry entry = std::move(*slots_[handle.index].entry);
        slots_[handle.index].entry.reset();
        free_.insert(handle.index);
        --count_;
        while (!slots_.empty() && !slots_.back().entry) {
            slots_.pop_back();
            free_.erase(end());
        }
        return entry;
    }
    // One past the last entry's index.
    std::uint32_t end() const {
        return static_cast<std::uint32_t>(slots_.size());
    }
    std::size_t count() const {
        return count_;
    }
    // Calls visit(handle, entry) for all entries, by ascending index.
    template <typename Visit>
    void forEach(const Visit& visit) {
        for (std::uint32_t i = 0; i < end(); ++i) {
            if (slots_[i].entry) {
                visit(Handle{i, slots_[i].generation}, *slots_[i].entry);
            }
        }
    }
    template <typename Visit>
    void forEach(const Visit& visit) const {
        const_cast<Slots*>(this)->forEach(
            [&](Handle handle, Entry& entry) { visit(handle, std::as_const(entry)); });
    }

private:
    struct Slot {
        std::uint32_t generation = 0;
        std::optional<Entry> entry;
    };
    std::vector<Slot> slots_;
    std::set<std::uint32_t> free_;  // below end()
    std::uint32_t generation_ = 0;
    std::size_t count_ = 0;
};

// Indices [first, end).
struct IndexRange {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};

// Finds room for runs of consecutive records. A run gets the smallest place that has room, and the lowest of
// these. Takes O(log n) time for n places.
class RunAllocator {
public:
    std::uint32_t allocate(std::uint32_t count);
    void release(std::uint32_t first, std::uint32_t count);
    // One past the last index in use.
    std::uint32_t end() const {
        return end_;
    }

private:
    using Place = std::map<std::uint32_t, std::uint32_t>::iterator;
    void insert(std::uint32_t first, std::uint32_t count);
    void erase(Place place);

    std::map<std::uint32_t, std::uint32_t> free_;  // first and count, below end_; no two of them touch
    std::set<std::pair<std::uint32_t, std::uint32_t>> bySize_;  // count and first of the same
    std::uint32_t end_ = 0;
};

// The host's copy of an array of records, with the parts of it that the device does not have yet.
class RecordStore {
public:
    explicit RecordStore(std::size_t stride) : stride_(stride) {}

    // Writes the record at `index`; the array grows to hold it.
    void writeBytes(std::uint32_t index, std::span<const std::uint8_t> record);
    template <typename T>
    void write(std::uint32_t index, const T& record) {
        static_assert(std::is_trivially_copyable_v<T>);
        writeBytes(index, std::span(reinterpret_cast<const std::uint8_t*>(&record), sizeof record));
    }
    // Replaces the records by these, and writes those that differ.
    template <typename Records>
    void replace(const Records& records) {
        const std::span all(records);
        static_assert(std::is_trivially_copyable_v<typename decltype(all)::value_type>);
        replaceBytes({reinterpret_cast<const std::uint8_t*>(all.data()), all.size_bytes()});
    }
    void replaceBytes(std::span<const std::uint8_t> records);
    // Forgets the records from `count` on.
    void shrink(std::uint32_t count);
    // Forgets everything, also of the device, for records of another size.
    void reset(std::size_t stride) {
        *this = RecordStore(stride);
    }

    std::span<const std::uint8_t> at(std::uint32_t index) const {
        return std::span(bytes_).subspan(index * stride_, stride_);
    }
    // The records of a range, which all must be there.
    std::span<const std::uint8_t> at(IndexRange range) const {
        return std::span(bytes_).subspan(range.first * stride_, (range.end - range.first) * stride_);
    }
    template <typename T>
    T read(std::uint32_t index) const {
        T record;
        std::memcpy(&record, at(index).data(), sizeof record);
        return record;
    }
    std::uint32_t count() const {
        return static_cast<std::uint32_t>(bytes_.size() / stride_);
    }
    std::size_t stride() const {
        return stride_;
    }
    // The records that were written since clearDirty(), as runs that do not touch.
    std::vector<IndexRange> dirty() const;
    void clearDirty() {
        dirty_.clear();
    }
    // Lets the next copy take all records.
    void touchAll() {
        dirty_.clear();
        if (count() > 0) {
            dirty_.push_back({0, count()});
        }
    }

    // The size of the array on the device, in records.
    std::uint32_t capacity = 0;
    std::uint32_t firstCapacity = 0;  // the capacity at the upload

private:
    std::size_t stride_;
    std::vector<std::uint8_t> bytes_;
    std::vector<IndexRange> dirty_;  // may overlap
};

// An array of records on the host, and its copy on the device.
struct RecordArray : RecordStore {
    using RecordStore::RecordStore;

    Buffer device;
};

// An array of a recording, and the size that it should have on the device.
struct ArrayTarget {
    RecordArray& array;
    std::uint32_t capacity = 0;  // in records; 0 if nothing reads the array, which then has no buffer
    MemoryPool* pool = nullptr;  // of a buffer of another size
    VkBufferUsageFlags usage = 0;
};

// The capacity of an array that doubles when it is full.
inline std::uint32_t grownCapacity(std::uint32_t count, std::uint32_t now) {
    return count > now ? std::max(count, 2 * now) : std::max(now, 1U);
}

// Brings arrays up to date in one recording. Its functions get the same arrays in the same order.
class ArrayUpdate {
public:
    // `staging` is the pool of staging memory.
    ArrayUpdate(Context::State& context, MemoryPool& staging) : context_(context), stagingPool_(staging) {}

    // Makes the buffers of arrays that get another capacity. Errors: those of buffers.
    Status prepareBuffers(std::span<const ArrayTarget> arrays);
    // Makes the staging memory of the records that the device does not have. Errors: those of buffers.
    Status prepareStaging(std::span<const ArrayTarget> arrays);
    // Returns the new buffer of an array, which has no handle if the array keeps the one that it has.
    const Buffer& bufferOf(std::size_t array) const {
        return made_[array];
    }
    bool hasWork() const;
    // Copies old content into new buffers, which the arrays get. `retired` gets the old ones.
    void recordResizes(VkCommandBuffer commands, std::span<const ArrayTarget> arrays, Retired& retired);
    // Copies the changed records. The caller keeps the result until the device has completed the copies.
    Buffer recordCopies(VkCommandBuffer commands, std::span<const ArrayTarget> arrays);

private:
    Context::State& context_;
    MemoryPool& stagingPool_;
    std::vector<Buffer> made_;
    Buffer staging_;
};

}  // namespace glint
