#include "plan/frame_time.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace glint::compiler {

namespace {

MergeEstimate estimateOf(const FrameModel& model, std::span<const WeightedKey> keys,
                         const MergeCandidate& candidate) {
    MergeEstimate estimate;
    estimate.name = candidate.name;
    estimate.cases = candidate.cases.size();
    for (const CaseKeys& shaderCase : candidate.cases) {
        estimate.inVain += mergingCost(toSet(shaderCase.keys, keys));
    }
    estimate.ms.resize(model.strategies.size());
    for (const SceneRays& scene : model.scenes) {
        std::vector<KeySet> sets;
        sets.reserve(candidate.cases.size());
        for (const CaseKeys& shaderCase : candidate.cases) {
            sets.push_back(toSet(shaderCase.keys, scene.keys));
        }
        const std::vector<RoundCase> cases = roundCases(sets);
        const Round first{model.shape.pixels * kSurfaceShare, 1.0, kScreenCoherence, 0.0, cases};
        estimate.firstMs += firstHitsMs(first, model.device);
        std::vector<Round> rounds = scene.rounds;
        setCases(rounds, cases, model.shape);
        for (std::size_t i = 0; i < model.strategies.size(); ++i) {
            const StrategyCosts* const costs = findCosts(model.device, model.strategies[i]);
            for (const Round& round : rounds) {
                estimate.ms[i] +=
                    costs != nullptr ? estimatedMs(round, *costs, model.device.subgroupSize) : 0.0;
            }
        }
    }
    for (double& ms : estimate.ms) {
        ms += estimate.firstMs;
    }
    return estimate;
}

// Returns what decides about the estimates; less is better.
std::vector<double> ratesOf(const FrameModel& model, std::span<const MergeEstimate> estimates) {
    std::vector<double> rates(estimates.size(),
                              model.takesFastest ? std::numeric_limits<double>::max() : 0.0);
    for (std::size_t strategy = 0; strategy < model.strategies.size(); ++strategy) {
        if (findCosts(model.device, model.strategies[strategy]) == nullptr) {
            continue;
        }
        double best = std::numeric_limits<double>::max();
        for (const MergeEstimate& estimate : estimates) {
            best = std::min(best, estimate.ms[strategy]);
        }
        for (std::size_t i = 0; i < estimates.size(); ++i) {
            const double ms = estimates[i].ms[strategy];
            rates[i] = model.takesFastest
                           ? std::min(rates[i], ms)
                           : rates[i] + ms / std::max(best, std::numeric_limits<double>::min());
        }
    }
    return rates;
}

}  // namespace

std::vector<MergeEstimate> estimateMerges(const FrameModel& model, std::span<const WeightedKey> keys,
                                          std::span<const MergeCandidate> candidates) {
    std::vector<MergeEstimate> estimates;
    estimates.reserve(candidates.size());
    for (const MergeCandidate& candidate : candidates) {
        estimates.push_back(estimateOf(model, keys, candidate));
    }
    if (!estimates.empty()) {
        const std::vector<double> rates = ratesOf(model, estimates);
        const double most = (1.0 + kSameTime) * std::ranges::min(rates);
        const auto orderOf = [&](std::size_t i) {
            return std::tuple(rates[i] > most, estimates[i].cases, rates[i]);
        };
        std::size_t best = 0;
        for (std::size_t i = 1; i < estimates.size(); ++i) {
            best = orderOf(i) < orderOf(best) ? i : best;
        }
        estimates[best].chosen = true;
    }
    return estimates;
}

std::string describeChoice(std::span<const MergeEstimate> estimates, std::span<const std::string> strategies,
                           bool takesFastest) {
    const MergeEstimate& chosen = *std::ranges::find(estimates, true, &MergeEstimate::chosen);
    std::vector<std::string> times;
    for (std::size_t i = 0; i < strategies.size(); ++i) {
        const bool isFastest =
            std::ranges::min_element(chosen.ms) - chosen.ms.begin() == static_cast<std::ptrdiff_t>(i);
        if (takesFastest && !isFastest) {
            continue;
        }
        std::vector<std::string> others;
        for (const MergeEstimate& other : estimates) {
            if (!other.chosen) {
                others.push_back(fmt::format("{} {:.2f}", other.name, other.ms[i]));
            }
        }
        times.push_back(fmt::format("{:.2f} ms with {}{}", chosen.ms[i], strategies[i],
                                    others.empty() ? "" : fmt::format(" ({})", fmt::join(others, ", "))));
    }
    return fmt::format("--merge auto takes {} case{} ({}); first hits and rays should take {}", chosen.cases,
                       chosen.cases == 1 ? "" : "s", chosen.name, fmt::join(times, "; "));
}

}  // namespace glint::compiler
