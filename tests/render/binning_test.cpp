// Rays are sorted by direction within their workgroup. The list must stay complete, and the picture the same.
#include "render/scene_builder.h"
#include "render/traced_frame.h"
#include "support/effect_bits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr FrameOptions::Binning kBinnings[] = {FrameOptions::Binning::None, FrameOptions::Binning::Sign,
                                               FrameOptions::Binning::Octahedral};

// Returns mirrors that send rays in all directions, in front of unlit walls.
gltf::Scene mirrors() {
    gltf::Scene scene = sceneWithCamera();
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int wall = addMaterial(scene, unlitMaterial({0.8F, 0.3F, 0.2F}));
    addInstance(scene, addMesh(scene, makeSphere(mirror, {-1.0F, 0.2F, -2.5F}, 1.0F, 12)));
    addInstance(scene, addMesh(scene, makeSphere(mirror, {1.4F, 0.4F, -3.0F}, 0.9F, 7)));
    addQuad(scene, mirror, {-9, -1, 0}, {18, 0, 0}, {0, 0, -8});
    addQuad(scene, wall, {-9, -1, -8}, {18, 0, 0}, {0, 3, 0});
    addDirectionalLight(scene, {0, -1, 0}, 1.0F);
    return scene;
}

RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height) {
    return defaultSetup(scene, width, height);
}

// Expects that the list contains each pixel that sent a ray exactly once, and nothing else.
void expectWhole(const TracedFrame& frame) {
    std::set<std::uint32_t> pixels;
    for (const gpu::RayRecord& ray : frame.rays) {
        ASSERT_LT(ray.target, frame.paths.size());
        EXPECT_TRUE(pixels.insert(ray.target).second) << "pixel " << ray.target << " twice";
        EXPECT_TRUE(frame.paths[ray.target] == Renderer::PixelPath::Hit ||
                    frame.paths[ray.target] == Renderer::PixelPath::Miss);
        const gpu::vec3& d = ray.direction;
        EXPECT_NEAR(d.x * d.x + d.y * d.y + d.z * d.z, 1.0F, 1e-5F);
    }
    EXPECT_EQ(pixels.size(), frame.counters.rays);
}

std::array<double, 2> octahedral(const gpu::vec3& v) {
    const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    const double x = v.x / sum;
    const double y = v.y / sum;
    if (v.z >= 0.0F) {
        return {x, y};
    }
    return {std::copysign(1.0 - std::abs(y), x), std::copysign(1.0 - std::abs(x), y)};
}

// Returns the bin of a direction, or -1 if the rounding of another machine might put it into a neighbouring
// bin.
int binOf(const gpu::vec3& v, FrameOptions::Binning binning) {
    if (binning == FrameOptions::Binning::Sign) {
        return (v.x < 0.0F ? 1 : 0) + (v.y < 0.0F ? 2 : 0) + (v.z < 0.0F ? 4 : 0);
    }
    int bin = 0;
    int scale = 1;
    for (const double coordinate : octahedral(v)) {
        const double cell = 4.0 * coordinate + 4.0;
        if (std::abs(cell - std::round(cell)) < 1e-4) {
            return -1;
        }
        bin += scale * static_cast<int>(cell);
        scale *= 8;
    }
    return bin;
}

// Expects that the rays of a workgroup follow each other in the list, bin by bin. Returns the most bins of
// one workgroup.
std::size_t expectSorted(const TracedFrame& frame, FrameOptions::Binning binning, std::uint32_t width) {
    const std::uint32_t tilesAcross = (width + gpu::kPixelGroupSize - 1) / gpu::kPixelGroupSize;
    std::map<std::uint32_t, std::set<int>> binsOfTile;
    std::uint32_t tile = 0;
    int last = -1;
    for (std::size_t i = 0; i < frame.rays.size(); ++i) {
        const gpu::RayRecord& ray = frame.rays[i];
        const std::uint32_t own = ray.target % width / gpu::kPixelGroupSize +
                                  ray.target / width / gpu::kPixelGroupSize * tilesAcross;
        if (i == 0 || own != tile) {
            EXPECT_FALSE(binsOfTile.contains(own)) << "workgroup " << own << " is in two places";
            tile = own;
            last = -1;
        }
        const int bin = binOf(ray.direction, binning);
        if (bin >= 0) {
            EXPECT_GE(bin, last) << "ray " << i;
            last = bin;
        }
        binsOfTile[tile].insert(bin);
    }
    std::size_t most = 0;
    for (const auto& [number, bins] : binsOfTile) {
        most = std::max(most, bins.size());
    }
    return most;
}

TEST(RayBinning, TheListIsWholeAndSortedAtEverySize) {
    const gltf::Scene scene = mirrors();
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    constexpr std::array<std::uint32_t, 2> kSizes[] = {{65, 37}, {64, 40}, {7, 3}, {1, 1}, {9, 100}};
    for (const auto& [width, height] : kSizes) {
        LinearImage reference;
        for (const FrameOptions::Binning binning : kBinnings) {
            SCOPED_TRACE(::testing::Message()
                         << width << " x " << height << ", binning " << static_cast<std::uint32_t>(binning));
            RenderSetup setup = setupOf(scene, width, height);
            setup.frame.binning = binning;
            const TracedFrame frame = traceFrame(loaded, package::kStrategyUber, setup);
            ASSERT_FALSE(frame.image.pixels.empty());
            expectWhole(frame);
            if (binning != FrameOptions::Binning::None) {
                const std::size_t bins = expectSorted(frame, binning, width);
                // Otherwise nothing would be sorted.
                EXPECT_TRUE(width != 65 || bins > 3) << bins;
            }
            if (reference.pixels.empty()) {
                reference = frame.image;
            }
            EXPECT_EQ(frame.image.pixels, reference.pixels);
        }
    }
}

TEST(RayBinning, ChangesNothingOfAnyStrategy) {
    const gltf::Scene scene = mirrors();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyVisibility | package::kStrategySortedUber;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = setupOf(scene, 65, 37);
    setup.samples = 3;
    setup.frame.screenSteps = 24;
    LinearImage reference;
    for (const auto strategy : {package::kStrategyVisibility, package::kStrategySortedUber}) {
        for (const FrameOptions::Binning binning : kBinnings) {
            setup.frame.binning = binning;
            const TracedFrame frame = traceFrame(loaded, strategy, setup);
            ASSERT_FALSE(frame.image.pixels.empty());
            EXPECT_GT(frame.counters.of(package::kEffectReflection).screenHits, 0U);
            expectWhole(frame);
            if (reference.pixels.empty()) {
                reference = frame.image;
            }
            EXPECT_EQ(frame.image.pixels, reference.pixels);
        }
    }
}

TEST(RayBinning, NoRaysMakeAnEmptyList) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, unlitMaterial({0.2F, 0.4F, 0.6F}), {-0.5F, -0.5F, -1}, {1, 0, 0}, {0, 1, 0});
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    LinearImage reference;
    for (const FrameOptions::Binning binning : kBinnings) {
        RenderSetup setup = setupOf(scene, 65, 37);
        setup.frame.binning = binning;
        const TracedFrame frame = traceFrame(loaded, package::kStrategyVisibility, setup);
        ASSERT_FALSE(frame.image.pixels.empty());
        EXPECT_EQ(frame.counters.rays, 0U);
        if (reference.pixels.empty()) {
            reference = frame.image;
        }
        EXPECT_EQ(frame.image.pixels, reference.pixels);
    }
}

}  // namespace
