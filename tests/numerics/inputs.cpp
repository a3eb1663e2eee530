#include "inputs.h"

#include <algorithm>
#include <limits>

namespace glint::numerics {
namespace {

constexpr double kPi = std::numbers::pi;
// The largest float below 1.
constexpr double kBelowOne = 1.0 - 0x1p-24;

Vector fromCosine(double cosine, double phi) {
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

Vector fromSine(double sine, double phi) {
    return {sine * std::cos(phi), sine * std::sin(phi),
            std::sqrt(std::max(0.0, (1.0 - sine) * (1.0 + sine)))};
}

}  // namespace

double InputSource::uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
}

double InputSource::logUniform(double low, double high) {
    return low * std::exp(uniform() * std::log(high / low));
}

bool InputSource::chance(double probability) {
    return uniform() < probability;
}

double InputSource::pick(std::span<const double> values) {
    return values[engine_() % values.size()];
}

double InputSource::alpha() {
    return chance(0.1) ? pick({1e-4, 1.0, 0.5}) : logUniform(1e-4, 1.0);
}

double InputSource::roughness() {
    return std::sqrt(alpha());
}

double InputSource::cosine() {
    const double kind = uniform();
    if (kind < 0.4) {
        return std::max(uniform(), 1e-7);
    }
    if (kind < 0.7) {
        return logUniform(1e-7, 1.0);
    }
    if (kind < 0.95) {
        return 1.0 - logUniform(1e-8, 1.0) * (1.0 - 1e-7);
    }
    return pick({1.0, 1e-7, 0.5, kBelowOne});
}

Vector InputSource::direction() {
    if (chance(0.03)) {
        const double sign = pick({-1.0, 1.0});
        const double axis = pick({0.0, 1.0, 2.0});
        return {axis == 0.0 ? sign : 0.0, axis == 1.0 ? sign : -0.0, axis == 2.0 ? sign : 0.0};
    }
    if (chance(0.4)) {
        return fromCosine(uniform(-1.0, 1.0), uniform(0.0, 2.0 * kPi));
    }
    Vector v = chance(0.5) ? fromSine(logUniform(1e-9, 1.0), uniform(0.0, 2.0 * kPi))
                           : fromCosine(logUniform(1e-9, 1.0), uniform(0.0, 2.0 * kPi));
    v.z *= pick({-1.0, 1.0});
    return v;
}

Vector InputSource::upper() {
    const double phi = chance(0.1) ? pick({0.0, 0.5 * kPi, kPi}) : uniform(0.0, 2.0 * kPi);
    return chance(0.2) ? fromSine(logUniform(1e-9, 1.0) * kBelowOne, phi) : fromCosine(cosine(), phi);
}

Vector InputSource::lower() {
    Vector v = upper();
    v.z = -v.z;
    return v;
}

Vector InputSource::lobeNormal(double alpha) {
    if (chance(0.02)) {
        return {};
    }
    const double tangent = alpha * logUniform(1e-3, 1e3);
    return fromSine(tangent / std::sqrt(1.0 + tangent * tangent), uniform(0.0, 2.0 * kPi));
}

Vector InputSource::mirrored(const Vector& view, double alpha) {
    const Vector h = lobeNormal(alpha);
    const double twice = 2.0 * (view.x * h.x + view.y * h.y + view.z * h.z);
    const Vector light{twice * h.x - view.x, twice * h.y - view.y, twice * h.z - view.z};
    return light.z > 1e-7 ? light : upper();
}

Vector InputSource::refracted(const Vector& view, double alpha, double eta) {
    const Vector h = lobeNormal(alpha);
    const double cosine = view.x * h.x + view.y * h.y + view.z * h.z;
    const double squared = 1.0 - (1.0 - cosine) * (1.0 + cosine) / (eta * eta);
    const double along = cosine / eta - std::sqrt(std::max(squared, 0.0));
    const Vector light{along * h.x - view.x / eta, along * h.y - view.y / eta, along * h.z - view.z / eta};
    return squared > 0.0 && light.z < -1e-7 ? light : lower();
}

double InputSource::eta(double leastStep) {
    if (chance(0.1)) {
        return 1.0 + pick({-1.0, 1.0}) * logUniform(leastStep, 0.1);
    }
    const double index = std::max(ior(), 1.0 + leastStep);
    return chance(0.5) ? index : 1.0 / index;
}

double InputSource::colour(bool bright) {
    if (chance(0.3)) {
        return pick({0.0, 1.0, 0.04, kBelowOne});
    }
    return bright && chance(0.3) ? logUniform(1.0, 100.0) : uniform();
}

double InputSource::ior() {
    return chance(0.4) ? pick({0.0, 1.0, 1.0 + 0x1p-23, 1.0001, 1.33, 1.5, 2.42, 3.0}) : uniform(1.0, 3.0);
}

double InputSource::sample() {
    if (chance(0.05)) {
        return pick({0.0, kBelowOne, 0.5, 0x1p-24});
    }
    return uniform() * kBelowOne;
}

double InputSource::coordinate() {
    if (chance(0.05)) {
        return pick({0.0, -0.0, 1e-40, -1e-40, 1.0, -1.0});
    }
    return pick({-1.0, 1.0}) * logUniform(1e-6, 1e5);
}

}  // namespace glint::numerics
