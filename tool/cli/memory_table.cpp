#include "cli/memory_table.h"

#include "cli/table.h"

#include <numeric>
#include <utility>

namespace glint {

namespace {

const char* nameOf(MemoryUse use) {
    switch (use) {
        case MemoryUse::Upload:
            return "upload";
        case MemoryUse::Readback:
            return "readback";
        default:
            return "device";
    }
}

const char* kindOf(const MemoryItem& item) {
    return item.isImage ? "image" : "buffer";
}

Json toJson(const std::vector<MemoryItem>& items) {
    Json list = Json::array();
    for (const MemoryItem& item : items) {
        list.push_back({{"name", item.name},
                        {"kind", kindOf(item)},
                        {"use", nameOf(item.use)},
                        {"count", item.count},
                        {"bytes", item.bytes}});
    }
    return list;
}

}  // namespace

std::uint64_t bytesOf(const std::vector<MemoryItem>& items) {
    return std::accumulate(items.begin(), items.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const MemoryItem& item) { return sum + item.bytes; });
}

Json toJson(const MemoryReport& memory) {
    const std::uint64_t frameBytes = bytesOf(memory.frame);
    const std::uint64_t sceneBytes = bytesOf(memory.scene);
    return {{"frame", toJson(memory.frame)},
            {"frameBytes", frameBytes},
            {"frameAllocatedBytes", memory.frameAllocatedBytes},
            {"scene", toJson(memory.scene)},
            {"sceneBytes", sceneBytes},
            {"sceneAllocatedBytes", memory.sceneAllocatedBytes},
            {"bytes", frameBytes + sceneBytes}};
}

std::string toText(const MemoryReport& memory) {
    std::vector<std::vector<std::string>> rows{{"memory", "of", "kind", "use", "bytes"}};
    for (const auto& [owner, items] :
         {std::pair("frame", &memory.frame), std::pair("scene", &memory.scene)}) {
        for (const MemoryItem& item : *items) {
            const std::string many = item.count > 1 ? std::to_string(item.count) + " " : "";
            rows.push_back({item.name, owner, many + kindOf(item) + (item.count > 1 ? "s" : ""),
                            nameOf(item.use), std::to_string(item.bytes)});
        }
    }
    rows.push_back({"all", "", "", "", std::to_string(bytesOf(memory.frame) + bytesOf(memory.scene))});
    return formatTable(rows);
}

}  // namespace glint
