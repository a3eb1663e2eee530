// Divides the default's error among its approximations.
#include <glint/measure/report.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace glint::measure {

namespace {

// The two causes of an error, in a measure that adds up.
struct Causes {
    double bias = 0.0;
    double noise = 0.0;  // the part that more samples remove
};

// Over N rounds of independent noise the error of the mean picture has 1 / N of the noise that the error of
// one picture has, and all of the bias. FLIP is no square: there the noise is a lower bound. A single round
// gives no estimate of noise.
Causes causesOf(const BenchPoint& point, ErrorMetric metric) {
    const auto rounds = static_cast<double>(point.errors.size());
    Causes causes;
    for (const image::ImageErrors& errors : point.errors) {
        causes.bias += additive(metric, valueOf(metric, errors)) / rounds;
    }
    if (point.errors.size() > 1 && point.errorOfMean) {
        const double lost = causes.bias - additive(metric, valueOf(metric, *point.errorOfMean));
        causes.noise = lost * (metric == ErrorMetric::Flip ? 1.0 : rounds / (rounds - 1.0));
        causes.bias -= causes.noise;
    }
    return causes;
}

const BenchPoint* find(std::span<const BenchPoint> points, const compiler::Configuration& configuration) {
    const auto found = std::ranges::find_if(points, [&](const BenchPoint& point) {
        return isOfSettings(point.kind) && point.configuration == configuration;
    });
    return found == points.end() ? nullptr : &*found;
}

}  // namespace

ErrorParts partsOfError(std::span<const BenchPoint> points, std::span<const Setting> settings,
                        ErrorMetric metric) {
    const Causes base = causesOf(points.front(), metric);
    const double whole = std::max(base.bias + base.noise, 1e-300);
    const auto removedBy = [&](const BenchPoint& point) {
        std::vector<double> removed;  // by rounds with the same seed
        for (const double ratio : point.errorRatios) {
            removed.push_back(1.0 - additive(metric, ratio));
        }
        const Causes causes = causesOf(point, metric);
        return RemovedError{static_cast<std::size_t>(&point - points.data()), intervalOf(removed),
                            (base.bias - causes.bias) / whole, (base.noise - causes.noise) / whole};
    };
    ErrorParts parts;
    parts.noise = base.noise / whole;
    parts.rest = base.bias / whole;
    compiler::Configuration exact;
    for (const Setting& setting : settings) {
        if (!hasExactValue(setting)) {
            continue;
        }
        exact.emplace(setting.name, setting.exact);
        if (const BenchPoint* const point = find(points, {{setting.name, setting.exact}})) {
            parts.parts.push_back({setting.name, setting.base, setting.exact, removedBy(*point)});
            parts.rest -= parts.parts.back().removed.bias;
        }
    }
    std::ranges::stable_sort(parts.parts, std::ranges::greater(),
                             [](const ErrorPart& part) { return part.removed.bias; });
    if (const BenchPoint* const point = exact.empty() ? nullptr : find(points, exact)) {
        parts.exact = removedBy(*point);
    }
    return parts;
}

}  // namespace glint::measure
