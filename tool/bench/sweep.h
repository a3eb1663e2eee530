// Which configurations a bench measures: each setting alone, the pairs that matter, and then those that may
// be better than all before.
#pragma once

#include "bench/settings.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint::bench {

// Each value of each setting that is not that of the default, alone.
std::vector<Configuration> singles(std::span<const Setting> settings, const Configuration& base);

// Of two settings whose effects are no sum: what saves time beside fewer or more samples, what shares
// shaders beside how they are run, and so on. With `quick` fewer.
std::vector<Configuration> pairs(std::span<const Setting> settings, const Configuration& base, bool quick);

// A configuration with what it takes and how far off it is.
struct Rated {
    Configuration configuration;
    double time = 0.0;   // any unit
    double error = 0.0;  // of a kind that adds up: relMSE, squared RMSE
    // Whether it can't be told from the default's.
    bool timeTie = false;
    bool errorTie = false;
};

// With the time and the error of the first, the default, where a point is tied with it or within 1 %: else
// noise would decide which of the same things is better.
std::vector<Rated> withTiesSettled(std::span<const Rated> points);

// The Pareto front: indices of those to which no other is as good or better in both and better in one, from
// the fastest; of equal ones the first.
std::vector<std::size_t> paretoFront(std::span<const Rated> points);

// At most `count` configurations that were not measured yet and may reach beyond the front of `measured`,
// whose first is the default and which has every single. Two models say where to look. From the default,
// times multiply and errors add over settings: the front of all combinations under that model, which a sweep
// over settings finds exactly, as both are separable. From each point of the measured front, one setting is
// changed to a neighbouring value, with the ratio and the difference that it had alone.
std::vector<Configuration> proposals(std::span<const Setting> settings, const Configuration& base,
                                     std::span<const Rated> measured, std::size_t count);

}  // namespace glint::bench
