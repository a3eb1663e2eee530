// Makes inputs of probes: random ones, and difficult ones.
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

// Returns values of named domains and writes them as floats. The seed decides the stream.
class InputSource {
public:
    explicit InputSource(std::uint64_t seed) : engine_(seed) {}

    // Writes the following values from `inputs` on, which must have room for them.
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

    // Returns a GGX alpha: log-uniform in [1e-4, 1], and both ends.
    double alpha();
    double roughness();
    // Returns a cosine in (0, 1]: uniform, log-uniform down to 1e-7, near 1 to 1e-8, and the ends.
    double cosine();
    // Returns any unit vector: uniform, near the poles, near the equator, or an axis.
    Vector direction();
    // Returns a unit vector whose z in (0, 1] comes from cosine().
    Vector upper();
    Vector lower();
    // Returns a normal about z whose sine is within some alphas of a lobe, from 1e-3 alpha to its far tail.
    Vector lobeNormal(double alpha);
    // Returns the light that `view` sees mirrored in lobeNormal(alpha), or upper() if that lies below the
    // horizon.
    Vector mirrored(const Vector& view, double alpha);
    // Returns the light that a facet of lobeNormal(alpha) refracts to `view`, or lower() if it refracts none.
    Vector refracted(const Vector& view, double alpha, double eta);
    // Returns n_t / n_i: an index or its inverse, which differs from 1 by at least leastStep, often by not
    // much more.
    double eta(double leastStep = 1e-7);
    // Returns a component of a colour: 0, 1 or random; with `bright`, up to 100.
    double colour(bool bright = false);
    // Returns an index of refraction that KHR_materials_ior allows: 0 or at least 1, such as 1 + 1e-7, common
    // ones and random ones.
    double ior();
    // Returns a random number of a sampler: [0, 1), with both ends.
    double sample();
    // Returns a coordinate: ±0, denormals, or 1e-6 to 1e5 of either sign.
    double coordinate();

private:
    std::mt19937_64 engine_;
    float* next_ = nullptr;
};

}  // namespace glint::numerics
