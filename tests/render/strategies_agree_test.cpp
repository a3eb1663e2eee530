// Every strategy under every merge policy gives the same linear image, on every scene that can be had.
#include "gltf/import.h"
#include "render/harness.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
namespace fs = std::filesystem;

// Scenes that ask for what the importer can't read end here, in an error that names the extension.
bool namesUnsupportedExtension(const Diagnostic& error) {
    return error.message.find("KHR_") != std::string::npos || error.message.find("EXT_") != std::string::npos;
}

class StrategiesAgree : public ::testing::TestWithParam<std::string> {};

TEST_P(StrategiesAgree, UnderEveryMergePolicy) {
    const fs::path path = GetParam();
    if (!fs::exists(path)) {
        GTEST_SKIP() << "no " << path.filename() << " beside the repository";
    }
    ImportOptions options;
    options.decodeImages = true;
    const Result<Scene> scene = importScene(path, options);
    if (!scene) {
        EXPECT_TRUE(namesUnsupportedExtension(scene.error())) << toString(scene.error());
        GTEST_SKIP() << toString(scene.error());
    }
    RenderSetup setup = defaultSetup(*scene, 64, 36);
    // Everything that is not fully rough sends a ray, so that as many hits as can be are shaded.
    setup.frame.maxReflectionRoughness = 1.0F;

    LinearImage reference;
    for (const MergePolicy merge : {MergePolicy::None, MergePolicy::Family, MergePolicy::All}) {
        PlanOptions plan;
        plan.merge = merge;
        const LoadedScene loaded(*scene, plan);
        ASSERT_TRUE(loaded.ok());
        for (const auto strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
            FrameCounters counters;
            const LinearImage image = loaded.render(strategy, setup, &counters);
            ASSERT_FALSE(image.pixels.empty());
            if (reference.pixels.empty()) {
                reference = image;
                EXPECT_GT(counters.rays, 0U) << "nothing reflects: the scene tests no strategy";
            }
            expectSameImage(image, reference,
                            std::string(strategy == package::kStrategyUber ? "uber" : "visibility") +
                                ", merge " + std::string(toString(merge)));
        }
    }
}

std::vector<std::string> scenePaths() {
    std::vector<std::string> paths{GLINT_GALLERY_SCENE};
    const std::string models = GLINT_SOURCE_DIR "/../shared/models/";
    for (const char* name : {"features/AlphaBlendModeTest/AlphaBlendModeTest.gltf",
                             "features/AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf",
                             "features/AnisotropyStrengthTest/AnisotropyStrengthTest.gltf",
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
                             "features/TextureTransformMultiTest/TextureTransformMultiTest.glb",
                             "features/TransmissionRoughnessTest/TransmissionRoughnessTest.glb",
                             "features/box-textured-separate-webp/box-textured-separate.gltf",
                             "features/box-textured-separate-webp/box-textured-with-fallback.gltf",
                             "features/dispersion-test/dispersion-test.glb",
                             "features/pirate/pirate.glb",
                             "large/2CylinderEngine/2CylinderEngine.glb",
                             "large/BrainStem/BrainStem.glb",
                             "large/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb",
                             "large/ReciprocatingSaw/ReciprocatingSaw.glb",
                             "large/VC/VC.glb"}) {
        paths.push_back(models + name);
    }
    return paths;
}

INSTANTIATE_TEST_SUITE_P(Scenes, StrategiesAgree, ::testing::ValuesIn(scenePaths()),
                         [](const ::testing::TestParamInfo<std::string>& path) {
                             std::string name = fs::path(path.param).stem().string();
                             for (char& c : name) {
                                 c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                             }
                             return name + "_" + std::to_string(path.index);
                         });

}  // namespace
