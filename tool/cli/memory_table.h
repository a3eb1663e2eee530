// Device memory, buffer by buffer.
#pragma once

#include "cli/report.h"

#include <glint/memory_report.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

struct MemoryReport {
    std::vector<MemoryItem> frame;
    std::vector<MemoryItem> scene;
    std::uint64_t frameAllocatedBytes = 0;
    std::uint64_t sceneAllocatedBytes = 0;
};

std::uint64_t bytesOf(const std::vector<MemoryItem>& items);

Json toJson(const MemoryReport& memory);
std::string toText(const MemoryReport& memory);

}  // namespace glint
