// Collects the memory items that the public headers report.
#pragma once

#include "context/resources.h"

#include <glint/memory_report.h>

#include <string>
#include <vector>

namespace glint {

// Adds an item, or adds its bytes to the item of the same name and use.
void addTo(std::vector<MemoryItem>& items, MemoryItem item);
// Adds a buffer or image to the items, or to the item of the same name. A resource without a handle adds
// nothing.
void addTo(std::vector<MemoryItem>& items, std::string name, const Buffer& buffer);
void addTo(std::vector<MemoryItem>& items, std::string name, const DeviceImage& image);

}  // namespace glint
