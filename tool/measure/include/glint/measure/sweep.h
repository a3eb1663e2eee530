// Chooses the configurations that a bench measures: each setting alone, then the pairs that matter, and then
// those that may be better than all before. Recommends one of them for a budget.
#pragma once

#include <glint/measure/settings.h>
#include <glint/measure/statistics.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::measure {

// Returns one configuration for each value of each setting that differs from the default.
std::vector<compiler::Configuration> singles(std::span<const Setting> settings,
                                             const compiler::Configuration& base);

// Returns the configuration in which every swept approximation has the reference's value.
compiler::Configuration exactTogether(std::span<const Setting> settings, const compiler::Configuration& base);

// Returns configurations that change two settings whose effects do not simply add up: for instance one that
// saves time beside the number of samples, or one that shares shaders beside how they are run. With `quick`
// there are fewer.
std::vector<compiler::Configuration> pairs(std::span<const Setting> settings,
                                           const compiler::Configuration& base, bool quick);

// A configuration with its time and its error.
struct Rated {
    compiler::Configuration configuration;
    double time = 0.0;   // any unit
    double error = 0.0;  // of a kind that adds up: relMSE, or squared RMSE
    // Set if the value can't be told from that of the default.
    bool timeTie = false;
    bool errorTie = false;
};

// Returns the points with ties settled: a point that is tied with the first one, the default, or within 1 %
// of it, gets its time or error. Otherwise noise would rank points that are equal.
std::vector<Rated> withTiesSettled(std::span<const Rated> points);

// Returns the Pareto front: the indices of points to which no other point is at least as good in both
// respects and better in one. They are sorted by time, the fastest first; of equal points the first is taken.
std::vector<std::size_t> paretoFront(std::span<const Rated> points);

// Returns at most `count` configurations that were not measured yet and may lie beyond the front of
// `measured`. The first of `measured` is the default, and all singles are among them. Two models predict
// where to look. In the first, times multiply and errors add over settings, starting from the default; as
// both are separable, a sweep over settings finds the front of all combinations exactly. In the second, one
// setting of each point of the measured front is changed to a neighbouring value, with the ratio and the
// difference that this value had alone.
std::vector<compiler::Configuration> proposals(std::span<const Setting> settings,
                                               const compiler::Configuration& base,
                                               std::span<const Rated> measured, std::size_t count);

// The measured time and error of a configuration.
struct Offer {
    Interval time;
    Interval error;
};

// The user's budget: at least one of the two is set.
struct Demand {
    std::optional<double> time;   // in the unit of the offers
    std::optional<double> error;  // in the unit of the offers
};

// Returns the index of the recommended offer. It returns nothing if no offer is certainly within the budget,
// that is, if no upper end of an interval is. With a budget of time it takes the least error, else the least
// time. Among offers that can't be told from the best (their intervals overlap) it takes the one that is
// better in the other respect.
std::optional<std::size_t> advise(std::span<const Offer> offers, const Demand& demand);

}  // namespace glint::measure
