// Tests KHR_materials_variants.
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <string>

namespace glint::test {
namespace {

// Returns three triangles. The first has material 0, and another one in both variants. The second has
// material 0, and another one only in Night. The third has no material.
GltfBuilder withVariants() {
    GltfBuilder builder;
    for (const char* name : {"plain", "red", "blue"}) {
        builder.append("materials", {{"name", name}});
    }
    builder.root["extensions"]["KHR_materials_variants"]["variants"] =
        Json::parse(R"([{"name": "Day"}, {"name": "Night"}])");
    const auto addTriangle = [&](int material, const char* mappings) {
        Json& primitive = builder.addTriangle();
        if (material >= 0) {
            primitive["material"] = material;
        }
        primitive["extensions"]["KHR_materials_variants"]["mappings"] = Json::parse(mappings);
    };
    addTriangle(0, R"([{"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}])");
    addTriangle(0, R"([{"material": 2, "variants": [1]}])");
    addTriangle(-1, R"([{"material": 1, "variants": [1, 0]}])");
    return builder;
}

gltf::ImportOptions with(const std::string& variant) {
    gltf::ImportOptions options;
    options.variant = variant;
    return options;
}

std::vector<int> materialsOf(const gltf::Scene& scene) {
    std::vector<int> materials;
    for (const materials::PrimitiveInputs& inputs : planningInputs(scene)) {
        materials.push_back(inputs.material);
    }
    return materials;
}

TEST(GltfVariants, DecideTheMaterialsOfPrimitives) {
    const gltf::Scene day = must(import(withVariants(), with("Day")));
    EXPECT_EQ(materialsOf(day), (std::vector<int>{1, 0, 1}));
    EXPECT_EQ(day.variant, "Day");
    // A primitive without a material has that of glTF's default when no variant is chosen, which an edit may
    // do.
    EXPECT_EQ(day.defaultMaterial, 3);
    const gltf::Scene night = must(import(withVariants(), with("Night")));
    EXPECT_EQ(materialsOf(night), (std::vector<int>{2, 2, 1}));
}

TEST(GltfVariants, WithoutOneTheDefaultsHold) {
    const gltf::Scene scene = must(import(withVariants()));
    EXPECT_EQ(materialsOf(scene), (std::vector<int>{0, 0, 3}));
    EXPECT_EQ(scene.defaultMaterial, 3);
    EXPECT_EQ(scene.variants, (std::vector<std::string>{"Day", "Night"}));
    EXPECT_TRUE(scene.variant.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfVariants, AnUnknownNameListsThoseOfTheFile) {
    const Diagnostic scene = mustFail(import(withVariants(), with("Nihgt")));
    EXPECT_EQ(scene.id, "variant-unknown");
    EXPECT_NE(scene.message.find("did you mean Night?"), std::string::npos);
    EXPECT_NE(scene.hint.find("Day, Night"), std::string::npos);
    EXPECT_TRUE(scene.where.ends_with("#/extensions/KHR_materials_variants/variants"));
    GltfBuilder without;
    without.addTriangle();
    const Diagnostic none = mustFail(import(without, with("Day")));
    EXPECT_EQ(none.id, "variant-unknown");
    EXPECT_NE(none.message.find("KHR_materials_variants"), std::string::npos);
}

TEST(GltfVariants, AreChecked) {
    const auto idAfter = [](const auto& change) {
        GltfBuilder builder = withVariants();
        change(builder.root,
               builder.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]);
        const Result<gltf::Scene> scene = import(builder, with("Day"));
        return scene ? std::string("imported") : scene.error().id;
    };
    EXPECT_EQ(idAfter([](Json&, Json& mappings) { mappings["mappings"][0]["material"] = 3; }), "index-range");
    EXPECT_EQ(idAfter([](Json&, Json& mappings) { mappings["mappings"][0]["variants"] = {2}; }),
              "index-range");
    EXPECT_EQ(idAfter([](Json&, Json& mappings) { mappings["mappings"][0].erase("material"); }),
              "json-missing");
    EXPECT_EQ(idAfter([](Json&, Json& mappings) { mappings["mappings"] = 1; }), "json-type");
    EXPECT_EQ(idAfter([](Json& root, Json&) {
                  root["extensions"]["KHR_materials_variants"]["variants"][1].erase("name");
              }),
              "json-missing");
    EXPECT_EQ(idAfter([](Json& root, Json&) { root["extensions"].erase("KHR_materials_variants"); }),
              "index-range");
}

}  // namespace
}  // namespace glint::test
