// glint bench: what each setting costs in time, and what it gains in accuracy.
#include "base/clock.h"
#include "bench/advice.h"
#include "bench/sweep.h"
#include "cli/bench_arguments.h"
#include "cli/bench_bed.h"
#include "cli/bench_measure.h"
#include "cli/bench_output.h"
#include "cli/bench_reference.h"
#include "cli/bench_report.h"
#include "cli/calibrate.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/compile_cache.h"
#include "cli/pipeline_cache.h"
#include "cli/plan_choice.h"
#include "cli/validation_messages.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace glint {

namespace {

BenchPoint makePoint(PointKind kind, bench::Configuration configuration) {
    BenchPoint point;
    point.kind = kind;
    point.name = bench::nameOf(configuration);
    point.configuration = std::move(configuration);
    return point;
}

// Does all the work between reading the scene and writing the files.
class Bench {
public:
    Bench(const Console& console, const BenchArguments& arguments, BenchBed& bed, CacheStore* store,
          BenchReport& report)
        : console_(console), arguments_(arguments), bed_(bed), store_(store), report_(report) {}

    Status run(const PlanOptions& plan) {
        if (Status made = makeTruth(plan); !made) {
            return made;
        }
        base_ = makePoint(PointKind::Default, {});
        const MeasureOptions options{static_cast<std::uint32_t>(arguments_.rounds), report_.seed,
                                     static_cast<std::uint32_t>(arguments_.batch), report_.metric};
        const Truth truth{report_.reference.image, report_.reference.exposure};
        console_.progress("compiling the default");
        Result<Measurer> measurer = Measurer::create(console_, bed_, options, truth, base_);
        if (!measurer) {
            return measurer.error();
        }
        std::vector<BenchPoint> points;
        for (const Candidate& candidate : arguments_.candidates) {
            BenchPoint point = makePoint(PointKind::Package, {});
            point.name = candidate.name;
            point.package = candidate.folder;
            points.push_back(std::move(point));
        }
        add(points, PointKind::Single, bench::singles(report_.settings, report_.base));
        if (arguments_.depth != "singles") {
            add(points, PointKind::Pair, bench::pairs(report_.settings, report_.base, arguments_.quick));
        }
        Status measured = measure(*measurer, std::move(points));
        for (std::size_t i = 0; measured && i < searches(); ++i) {
            std::vector<BenchPoint> found;
            const std::size_t count = arguments_.quick ? kQuickProposals : kProposals;
            add(found, PointKind::Search, bench::proposals(report_.settings, report_.base, rated(), count));
            if (found.empty()) {
                break;
            }
            measured = measure(*measurer, std::move(found));
        }
        if (!measured) {
            return measured;
        }
        finish();
        return okStatus();
    }

private:
    static constexpr std::size_t kProposals = 12;
    static constexpr std::size_t kQuickProposals = 4;

    std::size_t searches() const {
        constexpr std::size_t kSearches = 3;
        return arguments_.depth != "search" ? 0 : arguments_.quick ? 1 : kSearches;
    }

    // Makes the reference, learns about the scene's light from it, and then decides which settings there are.
    Status makeTruth(const PlanOptions& plan) {
        bench::Facts facts = factsOf(arguments_.render, bed_.scene(), plan);
        const std::uint32_t tracers = bed_.context().handles().tracers;
        facts.rayPipeline = (tracers & package::kTracerRayPipeline) != 0;
        facts.positionFetch = bed_.features().positionFetch;
        facts.float16 = bed_.features().float16;
        const ReferenceOptions options{arguments_.referenceError,
                                       static_cast<std::uint32_t>(arguments_.referenceSamples)};
        Result<Reference> reference = makeReference(console_, bed_, facts, options, store_);
        if (!reference) {
            return reference.error();
        }
        report_.reference = std::move(*reference);
        if (!report_.reference.reached) {
            console_.report(makeWarning(
                "bench-reference", report_.scene.file,
                fmt::format("the reference is within {:.2g} % after {} samples, not {:.2g} %",
                            100.0 * report_.reference.relativeError, report_.reference.samples,
                            100.0 * options.target),
                "give more --reference-spp, or ask for less with --reference-error: smaller errors can't "
                "be told apart"));
        }
        facts.white = std::exp2(-report_.reference.exposure);
        report_.settings = bench::settingsFor(facts, report_.base, arguments_.quick);
        if (!arguments_.only.empty()) {
            std::erase_if(report_.settings, [this](const bench::Setting& setting) {
                return std::ranges::find(arguments_.only, setting.name) == arguments_.only.end();
            });
        }
        return okStatus();
    }

    static void add(std::vector<BenchPoint>& points, PointKind kind,
                    std::vector<bench::Configuration> configurations) {
        for (bench::Configuration& configuration : configurations) {
            points.push_back(makePoint(kind, std::move(configuration)));
        }
    }

    Status measure(Measurer& measurer, std::vector<BenchPoint> points) {
        if (Status measured = measurer.measure(points); !measured) {
            return measured;
        }
        for (BenchPoint& point : points) {
            if (!point.times.empty()) {
                report_.points.push_back(std::move(point));
            }
        }
        return checkValidation(console_, bed_.context());
    }

    // Rates the points that the tool makes itself; errors are of a kind that adds up.
    std::vector<bench::Rated> rated() const {
        std::vector<bench::Rated> all;
        const auto add = [&](const BenchPoint& point) {
            if (point.kind != PointKind::Package) {
                const double error = errorOf(point, report_.metric).median;
                const bool isRoot = report_.metric == ErrorMetric::Rmse;
                all.push_back({point.configuration, timeRatio(point).median, isRoot ? error * error : error,
                               isTimeTie(point), isErrorTie(point)});
            }
        };
        add(base_);
        std::ranges::for_each(report_.points, add);
        return all;
    }

    void finish() {
        report_.points.insert(report_.points.begin(), std::move(base_));
        std::vector<bench::Rated> points;
        for (const BenchPoint& point : report_.points) {
            points.push_back({point.configuration, timeRatio(point).median,
                              errorOf(point, report_.metric).median, isTimeTie(point), isErrorTie(point)});
        }
        report_.front = bench::paretoFront(bench::withTiesSettled(points));
        report_.strategies = compareStrategies(report_.points, report_.base.find("strategy")->second);
        if (arguments_.budgetMs > 0.0 || arguments_.maxError > 0.0) {
            report_.advice = advise();
        }
    }

    BenchAdvice advise() const {
        BenchAdvice advice;
        bench::Demand demand;
        if (arguments_.budgetMs > 0.0) {
            advice.budgetMs = demand.time = arguments_.budgetMs;
        }
        if (arguments_.maxError > 0.0) {
            advice.maxError = demand.error = arguments_.maxError;
        }
        std::vector<bench::Offer> offers;
        std::size_t fastest = 0;
        std::size_t best = 0;
        for (std::size_t i = 0; i < report_.points.size(); ++i) {
            const BenchPoint& point = report_.points[i];
            offers.push_back({timeOf(report_, i), errorOf(point, report_.metric)});
            fastest = offers[i].time.median < offers[fastest].time.median ? i : fastest;
            best = offers[i].error.median < offers[best].error.median ? i : best;
        }
        advice.point = bench::advise(offers, demand);
        advice.file = (std::filesystem::path(arguments_.output) / kSettingsFile).string();
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

    const Console& console_;
    const BenchArguments& arguments_;
    BenchBed& bed_;
    CacheStore* store_;
    BenchReport& report_;
    BenchPoint base_;  // joins the report's points at the end
};

void describeScene(const RenderArguments& arguments, BenchBed& bed, BenchReport& report) {
    BenchScene& scene = report.scene;
    const SceneSize size = bed.sceneSize();
    scene.triangles = size.triangles;
    scene.instances = size.instances;
    scene.materials = bed.scene().materials.size();
    scene.lights = bed.lights();
    scene.camera = bed.cameraName();
    scene.environment = arguments.environment.file;
    parseSize(arguments.size, scene.width, scene.height);
    report.machine = machineOf(bed.context());
}

Status bench(const Console& console, const BenchArguments& arguments, const Scene& scene,
             const PlanOptions& plan, BenchReport& report) {
    const Clock::time_point start = Clock::now();
    CompileCache cache(arguments.cache, "");
    const Result<std::unique_ptr<BenchBed>> bed =
        BenchBed::create(console, arguments.render, scene, cache.modules());
    if (!bed) {
        return bed.error();
    }
    PipelineCacheFile pipelineCache(console, (*bed)->context(),
                                    pipelineCacheFolder(arguments.render.pipelines, arguments.cache));
    describeScene(arguments.render, **bed, report);
    report.base = configurationOf((*bed)->base());
    Status done = Bench(console, arguments, **bed, cache.store(), report).run(plan);
    pipelineCache.save();
    cache.close(console);
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return done;
}

int run(const Console& console, const BenchArguments& arguments) {
    const auto fail = [&console](const Diagnostic& error) {
        console.report(error);
        return kExitFailed;
    };
    if (Status writable = checkBenchFolder(arguments.output); !writable) {
        return fail(writable.error());
    }
    console.progress("reading " + arguments.render.scene);
    ImportOptions import;
    import.decodeImages = true;
    import.variant = arguments.render.reading.variant;
    import.strictPaths = arguments.render.reading.strictPaths;
    const Result<Scene> scene = importScene(arguments.render.scene, import);
    if (!scene) {
        return fail(scene.error());
    }
    console.report(scene->warnings);
    const Result<PlanChoice> plan = choosePlan(arguments.render.plan, SceneList({&*scene, 1}));
    if (!plan) {
        return fail(plan.error());
    }
    console.report(plan->warnings);
    console.report(plan->notes);
    if (console.refused()) {
        return kExitFailed;
    }
    BenchReport report;
    report.command = arguments.command;
    report.date = utcNow();
    report.viewWords = arguments.viewWords;
    report.scene.file = arguments.render.scene;
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = static_cast<std::uint32_t>(arguments.render.seed) + 1;
    report.batch = static_cast<std::uint32_t>(arguments.batch);
    report.quick = arguments.quick;
    report.metric = metricNamed(arguments.metric);
    if (Status done = bench(console, arguments, *scene, plan->options, report); !done) {
        return fail(done.error());
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (Status written = writeBench(report, arguments.output); !written) {
        return fail(written.error());
    }
    if (console.isJson()) {
        console.result(toJson(report));
    } else {
        console.print(toText(report));
        console.print(fmt::format("\n{}: open it in a browser; {} has the same numbers.\n",
                                  (std::filesystem::path(arguments.output) / kPageFile).string(),
                                  (std::filesystem::path(arguments.output) / kReportFile).string()));
    }
    if (report.advice && !report.advice->point) {
        return fail(makeError(
            "bench-advice", arguments.render.scene, report.advice->why,
            "allow more time or more error, or leave out the limit; the measurements are still written"));
    }
    return kExitDone;
}

}  // namespace

void addBench(CLI::App& app, Action& chosen) {
    CLI::App& command = addCommand(app, "bench", "Measure what accuracy costs in time, setting by setting",
                                   "glint bench scene.gltf -o out/bench --quick --budget-ms 20");
    const auto arguments = std::make_shared<BenchArguments>();
    addBenchOptions(command, *arguments);
    command.callback([arguments, &command, &chosen] {
        settleBench(command, *arguments);
        chosen = [arguments](const Console& console) {
            return arguments->calibrate.enabled ? calibrate(console, *arguments) : run(console, *arguments);
        };
    });
}

}  // namespace glint
