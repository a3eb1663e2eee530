// The text that glint bench prints.
#include "cli/bench_report.h"
#include "cli/bench_settings.h"
#include "cli/table.h"
#include "cli/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glint {

namespace {

using bench::Interval;
using Rows = std::vector<std::vector<std::string>>;

std::string timeText(const BenchReport& report, std::size_t point) {
    const Interval time = timeOf(report, point);
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", time.median, time.low, time.high);
}

std::string ratioText(const BenchPoint& point) {
    if (point.kind == PointKind::Default) {
        return "1";
    }
    const Interval ratio = timeRatio(point);
    return isTimeTie(point) ? fmt::format("{:.2f} tie", ratio.median) : fmt::format("{:.2f}", ratio.median);
}

std::string errorText(const BenchReport& report, const BenchPoint& point) {
    const Interval error = errorOf(point, report.metric);
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", error.median, error.low, error.high);
}

std::string changeText(const BenchReport& report, std::size_t index) {
    const BenchPoint& point = report.points[index];
    if (index == 0) {
        return "";
    }
    return point.sameImage ? "same picture" : isErrorTie(point) ? "tie" : "";
}

std::vector<std::string> rowOf(const BenchReport& report, std::size_t index, const std::string& name) {
    const BenchPoint& point = report.points[index];
    return {name, timeText(report, index), ratioText(point), errorText(report, point),
            changeText(report, index)};
}

Rows headed(const BenchReport& report) {
    return {{"configuration", "ms of a picture", "ratio", std::string(nameOf(report.metric)), "error"}};
}

std::string pointsTable(const BenchReport& report) {
    Rows rows = headed(report);
    for (std::size_t i = 0; i < report.points.size(); ++i) {
        if (report.points[i].kind != PointKind::Pair && report.points[i].kind != PointKind::Search) {
            rows.push_back(rowOf(report, i, report.points[i].name));
        }
    }
    return formatTable(rows);
}

std::string frontTable(const BenchReport& report) {
    // Names with many settings are listed below the table, because they would widen a column.
    constexpr std::size_t kLongest = 40;
    Rows rows = headed(report);
    std::string names;
    char letter = 'A';
    for (const std::size_t i : report.front) {
        const std::string& name = report.points[i].name;
        if (name.size() <= kLongest) {
            rows.push_back(rowOf(report, i, name));
            continue;
        }
        names += fmt::format("  {}: {}\n", letter, name);
        rows.push_back(rowOf(report, i, std::string(1, letter++)));
    }
    return formatTable(rows) + names;
}

// Returns a line for each reason, with the settings that are not tried for it.
std::string skippedText(const BenchReport& report) {
    std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
    for (const bench::Setting& setting : report.settings) {
        for (const bench::SkippedValue& value : setting.skipped) {
            auto known = std::ranges::find(reasons, value.reason, [](const auto& r) { return r.first; });
            if (known == reasons.end()) {
                reasons.push_back({value.reason, {}});
                known = reasons.end() - 1;
            }
            known->second.push_back(fmt::format("{} {}", setting.name, value.value));
        }
    }
    std::string text;
    for (const auto& [reason, values] : reasons) {
        text += fmt::format("  {}: {}\n", fmt::join(values, ", "), reason);
    }
    return text;
}

std::string adviceText(const BenchReport& report) {
    const BenchAdvice& advice = *report.advice;
    std::string text = "\nAdvice\n" + advice.why + "\n";
    if (advice.point) {
        text +=
            fmt::format("Settings: {} (glint render --settings, glint compile --settings)\n", advice.file);
    }
    return text;
}

// Returns a table of the passes in which strategies differ, or an empty text if no ray was sent.
std::string strategiesTable(const StrategyReport& report) {
    Rows rows{{"strategy", "ms of hits", "ratio", "trace", "order", "shade"}};
    for (const StrategyRow& row : report.rows) {
        rows.push_back(
            {row.strategy,
             fmt::format("{:.3g} ({:.3g} to {:.3g})", row.hits.median, row.hits.low, row.hits.high),
             fmt::format("{:.2f} ({:.2f} to {:.2f})", row.hitRatio.median, row.hitRatio.low,
                         row.hitRatio.high),
             fmt::format("{:.3g}", row.traceMs), fmt::format("{:.3g}", row.orderMs),
             fmt::format("{:.3g}", row.shadeMs)});
    }
    return formatTable(rows);
}

}  // namespace

std::string toText(const BenchReport& report) {
    const Reference& reference = report.reference;
    std::string text = formatFields(
        {{"scene", fmt::format("{}, {} x {}, camera {}", report.scene.file, report.scene.width,
                               report.scene.height, report.scene.camera)},
         {"device", fmt::format("{}, {}", report.machine.device, report.machine.driver)},
         {"reference",
          fmt::format("{} samples{}, within {:.2g} % ({})", reference.samples,
                      reference.cached ? ", cached" : "", 100.0 * reference.relativeError,
                      reference.reached ? fmt::format("asked for {:.2g} %", 100.0 * reference.target)
                                        : fmt::format("NOT the {:.2g} % asked for: give more --reference-spp",
                                                      100.0 * reference.target))},
         {"its relMSE", fmt::format("{:.2g}: smaller errors can't be told apart", reference.noise.relMse)},
         {"measured", fmt::format("{} configurations in {} rounds, {:.0f} s", report.points.size(),
                                  report.rounds, report.seconds)}});
    text +=
        fmt::format("\nOne setting at a time (default: {})\n{}",
                    shellWords(wordsOf(bench::simplified(report.base, configurationOf(usualArguments())))),
                    pointsTable(report));
    if (const std::string skipped = skippedText(report); !skipped.empty()) {
        text += "\nNot tried\n" + skipped;
    }
    text += "\nPareto front, from the fastest\n" + frontTable(report);
    if (!report.strategies.why.empty()) {
        text += "\nStrategies: from the list of rays to their shaded hits\n" +
                strategiesTable(report.strategies) + "\n";
        for (const std::string& sentence : report.strategies.why) {
            text += sentence + "\n";
        }
    }
    return report.advice ? text + adviceText(report) : text;
}

}  // namespace glint
