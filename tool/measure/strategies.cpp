#include <glint/measure/report.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glint::measure {

namespace {

template <typename Value>
Interval overRounds(const BenchPoint& point, const Value& value) {
    std::vector<double> values;
    for (const HitTimes& hits : point.hits) {
        values.push_back(value(hits));
    }
    return measure::intervalOf(values);
}

StrategyRow rowOf(const BenchPoint& point, std::size_t index, const std::string& strategy) {
    using Hits = HitTimes;
    StrategyRow row;
    row.strategy = strategy;
    row.point = index;
    row.ratio = timeRatio(point);
    row.hits = measure::intervalOf(point.hitMs);
    row.hitRatio = measure::intervalOf(point.hitRatios);
    row.traceMs = overRounds(point, [](const Hits& hits) { return hits.trace; }).median;
    row.orderMs = overRounds(point, [](const Hits& hits) { return hits.order; }).median;
    // Shading gets the rest, because its passes overlap if they are not measured one by one.
    row.shadeMs = std::max(row.hits.median - row.traceMs - row.orderMs, 0.0);
    row.commonMs = std::max(measure::intervalOf(point.times).median - row.hits.median, 0.0);
    row.rays = point.counters.rays;
    return row;
}

// Returns the average number of cases among `wave` hits in random order.
double casesIn(std::span<const std::uint32_t> hits, double wave) {
    const double all = std::accumulate(hits.begin(), hits.end(), 0.0);
    double cases = 0.0;
    for (const std::uint32_t count : hits) {
        cases += all > 0.0 ? 1.0 - std::pow(1.0 - count / all, wave) : 0.0;
    }
    return cases;
}

void countHits(std::span<const std::uint32_t> buckets, StrategyReport& report) {
    constexpr double kWave = 32.0;
    if (buckets.size() < 2) {
        return;
    }
    const std::span<const std::uint32_t> hits = buckets.subspan(1);  // the first is of misses
    report.cases = static_cast<std::uint32_t>(hits.size());
    report.filledCases =
        static_cast<std::uint32_t>(std::ranges::count_if(hits, [](std::uint32_t n) { return n > 0; }));
    const double all = std::accumulate(hits.begin(), hits.end(), 0.0);
    report.largestShare = all > 0.0 ? *std::ranges::max_element(hits) / all : 0.0;
    report.casesInWave = casesIn(hits, kWave);
}

// Returns the share of the row's time, in whole per cent.
double percent(double part, const StrategyRow& row) {
    return 100.0 * part / std::max(row.commonMs + row.traceMs + row.orderMs + row.shadeMs, 1e-12);
}

void explain(StrategyReport& report) {
    const auto least =
        std::ranges::min_element(report.rows, {}, [](const StrategyRow& row) { return row.ratio.median; });
    for (const StrategyRow& row : report.rows) {
        if (overlap(row.ratio, least->ratio)) {
            report.fastest.push_back(row.strategy);
        }
    }
    if (report.fastest.size() > 1) {
        report.why.push_back(
            fmt::format("{} take equally long: their intervals overlap.", fmt::join(report.fastest, ", ")));
    } else {
        report.why.push_back(fmt::format("{} is fastest.", least->strategy));
    }
    for (const StrategyRow& row : report.rows) {
        if (&row != &*least) {
            report.why.push_back(fmt::format("{} takes {:.2f} times as long as {} (the medians).",
                                             row.strategy, row.ratio.median / least->ratio.median,
                                             least->strategy));
        }
    }
    report.why.push_back(
        fmt::format("In a picture with {}, {:.0f} % of the time is work that all strategies share: primary "
                    "surfaces, rays, the composition. Strategies differ only in the rest.",
                    least->strategy, percent(least->commonMs, *least)));
    for (const StrategyRow& row : report.rows) {
        if (row.orderMs > 0.0) {
            report.why.push_back(
                fmt::format("{} spends {:.1f} % on tracing into hit records, {:.1f} % on sorting them and "
                            "{:.1f} % on shading them.",
                            row.strategy, percent(row.traceMs, row), percent(row.orderMs, row),
                            percent(row.shadeMs, row)));
        } else {
            report.why.push_back(
                fmt::format("{} sorts nothing: it spends {:.1f} % on tracing and shading hits at once.",
                            row.strategy, percent(row.shadeMs, row)));
        }
    }
    const std::uint32_t rays = report.rows.front().rays;
    report.why.push_back(fmt::format("A sample sends {} rays whose hits are shaded.", rays));
    if (report.cases > 0) {
        report.why.push_back(fmt::format(
            "Hits have {} of {} shaders, and {:.0f} % of them have the same one. 32 hits in random order "
            "have {:.1f} shaders: a subgroup of an uber shader runs at most that many one after another.",
            report.filledCases, report.cases, 100.0 * report.largestShare, report.casesInWave));
    }
}

}  // namespace

StrategyReport compareStrategies(std::span<const BenchPoint> points, const std::string& base) {
    StrategyReport report;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const compiler::Configuration& configuration = points[i].configuration;
        const auto own = configuration.find("strategy");
        const bool isAlone =
            configuration.empty() || (own != configuration.end() && configuration.size() == 1);
        if (!isAlone || points[i].times.empty() || !isOfSettings(points[i].kind)) {
            continue;
        }
        report.rows.push_back(rowOf(points[i], i, own == configuration.end() ? base : own->second));
        if (report.cases == 0) {
            countHits(points[i].counters.bucketCounts, report);
        }
    }
    if (report.rows.size() > 1 && report.rows.front().rays > 0) {
        explain(report);
    }
    return report;
}

}  // namespace glint::measure
