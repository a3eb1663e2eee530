#include "cli/calibration_points.h"

#include "cli/json_reader.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace glint {

namespace {

// 256 cases take some 25 kilobytes for each point.
constexpr std::uint64_t kMaxPointsBytes = 1ULL << 28;
constexpr std::uint64_t kMaxCases = 1ULL << 20;
constexpr double kAny = std::numeric_limits<double>::max();

DeviceCosts readMachine(JsonReader& reader, const Json& json) {
    DeviceCosts device;
    const Json* const machine = reader.member(json, "", "machine");
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
void readTime(JsonReader& reader, const Json& json, const std::string& place, double& baseMs,
              bench::CalibrationPoint& point) {
    if (json.is_object() && json.contains("skipped")) {
        return;
    }
    const std::string strategy = reader.text(json, place, "strategy");
    const Json* const time = reader.member(json, place, "time");
    const Json* const ratio = reader.member(json, place, "ratio");
    const Json* const difference = reader.member(json, place, "difference");
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

bench::CalibrationPoint readPoint(JsonReader& reader, const Json& json, const std::string& place) {
    bench::CalibrationPoint point;
    point.cases = static_cast<std::uint32_t>(reader.count(json, place, "cases", kMaxCases));
    point.cost = reader.text(json, place, "cost");
    point.coherence = reader.text(json, place, "coherence");
    point.rays = reader.number(json, place, "rays", 0.0, kAny);
    point.hitShare = reader.number(json, place, "hitShare", 0.0, 1.0);
    point.coherentShare = reader.number(json, place, "coherentShare", -1.0, 1.0);
    // A value below that of random order is noise of the sample.
    point.coherentShare = std::max(0.0, point.coherentShare);
    reader.each(json, place, "work", [&](const Json& work, const std::string& there) {
        point.work.push_back({reader.number(work, there, "share", 0.0, 1.0),
                              reader.number(work, there, "instructions", 0.0, kAny),
                              reader.number(work, there, "fetches", 0.0, kAny)});
    });
    double baseMs = 0.0;
    reader.each(json, place, "strategies", [&](const Json& measured, const std::string& there) {
        readTime(reader, measured, there, baseMs, point);
    });
    return point;
}

}  // namespace

Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path) {
    JsonReader reader(path, "calibration-format",
                      "give the calibration.json that glint bench --calibrate wrote");
    const Result<Json> json = reader.read(kMaxPointsBytes);
    if (!json) {
        return json.error();
    }
    CalibrationPoints read;
    read.device = readMachine(reader, *json);
    reader.each(*json, "", "points", [&](const Json& point, const std::string& place) {
        read.points.push_back(readPoint(reader, point, place));
    });
    return reader.ok() ? Result<CalibrationPoints>(std::move(read))
                       : Result<CalibrationPoints>(reader.error());
}

}  // namespace glint
