#include "cli/render/device_report.h"

#include "cli/report.h"
#include "cli/table.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace glint::cli {

namespace {

const char* nameOf(MemoryUse use) {
    switch (use) {
        case MemoryUse::Upload:
            return "upload";
        case MemoryUse::Shared:
            return "shared";
        case MemoryUse::Readback:
            return "readback";
        default:
            return "device";
    }
}

const char* kindOf(const MemoryItem& item) {
    return item.isImage ? "image" : "buffer";
}

base::Json toJson(const std::vector<MemoryItem>& items) {
    base::Json list = base::Json::array();
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

base::Json cacheToJson(const PipelineReport& report) {
    if (!report.cache) {
        return nullptr;
    }
    return {{"file", report.cache->file},
            {"loadedBytes", report.cache->loadedBytes},
            {"savedBytes", report.cache->savedBytes},
            {"hits", base::orNull(report.making.cacheHits)}};
}

std::string toText(const PipelineReport& report) {
    const Renderer::PipelineMaking& making = report.making;
    std::string text =
        fmt::format("{} in {} by {} thread{}", report.count, formatMilliseconds(making.milliseconds),
                    making.threads, making.threads == 1 ? "" : "s");
    if (report.cache) {
        text += fmt::format("; cache of {}", formatBytes(report.cache->loadedBytes));
        if (making.cacheHits) {
            text += fmt::format(", {} found in it", *making.cacheHits);
        }
    }
    return text;
}

base::Json toJson(const StartReport& start) {
    return {{"deviceMs", start.deviceMs},           {"texturesMs", start.texturesMs},
            {"uploadMs", start.uploadMs},           {"rendererMs", start.rendererMs},
            {"firstSampleMs", start.firstSampleMs}, {"totalMs", start.totalMs()}};
}

std::string toText(const StartReport& start) {
    return fmt::format(
        "after {}: device {:.3f}, textures {:.3f}, scene {:.3f}, renderer {:.3f}, sample {:.3f}",
        formatMilliseconds(start.totalMs()), start.deviceMs, start.texturesMs, start.uploadMs,
        start.rendererMs, start.firstSampleMs);
}

std::string tableOf(std::span<const PipelineStatistics> pipelines) {
    std::vector<std::vector<std::string>> rows{{"pipeline", "executable", "subgroup"}};
    for (const inspect::FactInfo& info : inspect::factTable()) {
        rows.front().emplace_back(info.column);
    }
    for (const PipelineStatistics& pipeline : pipelines) {
        for (const PipelineExecutable& executable : pipeline.executables) {
            const inspect::PipelineFacts facts = inspect::factsOf(executable);
            std::vector<std::string>& row = rows.emplace_back();
            row = {pipeline.name, executable.name,
                   executable.subgroupSize > 0 ? std::to_string(executable.subgroupSize) : "-"};
            for (const inspect::FactInfo& info : inspect::factTable()) {
                row.push_back(factText(info, facts));
            }
        }
    }
    return formatTable(rows, Detail::Whole);
}

std::string factText(const inspect::FactInfo& info, const inspect::PipelineFacts& facts) {
    const std::optional<double>& value = facts.*info.member;
    if (!value) {
        return "-";
    }
    return info.isLeast ? fmt::format("{:.0f} %", 100.0 * *value) : fmt::format("{}", std::round(*value));
}

std::uint64_t bytesOf(const std::vector<MemoryItem>& items) {
    return std::accumulate(items.begin(), items.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const MemoryItem& item) { return sum + item.bytes; });
}

base::Json toJson(const MemoryReport& memory) {
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

}  // namespace glint::cli
