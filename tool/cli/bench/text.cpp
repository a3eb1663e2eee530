// The text that glint bench prints.
#include "base/text.h"

#include "cli/bench/bench.h"
#include "cli/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glint::cli {

namespace {

constexpr double kMega = 1e6;

// Returns the names of all strategies that any entry has, in their order.
std::vector<std::string> strategiesOf(const measure::CalibrationReport& report) {
    std::vector<std::string> names;
    for (const measure::CalibrationEntry& entry : report.entries) {
        for (const measure::StrategyMeasure& measure : entry.strategies) {
            if (std::ranges::find(names, measure.strategy) == names.end()) {
                names.push_back(measure.strategy);
            }
        }
    }
    return names;
}

// The strategy that the others are compared with.
std::string_view base() {
    return package::strategyTable().front().name;
}

std::string cellOf(const measure::CalibrationEntry& entry, const std::string& strategy) {
    const auto found = std::ranges::find(entry.strategies, strategy, &measure::StrategyMeasure::strategy);
    if (found == entry.strategies.end() || found->times.empty()) {
        return "-";
    }
    if (strategy == base()) {
        return fmt::format("{:.3f}", measure::intervalOf(found->times).median);
    }
    if (found->difference.isWrong()) {
        return "wrong picture";
    }
    const measure::Interval ratio = measure::intervalOf(found->ratios);
    return fmt::format("{:.2f} ({:.2f}–{:.2f})", ratio.median, ratio.q1, ratio.q3);
}

std::string percentText(double share) {
    return fmt::format("{:.1f} %", 100.0 * share);
}

std::string textOf(const measure::Interval& interval) {
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", interval.median, interval.low, interval.high);
}

std::string ratioText(const measure::BenchPoint& point) {
    if (point.kind == measure::PointKind::Default) {
        return "1";
    }
    const measure::Interval ratio = timeRatio(point);
    return isTimeTie(point) ? fmt::format("{:.2f} tie", ratio.median) : fmt::format("{:.2f}", ratio.median);
}

std::string changeText(const measure::BenchReport& report, std::size_t index) {
    const measure::BenchPoint& point = report.points[index];
    if (index == 0) {
        return "";
    }
    return point.sameImage ? "same picture" : isErrorTie(point) ? "tie" : "";
}

std::vector<std::string> rowOf(const measure::BenchReport& report, std::size_t index,
                               const std::string& name) {
    const measure::BenchPoint& point = report.points[index];
    return {name, textOf(timeOf(report, index)), ratioText(point), textOf(errorOf(point, report.metric)),
            changeText(report, index)};
}

Rows headed(const measure::BenchReport& report) {
    return {{"configuration", "ms of a picture", "ratio", std::string(nameOf(report.metric)), "error"}};
}

std::string pointsTable(const measure::BenchReport& report) {
    Rows rows = headed(report);
    for (std::size_t i = 0; i < report.points.size(); ++i) {
        if (report.points[i].kind != measure::PointKind::Pair &&
            report.points[i].kind != measure::PointKind::Search) {
            rows.push_back(rowOf(report, i, report.points[i].name));
        }
    }
    return formatTable(rows);
}

std::string frontTable(const measure::BenchReport& report) {
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
std::string skippedText(const measure::BenchReport& report) {
    std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
    for (const measure::Setting& setting : report.settings) {
        for (const measure::SkippedValue& value : setting.skipped) {
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

// Returns what each approximation's exact value takes away from the default's error, and at what time.
std::string errorPartsTable(const measure::BenchReport& report) {
    const measure::ErrorParts& all = report.errorParts;
    Rows rows{{"exact value alone", "bias", "noise", "both", "ratio of time"}};
    const auto add = [&](const std::string& name, const measure::RemovedError& removed) {
        rows.push_back({name, percentText(removed.bias), percentText(removed.noise),
                        fmt::format("{} ({:.1f} to {:.1f})", percentText(removed.all.median),
                                    100.0 * removed.all.low, 100.0 * removed.all.high),
                        ratioText(report.points[removed.point])});
    };
    for (const measure::ErrorPart& part : all.parts) {
        add(fmt::format("{} {}", part.setting, part.to), part.removed);
    }
    rows.push_back({"any number of samples", "", percentText(all.noise), "", ""});
    rows.push_back({"the rest", percentText(all.rest), "", "", ""});
    if (all.exact) {
        add("all these values, same samples", *all.exact);
    }
    return formatTable(rows);
}

std::string adviceText(const measure::BenchReport& report) {
    const measure::BenchAdvice& advice = *report.advice;
    std::string text = "\nAdvice\n" + advice.why + "\n";
    if (advice.point) {
        text +=
            fmt::format("Settings: {} (glint render --settings, glint compile --settings)\n", advice.file);
    }
    return text;
}

// Returns a table of the passes in which strategies differ, or an empty text if no ray was sent.
std::string strategiesTable(const measure::StrategyReport& report) {
    Rows rows{{"strategy", "ms of hits", "ratio", "trace", "order", "shade"}};
    for (const measure::StrategyRow& row : report.rows) {
        rows.push_back({row.strategy, textOf(row.hits),
                        fmt::format("{:.2f} ({:.2f} to {:.2f})", row.hitRatio.median, row.hitRatio.low,
                                    row.hitRatio.high),
                        fmt::format("{:.3g}", row.traceMs), fmt::format("{:.3g}", row.orderMs),
                        fmt::format("{:.3g}", row.shadeMs)});
    }
    return formatTable(rows);
}

}  // namespace

std::string toText(const measure::BenchReport& report) {
    const measure::Reference& reference = report.reference;
    std::string text = formatFields(
        {{"scene", fmt::format("{}, {} x {}, camera {}", report.scene.file, report.scene.width,
                               report.scene.height, report.scene.camera)},
         {"device", fmt::format("{}, {}", report.machine.device, report.machine.driver)},
         {"reference", describeReference(report)},
         {"its samples",
          fmt::format("{}{}, within {:.2g} % ({})", reference.samples, reference.cached ? ", cached" : "",
                      100.0 * reference.relativeError,
                      reference.reached ? fmt::format("asked for {:.2g} %", 100.0 * reference.target)
                                        : fmt::format("NOT the {:.2g} % asked for: give more --reference-spp",
                                                      100.0 * reference.target))},
         {"its relMSE", fmt::format("{:.2g}: smaller errors can't be told apart", reference.noise.relMse)},
         {"measured", fmt::format("{} configurations in {} rounds, {:.0f} s", report.points.size(),
                                  report.rounds, report.seconds)}});
    text += fmt::format("\nOne setting at a time (default: {})\n{}",
                        base::shellWords(compiler::wordsOf(
                            measure::simplified(report.base, configurationOf(compiler::Settings())))),
                        pointsTable(report));
    if (const std::string skipped = skippedText(report); !skipped.empty()) {
        text += "\nNot tried\n" + skipped;
    }
    if (!report.errorParts.parts.empty()) {
        text += "\nWhat the default's error consists of: the share that goes with each exact value alone\n" +
                errorPartsTable(report);
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

std::string toText(const measure::CalibrationReport& report) {
    const std::vector<std::string> names = strategiesOf(report);
    Rows rows{{"cases", "cost", "hits", "M rays", "hit %", "alike", "instructions"}};
    for (const std::string& name : names) {
        rows[0].push_back(name == base() ? name + ", ms" : fmt::format("{} / {}", name, base()));
    }
    rows[0].emplace_back("fastest");
    for (const measure::CalibrationEntry& entry : report.entries) {
        const measure::CalibrationPoint& point = entry.point;
        std::vector<std::string> row{
            fmt::format("{}", point.cases),
            point.cost,
            point.coherence,
            fmt::format("{:.3g}", point.rays / kMega),
            fmt::format("{:.0f}", 100.0 * point.hitShare),
            fmt::format("{:.2f}", std::max(point.coherentShare, 0.0)),
            fmt::format("{:.0f}", measure::meanOf(point.work, &measure::CaseWork::instructions))};
        for (const std::string& name : names) {
            row.push_back(cellOf(entry, name));
        }
        row.push_back(entry.fastest.empty() ? "-" : fmt::format("{}", fmt::join(entry.fastest, ", ")));
        rows.push_back(std::move(row));
    }
    return fmt::format(
        "{}, {}. Passes from the list of rays to their shaded hits; ratios are to uber in the same\nround: "
        "median (quartiles) of {}.\n\n{}",
        report.machine.device, report.machine.driver, report.rounds, formatMarkdown(rows));
}

std::string describe(const measure::DeviceFile& file) {
    Rows rows{{"strategy"}};
    for (const compiler::CostTermInfo& info : compiler::costTerms()) {
        rows.front().push_back(fmt::format("{}, {}", info.name, info.unit));
    }
    rows.front().insert(rows.front().end(), {"points", "off by", "at most"});
    for (const compiler::StrategyCosts& costs : file.costs.strategies) {
        std::vector<std::string>& row = rows.emplace_back();
        row.push_back(costs.strategy);
        for (const compiler::CostTermInfo& info : compiler::costTerms()) {
            const double constant = costs.constants[static_cast<std::size_t>(info.term)];
            row.push_back(hasTerm(costs.strategy, info.term) ? fmt::format("{:.3g}", constant) : "-");
        }
        const auto quality =
            std::ranges::find(file.quality.strategies, costs.strategy, &measure::StrategyQuality::strategy);
        if (quality == file.quality.strategies.end()) {
            row.insert(row.end(), {"-", "-", "-"});
        } else {
            row.insert(row.end(), {std::to_string(quality->points), percentText(quality->medianError),
                                   percentText(quality->worstError)});
        }
    }
    const measure::Regret& regret = file.quality.regret;
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

}  // namespace glint::cli
