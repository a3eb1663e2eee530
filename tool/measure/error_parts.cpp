// Which part of the default's error is which approximation.
#include <glint/measure/report.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace glint::measure {

namespace {

// Returns the share of the default's error that a point lacks, by rounds with the same seed.
Interval removedBy(const BenchPoint& point, ErrorMetric metric) {
    std::vector<double> removed;
    for (const double ratio : point.errorRatios) {
        removed.push_back(1.0 - additive(metric, ratio));
    }
    return intervalOf(removed);
}

// Over N rounds of independent noise the error of the mean picture has 1 / N of the noise that the error of
// one picture has, and all of the bias. Of FLIP, which is no square, this is a lower bound.
std::optional<double> noiseOf(const BenchPoint& base, ErrorMetric metric) {
    const auto rounds = static_cast<double>(base.errors.size());
    if (base.errors.size() < 2 || !base.errorOfMean) {
        return std::nullopt;
    }
    double mean = 0.0;
    for (const image::ImageErrors& errors : base.errors) {
        mean += additive(metric, valueOf(metric, errors)) / rounds;
    }
    const double lost = mean - additive(metric, valueOf(metric, *base.errorOfMean));
    const double inflation = metric == ErrorMetric::Flip ? 1.0 : rounds / (rounds - 1.0);
    return mean > 0.0 ? lost / mean * inflation : 0.0;
}

const BenchPoint* find(std::span<const BenchPoint> points, const compiler::Configuration& configuration) {
    const auto found = std::ranges::find_if(points, [&](const BenchPoint& point) {
        return point.kind != PointKind::Package && point.configuration == configuration;
    });
    return found == points.end() ? nullptr : &*found;
}

}  // namespace

ErrorParts partsOfError(std::span<const BenchPoint> points, std::span<const Setting> settings,
                        ErrorMetric metric) {
    ErrorParts parts;
    compiler::Configuration exact;
    for (const Setting& setting : settings) {
        if (!hasExactValue(setting)) {
            continue;
        }
        exact.emplace(setting.name, setting.exact);
        if (const BenchPoint* const point = find(points, {{setting.name, setting.exact}})) {
            parts.parts.push_back({setting.name, setting.base, setting.exact,
                                   static_cast<std::size_t>(point - points.data()),
                                   removedBy(*point, metric)});
        }
    }
    std::ranges::stable_sort(parts.parts, std::ranges::greater(),
                             [](const ErrorPart& part) { return part.removed.median; });
    if (const BenchPoint* const point = exact.empty() ? nullptr : find(points, exact)) {
        parts.exact = static_cast<std::size_t>(point - points.data());
        parts.exactRemoved = removedBy(*point, metric);
    }
    parts.noise = noiseOf(points.front(), metric);
    parts.rest = 1.0 - parts.noise.value_or(0.0);
    for (const ErrorPart& part : parts.parts) {
        parts.rest -= part.removed.median;
    }
    return parts;
}

}  // namespace glint::measure
