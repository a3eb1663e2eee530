#include "measure/commit.h"
#include "measure/report_json.h"

#include <glint/measure/calibration.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glint::measure {

namespace {

bool counts(const StrategyMeasure& measure) {
    return !measure.times.empty() && !measure.difference.isWrong();
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

}  // namespace glint::measure
