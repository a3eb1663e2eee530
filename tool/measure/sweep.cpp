#include "base/lists.h"

#include <glint/measure/sweep.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

namespace glint::measure {

namespace {

struct Pair {
    std::string_view first;
    std::string_view second;
    bool quick;
};

constexpr Pair kPairs[] = {
    // These trade noise against bias: the second setting saves time that buys samples.
    {"spp", "max-roughness", true},
    {"spp", "hit-lobes", false},
    {"spp", "texture-lod", false},
    {"spp", "clamp", false},
    {"spp", "ssr", false},
    {"spp", "mirror-roughness", false},
    {"spp", "shadow-spp", true},
    {"spp", "skip-below", false},
    // The rays of further effects bring more with each bounce.
    {"effects", "bounces", true},
    // The cost of each strategy depends on the number of shaders.
    {"strategy", "merge", true},
    {"strategy", "hit-lobes", false},
    {"strategy", "binning", false},
    {"strategy", "ordering", false},
    {"strategy", "position-fetch", true},
    {"strategy", "shadows", false},
    {"strategy", "batch-effects", false},
    // Rays of later bounces hit different shaders.
    {"strategy", "bounces", false},
    // Both settings leave out rays.
    {"max-roughness", "skip-below", false},
    {"max-roughness", "ssr", false},
};

const Setting* find(std::span<const Setting> settings, std::string_view name) {
    const auto found = std::ranges::find(settings, name, &Setting::name);
    return found == settings.end() ? nullptr : &*found;
}

// Every pair of values is too many if both settings have several, so of samples only the neighbours of the
// default are taken.
std::vector<std::string> pairValues(const Setting& setting, bool quick) {
    std::vector<std::string> values;
    if (quick && setting.name == "merge") {
        return {"all"};  // the value that differs most from the others
    }
    if (setting.name == "effects") {
        return hasExactValue(setting) ? std::vector{setting.exact} : values;
    }
    const auto own = std::ranges::find(setting.values, setting.base);
    const auto at = std::distance(setting.values.begin(), own);
    for (std::ptrdiff_t i = 0; i < std::ssize(setting.values); ++i) {
        const bool isNear = setting.name != "spp" || std::abs(i - at) <= (quick ? 1 : 2);
        if (i != at && isNear) {
            values.push_back(setting.values[static_cast<std::size_t>(i)]);
        }
    }
    return values;
}

// The effect of one value alone, compared with the default.
struct Step {
    std::string value;
    double ratio = 1.0;       // ratio of the times
    double difference = 0.0;  // difference of the errors
};

using Steps = std::map<std::string, std::vector<Step>, std::less<>>;  // by setting

Steps stepsOf(std::span<const Setting> settings, std::span<const Rated> measured) {
    Steps steps;
    for (const Setting& setting : settings) {
        steps[setting.name].push_back({setting.base, 1.0, 0.0});
    }
    const Rated& base = measured.front();
    for (const Rated& point : measured) {
        if (point.configuration.size() == 1) {
            const auto& [name, value] = *point.configuration.begin();
            steps[name].push_back({value, point.time / base.time, point.error - base.error});
        }
    }
    return steps;
}

// Returns the best of the configurations that change only time.
std::vector<Rated> fastestWays(std::span<const Setting> settings, std::span<const Rated> measured) {
    constexpr std::size_t kWays = 3;
    std::vector<Rated> ways;
    for (const Rated& point : measured) {
        const bool keepsError = std::ranges::none_of(point.configuration, [&](const auto& choice) {
            const Setting* const setting = find(settings, choice.first);
            return setting == nullptr || setting->approximates;
        });
        if (keepsError && (point.configuration.empty() || !point.timeTie)) {
            ways.push_back(point);
        }
    }
    std::ranges::stable_sort(ways, {}, &Rated::time);
    ways.resize(std::min(ways.size(), kWays));
    return ways;
}

std::vector<Rated> frontOf(std::vector<Rated> points) {
    return base::mapped<Rated>(paretoFront(points), [&](std::size_t i) { return std::move(points[i]); });
}

// Returns the front that the separable model predicts over all combinations of approximations, for one way of
// running them.
std::vector<Rated> predictedFront(std::span<const Setting> settings, const Steps& steps, const Rated& way) {
    std::vector<Rated> front{way};
    for (const Setting& setting : settings) {
        if (!setting.approximates) {
            continue;
        }
        std::vector<Rated> grown;
        for (const Rated& point : front) {
            for (const Step& step : steps.find(setting.name)->second) {
                const bool isIdle = step.ratio == 1.0 && step.difference == 0.0;
                if (isIdle && step.value != setting.base) {
                    continue;
                }
                Rated next = point;
                next.configuration[setting.name] = step.value;
                next.time *= step.ratio;
                next.error += step.difference;
                grown.push_back(std::move(next));
            }
        }
        front = frontOf(std::move(grown));
    }
    return front;
}

// Returns points of the measured front with one setting moved to the previous or next value.
std::vector<Rated> neighbours(std::span<const Setting> settings, const compiler::Configuration& base,
                              const Steps& steps, std::span<const Rated> measured) {
    std::vector<Rated> found;
    for (const std::size_t i : paretoFront(measured)) {
        for (const Setting& setting : settings) {
            const std::string& current = valueOf(setting.name, measured[i].configuration, base);
            const std::vector<Step>& known = steps.find(setting.name)->second;
            const auto here = std::ranges::find(known, current, &Step::value);
            const auto at = std::ranges::find(setting.values, current) - setting.values.begin();
            for (const std::ptrdiff_t next : {at - 1, at + 1}) {
                if (here == known.end() || next < 0 || next >= std::ssize(setting.values)) {
                    continue;
                }
                const std::string& value = setting.values[static_cast<std::size_t>(next)];
                const auto there = std::ranges::find(known, value, &Step::value);
                if (there == known.end()) {
                    continue;
                }
                if (there->ratio == here->ratio && there->difference == here->difference) {
                    continue;
                }
                Rated moved = measured[i];
                moved.configuration[setting.name] = value;
                moved.time *= there->ratio / here->ratio;
                moved.error += there->difference - here->difference;
                found.push_back(std::move(moved));
            }
        }
    }
    return found;
}

// Returns `count` of the sorted candidates, evenly spread, including both ends.
std::vector<compiler::Configuration> spread(const std::vector<Rated>& candidates, std::size_t count) {
    std::vector<compiler::Configuration> chosen;
    const std::size_t taken = std::min(count, candidates.size());
    for (std::size_t i = 0; i < taken; ++i) {
        const std::size_t at = taken == 1 ? 0 : i * (candidates.size() - 1) / (taken - 1);
        chosen.push_back(candidates[at].configuration);
    }
    return chosen;
}

bool isWithin(const Offer& offer, const Demand& demand) {
    return (!demand.time || offer.time.high <= *demand.time) &&
           (!demand.error || offer.error.high <= *demand.error);
}

}  // namespace

std::vector<compiler::Configuration> singles(std::span<const Setting> settings,
                                             const compiler::Configuration& base) {
    std::vector<compiler::Configuration> all;
    for (const Setting& setting : settings) {
        for (const std::string& value : setting.values) {
            compiler::Configuration one = simplified({{setting.name, value}}, base);
            if (!one.empty()) {
                all.push_back(std::move(one));
            }
        }
    }
    return all;
}

compiler::Configuration exactTogether(std::span<const Setting> settings,
                                      const compiler::Configuration& base) {
    compiler::Configuration all;
    for (const Setting& setting : settings) {
        if (hasExactValue(setting)) {
            all.emplace(setting.name, setting.exact);
        }
    }
    return simplified(all, base);
}

std::vector<compiler::Configuration> pairs(std::span<const Setting> settings,
                                           const compiler::Configuration& base, bool quick) {
    std::vector<compiler::Configuration> all;
    std::set<compiler::Configuration> known;
    for (const Pair& pair : kPairs) {
        const Setting* const first = find(settings, pair.first);
        const Setting* const second = find(settings, pair.second);
        if ((quick && !pair.quick) || first == nullptr || second == nullptr) {
            continue;
        }
        for (const std::string& a : pairValues(*first, quick)) {
            for (const std::string& b : pairValues(*second, quick)) {
                compiler::Configuration both = simplified({{first->name, a}, {second->name, b}}, base);
                if (both.size() == 2 && known.insert(both).second) {
                    all.push_back(std::move(both));
                }
            }
        }
    }
    return all;
}

std::vector<Rated> withTiesSettled(std::span<const Rated> points) {
    // A difference can be certain and still too small for anybody to care.
    constexpr double kNegligible = 0.01;
    const Rated& base = points.front();
    const auto isSame = [](double a, double b) { return std::abs(a - b) <= kNegligible * std::abs(b); };
    std::vector<Rated> settled(points.begin(), points.end());
    for (Rated& point : settled) {
        point.time = point.timeTie || isSame(point.time, base.time) ? base.time : point.time;
        point.error = point.errorTie || isSame(point.error, base.error) ? base.error : point.error;
    }
    return settled;
}

std::vector<std::size_t> paretoFront(std::span<const Rated> points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [points](std::size_t a, std::size_t b) {
        return std::pair(points[a].time, points[a].error) < std::pair(points[b].time, points[b].error);
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : order) {
        if (front.empty() || points[i].error < points[front.back()].error) {
            front.push_back(i);
        }
    }
    return front;
}

std::vector<compiler::Configuration> proposals(std::span<const Setting> settings,
                                               const compiler::Configuration& base,
                                               std::span<const Rated> points, std::size_t count) {
    const std::vector<Rated> measured = withTiesSettled(points);
    const Steps steps = stepsOf(settings, measured);
    std::vector<Rated> candidates = neighbours(settings, base, steps, measured);
    for (const Rated& way : fastestWays(settings, measured)) {
        std::ranges::move(predictedFront(settings, steps, way), std::back_inserter(candidates));
    }
    std::set<compiler::Configuration> known;
    for (const Rated& point : measured) {
        known.insert(point.configuration);
    }
    std::vector<Rated> promising;
    const std::vector<std::size_t> front = paretoFront(measured);
    for (Rated& candidate : candidates) {
        candidate.configuration = simplified(candidate.configuration, base);
        const bool isBeaten = std::ranges::any_of(front, [&](std::size_t i) {
            return measured[i].time <= candidate.time && measured[i].error <= candidate.error;
        });
        if (!isBeaten && known.insert(candidate.configuration).second) {
            promising.push_back(std::move(candidate));
        }
    }
    return spread(frontOf(std::move(promising)), count);
}

std::optional<std::size_t> advise(std::span<const Offer> offers, const Demand& demand) {
    const bool wantsError = demand.time.has_value();
    const auto first = [wantsError](const Offer& offer) -> const Interval& {
        return wantsError ? offer.error : offer.time;
    };
    const auto second = [wantsError](const Offer& offer) -> const Interval& {
        return wantsError ? offer.time : offer.error;
    };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        if (isWithin(offers[i], demand) && (!best || first(offers[i]).median < first(offers[*best]).median)) {
            best = i;
        }
    }
    if (!best) {
        return best;
    }
    std::size_t chosen = *best;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        const bool isTied = isWithin(offers[i], demand) && overlap(first(offers[i]), first(offers[*best]));
        if (isTied && second(offers[i]).median < second(offers[chosen]).median) {
            chosen = i;
        }
    }
    return chosen;
}

}  // namespace glint::measure
