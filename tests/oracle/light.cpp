#include "oracle/light.h"

#include <algorithm>
#include <array>

namespace glint::oracle {
namespace {

double clampedArcCosine(double cosine) {
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// Returns the angle at C of the spherical triangle with sides a, b and c.
double angleOf(double a, double b, double c) {
    return clampedArcCosine((std::cos(c) - std::cos(a) * std::cos(b)) / (std::sin(a) * std::sin(b)));
}

}  // namespace

double LightCap::distanceAlong(const Vec3& toLight) const {
    if (centerDistance == kInfinity || radius == 0.0) {
        return centerDistance;
    }
    const double along = centerDistance * glm::dot(direction, toLight);
    const double across2 = std::max(centerDistance * centerDistance - along * along, 0.0);
    return along - std::sqrt(std::max(radius * radius - across2, 0.0));
}

LightCap lightCap(const gltf::Light& light, const LightSizes& sizes, const Vec3& position) {
    LightCap cap;
    if (light.type == gltf::LightType::Directional) {
        cap.direction = -toVec(light.direction);
        cap.halfAngle = 0.5 * sizes.sunDiameter;
        return cap;
    }
    const Vec3 toLight = toVec(light.position) - position;
    cap.centerDistance = glm::length(toLight);
    cap.direction = toLight / cap.centerDistance;
    cap.radius = sizes.radius;
    cap.halfAngle = std::asin(std::min(sizes.radius / cap.centerDistance, 1.0));
    return cap;
}

Vec3 irradianceFrom(const gltf::Light& light, const Vec3& position) {
    const Vec3 emitted = toVec(light.color) * static_cast<double>(light.intensity);
    if (light.type == gltf::LightType::Directional) {
        return emitted;
    }
    const Vec3 toLight = toVec(light.position) - position;
    const double distance = glm::length(toLight);
    double attenuation = 1.0 / (distance * distance);
    if (light.range > 0.0F) {
        attenuation *= std::clamp(1.0 - std::pow(distance / light.range, 4.0), 0.0, 1.0);
    }
    if (light.type == gltf::LightType::Spot) {
        const double cosine = glm::dot(toVec(light.direction), -toLight / distance);
        const double inner = std::cos(light.innerConeAngle);
        const double outer = std::cos(light.outerConeAngle);
        const double cone = std::clamp((cosine - outer) / std::max(inner - outer, 0.001), 0.0, 1.0);
        attenuation *= cone * cone;
    }
    return emitted * attenuation;
}

Estimate lightOfCap(const World& world, const LightCap& cap, const Vec3& position, const Scattered& scattered,
                    const Strata& strata, Random& random) {
    const glm::dmat3 frame = frameAbout(cap.direction);
    return average(strata, random, [&](Vec2 point) {
        const Vec3 direction = frame * capDirection(point, cap.halfAngle);
        const Vec3 light = scattered(direction) * cap.overFacing();
        const bool seen =
            light != Vec3(0.0) && world.visible({position, direction}, cap.distanceAlong(direction));
        return seen ? light : Vec3(0.0);
    });
}

Estimate irradianceOfCap(const World& world, const LightCap& cap, const Vec3& position, const Vec3& normal,
                         const Strata& strata, Random& random) {
    const auto cosine = [&](const Vec3& toLight) { return Vec3(std::max(glm::dot(normal, toLight), 0.0)); };
    return lightOfCap(world, cap, position, cosine, strata, random);
}

Vec3 vectorIrradiance(const Circle& first, const Circle& second) {
    const double a = first.halfAngle;
    const double b = second.halfAngle;
    const double apart = clampedArcCosine(glm::dot(first.axis, second.axis));
    if (apart >= a + b) {
        return Vec3(0.0);
    }
    if (apart <= std::abs(a - b)) {
        const Circle& inner = a < b ? first : second;
        return kPi * squared(std::sin(inner.halfAngle)) * inner.axis;
    }
    // The arc of a circle that is within the other; `half` is half of its azimuth.
    const auto arc = [](const Circle& circle, const Vec3& other, double half) {
        const Vec3 towards = glm::normalize(other - circle.axis * glm::dot(other, circle.axis));
        const double sine = std::sin(circle.halfAngle);
        return sine * (sine * half * circle.axis - std::cos(circle.halfAngle) * std::sin(half) * towards);
    };
    return arc(first, second.axis, angleOf(a, apart, b)) + arc(second, first.axis, angleOf(b, apart, a));
}

double irradianceAboveHorizon(const Circle& light, const Vec3& normal) {
    const Vec3 above = vectorIrradiance(light, {normal, 0.5 * kPi});
    return glm::dot(normal, above) / (kPi * squared(std::sin(light.halfAngle)));
}

double irradianceBesides(const Circle& light, const Circle& hiding, const Vec3& normal) {
    const Vec3 hidden = vectorIrradiance(light, hiding);
    return glm::dot(normal, light.axis - hidden / (kPi * squared(std::sin(light.halfAngle))));
}

double irradianceBesidesDisk(double halfAngle, double radius, double aside) {
    // On the plane at height 1, a direction of tangent r is hidden where a circle of radius r runs through
    // the disk.
    const auto hidden = [&](double tangent) {
        if (tangent <= radius - aside) {
            return 1.0;
        }
        if (tangent <= aside - radius || tangent >= aside + radius) {
            return 0.0;
        }
        const double cosine = (tangent * tangent + aside * aside - radius * radius) / (2.0 * tangent * aside);
        return clampedArcCosine(cosine) / kPi;
    };
    // The arc has roots at the ends of the interval in which it is partly hidden. So Simpson's rule is used
    // between them, with points that crowd there like those of Chebyshev.
    std::array<double, 4> ends{0.0, std::atan(std::abs(radius - aside)), std::atan(radius + aside),
                               halfAngle};
    constexpr int kSteps = 48;
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double from = std::min(ends[i], halfAngle);
        const double to = std::min(ends[i + 1], halfAngle);
        for (int step = 0; step <= kSteps; ++step) {
            const double phase = kPi * step / kSteps;
            const double angle = from + (to - from) * 0.5 * (1.0 - std::cos(phase));
            const double weight = step == 0 || step == kSteps ? 1.0 : (step % 2 == 1 ? 4.0 : 2.0);
            sum += weight * hidden(std::tan(angle)) * std::sin(2.0 * angle) * (to - from) * 0.5 *
                   std::sin(phase);
        }
    }
    return 1.0 - sum * kPi / (3.0 * kSteps) / squared(std::sin(halfAngle));
}

}  // namespace glint::oracle
