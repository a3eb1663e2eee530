// Compares the cost model with its formula.
#include "plan/cost.h"

#include "plan/cost_constants.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace {

using namespace glint;
using compiler::fitted::kInputBranch;
using compiler::fitted::kLitInstructions;
using compiler::fitted::kLobeBranch;

const materials::FeatureMask kBase = bit("normals");

// Returns the instructions of a feature's code, with its fetches.
const materials::Feature& featureNamed(const char* name) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    return model.features[static_cast<std::size_t>(model.findFeature(name))];
}

double instructionsOf(const char* name) {
    const materials::FeatureCost& cost = featureNamed(name).cost;
    return cost.instructions + compiler::kFetchCost * cost.fetches;
}

double laneChance(double p) {
    return 1.0 - std::pow(1.0 - p, compiler::kSubgroupSize);
}

TEST(Cost, OfOneKeyIsNothing) {
    EXPECT_EQ(compiler::mergingCost(compiler::toSet({kBase | bit("dispersion"), 1.0})), 0.0);
    EXPECT_EQ(compiler::mergingCost(compiler::toSet({kBase, 0.4}), compiler::toSet({kBase, 0.6})), 0.0);
}

TEST(Cost, IsThatOfTheFormula) {
    const compiler::KeySet plain = compiler::toSet({kBase, 0.6});
    const compiler::KeySet coated = compiler::toSet({kBase | bit("clearcoat") | bit("doubleSided"), 0.2});
    const double idle = laneChance(0.25) - 0.25;
    const double branches = kLobeBranch + kInputBranch;
    const double code = instructionsOf("clearcoat") + instructionsOf("doubleSided");
    EXPECT_NEAR(mergingCost(plain, coated), 0.8 * (branches + idle * code), 1e-9);
    EXPECT_DOUBLE_EQ(mergingCost(plain, coated), mergingCost(unionOf(plain, coated)));
    EXPECT_DOUBLE_EQ(mergingCost(plain, coated), mergingCost(coated, plain));
}

// Where branches cost occupancy, they cost it for all code of the case.
TEST(Cost, CountsSlowerInstructionsOfCasesThatBranch) {
    using compiler::fitted::kUnlitInstructions;
    compiler::WeightedKey plain{kBase, 0.6};
    compiler::WeightedKey coated{kBase | bit("clearcoat"), 0.2};
    const double inVain = mergingCost(compiler::toSet(plain), compiler::toSet(coated));
    plain.branchFactor = 1.5;
    coated.branchFactor = 1.5;
    const double own = 0.8 * (kUnlitInstructions + kLitInstructions + instructionsOf("normals")) +
                       0.2 * instructionsOf("clearcoat");
    EXPECT_NEAR(mergingCost(compiler::toSet(plain), compiler::toSet(coated)), 1.5 * inVain + 0.5 * own, 1e-9);
    EXPECT_EQ(mergingCost(compiler::toSet(coated)), 0.0) << "a case of one key does not branch";
}

TEST(Cost, UnlitHitsWaitForLitOnes) {
    const compiler::KeySet lit = compiler::toSet({kBase, 0.1});
    const compiler::KeySet unlit = compiler::toSet({bit("unlit"), 0.9});
    const double normals = kInputBranch + instructionsOf("normals") * (laneChance(0.1) - 0.1);
    const double expected = kLobeBranch + normals + kLitInstructions * (laneChance(0.1) - 0.1) +
                            instructionsOf("unlit") * (laneChance(0.9) - 0.9);
    EXPECT_NEAR(mergingCost(lit, unlit), expected, 1e-9);
}

TEST(Cost, OfWhatNothingHitsIsNothing) {
    EXPECT_EQ(compiler::mergingCost(compiler::toSet({kBase, 0.0}), compiler::toSet({bit("unlit"), 0.0})),
              0.0);
}

TEST(Cost, OfAFetchCounts) {
    const char* const texture = "baseColorTexture";
    EXPECT_GT(instructionsOf(texture), compiler::kFetchCost);
    const compiler::KeySet set =
        compiler::unionOf(compiler::toSet({kBase, 0.5}), compiler::toSet({kBase | bit(texture), 0.5}));
    EXPECT_NEAR(mergingCost(set), kInputBranch + instructionsOf(texture) * (laneChance(0.5) - 0.5), 1e-9);
}

// The parts add up to the whole. Features that no key or every key has cost nothing.
TEST(Cost, OfACaseIsThatOfItsBranches) {
    const materials::FeatureMask coated = kBase | bit("clearcoat") | bit("baseColorTexture");
    const compiler::KeySet set =
        compiler::unionOf(compiler::toSet({coated, 0.3}), compiler::toSet({kBase | bit("sheen"), 0.1}));
    double sum = 0.0;
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        const double cost = branchCost(set, info);
        const bool isBranch = (set.any & ~set.always & info.mask()) != 0;
        EXPECT_EQ(cost > 0.0, isBranch) << info.name;
        sum += cost;
    }
    EXPECT_NEAR(sum, mergingCost(set), 1e-9);
}

// If one of two keys gets more hits, sharing a case never becomes cheaper.
TEST(Cost, OfAPairGrowsWithTheHitsOfEither) {
    const materials::FeatureMask masks[] = {kBase, bit("unlit"), kBase | bit("clearcoat"),
                                            kBase | bit("sheen") | bit("baseColorTexture")};
    for (const materials::FeatureMask& a : masks) {
        for (const materials::FeatureMask& b : masks) {
            double last = 0.0;
            for (int step = 0; step < 22; ++step) {
                const double weight = 1e-4 * std::pow(1.7, step);
                const double cost =
                    compiler::mergingCost(compiler::toSet({a, weight}), compiler::toSet({b, 0.1}));
                EXPECT_GE(cost, last);
                last = cost;
            }
            EXPECT_EQ(last > 0.0, a != b);
        }
    }
}

TEST(Cost, SetsOfIndicesAreUnions) {
    const std::vector<compiler::WeightedKey> keys{
        {kBase, 0.5}, {bit("unlit"), 0.2}, {kBase | 1ULL << 40U, 0.3}};
    const std::vector<int> some{0, 2};
    const compiler::KeySet set = toSet(some, keys);
    const compiler::KeySet expected = unionOf(toSet(keys[0]), toSet(keys[2]));
    EXPECT_EQ(set.share, expected.share);
    EXPECT_EQ(set.always, expected.always);
    EXPECT_EQ(set.any, expected.any);
    EXPECT_EQ(set.shareWith, expected.shareWith);
}

TEST(Cost, EstimatesAddUp) {
    const compiler::CodeEstimate unlit = compiler::estimateCode(bit("unlit"), 0);
    const compiler::CodeEstimate lit = compiler::estimateCode(0, 0);
    EXPECT_NEAR(lit.instructions - unlit.instructions, kLitInstructions, 1e-9);
    const materials::FeatureMask texture = bit("emissiveTexture");
    const compiler::CodeEstimate always = compiler::estimateCode(texture, 0);
    EXPECT_EQ(always.fetches, 1.0);
    EXPECT_EQ(always.inputBranches + always.lobeBranches, 0);
    const compiler::CodeEstimate sometimes =
        compiler::estimateCode(0, texture | bit("sheen") | bit("volume"));
    EXPECT_EQ(sometimes.inputBranches, 1);
    EXPECT_EQ(sometimes.lobeBranches, 2);
    EXPECT_EQ(sometimes.fetches, 1.0);
    EXPECT_NEAR(sometimes.instructions -
                    compiler::estimateCode(texture | bit("sheen") | bit("volume"), 0).instructions,
                kInputBranch + 2.0 * kLobeBranch, 1e-9);
}

TEST(Cost, MeasuredConstantsAreSane) {
    EXPECT_GT(kInputBranch, 0.0);
    EXPECT_GT(kLobeBranch, 0.0);
    EXPECT_GT(kLitInstructions, 100.0);
    for (const materials::Feature& feature : materials::builtinMaterialModel().features) {
        EXPECT_GE(feature.cost.instructions, 0.0) << feature.name;
        EXPECT_LT(feature.cost.instructions, 2000.0) << "kRareShare counts on less: " << feature.name;
        EXPECT_EQ(feature.cost.fetches, feature.texture >= 0 ? 1.0 : 0.0) << feature.name;
    }
}

}  // namespace
