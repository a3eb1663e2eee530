#include "plan/strategy_cost.h"

#include "plan/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
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
        names.reserve(infos.size());
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

namespace {

// Returns the chance that one of `lanes` does what each does with the given chance.
double someLane(double chance, double lanes) {
    // expm1 and log1p keep the digits that pow would lose for small chances.
    return chance < 1.0 ? -std::expm1(lanes * std::log1p(-std::max(chance, 0.0))) : 1.0;
}

double weightOf(const PartialCode& part) {
    return part.instructions + kFetchCost * part.fetches;
}

}  // namespace

double unsortedWork(const Round& round, double lanes) {
    double sum = 0.0;
    for (const RoundCase& roundCase : round.cases) {
        const double chance = round.hitShare * roundCase.share;
        sum += someLane(chance, lanes) * weightOf(roundCase);
        for (const PartialCode& part : roundCase.parts) {
            sum += someLane(chance * part.share, lanes) * weightOf(part);
        }
    }
    return sum;
}

double sortedWork(const Round& round, double lanes) {
    double sum = 0.0;
    for (const RoundCase& roundCase : round.cases) {
        double work = weightOf(roundCase);
        for (const PartialCode& part : roundCase.parts) {
            work += someLane(part.share, lanes) * weightOf(part);
        }
        sum += round.hitShare * roundCase.share * work;
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
    const double lanes = independentLanes(subgroupSize, round.coherence);
    const double together = sortedWork(round, lanes);
    const double apart = unsortedWork(round, lanes);
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

double firstHitsMs(const Round& firstHits, const DeviceCosts& device) {
    if (device.strategies.empty() || firstHits.rays <= 0.0) {
        return 0.0;
    }
    const auto like = std::ranges::find_if(device.strategies, [](const StrategyCosts& costs) {
        return package::findStrategy(costs.strategy)->dispatchesCases;
    });
    const StrategyCosts& costs = like != device.strategies.end() ? *like : device.strategies.front();
    const auto constant = [&](CostTerm term) { return costs.constants[static_cast<std::size_t>(term)]; };
    const double lanes = independentLanes(device.subgroupSize, firstHits.coherence);
    const double aCase = std::max(constant(CostTerm::Cases), device.onCpu ? 0.0 : kFirstCaseMs);
    return firstHits.rays * sortedWork(firstHits, lanes) * kFirstHitWork * constant(CostTerm::Instructions) *
               kPicosecond +
           static_cast<double>(firstHits.cases.size()) * aCase;
}

namespace {

double partOf(const StrategyEstimate& estimate, CostTerm term) {
    return estimate.parts[static_cast<std::size_t>(term)];
}

// Three digits are enough, because no estimate is more accurate.
std::string milliseconds(double ms) {
    return ms < 1000.0 ? fmt::format("{:.3g} ms", ms) : fmt::format("{:.0f} ms", ms);
}

std::string whole(double count) {
    const std::string digits = fmt::format("{:.0f}", count);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        const bool opensGroup = i > 0 && (digits.size() - i) % 3 == 0;
        text += opensGroup ? "," : "";
        text += digits[i];
    }
    return text;
}

const StrategyEstimate* find(const StrategyChoice& choice, std::string_view strategy) {
    const auto row = std::ranges::find(choice.estimates, strategy, &StrategyEstimate::strategy);
    return row == choice.estimates.end() ? nullptr : &*row;
}

bool ordersHits(std::string_view strategy) {
    return hasTerm(strategy, CostTerm::Buckets);
}

// Describes the rays' hits in numbers.
std::string factsText(const FrameFacts& facts) {
    const std::string alike = facts.coherence >= 0.75  ? "mostly alike"
                              : facts.coherence > 0.25 ? "partly alike"
                                                       : "unlike";
    const std::string paths =
        facts.bounces == 1
            ? std::string()
            : fmt::format(" in {} bounces, {:.0f} % of them after the first, where neighbours go everywhere",
                          facts.bounces, 100.0 * facts.laterRays / std::max(facts.rays, 1e-12));
    std::string text = fmt::format(
        "{} rays{}, {} case{}, {} instructions a hit, hits of neighbouring rays {}", whole(facts.rays), paths,
        facts.cases, facts.cases == 1 ? "" : "s", whole(facts.instructions), alike);
    if (facts.cases > 1) {
        text +=
            fmt::format(": a subgroup of unsorted hits runs {:.1f} cases one after another", facts.casesRun);
    }
    return text + ".";
}

// Returns the best strategy of the other kind (ordering or not), for a comparison of the time that ordering
// saves or would save.
const StrategyEstimate* rivalOf(const StrategyChoice& choice) {
    const StrategyEstimate* best = nullptr;
    for (const StrategyEstimate& other : choice.estimates) {
        const bool rivals = other.available && ordersHits(other.strategy) != ordersHits(choice.strategy);
        if (rivals && (best == nullptr || other.ms < best->ms)) {
            best = &other;
        }
    }
    return best;
}

// Compares the two strategies term by term.
std::string comparisonText(const StrategyEstimate& chosen, const StrategyEstimate& rival) {
    const bool ordered = ordersHits(chosen.strategy);
    const StrategyEstimate& sorted = ordered ? chosen : rival;
    const StrategyEstimate& unsorted = ordered ? rival : chosen;
    const auto waits = [](const StrategyEstimate& row) {
        return partOf(row, CostTerm::Divergence) + partOf(row, CostTerm::Code) +
               partOf(row, CostTerm::Misses);
    };
    const double spared = waits(unsorted) - waits(sorted);
    const double shading = partOf(sorted, CostTerm::Instructions) - partOf(unsorted, CostTerm::Instructions);
    const double around = sorted.ms - unsorted.ms + spared - shading;
    return fmt::format(
        "{} is expected to take {}, and {} {} ({:.2f} times): sorting {} {} of divergence, {} {} of "
        "launches, records and sorting, and {} {} of shading.",
        chosen.strategy, milliseconds(chosen.ms), rival.strategy, milliseconds(rival.ms),
        rival.ms / std::max(chosen.ms, 1e-12), spared < 0.0 ? "adds" : "saves",
        milliseconds(std::abs(spared)), around < 0.0 ? "saves" : "adds", milliseconds(std::abs(around)),
        shading < 0.0 ? "saves" : "adds", milliseconds(std::abs(shading)));
}

void explain(StrategyChoice& choice) {
    if (choice.facts.rays <= 0.0) {
        choice.why = "No effect sends rays whose hits are shaded: strategies do not differ.";
        return;
    }
    choice.why = factsText(choice.facts);
    const StrategyEstimate* const chosen = find(choice, choice.strategy);
    if (const StrategyEstimate* const rival = rivalOf(choice)) {
        choice.why += fmt::format(" {}", comparisonText(*chosen, *rival));
    } else {
        choice.why +=
            fmt::format(" {} is expected to take {}; no strategy can be chosen that treats hits differently.",
                        choice.strategy, milliseconds(chosen->ms));
    }
}

}  // namespace

bool isBetterChoice(const ChoiceTime& a, const ChoiceTime& b, std::size_t cases) {
    if (cases <= 1 && ordersHits(a.strategy) != ordersHits(b.strategy)) {
        return ordersHits(b.strategy);
    }
    return a.ms < b.ms;
}

FrameFacts factsOf(std::span<const Round> rounds, double subgroupSize) {
    FrameFacts facts;
    for (const Round& round : rounds) {
        const double hits = round.rays * round.hitShare;
        facts.rays += round.rays;
        facts.laterRays += round.bounce > 1 ? round.rays : 0.0;
        facts.bounces = std::max(facts.bounces, round.bounce);
        facts.hits += hits;
        facts.cases = std::max(facts.cases, round.cases.size());
        facts.coherence += round.rays * round.coherence;
        facts.instructions += round.rays * sortedWork(round, 1.0);
        facts.casesRun += hits * casesRun(round, subgroupSize);
    }
    facts.coherence /= std::max(facts.rays, 1e-12);
    facts.instructions /= std::max(facts.hits, 1e-12);
    facts.casesRun /= std::max(facts.hits, 1e-12);
    return facts;
}

std::optional<StrategyChoice> chooseStrategy(std::span<const Round> rounds, const DeviceCosts& device,
                                             std::span<const std::string> available) {
    StrategyChoice choice;
    choice.facts = factsOf(rounds, device.subgroupSize);
    const StrategyEstimate* best = nullptr;
    choice.estimates.reserve(simplestFirst().size());  // The vector must not reallocate, so that `best`
                                                       // stays valid.
    for (const std::string_view name : simplestFirst()) {
        const StrategyCosts* const costs = findCosts(device, name);
        if (costs == nullptr) {
            continue;
        }
        StrategyEstimate& row = choice.estimates.emplace_back();
        row.strategy = name;
        row.available = std::ranges::find(available, name) != available.end();
        for (const Round& round : rounds) {
            const TermValues parts = estimate(round, *costs, device.subgroupSize);
            std::ranges::transform(row.parts, parts, row.parts.begin(), std::plus());
        }
        row.ms = std::accumulate(row.parts.begin(), row.parts.end(), 0.0);
        if (row.available &&
            (best == nullptr ||
             isBetterChoice({row.strategy, row.ms}, {best->strategy, best->ms}, choice.facts.cases))) {
            best = &row;
        }
    }
    if (best == nullptr) {
        return std::nullopt;
    }
    choice.strategy = best->strategy;
    explain(choice);
    return choice;
}

}  // namespace glint::compiler
