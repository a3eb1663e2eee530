// glint bench: what each setting costs in time, and what it gains in accuracy.
#include "cli/bench/bench.h"

#include "base/clock.h"
#include "base/fields.h"
#include "base/files.h"
#include "base/json.h"
#include "cli/command_line.h"
#include "cli/console.h"
#include "cli/options/options.h"
#include "cli/options/setting_options.h"
#include "cli/report.h"
#include "measure/calibration_measure.h"

#include <glint/measure/observer.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace glint::cli {

namespace {

// --- glint bench --calibrate: measures on generated scenes which strategy is fastest on this device ---

namespace fs = std::filesystem;

Status measureAll(const Console& console, const BenchArguments& arguments,
                  measure::CalibrationReport& report) {
    GLINT_TRY_DO(measure::checkBenchFolder(arguments.output, measure::kCalibrationFile));
    if (!arguments.calibrate.pictures.empty()) {
        GLINT_TRY_DO(measure::makeBenchFolder(arguments.calibrate.pictures, "give another --pictures"));
    }
    GLINT_TRY(const auto context, measure::openCalibrationDevice(arguments.render));
    report.machine = measure::machineOf(*context);
    CompileCache cache(arguments.render.cache, "");
    measure::CalibrationSettings settings = arguments.calibrate;
    settings.render = arguments.render;
    settings.output = arguments.output;
    settings.quick = arguments.quick;
    Status done = measure::runCalibration(console, settings, *context, cache.modules(), report);
    cache.close(console);
    return done;
}

// Returns what was fitted, as text; empty if there were too few measurements.
std::string fittedText(const std::optional<measure::DeviceFile>& fitted, const fs::path& folder) {
    return !fitted
               ? std::string()
               : fmt::format("\n{}\n{}: give it to --calibration, and --strategy auto goes by this device.\n",
                             describe(*fitted), (folder / measure::kDeviceFile).string());
}

// Measures and writes the results. Returns the exit code.
Result<int> calibrate(const Console& console, const BenchArguments& arguments) {
    measure::CalibrationReport report;
    report.command = arguments.command;
    report.date = measure::utcNow();
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = arguments.render.frame.seed + 1;
    report.quick = arguments.quick;
    GLINT_TRY_DO(measureAll(console, arguments, report));
    GLINT_TRY(const auto fitted, measure::fitCalibration(console, arguments.output));
    if (console.refused()) {
        return kExitFailed;
    }
    answer(
        console, [&] { return base::jsonOf(report); },
        [&](Detail) {
            return fmt::format("{}\n{} has the same numbers.\n{}", toText(report),
                               (fs::path(arguments.output) / measure::kCalibrationFile).string(),
                               fittedText(fitted, arguments.output));
        });
    return kExitDone;
}

Status bench(const Console& console, const BenchArguments& arguments, const gltf::Scene& scene,
             measure::BenchReport& report) {
    const base::Clock::time_point start = base::Clock::now();
    CompileCache cache(arguments.render.cache, "");
    GLINT_TRY(const auto bed,
              measure::BenchBed::create(console, arguments.render, scene, cache.modules(), cache.store()));
    console.report(idleSettings(bed->build()));
    if (console.refused()) {
        return okStatus();
    }
    PipelineCacheFile pipelineCache(console, bed->context(),
                                    pipelineCacheFolder(arguments.render.pipelines, arguments.render.cache));
    Status done = measure::runBench(console, arguments, *bed, cache.store(), report);
    pipelineCache.save();
    cache.close(console);
    report.seconds = std::chrono::duration<double>(base::Clock::now() - start).count();
    return done;
}

Result<int> run(const Console& console, const BenchArguments& arguments) {
    GLINT_TRY_DO(measure::checkBenchFolder(arguments.output));
    console.progress("reading " + arguments.render.scene);
    CompileCache known(arguments.render.cache, "");
    GLINT_TRY(const auto opened, session::open(arguments.render.scene, arguments.render, known.store()));
    console.report(opened.scene.warnings);
    if (console.refused()) {
        return kExitFailed;
    }
    measure::BenchReport report;
    report.command = arguments.command;
    report.date = measure::utcNow();
    report.viewWords = arguments.viewWords;
    report.scene.file = arguments.render.scene;
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = arguments.render.frame.seed + 1;
    report.batch = static_cast<std::uint32_t>(arguments.batch);
    report.quick = arguments.quick;
    report.metric = arguments.metric;
    GLINT_TRY_DO(bench(console, arguments, opened.scene, report));
    if (console.refused()) {
        return kExitFailed;
    }
    GLINT_TRY_DO(measure::writeBench(report, arguments.output));
    answer(
        console, [&] { return base::jsonOf(report); },
        [&](Detail) {
            return fmt::format("{}\n{}: open it in a browser; {} has the same numbers.\n", toText(report),
                               (fs::path(arguments.output) / measure::kPageFile).string(),
                               (fs::path(arguments.output) / measure::kReportFile).string());
        });
    if (report.advice && !report.advice->point) {
        return makeError(
            "bench-advice", arguments.render.scene, report.advice->why,
            "allow more time or more error, or leave out the limit; the measurements are still written");
    }
    return kExitDone;
}

Result<int> reportDevice(const Console& console, const BenchArguments& arguments) {
    const std::string& file = arguments.calibrate.deviceReport;
    GLINT_TRY_DO(base::checkOutputFile(file));
    CompileCache cache(arguments.render.cache, "");
    std::optional<gltf::Scene> scene;
    if (!arguments.render.scene.empty()) {
        GLINT_TRY(auto opened, session::open(arguments.render.scene, arguments.render, cache.store()));
        console.report(opened.scene.warnings);
        scene = std::move(opened.scene);
    }
    const measure::DeviceReportSettings settings{arguments.render,
                                                 static_cast<std::uint32_t>(arguments.rounds),
                                                 arguments.render.frame.seed + 1, arguments.quick};
    const Result<base::Json> report = measure::makeDeviceReport(console, settings, scene ? &*scene : nullptr,
                                                                cache.modules(), cache.store());
    cache.close(console);
    if (!report) {
        return report.error();
    }
    GLINT_TRY_DO(base::writeFile(file, base::toText(*report)));
    if (console.refused()) {
        return kExitFailed;
    }
    answer(
        console, [&] { return *report; },
        [&](Detail) {
            return fmt::format("{} tells of {}: docs/performance.md says where to send it.\n", file,
                               report->at("machine").at("device").get<std::string>());
        });
    return kExitDone;
}

Result<int> runChosen(const Console& console, const BenchArguments& arguments) {
    if (!arguments.calibrate.deviceReport.empty()) {
        return reportDevice(console, arguments);
    }
    return arguments.calibrate.enabled ? calibrate(console, arguments) : run(console, arguments);
}

}  // namespace

void addBench(CLI::App& app, Action& chosen) {
    CLI::App& command =
        addCommand(app, {.name = "bench",
                         .what = "Measure the error and the time of each accuracy setting",
                         .examples = {"glint bench scene.gltf -o out/bench --quick --budget-ms 20",
                                      "glint bench --calibrate -o out/calibration"},
                         .usual = {"--output", "--quick", "--budget-ms", "--max-error", "--only",
                                   "--reference", "--size", "--spp", "--calibrate", "--device"}});
    const auto arguments = std::make_shared<BenchArguments>();
    addBenchOptions(command, *arguments);
    command.callback([arguments, &command, &chosen] {
        settleBench(command, *arguments);
        chosen = [arguments](const Console& console) { return runChosen(console, *arguments); };
    });
}

}  // namespace glint::cli
