#include "base/json.h"
#include "plan/strategy_cost.h"

#include <glint/measure/device_file.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace glint::measure {

namespace {

constexpr const char* kDeviceFormat = "glint-device";
constexpr int kDeviceVersion = 1;
// A device file has a few kilobytes.
constexpr std::uint64_t kMaxDeviceBytes = 1ULL << 20;
constexpr std::uint64_t kMaxPoints = 1ULL << 32;
// No constant reaches a year of its unit. Errors and regrets are factors.
constexpr double kMostOfUnit = 1e12;
constexpr double kMaxSubgroup = 1024.0;

// Returns the JSON name of a constant: "launches" in milliseconds is "launchesMs".
std::string memberOf(const compiler::CostTermInfo& info) {
    const std::string unit = info.unit == "ms" ? "Ms" : info.unit == "ns" ? "Ns" : "Ps";
    return std::string(info.name) + unit;
}

base::Json constantsToJson(const compiler::StrategyCosts& costs) {
    base::Json constants = base::Json::object();
    for (const compiler::CostTermInfo& info : compiler::costTerms()) {
        if (hasTerm(costs.strategy, info.term)) {
            constants[memberOf(info)] = costs.constants[static_cast<std::size_t>(info.term)];
        }
    }
    return constants;
}

base::Json toJson(const StrategyQuality& quality) {
    return {{"points", quality.points},
            {"medianError", quality.medianError},
            {"worstError", quality.worstError},
            {"worstPoint", base::textOrNull(quality.worstPoint)}};
}

base::Json strategiesToJson(const DeviceFile& file) {
    base::Json list = base::Json::array();
    for (const compiler::StrategyCosts& costs : file.costs.strategies) {
        const auto quality =
            std::ranges::find(file.quality.strategies, costs.strategy, &StrategyQuality::strategy);
        const bool known = quality != file.quality.strategies.end();
        list.push_back({{"strategy", costs.strategy},
                        {"constants", constantsToJson(costs)},
                        {"fit", known ? toJson(*quality) : base::Json(nullptr)}});
    }
    return list;
}

StrategyQuality readQuality(base::JsonReader& reader, const base::Json& json, const std::string& place,
                            const std::string& strategy) {
    StrategyQuality quality;
    quality.strategy = strategy;
    quality.points = reader.count(json, place, "points", kMaxPoints);
    quality.medianError = reader.number(json, place, "medianError", 0.0, kMostOfUnit);
    quality.worstError = reader.number(json, place, "worstError", 0.0, kMostOfUnit);
    const base::Json* const point = reader.member(json, place, "worstPoint");
    if (point != nullptr && !point->is_null()) {
        quality.worstPoint = reader.text(json, place, "worstPoint");
    }
    return quality;
}

void readStrategy(base::JsonReader& reader, const base::Json& json, const std::string& place,
                  DeviceFile& file) {
    compiler::StrategyCosts costs;
    costs.strategy = reader.text(json, place, "strategy");
    if (reader.ok() &&
        std::ranges::find(compiler::simplestFirst(), costs.strategy) == compiler::simplestFirst().end()) {
        reader.fail(place + "/strategy",
                    fmt::format("is none of {}", fmt::join(compiler::simplestFirst(), ", ")));
    }
    if (reader.ok() && findCosts(file.costs, costs.strategy) != nullptr) {
        reader.fail(place + "/strategy", "is there twice");
    }
    const base::Json* const constants = reader.member(json, place, "constants");
    for (const compiler::CostTermInfo& info : compiler::costTerms()) {
        if (reader.ok() && hasTerm(costs.strategy, info.term)) {
            costs.constants[static_cast<std::size_t>(info.term)] =
                reader.number(*constants, place + "/constants", memberOf(info).c_str(), 0.0, kMostOfUnit);
        }
    }
    const base::Json* const fit = reader.member(json, place, "fit");
    if (fit != nullptr && !fit->is_null()) {
        file.quality.strategies.push_back(readQuality(reader, *fit, place + "/fit", costs.strategy));
    }
    file.costs.strategies.push_back(std::move(costs));
}

void readRegret(base::JsonReader& reader, const base::Json& json, FitQuality& quality) {
    const base::Json* const regret = reader.member(json, "", "regret");
    if (regret == nullptr) {
        return;
    }
    const std::string place = "/regret";
    quality.held = reader.flag(*regret, place, "heldOut");
    quality.regret.points = reader.count(*regret, place, "points", kMaxPoints);
    quality.regret.median = reader.number(*regret, place, "median", 0.0, kMostOfUnit);
    quality.regret.worst = reader.number(*regret, place, "worst", 0.0, kMostOfUnit);
    quality.regret.withinFivePercent = reader.number(*regret, place, "withinFivePercent", 0.0, 1.0);
    const base::Json* const point = reader.member(*regret, place, "worstPoint");
    if (point != nullptr && !point->is_null()) {
        quality.regret.worstPoint = reader.text(*regret, place, "worstPoint");
    }
}

void readMembers(base::JsonReader& reader, const base::Json& json, DeviceFile& file) {
    file.costs.device = reader.text(json, "", "device");
    file.costs.driver = reader.text(json, "", "driver");
    const std::string type = reader.text(json, "", "deviceType");
    if (reader.ok() && type != "cpu" && type != "gpu") {
        reader.fail("/deviceType", "is neither \"cpu\" nor \"gpu\"");
    }
    file.costs.onCpu = type == "cpu";
    file.costs.subgroupSize = reader.number(json, "", "subgroupSize", 1.0, kMaxSubgroup);
    file.costs.tracer = reader.text(json, "", "tracer");
    file.costs.shadows = reader.text(json, "", "shadows");
    file.costs.source = reader.text(json, "", "command");
    reader.each(json, "", "strategies", [&](const base::Json& strategy, const std::string& place) {
        readStrategy(reader, strategy, place, file);
    });
    if (reader.ok() && file.costs.strategies.empty()) {
        reader.fail("/strategies", "is empty");
    }
    readRegret(reader, json, file.quality);
}

// 256 cases take some 25 kilobytes for each point.
constexpr std::uint64_t kMaxPointsBytes = 1ULL << 28;
constexpr std::uint64_t kMaxCases = 1ULL << 20;
constexpr double kAny = std::numeric_limits<double>::max();

compiler::DeviceCosts readMachine(base::JsonReader& reader, const base::Json& json) {
    compiler::DeviceCosts device;
    const base::Json* const machine = reader.member(json, "", "machine");
    if (machine == nullptr) {
        return device;
    }
    const std::string place = "/machine";
    device.device = reader.text(*machine, place, "device");
    device.driver = reader.text(*machine, place, "driver");
    device.onCpu = reader.text(*machine, place, "deviceType") == "cpu";
    device.subgroupSize = device.onCpu ? 8.0 : 32.0;
    if (machine->contains("subgroupSize")) {
        device.subgroupSize = reader.number(*machine, place, "subgroupSize", 1.0, 1024.0);
    }
    const std::vector<std::string> tracers = reader.texts(*machine, place, "tracers");
    const bool queries = std::ranges::find(tracers, "ray-query") != tracers.end();
    device.tracer = queries ? "ray-query" : "ray-pipeline";
    device.shadows = "inline";
    device.source = reader.text(json, "", "command");
    return device;
}

// Adds the time of a strategy if it was measured and drew the same picture as uber; otherwise its time would
// mean nothing. `baseMs` is the time of the first measured strategy, to which ratios are relative; it is 0
// before.
void readTime(base::JsonReader& reader, const base::Json& json, const std::string& place, double& baseMs,
              CalibrationPoint& point) {
    if (json.is_object() && json.contains("skipped")) {
        return;
    }
    const std::string strategy = reader.text(json, place, "strategy");
    const base::Json* const time = reader.member(json, place, "time");
    const base::Json* const ratio = reader.member(json, place, "ratio");
    const base::Json* const difference = reader.member(json, place, "difference");
    if (time == nullptr || ratio == nullptr || difference == nullptr) {
        return;
    }
    const double median = reader.number(*time, place + "/time", "median", 0.0, kAny);
    const double toBase = reader.number(*ratio, place + "/ratio", "median", 0.0, kAny);
    baseMs = baseMs > 0.0 ? baseMs : median;
    if (!reader.flag(*difference, place + "/difference", "wrong")) {
        point.times.push_back({strategy, baseMs * toBase});
    }
}

CalibrationPoint readPoint(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    CalibrationPoint point;
    point.cases = static_cast<std::uint32_t>(reader.count(json, place, "cases", kMaxCases));
    point.cost = reader.text(json, place, "cost");
    point.coherence = reader.text(json, place, "coherence");
    point.rays = reader.number(json, place, "rays", 0.0, kAny);
    point.hitShare = reader.number(json, place, "hitShare", 0.0, 1.0);
    point.coherentShare = reader.number(json, place, "coherentShare", -1.0, 1.0);
    // A value below that of random order is noise of the sample.
    point.coherentShare = std::max(0.0, point.coherentShare);
    reader.each(json, place, "work", [&](const base::Json& work, const std::string& there) {
        point.work.push_back({reader.number(work, there, "share", 0.0, 1.0),
                              reader.number(work, there, "instructions", 0.0, kAny),
                              reader.number(work, there, "fetches", 0.0, kAny)});
    });
    double baseMs = 0.0;
    reader.each(json, place, "strategies", [&](const base::Json& measured, const std::string& there) {
        readTime(reader, measured, there, baseMs, point);
    });
    return point;
}

}  // namespace

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
    const compiler::DeviceCosts& costs = file.costs;
    const Regret& regret = file.quality.regret;
    return base::toText(base::Json{{"format", kDeviceFormat},
                                   {"version", kDeviceVersion},
                                   {"device", costs.device},
                                   {"driver", costs.driver},
                                   {"deviceType", costs.onCpu ? "cpu" : "gpu"},
                                   {"subgroupSize", costs.subgroupSize},
                                   {"tracer", costs.tracer},
                                   {"shadows", costs.shadows},
                                   {"command", costs.source},
                                   {"strategies", strategiesToJson(file)},
                                   {"regret",
                                    {{"heldOut", file.quality.held},
                                     {"points", regret.points},
                                     {"median", regret.median},
                                     {"worst", regret.worst},
                                     {"withinFivePercent", regret.withinFivePercent},
                                     {"worstPoint", base::textOrNull(regret.worstPoint)}}}});
}

Result<DeviceFile> readDeviceFile(const std::filesystem::path& path) {
    base::JsonReader reader(path, "calibration-format", "make the file again with glint bench --calibrate");
    GLINT_TRY(const auto json, reader.read(kMaxDeviceBytes));
    if (!json.is_object() || reader.text(json, "", "format") != kDeviceFormat) {
        return makeError("calibration-format", path.string(), "is no device file",
                         "give the device.json that glint bench --calibrate wrote");
    }
    const std::uint64_t version = reader.count(json, "", "version", kMaxPoints);
    if (reader.ok() && version != kDeviceVersion) {
        reader.fail("/version", fmt::format("is {}; this glint reads {}", version, kDeviceVersion));
    }
    DeviceFile file;
    if (reader.ok()) {
        readMembers(reader, json, file);
    }
    return reader.ok() ? Result<DeviceFile>(std::move(file)) : Result<DeviceFile>(reader.error());
}

Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path) {
    base::JsonReader reader(path, "calibration-format",
                            "give the calibration.json that glint bench --calibrate wrote");
    GLINT_TRY(const auto json, reader.read(kMaxPointsBytes));
    CalibrationPoints read;
    read.device = readMachine(reader, json);
    reader.each(json, "", "points", [&](const base::Json& point, const std::string& place) {
        read.points.push_back(readPoint(reader, point, place));
    });
    return reader.ok() ? Result<CalibrationPoints>(std::move(read))
                       : Result<CalibrationPoints>(reader.error());
}

}  // namespace glint::measure
