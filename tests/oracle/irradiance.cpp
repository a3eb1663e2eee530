#include "oracle/irradiance.h"

#include <algorithm>
#include <array>

namespace glint::oracle {

Vec3 GradientSky::operator()(const Vec3& direction) const {
    return glm::mix(horizon, direction.y >= 0.0 ? zenith : ground, std::min(std::abs(direction.y), 1.0));
}

Estimate irradianceOverPi(const World& world, const Vec3& position, const Vec3& normal, Faces faces,
                          const HitRadiance& hitRadiance, const SkyRadiance& sky, const Strata& strata,
                          Random& random) {
    const glm::dmat3 frame = frameAbout(normal);
    return average(strata, random, [&](Vec2 point) {
        const Ray ray{position, frame * cosineDirection(point)};
        const std::optional<Hit> hit = world.closest(ray, faces);
        return hit ? hitRadiance(*hit, ray) : sky(ray.direction);
    });
}

double formFactorOfQuad(const Vec3& position, const Vec3& normal, const Vec3& corner, const Vec3& right,
                        const Vec3& up) {
    const std::array<Vec3, 4> corners{corner, corner + right, corner + right + up, corner + up};
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = glm::normalize(corners[i] - position);
        const Vec3 b = glm::normalize(corners[(i + 1) % corners.size()] - position);
        const Vec3 across = glm::cross(a, b);
        sum += std::atan2(glm::length(across), glm::dot(a, b)) * glm::dot(normal, glm::normalize(across));
    }
    return std::abs(sum) / (2.0 * kPi);
}

}  // namespace glint::oracle
