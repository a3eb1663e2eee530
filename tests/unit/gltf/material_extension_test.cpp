// Tests KHR_materials_*: factors with their ranges, textures slot by slot, and which extension takes
// precedence.
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace glint::test {
namespace {

// Returns a file with one material, and two textures of one image for it.
GltfBuilder withMaterial(Json material) {
    GltfBuilder builder;
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.append("textures", {{"source", 0}});
    builder.append("textures", {{"source", 0}});
    builder.append("materials", std::move(material));
    return builder;
}

gltf::Scene importMaterial(const std::string& extensions) {
    return mustImport(withMaterial({{"extensions", Json::parse(extensions)}}));
}

const materials::Material& onlyMaterial(const gltf::Scene& scene) {
    return scene.materials.at(0);
}

TEST(GltfMaterialExtensions, HaveTheDefaultsOfTheirTexts) {
    const gltf::Scene scene = importMaterial(R"({"KHR_materials_clearcoat": {}, "KHR_materials_sheen": {},
        "KHR_materials_transmission": {}, "KHR_materials_volume": {}, "KHR_materials_ior": {},
        "KHR_materials_specular": {}, "KHR_materials_iridescence": {}, "KHR_materials_anisotropy": {},
        "KHR_materials_dispersion": {}, "KHR_materials_diffuse_transmission": {}})");
    const materials::Material& read = onlyMaterial(scene);
    EXPECT_TRUE(read.gives("KHR_materials_clearcoat") && read.gives("KHR_materials_sheen") &&
                read.gives("KHR_materials_transmission") && read.gives("KHR_materials_volume") &&
                read.gives("KHR_materials_ior") && read.gives("KHR_materials_specular") &&
                read.gives("KHR_materials_iridescence") && read.gives("KHR_materials_anisotropy") &&
                read.gives("KHR_materials_dispersion") && read.gives("KHR_materials_diffuse_transmission"));
    EXPECT_FALSE(read.gives("KHR_materials_pbrSpecularGlossiness"));
    EXPECT_EQ(read["clearcoatFactor"], 0.0F);
    EXPECT_EQ(read["clearcoatRoughnessFactor"], 0.0F);
    EXPECT_EQ(read["clearcoatNormalScale"], 1.0F);
    EXPECT_EQ(read["sheenColorFactor"], (std::array{0.0F, 0.0F, 0.0F}));
    EXPECT_EQ(read["sheenRoughnessFactor"], 0.0F);
    EXPECT_EQ(read["transmissionFactor"], 0.0F);
    EXPECT_EQ(read["thicknessFactor"], 0.0F);
    EXPECT_EQ(read["attenuationDistance"], std::numeric_limits<float>::infinity());  // infinite
    EXPECT_EQ(read["attenuationColor"], (std::array{1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(read["ior"], 1.5F);
    EXPECT_EQ(read["specularFactor"], 1.0F);
    EXPECT_EQ(read["specularColorFactor"], (std::array{1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(read["iridescenceFactor"], 0.0F);
    EXPECT_EQ(read["iridescenceIor"], 1.3F);
    EXPECT_EQ(read["iridescenceThicknessMinimum"], 100.0F);
    EXPECT_EQ(read["iridescenceThicknessMaximum"], 400.0F);
    EXPECT_EQ(read["anisotropyStrength"], 0.0F);
    EXPECT_EQ(read["anisotropyRotation"], 0.0F);
    EXPECT_EQ(read["dispersion"], 0.0F);
    EXPECT_EQ(read["diffuseTransmissionFactor"], 0.0F);
    EXPECT_EQ(read["diffuseTransmissionColorFactor"], (std::array{1.0F, 1.0F, 1.0F}));
    EXPECT_TRUE(read.unsupportedExtensions.empty());
    EXPECT_TRUE(readingWarnings(scene).empty());
}

TEST(GltfMaterialExtensions, AreReadToTheLastValue) {
    const gltf::Scene scene = importMaterial(R"({
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
            "clearcoatNormalTexture": {"index": 0, "scale": -2}},
        "KHR_materials_sheen": {"sheenColorFactor": [0.125, 0.25, 0.5], "sheenRoughnessFactor": 0.75},
        "KHR_materials_transmission": {"transmissionFactor": 0.875},
        "KHR_materials_volume": {"thicknessFactor": 2.5, "attenuationDistance": 0.25,
            "attenuationColor": [0.5, 0.25, 0]},
        "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [0.5, 1, 4]},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 2,
            "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 800},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": -1.5},
        "KHR_materials_dispersion": {"dispersion": 2},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.25,
            "diffuseTransmissionColorFactor": [1, 0.5, 0.25]}})");
    const materials::Material& read = onlyMaterial(scene);
    EXPECT_EQ(read["clearcoatFactor"], 0.5F);
    EXPECT_EQ(read["clearcoatRoughnessFactor"], 0.25F);
    EXPECT_EQ(read["clearcoatNormalScale"], -2.0F);
    EXPECT_EQ(read["sheenColorFactor"], (std::array{0.125F, 0.25F, 0.5F}));
    EXPECT_EQ(read["sheenRoughnessFactor"], 0.75F);
    EXPECT_EQ(read["transmissionFactor"], 0.875F);
    EXPECT_EQ(read["thicknessFactor"], 2.5F);
    EXPECT_EQ(read["attenuationDistance"], 0.25F);
    EXPECT_EQ(read["attenuationColor"], (std::array{0.5F, 0.25F, 0.0F}));
    EXPECT_EQ(read["ior"], 1.25F);
    EXPECT_EQ(read["specularFactor"], 0.5F);
    EXPECT_EQ(read["specularColorFactor"], (std::array{0.5F, 1.0F, 4.0F}));
    EXPECT_EQ(read["iridescenceFactor"], 0.5F);
    EXPECT_EQ(read["iridescenceIor"], 2.0F);
    EXPECT_EQ(read["iridescenceThicknessMinimum"], 50.0F);
    EXPECT_EQ(read["iridescenceThicknessMaximum"], 800.0F);
    EXPECT_EQ(read["anisotropyStrength"], 0.5F);
    EXPECT_EQ(read["anisotropyRotation"], -1.5F);
    EXPECT_EQ(read["dispersion"], 2.0F);
    EXPECT_EQ(read["diffuseTransmissionFactor"], 0.25F);
    EXPECT_EQ(read["diffuseTransmissionColorFactor"], (std::array{1.0F, 0.5F, 0.25F}));
    EXPECT_TRUE(readingWarnings(scene).empty());
}

// The place of each slot's texture: its owner (the extension, "pbrMetallicRoughness", or "") and the member.
struct SlotPlace {
    const char* owner;
    const char* member;
    const char* slot;
};
constexpr SlotPlace kPlaces[] = {
    {"pbrMetallicRoughness", "baseColorTexture", "baseColorTexture"},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", "metallicRoughnessTexture"},
    {"", "normalTexture", "normalTexture"},
    {"", "occlusionTexture", "occlusionTexture"},
    {"", "emissiveTexture", "emissiveTexture"},
    {"KHR_materials_clearcoat", "clearcoatTexture", "clearcoatTexture"},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture", "clearcoatRoughnessTexture"},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", "clearcoatNormalTexture"},
    {"KHR_materials_sheen", "sheenColorTexture", "sheenColorTexture"},
    {"KHR_materials_sheen", "sheenRoughnessTexture", "sheenRoughnessTexture"},
    {"KHR_materials_anisotropy", "anisotropyTexture", "anisotropyTexture"},
    {"KHR_materials_specular", "specularTexture", "specularTexture"},
    {"KHR_materials_specular", "specularColorTexture", "specularColorTexture"},
    {"KHR_materials_iridescence", "iridescenceTexture", "iridescenceTexture"},
    {"KHR_materials_iridescence", "iridescenceThicknessTexture", "iridescenceThicknessTexture"},
    {"KHR_materials_transmission", "transmissionTexture", "transmissionTexture"},
    {"KHR_materials_volume", "thicknessTexture", "thicknessTexture"},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture", "diffuseTransmissionTexture"},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture",
     "diffuseTransmissionColorTexture"},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseTexture", "baseColorTexture"},
    {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", "metallicRoughnessTexture"},
};

Json materialWith(const SlotPlace& place, const Json& textureInfo) {
    Json material = Json::object();
    const std::string owner = place.owner;
    Json& object = owner.empty()                     ? material
                   : owner == "pbrMetallicRoughness" ? material[owner]
                                                     : material["extensions"][owner];
    object[place.member] = textureInfo;
    return material;
}

TEST(GltfMaterialExtensions, EverySlotTakesTextureSetAndTransform) {
    const Json info = Json::parse(R"({"index": 1, "texCoord": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0.5, -1], "rotation": 0.25, "scale": [2, 3], "texCoord": 1}}})");
    std::vector<int> seen(materials::builtinMaterialModel().textures.size());
    for (const SlotPlace& place : kPlaces) {
        SCOPED_TRACE(std::string(place.owner) + " " + place.member);
        const gltf::Scene scene = mustImport(withMaterial(materialWith(place, info)));
        const materials::Material& material = onlyMaterial(scene);
        for (std::size_t slot = 0; slot < materials::builtinMaterialModel().textures.size(); ++slot) {
            const bool isThis =
                slot == static_cast<std::size_t>(materials::builtinMaterialModel().findTexture(place.slot));
            EXPECT_EQ(material.textures[slot].texture, isThis ? 0 : -1) << slot;
        }
        const materials::TextureInfo& read = material.texture(place.slot);
        EXPECT_EQ(read.texCoord, 1);
        EXPECT_TRUE(read.hasTransform);
        EXPECT_EQ(read.transform.offset, (std::array{0.5F, -1.0F}));
        EXPECT_EQ(read.transform.rotation, 0.25F);
        EXPECT_EQ(read.transform.scale, (std::array{2.0F, 3.0F}));
        EXPECT_TRUE(readingWarnings(scene).empty());
        ++seen[static_cast<std::size_t>(materials::builtinMaterialModel().findTexture(place.slot))];
    }
    for (std::size_t slot = 0; slot < materials::builtinMaterialModel().textures.size(); ++slot) {
        EXPECT_GT(seen[slot], 0) << slot;
    }
}

TEST(GltfMaterialExtensions, EverySlotIsChecked) {
    for (const SlotPlace& place : kPlaces) {
        SCOPED_TRACE(std::string(place.owner) + " " + place.member);
        const Diagnostic outside = mustFail(import(withMaterial(materialWith(place, {{"index", 2}}))));
        EXPECT_EQ(outside.id, "index-range");
        EXPECT_NE(outside.where.find(std::string(place.member) + "/index"), std::string::npos);
        EXPECT_EQ(mustFail(import(withMaterial(materialWith(place, 3)))).id, "json-type");
    }
}

struct OutOfRange {
    const char* extension;
    const char* member;
    Json value;
    float used;
    float (*read)(const materials::Material&);
};

TEST(GltfMaterialExtensions, ClampWhatIsOutOfRangeWithAWarning) {
    const OutOfRange cases[] = {
        {"clearcoat", "clearcoatFactor", 1.5, 1.0F,
         [](const materials::Material& m) -> float { return m["clearcoatFactor"]; }},
        {"clearcoat", "clearcoatRoughnessFactor", -1, 0.0F,
         [](const materials::Material& m) -> float { return m["clearcoatRoughnessFactor"]; }},
        {"sheen",
         "sheenColorFactor",
         {0, 2, 0},
         1.0F,
         [](const materials::Material& m) { return static_cast<float>(m["sheenColorFactor"][1]); }},
        {"sheen", "sheenRoughnessFactor", 2, 1.0F,
         [](const materials::Material& m) -> float { return m["sheenRoughnessFactor"]; }},
        {"transmission", "transmissionFactor", 2, 1.0F,
         [](const materials::Material& m) -> float { return m["transmissionFactor"]; }},
        {"volume", "thicknessFactor", -1, 0.0F,
         [](const materials::Material& m) -> float { return m["thicknessFactor"]; }},
        {"volume",
         "attenuationColor",
         {1, 1, 1.5},
         1.0F,
         [](const materials::Material& m) { return static_cast<float>(m["attenuationColor"][2]); }},
        {"volume", "attenuationDistance", 0, 1e-12F,
         [](const materials::Material& m) -> float { return m["attenuationDistance"]; }},
        {"volume", "attenuationDistance", -2, 1e-12F,
         [](const materials::Material& m) -> float { return m["attenuationDistance"]; }},
        {"ior", "ior", 0.5, 1.0F, [](const materials::Material& m) -> float { return m["ior"]; }},
        {"ior", "ior", -1, 1.0F, [](const materials::Material& m) -> float { return m["ior"]; }},
        {"specular", "specularFactor", 1.5, 1.0F,
         [](const materials::Material& m) -> float { return m["specularFactor"]; }},
        {"specular",
         "specularColorFactor",
         {-1, 0, 0},
         0.0F,
         [](const materials::Material& m) { return static_cast<float>(m["specularColorFactor"][0]); }},
        {"iridescence", "iridescenceFactor", 2, 1.0F,
         [](const materials::Material& m) -> float { return m["iridescenceFactor"]; }},
        {"iridescence", "iridescenceIor", 0.9, 1.0F,
         [](const materials::Material& m) -> float { return m["iridescenceIor"]; }},
        {"iridescence", "iridescenceThicknessMinimum", -1, 0.0F,
         [](const materials::Material& m) -> float { return m["iridescenceThicknessMinimum"]; }},
        {"iridescence", "iridescenceThicknessMaximum", -1, 0.0F,
         [](const materials::Material& m) -> float { return m["iridescenceThicknessMaximum"]; }},
        {"anisotropy", "anisotropyStrength", -0.5, 0.0F,
         [](const materials::Material& m) -> float { return m["anisotropyStrength"]; }},
        {"dispersion", "dispersion", -1, 0.0F,
         [](const materials::Material& m) -> float { return m["dispersion"]; }},
        {"diffuse_transmission", "diffuseTransmissionFactor", 2, 1.0F,
         [](const materials::Material& m) -> float { return m["diffuseTransmissionFactor"]; }},
        {"diffuse_transmission",
         "diffuseTransmissionColorFactor",
         {0, 0, 2},
         1.0F,
         [](const materials::Material& m) {
             return static_cast<float>(m["diffuseTransmissionColorFactor"][2]);
         }},
        {"pbrSpecularGlossiness",
         "diffuseFactor",
         {2, 0, 0, 1},
         1.0F,
         [](const materials::Material& m) { return static_cast<float>(m["baseColorFactor"][0]); }},
        {"pbrSpecularGlossiness",
         "specularFactor",
         {0, 0, -1},
         0.0F,
         [](const materials::Material& m) { return static_cast<float>(m["glossySpecularFactor"][2]); }},
        {"pbrSpecularGlossiness", "glossinessFactor", 2, 1.0F,
         [](const materials::Material& m) -> float { return m["glossinessFactor"]; }},
    };
    for (const OutOfRange& entry : cases) {
        SCOPED_TRACE(std::string(entry.member) + " " + entry.value.dump());
        Json material;
        material["extensions"][std::string("KHR_materials_") + entry.extension][entry.member] = entry.value;
        const gltf::Scene scene = mustImport(withMaterial(material));
        EXPECT_EQ(entry.read(onlyMaterial(scene)), entry.used);
        ASSERT_EQ(countWarnings(scene, "material-range"), 1U);
        const Diagnostic warning = findWarning(scene, "material-range");
        EXPECT_NE(warning.where.find(entry.member), std::string::npos) << warning.where;
        EXPECT_FALSE(warning.hint.empty());
        // A value of the wrong type is refused.
        material["extensions"][std::string("KHR_materials_") + entry.extension][entry.member] = "much";
        EXPECT_EQ(mustFail(import(withMaterial(material))).id, "json-type");
    }
}

TEST(GltfMaterialExtensions, TakeTheLimitsOfTheirRanges) {
    const gltf::Scene scene = importMaterial(R"({"KHR_materials_ior": {"ior": 0},
        "KHR_materials_iridescence": {"iridescenceIor": 1, "iridescenceThicknessMinimum": 500,
            "iridescenceThicknessMaximum": 100},
        "KHR_materials_volume": {"attenuationDistance": 1.7976931348623157e308}})");
    EXPECT_EQ(onlyMaterial(scene)["ior"], 0.0F);
    EXPECT_EQ(onlyMaterial(scene)["iridescenceThicknessMinimum"], 500.0F);
    // The distance is practically infinite.
    EXPECT_EQ(onlyMaterial(scene)["attenuationDistance"], std::numeric_limits<float>::infinity());
    EXPECT_TRUE(readingWarnings(scene).empty());
}

TEST(GltfMaterialExtensions, SpecularGlossinessWinsOverMetallicRoughness) {
    const gltf::Scene scene = mustImport(withMaterial(Json::parse(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "metallicFactor": 1, "roughnessFactor": 0.5,
            "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}},
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.25, 0.5, 0.75, 0.125],
            "specularFactor": [0.5, 0.25, 0.125], "glossinessFactor": 0.75,
            "diffuseTexture": {"index": 1, "texCoord": 1}}}})")));
    const materials::Material& read = onlyMaterial(scene);
    EXPECT_TRUE(read.gives("KHR_materials_pbrSpecularGlossiness"));
    EXPECT_EQ(read["baseColorFactor"], (std::array{0.25F, 0.5F, 0.75F, 0.125F}));
    EXPECT_EQ(read["glossySpecularFactor"], (std::array{0.5F, 0.25F, 0.125F}));
    EXPECT_EQ(read["glossinessFactor"], 0.75F);
    EXPECT_EQ(read.texture("baseColorTexture").texCoord, 1);
    EXPECT_EQ(read.texture("metallicRoughnessTexture").texture, -1);
    EXPECT_EQ(read["metallicFactor"], 0.0F);
}

TEST(GltfMaterialExtensions, UnlitReadsTheMetallicRoughnessBaseColor) {
    const gltf::Scene scene = mustImport(withMaterial(Json::parse(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_unlit": {}, "KHR_materials_pbrSpecularGlossiness":
            {"diffuseFactor": [0, 0, 1, 1], "diffuseTexture": {"index": 1, "texCoord": 1}}}})")));
    const materials::Material& read = onlyMaterial(scene);
    EXPECT_TRUE(read.isUnlit());
    EXPECT_EQ(read["baseColorFactor"], (std::array{1.0F, 0.5F, 0.0F, 1.0F}));
    EXPECT_EQ(read.texture("baseColorTexture").texCoord, 0);
}

TEST(GltfMaterialExtensions, MayBeRequired) {
    for (const char* name : {"anisotropy", "clearcoat", "diffuse_transmission", "dispersion",
                             "emissive_strength", "ior", "iridescence", "pbrSpecularGlossiness", "sheen",
                             "specular", "transmission", "unlit", "variants", "volume"}) {
        GltfBuilder builder = withMaterial(Json::object());
        builder.root["extensionsRequired"] = {std::string("KHR_materials_") + name};
        builder.root["extensionsUsed"] = builder.root["extensionsRequired"];
        const gltf::Scene scene = must(import(builder));
        EXPECT_TRUE(readingWarnings(scene).empty()) << name;
    }
}

}  // namespace
}  // namespace glint::test
