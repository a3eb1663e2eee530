// Attributes of vertices that packs declare.
#include "materials/declarations.h"
#include "plan/plan.h"
#include "support/must.h"
#include "unit/gltf/only_primitive.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace glint::test {
namespace {

const materials::MaterialModel& modelWithWear() {
    static const TemporaryFolder folder;
    static const Result<const materials::MaterialModel*> model = [&] {
        const std::string text = R"json({
            "name": "wear", "stage": "surface", "extension": "TEST_wear", "glsl": { "surface": "wear.glsl" },
            "attributes": [{ "name": "wearShare", "at": "_WEAR", "type": "vec2" },
                           { "name": "wearAge", "at": "_AGE", "type": "float", "default": 3 }],
            "neutral": [{ "when": "not attribute(wearAge)", "because": "nothing is old" }]
        })json";
        EXPECT_TRUE(base::writeFile(folder.path() / "wear.json", text));
        EXPECT_TRUE(base::writeFile(folder.path() / "wear.glsl", std::string("// wear\n")));
        return materials::loadMaterialModel(std::vector{folder.path().string()});
    }();
    EXPECT_TRUE(model) << toString(model.error());
    return **model;
}

gltf::ImportOptions withWear() {
    gltf::ImportOptions options;
    options.materialModel = &modelWithWear();
    return options;
}

std::vector<float> valuesOf(const gltf::Primitive& primitive, const std::string& name) {
    for (const gltf::VertexValues& attribute : primitive.attributes) {
        if (attribute.name == name) {
            return attribute.values;
        }
    }
    return {};
}

TEST(DeclaredAttributes, AreReadAsTheFileHasThem) {
    GltfBuilder floats;
    floats.addTriangle()["attributes"]["_WEAR"] = floats.addAccessor<float>({1, -2, 0.5F, 7, 0, 1e6F}, 2);
    const Result<gltf::Scene> asFloats = import(floats, withWear());
    EXPECT_EQ(valuesOf(onlyPrimitive(asFloats), "_WEAR"), (std::vector<float>{1, -2, 0.5F, 7, 0, 1e6F}));

    GltfBuilder shorts;
    constexpr std::uint16_t kMost = std::numeric_limits<std::uint16_t>::max();
    Json& triangle = shorts.addTriangle();
    triangle["attributes"]["_WEAR"] = shorts.addAccessor<std::uint16_t>({kMost, 0, 0, kMost, 0, 0}, 2, true);
    const Result<gltf::Scene> asShares = import(shorts, withWear());
    EXPECT_EQ(valuesOf(onlyPrimitive(asShares), "_WEAR"), (std::vector<float>{1, 0, 0, 1, 0, 0}));

    // Without the pack nobody reads them.
    const Result<gltf::Scene> without = import(floats);
    EXPECT_TRUE(onlyPrimitive(without).attributes.empty());
}

TEST(DeclaredAttributes, MustFitTheDeclaration) {
    GltfBuilder type;
    type.addTriangle()["attributes"]["_WEAR"] = type.addAccessor<float>(std::vector<float>(9), 3);
    const Diagnostic wrongType = mustFail(import(type, withWear()));
    EXPECT_EQ(wrongType.id, "attribute-type");
    EXPECT_TRUE(wrongType.where.ends_with("#/meshes/0/primitives/0/attributes/_WEAR"));
    GltfBuilder count;
    count.addTriangle()["attributes"]["_WEAR"] = count.addAccessor<float>({1, 2}, 2);
    EXPECT_EQ(mustFail(import(count, withWear())).id, "attribute-count");
}

TEST(DeclaredAttributes, ThatAreNotFiniteAreReplaced) {
    GltfBuilder builder;
    constexpr float kNotFinite = std::numeric_limits<float>::infinity();
    builder.addTriangle()["attributes"]["_WEAR"] = builder.addAccessor<float>({1, kNotFinite, 2, 3, 4, 5}, 2);
    const Result<gltf::Scene> scene = import(builder, withWear());
    EXPECT_EQ(valuesOf(onlyPrimitive(scene), "_WEAR"), (std::vector<float>{1, 0, 2, 3, 4, 5}));
    ASSERT_EQ(scene->warnings.size(), 1U);
    EXPECT_EQ(scene->warnings[0].id, "attribute-not-finite");
}

// An attribute without a default is a condition of its feature; one with a default is a fact alone.
TEST(DeclaredAttributes, DecideAboutKeys) {
    GltfBuilder builder;
    Json& triangle = builder.addTriangle();
    triangle["attributes"]["_WEAR"] = builder.addAccessor<float>(std::vector<float>(6), 2);
    builder.root["materials"] = {{{"extensions", {{"TEST_wear", Json::object()}}}}};
    builder.root["extensionsUsed"] = {"TEST_wear"};
    triangle["material"] = 0;
    const gltf::Scene scene = must(import(builder, withWear()));
    const materials::FeatureMask wear = modelWithWear().mask("wear");
    const auto key = [&](std::uint64_t attributes,
                         std::vector<std::pair<std::string, std::string>>* dropped) {
        materials::PrimitiveInputs inputs = planningInputs(scene).front();
        EXPECT_EQ(inputs.attributes, 1U);
        inputs.attributes = attributes;
        return compiler::makeKey(scene.materials[0], inputs, {}, dropped) & wear;
    };
    EXPECT_NE(key(3, nullptr), 0U);
    std::vector<std::pair<std::string, std::string>> dropped;
    EXPECT_EQ(key(1, &dropped), 0U);
    EXPECT_EQ(key(2, &dropped), 0U);
    ASSERT_EQ(dropped.size(), 2U);
    EXPECT_EQ(dropped[0], (std::pair<std::string, std::string>("wear", "nothing is old")));
    EXPECT_EQ(dropped[1], (std::pair<std::string, std::string>("wear", "the primitive has no _WEAR")));
}

}  // namespace
}  // namespace glint::test
