// Both strategies give the same linear image on every available scene; at night under every merge policy.
#include "gltf/import.h"
#include "render/harness.h"
#include "support/models.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
namespace fs = std::filesystem;

const char* name(package::Strategy strategy) {
    return strategy == package::kStrategyUber ? "uber" : "visibility";
}

class StrategiesAgree : public ::testing::TestWithParam<std::string> {
protected:
    // Skips or fails the test if there is no scene; the caller must then return.
    std::optional<gltf::Scene> load() {
        const fs::path path = GetParam();
        if (!fs::exists(path)) {
            skip(test::noModels(path));
            return std::nullopt;
        }
        gltf::ImportOptions options;
        options.decodeImages = true;
        Result<gltf::Scene> scene = importScene(path, options);
        if (!scene && scene.error().id == "texture-basisu") {
            skip("this build does not decode the KTX2 textures of " + path.filename().string());
            return std::nullopt;
        }
        if (!scene) {
            ADD_FAILURE() << toString(scene.error());
            return std::nullopt;
        }
        return std::move(*scene);
    }

    // Renders with both strategies under each of `merges`; all images must be the same.
    void expectAgreement(const gltf::Scene& scene, const std::vector<compiler::MergePolicy>& merges,
                         package::AlphaPolicy alpha) {
        RenderSetup setup = defaultSetup(scene, 64, 36);
        // Everything that is not fully rough sends a ray, so that as many hits as possible are shaded.
        setup.frame.maxReflectionRoughness = 1.0F;
        LinearImage reference;
        for (const compiler::MergePolicy merge : merges) {
            compiler::PlanOptions plan;
            plan.keys.alpha = alpha;
            plan.merge = merge;
            const LoadedScene loaded(scene, plan);
            for (const auto strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
                Renderer::Counters counters;
                const LinearImage image = loaded.render(strategy, setup, &counters);
                EXPECT_GT(counters.rays, 0U) << "nothing reflects: the scene tests no strategy";
                if (reference.pixels.empty()) {
                    reference = image;
                }
                expectSameImage(image, reference,
                                std::string(name(strategy)) + ", merge " + std::string(nameOf(merge)));
            }
        }
    }

private:
    static void skip(const std::string& why) {
        GTEST_SKIP() << why;
    }
};

// Uber shaders and visibility differ most where each key has its own case. test_combinations holds that rooms
// with every material look the same under every policy; at night all scenes do.
TEST_P(StrategiesAgree, OnEveryScene) {
    if (const std::optional<gltf::Scene> scene = load()) {
        expectAgreement(*scene,
                        test::nightly()
                            ? std::vector{compiler::MergePolicy::None, compiler::MergePolicy::Family,
                                          compiler::MergePolicy::All}
                            : std::vector{compiler::MergePolicy::None},
                        package::AlphaPolicy::Opaque);
    }
}

// With tested alpha, masked geometry leaves the opaque fast path, in the trace and in every shadow ray.
class StrategiesAgreeTested : public StrategiesAgree {};

TEST_P(StrategiesAgreeTested, WithAlphaMasks) {
    if (const std::optional<gltf::Scene> scene = load()) {
        const bool masked = std::ranges::any_of(scene->materials, [](const materials::Material& material) {
            return material.alphaMode == materials::AlphaMode::Mask;
        });
        EXPECT_TRUE(masked) << "the scene has no mask to test";
        expectAgreement(*scene,
                        test::nightly() ? std::vector{compiler::MergePolicy::None, compiler::MergePolicy::All}
                                        : std::vector{compiler::MergePolicy::None},
                        package::AlphaPolicy::Tested);
    }
}

std::vector<std::string> scenePaths() {
    const fs::path models = test::modelsFolder();
    std::vector<std::string> paths;
    if (test::nightly()) {
        // By day the tests of the command compare pictures of the gallery, which has transformed textures,
        // too. Other scenes below have the features of the rest.
        paths.emplace_back(GLINT_GALLERY_SCENE);
        for (const char* name : {"features/AnisotropyStrengthTest/AnisotropyStrengthTest.gltf",
                                 "features/TextureTransformMultiTest/TextureTransformMultiTest.glb",
                                 "features/TransmissionRoughnessTest/TransmissionRoughnessTest.glb",
                                 "features/box-textured-separate-webp/box-textured-with-fallback.gltf",
                                 "large/2CylinderEngine/2CylinderEngine.glb",
                                 "large/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb",
                                 "large/ReciprocatingSaw/ReciprocatingSaw.glb"}) {
            paths.push_back((models / name).string());
        }
    }
    for (const char* name : {"features/AlphaBlendModeTest/AlphaBlendModeTest.gltf",
                             "features/AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf",
                             "features/Avocado-draco/Avocado.gltf",
                             "features/ClearCoatTest/ClearCoatTest.gltf",
                             "features/DiffuseTransmissionTest-rebuilt/DiffuseTransmissionTest-rebuilt.gltf",
                             "features/Duck-quantized/Duck.gltf",
                             "features/EmissiveStrengthTest/EmissiveStrengthTest.gltf",
                             "features/IridescenceSuzanne/IridescenceSuzanne.glb",
                             "features/MeshPrimitiveModes/MeshPrimitiveModes.gltf",
                             "features/MorphPrimitivesTest/MorphPrimitivesTest.glb",
                             "features/NegativeScaleTest/NegativeScaleTest.glb",
                             "features/NormalTangentMirrorTest/NormalTangentMirrorTest.gltf",
                             "features/SheenChair/SheenChair.gltf",
                             "features/SimpleSkin/SimpleSkin.gltf",
                             "features/SimpleSparseAccessor/SimpleSparseAccessor.gltf",
                             "features/SpecularTest/SpecularTest.glb",
                             "features/box-textured-separate-webp/box-textured-separate.gltf",
                             "features/dispersion-test/dispersion-test.glb",
                             "features/pirate/pirate.glb",
                             "large/BrainStem/BrainStem.glb",
                             "large/VC/VC.glb"}) {
        paths.push_back((models / name).string());
    }
    return paths;
}

std::vector<std::string> maskedPaths() {
    std::vector<std::string> paths{
        (test::modelsFolder() / "features/AlphaBlendModeTest/AlphaBlendModeTest.gltf").string()};
    // Compiling all of the gallery once more takes a minute.
    if (test::nightly() || !fs::exists(paths.front())) {
        paths.emplace_back(GLINT_GALLERY_SCENE);
    }
    return paths;
}

std::string testName(const ::testing::TestParamInfo<std::string>& path) {
    std::string name = fs::path(path.param).stem().string();
    std::ranges::replace_if(
        name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, StrategiesAgree, ::testing::ValuesIn(scenePaths()), testName);
INSTANTIATE_TEST_SUITE_P(Scenes, StrategiesAgreeTested, ::testing::ValuesIn(maskedPaths()), testName);

}  // namespace
