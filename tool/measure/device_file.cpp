#include "base/fields.h"
#include "emit/package/manifest.h"
#include "plan/strategy_cost.h"

#include <glint/measure/device_file.h>
#include <glint/measure/statistics.h>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glint::measure {

namespace {

bool counts(const StrategyMeasure& measure) {
    return !measure.times.empty() && !measure.difference.isWrong();
}

}  // namespace

double meanOf(const std::vector<CaseWork>& work, double CaseWork::*member) {
    return std::accumulate(work.begin(), work.end(), 0.0,
                           [&](double sum, const CaseWork& one) { return sum + one.share * one.*member; });
}

bool PictureDifference::isWrong() const {
    constexpr std::uint64_t kOneIn = 1000;
    return differing * kOneIn > pixels;
}

void settleEntry(CalibrationEntry& entry) {
    entry.point.times.clear();
    entry.fastest.clear();
    std::vector<std::pair<std::string, Interval>> ratios;
    // Ratios are relative to the first strategy that was measured.
    const auto base = std::ranges::find_if(
        entry.strategies, [](const StrategyMeasure& measure) { return !measure.times.empty(); });
    const double baseMs = base != entry.strategies.end() ? measure::intervalOf(base->times).median : 0.0;
    for (const StrategyMeasure& measure : entry.strategies) {
        if (counts(measure)) {
            const Interval ratio = measure::intervalOf(measure.ratios);
            entry.point.times.push_back({measure.strategy, baseMs * ratio.median});
            ratios.emplace_back(measure.strategy, ratio);
        }
    }
    const auto least =
        std::ranges::min_element(ratios, {}, [](const auto& ratio) { return ratio.second.median; });
    for (const auto& [strategy, ratio] : ratios) {
        if (overlap(ratio, least->second)) {
            entry.fastest.push_back(strategy);
        }
    }
}

using base::field;
using base::Fields;

namespace {

// No constant reaches a year of its unit. Errors and regrets are factors.
constexpr double kMostOfUnit = 1e12;

// Returns the JSON name of a constant: "launches" in milliseconds is "launchesMs".
std::string memberOf(const compiler::CostTermInfo& info) {
    const std::string unit = info.unit == "ms" ? "Ms" : info.unit == "ns" ? "Ns" : "Ps";
    return std::string(info.name) + unit;
}

// A strategy with its constants by name, and how well they fit.
struct FittedStrategy {
    std::string strategy;
    std::vector<std::pair<std::string, double>> constants;
    std::optional<StrategyQuality> fit;
};

std::vector<FittedStrategy> strategiesOf(const DeviceFile& file) {
    std::vector<FittedStrategy> list;
    for (const compiler::StrategyCosts& costs : file.costs.strategies) {
        FittedStrategy& entry = list.emplace_back();
        entry.strategy = costs.strategy;
        for (const compiler::CostTermInfo& info : compiler::costTerms()) {
            if (hasTerm(costs.strategy, info.term)) {
                entry.constants.emplace_back(memberOf(info),
                                             costs.constants[static_cast<std::size_t>(info.term)]);
            }
        }
        for (const StrategyQuality& quality : file.quality.strategies) {
            if (quality.strategy == costs.strategy) {
                entry.fit = quality;
            }
        }
    }
    return list;
}

// Fails at the first strategy that is there twice or lacks a constant.
void setStrategies(DeviceFile& file, std::vector<FittedStrategy> list, base::JsonReader& reader,
                   const std::string& place) {
    for (FittedStrategy& entry : list) {
        const std::string there = fmt::format("{}/{}", place, &entry - list.data());
        if (findCosts(file.costs, entry.strategy) != nullptr) {
            reader.fail(there + "/strategy", "is there twice");
        }
        compiler::StrategyCosts& costs = file.costs.strategies.emplace_back();
        costs.strategy = entry.strategy;
        for (const compiler::CostTermInfo& info : compiler::costTerms()) {
            const auto constant =
                std::ranges::find(entry.constants, memberOf(info), &std::pair<std::string, double>::first);
            if (hasTerm(entry.strategy, info.term) && constant == entry.constants.end()) {
                reader.fail(there + "/constants", fmt::format("has no member \"{}\"", memberOf(info)));
            } else if (hasTerm(entry.strategy, info.term)) {
                costs.constants[static_cast<std::size_t>(info.term)] = constant->second;
            }
        }
        if (entry.fit) {
            entry.fit->strategy = entry.strategy;
            file.quality.strategies.push_back(std::move(*entry.fit));
        }
    }
}

}  // namespace

static Fields fieldsOf(const StrategyQuality*) {
    using T = StrategyQuality;
    return {field<&T::points>("points", "Number of measurements."),
            field<&T::medianError>("medianError", "Median of |estimate / measured - 1|.",
                                   {.least = 0, .most = kMostOfUnit}),
            field<&T::worstError>("worstError", "Largest error.", {.least = 0, .most = kMostOfUnit}),
            field<&T::worstPoint>("worstPoint", "The measurement with the largest error.", {.orNull = true})};
}

static Fields fieldsOf(const Regret*) {
    using T = Regret;
    return {
        field<&T::points>("points", "Measurements of two strategies or more."),
        field<&T::median>("median", "Median cost.", {.least = 0, .most = kMostOfUnit}),
        field<&T::worst>("worst", "Largest cost.", {.least = 0, .most = kMostOfUnit}),
        field<&T::withinFivePercent>("withinFivePercent", "Share of the points.", {.least = 0, .most = 1}),
        field<&T::worstPoint>("worstPoint",
                              "The measurement with the largest cost, the strategy that was chosen, and "
                              "the fastest one.",
                              {.orNull = true})};
}

namespace {

Fields fieldsOf(const FittedStrategy*) {
    using T = FittedStrategy;
    return {
        field<&T::strategy>("strategy", "Name of the strategy.", {.names = compiler::strategyWords()}),
        field<&T::constants>("constants",
                             "Constants of the terms that the strategy has (tool/plan/strategy_cost.h), in "
                             "milli-, nano- or picoseconds, as their names end.",
                             {.least = 0, .most = kMostOfUnit}),
        field<&T::fit>("fit", "How far estimates are from the measurements; null if that was not recorded.")};
}

}  // namespace

Fields fieldsOf(const DeviceFile*) {
    using T = DeviceFile;
    using Costs = compiler::DeviceCosts;
    return {base::constant("format", "Names the kind of file.", "glint-device"),
            base::constant("version", "Version of the format.", 1),
            field<&T::costs, &Costs::device>("device", "Name of the device."),
            field<&T::costs, &Costs::driver>("driver", "Name and version of the driver."),
            field(
                "deviceType", "Kind of the device.",
                [](const T& file) { return std::string(file.costs.onCpu ? "cpu" : "gpu"); },
                [](T& file, const std::string& type) { file.costs.onCpu = type == "cpu"; },
                {.names = {"cpu", "gpu"}}),
            field<&T::costs, &Costs::subgroupSize>("subgroupSize", "Lanes of a subgroup.",
                                                   {.least = 1, .most = 1024}),
            field<&T::costs, &Costs::tracer>("tracer",
                                             "The tracer of strategies without a pipeline of their own.",
                                             {.names = base::wordsFor<package::Tracer>()}),
            field<&T::costs, &Costs::shadows>("shadows", "Where shadow rays of hits were traced.",
                                              {.names = base::wordsFor<package::ShadowPlacement>()}),
            field<&T::costs, &Costs::source>("command", "The command that measured it."),
            field(
                "strategies", "The strategies that could be measured.",
                [](const T& file) { return strategiesOf(file); },
                [](T& file, std::vector<FittedStrategy> list, base::JsonReader& reader,
                   const std::string& place) { setStrategies(file, std::move(list), reader, place); },
                {.leastElements = 1}),
            base::group(
                "regret",
                "The cost of choosing by these constants: the time of the chosen strategy over that of the "
                "fastest, less 1.",
                {field<&T::quality, &FitQuality::held>("heldOut",
                                                       "Each scene was estimated by constants that were "
                                                       "fitted to the others; so are errors of the "
                                                       "strategies."),
                 field<&T::quality, &FitQuality::regret>("", "")})};
}

Result<DeviceFile> fitDevice(compiler::DeviceCosts device, std::span<const CalibrationPoint> points,
                             std::vector<Diagnostic>& notes) {
    DeviceFit fit = fitStrategies(points, device.subgroupSize);
    for (const std::string& omitted : fit.omitted) {
        notes.push_back({Severity::Note, "calibration-points", device.device, omitted, ""});
    }
    if (fit.strategies.empty()) {
        return makeError(
            "calibration-points", device.device,
            fmt::format("{} points are too few to find the constants of any strategy", points.size()),
            "measure more: other numbers of cases, both costs, both coherences");
    }
    device.strategies = std::move(fit.strategies);
    return DeviceFile{std::move(device), std::move(fit.quality)};
}

std::string toText(const DeviceFile& file) {
    return base::toText(base::jsonOf(file));
}

Result<DeviceFile> readDeviceFile(const std::filesystem::path& path) {
    // A device file has a few kilobytes.
    constexpr std::uint64_t kMostBytes = 1ULL << 20;
    constexpr const char* kHint = "give the device.json that glint bench --calibrate wrote";
    return base::readFileAs<DeviceFile>({path, "calibration-format", kHint}, kMostBytes);
}

Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path) {
    // 256 cases take some 25 kilobytes for each point.
    constexpr std::uint64_t kMostBytes = 1ULL << 28;
    constexpr const char* kHint = "give the calibration.json that glint bench --calibrate wrote";
    GLINT_TRY(auto report,
              base::readFileAs<CalibrationReport>({path, "calibration-format", kHint}, kMostBytes));
    const BenchMachine& machine = report.machine;
    CalibrationPoints read;
    read.device.device = machine.device;
    read.device.driver = machine.driver;
    read.device.onCpu = machine.deviceType == "cpu";
    read.device.subgroupSize = machine.subgroupSize.value_or(read.device.onCpu ? 8.0 : 32.0);
    read.device.tracer = std::ranges::count(machine.tracers, "ray-query") > 0 ? "ray-query" : "ray-pipeline";
    read.device.shadows = "inline";
    read.device.source = report.command;
    for (CalibrationEntry& entry : report.entries) {
        settleEntry(entry);
        // A value below that of random order is noise of the sample.
        entry.point.coherentShare = std::max(0.0, entry.point.coherentShare);
        read.points.push_back(std::move(entry.point));
    }
    return read;
}

}  // namespace glint::measure
