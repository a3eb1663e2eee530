// Values of every type of parameters, in extensions of glTF, in lists of materials and in sets of programs.
#include "base/files.h"
#include "gltf/import.h"
#include "gltf/material_set.h"
#include "materials/declarations.h"
#include "plan/key.h"
#include "support/must.h"
#include "support/temporary_folder.h"
#include "unit/gltf/gltf_builder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::test {
namespace {

// A model with parameters of all kinds, one of which has the name of one of Glint's, and a layer.
const materials::MaterialModel& typedModel() {
    static const TemporaryFolder folder;
    static const Result<const materials::MaterialModel*> model = [&] {
        EXPECT_TRUE(base::writeFile(folder.path() / "opal.json", std::string(R"json({
            "name": "opal", "extension": "EXT_opal", "stage": "base",
            "replaces": {"object": "pbrMetallicRoughness"},
            "parameters": [
                {"name": "step", "type": "int", "default": 0, "range": [-1, 2]},
                {"name": "bits", "type": "uint", "default": 0},
                {"name": "flag", "type": "bool", "default": false},
                {"name": "edge", "type": "enum", "values": ["soft", "hard"], "default": "soft"},
                {"name": "turn", "type": "mat3", "default": [1, 0, 0, 0, 1, 0, 0, 0, 1]},
                {"name": "ramp", "type": "vec2", "count": 3, "range": [0, 4], "default": [0, 0]},
                {"name": "edges", "type": "enum", "values": ["low", "high"], "count": 2, "default": "low"},
                {"name": "table", "type": "address"},
                {"name": "clearcoatFactor", "type": "int", "default": 7}],
            "textures": [{"name": "specularTexture"}, {"name": "mood", "dimension": "cube"}]})json")));
        return materials::loadMaterialModel(std::vector{folder.path().string()});
    }();
    EXPECT_TRUE(model) << toString(model.error());
    return **model;
}

gltf::ImportOptions options() {
    gltf::ImportOptions made;
    made.materialModel = &typedModel();
    return made;
}

Result<gltf::Scene> importValues(const std::string& values) {
    GltfBuilder builder;
    builder.addTriangle()["material"] = 0;
    builder.append("materials", {{"extensions", {{"EXT_opal", Json::parse(values)}}}});
    return import(builder, options());
}

std::vector<double> numbersOf(const materials::Material& material, const char* parameter) {
    return {material[parameter].begin(), material[parameter].end()};
}

using Numbers = std::vector<double>;

TEST(TypedValues, OfGltfAreReadAsTheyAre) {
    const gltf::Scene scene =
        must(importValues(R"({"step": -1, "bits": 4294967295, "flag": true, "edge": "hard",
        "turn": [1, 2, 3, 4, 5, 6, 7, 8, 9], "ramp": [[0, 0.5], [1, 1.5], [2, 9]], "edges": ["high", "low"]})"));
    const materials::Material& read = scene.materials.at(0);
    EXPECT_EQ(numbersOf(read, "step"), Numbers{-1});
    EXPECT_EQ(numbersOf(read, "bits"), Numbers{4294967295.0});
    EXPECT_EQ(numbersOf(read, "flag"), Numbers{1});
    EXPECT_EQ(numbersOf(read, "edge"), Numbers{1});
    EXPECT_EQ(numbersOf(read, "turn"), (Numbers{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(numbersOf(read, "ramp"), (Numbers{0, 0.5, 1, 1.5, 2, 4}));
    EXPECT_EQ(numbersOf(read, "edges"), (Numbers{1, 0}));
    EXPECT_EQ(numbersOf(read, "clearcoatFactor"), Numbers{7});
    const Diagnostic clamped = findWarning(scene, "material-range");
    EXPECT_TRUE(clamped.where.ends_with("/materials/0/extensions/EXT_opal/ramp/2/1")) << clamped.where;
    EXPECT_EQ(clamped.message, "is 9; 4 is used");
    EXPECT_EQ(countWarnings(must(importValues(R"({"step": 3, "bits": -1})")), "material-range"), 2U);
}

TEST(TypedValues, OfGltfHaveTheTypesOfTheirDeclarations) {
    struct Case {
        const char* values;
        const char* place;
        const char* message;
    };
    for (const Case& one : {
             Case{R"({"step": 0.5})", "/step", "is 0.5; it must be a whole number"},
             {R"({"step": "a"})", "/step", "must be a whole number"},
             {R"({"flag": 1})", "/flag", "must be true or false"},
             {R"({"edge": "hart"})", "/edge", "\"hart\" is none of soft, hard; did you mean hard?"},
             {R"({"edge": 1})", "/edge", "must be one of the names soft, hard"},
             {R"({"turn": [1, 0, 0]})", "/turn", "must be an array of 9 numbers"},
             {R"({"ramp": [0, 1]})", "/ramp", "has 2 values; it must be an array of 3"},
             {R"({"ramp": 1})", "/ramp", "must be an array of 3 values"},
             {R"({"ramp": [[0, 1], [0], [0, 1]]})", "/ramp/1", "must be an array of 2 numbers"},
             {R"({"ramp": [[0, 1], [0, null], [0, 1]]})", "/ramp/1/1", "must be a number"},
             {R"({"table": 0})", "/table", "is the address of a buffer, which only a program can give"},
             {R"({"edges": ["low", "hi"]})", "/edges/1", "\"hi\" is none of low, high"},
         }) {
        const Diagnostic refused = mustFail(importValues(one.values));
        EXPECT_TRUE(refused.where.ends_with(std::string("/materials/0/extensions/EXT_opal") + one.place))
            << refused.where;
        EXPECT_NE(refused.message.find(one.message), std::string::npos) << refused.message;
    }
}

TEST(TypedValues, AnimationsChangeFloatsAlone) {
    for (const auto& [member, type] : {std::pair{"step", "the type int"},
                                       {"edge", "the type enum (soft, hard)"},
                                       {"ramp", "the type vec2[3]"},
                                       {"turn", "the type mat3"},
                                       {"table", "the type address"}}) {
        GltfBuilder builder;
        builder.addTriangle()["material"] = 0;
        builder.append("materials", Json::parse(R"({"extensions": {"EXT_opal": {}}})"));
        const std::string pointer = fmt::format("/materials/0/extensions/EXT_opal/{}", member);
        builder.append(
            "animations",
            {{"samplers", Json::array({{{"input", builder.addAccessor(std::vector<float>{0, 1}, 1)},
                                        {"output", builder.addAccessor(std::vector<float>{0, 1}, 1)}}})},
             {"channels",
              Json::array({{{"sampler", 0},
                            {"target",
                             {{"path", "pointer"},
                              {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}})}});
        const gltf::Scene scene = must(import(builder, options()));
        EXPECT_TRUE(scene.animations.empty() || scene.animations[0].channels.empty()) << member;
        const Diagnostic warning = findWarning(scene, "animation-pointer");
        EXPECT_NE(warning.message.find(type), std::string::npos) << warning.message;
    }
}

Result<gltf::Scene> importList(const std::string& members) {
    static const TemporaryFolder folder;
    EXPECT_TRUE(base::writeFile(
        folder.path() / "list.json",
        R"({"materialList": 1, "materials": [{"name": "a", "model": "opal", )" + members + "}]}"));
    return gltf::importScene(folder.path() / "list.json", options());
}

// A set has the same values as the list, and what a model declares hides what others have of that name.
TEST(TypedValues, OfListsAreThoseOfSets) {
    const gltf::Scene list = must(importList(R"("values": {"step": 2, "bits": 3000000000, "flag": true,
        "edge": "hard", "turn": [1, 2, 3, 4, 5, 6, 7, 8, 9], "ramp": [[0, 0.5], [1, 1.5], [2, 2.5]],
        "edges": ["high", "low"], "clearcoatFactor": 5},
        "textures": {"specularTexture": {}}, "edited": ["flag", "edge", "ramp",
                                                        {"parameter": "step", "range": [0, 2]}])"));
    gltf::MaterialDescription made{.name = "a", .model = "opal"};
    made.values = {{"step", 2},
                   {"bits", 3000000000.0},
                   {"flag", true},
                   {"edge", "hard"},
                   {"turn", {1, 2, 3, 4, 5, 6, 7, 8, 9}},
                   {"ramp", {{0, 0.5}, {1, 1.5}, {2, 2.5}}},
                   {"edges", {"high", "low"}},
                   {"clearcoatFactor", {5}}};
    made.textures["specularTexture"] = {};
    made.edited = {{"flag", {}}, {"edge", {}}, {"ramp", {}}, {"step", {{0, 2}}}};
    const gltf::Scene set = must(gltf::importMaterials({"list", {made}}, options()));
    EXPECT_EQ(list.materials.at(0).values, set.materials.at(0).values);
    EXPECT_EQ(numbersOf(set.materials[0], "ramp"), (Numbers{0, 0.5, 1, 1.5, 2, 2.5}));
    EXPECT_EQ(numbersOf(set.materials[0], "clearcoatFactor"), Numbers{5});
    EXPECT_EQ(set.materials[0].values[static_cast<std::size_t>(
                  typedModel()
                      .parameters[static_cast<std::size_t>(typedModel().findParameter("clearcoatFactor"))]
                      .first)],
              0.0);
    EXPECT_GE(set.materials[0].texture("specularTexture").texture, 0);
    EXPECT_EQ(set.materials[0]
                  .textures[static_cast<std::size_t>(typedModel().findTexture("specularTexture"))]
                  .texture,
              -1);
    for (const gltf::Scene* const scene : {&list, &set}) {
        ASSERT_EQ(scene->animatedMaterials.size(), 1U);
        EXPECT_TRUE(scene->animatedMaterials[0].changes.empty());
        EXPECT_EQ(scene->animatedMaterials[0].edited,
                  (std::vector<std::string>{"opalFlag false or true", "opalEdge soft or hard",
                                            "opalRamp 0 to 4", "opalStep 0 to 2"}));
    }
}

TEST(TypedValues, OfListsAreCheckedAtTheirPlaces) {
    const auto refusal = [](const std::string& members) {
        const Diagnostic error = mustFail(importList(members));
        EXPECT_EQ(error.id, "material-list");
        return error.where.substr(error.where.find('#') + 1) + ": " + error.message;
    };
    EXPECT_EQ(refusal(R"("values": {"step": 0.5})"),
              "/materials/0/values/step: is 0.5; it must be a whole number");
    EXPECT_EQ(refusal(R"("values": {"edge": "hart"})"),
              "/materials/0/values/edge: \"hart\" is none of soft, hard; did you mean hard?");
    EXPECT_EQ(refusal(R"("values": {"flag": 0})"), "/materials/0/values/flag: must be true or false");
    EXPECT_EQ(refusal(R"("values": {"ramp": [[0, 1], [0, 1], [true, 1]]})"),
              "/materials/0/values/ramp/2/0: must be a number");
    EXPECT_EQ(refusal(R"("values": {"edges": ["low"]})"),
              "/materials/0/values/edges: has 1 values; it must be an array of 2");
    EXPECT_EQ(refusal(R"("values": {"roughnessFactor": 1})").substr(0, 70),
              "/materials/0/values/roughnessFactor: roughnessFactor is of another bas");
    EXPECT_NE(refusal(R"("values": {"table": [0, 0]})").find("/values/table: is the address of a buffer"),
              std::string::npos);
    EXPECT_NE(
        refusal(R"("edited": [{"parameter": "table", "range": [0, 1]}])").find("/range: is for numbers"),
        std::string::npos);
    EXPECT_NE(refusal(R"("edited": [{"parameter": "flag", "range": [0, 1]}])")
                  .find("/edited/0/range: is for numbers"),
              std::string::npos);
    EXPECT_NE(refusal(R"("edited": [{"parameter": "step", "range": [0.5, 1]}])")
                  .find("/edited/0: 0.5 to 1 is no range of whole numbers"),
              std::string::npos);
    EXPECT_NE(refusal(R"("edited": [{"parameter": "step", "range": [0, 3]}])").find("which is -1 to 2"),
              std::string::npos);
}

// Pictures show white for textures of each dimension that come at run time.
TEST(TypedValues, TexturesAtRunTimeHaveTheirDimension) {
    gltf::ImportOptions decoding = options();
    decoding.decodeImages = true;
    gltf::MaterialDescription made{.name = "a", .model = "opal"};
    made.textures["mood"] = {};
    const gltf::Scene scene = must(gltf::importMaterials({"list", {made}}, decoding));
    const gltf::Image& image = scene.images.at(0);
    EXPECT_EQ(image.dimension, package::TextureEntry::Dimension::Cube);
    EXPECT_EQ(image.layers, 6);
    EXPECT_EQ(image.pixels, std::vector<std::uint8_t>(24, 255));
}

}  // namespace
}  // namespace glint::test
