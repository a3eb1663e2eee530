// Tests which keys share a case under each policy, depending on the keys' hits.
#include "plan/merge.h"

#include "support/features.h"
#include "unit/plan/weighted_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace {

using namespace glint;

constexpr unsigned kMergeSeed = 20250317;
const materials::FeatureMask kMergeBase = bit("normals");
const materials::FeatureMask kMergeTextured = kMergeBase | bit("baseColorTexture") | bit("texCoord0");
const materials::FeatureMask kMergeCoated = kMergeTextured | bit("clearcoat");
const materials::FeatureMask kDispersing =
    kMergeBase | bit("transmission") | bit("volume") | bit("dispersion");

std::vector<compiler::WeightedKey> randomKeys(std::mt19937& random, std::size_t count) {
    materials::FeatureMask known = 0;
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        known |= info.mask();
    }
    std::map<materials::FeatureMask, double> weights;
    while (weights.size() < count) {
        const materials::FeatureMask mask = std::uint64_t{random()} << 32U | random();
        const materials::FeatureMask sparse = mask & (std::uint64_t{random()} << 32U | random()) & known;
        // The weights range from a hundred thousand to one, and some keys have no hits.
        weights[sparse] = random() % 8 == 0 ? 0.0 : std::exp2(static_cast<double>(random() % 17));
    }
    return glint::testing::toKeys(weights);
}

// After multiplying hits or shuffling a list, keys are identified by mask.
std::map<materials::FeatureMask, compiler::CaseReason> reasonsByMask(
    const std::vector<compiler::WeightedKey>& keys, const std::vector<compiler::CaseKeys>& cases) {
    std::map<materials::FeatureMask, compiler::CaseReason> reasons;
    for (const compiler::CaseKeys& shaderCase : cases) {
        for (const int key : shaderCase.keys) {
            reasons[keys[static_cast<std::size_t>(key)].mask] = shaderCase.reason;
        }
    }
    return reasons;
}

// Returns the case of each key; every key must be in exactly one.
std::vector<int> casesOfKeys(std::size_t keyCount, const std::vector<compiler::CaseKeys>& cases) {
    std::vector<int> caseOf(keyCount, -1);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_FALSE(cases[i].keys.empty());
        EXPECT_TRUE(std::ranges::is_sorted(cases[i].keys));
        for (const int key : cases[i].keys) {
            EXPECT_EQ(caseOf[static_cast<std::size_t>(key)], -1) << "key " << key << " is in two cases";
            caseOf[static_cast<std::size_t>(key)] = static_cast<int>(i);
        }
    }
    EXPECT_EQ(std::ranges::count(caseOf, -1), 0) << "a key is in no case";
    return caseOf;
}

constexpr compiler::MergePolicy kBudgeted[] = {compiler::MergePolicy::Auto, compiler::MergePolicy::Profile};

TEST(Merge, PartitionsTheKeysWithinTheBudget) {
    RecordProperty("seed", kMergeSeed);
    std::mt19937 random(kMergeSeed);
    for (const std::size_t count : {1U, 2U, 3U, 17U, 40U, 150U}) {
        const std::vector<compiler::WeightedKey> keys = randomKeys(random, count);
        for (const compiler::MergePolicy merge : kBudgeted) {
            for (const int budget : {1, 2, 3, 4, 5, 8, 32, 1000}) {
                SCOPED_TRACE(::testing::Message() << nameOf(merge) << ", " << count << " keys, " << budget);
                const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, merge, budget);
                EXPECT_LE(cases.size(), static_cast<std::size_t>(budget));
                casesOfKeys(keys.size(), cases);
                EXPECT_TRUE(std::ranges::is_sorted(
                    cases, {}, [](const compiler::CaseKeys& shaderCase) { return shaderCase.keys.front(); }));
            }
        }
    }
}

TEST(Merge, OfNothingMakesNoCase) {
    for (const compiler::MergePolicy merge :
         {compiler::MergePolicy::None, compiler::MergePolicy::Family, compiler::MergePolicy::All,
          compiler::MergePolicy::Auto, compiler::MergePolicy::Profile}) {
        EXPECT_TRUE(mergeKeys({}, merge, 1).empty());
    }
}

TEST(Merge, GivesTheSameCasesAgain) {
    std::mt19937 random(kMergeSeed);
    std::vector<compiler::WeightedKey> keys = randomKeys(random, 60);
    // All shares are tied, so the order of the masks decides.
    for (compiler::WeightedKey& key : keys) {
        key.share = 1.0 / 60.0;
    }
    for (const compiler::MergePolicy merge : kBudgeted) {
        const std::vector<int> once = casesOfKeys(keys.size(), mergeKeys(keys, merge, 7));
        EXPECT_EQ(once, casesOfKeys(keys.size(), mergeKeys(keys, merge, 7)));
        EXPECT_EQ(*std::ranges::max_element(once), 6);
    }
}

TEST(Merge, FrequentKeysThatDifferMuchStayApart) {
    const std::vector<compiler::WeightedKey> keys =
        glint::testing::toKeys({{kMergeTextured, 50.0}, {kMergeCoated, 30.0}, {kDispersing, 20.0}});
    const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Auto, 32);
    ASSERT_EQ(cases.size(), 3U);
    for (const compiler::CaseKeys& shaderCase : cases) {
        EXPECT_EQ(shaderCase.reason, compiler::CaseReason::Own);
    }
}

TEST(Merge, KeysThatHardlyDifferShareACaseWhereHitsAreFew) {
    const materials::FeatureMask doubleSided = kMergeCoated | bit("doubleSided");
    const auto casesWith = [&](double weight) {
        const std::vector<compiler::WeightedKey> keys =
            glint::testing::toKeys({{kMergeTextured, 1000.0}, {kMergeCoated, weight}, {doubleSided, weight}});
        const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Auto, 32);
        return casesOfKeys(keys.size(), cases);
    };
    const std::vector<int> few = casesWith(100.0);
    EXPECT_EQ(few[1], few[2]);
    EXPECT_NE(few[0], few[1]);
    const std::vector<int> many = casesWith(1000.0);
    EXPECT_NE(many[1], many[2]);
}

// The keys are the same: the keys with the hits get their own cases.
TEST(Merge, WeightsMoveKeysToCasesOfTheirOwn) {
    std::mt19937 random(kMergeSeed);
    const std::vector<compiler::WeightedKey> start = randomKeys(random, 30);
    for (const compiler::MergePolicy merge : kBudgeted) {
        for (std::size_t hot = 0; hot < start.size(); ++hot) {
            std::map<materials::FeatureMask, double> weights;
            for (const compiler::WeightedKey& key : start) {
                weights[key.mask] = 1.0;
            }
            weights[start[hot].mask] = 60.0;
            const std::vector<compiler::WeightedKey> keys = glint::testing::toKeys(weights);
            const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, merge, 4);
            const std::vector<int> caseOf = casesOfKeys(keys.size(), cases);
            EXPECT_EQ(std::ranges::count(caseOf, caseOf[hot]), 1) << nameOf(merge) << ", key " << hot;
        }
    }
}

TEST(Merge, RareKeysAreTheRest) {
    std::map<materials::FeatureMask, double> weights{{kMergeTextured, 600.0}, {kMergeCoated, 400.0}};
    for (const char* const feature : {"sheen", "anisotropy", "iridescence"}) {
        weights[kMergeBase | bit(feature)] = 1.0;
    }
    const std::vector<compiler::WeightedKey> keys = glint::testing::toKeys(weights);
    const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Auto, 32);
    EXPECT_EQ(cases.size(), 3U);
    const auto reasons = reasonsByMask(keys, cases);
    EXPECT_EQ(reasons.at(kMergeBase | bit("sheen")), compiler::CaseReason::Rest);
    EXPECT_EQ(reasons.at(kMergeBase | bit("iridescence")), compiler::CaseReason::Rest);
    EXPECT_EQ(reasons.at(kMergeTextured), compiler::CaseReason::Own);
    EXPECT_EQ(reasons.at(kMergeCoated), compiler::CaseReason::Own);
}

// Each of a thousand keys with equal shares is rare, but together they are not.
TEST(Merge, ManyEqualKeysAreNotAllRest) {
    std::mt19937 random(kMergeSeed);
    std::vector<compiler::WeightedKey> keys = randomKeys(random, 1000);
    for (compiler::WeightedKey& key : keys) {
        key.share = 1e-3;
    }
    EXPECT_EQ(mergeKeys(keys, compiler::MergePolicy::Auto, 20).size(), 20U);
}

TEST(Merge, TheBudgetIsTheReasonWhereMergingDoesNotPay) {
    const std::vector<compiler::WeightedKey> keys =
        glint::testing::toKeys({{kMergeTextured, 50.0}, {kMergeCoated, 30.0}, {kDispersing, 20.0}});
    const std::vector<compiler::CaseKeys> two = mergeKeys(keys, compiler::MergePolicy::Auto, 2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(std::ranges::count(two, compiler::CaseReason::Budget, &compiler::CaseKeys::reason), 1);
    const std::vector<compiler::CaseKeys> one = mergeKeys(keys, compiler::MergePolicy::Auto, 1);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].reason, compiler::CaseReason::Budget);
}

TEST(Merge, ProfilesTellHotFromColdFromNeverHit) {
    const materials::FeatureMask sheen = kMergeBase | bit("sheen");
    const std::vector<compiler::WeightedKey> keys =
        glint::testing::toKeys({{kMergeBase, 500.0},
                                {kMergeTextured, 460.0},
                                {kMergeTextured | bit("textureTransform"), 20.0},
                                {kMergeTextured | bit("vertexColor"), 18.0},
                                {kMergeCoated, 0.0},
                                {sheen, 0.0},
                                {sheen | bit("doubleSided"), 2.0}});
    const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Profile, 32);
    const auto reasons = reasonsByMask(keys, cases);
    EXPECT_EQ(reasons.at(kMergeBase), compiler::CaseReason::Hot);
    EXPECT_EQ(reasons.at(kMergeTextured), compiler::CaseReason::Hot);
    EXPECT_EQ(reasons.at(kMergeTextured | bit("textureTransform")), compiler::CaseReason::Cold);
    EXPECT_EQ(reasons.at(sheen | bit("doubleSided")), compiler::CaseReason::Cold);
    EXPECT_EQ(reasons.at(kMergeCoated), compiler::CaseReason::NeverHit);
    EXPECT_EQ(reasons.at(sheen), compiler::CaseReason::NeverHit);
    // There are two hot keys, at most two families of cold keys, and one case for the others.
    const std::vector<int> caseOf = casesOfKeys(keys.size(), cases);
    EXPECT_LE(cases.size(), 5U);
    for (const compiler::CaseKeys& shaderCase : cases) {
        EXPECT_TRUE(shaderCase.reason != compiler::CaseReason::Hot || shaderCase.keys.size() == 1);
    }
    EXPECT_EQ(std::ranges::count(cases, compiler::CaseReason::NeverHit, &compiler::CaseKeys::reason), 1);
    EXPECT_EQ(mergeKeys(keys, compiler::MergePolicy::Profile, 2).size(), 2U);
}

TEST(Merge, AProfileWithoutHitsMakesOneCase) {
    std::mt19937 random(kMergeSeed);
    std::vector<compiler::WeightedKey> keys = randomKeys(random, 10);
    for (compiler::WeightedKey& key : keys) {
        key.share = 0.0;
    }
    const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Profile, 32);
    ASSERT_EQ(cases.size(), 1U);
    EXPECT_EQ(cases[0].reason, compiler::CaseReason::NeverHit);
}

TEST(Merge, EveryReasonHasAWordAndASentence) {
    std::map<std::string_view, int> words;
    for (int i = 0; i <= static_cast<int>(compiler::CaseReason::NeverHit); ++i) {
        ++words[toString(static_cast<compiler::CaseReason>(i))];
        EXPECT_FALSE(explain(static_cast<compiler::CaseReason>(i)).empty());
    }
    EXPECT_EQ(words.size(), static_cast<std::size_t>(compiler::CaseReason::NeverHit) + 1);
    EXPECT_EQ(toString(compiler::CaseReason::NeverHit), "never-hit");
}

}  // namespace
