// Tests accessors, indices, modes and attributes.
#include "support/must.h"
#include "unit/gltf/only_primitive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace glint::test {
namespace {

void expectError(const Result<gltf::Scene>& scene, std::string_view id, std::string_view pointer) {
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.error().id, id) << toString(scene.error());
    EXPECT_TRUE(scene.error().where.ends_with("scene.gltf#" + std::string(pointer))) << scene.error().where;
    EXPECT_FALSE(scene.error().message.empty());
    EXPECT_FALSE(scene.error().hint.empty());
}

TEST(GltfGeometry, GeneratesIndicesAndLeavesMissingAttributesEmpty) {
    GltfBuilder builder;
    builder.addTriangle();
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& primitive = onlyPrimitive(scene);
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(primitive.positions, (std::vector<gltf::Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(primitive.normals.empty());
    EXPECT_TRUE(primitive.tangents.empty());
    EXPECT_TRUE(primitive.texCoords0.empty());
    EXPECT_EQ(primitive.colorContent, materials::ColorContent::None);
    EXPECT_EQ(primitive.pointer, "/meshes/0/primitives/0");
    EXPECT_EQ(scene->defaultMaterial, 0);
    EXPECT_EQ(primitive.material, 0);
    EXPECT_TRUE(scene->warnings.empty());
}

TEST(GltfGeometry, ReadsIndicesOfEveryType) {
    for (int type = 0; type < 3; ++type) {
        GltfBuilder builder;
        Json& primitive = builder.addTriangle();
        const int indices = type == 0   ? builder.addAccessor<std::uint8_t>({2, 1, 0}, 1)
                            : type == 1 ? builder.addAccessor<std::uint16_t>({2, 1, 0}, 1)
                                        : builder.addAccessor<std::uint32_t>({2, 1, 0}, 1);
        primitive["indices"] = indices;
        EXPECT_EQ(onlyPrimitive(import(builder)).indices, (std::vector<std::uint32_t>{2, 1, 0}));
    }
}

TEST(GltfGeometry, TurnsStripsAndFansIntoLists) {
    const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    GltfBuilder strip;
    strip.addMesh({{"attributes", {{"POSITION", strip.addAccessor(square, 3)}}}, {"mode", 5}});
    EXPECT_EQ(onlyPrimitive(import(strip)).indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
    GltfBuilder fan;
    fan.addMesh({{"attributes", {{"POSITION", fan.addAccessor(square, 3)}}}, {"mode", 6}});
    EXPECT_EQ(onlyPrimitive(import(fan)).indices, (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
}

// tinygltf refuses a document for each of these, or leaves the primitive out.
TEST(GltfGeometry, ReadsPastWhatNoPictureNeeds) {
    GltfBuilder builder;
    builder.addTriangle()["attributes"]["_NOTE"] = "text";
    builder.append("accessors", {{"componentType", 1}, {"type", "VEC9"}});
    builder.append("bufferViews", {{"buffer", 0}, {"byteLength", 12}, {"byteStride", 6}});
    builder.append("images", {{"uri", "missing.png"}, {"bufferView", 0}});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "spot"}}});
    builder.root["meshes"][0]["extensions"]["EXT_unknown"] = {{"size", 5000000000}, {"list", Json::array()}};
    EXPECT_EQ(onlyPrimitive(import(builder)).indices.size(), 3U);
}

TEST(GltfGeometry, SkipsPointsAndLines) {
    for (const int mode : {0, 1, 2, 3}) {
        GltfBuilder builder;
        builder.addTriangle()["mode"] = mode;
        const gltf::Scene scene = must(import(builder));
        EXPECT_TRUE(scene.meshes[0].primitives.empty());
        EXPECT_EQ(countWarnings(scene, "primitive-skipped"), 1U);
        EXPECT_EQ(scene.defaultMaterial, -1);
    }
    GltfBuilder unknown;
    unknown.addTriangle()["mode"] = 7;
    expectError(import(unknown), "primitive-mode", "/meshes/0/primitives/0/mode");
}

TEST(GltfGeometry, DropsIncompleteTriangles) {
    GltfBuilder builder;
    builder.addTriangle()["indices"] = builder.addAccessor<std::uint16_t>({0, 1, 2, 0, 1}, 1);
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).indices.size(), 3U);
    EXPECT_NE(findWarning(*scene, "triangle-incomplete").message.find("2 vertices"), std::string::npos);
}

TEST(GltfGeometry, RefusesBadIndices) {
    GltfBuilder beyond;
    beyond.addTriangle()["indices"] = beyond.addAccessor<std::uint16_t>({0, 1, 3}, 1);
    expectError(import(beyond), "index-range", "/meshes/0/primitives/0/indices");
    GltfBuilder restart;
    restart.addTriangle()["indices"] = restart.addAccessor<std::uint8_t>({0, 1, 255}, 1);
    expectError(import(restart), "primitive-restart", "/meshes/0/primitives/0/indices");
    // There is a vertex of that number.
    std::vector<float> positions(std::size_t{3} * 256);
    positions[3] = positions[3 * 255 + 1] = 1.0F;
    Json& first = restart.root["meshes"][0]["primitives"][0];
    first["attributes"]["POSITION"] = restart.addAccessor<float>(positions, 3);
    const Result<gltf::Scene> drawn = import(restart);
    EXPECT_EQ(onlyPrimitive(drawn).indices, (std::vector<std::uint32_t>{0, 1, 255}));
    EXPECT_NE(findWarning(*drawn, "primitive-restart").message.find("255"), std::string::npos);
    GltfBuilder floats;
    Json& withFloats = floats.addTriangle();
    withFloats["indices"] = floats.addAccessor<float>({0, 1, 2}, 1);
    expectError(import(floats), "accessor-component-type", "/accessors/1");
}

TEST(GltfGeometry, KeepsDegenerateTriangles) {
    GltfBuilder builder;
    builder.addTriangle()["indices"] = builder.addAccessor<std::uint8_t>({0, 1, 2, 1, 1, 1}, 1);
    EXPECT_EQ(onlyPrimitive(import(builder)).indices.size(), 6U);
}

TEST(GltfGeometry, NormalizesIntegers) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["TEXCOORD_0"] =
        builder.addAccessor<std::uint16_t>({0, 65535, 13107, 0, 0, 0}, 2, true);
    primitive["attributes"]["TEXCOORD_1"] =
        builder.addAccessor<std::int8_t>({127, -127, -128, 0, 0, 0}, 2, true);
    primitive["attributes"]["COLOR_0"] =
        builder.addAccessor<std::uint8_t>({255, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, true);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    EXPECT_EQ(read.texCoords0[0], (gltf::Float2{0.0F, 1.0F}));
    EXPECT_FLOAT_EQ(read.texCoords0[1][0], 0.2F);
    EXPECT_EQ(read.texCoords1[0], (gltf::Float2{1.0F, -1.0F}));
    EXPECT_EQ(read.texCoords1[1], (gltf::Float2{-1.0F, 0.0F}));
    EXPECT_FLOAT_EQ(read.colors[0][1], 0.2F);
    EXPECT_EQ(read.colorContent, materials::ColorContent::Varying);
}

TEST(GltfGeometry, ReadsQuantizedAttributes) {
    GltfBuilder builder;
    builder.root["extensionsRequired"] = Json::array({"KHR_mesh_quantization"});
    Json primitive;
    primitive["attributes"]["POSITION"] =
        builder.addAccessor<std::int16_t>({0, 0, 0, 100, 0, 0, 0, -100, 0}, 3);
    primitive["attributes"]["NORMAL"] = builder.addAccessor<std::int8_t>({0, 0, 127, 0, 0, 1, 0, 3, 4}, 3);
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<std::uint8_t>({0, 1, 2, 3, 4, 255}, 2);
    builder.addMesh(primitive);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    EXPECT_EQ(read.positions[2], (gltf::Float3{0.0F, -100.0F, 0.0F}));
    EXPECT_EQ(read.normals[1], (gltf::Float3{0.0F, 0.0F, 1.0F}));
    EXPECT_FLOAT_EQ(read.normals[2][1], 0.6F);
    EXPECT_EQ(read.texCoords0[2], (gltf::Float2{4.0F, 255.0F}));
}

TEST(GltfGeometry, ClassifiesColors) {
    GltfBuilder white;
    white.addTriangle()["attributes"]["COLOR_0"] =
        white.addAccessor<std::uint16_t>(std::vector<std::uint16_t>(9, 65535), 3, true);
    const Result<gltf::Scene> scene = import(white);
    EXPECT_EQ(onlyPrimitive(scene).colorContent, materials::ColorContent::White);
    EXPECT_EQ(onlyPrimitive(scene).colors[2], (gltf::Float4{1.0F, 1.0F, 1.0F, 1.0F}));
    GltfBuilder clear;
    clear.addTriangle()["attributes"]["COLOR_0"] =
        clear.addAccessor<float>({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.999F}, 4);
    EXPECT_EQ(onlyPrimitive(import(clear)).colorContent, materials::ColorContent::Varying);
}

TEST(GltfGeometry, ReadsStridedViews) {
    GltfBuilder builder;
    const std::vector<float> interleaved{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9};
    const int view = builder.addView(interleaved.data(), interleaved.size() * 4 - 4, 16);
    builder.append("accessors",
                   {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    builder.addMesh({{"attributes", {{"POSITION", 0}}}});
    EXPECT_EQ(onlyPrimitive(import(builder)).positions[2], (gltf::Float3{0, 1, 0}));
    builder.root["bufferViews"][0]["byteStride"] = 8;
    expectError(import(builder), "accessor-stride", "/bufferViews/0/byteStride");
}

TEST(GltfGeometry, AppliesSparseAccessors) {
    GltfBuilder builder;
    builder.addTriangle();
    const std::uint16_t indices[] = {1, 2};
    const float values[] = {5, 6, 7, 8, 9, 10};
    builder.root["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.addView(indices, sizeof indices)}, {"componentType", 5123}}},
        {"values", {{"bufferView", builder.addView(values, sizeof values)}}}};
    EXPECT_EQ(onlyPrimitive(import(builder)).positions,
              (std::vector<gltf::Float3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
    // Without a buffer view, the base consists of zeros.
    builder.root["accessors"][0].erase("bufferView");
    EXPECT_EQ(onlyPrimitive(import(builder)).positions[0], (gltf::Float3{0, 0, 0}));
    EXPECT_EQ(onlyPrimitive(import(builder)).positions[2], (gltf::Float3{8, 9, 10}));
    builder.root["accessors"][0]["count"] = 2;
    expectError(import(builder), "sparse-index", "/accessors/0/sparse/indices");
    builder.root["accessors"][0]["count"] = 1;
    expectError(import(builder), "sparse-count", "/accessors/0/sparse/count");
}

TEST(GltfGeometry, ReadsIndicesWithoutABufferViewAsZeros) {
    GltfBuilder builder;
    builder.addTriangle()["indices"] =
        builder.append("accessors", {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    EXPECT_EQ(onlyPrimitive(import(builder)).indices, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(GltfGeometry, ChecksBounds) {
    GltfBuilder builder;
    builder.addTriangle();
    Json& accessor = builder.root["accessors"][0];
    Json& view = builder.root["bufferViews"][0];
    accessor["byteOffset"] = 4;
    expectError(import(builder), "accessor-range", "/accessors/0");
    accessor["byteOffset"] = 9007199254740991;
    expectError(import(builder), "accessor-range", "/accessors/0");
    accessor["byteOffset"] = 0;
    accessor["count"] = 1000000;
    expectError(import(builder), "accessor-range", "/accessors/0");
    accessor["count"] = 9007199254740991;
    expectError(import(builder), "vertex-limit", "/accessors/0");
    accessor["count"] = -1;
    expectError(import(builder), "json-range", "/accessors/0/count");
    accessor["count"] = 3;
    view["byteLength"] = 9007199254740991;
    expectError(import(builder), "buffer-view-range", "/bufferViews/0");
    view["byteLength"] = 36;
    view["byteOffset"] = 9007199254740991;
    expectError(import(builder), "buffer-view-range", "/bufferViews/0");
    view["byteOffset"] = 0;
    accessor["componentType"] = 5124;
    expectError(import(builder), "accessor-component-type", "/accessors/0/componentType");
    accessor["componentType"] = 5126;
    accessor["type"] = "VEC5";
    expectError(import(builder), "accessor-type", "/accessors/0/type");
}

TEST(GltfGeometry, LimitsVertices) {
    GltfBuilder builder;
    builder.addTriangle();
    EXPECT_TRUE(import(builder, {.maxVertices = 3}).ok());
    expectError(import(builder, {.maxVertices = 2}), "vertex-limit", "/accessors/0");
    // An accessor that takes no bytes of the file must not take memory.
    builder.root["accessors"][0] = {{"componentType", 5126}, {"count", 200000000}, {"type", "VEC3"}};
    expectError(import(builder), "accessor-count", "/accessors/0");
}

TEST(GltfGeometry, PrimitivesThatShareVerticesHaveMaterialsOfTheirOwn) {
    GltfBuilder builder;
    Json first = builder.addTriangle();
    first["material"] = builder.append("materials", {{"name", "first"}});
    Json second = first;
    second["material"] = builder.append("materials", {{"name", "second"}});
    Json broken = first;
    broken["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 1}, 3);
    builder.root["meshes"][0]["primitives"][0] = first;
    builder.addMesh(second);
    builder.addMesh(broken);
    builder.addMesh(broken);

    const gltf::Scene scene = mustImport(builder);
    ASSERT_EQ(scene.meshes.size(), 4);
    const gltf::Primitive& one = scene.meshes[0].primitives.at(0);
    const gltf::Primitive& other = scene.meshes[1].primitives.at(0);
    EXPECT_EQ(other.positions, one.positions);
    EXPECT_EQ(other.indices, one.indices);
    EXPECT_EQ(one.pointer, "/meshes/0/primitives/0");
    EXPECT_EQ(other.pointer, "/meshes/1/primitives/0");
    EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(one.material)).name, "first");
    EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(other.material)).name, "second");
    // What is wrong with vertices is told of each primitive that has them.
    EXPECT_EQ(std::ranges::count(scene.warnings, "normal-invalid", &Diagnostic::id), 2);
    // They take room each.
    EXPECT_TRUE(import(builder, {.maxVertices = 3 + 3 + 6 + 6}).ok());
    expectError(import(builder, {.maxVertices = 3 + 2}), "vertex-limit", "/meshes/1/primitives/0");
}

TEST(GltfGeometry, RefusesAttributesThatDoNotMatch) {
    GltfBuilder count;
    count.addTriangle()["attributes"]["NORMAL"] = count.addAccessor<float>({0, 0, 1}, 3);
    expectError(import(count), "attribute-count", "/meshes/0/primitives/0/attributes/NORMAL");
    GltfBuilder type;
    type.addTriangle()["attributes"]["TEXCOORD_0"] = type.addAccessor<float>(std::vector<float>(9), 3);
    expectError(import(type), "attribute-type", "/meshes/0/primitives/0/attributes/TEXCOORD_0");
    GltfBuilder matrix;
    Json& withMatrix = matrix.addTriangle();
    withMatrix["attributes"]["COLOR_0"] = matrix.addAccessor<float>(std::vector<float>(48), 16);
    expectError(import(matrix), "accessor-type", "/accessors/1/type");
}

TEST(GltfGeometry, NeedsPositionsOnlyWhereDrawn) {
    GltfBuilder builder;
    builder.addTriangle()["attributes"].erase("POSITION");
    expectError(import(builder), "position-missing", "/meshes/0/primitives/0/attributes");
    builder.root.erase("nodes");
    const gltf::Scene scene = must(import(builder));
    EXPECT_EQ(countWarnings(scene, "position-missing"), 1U);
    EXPECT_TRUE(scene.meshes[0].primitives.empty());
}

TEST(GltfGeometry, ListsPlanningInputs) {
    GltfBuilder builder;
    builder.append("materials", Json::object());
    Json& first = builder.addTriangle();
    first["material"] = 0;
    first["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    first["attributes"]["TEXCOORD_1"] = builder.addAccessor<float>(std::vector<float>(6), 2);
    builder.addTriangle();
    const gltf::Scene scene = must(import(builder));
    const std::vector<materials::PrimitiveInputs> inputs = planningInputs(scene);
    ASSERT_EQ(inputs.size(), 2U);
    EXPECT_EQ(inputs[0].material, 0);
    EXPECT_TRUE(inputs[0].hasNormals);
    EXPECT_FALSE(inputs[0].hasTangents);
    EXPECT_FALSE(inputs[0].hasTexCoords0);
    EXPECT_TRUE(inputs[0].hasTexCoords1);
    EXPECT_EQ(inputs[1].mesh, 1);
    EXPECT_EQ(inputs[1].primitive, 0);
    EXPECT_EQ(inputs[1].material, 1);
    EXPECT_EQ(scene.defaultMaterial, 1);
    EXPECT_FALSE(inputs[1].hasNormals);
}

}  // namespace
}  // namespace glint::test
