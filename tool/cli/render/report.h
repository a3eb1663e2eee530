// The reports of glint render about a picture, the JSON of --stats and --json and the table, and of what is
// on the device: pipelines, how they were made and kept, the driver's statistics about them, and memory,
// buffer by buffer.
#pragma once

#include "cli/report.h"
#include "cli/table.h"
#include "gltf/import.h"
#include "inspect/pipelines.h"
#include "plan/strategy_cost.h"

#include <glint/context.h>
#include <glint/environment.h>
#include <glint/measure/views.h>
#include <glint/renderer.h>
#include <glint/scene_view.h>
#include <glint/session/sky.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::cli {

struct PipelineCacheReport {
    std::string file;
    std::uint64_t loadedBytes = 0;  // 0: there was nothing of use
    std::uint64_t savedBytes = 0;
    std::optional<std::uint32_t> hits;  // PipelineMaking::cacheHits
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
    std::optional<PipelineCacheReport> cache;  // absent: none is kept
    std::optional<std::vector<Renderer::PipelineStatistics>>
        statistics;  // absent: not asked for, or not to be had
};

// Returns a table with a row for each executable, and the facts that inspect::factsOf() finds.
std::string tableOf(std::span<const Renderer::PipelineStatistics> pipelines);
// Returns a cell of tables: "72", "38 %", or "-".
std::string factText(const inspect::FactInfo& info, const inspect::PipelineFacts& facts);

struct MemoryReport {
    std::vector<MemoryItem> frame;
    std::vector<MemoryItem> scene;
    std::uint64_t frameAllocatedBytes = 0;
    std::uint64_t sceneAllocatedBytes = 0;
    std::uint32_t bands = 1;  // that share the memory of a frame
};

base::Fields fieldsOf(const MemoryReport*);
std::string toText(const MemoryReport& memory);

// --- The report of glint render ---

struct EnvironmentReport {
    std::string file;
    Environment::Statistics statistics;
};

// One picture of a sequence.
struct FrameReport {
    std::int64_t frame = 0;
    double seconds = 0.0;  // of the animation
    std::string image;
    std::uint32_t edits = 0;  // that were made before it
    GpuScene::MotionStatistics motion;
    double poseMs = 0.0;  // wall clock: nodes, joints and weights on the CPU
    double updateMs =
        0.0;  // wall clock: the scene on the device; 0 for the first, which is uploaded in its pose
    double renderMs = 0.0;  // wall clock: all samples and the read-back
    double deviceMs = 0.0;  // the passes of the last sample
};

// The images of a scene as the device reads them.
struct TextureReport {
    std::uint32_t images = 0;
    std::uint32_t found = 0;                       // compressed, and found in the cache
    std::map<std::string, std::uint32_t> formats;  // how many have it
    std::uint64_t texels = 0;                      // of the first levels
    std::uint64_t bytes = 0;                       // of all levels
    // With --texture-levels: the finest level that was read of each texture of the package; none if it was
    // not read.
    std::vector<std::optional<std::uint32_t>> levels;
};
TextureReport textureReport(std::span<const ImageView> images);

struct RenderReport {
    std::string scene;
    gltf::SceneInFile sceneInFile;
    std::string image;
    std::string device;
    std::string driver;
    std::string strategy;
    std::optional<compiler::StrategyAdvice> strategyChoice;  // with --strategy auto
    std::string tracer;
    std::optional<std::string> ordering;  // of hits, where the strategy orders them
    std::optional<std::string> merge;     // absent: a package was given
    std::string alpha;
    std::uint32_t width = 0;   // pixels
    std::uint32_t height = 0;  // pixels
    std::uint32_t samples = 0;
    std::uint32_t seed = 0;
    std::string camera;
    double exposure = 0.0;           // stops
    bool exposureAutomatic = false;  // chosen by the first picture
    // The light of --sun, if it was added, and whether it was because the scene has none.
    struct Sun {
        LightView light;
        bool automatic = false;
    };
    std::optional<Sun> sun;
    std::optional<session::SkyChoice> sky;  // absent: an environment map lights the scene
    std::optional<double> compileMs;        // absent: a package was given
    std::uint32_t cases = 0;
    std::vector<std::string> caseNames;  // by shader ID
    std::optional<EnvironmentReport> environment;
    TextureReport textures;
    GpuScene::Statistics sceneStatistics;
    Renderer::Footprint footprint;
    bool countsLight = false;  // rays of shadow and ambient-occlusion are counted
    MemoryReport memory;
    bool hasDetails = false;  // the text has all memory, too
    PipelineReport pipelines;
    StartReport start;
    double renderMs = 0.0;                   // wall clock, all samples and the read-back
    std::vector<PassTiming> passes;          // of the last sample, of the last frame
    TrafficReport traffic;                   // of the last sample
    Renderer::Counters counters;             // of the last sample, of the last frame; nonFinite: of all
    std::vector<FrameReport> frames;         // with --frames
    std::optional<measure::View> view;       // of the last frame, with --view
    std::vector<Renderer::PixelPath> paths;  // of the last sample, row by row; for --coverage only
    std::vector<std::uint64_t> hits;         // by shader ID, of all samples that were given to addHits()

    void addHits(const Renderer::Counters& sample);
};

// Returns the error "order-check" if hits are lost, doubled or misplaced; RendererOptions::checkOrder counts
// these.
Status checkOrder(const RenderReport& report);

base::Fields fieldsOf(const RenderReport*);
std::string toText(const RenderReport& report, Detail detail);

}  // namespace glint::cli
