// Compares the clustering with exhaustive search, and tests what planning promises for any keys.
#include "plan/merge.h"
#include "support/features.h"
#include "unit/plan/weighted_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace {

using namespace glint;

const materials::FeatureMask kClusterBase = bit("normals");

// Calls use(partition) for every partition of n keys into at most `most` clusters.
template <typename Use>
void forEachPartition(std::vector<int>& labels, std::size_t index, int used, int most, const Use& use) {
    if (index == labels.size()) {
        std::vector<compiler::Cluster> clusters(static_cast<std::size_t>(used));
        for (std::size_t key = 0; key < labels.size(); ++key) {
            clusters[static_cast<std::size_t>(labels[key])].keys.push_back(static_cast<int>(key));
        }
        use(clusters);
        return;
    }
    for (int label = 0; label < std::min(used + 1, most); ++label) {
        labels[index] = label;
        forEachPartition(labels, index + 1, std::max(used, label + 1), most, use);
    }
}

std::vector<compiler::WeightedKey> randomClusterKeys(std::mt19937& random, int count) {
    std::vector<compiler::WeightedKey> keys;
    for (int i = 0; i < count; ++i) {
        materials::FeatureMask mask = kClusterBase;
        for (const char* const feature :
             {"clearcoat", "sheen", "baseColorTexture", "normalTexture", "doubleSided", "unlit"}) {
            mask |= random() % 3 == 0 ? bit(feature) : 0;
        }
        keys.push_back({mask, static_cast<double>(random() % 100)});
    }
    double sum = 0.0;
    for (const compiler::WeightedKey& key : keys) {
        sum += key.share;
    }
    for (compiler::WeightedKey& key : keys) {
        key.share /= sum;
    }
    return keys;
}

// Returns the distinct keys of randomClusterKeys(), ascending, as planning has them.
std::vector<compiler::WeightedKey> distinctKeys(std::mt19937& random, std::size_t count) {
    std::map<materials::FeatureMask, double> weights;
    while (weights.size() < count) {
        for (const compiler::WeightedKey& key : randomClusterKeys(random, 16)) {
            if (weights.size() < count) {
                weights[key.mask] = key.share + 1e-3;
            }
        }
    }
    return glint::testing::toKeys(weights);
}

std::vector<compiler::Cluster> oneEach(std::size_t count) {
    std::vector<compiler::Cluster> clusters;
    for (std::size_t i = 0; i < count; ++i) {
        clusters.push_back({{static_cast<int>(i)}});
    }
    return clusters;
}

// Greedy merging and moves are not optimal. Their cost must never be below the optimum, and must stay near
// it.
TEST(Cluster, IsNearTheBestOfAllPartitions) {
    constexpr unsigned kSeed = 20250318;
    RecordProperty("seed", kSeed);
    std::mt19937 random(kSeed);
    constexpr int kScenes = 60;
    double ratios = 0.0;
    for (int i = 0; i < kScenes; ++i) {
        const std::vector<compiler::WeightedKey> keys = randomClusterKeys(random, 7);
        const int budget = 1 + static_cast<int>(random() % 7);
        const std::vector<compiler::Cluster> merged = agglomerate(oneEach(keys.size()), keys, budget);
        const std::vector<compiler::Cluster> clusters = moveKeys(merged, keys, budget);
        ASSERT_LE(clusters.size(), static_cast<std::size_t>(budget));
        EXPECT_LE(totalCost(clusters, keys), totalCost(merged, keys));
        double best = std::numeric_limits<double>::infinity();
        std::vector<int> labels(keys.size());
        forEachPartition(labels, 0, 0, budget, [&](const std::vector<compiler::Cluster>& partition) {
            best = std::min(best, totalCost(partition, keys));
        });
        const double cost = totalCost(clusters, keys);
        EXPECT_GE(cost, best * (1.0 - 1e-12));
        ratios += cost / best;
    }
    RecordProperty("meanRatio", std::to_string(ratios / kScenes));
    EXPECT_LT(ratios / kScenes, 1.01);
}

// The cached partners must give the same result as trying every pair each time.
TEST(Cluster, TakesTheCheapestPairEachTime) {
    std::mt19937 random(20250319);
    for (int i = 0; i < 20; ++i) {
        const std::vector<compiler::WeightedKey> keys = randomClusterKeys(random, 24);
        std::vector<compiler::Cluster> expected = oneEach(keys.size());
        for (int left = 23; left >= 3; --left) {
            double least = std::numeric_limits<double>::infinity();
            std::vector<compiler::Cluster> next;
            for (std::size_t a = 0; a < expected.size(); ++a) {
                for (std::size_t b = a + 1; b < expected.size(); ++b) {
                    std::vector<compiler::Cluster> tried = expected;
                    tried[a].keys.insert(tried[a].keys.end(), tried[b].keys.begin(), tried[b].keys.end());
                    std::ranges::sort(tried[a].keys);
                    tried.erase(tried.begin() + static_cast<std::ptrdiff_t>(b));
                    const double cost = totalCost(tried, keys);
                    // Equal pairs differ by rounding here, so the first pair is kept.
                    if (cost < least - 1e-9) {
                        least = cost;
                        next = std::move(tried);
                    }
                }
            }
            expected = std::move(next);
        }
        const std::vector<compiler::Cluster> clusters = agglomerate(oneEach(keys.size()), keys, 3);
        ASSERT_LE(clusters.size(), 3U);
        EXPECT_LE(totalCost(clusters, keys), totalCost(expected, keys) + 1e-6);
    }
}

// Returns ascending keys with any features, whose hits span five orders of magnitude.
std::vector<compiler::WeightedKey> wildKeys(std::mt19937& random, std::size_t count) {
    materials::FeatureMask known = 0;
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        known |= info.mask();
    }
    const auto word = [&] { return std::uint64_t{random()} << 32U | random(); };
    std::map<materials::FeatureMask, double> weights;
    while (weights.size() < count) {
        const materials::FeatureMask some = word();
        weights[some & word() & known] = std::exp2(static_cast<double>(random() % 17));
    }
    double sum = 0.0;
    for (const auto& [mask, weight] : weights) {
        sum += weight;
    }
    std::vector<compiler::WeightedKey> keys;
    keys.reserve(weights.size());
    for (const auto& [mask, weight] : weights) {
        keys.push_back({mask, weight / sum});
    }
    return keys;
}

std::vector<compiler::Cluster> clustersOf(const std::vector<compiler::CaseKeys>& cases) {
    std::vector<compiler::Cluster> clusters;
    clusters.reserve(cases.size());
    for (const compiler::CaseKeys& shaderCase : cases) {
        clusters.push_back({shaderCase.keys});
    }
    return clusters;
}

TEST(Planner, AutoCostsNoMoreThanAnyOtherPolicyWithinTheBudget) {
    constexpr unsigned kSeed = 20250322;
    RecordProperty("seed", kSeed);
    std::mt19937 random(kSeed);
    int compared = 0;
    for (int i = 0; i < 120; ++i) {
        const std::size_t count = 1 + random() % 40;
        const std::vector<compiler::WeightedKey> keys =
            i % 2 == 0 ? wildKeys(random, count) : distinctKeys(random, count);
        for (const int budget : {1, 3, 8, 32, 100}) {
            const std::vector<compiler::CaseKeys> planned =
                mergeKeys(keys, compiler::MergePolicy::Auto, budget);
            EXPECT_LE(planned.size(), static_cast<std::size_t>(budget));
            const double cost = totalCost(clustersOf(planned), keys);
            for (const compiler::MergePolicy merge :
                 {compiler::MergePolicy::None, compiler::MergePolicy::Family, compiler::MergePolicy::All}) {
                const std::vector<compiler::CaseKeys> other = mergeKeys(keys, merge, budget);
                if (other.size() <= static_cast<std::size_t>(budget)) {
                    EXPECT_LE(cost, totalCost(clustersOf(other), keys) * (1.0 + 1e-12))
                        << nameOf(merge) << ", " << count << " keys, " << budget;
                    ++compared;
                }
            }
        }
    }
    EXPECT_GT(compared, 600);
}

// This also covers more keys than the number of clusters that merging starts with.
TEST(Planner, AutoIsNoWorseThanNoneWithManyKeys) {
    std::mt19937 random(20250323);
    const std::vector<compiler::WeightedKey> keys = wildKeys(random, compiler::kMaxStart + 60);
    const std::vector<compiler::CaseKeys> planned = mergeKeys(keys, compiler::MergePolicy::Auto, 1000);
    EXPECT_LE(totalCost(clustersOf(planned), keys), compiler::kCaseCost * static_cast<double>(keys.size()));
}

TEST(Planner, MoreCasesNeverCostMore) {
    std::mt19937 random(20250324);
    for (int i = 0; i < 10; ++i) {
        const std::vector<compiler::WeightedKey> keys = distinctKeys(random, 30);
        const double one = totalCost(clustersOf(mergeKeys(keys, compiler::MergePolicy::Auto, 1)), keys);
        const double some = totalCost(clustersOf(mergeKeys(keys, compiler::MergePolicy::Auto, 6)), keys);
        const double all = totalCost(clustersOf(mergeKeys(keys, compiler::MergePolicy::Auto, 30)), keys);
        EXPECT_LE(some, one);
        EXPECT_LE(all, some);
    }
}

TEST(Planner, OrderOfEqualHitsIsThatOfTheKeys) {
    std::mt19937 random(20250325);
    std::vector<compiler::WeightedKey> keys = wildKeys(random, 70);
    for (compiler::WeightedKey& key : keys) {
        key.share = 1.0 / 70.0;
    }
    const std::vector<compiler::CaseKeys> once = mergeKeys(keys, compiler::MergePolicy::Auto, 9);
    const std::vector<compiler::CaseKeys> again = mergeKeys(keys, compiler::MergePolicy::Auto, 9);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_EQ(once[i].keys, again[i].keys);
        EXPECT_EQ(once[i].reason, again[i].reason);
    }
}

// Returns how many keys share a case with `key`, itself included.
std::size_t companyOf(const std::vector<compiler::CaseKeys>& cases, int key) {
    for (const compiler::CaseKeys& shaderCase : cases) {
        if (std::ranges::binary_search(shaderCase.keys, key)) {
            return shaderCase.keys.size();
        }
    }
    return 0;
}

// Greedy merging does not promise this, but violations must be rare.
TEST(Planner, MoreHitsOfAKeyRarelyMergeItWithMoreKeys) {
    std::mt19937 random(20250326);
    int parted = 0;
    int joined = 0;
    int steps = 0;
    for (int i = 0; i < 12; ++i) {
        const std::vector<compiler::WeightedKey> start = distinctKeys(random, 20);
        for (int key = 0; key < 20; ++key) {
            std::size_t last = start.size();
            for (int step = 0; step < 10; ++step) {
                const double weight = 1e-4 * std::pow(4.0, step);
                std::vector<compiler::WeightedKey> keys = start;
                keys[static_cast<std::size_t>(key)].share = weight;
                const double sum = 1.0 - start[static_cast<std::size_t>(key)].share + weight;
                for (compiler::WeightedKey& each : keys) {
                    each.share /= sum;
                }
                const std::size_t company = companyOf(mergeKeys(keys, compiler::MergePolicy::Auto, 32), key);
                joined += company > last ? 1 : 0;
                ++steps;
                parted += company < last ? 1 : 0;
                last = company;
            }
            EXPECT_EQ(last, 1U);
        }
    }
    RecordProperty("joined", joined);
    EXPECT_LT(joined, steps / 100);
    EXPECT_GT(parted, 20 * joined);
}

TEST(Planner, FiveHundredKeysKeepToTheBudget) {
    std::mt19937 random(20250327);
    const std::vector<compiler::WeightedKey> keys = wildKeys(random, 512);
    double last = std::numeric_limits<double>::infinity();
    for (const int budget : {1, 32, 512}) {
        const std::vector<compiler::CaseKeys> cases = mergeKeys(keys, compiler::MergePolicy::Auto, budget);
        EXPECT_LE(cases.size(), static_cast<std::size_t>(budget));
        const double cost = totalCost(clustersOf(cases), keys);
        EXPECT_LT(cost, last);
        last = cost;
    }
}

}  // namespace
