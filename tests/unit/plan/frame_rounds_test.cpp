// Tests the rays that a frame is expected to send, bounce by bounce, and what --strategy auto makes of them.
#include "plan/frame_rounds.h"

#include "plan/gpu_costs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace glint {
namespace {

// A box whose walls are squares of `keys` materials, as benchmarks/measure_paths.py makes it: a bit of the
// number says whether a material has a feature.
struct Box {
    std::vector<materials::Material> materials;
    std::vector<materials::PrimitiveInputs> primitives;

    explicit Box(std::size_t keys, float roughness) {
        for (std::size_t i = 0; i < keys; ++i) {
            materials::Material material;
            material["roughnessFactor"] = roughness;
            if ((i & 1U) != 0) {
                material.give("KHR_materials_clearcoat");
                material["clearcoatFactor"] = 1.0F;
            }
            if ((i & 2U) != 0) {
                material.give("KHR_materials_sheen");
                material["sheenColorFactor"] = {1.0F, 1.0F, 1.0F};
            }
            if ((i & 4U) != 0) {
                material.give("KHR_materials_iridescence");
                material["iridescenceFactor"] = 1.0F;
            }
            if ((i & 8U) != 0) {
                material.give("KHR_materials_anisotropy");
                material["anisotropyStrength"] = 0.5F;
            }
            materials.push_back(material);
            materials::PrimitiveInputs primitive;
            primitive.material = static_cast<int>(i);
            primitive.hasNormals = primitive.hasTangents = true;
            primitive.expectedHits = 1.0;
            primitives.push_back(primitive);
        }
    }

    double pixels = 1920.0 * 1080.0;

    std::vector<compiler::Round> rounds(std::uint32_t bounces) const {
        compiler::PlanOptions options;
        options.merge = compiler::MergePolicy::None;
        const compiler::Plan plan = makePlan(materials, primitives, options);
        EXPECT_EQ(plan.cases.size(), materials.size());
        compiler::FrameShape shape;
        shape.effects = compiler::builtinEffects({"shadow", "reflection"});
        shape.maxReflectionRoughness = 1.0F;
        shape.bounces = bounces;
        shape.pixels = pixels;
        std::vector<compiler::Round> rounds = frameRounds(materials, primitives, shape);
        setCases(rounds, roundCases(caseKeys(plan, keysOfScene(plan, options, primitives, 0))), shape);
        return rounds;
    }

    std::vector<std::string> strategies{"uber", "sorted-uber", "visibility", "hit-shaders"};

    compiler::StrategyChoice choice(std::uint32_t bounces) const {
        return *chooseStrategy(rounds(bounces), compiler::builtInCosts(false), strategies);
    }
};

double milliseconds(const compiler::StrategyChoice& choice, std::string_view strategy) {
    return std::ranges::find(choice.estimates, strategy, &compiler::StrategyEstimate::strategy)->ms;
}

TEST(FrameRounds, OfPathsHaveFewerRaysAndPart) {
    const Box box(16, 0.5F);
    EXPECT_EQ(box.rounds(1).size(), 1U);
    const std::vector<compiler::Round> rounds = box.rounds(8);
    ASSERT_EQ(rounds.size(), 8U);
    EXPECT_EQ(rounds[0].rays, box.rounds(1)[0].rays);
    EXPECT_GT(rounds[0].coherence, rounds[1].coherence);
    for (std::uint32_t i = 1; i < rounds.size(); ++i) {
        EXPECT_EQ(rounds[i].bounce, i + 1);
        EXPECT_LT(rounds[i].rays, rounds[i - 1].rays);
        EXPECT_EQ(rounds[i].coherence, rounds[1].coherence);
    }
    // Roulette leaves few from the fourth bounce on; 64 bounces cost hardly more than 8.
    EXPECT_NEAR(rounds[2].rays / rounds[1].rays, compiler::kRayHitShare, 1e-9);
    EXPECT_NEAR(rounds[3].rays / rounds[2].rays, compiler::kRayHitShare / 8.0, 1e-9);
    const double eight = factsOf(rounds, 32.0).rays;
    EXPECT_LT(factsOf(box.rounds(64), 32.0).rays, 1.001 * eight);
    // The code of a hit also chooses the next ray.
    EXPECT_GT(rounds[0].cases[0].instructions, box.rounds(1)[0].cases[0].instructions);
}

// The hits of a finished package's case are taken to run all of its code, lit shading included.
TEST(FrameRounds, OfPackagesRunWholeCases) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    const materials::FeatureMask clearcoat = model.mask("clearcoat");
    const materials::FeatureMask normals = model.mask("normals");
    const std::vector<compiler::CaseFeatures> cases{
        {normals, clearcoat | model.unlit, false}, {0, 0, true}, {clearcoat, normals, false}};
    const std::vector<compiler::CaseHits> hits{{0, 3.0}, {2, 1.0}};
    const std::vector<compiler::RoundCase> found = roundCases(compiler::caseKeys(cases, hits, model));
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].share, 0.75);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const compiler::CaseFeatures& features = cases[2 * i];
        double run = found[i].instructions;
        for (const compiler::PartialCode& part : found[i].parts) {
            run += part.share * part.instructions;
        }
        EXPECT_NEAR(run, compiler::estimateCode(features.always, features.sometimes).instructions, 1e-9);
    }
}

// docs/paths.md has the measurements on an H200: with 16 keys sorted-uber is the fastest at 1, 2 and 8
// bounces, and its time over that of uber falls from bounce to bounce.
TEST(FrameRounds, ChooseWhatIsFastestByBounces) {
    const Box box(16, 0.5F);
    double before = 1.0;
    for (const std::uint32_t bounces : {1U, 2U}) {
        const compiler::StrategyChoice choice = box.choice(bounces);
        EXPECT_EQ(choice.strategy, "sorted-uber") << choice.why;
        const double ratio = milliseconds(choice, "sorted-uber") / milliseconds(choice, "uber");
        EXPECT_LT(ratio, before);
        before = ratio;
    }
    EXPECT_EQ(box.choice(8).strategy, "sorted-uber");
    // Uber took 4.1 times as long with 2 bounces as with 1, and 10.2 times with 8. The model is within a
    // factor of 2.
    const double once = milliseconds(box.choice(1), "uber");
    EXPECT_NEAR(std::log2(milliseconds(box.choice(2), "uber") / once / 4.1), 0.0, 1.0);
    EXPECT_NEAR(std::log2(milliseconds(box.choice(8), "uber") / once / 10.2), 0.0, 1.0);
}

// Neighbours of a mirror hit alike, so that two cases are not worth an order; those of later bounces do not.
TEST(FrameRounds, BouncesChangeTheChoice) {
    Box mirrors(2, 0.0F);
    mirrors.pixels = 640.0 * 400.0;
    mirrors.strategies = {"uber", "sorted-uber"};
    const compiler::StrategyChoice once = mirrors.choice(1);
    EXPECT_EQ(once.strategy, "uber") << once.why;
    EXPECT_EQ(once.why.find("bounces"), std::string::npos) << once.why;
    const compiler::StrategyChoice often = mirrors.choice(4);
    EXPECT_EQ(often.strategy, "sorted-uber") << often.why;
    EXPECT_NE(often.why.find(" in 4 bounces, 55 % of them after the first"), std::string::npos) << often.why;
}

}  // namespace
}  // namespace glint
