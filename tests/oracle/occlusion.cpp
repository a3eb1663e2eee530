#include "oracle/occlusion.h"

namespace glint::oracle {

Estimate openness(const World& world, const Vec3& position, const Vec3& normal,
                  const OcclusionSettings& settings, Faces faces, const Strata& strata, Random& random) {
    const glm::dmat3 frame = frameAbout(normal);
    const double farthest = settings.radius > 0.0 ? settings.radius : kInfinity;
    return average(strata, random, [&](Vec2 point) {
        const std::optional<Hit> hit =
            world.closest({position, frame * cosineDirection(point)}, faces, farthest);
        if (!hit) {
            return Vec3(1.0);
        }
        return Vec3(settings.linear ? hit->distance / settings.radius : 0.0);
    });
}

double opennessUnderSphere(const Vec3& position, const Vec3& normal, const Vec3& center, double radius) {
    const Vec3 toCenter = center - position;
    const double distance = glm::length(toCenter);
    return 1.0 - radius * radius * glm::dot(normal, toCenter) / (distance * distance * distance);
}

}  // namespace glint::oracle
