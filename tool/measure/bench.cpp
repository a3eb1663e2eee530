#include "gltf/codecs/basisu.h"
#include "measure/measurer.h"

#include <glint/measure/bench.h>
#include <glint/measure/sweep.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint::measure {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr Interval kNoOffer{kNever, kNever, kNever, kNever, kNever};

BenchPoint makePoint(PointKind kind, compiler::Configuration configuration) {
    BenchPoint point;
    point.kind = kind;
    point.name = nameOf(configuration);
    point.configuration = std::move(configuration);
    return point;
}

// Does all the work between reading the scene and writing the files.
class Bench {
public:
    Bench(const Observer& observer, const BenchSettings& settings, BenchBed& bed, compiler::CacheStore* store,
          BenchReport& report)
        : observer_(observer), settings_(settings), bed_(bed), store_(store), report_(report) {}

    Status run() {
        GLINT_TRY_DO(makeTruth());
        base_ = makePoint(PointKind::Default, {});
        const MeasureOptions options{static_cast<std::uint32_t>(settings_.rounds), report_.seed,
                                     static_cast<std::uint32_t>(settings_.batch), settings_.filter,
                                     report_.metric};
        const Truth truth{report_.reference.image, report_.reference.exposure};
        observer_.progress("compiling the default");
        GLINT_TRY(auto measurer, Measurer::create(observer_, bed_, options, truth, base_));
        std::vector<BenchPoint> points;
        for (const Candidate& candidate : settings_.candidates) {
            BenchPoint point = makePoint(PointKind::Package, {});
            point.name = candidate.name;
            point.package = candidate.folder;
            points.push_back(std::move(point));
        }
        add(points, PointKind::Single, singles(report_.settings, report_.base));
        if (settings_.filter != nullptr) {
            addFiltered(points);
        }
        if (settings_.depth != "singles") {
            add(points, PointKind::Pair, pairs(report_.settings, report_.base, settings_.quick));
        }
        // Measures all exact values together, beside each one alone.
        if (compiler::Configuration exact = exactTogether(report_.settings, report_.base); exact.size() > 1) {
            add(points, PointKind::Exact, {std::move(exact)});
        }
        Status measured = measure(measurer, std::move(points));
        for (std::size_t i = 0; measured && i < searches(); ++i) {
            std::vector<BenchPoint> found;
            const std::size_t count = settings_.quick ? kQuickProposals : kProposals;
            add(found, PointKind::Search, proposals(report_.settings, report_.base, rated(), count));
            if (found.empty()) {
                break;
            }
            measured = measure(measurer, std::move(found));
        }
        if (!measured) {
            return measured;
        }
        finish();
        return okStatus();
    }

private:
    static constexpr std::uint32_t kFilteredFrames = 16;
    static constexpr std::size_t kProposals = 12;
    static constexpr std::size_t kQuickProposals = 4;

    std::size_t searches() const {
        constexpr std::size_t kSearches = 3;
        return settings_.depth != "search" ? 0 : settings_.quick ? 1 : kSearches;
    }

    // Makes the reference, learns about the scene's light from it, and then decides which settings there are.
    Status makeTruth() {
        compiler::BenchFacts facts = factsOf(bed_.build());
        const std::uint32_t tracers = bed_.context().handles().tracers;
        facts.rayPipeline = (tracers & package::kTracerRayPipeline) != 0;
        facts.positionFetch = bed_.facts().positionFetch;
        facts.float16 = bed_.facts().float16;
        facts.packsTextures = gltf::hasBasisu() && bed_.context().texelFormats().has(TexelFormat::Bc7, true);
        facts.fullTransport = settings_.reference == "full";
        const ReferenceOptions options{settings_.referenceError,
                                       static_cast<std::uint32_t>(settings_.referenceSamples)};
        GLINT_TRY(report_.reference, makeReference(observer_, bed_, facts, options, store_));
        if (!report_.reference.reached) {
            observer_.report(makeWarning(
                "bench-reference", report_.scene.file,
                fmt::format("the reference is within {:.2g} % after {} samples, not {:.2g} %",
                            100.0 * report_.reference.relativeError, report_.reference.samples,
                            100.0 * options.target),
                "give more --reference-spp, or ask for less with --reference-error: smaller errors can't "
                "be told apart"));
        }
        facts.white = std::exp2(-report_.reference.exposure);
        report_.settings = settingsFor(facts, report_.base, settings_.quick);
        if (!settings_.only.empty()) {
            std::erase_if(report_.settings, [this](const Setting& setting) {
                return std::ranges::find(settings_.only, setting.name) == settings_.only.end();
            });
        }
        return okStatus();
    }

    static void add(std::vector<BenchPoint>& points, PointKind kind,
                    std::vector<compiler::Configuration> configurations) {
        for (compiler::Configuration& configuration : configurations) {
            points.push_back(makePoint(kind, std::move(configuration)));
        }
    }

    // The filter's pictures, and one of many samples for comparison.
    void addFiltered(std::vector<BenchPoint>& points) const {
        for (const std::uint32_t frames : {1U, kFilteredFrames}) {
            BenchPoint point = makePoint(PointKind::Filtered, {});
            point.name = frames == 1 ? std::string("denoised") : fmt::format("denoised, frame {}", frames);
            point.filteredFrames = frames;
            points.push_back(std::move(point));
        }
        const compiler::Configuration many = simplified({{"spp", "64"}}, report_.base);
        if (!many.empty() && std::ranges::find(points, many, &BenchPoint::configuration) == points.end()) {
            add(points, PointKind::Single, {many});
        }
    }

    Status measure(Measurer& measurer, std::vector<BenchPoint> points) {
        GLINT_TRY_DO(measurer.measure(points));
        for (BenchPoint& point : points) {
            if (!point.times.empty()) {
                report_.points.push_back(std::move(point));
            }
        }
        return checkValidation(observer_, bed_.context());
    }

    // Rates the points that the tool makes itself; errors are of a kind that adds up.
    std::vector<Rated> rated() const {
        std::vector<Rated> all;
        const auto add = [&](const BenchPoint& point) {
            if (isOfSettings(point.kind)) {
                const double error = errorOf(point, report_.metric).median;
                all.push_back({point.configuration, timeRatio(point).median, additive(report_.metric, error),
                               isTimeTie(point), isErrorTie(point)});
            }
        };
        add(base_);
        std::ranges::for_each(report_.points, add);
        return all;
    }

    void finish() {
        report_.points.insert(report_.points.begin(), std::move(base_));
        std::vector<Rated> points;
        for (const BenchPoint& point : report_.points) {
            points.push_back({point.configuration, timeRatio(point).median,
                              errorOf(point, report_.metric).median, isTimeTie(point), isErrorTie(point)});
        }
        report_.front = paretoFront(withTiesSettled(points));
        report_.errorParts = partsOfError(report_.points, report_.settings, report_.metric);
        report_.strategies = compareStrategies(report_.points, report_.base.find("strategy")->second);
        if (settings_.budgetMs > 0.0 || settings_.maxError > 0.0) {
            report_.advice = advise();
        }
    }

    BenchAdvice advise() const {
        BenchAdvice advice;
        Demand demand;
        if (settings_.budgetMs > 0.0) {
            advice.budgetMs = demand.time = settings_.budgetMs;
        }
        if (settings_.maxError > 0.0) {
            advice.maxError = demand.error = settings_.maxError;
        }
        std::vector<Offer> offers;
        std::size_t fastest = 0;
        std::size_t best = 0;
        for (std::size_t i = 0; i < report_.points.size(); ++i) {
            const BenchPoint& point = report_.points[i];
            offers.push_back({timeOf(report_, i), errorOf(point, report_.metric)});
            if (point.kind == PointKind::Filtered) {
                offers.back().error = kNoOffer;  // settings alone don't make its picture
                offers.back().time = kNoOffer;
            }
            fastest = offers[i].time.median < offers[fastest].time.median ? i : fastest;
            best = offers[i].error.median < offers[best].error.median ? i : best;
        }
        advice.point = measure::advise(offers, demand);
        advice.file = (std::filesystem::path(settings_.output) / kSettingsFile).string();
        const auto describe = [&](std::size_t i) {
            return fmt::format("{}: {:.3g} ms ({:.3g} to {:.3g}), {} {:.3g} ({:.3g} to {:.3g})",
                               report_.points[i].name, offers[i].time.median, offers[i].time.low,
                               offers[i].time.high, nameOf(report_.metric), offers[i].error.median,
                               offers[i].error.low, offers[i].error.high);
        };
        if (advice.point) {
            advice.why = fmt::format(
                "{}. Of {} measured configurations it has the {} of those whose intervals are within what is "
                "asked for; ties go to the {} one.",
                describe(*advice.point), report_.points.size(),
                advice.budgetMs ? "least error" : "least time", advice.budgetMs ? "faster" : "more exact");
        } else {
            advice.why = fmt::format(
                "no measured configuration is surely within what is asked for; the "
                "fastest is {}; the most exact is {}",
                describe(fastest), describe(best));
        }
        return advice;
    }

    const Observer& observer_;
    const BenchSettings& settings_;
    BenchBed& bed_;
    compiler::CacheStore* store_;
    BenchReport& report_;
    BenchPoint base_;  // joins the report's points at the end
};

void describeScene(BenchBed& bed, BenchReport& report) {
    const compiler::Settings& render = bed.base();
    BenchScene& scene = report.scene;
    scene.triangles = bed.facts().triangles;
    scene.instances = bed.facts().instances;
    scene.materials = bed.scene().materials.size();
    scene.lights = bed.facts().lights;
    scene.inFile = gltf::sceneInFile(bed.scene());
    scene.camera = bed.facts().cameraName;
    scene.environment = render.environment;
    scene.width = render.renderer.width;
    scene.height = render.renderer.height;
    report.machine = machineOf(bed.context());
}

}  // namespace

Status runBench(const Observer& observer, const BenchSettings& settings, BenchBed& bed,
                compiler::CacheStore* store, BenchReport& report) {
    describeScene(bed, report);
    report.base = configurationOf(bed.base());
    return Bench(observer, settings, bed, store, report).run();
}

}  // namespace glint::measure
