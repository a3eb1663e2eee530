// The domains from which claims are put together.
#pragma once

#include "proofs.h"

#include <initializer_list>
#include <numbers>

namespace glint::numerics {

// Any float.
inline constexpr double kAny = verify::kLargestSingle;
// A share of 1, with the most that rounding adds to it.
inline constexpr double kOne = 1.0 + 1e-5;

// For claims about few numbers that so many boxes decide in a second.
inline constexpr std::uint64_t kManyBoxes = 20'000;

std::vector<Proof> bsdfProofs();
std::vector<Proof> hitProofs();

// Cosines above the horizon, down to kMinViewCosine.
inline verify::InputRange cosineInput(std::string name) {
    return {std::move(name), 1e-7F, 1.0, verify::Scale::Logarithmic};
}
// GGX alphas, from kMinAlpha.
inline verify::InputRange alphaInput(std::string name) {
    return {std::move(name), 1e-4F, 1.0, verify::Scale::Logarithmic};
}
// Alphas of sheen, from kMinSheenAlpha.
inline verify::InputRange sheenAlphaInput(std::string name) {
    return {std::move(name), 0.0049F, 1.0, verify::Scale::Logarithmic};
}
inline verify::InputRange shareInput(std::string name) {
    return {std::move(name), 0.0, 1.0, verify::Scale::Linear};
}
inline verify::InputRange rangeInput(std::string name, double low, double high) {
    return {std::move(name), low, high, verify::Scale::Linear};
}
// Random numbers in [0, 1).
inline verify::InputRange randomInput(std::string name) {
    return {std::move(name), 0.0, 0.99999994F, verify::Scale::Linear};
}

// A unit vector is its cosine to z, its azimuth, and an error of its length.
enum class Hemisphere { Upper, Whole };
inline std::vector<verify::InputRange> unitInput(const std::string& name, Hemisphere hemisphere) {
    constexpr double kTurn = static_cast<float>(std::numbers::pi);
    return {hemisphere == Hemisphere::Upper ? cosineInput(name + ".z") : rangeInput(name + ".z", -1.0, 1.0),
            rangeInput("azimuth of " + name, -kTurn, kTurn),
            {"length error of " + name, -2e-7F, 2e-7F, verify::Scale::Whole}};
}

inline std::vector<verify::InputRange> inputs(std::initializer_list<std::vector<verify::InputRange>> groups) {
    std::vector<verify::InputRange> all;
    for (const std::vector<verify::InputRange>& group : groups) {
        all.insert(all.end(), group.begin(), group.end());
    }
    return all;
}

}  // namespace glint::numerics
