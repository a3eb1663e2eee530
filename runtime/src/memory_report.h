// Collecting what the public headers list of memory.
#pragma once

#include "resources.h"

#include <glint/memory_report.h>

#include <string>
#include <vector>

namespace glint {

// Adds a buffer or image, or what it has of another of its name; nothing where it has no handle.
void addTo(std::vector<MemoryItem>& items, std::string name, const Buffer& buffer);
void addTo(std::vector<MemoryItem>& items, std::string name, const DeviceImage& image);

}  // namespace glint
