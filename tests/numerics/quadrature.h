// Integrates functions of directions that may be as sharp as a mirror. Shares no code with the shaders.
#pragma once

#include <glm/glm.hpp>

#include <functional>
#include <vector>

namespace glint::numerics {

// Knows where a function of directions has its mass. Points are placed there and weighted by the sum of all
// densities (the balance heuristic of Veach 1997), so it converges for any function that is bounded by a
// multiple of that sum.
class Quadrature {
public:
    // The frame has the normal as z; view is a unit vector with z > 0.
    explicit Quadrature(const glm::dvec3& view) : view_(view) {}

    // Adds points around the mirror direction of GGX microfacets, about `normal`.
    void addReflection(const glm::dvec2& alpha, const glm::dvec3& normal = {0.0, 0.0, 1.0});
    // Adds the same, mirrored to the far side.
    void addThinTransmission(const glm::dvec2& alpha);
    // Adds points around the refracted direction; eta = n_t / n_i, which must not be 1.
    void addRefraction(const glm::dvec2& alpha, double eta);

    // Returns ∫ f over the sphere, with `points` points for each place and each hemisphere.
    glm::dvec3 integrate(const std::function<glm::dvec3(const glm::dvec3&)>& f, int points) const;

private:
    enum class Kind { Reflection, ThinTransmission, Refraction };
    struct Place {
        Kind kind = Kind::Reflection;
        glm::dvec2 alpha{1.0};
        double eta = 1.0;
        glm::dmat3 frame{1.0};  // columns: tangent, bitangent, normal
        glm::dvec3 view{0.0};   // in that frame
    };
    static double density(const Place& place, const glm::dvec3& light);
    static glm::dvec3 sample(const Place& place, double u1, double u2);
    double density(const glm::dvec3& light) const;

    glm::dvec3 view_;
    std::vector<Place> places_;
};

// Returns a direction from its cosine to z and its azimuth.
glm::dvec3 direction(double cosine, double phi);

}  // namespace glint::numerics
