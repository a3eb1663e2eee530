#include "cli/explain_strategies.h"

#include "cli/table.h"

#include <fmt/format.h>

#include <initializer_list>
#include <vector>

namespace glint {

namespace {

std::string sumOf(const StrategyEstimate& estimate, std::initializer_list<CostTerm> terms) {
    double sum = 0.0;
    bool has = false;
    for (const CostTerm term : terms) {
        sum += estimate.parts[static_cast<std::size_t>(term)];
        has = has || hasTerm(estimate.strategy, term);
    }
    return has ? fmt::format("{:.3f}", sum) : "-";
}

}  // namespace

std::string strategiesText(const StrategyAdvice& advice) {
    const FrameFacts& facts = advice.choice.facts;
    const std::string costs = advice.builtIn ? "as measured on " : "of the calibration of ";
    std::string text = fmt::format("\nStrategies for a frame of {:.3g} million pixels, costs {}{}\n\n",
                                   advice.pixels / 1e6, costs, advice.device);
    if (facts.rays > 0.0) {
        std::vector<std::vector<std::string>> rows{
            {"strategy, ms", "all", "launches", "rays", "ordering", "shading", "divergence"}};
        for (const StrategyEstimate& estimate : advice.choice.estimates) {
            rows.push_back({estimate.strategy, fmt::format("{:.3f}", estimate.ms),
                            sumOf(estimate, {CostTerm::Launches, CostTerm::Cases}),
                            sumOf(estimate, {CostTerm::Rays, CostTerm::Incoherence}),
                            sumOf(estimate, {CostTerm::Buckets}), sumOf(estimate, {CostTerm::Instructions}),
                            sumOf(estimate, {CostTerm::Divergence, CostTerm::Code, CostTerm::Misses})});
        }
        text += formatTable(rows) + "\n";
    }
    return text + wrapped(fmt::format("--strategy {}: {}\n\n", advice.choice.strategy, advice.choice.why));
}

}  // namespace glint
