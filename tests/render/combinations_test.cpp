// The linear image is the same however a hit is traced, recorded, ordered, merged and shadowed. The sweep
// covers every pair of values of two settings.
#include "render/harness.h"
#include "render/rooms.h"

#include <glint/package_modules.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

struct Room {
    const char* name;
    Scene (*make)();
    AlphaPolicy alpha;
    package::ShadowPlacement profileShadows;
};

// The choices of a renderer, for one strategy and tracer.
struct Way {
    package::Strategy strategy;
    package::Tracer tracer;
};

std::vector<Way> waysOf(std::uint32_t tracers) {
    std::vector<Way> ways;
    for (const package::Strategy strategy : package::kStrategies) {
        for (const package::Tracer tracer : package::kTracers) {
            if ((package::tracersOf(strategy, tracers) & tracer) != 0) {
                ways.push_back({strategy, tracer});
            }
        }
    }
    return ways;
}

// Makes a profile in which keys are hot, never hit and cold in turn. It does not contain the last key.
std::map<FeatureMask, std::uint64_t> makeUpHits(const std::vector<Key>& keys) {
    constexpr std::uint64_t kHits[] = {1000, 0, 1};
    std::map<FeatureMask, std::uint64_t> hits;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        hits[keys[i].mask] = kHits[i % 3];
    }
    return hits;
}

// Expects that the profile was used: hot keys are separate, and some of the others share a case.
void expectMergedByHits(const Plan& plan) {
    bool isHot = false;
    bool shares = false;
    for (const Case& it : plan.cases) {
        isHot = isHot || it.reason == CaseReason::Hot;
        shares = shares || it.keys.size() > 1;
        EXPECT_TRUE(it.reason != CaseReason::Hot || it.keys.size() == 1) << it.name;
    }
    EXPECT_TRUE(isHot);
    EXPECT_TRUE(shares);
}

class Combinations : public ::testing::TestWithParam<Room> {
protected:
    RenderSetup setup(const Scene& scene) {
        RenderSetup setup = defaultSetup(scene, 48, 32);
        setup.frame.maxReflectionRoughness = 1.0F;
        setup.frame.seed = 5;
        setup.samples = 2;
        return setup;
    }

    // Renders every way of one package. Orderings and binnings take turns, so that each meets each way over
    // the packages.
    void sweep(const Scene& scene, const CompileSettings& settings) {
        const LoadedScene loaded(scene, settings);
        ASSERT_TRUE(loaded.ok());
        plan_ = loaded.compiled().plan;
        for (const Way& way : waysOf(settings.tracers)) {
            RenderSetup frame = setup(scene);
            frame.frame.binning = static_cast<Binning>(turn_ % 3);
            RendererOptions options;
            options.strategy = way.strategy;
            options.tracer = way.tracer;
            options.ordering =
                static_cast<package::Ordering>(turn_ % static_cast<unsigned>(package::Ordering::Count));
            options.checkOrder = true;
            ++turn_;
            const std::string what = std::string(GetParam().name) + ": " +
                                     std::string(package::nameOf(way.strategy)) + ", " +
                                     std::string(package::nameOf(way.tracer)) + ", merge " +
                                     std::string(toString(settings.plan.merge)) + ", shadows " +
                                     std::string(package::nameOf(settings.shadows)) + ", ordering " +
                                     std::string(package::nameOf(*options.ordering)) + ", binning " +
                                     std::to_string(static_cast<unsigned>(frame.frame.binning));
            FrameCounters counters;
            const LinearImage image = loaded.render(options, frame, &counters);
            ASSERT_FALSE(image.pixels.empty()) << what;
            EXPECT_GT(counters.rays, 0U) << what;
            EXPECT_EQ(counters.orderErrors, 0U) << what;
            if (reference_.pixels.empty()) {
                reference_ = image;
                first_ = what;
            }
            expectSameImage(image, reference_, what + " against " + first_);
        }
    }

    Plan plan_;  // of the last package

private:
    LinearImage reference_;
    std::string first_;
    unsigned turn_ = 0;
};

TEST_P(Combinations, GiveOneImage) {
    const Scene scene = GetParam().make();
    CompileSettings settings;
    settings.strategies = package::kAllStrategies;
    settings.tracers = package::kAllTracers;
    settings.plan.keys.alpha = GetParam().alpha;
    for (const MergePolicy merge :
         {MergePolicy::All, MergePolicy::None, MergePolicy::Family, MergePolicy::Auto}) {
        for (const auto shadows : {package::ShadowPlacement::Inline, package::ShadowPlacement::Deferred}) {
            settings.shadows = shadows;
            settings.plan.merge = merge;
            settings.plan.maxShaders = merge == MergePolicy::Auto ? 3 : 0;
            sweep(scene, settings);
        }
    }
    // Each room has one placement of shadows, so that each placement meets the policy.
    settings.shadows = GetParam().profileShadows;
    settings.plan.merge = MergePolicy::Profile;
    settings.plan.maxShaders = 4;
    settings.plan.hits = makeUpHits(plan_.keys);
    sweep(scene, settings);
    expectMergedByHits(plan_);
}

// Half the memory costs only the precision of its barycentrics and cone widths.
TEST_P(Combinations, PackedHitsAreClose) {
    const Scene scene = GetParam().make();
    CompileSettings settings;
    settings.strategies = package::kOrderedStrategies;
    settings.plan.keys.alpha = GetParam().alpha;
    const LoadedScene full(scene, settings);
    settings.hitRecord = package::HitRecordFormat::Packed;
    const LoadedScene packed(scene, settings);
    ASSERT_TRUE(full.ok() && packed.ok());
    const RenderSetup frame = setup(scene);
    const LinearImage exact = full.render(package::kStrategyVisibility, frame);
    const LinearImage visibility = packed.render(package::kStrategyVisibility, frame);
    const LinearImage sorted = packed.render(package::kStrategySortedUber, frame);
    ASSERT_FALSE(exact.pixels.empty() || visibility.pixels.empty());
    expectSameImage(sorted, visibility, "packed, sorted-uber against visibility");
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            // The error is relative to the value, because a sharp highlight that moves by a few per cent
            // would otherwise dominate.
            const double truth = exact.pixels[i][channel];
            const double difference = visibility.pixels[i][channel] - truth;
            sum += difference * difference / (truth * truth + 0.01);
        }
    }
    EXPECT_LT(std::sqrt(sum / (3.0 * static_cast<double>(exact.pixels.size()))), 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Rooms, Combinations,
                         ::testing::Values(Room{"Materials", roomOfMaterials, AlphaPolicy::Opaque,
                                                package::ShadowPlacement::Inline},
                                           Room{"Fence", roomWithFence, AlphaPolicy::Tested,
                                                package::ShadowPlacement::Deferred}),
                         [](const auto& room) { return std::string(room.param.name); });

}  // namespace
