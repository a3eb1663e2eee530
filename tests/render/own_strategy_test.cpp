// The strategy that docs/strategies.md makes, as it is printed. This program is linked with a copy of the
// table that has its row, and with its shaders among those of Glint; all else is the product.
#include "emit/compile.h"
#include "plan/strategy_cost.h"
#include "render/pixel_test.h"
#include "settings/settings.h"

#include <glint/internal/package_modules.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

const package::StrategyInfo& splitUber() {
    return *package::findStrategy("split-uber");
}

// A mirror that sees a wall on its left and the sky on its right.
gltf::Scene mirrorAndWall() {
    gltf::Scene scene = sceneWithCamera();
    materials::Material wall;
    wall["baseColorFactor"] = {0.75F, 0.5F, 0.25F, 1};
    wall["metallicFactor"] = 0.0F;
    wall.doubleSided = true;
    const int mirrorNumber = addMaterial(scene, mirrorMaterial());
    const int wallNumber = addMaterial(scene, wall);
    addQuad(scene, mirrorNumber, {-4, -4, -2}, {8, 0, 0}, {0, 8, 0});
    addQuad(scene, wallNumber, {-40, -40, 3}, {40, 0, 0}, {0, 80, 0});
    return scene;
}

TEST(OwnStrategy, IsKnownByItsRow) {
    const package::StrategyInfo& info = splitUber();
    EXPECT_EQ(info.strategy, package::strategyTable().back().strategy);
    EXPECT_TRUE(info.ordersHits && info.fillsWorkgroups);
    EXPECT_FALSE(info.dispatchesCases || info.ownPipeline);
    const std::vector<std::string_view> names(compiler::simplestFirst().begin(),
                                              compiler::simplestFirst().end());
    EXPECT_EQ(names, (std::vector<std::string_view>{"uber", "sorted-uber", "split-uber", "visibility",
                                                    "hit-shaders"}));
    EXPECT_TRUE(compiler::hasTerm("split-uber", compiler::CostTerm::Buckets));
}

TEST(OwnStrategy, DrawsThePictureOfUber) {
    const gltf::Scene scene = mirrorAndWall();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber | splitUber().strategy;
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::None;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = defaultSetup(scene, 16, 16);
    Renderer::Counters counters;
    const LinearImage reference = loaded.render(package::kStrategyUber, setup, &counters);
    const Renderer::EffectCounters reflection = counters.of(loaded.package().effect("reflection"));
    EXPECT_GT(reflection.hits, 0U);
    EXPECT_GT(reflection.misses, 0U);
    for (const package::Tracer tracer : package::kTracers) {
        RendererOptions options{splitUber().strategy};
        options.tracer = tracer;
        expectSameImage(loaded.render(options, setup), reference, std::string(nameOf(tracer)));
    }
}

}  // namespace
