#include "plan/strategy_cost.h"

#include <glint/measure/statistics.h>
#include <glint/measure/strategy_fit.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace glint::measure {

namespace {

// A point, with the values that the model needs.
struct Sample {
    std::string name;
    std::string group;  // the same for points that differ in their rays alone
    compiler::TermValues terms{};
    std::map<std::string, double, std::less<>> ms;  // by strategy
};

std::string nameOf(const CalibrationPoint& point) {
    return fmt::format("{} case{}, {}, {}, {:.0f} rays", point.cases, point.cases == 1 ? "" : "s", point.cost,
                       point.coherence, point.rays);
}

bool isShare(double value) {
    return value >= 0.0 && value <= 1.0;  // a value that is not a number fails both tests
}

// Returns why a point can't be used, or an empty text if it can.
std::string whyUnusable(const CalibrationPoint& point) {
    if (!std::isfinite(point.rays) || point.rays <= 0.0) {
        return "has no rays";
    }
    // Measured hits can be less alike than random ones are on average.
    if (!isShare(point.hitShare) || !(std::abs(point.coherentShare) <= 1.0)) {
        return "has a share that is not from 0 to 1";
    }
    if (point.work.empty()) {
        return "has no cases";
    }
    const bool worksOut = std::ranges::all_of(point.work, [](const CaseWork& work) {
        return isShare(work.share) && std::isfinite(work.instructions) && work.instructions >= 0.0 &&
               std::isfinite(work.fetches) && work.fetches >= 0.0;
    });
    return worksOut ? "" : "has a case whose share or code is out of range";
}

std::vector<Sample> samplesOf(std::span<const CalibrationPoint> points, double subgroupSize,
                              std::vector<std::string>& omitted) {
    std::vector<Sample> samples;
    for (const CalibrationPoint& point : points) {
        if (const std::string why = whyUnusable(point); !why.empty()) {
            omitted.push_back(fmt::format("the point {} {}", nameOf(point), why));
            continue;
        }
        Sample sample;
        sample.name = nameOf(point);
        sample.group = fmt::format("{} {} {}", point.cases, point.cost, point.coherence);
        sample.terms = termsOf(roundOf(point), subgroupSize);
        for (const StrategyTime& time : point.times) {
            const bool known = std::ranges::find(compiler::simplestFirst(), time.strategy) !=
                               compiler::simplestFirst().end();
            if (known && std::isfinite(time.ms) && time.ms > 0.0) {
                sample.ms[time.strategy] = time.ms;
            } else {
                omitted.push_back(fmt::format("the time of {} at the point {} is not one above 0",
                                              time.strategy, sample.name));
            }
        }
        samples.push_back(std::move(sample));
    }
    return samples;
}

using Samples = std::vector<const Sample*>;

// Returns the terms that the strategy has.
std::vector<compiler::CostTermInfo> termsOf(std::string_view strategy) {
    std::vector<compiler::CostTermInfo> terms;
    std::ranges::copy_if(compiler::costTerms(), std::back_inserter(terms),
                         [&](const compiler::CostTermInfo& info) { return hasTerm(strategy, info.term); });
    return terms;
}

// Each row is divided by the measured time, so that the error of a quick point counts as much as that of a
// slow one.
std::optional<compiler::StrategyCosts> fitOne(std::string_view strategy, const Samples& samples) {
    const std::vector<compiler::CostTermInfo> terms = termsOf(strategy);
    std::vector<std::vector<double>> rows;
    for (const Sample* const sample : samples) {
        const auto time = sample->ms.find(strategy);
        if (time == sample->ms.end()) {
            continue;
        }
        std::vector<double>& row = rows.emplace_back();
        for (const compiler::CostTermInfo& info : terms) {
            row.push_back(sample->terms[static_cast<std::size_t>(info.term)] * info.milliseconds /
                          time->second);
        }
    }
    if (rows.size() < std::max<std::size_t>(terms.size(), 2)) {
        return std::nullopt;
    }
    const std::vector<double> ones(rows.size(), 1.0);
    const std::optional<std::vector<double>> x = nonNegativeLeastSquares(rows, ones, terms.size());
    if (!x) {
        return std::nullopt;
    }
    compiler::StrategyCosts costs;
    costs.strategy = strategy;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        costs.constants[static_cast<std::size_t>(terms[i].term)] = (*x)[i];
    }
    return costs;
}

double estimateOf(const Sample& sample, const compiler::StrategyCosts& costs) {
    double ms = 0.0;
    for (const compiler::CostTermInfo& info : compiler::costTerms()) {
        const auto i = static_cast<std::size_t>(info.term);
        ms += sample.terms[i] * costs.constants[i] * info.milliseconds;
    }
    return ms;
}

// Estimates of every point, by strategy. The constants are fitted from the other groups, if there are any.
using Estimates = std::map<const Sample*, std::map<std::string, double, std::less<>>>;

Estimates estimateHeldOut(const std::vector<Sample>& samples, bool& held) {
    std::set<std::string> groups;
    for (const Sample& sample : samples) {
        groups.insert(sample.group);
    }
    held = groups.size() > 1;
    Estimates estimates;
    for (const std::string& group : groups) {
        Samples others;
        for (const Sample& sample : samples) {
            if (!held || sample.group != group) {
                others.push_back(&sample);
            }
        }
        for (const std::string_view strategy : compiler::simplestFirst()) {
            const std::optional<compiler::StrategyCosts> costs = fitOne(strategy, others);
            for (const Sample& sample : samples) {
                if (costs && sample.group == group && sample.ms.contains(strategy)) {
                    estimates[&sample][std::string(strategy)] = estimateOf(sample, *costs);
                }
            }
        }
    }
    return estimates;
}

StrategyQuality qualityOf(std::string_view strategy, const std::vector<Sample>& samples,
                          const Estimates& estimates) {
    StrategyQuality quality;
    quality.strategy = strategy;
    std::vector<double> errors;
    for (const Sample& sample : samples) {
        const auto own = estimates.find(&sample);
        const auto estimated =
            own == estimates.end() ? decltype(own->second.end()){} : own->second.find(strategy);
        if (own == estimates.end() || estimated == own->second.end()) {
            continue;
        }
        errors.push_back(std::abs(estimated->second / sample.ms.find(strategy)->second - 1.0));
        if (errors.back() >= quality.worstError) {
            quality.worstError = errors.back();
            quality.worstPoint = sample.name;
        }
    }
    quality.points = errors.size();
    quality.medianError = errors.empty() ? 0.0 : intervalOf(errors).median;
    return quality;
}

Regret regretOf(const std::vector<Sample>& samples, const Estimates& estimates) {
    constexpr double kLittle = 0.05;
    Regret regret;
    std::vector<double> losses;
    for (const Sample& sample : samples) {
        const auto own = estimates.find(&sample);
        if (own == estimates.end() || own->second.size() < 2) {
            continue;
        }
        // The loop follows the order in which a choice takes the first of several equal ones.
        std::string_view taken;
        std::string_view fastest;
        for (const std::string_view strategy : compiler::simplestFirst()) {
            const auto estimated = own->second.find(strategy);
            if (estimated == own->second.end()) {
                continue;
            }
            const auto cases =
                static_cast<std::size_t>(sample.terms[static_cast<std::size_t>(compiler::CostTerm::Cases)]);
            if (taken.empty() || compiler::isBetterChoice({strategy, estimated->second},
                                                          {taken, own->second.find(taken)->second}, cases)) {
                taken = strategy;
            }
            if (fastest.empty() || sample.ms.find(strategy)->second < sample.ms.find(fastest)->second) {
                fastest = strategy;
            }
        }
        losses.push_back(sample.ms.find(taken)->second / sample.ms.find(fastest)->second - 1.0);
        if (losses.back() >= regret.worst) {
            regret.worst = losses.back();
            regret.worstPoint = fmt::format("{}: {} taken, {} fastest", sample.name, taken, fastest);
        }
    }
    regret.points = losses.size();
    if (!losses.empty()) {
        regret.median = intervalOf(losses).median;
        const auto few = std::ranges::count_if(losses, [](double loss) { return loss <= kLittle; });
        regret.withinFivePercent = static_cast<double>(few) / static_cast<double>(losses.size());
    }
    return regret;
}

}  // namespace

compiler::Round roundOf(const CalibrationPoint& point) {
    // If there is one case, all hits are alike, wherever rays go.
    compiler::Round round{point.rays,
                          point.hitShare,
                          std::max(0.0, point.coherentShare),
                          point.coherence == "coherent" ? 0.0 : 1.0,
                          {}};
    for (const CaseWork& work : point.work) {
        round.cases.push_back({work.share, work.instructions, work.fetches});
    }
    return round;
}

DeviceFit fitStrategies(std::span<const CalibrationPoint> points, double subgroupSize) {
    DeviceFit fit;
    const std::vector<Sample> samples = samplesOf(points, subgroupSize, fit.omitted);
    Samples all;
    for (const Sample& sample : samples) {
        all.push_back(&sample);
    }
    const Estimates estimates = estimateHeldOut(samples, fit.quality.held);
    for (const std::string_view strategy : compiler::simplestFirst()) {
        const auto measured = static_cast<std::size_t>(std::ranges::count_if(
            samples, [&](const Sample& sample) { return sample.ms.contains(strategy); }));
        if (measured == 0) {
            fit.omitted.push_back(fmt::format("{} was not measured", strategy));
            continue;
        }
        std::optional<compiler::StrategyCosts> costs = fitOne(strategy, all);
        if (!costs) {
            fit.omitted.push_back(fmt::format("{} has {} usable points, and {} terms to find", strategy,
                                              measured, termsOf(strategy).size()));
            continue;
        }
        fit.strategies.push_back(std::move(*costs));
        fit.quality.strategies.push_back(qualityOf(strategy, samples, estimates));
    }
    fit.quality.regret = regretOf(samples, estimates);
    return fit;
}

}  // namespace glint::measure
