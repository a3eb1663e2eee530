#include "measure/calibration_measure.h"

#include "base/clock.h"
#include "base/lists.h"
#include "image/image_file.h"
#include "image/tone.h"
#include "resolve/resolve.h"
#include "synthetic/cases_scene.h"

#include <glint/measure/bed.h>
#include <glint/measure/machine.h>
#include <glint/session/camera.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <utility>

namespace glint::measure {

namespace {

package::Effect effectOf(synthetic::Coherence coherence) {
    return compiler::builtinEffects(
        {coherence == synthetic::Coherence::Coherent ? "reflection" : "indirect-diffuse"});
}

compiler::Settings settingsOf(const CalibrationSettings& settings, std::uint32_t tracers) {
    compiler::Settings asked = settings.render;
    asked.profile.clear();
    asked.packLobes.clear();
    asked.compile.plan = {};
    asked.compile.plan.merge = compiler::MergePolicy::None;
    asked.alpha = package::AlphaPolicy::Opaque;
    asked.sun = compiler::Sun::Off;
    asked.strategy = package::strategyTable().front().strategy;
    for (const std::string& strategy : strategiesFor(tracers)) {
        asked.furtherStrategies |= *valueNamed<package::Strategy>(strategy);
    }
    // The settings cover scenes with both kinds of rays, so that they can share a package.
    asked.compile.effects = {false, compiler::builtinEffects({"reflection", "indirect-diffuse"})};
    if (settings.shadows) {
        asked.compile.effects.named |= compiler::builtinEffects({"shadow"});
    }
    return asked;
}

// Returns the size of the code of each case's own shader.
std::vector<CaseWork> workOf(const compiler::CompiledPackage& compiled) {
    std::vector<CaseWork> work(compiled.plan.cases.size());
    for (const compiler::CompiledModule& module : compiled.modules) {
        if (package::findRole(module.key.role)->over == package::Over::Buckets) {
            CaseWork& one = work[module.key.index];
            one.instructions = module.statistics.instructions;
            one.fetches = module.statistics.textureFetches;
        }
    }
    return work;
}

}  // namespace

std::vector<std::string> strategiesFor(std::uint32_t tracers) {
    std::vector<std::string> names;
    for (const package::Strategy strategy : package::strategies()) {
        const bool pipelineOnly = (strategy & package::pipelineStrategies()) != 0;
        if (!pipelineOnly || (tracers & package::kTracerRayPipeline) != 0) {
            names.emplace_back(package::nameOf(strategy));
        }
    }
    return names;
}

Result<CompiledGroup> compileGroup(const CalibrationSettings& settings, std::uint32_t tracers,
                                   std::vector<synthetic::CasesOptions> options,
                                   compiler::ModuleCache* cache) {
    CompiledGroup group;
    group.scenes = base::mapped<gltf::Scene>(options, synthetic::makeCasesScene);
    group.options = std::move(options);
    GLINT_TRY(const auto build,
              compiler::resolve(group.scenes, settingsOf(settings, tracers), {.tracers = tracers}));
    group.settings = build.settings;
    GLINT_TRY(group.package, compilePackage(build, cache));
    return group;
}

Result<CalibrationGroup> uploadGroup(Context& context, const CompiledGroup& compiled) {
    CalibrationGroup group;
    group.work = workOf(compiled.package);
    GLINT_TRY(group.package, session::loadPackage(compiled.package));
    for (std::size_t i = 0; i < compiled.scenes.size(); ++i) {
        const gltf::Scene& scene = compiled.scenes[i];
        const synthetic::CasesOptions& options = compiled.options[i];
        GLINT_TRY(const auto camera, session::sceneCamera(scene, 0, options.aspect));
        session::SceneViewData data = session::sceneView(compiled.settings, scene);
        data.packageScene = static_cast<std::uint32_t>(i);
        GLINT_TRY(auto uploaded, session::DeviceScene::upload(context, group.package, std::move(data)));
        group.scenes.push_back({options, std::move(uploaded), camera, effectOf(options.coherence)});
    }
    return group;
}

namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

// The number of samples is chosen so that uber takes this long, within limits. The clock of a GPU ticks in
// microseconds at worst, and a sample of 10⁶ rays takes about one millisecond.
constexpr double kLeastMs = 10.0;
constexpr std::uint32_t kMaxSamples = 16;
// The limit of a visible difference, relative to the larger of the pixel and 1, which is the white of the
// scenes' light. Strategies add the same numbers in the same order, so every difference beyond rounding is a
// defect.
constexpr double kVisible = 1e-3;

constexpr std::uint32_t kTile = 8;

PictureDifference differenceOf(const LinearImage& image, const LinearImage& reference) {
    PictureDifference difference;
    difference.pixels = image.pixels.size();
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        double largest = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double a = image.pixels[i][c];
            const double b = reference.pixels[i][c];
            const double error = std::abs(a - b) / std::max(1.0, std::abs(b));
            // A value that is not a number counts as wrong too.
            largest = error <= largest ? largest : std::isfinite(error) ? error : 1e30;
        }
        difference.largest = std::max(difference.largest, largest);
        difference.differing += largest > kVisible ? 1 : 0;
    }
    return difference;
}

// A strategy that is ready to run.
struct Runner {
    std::size_t strategy = 0;  // index into CalibrationEntry::strategies
    std::unique_ptr<Renderer> renderer;
    double roundMs = 0.0;  // of the current round
};

class PointMeasurer {
public:
    PointMeasurer(Context& context, CalibrationGroup& group, const CalibrationScene& scene,
                  const CalibrationSettings& settings, const PointOptions& options)
        : context_(context), group_(group), scene_(scene), settings_(settings), options_(options) {
        sizeFor(options.rays, entry_.width, entry_.height);
        frame_ = session::frameOptions(settings.render, scene.camera, session::SkyChoice{}, nullptr);
        frame_.effects = scene.effect;
    }

    Result<CalibrationEntry> run() {
        describe();
        GLINT_TRY_DO(makeRunners());
        const bool onCpu = isOnCpu(context_);
        entry_.samples = onCpu ? 1 : samplesFor(uberMs_);
        std::mt19937_64 random(options_.seed);
        for (std::uint32_t round = 0; !runners_.empty() && round < options_.rounds; ++round) {
            GLINT_TRY_DO(measureRound(round, random, !onCpu));
        }
        for (Runner& runner : runners_) {
            entry_.strategies[runner.strategy].split /= options_.rounds;
        }
        settleEntry(entry_);
        return std::move(entry_);
    }

private:
    void describe() {
        CalibrationPoint& point = entry_.point;
        point.cases = static_cast<std::uint32_t>(scene_.options.cases);
        point.cost = synthetic::nameOf(scene_.options.cost);
        point.coherence = synthetic::nameOf(scene_.options.coherence);
        point.coherentShare = synthetic::coherentShareOf(scene_.options, entry_.width, entry_.height);
        point.work = group_.work;
        entry_.shares = synthetic::nameOf(scene_.options.shares);
        entry_.lights = static_cast<std::uint32_t>(scene_.options.lights);
        entry_.shadows = settings_.shadows;
    }

    static std::uint32_t samplesFor(double milliseconds) {
        const double wanted = std::ceil(kLeastMs / std::max(milliseconds, 1e-3));
        return static_cast<std::uint32_t>(std::clamp(wanted, 1.0, static_cast<double>(kMaxSamples)));
    }

    // Returns the time of the passes in which strategies differ, for the last sample of `renderer`, in
    // milliseconds.
    static Result<double> hitMs(Renderer& renderer) {
        GLINT_TRY(const auto timings, renderer.timings());
        return stretchMs(timings, Pass::Hits);
    }

    Status makeRunners() {
        for (const std::string& name : strategiesFor(context_.handles().tracers)) {
            entry_.strategies.emplace_back().strategy = name;
            GLINT_TRY_DO(makeRunner(entry_.strategies.size() - 1));
        }
        reference_ = {};
        return okStatus();
    }

    // The first runner is uber.
    Status makeRunner(std::size_t index) {
        StrategyMeasure& measure = entry_.strategies[index];
        if (index > 0 && runners_.empty()) {
            measure.skipped = "uber could not run, which is what all are compared with";
            return okStatus();
        }
        compiler::Settings asked = settings_.render;
        asked.strategy = *valueNamed<package::Strategy>(measure.strategy);
        if ((*asked.strategy & package::pipelineStrategies()) != 0) {
            asked.renderer.tracer.reset();
        }
        asked.renderer.width = entry_.width;
        asked.renderer.height = entry_.height;
        asked.renderer.bands = 1;  // the model is that of one list
        Result<std::unique_ptr<Renderer>> renderer =
            scene_.scene.makeRenderer(context_, session::rendererOptions(asked));
        if (!renderer) {
            measure.skipped = renderer.error().message;
            return okStatus();
        }
        measure.pipelineMs = (*renderer)->pipelineMaking().milliseconds;
        measure.bytes = (*renderer)->footprint().bytes;
        measure.tracer = package::nameOf((*renderer)->tracer());
        if ((*asked.strategy & package::orderedStrategies()) != 0) {
            measure.ordering = package::nameOf((*renderer)->ordering());
        }
        runners_.push_back({index, std::move(*renderer)});
        return renderFirst(*runners_.back().renderer, measure);
    }

    Status renderFirst(Renderer& renderer, StrategyMeasure& measure) {
        const base::Clock::time_point start = base::Clock::now();
        GLINT_TRY(auto image, renderer.render(frame_, 1));
        measure.firstMs = base::millisecondsSince(start);
        GLINT_TRY(const auto counters, renderer.counters());
        countHits(counters);
        if (runners_.size() > 1) {
            measure.difference = differenceOf(image, reference_);
            return okStatus();
        }
        measure.difference.pixels = image.pixels.size();
        reference_ = std::move(image);
        if (!options_.picture.empty()) {
            GLINT_TRY_DO(
                image::writeImage(options_.picture, reference_, image::automaticExposure(reference_)));
        }
        // It renders again, because the first sample may have included compilation.
        GLINT_TRY_DO(renderer.renderSamples(frame_, 1));
        GLINT_TRY(uberMs_, hitMs(renderer));
        return okStatus();
    }

    // Any strategy gives the number of hits; a strategy that counts hits by case also gives the shares.
    void countHits(const Renderer::Counters& counters) {
        const Renderer::EffectCounters effect = counters.of(scene_.effect);
        CalibrationPoint& point = entry_.point;
        point.rays = effect.rays;
        point.hitShare = effect.rays > 0 ? static_cast<double>(effect.hits) / effect.rays : 0.0;
        entry_.hits = effect.hits;
        if (counters.bucketCounts.size() != point.work.size() + 1 || effect.hits == 0) {
            return;
        }
        entry_.filledCases = 0;
        for (std::size_t i = 0; i < point.work.size(); ++i) {
            const std::uint32_t hits = counters.bucketCounts[i + 1];
            point.work[i].share = static_cast<double>(hits) / effect.hits;
            entry_.filledCases += hits > 0 ? 1 : 0;
        }
    }

    Status warmUp(Runner& runner, Milliseconds time) const {
        const base::Clock::time_point start = base::Clock::now();
        while (base::Clock::now() - start < time) {
            GLINT_TRY_DO(runner.renderer->renderSamples(frame_, 1));
        }
        return okStatus();
    }

    Status measureRound(std::uint32_t round, std::mt19937_64& random, bool warms) {
        GLINT_TRY_DO(warms ? warmUp(runners_.front(), kRoundWarmUp) : okStatus());
        FrameOptions frame = frame_;
        frame.seed = options_.seed + round;
        for (const std::size_t i : shuffled(runners_.size(), random)) {
            GLINT_TRY_DO(warms ? warmUp(runners_[i], kWarmUp) : okStatus());
            GLINT_TRY_DO(measureOnce(runners_[i], frame));
        }
        const double uberMs = std::max(runners_.front().roundMs, 1e-9);
        for (const Runner& runner : runners_) {
            StrategyMeasure& measure = entry_.strategies[runner.strategy];
            measure.times.push_back(runner.roundMs);
            measure.ratios.push_back(runner.roundMs / uberMs);
        }
        return okStatus();
    }

    Status measureOnce(Runner& runner, FrameOptions frame) {
        double sum = 0.0;
        const auto addHits = [&]() -> Status {
            GLINT_TRY(const auto milliseconds, hitMs(*runner.renderer));
            sum += milliseconds;
            return okStatus();
        };
        GLINT_TRY_DO(runner.renderer->renderSamples(frame, entry_.samples, addHits));
        runner.roundMs = sum / entry_.samples;
        // Measures the passes one by one on one more sample, which keeps them from overlapping.
        frame.timing = Timing::Passes;
        GLINT_TRY_DO(runner.renderer->renderSamples(frame, 1));
        GLINT_TRY(const auto passes, runner.renderer->timings());
        entry_.strategies[runner.strategy].split += hitTimesOf(passes);
        return okStatus();
    }

    Context& context_;
    CalibrationGroup& group_;
    const CalibrationScene& scene_;
    const CalibrationSettings& settings_;
    const PointOptions& options_;
    FrameOptions frame_;
    CalibrationEntry entry_;
    std::vector<Runner> runners_;  // of strategies that run; the first is uber
    LinearImage reference_;        // uber's first sample
    double uberMs_ = 0.0;          // of one sample
};

}  // namespace

void sizeFor(std::uint64_t rays, std::uint32_t& width, std::uint32_t& height) {
    const double side = std::sqrt(static_cast<double>(rays) / 2.0);
    const auto tiles = static_cast<std::uint32_t>(std::lround(side / kTile));
    height = kTile * std::max(1U, tiles);
    width = 2 * height;
}

Result<CalibrationEntry> measurePoint(Context& context, CalibrationGroup& group,
                                      const CalibrationScene& scene, const CalibrationSettings& settings,
                                      const PointOptions& options) {
    return PointMeasurer(context, group, scene, settings, options).run();
}

}  // namespace glint::measure
