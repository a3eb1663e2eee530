#include "oracle/spec/views.h"

#include "oracle/spec/directions.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

constexpr double kSpacing = 1000.0;
constexpr std::size_t kPlanesInRow = 6;
// 2π / φ², which never repeats.
constexpr double kGoldenAngle = 2.39996322972865332;

}  // namespace

Plane planeOf(std::size_t row) {
    const auto along = [](std::size_t index) { return kSpacing * (static_cast<double>(index) - 2.5); };
    Plane plane;
    plane.center = {along(row % kPlanesInRow), along(row / kPlanesInRow % kPlanesInRow),
                    along(row / (kPlanesInRow * kPlanesInRow))};
    const auto index = static_cast<double>(row);
    const double tilt = 0.7 * std::sqrt(std::fmod(0.61803398875 * index + 0.3, 1.0));
    const Vec3 z = polarDirection(std::cos(tilt), kGoldenAngle * index);
    const glm::dmat3 frame = oracle::frameAbout(Vec3(z.x, z.z, z.y));
    const double turn = 1.7 * index;
    plane.frame = {std::cos(turn) * frame[0] + std::sin(turn) * frame[1],
                   std::cos(turn) * frame[1] - std::sin(turn) * frame[0], frame[2]};
    return plane;
}

std::vector<View> viewsOf(bool many) {
    if (!many) {
        return {{polarDirection(0.9, 0.5), Zone::Steep},
                {polarDirection(0.5, 2.6), Zone::Middle},
                {polarDirection(0.2, -0.4), Zone::Grazing}};
    }
    return {{polarDirection(0.97, 0.5), Zone::Steep},    {polarDirection(0.8, 2.9), Zone::Steep},
            {polarDirection(0.6, 1.1), Zone::Middle},    {polarDirection(0.4, -1.3), Zone::Middle},
            {polarDirection(0.25, -0.4), Zone::Grazing}, {polarDirection(0.12, 4.0), Zone::Grazing}};
}

bool faces(const Material& material, const View& view) {
    return glm::dot(material.normal, view.local) > 0.05 &&
           glm::dot(material.clearcoatNormal, view.local) > 0.05;
}

std::vector<Light> lightsOfScene() {
    const auto light = [](const Vec3& towards, const Vec3& irradiance) {
        return Light{glm::normalize(towards), irradiance};
    };
    return {light({0.1, 1.0, 0.2}, {2.0, 1.8, 1.5}),   light({0.9, 0.7, -0.3}, {1.0, 1.4, 0.6}),
            light({-0.8, 0.5, 0.6}, {0.5, 0.9, 2.0}),  light({-0.2, 0.4, -0.9}, {1.2, 0.4, 0.9}),
            light({0.5, 0.3, 0.8}, {0.8, 0.8, 0.8}),   light({0.2, -0.9, 0.1}, {1.0, 2.0, 3.0}),
            light({-0.7, -0.4, 0.3}, {2.0, 1.0, 0.5}), light({0.4, -0.5, -0.8}, {0.7, 0.7, 1.5})};
}

Vec3 radianceOf(MapKind kind, const Vec3& d) {
    if (kind == MapKind::White) {
        return Vec3(1.0);
    }
    const Vec3 smooth(0.9 + 0.5 * d.x + 0.3 * d.y * d.z, 0.8 + 0.6 * d.y - 0.2 * d.x * d.z,
                      0.7 - 0.5 * d.z + 0.15 * d.x * d.y);
    if (kind == MapKind::Smooth) {
        return smooth;
    }
    // From the full brightness at 8° to none at 12°.
    const double angle =
        std::acos(std::clamp(glm::dot(d, glm::normalize(Vec3(0.35, 0.85, -0.4))), -1.0, 1.0));
    const double edge = std::clamp((12.0 - angle * 180.0 / kPi) / 4.0, 0.0, 1.0);
    return 0.4 * smooth + Vec3(26.0, 22.0, 16.0) * (edge * edge * (3.0 - 2.0 * edge));
}

}  // namespace glint::spec
