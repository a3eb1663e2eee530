// Lists of materials without a scene.
#include "gltf/import.h"
#include "gltf/material_set.h"
#include "plan/key.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

using namespace glint;

class MaterialLists : public ::testing::Test {
protected:
    // Reads a list of these materials.
    Result<gltf::Scene> read(const std::string& materials, const gltf::ImportOptions& options = {}) {
        return readFile(R"({"materialList": 1, "materials": [)" + materials + "]}", options);
    }
    Result<gltf::Scene> readFile(const std::string& text, const gltf::ImportOptions& options = {}) {
        std::ofstream(folder_.path() / "list.json") << text;
        return gltf::importScene(folder_.path() / "list.json", options);
    }
    // Returns the place below the file and the message of the error.
    std::string refusal(const std::string& materials) {
        const Result<gltf::Scene> scene = read(materials);
        if (scene) {
            return "accepted";
        }
        EXPECT_EQ(scene.error().id, "material-list");
        return scene.error().where.substr(scene.error().where.find('#') + 1) + ": " + scene.error().message;
    }
    static materials::FeatureMask keyOf(const gltf::Scene& scene) {
        return compiler::makeKey(gltf::planningMaterials(scene)[0], gltf::planningInputs(scene)[0], {});
    }
    static bool hasFeature(const gltf::Scene& scene, const char* feature) {
        return (keyOf(scene) & scene.materials[0].model().mask(feature)) != 0;
    }

    test::TemporaryFolder folder_;
};

TEST_F(MaterialLists, GiveASphereToEachMaterial) {
    const gltf::Scene scene = must(read(R"(
        {"name": "paint", "values": {"roughnessFactor": 0.25, "clearcoatFactor": 1, "sheenColorFactor": [0, 0.5, 1]},
         "alphaMode": "MASK", "doubleSided": true, "weight": 4, "attributes": ["NORMAL", "TANGENT", "COLOR_0"]},
        {"name": "sign", "features": ["unlit"]},
        {"name": "old", "model": "specularGlossiness", "values": {"glossinessFactor": 0.5}})"));
    EXPECT_TRUE(scene.warnings.empty()) << toString(scene.warnings.front());
    ASSERT_EQ(scene.materials.size(), 3U);
    const materials::Material& paint = scene.materials[0];
    EXPECT_EQ(paint.name, "paint");
    EXPECT_EQ(paint["roughnessFactor"][0], 0.25F);
    EXPECT_EQ(paint["sheenColorFactor"][2], 1.0F);
    EXPECT_EQ(paint.alphaMode, materials::AlphaMode::Mask);
    EXPECT_TRUE(paint.doubleSided);
    EXPECT_TRUE(hasFeature(scene, "clearcoat"));
    EXPECT_TRUE(scene.materials[1].isUnlit());
    EXPECT_EQ(scene.materials[2]["glossinessFactor"][0], 0.5F);
    ASSERT_EQ(scene.meshes.size(), 3U);
    EXPECT_EQ(scene.lights.size(), 1U);
    for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(scene.meshes[i].primitives.size(), 1U);
        EXPECT_EQ(scene.meshes[i].primitives[0].material, static_cast<int>(i));
    }
    const gltf::Primitive& primitive = scene.meshes[0].primitives[0];
    EXPECT_TRUE(primitive.texCoords0.empty());
    EXPECT_EQ(primitive.tangents.size(), primitive.positions.size());
    EXPECT_EQ(primitive.colorContent, materials::ColorContent::Varying);
    EXPECT_FALSE(scene.meshes[1].primitives[0].texCoords0.empty());
    // The area of the sphere, not its radius, follows the weight.
    EXPECT_EQ(scene.nodes[0].rest.scale[0], 2.0 * scene.nodes[1].rest.scale[0]);
}

TEST_F(MaterialLists, KeepFeaturesForEditedValues) {
    for (const bool isEdited : {false, true}) {
        const gltf::Scene scene = must(
            read(fmt::format(R"({{"name": "a", "edited": [{}]}})", isEdited ? R"("clearcoatFactor")" : "")));
        EXPECT_EQ(hasFeature(scene, "clearcoat"), isEdited);
        EXPECT_EQ(scene.materials[0]["clearcoatFactor"][0], 0.0F);
        ASSERT_EQ(scene.animatedMaterials.size(), isEdited ? 1U : 0U);
    }
}

// A feature is left out where no value of the range needs it.
TEST_F(MaterialLists, EditedValuesHaveRanges) {
    const auto edited = [](const char* range) {
        return fmt::format(
            R"({{"name": "a", "values": {{"clearcoatFactor": 0.5, "sheenColorFactor": [0, 0, 0]}},
                               "edited": ["roughnessFactor", {{"parameter": "clearcoatFactor"{}}}]}})",
            range);
    };
    const gltf::Scene scene = must(read(edited(R"(, "range": [0.25, 0.75])")));
    ASSERT_EQ(scene.animatedMaterials.size(), 1U);
    const materials::Material& planned = scene.animatedMaterials[0].planned;
    const auto rangeOf = [&](const char* parameter) {
        const int index = planned.model().findParameter(parameter);
        return planned.ranges[static_cast<std::size_t>(
            planned.model().parameters[static_cast<std::size_t>(index)].first)];
    };
    EXPECT_EQ(rangeOf("clearcoatFactor"), (materials::ValueInterval{0.25, 0.75}));
    EXPECT_EQ(rangeOf("roughnessFactor"), (materials::ValueInterval{0.0, 1.0}));
    const gltf::Scene metal = must(read(R"({"name": "a", "values": {"metallicFactor": 1},
                 "edited": [{"parameter": "metallicFactor", "range": [1, 1]}]})"));
    EXPECT_FALSE(hasFeature(metal, "partialMetal"));
    EXPECT_NE(refusal(edited(R"(, "range": [0.75, 0.25])"))
                  .find("/materials/0/edited/1: 0.75 to 0.25 is no range within that of clearcoatFactor"),
              std::string::npos);
    EXPECT_NE(refusal(edited(R"(, "range": [0, 2])")).find("which is 0 to 1"), std::string::npos);
    EXPECT_NE(refusal(edited(R"(, "range": [1])")).find("has 1 number, not 2"), std::string::npos);
    EXPECT_NE(refusal(edited(R"(, "range": [0.6, 1])"))
                  .find("/materials/0/edited/1: clearcoatFactor is 0.5, which is not within 0.6 to 1"),
              std::string::npos);
    EXPECT_NE(refusal(edited(R"(, "ranges": 1)")).find("/edited/1/ranges: is no member"), std::string::npos);
}

// A set that a program makes is the scene of the list that says the same.
TEST_F(MaterialLists, AreSetsOfPrograms) {
    const gltf::Scene list = must(read(R"(
        {"name": "paint", "values": {"roughnessFactor": 0.25, "sheenColorFactor": [0, 0.5, 1], "normalScale": 2},
         "textures": {"baseColorTexture": {"name": "colours", "scale": [2, 3], "rotation": 0.5},
                      "normalTexture": "bumps.png"},
         "alphaMode": "BLEND", "doubleSided": true, "weight": 4, "attributes": ["NORMAL", "TANGENT", "TEXCOORD_0"],
         "edited": [{"parameter": "clearcoatFactor", "range": [0, 0.5]}, "metallicFactor"]},
        {"name": "old", "model": "specularGlossiness", "features": ["unlit"], "alphaMode": "MASK"})"));
    gltf::MaterialSet set;
    set.path = folder_.path() / "list";
    gltf::MaterialDescription paint;
    paint.name = "paint";
    paint.values = {{"roughnessFactor", {0.25}}, {"sheenColorFactor", {0, 0.5, 1}}, {"normalScale", {2}}};
    paint.textures["baseColorTexture"] = {.name = "colours", .scale = {2, 3}, .rotation = 0.5};
    paint.textures["normalTexture"].file = "bumps.png";
    paint.alphaMode = materials::AlphaMode::Blend;
    paint.doubleSided = true;
    paint.weight = 4;
    paint.attributes = {"NORMAL", "TANGENT", "TEXCOORD_0"};
    paint.edited = {{"clearcoatFactor", {{0, 0.5}}}, {"metallicFactor", {}}};
    gltf::MaterialDescription old;
    old.name = "old";
    old.model = "specularGlossiness";
    old.features = {"unlit"};
    old.alphaMode = materials::AlphaMode::Mask;
    set.materials = {paint, old};
    const gltf::Scene scene = must(gltf::importMaterials(set));
    ASSERT_EQ(scene.materials.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const materials::Material& one = scene.materials[i];
        const materials::Material& other = list.materials[i];
        EXPECT_EQ(one.name, other.name);
        EXPECT_EQ(one.values, other.values);
        EXPECT_EQ(one.alphaMode, other.alphaMode);
        EXPECT_EQ(one.doubleSided, other.doubleSided);
        EXPECT_EQ(compiler::makeKey(gltf::planningMaterials(scene)[i], gltf::planningInputs(scene)[i], {}),
                  compiler::makeKey(gltf::planningMaterials(list)[i], gltf::planningInputs(list)[i], {}));
        EXPECT_EQ(scene.nodes[i].rest.scale, list.nodes[i].rest.scale);
    }
    ASSERT_EQ(scene.images.size(), 2U);
    EXPECT_EQ(scene.images[0].name, "colours");
    EXPECT_TRUE(scene.images[0].isAtRunTime);
    EXPECT_EQ(scene.images[1].name, "bumps.png");
    ASSERT_EQ(scene.animatedMaterials.size(), 1U);
    EXPECT_EQ(scene.animatedMaterials[0].planned.ranges, list.animatedMaterials[0].planned.ranges);
    EXPECT_EQ(std::filesystem::path(scene.path).stem(), std::filesystem::path(list.path).stem());
}

TEST_F(MaterialLists, RefuseSetsThatNoListCouldSay) {
    const auto refusalOf = [](const gltf::MaterialDescription& material) {
        const Result<gltf::Scene> scene = gltf::importMaterials({"set", {material}});
        EXPECT_FALSE(scene);
        return scene ? "" : toString(scene.error());
    };
    EXPECT_FALSE(gltf::importMaterials({}));
    EXPECT_NE(refusalOf({.weight = 0}).find("set#/materials/0/weight: error: is no number from"),
              std::string::npos)
        << refusalOf({.weight = 0});
    EXPECT_NE(refusalOf({.values = {{"roughnessFactor", {std::nan("")}}}}).find("/values/roughnessFactor"),
              std::string::npos);
    EXPECT_NE(refusalOf({.values = {{"roughnessFactor", {}}}}).find("must be a number"), std::string::npos);
    EXPECT_NE(refusalOf({.textures = {{"baseColorTexture", {.texCoord = 2}}}}).find("texCoord"),
              std::string::npos);
    EXPECT_NE(refusalOf({.features = {"unlitt"}}).find("did you mean unlit?"), std::string::npos);
}

TEST_F(MaterialLists, TrustNoTextureThatComesAtRunTime) {
    gltf::ImportOptions options;
    options.trustTextures = true;
    options.decodeImages = true;
    const gltf::Scene scene =
        must(read(R"({"name": "a", "textures": {"baseColorTexture": {}, "normalTexture": {"name": "bumps"}},
                 "values": {"normalScale": 0.5}})",
                  options));
    EXPECT_TRUE(hasFeature(scene, "baseColorTexture"));
    EXPECT_TRUE(hasFeature(scene, "normalTexture"));
    ASSERT_EQ(scene.images.size(), 2U);
    EXPECT_EQ(scene.images[0].name, "baseColorTexture");
    EXPECT_EQ(scene.images[0].pixels, (std::vector<std::uint8_t>{255, 255, 255, 255}));
    EXPECT_EQ(scene.images[1].name, "bumps");
    EXPECT_EQ(scene.images[1].pixels, (std::vector<std::uint8_t>{128, 128, 255, 255}));
}

TEST_F(MaterialLists, RefuseWhatNoDeclarationHas) {
    const auto material = [&](const std::string& members) {
        return refusal(R"({"name": "a", )" + members + "}");
    };
    EXPECT_NE(material(R"("model": "tone")").find("/materials/0/model: no declaration of a base"),
              std::string::npos);
    EXPECT_NE(material(R"("features": ["unlitt"])").find("/materials/0/features/0: no feature"),
              std::string::npos);
    EXPECT_NE(material(R"("features": ["specularGlossiness"])").find("name it as the material's \"model\""),
              std::string::npos);
    EXPECT_NE(material(R"("values": {"roughnesFactor": 1})")
                  .find("/values/roughnesFactor: no parameter is called \"roughnesFactor\"; did you mean"),
              std::string::npos);
    EXPECT_NE(material(R"("values": {"roughnessFactor": [1, 2]})").find("must be a number"),
              std::string::npos);
    EXPECT_NE(material(R"("values": {"sheenColorFactor": [1, "a", 0]})")
                  .find("/values/sheenColorFactor/1: must be a number"),
              std::string::npos);
    EXPECT_NE(
        material(R"("values": {"glossinessFactor": 1})")
            .find("glossinessFactor is of another base: the model of the material is metallicRoughness"),
        std::string::npos);
    EXPECT_NE(material(R"("model": "specularGlossiness", "edited": ["metallicFactor"])")
                  .find("/edited/0: metallicFactor is of another base"),
              std::string::npos);
    EXPECT_NE(material(R"("values": {"normalScale": 1})").find("changes nothing without the texture"),
              std::string::npos);
    EXPECT_NE(material(R"("textures": {"colorTexture": "a.png"})").find("/textures/colorTexture: no texture"),
              std::string::npos);
    EXPECT_NE(material(R"("textures": {"baseColorTexture": {"texCoord": 2}})").find("texCoord"),
              std::string::npos);
    EXPECT_NE(material(R"("textures": {"baseColorTexture": {"scale": [2]}})").find("has 1 number, not 2"),
              std::string::npos);
    EXPECT_NE(material(R"("attributes": ["TEXCOORD_3"])").find("/attributes/0: no material reads"),
              std::string::npos);
    EXPECT_NE(material(R"("weight": 0)").find("/weight"), std::string::npos);
    EXPECT_NE(material(R"("colour": 1)").find("/materials/0/colour"), std::string::npos);
    EXPECT_NE(refusal("").find("/materials"), std::string::npos);
    EXPECT_FALSE(readFile(R"({"materialList": 2, "materials": [{"name": "a"}]})"));
}

// Messages of what reads glTF name the places of the list.
TEST_F(MaterialLists, MessagesNameTheirPlaces) {
    const gltf::Scene high = must(read(R"({"name": "a", "values": {"clearcoatFactor": 2}})"));
    ASSERT_EQ(high.warnings.size(), 1U);
    EXPECT_TRUE(high.warnings[0].where.ends_with("list.json#/materials/0/values/clearcoatFactor"))
        << high.warnings[0].where;
    gltf::ImportOptions options;
    options.decodeImages = true;
    const Diagnostic missing =
        mustFail(read(R"({"name": "a", "textures": {"baseColorTexture": "none.png"}})", options));
    EXPECT_NE(missing.where.find("list.json#/materials/0/textures/baseColorTexture"), std::string::npos)
        << missing.where;
}

}  // namespace
