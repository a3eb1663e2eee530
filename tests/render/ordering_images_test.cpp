// A picture does not depend on how its hits were ordered.
#include "render/harness.h"
#include "render/rooms.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using package::Ordering;

class OrderingImages : public ::testing::TestWithParam<package::Strategy> {
protected:
    // Returns an empty image if rendering fails. Expects that the device finds the hits in order.
    static LinearImage renderChecked(const LoadedScene& loaded, const RenderSetup& setup, Ordering ordering,
                                     Renderer::Counters& counters) {
        LinearImage image =
            loaded.render(RendererOptions{.strategy = GetParam(), .ordering = ordering, .checkOrder = true},
                          setup, &counters);
        EXPECT_EQ(counters.orderErrors, 0U) << nameOf(ordering);
        return image;
    }
};

TEST_P(OrderingImages, AreTheSame) {
    const gltf::Scene scene = roomOfMaterials();
    compiler::CompileSettings settings;
    settings.strategies = GetParam();
    settings.plan.merge = compiler::MergePolicy::None;
    const LoadedScene loaded(scene, settings);
    // 77 x 45 pixels are not a whole number of workgroups.
    RenderSetup setup = defaultSetup(scene, 77, 45);
    setup.frame.maxReflectionRoughness = 1.0F;
    LinearImage reference;
    Renderer::Counters referenceCounters;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(Ordering::Count); ++i) {
        const auto ordering = static_cast<Ordering>(i);
        Renderer::Counters counters;
        const LinearImage image = renderChecked(loaded, setup, ordering, counters);
        EXPECT_EQ(std::accumulate(counters.bucketCounts.begin(), counters.bucketCounts.end(), 0U),
                  counters.rays)
            << nameOf(ordering);
        if (i == 0) {
            reference = image;
            referenceCounters = counters;
            EXPECT_GE(
                std::ranges::count_if(counters.bucketCounts, [](std::uint32_t count) { return count > 0; }),
                5)
                << "too few buckets to put in order";
        }
        EXPECT_EQ(counters.bucketCounts, referenceCounters.bucketCounts) << nameOf(ordering);
        expectSameImage(image, reference, std::string(nameOf(ordering)));
    }
}

// The check also runs without rays: every bucket must be empty.
TEST_P(OrderingImages, NeedNoRays) {
    const gltf::Scene scene = roomOfMaterials();
    compiler::CompileSettings settings;
    settings.strategies = GetParam();
    settings.plan.merge = compiler::MergePolicy::All;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = defaultSetup(scene, 16, 16);
    setup.frame.maxReflectionRoughness = -1.0F;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(Ordering::Count); ++i) {
        const auto ordering = static_cast<Ordering>(i);
        Renderer::Counters counters;
        const LinearImage image = renderChecked(loaded, setup, ordering, counters);
        EXPECT_EQ(counters.rays, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Strategies, OrderingImages,
                         ::testing::Values(package::kStrategyVisibility, package::kStrategySortedUber),
                         [](const ::testing::TestParamInfo<package::Strategy>& strategy) {
                             return strategy.param == package::kStrategyVisibility ? "Visibility"
                                                                                   : "SortedUber";
                         });

// Pixels are ordered by what they see, with keys of one or two bytes, and with more buckets than shared
// memory holds.
TEST(FirstHits, AreOrderedWhateverTheNumberOfBuckets) {
    const gltf::Scene scene = roomOfMaterials();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects = {false, 0};
    settings.plan.merge = compiler::MergePolicy::None;
    // 77 x 45 pixels are not a whole number of tiles.
    const RenderSetup setup = defaultSetup(scene, 77, 45);
    LinearImage reference;
    std::vector<std::uint32_t> expected;
    compiler::LockedIds ids;
    for (const int from : {0, 300, 1100}) {
        SCOPED_TRACE(from);
        settings.plan.lockedIds = ids;
        for (auto& [mask, id] : settings.plan.lockedIds) {
            id += from;
        }
        const LoadedScene loaded(scene, settings);
        Renderer::Counters counters;
        const LinearImage image =
            loaded.render(RendererOptions{.strategy = package::kStrategyUber}, setup, &counters);
        const std::vector<std::uint32_t>& counts = counters.pixelCounts;
        EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0U), 77U * 45U);
        EXPECT_EQ(counters.unknownShader, 0U);
        if (from == 0) {
            reference = image;
            expected = counts;
            EXPECT_GE(std::ranges::count_if(counts, [](std::uint32_t count) { return count > 0; }), 5);
            for (const compiler::Key& key : loaded.compiled().plan.keys) {
                ids[key.mask] = key.shaderId;
            }
            continue;
        }
        ASSERT_EQ(counts.size(), expected.size() + from);
        EXPECT_EQ(counts[0], expected[0]);
        EXPECT_TRUE(std::equal(expected.begin() + 1, expected.end(), counts.begin() + 1 + from));
        expectSameImage(image, reference, "the picture with other shader IDs");
    }
}

}  // namespace
