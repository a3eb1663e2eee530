// Tests the precision ladder: it has every rung, its errors are within the bounds of the functions, and its
// statistics are right. About times it only tests that there are some.
#include "ladder.h"

#include "ladder_report.h"
#include "support/must.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace glint::numerics {
namespace {

TEST(Spread, IsThatOfOrderStatistics) {
    std::vector<double> values(15);
    std::iota(values.rbegin(), values.rend(), 1.0);
    const Spread spread = spreadOf(values);
    EXPECT_EQ(spread.median, 8.0);
    EXPECT_EQ(spread.q1, 4.5);
    EXPECT_EQ(spread.q3, 11.5);
    // The probabilities of both tails of 15 trials are 3.5 % for 3 or fewer successes, 11.8 % for 4.
    EXPECT_EQ(spread.low, 4.0);
    EXPECT_EQ(spread.high, 12.0);
}

TEST(Spread, OfFewIsAllThereAre) {
    for (const std::size_t count : {1U, 2U, 3U, 5U}) {
        std::vector<double> values(count);
        std::iota(values.begin(), values.end(), 1.0);
        EXPECT_EQ(spreadOf(values).low, 1.0);
        EXPECT_EQ(spreadOf(values).high, static_cast<double>(count));
    }
}

TEST(Spread, TiesOverlap) {
    const auto between = [](double low, double high) {
        return Spread{0.5 * (low + high), low, high, low, high};
    };
    EXPECT_TRUE(isTie(between(1, 2), between(2, 3)));
    EXPECT_TRUE(isTie(between(1, 4), between(2, 3)));
    EXPECT_FALSE(isTie(between(1, 2), between(2.1, 3)));
    EXPECT_FALSE(isTie(between(5, 6), between(2, 3)));
}

TEST(Ladder, HasEveryFunctionWithATextbookForm) {
    const std::vector<Probe> probes = ladderProbes();
    int textbooks = 0;
    for (const Probe& probe : allProbes()) {
        const bool climbs =
            std::ranges::any_of(probes, [&](const Probe& candidate) { return candidate.name == probe.name; });
        textbooks += probe.textbook.empty() ? 0 : 1;
        EXPECT_TRUE(climbs || probe.textbook.empty() || probe.name == "RunningMean") << probe.name;
    }
    EXPECT_GT(textbooks, 10);
    for (const char* const name : {"EvaluateBsdf", "SampleBsdf", "IridescentFresnel", "GgxVisibility",
                                   "GgxAlbedo", "SheenVisibility", "RefractDirection"}) {
        EXPECT_TRUE(std::ranges::any_of(probes, [&](const Probe& probe) { return probe.name == name; }))
            << name;
    }
}

TEST(LadderJson, IsRefusedWhereItIsNone) {
    for (
        const char* const text :
        {"", "[]", "{}", R"({"device": 1})",
         R"({"device": "", "half": true, "inputs": 1, "seed": 1, "rounds": 1, "functions": [{"name": "none"}]})"}) {
        const Result<Ladder> ladder = ladderFromJson(text);
        ASSERT_FALSE(ladder) << text;
        EXPECT_EQ(ladder.error().id, "ladder-format");
    }
}

class LadderOf : public ::testing::TestWithParam<const char*> {};

TEST_P(LadderOf, HasEveryRungWithinItsBounds) {
    const Result<std::unique_ptr<ProbeDevice>> device = ProbeDevice::create({{}, false});
    if (!device) {
        GTEST_SKIP() << "no device to test on: " << toString(device.error());
    }
    LadderOptions options;
    options.inputs = 4000;
    options.rounds = 2;
    options.leastMilliseconds = 0.0;
    options.function = GetParam();
    const Ladder ladder = must(climb(**device, options));
    ASSERT_EQ(ladder.rows.size(), 1U);
    const LadderRow& row = ladder.rows.front();
    const Rung* const ours = row.find(RungKind::Single);
    const Rung* const twice = row.find(RungKind::Double);
    ASSERT_TRUE(ours != nullptr && twice != nullptr);
    EXPECT_GT(*ours->instructions, 0U);
    EXPECT_EQ(ours->errors->notFinite, 0.0);
    EXPECT_LE(ours->errors->worst, row.probe.bounds.worst);
    EXPECT_LE(ours->errors->median, row.probe.bounds.median);
    EXPECT_FALSE(twice->errors);
    EXPECT_GT(twice->nanoseconds.low, 0.0);
    if (!row.probe.textbook.empty()) {
        const Rung* const textbook = row.find(RungKind::Textbook);
        ASSERT_NE(textbook, nullptr);
        EXPECT_GT(textbook->errors->worst, ours->errors->worst);
    }
    if ((*device)->hasHalf()) {
        const Rung* const half = row.find(RungKind::Half);
        ASSERT_NE(half, nullptr);
        EXPECT_GT(half->errors->worst, 100.0 * ours->errors->worst);
        if (const Rung* const mixed = row.find(RungKind::Mixed)) {
            EXPECT_EQ(mixed->errors->notFinite, 0.0);
            EXPECT_LT(mixed->errors->median, half->errors->median + 1e-12);
        }
    }
    const nlohmann::json json = nlohmann::json::parse(toJson(ladder));
    EXPECT_EQ(json.at("functions").at(0).at("rungs").size(), row.rungs.size());
    const std::string table = toMarkdown(ladder);
    const Ladder again = must(ladderFromJson(toJson(ladder)));
    EXPECT_EQ(toMarkdown(again), table);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(table, '\n')), 4 + row.rungs.size()) << table;
}

INSTANTIATE_TEST_SUITE_P(Functions, LadderOf,
                         ::testing::Values("fresnelSchlick", "fresnelInterface", "ggxDistribution",
                                           "ggxVisibility", "evaluateBsdf, all lobes but sheen",
                                           "evaluateBsdf, all lobes"));

}  // namespace
}  // namespace glint::numerics
