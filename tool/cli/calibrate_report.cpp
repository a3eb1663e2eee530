#include "cli/calibrate_report.h"

#include "cli/commit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glint {

namespace {

using bench::Interval;

constexpr double kMega = 1e6;

// Returns the mean over the cases, weighted by their shares of hits: what an average hit runs.
double meanOf(const std::vector<bench::CaseWork>& work, double bench::CaseWork::*member) {
    return std::accumulate(work.begin(), work.end(), 0.0, [&](double sum, const bench::CaseWork& one) {
        return sum + one.share * one.*member;
    });
}

bool counts(const StrategyMeasure& measure) {
    return !measure.times.empty() && !measure.difference.isWrong();
}

Json splitToJson(const bench::HitTimes& split) {
    return {{"dispatch", split.dispatch},
            {"trace", split.trace},
            {"order", split.order},
            {"shade", split.shade},
            {"shadow", split.shadow}};
}

Json strategyToJson(const StrategyMeasure& measure) {
    if (measure.times.empty()) {
        return {{"strategy", measure.strategy}, {"skipped", measure.skipped}};
    }
    Json time = toJson(bench::intervalOf(measure.times));
    time["values"] = measure.times;
    return {{"strategy", measure.strategy},
            {"tracer", measure.tracer},
            {"ordering", textOrNull(measure.ordering)},
            {"time", std::move(time)},
            {"ratio", toJson(bench::intervalOf(measure.ratios))},
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

Json entryToJson(const CalibrationEntry& entry) {
    const bench::CalibrationPoint& point = entry.point;
    Json work = Json::array();
    for (const bench::CaseWork& one : point.work) {
        work.push_back({{"share", one.share}, {"instructions", one.instructions}, {"fetches", one.fetches}});
    }
    Json strategies = Json::array();
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
            {"instructions", meanOf(point.work, &bench::CaseWork::instructions)},
            {"fetches", meanOf(point.work, &bench::CaseWork::fetches)},
            {"work", std::move(work)},
            {"samples", entry.samples},
            {"strategies", std::move(strategies)},
            {"fastest", entry.fastest}};
}

// Returns the names of all strategies that any entry has, in their order.
std::vector<std::string> strategiesOf(const CalibrationReport& report) {
    std::vector<std::string> names;
    for (const CalibrationEntry& entry : report.entries) {
        for (const StrategyMeasure& measure : entry.strategies) {
            if (std::ranges::find(names, measure.strategy) == names.end()) {
                names.push_back(measure.strategy);
            }
        }
    }
    return names;
}

std::string cellOf(const CalibrationEntry& entry, const std::string& strategy) {
    const auto found = std::ranges::find(entry.strategies, strategy, &StrategyMeasure::strategy);
    if (found == entry.strategies.end() || found->times.empty()) {
        return "-";
    }
    if (strategy == "uber") {
        return fmt::format("{:.3f}", bench::intervalOf(found->times).median);
    }
    if (found->difference.isWrong()) {
        return "wrong picture";
    }
    const Interval ratio = bench::intervalOf(found->ratios);
    return fmt::format("{:.2f} ({:.2f}–{:.2f})", ratio.median, ratio.q1, ratio.q3);
}

// Counts code points, which is the width in a terminal and in Markdown source.
std::size_t widthOf(const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string markdownTable(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 3);
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], widthOf(row[i]));
        }
    }
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t i = 0; i < rows[r].size(); ++i) {
            text += fmt::format("| {}{} ", rows[r][i], std::string(widths[i] - widthOf(rows[r][i]), ' '));
        }
        text += "|\n";
        for (std::size_t i = 0; r == 0 && i < widths.size(); ++i) {
            text += fmt::format("|{}", std::string(widths[i] + 2, '-'));
        }
        text += r == 0 ? "|\n" : "";
    }
    return text;
}

}  // namespace

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
    const double baseMs = base != entry.strategies.end() ? bench::intervalOf(base->times).median : 0.0;
    for (const StrategyMeasure& measure : entry.strategies) {
        if (counts(measure)) {
            const Interval ratio = bench::intervalOf(measure.ratios);
            entry.point.times.push_back({measure.strategy, baseMs * ratio.median});
            ratios.emplace_back(measure.strategy, ratio);
        }
    }
    const auto least =
        std::ranges::min_element(ratios, {}, [](const auto& ratio) { return ratio.second.median; });
    for (const auto& [strategy, ratio] : ratios) {
        if (bench::overlap(ratio, least->second)) {
            entry.fastest.push_back(strategy);
        }
    }
}

Json toJson(const CalibrationReport& report) {
    Json points = Json::array();
    for (const CalibrationEntry& entry : report.entries) {
        points.push_back(entryToJson(entry));
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
              {"confidence", bench::kConfidence},
              {"quick", report.quick},
              {"compileSeconds", report.compileSeconds},
              {"seconds", report.seconds}}},
            {"complete", report.complete},
            {"points", std::move(points)}};
}

std::string toText(const CalibrationReport& report) {
    const std::vector<std::string> names = strategiesOf(report);
    std::vector<std::vector<std::string>> rows{
        {"cases", "cost", "hits", "M rays", "hit %", "alike", "instructions"}};
    for (const std::string& name : names) {
        rows[0].push_back(name == "uber" ? "uber, ms" : name + " / uber");
    }
    rows[0].emplace_back("fastest");
    for (const CalibrationEntry& entry : report.entries) {
        const bench::CalibrationPoint& point = entry.point;
        std::vector<std::string> row{
            fmt::format("{}", point.cases),
            point.cost,
            point.coherence,
            fmt::format("{:.3g}", point.rays / kMega),
            fmt::format("{:.0f}", 100.0 * point.hitShare),
            fmt::format("{:.2f}", std::max(point.coherentShare, 0.0)),
            fmt::format("{:.0f}", meanOf(point.work, &bench::CaseWork::instructions))};
        for (const std::string& name : names) {
            row.push_back(cellOf(entry, name));
        }
        row.push_back(entry.fastest.empty() ? "-" : fmt::format("{}", fmt::join(entry.fastest, ", ")));
        rows.push_back(std::move(row));
    }
    return fmt::format(
        "{}, {}. Passes from the list of rays to their shaded hits; ratios are to uber in the same\nround: "
        "median (quartiles) of {}.\n\n{}",
        report.machine.device, report.machine.driver, report.rounds, markdownTable(rows));
}

}  // namespace glint
