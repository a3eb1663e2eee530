// Tests the choice of cases by the expected time of a frame.
#include "plan/frame_time.h"

#include "plan/gpu_costs.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace glint {
namespace {

// A wall of 64 materials in a mirror, which fills the picture: keys with all sets of two inputs and four
// lobes. Frames of such a scene were measured on the GPU of the built-in costs (docs/merging.md): uber
// takes 4.0 ms with one case for all keys, and 11 to 13 with more; sorted-uber takes 2.7 ms with a case for
// each family, and 3.1 with one for all keys.
struct MirroredWall {
    std::vector<compiler::WeightedKey> keys;
    std::vector<compiler::MergeCandidate> candidates;

    explicit MirroredWall(int maxCases = 64) {
        const materials::FeatureMask features[] = {bit("normalTexture"), bit("metallicRoughnessTexture"),
                                                   bit("clearcoat"),     bit("sheen"),
                                                   bit("iridescence"),   bit("anisotropy")};
        for (unsigned i = 0; i < 64; ++i) {
            materials::FeatureMask mask = bit("baseColorTexture") | bit("normals") | bit("texCoord0");
            for (unsigned place = 0; place < std::size(features); ++place) {
                mask |= (i >> place & 1U) != 0 ? features[place] : 0;
            }
            keys.push_back({mask, 1.0 / 64.0});
        }
        std::ranges::sort(keys, {}, &compiler::WeightedKey::mask);
        candidates = mergeCandidates(keys, maxCases);
    }

    std::vector<compiler::MergeEstimate> estimates(std::vector<std::string> strategies,
                                                   bool takesFastest = false,
                                                   double rays = 1920.0 * 1080.0) const {
        const compiler::Round round{rays, 1.0, 0.5, 0.5, {}};
        return estimateMerges(
            {{{{round}, keys}}, {}, compiler::builtInCosts(false), std::move(strategies), takesFastest}, keys,
            candidates);
    }
};

const compiler::MergeEstimate& chosen(const std::vector<compiler::MergeEstimate>& estimates) {
    EXPECT_EQ(std::ranges::count(estimates, true, &compiler::MergeEstimate::chosen), 1);
    return *std::ranges::find(estimates, true, &compiler::MergeEstimate::chosen);
}

const compiler::MergeEstimate& named(const std::vector<compiler::MergeEstimate>& estimates,
                                     std::string_view name) {
    return *std::ranges::find(estimates, name, &compiler::MergeEstimate::name);
}

TEST(FrameTime, CasesDependOnTheStrategy) {
    const MirroredWall wall;
    for (const char* const strategy : {"uber", "hit-shaders"}) {
        const auto estimates = wall.estimates({strategy});
        EXPECT_EQ(chosen(estimates).name, "all") << strategy;
        EXPECT_GT(named(estimates, "none").ms[0], 2.0 * named(estimates, "all").ms[0]);
    }
    for (const char* const strategy : {"sorted-uber", "visibility"}) {
        const auto estimates = wall.estimates({strategy});
        EXPECT_GE(chosen(estimates).cases, 4U) << strategy;
        EXPECT_LT(chosen(estimates).ms[0], 0.95 * named(estimates, "all").ms[0]);
    }
}

TEST(FrameTime, OfSeveralStrategiesTheFastestOrAllCount) {
    const MirroredWall wall;
    const std::vector<std::string> both{"uber", "sorted-uber"};
    EXPECT_EQ(chosen(wall.estimates(both, true)).name, chosen(wall.estimates({"sorted-uber"})).name);
    // The switch loses more by many cases than sorted hits by one.
    EXPECT_EQ(chosen(wall.estimates(both, false)).name, "all");
    EXPECT_NE(describeChoice(wall.estimates(both), both, false).find("sorted-uber"), std::string::npos);
    const std::string fastest = describeChoice(wall.estimates(both, true), both, true);
    EXPECT_EQ(fastest.find("; uber"), std::string::npos) << fastest;
}

// Without rays only first hits count, which every strategy shades in the same way.
TEST(FrameTime, FirstHitsAreTheSameForAllStrategies) {
    const MirroredWall wall;
    for (const compiler::MergeEstimate& estimate : wall.estimates({"uber", "visibility"}, false, 0.0)) {
        EXPECT_GT(estimate.firstMs, 0.0);
        EXPECT_EQ(estimate.ms[0], estimate.firstMs);
        EXPECT_EQ(estimate.ms[1], estimate.firstMs);
    }
}

TEST(FrameTime, FewCasesAreTakenWhereTimesAreAlike) {
    const MirroredWall wall;
    const auto estimates = wall.estimates({"visibility"});
    const compiler::MergeEstimate& best = chosen(estimates);
    for (const compiler::MergeEstimate& other : estimates) {
        EXPECT_GE(other.ms[0] * (1.0 + compiler::kSameTime), best.ms[0]) << other.name;
        if (other.ms[0] <= best.ms[0]) {
            EXPECT_GE(other.cases, best.cases) << other.name;
        }
    }
}

TEST(FrameTime, CandidatesKeepToTheBudget) {
    for (const int budget : {1, 3, 16, 64}) {
        const MirroredWall wall(budget);
        ASSERT_FALSE(wall.candidates.empty());
        for (const compiler::MergeCandidate& candidate : wall.candidates) {
            EXPECT_LE(candidate.cases.size(), static_cast<std::size_t>(budget)) << candidate.name;
            std::size_t keys = 0;
            for (const compiler::CaseKeys& shaderCase : candidate.cases) {
                keys += shaderCase.keys.size();
            }
            EXPECT_EQ(keys, wall.keys.size()) << candidate.name;
        }
    }
}

// A device without constants for a strategy does not know its time.
TEST(FrameTime, StrategiesWithoutConstantsDoNotCount) {
    const MirroredWall wall;
    compiler::FrameModel model{{{{{1e6, 1.0, 0.5, 0.5, {}}}, wall.keys}},
                               {},
                               compiler::builtInCosts(false),
                               {"uber", "sorted-uber"},
                               true};
    std::erase_if(model.device.strategies,
                  [](const compiler::StrategyCosts& costs) { return costs.strategy == "uber"; });
    const auto estimates = estimateMerges(model, wall.keys, wall.candidates);
    EXPECT_EQ(chosen(estimates).name, chosen(wall.estimates({"sorted-uber"})).name);
}

}  // namespace
}  // namespace glint
