// Integrates over unit squares with stratified points, and estimates the error.
#pragma once

#include "oracle/vectors.h"

#include <cstdint>
#include <functional>

namespace glint::oracle {

// Returns numbers in [0, 1) that depend on the seed alone: SplitMix64 (Steele, Lea and Flood 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double next();

private:
    std::uint64_t state_;
};

// The mean of a function over a unit square.
struct Estimate {
    Vec3 mean{0.0};
    Vec3 error{0.0};  // standard error of the mean: one standard deviation
    // The mean of the function's square. A single random point has the variance square - mean².
    Vec3 square{0.0};
};

// The points of a square: `strata` × `strata` cells with a random point in each, `repeats` times. The means
// of the repeats are independent, and their spread gives the error. The error falls as strata⁻² for a
// function that is smooth within cells, and as strata^-1.5 for one with edges.
struct Strata {
    int strata = 16;
    int repeats = 4;  // at least 2
};

Estimate average(const Strata& strata, Random& random, const std::function<Vec3(Vec2)>& f);

// The same for a function that returns an estimate for each point. Its own errors are part of the spread.
Estimate averageOfEstimates(const Strata& strata, Random& random, const std::function<Estimate(Vec2)>& f);

// Returns a direction about z with the density cosine / π, for a point of the unit square: Malley's method.
Vec3 cosineDirection(Vec2 point);
// Returns a direction about z, uniform over the cap of that half angle.
Vec3 capDirection(Vec2 point, double halfAngle);

}  // namespace glint::oracle
