// Tests ambient occlusion of a sphere over a plane, by the device and by the oracle.
#include "oracle/comparison.h"
#include "oracle/device.h"
#include "oracle/occlusion.h"
#include "oracle/scene_file.h"
#include "support/effect_bits.h"

namespace {

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kAmbientOcclusionWidth = 48;
constexpr std::uint32_t kAmbientOcclusionHeight = 27;
constexpr Vec3 kCenter(0.0, 0.6, 0.0);
constexpr double kRadius = 0.5;

// Returns a white sphere over a white floor. Under a sky of 1 each shows its openness.
gltf::Scene sphereOverFloor() {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial());
    file.addQuad(white, {-6, 0, 6}, {12, 0, 0}, {0, 0, -12});
    file.addSphere(white, kCenter, kRadius, 96);
    file.addCamera({0.3, 1.9, 2.0}, {0, 0.25, 0}, 40);
    file.addDarkness();
    return file.import();
}

class AmbientOcclusion : public ::testing::Test {
protected:
    AmbientOcclusion()
        : scene_(sphereOverFloor()),
          world_(scene_),
          view_(scene_.cameras.at(0), kAmbientOcclusionWidth, kAmbientOcclusionHeight) {}

    LinearImage render(const OcclusionSettings& settings, std::uint32_t raysPerSample = 1) {
        EffectOptions options;
        options.effects = package::kEffectAmbientOcclusion;
        options.occlusion = settings;
        options.occlusionRays = raysPerSample;
        return renderEffect(scene_, options,
                            setupOf(scene_, kAmbientOcclusionWidth, kAmbientOcclusionHeight,
                                    kAmbientOcclusionSamples / raysPerSample, kWhiteSky));
    }

    std::vector<PixelTruth> truths(const OcclusionSettings& settings) {
        return pixelTruths(
            view_, {6, 4}, [&](const Ray& ray) { return world_.closest(ray, Faces::Culled).has_value(); },
            [&](const Ray& ray, Random& random) {
                const Hit hit = *world_.closest(ray, Faces::Culled);
                return openness(world_, hit.position, hit.normal, settings, Faces::All, {3, 2}, random);
            });
    }

    static constexpr std::uint32_t kAmbientOcclusionSamples = 512;
    static constexpr GradientSky kWhiteSky{Vec3(1.0), Vec3(1.0), Vec3(1.0)};
    gltf::Scene scene_;
    World world_;
    View view_;
};

// Facets are inside the sphere by up to 1.3e-4 of its radius, and hide that much less. Near its own facets,
// the sphere's shading normal sees 1e-3 of what lies below.
constexpr double kFacets = 3e-4;

TEST_F(AmbientOcclusion, IsThatOfTheOracle) {
    const LinearImage image = render({});
    expectAgrees(image, truths({}),
                 {"ambient-occlusion", "a sphere over a floor, no limit", "quadrature", 1,
                  samplesOf(kAmbientOcclusionSamples), 1.0, kFacets});
    // The closed form covers the floor alone.
    const auto closed = pixelTruths(
        view_, {8, 4}, [&](const Ray& ray) { return world_.meetsGround(ray); },
        [&](const Ray& ray, Random&) {
            const Hit hit = *world_.closest(ray, Faces::Culled);
            const Vec3 value(opennessUnderSphere(hit.position, {0, 1, 0}, kCenter, kRadius));
            return Estimate{value, Vec3(0.0), value};
        });
    EXPECT_GT(closed.size(), 500U);
    expectAgrees(image, closed,
                 {"ambient-occlusion", "its floor", "1 - r² h / d³", 1, samplesOf(kAmbientOcclusionSamples),
                  1.0, kFacets});
}

TEST_F(AmbientOcclusion, WithinARadiusIsThatOfTheOracle) {
    for (const bool linear : {false, true}) {
        const OcclusionSettings settings{0.7, linear};
        const std::string what = linear ? "radius 0.7 m, falloff linear" : "radius 0.7 m, falloff none";
        expectAgrees(
            render(settings), truths(settings),
            {"ambient-occlusion", what, "quadrature", 1, samplesOf(kAmbientOcclusionSamples), 1.0, kFacets});
    }
}

TEST_F(AmbientOcclusion, ByFourRaysASampleIsTheSame) {
    expectAgrees(render({}, 4), truths({}),
                 {"ambient-occlusion", "four rays a sample", "quadrature", 1,
                  samplesOf(kAmbientOcclusionSamples), 1.0, kFacets});
}

}  // namespace
