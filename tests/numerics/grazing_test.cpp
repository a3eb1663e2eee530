// Tests samples of the BSDF at grazing angles in single precision, in which shaders compute. Rounding leaves
// few digits of half vectors there.
#define GLINT_REAL float
#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION 1
#define PROBE(name) [[maybe_unused]] void probe##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "probes.inc"
}  // namespace
}  // namespace glsl

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

constexpr int kSamples = 100000;

// Weights of rare samples reach 1e3, where the lobe of light that facets scatter again is sampled by the
// cosine. If the density misses the peak of the microfacets, the same samples bring 1e13 and more.
constexpr float kMostWeight = 1e4F;

TEST(Grazing, SamplesOfWeakLobesDoNotBringThePeakOfSmoothOnes) {
    std::mt19937_64 engine(1);
    const auto uniform = [&] {
        return static_cast<float>(std::uniform_real_distribution<double>(0.0, 0.9999999)(engine));
    };
    for (const glsl::uint lobes : {0U, GLINT_TRANSMISSION | GLINT_VOLUME}) {
        const glsl::Features features{0U, 0U, 0xFFFFFFFFU, 0xFFFFFFFFU, 0U, 0U, 0U, lobes, 0U, 0U, 0U};
        glsl::Bsdf b{};
        b.base.alpha = glsl::vec2(glsl::kMinAlpha);
        b.base.f0 = glsl::vec3(0.04F);
        b.base.f90 = 1.0F;
        b.base.eta = glsl::vec3(1.5F);
        b.base.transmitted = glsl::vec3(lobes == 0U ? 0.0F : 0.9F);
        b.diffuse = glsl::vec3(lobes == 0U ? 0.9F : 0.0F);
        float largest = 0.0F;
        for (int i = 0; i < kSamples; ++i) {
            const float cosine = std::pow(10.0F, -7.0F * uniform());
            const float sine = std::sqrt(1.0F - cosine * cosine);
            const float turn = 6.2831853F * uniform();
            const glsl::vec3 view(sine * std::cos(turn), sine * std::sin(turn), cosine);
            glsl::prepareBsdf(b, features, glsl::normalize(view));
            const float x = uniform();
            const float y = uniform();
            const float weight = glsl::sampleBsdf(b, features, {x, y, uniform()}).weight.y;
            ASSERT_TRUE(std::isfinite(weight));
            largest = std::max(largest, weight);
        }
        EXPECT_LT(largest, kMostWeight) << "lobes " << lobes;
    }
}

}  // namespace
