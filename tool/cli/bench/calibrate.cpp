#include "cli/bench/calibrate.h"

#include "base/json.h"
#include "cli/bench/text.h"
#include "cli/command_line.h"
#include "cli/compile/cache.h"
#include "measure/report_json.h"

#include <glint/measure/calibration.h>
#include <glint/measure/observer.h>
#include <glint/measure/report.h>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

namespace glint::cli {

namespace {

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

}  // namespace

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
        console.result(measure::toJson(report));
    } else {
        console.print(toText(report));
        console.print(fmt::format("\n{} has the same numbers.\n",
                                  (fs::path(arguments.output) / measure::kCalibrationFile).string()));
        console.print(fittedText(*fitted, arguments.output));
    }
    return kExitDone;
}

}  // namespace glint::cli
