// glint bench: what each setting costs in time, and what it gains in accuracy.
#include "base/clock.h"
#include "base/files.h"
#include "base/json.h"
#include "cli/bench/arguments.h"
#include "cli/bench/text.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/compile/cache.h"
#include "cli/console.h"
#include "cli/options/setting_options.h"
#include "cli/render/pipeline_cache.h"
#include "cli/report.h"
#include "gltf/import.h"
#include "measure/device_report.h"
#include "measure/report_json.h"

#include <glint/measure/bench.h>
#include <glint/measure/calibration.h>
#include <glint/measure/observer.h>
#include <glint/measure/report.h>

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace glint::cli {

namespace {

// --- glint bench --calibrate: measures on generated scenes which strategy is fastest on this device ---

namespace fs = std::filesystem;

measure::CalibrationSettings settingsOf(const BenchArguments& arguments) {
    const CalibrateArguments& given = arguments.calibrate;
    measure::CalibrationSettings settings;
    settings.render = arguments.render;
    settings.output = arguments.output;
    settings.quick = arguments.quick;
    settings.cases = casesOf(given);
    settings.rays = raysOf(given);
    settings.costs = given.costs;
    settings.coherences = given.coherences;
    settings.shares = given.shares;
    settings.lights = given.lights;
    settings.shadows = given.shadows;
    settings.pictures = given.pictures;
    return settings;
}

Status makePictureFolder(const std::string& folder) {
    std::error_code error;
    if (!folder.empty()) {
        fs::create_directories(folder, error);
    }
    return error ? Status(makeError("bench-folder", folder, "can't be made: " + error.message(),
                                    "give another --pictures"))
                 : okStatus();
}

Status measureAll(const Console& console, const BenchArguments& arguments,
                  measure::CalibrationReport& report) {
    GLINT_TRY_DO(measure::checkBenchFolder(arguments.output, measure::kCalibrationFile));
    GLINT_TRY_DO(makePictureFolder(arguments.calibrate.pictures));
    GLINT_TRY(const auto context, measure::openCalibrationDevice(arguments.render));
    report.machine = measure::machineOf(*context);
    CompileCache cache(arguments.render.cache, "");
    Status done = measure::runCalibration(console, settingsOf(arguments), *context, cache.modules(), report);
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
int calibrate(const Console& console, const BenchArguments& arguments) {
    measure::CalibrationReport report;
    report.command = arguments.command;
    report.date = measure::utcNow();
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = arguments.render.frame.seed + 1;
    report.quick = arguments.quick;
    if (Status done = measureAll(console, arguments, report); !done) {
        return fail(console, done.error());
    }
    const Result<std::optional<measure::DeviceFile>> fitted =
        measure::fitCalibration(console, arguments.output);
    if (!fitted) {
        return fail(console, fitted.error());
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (console.isJson()) {
        console.result(base::jsonOf(report));
    } else {
        console.print(toText(report));
        console.print(fmt::format("\n{} has the same numbers.\n",
                                  (fs::path(arguments.output) / measure::kCalibrationFile).string()));
        console.print(fittedText(*fitted, arguments.output));
    }
    return kExitDone;
}

Status bench(const Console& console, const BenchArguments& arguments, const gltf::Scene& scene,
             const measure::SceneReader& reader, measure::BenchReport& report) {
    const base::Clock::time_point start = base::Clock::now();
    CompileCache cache(arguments.render.cache, "");
    GLINT_TRY(const auto bed, measure::BenchBed::create(console, arguments.render, scene, reader,
                                                        cache.modules(), cache.store()));
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

int run(const Console& console, const BenchArguments& arguments) {
    const auto fail = [&console](const Diagnostic& error) {
        console.report(error);
        return kExitFailed;
    };
    if (Status writable = measure::checkBenchFolder(arguments.output); !writable) {
        return fail(writable.error());
    }
    console.progress("reading " + arguments.render.scene);
    CompileCache known(arguments.render.cache, "");
    const Result<gltf::ImportOptions> import =
        importOptions(arguments.render, ImageReading::Files, known.store());
    if (!import) {
        return fail(import.error());
    }
    const Result<gltf::Scene> scene = importScene(arguments.render.scene, *import);
    if (!scene) {
        return fail(scene.error());
    }
    console.report(scene->warnings);
    if (console.refused()) {
        return kExitFailed;
    }
    const measure::SceneReader reader = [&](bool trustsTextures) {
        gltf::ImportOptions other = *import;
        other.trustTextures = trustsTextures;
        return importScene(arguments.render.scene, other);
    };
    measure::BenchReport report;
    report.command = arguments.command;
    report.date = measure::utcNow();
    report.viewWords = arguments.viewWords;
    report.scene.file = arguments.render.scene;
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = arguments.render.frame.seed + 1;
    report.batch = static_cast<std::uint32_t>(arguments.batch);
    report.quick = arguments.quick;
    report.metric = measure::metricNamed(arguments.metric);
    if (Status done = bench(console, arguments, *scene, reader, report); !done) {
        return fail(done.error());
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (Status written = measure::writeBench(report, arguments.output); !written) {
        return fail(written.error());
    }
    if (console.isJson()) {
        console.result(base::jsonOf(report));
    } else {
        console.print(toText(report));
        console.print(fmt::format("\n{}: open it in a browser; {} has the same numbers.\n",
                                  (std::filesystem::path(arguments.output) / measure::kPageFile).string(),
                                  (std::filesystem::path(arguments.output) / measure::kReportFile).string()));
    }
    if (report.advice && !report.advice->point) {
        return fail(makeError(
            "bench-advice", arguments.render.scene, report.advice->why,
            "allow more time or more error, or leave out the limit; the measurements are still written"));
    }
    return kExitDone;
}

int reportDevice(const Console& console, const BenchArguments& arguments) {
    const std::string& file = arguments.calibrate.deviceReport;
    if (Status writable = base::checkOutputFile(file); !writable) {
        return fail(console, writable.error());
    }
    CompileCache cache(arguments.render.cache, "");
    std::optional<gltf::Scene> scene;
    if (!arguments.render.scene.empty()) {
        const Result<gltf::ImportOptions> import =
            importOptions(arguments.render, ImageReading::Files, cache.store());
        if (!import) {
            return fail(console, import.error());
        }
        Result<gltf::Scene> read = importScene(arguments.render.scene, *import);
        if (!read) {
            return fail(console, read.error());
        }
        console.report(read->warnings);
        scene = std::move(*read);
    }
    const measure::DeviceReportSettings settings{arguments.render,
                                                 static_cast<std::uint32_t>(arguments.rounds),
                                                 arguments.render.frame.seed + 1, arguments.quick};
    const Result<base::Json> report = measure::makeDeviceReport(console, settings, scene ? &*scene : nullptr,
                                                                cache.modules(), cache.store());
    cache.close(console);
    if (!report) {
        return fail(console, report.error());
    }
    if (Status written = base::writeFile(file, base::toText(*report)); !written) {
        return fail(console, written.error());
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (console.isJson()) {
        console.result(*report);
    } else {
        console.print(fmt::format("{} tells of {}: docs/performance.md says where to send it.\n", file,
                                  report->at("machine").at("device").get<std::string>()));
    }
    return kExitDone;
}

int runChosen(const Console& console, const BenchArguments& arguments) {
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
