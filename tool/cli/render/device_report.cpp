#include "cli/render/device_report.h"

#include "cli/report.h"
#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <string_view>
#include <utility>

namespace glint::cli {

namespace {

base::Json stagesToJson(VkShaderStageFlags stages) {
    constexpr std::pair<VkShaderStageFlagBits, const char*> kNames[] = {
        {VK_SHADER_STAGE_VERTEX_BIT, "vertex"},       {VK_SHADER_STAGE_FRAGMENT_BIT, "fragment"},
        {VK_SHADER_STAGE_COMPUTE_BIT, "compute"},     {VK_SHADER_STAGE_RAYGEN_BIT_KHR, "ray-generation"},
        {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "any-hit"}, {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "closest-hit"},
        {VK_SHADER_STAGE_MISS_BIT_KHR, "miss"}};
    base::Json list = base::Json::array();
    for (const auto& [bit, name] : kNames) {
        if ((stages & bit) != 0) {
            list.push_back(name);
        }
    }
    return list;
}

// The names match the alternatives of PipelineStatistic::value.
constexpr std::array kFormats{"bool", "int64", "uint64", "float64"};
static_assert(kFormats.size() == std::variant_size_v<decltype(PipelineStatistic::value)>);

base::Json toJson(const PipelineExecutable& executable) {
    base::Json statistics = base::Json::array();
    for (const PipelineStatistic& statistic : executable.statistics) {
        statistics.push_back(
            {{"name", statistic.name},
             {"description", statistic.description},
             {"format", kFormats[statistic.value.index()]},
             {"value", std::visit([](auto value) { return base::Json(value); }, statistic.value)}});
    }
    return {{"name", executable.name},
            {"description", executable.description},
            {"stages", stagesToJson(executable.stages)},
            {"subgroupSize", executable.subgroupSize},
            {"statistics", std::move(statistics)}};
}

base::Json toJson(const std::vector<PipelineStatistics>& pipelines) {
    base::Json list = base::Json::array();
    for (const PipelineStatistics& pipeline : pipelines) {
        base::Json executables = base::Json::array();
        for (const PipelineExecutable& executable : pipeline.executables) {
            executables.push_back(toJson(executable));
        }
        list.push_back({{"name", pipeline.name},
                        {"creationMs", base::orNull(pipeline.creationMs)},
                        {"cacheHit", base::orNull(pipeline.cacheHit)},
                        {"executables", std::move(executables)}});
    }
    return list;
}

std::string textOf(const PipelineStatistic& statistic) {
    return std::visit([](auto value) { return fmt::format("{}", value); }, statistic.value);
}

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

base::Json statisticsToJson(const PipelineReport& report) {
    return report.statistics ? toJson(*report.statistics) : base::Json(nullptr);
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

// The words come from names that, among others, the drivers of NVIDIA, Mesa and AMD use.
PipelineColumn columnOf(const std::string& statistic) {
    std::string name = statistic;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto hasAny = [&](std::initializer_list<std::string_view> words) {
        return std::ranges::any_of(
            words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
    };
    if (hasAny({"spill", "fill count"})) {
        return PipelineColumn::Spills;
    }
    if (hasAny({"register", "gpr"})) {
        return PipelineColumn::Registers;
    }
    if (hasAny({"local memory", "scratch", "stack"})) {
        return PipelineColumn::LocalMemory;
    }
    if (hasAny({"binary size", "code size", "size of code"})) {
        return PipelineColumn::CodeBytes;
    }
    return hasAny({"instruction"}) ? PipelineColumn::Instructions : PipelineColumn::None;
}

std::string tableOf(std::span<const PipelineStatistics> pipelines) {
    std::vector<std::vector<std::string>> rows{{"pipeline", "executable", "subgroup", "registers", "spills",
                                                "local memory", "instructions", "code bytes"}};
    for (const PipelineStatistics& pipeline : pipelines) {
        for (const PipelineExecutable& executable : pipeline.executables) {
            constexpr std::size_t kFirstColumn = 2;  // that of PipelineColumn::None
            std::vector<std::string> row(rows.front().size(), "-");
            for (const PipelineStatistic& statistic : executable.statistics) {
                const PipelineColumn column = columnOf(statistic.name);
                if (column != PipelineColumn::None) {
                    std::string& cell = row[kFirstColumn + static_cast<std::size_t>(column)];
                    cell = cell == "-" ? textOf(statistic) : fmt::format("{} + {}", cell, textOf(statistic));
                }
            }
            row[0] = pipeline.name;
            row[1] = executable.name;
            row[kFirstColumn] = executable.subgroupSize > 0 ? std::to_string(executable.subgroupSize) : "-";
            rows.push_back(std::move(row));
        }
    }
    return formatTable(rows, Detail::Whole);
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
