#include "context/memory_items.h"

#include <algorithm>
#include <utility>

namespace glint {

void addTo(std::vector<MemoryItem>& items, MemoryItem item) {
    const auto known = std::ranges::find_if(items, [&](const MemoryItem& other) {
        return other.name == item.name && other.use == item.use && other.isImage == item.isImage;
    });
    if (known == items.end()) {
        items.push_back(std::move(item));
        return;
    }
    known->count += item.count;
    known->bytes += item.bytes;
}

void addTo(std::vector<MemoryItem>& items, std::string name, const Buffer& buffer) {
    if (buffer.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {std::move(name), buffer.use, false, 1, buffer.bytes});
    }
}

void addTo(std::vector<MemoryItem>& items, std::string name, const DeviceImage& image) {
    if (image.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {std::move(name), MemoryUse::Device, true, 1, image.bytes});
    }
}

}  // namespace glint
