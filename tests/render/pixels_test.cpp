// Pictures whose pixels can be worked out on paper: orientation, colour, light, shadow, reflection, alpha,
// facing. Each holds for both strategies.
#include "context_state.h"
#include "render/harness.h"
#include "render/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace {

using namespace glint;
using namespace glint::testing;

using Pixel = std::array<float, 4>;

Pixel at(const LinearImage& image, std::uint32_t x, std::uint32_t y) {
    return image.pixels[static_cast<std::size_t>(y) * image.width + x];
}

void expectColor(const Pixel& pixel, Float3 expected, float tolerance, const char* where) {
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pixel[channel], expected[channel], tolerance) << where << ", channel " << channel;
    }
}

constexpr Float3 kRed{0.8F, 0.1F, 0.1F};
constexpr Float3 kGreen{0.1F, 0.7F, 0.1F};
constexpr Float3 kBlue{0.1F, 0.2F, 0.9F};

// A square picture by the camera of addCamera(); the sky is white, so that ambient light is easy to work out.
RenderSetup squareSetup(const Scene& scene) {
    RenderSetup setup = defaultSetup(scene, 32, 32);
    setup.frame.sky = {{1.0F, 1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}};
    return setup;
}

class Pixels : public ::testing::TestWithParam<package::Strategy> {
protected:
    LinearImage render(const Scene& scene, const RenderSetup& setup, AlphaPolicy alpha = AlphaPolicy::Opaque,
                       FrameCounters* counters = nullptr) {
        PlanOptions plan;
        plan.keys.alpha = alpha;
        plan.merge = MergePolicy::None;
        const LoadedScene loaded(scene, plan);
        return loaded.ok() ? loaded.render(GetParam(), setup, counters) : LinearImage{};
    }
};

INSTANTIATE_TEST_SUITE_P(Strategies, Pixels,
                         ::testing::Values(package::kStrategyUber, package::kStrategyVisibility),
                         [](const auto& strategy) {
                             return strategy.param == package::kStrategyUber ? "Uber" : "Visibility";
                         });

TEST_P(Pixels, AnEmptySceneShowsTheSkyUpright) {
    Scene scene = emptyScene();
    addCamera(scene);
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}};
    FrameCounters counters;
    const LinearImage image = render(scene, setup, AlphaPolicy::Opaque, &counters);
    ASSERT_FALSE(image.pixels.empty());
    EXPECT_EQ(counters.rays, 0U);
    EXPECT_EQ(counters.skippedSky, 32U * 32U);
    // Row 0 looks up by atan(31/32); the sky is linear in the sine.
    const float sine =
        (31.0F / 32.0F) / std::sqrt(1.0F + std::pow(31.0F / 32.0F, 2.0F) + std::pow(1.0F / 32.0F, 2.0F));
    expectColor(at(image, 16, 0), {0.0F, 0.0F, sine}, 1e-4F, "top");
    expectColor(at(image, 16, 31), {sine, 0.0F, 0.0F}, 1e-4F, "bottom");
}

TEST_P(Pixels, TextureStandsUpright) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
    // First row red, green; second row blue, white.
    material.texture(TextureSlot::BaseColor).texture =
        addTexture(scene, 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, material), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
    const LinearImage image = render(scene, squareSetup(scene));
    ASSERT_FALSE(image.pixels.empty());
    expectColor(at(image, 8, 8), {1, 0, 0}, 1e-5F, "top left");
    expectColor(at(image, 24, 8), {0, 1, 0}, 1e-5F, "top right");
    expectColor(at(image, 8, 24), {0, 0, 1}, 1e-5F, "bottom left");
    expectColor(at(image, 24, 24), {1, 1, 1}, 1e-5F, "bottom right");
}

TEST_P(Pixels, ColourTexturesAreSrgbAndBoundTexturesTransform) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
    TextureInfo& info = material.texture(TextureSlot::BaseColor);
    info.texture = addTexture(scene, 2, 1, {128, 128, 128, 255, 0, 0, 0, 255});
    // Offset by half the image: the black texel comes first.
    info.transform.offset = {0.5F, 0.0F};
    info.hasTransform = true;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, material), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
    const LinearImage image = render(scene, squareSetup(scene));
    ASSERT_FALSE(image.pixels.empty());
    expectColor(at(image, 8, 16), {0, 0, 0}, 1e-5F, "left");
    expectColor(at(image, 24, 16), {0.2158605F, 0.2158605F, 0.2158605F}, 1e-3F,
                "right: sRGB 128 in linear light");
}

// The colour that a mirror in front of the camera shows of what stands behind the camera.
TEST_P(Pixels, AMirrorShowsWhatIsBehindTheCamera) {
    Scene scene = emptyScene();
    addCamera(scene);
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int red = addMaterial(scene, unlitMaterial(kRed));
    const int blue = addMaterial(scene, unlitMaterial(kBlue));
    addInstance(scene, addMesh(scene, makeQuad(mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
    // Behind the camera, facing it: red above, blue below; right × up points to -Z.
    addInstance(scene, addMesh(scene, makeQuad(red, {9, 0, 3}, {-18, 0, 0}, {0, 9, 0})));
    addInstance(scene, addMesh(scene, makeQuad(blue, {9, -9, 3}, {-18, 0, 0}, {0, 9, 0})));
    addDirectionalLight(scene, {0, -1, 0}, 1.0F);
    FrameCounters counters;
    const LinearImage image = render(scene, squareSetup(scene), AlphaPolicy::Opaque, &counters);
    ASSERT_FALSE(image.pixels.empty());
    EXPECT_EQ(counters.rays, 32U * 32U);
    expectColor(at(image, 16, 4), kRed, 1e-4F, "above");
    expectColor(at(image, 16, 28), kBlue, 1e-4F, "below");
    if (GetParam() == package::kStrategyVisibility) {
        std::uint32_t sum = 0;
        for (const std::uint32_t count : counters.bucketCounts) {
            sum += count;
        }
        EXPECT_EQ(sum, counters.rays);
        EXPECT_EQ(counters.bucketCounts[0], 0U) << "no ray misses";
    }
}

TEST_P(Pixels, AMirrorThatSeesNothingShowsTheSky) {
    Scene scene = emptyScene();
    addCamera(scene);
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, mirrorMaterial()), {-1, -1, -1}, {2, 0, 0},
                                               {0, 2, 0})));
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {kGreen, kGreen, kGreen};
    const LinearImage image = render(scene, setup);
    ASSERT_FALSE(image.pixels.empty());
    expectColor(at(image, 16, 16), kGreen, 1e-4F, "centre");
}

// Of a diffuse surface: f0 = 0 by a metallic factor of 1 and black, plus emission, would hide the light, so
// this takes the dielectric BRDF at normal incidence: (1 - F) albedo / π + F D V with F = 0.04.
TEST_P(Pixels, DirectLightOnADiffuseWallIsAnalytic) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material material;
    material.metallicFactor = 0.0F;
    material.baseColorFactor = {0.5F, 0.5F, 0.5F, 1.0F};
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, material), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
    addDirectionalLight(scene, {0, 0, -1}, 2.0F);
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 33;  // a pixel in the middle, whose ray is the axis
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LinearImage image = render(scene, setup);
    ASSERT_FALSE(image.pixels.empty());
    // alpha = 1: D = 1/π, V = 1/4 at normal incidence.
    const float pi = std::numbers::pi_v<float>;
    const float expected = 2.0F * (0.96F * 0.5F / pi + 0.04F / pi * 0.25F);
    expectColor(at(image, 16, 16), {expected, expected, expected}, 1e-5F, "centre");
}

// What a diffuse wall at z = -1 sends along the axis under a light of `intensity` lux at normal incidence.
float wallRadiance(float irradiance) {
    const float pi = std::numbers::pi_v<float>;
    return irradiance * (0.96F * 0.5F / pi + 0.04F / pi * 0.25F);
}

float litWall(const Light& light,
              const std::function<LinearImage(const Scene&, const RenderSetup&)>& render) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material material;
    material.metallicFactor = 0.0F;
    material.baseColorFactor = {0.5F, 0.5F, 0.5F, 1.0F};
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, material), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
    scene.lights.push_back(light);
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 33;
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LinearImage image = render(scene, setup);
    return image.pixels.empty() ? -1.0F : at(image, 16, 16)[0];
}

TEST_P(Pixels, PunctualLightsFollowTheirExtension) {
    const auto toImage = [&](const Scene& scene, const RenderSetup& setup) { return render(scene, setup); };
    Light point;
    point.type = LightType::Point;
    point.intensity = 8.0F;
    point.position = {0.0F, 0.0F, 1.0F};  // 2 m from the wall
    EXPECT_NEAR(litWall(point, toImage), wallRadiance(8.0F / 4.0F), 1e-5F) << "inverse square";
    point.range = 4.0F;
    EXPECT_NEAR(litWall(point, toImage), wallRadiance(8.0F / 4.0F * (1.0F - 1.0F / 16.0F)), 1e-5F)
        << "window";
    point.range = 2.0F;
    EXPECT_NEAR(litWall(point, toImage), 0.0F, 1e-6F) << "at its range";

    Light spot = point;
    spot.range = 0.0F;
    spot.type = LightType::Spot;
    spot.direction = {0.0F, 0.0F, -1.0F};
    spot.innerConeAngle = 0.2F;
    spot.outerConeAngle = 0.6F;
    EXPECT_NEAR(litWall(spot, toImage), wallRadiance(2.0F), 1e-5F) << "inside the inner cone";
    spot.direction = {0.0F, std::sin(0.4F), -std::cos(0.4F)};
    const float cone = (std::cos(0.4F) - std::cos(0.6F)) / (std::cos(0.2F) - std::cos(0.6F));
    EXPECT_NEAR(litWall(spot, toImage), wallRadiance(2.0F * cone * cone), 1e-4F) << "between the cones";
    spot.direction = {0.0F, std::sin(0.7F), -std::cos(0.7F)};
    EXPECT_NEAR(litWall(spot, toImage), 0.0F, 1e-6F) << "outside";
}

// A hit takes one light by chance; over many samples it shows the sum of all, which a primary surface shows
// at once.
TEST_P(Pixels, TheChosenLightOfAHitIsUnbiased) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material white;
    white.metallicFactor = 0.0F;
    const int wall = addMaterial(scene, white);
    // Left half of the view: the wall behind the camera in a mirror. Right half: the same wall in front,
    // mirrored about the mirror's plane, so that both see it from the same distance and angle.
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, mirrorMaterial()), {-1, -1, -1}, {1, 0, 0},
                                               {0, 2, 0})));
    addInstance(scene, addMesh(scene, makeQuad(wall, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0})));
    addInstance(scene, addMesh(scene, makeQuad(wall, {0.001F, -9, -5}, {9, 0, 0}, {0, 18, 0})));
    // Two lights before each wall, mirrored likewise; their range ends before the other wall.
    Light light;
    light.type = LightType::Point;
    light.range = 5.0F;
    for (const float side : {-1.0F, 1.0F}) {
        light.intensity = 8.0F;
        light.position = {2.0F * side, 1.0F, -1.0F - 2.5F * side};
        scene.lights.push_back(light);
        light.intensity = 12.0F;
        light.position = {3.0F * side, -1.5F, -1.0F - 3.0F * side};
        scene.lights.push_back(light);
    }
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    setup.samples = 128;
    const LinearImage image = render(scene, setup);
    ASSERT_FALSE(image.pixels.empty());
    std::vector<double> ratios;
    for (std::uint32_t y = 8; y < 24; ++y) {
        for (std::uint32_t x = 4; x < 12; ++x) {
            ratios.push_back(at(image, x, y)[0] / at(image, 31 - x, y)[0]);
        }
    }
    // Jitter moves both halves the same way, so that pixels on a slope differ by up to 2 %; the lights' own
    // images in the mirror outshine a few.
    std::ranges::sort(ratios);
    EXPECT_NEAR(ratios[ratios.size() / 2], 1.0, 0.005);
    EXPECT_NEAR(ratios[ratios.size() / 20], 1.0, 0.02);
    EXPECT_NEAR(ratios[ratios.size() * 19 / 20], 1.0, 0.02);
}

// A wall lit by the sun with a plate between: the plate's shadow lies on the wall, in the picture and in a
// mirror.
Scene shadowScene(bool shadeInMirror, int plateMaterialKind) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material white;
    white.metallicFactor = 0.0F;
    const int wall = addMaterial(scene, white);
    Material plate = unlitMaterial(kRed);
    plate.doubleSided = true;
    if (plateMaterialKind == 1) {
        plate.alphaMode = AlphaMode::Mask;
        plate.baseColorFactor[3] = 0.0F;  // cut out entirely
    }
    const int plateMaterial = addMaterial(scene, plate);
    if (!shadeInMirror) {
        addInstance(scene, addMesh(scene, makeQuad(wall, {-4, -4, -2}, {8, 0, 0}, {0, 8, 0})));
        // Above the frustum's centre line, in the sun's way to the wall's middle.
        addInstance(scene, addMesh(scene, makeQuad(plateMaterial, {-1, 3, -1.0F}, {2, 0, 0}, {0, 0, -0.5F})));
        addDirectionalLight(scene, {0.0F, -0.9284767F, -0.3713907F}, 3.0F);
    } else {
        const int mirror = addMaterial(scene, mirrorMaterial());
        addInstance(scene, addMesh(scene, makeQuad(mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0})));
        addInstance(scene, addMesh(scene, makeQuad(wall, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0})));
        addInstance(scene, addMesh(scene, makeQuad(plateMaterial, {-1, 3, 1.5F}, {2, 0, 0}, {0, 0, 0.7F})));
        addDirectionalLight(scene, {0.0F, -0.9284767F, 0.3713907F}, 3.0F);
    }
    return scene;
}

TEST_P(Pixels, AShadowFallsOnAWall) {
    const Scene scene = shadowScene(false, 0);
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LinearImage image = render(scene, setup);
    ASSERT_FALSE(image.pixels.empty());
    // Plate at y = 3, z in [-1.5, -1]; the sun falls 2.5 for each 1 in -z: shadow on z = -2 at y in
    // [0.5, 1.75].
    expectColor(at(image, 16, 7), {0, 0, 0}, 1e-6F, "in the shadow, y = 1.06");
    EXPECT_GT(at(image, 16, 24)[1], 0.1F) << "below the shadow";
    EXPECT_GT(at(image, 2, 7)[1], 0.1F) << "beside the shadow";
}

TEST_P(Pixels, AReflectedSurfaceHasItsShadow) {
    const Scene scene = shadowScene(true, 0);
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LinearImage image = render(scene, setup);
    ASSERT_FALSE(image.pixels.empty());
    // Shadow on z = 3 at y in [3 - 2.5 * 1.5, 3 - 2.5 * 0.8] = [-0.75, 1]. The ray of row r meets z = 3 after
    // 5 units of depth in all: y = 5 p.
    expectColor(at(image, 16, 16), {0, 0, 0}, 1e-6F, "in the shadow, y = -0.16");
    EXPECT_GT(at(image, 16, 0)[1], 0.1F) << "above the shadow, past the plate";
    EXPECT_GT(at(image, 28, 16)[1], 0.1F) << "beside the shadow";
}

TEST_P(Pixels, AlphaIsTestedOrForcedOpaqueAsThePackageSays) {
    const Scene scene = shadowScene(true, 1);
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LinearImage opaque = render(scene, setup, AlphaPolicy::Opaque);
    const LinearImage tested = render(scene, setup, AlphaPolicy::Tested);
    ASSERT_FALSE(opaque.pixels.empty() || tested.pixels.empty());
    expectColor(at(opaque, 16, 16), {0, 0, 0}, 1e-6F, "opaque: the cut-out plate throws a shadow");
    EXPECT_GT(at(tested, 16, 16)[1], 0.1F) << "tested: it does not";
}

// A wall that faces away: invisible if single-sided, in the picture and in the mirror; visible if
// double-sided. The same under a mirroring transform, which must not turn it round.
class Facing : public ::testing::TestWithParam<std::tuple<package::Strategy, bool, bool>> {};

TEST_P(Facing, FollowsTheWindingInObjectSpace) {
    const auto [strategy, doubleSided, mirrored] = GetParam();
    for (const bool facesCamera : {false, true}) {
        Scene scene = emptyScene();
        addCamera(scene);
        Material red = unlitMaterial(kRed);
        red.doubleSided = doubleSided;
        const int wallMaterial = addMaterial(scene, red);
        const int mirror = addMaterial(scene, mirrorMaterial());
        // Left half of the view: the wall itself. Right half: a mirror that sees the wall behind the camera.
        const Float3 right = facesCamera ? Float3{8, 0, 0} : Float3{-8, 0, 0};
        const float x = facesCamera ? -8.0F : 0.0F;
        const float mirroredX = mirrored ? -x - right[0] : x;
        // Under a mirroring in x the same corners, mirrored beforehand, come back with the winding turned:
        // the front is by definition what it was in object space.
        const Float3 objectRight = right;
        addInstance(scene,
                    addMesh(scene, makeQuad(wallMaterial, {mirroredX, -4, -2}, objectRight, {0, 8, 0})),
                    scaling(mirrored ? -1.0 : 1.0, 1.0, 1.0));
        addInstance(scene, addMesh(scene, makeQuad(mirror, {0, -1, -1}, {1, 0, 0}, {0, 2, 0})));
        const Float3 behindRight = facesCamera ? Float3{-18, 0, 0} : Float3{18, 0, 0};
        const float behindX = facesCamera ? 9.0F : -9.0F;
        addInstance(scene, addMesh(scene, makeQuad(wallMaterial, {behindX, -9, 3}, behindRight, {0, 18, 0})),
                    scaling(mirrored ? -1.0 : 1.0, 1.0, 1.0));
        PlanOptions plan;
        const LoadedScene loaded(scene, plan);
        ASSERT_TRUE(loaded.ok());
        RenderSetup setup = squareSetup(scene);
        const LinearImage image = loaded.render(strategy, setup);
        ASSERT_FALSE(image.pixels.empty());
        const bool visible = facesCamera || doubleSided;
        const Float3 expected = visible ? kRed : Float3{1, 1, 1};
        expectColor(at(image, 8, 16), expected, 1e-4F, facesCamera ? "seen, front" : "seen, back");
        expectColor(at(image, 24, 16), expected, 1e-4F, facesCamera ? "mirrored, front" : "mirrored, back");
    }
}

INSTANTIATE_TEST_SUITE_P(All, Facing,
                         ::testing::Combine(::testing::Values(package::kStrategyUber,
                                                              package::kStrategyVisibility),
                                            ::testing::Bool(), ::testing::Bool()));

// A mesh split over several acceleration structures is the same mesh: triangles keep their vertices and
// materials.
TEST_P(Pixels, SplittingAMeshChangesNothing) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material textured = unlitMaterial({1.0F, 1.0F, 1.0F});
    textured.texture(TextureSlot::BaseColor).texture =
        addTexture(scene, 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
    const int picture = addMaterial(scene, textured);
    Mesh mesh;
    mesh.primitives = {
        makeQuad(addMaterial(scene, mirrorMaterial()), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}),
        makeQuad(picture, {9, 0, 3}, {-18, 0, 0}, {0, 9, 0}),
        makeQuad(addMaterial(scene, unlitMaterial(kBlue)), {9, -9, 3}, {-18, 0, 0}, {0, 9, 0})};
    scene.meshes.push_back(mesh);
    addInstance(scene, 0);
    const RenderSetup setup = squareSetup(scene);
    const LinearImage whole = render(scene, setup);
    auto& limits = sharedContext().state().limits.accelerationStructure;
    const auto before = limits.maxPrimitiveCount;
    limits.maxPrimitiveCount = 1;
    const LinearImage split = render(scene, setup);
    limits.maxPrimitiveCount = before;
    ASSERT_FALSE(whole.pixels.empty());
    EXPECT_EQ(whole.pixels, split.pixels);
}

TEST_P(Pixels, SamplesAverageAndSeedsRepeat) {
    Scene scene = emptyScene();
    addCamera(scene);
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, unlitMaterial(kRed)), {-0.5F, -0.5F, -1},
                                               {1, 0, 0}, {0, 1, 0})));
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 31;  // the quad's edge crosses pixels
    setup.samples = 16;
    const LinearImage once = render(scene, setup);
    const LinearImage again = render(scene, setup);
    ASSERT_FALSE(once.pixels.empty());
    EXPECT_EQ(once.pixels, again.pixels);
    // An edge pixel holds a mixture of quad and sky.
    const float edge = at(once, 7, 15)[1];
    EXPECT_GT(edge, kRed[1] + 0.05F);
    EXPECT_LT(edge, 0.95F);
    expectColor(at(once, 15, 15), kRed, 1e-5F, "inside");
}

}  // namespace
