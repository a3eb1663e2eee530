// Tests the declarations of material features: Glint's own, and what the reader refuses.
#include "materials/declarations.h"

#include "materials/declaration_files.h"
#include "materials/declaration_members.h"
#include "plan/plan.h"
#include "support/must.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <interop/models.h>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace {

using namespace glint;

// Glint's own declarations with one more.
Result<materials::MaterialModel> modelWith(const std::string& text, bool isOfPack = false) {
    std::vector<materials::DeclarationFile> files;
    for (const base::BuiltinFile& file : materials::declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    files.push_back({"materials/wet/wet.json", text, isOfPack});
    return readDeclarations(files);
}

std::string refusal(const std::string& text) {
    const Result<materials::MaterialModel> model = modelWith(text);
    EXPECT_FALSE(model.ok()) << text;
    if (model) {
        return {};
    }
    EXPECT_EQ(model.error().id, "declaration");
    return model.error().where + ": " + model.error().message;
}

TEST(Declarations, OfGlintAreComplete) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    EXPECT_EQ(model.features.size(), 45U);
    EXPECT_EQ(model.order.size(), model.features.size());
    std::set<std::string> shortNames;
    for (const materials::Feature& feature : model.features) {
        EXPECT_FALSE(feature.gltf.empty()) << feature.name;
        EXPECT_TRUE(shortNames.insert(feature.shortName).second) << feature.shortName;
        EXPECT_TRUE(!feature.neutral.empty() || feature.stage == materials::Stage::Base ||
                    feature.texture >= 0)
            << feature.name;
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        EXPECT_FALSE(texture.places.empty()) << texture.name;
        EXPECT_EQ(model.features[static_cast<std::size_t>(texture.feature)].name, texture.name);
    }
}

TEST(Declarations, DoNotDependOnTheOrderOfFiles) {
    std::vector<materials::DeclarationFile> files;
    for (const base::BuiltinFile& file : materials::declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    std::ranges::reverse(files);
    const materials::MaterialModel model = must(readDeclarations(files));
    EXPECT_EQ(model.featureDefines(), materials::builtinMaterialModel().featureDefines());
    EXPECT_TRUE(std::ranges::equal(model.order, materials::builtinMaterialModel().order, {},
                                   &materials::FeatureStep::feature, &materials::FeatureStep::feature));
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        EXPECT_EQ(model.parameters[i].name, materials::builtinMaterialModel().parameters[i].name);
    }
}

// A user's feature is in keys like Glint's own, from one file alone.
TEST(Declarations, OneFileAddsAFeature) {
    const materials::MaterialModel model = must(modelWith(R"({
        "name": "wet", "extension": "EXT_wet", "stage": "layer",
        "parameters": [{"name": "wetness", "type": "float", "default": 0, "range": [0, 1]}],
        "textures": [{"name": "wetTexture", "scales": ["wetness"]}],
        "neutral": [{"when": "wetness == 0", "because": "wetness is 0"}],
        "effects": [{"does": "reflects", "when": "wetness > 0", "roughness": "0.02", "text": "is wet"}]})"));
    const materials::FeatureMask wet = model.mask("wet");
    EXPECT_NE(wet & model.lobes, 0U);
    EXPECT_NE(model.featureDefines().find("#define GLINT_WET_TEXTURE "), std::string::npos);
    materials::Material material(model);
    material["metallicFactor"] = 0.0F;
    materials::PrimitiveInputs primitive;
    primitive.hasTexCoords0 = true;
    const materials::EffectDeclaration& reflection = materials::builtinMaterialModel().effects[2];
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & wet, 0U);
    EXPECT_FALSE(compiler::sendsRays(reflection, material, primitive, 0.3F));
    material["wetness"] = 0.5F;
    material.texture("wetTexture").texture = 0;
    EXPECT_EQ(compiler::makeKey(material, primitive, {}),
              wet | model.mask("wetTexture") | model.mask("texCoord0"));
    EXPECT_TRUE(compiler::sendsRays(reflection, material, primitive, 0.3F));
    // Existing features keep their bits.
    for (const materials::Feature& feature : materials::builtinMaterialModel().features) {
        EXPECT_EQ(model.mask(feature.name), feature.mask()) << feature.name;
    }
}

TEST(Declarations, SayWhatIsWrongAndWhere) {
    const std::string file = "materials/wet/wet.json";
    EXPECT_EQ(refusal("{"), file + ": is no JSON");
    EXPECT_EQ(refusal("[]"), file + "#: must be an object");
    EXPECT_EQ(refusal("{}"), file + "#: has no \"name\"");
    EXPECT_EQ(refusal(R"({"name": "Wet", "stage": "layer"})"),
              file + "#/name: \"Wet\" must be letters and digits that begin with a small letter");
    EXPECT_NE(refusal(R"({"name": "sheen", "stage": "layer"})").find("is declared twice"), std::string::npos);
    EXPECT_NE(
        refusal(R"({"name": "wet", "stage": "layr"})").find("#/stage: there is no \"layr\"; did you mean"),
        std::string::npos);
    EXPECT_NE(
        refusal(R"({"name": "wet", "stage": "layer", "neutrl": []})").find("#/neutrl: there is no member"),
        std::string::npos);
    const auto withReason = [&](const std::string& when) {
        return refusal(R"({"name": "wet", "stage": "layer", "neutral": [{"when": ")" + when +
                       R"(", "because": "it is"}]})");
    };
    EXPECT_NE(withReason("wetness == 0").find("#/neutral/0/when: there is no \"wetness\""),
              std::string::npos);
    EXPECT_NE(withReason("metallicFactor").find("must be a condition"), std::string::npos);
    EXPECT_NE(withReason("has(wet)").find("lead back to it"), std::string::npos);
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "surface", "parameters": [
                          {"name": "wetness", "type": "float", "default": 2, "range": [0, 1]}]})")
                  .find("#/parameters/0/default: is outside of the range"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "surface", "textures": [
                          {"name": "wetTexture", "scales": ["damp"]}]})")
                  .find("there is no parameter \"damp\""),
              std::string::npos);
    const auto withScales = [&](const std::string& scales) {
        return refusal(R"({"name": "wet", "stage": "surface",
            "parameters": [{"name": "wetness", "type": "color", "default": [0, 0, 0], "range": [0, 1]}],
            "textures": [{"name": "wetTexture", "scales": [")" +
                       scales + R"("]}]})");
    };
    EXPECT_NE(withScales("wetness.rg").find("\"wetness.rg\" must name 3 of the texture's channels"),
              std::string::npos);
    EXPECT_NE(withScales("wetness.rgx").find("a channel that is not r, g, b or a"), std::string::npos);
    EXPECT_TRUE(modelWith(R"({"name": "wet", "stage": "surface",
            "parameters": [{"name": "wetness", "type": "color", "default": [0, 0, 0], "range": [0, 1]}],
            "textures": [{"name": "wetTexture", "scales": ["wetness.bga"]}]})")
                    .ok());
    const auto withRoughness = [&](const std::string& members) {
        return refusal(R"({"name": "wet", "stage": "surface", "textures": [{"name": "wetTexture", )" +
                       members + "}]}");
    };
    EXPECT_NE(withRoughness(R"("roughness": "rg")").find("\"rg\" is neither one of the channels"),
              std::string::npos);
    EXPECT_NE(withRoughness(R"("reads": "r", "roughness": "1 - a")").find("\"reads\" names"),
              std::string::npos);
    EXPECT_NE(withRoughness(R"("reads": "normal", "roughness": "g")").find("\"reads\" names"),
              std::string::npos);
    EXPECT_NE(
        withRoughness(R"("color": true, "roughness": "g")").find("must be alpha in a texture of colours"),
        std::string::npos);
    EXPECT_NE(withReason("texel(dampTexture).r == 1").find("there is no \"texel(dampTexture)\""),
              std::string::npos);
    EXPECT_NE(refusal(std::string(2000, '[')).find("nests too deep"), std::string::npos);
}

// Each member that says something of the declaration's own feature, where there is none. "excludes" read out
// of bounds once.
TEST(Declarations, MembersOfAFeatureNeedOne) {
    for (const std::string member :
         {R"("short": "Wet")", R"("light": "none")", R"("given": "doubleSided")", R"("needs": "tangents")",
          R"("draft": true)", R"("ofBase": true)", R"("cost": {"instructions": 1, "fetches": 0})",
          R"("order": 3)", R"("gltf": "somewhere")",
          R"("excludes": {"stage": "layer", "because": "it is wet"})"}) {
        const std::string name = member.substr(1, member.find('"', 1) - 1);
        const std::string without = R"({"name": "wet", "stage": "layer", "parameters": [
            {"name": "wetness", "type": "float", "default": 0, "range": [0, 1]}], )" +
                                    member;
        EXPECT_EQ(refusal(without + "}"), "materials/wet/wet.json#/" + name +
                                              ": is of a feature of the declaration's own, and it has none");
        const Result<materials::MaterialModel> model =
            modelWith(without + R"(, "neutral": [{"when": "wetness == 0", "because": "wetness is 0"}]})");
        EXPECT_TRUE(model.ok()) << member;
    }
}

TEST(Declarations, NoMaterialGetsAFeatureUnasked) {
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "layer", "neutral": []})")
                  .find("every material would have its feature"),
              std::string::npos);
    const auto replacing = [](const std::string& name, const std::string& owner) {
        return R"({"name": ")" + name + R"(", "stage": "base", )" + owner +
               R"("replaces": {"object": "pbrMetallicRoughness"}})";
    };
    EXPECT_NE(refusal(replacing("wet", "")).find("#/replaces: every material would lose"), std::string::npos);
    // Base models may replace the same object; others may not.
    const std::string base = replacing("wet", R"("extension": "EXT_wet", )");
    EXPECT_TRUE(modelWith(base).ok());
    std::string surface = base;
    surface.replace(surface.find("\"base\""), 6, "\"surface\"");
    EXPECT_NE(refusal(surface).find("replaces it, too"), std::string::npos);
}

TEST(Declarations, WhatTransmitsTakesLightFromBothSides) {
    const auto wet = [](const std::string& members) {
        return R"({"name": "wet", "stage": "layer", "extension": "EXT_wet", )" + members +
               R"("effects": [{"does": "transmits", "when": "doubleSided", "text": "lets light through"}]})";
    };
    EXPECT_NE(refusal(wet("")).find("#/effects/0/does: light comes to such a surface"), std::string::npos);
    EXPECT_TRUE(modelWith(wet(R"("light": "both", )")).ok());
}

TEST(Declarations, AnglesHaveNoRange) {
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "surface", "parameters": [
            {"name": "wetness", "type": "float", "default": 0, "unit": "radians", "range": [0, 1]}]})")
                  .find("#/parameters/0/range: angles are held"),
              std::string::npos);
}

TEST(Declarations, ModelsReplaceABase) {
    const auto declared = [](const std::string& stage, const std::string& members, const std::string& glsl) {
        return R"({"name": "wet", "stage": ")" + stage + R"(", )" + members + R"("glsl": {)" + glsl + "}}";
    };
    const std::string whole = R"("extension": "EXT_wet", "replaces": {"object": "pbrMetallicRoughness"}, )";
    const std::string files = R"("bsdf": "wet.glsl", "model": "wet.glsl")";
    const Result<materials::MaterialModel> model =
        modelWith(declared("base", whole + R"("light": "both", )", files + R"(, "sampled": true)"), true);
    ASSERT_TRUE(model.ok()) << toString(model.error());
    EXPECT_EQ(model->ownModels, model->mask("wet"));
    EXPECT_NE(model->bothSides & model->mask("wet"), 0U);
    EXPECT_EQ(model->modelWord(0), 1U | gpu::kModelOwnCode | gpu::kModelBothSides | gpu::kModelSampled);
    EXPECT_NE(model->featureDefines().find("#define GLINT_HAS_WET(features) hasOwn(features, 1u, 0, 0x0u)\n"),
              std::string::npos);
    EXPECT_NE(refusal(declared("layer", R"("extension": "EXT_wet", )", files))
                  .find("#/glsl/model: needs a declaration whose"),
              std::string::npos);
    EXPECT_NE(
        refusal(declared("base", R"("extension": "EXT_wet", )", files)).find("#/glsl/model: a model is"),
        std::string::npos);
    EXPECT_NE(refusal(declared("base", whole, R"("model": "wet.glsl")")).find("#/glsl/model: needs \"bsdf\""),
              std::string::npos);
    EXPECT_NE(refusal(declared("base", whole, R"("bsdf": "wet.glsl", "sampled": true)"))
                  .find("#/glsl/sampled: is for models"),
              std::string::npos);
    EXPECT_NE(refusal(declared("base", whole + R"("light": "back", )", files)).find("#/light"),
              std::string::npos);
}

TEST(Declarations, AliasesHaveNoRangeOfTheirOwn) {
    const auto alias = [](const std::string& members) {
        return R"({"name": "wet", "stage": "layer", "object": "wetness", "parameters": [
            {"name": "dampness", "is": "metallicFactor", "default": 0)" +
               members + "}]}";
    };
    EXPECT_TRUE(modelWith(alias("")).ok());
    for (const std::string member : {R"("range": [0, 2])", R"("also": [3])", R"("of": "clearcoat")",
                                     R"("type": "vec2")", R"("unit": "radians")", R"("record": false)"}) {
        EXPECT_NE(refusal(alias(", " + member)).find("is that of the parameter"), std::string::npos)
            << member;
    }
}

// Glint's own code knows parameters, textures and features by their roles alone.
TEST(Declarations, RolesFillWhatGlintReads) {
    const materials::MaterialModel& own = materials::builtinMaterialModel();
    for (const materials::NamedRole& row : materials::kRoles) {
        const auto isOf = [&](materials::Place place) { return (row.places & placeBit(place)) != 0; };
        EXPECT_EQ(own.parameterOf(row.role) >= 0, isOf(materials::Place::Parameter)) << row.name;
        EXPECT_EQ(own.textureOf(row.role) >= 0, isOf(materials::Place::Texture)) << row.name;
        EXPECT_EQ(own.mask(row.role) != 0, isOf(materials::Place::Feature)) << row.name;
    }
    EXPECT_EQ(own.featuresFor(package::Role::BaseColor), own.mask("baseColorTexture") |
                                                             own.mask("texCoord0") | own.mask("texCoord1") |
                                                             own.mask("textureTransform"));
    EXPECT_EQ(own.featuresFor(package::Role::EmissionStrength), own.mask("emissiveStrength"));
    const auto wet = [](const std::string& parameter, const std::string& texture) {
        return R"({"name": "wet", "extension": "EXT_wet", "stage": "base",
            "replaces": {"object": "pbrMetallicRoughness"},
            "parameters": [{"name": "shine", "default": [1, 0, 0], )" +
               parameter + R"(}], "textures": [{"name": "shineTexture", )" + texture + "}]}";
    };
    // A role of Glint's is filled as by its name, so a lamp of a model is a lamp as glTF's is.
    const materials::MaterialModel byRole =
        must(modelWith(wet(R"("role": "emission")", R"("role": "emission")"), true));
    const materials::MaterialModel byName =
        must(modelWith(wet(R"("is": "emissiveFactor")", R"("is": "emissiveTexture")"), true));
    for (const materials::MaterialModel* model : {&byRole, &byName}) {
        const int shine = model->findParameter("wetShine");
        EXPECT_EQ(model->parameters[static_cast<std::size_t>(shine)].aliasOf,
                  model->parameterOf(package::Role::Emission));
        EXPECT_EQ(model->parameterOf(package::Role::Emission), own.parameterOf(package::Role::Emission));
        EXPECT_EQ(model->textures[static_cast<std::size_t>(model->textureOf(package::Role::Emission))]
                      .places.size(),
                  2U);
    }
    EXPECT_EQ(byRole.featureDefines(), byName.featureDefines());
    for (const char* const defines :
         {"#define GLINT_EMISSIVE_TEXTURE 0x10u\n", "#define GLINT_ROLE_EMISSION_TEXTURE 0x10u\n",
          "#define GLINT_VERTEX_COLOR 0x200u\n", "#define GLINT_ROLE_VERTEX_COLOR 0x200u\n"}) {
        EXPECT_NE(byRole.featureDefines().find(defines), std::string::npos) << defines;
    }
    // What is refused beside a name is refused beside a role, and so are other things with the role.
    for (const auto& [parameter, texture, message] : {
             std::tuple(R"("role": "emission", "range": [0, 2])", R"("color": true)",
                        "#/parameters/0/range: is that of the parameter"),
             std::tuple(R"("role": "emission", "is": "emissiveFactor")", R"("color": true)",
                        "#/parameters/0/is: says what the role says"),
             std::tuple(R"("role": "emission")", R"("role": "alphaCutoff")",
                        "#/textures/0/role: \"alphaCutoff\" is the role of something else"),
             std::tuple(R"("role": "emision")", R"("color": true)",
                        "#/parameters/0/role: there is no \"emision\""),
             std::tuple(R"("role": "emission")",
                        R"("role": "emission", "cost": {"instructions": 1, "fetches": 1})",
                        "#/textures/0/cost: is that of the texture"),
         }) {
        EXPECT_NE(refusal(wet(parameter, texture)).find(message), std::string::npos)
            << refusal(wet(parameter, texture));
    }
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "surface", "features": [
                  {"name": "damp", "gltf": "damp", "role": "normals", "given": "NORMAL"}]})")
                  .find("#/features/0/role: materials/attributes/attributes.json#/features/1 has the role"),
              std::string::npos);
}

// What a parameter may be is told by one texture: with two, a feature was left out that changes something.
TEST(Declarations, OneTextureScalesAParameter) {
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "surface",
            "parameters": [{"name": "wetness", "type": "float", "default": 0, "range": [0, 1]}],
            "textures": [{"name": "wetTexture", "scales": ["wetness.r"]},
                         {"name": "dampTexture", "scales": ["wetness.g"]}]})")
                  .find("#/textures/1/scales: wetTexture scales \"wetness\", too"),
              std::string::npos);
}

// An alias has the numbers of the parameter that it fills, and no channel counts twice.
TEST(Declarations, ScaledParametersAreThoseThatAliasesFill) {
    const auto scaling = [](const std::string& scales) {
        return R"({"name": "wet", "stage": "surface", "object": "wetness",
            "parameters": [{"name": "wetRoughness", "is": "roughnessFactor", "default": 1},
                           {"name": "wetIor", "is": "ior", "default": 1.5}],
            "textures": [{"name": "wetTexture", "scales": )" +
               scales + "}]}";
    };
    EXPECT_NE(refusal(scaling(R"(["wetRoughness.r"])")).find("metallicRoughnessTexture scales"),
              std::string::npos);
    EXPECT_NE(refusal(scaling(R"(["wetIor.r", "wetIor.g"])")).find("\"wetIor\" is scaled twice"),
              std::string::npos);
    const materials::MaterialModel model = must(modelWith(scaling(R"(["wetIor.r"])")));
    for (const char* const name : {"ior", "wetIor"}) {
        EXPECT_EQ(model.parameters[static_cast<std::size_t>(model.findParameter(name))].scaledBy,
                  model.findTexture("wetTexture"))
            << name;
    }
}

// What lobes alone can say was lost where inputs said it, or was no GLSL.
TEST(Declarations, LightIsOfLobes) {
    for (const std::string member : {R"("light": "both")", R"("ofBase": true)"}) {
        const std::string text =
            R"({"name": "wet", "extension": "EXT_wet", "stage": "surface", )" + member + "}";
        EXPECT_NE(refusal(text).find("is for lobes"), std::string::npos) << member;
    }
}

TEST(Declarations, NumbersAreInTheirRanges) {
    const auto wet = [](const std::string& members) {
        return R"({"name": "wet", "extension": "EXT_wet", "stage": "layer", )" + members + "}";
    };
    EXPECT_NE(
        refusal(wet(R"("cost": {"instructions": -1, "fetches": 0})")).find("#/cost/instructions: must be"),
        std::string::npos);
    EXPECT_NE(
        refusal(wet(R"("replaces": {"object": "KHR_materials_sheen", "sets": {"sheenRoughnessFactor": 2}})"))
            .find("#/replaces/sets/sheenRoughnessFactor: is outside"),
        std::string::npos);
    EXPECT_NE(refusal(wet(R"("replaces": {"object": "EXT_wet"})")).find("is the declaration's own object"),
              std::string::npos);
    EXPECT_NE(refusal(wet(R"("needs": [])")).find("#/needs: names nothing"), std::string::npos);
    EXPECT_NE(refusal(wet(R"("glsl": {"after": ["sheen"]})")).find("#/glsl: names no file"),
              std::string::npos);
    EXPECT_NE(
        refusal(wet(R"("parameters": [{"name": "wetness", "type": "float", "default": 0, "range": [0, 1],
                                             "also": [0.5]}])"))
            .find("#/parameters/0/also: is within the range"),
        std::string::npos);
    EXPECT_NE(refusal(wet(R"("effects": [{"does": "emits", "when": "MASK", "value": "1", "text": "glows"}])"))
                  .find("#/effects/0/value: there is no {}"),
              std::string::npos);
}

// Without words for explain, a reflection counted as none.
TEST(Declarations, ReflectionsNeedNoWords) {
    const materials::MaterialModel model =
        must(modelWith(R"({"name": "wet", "extension": "EXT_wet", "stage": "layer",
            "effects": [{"does": "reflects", "when": "raysBlend or not raysBlend", "roughness": "0.02"}]})"));
    materials::Material material(model);
    material["metallicFactor"] = 0.0F;
    EXPECT_TRUE(compiler::sendsRays(materials::builtinMaterialModel().effects[2], material, {}, 0.3F));
}

// Names that stand alone in GLSL; those of other features are the beginnings of names.
TEST(Declarations, NamesAreNoWordsOfGlsl) {
    const auto layer = [](const std::string& name) {
        return R"({"name": ")" + name +
               R"(", "extension": "EXT_wet", "stage": "layer", "glsl": {"bsdf": "a.glsl", "layer": "a.glsl"}})";
    };
    const auto parameter = [](const std::string& name) {
        return R"({"name": "wet", "stage": "layer", "parameters": [{"name": ")" + name +
               R"(", "type": "float", "default": 0}]})";
    };
    for (const std::string name : {"precision", "sample", "vec3", "mat2x3"}) {
        EXPECT_NE(refusal(layer(name)).find("#/name: \"" + name + "\" is a word of GLSL"), std::string::npos);
        EXPECT_NE(refusal(parameter(name)).find("#/parameters/0/name: \"" + name + "\" is a word of GLSL"),
                  std::string::npos);
    }
    EXPECT_TRUE(modelWith(parameter("vec")).ok());
    EXPECT_TRUE(modelWith(R"({"name": "half", "stage": "opacity"})").ok());
}

// Glint's shaders have macros such as GLINT_PATHS and GLINT_FRAME. The bits of packs have a prefix, and no
// macro of Glint's has one of the prefixes of those that follow from names.
TEST(Declarations, MacrosOfPacksMeetNoneOfGlints) {
    const materials::DeclarationFile file{
        "wet.json",
        R"({"name": "paths", "extension": "EXT_paths", "stage": "layer", "textures": [{"name": "frame"}]})",
        true};
    const materials::MaterialModel model = must(materials::readDeclarations({&file, 1}));
    const std::string defines = model.featureDefines();
    EXPECT_NE(defines.find("#define GLINT_PACK_PATHS 0x1u\n#define GLINT_HAS_PATHS(features) hasLobe("),
              std::string::npos)
        << defines;
    EXPECT_NE(defines.find("#define GLINT_KEY_HAS_FRAME(features) inputOfKey(features, GLINT_PACK_FRAME)"),
              std::string::npos);
    std::set<std::string> known;
    for (const materials::Feature& feature : materials::builtinMaterialModel().features) {
        known.insert(feature.macro.substr(6));
    }
    const std::regex macro("GLINT_(PACK|HAS|KEY_HAS)_([A-Z0-9_]+)");
    for (const char* const folder : {"shaders", "templates"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::string(GLINT_SOURCE_DIR "/") + folder)) {
            std::ifstream stream(entry.is_regular_file() ? entry.path() : std::filesystem::path());
            const std::string text(std::istreambuf_iterator<char>(stream), {});
            for (std::sregex_iterator found(text.begin(), text.end(), macro); found != std::sregex_iterator();
                 ++found) {
                EXPECT_TRUE(known.contains((*found)[2])) << entry.path() << ": " << (*found)[0];
            }
        }
    }
}

// Code outside of the folders of declarations asks for roles, and shaders ask materials/base/queries.glsl
// what a base does. Excepted are code that reads glTF, and code that is about materials of glTF.
TEST(Declarations, NoOtherCodeNamesWhatTheyDeclare) {
    constexpr std::string_view kExcepted[] = {"shaders/materials/", "tool/gltf/document/", "tool/synthetic/",
                                              "tool/measure/features/combinations.cpp"};
    std::set<std::string> names;
    const auto add = [&](const std::string& name, const std::string& constant) {
        names.insert({"\"" + name + "\"", constant});
    };
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    for (const materials::Parameter& parameter : model.parameters) {
        add(parameter.name, "_" + materials::fieldMacro(parameter.name) + "(");
    }
    for (const materials::DerivedField& field : model.derived) {
        add(field.name, "_" + materials::fieldMacro(field.name) + "(");
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        add(texture.name, "k" + materials::capitalized(texture.name));
    }
    for (const materials::Feature& feature : model.features) {
        names.insert(feature.macro);
    }
    for (const materials::NamedRole& role : materials::kRoles) {
        names.erase("\"" + std::string(role.name) + "\"");  // a word of its own
    }
    int sources = 0;
    const std::regex word(R"("[A-Za-z0-9]+"|\bk[A-Z]\w*|GLINT_(RECORD|MATERIAL)(_[A-Z0-9_]+\()|\bGLINT_\w+)");
    for (const char* const folder : {"runtime", "shaders", "templates", "tool", "verify"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::string(GLINT_SOURCE_DIR "/") + folder)) {
            const std::string path =
                std::filesystem::relative(entry.path(), GLINT_SOURCE_DIR).generic_string();
            if (!entry.is_regular_file() || entry.path().extension() == ".json" ||
                std::ranges::any_of(kExcepted, [&](std::string_view one) { return path.starts_with(one); })) {
                continue;
            }
            ++sources;
            std::ifstream stream(entry.path());
            for (std::string line; std::getline(stream, line);) {
                const std::string code = line.substr(0, line.find("//"));
                for (std::sregex_iterator found(code.begin(), code.end(), word);
                     found != std::sregex_iterator(); ++found) {
                    const std::string name = (*found)[2].matched ? (*found)[2].str() : (*found)[0].str();
                    EXPECT_FALSE(names.contains(name)) << path << " names " << (*found)[0];
                }
            }
        }
    }
    EXPECT_GT(sources, 500);
}

TEST(Declarations, FeaturesOfPacksCostSomething) {
    const std::string text = R"({"name": "wet", "extension": "EXT_wet", "stage": "layer",
        "textures": [{"name": "wetTexture"}, {"name": "dampTexture", "cost": {"instructions": 7, "fetches": 2}}]})";
    for (const bool isOfPack : {true, false}) {
        const materials::DeclarationFile file{"wet.json", text, isOfPack};
        const materials::MaterialModel model = must(materials::readDeclarations({&file, 1}));
        const auto cost = [&](std::string_view name) {
            return model.features[static_cast<std::size_t>(model.findFeature(name))].cost;
        };
        EXPECT_EQ(cost("wet").instructions > 0.0, isOfPack);
        EXPECT_EQ(cost("wetTexture").fetches, isOfPack ? 1.0 : 0.0);
        EXPECT_EQ(cost("dampTexture").instructions, 7.0);
        EXPECT_EQ(cost("dampTexture").fetches, 2.0);
    }
}

TEST(Declarations, RoughnessIsOneNumber) {
    const auto reflecting = [](const std::string& roughness) {
        return R"({"name": "wet", "stage": "layer", "extension": "EXT_wet",
            "parameters": [{"name": "wetRoughness", "type": "vec2", "default": [0, 0], "range": [0, 1]}],
            "effects": [{"does": "reflects", "when": "doubleSided", "roughness": ")" +
               roughness + R"(", "text": "is wet"}]})";
    };
    EXPECT_NE(refusal(reflecting("wetRoughness")).find("#/effects/0/roughness: has 2 channels"),
              std::string::npos);
    EXPECT_TRUE(modelWith(reflecting("wetRoughness.g")).ok());
}

TEST(Declarations, AFeatureReadsOneUvSetOfItsOwn) {
    EXPECT_NE(refusal(R"({"name": "wet", "stage": "layer", "extension": "EXT_wet",
                          "needs": ["texCoord0", "texCoord1"]})")
                  .find("#/needs: a feature can read one UV set"),
              std::string::npos);
}

constexpr std::string_view kGlow = R"({
    "name": "glow",
    "about": "It glows.",
    "kind": "rays",
    "glsl": { "sample": "glow.glsl" },
    "calledFor": { "by": "emits", "otherwise": "nothing glows" },
    "coherence": 0.5
})";

// Returns the text of kGlow with a part of it changed.
std::string glowWith(std::string_view part, std::string_view other) {
    std::string text(kGlow);
    const std::size_t place = text.find(part);
    EXPECT_NE(place, std::string::npos) << part;
    return text.replace(place, part.size(), other);
}

TEST(Declarations, OfEffectsAreRead) {
    const materials::DeclarationFile file{"packs/glow/glow.json", kGlow, true};
    const materials::MaterialModel model = must(materials::readDeclarations({&file, 1}));
    ASSERT_EQ(model.effects.size(), 1U);
    const materials::EffectDeclaration& glow = model.effects[0];
    EXPECT_EQ(glow.sample, "packs/glow/glow.glsl");
    EXPECT_EQ(glow.call.behaviour, materials::Behaviour::Emits);
    EXPECT_EQ(glow.function(), "Glow");
    EXPECT_EQ(glow.abilities(), 0U);
    materials::EffectDeclaration named;
    named.name = "ambient-occlusion";
    EXPECT_EQ(named.function(), "AmbientOcclusion");
    EXPECT_EQ(named.macro(), "AMBIENT_OCCLUSION");
    EXPECT_EQ(named.file(), "ambient_occlusion");
}

TEST(Declarations, OfEffectsSayWhatIsWrongAndWhere) {
    const auto refuses = [](const std::string& text, std::string_view message) {
        const std::string refused = refusal(text);
        EXPECT_NE(refused.find(message), std::string::npos) << refused;
    };
    EXPECT_TRUE(modelWith(std::string(kGlow)).ok());
    refuses(glowWith("\"glow\"", "\"Glow\""), "#/name: \"Glow\" must be words");
    refuses(glowWith("\"glow\"", "\"glow-\""), "#/name: \"glow-\" must be words");
    refuses(glowWith("\"glow\"", "\"shadow\""), "declared twice");
    refuses(glowWith("\"glow\"", "\"auto\""), "has another meaning");
    refuses(glowWith("It glows.", "It glows"), "#/about: must be a sentence");
    refuses(glowWith("\"rays\"", "\"ray\""), "#/kind: there is no \"ray\"; did you mean");
    refuses(glowWith("\"rays\"", "\"surface\""), "#/glsl/sample: there is no member");
    refuses(glowWith("{ \"sample\": \"glow.glsl\" }", "{}"), "#/glsl: has no \"sample\"");
    refuses(glowWith("glow.glsl", "../glow.glsl"), "beside the declaration");
    refuses(glowWith("\"glow.glsl\"", "\"glow.glsl\", \"walk\": \"walk.glsl\""),
            "#/glsl/walk: \"walk.glsl\"");
    refuses(glowWith("\"otherwise\"", "\"because\""), "#/calledFor: \"because\" stands where");
    refuses(glowWith("\"emits\"", "\"lit\""), "#/calledFor: \"because\" stands where");
    refuses(glowWith("0.5", "1.5"), "#/coherence: must be from 0 to 1");
    refuses(glowWith("\"coherence\"", "\"settings\": [\"spp\"], \"coherence\""), "\"absent\" stands where");
    refuses(R"({"name": "glow", "about": "", "kind": "light"})", "#/about");
    refuses(R"({"name": "dim", "about": "It dims.", "kind": "light", "glsl": {"light": "dim.glsl"},
                "calledFor": {"by": "lit", "because": "is lit"}})",
            "one effect of the kind light");
}

// A parameter of a layer with these members, and conditions on it.
std::string layerWith(const std::string& parameter, const std::string& rest = "") {
    return R"({"name": "wet", "extension": "EXT_wet", "stage": "layer", "parameters": [{"name": "rim", )" +
           parameter + "}]" + rest + "}";
}

TEST(Declarations, TypesHaveValuesOfTheirOwn) {
    struct Case {
        const char* parameter;
        const char* refusal;
    };
    for (const Case& one : {
             Case{R"("type": "int", "default": 0.5)", "/default: is 0.5; it must be a whole number"},
             {R"("type": "int", "default": 3000000000)", "/default: is outside of the range"},
             {R"("type": "uint", "default": -1)", "/default: is outside of the range"},
             {R"("type": "int", "default": 5, "range": [0, 4])", "/default: is outside of the range"},
             {R"("type": "int", "default": 1, "range": [0.5, 4])", "/range: 0.5 is no value of int"},
             {R"("type": "int", "default": true)", "/default: must be a whole number"},
             {R"("type": "bool", "default": 1)", "/default: must be true or false"},
             {R"("type": "bool", "default": true, "range": [0, 1])", "/range: is for numbers"},
             {R"("type": "float", "default": "soft")", "/default: must be a number, or \"infinity\""},
             {R"("type": "enum", "default": "soft")", "parameters/0: an enum has names"},
             {R"("type": "enum", "values": ["soft", "hard"], "default": "hart")",
              "/default: \"hart\" is none of soft, hard; did you mean hard?"},
             {R"("type": "enum", "values": ["soft", "hard"], "default": 1)",
              "/default: must be one of the names soft, hard"},
             {R"("type": "enum", "values": ["soft", "soft"], "default": "soft")",
              "/values/1: \"rimSoft\" is declared twice"},
             {R"("type": "enum", "values": ["Soft"], "default": "Soft")",
              "/values/0: \"Soft\" must be letters"},
             {R"("type": "float", "values": ["soft"], "default": 1)", "/values: lists names"},
             {R"("type": "mat3", "default": [1, 0, 0])", "/default: must be an array of 9 numbers"},
             {R"("type": "float", "count": 0, "default": 1)", "/count: must be a whole number from 1 to 256"},
             {R"("type": "float", "count": 2.5, "default": 1)", "/count: must be a whole number"},
             {R"("type": "color", "count": 2, "default": [[0, 0, 0]])",
              "/default: has 1 values; it must be an array of 2"},
             {R"("type": "color", "count": 2, "default": [[0, 0, 0], [0, "a", 0]])",
              "/default/1/1: must be a number"},
             {R"("type": "color", "count": 2, "range": [0, 1], "default": [[0, 0, 0], [0, 2, 0]])",
              "/default/1/1: is outside of the range"},
             {R"("type": "int", "count": 2, "default": 0.5)", "/default: is 0.5; it must be a whole number"},
             {R"("type": "int", "unit": "radians", "default": 0)", "/unit: angles are"},
             {R"("type": "address", "default": 0)", "/default: is for values, and a program gives addresses"},
             {R"("type": "address", "range": [0, 1])", "/range: is for numbers"},
             {R"("type": "address", "unit": "radians")", "/unit: angles are"},
             {R"("type": "int")", "has no \"default\""},
         }) {
        const std::string refused = refusal(layerWith(one.parameter));
        EXPECT_NE(refused.find(one.refusal), std::string::npos) << one.parameter << ": " << refused;
    }
    const auto numbersOf = [](const std::string& parameter) {
        const materials::MaterialModel model = must(modelWith(layerWith(parameter)));
        return model.parameters[static_cast<std::size_t>(model.findParameter("rim"))].fallback;
    };
    using Numbers = std::vector<double>;
    EXPECT_EQ(numbersOf(R"("type": "uint", "default": 4294967295)"), Numbers{4294967295.0});
    EXPECT_EQ(numbersOf(R"("type": "int", "default": -2147483648)"), Numbers{-2147483648.0});
    EXPECT_EQ(numbersOf(R"("type": "enum", "values": ["soft", "hard"], "default": "hard")"), Numbers{1.0});
    EXPECT_EQ(numbersOf(R"("type": "bool", "count": 2, "default": [false, true])"), (Numbers{0.0, 1.0}));
    EXPECT_EQ(numbersOf(R"("type": "address")"), (Numbers{0.0, 0.0}));
    EXPECT_EQ(numbersOf(R"("type": "vec2", "count": 2, "default": [3, 4])"), (Numbers{3.0, 4.0, 3.0, 4.0}));
}

TEST(Declarations, ConditionsKnowWholeNumbersAndNames) {
    const std::string edge = R"("type": "enum", "values": ["soft", "hard"], "default": "soft")";
    const std::string flag = R"("type": "bool", "default": true)";
    const std::string step = R"("type": "int", "default": 3)";
    const auto neutral = [](const std::string& when) {
        return R"(, "neutral": [{"when": ")" + when + R"(", "because": "it is so"}])";
    };
    const auto drops = [&](const std::string& parameter, const std::string& when) {
        const materials::MaterialModel model = must(modelWith(layerWith(parameter, neutral(when))));
        materials::Material material(model);
        material.give("EXT_wet");
        return (compiler::makeKey(material, {}, {}) & model.mask("wet")) == 0;
    };
    EXPECT_TRUE(drops(edge, "rim == soft"));
    EXPECT_FALSE(drops(edge, "rim == hard"));
    EXPECT_TRUE(drops(edge, "rim != hard and not (rim == hard)"));
    EXPECT_TRUE(drops(flag, "rim"));
    EXPECT_TRUE(drops(flag, "(rim) and rim == true"));
    EXPECT_FALSE(drops(flag, "not rim or rim != true"));
    EXPECT_TRUE(drops(flag, "select(rim, 1, 2) < 2"));
    EXPECT_TRUE(drops(step, "rim - 1 == 2 and rim > 2.5"));
    const auto refusedBy = [&](const std::string& parameter, const std::string& when) {
        return refusal(layerWith(parameter, neutral(when)));
    };
    for (const std::string when : {"rim", "rim == 1", "rim < hard", "rim + 1 == 2", "rim.r == soft"}) {
        EXPECT_NE(refusedBy(edge, when).find("#/neutral/0/when: "), std::string::npos) << when;
    }
    EXPECT_NE(refusedBy(edge, "rim == hart").find("\"hart\" is none of soft, hard"), std::string::npos);
    EXPECT_NE(refusedBy(edge, "rim > 0").find("is compared by == or != with one of soft, hard"),
              std::string::npos);
    EXPECT_NE(refusedBy(flag, "rim + 1 == 2").find("with one of false, true"), std::string::npos);
    EXPECT_NE(refusedBy(R"("type": "mat3", "default": [1, 0, 0, 0, 1, 0, 0, 0, 1])", "rim == 0")
                  .find("\"rim\" is a matrix, which conditions can't name"),
              std::string::npos);
    EXPECT_NE(refusedBy(R"("type": "float", "count": 2, "default": 0)", "rim == 0")
                  .find("\"rim\" is an array, which conditions can't name"),
              std::string::npos);
    EXPECT_NE(refusedBy(R"("type": "address")", "rim == 0").find("\"rim\" is an address, which conditions"),
              std::string::npos);
    EXPECT_NE(refusal(layerWith(step, R"(, "textures": [{"name": "wetTexture", "scales": ["rim"]}])"))
                  .find("#/textures/0/scales: \"rim\" has the type int"),
              std::string::npos);
    for (const std::string member : {R"("derived": [{"name": "damp", "type": "int", "value": "rim"}])",
                                     R"("attributes": [{"name": "damp", "at": "_DAMP", "type": "int"}])"}) {
        EXPECT_NE(
            refusal(layerWith(step, ", " + member)).find("/0/type: must be a number or a vector of floats"),
            std::string::npos)
            << member;
    }
    // Whole numbers take part in derived fields.
    EXPECT_TRUE(
        modelWith(layerWith(step, R"(, "derived": [{"name": "damp", "type": "float", "value": "rim / 2"}])"))
            .ok());
}

TEST(Declarations, TexturesHaveADimension) {
    const auto textures = [](const std::string& members, const std::string& when = "MASK") {
        return R"({"name": "wet", "extension": "EXT_wet", "stage": "layer",
                   "neutral": [{"when": ")" +
               when + R"(", "because": "it is so"}], "textures": [{"name": "rim", )" + members + "}]}";
    };
    for (const auto& [members, expected] :
         {std::pair(R"("dimension": "Cube")",
                    "/textures/0/dimension: there is no \"Cube\"; did you mean cube?"),
          {R"("dimension": "cube", "reads": "rg")", "/textures/0/reads: is for 2D textures"},
          {R"("dimension": "3d", "roughness": "g")", "/textures/0/roughness: is for 2D textures"},
          {R"("dimension": "cube", "coordinates": "own")",
           "/textures/0/coordinates: a texture with the dim"}}) {
        EXPECT_NE(refusal(textures(members)).find(expected), std::string::npos) << refusal(textures(members));
    }
    // Only those that have UVs need any, and nobody knows what they hold: floats may be beyond [0, 1].
    const auto key = [&](const std::string& members) {
        const materials::MaterialModel model = must(modelWith(textures(members, "texel(rim).r <= 1")));
        materials::Material material(model);
        material.give("EXT_wet");
        material.texture("rim").texture = 0;
        return model.names(
            compiler::makeKey(material, {.hasTexCoords0 = members.find("d-a") == std::string::npos}, {}));
    };
    const auto has = [&](const std::string& members, std::string_view feature) {
        const auto names = key(members);
        return std::ranges::find(names, feature) != names.end();
    };
    EXPECT_FALSE(has(R"("dimension": "2d")", "wet"));
    EXPECT_TRUE(has(R"("dimension": "cube")", "wet"));
    EXPECT_TRUE(has(R"("dimension": "3d")", "rim"));
    EXPECT_FALSE(has(R"("dimension": "2d-array")", "rim"));
    EXPECT_TRUE(has(R"("dimension": "2d-array", "coordinates": "own")", "rim"));
}

// Models of packs have names of their own, which hide those that all models share.
TEST(Declarations, NamesAreUniqueInTheirModel) {
    const auto read = [](const std::vector<std::string>& texts) {
        std::vector<std::string> names;
        std::vector<materials::DeclarationFile> files;
        for (const base::BuiltinFile& file : materials::declarationFiles()) {
            files.push_back({file.name, file.text});
        }
        names.reserve(texts.size());
        for (const std::string& text : texts) {
            files.push_back(
                {names.emplace_back("pack/" + std::to_string(names.size()) + ".json"), text, true});
        }
        return materials::readDeclarations(files);
    };
    const auto modelOf = [](const std::string& name, const std::string& more = "") {
        return R"({"name": ")" + name + R"(", "extension": "EXT_)" + name + R"(", "stage": "base",
            "replaces": {"object": "pbrMetallicRoughness"},
            "parameters": [{"name": "color", "is": "baseColorFactor", "default": [1, 1, 1, 1]},
                           {"name": "roughnessFactor", "type": "float", "default": 0.25},
                           {"name": "texture", "type": "float", "default": 0},
                           {"name": "precision", "type": "enum", "values": ["low", "high"], "default": "low"}],
            "textures": [{"name": "frame"}, {"name": "specularTexture", "scales": ["roughnessFactor.r"]}],
            "features": [{"name": "paths", "gltf": "paths", "neutral": [
                {"when": "roughnessFactor == 0.25 or has(frame) or precision == low", "because": "it is plain"}]}])" +
               more + "}";
    };
    const Result<materials::MaterialModel> both = read({modelOf("opal"), modelOf("jade")});
    ASSERT_TRUE(both.ok()) << toString(both.error());
    const std::string defines = both->featureDefines();
    for (const char* const macro :
         {"GLINT_HAS_OPAL_FRAME", "GLINT_HAS_JADE_FRAME", "GLINT_KEY_HAS_OPAL_PATHS",
          "GLINT_HAS_JADE_SPECULAR_TEXTURE", "GLINT_HAS_SPECULAR_TEXTURE"}) {
        EXPECT_NE(defines.find(fmt::format("#define {}(", macro)), std::string::npos) << macro;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const auto model = static_cast<int>(i);
        const std::string name = both->models[i].name;
        const auto own = static_cast<std::size_t>(both->findParameter("roughnessFactor", model));
        EXPECT_EQ(both->parameters[own].name, name + "RoughnessFactor");
        EXPECT_EQ(both->parameters[own].declared, "roughnessFactor");
        EXPECT_EQ(both->parameters[own].place, "roughnessFactor");
        EXPECT_EQ(both->parameters[own].scaledBy, both->findTexture(name + "SpecularTexture"));
        materials::Material material(*both);
        material.give("EXT_" + name);
        EXPECT_EQ(material["roughnessFactor"][0], 0.25);
        EXPECT_EQ(both->findParameter("metallicFactor", model), both->findParameter("metallicFactor"));
    }
    EXPECT_EQ(materials::Material(*both)["roughnessFactor"][0], 1.0);
    // Full names meet only where two begin alike.
    const auto refused = [&](const std::vector<std::string>& texts) {
        const Result<materials::MaterialModel> model = read(texts);
        return model ? std::string("accepted") : toString(model.error());
    };
    EXPECT_NE(refused({modelOf("opal"), modelOf("opalFrame", R"(, "derived": [])"),
                       R"({"name": "opalFrame", "stage": "surface"})"})
                  .find("\"opalFrame\" is declared twice"),
              std::string::npos);
    EXPECT_NE(
        refused({modelOf("opal", R"(, "derived": [{"name": "opalColor", "type": "float", "value": "1"}])")})
            .find("\"opalColor\" is declared twice"),
        std::string::npos);
    for (const std::string name : {"own", "textures"}) {
        EXPECT_NE(refused({R"({"name": "wet", "stage": "surface", "parameters": [
                             {"name": ")" +
                           name + R"(", "type": "float", "default": 0}]})"})
                      .find("is a member that all records have"),
                  std::string::npos);
    }
}

// Damaged declarations are refused, or read; they never crash.
TEST(Declarations, DamagedFilesAreRefusedOrRead) {
    for (const base::BuiltinFile& file : materials::declarationFiles()) {
        const std::string text(file.text);
        for (std::size_t place = 0; place < text.size(); place += 7) {
            for (const char other : {'"', '0', '{', ' '}) {
                std::string damaged = text;
                damaged[place] = other;
                const materials::DeclarationFile alone{"materials/x/x.json", damaged};
                const Result<materials::MaterialModel> model = materials::readDeclarations({&alone, 1});
                if (!model) {
                    ASSERT_EQ(model.error().id, "declaration") << damaged;
                }
            }
        }
    }
}

}  // namespace
