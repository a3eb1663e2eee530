#include "cli/device_file.h"

#include "cli/json_reader.h"
#include "cli/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace glint {

namespace {

constexpr const char* kDeviceFormat = "glint-device";
constexpr int kDeviceVersion = 1;
// A device file has a few kilobytes.
constexpr std::uint64_t kMaxDeviceBytes = 1ULL << 20;
constexpr std::uint64_t kMaxPoints = 1ULL << 32;
// No constant reaches a year of its unit. Errors and regrets are factors.
constexpr double kMostOfUnit = 1e12;
constexpr double kMaxSubgroup = 1024.0;

std::string percentText(double share) {
    return fmt::format("{:.1f} %", 100.0 * share);
}

// Returns the JSON name of a constant: "launches" in milliseconds is "launchesMs".
std::string memberOf(const CostTermInfo& info) {
    const std::string unit = info.unit == "ms" ? "Ms" : info.unit == "ns" ? "Ns" : "Ps";
    return std::string(info.name) + unit;
}

Json constantsToJson(const StrategyCosts& costs) {
    Json constants = Json::object();
    for (const CostTermInfo& info : costTerms()) {
        if (hasTerm(costs.strategy, info.term)) {
            constants[memberOf(info)] = costs.constants[static_cast<std::size_t>(info.term)];
        }
    }
    return constants;
}

Json toJson(const bench::StrategyQuality& quality) {
    return {{"points", quality.points},
            {"medianError", quality.medianError},
            {"worstError", quality.worstError},
            {"worstPoint", textOrNull(quality.worstPoint)}};
}

Json strategiesToJson(const DeviceFile& file) {
    Json list = Json::array();
    for (const StrategyCosts& costs : file.costs.strategies) {
        const auto quality =
            std::ranges::find(file.quality.strategies, costs.strategy, &bench::StrategyQuality::strategy);
        const bool known = quality != file.quality.strategies.end();
        list.push_back({{"strategy", costs.strategy},
                        {"constants", constantsToJson(costs)},
                        {"fit", known ? toJson(*quality) : Json(nullptr)}});
    }
    return list;
}

bench::StrategyQuality readQuality(JsonReader& reader, const Json& json, const std::string& place,
                                   const std::string& strategy) {
    bench::StrategyQuality quality;
    quality.strategy = strategy;
    quality.points = reader.count(json, place, "points", kMaxPoints);
    quality.medianError = reader.number(json, place, "medianError", 0.0, kMostOfUnit);
    quality.worstError = reader.number(json, place, "worstError", 0.0, kMostOfUnit);
    const Json* const point = reader.member(json, place, "worstPoint");
    if (point != nullptr && !point->is_null()) {
        quality.worstPoint = reader.text(json, place, "worstPoint");
    }
    return quality;
}

void readStrategy(JsonReader& reader, const Json& json, const std::string& place, DeviceFile& file) {
    StrategyCosts costs;
    costs.strategy = reader.text(json, place, "strategy");
    if (reader.ok() && std::ranges::find(kStrategyNames, costs.strategy) == std::end(kStrategyNames)) {
        reader.fail(place + "/strategy", fmt::format("is none of {}", fmt::join(kStrategyNames, ", ")));
    }
    if (reader.ok() && findCosts(file.costs, costs.strategy) != nullptr) {
        reader.fail(place + "/strategy", "is there twice");
    }
    const Json* const constants = reader.member(json, place, "constants");
    for (const CostTermInfo& info : costTerms()) {
        if (reader.ok() && hasTerm(costs.strategy, info.term)) {
            costs.constants[static_cast<std::size_t>(info.term)] =
                reader.number(*constants, place + "/constants", memberOf(info).c_str(), 0.0, kMostOfUnit);
        }
    }
    const Json* const fit = reader.member(json, place, "fit");
    if (fit != nullptr && !fit->is_null()) {
        file.quality.strategies.push_back(readQuality(reader, *fit, place + "/fit", costs.strategy));
    }
    file.costs.strategies.push_back(std::move(costs));
}

void readRegret(JsonReader& reader, const Json& json, bench::FitQuality& quality) {
    const Json* const regret = reader.member(json, "", "regret");
    if (regret == nullptr) {
        return;
    }
    const std::string place = "/regret";
    quality.held = reader.flag(*regret, place, "heldOut");
    quality.regret.points = reader.count(*regret, place, "points", kMaxPoints);
    quality.regret.median = reader.number(*regret, place, "median", 0.0, kMostOfUnit);
    quality.regret.worst = reader.number(*regret, place, "worst", 0.0, kMostOfUnit);
    quality.regret.withinFivePercent = reader.number(*regret, place, "withinFivePercent", 0.0, 1.0);
    const Json* const point = reader.member(*regret, place, "worstPoint");
    if (point != nullptr && !point->is_null()) {
        quality.regret.worstPoint = reader.text(*regret, place, "worstPoint");
    }
}

void readMembers(JsonReader& reader, const Json& json, DeviceFile& file) {
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
    reader.each(json, "", "strategies", [&](const Json& strategy, const std::string& place) {
        readStrategy(reader, strategy, place, file);
    });
    if (reader.ok() && file.costs.strategies.empty()) {
        reader.fail("/strategies", "is empty");
    }
    readRegret(reader, json, file.quality);
}

}  // namespace

Result<DeviceFile> fitDevice(DeviceCosts device, std::span<const bench::CalibrationPoint> points,
                             std::vector<Diagnostic>& notes) {
    bench::DeviceFit fit = bench::fitStrategies(points, device.subgroupSize);
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

std::string describe(const DeviceFile& file) {
    std::vector<std::vector<std::string>> rows{{"strategy"}};
    for (const CostTermInfo& info : costTerms()) {
        rows.front().push_back(fmt::format("{}, {}", info.name, info.unit));
    }
    rows.front().insert(rows.front().end(), {"points", "off by", "at most"});
    for (const StrategyCosts& costs : file.costs.strategies) {
        std::vector<std::string>& row = rows.emplace_back();
        row.push_back(costs.strategy);
        for (const CostTermInfo& info : costTerms()) {
            const double constant = costs.constants[static_cast<std::size_t>(info.term)];
            row.push_back(hasTerm(costs.strategy, info.term) ? fmt::format("{:.3g}", constant) : "-");
        }
        const auto quality =
            std::ranges::find(file.quality.strategies, costs.strategy, &bench::StrategyQuality::strategy);
        if (quality == file.quality.strategies.end()) {
            row.insert(row.end(), {"-", "-", "-"});
        } else {
            row.insert(row.end(), {std::to_string(quality->points), percentText(quality->medianError),
                                   percentText(quality->worstError)});
        }
    }
    const bench::Regret& regret = file.quality.regret;
    const std::string text = formatTable(rows);
    return regret.points == 0
               ? text
               : text +
                     fmt::format(
                         "\nBy these constants{} the strategy that is taken is {} slower than the fastest "
                         "(the median of {}\npoints), within 5 % at {} of them, and at most {} slower{}.\n",
                         file.quality.held ? ", fitted to other scenes," : "", percentText(regret.median),
                         regret.points, percentText(regret.withinFivePercent), percentText(regret.worst),
                         regret.worstPoint.empty() ? "" : " (" + regret.worstPoint + ")");
}

std::string toText(const DeviceFile& file) {
    const DeviceCosts& costs = file.costs;
    const bench::Regret& regret = file.quality.regret;
    return toText(Json{{"format", kDeviceFormat},
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
                         {"worstPoint", textOrNull(regret.worstPoint)}}}});
}

Result<DeviceFile> readDeviceFile(const std::filesystem::path& path) {
    JsonReader reader(path, "calibration-format", "make the file again with glint bench --calibrate");
    const Result<Json> json = reader.read(kMaxDeviceBytes);
    if (!json) {
        return json.error();
    }
    if (!json->is_object() || reader.text(*json, "", "format") != kDeviceFormat) {
        return makeError("calibration-format", path.string(), "is no device file",
                         "give the device.json that glint bench --calibrate wrote");
    }
    const std::uint64_t version = reader.count(*json, "", "version", kMaxPoints);
    if (reader.ok() && version != kDeviceVersion) {
        reader.fail("/version", fmt::format("is {}; this glint reads {}", version, kDeviceVersion));
    }
    DeviceFile file;
    if (reader.ok()) {
        readMembers(reader, *json, file);
    }
    return reader.ok() ? Result<DeviceFile>(std::move(file)) : Result<DeviceFile>(reader.error());
}

}  // namespace glint
