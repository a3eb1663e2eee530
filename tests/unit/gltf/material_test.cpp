// Tests materials, textures, images and extensions.
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace glint::test {
namespace {

std::string pngUri(const char* base64Text) {
    return std::string("data:image/png;base64,") + base64Text;
}

// Returns a file with one texture and one material whose base colour uses it. The test adds the rest.
GltfBuilder texturedMaterial() {
    GltfBuilder builder;
    builder.append("images", {{"uri", pngUri(kPng8)}});
    builder.append("textures", {{"source", 0}});
    Json material;
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    builder.append("materials", std::move(material));
    return builder;
}

TEST(GltfMaterials, HaveTheDefaultsOfTheSpecification) {
    GltfBuilder builder;
    builder.append("materials", Json::object());
    const gltf::Scene scene = mustImport(builder);
    ASSERT_EQ(scene.materials.size(), 1U);
    const materials::Material& read = scene.materials[0];
    const materials::Material expected;
    EXPECT_EQ(read["baseColorFactor"], expected["baseColorFactor"]);
    EXPECT_EQ(read["metallicFactor"], 1.0F);
    EXPECT_EQ(read["roughnessFactor"], 1.0F);
    EXPECT_EQ(read["emissiveFactor"], expected["emissiveFactor"]);
    EXPECT_EQ(read["emissiveStrength"], 1.0F);
    EXPECT_EQ(read["normalScale"], 1.0F);
    EXPECT_EQ(read["occlusionStrength"], 1.0F);
    EXPECT_EQ(read["alphaCutoff"], 0.5F);
    EXPECT_EQ(read.alphaMode, materials::AlphaMode::Opaque);
    EXPECT_FALSE(read.doubleSided);
    EXPECT_FALSE(read.isUnlit());
    for (const auto& [slot, info] : read.textures) {
        EXPECT_EQ(info.texture, -1);
    }
    EXPECT_EQ(scene.defaultMaterial, -1);
}

TEST(GltfMaterials, ReadsEveryValue) {
    GltfBuilder builder = texturedMaterial();
    builder.root["materials"][0] = Json::parse(R"({
        "name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
        "emissiveFactor": [0.125, 0.25, 0.5],
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.25,
            "roughnessFactor": 0.75, "baseColorTexture": {"index": 0, "texCoord": 1},
            "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 0, "scale": -2, "extensions": {"KHR_texture_transform":
            {"offset": [0.5, -1], "rotation": 3, "scale": [2, 0.5]}}},
        "occlusionTexture": {"index": 0, "strength": 0.5, "texCoord": 0, "extensions":
            {"KHR_texture_transform": {"texCoord": 1}}},
        "emissiveTexture": {"index": 0},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3000000000},
            "KHR_materials_unlit": {}}})");
    const gltf::Scene scene = mustImport(builder);
    const materials::Material& read = scene.materials.at(0);
    EXPECT_EQ(read.name, "paint");
    EXPECT_TRUE(read.doubleSided);
    EXPECT_TRUE(read.isUnlit());
    EXPECT_EQ(read.alphaMode, materials::AlphaMode::Mask);
    EXPECT_EQ(read["alphaCutoff"], 0.25F);
    EXPECT_EQ(read["baseColorFactor"], (std::array{0.5F, 0.25F, 0.125F, 0.75F}));
    EXPECT_EQ(read["emissiveFactor"], (std::array{0.125F, 0.25F, 0.5F}));
    EXPECT_EQ(read["emissiveStrength"], 3e9F);
    EXPECT_EQ(read["metallicFactor"], 0.25F);
    EXPECT_EQ(read["roughnessFactor"], 0.75F);
    EXPECT_EQ(read["normalScale"], -2.0F);
    EXPECT_EQ(read["occlusionStrength"], 0.5F);
    for (std::size_t slot = 0; slot < materials::builtinMaterialModel().textures.size(); ++slot) {
        const bool isCore = slot <= static_cast<std::size_t>(
                                        materials::builtinMaterialModel().findTexture("emissiveTexture"));
        EXPECT_EQ(read.textures[slot].texture, isCore ? 0 : -1);
    }
    EXPECT_EQ(read.texture("baseColorTexture").texCoord, 1);
    EXPECT_EQ(read.texture("occlusionTexture").texCoord, 1);
    const materials::TextureTransform& transform = read.texture("normalTexture").transform;
    EXPECT_EQ(transform.offset, (std::array{0.5F, -1.0F}));
    EXPECT_EQ(transform.rotation, 3.0F);
    EXPECT_EQ(transform.scale, (std::array{2.0F, 0.5F}));
    EXPECT_EQ(scene.textures.size(), 1U);
    EXPECT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(readingWarnings(scene).size(), 1U);
    EXPECT_EQ(countWarnings(scene, "material-conflict"), 1U) << "unlit and emissive strength";
}

TEST(GltfMaterials, ClampsFactorsWithAWarning) {
    GltfBuilder builder;
    builder.append("materials", Json::parse(R"({"pbrMetallicRoughness": {"metallicFactor": 1.5,
        "roughnessFactor": -1, "baseColorFactor": [2, 0, 0, 1]}, "alphaMode": "GLASS"})"));
    const gltf::Scene scene = mustImport(builder);
    EXPECT_EQ(scene.materials.at(0)["metallicFactor"], 1.0F);
    EXPECT_EQ(scene.materials.at(0)["roughnessFactor"], 0.0F);
    EXPECT_EQ(scene.materials.at(0)["baseColorFactor"][0], 1.0F);
    EXPECT_EQ(countWarnings(scene, "material-range"), 3U);
    EXPECT_EQ(countWarnings(scene, "alpha-mode"), 1U);
    EXPECT_TRUE(findWarning(scene, "material-range")
                    .where.ends_with("#/materials/0/pbrMetallicRoughness/baseColorFactor/0"));
}

TEST(GltfMaterials, RefusesWrongTypesAndNumbers) {
    const auto idOf = [](const char* material) {
        const Result<gltf::Scene> scene =
            importText(std::string(R"({"asset": {"version": "2.0"}, "materials": [)") + material + "]}");
        return scene ? std::string("imported") : scene.error().id;
    };
    EXPECT_EQ(idOf(R"({"emissiveFactor": [1, 1]})"), "json-type");
    EXPECT_EQ(idOf(R"({"emissiveFactor": [1, 1, "x"]})"), "json-type");
    EXPECT_EQ(idOf(R"({"alphaCutoff": 1e300})"), "json-range");
    EXPECT_EQ(idOf(R"({"alphaCutoff": 1e999})"), "json-range");
    EXPECT_EQ(idOf(R"({"alphaCutoff": NaN})"), "json-syntax");
    EXPECT_EQ(idOf(R"({"doubleSided": 1})"), "json-type");
    EXPECT_EQ(idOf(R"({"normalTexture": {"index": 0}})"), "index-range");
    EXPECT_EQ(idOf(R"({"normalTexture": {}})"), "json-missing");
    EXPECT_EQ(idOf("null"), "json-type");
    EXPECT_EQ(idOf(R"({"alphaCutoff": 1})"), "imported");
}

TEST(GltfMaterials, LeavesOutUvSetsBeyondTheSecond) {
    GltfBuilder builder = texturedMaterial();
    builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2;
    const gltf::Scene scene = mustImport(builder);
    EXPECT_EQ(scene.materials.at(0).texture("baseColorTexture").texture, -1);
    EXPECT_EQ(countWarnings(scene, "texture-uv-set"), 1U);
}

// A texture without an image is treated as absent.
TEST(GltfMaterials, NotesTexturesWithoutASource) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.append("textures", Json::object());
    builder.append("materials", Json::parse(R"({"normalTexture": {"index": 0}})"));
    const gltf::Scene scene = mustImport(builder);
    EXPECT_EQ(scene.materials.at(0).texture("normalTexture").texture, -1);
    EXPECT_EQ(findWarning(scene, "texture-source").severity, Severity::Note);
    EXPECT_EQ(countWarnings(scene, "texture-source"), 1U);
}

// One note names all of them, whether they are required or not.
TEST(GltfMaterials, NotesExtensionsThatChangeNoPictureOnce) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = Json::array({"KHR_xmp_json_ld", "KHR_xmp", "EXT_structural_metadata"});
    builder.root["extensionsRequired"] = Json::array({"KHR_xmp_json_ld"});
    builder.root["extensions"]["KHR_xmp_json_ld"]["packets"] = Json::array({Json::object()});
    builder.append("materials", Json::parse(R"({"extensions": {"KHR_xmp_json_ld": {"packet": 0}}})"));
    const gltf::Scene scene = mustImport(builder);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].id, "extension-no-picture");
    EXPECT_EQ(scene.warnings[0].severity, Severity::Note);
    EXPECT_EQ(scene.warnings[0].message,
              "EXT_structural_metadata, KHR_xmp, KHR_xmp_json_ld change no picture and are not read");
    EXPECT_TRUE(scene.materials.at(0).unsupportedExtensions.empty());
}

TEST(GltfMaterials, NamesUnsupportedExtensions) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = Json::array({"KHR_materials_future", "KHR_materials_unlit"});
    builder.append("materials", Json::parse(R"({"extensions": {"KHR_materials_future": {},
        "ACME_paint": {}, "KHR_materials_unlit": {}}})"));
    const gltf::Scene scene = mustImport(builder);
    EXPECT_EQ(scene.materials.at(0).unsupportedExtensions,
              (std::vector<std::string>{"ACME_paint", "KHR_materials_future"}));
    EXPECT_EQ(countWarnings(scene, "extension-ignored"), 1U);
}

TEST(GltfExtensions, RefusesWhatIsRequiredAndUnknown) {
    for (const char* name : {"KHR_materials_future", "EXT_texture_avif", "ACME_magic"}) {
        GltfBuilder builder;
        builder.root["extensionsRequired"] = Json::array({"KHR_texture_transform", name});
        const Result<gltf::Scene> scene = import(builder);
        ASSERT_FALSE(scene.ok()) << name;
        EXPECT_EQ(scene.error().id, "extension-unsupported");
        EXPECT_TRUE(scene.error().where.ends_with("scene.gltf#/extensionsRequired/1"));
        EXPECT_NE(scene.error().message.find(name), std::string::npos);
        EXPECT_FALSE(scene.error().hint.empty());
    }
}

TEST(GltfExtensions, WarnsOnceOfWhatIsUsedAndUnknown) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = Json::array({"ACME_magic", "KHR_lights_punctual", "ACME_magic"});
    EXPECT_EQ(countWarnings(mustImport(builder), "extension-ignored"), 1U);
    builder.root["extensionsUsed"] = Json::array({1});
    EXPECT_FALSE(import(builder).ok());
}

TEST(GltfExtensions, UsesTheFallbackOfTextures) {
    GltfBuilder builder = texturedMaterial();
    builder.root["textures"][0]["extensions"]["EXT_texture_avif"]["source"] = 1;
    EXPECT_EQ(mustImport(builder).materials.at(0).texture("baseColorTexture").texture, 0);
    builder.root["textures"][0].erase("source");
    const gltf::Scene scene = mustImport(builder);
    EXPECT_EQ(scene.materials.at(0).texture("baseColorTexture").texture, -1);
    EXPECT_TRUE(scene.textures.empty());
    EXPECT_TRUE(scene.images.empty());
    EXPECT_NE(findWarning(scene, "texture-source").message.find("EXT_texture_avif"), std::string::npos);
    EXPECT_TRUE(findWarning(scene, "texture-source").where.ends_with("#/textures/0"));
}

TEST(GltfExtensions, LeavesSlotsOfUnreadableFormatsEmpty) {
    for (const Json& image : {Json{{"uri", "a.ktx"}}, Json{{"uri", "data:image/avif;base64,AAAA"}},
                              Json{{"uri", "a.bin"}, {"mimeType", "image/avif"}}}) {
        GltfBuilder builder = texturedMaterial();
        builder.root["images"][0] = image;
        const gltf::Scene scene = mustImport(builder, {.decodeImages = true});
        EXPECT_EQ(scene.materials.at(0).texture("baseColorTexture").texture, -1);
        EXPECT_EQ(countWarnings(scene, "texture-source"), 1U);
    }
}

TEST(GltfTextures, ReadsSamplers) {
    GltfBuilder builder = texturedMaterial();
    builder.root["samplers"] = Json::parse(R"([
        {"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9728},
        {"minFilter": 9985}, {"minFilter": 9986}, {"minFilter": 1, "magFilter": 2, "wrapS": 3, "wrapT": 4}])");
    builder.root["textures"][0]["sampler"] = 1;
    const gltf::Scene scene = mustImport(builder);
    ASSERT_EQ(scene.samplers.size(), 4U);
    EXPECT_EQ(scene.textures.at(0).sampler, 1);
    const gltf::Sampler& first = scene.samplers[0];
    EXPECT_EQ(first.wrapU, gltf::Wrap::ClampToEdge);
    EXPECT_EQ(first.wrapV, gltf::Wrap::MirroredRepeat);
    EXPECT_EQ(first.magnification, gltf::Filter::Nearest);
    EXPECT_EQ(first.minification, gltf::Filter::Nearest);
    EXPECT_FALSE(first.mipmapped);
    EXPECT_EQ(scene.samplers[1].minification, gltf::Filter::Linear);
    EXPECT_EQ(scene.samplers[1].mip, gltf::Filter::Nearest);
    EXPECT_EQ(scene.samplers[2].minification, gltf::Filter::Nearest);
    EXPECT_EQ(scene.samplers[2].mip, gltf::Filter::Linear);
    EXPECT_TRUE(scene.samplers[2].mipmapped);
    EXPECT_EQ(scene.samplers[3], gltf::Sampler{});
    EXPECT_EQ(countWarnings(scene, "sampler-value"), 4U);
}

TEST(GltfTextures, AppendsADefaultSampler) {
    GltfBuilder builder = texturedMaterial();
    builder.append("samplers", {{"wrapS", 33071}});
    const gltf::Scene scene = mustImport(builder);
    ASSERT_EQ(scene.samplers.size(), 2U);
    EXPECT_EQ(scene.textures.at(0).sampler, 1);
    EXPECT_EQ(scene.samplers[1], gltf::Sampler{});
}

TEST(GltfImages, DecodesWhereAsked) {
    const gltf::Scene headers = mustImport(texturedMaterial());
    EXPECT_TRUE(headers.images.at(0).pixels.empty());
    EXPECT_EQ(headers.images.at(0).name, "image 0");
    EXPECT_EQ(headers.images.at(0).pointer, "/images/0");
    const gltf::Scene decoded = mustImport(texturedMaterial(), {.decodeImages = true});
    EXPECT_EQ(decoded.images.at(0).width, 1);
    EXPECT_EQ(decoded.images.at(0).height, 2);
    EXPECT_EQ(decoded.images.at(0).pixels, (std::vector<std::uint8_t>{255, 0, 128, 64, 1, 2, 3, 4}));
}

TEST(GltfImages, ExplainsWhatItCannotDecode) {
    const auto idOf = [](const Json& image, const gltf::ImportOptions& options) {
        GltfBuilder builder = texturedMaterial();
        builder.root["images"][0] = image;
        const Result<gltf::Scene> scene = import(builder, options);
        if (scene) {
            return std::string("imported");
        }
        EXPECT_NE(scene.error().where.find("#/images/0"), std::string::npos) << scene.error().where;
        EXPECT_FALSE(scene.error().hint.empty());
        return scene.error().id;
    };
    const gltf::ImportOptions decode{.decodeImages = true};
    EXPECT_EQ(idOf({{"uri", "data:image/png;base64,AAAAAAAA"}}, decode), "image-decode");
    EXPECT_EQ(idOf({{"uri", "data:image/png;base64,"}}, decode), "image-decode");
    EXPECT_EQ(idOf({{"uri", "data:image/png;base64,A*"}}, decode), "data-uri");
    EXPECT_EQ(idOf({{"uri", pngUri(kPngBomb)}}, decode), "image-decode");
    EXPECT_EQ(idOf({{"uri", pngUri(kPng8)}}, {.decodeImages = true, .maxImageSize = 1}), "image-size");
    EXPECT_EQ(idOf({{"uri", "missing.png"}}, decode), "file-open");
    EXPECT_EQ(idOf({{"uri", "missing.png"}}, {}), "imported");
    EXPECT_EQ(idOf(Json::object(), {}), "image-data");
    EXPECT_EQ(idOf({{"uri", "data:image/png;base64," + std::string(kPng8).substr(0, 60)}}, decode),
              "image-decode");
}

TEST(GltfImages, RefusesJpegsOfManyScans) {
    // Each scan would cost a pass over the image.
    const auto messageOf = [](std::size_t scans) {
        base::Bytes bytes{0xFF, 0xD8};
        for (std::size_t i = 0; i < scans; ++i) {
            bytes.insert(bytes.end(), {0xFF, 0xDA});
        }
        GltfBuilder builder = texturedMaterial();
        builder.root["images"][0] = {{"uri", "data:image/jpeg;base64," + base64(bytes)}};
        const Result<gltf::Scene> scene = import(builder, {.decodeImages = true});
        return scene ? "imported" : scene.error().id + ": " + scene.error().message;
    };
    EXPECT_TRUE(messageOf(257).starts_with("image-decode: ")) << messageOf(257);
    EXPECT_NE(messageOf(257).find("more than 256 scans"), std::string::npos) << messageOf(257);
    EXPECT_EQ(messageOf(256).find("scans"), std::string::npos) << messageOf(256);
}

TEST(GltfImages, DecodesFromBufferViews) {
    GltfBuilder builder = texturedMaterial();
    const std::string uri = pngUri(kPng8);
    // The same bytes come through the buffer, so the importer's own data URI code decodes them.
    builder.root["buffers"] = Json::array({{{"byteLength", 75}, {"uri", uri}}});
    builder.root["bufferViews"] = Json::array({{{"buffer", 0}, {"byteLength", 75}}});
    builder.root["images"][0] = {{"bufferView", 0}, {"mimeType", "image/png"}};
    const gltf::Scene scene = mustImport(builder, {.decodeImages = true});
    EXPECT_EQ(scene.images.at(0).pixels.size(), 8U);
    EXPECT_EQ(scene.images.at(0).pixels[4], 1);
}

}  // namespace
}  // namespace glint::test
