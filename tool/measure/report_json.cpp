#include "measure/report_json.h"

#include "base/text.h"
#include "emit/package/json.h"
#include "measure/commit.h"
#include "settings/descriptor.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

namespace glint::measure {

namespace {

base::Json numberOrNull(double value) {
    return std::isfinite(value) ? base::Json(value) : base::Json(nullptr);
}

base::Json splitToJson(const HitTimes& split) {
    return {{"dispatch", split.dispatch},
            {"trace", split.trace},
            {"order", split.order},
            {"shade", split.shade},
            {"shadow", split.shadow}};
}

base::Json strategyToJson(const StrategyMeasure& measure) {
    if (measure.times.empty()) {
        return {{"strategy", measure.strategy}, {"skipped", measure.skipped}};
    }
    base::Json time = toJson(measure::intervalOf(measure.times));
    time["values"] = measure.times;
    return {{"strategy", measure.strategy},
            {"tracer", measure.tracer},
            {"ordering", base::textOrNull(measure.ordering)},
            {"time", std::move(time)},
            {"ratio", toJson(measure::intervalOf(measure.ratios))},
            {"split", splitToJson(measure.split)},
            {"pipelineMs", measure.pipelineMs},
            {"firstMs", measure.firstMs},
            {"bytes", measure.bytes},
            {"difference",
             {{"largest", measure.difference.largest},
              {"differing", measure.difference.differing},
              {"pixels", measure.difference.pixels},
              {"wrong", measure.difference.isWrong()}}}};
}

base::Json settingsToJson(const compiler::Configuration& configuration) {
    base::Json object = base::Json::object();
    for (const std::string& name : compiler::settingNames()) {
        const auto value = configuration.find(name);
        if (value != configuration.end()) {
            object[name] = value->second;
        }
    }
    return object;
}

// Returns the interval over the rounds of a point.
Interval errorInterval(const BenchPoint& point, double image::ImageErrors::*member) {
    std::vector<double> values;
    for (const image::ImageErrors& errors : point.errors) {
        values.push_back(errors.*member);
    }
    return measure::intervalOf(values);
}

base::Json errorsToJson(const BenchPoint& point) {
    std::vector<double> biases;
    for (const image::ImageErrors& errors : point.errors) {
        biases.push_back(errors.bias);
    }
    const MeanInterval bias = measure::meanOf(biases);
    return {{"relMse", toJson(errorInterval(point, &image::ImageErrors::relMse))},
            {"rmse", toJson(errorInterval(point, &image::ImageErrors::rmse))},
            {"psnr", toJson(errorInterval(point, &image::ImageErrors::psnr))},
            {"p999", toJson(errorInterval(point, &image::ImageErrors::p999))},
            {"trimmed", toJson(errorInterval(point, &image::ImageErrors::trimmed))},
            {"flip", toJson(errorInterval(point, &image::ImageErrors::flip))},
            {"bias", {{"mean", bias.mean}, {"low", bias.low}, {"high", bias.high}}}};
}

base::Json passesToJson(const BenchPoint& point) {
    base::Json passes = base::Json::array();
    for (const auto& [name, milliseconds] : point.passes) {
        const Interval interval = measure::intervalOf(milliseconds);
        passes.push_back(
            {{"name", name}, {"median", interval.median}, {"q1", interval.q1}, {"q3", interval.q3}});
    }
    return passes;
}

base::Json pointToJson(const BenchReport& report, std::size_t index) {
    const BenchPoint& point = report.points[index];
    base::Json time = toJson(timeOf(report, index));
    time["values"] = point.times;
    return {{"id", index},
            {"name", point.name},
            {"kind", nameOf(point.kind)},
            {"settings", settingsToJson(point.configuration)},
            {"package", base::textOrNull(point.package)},
            {"filteredFrames", point.filteredFrames},
            {"command", renderCommand(report, point)},
            {"time", std::move(time)},
            {"ratio", toJson(timeRatio(point))},
            {"timeTie", isTimeTie(point)},
            {"passes", passesToJson(point)},
            {"error", errorsToJson(point)},
            {"errorTie", isErrorTie(point)},
            {"sameImage", point.sameImage},
            {"front", std::ranges::find(report.front, index) != report.front.end()},
            {"tracer", point.tracer},
            {"ordering", base::textOrNull(point.ordering)},
            {"rays", point.counters.rays},
            {"cases", point.cases},
            {"pipelines", point.footprint.pipelines},
            {"bytes", point.footprint.bytes},
            {"image", imageName(index)},
            {"errorImage", errorImageName(index)}};
}

base::Json settingToJson(const Setting& setting) {
    base::Json skipped = base::Json::array();
    for (const SkippedValue& value : setting.skipped) {
        skipped.push_back({{"value", value.value}, {"reason", value.reason}});
    }
    return {{"name", setting.name},
            {"option", "--" + setting.name},
            {"stage", setting.isCompiled ? "compile" : "render"},
            {"approximates", setting.approximates},
            {"exact", hasExactValue(setting) ? base::Json(setting.exact) : base::Json(nullptr)},
            {"what", setting.what},
            {"default", setting.base},
            {"values", setting.values},
            {"skipped", std::move(skipped)}};
}

base::Json referenceToJson(const BenchReport& report) {
    const Reference& reference = report.reference;
    return {{"image", kReferenceImage},
            {"transport", reference.isFull ? "full" : "same"},
            {"what", describeReference(report)},
            {"samples", reference.samples},
            {"relativeError", reference.relativeError},
            {"target", reference.target},
            {"reached", reference.reached},
            {"noise",
             {{"relMse", reference.noise.relMse},
              {"trimmed", reference.noise.trimmed},
              {"rmse", reference.noise.rmse}}},
            {"cached", reference.cached},
            {"seconds", reference.seconds},
            {"settings", settingsToJson(reference.configuration)},
            {"exposure", reference.exposure}};
}

// Returns the values of the base and the point that `glint compile` decides, or the others.
base::Json decided(const BenchReport& report, const BenchPoint& point, bool compiled) {
    compiler::Configuration values;
    for (const auto& [name, value] : report.base) {
        if (compiler::isCompiled(*compiler::sweptSetting(name)) == compiled) {
            values[name] = valueOf(name, point.configuration, report.base);
        }
    }
    return settingsToJson(values);
}

base::Json adviceToJson(const BenchReport& report) {
    if (!report.advice) {
        return nullptr;
    }
    const BenchAdvice& advice = *report.advice;
    base::Json object{{"budgetMs", advice.budgetMs ? base::Json(*advice.budgetMs) : base::Json(nullptr)},
                      {"maxError", advice.maxError ? base::Json(*advice.maxError) : base::Json(nullptr)},
                      {"metric", nameOf(report.metric)},
                      {"point", advice.point ? base::Json(*advice.point) : base::Json(nullptr)},
                      {"file", advice.point ? base::Json(advice.file) : base::Json(nullptr)}};
    if (advice.point) {
        const BenchPoint& point = report.points[*advice.point];
        object["compile"] = decided(report, point, true);
        object["render"] = decided(report, point, false);
    }
    object["why"] = advice.why;
    return object;
}

base::Json removedToJson(const RemovedError& removed) {
    return {{"point", removed.point},
            {"removed", toJson(removed.all)},
            {"bias", removed.bias},
            {"noise", removed.noise}};
}

base::Json errorPartsToJson(const BenchReport& report) {
    const ErrorParts& all = report.errorParts;
    base::Json parts = base::Json::array();
    for (const ErrorPart& part : all.parts) {
        base::Json object{{"setting", part.setting}, {"from", part.from}, {"to", part.to}};
        object.update(removedToJson(part.removed));
        parts.push_back(std::move(object));
    }
    return {{"parts", std::move(parts)},
            {"exact", all.exact ? removedToJson(*all.exact) : base::Json(nullptr)},
            {"noise", all.noise},
            {"rest", all.rest}};
}

base::Json strategiesToJson(const BenchReport& report) {
    const StrategyReport& strategies = report.strategies;
    base::Json rows = base::Json::array();
    for (const StrategyRow& row : strategies.rows) {
        rows.push_back({{"strategy", row.strategy},
                        {"point", row.point},
                        {"time", toJson(timeOf(report, row.point))},
                        {"ratio", toJson(row.ratio)},
                        {"hits", toJson(row.hits)},
                        {"hitRatio", toJson(row.hitRatio)},
                        {"traceMs", row.traceMs},
                        {"orderMs", row.orderMs},
                        {"shadeMs", row.shadeMs},
                        {"commonMs", row.commonMs},
                        {"rays", row.rays}});
    }
    return {{"fastest", strategies.fastest},
            {"rows", std::move(rows)},
            {"cases", strategies.cases},
            {"filledCases", strategies.filledCases},
            {"largestShare", strategies.largestShare},
            {"casesInWave", strategies.casesInWave},
            {"why", strategies.why}};
}

}  // namespace

base::Json toJson(const BenchMachine& machine) {
    return {{"device", machine.device},   {"driver", machine.driver}, {"deviceType", machine.deviceType},
            {"tracers", machine.tracers}, {"cpu", machine.processor}, {"cores", machine.cores},
            {"os", machine.system}};
}

base::Json toJson(const Interval& interval) {
    return {{"median", numberOrNull(interval.median)},
            {"low", numberOrNull(interval.low)},
            {"high", numberOrNull(interval.high)},
            {"q1", numberOrNull(interval.q1)},
            {"q3", numberOrNull(interval.q3)}};
}

base::Json toJson(const CalibrationEntry& entry) {
    const CalibrationPoint& point = entry.point;
    base::Json work = base::Json::array();
    for (const CaseWork& one : point.work) {
        work.push_back({{"share", one.share}, {"instructions", one.instructions}, {"fetches", one.fetches}});
    }
    base::Json strategies = base::Json::array();
    for (const StrategyMeasure& measure : entry.strategies) {
        strategies.push_back(strategyToJson(measure));
    }
    return {{"cases", point.cases},
            {"cost", point.cost},
            {"coherence", point.coherence},
            {"shares", entry.shares},
            {"lights", entry.lights},
            {"shadows", entry.shadows},
            {"width", entry.width},
            {"height", entry.height},
            {"rays", static_cast<std::uint64_t>(point.rays)},
            {"hits", entry.hits},
            {"hitShare", point.hitShare},
            {"coherentShare", point.coherentShare},
            {"filledCases", entry.filledCases},
            {"instructions", meanOf(point.work, &CaseWork::instructions)},
            {"fetches", meanOf(point.work, &CaseWork::fetches)},
            {"work", std::move(work)},
            {"samples", entry.samples},
            {"strategies", std::move(strategies)},
            {"fastest", entry.fastest}};
}

base::Json toJson(const CalibrationReport& report) {
    base::Json points = base::Json::array();
    for (const CalibrationEntry& entry : report.entries) {
        points.push_back(toJson(entry));
    }
    return {{"format", "glint-calibration"},
            {"version", 1},
            {"tool", GLINT_VERSION},
            {"commit", sourceCommit()},
            {"date", report.date},
            {"command", report.command},
            {"machine", toJson(report.machine)},
            {"method",
             {{"rounds", report.rounds},
              {"seed", report.seed},
              {"confidence", kConfidence},
              {"quick", report.quick},
              {"compileSeconds", report.compileSeconds},
              {"seconds", report.seconds}}},
            {"complete", report.complete},
            {"points", std::move(points)}};
}

base::Json toJson(const BenchReport& report) {
    base::Json settings = base::Json::array();
    for (const Setting& setting : report.settings) {
        settings.push_back(settingToJson(setting));
    }
    base::Json points = base::Json::array();
    for (std::size_t i = 0; i < report.points.size(); ++i) {
        points.push_back(pointToJson(report, i));
    }
    const BenchScene& scene = report.scene;
    return {{"format", "glint-bench"},
            {"version", 1},
            {"tool", GLINT_VERSION},
            {"commit", sourceCommit()},
            {"date", report.date},
            {"command", report.command},
            {"scene",
             {{"file", scene.file},
              {"name", std::filesystem::path(scene.file).stem().string()},
              {"sceneInFile", compiler::sceneInFileToJson(scene.inFile)},
              {"triangles", scene.triangles},
              {"materials", scene.materials},
              {"instances", scene.instances},
              {"lights", scene.lights},
              {"camera", scene.camera},
              {"width", scene.width},
              {"height", scene.height},
              {"environment", base::textOrNull(scene.environment)}}},
            {"machine", toJson(report.machine)},
            {"method",
             {{"rounds", report.rounds},
              {"seed", report.seed},
              {"confidence", kConfidence},
              {"quick", report.quick},
              {"batch", report.batch},
              {"pictureScale", pictureScale(report)},
              {"seconds", report.seconds},
              {"metric", nameOf(report.metric)}}},
            {"reference", referenceToJson(report)},
            {"settings", std::move(settings)},
            {"points", std::move(points)},
            {"front", report.front},
            {"advice", adviceToJson(report)},
            {"errorParts", errorPartsToJson(report)},
            {"strategies", strategiesToJson(report)}};
}

}  // namespace glint::measure
