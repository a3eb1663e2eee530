// Packs: material features of a user's own.
#include "materials/packs.h"

#include "base/files.h"
#include "materials/material.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
        ASSERT_TRUE(writeFile(folder_.path() / name, text));
    }

    Result<const MaterialModel*> load() const {
        return loadMaterialModel(std::vector{folder_.path().string()});
    }

    // Expects that the pack is refused with this error at a place that ends so.
    void expectError(std::string_view id, std::string_view place, std::string_view message) const {
        const Result<const MaterialModel*> model = load();
        ASSERT_FALSE(model);
        EXPECT_EQ(model.error().id, id);
        EXPECT_TRUE(model.error().where.ends_with(place)) << model.error().where;
        EXPECT_NE(model.error().message.find(message), std::string::npos) << model.error().message;
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
    const Result<const MaterialModel*> model = load();
    ASSERT_TRUE(model) << toString(model.error());
    for (const Feature& feature : builtinMaterialModel().features) {
        EXPECT_EQ((*model)->mask(feature.name), feature.mask()) << feature.name;
    }
    Material material(**model);
    EXPECT_EQ(makeKey(material, {}, {}) & (*model)->mask("mud"), 0U);
    material["mudAmount"] = 0.5F;
    EXPECT_NE(makeKey(material, {}, {}) & (*model)->mask("mud"), 0U);
    ASSERT_EQ((*model)->sources.size(), 1U);
    EXPECT_EQ((*model)->sources.front().text, "// mud\n");
}

TEST_F(MaterialPacks, WithoutFoldersTheModelIsThatOfGlint) {
    const Result<const MaterialModel*> model = loadMaterialModel({});
    ASSERT_TRUE(model);
    EXPECT_EQ(*model, &builtinMaterialModel());
}

TEST_F(MaterialPacks, AFolderMustHaveADeclaration) {
    expectError("materials-folder", folder_.path().filename().string(), "holds no declaration");
    const Result<const MaterialModel*> none = loadMaterialModel(std::vector<std::string>{"/nowhere"});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().id, "materials-folder");
}

TEST_F(MaterialPacks, DeclaredGlslMustBeThere) {
    write("mud/mud.json", kMud);
    expectError("materials-glsl", "mud/mud.glsl", "is not there");
}

TEST_F(MaterialPacks, NamesMustNotCollide) {
    write("mud.json", R"({"name": "sheen", "object": "extras", "stage": "surface", "short": "Mud"})");
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

// A division by an interval with 0 is unknown, so it drops nothing.
TEST_F(MaterialPacks, DivisionByZeroDropsNothing) {
    std::string mud(kMud);
    mud.replace(mud.find("mudAmount == 0"), 14, "1 / mudAmount > 5");
    write("mud/mud.json", mud);
    write("mud/mud.glsl", "");
    const Result<const MaterialModel*> model = load();
    ASSERT_TRUE(model) << toString(model.error());
    EXPECT_NE(makeKey(Material(**model), {}, {}) & (*model)->mask("mud"), 0U);
}

// Inputs that find no place among the inputs take bits of the lobes' word, and there is an end to these, too.
TEST_F(MaterialPacks, FeaturesFillTheKey) {
    const std::size_t room = kFeatureBits - builtinMaterialModel().features.size();
    for (std::size_t i = 0; i < room; ++i) {
        write(fmt::format("f{}.json", i),
              fmt::format(R"({{"name": "f{}", "object": "extras", "stage": "surface", "short": "F{}"}})", i,
                          i));
    }
    const Result<const MaterialModel*> model = load();
    ASSERT_TRUE(model) << toString(model.error());
    FeatureMask all = 0;
    for (const Feature& feature : (*model)->features) {
        EXPECT_EQ(all & feature.mask(), 0U) << feature.name;
        EXPECT_EQ(feature.isLobe, ((*model)->lobes & feature.mask()) != 0) << feature.name;
        all |= feature.mask();
    }
    EXPECT_EQ(all, ~FeatureMask{0});
    EXPECT_EQ((*model)->lobes, builtinMaterialModel().lobes);
    write("more.json", R"({"name": "more", "object": "extras", "stage": "surface", "short": "More"})");
    expectError("declaration", "#", "more features than");
}

}  // namespace
