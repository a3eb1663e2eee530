// Inputs of probes: random ones, and those that hurt.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>
#include <span>

namespace glint::numerics {

struct Vector {
    double x = 0.0;
    double y = 0.0;
    double z = 1.0;
};

// Hands out values of named domains and writes them as floats. A stream is fixed by its seed.
class InputSource {
public:
    explicit InputSource(std::uint64_t seed) : engine_(seed) {}

    // The values that follow are written from `inputs` on; it has room for them.
    void start(float* inputs) {
        next_ = inputs;
    }
    void put(double value) {
        *next_++ = static_cast<float>(value);
    }
    void put(const Vector& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }

    double uniform(double low = 0.0, double high = 1.0);
    double logUniform(double low, double high);
    bool chance(double probability);
    double pick(std::span<const double> values);
    double pick(std::initializer_list<double> values) {
        return pick(std::span<const double>(values.begin(), values.size()));
    }

    // GGX alpha: log-uniform in [1e-4, 1], and both ends.
    double alpha();
    double roughness();
    // In (0, 1]: uniform, log-uniform down to 1e-7, near 1 to 1e-8, and the ends.
    double cosine();
    // Any unit vector: uniform, near the poles, near the equator, the axes.
    Vector direction();
    // z in (0, 1] by cosine().
    Vector upper();
    Vector lower();
    // A normal about z whose sine is within some alphas of a lobe, from 1e-3 alpha to its far tail.
    Vector lobeNormal(double alpha);
    // The light that `view` sees mirrored in lobeNormal(alpha), or upper() where that lies below the horizon.
    Vector mirrored(const Vector& view, double alpha);
    // The light that a facet of lobeNormal(alpha) refracts to `view`, lower() where it refracts none.
    Vector refracted(const Vector& view, double alpha, double eta);
    // n_t / n_i: an index or its inverse, apart from 1 by leastStep, often not by much more.
    double eta(double leastStep = 1e-7);
    // A component of a colour: 0, 1 and random; with `bright`, up to 100.
    double colour(bool bright = false);
    // Index of refraction as KHR_materials_ior allows: 0 or at least 1, with 1 + 1e-7, common ones and
    // random.
    double ior();
    // A random number of a sampler: [0, 1), with both ends.
    double sample();
    // A coordinate: ±0, denormals, 1e-6 to 1e5 of either sign.
    double coordinate();

private:
    std::mt19937_64 engine_;
    float* next_ = nullptr;
};

}  // namespace glint::numerics
