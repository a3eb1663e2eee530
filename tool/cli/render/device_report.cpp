#include "cli/render/report.h"
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

}  // namespace
}  // namespace glint::cli

namespace glint {

static base::Fields fieldsOf(const MemoryItem*) {
    using T = MemoryItem;
    using base::output;
    return {output<&T::name>("name", "What it holds."),
            output<cli::kindOf>("kind", "Kind of resource.", {.names = {"image", "buffer"}}),
            output("use", "Whether only the device uses it, or the host writes or reads it.",
                   [](const T& item) { return cli::nameOf(item.use); },
                   {.names = {"device", "upload", "shared", "readback"}}),
            output<&T::count>("count", "Number of resources of this name."),
            output<&T::bytes>("bytes", "Size of all of them.")};
}

}  // namespace glint

namespace glint::cli {

using base::output;

base::Fields fieldsOf(const PipelineCacheReport*) {
    using T = PipelineCacheReport;
    return {output<&T::file>("file", "The cache's file for this device and driver."),
            output<&T::loadedBytes>("loadedBytes", "Size of the file before; 0 if there was nothing usable."),
            output<&T::savedBytes>("savedBytes", "Size of the file after; 0 if it could not be written."),
            output<&T::hits>("hits", "Pipelines found in it; null if the driver does not say.")};
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

base::Fields fieldsOf(const StartReport*) {
    using T = StartReport;
    return {
        output<&T::deviceMs>("deviceMs", "Time of making instance, device and pipeline cache."),
        output<&T::texturesMs>("texturesMs", "Time of reading, transcoding and compressing images."),
        output<&T::uploadMs>("uploadMs", "Time of uploading the scene and building acceleration structures."),
        output<&T::rendererMs>("rendererMs", "Time of making buffers, images and pipelines."),
        output<&T::firstSampleMs>("firstSampleMs", "Time of the first sample until it is complete."),
        output<&T::totalMs>("totalMs", "Sum of these times.")};
}

std::string toText(const StartReport& start) {
    return fmt::format(
        "after {}: device {:.3f}, textures {:.3f}, scene {:.3f}, renderer {:.3f}, sample {:.3f}",
        formatMilliseconds(start.totalMs()), start.deviceMs, start.texturesMs, start.uploadMs,
        start.rendererMs, start.firstSampleMs);
}

std::string tableOf(std::span<const PipelineStatistics> pipelines) {
    Rows rows{{"pipeline", "executable", "subgroup"}};
    for (const inspect::FactInfo& info : inspect::factTable()) {
        rows.front().emplace_back(info.column);
    }
    for (const PipelineStatistics& pipeline : pipelines) {
        for (const PipelineStatistics::Executable& executable : pipeline.executables) {
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

base::Fields fieldsOf(const MemoryReport*) {
    using T = MemoryReport;
    return {
        output<&T::frame>("frame", "Every image and buffer of the footprint."),
        output("frameBytes", "Sum of these sizes.", [](const T& memory) { return bytesOf(memory.frame); }),
        output<&T::frameAllocatedBytes>("frameAllocatedBytes", "Size of the allocations that hold them."),
        output<&T::scene>("scene", "Images and buffers of the scene."),
        output("sceneBytes", "Sum of these sizes.", [](const T& memory) { return bytesOf(memory.scene); }),
        output<&T::sceneAllocatedBytes>("sceneAllocatedBytes", "Size of the allocations that hold them."),
        output("bytes", "Size of frame and scene.",
               [](const T& memory) { return bytesOf(memory.frame) + bytesOf(memory.scene); })};
}

std::string toText(const MemoryReport& memory) {
    Rows rows{{"memory", "of", "kind", "use", "bytes"}};
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
