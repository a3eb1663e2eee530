// The linear image is the same however a hit is traced, recorded, ordered, merged and shadowed. The sweep
// covers every pair of values of two settings.
#include "render/harness.h"
#include "render/rooms.h"
#include "render/ways.h"
#include "support/nightly.h"

#include <glint/internal/package_modules.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

struct Room {
    unsigned number;
    const char* name;
    gltf::Scene (*make)();
    package::AlphaPolicy alpha;
};

constexpr compiler::MergePolicy kPolicies[] = {compiler::MergePolicy::All, compiler::MergePolicy::None,
                                               compiler::MergePolicy::Family, compiler::MergePolicy::Auto,
                                               compiler::MergePolicy::Profile};
constexpr package::ShadowPlacement kPlacements[] = {package::ShadowPlacement::Inline,
                                                    package::ShadowPlacement::Deferred};
constexpr unsigned kOrderings = static_cast<unsigned>(package::Ordering::Count);
constexpr unsigned kBinnings = 3;
constexpr unsigned kRooms = 2;

// One picture of the sweep.
struct Combination {
    unsigned room;
    compiler::MergePolicy merge;
    package::ShadowPlacement shadows;
    Way way;
    std::optional<package::Ordering> ordering;  // none where the strategy orders nothing
    FrameOptions::Binning binning;
};

std::vector<Combination> allCombinations() {
    std::vector<Combination> all;
    // Adds the orderings and binnings of one way.
    const auto addWay = [&](unsigned room, compiler::MergePolicy merge, package::ShadowPlacement shadows,
                            const Way& way) {
        const bool orders = (package::orderedStrategies() & way.strategy) != 0;
        for (unsigned i = 0; i < (orders ? kOrderings : 1U) * kBinnings; ++i) {
            std::optional<package::Ordering> ordering;
            if (orders) {
                ordering = static_cast<package::Ordering>(i / kBinnings);
            }
            all.push_back(
                {room, merge, shadows, way, ordering, static_cast<FrameOptions::Binning>(i % kBinnings)});
        }
    };
    for (unsigned room = 0; room < kRooms; ++room) {
        for (const compiler::MergePolicy merge : kPolicies) {
            for (const package::ShadowPlacement shadows : kPlacements) {
                for (const Way& way : waysOf(package::allStrategies(), package::kAllTracers)) {
                    addWay(room, merge, shadows, way);
                }
            }
        }
    }
    return all;
}

// Two settings, each with a value.
using Pair = std::array<unsigned, 4>;

std::vector<Pair> pairsOf(const Combination& combination) {
    std::vector<std::array<unsigned, 2>> values{{0, static_cast<unsigned>(combination.merge)},
                                                {1, static_cast<unsigned>(combination.shadows)},
                                                {2, static_cast<unsigned>(combination.way.strategy)},
                                                {3, static_cast<unsigned>(combination.way.tracer)},
                                                {4, static_cast<unsigned>(combination.binning)},
                                                {6, combination.room}};
    if (combination.ordering) {
        values.push_back({5, static_cast<unsigned>(*combination.ordering)});
    }
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t j = i + 1; j < values.size(); ++j) {
            pairs.push_back({values[i][0], values[i][1], values[j][0], values[j][1]});
        }
    }
    return pairs;
}

// Chooses few combinations, greedily, that cover every pair of values of two settings. The nightly sweep
// takes all combinations.
std::vector<Combination> chosenCombinations() {
    const std::vector<Combination> all = allCombinations();
    if (test::nightly()) {
        return all;
    }
    std::set<Pair> missing;
    for (const Combination& combination : all) {
        const std::vector<Pair> pairs = pairsOf(combination);
        missing.insert(pairs.begin(), pairs.end());
    }
    std::vector<Combination> chosen;
    while (!missing.empty()) {
        const auto gain = [&](const Combination& combination) {
            return std::ranges::count_if(pairsOf(combination),
                                         [&](const Pair& pair) { return missing.contains(pair); });
        };
        chosen.push_back(*std::ranges::max_element(all, {}, gain));
        for (const Pair& pair : pairsOf(chosen.back())) {
            missing.erase(pair);
        }
    }
    return chosen;
}

// Makes a profile in which keys are hot, never hit and cold in turn. It does not contain the last key.
std::map<materials::FeatureMask, std::uint64_t> makeUpHits(const std::vector<compiler::Key>& keys) {
    constexpr std::uint64_t kHits[] = {1000, 0, 1};
    std::map<materials::FeatureMask, std::uint64_t> hits;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        hits[keys[i].mask] = kHits[i % 3];
    }
    return hits;
}

// Expects that the profile was used: hot keys are separate, and some of the others share a case.
void expectMergedByHits(const compiler::Plan& plan) {
    bool isHot = false;
    bool shares = false;
    for (const compiler::Case& it : plan.cases) {
        isHot = isHot || it.reason == compiler::CaseReason::Hot;
        shares = shares || it.keys.size() > 1;
        EXPECT_TRUE(it.reason != compiler::CaseReason::Hot || it.keys.size() == 1) << it.name;
    }
    EXPECT_TRUE(isHot);
    EXPECT_TRUE(shares);
}

class Combinations : public ::testing::TestWithParam<Room> {
protected:
    RenderSetup setup(const gltf::Scene& scene) {
        RenderSetup setup = defaultSetup(scene, 48, 32);
        setup.frame.maxReflectionRoughness = 1.0F;
        setup.frame.seed = 5;
        setup.samples = 2;
        return setup;
    }

    void expectReference(const LoadedScene& loaded, const gltf::Scene& scene,
                         const Combination& combination) {
        RenderSetup frame = setup(scene);
        frame.frame.binning = combination.binning;
        RendererOptions options = optionsOf(combination.way);
        options.ordering = combination.ordering;
        const std::string what = fmt::format(
            "{}: {}, merge {}, shadows {}, ordering {}, binning {}", GetParam().name, nameOf(combination.way),
            nameOf(combination.merge), package::nameOf(combination.shadows),
            combination.ordering ? package::nameOf(*combination.ordering) : "-",
            static_cast<unsigned>(combination.binning));
        Renderer::Counters counters;
        const LinearImage image = loaded.render(options, frame, &counters);
        EXPECT_GT(counters.rays, 0U) << what;
        EXPECT_EQ(counters.orderErrors, 0U) << what;
        if (reference_.pixels.empty()) {
            reference_ = image;
            first_ = what;
        }
        expectSameImage(image, reference_, what + " against " + first_);
    }

    std::vector<compiler::Key> keys_;  // of the last package

private:
    LinearImage reference_;
    std::string first_;
};

TEST_P(Combinations, GiveOneImage) {
    const gltf::Scene scene = GetParam().make();
    const std::vector<Combination> combinations = chosenCombinations();
    for (const compiler::MergePolicy merge : kPolicies) {
        for (const package::ShadowPlacement shadows : kPlacements) {
            // A package has only what it is rendered with, because compiling takes longest.
            compiler::CompileSettings settings;
            settings.strategies = 0;
            settings.tracers = 0;
            std::vector<Combination> rendered;
            for (const Combination& combination : combinations) {
                if (combination.room == GetParam().number && combination.merge == merge &&
                    combination.shadows == shadows) {
                    rendered.push_back(combination);
                    settings.strategies |= combination.way.strategy;
                    settings.tracers |= combination.way.tracer;
                }
            }
            if (rendered.empty()) {
                continue;
            }
            settings.plan.keys.alpha = GetParam().alpha;
            settings.shadows = shadows;
            settings.plan.merge = merge;
            settings.plan.maxShaders = merge == compiler::MergePolicy::Auto      ? 3
                                       : merge == compiler::MergePolicy::Profile ? 4
                                                                                 : 0;
            if (merge == compiler::MergePolicy::Profile) {
                settings.plan.hits = makeUpHits(keys_);
            }
            const LoadedScene loaded(scene, settings);
            keys_ = loaded.compiled().plan.keys;
            if (merge == compiler::MergePolicy::Profile) {
                expectMergedByHits(loaded.compiled().plan);
            }
            for (const Combination& combination : rendered) {
                expectReference(loaded, scene, combination);
            }
        }
    }
}

// Half the memory costs only the precision of its barycentrics and cone widths.
TEST_P(Combinations, PackedHitsAreClose) {
    const gltf::Scene scene = GetParam().make();
    compiler::CompileSettings settings;
    settings.strategies = package::orderedStrategies();
    settings.plan.keys.alpha = GetParam().alpha;
    const LoadedScene full(scene, settings);
    settings.hitRecord = package::HitRecordFormat::Packed;
    const LoadedScene packed(scene, settings);
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
                         ::testing::Values(Room{0, "Materials", roomOfMaterials,
                                                package::AlphaPolicy::Opaque},
                                           Room{1, "Fence", roomWithFence, package::AlphaPolicy::Tested}),
                         [](const auto& room) { return std::string(room.param.name); });

}  // namespace
