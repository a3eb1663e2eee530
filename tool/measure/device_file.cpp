#include "base/fields.h"
#include "base/lists.h"
#include "emit/package/manifest.h"

#include <glint/measure/device_file.h>
#include <glint/measure/statistics.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace glint::measure {

// --- The fit ---

namespace {

// A point, with the values that the model needs.
struct Sample {
    std::string name;
    std::string group;  // the same for points that differ in their rays alone
    compiler::TermValues terms{};
    std::map<std::string, double, std::less<>> ms;  // by strategy
};

std::string nameOf(const CalibrationPoint& point) {
    return fmt::format("{} case{}, {}, {}, {:.0f} rays", point.cases, point.cases == 1 ? "" : "s", point.cost,
                       point.coherence, point.rays);
}

bool isShare(double value) {
    return value >= 0.0 && value <= 1.0;  // a value that is not a number fails both tests
}

// Returns why a point can't be used, or an empty text if it can.
std::string whyUnusable(const CalibrationPoint& point) {
    if (!std::isfinite(point.rays) || point.rays <= 0.0) {
        return "has no rays";
    }
    // Measured hits can be less alike than random ones are on average.
    if (!isShare(point.hitShare) || !(std::abs(point.coherentShare) <= 1.0)) {
        return "has a share that is not from 0 to 1";
    }
    if (point.work.empty()) {
        return "has no cases";
    }
    const bool worksOut = std::ranges::all_of(point.work, [](const CaseWork& work) {
        return isShare(work.share) && std::isfinite(work.instructions) && work.instructions >= 0.0 &&
               std::isfinite(work.fetches) && work.fetches >= 0.0;
    });
    return worksOut ? "" : "has a case whose share or code is out of range";
}

std::vector<Sample> samplesOf(std::span<const CalibrationPoint> points, double subgroupSize,
                              std::vector<std::string>& omitted) {
    std::vector<Sample> samples;
    for (const CalibrationPoint& point : points) {
        if (const std::string why = whyUnusable(point); !why.empty()) {
            omitted.push_back(fmt::format("the point {} {}", nameOf(point), why));
            continue;
        }
        Sample sample;
        sample.name = nameOf(point);
        sample.group = fmt::format("{} {} {}", point.cases, point.cost, point.coherence);
        sample.terms = termsOf(roundOf(point), subgroupSize);
        for (const StrategyTime& time : point.times) {
            const bool known = std::ranges::find(compiler::simplestFirst(), time.strategy) !=
                               compiler::simplestFirst().end();
            if (known && std::isfinite(time.ms) && time.ms > 0.0) {
                sample.ms[time.strategy] = time.ms;
            } else {
                omitted.push_back(fmt::format("the time of {} at the point {} is not one above 0",
                                              time.strategy, sample.name));
            }
        }
        samples.push_back(std::move(sample));
    }
    return samples;
}

using Samples = std::vector<const Sample*>;

// Returns the terms that the strategy has.
std::vector<compiler::CostTermInfo> termsOf(std::string_view strategy) {
    std::vector<compiler::CostTermInfo> terms;
    std::ranges::copy_if(compiler::costTerms(), std::back_inserter(terms),
                         [&](const compiler::CostTermInfo& info) { return hasTerm(strategy, info.term); });
    return terms;
}

// Each row is divided by the measured time, so that the error of a quick point counts as much as that of a
// slow one.
std::optional<compiler::StrategyCosts> fitOne(std::string_view strategy, const Samples& samples) {
    const std::vector<compiler::CostTermInfo> terms = termsOf(strategy);
    std::vector<std::vector<double>> rows;
    for (const Sample* const sample : samples) {
        const auto time = sample->ms.find(strategy);
        if (time == sample->ms.end()) {
            continue;
        }
        std::vector<double>& row = rows.emplace_back();
        for (const compiler::CostTermInfo& info : terms) {
            row.push_back(sample->terms[static_cast<std::size_t>(info.term)] * info.milliseconds /
                          time->second);
        }
    }
    if (rows.size() < std::max<std::size_t>(terms.size(), 2)) {
        return std::nullopt;
    }
    const std::vector<double> ones(rows.size(), 1.0);
    const std::optional<std::vector<double>> x = nonNegativeLeastSquares(rows, ones, terms.size());
    if (!x) {
        return std::nullopt;
    }
    compiler::StrategyCosts costs;
    costs.strategy = strategy;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        costs.constants[static_cast<std::size_t>(terms[i].term)] = (*x)[i];
    }
    return costs;
}

double estimateOf(const Sample& sample, const compiler::StrategyCosts& costs) {
    double ms = 0.0;
    for (const compiler::CostTermInfo& info : compiler::costTerms()) {
        const auto i = static_cast<std::size_t>(info.term);
        ms += sample.terms[i] * costs.constants[i] * info.milliseconds;
    }
    return ms;
}

// Estimates of every point, by strategy. The constants are fitted from the other groups, if there are any.
using Estimates = std::map<const Sample*, std::map<std::string, double, std::less<>>>;

Estimates estimateHeldOut(const std::vector<Sample>& samples, bool& held) {
    std::set<std::string> groups;
    for (const Sample& sample : samples) {
        groups.insert(sample.group);
    }
    held = groups.size() > 1;
    Estimates estimates;
    for (const std::string& group : groups) {
        Samples others;
        for (const Sample& sample : samples) {
            if (!held || sample.group != group) {
                others.push_back(&sample);
            }
        }
        for (const std::string_view strategy : compiler::simplestFirst()) {
            const std::optional<compiler::StrategyCosts> costs = fitOne(strategy, others);
            for (const Sample& sample : samples) {
                if (costs && sample.group == group && sample.ms.contains(strategy)) {
                    estimates[&sample][std::string(strategy)] = estimateOf(sample, *costs);
                }
            }
        }
    }
    return estimates;
}

StrategyQuality qualityOf(std::string_view strategy, const std::vector<Sample>& samples,
                          const Estimates& estimates) {
    StrategyQuality quality;
    quality.strategy = strategy;
    std::vector<double> errors;
    for (const Sample& sample : samples) {
        const auto own = estimates.find(&sample);
        const auto estimated =
            own == estimates.end() ? decltype(own->second.end()){} : own->second.find(strategy);
        if (own == estimates.end() || estimated == own->second.end()) {
            continue;
        }
        errors.push_back(std::abs(estimated->second / sample.ms.find(strategy)->second - 1.0));
        if (errors.back() >= quality.worstError) {
            quality.worstError = errors.back();
            quality.worstPoint = sample.name;
        }
    }
    quality.points = errors.size();
    quality.medianError = errors.empty() ? 0.0 : intervalOf(errors).median;
    return quality;
}

Regret regretOf(const std::vector<Sample>& samples, const Estimates& estimates) {
    constexpr double kLittle = 0.05;
    Regret regret;
    std::vector<double> losses;
    for (const Sample& sample : samples) {
        const auto own = estimates.find(&sample);
        if (own == estimates.end() || own->second.size() < 2) {
            continue;
        }
        // The loop follows the order in which a choice takes the first of several equal ones.
        std::string_view taken;
        std::string_view fastest;
        for (const std::string_view strategy : compiler::simplestFirst()) {
            const auto estimated = own->second.find(strategy);
            if (estimated == own->second.end()) {
                continue;
            }
            const auto cases =
                static_cast<std::size_t>(sample.terms[static_cast<std::size_t>(compiler::CostTerm::Cases)]);
            if (taken.empty() || compiler::isBetterChoice({strategy, estimated->second},
                                                          {taken, own->second.find(taken)->second}, cases)) {
                taken = strategy;
            }
            if (fastest.empty() || sample.ms.find(strategy)->second < sample.ms.find(fastest)->second) {
                fastest = strategy;
            }
        }
        losses.push_back(sample.ms.find(taken)->second / sample.ms.find(fastest)->second - 1.0);
        if (losses.back() >= regret.worst) {
            regret.worst = losses.back();
            regret.worstPoint = fmt::format("{}: {} taken, {} fastest", sample.name, taken, fastest);
        }
    }
    regret.points = losses.size();
    if (!losses.empty()) {
        regret.median = intervalOf(losses).median;
        const auto few = std::ranges::count_if(losses, [](double loss) { return loss <= kLittle; });
        regret.withinFivePercent = static_cast<double>(few) / static_cast<double>(losses.size());
    }
    return regret;
}

}  // namespace

compiler::Round roundOf(const CalibrationPoint& point) {
    // If there is one case, all hits are alike, wherever rays go.
    compiler::Round round{point.rays,
                          point.hitShare,
                          std::max(0.0, point.coherentShare),
                          point.coherence == "coherent" ? 0.0 : 1.0,
                          {}};
    for (const CaseWork& work : point.work) {
        round.cases.push_back({work.share, work.instructions, work.fetches});
    }
    return round;
}

DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize) {
    DeviceFit fit;
    const std::vector<Sample> samples = samplesOf(points, subgroupSize, fit.omitted);
    const auto all = base::mapped<const Sample*>(samples, [](const Sample& sample) { return &sample; });
    const Estimates estimates = estimateHeldOut(samples, fit.quality.held);
    for (const std::string_view strategy : compiler::simplestFirst()) {
        const auto measured = static_cast<std::size_t>(std::ranges::count_if(
            samples, [&](const Sample& sample) { return sample.ms.contains(strategy); }));
        if (measured == 0) {
            fit.omitted.push_back(fmt::format("{} was not measured", strategy));
            continue;
        }
        std::optional<compiler::StrategyCosts> costs = fitOne(strategy, all);
        if (!costs) {
            fit.omitted.push_back(fmt::format("{} has {} usable points, and {} terms to find", strategy,
                                              measured, termsOf(strategy).size()));
            continue;
        }
        fit.strategies.push_back(std::move(*costs));
        fit.quality.strategies.push_back(qualityOf(strategy, samples, estimates));
    }
    fit.quality.regret = regretOf(samples, estimates);
    return fit;
}

// --- Calibrations and files of costs ---

namespace {

bool counts(const StrategyMeasure& measure) {
    return !measure.times.empty() && !measure.difference.isWrong();
}

}  // namespace

double meanOf(const std::vector<CaseWork>& work, double CaseWork::*member) {
    return base::sumOf<double>(work, [&](const CaseWork& one) { return one.share * one.*member; });
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
