#include "base/fields.h"
#include "inspect/pipelines.h"
#include "measure/calibration_measure.h"

#include <glint/measure/bed.h>
#include <glint/measure/calibration.h>
#include <glint/measure/machine.h>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::measure {

namespace {

// Scenes that share a package: as many cases, as costly, and one scene for each coherence.
struct Group {
    int cases = 1;
    synthetic::Cost cost{};
    std::vector<synthetic::Coherence> coherences;
};

// Five scenes: one case, some, and many, whose rays are those of a mirror or go anywhere.
std::vector<Group> groupsOf(bool quick) {
    using enum synthetic::Coherence;
    // Expensive cases take minutes to compile on few cores.
    const synthetic::Cost costly = quick ? synthetic::Cost::Cheap : synthetic::Cost::Expensive;
    return {{1, costly, {Incoherent}},
            {quick ? 2 : 16, synthetic::Cost::Cheap, {Coherent, Incoherent}},
            {quick ? 3 : 64, costly, {Coherent, Incoherent}}};
}

std::uint64_t raysOf(bool quick, bool onCpu) {
    return quick ? 1024 : onCpu ? 16'000 : 1'000'000;
}

Result<std::unique_ptr<Context>> open(const compiler::Settings& render, bool positionFetch, bool float16) {
    HeadlessOptions options = session::deviceOptions(render);
    options.pipelineStatistics = true;
    options.positionFetch = positionFetch;
    options.shaderFloat16 = float16;
    return Context::createHeadless(options);
}

base::Json featuresToJson(const compiler::Settings& render, const Context& context) {
    const DeviceHandles& handles = context.handles();
    return {{"rayQuery", (handles.tracers & package::kTracerRayQuery) != 0},
            {"rayPipeline", (handles.tracers & package::kTracerRayPipeline) != 0},
            {"positionFetch", open(render, true, false).ok()},
            {"shaderFloat16", open(render, false, true).ok()},
            {"opacityMicromaps", handles.opacityMicromaps},
            {"pipelineStatistics", handles.pipelineStatistics},
            {"subgroupSize", context.subgroupSize()}};
}

class DeviceReport {
public:
    DeviceReport(const Observer& observer, const DeviceReportSettings& settings, compiler::ModuleCache* cache,
                 compiler::CacheStore* store)
        : observer_(observer), settings_(settings), cache_(cache), store_(store) {}

    Result<base::Json> make(const gltf::Scene* scene) {
        GLINT_TRY(context_, open(settings_.render, false, false));
        for (const Group& group : groupsOf(settings_.quick)) {
            GLINT_TRY_DO(measureGroup(group));
        }
        base::Json picture = nullptr;
        if (scene != nullptr) {
            GLINT_TRY(picture, measureScene(*scene));
        }
        GLINT_TRY_DO(checkValidation(observer_, *context_));
        return base::Json{{"format", "glint-device-report"},
                          {"version", 1},
                          {"tool", GLINT_VERSION},
                          {"commit", sourceCommit()},
                          {"date", utcNow()},
                          {"quick", settings_.quick},
                          {"rounds", settings_.rounds},
                          {"machine", base::jsonOf(machineOf(*context_))},
                          {"features", featuresToJson(settings_.render, *context_)},
                          {"scene", std::move(picture)},
                          {"generated", std::move(points_)},
                          {"pipelines", std::move(pipelines_)}};
    }

private:
    // Reports contain no folder, so `name` identifies the package.
    Status addPipelines(const Package& package, const std::string& name) {
        observer_.progress("making the pipelines of " + name);
        inspect::Manifest manifest;
        manifest.merge = compiler::nameOf(compiler::MergePolicy::None);
        GLINT_TRY(const auto report, inspect::reportPipelines(*context_, package, manifest, name));
        pipelines_.push_back(base::jsonOf(report));
        return okStatus();
    }

    Status measureGroup(const Group& group) {
        CalibrationSettings settings;
        settings.render = settings_.render;
        std::vector<synthetic::CasesOptions> scenes;
        for (const synthetic::Coherence coherence : group.coherences) {
            synthetic::CasesOptions& options = scenes.emplace_back();
            options.cases = group.cases;
            options.cost = group.cost;
            options.coherence = coherence;
        }
        const std::string name = fmt::format("{} {} cases", group.cases, synthetic::nameOf(group.cost));
        observer_.progress("compiling " + name);
        GLINT_TRY(const auto compiled,
                  compileGroup(settings, context_->handles().tracers, std::move(scenes), cache_));
        GLINT_TRY(auto uploaded, uploadGroup(*context_, compiled));
        for (const CalibrationScene& scene : uploaded.scenes) {
            observer_.progress(fmt::format("{}, {}", name, synthetic::nameOf(scene.options.coherence)));
            PointOptions options;
            options.rays = raysOf(settings_.quick, isOnCpu(*context_));
            options.rounds = settings_.rounds;
            options.seed = settings_.seed;
            GLINT_TRY(const auto entry, measurePoint(*context_, uploaded, scene, settings, options));
            points_.push_back(base::jsonOf(entry));
        }
        return addPipelines(*uploaded.package, name);
    }

    // Times the picture of the user's scene with each strategy. A strategy that the device can't run is left
    // out with its reason.
    Result<base::Json> measureScene(const gltf::Scene& scene) {
        observer_.progress("timing the scene");
        GLINT_TRY(const auto bed, BenchBed::create(observer_, settings_.render, scene, cache_, store_));
        base::Json strategies = base::Json::array();
        for (const package::StrategyInfo& info : package::strategyTable()) {
            GLINT_TRY(auto measured, measureStrategy(*bed, std::string(info.name)));
            strategies.push_back(std::move(measured));
        }
        return base::Json{
            {"triangles", bed->facts().triangles},        {"instances", bed->facts().instances},
            {"materials", scene.materials.size()},        {"width", settings_.render.renderer.width},
            {"height", settings_.render.renderer.height}, {"samples", settings_.render.samples},
            {"strategies", std::move(strategies)}};
    }

    Result<base::Json> measureStrategy(BenchBed& bed, const std::string& strategy) {
        const Result<Mount> mount = bed.mount({{"strategy", strategy}});
        if (!mount) {
            return base::Json{{"strategy", strategy}, {"skipped", mount.error().message}};
        }
        std::vector<double> times;
        std::vector<double> hits;
        // The first picture may include compilation by the driver.
        for (std::uint32_t round = 0; round <= settings_.rounds; ++round) {
            GLINT_TRY(const auto exposure, mount->expose(settings_.seed + round));
            if (round > 0) {
                times.push_back(exposure.milliseconds);
                hits.push_back(exposure.hitMs);
            }
        }
        GLINT_TRY_DO(addPipelines(mount->package(), "scene, " + strategy));
        return base::Json{{"strategy", strategy},
                          {"cases", mount->cases()},
                          {"time", base::jsonOf(intervalOf(times))},
                          {"hitTime", base::jsonOf(intervalOf(hits))}};
    }

    const Observer& observer_;
    const DeviceReportSettings& settings_;
    compiler::ModuleCache* cache_;
    compiler::CacheStore* store_;
    std::unique_ptr<Context> context_;
    base::Json points_ = base::Json::array();
    base::Json pipelines_ = base::Json::array();
};

}  // namespace

Result<base::Json> makeDeviceReport(const Observer& observer, const DeviceReportSettings& settings,
                                    const gltf::Scene* scene, compiler::ModuleCache* cache,
                                    compiler::CacheStore* store) {
    return DeviceReport(observer, settings, cache, store).make(scene);
}

}  // namespace glint::measure
