// Materials for tests of the whole BSDF, as evaluateSurface() makes them: metal, diffuse and transmitted
// light share the energy.
#pragma once

#include "quadrature.h"
#include "shaders_double.h"

#include <algorithm>
#include <ostream>
#include <random>

namespace glint::numerics {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct TestMaterial {
    glsl::Bsdf bsdf{};
    glsl::uint lobes = 0;
    glsl::uint inputs = 0;

    glsl::Features features() const {
        return {0U, 0U, 0xFFFFFFFFU, 0xFFFFFFFFU, 0U, 0U, 0U, lobes, inputs, 0U, 0U};
    }
    bool has(glsl::uint lobe) const {
        return (lobes & lobe) != 0U;
    }
    // Returns the material with everything that follows from the view.
    TestMaterial seenFrom(const glm::dvec3& view) const {
        TestMaterial seen = *this;
        glsl::prepareBsdf(seen.bsdf, features(), view);
        return seen;
    }
    glm::dvec3 evaluate(const glm::dvec3& light) const {
        return glsl::evaluateBsdf(bsdf, features(), light);
    }
    double pdf(const glm::dvec3& light) const {
        return glsl::bsdfPdf(bsdf, features(), light);
    }
};

// Returns a black material whose other values are neutral.
[[maybe_unused]] TestMaterial makeMaterial(double alpha) {
    TestMaterial material;
    material.bsdf.base.f90 = 1.0;
    material.bsdf.base.alpha = glm::dvec2(alpha);
    material.bsdf.base.eta = glm::dvec3(1.5);
    material.bsdf.layers.clearcoat.alpha = 0.01;
    material.bsdf.layers.clearcoat.normal = {0.0, 0.0, 1.0};
    material.bsdf.layers.sheen.alpha = 0.25;
    return material;
}

using Engine = std::mt19937_64;

[[maybe_unused]] double uniform(Engine& engine, double low = 0.0, double high = 1.0) {
    return std::uniform_real_distribution<double>(low, high)(engine);
}

[[maybe_unused]] glm::dvec3 colour(Engine& engine) {
    const auto component = [&] { return uniform(engine) < 0.3 ? 1.0 : uniform(engine); };
    return {component(), component(), component()};
}

// Returns alpha from a roughness as artists set it, at least `leastAlpha`.
[[maybe_unused]] double randomAlpha(Engine& engine, double leastAlpha) {
    const double roughness = uniform(engine);
    return std::max(roughness * roughness, leastAlpha);
}

// Returns the alpha along the direction of anisotropy: KHR_materials_anisotropy.
[[maybe_unused]] double anisotropicAlpha(double alpha, double strength) {
    return alpha + (1.0 - alpha) * strength * strength;
}

// Returns a material with any combination of the lobes in `allowed`.
[[maybe_unused]] TestMaterial randomMaterial(Engine& engine, glsl::uint allowed, double leastAlpha = 1e-4) {
    TestMaterial material = makeMaterial(randomAlpha(engine, leastAlpha));
    glsl::Bsdf& b = material.bsdf;
    material.lobes = static_cast<glsl::uint>(engine()) & allowed;
    if (material.has(GLINT_ANISOTROPY)) {
        b.base.alpha.x = anisotropicAlpha(b.base.alpha.y, uniform(engine));
    }
    const double ior = uniform(engine) < 0.1 ? 1.0 : uniform(engine, 1.0, 3.0);
    const bool leaves = material.has(GLINT_VOLUME) && uniform(engine) < 0.4;
    const double spread = material.has(GLINT_DISPERSION) ? (ior - 1.0) * uniform(engine, 0.0, 0.05) : 0.0;
    const glm::dvec3 iors(ior - spread, ior, ior + spread);
    b.base.eta = leaves ? 1.0 / iors : iors;
    const double metal = uniform(engine) < 0.5 ? std::round(uniform(engine)) : uniform(engine);
    b.base.f0 = glm::dvec3(glsl::dielectricF0(ior));
    b.base.metalF0 = colour(engine);
    b.base.metallic = metal;
    if (metal == 1.0) {
        b.base.f0 = b.base.metalF0;
    } else if (metal > 0.0) {
        material.inputs = GLINT_PARTIAL_METAL;
    }
    const double transmission = material.has(GLINT_TRANSMISSION) ? uniform(engine) : 0.0;
    const double through = material.has(GLINT_DIFFUSE_TRANSMISSION) ? uniform(engine) : 0.0;
    const double dielectric = 1.0 - metal;
    b.base.transmitted = colour(engine) * (dielectric * transmission);
    b.diffuse = colour(engine) * (dielectric * (1.0 - transmission) * (1.0 - through));
    b.diffuseTransmitted = colour(engine) * (dielectric * (1.0 - transmission) * through);
    b.layers.clearcoat.factor = uniform(engine);
    b.layers.clearcoat.alpha = randomAlpha(engine, leastAlpha);
    b.layers.clearcoat.normal =
        direction(1.0 - 0.1 * uniform(engine) * uniform(engine), uniform(engine, 0.0, 2.0 * kPi));
    b.layers.sheen.color = colour(engine);
    b.layers.sheen.alpha = std::max(randomAlpha(engine, leastAlpha), glsl::kMinSheenAlpha);
    return material;
}

// Returns points where the material, seen from its view, has its mass.
[[maybe_unused]] Quadrature quadratureOf(const TestMaterial& material) {
    const glsl::Bsdf& b = material.bsdf;
    Quadrature quadrature(b.view);
    quadrature.addReflection(b.base.alpha);
    if (material.has(GLINT_CLEARCOAT)) {
        quadrature.addReflection(glm::dvec2(b.layers.clearcoat.alpha), b.layers.clearcoat.normal);
    }
    if (material.has(GLINT_TRANSMISSION)) {
        for (int channel = 0; channel < (material.has(GLINT_DISPERSION) ? 3 : 1); ++channel) {
            const double eta = material.has(GLINT_DISPERSION) ? b.base.eta[channel] : b.base.eta.y;
            const bool bends = material.has(GLINT_VOLUME) && glsl::refracts(eta);
            if (bends) {
                quadrature.addRefraction(b.base.alpha, eta);
            } else {
                quadrature.addThinTransmission(material.has(GLINT_VOLUME) ? glm::dvec2(glsl::kMinAlpha)
                                                                          : b.base.alpha);
            }
        }
    }
    return quadrature;
}

[[maybe_unused]] glm::dvec3 albedo(const TestMaterial& seen, int points) {
    return quadratureOf(seen).integrate([&](const glm::dvec3& light) { return seen.evaluate(light); },
                                        points);
}

[[maybe_unused]] double largestOf(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

[[maybe_unused]] std::ostream& operator<<(std::ostream& out, const TestMaterial& material) {
    const glsl::Bsdf& b = material.bsdf;
    const auto put = [&](const char* name, const glm::dvec3& v) {
        out << ", " << name << " (" << v.x << ", " << v.y << ", " << v.z << ")";
    };
    out << "lobes " << material.lobes << ", alpha (" << b.base.alpha.x << ", " << b.base.alpha.y << ")";
    put("f0", b.base.f0);
    if (material.inputs != 0U) {
        out << ", metal " << b.base.metallic;
        put("metal's f0", b.base.metalF0);
    }
    put("diffuse", b.diffuse);
    put("transmitted", b.base.transmitted);
    put("diffuse transmitted", b.diffuseTransmitted);
    put("eta", b.base.eta);
    out << ", coat " << b.layers.clearcoat.factor << " of alpha " << b.layers.clearcoat.alpha;
    put("coat's normal", b.layers.clearcoat.normal);
    put("sheen", b.layers.sheen.color);
    out << " of alpha " << b.layers.sheen.alpha;
    put("view", b.view);
    return out;
}

}  // namespace
}  // namespace glint::numerics
