// Packs: material features of a user's own.
#include "base/files.h"
#include "emit/material_layout.h"
#include "materials/declarations.h"
#include "materials/material.h"
#include "plan/plan.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
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

TEST_F(MaterialPacks, AModelIsTheSameUntilAFileHasAnotherText) {
    write("mud/mud.json", kMud);
    write("mud/mud.glsl", "// mud\n");
    const materials::MaterialModel* const first = must(load());
    fs::last_write_time(folder_.path() / "mud/mud.json", fs::file_time_type::clock::now());
    EXPECT_EQ(must(load()), first);
    ASSERT_EQ(first->files.size(), 2U);
    EXPECT_EQ(first->files[1].hash, base::hashBytes(kMud));

    write("mud/mud.glsl", "// other\n");
    const materials::MaterialModel* const other = must(load());
    EXPECT_EQ(first->sources.front().text, "// mud\n");
    EXPECT_EQ(other->sources.front().text, "// other\n");
    EXPECT_EQ(other->files[0].hash, base::hashBytes(std::string_view("// other\n")));

    // An error and its mend, and a declaration that comes and goes.
    write("mud/mud.json", "{");
    EXPECT_EQ(mustFail(load()).id, "declaration");
    std::string declaration(kMud);
    declaration.replace(declaration.find("\"default\": 0"), 12, "\"default\": 1");
    write("mud/mud.json", declaration);
    const materials::MaterialModel* const mended = must(load());
    const auto fallback = [](const materials::MaterialModel& model) {
        return model.parameters[static_cast<std::size_t>(model.findParameter("mudAmount"))].fallback;
    };
    EXPECT_EQ(fallback(*mended), std::vector<double>{1.0});
    EXPECT_EQ(fallback(*other), std::vector<double>{0.0});
    std::string dust(kMud);
    for (std::size_t place = dust.find("mud"); place != std::string::npos; place = dust.find("mud", place)) {
        dust.replace(place, 3, "dust");
    }
    write("dust/dust.json", dust);
    write("dust/dust.glsl", "// dust\n");
    EXPECT_GE(must(load())->findFeature("dust"), 0);
    fs::remove_all(folder_.path() / "dust");
    EXPECT_EQ(must(load())->findFeature("dust"), -1);
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
    EXPECT_EQ(wet.type->channels, 3);
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
    EXPECT_EQ(model->words(model->mask("zincAlloy")).own.words[0], 1U);
}

// Declares a model with so many features beside its base.
std::string zincWith(int features) {
    std::string text = R"({"name": "zinc", "extension": "EXT_zinc", "stage": "base",
        "replaces": {"object": "pbrMetallicRoughness"}, "features": [)";
    for (int i = 0; i < features; ++i) {
        text += fmt::format(R"json({}{{"name": "alloy{:03}", "gltf": "alloy", "given": "has(zinc)",
            "neutral": [{{"when": "not has(zinc)", "because": "there is no zinc"}}]}})json",
                            i == 0 ? "" : ", ", i);
    }
    return text + "]}";
}

TEST_F(MaterialPacks, AModelHas128FeaturesOfItsOwn) {
    write("zinc.json", zincWith(128));
    const materials::MaterialModel* model = must(load());
    EXPECT_EQ(model->ownWordCount(model->mask("zinc")), 4);
    EXPECT_EQ(model->ownWordCount(0), 1);
    materials::Material material(*model);
    material.give("EXT_zinc");
    const materials::FeatureMask key = compiler::makeKey(material, {}, {});
    EXPECT_EQ((key & ~materials::FeatureMask(~std::uint64_t{0})).count(), 129);
    EXPECT_EQ(model->words(key).own, package::KeyWords::Own::all());
    EXPECT_EQ(model->maskOf(model->words(key)), key);
    const package::KeyWords last = model->words(model->mask("zincAlloy127"));
    EXPECT_EQ(last.own.words, (std::array<std::uint32_t, 4>{0, 0, 0, 1U << 31}));
    EXPECT_EQ(model->maskOf(last), model->mask("zinc") | model->mask("zincAlloy127"));
    EXPECT_NE(model->featureDefines().find(
                  "GLINT_HAS_ZINC_ALLOY_127(features) hasOwn(features, 1u, 3, 0x80000000u)"),
              std::string::npos);
    write("zinc.json", zincWith(129));
    expectError("declaration", "zinc.json#/features/128", "zinc has more than 128 features of its own");
}

TEST(KeyWords, UnionsOfSeveralModelsKnowNothingAboutTheFeaturesOfEach) {
    package::KeyWords set{1, 2};
    package::KeyWords zinc{4, 0, 7};
    zinc.own.add(100);
    set |= zinc;
    EXPECT_EQ(set.lobes, 5U);
    EXPECT_EQ(set.inputs, 2U);
    EXPECT_EQ(set.model, 7U);
    EXPECT_EQ(set.own, zinc.own);
    set |= package::KeyWords{8};
    EXPECT_EQ(set.model, 7U);
    set |= package::KeyWords{0, 0, 6};
    EXPECT_EQ(set.model, package::KeyWords::kAnyModel);
    EXPECT_EQ(set.own, package::KeyWords::Own::all());
    EXPECT_TRUE(set.hasAny(zinc));
    EXPECT_FALSE((package::KeyWords{0, 0, 6}).hasAny({0, 0, 7}));
}

constexpr std::string_view kZinc = R"json({"name": "zinc", "extension": "EXT_zinc", "stage": "base",
    "replaces": {"object": "pbrMetallicRoughness"},
    "parameters": [{"name": "zincBloom", "type": "color", "default": [1, 1, 1]},
                   {"name": "zincGrain", "type": "float", "default": 2}],
    "textures": [{"name": "zincTexture"}]})json";
constexpr std::string_view kTin = R"json({"name": "tin", "extension": "EXT_tin", "stage": "base",
    "replaces": {"object": "pbrMetallicRoughness"},
    "parameters": [{"name": "tinColor", "is": "baseColorFactor", "default": [1, 1, 1, 1]},
                   {"name": "tinPest", "type": "float", "default": 5}]})json";

// The layout of a package of materials that each have a primitive.
compiler::MaterialLayout layoutOf(const std::vector<materials::Material>& list,
                                  const compiler::PlanOptions& options = {}) {
    std::vector<materials::PrimitiveInputs> primitives(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        primitives[i].material = static_cast<int>(i);
    }
    return compiler::materialLayoutOf(compiler::makePlan(list, primitives, options));
}

float valueAt(const materials::Material& material, const compiler::MaterialLayout& layout,
              std::string_view field) {
    const auto found = std::ranges::find(layout.fields, field, &compiler::RecordField::name);
    const std::vector<std::uint8_t> record = compiler::makeMaterialRecord(material, layout);
    float value = 0.0F;
    std::memcpy(&value, &record.at(found->offset), sizeof value);
    return value;
}

TEST_F(MaterialPacks, RecordsHaveTheFieldsOfTheirModelAlone) {
    write("zinc.json", kZinc);
    write("tin.json", kTin);
    const materials::MaterialModel* model = must(load());
    const materials::Material gltf(*model);
    materials::Material zinc(*model);
    zinc.give("EXT_zinc");
    materials::Material tin(*model);
    tin.give("EXT_tin");
    EXPECT_EQ(layoutOf({gltf}).bytes, 40U);
    EXPECT_EQ(layoutOf({zinc}).bytes, 16U);  // a colour and a number of its own
    EXPECT_EQ(layoutOf({tin}).bytes, 20U);   // the base colour, which it fills, and a number
    EXPECT_EQ(layoutOf({zinc, tin}).bytes, 20U);
    const compiler::MaterialLayout mixed = layoutOf({gltf, zinc, tin});
    EXPECT_EQ(mixed.bytes, 40U);
    EXPECT_EQ(valueAt(gltf, mixed, "roughnessFactor"), 1.0F);
    EXPECT_EQ(valueAt(zinc, mixed, "zincGrain"), 2.0F);
    EXPECT_EQ(valueAt(tin, mixed, "tinPest"), 5.0F);
    EXPECT_EQ(valueAt(tin, mixed, "baseColorFactor"), 1.0F);
    EXPECT_EQ(compiler::makeMaterialRecord(zinc, mixed).size(), 40U);
    // Masks and emission take room where a material has them.
    materials::Material masked = zinc;
    masked.alphaMode = materials::AlphaMode::Mask;
    EXPECT_EQ(layoutOf({masked}).bytes, 20U);
    materials::Material lamp = zinc;
    lamp["emissiveFactor"] = 0.5F;
    const compiler::MaterialLayout lit = layoutOf({lamp, tin});
    EXPECT_EQ(lit.bytes, 28U);
    EXPECT_EQ(valueAt(lamp, lit, "emissiveFactor"), 0.5F);
    // A layer takes room in the records of the model whose materials have it.
    materials::Material coated = tin;
    coated["clearcoatFactor"] = 1.0F;
    EXPECT_EQ(layoutOf({coated}).bytes, 28U);
    EXPECT_EQ(layoutOf({coated, zinc}).bytes, 28U);
    EXPECT_EQ(layoutOf({coated, gltf}).bytes, 40U);
    // With a fallback an edit may give it to any of them.
    compiler::PlanOptions options;
    options.fallback = true;
    EXPECT_EQ(layoutOf({coated, gltf}, options).bytes, 48U);
}

TEST_F(MaterialPacks, CodeOfAModelReadsWhatItsRecordsHave) {
    std::string text(kTin);
    text.insert(text.find("\"parameters\""), R"("glsl": {"surface": "tin.glsl"}, )");
    write("tin.json", text);
    write("tin.glsl", "vec4 tin(Hit hit) {\n    return GLINT_MATERIAL_BASE_COLOR_FACTOR(hit);\n}\n");
    must(load());
    write("tin.glsl", "float tin(Hit hit) {\n    return GLINT_MATERIAL_METALLIC_FACTOR(hit);\n}\n");
    expectError("materials-glsl", "tin.glsl:2", "reads metallicFactor, which the records of tin do not have");
}

// The keys of such a material are of glTF's base without the amount, so its records have the fields of both.
TEST_F(MaterialPacks, RecordsHaveRoomForABaseThatIsLeftOut) {
    std::string text(kZinc);
    text.insert(text.find("\"parameters\""),
                R"("neutral": [{"when": "zincGrain == 0", "because": "none"}], )");
    write("zinc.json", text);
    const materials::MaterialModel* model = must(load());
    materials::Material zinc(*model);
    zinc.give("EXT_zinc");
    EXPECT_EQ(layoutOf({zinc}).bytes, 56U);
}

// Textures of different models lie in the same slots.
TEST_F(MaterialPacks, TexturesOfModelsShareSlots) {
    write("zinc.json", kZinc);
    const materials::MaterialModel* model = must(load());
    const compiler::RecordUse uses[] = {{{-1}, model->mask("occlusionTexture"), false},
                                        {{0}, model->mask("zincTexture"), false}};
    const compiler::MaterialLayout layout = compiler::makeMaterialLayout(*model, uses);
    EXPECT_EQ(layout.textureCount, 1U);
    EXPECT_EQ(layout.slotOf(model->findTexture("zincTexture"), 0), 0);
    EXPECT_EQ(layout.slotOf(model->findTexture("occlusionTexture"), -1), 0);
    EXPECT_EQ(layout.slotOf(model->findTexture("occlusionTexture"), 0), -1);
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
