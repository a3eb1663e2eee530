// Tests reflections found in screen space: where the march finds something, a ray would find the same, and
// where it finds nothing, the picture is that of rays.
#include "render/pixel_test.h"
#include "render/traced_frame.h"
#include "support/effect_bits.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kSize = 64;

void addBox(gltf::Scene& scene, int material, gltf::Float3 low, gltf::Float3 size) {
    const auto [x, y, z] = size;
    gltf::Mesh mesh;
    mesh.primitives = {makeQuad(material, {low[0], low[1], low[2] + z}, {x, 0, 0}, {0, y, 0}),       // front
                       makeQuad(material, {low[0] + x, low[1], low[2]}, {-x, 0, 0}, {0, y, 0}),      // back
                       makeQuad(material, {low[0], low[1] + y, low[2] + z}, {x, 0, 0}, {0, 0, -z}),  // top
                       makeQuad(material, {low[0], low[1], low[2]}, {x, 0, 0}, {0, 0, z}),           // bottom
                       makeQuad(material, {low[0] + x, low[1], low[2] + z}, {0, 0, -z}, {0, y, 0}),  // right
                       makeQuad(material, {low[0], low[1], low[2]}, {0, 0, z}, {0, y, 0})};          // left
    scene.meshes.push_back(std::move(mesh));
    addInstance(scene, static_cast<int>(scene.meshes.size()) - 1);
}

// Returns a mirror floor one metre below the camera that ends at a wall: blue below 2 m, green above.
gltf::Scene room() {
    gltf::Scene scene = sceneWithCamera();
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int blue = addMaterial(scene, unlitMaterial(kBlue));
    const int green = addMaterial(scene, unlitMaterial(kGreen));
    addQuad(scene, mirror, {-20, -1, 4}, {40, 0, 0}, {0, 0, -14});
    addQuad(scene, blue, {-20, -1, -10}, {40, 0, 0}, {0, 3, 0});
    addQuad(scene, green, {-20, 2, -10}, {40, 0, 0}, {0, 6, 0});
    addDirectionalLight(scene, {0, -1, 0}, 1.0F);
    return scene;
}

gltf::Scene roomWithBox() {
    gltf::Scene scene = room();
    addBox(scene, addMaterial(scene, unlitMaterial(kRed)), {-1.0F, -1.0F, -6.0F}, {2.0F, 1.5F, 1.0F});
    return scene;
}

RenderSetup withSteps(const gltf::Scene& scene, std::uint32_t steps) {
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = kSize;
    setup.frame.screenSteps = steps;
    return setup;
}

// With this many steps, each is shorter than a pixel even on the longest line of the picture.
constexpr std::uint32_t kEveryPixel = 2 * kSize;

double largestDifference(const Pixel& a, const Pixel& b) {
    double largest = 0.0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        // This also holds if one of them is not a number.
        const double difference = std::abs(static_cast<double>(a[channel]) - b[channel]);
        largest = difference <= largest ? largest : difference;
    }
    return largest;
}

// Expects that everything not found in screen space is the same as with rays only; what is found may differ
// at edges. Returns the share of the found pixels that agree.
double expectLikeRays(const TracedFrame& hybrid, const TracedFrame& rays) {
    EXPECT_EQ(hybrid.paths.size(), rays.paths.size());
    EXPECT_EQ(rays.counters.of(package::kEffectReflection).screenHits, 0U);
    EXPECT_EQ(hybrid.counters.rays + hybrid.counters.of(package::kEffectReflection).screenHits,
              rays.counters.rays);
    std::size_t found = 0;
    std::size_t agreeing = 0;
    for (std::size_t i = 0; i < hybrid.paths.size(); ++i) {
        const double difference = largestDifference(hybrid.image.pixels[i], rays.image.pixels[i]);
        if (hybrid.paths[i] != Renderer::PixelPath::Screen) {
            EXPECT_LE(difference, 1e-4) << "pixel " << i;
            EXPECT_EQ(hybrid.paths[i], rays.paths[i]) << "pixel " << i;
        } else {
            ++found;
            agreeing += difference <= 1e-4 ? 1U : 0U;
        }
    }
    return found == 0 ? 0.0 : static_cast<double>(agreeing) / static_cast<double>(found);
}

class ScreenSpace : public ::testing::TestWithParam<std::uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Steps, ScreenSpace, ::testing::Values(8U, 24U, kEveryPixel),
                         ::testing::PrintToStringParamName());

// The floor's pixels show what a camera two metres below, looking up through it, would see. The line of sight
// of row y meets the plane z = -d at the height -2 + d s, s = 2 (y + 1/2) / 64 - 1.
TEST_P(ScreenSpace, TheFloorShowsBoxAndWall) {
    const gltf::Scene scene = roomWithBox();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    const TracedFrame frame = traceFrame(loaded, package::kStrategyUber, withSteps(scene, GetParam()));
    ASSERT_FALSE(frame.image.pixels.empty());
    const struct {
        std::uint32_t x;
        std::uint32_t y;
        gltf::Float3 color;
        const char* what;
    } expected[] = {
        {32, 40, kRed, "the box's front, at -0.67 m"},
        {32, 53, kGreen, "the wall above the box, at 4.7 m"},
        {8, 38, kBlue, "the wall beside the box, at 0.03 m"},
    };
    for (const auto& pixel : expected) {
        expectColor(at(frame.image, pixel.x, pixel.y), pixel.color, 1e-4F, pixel.what);
        EXPECT_EQ(frame.paths[pixel.y * kSize + pixel.x], Renderer::PixelPath::Screen) << pixel.what;
    }
}

TEST_P(ScreenSpace, AgreesWithRays) {
    const gltf::Scene scene = roomWithBox();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    RenderSetup setups[] = {withSteps(scene, GetParam()), withSteps(scene, GetParam())};
    // The view is from above with parallel rays; the floor fills the lower half.
    CameraView& camera = setups[1].frame.camera;
    camera.position = {0.0F, 3.0F, 2.0F};
    camera.forward = {0.0F, -0.6F, -0.8F};
    camera.up = {0.0F, 0.8F, -0.6F};
    camera.orthographic = true;
    camera.halfHeight = camera.halfWidth = 5.0F;
    camera.near = 0.0F;
    camera.far = 50.0F;
    for (RenderSetup& setup : setups) {
        SCOPED_TRACE(setup.frame.camera.orthographic ? "orthographic" : "perspective");
        const TracedFrame hybrid = traceFrame(loaded, package::kStrategyUber, setup);
        const TracedFrame again = traceFrame(loaded, package::kStrategyUber, setup);
        setup.frame.screenSteps = 0;
        const TracedFrame rays = traceFrame(loaded, package::kStrategyUber, setup);
        ASSERT_FALSE(hybrid.image.pixels.empty());
        EXPECT_EQ(hybrid.image.pixels, again.image.pixels);
        EXPECT_EQ(hybrid.paths, again.paths);
        const double agreeing = expectLikeRays(hybrid, rays);
        RecordProperty("agreeing", std::to_string(agreeing));
        RecordProperty("found", std::to_string(hybrid.counters.of(package::kEffectReflection).screenHits));
        // Silhouettes within a pixel are a noticeable part of so small a picture, and coarse steps miss more
        // of them.
        EXPECT_GE(agreeing, GetParam() == 8 ? 0.9 : 0.95);
        EXPECT_GT(hybrid.counters.of(package::kEffectReflection).screenHits, rays.counters.rays / 10);
    }
}

// A slab hangs in front of a red panel that the camera can't see. The floor reflects the panel from below the
// slab.
TEST_P(ScreenSpace, WhatIsHiddenIsLeftToRays) {
    gltf::Scene scene = room();
    const int slab = addMaterial(scene, unlitMaterial({0.9F, 0.9F, 0.1F}));
    const int panel = addMaterial(scene, unlitMaterial(kRed));
    addBox(scene, slab, {-0.8F, 0.45F, -3.2F}, {1.6F, 0.75F, 0.2F});
    addQuad(scene, panel, {-1, 1, -6}, {2, 0, 0}, {0, 1.2F, 0});
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    for (const float thickness : {0.02F, 10.0F}) {
        RenderSetup setup = withSteps(scene, GetParam());
        setup.frame.screenThickness = thickness;
        const TracedFrame hybrid = traceFrame(loaded, package::kStrategyUber, setup);
        setup.frame.screenSteps = 0;
        const TracedFrame rays = traceFrame(loaded, package::kStrategyUber, setup);
        ASSERT_FALSE(hybrid.image.pixels.empty());
        EXPECT_GE(expectLikeRays(hybrid, rays), 0.95);
        // The pixel shows the panel at 1.5 m.
        expectColor(at(hybrid.image, 32, 50), kRed, 1e-4F, "panel");
        EXPECT_EQ(hybrid.paths[50 * kSize + 32], Renderer::PixelPath::Hit);
    }
}

// A convex mirror does not see itself, whatever its facets and normals are.
TEST_P(ScreenSpace, ASphereDoesNotReflectItself) {
    for (const int rows : {6, 40}) {
        gltf::Scene scene = sceneWithCamera();
        addInstance(scene, addMesh(scene, makeSphere(addMaterial(scene, mirrorMaterial()),
                                                     {0.1F, -0.2F, -2.0F}, 1.3F, rows)));
        const LoadedScene loaded(scene, compiler::PlanOptions{});
        RenderSetup setup = withSteps(scene, GetParam());
        setup.frame.screenThickness = 1.0F;
        setup.samples = 3;
        const TracedFrame frame = traceFrame(loaded, package::kStrategyUber, setup);
        ASSERT_FALSE(frame.image.pixels.empty());
        EXPECT_GT(frame.counters.rays, 1000U);
        EXPECT_EQ(frame.counters.of(package::kEffectReflection).screenHits, 0U) << rows << " rows";
    }
}

// Rays that the march has followed pixel by pixel start where it ends, on the same line. Other rays start
// where they would without it.
TEST_P(ScreenSpace, RaysStartWhereTheMarchEnds) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-20, -1, 4}, {40, 0, 0}, {0, 0, -14});
    addBox(scene, addMaterial(scene, unlitMaterial(kRed)), {-1.0F, 0.5F, -6.0F}, {2.0F, 1.5F, 1.0F});
    compiler::CompileSettings settings;
    settings.hitRecord = package::HitRecordFormat::Packed;
    settings.maxBounces = 2;  // rays then keep their origins, as frames have one bounce
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = withSteps(scene, GetParam());
    const TracedFrame hybrid = traceFrame(loaded, package::kStrategyVisibility, setup);
    setup.frame.screenSteps = 0;
    const TracedFrame rays = traceFrame(loaded, package::kStrategyVisibility, setup);
    ASSERT_FALSE(hybrid.image.pixels.empty());
    expectLikeRays(hybrid, rays);
    std::vector<gpu::RayRecord> whole(std::size_t{kSize} * kSize);
    for (const gpu::RayRecord& ray : rays.rays) {
        whole[ray.target] = ray;
    }
    std::size_t moved = 0;
    for (const gpu::RayRecord& ray : hybrid.rays) {
        const gpu::RayRecord& from = whole[ray.target];
        const gpu::vec3 step{ray.origin.x - from.origin.x, ray.origin.y - from.origin.y,
                             ray.origin.z - from.origin.z};
        const float distance = step.x * ray.direction.x + step.y * ray.direction.y + step.z * ray.direction.z;
        const float length = std::sqrt(step.x * step.x + step.y * step.y + step.z * step.z);
        // Both values are rounded.
        const float tolerance = 1e-5F * std::max(1.0F, length);
        EXPECT_NEAR(distance, length, tolerance);
        EXPECT_NEAR(ray.coneWidth, from.coneWidth + from.coneSpread * distance, tolerance);
        moved += distance > 0.01F ? 1U : 0U;
    }
    if (GetParam() == kEveryPixel) {
        EXPECT_GT(moved, hybrid.rays.size() / 2);
    } else {
        // Only rays whose line is shorter than the steps are followed pixel by pixel.
        EXPECT_LT(moved, hybrid.rays.size());
    }
}

// Samples of a pixel are off its centre, so depth and march must agree on where they are.
TEST(ScreenSpaceSamples, ConvergeToTheImageOfRays) {
    const gltf::Scene scene = roomWithBox();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    RenderSetup setup = withSteps(scene, kEveryPixel);
    setup.samples = 16;
    const TracedFrame hybrid = traceFrame(loaded, package::kStrategyUber, setup);
    setup.frame.screenSteps = 0;
    const TracedFrame rays = traceFrame(loaded, package::kStrategyUber, setup);
    ASSERT_FALSE(hybrid.image.pixels.empty());
    double sum = 0.0;
    for (std::size_t i = 0; i < hybrid.image.pixels.size(); ++i) {
        sum += largestDifference(hybrid.image.pixels[i], rays.image.pixels[i]);
    }
    // Only edges differ: colours differ by 0.8 at most.
    EXPECT_LE(sum / (kSize * kSize), 5e-3);
    EXPECT_GT(hybrid.counters.of(package::kEffectReflection).screenHits, 100U);
}

TEST(ScreenSpaceSamples, NoThicknessMeansRays) {
    const gltf::Scene scene = roomWithBox();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    RenderSetup setup = withSteps(scene, kEveryPixel);
    setup.frame.screenThickness = 0.0F;
    const TracedFrame hybrid = traceFrame(loaded, package::kStrategyUber, setup);
    setup.frame.screenSteps = 0;
    const TracedFrame rays = traceFrame(loaded, package::kStrategyUber, setup);
    ASSERT_FALSE(hybrid.image.pixels.empty());
    expectLikeRays(hybrid, rays);
    EXPECT_LT(hybrid.counters.of(package::kEffectReflection).screenHits, rays.counters.rays / 50);
}

}  // namespace
