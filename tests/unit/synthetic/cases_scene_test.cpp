// Generated scenes must have as many keys as asked for, whatever the other options are.
#include "synthetic/cases_scene.h"

#include "gltf/import.h"
#include "plan/plan.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>

namespace glint::synthetic {
namespace {

compiler::Plan planOf(const gltf::Scene& scene) {
    compiler::PlanOptions options;
    options.merge = compiler::MergePolicy::None;
    return makePlan(scene.materials, planningInputs(scene), options);
}

TEST(CasesScene, HasAsManyKeysAsCases) {
    for (const synthetic::Cost cost : {synthetic::Cost::Cheap, synthetic::Cost::Expensive}) {
        for (const synthetic::Coherence coherence :
             {synthetic::Coherence::Coherent, synthetic::Coherence::Incoherent}) {
            for (const int cases : {1, 2, 3, 4, 16, 64, 255, 256}) {
                const gltf::Scene scene = makeCasesScene({cases, cost, coherence});
                const compiler::Plan plan = planOf(scene);
                EXPECT_EQ(plan.keys.size(), static_cast<std::size_t>(cases)) << nameOf(cost);
                EXPECT_EQ(plan.cases.size(), static_cast<std::size_t>(cases)) << nameOf(cost);
                EXPECT_TRUE(plan.dropped.empty())
                    << cases << " " << plan.dropped[0].feature << ": " << plan.dropped[0].reason;
            }
        }
    }
}

// Only the options may decide, not their side effects: the scenes of one cost share their cases.
TEST(CasesScene, HasTheSameKeysHoweverRaysGo) {
    for (const synthetic::Cost cost : {synthetic::Cost::Cheap, synthetic::Cost::Expensive}) {
        const compiler::Plan mirror = planOf(makeCasesScene({16, cost, synthetic::Coherence::Coherent}));
        const compiler::Plan rough = planOf(makeCasesScene({16, cost, synthetic::Coherence::Incoherent}));
        ASSERT_EQ(mirror.keys.size(), rough.keys.size());
        for (std::size_t i = 0; i < mirror.keys.size(); ++i) {
            EXPECT_EQ(mirror.keys[i].mask, rough.keys[i].mask);
        }
    }
}

// The average number of features of keys: work must not grow with the number of cases.
TEST(CasesScene, KeepsItsWork) {
    for (const synthetic::Cost cost : {synthetic::Cost::Cheap, synthetic::Cost::Expensive}) {
        std::map<int, double> features;
        for (const int cases : {4, 16, 64, 256}) {
            for (const compiler::Key& key : planOf(makeCasesScene({cases, cost})).keys) {
                // Texture coordinates are in a key for any texture, so they are not one of the switches.
                features[cases] += (key.mask & ~bit("texCoord0")).count() / double(cases);
            }
        }
        EXPECT_NEAR(features[4], features[256], 1e-9) << nameOf(cost);
        EXPECT_NEAR(features[16], features[256], 1e-9) << nameOf(cost);
        EXPECT_NEAR(features[64], features[256], 1e-9) << nameOf(cost);
    }
}

TEST(CasesScene, GivesEveryCaseATile) {
    for (const synthetic::Coherence coherence :
         {synthetic::Coherence::Coherent, synthetic::Coherence::Incoherent}) {
        for (const synthetic::Shares shares : {synthetic::Shares::Uniform, synthetic::Shares::Zipf}) {
            for (const int cases : {1, 3, 64, 256}) {
                const synthetic::CasesOptions options{cases, synthetic::Cost::Cheap, coherence, shares};
                const synthetic::Ceiling ceiling = makeCeiling(options);
                std::map<int, std::size_t> tiles;
                for (const int index : ceiling.cases) {
                    ++tiles[index];
                }
                ASSERT_EQ(tiles.size(), static_cast<std::size_t>(cases));
                EXPECT_EQ(ceiling.cases.size(), static_cast<std::size_t>(ceiling.tiles * ceiling.tiles));
                const double all = static_cast<double>(ceiling.cases.size());
                // The first case is least affected by rounding and by the tiles given to cases below one
                // tile.
                EXPECT_NEAR(static_cast<double>(tiles[0]) / all, sharesOf(options)[0], 0.06);
                EXPECT_TRUE(std::ranges::is_sorted(
                                tiles, [](const auto& a, const auto& b) { return a.second > b.second; }) ||
                            shares == synthetic::Shares::Uniform);
                const gltf::Scene scene = makeCasesScene(options);
                std::size_t triangles = 0;
                for (const gltf::Primitive& primitive : scene.meshes[1].primitives) {
                    triangles += primitive.indices.size() / 3;
                }
                EXPECT_EQ(triangles, 2 * ceiling.cases.size());
            }
        }
    }
}

// Fronts must face the rays, because hits of back faces are culled.
TEST(CasesScene, FacesItsRays) {
    const gltf::Scene scene =
        makeCasesScene({4, synthetic::Cost::Expensive, synthetic::Coherence::Incoherent});
    for (std::size_t mesh = 0; mesh < 2; ++mesh) {
        for (const gltf::Primitive& primitive : scene.meshes[mesh].primitives) {
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                const gltf::Float3& a = primitive.positions[primitive.indices[i]];
                const gltf::Float3& b = primitive.positions[primitive.indices[i + 1]];
                const gltf::Float3& c = primitive.positions[primitive.indices[i + 2]];
                // This is the height of the cross product of two edges.
                const float up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
                ASSERT_GT(mesh == 0 ? up : -up, 0.0F);
                ASSERT_EQ(primitive.normals[primitive.indices[i]][1], mesh == 0 ? 1.0F : -1.0F);
            }
        }
    }
}

TEST(CasesScene, IsLitByTheSkyAloneUnlessAskedElse) {
    EXPECT_TRUE(makeCasesScene({}).lights.empty());
    synthetic::CasesOptions options;
    options.lights = 3;
    EXPECT_EQ(makeCasesScene(options).lights.size(), 3U);
}

}  // namespace
}  // namespace glint::synthetic
