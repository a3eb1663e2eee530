#include <glint/measure/calibration_report.h>
#include <glint/measure/statistics.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glint::measure {

namespace {

bool counts(const StrategyMeasure& measure) {
    return !measure.times.empty() && !measure.difference.isWrong();
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

}  // namespace glint::measure
