#include "edit/record_store.h"

#include <algorithm>

namespace glint {

std::uint32_t RunAllocator::allocate(std::uint32_t count) {
    const auto room = std::ranges::find_if(
        free_, [&](const IndexRange& range) { return range.end - range.first >= count; });
    if (room == free_.end()) {
        const std::uint32_t first = end_;
        end_ += count;
        return first;
    }
    const std::uint32_t first = room->first;
    room->first += count;
    if (room->first == room->end) {
        free_.erase(room);
    }
    return first;
}

void RunAllocator::release(std::uint32_t first, std::uint32_t count) {
    if (count == 0) {
        return;
    }
    auto place = std::ranges::lower_bound(free_, first, {}, &IndexRange::first);
    place = free_.insert(place, {first, first + count});
    if (const auto next = place + 1; next != free_.end() && next->first == place->end) {
        place->end = next->end;
        free_.erase(next);
    }
    if (place != free_.begin() && (place - 1)->end == place->first) {
        (place - 1)->end = place->end;
        free_.erase(place);
    }
    if (free_.back().end == end_) {
        end_ = free_.back().first;
        free_.pop_back();
    }
}

void RecordStore::writeBytes(std::uint32_t index, std::span<const std::uint8_t> record) {
    const std::size_t place = index * stride_;
    if (bytes_.size() < place + stride_) {
        bytes_.resize(place + stride_);
    }
    std::ranges::copy(record, bytes_.begin() + static_cast<std::ptrdiff_t>(place));
    dirty_.push_back(index);
}

void RecordStore::shrink(std::uint32_t count) {
    if (count < this->count()) {
        bytes_.resize(count * stride_);
        std::erase_if(dirty_, [&](std::uint32_t index) { return index >= count; });
    }
}

std::vector<IndexRange> RecordStore::dirty() const {
    std::vector<std::uint32_t> sorted = dirty_;
    std::ranges::sort(sorted);
    std::vector<IndexRange> runs;
    for (const std::uint32_t index : sorted) {
        if (!runs.empty() && index <= runs.back().end) {
            runs.back().end = std::max(runs.back().end, index + 1);
        } else {
            runs.push_back({index, index + 1});
        }
    }
    return runs;
}

}  // namespace glint
