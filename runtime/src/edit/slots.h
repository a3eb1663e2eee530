// Entries that handles name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
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
        for (std::uint32_t i = 0; i < end(); ++i) {
            if (slots_[i].entry) {
                visit(Handle{i, slots_[i].generation}, *slots_[i].entry);
            }
        }
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

}  // namespace glint
