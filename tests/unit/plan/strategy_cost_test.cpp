// Tests the model behind --strategy auto: its formula against brute force, and its choices.
#include "plan/strategy_cost.h"

#include "plan/cost.h"
#include "plan/gpu_costs.h"
#include "plan/merge.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace glint {
namespace {

compiler::Round makeRound(std::size_t cases, double instructions, double coherence, double rays = 8e6) {
    compiler::Round round{rays, 0.8, coherence, 1.0 - coherence, {}};
    for (std::size_t i = 0; i < cases; ++i) {
        round.cases.push_back({1.0 / static_cast<double>(cases), instructions, 0.0});
    }
    return round;
}

void set(compiler::StrategyCosts& costs, compiler::CostTerm term, double value) {
    costs.constants[static_cast<std::size_t>(term)] = value;
}

// Returns a device with round numbers, on which ordering a ray takes a nanosecond.
compiler::DeviceCosts someDevice() {
    compiler::DeviceCosts device;
    device.device = "Some";
    device.subgroupSize = 32.0;
    for (const std::string_view name : compiler::simplestFirst()) {
        compiler::StrategyCosts& costs = device.strategies.emplace_back();
        costs.strategy = name;
        const bool ordered = hasTerm(name, compiler::CostTerm::Buckets);
        set(costs, compiler::CostTerm::Launches, ordered ? 0.1 : 0.02);
        set(costs, compiler::CostTerm::Rays, ordered ? 1.5 : 0.5);
        set(costs, compiler::CostTerm::Incoherence, 0.2);
        set(costs, compiler::CostTerm::Instructions, name == "hit-shaders" ? 0.3 : 0.2);
        set(costs, compiler::CostTerm::Cases, name == "visibility" ? 0.005 : 0.0);
        set(costs, compiler::CostTerm::Divergence, ordered ? 0.0 : 0.2);
    }
    return device;
}

const std::vector<std::string> kAll(compiler::simplestFirst().begin(), compiler::simplestFirst().end());

std::string chosen(const compiler::Round& round, const std::vector<std::string>& available = kAll) {
    const auto choice = chooseStrategy({&round, 1}, someDevice(), available);
    return choice ? choice->strategy : "none";
}

double ms(const compiler::Round& round, std::string_view strategy) {
    const compiler::DeviceCosts device = someDevice();
    return estimatedMs(round, *findCosts(device, strategy), device.subgroupSize);
}

TEST(StrategyCost, RunsWhatSubgroupsOfRandomHitsRun) {
    compiler::Round round{1.0, 0.7, 0.0, 1.0, {{0.5, 100.0, 0.0}, {0.3, 400.0, 2.0}, {0.2, 1000.0, 0.0}}};
    round.cases[1].parts = {{0.25, 700.0, 1.0}};
    constexpr int kLanes = 8;
    constexpr int kGroups = 200000;
    std::mt19937 random(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same draws in every run
    std::uniform_real_distribution<double> uniform;
    double mixed = 0.0;   // work of subgroups of any hits
    double sorted = 0.0;  // work of subgroups of one case's hits
    for (int group = 0; group < kGroups; ++group) {
        std::vector<bool> hit(round.cases.size());
        bool hitsPart = false;
        bool partOfSorted = false;
        for (int lane = 0; lane < kLanes; ++lane) {
            double draw = uniform(random) / round.hitShare;
            for (std::size_t i = 0; i < hit.size(); ++i) {
                if (draw >= 0.0 && draw < round.cases[i].share) {
                    hit[i] = true;
                    hitsPart = hitsPart || (i == 1 && draw < 0.25 * round.cases[i].share);
                }
                draw -= round.cases[i].share;
            }
            partOfSorted = partOfSorted || uniform(random) < 0.25;
        }
        const double part = 700.0 + compiler::kFetchCost;
        for (std::size_t i = 0; i < hit.size(); ++i) {
            const double work = weightOf(round.cases[i]);
            mixed += hit[i] ? work : 0.0;
            sorted += round.hitShare * round.cases[i].share * (work + (i == 1 && partOfSorted ? part : 0.0));
        }
        mixed += hitsPart ? part : 0.0;
    }
    EXPECT_NEAR(unsortedWork(round, kLanes) / (mixed / kGroups), 1.0, 0.005);
    EXPECT_NEAR(sortedWork(round, kLanes) / (sorted / kGroups), 1.0, 0.005);
    EXPECT_NEAR(unsortedWork(round, 1.0), sortedWork(round, 1.0), 1e-9);
}

TEST(StrategyCost, OneLaneRunsItsOwnCaseAlone) {
    const compiler::Round round{1.0, 0.6, 1.0, 0.0, {{0.75, 200.0, 1.0}, {0.25, 1000.0, 0.0}}};
    EXPECT_NEAR(unsortedWork(round, 1.0), 0.6 * (0.75 * (200.0 + compiler::kFetchCost) + 0.25 * 1000.0),
                1e-9);
    EXPECT_DOUBLE_EQ(compiler::independentLanes(32.0, 1.0), 1.0);
    EXPECT_DOUBLE_EQ(compiler::independentLanes(32.0, 0.0), 32.0);
    const compiler::TermValues terms = termsOf(round, 32.0);
    EXPECT_EQ(terms[static_cast<std::size_t>(compiler::CostTerm::Divergence)], 0.0);
}

TEST(StrategyCost, GrowsWithRaysWorkAndDivergence) {
    for (const std::string_view strategy : compiler::simplestFirst()) {
        EXPECT_LT(ms(makeRound(16, 800, 0.5, 1e6), strategy), ms(makeRound(16, 800, 0.5, 2e6), strategy));
        EXPECT_LT(ms(makeRound(16, 400, 0.5), strategy), ms(makeRound(16, 800, 0.5), strategy));
        EXPECT_LT(ms(makeRound(16, 800, 0.9), strategy), ms(makeRound(16, 800, 0.1), strategy));
        EXPECT_LE(ms(makeRound(16, 800, 0.5), strategy), ms(makeRound(64, 800, 0.5), strategy));
        EXPECT_EQ(ms(makeRound(16, 800, 0.5, 0.0), strategy), 0.0);
    }
}

TEST(StrategyCost, OneCaseIsNeverOrdered) {
    for (const double instructions : {50.0, 700.0, 5000.0}) {
        for (const double coherence : {0.0, 0.5, 1.0}) {
            for (const double rays : {1e3, 1e6, 3.2e7}) {
                compiler::Round round = makeRound(1, instructions, coherence, rays);
                round.hitShare = 1.0;
                EXPECT_EQ(chosen(round), "uber") << instructions << " " << coherence << " " << rays;
            }
        }
    }
}

TEST(StrategyCost, ManyExpensiveIncoherentCasesAreOrdered) {
    EXPECT_EQ(chosen(makeRound(64, 2000, 0.0)), "sorted-uber");
    EXPECT_EQ(chosen(makeRound(64, 2000, 0.0), {"uber", "visibility"}), "visibility");
    EXPECT_EQ(chosen(makeRound(64, 2000, 1.0)), "uber");
    // Few rays don't pay for the additional passes.
    EXPECT_EQ(chosen(makeRound(64, 2000, 0.0, 2000.0)), "uber");
}

TEST(StrategyCost, TakesTheLeastEstimateOfWhatThereIs) {
    for (const double coherence : {0.0, 0.7, 1.0}) {
        for (const std::size_t cases : {1U, 4U, 16U, 256U}) {
            const compiler::Round round = makeRound(cases, 900, coherence);
            const auto choice = chooseStrategy({&round, 1}, someDevice(), kAll);
            ASSERT_TRUE(choice);
            ASSERT_EQ(choice->estimates.size(), 4U);
            for (const compiler::StrategyEstimate& estimate : choice->estimates) {
                EXPECT_GE(estimate.ms, ms(round, choice->strategy));
                EXPECT_NEAR(std::accumulate(estimate.parts.begin(), estimate.parts.end(), 0.0), estimate.ms,
                            1e-9);
            }
        }
    }
}

TEST(StrategyCost, StrategiesWithoutConstantsAreNotChosen) {
    compiler::DeviceCosts device = someDevice();
    const compiler::Round round = makeRound(64, 2000, 0.0);
    std::erase_if(device.strategies,
                  [](const compiler::StrategyCosts& costs) { return costs.strategy != "visibility"; });
    const std::vector<std::string> uber{"uber"};
    EXPECT_FALSE(chooseStrategy({&round, 1}, device, uber));
    EXPECT_FALSE(chooseStrategy({&round, 1}, device, {}));
    const auto choice = chooseStrategy({&round, 1}, device, kAll);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->strategy, "visibility");
    EXPECT_EQ(choice->estimates.size(), 1U);
}

TEST(StrategyCost, SaysWhyInNumbers) {
    const compiler::Round round = makeRound(64, 2000, 0.0);
    const auto choice = chooseStrategy({&round, 1}, someDevice(), kAll);
    ASSERT_TRUE(choice);
    EXPECT_NE(choice->why.find("8,000,000 rays, 64 cases, 2,000 instructions a hit"), std::string::npos)
        << choice->why;
    EXPECT_NE(choice->why.find("runs 21.2 cases"), std::string::npos) << choice->why;
    EXPECT_NE(choice->why.find("sorted-uber"), std::string::npos) << choice->why;
    const auto nothing = chooseStrategy({}, someDevice(), kAll);
    ASSERT_TRUE(nothing);
    EXPECT_EQ(nothing->strategy, "uber");
    EXPECT_NE(nothing->why.find("No effect sends rays"), std::string::npos);
}

compiler::ModuleCost moduleOf(const char* role, double cost, double occupancy, double spills = 0.0) {
    compiler::ModuleCost module;
    module.role = role;
    module.tracer = "ray-query";
    module.modules = 1;
    module.cost = cost;
    module.weight = 2000.0;
    module.occupancy = occupancy;
    module.leastOccupancy = occupancy;
    module.spills = spills;
    return module;
}

// A GPU on which the switch of uber has a quarter of the occupancy that cases have.
compiler::GpuCosts someGpu() {
    compiler::GpuCosts gpu{"some", "Some GPU", "driver", 64.0, {}};
    gpu.packages.push_back({"none",
                            "none",
                            "inline",
                            32,
                            {moduleOf("ShadeCase", 1000.0, 0.8), moduleOf("UberShade", 3000.0, 0.2),
                             moduleOf("SortedShade", 2000.0, 0.4, 100.0)}});
    return gpu;
}

double constantOf(const compiler::DeviceCosts& device, const char* strategy, compiler::CostTerm term) {
    return findCosts(device, strategy)->constants[static_cast<std::size_t>(term)];
}

TEST(GpuCosts, MakeInstructionsCostWhatOccupancyAndSpillsSay) {
    const auto factors = strategyFactors(someGpu());
    ASSERT_EQ(factors.size(), 3U);
    for (const compiler::StrategyFactor& factor : factors) {
        const double expected = factor.strategy == "uber"          ? 4.0
                                : factor.strategy == "sorted-uber" ? 4.0
                                                                   : 1.0;
        EXPECT_NEAR(factor.factor, expected, 1e-12) << factor.strategy;  // 100 spills double an instruction
    }
    const compiler::DeviceCosts measured = someDevice();
    const compiler::DeviceCosts costs = withGpu(measured, someGpu());
    EXPECT_EQ(costs.subgroupSize, 64.0);
    using enum compiler::CostTerm;
    const double ofCases = constantOf(measured, "visibility", Instructions);
    EXPECT_NEAR(constantOf(costs, "visibility", Instructions), ofCases, 1e-12);
    EXPECT_NEAR(constantOf(costs, "uber", Instructions), 4.0 * ofCases, 1e-12);
    EXPECT_NEAR(constantOf(costs, "uber", Divergence) / constantOf(costs, "uber", Instructions),
                constantOf(measured, "uber", Divergence) / constantOf(measured, "uber", Instructions), 1e-12);
    EXPECT_EQ(constantOf(costs, "uber", Rays), constantOf(measured, "uber", Rays));
    EXPECT_EQ(findCosts(costs, "hit-shaders"), nullptr) << "its time would be that of another GPU";
}

TEST(GpuCosts, TurnAChoice) {
    // Coherent hits of two cases gain little by being ordered, unless uber has few subgroups in flight.
    const compiler::Round round = makeRound(2, 4000, 0.9);
    const std::vector<std::string> some{"uber", "visibility"};
    const auto before = chooseStrategy({&round, 1}, someDevice(), some);
    const auto after = chooseStrategy({&round, 1}, withGpu(someDevice(), someGpu()), some);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->strategy, "uber") << before->why;
    EXPECT_EQ(after->strategy, "visibility") << after->why;
}

// Spills alone make uber slower than ordering, and without a table the choice is the measured one.
TEST(GpuCosts, SpillsTurnAChoice) {
    const compiler::Round round = makeRound(2, 4000, 0.9);
    const std::vector<std::string> some{"uber", "visibility"};
    const auto strategyWith = [&](double spills) {
        compiler::GpuCosts gpu{"some", "Some GPU", "driver", 32.0, {}};
        gpu.packages.push_back(
            {"none",
             "none",
             "inline",
             32,
             {moduleOf("ShadeCase", 1000.0, 0.5), moduleOf("UberShade", 1000.0, 0.5, spills)}});
        return chooseStrategy({&round, 1}, withGpu(someDevice(), gpu), some)->strategy;
    };
    EXPECT_EQ(strategyWith(0.0), "uber");
    EXPECT_EQ(strategyWith(500.0), "visibility");
}

// A hit stores and loads each word of the stack of a pipeline of hit shaders.
TEST(GpuCosts, StacksOfHitShadersCount) {
    compiler::GpuCosts gpu = someGpu();
    compiler::ModuleCost hitShaders = moduleOf("HitTrace", 1000.0, 0.8);
    hitShaders.weight = 50'000.0;  // of all cases together
    gpu.packages.front().modules.push_back(hitShaders);
    const auto factorOf = [&gpu](std::string_view strategy) {
        const auto factors = strategyFactors(gpu);
        return std::ranges::find(factors, strategy, &compiler::StrategyFactor::strategy)->factor;
    };
    EXPECT_NEAR(factorOf("hit-shaders"), 1.0, 1e-12);
    gpu.packages.front().modules.back().scratchBytes = 400.0;  // 100 words, each a fetch of 2000 instructions
    EXPECT_NEAR(factorOf("hit-shaders"), 2.0, 1e-12);
    gpu.packages.front().modules[1].scratchBytes = 400.0;
    EXPECT_NEAR(factorOf("uber"), 4.0, 1e-12) << "scratch of a switch is for spills, which count already";
    EXPECT_NE(describe(gpu).find("a stack of 400 bytes"), std::string::npos) << describe(gpu);
}

// Adds packages to compare: cases that branch, cases without their shadow rays, and cases in 16 bits.
compiler::GpuCosts comparedGpu(double familyOccupancy, double deferredCost, double halfCost) {
    compiler::GpuCosts gpu = someGpu();
    gpu.packages.push_back(
        {"family", "family", "inline", 32, {moduleOf("ShadeCase", 1500.0, familyOccupancy)}});
    gpu.packages.push_back({"deferred",
                            "none",
                            "deferred",
                            32,
                            {moduleOf("ShadeCase", deferredCost, 1.0), moduleOf("ShadowTrace", 300.0, 1.0)}});
    gpu.packages.push_back({"half", "none", "inline", 16, {moduleOf("ShadeCase", halfCost, 0.8)}});
    return gpu;
}

TEST(GpuCosts, ChooseWhereShadowsAreTraced) {
    const auto shadowsOf = [](double deferredCost) {
        const compiler::GpuCosts gpu = comparedGpu(0.5, deferredCost, 1000.0);
        const compiler::GpuChoice choice = chooseSettings(&gpu, 0.0).front();
        EXPECT_EQ(choice.setting, "shadows");
        EXPECT_TRUE(choice.known);
        return choice.value;
    };
    EXPECT_EQ(shadowsOf(400.0), "deferred");
    EXPECT_EQ(shadowsOf(650.0), "inline") << "a twentieth is not worth records and a pass";
    EXPECT_EQ(shadowsOf(900.0), "inline");
}

TEST(GpuCosts, ChooseSixteenBitsOnlyWhereTheirErrorIsAccepted) {
    const auto precisionOf = [](double halfCost, double acceptedError) {
        const compiler::GpuCosts gpu = comparedGpu(0.5, 900.0, halfCost);
        const compiler::GpuChoice choice = chooseSettings(&gpu, acceptedError).back();
        EXPECT_EQ(choice.setting, "precision");
        EXPECT_TRUE(choice.known);
        EXPECT_FALSE(choice.why.empty());
        return choice.value;
    };
    EXPECT_EQ(precisionOf(700.0, 0.0), "32");
    EXPECT_EQ(precisionOf(700.0, 0.9 * compiler::kHalfError), "32");
    EXPECT_EQ(precisionOf(700.0, compiler::kHalfError), "16");
    EXPECT_EQ(precisionOf(950.0, 1.0), "32") << "a twentieth is not worth an error";
}

TEST(GpuCosts, WhatTheTableLacksStaysAndIsSaid) {
    const compiler::GpuCosts gpu = someGpu();
    for (const compiler::GpuCosts* const table : {static_cast<const compiler::GpuCosts*>(nullptr), &gpu}) {
        const auto choices = chooseSettings(table, 1.0);
        ASSERT_EQ(choices.size(), 2U);
        EXPECT_EQ(choices[0].value, "inline");
        EXPECT_EQ(choices[1].value, "32");
        for (const compiler::GpuChoice& choice : choices) {
            EXPECT_FALSE(choice.known);
            EXPECT_NE(choice.why.find("able of "), std::string::npos) << choice.why;
        }
    }
    EXPECT_FALSE(branchFactor(gpu));
    EXPECT_NE(describe(gpu).find("no package of --merge family"), std::string::npos);
    EXPECT_NE(describe(gpu).find("hit-shaders: the table has no numbers"), std::string::npos);
    EXPECT_NEAR(branchFactor(comparedGpu(0.5, 900.0, 1000.0)).value_or(0.0), 1.6, 1e-12);
}

// Branches that cost occupancy make --merge auto keep keys apart.
TEST(GpuCosts, TurnAMerge) {
    const auto casesWith = [](double familyOccupancy) {
        std::vector<compiler::WeightedKey> keys{{bit("normals"), 0.1},
                                                {bit("normals") | bit("doubleSided"), 0.1}};
        for (compiler::WeightedKey& key : keys) {
            key.branchFactor = branchFactor(comparedGpu(familyOccupancy, 900.0, 1000.0)).value_or(1.0);
        }
        return mergeKeys(keys, compiler::MergePolicy::Auto, compiler::kDefaultMaxCases).size();
    };
    EXPECT_EQ(casesWith(0.8), 1U);
    EXPECT_EQ(casesWith(0.2), 2U);
}

TEST(GpuCosts, OfNoModulesChangeNothing) {
    compiler::GpuCosts gpu{"none", "", "", 32.0, {{"none", "none", "inline", 32, {}}}};
    EXPECT_TRUE(strategyFactors(gpu).empty());
    EXPECT_FALSE(branchFactor(gpu));
    EXPECT_FALSE(chooseSettings(&gpu, 1.0).front().known);
    EXPECT_EQ(withGpu(someDevice(), gpu).strategies.front().constants,
              someDevice().strategies.front().constants);
}

}  // namespace
}  // namespace glint
