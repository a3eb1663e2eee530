// Packs: material features of a user's own.
#include "base/files.h"
#include "materials/declarations.h"
#include "materials/material.h"
#include "plan/plan.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace glint;
namespace fs = std::filesystem;

class MaterialPacks : public ::testing::Test {
protected:
    void write(const std::string& name, std::string_view text) const {
        fs::create_directories((folder_.path() / name).parent_path());
        ASSERT_TRUE(base::writeFile(folder_.path() / name, text));
    }

    Result<const materials::MaterialModel*> load() const {
        return materials::loadMaterialModel(std::vector{folder_.path().string()});
    }

    // Expects that the pack is refused with this error at a place that ends so.
    void expectError(std::string_view id, std::string_view place, std::string_view message) const {
        const Diagnostic model = mustFail(load());
        EXPECT_EQ(model.id, id);
        EXPECT_TRUE(model.where.ends_with(place)) << model.where;
        EXPECT_NE(model.message.find(message), std::string::npos) << model.message;
    }

    test::TemporaryFolder folder_;
};

constexpr std::string_view kMud = R"({
    "name": "mud",
    "object": "extras",
    "stage": "surface",
    "glsl": { "surface": "mud.glsl" },
    "parameters": [{ "name": "mudAmount", "at": "mud/amount", "type": "float", "default": 0, "range": [0, 1] }],
    "neutral": [{ "when": "mudAmount == 0", "because": "there is no mud" }]
})";

TEST_F(MaterialPacks, AddFeaturesAfterThoseOfGlint) {
    write("mud/mud.json", kMud);
    write("mud/mud.glsl", "// mud\n");
    const materials::MaterialModel* model = must(load());
    for (const materials::Feature& feature : materials::builtinMaterialModel().features) {
        EXPECT_EQ(model->mask(feature.name), feature.mask()) << feature.name;
    }
    materials::Material material(*model);
    EXPECT_EQ(compiler::makeKey(material, {}, {}) & model->mask("mud"), 0U);
    material["mudAmount"] = 0.5F;
    EXPECT_NE(compiler::makeKey(material, {}, {}) & model->mask("mud"), 0U);
    ASSERT_EQ(model->sources.size(), 1U);
    EXPECT_EQ(model->sources.front().text, "// mud\n");
}

TEST_F(MaterialPacks, WithoutFoldersTheModelIsThatOfGlint) {
    const materials::MaterialModel* model = must(materials::loadMaterialModel({}));
    EXPECT_EQ(model, &materials::builtinMaterialModel());
}

TEST_F(MaterialPacks, AFolderMustHaveADeclaration) {
    expectError("materials-folder", folder_.path().filename().string(), "holds no declaration");
    EXPECT_EQ(mustFail(materials::loadMaterialModel(std::vector<std::string>{"/nowhere"})).id,
              "materials-folder");
}

TEST_F(MaterialPacks, DeclaredGlslMustBeThere) {
    write("mud/mud.json", kMud);
    expectError("materials-glsl", "mud/mud.glsl", "is not there");
}

// The record of a material without the texture would give another one.
TEST_F(MaterialPacks, TexturesAreReadWhereTheKeyHasThem) {
    std::string mud(kMud);
    mud.insert(mud.find("\"parameters\""), R"("textures": [{"name": "mudTexture"}], )");
    write("mud/mud.json", mud);
    write("mud/mud.glsl", "// mud\nfloat mud() { return sampleSlot(hit, kMudTexture, features).r; }\n");
    expectError("materials-glsl", "mud/mud.glsl:2", "reads kMudTexture, but the file never asks");
    write("mud/mud.glsl",
          "float mud() { return GLINT_HAS_MUD_TEXTURE(features) ? sampleSlot(hit, kMudTexture, features).r : "
          "1.0; }\n");
    const Result<const materials::MaterialModel*> model = load();
    EXPECT_TRUE(model) << toString(model.error());
}

TEST_F(MaterialPacks, NamesMustNotCollide) {
    write("mud.json", R"({"name": "sheen", "object": "extras", "stage": "surface",
                          "neutral": [{"when": "doubleSided", "because": "both sides are clean"}]})");
    expectError("declaration", "#/name", "is declared twice");
}

TEST_F(MaterialPacks, GlslStaysInItsFolder) {
    std::string mud(kMud);
    mud.replace(mud.find("\"mud.glsl\""), 10, "\"../m.glsl\"");
    write("mud/mud.json", mud);
    expectError("declaration", "mud.json#/glsl/surface", "beside the declaration");
}

TEST_F(MaterialPacks, OrderMustHaveAnEnd) {
    std::string mud(kMud);
    mud.replace(mud.find("\"mud.glsl\""), 10, "\"mud.glsl\", \"after\": [\"mud\"]");
    write("mud/mud.json", mud);
    write("mud/mud.glsl", "");
    expectError("declaration", "mud.json#/glsl/after", "waits for itself");
    mud.replace(mud.find("[\"mud\"]"), 7, "[\"sheeen\"]");
    write("mud/mud.json", mud);
    expectError("declaration", "mud.json#/glsl/after", "sheen");
}

TEST_F(MaterialPacks, LayersAreLobes) {
    write("mud.json", R"({"name": "mud", "extension": "EXAMPLE_mud", "stage": "surface",
                          "glsl": {"bsdf": "mud.glsl", "layer": "mud.glsl"}})");
    expectError("declaration", "mud.json#/glsl/layer", "\"stage\" is \"layer\"");
}

TEST_F(MaterialPacks, AttributesOfVerticesAreAnApplicationsOwn) {
    const auto withAttributes = [](const std::string& attributes) {
        std::string mud(kMud);
        mud.insert(mud.find("\"parameters\""), "\"attributes\": " + attributes + ", ");
        return mud;
    };
    write("mud/mud.glsl", "");
    write("mud/mud.json",
          withAttributes(R"([{"name": "wet", "at": "_WET", "type": "vec3", "default": [1, 2, 3]}])"));
    const materials::MaterialModel* model = must(load());
    ASSERT_EQ(model->attributes.size(), 1U);
    const materials::VertexAttribute& wet = model->attributes.front();
    EXPECT_EQ(wet.channels, 3);
    EXPECT_EQ(wet.fallback, (std::array<float, 4>{1, 2, 3, 0}));
    EXPECT_EQ(model->features[static_cast<std::size_t>(wet.feature)].name, "mud");

    write("mud/mud.json", withAttributes(R"([{"name": "wet", "at": "WET", "type": "float"}])"));
    expectError("declaration", "mud.json#/attributes/0/at", "underscore");
    write("mud/mud.json", withAttributes(R"([{"name": "wet", "at": "_WET", "type": "vec2", "default": 1}])"));
    expectError("declaration", "mud.json#/attributes/0/default", "2 numbers");
    write("mud/mud.json", withAttributes(R"([{"name": "wet", "at": "_WET", "type": "vec2"},
                                             {"name": "wetter", "at": "_WET", "type": "float"}])"));
    expectError("declaration", "mud.json#/attributes/1/type", "has 1 channels here and 2");
}

TEST_F(MaterialPacks, CodeOfTraversalNeedsAFeature) {
    write("mud.json",
          R"({"name": "mud", "object": "extras", "stage": "opacity", "glsl": {"opacity": "mud.glsl"}})");
    expectError("declaration", "mud.json#/glsl/opacity", "a feature of its own");
    write("mud.json", R"({"name": "mud", "object": "extras", "stage": "surface",
                          "neutral": [{"when": "doubleSided", "because": "both sides are clean"}],
                          "glsl": {"diffuse": "mud.glsl"}})");
    expectError("declaration", "mud.json#/glsl/diffuse", "\"bsdf\"");
}

TEST_F(MaterialPacks, NeedsAreFramesAndCoordinates) {
    std::string mud(kMud);
    mud.insert(mud.find("\"parameters\""), R"("needs": ["tangents", "texCoord0"], )");
    write("mud/mud.json", mud);
    write("mud/mud.glsl", "");
    const materials::MaterialModel* model = must(load());
    materials::Material material(*model);
    material["mudAmount"] = 0.5F;
    materials::PrimitiveInputs inputs;
    EXPECT_EQ(compiler::makeKey(material, inputs, {}) & model->mask("mud"), 0U);
    inputs.hasTexCoords0 = true;
    EXPECT_EQ(compiler::makeKey(material, inputs, {}) & (model->mask("mud") | model->mask("texCoord0")),
              model->mask("mud") | model->mask("texCoord0"));
    mud.replace(mud.find("texCoord0"), 9, "texCoord7");
    write("mud/mud.json", mud);
    expectError("declaration", "mud.json#/needs", "texCoord7");
}

// A mask can't be dropped for its numbers if a feature changes alpha.
TEST_F(MaterialPacks, OpacityKeepsMasks) {
    write("mud/mud.json", R"({"name": "mud", "object": "extras", "stage": "opacity", "short": "Mud",
                              "glsl": {"opacity": "mud.glsl"},
                              "parameters": [{"name": "mudAmount", "at": "mud", "type": "float", "default": 0}],
                              "neutral": [{"when": "mudAmount == 0", "because": "there is no mud"}]})");
    write("mud/mud.glsl", "");
    const materials::MaterialModel* model = must(load());
    materials::Material material(*model);
    material.alphaMode = materials::AlphaMode::Mask;
    const materials::KeyOptions tested{.alpha = package::AlphaPolicy::Tested};
    EXPECT_EQ(compiler::makeKey(material, {}, tested) & model->mask("alphaMask"), 0U);
    material["mudAmount"] = 1.0F;
    EXPECT_NE(compiler::makeKey(material, {}, tested) & model->mask("alphaMask"), 0U);
}

// A division by an interval with 0 is unknown, so it drops nothing.
TEST_F(MaterialPacks, DivisionByZeroDropsNothing) {
    std::string mud(kMud);
    mud.replace(mud.find("mudAmount == 0"), 14, "1 / mudAmount > 5");
    write("mud/mud.json", mud);
    write("mud/mud.glsl", "");
    const materials::MaterialModel* model = must(load());
    EXPECT_NE(compiler::makeKey(materials::Material(*model), {}, {}) & model->mask("mud"), 0U);
}

// A model's further features may have names and orders before its base's.
TEST_F(MaterialPacks, TheBaseComesFirstOfItsModel) {
    write("zinc.json", R"json({"name": "zinc", "extension": "EXT_zinc", "stage": "base",
        "features": [{"name": "alloy", "gltf": "alloy", "order": -1,
                      "neutral": [{"when": "not has(zinc)", "because": "there is no zinc"}]}]})json");
    const materials::MaterialModel* model = must(load());
    ASSERT_EQ(model->models.size(), 1U);
    const materials::BaseModel& zinc = model->models[0];
    EXPECT_EQ(zinc.name, "zinc");
    EXPECT_EQ(model->mask("zinc"), materials::FeatureMask::ofBit(zinc.firstBit - 1));
    EXPECT_EQ(model->words(model->mask("alloy")).own, 1U);
}

// Inputs that find no place among the inputs take bits of the lobes' word, and there is an end to these, too.
TEST_F(MaterialPacks, FeaturesFillTheKey) {
    const std::size_t room = materials::kFirstOfModels - materials::builtinMaterialModel().features.size();
    for (std::size_t i = 0; i < room; ++i) {
        write(fmt::format("f{}.json", i),
              fmt::format(R"({{"name": "f{}", "extension": "EXT_f{}", "stage": "surface"}})", i, i));
    }
    const materials::MaterialModel* model = must(load());
    materials::FeatureMask all = 0;
    for (const materials::Feature& feature : model->features) {
        EXPECT_EQ(all & feature.mask(), 0U) << feature.name;
        EXPECT_EQ(feature.isLobe, (model->lobes & feature.mask()) != 0) << feature.name;
        all |= feature.mask();
    }
    EXPECT_EQ(all, ~std::uint64_t{0});
    EXPECT_EQ(model->lobes, materials::builtinMaterialModel().lobes);
    write("more.json", R"({"name": "more", "extension": "EXT_more", "stage": "surface"})");
    expectError("declaration", "#", "more features than");
}

}  // namespace
