// The output about what is on the device: pipelines, how they were made and kept, the driver's statistics
// about them, and memory, buffer by buffer.
#pragma once

#include "cli/report.h"
#include "inspect/pipelines.h"

#include <glint/context.h>
#include <glint/pipeline_statistics.h>
#include <glint/renderer.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::cli {

struct PipelineCacheReport {
    std::string file;
    std::uint64_t loadedBytes = 0;  // 0: there was nothing of use
    std::uint64_t savedBytes = 0;
};

// The times from nothing to a picture, wall clock.
struct StartReport {
    double deviceMs = 0.0;       // instance, device, the pipeline cache from its file
    double texturesMs = 0.0;     // images read, transcoded, compressed
    double uploadMs = 0.0;       // the scene, with its acceleration structures
    double rendererMs = 0.0;     // buffers, images and pipelines
    double firstSampleMs = 0.0;  // recorded, submitted and complete

    double totalMs() const {
        return deviceMs + texturesMs + uploadMs + rendererMs + firstSampleMs;
    }
};

struct PipelineReport {
    std::uint32_t count = 0;
    Renderer::PipelineMaking making;
    std::optional<PipelineCacheReport> cache;                   // absent: none is kept
    std::optional<std::vector<PipelineStatistics>> statistics;  // absent: not asked for, or not to be had
};

// Returns null if there is none.
base::Json cacheToJson(const PipelineReport& report);
base::Json statisticsToJson(const PipelineReport& report);
// Returns "8 in 12.3 ms by 4 threads; cache of 1.2 MiB, 8 found in it".
std::string toText(const PipelineReport& report);

base::Json toJson(const StartReport& start);
std::string toText(const StartReport& start);

// Returns a table with a row for each executable, and the facts that inspect::factsOf() finds.
std::string tableOf(std::span<const PipelineStatistics> pipelines);
// Returns a cell of tables: "72", "38 %", or "-".
std::string factText(const inspect::FactInfo& info, const inspect::PipelineFacts& facts);

struct MemoryReport {
    std::vector<MemoryItem> frame;
    std::vector<MemoryItem> scene;
    std::uint64_t frameAllocatedBytes = 0;
    std::uint64_t sceneAllocatedBytes = 0;
};

std::uint64_t bytesOf(const std::vector<MemoryItem>& items);

base::Json toJson(const MemoryReport& memory);
std::string toText(const MemoryReport& memory);

}  // namespace glint::cli
