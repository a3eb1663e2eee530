#include "scene/record_store.h"

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
    if (!dirty_.empty() && dirty_.back().end == index) {
        ++dirty_.back().end;
    } else {
        dirty_.push_back({index, index + 1});
    }
}

void RecordStore::replaceBytes(std::span<const std::uint8_t> records) {
    const auto wanted = static_cast<std::uint32_t>(records.size() / stride_);
    const std::uint32_t both = std::min(wanted, count());
    const auto isSame = [&](std::uint32_t index) {
        return std::ranges::equal(records.subspan(index * stride_, stride_), at(index));
    };
    std::uint32_t first = 0;
    while (first < both && isSame(first)) {
        ++first;
    }
    std::uint32_t end = wanted;
    while (wanted == both && end > first && isSame(end - 1)) {
        --end;
    }
    shrink(wanted);
    bytes_.assign(records.begin(), records.end());
    if (end > first) {
        dirty_.push_back({first, end});
    }
}

void RecordStore::shrink(std::uint32_t count) {
    if (count < this->count()) {
        bytes_.resize(count * stride_);
        std::erase_if(dirty_, [&](const IndexRange& range) { return range.first >= count; });
        for (IndexRange& range : dirty_) {
            range.end = std::min(range.end, count);
        }
    }
}

std::vector<IndexRange> RecordStore::dirty() const {
    std::vector<IndexRange> sorted = dirty_;
    std::ranges::sort(sorted, {}, &IndexRange::first);
    std::vector<IndexRange> runs;
    for (const IndexRange& range : sorted) {
        if (!runs.empty() && range.first <= runs.back().end) {
            runs.back().end = std::max(runs.back().end, range.end);
        } else {
            runs.push_back(range);
        }
    }
    return runs;
}

}  // namespace glint
