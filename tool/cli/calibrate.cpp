#include "cli/calibrate.h"

#include "base/clock.h"
#include "base/files.h"
#include "cli/bench_output.h"
#include "cli/calibrate_group.h"
#include "cli/calibrate_measure.h"
#include "cli/calibrate_report.h"
#include "cli/calibration_points.h"
#include "cli/command_line.h"
#include "cli/compile_cache.h"
#include "cli/device_file.h"
#include "cli/validation_messages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace glint {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDeviceFile = "device.json";

std::vector<std::uint32_t> usualCases(bool quick) {
    return quick ? std::vector<std::uint32_t>{1, 16, 64} : std::vector<std::uint32_t>{1, 4, 16, 64, 256};
}

std::vector<std::uint64_t> usualRays(bool quick, bool onCpu) {
    constexpr std::uint64_t kThousand = 1000;
    const std::uint64_t unit = onCpu ? 16 * kThousand : kThousand * kThousand;
    std::vector<std::uint64_t> rays = onCpu ? std::vector<std::uint64_t>{unit, 4 * unit, 16 * unit}
                                            : std::vector<std::uint64_t>{unit, 8 * unit, 32 * unit};
    if (quick) {
        rays.pop_back();
    }
    return rays;
}

Result<std::unique_ptr<Context>> openDevice(const RenderArguments& arguments) {
    HeadlessOptions options;
    options.validation = arguments.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = arguments.device;
    options.positionFetch = arguments.tracing.positionFetch;
    options.shaderFloat16 = arguments.accuracy.halves();
    return Context::createHeadless(options);
}

template <typename Value>
std::vector<Value> chosen(const std::vector<std::string>& names, std::initializer_list<Value> values) {
    std::vector<Value> found;
    for (const Value value : values) {
        if (std::ranges::find(names, synthetic::nameOf(value)) != names.end()) {
            found.push_back(value);
        }
    }
    return found;
}

class Calibration {
public:
    Calibration(const Console& console, const BenchArguments& arguments, Context& context, ModuleCache* cache,
                CalibrationReport& report)
        : console_(console), arguments_(arguments), context_(context), cache_(cache), report_(report) {
        const CalibrateArguments& given = arguments.calibrate;
        cases_ = casesOf(given, usualCases(arguments.quick));
        rays_ = raysOf(given, usualRays(arguments.quick, isOnCpu(context)));
        costs_ = chosen(given.costs, {synthetic::Cost::Cheap, synthetic::Cost::Expensive});
        coherences_ =
            chosen(given.coherences, {synthetic::Coherence::Coherent, synthetic::Coherence::Incoherent});
    }

    // Compiles everything first, because that uses all cores of the host. Then it measures group by group and
    // writes the report after each group, so that an interrupted run keeps its measurements.
    Status run() {
        std::vector<Result<CompiledGroup>> groups = compileGroups();
        report_.compileSeconds = secondsSinceStart();
        for (std::size_t i = 0; i < groups.size(); ++i) {
            if (!groups[i]) {
                return groups[i].error();
            }
            if (Status measured = measureGroup(*groups[i]); !measured) {
                return measured;
            }
            groups[i] = Diagnostic{};  // its memory
            report_.complete = i + 1 == groups.size();
            report_.seconds = secondsSinceStart();
            if (Status written = write(); !written) {
                return written;
            }
        }
        return okStatus();
    }

private:
    double secondsSinceStart() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }

    // Returns the options of the scenes of each group.
    std::vector<std::vector<synthetic::CasesOptions>> planGroups() const {
        std::vector<std::vector<synthetic::CasesOptions>> groups;
        for (const synthetic::Cost cost : costs_) {
            for (const std::uint32_t cases : cases_) {
                std::vector<synthetic::CasesOptions>& group = groups.emplace_back();
                for (const synthetic::Coherence coherence : coherences_) {
                    synthetic::CasesOptions& options = group.emplace_back();
                    options.cases = static_cast<int>(cases);
                    options.cost = cost;
                    options.coherence = coherence;
                    options.shares = arguments_.calibrate.shares == nameOf(synthetic::Shares::Zipf)
                                         ? synthetic::Shares::Zipf
                                         : synthetic::Shares::Uniform;
                    options.lights = static_cast<int>(arguments_.calibrate.lights);
                }
            }
        }
        return groups;
    }

    // Packages with many cases have modules that take long to compile alone. Several packages are compiled at
    // a time, to use the other cores meanwhile.
    std::vector<Result<CompiledGroup>> compileGroups() const {
        constexpr std::size_t kCoresPerPackage = 4;
        const std::vector<std::vector<synthetic::CasesOptions>> plans = planGroups();
        std::vector<Result<CompiledGroup>> groups(plans.size(), Diagnostic{});
        console_.progress(fmt::format("compiling {} packages", plans.size()));
        const std::uint32_t tracers = context_.handles().tracers;
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            for (std::size_t i = next++; i < plans.size(); i = next++) {
                // The largest group is started first, so that nothing has to wait for it in the end.
                const std::size_t group = plans.size() - 1 - i;
                groups[group] = compileGroup(arguments_, tracers, plans[group], cache_);
            }
        };
        const std::size_t wanted =
            std::min<std::size_t>(plans.size(), std::thread::hardware_concurrency() / kCoresPerPackage);
        std::vector<std::jthread> threads;
        for (std::size_t i = 1; i < wanted; ++i) {
            threads.emplace_back(work);
        }
        work();
        threads.clear();  // waits for them
        return groups;
    }

    Status measureGroup(const CompiledGroup& compiled) {
        Result<CalibrationGroup> group = uploadGroup(context_, compiled);
        if (!group) {
            return group.error();
        }
        for (const CalibrationScene& scene : group->scenes) {
            for (const std::uint64_t rays : rays_) {
                if (Status measured = measure(*group, scene, rays); !measured) {
                    return measured;
                }
            }
        }
        return checkValidation(console_, context_);
    }

    Status measure(CalibrationGroup& group, const CalibrationScene& scene, std::uint64_t rays) {
        const std::string name =
            fmt::format("{} {} cases, {}, {} rays", scene.options.cases, nameOf(scene.options.cost),
                        nameOf(scene.options.coherence), rays);
        console_.progress(fmt::format("{:.0f} s: {}", secondsSinceStart(), name));
        PointOptions options{rays, report_.rounds, report_.seed};
        if (!arguments_.calibrate.pictures.empty() && rays == rays_.front()) {
            const std::string file =
                fmt::format("{}-{}-{}.png", scene.options.cases, synthetic::nameOf(scene.options.cost),
                            synthetic::nameOf(scene.options.coherence));
            options.picture = (fs::path(arguments_.calibrate.pictures) / file).string();
        }
        Result<CalibrationEntry> entry = measurePoint(context_, group, scene, arguments_, options);
        if (!entry) {
            return entry.error();
        }
        for (const StrategyMeasure& one : entry->strategies) {
            if (!one.skipped.empty()) {
                console_.report(makeWarning("calibrate-point", name,
                                            fmt::format("{} was left out: {}", one.strategy, one.skipped),
                                            "--calibrate-rays and --calibrate-cases choose points"));
            }
            if (one.difference.isWrong()) {
                console_.report(makeWarning(
                    "calibrate-picture", name,
                    fmt::format("the picture of {} is not that of uber: {} of {} pixels differ, by {:.3g} at "
                                "most; its times don't count",
                                one.strategy, one.difference.differing, one.difference.pixels,
                                one.difference.largest),
                    "this is a defect of Glint or of the driver"));
            }
        }
        console_.detail(fmt::format("fastest: {}", fmt::join(entry->fastest, ", ")));
        report_.entries.push_back(std::move(*entry));
        return okStatus();
    }

    Status write() const {
        const fs::path folder = arguments_.output;
        std::error_code error;
        fs::create_directories(folder, error);
        if (error) {
            return makeError("bench-folder", folder.string(), "can't be made: " + error.message(),
                             "give another -o");
        }
        return writeFile(folder / kCalibrationFile, toText(toJson(report_)));
    }

    const Console& console_;
    const BenchArguments& arguments_;
    Context& context_;
    ModuleCache* cache_;
    CalibrationReport& report_;
    Clock::time_point start_ = Clock::now();
    std::vector<std::uint32_t> cases_;
    std::vector<std::uint64_t> rays_;
    std::vector<synthetic::Cost> costs_;
    std::vector<synthetic::Coherence> coherences_;
};

Status makePictureFolder(const std::string& folder) {
    std::error_code error;
    if (!folder.empty()) {
        fs::create_directories(folder, error);
    }
    return error ? Status(makeError("bench-folder", folder, "can't be made: " + error.message(),
                                    "give another --pictures"))
                 : okStatus();
}

Status measureAll(const Console& console, const BenchArguments& arguments, CalibrationReport& report) {
    if (Status writable = checkBenchFolder(arguments.output, kCalibrationFile); !writable) {
        return writable;
    }
    if (Status made = makePictureFolder(arguments.calibrate.pictures); !made) {
        return made;
    }
    const Result<std::unique_ptr<Context>> context = openDevice(arguments.render);
    if (!context) {
        return context.error();
    }
    report.machine = machineOf(**context);
    CompileCache cache(arguments.cache, "");
    Status done = Calibration(console, arguments, **context, cache.modules(), report).run();
    cache.close(console);
    return done;
}

// Fits to the measurements in the file, as scripts/fit_strategy_costs.py does. Too few measurements are not
// an error; the file stays.
Result<std::string> fit(const Console& console, const fs::path& folder) {
    Result<CalibrationPoints> read = readCalibrationPoints(folder / kCalibrationFile);
    if (!read) {
        return read.error();
    }
    std::vector<Diagnostic> notes;
    const Result<DeviceFile> fitted = fitDevice(std::move(read->device), read->points, notes);
    console.report(notes);
    if (!fitted) {
        Diagnostic note = fitted.error();
        note.severity = Severity::Note;
        console.report(note);
        return std::string();
    }
    if (Status written = writeFile(folder / kDeviceFile, toText(*fitted)); !written) {
        return written.error();
    }
    return fmt::format("\n{}\n{}: give it to --calibration, and --strategy auto goes by this device.\n",
                       describe(*fitted), (folder / kDeviceFile).string());
}

}  // namespace

int calibrate(const Console& console, const BenchArguments& arguments) {
    CalibrationReport report;
    report.command = arguments.command;
    report.date = utcNow();
    report.rounds = static_cast<std::uint32_t>(arguments.rounds);
    report.seed = static_cast<std::uint32_t>(arguments.render.seed) + 1;
    report.quick = arguments.quick;
    if (Status done = measureAll(console, arguments, report); !done) {
        console.report(done.error());
        return kExitFailed;
    }
    const Result<std::string> fitted = fit(console, arguments.output);
    if (!fitted) {
        console.report(fitted.error());
        return kExitFailed;
    }
    if (console.refused()) {
        return kExitFailed;
    }
    if (console.isJson()) {
        console.result(toJson(report));
    } else {
        console.print(toText(report));
        console.print(fmt::format("\n{} has the same numbers.\n",
                                  (fs::path(arguments.output) / kCalibrationFile).string()));
        console.print(*fitted);
    }
    return kExitDone;
}

}  // namespace glint
