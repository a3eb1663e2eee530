// Compares the reported cost of a plan with the clusters' own sums, and with plans in which keys did move.
#include "plan/plan_cost.h"

#include "plan/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace {

using namespace glint;

struct Scene {
    std::vector<materials::Material> materials;
    std::vector<materials::PrimitiveInputs> primitives;

    // Makes materials with random lobes and textures, each on one primitive.
    explicit Scene(std::mt19937& random, int count = 24) {
        for (int i = 0; i < count; ++i) {
            materials::Material material;
            material.doubleSided = random() % 2 == 0;
            material.give("KHR_materials_clearcoat");
            material["clearcoatFactor"] = random() % 3 == 0 ? 1.0F : 0.0F;
            if (random() % 5 == 0) {
                material.give("KHR_materials_unlit");
            }
            material.give("KHR_materials_emissive_strength");
            material["emissiveStrength"] = random() % 4 == 0 ? 2.0F : 1.0F;
            material["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
            materials.push_back(material);
            materials::PrimitiveInputs primitive;
            primitive.material = i;
            primitive.hasNormals = random() % 2 == 0;
            primitive.colors =
                random() % 3 == 0 ? materials::ColorContent::Varying : materials::ColorContent::None;
            primitive.expectedHits = 1.0 + static_cast<double>(random() % 200);
            primitives.push_back(primitive);
        }
    }
    compiler::Plan plan(const compiler::PlanOptions& options) const {
        return makePlan(materials, primitives, options);
    }
};

std::vector<compiler::WeightedKey> weightedKeys(const compiler::Plan& plan) {
    std::vector<compiler::WeightedKey> keys;
    for (const compiler::Key& key : plan.keys) {
        keys.push_back({key.mask, key.share});
    }
    return keys;
}

std::vector<compiler::Cluster> clustersOf(const compiler::Plan& plan) {
    std::vector<compiler::Cluster> clusters;
    for (const compiler::Case& shaderCase : plan.cases) {
        clusters.push_back({shaderCase.keys});
    }
    return clusters;
}

constexpr compiler::MergePolicy kPolicies[] = {compiler::MergePolicy::None, compiler::MergePolicy::Family,
                                               compiler::MergePolicy::All, compiler::MergePolicy::Auto};

TEST(PlanCost, IsThatOfItsClusters) {
    std::mt19937 random(20250401);
    const Scene scene(random);
    for (const compiler::MergePolicy merge : kPolicies) {
        const compiler::PlanOptions options{{}, merge, 6};
        const compiler::Plan plan = scene.plan(options);
        const compiler::PlanCost cost = costPlan(plan, options);
        ASSERT_EQ(cost.cases.size(), plan.cases.size());
        const double expected = totalCost(clustersOf(plan), weightedKeys(plan));
        EXPECT_NEAR(compiler::totalCost(cost.inVain, cost.cases.size()), expected, 1e-9);
        for (const compiler::CaseCost& entry : cost.cases) {
            double branches = 0.0;
            double last = entry.inVain;
            for (const compiler::BranchCost& branch : entry.branches) {
                branches += branch.cost;
                EXPECT_LE(branch.cost, last);
                EXPECT_GT(branch.share, 0.0);
                EXPECT_LT(branch.share, 1.0);
                last = branch.cost;
            }
            EXPECT_NEAR(branches, entry.inVain, 1e-9);
            EXPECT_EQ(entry.saved, compiler::kCaseCost * static_cast<double>(entry.keys.size() - 1));
            EXPECT_LE(entry.ownInstructions, entry.code.instructions + 1e-9);
        }
    }
}

// Keys that leave, and cases that merge, cost what the report says.
TEST(PlanCost, OfWhatWouldChangeIsTrue) {
    std::mt19937 random(20250402);
    const Scene scene(random);
    const compiler::PlanOptions options{{}, compiler::MergePolicy::Family};
    const compiler::Plan plan = scene.plan(options);
    const std::vector<compiler::WeightedKey> keys = weightedKeys(plan);
    const std::vector<compiler::Cluster> clusters = clustersOf(plan);
    const double now = totalCost(clusters, keys);
    int left = 0;
    for (const compiler::CaseCost& entry : costPlan(plan, options).cases) {
        const auto place = static_cast<std::size_t>(entry.shaderId);
        for (const compiler::KeyCost& key : entry.keys) {
            if (entry.keys.size() == 1) {
                EXPECT_EQ(key.leavingAdds, 0.0);
                continue;
            }
            std::vector<compiler::Cluster> changed = clusters;
            std::erase(changed[place].keys, key.key);
            changed.push_back({{key.key}});
            EXPECT_NEAR(totalCost(changed, keys) - now, key.leavingAdds, 1e-9);
            ++left;
        }
        ASSERT_TRUE(entry.nearest);
        double least = 1e300;
        for (std::size_t other = 0; other < clusters.size(); ++other) {
            if (other == place) {
                continue;
            }
            std::vector<compiler::Cluster> changed = clusters;
            changed[place].keys.insert(changed[place].keys.end(), clusters[other].keys.begin(),
                                       clusters[other].keys.end());
            changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(other));
            least = std::min(least, totalCost(changed, keys) - now + compiler::kCaseCost);
        }
        EXPECT_NEAR(entry.nearest->adds, least, 1e-9);
    }
    EXPECT_GT(left, 10);
}

// No single key is cheaper in its own case, unless the budget forbids it, and no two cases are cheaper
// together.
TEST(PlanCost, AutoStopsWhereNothingIsSpared) {
    std::mt19937 random(20250403);
    for (int i = 0; i < 10; ++i) {
        const Scene scene(random);
        const compiler::PlanOptions options{{}, compiler::MergePolicy::Auto};
        const compiler::Plan plan = scene.plan(options);
        ASSERT_LT(plan.cases.size(), static_cast<std::size_t>(compiler::kDefaultMaxCases));
        for (const compiler::CaseCost& entry : costPlan(plan, options).cases) {
            for (const compiler::KeyCost& key : entry.keys) {
                EXPECT_GE(key.leavingAdds, -1e-6);
            }
        }
    }
}

TEST(PlanCost, OfRetiredCasesAndOfNothing) {
    const compiler::PlanCost nothing = compiler::costPlan({}, {});
    EXPECT_TRUE(nothing.cases.empty());
    EXPECT_EQ(compiler::totalCost(nothing.inVain, 0), 0.0);
    std::mt19937 random(20250404);
    const Scene scene(random, 1);
    compiler::PlanOptions options{{}, compiler::MergePolicy::None};
    options.lockedIds[scene.plan(options).keys.front().mask] = 2;
    const compiler::Plan plan = scene.plan(options);
    ASSERT_EQ(plan.cases.size(), 3U);
    const compiler::PlanCost cost = costPlan(plan, options);
    ASSERT_EQ(cost.cases.size(), 1U);
    EXPECT_EQ(cost.cases[0].shaderId, 2);
    EXPECT_FALSE(cost.cases[0].nearest);
}

}  // namespace
