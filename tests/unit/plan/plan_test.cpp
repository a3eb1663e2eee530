// Tests keys, cases and IDs of hand-made scenes under each merge policy.
#include "plan/plan.h"

#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace {

using namespace glint;

const materials::FeatureMask kNormals = bit("normals");
const materials::FeatureMask kTextured = bit("baseColorTexture") | bit("texCoord0");

// Materials: 0 plain, 1 plain with other values, 2 textured, 3 unlit, 4 unlit and textured.
struct SmallScene {
    std::vector<materials::Material> materials{5};
    std::vector<materials::PrimitiveInputs> primitives;

    SmallScene() {
        materials[1]["roughnessFactor"] = 0.2F;
        materials[2].texture("baseColorTexture").texture = 0;
        materials[3].give("KHR_materials_unlit");
        materials[4].give("KHR_materials_unlit");
        materials[4].texture("baseColorTexture").texture = 0;
        for (int material = 0; material < 5; ++material) {
            materials::PrimitiveInputs primitive;
            primitive.primitive = material;
            primitive.material = material;
            primitive.hasNormals = true;
            primitive.hasTexCoords0 = true;
            primitives.push_back(primitive);
        }
        // A second primitive of material 0 has no normals, and so another key.
        materials::PrimitiveInputs flat;
        flat.mesh = 1;
        primitives.push_back(flat);
    }

    compiler::Plan plan(compiler::MergePolicy merge) const {
        return compiler::makePlan(materials, primitives, {{}, merge});
    }
};

TEST(Plan, GivesEachPermutationAKey) {
    const compiler::Plan plan = SmallScene().plan(compiler::MergePolicy::None);
    ASSERT_EQ(plan.keys.size(), 5U);
    const materials::FeatureMask unlit = bit("unlit");
    EXPECT_EQ(plan.keys[0].mask, 0U);
    EXPECT_EQ(plan.keys[1].mask, unlit);
    EXPECT_EQ(plan.keys[2].mask, kTextured | unlit);
    EXPECT_EQ(plan.keys[3].mask, kNormals);
    EXPECT_EQ(plan.keys[4].mask, kTextured | kNormals);
    EXPECT_EQ(plan.keys[3].materials, (std::vector<int>{0, 1}));
    EXPECT_EQ(plan.keyOfPrimitive, (std::vector<int>{3, 3, 4, 1, 2, 0}));
    // unlit, base colour texture, UV set 0, normals
    EXPECT_EQ(plan.keysPossible, 16.0);
}

TEST(Plan, NoneMakesEveryKeyACase) {
    const compiler::Plan plan = SmallScene().plan(compiler::MergePolicy::None);
    ASSERT_EQ(plan.cases.size(), 5U);
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        EXPECT_EQ(plan.cases[i].shaderId, static_cast<int>(i));
        EXPECT_EQ(plan.cases[i].always, plan.keys[i].mask);
        EXPECT_EQ(plan.cases[i].sometimes, 0U);
        EXPECT_EQ(plan.keys[i].shaderId, static_cast<int>(i));
    }
    EXPECT_EQ(plan.cases[4].name, "Pbr_BaseTex_Uv0_Normals");
    EXPECT_EQ(plan.cases[2].name, "Unlit_BaseTex_Uv0");
}

TEST(Plan, FamilyMergesKeysWithTheSameLobes) {
    const compiler::Plan plan = SmallScene().plan(compiler::MergePolicy::Family);
    ASSERT_EQ(plan.cases.size(), 2U);
    EXPECT_EQ(plan.cases[0].name, "PbrFamily");
    EXPECT_EQ(plan.cases[0].always, 0U);
    EXPECT_EQ(plan.cases[0].sometimes, kTextured | kNormals);
    EXPECT_EQ(plan.cases[0].materials, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(plan.cases[1].always, bit("unlit"));
    EXPECT_EQ(plan.cases[1].sometimes, kTextured);
    EXPECT_EQ(plan.cases[1].keys, (std::vector<int>{1, 2}));
}

TEST(Plan, AllMakesOneCase) {
    const compiler::Plan plan = SmallScene().plan(compiler::MergePolicy::All);
    ASSERT_EQ(plan.cases.size(), 1U);
    EXPECT_EQ(plan.cases[0].always, 0U);
    EXPECT_EQ(plan.cases[0].sometimes, bit("unlit") | kTextured | kNormals);
    EXPECT_EQ(plan.cases[0].keys.size(), 5U);
    EXPECT_EQ(plan.always, plan.cases[0].always);
    EXPECT_EQ(plan.sometimes, plan.cases[0].sometimes);
}

TEST(Plan, OfNothingHasNoCase) {
    for (const compiler::MergePolicy merge :
         {compiler::MergePolicy::None, compiler::MergePolicy::Family, compiler::MergePolicy::All,
          compiler::MergePolicy::Auto, compiler::MergePolicy::Profile}) {
        const compiler::Plan plan = compiler::makePlan({}, {}, {{}, merge});
        EXPECT_TRUE(plan.keys.empty());
        EXPECT_TRUE(plan.cases.empty());
        EXPECT_EQ(plan.always | plan.sometimes, 0U);
        EXPECT_EQ(plan.keysPossible, 0.0);
    }
}

TEST(Plan, DoesNotDependOnTheOrderOfPrimitives) {
    SmallScene scene;
    const compiler::Plan before = scene.plan(compiler::MergePolicy::None);
    std::ranges::reverse(scene.primitives);
    const compiler::Plan after = scene.plan(compiler::MergePolicy::None);
    ASSERT_EQ(before.cases.size(), after.cases.size());
    for (std::size_t i = 0; i < before.cases.size(); ++i) {
        EXPECT_EQ(before.cases[i].name, after.cases[i].name);
        EXPECT_EQ(before.cases[i].materials, after.cases[i].materials);
    }
}

TEST(Plan, SharesTheExpectedHits) {
    SmallScene scene;
    // Nothing is known, so all keys have the same share.
    for (const compiler::Key& key : scene.plan(compiler::MergePolicy::None).keys) {
        EXPECT_DOUBLE_EQ(key.share, 0.2);
    }
    scene.primitives[2].expectedHits = 3.0;
    scene.primitives[0].expectedHits = 0.5;
    scene.primitives[1].expectedHits = 0.5;
    scene.primitives[3].expectedHits = 4.0;
    const compiler::Plan plan = scene.plan(compiler::MergePolicy::Auto);
    EXPECT_DOUBLE_EQ(plan.keys[4].share, 0.375);
    EXPECT_DOUBLE_EQ(plan.keys[3].share, 0.125);
    EXPECT_DOUBLE_EQ(plan.keys[1].share, 0.5);
    EXPECT_EQ(plan.keys[0].share, 0.0);
    double ofCases = 0.0;
    for (const compiler::Case& shaderCase : plan.cases) {
        ofCases += shaderCase.share;
    }
    EXPECT_DOUBLE_EQ(ofCases, 1.0);
}

// A key that was counted as hot gets its own case; without counts, no key is expected to be hot.
TEST(Plan, AutoMergesByCountedHits) {
    SmallScene scene;
    compiler::PlanOptions options{{}, compiler::MergePolicy::Auto};
    options.hits = {{kNormals, 1}, {kTextured | kNormals, 999'999}};
    const compiler::Plan plan = makePlan(scene.materials, scene.primitives, options);
    EXPECT_DOUBLE_EQ(plan.keys[4].share, 0.999999);
    EXPECT_EQ(plan.keys[0].share, 0.0);
    ASSERT_EQ(plan.cases.size(), 2U);
    EXPECT_EQ(plan.cases[0].reason, compiler::CaseReason::Rest);
    EXPECT_EQ(plan.cases[0].keys.size(), 4U);
    EXPECT_EQ(plan.cases[1].reason, compiler::CaseReason::Own);
    EXPECT_GT(scene.plan(compiler::MergePolicy::Auto).cases.size(), 2U);
    options.merge = compiler::MergePolicy::None;
    EXPECT_FALSE(countsHits(options));
    EXPECT_DOUBLE_EQ(makePlan(scene.materials, scene.primitives, options).keys[4].share, 0.2);
}

TEST(Plan, TakesTheSharesOfAProfile) {
    const SmallScene scene;
    compiler::PlanOptions options{{}, compiler::MergePolicy::Profile};
    options.hits = {{kNormals, 30}, {kTextured | kNormals, 10}, {std::uint64_t{1} << 63U, 1000}};
    const compiler::Plan plan = makePlan(scene.materials, scene.primitives, options);
    EXPECT_DOUBLE_EQ(plan.keys[3].share, 0.75);
    EXPECT_DOUBLE_EQ(plan.keys[4].share, 0.25);
    ASSERT_EQ(plan.cases.size(), 3U);
    EXPECT_EQ(plan.cases[0].reason, compiler::CaseReason::NeverHit);
    EXPECT_EQ(plan.cases[0].name, "PbrMixed");
    EXPECT_EQ(plan.cases[1].reason, compiler::CaseReason::Hot);
    EXPECT_EQ(plan.cases[1].name, "Pbr_Normals");
}

TEST(Plan, RecordsEachDropOnceWithItsMaterials) {
    SmallScene scene;
    for (materials::Material& material : scene.materials) {
        material.alphaMode = materials::AlphaMode::Mask;
    }
    const compiler::Plan plan = scene.plan(compiler::MergePolicy::None);
    int alphaDrops = 0;
    for (const compiler::DroppedFeature& dropped : plan.dropped) {
        if (dropped.feature == "alphaMask") {
            ++alphaDrops;
            EXPECT_EQ(dropped.materials, (std::vector<int>{0, 1, 2, 3, 4}));
        }
    }
    EXPECT_EQ(alphaDrops, 1);
}

TEST(Plan, ExcessSaysWhatToDo) {
    const SmallScene scene;
    const compiler::Plan plan = scene.plan(compiler::MergePolicy::None);
    const auto excess = [&](int limit) {
        compiler::PlanOptions options{{}, compiler::MergePolicy::None};
        options.maxShaders = limit;
        return describeExcess(plan, options);
    };
    EXPECT_FALSE(excess(0).has_value());
    EXPECT_FALSE(excess(5).has_value());
    EXPECT_NE(excess(4)->find("--merge family"), std::string::npos);
    EXPECT_EQ(excess(1)->find("--merge family"), std::string::npos);
    EXPECT_NE(excess(1)->find("--merge auto"), std::string::npos);
}

materials::Material randomMaterial(std::mt19937& random) {
    const auto coin = [&] { return (random() & 1U) != 0; };
    materials::Material material;
    for (std::size_t slot = 0; slot < material.model().textures.size(); ++slot) {
        materials::TextureInfo& info = material.textures[slot];
        info.texture = coin() ? 0 : -1;
        info.texCoord = coin() ? 1 : 0;
        info.transform.rotation = coin() ? 1.0F : 0.0F;
    }
    if (coin()) {
        material.give("KHR_materials_unlit");
    }
    material.doubleSided = coin();
    material.alphaMode = coin() ? materials::AlphaMode::Mask : materials::AlphaMode::Opaque;
    material["emissiveFactor"][0] = coin() ? 1.0F : 0.0F;
    material["emissiveStrength"] = coin() ? 2.0F : 1.0F;
    if (random() % 8 == 0) {
        material.give("KHR_materials_pbrSpecularGlossiness");
    }
    material["metallicFactor"] = coin() ? 1.0F : 0.5F;
    material["ior"] = coin() ? 1.0F : 1.5F;
    material["clearcoatFactor"] = coin() ? 1.0F : 0.0F;
    material["sheenColorFactor"][1] = coin() ? 1.0F : 0.0F;
    material["anisotropyStrength"] = coin() ? 1.0F : 0.0F;
    material["iridescenceFactor"] = coin() ? 1.0F : 0.0F;
    material["specularFactor"] = coin() ? 1.0F : 0.5F;
    material["transmissionFactor"] = coin() ? 1.0F : 0.0F;
    material["diffuseTransmissionFactor"] = coin() ? 1.0F : 0.0F;
    material["thicknessFactor"] = coin() ? 1.0F : 0.0F;
    material["attenuationDistance"] = coin() ? 1.0F : std::numeric_limits<float>::infinity();
    material["attenuationColor"][2] = coin() ? 1.0F : 0.0F;
    material["dispersion"] = coin() ? 1.0F : 0.0F;
    return material;
}

struct RandomScene {
    std::vector<materials::Material> materials;
    std::vector<materials::PrimitiveInputs> primitives;

    explicit RandomScene(std::mt19937& random) {
        for (int i = 0; i < 500; ++i) {
            materials.push_back(randomMaterial(random));
            materials::PrimitiveInputs primitive;
            primitive.material = i;
            primitive.hasNormals = (random() & 1U) != 0;
            primitive.hasTangents = (random() & 1U) != 0;
            primitive.hasTexCoords0 = (random() & 3U) != 0;
            primitive.hasTexCoords1 = (random() & 1U) != 0;
            primitive.colors = static_cast<materials::ColorContent>(random() % 3);
            primitives.push_back(primitive);
        }
    }
};

// The promises of `always`, `sometimes` and "never" must hold for every key of every case.
TEST(Plan, BitsOfCasesAgreeWithTheirKeys) {
    constexpr unsigned kSeed = 20240611;
    RecordProperty("seed", kSeed);
    std::mt19937 random(kSeed);
    const RandomScene scene(random);
    for (const compiler::MergePolicy merge :
         {compiler::MergePolicy::None, compiler::MergePolicy::Family, compiler::MergePolicy::All,
          compiler::MergePolicy::Auto, compiler::MergePolicy::Profile}) {
        compiler::PlanOptions options{{package::AlphaPolicy::Tested}, merge};
        for (const materials::PrimitiveInputs& primitive : scene.primitives) {
            const materials::Material& material =
                scene.materials[static_cast<std::size_t>(primitive.material)];
            options.hits[compiler::makeKey(material, primitive, options.keys)] = random() % 100;
        }
        const compiler::Plan plan = makePlan(scene.materials, scene.primitives, options);
        std::set<std::string> names;
        std::size_t keyCount = 0;
        double share = 0.0;
        for (const compiler::Case& shaderCase : plan.cases) {
            EXPECT_EQ(shaderCase.always & shaderCase.sometimes, 0U);
            EXPECT_TRUE(names.insert(shaderCase.name).second) << shaderCase.name;
            materials::FeatureMask all = ~materials::FeatureMask{0};
            materials::FeatureMask any = 0;
            for (const int key : shaderCase.keys) {
                all &= plan.keys[key].mask;
                any |= plan.keys[key].mask;
                EXPECT_EQ(plan.keys[key].shaderId, shaderCase.shaderId);
            }
            EXPECT_EQ(shaderCase.always, all);
            EXPECT_EQ(shaderCase.sometimes, any & ~all);
            share += shaderCase.share;
            keyCount += shaderCase.keys.size();
        }
        EXPECT_EQ(keyCount, plan.keys.size());
        EXPECT_NEAR(share, 1.0, 1e-9);
    }
}

// The device tests the features of hits in the mask of primary surfaces, so none may be missing there.
TEST(Plan, KeysOfHitsArePartOfPrimaryMasks) {
    constexpr unsigned kSeed = 20241121;
    RecordProperty("seed", kSeed);
    std::mt19937 random(kSeed);
    const RandomScene scene(random);
    for (int i = 0; i < 50; ++i) {
        const materials::KeyOptions keys{
            package::AlphaPolicy::Tested,
            static_cast<materials::FeatureMask>(random()) & materials::builtinMaterialModel().lobes};
        const compiler::Plan plan =
            compiler::makePlan(scene.materials, scene.primitives, {keys, compiler::MergePolicy::Family});
        const materials::FeatureMask whole = plan.primaryAlways | plan.primarySometimes;
        materials::FeatureMask every = ~materials::FeatureMask{0};
        for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
            const materials::FeatureMask primary = plan.primaryMaskOfPrimitive[p];
            EXPECT_EQ(plan.keys[plan.keyOfPrimitive[p]].mask & ~primary, 0U);
            EXPECT_EQ(primary, compiler::makeKey(scene.materials[p], scene.primitives[p],
                                                 {package::AlphaPolicy::Tested}));
            EXPECT_EQ(primary & ~whole, 0U);
            every &= primary;
            // First hits are shaded by the case of the hits, which must promise nothing wrong about this
            // mask.
            const int shaderId = plan.keys[plan.keyOfPrimitive[p]].shaderId;
            const compiler::Case first = compiler::firstCase(plan, plan.cases[shaderId]);
            EXPECT_EQ(first.always & ~primary, 0U);
            EXPECT_EQ(primary & ~(first.always | first.sometimes), 0U);
            EXPECT_EQ(first.always & first.sometimes, 0U);
        }
        EXPECT_EQ(plan.primaryAlways, every);
        EXPECT_EQ(plan.primaryAlways & plan.primarySometimes, 0U);
    }
}

TEST(Plan, HitsThatKeepFewerLobesShareMoreCases) {
    SmallScene scene;
    scene.materials[1]["clearcoatFactor"] = 1.0F;
    const compiler::Plan all = scene.plan(compiler::MergePolicy::Family);
    compiler::PlanOptions options{{}, compiler::MergePolicy::Family};
    options.keys.keptLobes = bit("ior");
    const compiler::Plan few = makePlan(scene.materials, scene.primitives, options);
    EXPECT_EQ(all.cases.size(), 3U);
    // The base models stay, so unlit is a separate case.
    EXPECT_EQ(few.cases.size(), 2U);
    EXPECT_EQ((few.always | few.sometimes) & bit("clearcoat"), 0U);
    EXPECT_NE(few.primarySometimes & bit("clearcoat"), 0U);
    EXPECT_EQ(all.primarySometimes, few.primarySometimes);
    EXPECT_EQ(all.sometimes, all.primarySometimes);
    for (const compiler::Case& shaderCase : all.cases) {
        const compiler::Case first = compiler::firstCase(all, shaderCase);
        EXPECT_EQ(first.always, shaderCase.always);
        EXPECT_EQ(first.sometimes, shaderCase.sometimes);
    }
    const auto coat = std::ranges::find(few.dropped, "clearcoat", &compiler::DroppedFeature::feature);
    ASSERT_NE(coat, few.dropped.end());
    EXPECT_NE(coat->reason.find("--hit-lobes"), std::string::npos);
    EXPECT_EQ(coat->materials, (std::vector<int>{1}));
}

}  // namespace
