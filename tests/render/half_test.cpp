// Compares shading in 16 bits with shading in 32: everything is finite, and the pictures are nearly the same.
#include "gltf/import.h"
#include "image/compare.h"
#include "render/pixel_test.h"
#include "render/rooms.h"
#include "support/effect_bits.h"
#include "support/must.h"
#include "support/nightly.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

compiler::CompileSettings settingsOf(package::Strategy strategy, package::ShadingPrecision precision) {
    compiler::CompileSettings settings;
    settings.strategies = strategy;
    settings.precision = precision;
    // One case has every lobe, and compiles sooner than many.
    settings.plan.merge = test::nightly() ? compiler::MergePolicy::Family : compiler::MergePolicy::All;
    settings.effects = {false, package::kEffectShadow | package::kEffectReflection |
                                   package::kEffectRefraction | package::kEffectIndirectDiffuse};
    return settings;
}

LinearImage rendered(const gltf::Scene& scene, package::Strategy strategy,
                     package::ShadingPrecision precision, const RenderSetup& setup) {
    const LoadedScene loaded(scene, settingsOf(strategy, precision));
    Renderer::Counters counters;
    LinearImage image = loaded.render(strategy, setup, &counters);
    EXPECT_EQ(counters.nonFinite, 0U);
    return image;
}

// `bound` limits relMSE; it is about eight times what was measured on lavapipe.
void expectAlike(const gltf::Scene& scene, package::Strategy strategy, double bound) {
    RenderSetup setup = defaultSetup(scene, 64, 36);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.samples = 4;
    const LinearImage single = rendered(scene, strategy, package::ShadingPrecision::Single, setup);
    const LinearImage half = rendered(scene, strategy, package::ShadingPrecision::Half, setup);
    ASSERT_EQ(single.pixels.size(), half.pixels.size());
    const image::ImageDifference difference = must(image::compareImages(half, single, "half", "single"));
    EXPECT_EQ(difference.nonFinite, 0U);
    EXPECT_EQ(difference.referenceNonFinite, 0U);
    EXPECT_LE(difference.relMse, bound);
    // The pictures must differ, or 16 bits were not used.
    EXPECT_GT(difference.relMse, 0.0);
    std::printf("relMSE %.2e, largest relative error %.2e\n", difference.relMse, difference.relative.value);
}

TEST(Half, TheGalleryIsNearlyTheSame) {
    if (!test::nightly()) {
        GTEST_SKIP() << "takes a minute to compile: scripts/nightly.sh runs it";
    }
    gltf::ImportOptions options;
    options.decodeImages = true;
    const gltf::Scene scene = must(importScene(GLINT_GALLERY_SCENE, options));
    expectAlike(scene, package::kStrategyUber, 2e-6);
}

TEST(Half, ARoomOfMaterialsIsNearlyTheSame) {
    expectAlike(roomOfMaterials(), package::kStrategyVisibility, 2e-6);
}

TEST(Half, HitShadersShadeSoToo) {
    expectAlike(roomWithFence(), package::kStrategyHitShaders, 2e-7);
}

// Returns materials that each are at a limit of what files may contain.
std::vector<materials::Material> extremeMaterials() {
    std::vector<materials::Material> list;
    for (const float roughness : {0.0F, 0.01F, 1.0F}) {
        for (const float metallic : {0.0F, 1.0F}) {
            for (const float colour : {0.0F, 1e-7F, 1.0F}) {
                materials::Material material;
                material["roughnessFactor"] = roughness;
                material["metallicFactor"] = metallic;
                material["baseColorFactor"] = {colour, 1.0F, colour, 1.0F};
                list.push_back(material);
            }
        }
    }
    const std::size_t plain = list.size();
    for (std::size_t i = 0; i < plain; ++i) {
        materials::Material& material = list[i];
        switch (i % 6) {
            case 0:
                material.give("KHR_materials_clearcoat");
                material["clearcoatFactor"] = 1.0F;
                material["clearcoatRoughnessFactor"] = 0.0F;
                material["clearcoatNormalScale"] = 1.0F;
                break;
            case 1:
                material.give("KHR_materials_sheen");
                material["sheenColorFactor"] = {1.0F, 1.0F, 1.0F};
                material["sheenRoughnessFactor"] = i % 4 == 1 ? 0.0F : 1.0F;
                break;
            case 2:
                material.give("KHR_materials_specular");
                material["specularFactor"] = 1.0F;
                material["specularColorFactor"] = {1e9F, 1.0F, 0.0F};
                break;
            case 3:
                material["emissiveFactor"] = {1.0F, 1.0F, 1e-8F};
                material["emissiveStrength"] = 1e6F;
                material.give("KHR_materials_emissive_strength");
                break;
            case 4:
                material.give("KHR_materials_ior");
                material["ior"] = i % 4 == 0 ? 0.0F : 1.0000001F;
                material.give("KHR_materials_transmission");
                material["transmissionFactor"] = 1.0F;
                break;
            default:
                material.give("KHR_materials_iridescence");
                material["iridescenceFactor"] = 1.0F;
                break;
        }
    }
    return list;
}

// Returns quads of those materials, from facing the camera to edge-on, with vertex colours from 0 to 1e6,
// under lamps of a millionth and a million.
gltf::Scene extremeScene() {
    gltf::Scene scene = sceneWithCamera();
    const std::vector<materials::Material> materials = extremeMaterials();
    constexpr int kColumns = 6;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const auto column = static_cast<float>(i % kColumns);
        const std::size_t whole = i / kColumns;
        const auto row = static_cast<float>(whole);
        const float turn = 1.5F * row / (static_cast<float>(materials.size()) / kColumns);
        gltf::Primitive quad =
            makeQuad(addMaterial(scene, materials[i]),
                     {0.33F * column - 1.0F, 0.6F * row - 0.9F, -1.0F - 0.1F * column},
                     {0.3F * std::cos(turn), 0.0F, -0.3F * std::sin(turn)}, {0.0F, 0.5F, 0.0F});
        if (i % 3 == 0) {
            quad.colors.assign(4, {i % 2 == 0 ? 1e6F : 0.5F, 1.0F, 1e-30F, 1.0F});
            quad.colorContent = materials::ColorContent::Varying;
        }
        addInstance(scene, addMesh(scene, std::move(quad)));
    }
    addDirectionalLight(scene, {0.0F, 0.0F, -1.0F}, 1e6F);
    addDirectionalLight(scene, {1.0F, 0.0F, -1e-4F}, 1e-6F);
    return scene;
}

TEST(Half, ExtremesStayFinite) {
    const gltf::Scene scene = extremeScene();
    RenderSetup setup = defaultSetup(scene, 96, 64);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.samples = 2;
    const auto finite = [](const LinearImage& image) {
        return !image.pixels.empty() && std::ranges::all_of(image.pixels, [](const Pixel& pixel) {
            return std::ranges::all_of(pixel, [](float value) { return std::isfinite(value); });
        });
    };
    const LinearImage half = rendered(scene, package::kStrategyUber, package::ShadingPrecision::Half, setup);
    EXPECT_TRUE(finite(half));
}

// A device that was made without the feature is refused, and the error names the feature.
TEST(Half, NeedsTheFeature) {
    const gltf::Scene scene = roomWithFence();
    const LoadedScene loaded(scene, settingsOf(package::kStrategyUber, package::ShadingPrecision::Half));
    EXPECT_EQ(loaded.package().precision(), package::ShadingPrecision::Half);
    const std::unique_ptr<Context> context = must(Context::createHeadless({}));
    const Diagnostic uploaded =
        mustFail(GpuScene::upload(*context, loaded.package(), session::makeSceneView(scene).view()));
    EXPECT_EQ(uploaded.id, "half-precision");
    EXPECT_NE(uploaded.hint.find("--precision 32"), std::string::npos);
}

}  // namespace
