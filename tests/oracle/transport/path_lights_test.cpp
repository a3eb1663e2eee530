// Tests the lights that paths choose from: their densities are those of their samples.
#include "oracle/transport/path_scene.h"

namespace {

using namespace glint;
using namespace glint::oracle;

Vec3 cube(Random& random) {
    const double x = random.next();
    const double y = random.next();
    return {x, y, random.next()};
}

LinearImage map() {
    LinearImage image{16, 8, {}};
    for (std::uint32_t i = 0; i < 16 * 8; ++i) {
        const float value = i == 37 ? 50.0F : 0.2F * static_cast<float>(i % 5);
        image.pixels.push_back({value, 0.5F * value, 0.1F, 1.0F});
    }
    return image;
}

// A map and a gradient, whose integral over all directions is found by their own samples and by uniform ones.
TEST(PathLights, TheSkysDensityIsThatOfItsSamples) {
    for (const bool mapped : {true, false}) {
        const PathSky sky = mapped ? PathSky(map()) : PathSky(GradientSky{Vec3(2.0), Vec3(1.0), Vec3(0.5)});
        Random random(5);
        Estimate own = average({64, 4}, random, [&](Vec2 point) {
            const Vec3 direction = sky.sample({random.next(), point.x, point.y});
            EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
            return sky.radiance(direction) / sky.density(direction);
        });
        Estimate uniform = average({200, 4}, random, [&](Vec2 point) {
            const double height = 1.0 - 2.0 * point.x;
            const double across = std::sqrt(1.0 - height * height);
            const double angle = 2.0 * kPi * point.y;
            const Vec3 direction(across * std::cos(angle), height, across * std::sin(angle));
            return Vec3(sky.radiance(direction).x, sky.density(direction), 0.0) * (4.0 * kPi);
        });
        expectEstimate(own, uniform.mean.x, 0.02 * uniform.mean.x, 5.0 * uniform.error.x);
        EXPECT_NEAR(uniform.mean.y, 1.0, 5.0 * uniform.error.y + 1e-9) << "the density integrates to 1";
    }
}

// docs: u is the azimuth from +X towards +Z, with +X in the middle; the first row is the zenith.
TEST(PathLights, TheMapsTexelsAreWhereShadersReadThem) {
    LinearImage image{8, 4, std::vector<std::array<float, 4>>(32, {0.0F, 0.0F, 0.0F, 1.0F})};
    const auto light = [&](std::size_t texel, const Vec3& direction) {
        LinearImage lit = image;
        lit.pixels[texel] = {8.0F, 8.0F, 8.0F, 1.0F};
        return PathSky(lit).radiance(glm::normalize(direction)).x;
    };
    // The middle of the texels (4, 1) and (6, 2).
    EXPECT_NEAR(light(8 + 4, {std::cos(kPi / 8.0), std::tan(kPi / 8.0), std::sin(kPi / 8.0)}), 8.0, 1e-9);
    EXPECT_NEAR(light(16 + 6, {-std::sin(kPi / 8.0), -std::tan(kPi / 8.0), std::cos(kPi / 8.0)}), 8.0, 1e-9);
}

TEST(PathLights, TrianglesAreChosenByTheirDensity) {
    SceneFile file;
    file.addQuad(file.addMaterial(emissiveMaterial({1, 1, 1})), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    file.addQuad(file.addMaterial(diffuseMaterial()), {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    file.addQuad(file.addMaterial(emissiveMaterial({6, 6, 6})), {0, 0, 2}, {2, 0, 0}, {0, 1, 0});
    const gltf::Scene scene = file.import();
    const SceneGeometry geometry(scene, [](const SurfacePoint&) { return true; });
    const EmissiveTriangles lights(scene, geometry);
    std::vector<double> counts(geometry.triangleCount(), 0.0);
    Random random(9);
    constexpr int kDrawn = 100000;
    Vec3 middle(0.0);
    for (int i = 0; i < kDrawn; ++i) {
        const EmissiveTriangles::Place place = lights.sample(cube(random));
        counts[place.triangle] += 1.0 / kDrawn;
        middle += geometry.pointAt(place.triangle, place.u, place.v, {0, 0, 1}).position / double{kDrawn};
    }
    // 1 and 12, by area times radiance, two triangles each.
    const std::vector<double> shares{0.5 / 13.0, 0.5 / 13.0, 0.0, 0.0, 6.0 / 13.0, 6.0 / 13.0};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        EXPECT_NEAR(counts[i], shares[i], 0.008);
        const Triangle& triangle = geometry.triangle(static_cast<std::uint32_t>(i));
        const double area = 0.5 * glm::length(glm::cross(triangle.positions[1] - triangle.positions[0],
                                                         triangle.positions[2] - triangle.positions[0]));
        EXPECT_NEAR(lights.density(static_cast<std::uint32_t>(i)) * area, shares[i], 1e-12);
    }
    EXPECT_NEAR(glm::length(middle - Vec3((0.5 + 12.0) / 13.0, 0.5, 24.0 / 13.0)), 0.0, 0.01)
        << "uniform by area";
}

}  // namespace
