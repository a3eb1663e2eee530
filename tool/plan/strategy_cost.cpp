#include "plan/strategy_cost.h"

#include "plan/cost.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace glint::compiler {

namespace {

constexpr double kNanosecond = 1e-6;  // in milliseconds
constexpr double kPicosecond = 1e-9;

constexpr CostTermInfo kTerms[] = {
    {CostTerm::Launches, "launches", "ms", 1.0, "a list of rays"},
    {CostTerm::Cases, "cases", "ms", 1.0, "a case and list"},
    {CostTerm::Rays, "rays", "ns", kNanosecond, "a ray"},
    {CostTerm::Incoherence, "incoherence", "ns", kNanosecond, "an incoherent ray"},
    {CostTerm::Buckets, "buckets", "ns", kNanosecond, "a ray and doubling of the buckets"},
    {CostTerm::Instructions, "instructions", "ps", kPicosecond, "an instruction of a hit"},
    {CostTerm::Divergence, "divergence", "ps", kPicosecond, "an instruction that others wait for"},
    {CostTerm::Code, "code", "ps", kPicosecond, "an instruction of a hit and root of the cases"},
    {CostTerm::Misses, "misses", "ps", kPicosecond, "divergent code beyond a cache"},
};
static_assert(std::size(kTerms) == kCostTerms);

}  // namespace

std::span<const CostTermInfo> costTerms() {
    return kTerms;
}

std::span<const std::string_view> simplestFirst() {
    static const std::vector<std::string_view> kNames = [] {
        std::vector<const package::StrategyInfo*> infos;
        for (const package::StrategyInfo& info : package::strategyTable()) {
            infos.push_back(&info);
        }
        std::ranges::stable_sort(infos, {}, [](const package::StrategyInfo* info) {
            return std::tuple(info->ownPipeline, info->dispatchesCases, info->ordersHits);
        });
        std::vector<std::string_view> names;
        for (const package::StrategyInfo* const info : infos) {
            names.push_back(info->name);
        }
        return names;
    }();
    return kNames;
}

bool hasTerm(std::string_view strategy, CostTerm term) {
    const package::StrategyInfo& info = *package::findStrategy(strategy);
    switch (term) {
        case CostTerm::Cases:
        case CostTerm::Buckets:
            return info.ordersHits;
        case CostTerm::Divergence:
        case CostTerm::Misses:
            return !info.ordersHits;
        case CostTerm::Code:
            return !info.dispatchesCases;
        default:
            return true;
    }
}

const StrategyCosts* findCosts(const DeviceCosts& device, std::string_view strategy) {
    const auto row = std::ranges::find(device.strategies, strategy, &StrategyCosts::strategy);
    return row == device.strategies.end() ? nullptr : &*row;
}

double weightOf(const RoundCase& roundCase) {
    return roundCase.instructions + kFetchCost * roundCase.fetches;
}

double independentLanes(double subgroupSize, double coherence) {
    return 1.0 + std::max(0.0, subgroupSize - 1.0) * (1.0 - std::clamp(coherence, 0.0, 1.0));
}

double instructionsRun(const Round& round, double lanes) {
    double sum = 0.0;
    for (const RoundCase& roundCase : round.cases) {
        const double chance = std::clamp(round.hitShare * roundCase.share, 0.0, 1.0);
        // expm1 and log1p keep the digits that pow would lose for small chances.
        const double some = chance < 1.0 ? -std::expm1(lanes * std::log1p(-chance)) : 1.0;
        sum += some * weightOf(roundCase);
    }
    return sum;
}

double casesRun(const Round& round, double subgroupSize) {
    const double lanes = independentLanes(subgroupSize, round.coherence);
    double sum = 0.0;
    for (const RoundCase& roundCase : round.cases) {
        sum += 1.0 - std::pow(1.0 - std::clamp(round.hitShare * roundCase.share, 0.0, 1.0), lanes);
    }
    const double someHit = 1.0 - std::pow(1.0 - std::clamp(round.hitShare, 0.0, 1.0), lanes);
    return someHit > 0.0 ? sum / someHit : 0.0;
}

TermValues termsOf(const Round& round, double subgroupSize) {
    const auto cases = static_cast<double>(round.cases.size());
    const double together = instructionsRun(round, 1.0);
    const double apart = instructionsRun(round, independentLanes(subgroupSize, round.coherence));
    const double waits = std::max(0.0, apart - together);
    // The order is that of CostTerm.
    return {1.0,
            cases,
            round.rays,
            round.rays * std::clamp(round.scatter, 0.0, 1.0),
            round.rays * std::log2(1.0 + cases),
            round.rays * together,
            round.rays * waits,
            round.rays * together * (std::sqrt(std::max(1.0, cases)) - 1.0),
            round.rays * waits * std::sqrt(waits / 1000.0)};
}

TermValues estimate(const Round& round, const StrategyCosts& costs, double subgroupSize) {
    TermValues parts{};
    if (round.rays <= 0.0) {
        return parts;
    }
    const TermValues counts = termsOf(round, subgroupSize);
    for (const CostTermInfo& info : kTerms) {
        const auto i = static_cast<std::size_t>(info.term);
        parts[i] = counts[i] * costs.constants[i] * info.milliseconds;
    }
    return parts;
}

double estimatedMs(const Round& round, const StrategyCosts& costs, double subgroupSize) {
    const TermValues parts = estimate(round, costs, subgroupSize);
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

}  // namespace glint::compiler
