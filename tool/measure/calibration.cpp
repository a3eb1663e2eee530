#include "base/clock.h"
#include "base/fields.h"
#include "base/files.h"
#include "base/json.h"
#include "base/parallel.h"
#include "measure/calibration_measure.h"

#include <glint/measure/calibration.h>
#include <glint/measure/report.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace glint::measure {

namespace {

namespace fs = std::filesystem;

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
    Calibration(const Observer& observer, const CalibrationSettings& settings, Context& context,
                compiler::ModuleCache* cache, CalibrationReport& report)
        : observer_(observer), settings_(settings), context_(context), cache_(cache), report_(report) {
        cases_ = settings.cases.empty() ? usualCases(settings.quick) : settings.cases;
        rays_ = settings.rays.empty() ? usualRays(settings.quick, isOnCpu(context)) : settings.rays;
        costs_ = chosen(settings.costs, {synthetic::Cost::Cheap, synthetic::Cost::Expensive});
        coherences_ =
            chosen(settings.coherences, {synthetic::Coherence::Coherent, synthetic::Coherence::Incoherent});
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
            GLINT_TRY_DO(measureGroup(*groups[i]));
            groups[i] = Diagnostic{};  // its memory
            report_.complete = i + 1 == groups.size();
            report_.seconds = secondsSinceStart();
            GLINT_TRY_DO(write());
        }
        return okStatus();
    }

private:
    double secondsSinceStart() const {
        return std::chrono::duration<double>(base::Clock::now() - start_).count();
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
                    options.shares = settings_.shares == nameOf(synthetic::Shares::Zipf)
                                         ? synthetic::Shares::Zipf
                                         : synthetic::Shares::Uniform;
                    options.lights = static_cast<int>(settings_.lights);
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
        observer_.progress(fmt::format("compiling {} packages", plans.size()));
        const std::uint32_t tracers = context_.handles().tracers;
        const int jobs = settings_.render.compile.jobs;
        const std::size_t cores =
            jobs > 0 ? static_cast<std::size_t>(jobs) : std::thread::hardware_concurrency();
        const int together = std::max(1, static_cast<int>(cores / kCoresPerPackage));
        base::runParallel(plans.size(), together, [&](std::size_t i) {
            // The largest group is started first, so that nothing has to wait for it in the end.
            const std::size_t group = plans.size() - 1 - i;
            groups[group] = compileGroup(settings_, tracers, plans[group], cache_);
            return true;
        });
        return groups;
    }

    Status measureGroup(const CompiledGroup& compiled) {
        GLINT_TRY(auto group, uploadGroup(context_, compiled));
        for (const CalibrationScene& scene : group.scenes) {
            for (const std::uint64_t rays : rays_) {
                GLINT_TRY_DO(measure(group, scene, rays));
            }
        }
        return checkValidation(observer_, context_);
    }

    Status measure(CalibrationGroup& group, const CalibrationScene& scene, std::uint64_t rays) {
        const std::string name =
            fmt::format("{} {} cases, {}, {} rays", scene.options.cases, nameOf(scene.options.cost),
                        nameOf(scene.options.coherence), rays);
        const std::size_t all = costs_.size() * cases_.size() * coherences_.size() * rays_.size();
        observer_.progress(fmt::format("point {} of {}: {}", report_.entries.size() + 1, all, name));
        PointOptions options{rays, report_.rounds, report_.seed};
        if (!settings_.pictures.empty() && rays == rays_.front()) {
            const std::string file =
                fmt::format("{}-{}-{}.png", scene.options.cases, synthetic::nameOf(scene.options.cost),
                            synthetic::nameOf(scene.options.coherence));
            options.picture = (fs::path(settings_.pictures) / file).string();
        }
        GLINT_TRY(auto entry, measurePoint(context_, group, scene, settings_, options));
        for (const StrategyMeasure& one : entry.strategies) {
            if (!one.skipped.empty()) {
                observer_.report(makeWarning("calibrate-point", name,
                                             fmt::format("{} was left out: {}", one.strategy, one.skipped),
                                             "--calibrate-rays and --calibrate-cases choose points"));
            }
            if (one.difference.isWrong()) {
                observer_.report(makeWarning(
                    "calibrate-picture", name,
                    fmt::format("the picture of {} is not that of uber: {} of {} pixels differ, by {:.3g} at "
                                "most; its times don't count",
                                one.strategy, one.difference.differing, one.difference.pixels,
                                one.difference.largest),
                    "this is a defect of Glint or of the driver"));
            }
        }
        observer_.detail(fmt::format("fastest: {}", fmt::join(entry.fastest, ", ")));
        report_.entries.push_back(std::move(entry));
        return okStatus();
    }

    Status write() const {
        const fs::path folder = settings_.output;
        GLINT_TRY_DO(makeBenchFolder(folder));
        return base::writeFile(folder / kCalibrationFile, base::toText(base::jsonOf(report_)));
    }

    const Observer& observer_;
    const CalibrationSettings& settings_;
    Context& context_;
    compiler::ModuleCache* cache_;
    CalibrationReport& report_;
    base::Clock::time_point start_ = base::Clock::now();
    std::vector<std::uint32_t> cases_;
    std::vector<std::uint64_t> rays_;
    std::vector<synthetic::Cost> costs_;
    std::vector<synthetic::Coherence> coherences_;
};

}  // namespace

Result<std::unique_ptr<Context>> openCalibrationDevice(const compiler::Settings& render) {
    return Context::createHeadless(session::deviceOptions(render));
}

Status runCalibration(const Observer& observer, const CalibrationSettings& settings, Context& context,
                      compiler::ModuleCache* cache, CalibrationReport& report) {
    return Calibration(observer, settings, context, cache, report).run();
}

Result<std::optional<DeviceFile>> fitCalibration(const Observer& observer, const fs::path& folder) {
    GLINT_TRY(auto read, readCalibrationPoints(folder / kCalibrationFile));
    std::vector<Diagnostic> notes;
    Result<DeviceFile> fitted = fitDevice(std::move(read.device), read.points, notes);
    for (const Diagnostic& note : notes) {
        observer.report(note);
    }
    if (!fitted) {
        Diagnostic note = fitted.error();
        note.severity = Severity::Note;
        observer.report(note);
        return std::optional<DeviceFile>();
    }
    GLINT_TRY_DO(base::writeFile(folder / kDeviceFile, toText(*fitted)));
    return std::optional(std::move(*fitted));
}

}  // namespace glint::measure
