#include "measure/calibration_measure.h"

#include "base/clock.h"
#include "image/image_file.h"
#include "image/tone.h"
#include "measure/rounds.h"
#include "synthetic/coherence.h"

#include <glint/measure/bed.h>
#include <glint/measure/render_settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <utility>

namespace glint::measure {

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
        frame_ = frameOptions(settings.render, scene.camera, scene_view::SkyChoice{}, nullptr);
        frame_.effects = scene.effect;
    }

    Result<CalibrationEntry> run() {
        describe();
        GLINT_TRY_DO(makeRunners());
        const bool onCpu = context_.deviceType() == VK_PHYSICAL_DEVICE_TYPE_CPU;
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
            Renderer::create(context_, *group_.package, *scene_.scene, rendererOptions(asked));
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
        Result<LinearImage> image = renderer.render(frame_, 1);
        if (!image) {
            return image.error();
        }
        measure.firstMs = base::millisecondsSince(start);
        GLINT_TRY(const auto counters, renderer.counters());
        countHits(counters);
        if (runners_.size() > 1) {
            measure.difference = differenceOf(*image, reference_);
            return okStatus();
        }
        measure.difference.pixels = image->pixels.size();
        reference_ = std::move(*image);
        if (!options_.picture.empty()) {
            GLINT_TRY_DO(
                image::writeImage(options_.picture, reference_, image::automaticExposure(reference_)));
        }
        // It renders again, because the first sample may have included compilation.
        GLINT_TRY_DO(renderer.renderSamples(frame_, 1));
        const Result<double> milliseconds = hitMs(renderer);
        uberMs_ = milliseconds ? *milliseconds : 0.0;
        return milliseconds ? okStatus() : Status(milliseconds.error());
    }

    // Any strategy gives the number of hits; a strategy that counts hits by case also gives the shares.
    void countHits(const FrameCounters& counters) {
        const EffectCounters effect = counters.of(scene_.effect);
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
            Status measured = warms ? warmUp(runners_[i], kWarmUp) : okStatus();
            measured = measured ? measureOnce(runners_[i], frame) : measured;
            if (!measured) {
                return measured;
            }
        }
        const double uberMs = std::max(runners_.front().roundMs, 1e-9);
        for (const Runner& runner : runners_) {
            StrategyMeasure& measure = entry_.strategies[runner.strategy];
            measure.times.push_back(runner.roundMs);
            measure.ratios.push_back(runner.roundMs / uberMs);
        }
        return okStatus();
    }

    Status measureOnce(Runner& runner, const FrameOptions& frame) {
        double sum = 0.0;
        Status rendered = runner.renderer->renderSamples(frame, entry_.samples, [&]() -> Status {
            const Result<double> milliseconds = hitMs(*runner.renderer);
            sum += milliseconds ? *milliseconds : 0.0;
            return milliseconds ? okStatus() : Status(milliseconds.error());
        });
        runner.roundMs = sum / entry_.samples;
        return rendered ? measureSplit(runner, frame) : rendered;
    }

    // Measures the passes one by one on one more sample. Measuring each pass keeps passes from overlapping.
    Status measureSplit(Runner& runner, FrameOptions frame) {
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
