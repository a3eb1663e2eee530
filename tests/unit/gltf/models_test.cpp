// Tests scenes by others: each is imported, or causes a diagnostic that says why not.
#include "support/models.h"

#include "gltf/codecs/codecs.h"
#include "gltf/import.h"
#include "plan/plan.h"
#include "support/features.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace glint::test {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = modelsFolder();

// Returns every .gltf and .glb below a folder, sorted.
std::vector<fs::path> findModels(const fs::path& folder) {
    std::vector<fs::path> models;
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb") {
            models.push_back(entry.path());
        }
    }
    std::sort(models.begin(), models.end());
    return models;
}

// Expects everything on which the readers of a Scene rely.
void expectSound(const gltf::Scene& scene) {
    const int materials = static_cast<int>(scene.materials.size());
    const auto inRange = [](int index, std::size_t size) {
        return index >= -1 && index < static_cast<int>(size);
    };
    for (const gltf::Mesh& mesh : scene.meshes) {
        for (const gltf::Primitive& primitive : mesh.primitives) {
            const std::size_t count = primitive.positions.size();
            EXPECT_TRUE(primitive.material >= 0 && primitive.material < materials) << primitive.pointer;
            EXPECT_EQ(primitive.indices.size() % 3, 0U);
            EXPECT_TRUE(std::all_of(primitive.indices.begin(), primitive.indices.end(),
                                    [&](std::uint32_t index) { return index < count; }));
            for (const std::size_t size :
                 {primitive.normals.size(), primitive.tangents.size(), primitive.texCoords0.size(),
                  primitive.texCoords1.size(), primitive.colors.size()}) {
                EXPECT_TRUE(size == 0 || size == count) << primitive.pointer;
            }
            for (const gltf::Float3& normal : primitive.normals) {
                ASSERT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1.0F, 1e-5F) << primitive.pointer;
            }
        }
    }
    for (const materials::Material& material : scene.materials) {
        for (const auto& [slot, info] : material.textures) {
            EXPECT_TRUE(inRange(info.texture, scene.textures.size()));
        }
    }
    for (const gltf::Texture& texture : scene.textures) {
        EXPECT_TRUE(texture.image >= 0 && inRange(texture.image, scene.images.size()));
        EXPECT_TRUE(texture.sampler >= 0 && inRange(texture.sampler, scene.samplers.size()));
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        EXPECT_TRUE(inRange(scene.nodes[i].parent, i));
        EXPECT_TRUE(inRange(scene.nodes[i].mesh, scene.meshes.size()));
        EXPECT_TRUE(inRange(scene.nodes[i].camera, scene.cameras.size()));
        EXPECT_TRUE(inRange(scene.nodes[i].light, scene.lights.size()));
    }
    for (const Diagnostic& warning : scene.warnings) {
        EXPECT_NE(warning.severity, Severity::Error);
        EXPECT_FALSE(warning.where.empty());
        EXPECT_FALSE(warning.message.empty());
    }
}

TEST(GltfModels, AllImport) {
    std::vector<fs::path> models = findModels(kModels / "features");
    const std::vector<fs::path> large = findModels(kModels / "large");
    models.insert(models.end(), large.begin(), large.end());
    if (models.empty()) {
        GTEST_SKIP() << noModels(kModels);
    }
    for (const fs::path& path : models) {
        const Result<gltf::Scene> scene = gltf::importScene(path, {.decodeImages = true});
        if (!scene && scene.error().id == "texture-basisu") {
            EXPECT_FALSE(gltf::hasBasisu()) << path;
            continue;
        }
        ASSERT_TRUE(scene.ok()) << toString(scene.error());
        expectSound(*scene);
        EXPECT_FALSE(planningInputs(*scene).empty()) << path;
        for (const gltf::Image& image : scene->images) {
            EXPECT_EQ(image.pixels.size(), byteCount(image)) << image.name;
        }
    }
}

// The lamp's four textures are KTX2 without a fallback.
TEST(GltfModels, LampHasItsKtx2Textures) {
    const fs::path path = kModels / "features/AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf";
    if (!gltf::hasBasisu() || !fs::exists(path)) {
        GTEST_SKIP() << "no model, or this build does not decode KTX2";
    }
    const gltf::Scene scene = must(gltf::importScene(path, {.decodeImages = true}));
    EXPECT_TRUE(scene.warnings.empty()) << toString(scene.warnings[0]);
    ASSERT_EQ(scene.images.size(), 4U);
    // The means of the channels show copper, and normals that point out of the surface.
    const auto meanOf = [](const gltf::Image& image, std::size_t channel) {
        double sum = 0;
        for (std::size_t i = channel; i < image.pixels.size(); i += 4) {
            sum += image.pixels[i];
        }
        return sum / static_cast<double>(pixelCount(image, 0));
    };
    for (const gltf::Image& image : scene.images) {
        EXPECT_EQ(image.width, 2048) << image.name;
        EXPECT_EQ(image.height, 2048) << image.name;
    }
    const gltf::Image& color = scene.images[0];
    EXPECT_GT(meanOf(color, 0), meanOf(color, 1) + 15);
    EXPECT_GT(meanOf(color, 1), meanOf(color, 2) + 10);
    const gltf::Image& normals = scene.images[2];
    EXPECT_NEAR(meanOf(normals, 0), 128, 3);
    EXPECT_NEAR(meanOf(normals, 1), 128, 3);
    EXPECT_GT(meanOf(normals, 2), 250);
}

// Every material extension in the samples is shaded. None is left out because Glint lacks it.
TEST(GltfModels, EveryMaterialExtensionIsShaded) {
    const std::vector<fs::path> models = findModels(kModels / "features");
    if (models.empty()) {
        GTEST_SKIP() << noModels(kModels);
    }
    materials::FeatureMask seen = 0;
    for (const fs::path& path : models) {
        const Result<gltf::Scene> scene = gltf::importScene(path);
        if (!scene) {
            continue;  // another test covers it
        }
        for (const materials::Material& material : scene->materials) {
            EXPECT_TRUE(material.unsupportedExtensions.empty()) << path << ": " << material.name;
        }
        const compiler::Plan plan = compiler::makePlan(scene->materials, planningInputs(*scene), {});
        seen |= plan.primaryAlways | plan.primarySometimes;
    }
    for (const char* const lobe : {"ior", "specular", "clearcoat", "sheen", "anisotropy", "iridescence",
                                   "transmission", "diffuseTransmission", "volume", "dispersion"}) {
        EXPECT_NE(seen & bit(lobe), 0U) << "no sample has lobe " << lobe;
    }
}

TEST(GltfModels, InvalidFilesAreExplained) {
    const std::vector<fs::path> models = findModels(kModels / "invalid");
    if (models.empty()) {
        GTEST_SKIP() << noModels(kModels);
    }
    for (const fs::path& path : models) {
        for (const bool decodeImages : {false, true}) {
            const Result<gltf::Scene> scene = gltf::importScene(path, {.decodeImages = decodeImages});
            if (scene) {
                expectSound(*scene);
                continue;
            }
            EXPECT_NE(scene.error().where.find(path.filename().string()), std::string::npos) << path;
            EXPECT_FALSE(scene.error().message.empty()) << path;
            EXPECT_FALSE(scene.error().id.empty()) << path;
            EXPECT_FALSE(scene.error().hint.empty()) << path;
        }
    }
}

// Returns the files in which the glTF validator finds no error. verdicts.csv lists them as
// "file,validator_errors,codes".
std::vector<std::string> validFiles(const fs::path& verdicts) {
    std::vector<std::string> files;
    std::ifstream lines(verdicts);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(',');
        if (first != std::string::npos && line.substr(first, 3) == ",0,") {
            files.push_back(line.substr(0, first));
        }
    }
    return files;
}

TEST(GltfModels, ValidFilesAreRead) {
    const std::vector<std::string> files = validFiles(kModels / "invalid/verdicts.csv");
    if (files.empty()) {
        GTEST_SKIP() << "no verdicts in " << kModels;
    }
    // Its "minVersion" asks for glTF 2.1.
    const std::map<std::string, std::string> refused{{"asset/min_version_valid.gltf", "asset-version"}};
    for (const std::string& file : files) {
        for (const bool decodeImages : {false, true}) {
            const Result<gltf::Scene> scene =
                gltf::importScene(kModels / "invalid" / file, {.decodeImages = decodeImages});
            const auto known = refused.find(file);
            if (known == refused.end()) {
                EXPECT_TRUE(scene.ok()) << toString(scene.error());
            } else {
                ASSERT_FALSE(scene.ok()) << file;
                EXPECT_EQ(scene.error().id, known->second);
            }
        }
    }
}

TEST(GltfModels, HaveTheirKnownContent) {
    const fs::path features = kModels / "features";
    if (!fs::exists(features)) {
        GTEST_SKIP() << noModels(kModels);
    }
    const gltf::Scene multi =
        must(gltf::importScene(features / "TextureTransformMultiTest/TextureTransformMultiTest.glb"));
    EXPECT_EQ(multi.materials.size(), 29U);
    EXPECT_EQ(planningInputs(multi).size(), 29U);
    const gltf::Scene modes =
        must(gltf::importScene(features / "MeshPrimitiveModes/MeshPrimitiveModes.gltf"));
    EXPECT_EQ(planningInputs(modes).size(), 3U);
    EXPECT_EQ(modes.defaultMaterial, 0);
    const gltf::Scene sparse =
        must(gltf::importScene(features / "SimpleSparseAccessor/SimpleSparseAccessor.gltf"));
    EXPECT_EQ(sparse.meshes.at(0).primitives.at(0).positions.at(8), (gltf::Float3{1.0F, 2.0F, 0.0F}));
    const gltf::Scene avocado = must(gltf::importScene(features / "Avocado-draco/Avocado.gltf"));
    EXPECT_EQ(avocado.meshes.at(0).primitives.at(0).positions.size(), 406U);
    EXPECT_EQ(avocado.meshes.at(0).primitives.at(0).indices.size(), 2046U);
    const gltf::Scene pirate = must(gltf::importScene(features / "pirate/pirate.glb"));
    EXPECT_EQ(pirate.meshes.at(0).primitives.at(0).positions.size(), 2887U);
    EXPECT_EQ(pirate.meshes.at(0).primitives.at(0).indices.size(), 15030U);
    const gltf::Scene spheres = must(
        gltf::importScene(kModels / "large/MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb"));
    std::size_t triangles = 0;
    for (const gltf::Node& node : spheres.nodes) {
        if (node.mesh >= 0) {
            for (const gltf::Primitive& primitive :
                 spheres.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                triangles += primitive.indices.size() / 3;
            }
        }
    }
    EXPECT_GT(triangles, 1000000U);
}

}  // namespace
}  // namespace glint::test
