// Integrals over unit squares by stratified points, with an estimate of their error.
#pragma once

#include "oracle/vectors.h"

#include <cstdint>
#include <functional>

namespace glint::oracle {

// Numbers in [0, 1) that depend on the seed alone: SplitMix64 (Steele, Lea and Flood 2014).
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
    // Mean of the function's square: a single random point has the variance square - mean².
    Vec3 square{0.0};
};

// Points of a square: `strata` × `strata` cells with a point at random in each, `repeats` times over. The
// means of the repeats are independent, and their spread is the error. A function that is smooth within cells
// has an error that falls as strata⁻², one with edges as strata^-1.5.
struct Strata {
    int strata = 16;
    int repeats = 4;  // at least 2
};

Estimate average(const Strata& strata, Random& random, const std::function<Vec3(Vec2)>& f);

// The same of a function that is itself an estimate at each point. Its own errors are part of the spread.
Estimate averageOfEstimates(const Strata& strata, Random& random, const std::function<Estimate(Vec2)>& f);

// A direction about z with a density of cosine / π, of a point of the unit square: Malley's method.
Vec3 cosineDirection(Vec2 point);
// A direction about z, uniform over the cap of that half angle.
Vec3 capDirection(Vec2 point, double halfAngle);

}  // namespace glint::oracle
