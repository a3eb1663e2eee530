#include "scene/record_store.h"

#include <algorithm>
#include <iterator>

namespace glint {

void RunAllocator::insert(std::uint32_t first, std::uint32_t count) {
    free_.emplace(first, count);
    bySize_.emplace(count, first);
}

void RunAllocator::erase(Place place) {
    bySize_.erase({place->second, place->first});
    free_.erase(place);
}

std::uint32_t RunAllocator::allocate(std::uint32_t count) {
    const auto room = bySize_.lower_bound({count, 0});
    if (count == 0 || room == bySize_.end()) {
        const std::uint32_t first = count == 0 ? 0 : end_;
        end_ += count;
        return first;
    }
    const auto [size, first] = *room;
    erase(free_.find(first));
    if (size > count) {
        insert(first + count, size - count);
    }
    return first;
}

void RunAllocator::release(std::uint32_t first, std::uint32_t count) {
    if (count == 0) {
        return;
    }
    const auto next = free_.lower_bound(first);
    const bool touchesNext = next != free_.end() && next->first == first + count;
    const auto before = next == free_.begin() ? free_.end() : std::prev(next);
    const bool touchesBefore = before != free_.end() && before->first + before->second == first;
    if (touchesNext) {
        count += next->second;
        erase(next);
    }
    if (touchesBefore) {
        first = before->first;
        count += before->second;
        erase(before);
    }
    if (first + count == end_) {
        end_ = first;
    } else {
        insert(first, count);
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
    shrink(wanted);
    for (std::uint32_t index = 0; index < wanted; ++index) {
        const std::span<const std::uint8_t> record = records.subspan(index * stride_, stride_);
        if (index >= count() || !std::ranges::equal(record, at(index))) {
            writeBytes(index, record);
        }
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
